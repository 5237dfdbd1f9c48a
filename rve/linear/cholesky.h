/*
  Small systems expected to be positive definite: PETSc's own Cholesky factorisation without pivoting. Up to some
  thousand unknowns the factorisation takes half the time of MUMPS, and a solve a tenth (docs/results/performance.md).
*/
#ifndef LAM_CHOLESKY_H
#define LAM_CHOLESKY_H

#include <petscsys.h>

#define LAM_CHOLESKY_LARGEST 3000 /* unknowns; MUMPS is faster beyond */

typedef struct LamCholesky_s *LamCholesky;

/* As LamFactorCreate, on this process only. */
PetscErrorCode LamCholeskyCreate(PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                                 LamCholesky *cholesky);
/* Factors the present values. *definite is PETSC_FALSE if the matrix is not positive definite; there is then no factor.
 */
PetscErrorCode LamCholeskyNumeric(LamCholesky cholesky, PetscBool *definite);
PetscErrorCode LamCholeskySolve(LamCholesky cholesky, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
PetscErrorCode LamCholeskyDestroy(LamCholesky *cholesky);

#endif
