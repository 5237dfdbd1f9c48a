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
  const char *directory, *budget_text, *only;
  LamTradeoff tradeoff;
  LamConsole console;
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

static PetscErrorCode Solve(Command *run, int *exit_status)
{
  LamTradeoff *t = &run->tradeoff;

  PetscFunctionBeginUser;
  t->reporter = LamConsoleReporter(&run->console);
  PetscCall(CheckDirectory(run));
  PetscCall(LamTradeoffRun(t));
  LamConsoleClear(&run->console);
  if (run->console.json)
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
      return LamUsageError("tradeoff", exit_status,
                           "--only \"%s\": there are mesh, strategy, cells, tolerance, database, macro", word);
    run->tradeoff.chosen[k] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool ReadValues(Command *run, int *exit_status)
{
  char *end;

  if (run->tradeoff.repeats > LAM_MOST_REPEATS)
    return LamUsageError("tradeoff", exit_status, "--repeats \"%" PetscInt_FMT "\": %d at most", run->tradeoff.repeats,
                         LAM_MOST_REPEATS);
  if (run->budget_text) {
    run->tradeoff.budget = strtod(run->budget_text, &end);
    if (end == run->budget_text || *end || !(run->tradeoff.budget > 0) || PetscIsInfReal(run->tradeoff.budget))
      return LamUsageError("tradeoff", exit_status, "--budget \"%s\": a number of seconds is wanted, such as 120",
                           run->budget_text);
  }
  return ReadFamilies(run, exit_status);
}

/* Other ranks would share the processor and distort the times. */
static PetscBool IsSerial(int *exit_status)
{
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return (PetscBool)(size == 1 ||
                     LamUsageError("tradeoff", exit_status,
                                   "measures the time of one core; run it without mpirun, or on one rank"));
}

PetscErrorCode LamCommandTradeoff(LamArgs *args, int *exit_status)
{
  Command run = {.tradeoff = {.repeats = 3, .budget = 120}, .console.command = "tradeoff"};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "DIR",
       "folder for tradeoff.json, tradeoff.png and .svg (the diagram) and model.json; made where it is missing",
       &run.directory},
      {0, "budget", LAM_OPTION_TEXT, "SECONDS", "how long it may measure, in all; default 120", &run.budget_text},
      {0, "repeats", LAM_OPTION_FROM_1, "N", "how often each setting is measured; default 3", &run.tradeoff.repeats},
      {0, "only", LAM_OPTION_TEXT, "FAMILY,...", "of mesh, strategy, cells, tolerance, database, macro", &run.only},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per setting on stdout", &run.console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.console.quiet},
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
