/*
  lamella verify: queries a database at random states and solves the states for which it has a response.
*/
#include "audit_report.h"
#include "clock.h"

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

PetscErrorCode LamCommandVerify(LamArgs *args, int *exit_status)
{
  LamVerification v = {.samples = 200, .seed = 1};
  LamConsole console = {.command = "verify"};
  PetscBool done;
  const LamOption options[] = {
      {0, "samples", LAM_OPTION_FROM_1, "N", "answers that are solved afresh; default 200", &v.samples},
      {0, "seed", LAM_OPTION_FROM_0, "S", "another one draws other states; default 1", &v.seed},
      {0, "accuracy", LAM_OPTION_ACCURACY, "ERROR",
       "relative error of P that is asked for, 0.01; inf: any; by default the scene's", &v.accuracy},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "verify DB.h5 [--samples N] [--seed S] [--accuracy ERROR] [--json] [--quiet]",
                            "Asks a database at random, solves what it answers afresh, and compares.", options, 1,
                            &v.path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  v.reporter = LamConsoleReporter(&console);
  PetscCall(LamVerificationRun(&v));
  LamConsoleClear(&console);
  if (!v.rank) PetscCall(PrintReport(&v, console.json));
  /* unsolved: a response has no solution to compare with, or there was no response */
  PetscCall(
      LamShareOutcome((PetscBool)(!v.rank && (json_object_size(v.audit.unsolved) || !v.audit.answered)), exit_status));
  PetscCall(LamVerificationDestroy(&v));
  PetscFunctionReturn(0);
}
