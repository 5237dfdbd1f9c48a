/*
  Two cuboids in contact under generalised shear (Mihai, Safar & Wyatt, Section 4.1): what the test asserts and the
  bench program prints. Set-up, and what of it is ours: docs/results/paper-cuboids.md.

  Unit squares [-1, 0] x [0, 1] and [0, 1] x [0, 1] of plane section, fibres along X2; bottoms held, tops moved by
  top[k] e1, which is a shear f(X2) with f(0) = 0, f(1) = top[k] that the free sides bend. The interface is the material
  plane X1 = 0: frictionless unilateral contact with cohesion. Follower (Cauchy) pressure on the sides X1 = -1 and 1.
  Lengths in edges, stresses in C1 + C2.

    CuboidsSetup setup = CuboidsDefault(n, shear, pressure_in_MPa);
    CuboidsCreate(&setup, &cuboids); CuboidsSolve(&cuboids, 1.0, setup.pressure, &converged);
    CuboidsFindProfile(&cuboids, &profile); CuboidsDestroy(&cuboids);
*/
#ifndef LAM_SUPPORT_CUBOIDS_H
#define LAM_SUPPORT_CUBOIDS_H

#include <petsctime.h>
#include "blocks.h"

#define CUBOIDS_STRESS 0.11 /* C1 + C2, MPa */
#define CUBOIDS_SAMPLES 201 /* of the interface, equally spaced in X2 */
typedef struct {
  PetscInt n; /* n x n elements a body */
  PetscReal top[2], cohesion;
  PetscReal pressure; /* at the start */
  PetscBool plane_stress;
  LamWall wall[2];
} CuboidsSetup;

/* A share of the tops' displacement, and the pressure. */
typedef struct {
  PetscReal share, pressure;
} CuboidsLoad;

typedef struct {
  CuboidsSetup setup;
  Blocks blocks;
  PetscInt first[3];   /* first node of each body, end */
  CuboidsLoad load;    /* that is reached */
  PetscInt iterations; /* of all steps */
  PetscReal seconds;
} Cuboids;

/* Equal bodies, both tops moved by `shear`; pressure in MPa. */
CuboidsSetup CuboidsDefault(PetscInt n, PetscReal shear, PetscReal pressure);
/* The fibres of the right body ten times softer, W_1 != W_2. */
CuboidsSetup CuboidsUnequal(PetscInt n, PetscReal shear, PetscReal pressure);
PetscErrorCode CuboidsCreate(const CuboidsSetup *setup, Cuboids *c);
PetscErrorCode CuboidsDestroy(Cuboids *c);
/* A stable state has one negative eigenvalue for every active multiplier. */
PetscBool CuboidsIsStable(const Cuboids *c);
/* From the present load to a share of setup.top and a pressure in C1 + C2; where that fails, `load` is what was
   reached. */
PetscErrorCode CuboidsSolve(Cuboids *c, PetscReal share, PetscReal pressure, PetscBool *converged);
/* What the interface looks like: gap and pressure (0 where apart, in C1 + C2) at the points of the left
   body with X2 = k / (CUBOIDS_SAMPLES - 1). */
typedef struct {
  PetscReal gap[CUBOIDS_SAMPLES], pressure[CUBOIDS_SAMPLES];
  PetscReal largest, at; /* gap within the margins, and its X2 */
  PetscReal depth;       /* of the deepest penetration within the margins */
  PetscReal area;        /* current, between the bodies */
  PetscReal apart, open; /* shares of the interface without pressure, and with a gap above CUBOIDS_OPEN */
} CuboidsProfile;

void CuboidsFindProfile(Cuboids *c, CuboidsProfile *profile);
/* Creates the cuboids and solves from the reference state under setup->pressure in one go. */
PetscErrorCode CuboidsCompute(const CuboidsSetup *setup, Cuboids *c, CuboidsProfile *profile);
/* Largest difference of the gaps within the margins, relative to the largest gap of the reference. */
PetscReal CuboidsGapError(const CuboidsProfile *profile, const CuboidsProfile *reference);

/*
  Force of the grips on a body: what its wall stresses ask for at held nodes, less what pressure and contact give there.
  The gradient of the area at an open side, which the residual holds, is the pressure's force but for half the side's
  chord, turned, at its ends.
*/
PetscErrorCode CuboidsGripForce(Cuboids *c, PetscInt body, PetscReal force[2]);
/* Force of the contact pressure on the left body, by the normal of its side; midpoints of 8 parts of a half-edge. */
void CuboidsContactForce(Cuboids *c, PetscReal force[2]);

#endif
