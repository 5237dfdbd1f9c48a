/* Buckling of tissue under biaxial compression F = (1 - e) 1, and of rows of cells along any ramp: what the test
   asserts and the bench program prints. The affine start has all symmetries of the cell and plain Newton steps keep
   them, so the symmetric solution is found also where it is unstable; the inertia of its tangent tells which side of
   the onset it is on. */
#ifndef LAM_SUPPORT_BUCKLING_H
#define LAM_SUPPORT_BUCKLING_H

#include "tissue.h"
#include "solve.h"

/* Full Newton steps, without inertia correction, from the affine state; rve->y becomes the symmetric solution. */
PetscErrorCode SolveSymmetric(LamRVE rve, const LamLoad *load, PetscBool *ok);
/* Energy per volume of the symmetric solution and its number of negative eigenvalues; -1: not found. */
PetscErrorCode SymmetricSolution(LamRVE rve, double e, double turgor, double *energy, PetscInt *negative);
/* Narrows [low, high] around the strain where the symmetric solution loses stability, until it is `width` wide. */
PetscErrorCode BucklingOnset(LamRVE rve, double turgor, double width, double *low, double *high);

#endif
