/*
  Complete studies for other programs.
*/
#include "audit.h"
#include "build_run.h"
#include "clock.h"
#include "map.h"
#include "process_run.h"
#include "tradeoff.h"
#include <math.h>
#include <string.h>

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

static PetscErrorCode FillVerifyResult(const LamVerification *v, LamVerifyResult *result)
{
  const LamAudit *audit = &v->audit;
  PetscReal *errors;

  PetscFunctionBeginUser;
  *result = (LamVerifyResult){.queries = audit->asked,
                              .responses = audit->answered,
                              .error = NAN,
                              .seconds = LamClock() - v->start,
                              .stopped = LamStopRequested()};
  PetscCall(PetscMalloc1(audit->answered, &errors));
  for (PetscInt i = 0; i < audit->answered; i++) {
    if (!audit->results[i].compared) continue;
    errors[result->compared++] = audit->results[i].error;
    result->beyond += !(audit->results[i].error <= audit->accuracy);
  }
  PetscCall(PetscSortReal(result->compared, errors));
  if (result->compared) result->error = errors[(PetscInt)(0.95 * (PetscReal)(result->compared - 1))];
  PetscCall(PetscFree(errors));
  PetscFunctionReturn(0);
}

PetscErrorCode LamStudyVerify(const char database_path[], const LamVerifyOptions *options, LamVerifyResult *result)
{
  LamVerification v = {.path = database_path,
                       .samples = options->samples,
                       .seed = options->seed,
                       .accuracy = options->accuracy,
                       .reporter = options->reporter};

  PetscFunctionBeginUser;
  PetscCall(LamVerificationRun(&v));
  if (!v.rank) PetscCall(FillVerifyResult(&v, result));
  PetscCall(LamVerificationDestroy(&v));
  PetscFunctionReturn(0);
}

/* ---- a failure map ---- */

PetscErrorCode LamStudyMap(const char scene_path[], const char map_path[], const LamMapOptions *options,
                           LamMapResult *result)
{
  LamMap map = {.scene_path = scene_path, .path = map_path, .resume = options->resume, .reporter = options->reporter};

  PetscFunctionBeginUser;
  PetscCall(LamMapRun(&map));
  if (!map.rank)
    *result = (LamMapResult){.points = map.old + map.solved,
                             .solved = map.solved,
                             .unknown = LamMapCountMode(&map, LAM_FAILURE_UNKNOWN),
                             .seconds = LamClock() - map.start,
                             .stopped = LamStopRequested()};
  PetscCall(LamMapDestroy(&map));
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

/* A run as the options say; also of a process. */
static LamFE2Run Run(const char scene_path[], LamFE2Response response, const char database_path[],
                     const char out_path[], const LamReporter *reporter)
{
  LamFE2Run run = LAM_FE2_RUN;

  run.comm = PETSC_COMM_WORLD;
  run.scene_path = scene_path;
  run.response = response;
  run.database_path = database_path;
  run.out_path = out_path;
  run.reporter = *reporter;
  return run;
}

PetscErrorCode LamStudyFE2(const char scene_path[], const LamFE2Options *options, LamMacroReason *reason,
                           char message[])
{
  LamFE2Run run = Run(scene_path, options->response, options->database_path, options->out_path, &options->reporter);
  PetscBool finished;

  PetscFunctionBeginUser;
  PetscCheck(options->database_path || options->response != LAM_FE2_DATABASE, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL,
             "response \"%s\" needs a database", LamFE2ResponseNames[options->response]);
  PetscCheck(options->out_path || !options->resume, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL,
             "a run can only be resumed where out_path has its results");
  run.resume = options->resume;
  run.step = ReportStep;
  run.step_ctx = (void *)options;
  PetscCall(LamFE2Prepare(&run, &finished));
  if (!finished) PetscCall(LamFE2Solve(&run));
  *reason = run.reason;
  PetscCall(PetscStrncpy(message, run.message, LAM_MESSAGE_LENGTH));
  PetscCall(LamFE2Destroy(&run));
  PetscFunctionReturn(0);
}

/* ---- tissue that changes in time ---- */

static PetscErrorCode ReportPoint(void *ctx, const LamProcessStudy *study)
{
  const LamProcessOptions *options = (const LamProcessOptions *)ctx;

  PetscFunctionBeginUser;
  if (options->point)
    PetscCall(
        options->point(options->reporter.ctx, &study->scene->scales, &study->history.states[study->history.count - 1]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportBody(void *ctx, const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamProcessOptions *options = (const LamProcessOptions *)ctx;

  PetscFunctionBeginUser;
  if (options->body) PetscCall(options->body(options->reporter.ctx, &study->fe2.scene->scales, state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamStudyProcess(const char scene_path[], const LamProcessOptions *options, LamProcessReason *reason,
                               char message[])
{
  LamBodyStudy body = {
      .fe2 = Run(scene_path, options->response, options->database_path, options->out_path, &options->reporter),
      .state = ReportBody};
  LamProcessStudy point = {.out_path = options->out_path, .frames = options->frames, .state = ReportPoint};

  PetscFunctionBeginUser;
  PetscCheck(options->database_path || options->response != LAM_FE2_DATABASE, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL,
             "response \"%s\" needs a database", LamFE2ResponseNames[options->response]);
  body.fe2.step_ctx = (void *)options;
  PetscCall(LamSceneRead(scene_path, &body.fe2.scene));
  if (body.fe2.scene->has_macro && body.fe2.scene->has_process) {
    PetscCall(LamBodyStudyPrepare(&body));
    PetscCall(LamBodyStudySolve(&body));
    *reason = body.reason;
    PetscCall(PetscStrncpy(message, body.message, LAM_PROCESS_MESSAGE));
  } else {
    point.response = body.fe2;
    point.scene = body.fe2.scene;
    PetscCall(LamProcessStudyRun(&point));
    *reason = point.reason;
    PetscCall(PetscStrncpy(message, point.message, LAM_PROCESS_MESSAGE));
  }
  PetscCall(LamBodyStudyDestroy(&body));
  PetscFunctionReturn(0);
}

/* ---- error against time ---- */

static PetscErrorCode ReportSettings(const LamTradeoff *t, const LamTradeoffOptions *options)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n && options->setting; i++) {
    const LamMeasurement *m = &t->measured[i];
    const LamTradeoffSetting setting = {.family = LamKnobNames[m->setting.knob],
                                        .setting = m->setting.label,
                                        .planned = m->setting.planned,
                                        .runs = m->runs,
                                        .reason = m->reason,
                                        .core_seconds = m->cpu_spread.median,
                                        .P = m->error[LAM_ERROR_P].largest,
                                        .tangent = m->error[LAM_ERROR_TANGENT].largest,
                                        .opening = m->error[LAM_ERROR_OPENING].largest,
                                        .reaction = m->error[LAM_ERROR_MACRO].largest};

    PetscCall(options->setting(options->reporter.ctx, &setting));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamStudyTradeoff(const char scene_path[], const LamTradeoffOptions *options, PetscBool *solved)
{
  LamTradeoff t = {
      .scene_path = scene_path, .repeats = options->repeats, .budget = options->seconds, .reporter = options->reporter};
  PetscInt families = 0;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCheck(size == 1, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "measures the time of one core; run it on one rank");
  for (int k = 0; k < LAM_KNOB_COUNT; k++) {
    t.chosen[k] = (PetscBool)(!options->family || !strcmp(options->family, LamKnobNames[k]));
    families += t.chosen[k];
  }
  PetscCheck(families, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "family \"%s\": unknown", options->family);
  PetscCall(LamTradeoffRun(&t));
  PetscCall(ReportSettings(&t, options));
  *solved = LamTradeoffIsSolved(&t);
  PetscCall(LamTradeoffDestroy(&t));
  PetscFunctionReturn(0);
}
