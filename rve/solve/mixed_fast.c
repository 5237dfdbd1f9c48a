/*
  Fast tier of prescribed stress: the iterations of newton.c and contact_find.c with free components of F.

  Method. The initial guess is the previous state, rotated and moved affinely to the guess of F.
*/
#include "mixed.h"
#include "contact_find.h"

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

static PetscErrorCode TryContact(LamRVE rve, LamBorder *border, LamRVEState state, PetscBool *solved)
{
  LamContactOutcome out;
  LamRVEState before;

  PetscFunctionBeginUser;
  PetscCall(LamTurnedState(rve, state, &border->load, &before));
  PetscCall(LamContactFind(rve, NULL, border, before, &out));
  PetscCall(LamRVEStateDestroy(&before));
  *solved = LamContactIsStable(&out);
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
    PetscCall(TryContact(rve, border, state, &solved));
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
