/*
  lamella build: fills the table of a response database.

  Method
    In rounds (build.h): rank 0 asks the table of the rounds before the states of the sample box, and has the nodes that
    it lacks solved by all ranks, each from its parent (node_solver.h). Nodes are committed in the order of their keys,
    round by round, so the file does not depend on the number of ranks (except times, and checksums, which cover them).
*/
#include "build.h"
#include "dispatch.h"
#include "node_solver.h"
#include <petsctime.h>
#include <string.h>
#include <unistd.h>

enum { COMMIT_RECORDS = 64 };
#define COMMIT_SECONDS 2.0

typedef struct {
  LamScene *scene;
  const char *path;
  PetscBool json, quiet;
  LamRVE rve;
  LamGrid grid;
  LamNodeChain chain;
  LamDispatch dispatch;
  PetscInt count;   /* nodes to solve in this round; 0: the build is at its end */
  PetscInt64 *keys; /* [count] theirs */

  /* on rank 0 */
  LamRecordWriter writer;
  LamProgress progress;
  LamDatabase file; /* what was there before; NULL: nothing */
  LamRounds rounds;
  PetscBool *solved;           /* [count] */
  PetscInt arrived, committed; /* of the count; the first so many are committed */
  PetscInt64 added, failed;    /* committed by this run; those without an answer */
  PetscLogDouble start, last_commit;
} Build;

/* Nodes in the file that this build has asked for. */
static PetscInt64 Records(const Build *b)
{
  return b->rounds.nodes + b->rounds.n - b->rounds.missing + b->committed;
}

static PetscInt64 Failed(const Build *b)
{
  return b->rounds.known_failed + b->failed;
}

/* ---- commits ---- */

static PetscErrorCode Report(Build *b)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  PetscCall(LamPrintJSON(json_pack("{s:I, s:I, s:o, s:o, s:o}", "records", (json_int_t)Records(b), "failed",
                                   (json_int_t)Failed(b), "seconds", LamJSONReal(now - b->start), "answered",
                                   LamJSONReal(LamRoundsAnswered(&b->rounds)), "error_95",
                                   LamJSONReal(b->rounds.poll.error))));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(Build *b, PetscInt n)
{
  LamResponse *responses;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &responses));
  for (PetscInt k = 0; k < n; k++) {
    responses[k] = b->rounds.responses[b->rounds.place[b->committed + k]];
    b->failed += responses[k].status != LAM_CONVERGED;
  }
  PetscCall(LamRecordWriterCommit(b->writer, n, b->keys + b->committed, responses));
  PetscCall(PetscFree(responses));
  b->committed += n;
  b->added += n;
  PetscCall(PetscTime(&b->last_commit));
  if (b->json) PetscCall(Report(b));
  PetscFunctionReturn(0);
}

/* Commits the solved nodes that follow without a gap: when they are many, when it is time, or when asked to. */
static PetscErrorCode CommitReady(Build *b, PetscBool now)
{
  PetscLogDouble time;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  while (b->committed + n < b->count && b->solved[b->committed + n]) n++;
  PetscCall(PetscTime(&time));
  if (n && (now || n >= COMMIT_RECORDS || time - b->last_commit >= COMMIT_SECONDS)) PetscCall(Commit(b, n));
  PetscFunctionReturn(0);
}

/* ---- rounds ---- */

/* A LamWork: node `index` of the round's keys. */
static PetscErrorCode SolveNode(void *ctx, PetscInt64 index, void *result)
{
  Build *b = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamNodeChainSolve(b->chain, b->keys[index], result));
  PetscFunctionReturn(0);
}

/* A LamWorked */
static PetscErrorCode Arrive(void *ctx, PetscInt64 index, const void *result)
{
  Build *b = ctx;

  PetscFunctionBeginUser;
  b->rounds.responses[b->rounds.place[index]] = *(const LamResponse *)result;
  b->solved[index] = PETSC_TRUE;
  b->arrived++;
  PetscCall(CommitReady(b, PETSC_FALSE));
  PetscCall(LamProgressUpdate(&b->progress, b->rounds.nodes + b->rounds.n - b->rounds.missing + b->arrived, Failed(b)));
  PetscFunctionReturn(0);
}

static PetscErrorCode NextRound(Build *b)
{
  PetscFunctionBeginUser;
  b->count = 0;
  if (!LamStopRequested()) PetscCall(LamRoundsNext(&b->rounds));
  if (LamStopRequested()) PetscFunctionReturn(0);
  b->count = b->rounds.missing;
  PetscCall(PetscFree(b->solved));
  PetscCall(PetscCalloc1(b->count, &b->solved));
  PetscFunctionReturn(0);
}

/* The keys of the round, from rank 0 to all. */
static PetscErrorCode ShareRound(Build *b)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&b->count, 1, MPIU_INT, 0, b->dispatch.comm));
  PetscCall(PetscFree(b->keys));
  PetscCall(PetscMalloc1(b->count, &b->keys));
  for (PetscInt k = 0; k < b->count && !b->dispatch.rank; k++) b->keys[k] = b->rounds.poll.keys[b->rounds.place[k]];
  PetscCallMPI(MPI_Bcast(b->keys, (PetscMPIInt)b->count, MPIU_INT64, 0, b->dispatch.comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveRound(Build *b)
{
  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&b->progress, b->rounds.nodes + b->rounds.n, b->quiet));
  PetscCall(LamDispatchRun(&b->dispatch, 0, b->count, Arrive, b));
  PetscCall(CommitReady(b, PETSC_TRUE));
  PetscCall(LamProgressEnd(&b->progress));
  if (b->committed < b->count) PetscFunctionReturn(0); /* stopped */
  PetscCall(LamRoundsComplete(&b->rounds));
  b->arrived = b->committed = 0;
  PetscFunctionReturn(0);
}

/* A worker that fails cannot tell rank 0, which waits for its result: it goes straight to main, which ends the job. */
static PetscErrorCode RunRounds(Build *b)
{
  const PetscBool root = (PetscBool)(b->dispatch.rank == 0);
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  for (;;) {
    if (root && !ierr) ierr = NextRound(b);
    PetscCall(LamDispatchShare(&b->dispatch, ierr));
    PetscCall(ShareRound(b));
    if (!b->count) break;
    if (root) {
      ierr = SolveRound(b);
      PetscCall(LamDispatchEnd(&b->dispatch));
    } else {
      PetscCall(LamDispatchServe(&b->dispatch));
    }
  }
  PetscFunctionReturn(0);
}

/* ---- the file and its grid, on rank 0 ---- */

static PetscErrorCode OpenWriter(Build *b, PetscBool resume)
{
  const PetscBool exists = (PetscBool)!access(b->path, F_OK);

  PetscFunctionBeginUser;
  PetscCheck(resume || !exists, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give --resume to go on with it, or remove it", b->path);
  PetscCall(LamRecordWriterOpen(b->path, "database", LAM_WRITE_APPEND, b->scene, &b->writer));
  if (exists) PetscCall(LamDatabaseOpen(b->path, &b->file));
  PetscFunctionReturn(0);
}

/* Free cells' states come with it: the first commit. */
static PetscErrorCode NewGrid(Build *b, LamGrid *grid)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamResponder solver;
  char *text;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamRVEResponderCreate(b->rve, 0, &solver));
  PetscCall(LamGridCreate(b->scene, &solver, grid));
  PetscCall(solver.destroy(&solver.ctx));
  PetscCall(LamGridGetText(*grid, &text));
  PetscCall(LamRecordWriterText(b->writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscCall(LamGridGetRecords(*grid, &n, &keys, &records));
  PetscCall(LamRecordWriterCommit(b->writer, n, keys, records));
  b->added = n;
  PetscFunctionReturn(0);
}

static PetscErrorCode OldGrid(Build *b, LamGrid *grid)
{
  PetscBool found;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(b->path, LAM_GRID_NAME, &found, &text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no grid (%s): its records are of an older lamella, or of no build; give the new database another "
             "name",
             b->path, LAM_GRID_NAME);
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, grid));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscErrorCode StartRounds(Build *b, PetscBool resume)
{
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(OpenWriter(b, resume));
  if (b->file)
    PetscCall(OldGrid(b, &grid));
  else
    PetscCall(NewGrid(b, &grid));
  PetscCall(LamRoundsCreate(b->scene, b->file, &grid, &b->rounds));
  PetscFunctionReturn(0);
}

/* The grid, from rank 0 to all: the others, and a later run, have it from its text. */
static PetscErrorCode ShareGrid(Build *b)
{
  char *text = NULL;
  PetscInt length;
  LamGrid grid;

  PetscFunctionBeginUser;
  if (!b->dispatch.rank) {
    PetscCall(LamDatabaseGetGrid(b->rounds.table, &grid));
    PetscCall(LamGridGetText(grid, &text));
    length = (PetscInt)strlen(text) + 1;
  }
  PetscCallMPI(MPI_Bcast(&length, 1, MPIU_INT, 0, b->dispatch.comm));
  if (!text) PetscCall(PetscMalloc1(length, &text));
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)length, MPI_CHAR, 0, b->dispatch.comm));
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, &b->grid));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

/* ---- summary ---- */

static void PrintTable(const Build *b, PetscLogDouble seconds)
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
  printf("%-16s %.3g s on %d rank%s\n", "time", seconds, (int)b->dispatch.size, b->dispatch.size > 1 ? "s" : "");
  if (b->added) printf("%-16s %.3g\n", "nodes per s", (PetscReal)b->added / seconds);
  if (LamStopRequested())
    printf("%-16s %s\n", "ended", "stopped by a signal");
  else if (LamRoundsAreIdle(&b->rounds) && !LamPollIsDone(poll))
    printf("%-16s %s\n", "ended", "where two rounds answered less than 1 % of the box more");
  else if (accuracy && !LamPollIsDone(poll))
    printf("%-16s %s\n", "ended", "at the largest number of records");
}

static PetscErrorCode Summary(Build *b)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  if (b->json)
    PetscCall(Report(b)); /* one object per commit has been printed; this one is of the table at the end */
  else
    PrintTable(b, now - b->start);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* Rank 0 keeps the file. */
static PetscErrorCode RunAll(Build *b, PetscBool resume)
{
  const PetscBool root = (PetscBool)(b->dispatch.rank == 0);
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = root ? StartRounds(b, resume) : 0;
  if (ierr) (void)LamRecordWriterClose(&b->writer);
  PetscCall(LamDispatchShare(&b->dispatch, ierr));
  PetscCall(ShareGrid(b));
  PetscCall(LamNodeChainCreate(b->rve, b->scene->micro.interface, b->grid, LAM_NODE_MEMORY, NULL, &b->chain));
  ierr = RunRounds(b);
  if (root && ierr) (void)LamRecordWriterClose(&b->writer);
  PetscCall(ierr);
  if (root) ierr = LamRecordWriterClose(&b->writer);
  PetscCall(LamDispatchShare(&b->dispatch, ierr));
  if (root) PetscCall(Summary(b));
  PetscFunctionReturn(0);
}

/* Rank 0's outcome is everyone's: mpirun reports the largest. */
static PetscErrorCode ExitStatus(Build *b, int *exit_status)
{
  int status = Failed(b) ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, b->dispatch.comm));
  *exit_status = status;
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateRVE(Build *b)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &b->rve));
  PetscCall(LamRVESetMicrostructure(b->rve, &b->scene->micro));
  PetscCall(LamRVESetStrategy(b->rve, b->scene->strategy));
  PetscCall(LamRVESetUp(b->rve));
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
  PetscCall(PetscTime(&b->start));
  b->last_commit = b->start;
  PetscCall(LamSignalsInstall());
  PetscCall(CreateRVE(b));
  PetscCall(LamDispatchCreate(PETSC_COMM_WORLD, SolveNode, b, sizeof(LamResponse), &b->dispatch));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Build *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(b->keys));
  PetscCall(PetscFree(b->solved));
  PetscCall(LamRoundsDestroy(&b->rounds));
  PetscCall(LamDatabaseClose(&b->file));
  PetscCall(LamDispatchDestroy(&b->dispatch));
  PetscCall(LamNodeChainDestroy(&b->chain));
  PetscCall(LamGridDestroy(&b->grid));
  PetscCall(LamRVEDestroy(&b->rve));
  PetscCall(LamSceneDestroy(&b->scene));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandBuild(LamArgs *args, int *exit_status)
{
  Build b = {0};
  PetscBool resume = PETSC_FALSE, done;
  const char *scene_path;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "the database to fill", &b.path},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on with the database where it is there", &resume},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per commit on stdout", &b.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &b.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(
      LamOptionsParse(args, "build SCENE -d DB.h5 [--resume] [--json] [--quiet]",
                      "Solves nodes of a grid until a table of them answers the states of the scene's sample box.",
                      options, 1, &scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!b.path) {
    fprintf(stderr, "lamella build: the database is missing; give -d DB.h5\n");
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamAppInitialize(args));
  PetscCall(Prepare(&b, scene_path));
  PetscCall(RunAll(&b, resume));
  PetscCall(ExitStatus(&b, exit_status));
  PetscCall(Destroy(&b));
  PetscFunctionReturn(0);
}
