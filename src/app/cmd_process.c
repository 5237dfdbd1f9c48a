/*
  lamella process: tissue that changes in time, at one material point, or of a body (process_body.c).

  The way of a point through time is one chain: rank 0 follows it, further ranks wait.
*/
#include "process_run.h"
#include <lamella/clock.h>
#include <string.h>
#include <unistd.h>

/* ---- what answers ---- */

static PetscErrorCode Connect(LamProcessRunState *run, LamResponder **responder)
{
  LamFE2Run *response = &run->response;
  LamFE2Tissue *tissue;

  PetscFunctionBeginUser;
  response->tissues.count = 1;
  PetscCall(PetscCalloc1(1, &response->tissues.tissues));
  tissue = response->tissues.tissues;
  tissue->scene = *run->scene;
  tissue->stress = 1;
  tissue->points = tissue->body_points = 1;
  if (response->database_path)
    PetscCall(PetscStrncpy(tissue->database_path, response->database_path, sizeof(tissue->database_path)));
  PetscCall(LamFE2PrepareTissue(response, tissue));
  run->scene->micro = tissue->scene.micro;
  PetscCall(LamFE2ConnectTissue(response, tissue, responder));
  if (!response->stopped && response->response == LAM_FE2_CACHE) PetscCall(LamFE2OpenTissueFile(tissue));
  PetscFunctionReturn(0);
}

static PetscErrorCode Disconnect(LamProcessRunState *run)
{
  LamFE2Run *response = &run->response;

  PetscFunctionBeginUser;
  if (response->tissues.count) PetscCall(LamFE2DisconnectTissue(response->tissues.tissues));
  PetscCall(PetscFree(response->tissues.tissues));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessChangeWalls(void *ctx, const PetscReal factor[3])
{
  LamFE2Tissue *tissue = (LamFE2Tissue *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamFE2ChangeWalls(tissue->rve, &tissue->scene.micro, factor));
  PetscFunctionReturn(0);
}

/* What the cache has solved goes to its database's file, whatever the end was. */
static PetscErrorCode CloseDatabase(LamProcessRunState *run)
{
  LamFE2Tissue *tissue = run->response.tissues.tissues;
  PetscErrorCode ierr, closed;

  PetscFunctionBeginUser;
  if (!tissue || !tissue->records) PetscFunctionReturn(0);
  ierr = LamFE2RecordTissue(tissue);
  closed = LamRecordWriterClose(&tissue->records);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}

/* ---- the way ---- */

/* LamProcessMonitor */
static PetscErrorCode Told(const LamProcessState *state, void *ctx)
{
  LamProcessRunState *run = (LamProcessRunState *)ctx;
  LamProcessHistory *h = &run->history;

  PetscFunctionBeginUser;
  if (h->count == h->capacity) {
    h->capacity = PetscMax(128, 2 * h->capacity);
    PetscCall(PetscRealloc((size_t)h->capacity * sizeof(LamProcessState), &h->states));
  }
  h->states[h->count++] = *state;
  PetscCall(LamProcessReport(run));
  PetscCall(LamProcessFileAdd(run, PETSC_FALSE));
  PetscCall(LamProgressUpdate(&run->progress, (PetscInt64)(1000 * state->time / run->scene->process.duration), 0));
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(LamProcessRunState *run, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE])
{
  PetscErrorCode ierr, closed;
  const char *status;

  PetscFunctionBeginUser;
  PetscCall(LamProcessFileOpen(run));
  PetscCall(LamProgressStart(&run->progress, 1000, (PetscBool)(run->quiet || !run->json)));
  ierr = LamProcessRun(run->process, reason, message);
  status = ierr ? NULL : *reason == LAM_PROCESS_DONE ? "done" : *reason == LAM_PROCESS_STOPPED ? "stopped" : message;
  if (!ierr && *reason != LAM_PROCESS_STOPPED) ierr = LamProcessFrames(run, run->frames);
  closed = LamProcessFileClose(run, ierr ? NULL : status);
  PetscCall(ierr ? ierr : closed);
  PetscCall(LamProgressEnd(&run->progress));
  PetscCall(LamProcessReportEnd(run, *reason, message));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamProcessRunState *run, int *exit_status)
{
  char message[LAM_PROCESS_MESSAGE];
  LamProcessReason reason = LAM_PROCESS_STOPPED;
  LamResponder *responder;

  PetscFunctionBeginUser;
  run->start = LamClock();
  PetscCall(LamProcessCreate(run->scene, &run->process));
  PetscCall(Connect(run, &responder));
  if (!run->response.stopped) {
    PetscCall(LamProcessSetResponder(run->process, responder));
    if (run->response.response == LAM_FE2_DIRECT)
      PetscCall(LamProcessSetWalls(run->process, LamProcessChangeWalls, run->response.tissues.tissues));
    if (run->response.response == LAM_FE2_CACHE)
      PetscCall(LamProcessSetJudge(run->process, &run->response.tissues.tissues->solver));
    PetscCall(LamProcessSetMonitor(run->process, Told, run));
    PetscCall(LamProcessSetStop(run->process, LamStopRequested));
    PetscCall(Follow(run, &reason, message));
  }
  *exit_status = reason == LAM_PROCESS_STOPPED ? LamStopExitStatus()
                 : reason == LAM_PROCESS_ENDED ? LAM_EXIT_UNSOLVED
                                               : LAM_EXIT_OK;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(LamProcessRunState *run)
{
  PetscFunctionBeginUser;
  PetscCall(CloseDatabase(run));
  PetscCall(LamProcessDestroy(&run->process));
  PetscCall(Disconnect(run));
  PetscCall(PetscFree(run->history.states));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandProcess(LamArgs *args, int *exit_status)
{
  LamProcessRunState run = {0};
  PetscErrorCode ierr = 0;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "response database; a cache adds to it what it solves",
       &run.response.database_path},
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5",
       "states in time, for plot and info; of a body with OUT.xdmf and OUT.csv beside it", &run.out_path},
      {0, "response", LAM_OPTION_TEXT, "TYPE",
       "direct: solve an RVE for each state (default); cache: query, solve what is missing (default with -d); "
       "database: query only",
       &run.response.response_name},
      {0, "frames", LAM_OPTION_TEXT, "N",
       "at a material point: keep the cells at N states evenly spread, for a film (default: at events, start and end)",
       &run.frames_text},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per output and event on stdout", &run.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args, "process SCENE [-d DB.h5] [-o OUT.h5] [--response TYPE] [--frames N] [--json]\n               [--quiet]",
      "Follows tissue that changes in time.", options, 1, &run.response.scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!LamFE2ChooseResponse("process", &run.response)) {
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  if (run.frames_text && !LamCountParse("process", "--frames", run.frames_text, 2, &run.frames, exit_status))
    PetscFunctionReturn(0);
  PetscCall(LamAppInitialize(args));
  run.response.quiet = run.quiet;
  PetscCall(LamSceneRead(run.response.scene_path, &run.scene));
  run.response.scene = run.scene;
  run.response.walls = 1;
  for (int k = 0; k < 3; k++) run.response.wall_ratio[k] = 1;
  if (run.scene->has_macro && run.scene->has_process) {
    PetscCall(LamProcessBody(&run, exit_status));
    PetscFunctionReturn(0);
  }
  run.response.comm = PETSC_COMM_SELF;
  if (LamAppIsRoot()) {
    ierr = Solve(&run, exit_status);
    const PetscErrorCode freed = Destroy(&run);
    if (!ierr) ierr = freed;
  }
  PetscCall(ierr);
  PetscCall(LamFE2ShareError(PETSC_COMM_WORLD, 0));
  PetscCall(LamSceneDestroy(&run.scene));
  PetscFunctionReturn(0);
}
