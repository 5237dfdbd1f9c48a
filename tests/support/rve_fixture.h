/* What tests of the RVE share: solving the tissue of tissue.h from the reference state. */
#ifndef LAM_SUPPORT_RVE_FIXTURE_H
#define LAM_SUPPORT_RVE_FIXTURE_H

#include "test.h"
#include "tissue.h"

LamRVE NewRVE(const LamMicrostructure *micro);
/* Solves from F = I in one go. */
LamResponse SolveFromReference(LamRVE rve, LamLoad load);
LamResponse SolveTissue(const LamMicrostructure *micro, LamLoad load);

#endif
