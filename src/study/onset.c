/*
  The onset of separation along the states of a scene.

  Method. While the states are solved, the last one that is not separated is kept, on both meshes, until one is
  separated. The load between the two, linear in F, turgor and cohesion, is then bisected. Each intermediate load is
  solved from the nearest lower state that is not separated, because contact is lost more easily than it is found again.
*/
#include "onset.h"

const char *const LamOnsetStatusNames[] = {LAM_ONSET_STATUSES(LAM_NAME_ENTRY)};

/* Width of the bracket, as a fraction of the step between two states. */
#define RESOLUTION 1e-3

PetscErrorCode LamOnsetCreate(const LamMeshes *meshes, LamOnset *onset)
{
  PetscFunctionBeginUser;
  *onset = (LamOnset){.status = LAM_ONSET_NOT_MET, .bracket = {0, 1}};
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateCreate(meshes->rve[m], &onset->closed[m]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamOnsetDestroy(LamOnset *onset)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateDestroy(&onset->closed[m]));
  PetscFunctionReturn(0);
}

/* The present states are not separated: the onset lies after them. */
static PetscErrorCode KeepClosed(LamOnset *onset, const LamMeshes *meshes)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateCopy(meshes->state[m], onset->closed[m]));
  PetscFunctionReturn(0);
}

static void KeepSeparated(LamOnset *onset, const LamResponse responses[2], LamSeparation separation)
{
  onset->load = responses[0].load;
  onset->criterion = separation;
  for (PetscInt m = 0; m < 2; m++) onset->responses[m] = responses[m];
}

/* `where`: the load that did not converge. */
static PetscErrorCode KeepReason(LamOnset *onset, const char where[], const LamResponse responses[2])
{
  const PetscInt m = LamResponseHasFields(&responses[0]) ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(onset->reason, sizeof(onset->reason), "%s has no response on the %s mesh: %s", where,
                          m ? "second" : "first", responses[m].reason));
  PetscFunctionReturn(0);
}

/* Keeps the first state that did not converge. */
static PetscErrorCode KeepUnknown(LamOnset *onset, PetscInt number, const LamResponse responses[2])
{
  char where[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  if (onset->status == LAM_ONSET_UNKNOWN) PetscFunctionReturn(0);
  onset->status = LAM_ONSET_UNKNOWN;
  PetscCall(PetscSNPrintf(where, sizeof(where), "state %" PetscInt_FMT, number));
  PetscCall(KeepReason(onset, where, responses));
  PetscFunctionReturn(0);
}

PetscErrorCode LamOnsetWatch(LamOnset *onset, const LamMeshes *meshes, PetscInt number, const LamResponse responses[2])
{
  const LamSeparation separation = LamSeparationOf(responses);

  PetscFunctionBeginUser;
  onset->last = number;
  if (onset->states[1]) PetscFunctionReturn(0);
  if (separation == LAM_SEPARATION_UNKNOWN) {
    PetscCall(KeepUnknown(onset, number, responses));
    PetscFunctionReturn(0);
  }
  if (separation == LAM_SEPARATION_NONE) {
    onset->states[0] = number;
    onset->ends[0] = responses[0].load;
    PetscCall(KeepClosed(onset, meshes));
    PetscFunctionReturn(0);
  }
  onset->states[1] = number;
  onset->ends[1] = responses[0].load;
  onset->status = onset->states[0] ? LAM_ONSET_FOUND : LAM_ONSET_BEFORE_FIRST;
  if (onset->status == LAM_ONSET_FOUND) onset->reason[0] = '\0'; /* states that did not converge are ignored */
  KeepSeparated(onset, responses, separation);
  PetscFunctionReturn(0);
}

/* Solves in the middle of the bracket and halves it; a load that does not converge ends the search. */
static PetscErrorCode Halve(LamOnset *onset, LamMeshes *meshes)
{
  const PetscReal middle = 0.5 * (onset->bracket[0] + onset->bracket[1]);
  const LamLoad load = LamLoadBetween(&onset->ends[0], &onset->ends[1], middle);
  LamSeparation separation;
  LamResponse responses[2];

  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateCopy(onset->closed[m], meshes->state[m]));
  PetscCall(LamMeshesSolve(meshes, &load, NULL, responses));
  if (meshes->stopped) {
    onset->status = LAM_ONSET_STOPPED;
    PetscCall(PetscStrncpy(onset->reason, "stopped by a signal", sizeof(onset->reason)));
    PetscFunctionReturn(0);
  }
  separation = LamSeparationOf(responses);
  if (separation == LAM_SEPARATION_UNKNOWN) {
    onset->status = LAM_ONSET_NOT_CONVERGED;
    PetscCall(KeepReason(onset, "a load in between", responses));
  } else if (separation == LAM_SEPARATION_NONE) {
    onset->bracket[0] = middle;
    PetscCall(KeepClosed(onset, meshes));
  } else {
    onset->bracket[1] = middle;
    KeepSeparated(onset, responses, separation);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamOnsetFind(LamOnset *onset, LamMeshes *meshes, PetscInt count)
{
  PetscFunctionBeginUser;
  if (onset->status == LAM_ONSET_NOT_MET && onset->last < count) {
    onset->status = LAM_ONSET_UNKNOWN;
    PetscCall(PetscSNPrintf(onset->reason, sizeof(onset->reason), "stopped by a signal before state %" PetscInt_FMT,
                            onset->last + 1));
  }
  while (onset->status == LAM_ONSET_FOUND && onset->bracket[1] - onset->bracket[0] > RESOLUTION)
    PetscCall(Halve(onset, meshes));
  PetscFunctionReturn(0);
}

PetscBool LamOnsetIsUnsolved(const LamOnset *onset)
{
  return (PetscBool)(onset->reason[0] != '\0');
}
