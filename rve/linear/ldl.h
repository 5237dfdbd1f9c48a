/*
  Factorisation P K P^T = L D L^T of a symmetric matrix whose sparsity pattern does not change, without pivoting: all
  index work is done once, and unknowns are taken in pairs. K has as many negative eigenvalues as the diagonal matrix D
  (Sylvester).
*/
#ifndef LAM_LDL_H
#define LAM_LDL_H

#include <petscsys.h>

typedef struct LamLDL_s *LamLDL;

/* Upper triangle in compressed rows, the diagonal first: row [n+1], column and values [row[n]]; borrowed. The unknowns
   before `positions`, an even number, are eliminated first. Those after them may have a zero on the diagonal; all
   positions that are coupled with the same one of these are coupled with each other. *ldl is NULL if the factor would
   be so large that MUMPS is as fast. */
PetscErrorCode LamLDLCreate(PetscInt n, PetscInt positions, const PetscInt row[], const PetscInt column[],
                            const PetscReal values[], LamLDL *ldl);
/* Factors the present values. *ok is PETSC_FALSE, and there is no factor, if more than `most` eigenvalues are negative
   (*negative is then a lower bound), if a pivot is singular, or if the factors are so large that rounding spoils them
   (*unsure). */
PetscErrorCode LamLDLNumeric(LamLDL ldl, PetscInt most, PetscInt *negative, PetscBool *ok, PetscBool *unsure);
/* solution = K^-1 rhs, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamLDLSolve(LamLDL ldl, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
PetscErrorCode LamLDLDestroy(LamLDL *ldl);

#endif
