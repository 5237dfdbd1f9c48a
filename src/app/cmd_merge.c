/*
  lamella merge: merges several databases into one. Needs no MPI.
*/
#include "app.h"
#include <unistd.h>
#include "clock.h"

typedef struct {
  LamConsole console;
  PetscBool salvage;
  const char *out, *const *files;
  PetscInt n;
} Merge;

static PetscErrorCode PrintObject(const Merge *m, const LamMergeReport *report, PetscReal seconds)
{
  PetscFunctionBeginUser;
  PetscCall(LamPrintJSON(json_pack("{s:s, s:I, s:I, s:I, s:I, s:o, s:I, s:o}", "database", m->out, "records",
                                   (json_int_t)report->records, "shards", (json_int_t)m->n, "duplicates",
                                   (json_int_t)report->duplicates, "differing", (json_int_t)report->differing,
                                   "difference", LamJSONReal(report->difference), "left_out",
                                   (json_int_t)report->left_out, "seconds", LamJSONReal(seconds))));
  PetscFunctionReturn(0);
}

static void PrintTable(const Merge *m, const LamMergeReport *report, PetscReal seconds)
{
  printf("%-16s %s\n", "database", m->out);
  printf("%-16s %" PetscInt_FMT " of %" PetscInt_FMT " file%s\n", "records", report->records, m->n,
         m->n == 1 ? "" : "s");
  printf("%-16s %lld\n", "duplicates", (long long)report->duplicates);
  if (report->differing)
    printf("%-16s %lld of them in their numbers, by up to %.2g %% of P\n", "differing", (long long)report->differing,
           100 * (double)report->difference);
  if (m->salvage) printf("%-16s %lld\n", "left out", (long long)report->left_out);
  printf("%-16s %.3g s\n", "time", seconds);
}

static PetscErrorCode Run(Merge *m, int *exit_status)
{
  const LamMergeOptions options = {
      .salvage = m->salvage, .stop = LamStopRequested, .reporter = LamConsoleReporter(&m->console)};
  PetscReal start, end;
  LamMergeReport report;

  PetscFunctionBeginUser;
  start = LamClock();
  LamActivitySet("records");
  PetscCall(LamDatabaseMerge(m->out, m->n, m->files, &options, &report));
  end = LamClock();
  LamConsoleClear();
  *exit_status = report.stopped ? LamStopExitStatus() : LAM_EXIT_OK;
  if (report.stopped) PetscFunctionReturn(0);
  if (report.differing && !m->console.quiet)
    fprintf(stderr,
            "lamella merge: %lld records have been solved twice, with different numbers; of each the first was kept, "
            "or the one that converged\n",
            (long long)report.differing);
  if (m->console.json)
    PetscCall(PrintObject(m, &report, end - start));
  else
    PrintTable(m, &report, end - start);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandMerge(LamArgs *args, int *exit_status)
{
  const char **names;
  Merge m = {.console.command = "merge"};
  PetscBool done;
  const LamOption options[] = {
      {0, "salvage", LAM_OPTION_FLAG, NULL, "take the sound records of damaged files", &m.salvage},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &m.console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress and no messages but errors", &m.console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(args->argc + 1, &names));
  PetscCall(LamOptionsParse(args, "merge OUT.h5 FILE.h5... [--salvage] [--json] [--quiet]",
                            "Makes one database of all records of several, each state once.", options, -2, names, &done,
                            exit_status));
  m.out = names[0];
  m.files = names + 1;
  while (!done && m.files[m.n]) m.n++;
  PetscCheck(done || !m.salvage || access(m.out, F_OK), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; --salvage makes a new file: give another file name or remove it", m.out);
  if (!done) {
    PetscCall(LamSignalsInstall());
    PetscCall(Run(&m, exit_status));
  }
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}
