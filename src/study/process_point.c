/*
  A process at one material point: its history is sequential and is computed on one rank.
*/
#include "process_run.h"
#include "clock.h"

/* ---- responses ---- */

static PetscErrorCode Connect(LamProcessStudy *study, LamResponder **responder)
{
  LamFE2Run *response = &study->response;
  LamFE2Tissue *tissue;

  PetscFunctionBeginUser;
  response->tissues.count = 1;
  PetscCall(PetscCalloc1(1, &response->tissues.tissues));
  tissue = response->tissues.tissues;
  tissue->scene = *study->scene;
  tissue->stress = 1;
  tissue->points = tissue->body_points = 1;
  if (response->database_path)
    PetscCall(PetscStrncpy(tissue->database_path, response->database_path, sizeof(tissue->database_path)));
  PetscCall(LamFE2PrepareTissue(response, tissue));
  study->scene->micro = tissue->scene.micro;
  PetscCall(LamFE2ConnectTissue(response, tissue, responder));
  if (!response->stopped && response->response == LAM_FE2_CACHE) PetscCall(LamFE2OpenTissueFile(tissue));
  PetscFunctionReturn(0);
}

static PetscErrorCode Disconnect(LamProcessStudy *study)
{
  LamFE2Run *response = &study->response;

  PetscFunctionBeginUser;
  if (response->tissues.count) PetscCall(LamFE2DisconnectTissue(response->tissues.tissues));
  PetscCall(PetscFree(response->tissues.tissues));
  PetscFunctionReturn(0);
}

/* Writes the states solved by the cache to its database's file, also after an error. */
static PetscErrorCode CloseDatabase(LamProcessStudy *study)
{
  LamFE2Tissue *tissue = study->response.tissues.tissues;
  PetscErrorCode ierr, closed;

  PetscFunctionBeginUser;
  if (!tissue || !tissue->records) PetscFunctionReturn(0);
  ierr = LamFE2RecordTissue(tissue);
  closed = LamRecordWriterClose(&tissue->records);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}

/* ---- the history ---- */

/* LamProcessMonitor */
static PetscErrorCode AddState(const LamProcessState *state, void *ctx)
{
  LamProcessStudy *study = (LamProcessStudy *)ctx;
  LamProcessHistory *h = &study->history;

  PetscFunctionBeginUser;
  if (h->count == h->capacity) {
    h->capacity = PetscMax(128, 2 * h->capacity);
    PetscCall(PetscRealloc((size_t)h->capacity * sizeof(LamProcessState), &h->states));
  }
  h->states[h->count++] = *state;
  if (study->state) PetscCall(study->state(study->response.reporter.ctx, study));
  PetscCall(LamProcessFileAdd(study, PETSC_FALSE));
  PetscCall(LamReportProgress(&study->response.reporter,
                              (PetscInt64)(LAM_PROCESS_PARTS * state->time / study->scene->process.duration),
                              LAM_PROCESS_PARTS, 0));
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(LamProcessStudy *study, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE])
{
  PetscErrorCode ierr, closed;
  const char *status;

  PetscFunctionBeginUser;
  PetscCall(LamProcessFileOpen(study));
  ierr = LamProcessRun(study->process, reason, message);
  status = ierr ? NULL : *reason == LAM_PROCESS_DONE ? "done" : *reason == LAM_PROCESS_STOPPED ? "stopped" : message;
  if (!ierr && *reason != LAM_PROCESS_STOPPED) ierr = LamProcessFrames(study, study->frames);
  closed = LamProcessFileClose(study, ierr ? NULL : status);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessSolvePoint(LamProcessStudy *study, LamProcessReason *reason, char message[])
{
  LamResponder *responder;

  PetscFunctionBeginUser;
  *reason = LAM_PROCESS_STOPPED;
  study->start = LamClock();
  PetscCall(LamProcessCreate(study->scene, &study->process));
  PetscCall(Connect(study, &responder));
  if (study->response.stopped) PetscFunctionReturn(0);
  PetscCall(LamProcessSetResponder(study->process, responder));
  if (study->response.response == LAM_FE2_DIRECT)
    PetscCall(LamProcessSetWalls(study->process, LamFE2ChangeTissueWalls, study->response.tissues.tissues));
  if (study->response.response == LAM_FE2_CACHE)
    PetscCall(LamProcessSetReferenceResponder(study->process, &study->response.tissues.tissues->solver));
  PetscCall(LamProcessSetMonitor(study->process, AddState, study));
  PetscCall(LamProcessSetStop(study->process, LamStopRequested));
  PetscCall(Follow(study, reason, message));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessStudyDestroy(LamProcessStudy *study)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = CloseDatabase(study); /* solved states are kept, also after an error */
  PetscCall(LamProcessDestroy(&study->process));
  PetscCall(Disconnect(study));
  PetscCall(PetscFree(study->history.states));
  PetscFunctionReturn(ierr);
}
