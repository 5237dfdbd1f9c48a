/* The tangent of a step from a history. */
#ifndef LAM_SUPPORT_STEP_TANGENT_H
#define LAM_SUPPORT_STEP_TANGENT_H

#include "lamella_tissue.h"

/* All from the specimen's present state: fourth-order differences of the stress against the tangent at a load, to 1e-6,
   and the tangent's symmetry, to 1e-10. */
void CheckStepTangent(Specimen *specimen, const LamLoad *load);

#endif
