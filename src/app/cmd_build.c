/*
  lamella build: fills the table of a response database.

  Method
    In rounds (build.h): rank 0 asks the table of complete rounds before the states of the sample box, and has the nodes
    that it lacks solved by all ranks, each from its parent (node_work.h), those that will take longest first. They are
    committed in that order, so the file does not depend on the number of ranks (except times, and checksums, which
    cover them). A node that is late holds up those behind it for half a minute at most.
*/
#include "build_run.h"
#include "rounding.h"
#include <lamella/clock.h>
#include <string.h>

/* ---- rounds ---- */

static PetscErrorCode WantRound(LamBuild *b, const LamRound *round)
{
  PetscFunctionBeginUser;
  b->there += round->n - round->missing;
  for (PetscInt m = 0; m < round->missing; m++)
    PetscCall(LamNodeWorkWant(b->work, round->keys[round->order[m]], round->cost[m]));
  PetscFunctionReturn(0);
}

/* Closes complete rounds and opens the next. */
static PetscErrorCode OpenRounds(LamBuild *b)
{
  LamRound *round;

  PetscFunctionBeginUser;
  if (b->opening || LamStopRequested()) PetscFunctionReturn(0);
  b->opening = PETSC_TRUE;
  for (;;) {
    PetscCall(LamBuildTakeInTurn(b));
    PetscCall(LamRoundsNext(&b->rounds, &round));
    if (!round) break;
    PetscCall(WantRound(b, round));
  }
  b->opening = PETSC_FALSE;
  LamProgressSetTotal(&b->progress, b->scene->sample.count ? b->rounds.most : LamRoundsAsked(&b->rounds));
  PetscFunctionReturn(0);
}

/* A LamNodeArrived */
static PetscErrorCode Arrive(void *ctx, PetscInt64 key, const LamResponse *response)
{
  LamBuild *b = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamRoundsArrive(&b->rounds, key, response));
  PetscCall(OpenRounds(b));
  PetscCall(LamBuildCommitInTime(b));
  PetscCall(LamProgressUpdate(&b->progress, LamRoundsThere(&b->rounds), LamBuildFailed(b)));
  PetscFunctionReturn(0);
}

/* A LamNodeKnown */
static const LamResponse *Known(void *ctx, PetscInt64 key)
{
  const LamBuild *b = ctx;

  return LamRoundsKnown(&b->rounds, key);
}

static PetscErrorCode SolveRounds(LamBuild *b)
{
  PetscBool complete;

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&b->progress, 0, b->quiet));
  b->last_commit = b->last_taken = LamClock();
  PetscCall(OpenRounds(b));
  PetscCall(LamNodeWorkRun(b->work, LamBuildCommitAll, &complete));
  PetscCall(LamBuildCommitAll(b));
  PetscCall(LamProgressEnd(&b->progress));
  PetscFunctionReturn(0);
}

/* The grid, from rank 0 to all: the others, and a later run, have it from its text. */
static PetscErrorCode ShareGrid(LamBuild *b)
{
  char *text = NULL;
  PetscInt length;
  LamGrid grid;

  PetscFunctionBeginUser;
  if (!b->rank) {
    PetscCall(LamDatabaseGetGrid(b->rounds.table, &grid));
    PetscCall(LamGridGetText(grid, &text));
    length = (PetscInt)strlen(text) + 1;
  }
  PetscCallMPI(MPI_Bcast(&length, 1, MPIU_INT, 0, b->leaders));
  if (!text) PetscCall(PetscMalloc1(length, &text));
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)length, MPI_CHAR, 0, b->leaders));
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, &b->grid));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

/* ---- summary ---- */

static void PrintTable(const LamBuild *b, PetscReal seconds)
{
  const LamPoll *poll = &b->rounds.poll;
  const PetscReal accuracy = b->scene->sample.accuracy;

  printf("%-16s %s\n", "database", b->path);
  printf("%-16s %lld (%lld new)\n", "records", (long long)LamBuildRecords(b), (long long)b->added);
  printf("%-16s %lld\n", "failed", (long long)LamBuildFailed(b));
  printf("%-16s %.1f %% of the box\n", "answered", 100 * LamRoundsAnswered(&b->rounds));
  if (poll->refused)
    printf("%-16s %.1f %% of the box, such as: %s\n", "never answered",
           100 * (PetscReal)poll->refused / (PetscReal)poll->asked, poll->reason);
  if (poll->reached)
    printf("%-16s estimated below %.2g %% at 95 %% of the box that is reached\n", "error of P", 100 * poll->error);
  printf("%-16s %.3g s on %d rank%s\n", "time", seconds, (int)b->size, b->size > 1 ? "s" : "");
  if (b->added) printf("%-16s %.3g\n", "nodes per s", (PetscReal)b->added / seconds);
  if (b->added) printf("%-16s %.2g %% of the time\n", "commits", 100 * b->all_commits / seconds);
  if (LamStopRequested())
    printf("%-16s %s\n", "ended", "stopped by a signal");
  else if (LamRoundsAreIdle(&b->rounds) && !LamPollIsDone(poll))
    printf("%-16s %s\n", "ended", "where two rounds answered less than 1 % of the box more");
  else if (accuracy && !LamPollIsDone(poll))
    printf("%-16s %s\n", "ended", "at the largest number of records");
}

static PetscErrorCode Summary(LamBuild *b)
{
  PetscFunctionBeginUser;
  if (b->json)
    PetscCall(LamBuildReport(b)); /* one object per commit has been printed; this one is of the table at the end */
  else
    PrintTable(b, LamClock() - b->start);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* An error of rank 0 ends every rank; it has been told once. */
static PetscErrorCode Share(MPI_Comm comm, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, comm));
  if (code) return (PetscErrorCode)code;
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateRVE(LamBuild *b)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(b->team, &b->rve));
  PetscCall(LamRVESetMicrostructure(b->rve, &b->scene->micro));
  PetscCall(LamRVESetStrategy(b->rve, b->scene->strategy));
  PetscCall(LamRVESetTolerance(b->rve, b->scene->tolerance));
  PetscCall(LamRVESetUp(b->rve));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateWork(LamBuild *b)
{
  const LamNodeCustomer customer = {.ctx = b, .arrived = Arrive, .known = Known};

  PetscFunctionBeginUser;
  PetscCall(LamNodeWorkCreate(b->leaders, b->rve, b->scene->micro.interface, b->grid, LAM_NODE_WORK_MEMORY, b->group,
                              &customer, &b->work));
  PetscFunctionReturn(0);
}

/* Of those that solve an RVE each, or lead a team that does; rank 0 keeps the file. */
static PetscErrorCode RunLeader(LamBuild *b)
{
  const PetscBool root = (PetscBool)(b->rank == 0);
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(CreateRVE(b));
  ierr = root ? LamBuildStart(b) : 0;
  if (ierr) (void)LamRecordWriterClose(&b->writer);
  PetscCall(Share(b->leaders, ierr));
  PetscCall(ShareGrid(b));
  PetscCall(CreateWork(b));
  ierr = root ? SolveRounds(b) : LamNodeWorkServe(b->work);
  if (ierr)
    (void)LamRecordWriterClose(&b->writer);
  else
    ierr = LamRecordWriterClose(&b->writer);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/*
  The first rank of each team makes all decisions; the others take part in its factorisations until it dismisses them.
  A rank that fails alone goes straight to main, which ends the job.
*/
static PetscErrorCode RunAll(LamBuild *b)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (b->leaders == MPI_COMM_NULL) {
    PetscCall(LamRVEServe(b->team, LamStopInterrupt, NULL));
  } else {
    ierr = RunLeader(b);
    PetscCall(LamNodeWorkDestroy(&b->work));
    PetscCall(LamRVEDestroy(&b->rve)); /* the team has a part in its factors */
    if (b->team_size > 1) PetscCall(LamRVEDismiss(b->team));
  }
  PetscCall(Share(PETSC_COMM_WORLD, ierr));
  PetscFunctionReturn(0);
}

/* Rank 0's outcome is everyone's: mpirun reports the largest. */
static PetscErrorCode ExitStatus(LamBuild *b, int *exit_status)
{
  int status = LamBuildFailed(b) ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  *exit_status = status;
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateTeams(LamBuild *b)
{
  PetscMPIInt place;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &b->rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &b->size));
  PetscCallMPI(MPI_Comm_split(PETSC_COMM_WORLD, (int)(b->rank / b->team_size), b->rank, &b->team));
  PetscCallMPI(MPI_Comm_rank(b->team, &place));
  PetscCallMPI(MPI_Comm_split(PETSC_COMM_WORLD, place ? MPI_UNDEFINED : 0, b->rank, &b->leaders));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(LamBuild *b, const char scene_path[])
{
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(scene_path, &b->scene));
  PetscCheck(b->scene->has_sample, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `sample`, which says what states to build from", scene_path);
  PetscCall(LamPlanMake(b->scene, &plan));
  PetscCall(LamWarnOfDigits(&plan.micro, b->scene->accuracy));
  b->scene->micro = plan.micro;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildTable(LamBuild *b)
{
  PetscFunctionBeginUser;
  b->start = LamClock();
  PetscCall(CreateTeams(b));
  PetscCall(RunAll(b));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildDestroy(LamBuild *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(b->pending.keys));
  PetscCall(PetscFree(b->pending.responses));
  PetscCall(LamRoundsDestroy(&b->rounds));
  PetscCall(LamDatabaseClose(&b->file));
  PetscCall(LamGridDestroy(&b->grid));
  PetscCallMPI(MPI_Comm_free(&b->team));
  if (b->leaders != MPI_COMM_NULL) PetscCallMPI(MPI_Comm_free(&b->leaders));
  PetscCall(LamSceneDestroy(&b->scene));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandBuild(LamArgs *args, int *exit_status)
{
  LamBuild b = {.team_size = 1, .shard = {1, 1}};
  const char *scene_path, *group = NULL, *team = NULL, *shard = NULL;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "the database to fill", &b.path},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on with the database where it is there", &b.resume},
      {0, "shard", LAM_OPTION_TEXT, "I/N", "only part I of N of the sample box, for `lamella merge`", &shard},
      {0, "ranks-per-rve", LAM_OPTION_TEXT, "R", "ranks that factor the matrices of one RVE together; default 1",
       &team},
      {0, "group", LAM_OPTION_TEXT, "G", "ranks that one rank hands out work to; default 128", &group},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per commit on stdout", &b.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &b.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args, "build SCENE -d DB.h5 [--resume] [--shard I/N] [--ranks-per-rve R] [--group G] [--json] [--quiet]",
      "Solves nodes of a grid until a table of them answers the states of the scene's sample box.", options, 1,
      &scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!b.path) {
    fprintf(stderr, "lamella build: the database is missing; give -d DB.h5\n");
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  if ((group && !LamCountParse("build", "--group", group, 1, &b.group, exit_status)) ||
      (team && !LamCountParse("build", "--ranks-per-rve", team, 1, &b.team_size, exit_status)) ||
      (shard && !LamShardParse(shard, &b.shard, exit_status)))
    PetscFunctionReturn(0);
  PetscCall(LamAppInitialize(args));
  PetscCall(Prepare(&b, scene_path));
  PetscCall(LamBuildTable(&b));
  if (!b.rank) PetscCall(Summary(&b));
  PetscCall(ExitStatus(&b, exit_status));
  PetscCall(LamBuildDestroy(&b));
  PetscFunctionReturn(0);
}
