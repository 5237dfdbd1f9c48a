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

#endif
