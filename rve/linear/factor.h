/*
  Factorisation of the symmetric indefinite matrices of the RVE by MUMPS LDL^T, on one rank or, for large systems, on
  several. Rank 0 holds the matrix and all vectors; the other ranks of the communicator wait in
  LamRVEServe and take part in factorisations and solves until LamRVEDismiss.
*/
#ifndef LAM_RVE_FACTOR_H
#define LAM_RVE_FACTOR_H

#include <petscsys.h>

typedef struct LamFactor_s *LamFactor;

/* Upper triangle in compressed rows: row [n+1], column and values [row[n]] are borrowed. positions: unknowns that come
   first, whose part of the matrix is expected to be positive definite. Small matrices are first tried without pivoting
   (ldl.h). Called on rank 0 only. */
PetscErrorCode LamFactorCreate(MPI_Comm comm, PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                               PetscInt positions, LamFactor *factor);
/* Factors the present values. *ok is PETSC_FALSE if the matrix is singular to working precision. *negative: number of
   negative eigenvalues. */
PetscErrorCode LamFactorNumeric(LamFactor factor, PetscInt *negative, PetscBool *ok);
/* *ok: the present values have `expected` negative eigenvalues, and are factored; otherwise there may be no factor. */
PetscErrorCode LamFactorExpected(LamFactor factor, PetscInt expected, PetscBool *ok);
/* solution = K^-1 rhs, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamFactorSolve(LamFactor factor, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
PetscErrorCode LamFactorDestroy(LamFactor *factor);

#endif
