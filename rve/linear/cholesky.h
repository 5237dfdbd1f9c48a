/*
  Small systems that should be positive definite: PETSc's own Cholesky factorisation, which does not pivot. Without
  MUMPS' bookkeeping it takes half the time up to some thousand unknowns, and a solve a tenth
  (docs/results/performance.md).
*/
#ifndef LAM_CHOLESKY_H
#define LAM_CHOLESKY_H

#include <petscsys.h>

#define LAM_CHOLESKY_LARGEST 3000 /* unknowns; beyond, MUMPS is faster */

typedef struct LamCholesky_s *LamCholesky;

/* As LamFactorCreate, on this process alone. */
PetscErrorCode LamCholeskyCreate(PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                                 LamCholesky *cholesky);
/* *definite is PETSC_FALSE where the matrix is not positive definite: then there is no factor. */
PetscErrorCode LamCholeskyNumeric(LamCholesky cholesky, PetscBool *definite);
PetscErrorCode LamCholeskySolve(LamCholesky cholesky, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
PetscErrorCode LamCholeskyDestroy(LamCholesky *cholesky);

#endif
