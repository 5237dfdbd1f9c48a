/*
  The microstructure at selected states of a process, for figures: solved again, each from the previous one.
*/
#include "process_run.h"
#include "rve_fields.h"

/* The first and the last state, all events, and `frames` evenly spaced states. */
static PetscBool IsChosen(const LamProcessStudy *study, PetscInt k, PetscInt frames)
{
  const PetscInt n = study->history.count;

  if (k == 0 || k == n - 1 || study->history.states[k].event != LAM_EVENT_COUNT) return PETSC_TRUE;
  return (PetscBool)(frames > 1 && k * (frames - 1) / (n - 1) != (k - 1) * (frames - 1) / (n - 1));
}

static PetscErrorCode TellModuli(LamProcessStudy *study, const LamProcessState *state)
{
  PetscReal ratio[LAM_WALL_PARAMETER_COUNT];

  PetscFunctionBeginUser;
  if (LamProcessWallsStayAlike(study->scene)) PetscFunctionReturn(0);
  (void)LamWallRatios(&study->scene->micro.wall, &state->factor[LAM_CHANGING_OF_PARAMETER(0)], ratio);
  PetscCall(LamFE2ChangeTissueWalls(study->response.tissues.tissues, ratio));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFrame(LamProcessStudy *study, LamRVE rve, LamRVEState at, PetscInt k)
{
  const LamProcessState *state = &study->history.states[k];
  LamScales scales = study->scene->scales;
  LamLoad load = state->response.load;
  char group[LAM_NAME_LENGTH];
  LamResponse response;

  PetscFunctionBeginUser;
  load.turgor /= state->walls;
  load.cohesion /= state->walls;
  scales.stress *= state->walls;
  PetscCall(TellModuli(study, state));
  PetscCall(LamRVESolve(rve, &load, at, &response));
  if (!LamResponseHasFields(&response)) {
    LamReportNote(&study->response.reporter, "the cells of state %d are not kept: solved once more it is %s: %s",
                  (int)k, LamStatusNames[response.status], response.reason);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscSNPrintf(group, sizeof(group), "/fields/%" PetscInt_FMT, k));
  PetscCall(LamRVEWriteFields(study->writer, group, rve, at, &scales));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessFrames(LamProcessStudy *study, PetscInt frames)
{
  LamRVE own = NULL, rve = study->response.tissues.tissues->rve;
  LamRVEState state;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  if (!study->writer || !study->history.count) PetscFunctionReturn(0);
  if (!rve) {
    PetscCall(LamRVECreate(PETSC_COMM_SELF, &own));
    PetscCall(LamRVESetMicrostructure(own, &study->scene->micro));
    PetscCall(LamRVESetUp(own));
    PetscCall(LamRVESetInterrupt(own, LamStopInterrupt, NULL));
    rve = own;
  }
  PetscCall(LamRVESetWanted(rve, LAM_WANT_STRESS));
  PetscCall(LamRVEStateCreate(rve, &state));
  ierr = LamRVEWriteMesh(study->writer, "/mesh", rve);
  for (PetscInt k = 0; k < study->history.count && !ierr && !LamStopRequested(); k++)
    if (IsChosen(study, k, frames)) ierr = WriteFrame(study, rve, state, k);
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&own));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
