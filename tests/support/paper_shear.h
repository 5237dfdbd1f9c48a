/* Prescribed generalised shear: the wall-law kernels and the element against the closed forms of shear_exact.h, at
   random moduli, fibre angles and shears. Errors are relative to 1 + the largest stress. */
#ifndef LAM_SUPPORT_PAPER_SHEAR_H
#define LAM_SUPPORT_PAPER_SHEAR_H

#include <string.h>
#include "displaced.h"
#include "random_reals.h"
#include "shear_exact.h"

#define SHEAR_STATES 200
typedef struct {
  LamWall wall;
  double psi, s;
} ShearState;

ShearState RandomShear(uint64_t *seed);
/* First Piola-Kirchhoff stress of the kernels, 11 12 21 22 33. */
PetscErrorCode KernelStress(const ShearState *state, double P[5]);
/* Largest errors over the random states. */
typedef struct {
  double nominal, cauchy;    /* stresses of the kernels */
  double traction;           /* Cauchy, on a plane of random normal and on X1 = const */
  double force;              /* nodal forces of an element */
  double stretch, principal; /* of fibres, and of the largest Cauchy stress, at its Gauss points */
} ShearErrors;

/* Tractions from the kernels' nominal stress, divided by the change of area, against the closed forms. */
double TractionError(const ShearState *state, const double P[5], double angle);
PetscErrorCode ComputeShearErrors(ShearErrors *errors);

#endif
