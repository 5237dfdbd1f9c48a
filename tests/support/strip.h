/*
  A strip of wall, 0 <= X2 <= 1, in shear under a pressure that rises along it: the boundary-value problem whose exact
  solution is the generalised shear of shear_exact.h with sigma12 = a X2 + b.

  Held at X2 = 0; X2 = 1 stays at its height and is moved by f(1), or pulled by the shear traction a + b. In X1 the
  strip repeats with the period `length`, but the pressure rises by a `length` from one period to the next: the right
  side is pressed by that much (Cauchy, follower) more than the left one. Or, another problem, the left side is moved by
  f(X2) and the right one is a free face. Displacements are a prolongation of the free components.
*/
#ifndef LAM_SUPPORT_STRIP_H
#define LAM_SUPPORT_STRIP_H

#include "blocks.h"
#include "shear_exact.h"

typedef struct {
  LamWall wall;
  double psi, a, b;
  double length;
  PetscInt columns, rows;
  PetscBool pulled;    /* by a traction at X2 = 1, else moved by f(1) */
  PetscBool free_face; /* on the right, with the left side moved by f(X2); else periodic */
} StripProblem;

typedef struct {
  const StripProblem *problem;
  Blocks blocks;
  PetscInt size, *map; /* number of free components; [2 node + component] which one, -1: held */
  Mat prolongation;
} Strip;

/* `problem` is borrowed. */
PetscErrorCode StripCreate(StripProblem *problem, Strip *strip);
PetscErrorCode StripDestroy(Strip *strip);
/* Newton's method down to a few times the rounding error of the residual; an error where it does not
   converge. */
PetscErrorCode StripSolve(Strip *strip, PetscInt *iterations);

/* Errors against generalised shear. Root mean squares over the strip, of stresses over the largest sigma12. */
typedef struct {
  double displacement, gradient; /* x1 - X1 against f(X2); F12 against f'(X2) */
  double nodal;                  /* largest error of x1 at a node */
  double lateral;                /* x2 - X2, which is zero */
  double shear, normal;          /* P12 = sigma12; P22 = sigma22, whose mean is free */
  PetscInt iterations;
} StripErrors;

/* Default tissue, C1 : C2 : C4 = 10 : 1 : 100, fibres along X2; sigma12 rises from 0.2 to 1.7, the shear to 0.5. */
StripProblem DefaultStrip(PetscInt rows, double bulk);
PetscErrorCode ComputeStrip(StripProblem problem, StripErrors *errors);

#endif
