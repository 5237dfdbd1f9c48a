/* Tissue without any feature: bonded cells that are all alike, empty lumens. Newton iterations on wall elements, the
   matrix of the converged state factored for its negative eigenvalues, and the stress P; nothing is asked of contact,
   cohesion, turgor, sealed lumens, cells that differ, tangents or indicators. The step is that of the RVE solver, so
   that the two can be held against each other. */
#ifndef LAM_SUPPORT_BARE_TISSUE_H
#define LAM_SUPPORT_BARE_TISSUE_H

#include "solve.h"
#include "tissue.h"

PetscErrorCode BareCreate(const LamMicrostructure *micro, LamRVE *out);
PetscErrorCode BareDestroy(LamRVE *rve);
/* From F = I; of the response status, P and the counts of work are filled. */
PetscErrorCode BareSolve(LamRVE rve, const LamLoad *load, LamResponse *response);

#endif
