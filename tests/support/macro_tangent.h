/* The tangent of the macroscale solver against differences of its residual. */
#ifndef LAM_SUPPORT_MACRO_TANGENT_H
#define LAM_SUPPORT_MACRO_TANGENT_H

#include "macro_fixture.h"

/* Bordered residual and tangent at a random state, displacements up to `size`, against central differences, q of the
   borders included. */
void CheckTangent(Fixture *fixture, PetscReal size);

#endif
