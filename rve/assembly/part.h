/*
  A part of the cells in which a solve is restricted: cells around some seeds move, all others are held or moved by the
  caller. While it is in use, sums over elements, edges of the lamella and walls are those of the part: exact for the
  energy but for a constant, and for the residual and the matrix in the rows of what moves; other rows are undefined.

  The matrix of what moves has a factor of its own, on this rank. Not for sealed tissue, nor with suction.
*/
#ifndef LAM_RVE_PART_H
#define LAM_RVE_PART_H

#include "rve_impl.h"

typedef struct LamPartSystem_s *LamPartSystem;

/* Cells within `layers` cells of a seed move; seed [cell]. */
PetscErrorCode LamPartCreate(LamRVE rve, const PetscBool seed[], PetscInt layers, LamPart **part);
PetscErrorCode LamPartDestroy(LamPart **part);
/* Restricts sums to a part; NULL: to none. */
void LamPartUse(LamRVE rve, const LamPart *part);
/* Zeroes residual and linear.values in the rows that are summed. */
PetscErrorCode LamPartClear(LamRVE rve, PetscReal residual[]);

/* Unknowns that move, increasing: *unknown [*count], owned by the system. */
PetscErrorCode LamPartSystemCreate(LamRVE rve, const LamPart *part, LamPartSystem *system);
PetscErrorCode LamPartSystemDestroy(LamPartSystem *system);
PetscInt LamPartSystemUnknowns(const LamPartSystem system, const PetscInt **unknown);
/* Factors the part's matrix + shift 1. */
PetscErrorCode LamPartSystemFactor(LamRVE rve, LamPartSystem system, PetscReal shift, PetscInt *negative,
                                   PetscBool *ok);
PetscErrorCode LamPartSystemSolve(LamPartSystem system, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
/* image [count] := (K x) in the rows of what moves; x [n] is zero outside the cells that are summed. */
void LamPartSystemMultiply(LamRVE rve, const LamPartSystem system, const PetscReal x[], PetscReal image[]);

#endif
