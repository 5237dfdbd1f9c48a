/*
  A process at one material point: its history is sequential and is computed on one rank.

  The result file is of kind "process": records are the responses of the states, with keys from 0; the other quantities
  are in /process (process_states.c). The microstructure at selected states, for figures, is solved again after the end,
  each from the previous one;
  with a history all states are.
*/
#include "process_run.h"
#include "clock.h"
#include "rve_fields.h"

#define COMMIT_SECONDS 5.0

/* ---- responses ---- */

static PetscErrorCode Connect(LamProcessStudy *study, LamResponder *responder)
{
  LamMicrostructure timeless = study->scene->micro;
  LamFE2Run *response = &study->response;
  LamFE2Tissue *tissue;

  PetscFunctionBeginUser;
  timeless.relaxation.terms = 0; /* those of walls that relax follow from a table (relaxing.h) */
  if (response->response != LAM_FE2_DIRECT)
    PetscCall(LamRefuseHistory(study->scene->path, &timeless, "a table", ", or solve directly, without a database"));
  PetscCall(LamFE2TissuesCreateOne(PETSC_COMM_SELF, study->scene, response->database_path, 1, &response->tissues));
  tissue = response->tissues.tissues;
  PetscCall(LamFE2PrepareTissue(response, tissue));
  LamFE2TakeMesh(tissue, study->scene);
  PetscCall(LamFE2ConnectTissue(response, tissue, responder));
  if (!response->stopped && response->response == LAM_FE2_CACHE && response->database_path)
    PetscCall(LamFE2OpenTissueFile(tissue));
  PetscFunctionReturn(0);
}

/* ---- the file ---- */

/* Commits the states that are not in the file yet. status: "done", "stopped", or why it ended; NULL: it goes on. */
static PetscErrorCode Commit(LamProcessStudy *study, const char status[])
{
  const PetscInt n = study->history.count - study->committed;
  PetscErrorCode ierr;
  LamResponse *records;
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterBegin(study->writer));
  if (study->history.count) PetscCall(LamProcessHistoryWrite(study->writer, study->scene, &study->history));
  if (status) PetscCall(LamRecordWriterText(study->writer, "/process/status", status));
  PetscCall(PetscMalloc2(n, &keys, n, &records));
  for (PetscInt k = 0; k < n; k++) {
    keys[k] = study->committed + k;
    records[k] = study->history.states[study->committed + k].response;
  }
  ierr = LamRecordWriterCommit(study->writer, n, keys, records);
  PetscCall(PetscFree2(keys, records));
  PetscCall(ierr);
  study->committed += n;
  study->last_commit = LamClock();
  PetscFunctionReturn(0);
}

/* ---- microstructure ---- */

/* The first and the last state, all events, and study->frames evenly spaced states. */
static PetscBool IsChosen(const LamProcessStudy *study, PetscInt k)
{
  const PetscInt n = study->history.count, frames = study->frames;

  if (k == 0 || k == n - 1 || study->history.states[k].event != LAM_EVENT_COUNT) return PETSC_TRUE;
  return (PetscBool)(frames > 1 && k * (frames - 1) / (n - 1) != (k - 1) * (frames - 1) / (n - 1));
}

static PetscBool HasHistory(const LamProcessStudy *study)
{
  return LamHasHistory(&study->scene->micro);
}

/* From the state before. */
static PetscReal DurationOf(const LamProcessStudy *study, PetscInt k)
{
  const LamProcessState *state = &study->history.states[k];

  return k && HasHistory(study) ? PetscMax(0, state[0].time - state[-1].time) : 0;
}

/* Walls with memory have been for ever where the process begins, F0 in F = F_rel F0 of its first state. */
static PetscErrorCode StartFrames(LamProcessStudy *study, LamRVE rve, LamRVEState at)
{
  const LamProcessState *first = study->history.states;
  const PetscReal *F = first->F, *total = first->response.load.F, det = F[0] * F[4] - F[1] * F[3];
  LamLoad load = first->response.load;
  LamResponse response;

  PetscFunctionBeginUser;
  if (!LamWallsRelax(&study->scene->micro)) PetscFunctionReturn(0);
  load.duration = PETSC_INFINITY;
  load.F[8] = total[8] / F[8];
  for (int j = 0; j < 2; j++) {
    load.F[j] = (F[4] * total[j] - F[1] * total[3 + j]) / det;
    load.F[3 + j] = (F[0] * total[3 + j] - F[3] * total[j]) / det;
  }
  PetscCall(LamRVESolve(rve, &load, at, &response));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFrame(LamProcessStudy *study, LamRVE rve, LamRVEState at, PetscInt k)
{
  const LamProcessState *state = &study->history.states[k];
  LamScales scales = study->scene->scales;
  LamLoad load = state->response.load;
  LamTissueFactors factors;
  const PetscReal unit = LamProcessTissueFactors(study->scene, state->factor, &factors);
  char group[LAM_NAME_LENGTH];
  LamResponse response;

  PetscFunctionBeginUser;
  load.turgor /= unit;
  load.cohesion /= unit;
  load.duration = DurationOf(study, k);
  scales.stress *= unit;
  if (study->scene->micro.interface == LAM_INTERFACE_LAMELLA || !LamProcessWallsStayAlike(study->scene))
    PetscCall(LamFE2ChangeTissue(study->response.tissues.tissues, &factors));
  PetscCall(LamRVESolve(rve, &load, at, &response));
  if (!LamResponseHasFields(&response)) {
    LamReportNote(&study->response.reporter, "the cells of state %d are not kept: solved once more it is %s: %s",
                  (int)k, LamStatusNames[response.status], response.reason);
    PetscFunctionReturn(0);
  }
  if (!IsChosen(study, k)) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(group, sizeof(group), "/fields/%" PetscInt_FMT, k));
  PetscCall(LamRVEWriteFields(study->writer, group, rve, at, &scales));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFrames(LamProcessStudy *study)
{
  LamRVE own = NULL, rve = study->response.tissues.tissues->rve;
  LamRVEState state;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  if (!study->writer || !study->history.count) PetscFunctionReturn(0);
  if (!rve || study->response.tissues.tissues->relaxing) {
    PetscCall(LamSceneRVECreate(PETSC_COMM_SELF, study->scene, &own));
    PetscCall(LamRVESetInterrupt(own, LamStopInterrupt, NULL));
    rve = own;
  }
  PetscCall(LamRVESetWanted(rve, LAM_WANT_STRESS));
  PetscCall(LamRVEStateCreate(rve, &state));
  ierr = LamRVEWriteMesh(study->writer, "/mesh", rve);
  if (!ierr) ierr = StartFrames(study, rve, state);
  for (PetscInt k = 0; k < study->history.count && !ierr && !LamStopRequested(); k++)
    if (HasHistory(study) || IsChosen(study, k)) ierr = WriteFrame(study, rve, state, k);
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&own));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- the history ---- */

/* LamProcessMonitor */
static PetscErrorCode AddState(const LamProcessState *state, void *ctx)
{
  LamProcessStudy *study = (LamProcessStudy *)ctx;
  LamProcessHistory *h = &study->history;

  PetscFunctionBeginUser;
  PetscCall(LamListGrow(h->count, sizeof(*h->states), &h->capacity, &h->states));
  h->states[h->count++] = *state;
  if (study->state) PetscCall(study->state(study->response.step_ctx, study));
  if (study->writer && LamClock() - study->last_commit >= COMMIT_SECONDS) PetscCall(Commit(study, NULL));
  PetscCall(LamReportProgress(&study->response.reporter, LamProcessProgress(study->scene, state->time),
                              LAM_PROCESS_PARTS, 0));
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(LamProcessStudy *study)
{
  const char *status;
  PetscErrorCode ierr, closed;

  PetscFunctionBeginUser;
  if (study->out_path)
    PetscCall(LamRecordWriterOpen(study->out_path, "process", LamTargetMode(study->response.overwrite), study->scene,
                                  &study->writer));
  study->last_commit = LamClock();
  LamActivitySet("time, %%");
  PetscCall(LamReportProgress(&study->response.reporter, 0, LAM_PROCESS_PARTS, 0));
  ierr = LamProcessRun(study->process, &study->reason, study->message);
  status = study->reason == LAM_PROCESS_DONE      ? "done"
           : study->reason == LAM_PROCESS_STOPPED ? "stopped"
                                                  : study->message;
  if (!ierr && study->reason != LAM_PROCESS_STOPPED) ierr = WriteFrames(study);
  if (!ierr && study->writer) ierr = Commit(study, status);
  if (!ierr && study->out_path) ierr = LamProcessHistoryWriteCSV(study->out_path, study->scene, &study->history);
  closed = LamRecordWriterClose(&study->writer);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamProcessStudy *study)
{
  LamResponder responder;

  PetscFunctionBeginUser;
  study->reason = LAM_PROCESS_STOPPED;
  study->start = LamClock();
  if (study->out_path) {
    PetscCall(LamTargetCheck(study->out_path, "process", study->response.overwrite, study->scene));
    PetscCall(LamTargetCheckText(study->out_path, &LamProcessTable, study->response.overwrite, study->scene));
  }
  PetscCall(LamProcessCreate(study->scene, &study->process));
  PetscCall(Connect(study, &responder));
  if (study->response.stopped) PetscFunctionReturn(0);
  PetscCall(LamProcessSetResponder(study->process, responder));
  if (study->response.response == LAM_FE2_DIRECT)
    PetscCall(LamProcessSetTissue(study->process, LamFE2ChangeTissue, study->response.tissues.tissues));
  if (study->response.response == LAM_FE2_CACHE && !HasHistory(study))
    PetscCall(LamProcessSetReferenceResponder(study->process, study->response.tissues.tissues->direct));
  PetscCall(LamProcessSetMonitor(study->process, AddState, study));
  PetscCall(LamProcessSetStop(study->process, LamStopRequested));
  PetscCall(Follow(study));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(LamProcessStudy *study)
{
  LamFE2Tissues *tissues = &study->response.tissues;
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (tissues->count) ierr = LamFE2CloseTissueFile(tissues->tissues); /* solved states are kept, also after an error */
  PetscCall(LamProcessDestroy(&study->process));
  PetscCall(LamFE2Disconnect(&study->response));
  PetscCall(PetscFree(study->history.states));
  PetscFunctionReturn(ierr);
}

PetscErrorCode LamProcessStudyRun(LamProcessStudy *study)
{
  PetscErrorCode ierr = 0, freed;

  PetscFunctionBeginUser;
  study->response.comm = PETSC_COMM_SELF;
  if (LamIsFirst(PETSC_COMM_WORLD)) {
    ierr = Solve(study);
    if (!ierr && study->done) ierr = study->done(study->response.step_ctx, study);
    freed = Destroy(study);
    if (!ierr) ierr = freed;
  }
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr));
  PetscCallMPI(MPI_Bcast(&study->reason, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(study->message, LAM_PROCESS_MESSAGE, MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
