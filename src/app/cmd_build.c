/*
  lamella build: fills the table of a response database.

  Method
    In rounds (build.h): rank 0 asks the table of complete rounds before the states of the sample box, and has the nodes
    that it lacks solved by all ranks, each from its parent (node_work.h), those that will take longest first. They are
    committed in that order, so the file does not depend on the number of ranks (except times, and checksums, which
    cover them). A node that is late holds up those behind it for no longer than LATE.
*/
#include "build.h"
#include <lamella/clock.h>
#include "node_work.h"
#include <string.h>
#include <unistd.h>

/* A commit follows the last one after so many seconds, and so many times what that one took: it may cost 2 %. */
#define COMMIT_SECONDS 1.0
#define COMMIT_SHARE 50.0
enum { COMMIT_RECORDS = 65536 }; /* more are not kept back */
#define LATE 30.0                /* s */

/* What is to be committed next: records in the order of the file. */
typedef struct {
  PetscInt n, room;
  PetscInt64 *keys;       /* [n]; owned */
  LamResponse *responses; /* [n]; owned */
} Pending;

typedef struct {
  LamScene *scene;
  const char *path;
  PetscBool json, quiet;
  PetscBool resume;
  PetscInt group;     /* ranks that one rank hands out to; 0: as many as do */
  PetscInt team_size; /* ranks that solve one RVE together */
  LamShard shard;
  PetscMPIInt rank, size;
  MPI_Comm team, leaders; /* of this rank; leaders: the first ranks of all teams, MPI_COMM_NULL on the others */
  LamRVE rve;
  LamGrid grid;
  LamNodeWork work;
  PetscReal start;

  /* on rank 0 */
  LamRecordWriter writer;
  LamProgress progress;
  LamDatabase file; /* what was there before; NULL: nothing */
  LamRounds rounds;
  Pending pending;
  PetscBool opening;       /* rounds are being opened: what arrives meanwhile opens none */
  PetscInt64 added, there; /* committed by this run; nodes that rounds have found in the file */
  PetscInt64 failed;       /* without an answer, of those committed */
  PetscReal last_commit, commit_seconds, all_commits; /* when it ended; what it took, and all of them, s */
  PetscReal last_taken;                               /* when a record was last taken for the file in its turn */
} Build;

/* Nodes in the file that this build has asked for. */
static PetscInt64 Records(const Build *b)
{
  return b->there + b->added;
}

static PetscInt64 Failed(const Build *b)
{
  return b->rounds.known_failed + b->failed;
}

/* ---- commits ---- */

static PetscErrorCode Report(Build *b)
{
  PetscFunctionBeginUser;
  PetscCall(LamPrintJSON(json_pack("{s:I, s:I, s:o, s:o, s:o}", "records", (json_int_t)Records(b), "failed",
                                   (json_int_t)Failed(b), "seconds", LamJSONReal(LamClock() - b->start), "answered",
                                   LamJSONReal(LamRoundsAnswered(&b->rounds)), "error_95",
                                   LamJSONReal(b->rounds.poll.error))));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(Build *b)
{
  const PetscReal begin = LamClock();
  Pending *p = &b->pending;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterCommit(b->writer, p->n, p->keys, p->responses));
  for (PetscInt i = 0; i < p->n; i++) b->failed += p->responses[i].status != LAM_CONVERGED;
  b->added += p->n;
  p->n = 0;
  b->last_commit = LamClock();
  b->commit_seconds = b->last_commit - begin;
  b->all_commits += b->commit_seconds;
  if (b->json) PetscCall(Report(b));
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeForFile(Build *b, PetscInt64 key, const LamResponse *response)
{
  Pending *p = &b->pending;

  PetscFunctionBeginUser;
  if (p->n == p->room) {
    p->room = PetscMax(256, 2 * p->room);
    PetscCall(PetscRealloc((size_t)p->room * sizeof(*p->keys), &p->keys));
    PetscCall(PetscRealloc((size_t)p->room * sizeof(*p->responses), &p->responses));
  }
  p->keys[p->n] = key;
  p->responses[p->n++] = *response;
  PetscFunctionReturn(0);
}

/* The node that comes as number m in its round. */
static PetscErrorCode TakeNode(Build *b, LamRound *round, PetscInt m)
{
  const PetscInt i = round->order[m];

  PetscFunctionBeginUser;
  PetscCall(TakeForFile(b, round->keys[i], &round->responses[i]));
  round->taken[m] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* What follows without a gap in the order of the file. */
static PetscErrorCode TakeInTurn(Build *b)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < b->rounds.open; r++) {
    LamRound *round = &b->rounds.round[r];

    for (; round->next < round->missing; round->next++) {
      if (round->taken[round->next]) continue;
      if (!round->solved[round->order[round->next]]) PetscFunctionReturn(0);
      PetscCall(TakeNode(b, round, round->next));
      b->last_taken = LamClock();
    }
  }
  PetscFunctionReturn(0);
}

/* All that is there, whatever is missing before it. */
static PetscErrorCode TakeAll(Build *b)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < b->rounds.open; r++) {
    LamRound *round = &b->rounds.round[r];

    for (PetscInt m = round->next; m < round->missing; m++)
      if (!round->taken[m] && round->solved[round->order[m]]) PetscCall(TakeNode(b, round, m));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CommitInTime(Build *b)
{
  const PetscReal waited = LamClock() - b->last_commit;

  PetscFunctionBeginUser;
  if (LamClock() - b->last_taken > LATE) PetscCall(TakeAll(b));
  if (b->pending.n >= COMMIT_RECORDS ||
      (b->pending.n && waited >= PetscMax(COMMIT_SECONDS, COMMIT_SHARE * b->commit_seconds)))
    PetscCall(Commit(b));
  PetscFunctionReturn(0);
}

/* At a stop, and at the end: everything. */
static PetscErrorCode CommitAll(void *ctx)
{
  Build *b = ctx;

  PetscFunctionBeginUser;
  PetscCall(TakeAll(b));
  if (b->pending.n) PetscCall(Commit(b));
  PetscFunctionReturn(0);
}

/* ---- rounds ---- */

static PetscErrorCode WantRound(Build *b, const LamRound *round)
{
  PetscFunctionBeginUser;
  b->there += round->n - round->missing;
  for (PetscInt m = 0; m < round->missing; m++)
    PetscCall(LamNodeWorkWant(b->work, round->keys[round->order[m]], round->cost[m]));
  PetscFunctionReturn(0);
}

/* Closes complete rounds and opens the next. */
static PetscErrorCode OpenRounds(Build *b)
{
  LamRound *round;

  PetscFunctionBeginUser;
  if (b->opening || LamStopRequested()) PetscFunctionReturn(0);
  b->opening = PETSC_TRUE;
  for (;;) {
    PetscCall(TakeInTurn(b));
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
  Build *b = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamRoundsArrive(&b->rounds, key, response));
  PetscCall(OpenRounds(b));
  PetscCall(CommitInTime(b));
  PetscCall(LamProgressUpdate(&b->progress, LamRoundsThere(&b->rounds), Failed(b)));
  PetscFunctionReturn(0);
}

/* A LamNodeKnown */
static const LamResponse *Known(void *ctx, PetscInt64 key)
{
  const Build *b = ctx;

  return LamRoundsKnown(&b->rounds, key);
}

static PetscErrorCode SolveRounds(Build *b)
{
  PetscBool complete;

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&b->progress, 0, b->quiet));
  b->last_commit = b->last_taken = LamClock();
  PetscCall(OpenRounds(b));
  PetscCall(LamNodeWorkRun(b->work, CommitAll, &complete));
  PetscCall(CommitAll(b));
  PetscCall(LamProgressEnd(&b->progress));
  PetscFunctionReturn(0);
}

/* ---- the file and its grid, on rank 0 ---- */

static PetscErrorCode OpenWriter(Build *b)
{
  const PetscBool exists = (PetscBool)!access(b->path, F_OK);

  PetscFunctionBeginUser;
  PetscCheck(b->resume || !exists, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give --resume to go on with it, or remove it", b->path);
  PetscCall(LamRecordWriterOpen(b->path, "database", LAM_WRITE_APPEND, b->scene, &b->writer));
  if (exists) PetscCall(LamDatabaseOpen(b->path, &b->file));
  PetscFunctionReturn(0);
}

/* Free cells' states that come with a grid, those of them that the file has not got. */
static PetscErrorCode CommitFreeCells(Build *b, LamGrid grid)
{
  const LamResponse *records;
  const PetscInt64 *keys, *there;
  PetscInt n, n_there, missing = 0;

  PetscFunctionBeginUser;
  PetscCall(LamGridGetRecords(grid, &n, &keys, &records));
  PetscCall(LamRecordWriterGetKeys(b->writer, &n_there, &there));
  for (PetscInt i = 0; i < n; i++) {
    PetscInt k = 0;

    while (k < n_there && there[k] != keys[i]) k++;
    if (k < n_there) continue;
    PetscCall(TakeForFile(b, keys[i], &records[i]));
    missing++;
  }
  PetscCall(LamRecordWriterCommit(b->writer, b->pending.n, b->pending.keys, b->pending.responses)); /* or 0: its name */
  b->added = missing;
  b->pending.n = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode NewGrid(Build *b, LamResponder *solver, LamGrid *grid)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(b->scene, solver, grid));
  PetscCall(LamGridGetText(*grid, &text));
  PetscCall(LamRecordWriterText(b->writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscCall(CommitFreeCells(b, *grid));
  PetscFunctionReturn(0);
}

/* How many of the grid's free cells the file has. */
static PetscInt CountFreeCells(PetscInt n, const PetscInt64 keys[])
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < n; i++) count += LamKeyIsFreeCell(keys[i]);
  return count;
}

static PetscErrorCode OldGrid(Build *b, LamResponder *solver, LamGrid *grid)
{
  const PetscInt64 *keys;
  PetscBool found;
  PetscInt n, wanted;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(b->path, LAM_GRID_NAME, &found, &text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no grid (%s): its records are of an older lamella, or of no build; give the new database another "
             "name",
             b->path, LAM_GRID_NAME);
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, grid));
  PetscCall(PetscFree(text));
  PetscCall(LamGridGetFreeKeys(*grid, &wanted, &keys));
  PetscCall(LamRecordWriterGetKeys(b->writer, &n, &keys));
  if (CountFreeCells(n, keys) >= wanted) PetscFunctionReturn(0);
  PetscCall(LamGridSolveRecords(*grid, &b->scene->micro, solver)); /* a damaged file may have lost some */
  PetscCall(CommitFreeCells(b, *grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode StartRounds(Build *b)
{
  LamResponder solver;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(OpenWriter(b));
  PetscCall(LamRVEResponderCreate(b->rve, 0, &solver));
  PetscCall(b->file ? OldGrid(b, &solver, &grid) : NewGrid(b, &solver, &grid));
  PetscCall(solver.destroy(&solver.ctx));
  PetscCall(LamRoundsCreate(b->scene, &b->shard, b->file, &grid, &b->rounds));
  b->there = b->rounds.nodes - b->added;
  PetscFunctionReturn(0);
}

/* The grid, from rank 0 to all: the others, and a later run, have it from its text. */
static PetscErrorCode ShareGrid(Build *b)
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

static void PrintTable(const Build *b, PetscReal seconds)
{
  const LamPoll *poll = &b->rounds.poll;
  const PetscReal accuracy = b->scene->sample.accuracy;

  printf("%-16s %s\n", "database", b->path);
  printf("%-16s %lld (%lld new)\n", "records", (long long)Records(b), (long long)b->added);
  printf("%-16s %lld\n", "failed", (long long)Failed(b));
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

static PetscErrorCode Summary(Build *b)
{
  PetscFunctionBeginUser;
  if (b->json)
    PetscCall(Report(b)); /* one object per commit has been printed; this one is of the table at the end */
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

static PetscErrorCode CreateRVE(Build *b)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(b->team, &b->rve));
  PetscCall(LamRVESetMicrostructure(b->rve, &b->scene->micro));
  PetscCall(LamRVESetStrategy(b->rve, b->scene->strategy));
  PetscCall(LamRVESetUp(b->rve));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateWork(Build *b)
{
  const LamNodeCustomer customer = {.ctx = b, .arrived = Arrive, .known = Known};

  PetscFunctionBeginUser;
  PetscCall(LamNodeWorkCreate(b->leaders, b->rve, b->scene->micro.interface, b->grid, LAM_NODE_WORK_MEMORY, b->group,
                              &customer, &b->work));
  PetscFunctionReturn(0);
}

/* Of those that solve an RVE each, or lead a team that does; rank 0 keeps the file. */
static PetscErrorCode RunLeader(Build *b)
{
  const PetscBool root = (PetscBool)(b->rank == 0);
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(CreateRVE(b));
  ierr = root ? StartRounds(b) : 0;
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
static PetscErrorCode RunAll(Build *b)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (b->leaders == MPI_COMM_NULL) {
    PetscCall(LamRVEServe(b->team));
  } else {
    ierr = RunLeader(b);
    PetscCall(LamNodeWorkDestroy(&b->work));
    PetscCall(LamRVEDestroy(&b->rve)); /* the team has a part in its factors */
    if (b->team_size > 1) PetscCall(LamRVEDismiss(b->team));
  }
  PetscCall(Share(PETSC_COMM_WORLD, ierr));
  if (!b->rank) PetscCall(Summary(b));
  PetscFunctionReturn(0);
}

/* Rank 0's outcome is everyone's: mpirun reports the largest. */
static PetscErrorCode ExitStatus(Build *b, int *exit_status)
{
  int status = Failed(b) ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  *exit_status = status;
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateTeams(Build *b)
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

static PetscErrorCode Prepare(Build *b, const char scene_path[])
{
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(scene_path, &b->scene));
  PetscCheck(b->scene->has_sample, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `sample`, which says what states to build from", scene_path);
  PetscCall(LamPlanMake(b->scene, &plan));
  b->scene->micro = plan.micro;
  b->start = LamClock();
  PetscCall(CreateTeams(b));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Build *b)
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
  Build b = {.team_size = 1, .shard = {1, 1}};
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
  PetscCall(RunAll(&b));
  PetscCall(ExitStatus(&b, exit_status));
  PetscCall(Destroy(&b));
  PetscFunctionReturn(0);
}
