/*
  Fast tier of prescribed stress: the Newton iterations of newton.c and contact_newton.c with free components of F.

  Method. The initial guess is the previous state, rotated and moved affinely to the guess of F. Contact tissue without
  a near state, or for which that fails, uses the two_step strategy if it is selected: the bonded tissue is solved under
  the same control, then released to contact with F still free.
*/
#include "mixed.h"
#include "contact_path.h"

#define PATIENCE 3 /* iterations after release in which long steps freeze F */

static PetscErrorCode TryBonded(LamRVE rve, LamBorder *border, LamRVEState state, PetscBool *solved)
{
  LamNewtonOutcome outcome;
  LamRVEState turned;
  PetscInt negative;

  PetscFunctionBeginUser;
  *solved = PETSC_FALSE;
  PetscCall(LamTurnedState(rve, state, &border->load, &turned));
  LamMoveAffinely(rve, turned->y, &turned->load, &border->load);
  PetscCall(LamRVEStateDestroy(&turned));
  PetscCall(LamNewtonFast(rve, &border->load, border, &outcome));
  if (outcome != LAM_NEWTON_CONVERGED) PetscFunctionReturn(0);
  PetscCall(LamFactorConsistent(rve, &border->load, &negative, solved));
  if (negative > 0) *solved = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Solves contact from the previous state. */
static PetscErrorCode TryNear(LamRVE rve, LamBorder *border, LamRVEState state, LamContactOutcome *out)
{
  LamRVEState before;

  PetscFunctionBeginUser;
  PetscCall(LamTurnedState(rve, state, &border->load, &before));
  LamContactStartNear(rve, before, &border->load);
  PetscCall(LamContactTryMixed(rve, border, LAM_NEAR_REACH, out));
  PetscCall(LamRVEStateDestroy(&before));
  PetscFunctionReturn(0);
}

/* Solves contact from the bonded tissue under the same control, whose F is a better guess even if contact fails. */
static PetscErrorCode TryRelease(LamRVE rve, LamBorder *border, const LamStressControl *control, LamRVEState state,
                                 LamContactOutcome *out)
{
  LamResponse response;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(state->bonded, rve->bonded_state));
  PetscCall(LamRVESolveMixed(rve->bonded, &border->load, control, rve->bonded_state, &response));
  LamAddWork(rve, &response);
  if (response.status != LAM_CONVERGED) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(border->load.F, response.load.F, 9));
  PetscCall(PetscArraycpy(rve->bonded->y, rve->bonded_state->y, rve->bonded->length));
  PetscCall(LamContactStartBonded(rve, &border->load, &ok));
  border->patience = PATIENCE;
  if (ok) PetscCall(LamContactTryMixed(rve, border, LAM_NEAR_REACH, out));
  PetscFunctionReturn(0);
}

static PetscErrorCode TryContact(LamRVE rve, LamBorder *border, LamLoad *load, const LamStressControl *control,
                                 LamRVEState state, LamResponse *response, PetscBool *solved)
{
  LamContactOutcome out = {0};

  PetscFunctionBeginUser;
  if (state->solved && LamContactIsNear(&state->load, load)) PetscCall(TryNear(rve, border, state, &out));
  if (!LamContactIsStable(&out) && rve->strategy == LAM_TWO_STEP && !rve->work.stopped) {
    border->load = *load;
    PetscCall(TryRelease(rve, border, control, state, &out));
    if (LamContactIsStable(&out)) PetscCall(LamRVEStateCopy(rve->bonded_state, state->bonded));
    PetscCall(PetscArraycpy(load->F, rve->bonded_state->load.F, 9));
  }
  LamContactSettle(&out);
  *solved = LamContactIsStable(&out);
  if (out.refusal != LAM_NOT_REFUSED) PetscCall(LamContactRefuse(rve, &out, response));
  response->max_penetration = *solved ? PetscMax(0.0, out.depth) : NAN;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMixedFast(LamRVE rve, LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response)
{
  LamBorder *border;
  PetscBool solved;

  PetscFunctionBeginUser;
  PetscCall(LamBeginResponse(rve, load, state, response));
  PetscCall(LamBorderCreate(rve, load, control, &border));
  if (rve->contact)
    PetscCall(TryContact(rve, border, load, control, state, response, &solved));
  else
    PetscCall(TryBonded(rve, border, state, &solved));
  if (solved) {
    response->load = border->load;
    response->status = LAM_CONVERGED;
    response->branch = state->branch;
  }
  PetscCall(LamEndResponse(rve, &border->load, state, response));
  PetscCall(LamBorderDestroy(&border));
  PetscFunctionReturn(0);
}
