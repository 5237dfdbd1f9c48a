/*
  Digits that rounding leaves, before anything is solved (docs/theory/homogenisation.md, Rounding). P keeps all but two
  or three whatever the walls; the tangent, and with it stability and the convergence of a body, loses what the bulk
  modulus is stiffer than the matrix, the more the thinner the elements.
*/
#ifndef LAM_ROUNDING_H
#define LAM_ROUNDING_H

#include "study.h"

/* Relative error of the tangent that rounding stays below, on the mesh in micro; of uneven cells that of the worst. */
PetscReal LamTangentRounding(const LamMicrostructure *micro);
/* One sentence where that leaves less than `accuracy`: how many digits are left and what to change; else empty. */
PetscErrorCode LamDigitsWarning(const LamMicrostructure *micro, PetscReal accuracy, char text[], size_t length);
/* The same as a warning of rank 0. */
PetscErrorCode LamWarnOfDigits(MPI_Comm comm, const LamReporter *reporter, const LamMicrostructure *micro,
                               PetscReal accuracy);

#endif
