/*
  Complete studies for other programs.
*/
#include "build_run.h"
#include "fe2_run.h"
#include "clock.h"

/* ---- a response database ---- */

static void FillResult(const LamBuild *build, LamBuildResult *result)
{
  *result = (LamBuildResult){.records = LamBuildRecords(build),
                             .added = build->added,
                             .failed = LamBuildFailed(build),
                             .answered = LamRoundsCovered(&build->rounds),
                             .error = build->rounds.coverage.error,
                             .seconds = LamClock() - build->start,
                             .stopped = LamStopRequested()};
}

PetscErrorCode LamStudyBuild(const char scene_path[], const char database_path[], const LamBuildOptions *options,
                             LamBuildResult *result)
{
  LamBuild build = {.path = database_path,
                    .resume = options->resume,
                    .team_size = PetscMax(1, options->ranks_per_rve),
                    .shard = {PetscMax(1, options->shard), PetscMax(1, options->shard_count)},
                    .reporter = options->reporter};

  PetscFunctionBeginUser;
  PetscCheck(build.shard.index <= build.shard.count, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "part %d of %d of the sample box: there is none", (int)build.shard.index, (int)build.shard.count);
  PetscCall(LamBuildPrepare(&build, scene_path));
  PetscCall(LamBuildTable(&build));
  if (!build.rank) FillResult(&build, result);
  PetscCall(LamBuildDestroy(&build));
  PetscFunctionReturn(0);
}

/* ---- a body ---- */

static PetscErrorCode ReportStep(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  const LamFE2Options *options = (const LamFE2Options *)ctx;

  PetscFunctionBeginUser;
  (void)peak_memory;
  if (options->step) PetscCall(options->step(options->reporter.ctx, &run->scene->scales, step));
  PetscFunctionReturn(0);
}

static void ReportMessage(void *ctx, PetscBool warning, const char text[])
{
  const LamReporter *reporter = &((const LamFE2Options *)ctx)->reporter;

  if (reporter->message) reporter->message(reporter->ctx, warning, text);
}

static PetscErrorCode ReportProgress(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  return LamReportProgress(&((const LamFE2Options *)ctx)->reporter, done, total, failed);
}

PetscErrorCode LamStudyFE2(const char scene_path[], const LamFE2Options *options, LamMacroReason *reason,
                           char message[])
{
  LamFE2Run run = LAM_FE2_RUN;
  PetscBool finished;

  PetscFunctionBeginUser;
  PetscCheck(options->database_path || options->response == LAM_FE2_DIRECT, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL,
             "response \"%s\" needs a database", LamFE2ResponseNames[options->response]);
  PetscCheck(options->out_path || !options->resume, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL,
             "a run can only be resumed where out_path has its results");
  run.comm = PETSC_COMM_WORLD;
  run.scene_path = scene_path;
  run.response = options->response;
  run.database_path = options->database_path;
  run.out_path = options->out_path;
  run.resume = options->resume;
  run.reporter = (LamReporter){(void *)options, ReportMessage, ReportProgress};
  run.step = ReportStep;
  message[0] = '\0';
  *reason = LAM_MACRO_DONE;
  PetscCall(LamFE2Prepare(&run, &finished));
  if (!finished) PetscCall(LamFE2Solve(&run, reason, message));
  PetscCall(LamFE2Destroy(&run));
  PetscFunctionReturn(0);
}
