/*
  lamella process: tissue that changes in time, at one material point, or of a body.

  The history of a point is sequential: rank 0 computes it, further ranks wait.
*/
#include "app.h"
#include "process_report.h"
#include <stdio.h>
#include <unistd.h>

static int StatusOf(LamProcessReason reason)
{
  return reason == LAM_PROCESS_STOPPED ? LamStopExitStatus()
         : reason == LAM_PROCESS_ENDED ? LAM_EXIT_UNSOLVED
                                       : LAM_EXIT_OK;
}

/* ---- at a material point ---- */

static PetscErrorCode SolvePoint(LamProcessStudy *study, LamConsole *console, int *exit_status)
{
  char message[LAM_PROCESS_MESSAGE] = "";
  LamProcessReason reason;

  PetscFunctionBeginUser;
  console->has_rows = (PetscBool)!console->json;
  PetscCall(LamProcessSolvePoint(study, &reason, message));
  LamConsoleClear(console);
  if (!study->response.stopped) PetscCall(LamProcessReportEnd(console, study, reason, message));
  *exit_status = StatusOf(reason);
  PetscFunctionReturn(0);
}

static PetscErrorCode RunPoint(const LamFE2Run *run, PetscInt frames, LamConsole *console, int *exit_status)
{
  LamProcessStudy study = {
      .response = *run, .out_path = run->out_path, .frames = frames, .scene = run->scene, .state = LamProcessReport};
  PetscErrorCode ierr = 0, freed;

  PetscFunctionBeginUser;
  study.response.comm = PETSC_COMM_SELF;
  if (LamAppIsRoot()) {
    ierr = SolvePoint(&study, console, exit_status);
    freed = LamProcessStudyDestroy(&study);
    if (!ierr) ierr = freed;
  }
  PetscCall(ierr);
  PetscCall(LamShareError(PETSC_COMM_WORLD, 0));
  PetscCall(LamSceneDestroy(&study.response.scene));
  PetscFunctionReturn(0);
}

/* ---- of a body ---- */

static PetscErrorCode SolveBody(LamBodyStudy *study, LamConsole *console, int *exit_status)
{
  LamFE2Run *fe2 = &study->fe2;
  char message[LAM_PROCESS_MESSAGE] = "";
  LamProcessReason reason;

  PetscFunctionBeginUser;
  if (!LamFE2CheckPaths("process", fe2, exit_status)) PetscFunctionReturn(0);
  PetscCall(LamBodyStudyPrepare(study));
  if (!LamFE2CheckTissuePaths("process", fe2, exit_status)) PetscFunctionReturn(0);
  console->has_rows = (PetscBool)(!console->json && isatty(STDOUT_FILENO));
  PetscCall(LamBodyStudySolve(study, &reason, message));
  LamConsoleClear(console);
  *exit_status = StatusOf(reason);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, exit_status, 1, MPI_INT, MPI_MAX, fe2->comm));
  if (!LamAppIsRoot() || fe2->stopped) PetscFunctionReturn(0);
  if (!console->json) PetscCall(LamBodyReportEnd(study));
  if (reason == LAM_PROCESS_ENDED) fprintf(stderr, "lamella process: %s: %s\n", fe2->scene_path, message);
  PetscFunctionReturn(0);
}

static PetscErrorCode RunBody(const LamFE2Run *run, PetscInt frames, LamConsole *console, int *exit_status)
{
  LamBodyStudy study = {.fe2 = *run, .state = LamBodyReport};

  PetscFunctionBeginUser;
  if (!frames ||
      LamUsageError("process", exit_status, "--frames: keeps cells of one material point; of a body `macro.zoom` does"))
    PetscCall(SolveBody(&study, console, exit_status));
  PetscCall(LamBodyStudyDestroy(&study));
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

PetscErrorCode LamCommandProcess(LamArgs *args, int *exit_status)
{
  LamFE2Run run = LAM_FE2_RUN;
  LamConsole console = {.command = "process"};
  const char *response = NULL;
  PetscInt frames = 0;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "response database; a cache adds to it what it solves",
       &run.database_path},
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5",
       "states in time, for plot and info; of a body with OUT.xdmf and OUT.csv beside it", &run.out_path},
      {0, "response", LAM_OPTION_TEXT, "TYPE",
       "direct: solve an RVE for each state (default); cache: query, solve what is missing (default with -d); "
       "database: query only",
       &response},
      {0, "frames", LAM_OPTION_FROM_2, "N",
       "at a material point: keep the cells at N states evenly spread, for a film (default: at events, start and end)",
       &frames},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per output and event on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args, "process SCENE [-d DB.h5] [-o OUT.h5] [--response TYPE] [--frames N] [--json]\n               [--quiet]",
      "Follows tissue that changes in time.", options, 1, &run.scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!LamFE2ChooseResponse("process", response, &run, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  run.comm = PETSC_COMM_WORLD;
  run.reporter = LamConsoleReporter(&console);
  PetscCall(LamSceneRead(run.scene_path, &run.scene));
  if (run.scene->has_macro && run.scene->has_process)
    PetscCall(RunBody(&run, frames, &console, exit_status));
  else
    PetscCall(RunPoint(&run, frames, &console, exit_status));
  PetscFunctionReturn(0);
}
