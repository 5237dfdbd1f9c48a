/*
  lamella tradeoff: error against time for every parameter of a scene that trades one for the other.
*/
#include "tradeoff_report.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct {
  const char *directory, *repeats_text, *budget_text, *only;
  PetscBool json, quiet;
  LamTradeoff tradeoff;
  LamProgress progress;
} Command;

/* Creates the output folder if needed, before anything is measured. */
static PetscErrorCode CheckDirectory(const Command *run)
{
  struct stat status;

  PetscFunctionBeginUser;
  if (!run->directory) PetscFunctionReturn(0);
  PetscCheck((!mkdir(run->directory, 0777) || errno == EEXIST) && !stat(run->directory, &status), PETSC_COMM_SELF,
             PETSC_ERR_FILE_OPEN, "%s: %s", run->directory, strerror(errno));
  PetscCheck(S_ISDIR(status.st_mode), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: is no folder", run->directory);
  PetscCheck(!access(run->directory, W_OK | X_OK), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", run->directory,
             strerror(errno));
  PetscFunctionReturn(0);
}

/* 3 if the planned setting has no result, or nothing to compare with. */
static int ExitStatus(const LamTradeoff *t)
{
  if (t->stopped) return LamStopExitStatus();
  return LamTradeoffIsSolved(t) ? LAM_EXIT_OK : LAM_EXIT_UNSOLVED;
}

static PetscErrorCode UpdateProgress(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  Command *run = (Command *)ctx;

  PetscFunctionBeginUser;
  LamProgressSetTotal(&run->progress, total);
  PetscCall(LamProgressUpdate(&run->progress, done, failed));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(Command *run, int *exit_status)
{
  LamTradeoff *t = &run->tradeoff;

  PetscFunctionBeginUser;
  t->reporter = (LamReporter){run, LamConsole.message, UpdateProgress};
  PetscCall(CheckDirectory(run));
  PetscCall(LamProgressStart(&run->progress, 0, run->quiet));
  PetscCall(LamTradeoffRun(t));
  PetscCall(LamProgressEnd(&run->progress));
  if (run->json)
    PetscCall(LamTradeoffPrintJSON(t));
  else
    LamTradeoffPrint(t);
  if (run->directory) PetscCall(LamTradeoffWrite(t, run->directory));
  *exit_status = ExitStatus(t);
  PetscCall(LamTradeoffDestroy(t));
  PetscFunctionReturn(0);
}

/* ---- the command line ---- */

static PetscBool ReadFamilies(Command *run, int *exit_status)
{
  char text[256], *rest = text;

  for (int k = 0; k < LAM_KNOB_COUNT; k++) run->tradeoff.chosen[k] = (PetscBool)!run->only;
  snprintf(text, sizeof(text), "%s", run->only ? run->only : "");
  for (char *word = strsep(&rest, ","); run->only && word; word = strsep(&rest, ",")) {
    int k = 0;

    while (k < LAM_KNOB_COUNT && strcmp(word, LamKnobNames[k])) k++;
    if (k == LAM_KNOB_COUNT)
      return LamUsageError("tradeoff", "--only", word, "there are mesh, strategy, cells, tolerance, database, macro",
                           exit_status);
    run->tradeoff.chosen[k] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool ReadValues(Command *run, int *exit_status)
{
  char *end;

  if (!LamCountParse("tradeoff", "--repeats", run->repeats_text, 1, &run->tradeoff.repeats, exit_status))
    return PETSC_FALSE;
  if (run->tradeoff.repeats > LAM_MOST_REPEATS)
    return LamUsageError("tradeoff", "--repeats", run->repeats_text, "100 at most", exit_status);
  if (run->budget_text) {
    run->tradeoff.budget = strtod(run->budget_text, &end);
    if (end == run->budget_text || *end || !(run->tradeoff.budget > 0) || PetscIsInfReal(run->tradeoff.budget))
      return LamUsageError("tradeoff", "--budget", run->budget_text, "a number of seconds is wanted, such as 120",
                           exit_status);
  }
  return ReadFamilies(run, exit_status);
}

/* Other ranks would share the processor and distort the times. */
static PetscBool IsSerial(int *exit_status)
{
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (size == 1) return PETSC_TRUE;
  if (LamAppIsRoot())
    fprintf(stderr, "lamella tradeoff: measures the time of one core; run it without mpirun, or on one rank\n");
  *exit_status = LAM_EXIT_USAGE;
  return PETSC_FALSE;
}

PetscErrorCode LamCommandTradeoff(LamArgs *args, int *exit_status)
{
  Command run = {.tradeoff = {.repeats = 3, .budget = 120}};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "DIR",
       "folder for tradeoff.json, tradeoff.png and .svg (the diagram) and model.json; made where it is missing",
       &run.directory},
      {0, "budget", LAM_OPTION_TEXT, "SECONDS", "how long it may measure, in all; default 120", &run.budget_text},
      {0, "repeats", LAM_OPTION_TEXT, "N", "how often each setting is measured; default 3", &run.repeats_text},
      {0, "only", LAM_OPTION_TEXT, "FAMILY,...", "of mesh, strategy, cells, tolerance, database, macro", &run.only},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per setting on stdout", &run.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args, "tradeoff SCENE [-o DIR] [--budget SECONDS] [--repeats N] [--only FAMILY,...] [--json] [--quiet]",
      "Measures error against time over the knobs of a scene that trade them.", options, 1, &run.tradeoff.scene_path,
      &done, exit_status));
  if (done || !ReadValues(&run, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  if (IsSerial(exit_status)) PetscCall(Solve(&run, exit_status));
  PetscFunctionReturn(0);
}
