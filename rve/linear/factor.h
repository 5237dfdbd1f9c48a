/*
  Factorisation of the symmetric indefinite matrices of the RVE by MUMPS LDL^T through PETSc, on one rank or, of large
  systems, with the help of others. Rank 0 holds the matrix and all vectors; the other ranks of the communicator wait in
  LamFactorServe and take part in factorisations and solves until they are dismissed.
*/
#ifndef LAM_RVE_FACTOR_H
#define LAM_RVE_FACTOR_H

#include <petscmat.h>

typedef struct LamFactor_s *LamFactor;

/* Upper triangle in compressed rows: row [n+1], column and values [row[n]] are borrowed. definite: the matrix should be
   positive definite; a small one is then tried without pivots first (cholesky.h). Called by rank 0 alone. */
PetscErrorCode LamFactorCreate(MPI_Comm comm, PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                               PetscBool definite, LamFactor *factor);
/* Of the present values. *ok is PETSC_FALSE where the matrix is singular to working precision; negative: eigenvalues.
 */
PetscErrorCode LamFactorNumeric(LamFactor factor, PetscInt *negative, PetscBool *ok);
/* solution = K^-1 rhs, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamFactorSolve(LamFactor factor, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
PetscErrorCode LamFactorDestroy(LamFactor *factor);

/* On the other ranks: helps until rank 0 calls LamFactorDismiss; `waiting` as for LamRVEServe. */
PetscErrorCode LamFactorServe(MPI_Comm comm, PetscBool (*waiting)(void *ctx), void *ctx);
PetscErrorCode LamFactorDismiss(MPI_Comm comm);

#endif
