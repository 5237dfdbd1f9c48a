/*
  The gap k X2 - (3 k / 4) X2^(4/3) between two walls side by side, fibres along X2, as Section 3 of Mihai, Safar &
  Wyatt has it, against equilibrium and the contact conditions (docs/results/paper.md): the left wall in generalised
  shear with sigma12 = a X2, the right one in simple shear k, touching at X2 = 0. a is chosen so that both shears are k
  at X2 = 1.
*/
#ifndef LAM_FIGURES_GAP_H
#define LAM_FIGURES_GAP_H

#include "figures_strip.h"

#define GAP_PSI 1.57079632679489662

typedef struct {
  double ratio;  /* (C1 + C2) / (C4 k^2): 0 where the power 4/3 is the solution of the cubic */
  double gap;    /* at X2 = 1, over k; the paper's: 1/4 */
  double shear;  /* shear traction on both faces at X2 = 1, which has to be 0 */
  double spread; /* normal traction on the left face at X2 = 0 less that at X2 = 1, which has to be 0 */
  double scale;  /* sigma12 at X2 = 1 */
} Gap;

static inline Gap ComputeGap(const LamWall *wall, double k)
{
  const double a = ShearFlow(wall, GAP_PSI, k), f = ShearProfile(wall, GAP_PSI, a, 0.0, 1.0);
  const double p0 = ShearPressure(wall, GAP_PSI, 0.0, 0.0), p1 = ShearPressure(wall, GAP_PSI, k, -a * f);

  return (Gap){.ratio = (wall->C1 + wall->C2) / (wall->C4 * k * k),
               .gap = 1.0 - f / k,
               .shear = InterfaceShear(wall, GAP_PSI, k),
               .spread = InterfaceNormal(wall, GAP_PSI, 0.0, p0) - InterfaceNormal(wall, GAP_PSI, k, p1),
               .scale = a};
}

#define FACE_ELEMENTS 16
#define FACE_NODES (2 * FACE_ELEMENTS + 1)

/*
  Square walls with the shears of the gap, moved at the ends and on their outer sides, whose inner faces are free: no
  traction, g = 0. Gaps along X1 at equal current heights, over k. Where all are positive the walls do not meet, and
  this is what unilateral contact gives.
*/
typedef struct {
  double computed[FACE_NODES];
  double sheared[FACE_NODES]; /* of the generalised shears, not free of tractions */
  double power[FACE_NODES];   /* X2 - (3/4) X2^(4/3) */
} FreeFaces;

/* Displacements x1 - X1 of the free face and its current heights. */
typedef struct {
  double u[FACE_NODES], height[FACE_NODES];
} Face;

static inline PetscErrorCode FreeFace(const LamWall *wall, double a, double b, Face *face)
{
  StripProblem problem = {.wall = *wall,
                          .psi = GAP_PSI,
                          .a = a,
                          .b = b,
                          .length = 1.0,
                          .columns = FACE_ELEMENTS,
                          .rows = FACE_ELEMENTS,
                          .free_face = PETSC_TRUE};
  PetscInt iterations;
  Strip strip;

  PetscFunctionBeginUser;
  PetscCall(StripCreate(&problem, &strip));
  PetscCall(StripSolve(&strip, &iterations));
  for (PetscInt j = 0; j < FACE_NODES; j++) {
    const PetscInt node = (j + 1) * FACE_NODES - 1;

    face->u[j] = strip.blocks.x[node][0] - strip.blocks.X[node][0];
    face->height[j] = strip.blocks.x[node][1];
  }
  PetscCall(StripDestroy(&strip));
  PetscFunctionReturn(0);
}

/* Displacement at a height, linear between nodes. */
static inline double FaceAt(const Face *face, double height)
{
  int j = 1;

  while (j < FACE_NODES - 1 && face->height[j] < height) j++;
  return face->u[j] -
         (face->height[j] - height) * (face->u[j] - face->u[j - 1]) / (face->height[j] - face->height[j - 1]);
}

/* The right wall, whose free face is on its left, is solved turned by 180 degrees, which changes no shear. */
static inline PetscErrorCode ComputeFreeFaces(const LamWall *wall, double k, FreeFaces *faces)
{
  const double tau = ShearFlow(wall, GAP_PSI, k);
  Face left = {{0}, {0}}, right = {{0}, {0}};

  PetscFunctionBeginUser;
  PetscCall(FreeFace(wall, tau, 0.0, &left));
  PetscCall(FreeFace(wall, 0.0, tau, &right));
  for (int j = 0; j < FACE_NODES; j++) {
    const double height = j / (FACE_NODES - 1.0);

    faces->computed[j] = 1.0 - (FaceAt(&right, 1.0 - height) + FaceAt(&left, height)) / k;
    faces->sheared[j] = height - ShearProfile(wall, GAP_PSI, tau, 0.0, height) / k;
    faces->power[j] = height - 0.75 * pow(height, 4.0 / 3.0);
  }
  PetscFunctionReturn(0);
}

#endif
