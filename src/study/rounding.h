/*
  A priori estimate of the digits left by rounding (docs/theory/homogenisation.md, Rounding). P keeps all but two or
  three digits for all walls. The tangent, and with it stability and the convergence of a body, loses digits by the
  ratio of bulk modulus to matrix stiffness, the more the thinner the elements.
*/
#ifndef LAM_ROUNDING_H
#define LAM_ROUNDING_H

#include "study.h"

/* Upper bound of the tangent's relative rounding error on the mesh in micro; the largest one if cells differ. */
PetscReal LamTangentRounding(const LamMicrostructure *micro);
/* One sentence if the rounding error exceeds `accuracy`: how many digits are left and what to change; else empty. */
PetscErrorCode LamDigitsWarning(const LamMicrostructure *micro, PetscReal accuracy, char text[], size_t length);
/* Reports the same as a warning on rank 0. */
PetscErrorCode LamWarnOfDigits(MPI_Comm comm, const LamReporter *reporter, const LamMicrostructure *micro,
                               PetscReal accuracy);

#endif
