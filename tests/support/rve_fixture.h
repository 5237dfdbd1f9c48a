/* What tests of the RVE share: solving the tissue of tissue.h from the reference state. */
#ifndef LAM_SUPPORT_RVE_FIXTURE_H
#define LAM_SUPPORT_RVE_FIXTURE_H

#include "test.h"
#include "contact_tissue.h"

LamRVE NewRVE(const LamMicrostructure *micro);
/* With lumens that may be sealed. */
LamRVE NewSealable(const LamMicrostructure *micro);
LamRVEState NewState(LamRVE rve);
/* Copies a state by its packed bytes. */
void CopyPacked(LamRVEState from, LamRVEState to);
/* Solves from F = I in one go. */
LamResponse SolveFromReference(LamRVE rve, LamLoad load);
LamResponse SolveTissue(const LamMicrostructure *micro, LamLoad load);
/* The default tissue; the same in contact. */
LamResponse SolveDefaultTissue(LamLoad load);
LamResponse SolveContactTissue(LamLoad load);

#endif
