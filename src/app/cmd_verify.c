/*
  lamella verify: queries a database at random states and solves the states for which it has a response.
*/
#include "audit_report.h"
#include "clock.h"

enum { DEFAULT_SAMPLES = 200 };

typedef struct {
  PetscBool json, quiet;
  LamProgress progress;
} Report;

typedef struct {
  const char *samples, *seed, *accuracy;
} Texts;

static PetscErrorCode UpdateProgress(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  Report *report = (Report *)ctx;

  PetscFunctionBeginUser;
  LamProgressSetTotal(&report->progress, total);
  PetscCall(LamProgressUpdate(&report->progress, done, failed));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintReport(const LamVerification *v, PetscBool json)
{
  json_t *object;

  PetscFunctionBeginUser;
  if (!json) {
    PetscCall(LamAuditPrint(&v->audit, v->path, LamClock() - v->start, v->ranks));
    PetscFunctionReturn(0);
  }
  PetscCall(LamAuditToJSON(&v->audit, v->path, LamClock() - v->start, &object));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

/* Unsolved if a response has no solution to compare with, or there was no response. The outcome of rank 0 applies to
   all ranks. */
static PetscErrorCode ExitStatus(LamVerification *v, int *exit_status)
{
  int status = LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (v->rank == 0 && (json_object_size(v->audit.unsolved) || !v->audit.answered)) status = LAM_EXIT_UNSOLVED;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  *exit_status = status;
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static PetscBool ReadValues(LamVerification *v, const Texts *texts, int *exit_status)
{
  v->samples = DEFAULT_SAMPLES;
  v->seed = 1;
  return (PetscBool)(LamCountParse("verify", "--samples", texts->samples, 1, &v->samples, exit_status) &&
                     LamCountParse("verify", "--seed", texts->seed, 0, &v->seed, exit_status) &&
                     LamAccuracyParse("verify", texts->accuracy, &v->accuracy, exit_status));
}

PetscErrorCode LamCommandVerify(LamArgs *args, int *exit_status)
{
  LamVerification v = {0};
  Report report = {0};
  Texts texts = {NULL};
  PetscBool done;
  const LamOption options[] = {
      {0, "samples", LAM_OPTION_TEXT, "N", "answers that are solved afresh; default 200", &texts.samples},
      {0, "seed", LAM_OPTION_TEXT, "S", "another one draws other states; default 1", &texts.seed},
      {0, "accuracy", LAM_OPTION_TEXT, "ERROR",
       "relative error of P that is asked for, 0.01; inf: any; by default the scene's", &texts.accuracy},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &report.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &report.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "verify DB.h5 [--samples N] [--seed S] [--accuracy ERROR] [--json] [--quiet]",
                            "Asks a database at random, solves what it answers afresh, and compares.", options, 1,
                            &v.path, &done, exit_status));
  if (done || !ReadValues(&v, &texts, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  v.reporter = (LamReporter){&report, LamConsole.message, UpdateProgress};
  PetscCall(LamProgressStart(&report.progress, 0, report.quiet));
  PetscCall(LamVerificationRun(&v));
  PetscCall(LamProgressEnd(&report.progress));
  if (!v.rank) PetscCall(PrintReport(&v, report.json));
  PetscCall(ExitStatus(&v, exit_status));
  PetscCall(LamVerificationDestroy(&v));
  PetscFunctionReturn(0);
}
