/*
  lamella build: fills the table of a response database.
*/
#include "app.h"
#include "build_run.h"
#include "clock.h"
#include <stdio.h>

typedef struct {
  PetscBool json, quiet;
  LamProgress progress;
} Report;

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

/* Message function of a LamReporter. */
static void PrintMessage(void *ctx, PetscBool warning, const char text[])
{
  const Report *report = (const Report *)ctx;

  if (warning || !report->quiet) fprintf(stderr, "lamella build: %s\n", text);
}

static PetscErrorCode UpdateProgress(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  Report *report = (Report *)ctx;

  PetscFunctionBeginUser;
  LamProgressSetTotal(&report->progress, total);
  PetscCall(LamProgressUpdate(&report->progress, done, failed));
  PetscFunctionReturn(0);
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

static PetscBool ParseShard(const char text[], LamShard *shard, int *exit_status)
{
  if (LamShardParse(text, shard)) return PETSC_TRUE;
  fprintf(stderr, "lamella build: --shard %s: which part of how many is wanted, such as 1/4 to 4/4\n", text);
  *exit_status = LAM_EXIT_USAGE;
  return PETSC_FALSE;
}

/* The outcome of rank 0 applies to all ranks: mpirun reports the largest status. */
static PetscErrorCode ExitStatus(LamBuild *b, int *exit_status)
{
  int status = LamBuildFailed(b) ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  *exit_status = status;
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(LamBuild *b, Report *report, const char scene_path[], int *exit_status)
{
  b->reporter = (LamReporter){report, PrintMessage, UpdateProgress};
  if (report->json) b->committed = ReportCommit;

  PetscFunctionBeginUser;
  PetscCall(LamBuildPrepare(b, scene_path));
  PetscCall(LamProgressStart(&report->progress, 0, report->quiet));
  PetscCall(LamBuildTable(b));
  PetscCall(LamProgressEnd(&report->progress));
  if (!b->rank && report->json) PetscCall(ReportCommit(NULL, b)); /* the table at the end */
  if (!b->rank && !report->json) PrintTable(b, LamClock() - b->start);
  PetscCall(ExitStatus(b, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandBuild(LamArgs *args, int *exit_status)
{
  LamBuild b = {.team_size = 1, .shard = {1, 1}};
  Report report = {0};
  const char *scene_path, *team = NULL, *shard = NULL;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "the database to fill", &b.path},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on with the database where it is there", &b.resume},
      {0, "shard", LAM_OPTION_TEXT, "I/N", "only part I of N of the sample box, for `lamella merge`", &shard},
      {0, "ranks-per-rve", LAM_OPTION_TEXT, "R", "ranks that factor the matrices of one RVE together; default 1",
       &team},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per commit on stdout", &report.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &report.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(
      LamOptionsParse(args, "build SCENE -d DB.h5 [--resume] [--shard I/N] [--ranks-per-rve R] [--json] [--quiet]",
                      "Solves nodes of a grid until a table of them answers the states of the scene's sample box.",
                      options, 1, &scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!b.path) {
    fprintf(stderr, "lamella build: the database is missing; give -d DB.h5\n");
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  if ((team && !LamCountParse("build", "--ranks-per-rve", team, 1, &b.team_size, exit_status)) ||
      (shard && !ParseShard(shard, &b.shard, exit_status)))
    PetscFunctionReturn(0);
  PetscCall(args->start(args));
  PetscCall(Run(&b, &report, scene_path, exit_status));
  PetscCall(LamBuildDestroy(&b));
  PetscFunctionReturn(0);
}
