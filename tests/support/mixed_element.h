/*
  Bodies on a row of meshes, for the order of the macroscale elements, mixed and not.

  Cook's membrane has corners that limit the order. The smooth problem has an exact solution of small strains on the
  unit square, which all its sides are given: u = a (x^3 - 3 x y^2, y^3 - 3 x^2 y), in balance with any isotropic
  moduli, and where `gradient` is set a (y^3, x^3) besides, in which the turgor of incompressible tissue changes by 6 a
  mu x y / v.
*/
#ifndef LAM_SUPPORT_MIXED_ELEMENT_H
#define LAM_SUPPORT_MIXED_ELEMENT_H

#include <lamella/rve.h>
#include "gmsh_writer.h"
#include "macro_impl.h"
#include "synthetic_responder.h"

typedef enum { PROBLEM_COOK, PROBLEM_SMOOTH } ProblemKind;

typedef struct {
  ProblemKind kind;
  PetscInt n; /* elements along each side; twice as many triangles in all */
  GmshElements elements;
  PetscReal amplitude; /* Cook: lift of the right side, of 48; smooth: a */
  PetscBool gradient;
  const LamScene *scene;        /* turgor, and whether it is sealed and by what; its mesh is not used */
  LamRVE rve;                   /* NULL: the synthetic material ... */
  PetscReal mu, lambda, phi, c; /* ... with these */
} Problem;

typedef struct {
  PetscReal strain; /* smooth: relative error of the displacement gradient, L2 */
  PetscReal turgor; /* with `gradient`: relative error of the turgor but for a constant, L2 */
  PetscReal energy; /* of the body */
  PetscReal force;  /* on the right side, upwards */
  PetscReal residuals[32];
  PetscInt residual_count; /* 0: no solution */
} ProblemResult;

/* One series of Newton iterations from the undeformed body under its turgor. */
PetscErrorCode ProblemSolve(const Problem *problem, ProblemResult *result);
/* Order of convergence of a quantity on three meshes, each half as fine as the next. */
PetscReal OrderOf(const PetscReal value[3]);

#endif
