/*
  lamella build: fills the table of a response database.
*/
#include "app.h"
#include "build_run.h"
#include "clock.h"
#include <stdio.h>

/* ---- reports ---- */

static void PrintTable(const LamBuild *b, PetscReal seconds)
{
  const LamCoverage *coverage = &b->rounds.coverage;
  const PetscReal accuracy = b->scene->sample.accuracy;

  printf("%-16s %s\n", "database", b->path);
  printf("%-16s %lld (%lld new)\n", "records", (long long)LamBuildRecords(b), (long long)b->added);
  printf("%-16s %lld\n", "failed", (long long)LamBuildFailed(b));
  printf("%-16s %.1f %% of the box\n", "answered", 100 * LamRoundsCovered(&b->rounds));
  if (coverage->refused)
    printf("%-16s %.1f %% of the box, such as: %s\n", "never answered",
           100 * (PetscReal)coverage->refused / (PetscReal)coverage->states, coverage->reason);
  if (coverage->reached)
    printf("%-16s estimated below %.2g %% at 95 %% of the box that is reached\n", "error of P", 100 * coverage->error);
  printf("%-16s %.3g s on %d rank%s\n", "time", seconds, (int)b->size, b->size > 1 ? "s" : "");
  if (b->added) printf("%-16s %.3g\n", "nodes per s", (PetscReal)b->added / seconds);
  if (b->added) printf("%-16s %.2g %% of the time\n", "commits", 100 * b->all_commits / seconds);
  if (LamStopRequested())
    printf("%-16s %s\n", "ended", "stopped by a signal");
  else if (LamRoundsAreIdle(&b->rounds) && !LamCoverageIsDone(coverage))
    printf("%-16s %s\n", "ended", "where two rounds answered less than 1 % of the box more");
  else if (accuracy && !LamCoverageIsDone(coverage))
    printf("%-16s %s\n", "ended", "at the largest number of records");
}

/* One JSON object. */
static PetscErrorCode ReportCommit(void *ctx, const LamBuild *b)
{
  PetscFunctionBeginUser;
  (void)ctx;
  PetscCall(LamPrintJSON(json_pack("{s:I, s:I, s:o, s:o, s:o}", "records", (json_int_t)LamBuildRecords(b), "failed",
                                   (json_int_t)LamBuildFailed(b), "seconds", LamJSONReal(LamClock() - b->start),
                                   "answered", LamJSONReal(LamRoundsCovered(&b->rounds)), "error_95",
                                   LamJSONReal(b->rounds.coverage.error))));
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static PetscErrorCode Run(LamBuild *b, LamConsole *console, const char scene_path[], int *exit_status)
{
  b->reporter = LamConsoleReporter(console);
  if (console->json) b->committed = ReportCommit;

  PetscFunctionBeginUser;
  PetscCall(LamBuildPrepare(b, scene_path));
  PetscCall(LamBuildTable(b));
  LamConsoleClear();
  if (!b->rank && console->json) PetscCall(ReportCommit(NULL, b)); /* the table at the end */
  if (!b->rank && !console->json) PrintTable(b, LamClock() - b->start);
  LamTellStopped(console, b->path, PETSC_TRUE);
  PetscCall(LamShareOutcome((PetscBool)(LamBuildFailed(b) > 0), exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandBuild(LamArgs *args, int *exit_status)
{
  LamBuild b = {.team_size = 1, .shard = {1, 1}};
  LamConsole console = {.command = "build"};
  const char *scene_path, *shard = NULL;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "the database to fill", &b.path},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on with the database where it is there", &b.resume},
      {0, "shard", LAM_OPTION_TEXT, "I/N", "only part I of N of the sample box, for `lamella merge`", &shard},
      {0, "ranks-per-rve", LAM_OPTION_FROM_1, "R", "ranks that factor the matrices of one RVE together; default 1",
       &b.team_size},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per commit on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(
      LamOptionsParse(args, "build SCENE -d DB.h5 [--resume] [--shard I/N] [--ranks-per-rve R] [--json] [--quiet]",
                      "Solves nodes of a grid until their table responds to the states of the scene's sample box.",
                      options, 1, &scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!b.path && !LamUsageError("build", exit_status, "the database is missing; give -d DB.h5")) PetscFunctionReturn(0);
  if (shard && !LamShardParse(shard, &b.shard) &&
      !LamUsageError("build", exit_status, "--shard %s: which part of how many is wanted, such as 1/4 to 4/4", shard))
    PetscFunctionReturn(0);
  PetscCall(args->start(args));
  PetscCall(Run(&b, &console, scene_path, exit_status));
  PetscCall(LamBuildDestroy(&b));
  PetscFunctionReturn(0);
}
