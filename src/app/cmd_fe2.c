/*
  lamella fe2: the macroscale problem of a scene, with material response from RVE solves, a database or both.
*/
#include "app.h"
#include "fe2_report.h"
#include <stdio.h>
#include <unistd.h>

/* What a stopped run leaves, and how to go on with it. */
static void TellHowToGoOn(const LamFE2Run *run)
{
  const char *solved = run->database_path ? "; what was solved is in the database" : "";

  if (!run->out_path)
    fprintf(stderr, "lamella fe2: stopped: without -o OUT.h5 no step is kept%s\n", solved);
  else if (run->stopped)
    fprintf(stderr, "lamella fe2: stopped before the first step: %s is not written%s\n", run->out_path, solved);
  else
    fprintf(stderr,
            "lamella fe2: stopped: the same command with --resume goes on behind the last complete step of %s\n",
            run->out_path);
}

/* The outcome of rank 0 applies to all ranks: a signal may have reached one rank only. */
static PetscErrorCode Report(const LamFE2Run *run, const LamConsole *console, int *exit_status)
{
  int status = run->reason == LAM_MACRO_STOPPED ? LamStopExitStatus() : LAM_EXIT_OK;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &status, 1, MPI_INT, MPI_MAX, run->comm));
  *exit_status = run->reason == LAM_MACRO_NOT_CONVERGED ? LAM_EXIT_UNSOLVED : status;
  if (LamIsFirst(run->comm) && status) TellHowToGoOn(run);
  if (!LamIsFirst(run->comm) || run->stopped) PetscFunctionReturn(0);
  PetscCall(LamFE2ReportEnd(run, console));
  if (run->reason == LAM_MACRO_NOT_CONVERGED) fprintf(stderr, "lamella fe2: %s: %s\n", run->scene_path, run->message);
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamFE2Run *run, LamConsole *console, int *exit_status)
{
  PetscBool finished;

  PetscFunctionBeginUser;
  PetscCall(LamFE2Prepare(run, &finished));
  if (finished) PetscFunctionReturn(0);
  if (!LamFE2CheckTissuePaths("fe2", run, exit_status)) PetscFunctionReturn(0);
  if (LamIsFirst(run->comm) && run->scene->sealed && run->response == LAM_FE2_DIRECT)
    LamReportNote(&run->reporter, "sealed cells are solved at each material point, together with their pressure, which "
                                  "is slow; -d DB.h5 responds from a database of prescribed turgor, which later runs "
                                  "use again");
  PetscCall(LamFE2Solve(run));
  LamConsoleClear();
  PetscCall(Report(run, console, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandFE2(LamArgs *args, int *exit_status)
{
  LamFE2Run run = LAM_FE2_RUN;
  LamConsole console = {.command = "fe2"};
  const char *response = NULL;
  PetscBool done, all = PETSC_FALSE, none = PETSC_FALSE;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "response database; a cache adds to it what it solves",
       &run.database_path},
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "results, with OUT.xdmf (for ParaView) and OUT.csv (curves) beside it",
       &run.out_path},
      LAM_OVERWRITE_OPTION(run.overwrite),
      {0, "response", LAM_OPTION_TEXT, "TYPE",
       "direct: solve an RVE per material point (default); cache: query, solve what is missing (default with -d); "
       "database: query only",
       &response},
      {0, "certify", LAM_OPTION_FLAG, NULL,
       "correct the reactions of each step by direct solves of all its material points", &all},
      {0, "no-certify", LAM_OPTION_FLAG, NULL, "do not correct reactions at the end, from a sample of material points",
       &none},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on behind the last complete step of OUT.h5, where there is one",
       &run.resume},
      LAM_TEST_OPTIONS(console.test, " of the loaded side"),
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per load step on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "fe2 SCENE [-d DB.h5] [-o OUT.h5] [--response TYPE] [--certify | --no-certify]\n           "
                            "[--readings] [--at STRAIN,...] [--resume] [--overwrite] [--json] [--quiet]",
                            "Solves the macroscale problem of a scene.", options, 1, &run.scene_path, &done,
                            exit_status));
  if (done) PetscFunctionReturn(0);
  if (!LamFE2ChooseResponse("fe2", response, &run, exit_status) || !LamFE2CheckPaths("fe2", &run, exit_status) ||
      !LamTestReadOptions("fe2", &console.test, exit_status))
    PetscFunctionReturn(0);
  if (all && none && !LamUsageError("fe2", exit_status, "--certify and --no-certify exclude each other"))
    PetscFunctionReturn(0);
  if (!none && run.response != LAM_FE2_DIRECT) run.certify = all ? LAM_CERTIFY_ALL : LAM_CERTIFY_SHARE;
  if (all && run.response == LAM_FE2_DIRECT &&
      !LamUsageError("fe2", exit_status,
                     "--certify corrects interpolated responses, and here all are solved; leave it "
                     "out, or give -d DB.h5"))
    PetscFunctionReturn(0);
  PetscCall(args->start(args));
  run.comm = PETSC_COMM_WORLD;
  run.reporter = LamConsoleReporter(&console);
  run.step = LamFE2ReportStep;
  run.step_ctx = &console;
  run.all_fields = (PetscBool)(!console.json || console.test.readings); /* the summary has the curve */
  PetscCall(Solve(&run, &console, exit_status));
  PetscCall(LamFE2Destroy(&run));
  PetscFunctionReturn(0);
}
