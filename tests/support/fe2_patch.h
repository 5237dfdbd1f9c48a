/*
  FE2 against a direct patch of n x n cells between grips: what the tests assert and the bench program prints.

  Matching. A block of n x n cells that stand on a corner has rows of height sqrt(3) a and columns of width 2 a. Its
  outer walls are zigzags around the sides of a box of 2 n a x sqrt(3) n a, whose area is n^2 V0: that box is the body
  of FE2, with bottom and top where the zigzags of the grips have their mean. The box has the same shape for all n and
  FE2 knows no length, so that one FE2 solution stands against all n. Grips move as x = F X in both; the force on the
  top over its width is the mean P_i2 of the box, and of the patch as docs/theory/walls.md, Patches between grips, has
  it. Lateral sides: free (the walls of the patch bear turgor from inside and nothing from outside, so that fluid and
  walls together carry no traction, as the free side of FE2); or affine, where F is the same everywhere and FE2 is one
  RVE. In both the walls are meshed alike, turgor acts first, with the grips at rest, and then F grows in equal steps.

  Stresses in MPa.
*/
#ifndef LAM_SUPPORT_FE2_PATCH_H
#define LAM_SUPPORT_FE2_PATCH_H

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <petsctime.h>
#include "tissue.h"

#define SCALES_STEPS_MAX 4
/* A block and the way that its grips go: simple shear, or apart with F22. */
typedef struct {
  const char *name;
  LamInterfaceLawType interface;
  LamPatchSides sides;
  double turgor, cohesion; /* MPa */
  double shear, stretch;   /* at the end: F12 and F22 - 1, one of them 0 */
  int largest;             /* block that is solved: larger ones that buckle do not find their pattern in minutes */
} ScalesCase;

/* In the order of the list. */
enum {
  SCALES_BONDED_FREE_SHEARED,
  SCALES_BONDED_FREE_PULLED,
  SCALES_BONDED_FREE_PRESSED,
  SCALES_CONTACT_FREE_SHEARED,
  SCALES_CONTACT_FREE_PULLED,
  SCALES_CONTACT_FREE_PRESSED,
  SCALES_CONTACT_AFFINE_SHEARED,
  SCALES_CONTACT_AFFINE_PULLED,
  SCALES_CONTACT_AFFINE_PRESSED,
  SCALES_CASES
};

static const ScalesCase scales_cases[SCALES_CASES] = {
    {"bonded, free, sheared", LAM_INTERFACE_BONDED, LAM_SIDES_FREE, 0.02, 0, 0.1, 0, 16},
    {"bonded, free, pulled", LAM_INTERFACE_BONDED, LAM_SIDES_FREE, 0.02, 0, 0, 0.1, 16},
    {"bonded, free, pressed", LAM_INTERFACE_BONDED, LAM_SIDES_FREE, 0.02, 0, 0, -0.05, 16},
    {"contact, free, sheared", LAM_INTERFACE_CONTACT, LAM_SIDES_FREE, 0.01, 0.02, 0.1, 0, 16},
    {"contact, free, pulled", LAM_INTERFACE_CONTACT, LAM_SIDES_FREE, 0.01, 0.02, 0, 0.1, 16},
    {"contact, free, pressed", LAM_INTERFACE_CONTACT, LAM_SIDES_FREE, 0.01, 0.02, 0, -0.04, 16},
    {"contact, affine, sheared", LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE, 0.02, 0.005, 0.2, 0, 16},
    {"contact, affine, pulled", LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE, 0.02, 0.005, 0, 0.1, 16},
    {"contact, affine, pressed", LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE, 0.02, 0.005, 0, -0.05, 8},
};

/* Values at the steps 1..steps; as far as they go where a run ends early. */
typedef struct {
  int steps;
  double stress[SCALES_STEPS_MAX];   /* P12 in shear, else P22 */
  double opening[SCALES_STEPS_MAX];  /* gaps over the volume of the block */
  double debonded[SCALES_STEPS_MAX]; /* share of the interface that carries no contact */
  double seconds;
} ScalesCurve;

/* n x n cells, as one block or as the period of tissue under one F. */
PetscErrorCode ScalesSolveCells(const ScalesCase *c, PetscInt n, PetscBool is_patch, int steps, ScalesCurve *curve);
PetscErrorCode ScalesSolveBody(const ScalesCase *c, int elements, int steps, ScalesCurve *curve);

/*
  FE2 on infinitely fine meshes, from `elements` and twice as many. Where a held side meets a free one F is singular,
  and the reaction has an error of h^2q there, q the exponent of the displacement; 2q = 4/3 fits what meshes of 2, 4 and
  8 elements give (1.3 to 1.4). Opening and debonded share are those of the finer mesh: switches of contact at material
  points change them by as much as the mesh does.
*/
ScalesCurve ScalesBodyLimit(const ScalesCurve *elements, const ScalesCurve *twice);
/* What the block tends to: the body, from meshes of `elements` and 2 `elements`; or, where F is the same everywhere,
   tissue with a period of 2 x 2 cells, which may buckle in a pattern of two. Without steps where a mesh has none. */
PetscErrorCode ScalesSolveLimit(const ScalesCase *c, int elements, int steps, ScalesCurve *limit);

/* ---- differences ---- */

/* Largest difference along two curves of the same steps, over the largest value of the second. */
double ScalesDifference(int steps, const double values[], const double reference[]);
/* The limit of curves of n and 2 n cells whose difference from it is proportional to 1/n. */
ScalesCurve ScalesExtrapolated(const ScalesCurve *n, const ScalesCurve *twice);

#endif
