/*
  lamella build: fills a response database.

  Method
    States are solved in any order on all ranks and committed in the order of their numbers, so the file does not
    depend on the number of ranks (except times, and checksums, which cover them), and the sample states in it are
    always 0..n-1: --resume goes on with n. Records with a key from LAM_CACHE_KEY on are of others, and passed over.
    With a count, that many states. With an accuracy, batches: each is first predicted from the records before it, then
    solved, and the build ends when 95 % of the states of the last two batches were within the trust radius of a record
    and predicted with an error below the accuracy, or at MOST_RECORDS.
*/
#include "build.h"
#include "dispatch.h"
#include <math.h>
#include <petsctime.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COMMIT_RECORDS = 64, BATCH = 64, MOST_RECORDS = 20000 };
#define COMMIT_SECONDS 2.0
#define QUANTILE 0.95

typedef struct {
  LamScene *scene;
  const char *path;
  PetscBool json, quiet;
  LamSampler sampler;
  LamDispatch dispatch;
  LamRecordWriter writer;
  LamProgress progress;
  PetscInt64 target; /* number of states at most */

  PetscInt64 committed, begun_with; /* sample states 0..committed-1 are in the file; begun_with: when this run began */
  PetscInt capacity;
  LamResponse *waiting; /* [capacity] states committed, committed+1, ...: solved or not yet */
  PetscBool *solved;    /* [capacity] */
  PetscInt64 arrived, failed;
  PetscLogDouble start, last_commit;

  LamDatabase database;                      /* what is known so far; for predictions, NULL with a count */
  PetscReal *errors;                         /* [2 * BATCH] of the last two batches; infinite: out of reach */
  PetscInt error_count, last_count, batches; /* last_count: of the last batch alone */
  PetscReal error;                           /* their quantile; NaN: not known */
} Build;

/* ---- commits ---- */

static PetscErrorCode Report(Build *b)
{
  PetscLogDouble now;
  json_t *object;

  PetscFunctionBeginUser;
  PetscCall(LamProgressUpdate(&b->progress, b->begun_with + b->arrived, b->failed));
  if (!b->json) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  object = json_pack("{s:I, s:I, s:o}", "records", (json_int_t)b->committed, "failed", (json_int_t)b->failed, "seconds",
                     LamJSONReal(now - b->start));
  if (b->database) json_object_set_new(object, "error_95", LamJSONReal(b->error));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(Build *b, PetscInt n)
{
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &keys));
  for (PetscInt i = 0; i < n; i++) keys[i] = b->committed + i;
  PetscCall(LamRecordWriterCommit(b->writer, n, keys, b->waiting));
  PetscCall(PetscFree(keys));
  for (PetscInt i = 0; i < n; i++) b->failed += b->waiting[i].status != LAM_CONVERGED;
  if (b->database) PetscCall(LamDatabaseAdd(b->database, n, NULL, b->waiting));
  memmove(b->waiting, b->waiting + n, (size_t)(b->capacity - n) * sizeof(*b->waiting));
  memmove(b->solved, b->solved + n, (size_t)(b->capacity - n) * sizeof(*b->solved));
  memset(b->solved + b->capacity - n, 0, (size_t)n * sizeof(*b->solved));
  b->committed += n;
  PetscCall(PetscTime(&b->last_commit));
  PetscCall(Report(b));
  PetscFunctionReturn(0);
}

/* Commits the solved states that follow without a gap: when they are many, when it is time, or when asked to. */
static PetscErrorCode CommitReady(Build *b, PetscBool now)
{
  PetscLogDouble time;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  while (n < b->capacity && b->solved[n]) n++;
  PetscCall(PetscTime(&time));
  if (n && (now || n >= COMMIT_RECORDS || time - b->last_commit >= COMMIT_SECONDS)) PetscCall(Commit(b, n));
  PetscFunctionReturn(0);
}

static PetscErrorCode Reserve(Build *b, PetscInt n)
{
  const PetscInt capacity = PetscMax(2 * b->capacity, n);

  PetscFunctionBeginUser;
  if (n <= b->capacity) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)capacity * sizeof(*b->waiting), &b->waiting));
  PetscCall(PetscRealloc((size_t)capacity * sizeof(*b->solved), &b->solved));
  memset(b->solved + b->capacity, 0, (size_t)(capacity - b->capacity) * sizeof(*b->solved));
  b->capacity = capacity;
  PetscFunctionReturn(0);
}

/* A LamWorked */
static PetscErrorCode Arrive(void *ctx, PetscInt64 index, const void *result)
{
  Build *b = ctx;
  const PetscInt at = (PetscInt)(index - b->committed);

  PetscFunctionBeginUser;
  PetscCall(Reserve(b, at + 1));
  b->waiting[at] = *(const LamResponse *)result;
  b->solved[at] = PETSC_TRUE;
  b->arrived++;
  PetscCall(LamProgressUpdate(&b->progress, b->begun_with + b->arrived, b->failed));
  PetscCall(CommitReady(b, PETSC_FALSE));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(Build *b, PetscInt64 last)
{
  PetscFunctionBeginUser;
  PetscCall(LamDispatchRun(&b->dispatch, b->committed, last, Arrive, b));
  PetscCall(CommitReady(b, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* ---- sampling until an accuracy is reached ---- */

static int Ascending(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

static PetscReal Quantile(PetscInt n, const PetscReal errors[])
{
  PetscReal sorted[2 * BATCH];

  if (!n) return NAN;
  memcpy(sorted, errors, (size_t)n * sizeof(*sorted));
  qsort(sorted, (size_t)n, sizeof(*sorted), Ascending);
  return sorted[PetscMin(n - 1, (PetscInt)(QUANTILE * (PetscReal)n))];
}

/* Errors of the predictions for a batch, of states that have an answer; the batch before it stays in the window. */
static void Compare(Build *b, PetscInt n, const LamResponse predicted[], const LamResponse solved[])
{
  PetscInt count = b->last_count;

  memmove(b->errors, b->errors + b->error_count - count, (size_t)count * sizeof(*b->errors));
  for (PetscInt i = 0; i < n; i++) {
    if (solved[i].status != LAM_CONVERGED) continue;
    b->errors[count++] = predicted[i].status == LAM_CONVERGED ? LamStressError(predicted[i].P, solved[i].P) : INFINITY;
  }
  b->last_count = count - b->last_count;
  b->error_count = count;
  b->error = Quantile(count, b->errors);
  b->batches++;
}

/* One batch: predict, solve (what the file does not hold), compare. `first` is a multiple of BATCH. */
static PetscErrorCode RunBatch(Build *b, PetscInt64 first, PetscInt n, const LamResponse old[], PetscInt64 old_count)
{
  const PetscInt have = (PetscInt)PetscMin(n, PetscMax(old_count - first, 0));
  const LamResponse *records;
  LamResponse *predicted;
  PetscInt known;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &predicted));
  for (PetscInt i = 0; i < n; i++) {
    LamLoad load;

    LamSampleLoad(b->scene, first + i, &load);
    PetscCall(LamDatabaseQuery(b->database, &load, b->scene->sample.accuracy, &predicted[i]));
  }
  PetscCall(LamDatabaseAdd(b->database, have, NULL, old + first));
  if (have < n) PetscCall(Solve(b, first + n));
  PetscCall(LamDatabaseGetRecords(b->database, &known, &records, NULL));
  if (known == first + n) Compare(b, n, predicted, records + first);
  PetscCall(PetscFree(predicted));
  PetscFunctionReturn(0);
}

static PetscBool AccuracyReached(const Build *b)
{
  return (PetscBool)(b->batches >= 2 && b->error_count >= BATCH / 2 && b->error <= b->scene->sample.accuracy);
}

/* Batches that the file holds are predicted again, so the end does not depend on where a run was interrupted. */
static PetscErrorCode RunUntilAccurate(Build *b, const LamResponse old[], PetscInt64 old_count)
{
  PetscFunctionBeginUser;
  PetscCall(LamDatabaseCreateEmpty(b->scene, &b->database));
  PetscCall(PetscMalloc1(2 * BATCH, &b->errors));
  for (PetscInt64 first = 0; first < b->target && !AccuracyReached(b) && !LamStopRequested(); first += BATCH)
    PetscCall(RunBatch(b, first, (PetscInt)PetscMin(BATCH, b->target - first), old, old_count));
  PetscFunctionReturn(0);
}

/* ---- going on with a file ---- */

/* The sample states of a file, without what others have added to it; old[] and keys[] are the caller's to free. */
static PetscErrorCode SampleStates(LamDatabase file, PetscInt *n, LamResponse **old, PetscInt64 **keys)
{
  const LamResponse *all = NULL;
  const PetscInt64 *all_keys = NULL;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  if (file) PetscCall(LamDatabaseGetRecords(file, &count, &all, &all_keys));
  PetscCall(PetscMalloc1(count, old));
  PetscCall(PetscMalloc1(count, keys));
  *n = 0;
  for (PetscInt i = 0; i < count; i++) {
    if (all_keys[i] >= LAM_CACHE_KEY) continue;
    (*old)[*n] = all[i];
    (*keys)[(*n)++] = all_keys[i];
  }
  PetscFunctionReturn(0);
}

/* They must be states 0, 1, ... of this very box. */
static PetscErrorCode CheckOld(const Build *b, PetscInt n, const LamResponse old[], const PetscInt64 keys[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscReal difference;
    LamLoad load;

    LamSampleLoad(b->scene, i, &load);
    difference = fabs(load.turgor - old[i].load.turgor) + fabs(load.cohesion - old[i].load.cohesion);
    for (int k = 0; k < 9; k++) difference += fabs(load.F[k] - old[i].load.F[k]);
    PetscCheck(keys[i] == i && difference < 1e-9, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: sample record %" PetscInt_FMT " is not state %" PetscInt_FMT
               " of the sample box of %s; --resume needs the "
               "scene that the file was begun with",
               b->path, i, i, b->scene->path);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode RunFrom(Build *b, LamDatabase file)
{
  LamResponse *old;
  PetscInt64 *keys;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(SampleStates(file, &n, &old, &keys));
  PetscCall(CheckOld(b, n, old, keys));
  for (PetscInt i = 0; i < n; i++) b->failed += old[i].status != LAM_CONVERGED;
  b->committed = b->begun_with = n;
  PetscCall(LamProgressStart(&b->progress, b->target, b->quiet));
  if (b->scene->sample.count)
    PetscCall(Solve(b, b->target));
  else
    PetscCall(RunUntilAccurate(b, old, n));
  PetscCall(LamProgressEnd(&b->progress));
  PetscCall(PetscFree(old));
  PetscCall(PetscFree(keys));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(Build *b)
{
  const PetscBool exists = (PetscBool)!access(b->path, F_OK);
  LamDatabase file = NULL;

  PetscFunctionBeginUser;
  if (exists) PetscCall(LamDatabaseOpen(b->path, &file));
  PetscCall(RunFrom(b, file));
  PetscCall(LamDatabaseClose(&file));
  PetscFunctionReturn(0);
}

/* ---- summary ---- */

static PetscErrorCode Summary(Build *b)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  if (b->json) {
    /* one object per commit has been printed; where nothing was solved, or the error known after it, one more */
    if (!b->arrived || b->database) PetscCall(Report(b));
    PetscFunctionReturn(0);
  }
  printf("%-16s %s\n", "database", b->path);
  printf("%-16s %lld (%lld new)\n", "records", (long long)b->committed, (long long)(b->committed - b->begun_with));
  printf("%-16s %lld\n", "failed", (long long)b->failed);
  printf("%-16s %.3g s on %d rank%s\n", "time", now - b->start, (int)b->dispatch.size, b->dispatch.size > 1 ? "s" : "");
  if (b->arrived) printf("%-16s %.3g\n", "states per s", (PetscReal)b->arrived / (now - b->start));
  if (b->database && isfinite(b->error))
    printf("%-16s %.2g %% at 95 %% of new states (wanted %.2g %%)\n", "error of P", 100 * b->error,
           100 * b->scene->sample.accuracy);
  if (b->database && !AccuracyReached(b))
    printf("%-16s %s\n", "ended", LamStopRequested() ? "stopped by a signal" : "at the largest number of records");
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static PetscErrorCode OpenWriter(Build *b, PetscBool resume)
{
  PetscFunctionBeginUser;
  PetscCheck(resume || access(b->path, F_OK), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give --resume to go on with it, or remove it", b->path);
  PetscCall(LamRecordWriterOpen(b->path, "database", LAM_WRITE_APPEND, b->scene, &b->writer));
  PetscFunctionReturn(0);
}

/* Rank 0 keeps the file. A worker that fails cannot tell rank 0, which waits for its result: it ends the job. */
static PetscErrorCode RunAll(Build *b, PetscBool resume)
{
  const PetscBool root = (PetscBool)(b->dispatch.rank == 0);
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(LamDispatchShare(&b->dispatch, root ? OpenWriter(b, resume) : 0));
  if (root) {
    ierr = RunRoot(b);
    PetscCall(LamDispatchEnd(&b->dispatch));
    if (!ierr)
      ierr = LamRecordWriterClose(&b->writer);
    else
      (void)LamRecordWriterClose(&b->writer);
  } else {
    /* alone with its error, a worker goes straight to main, which tells it and ends the job */
    PetscCall(LamDispatchServe(&b->dispatch));
  }
  PetscCall(LamDispatchShare(&b->dispatch, ierr));
  if (root) PetscCall(Summary(b));
  PetscFunctionReturn(0);
}

/* Rank 0's outcome is everyone's: mpirun reports the largest. */
static PetscErrorCode ExitStatus(Build *b, int *exit_status)
{
  int status = b->failed ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, b->dispatch.comm));
  *exit_status = status;
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
  b->target = b->scene->sample.count ? b->scene->sample.count : MOST_RECORDS;
  b->error = NAN;
  PetscCall(PetscTime(&b->start));
  b->last_commit = b->start;
  PetscCall(LamSignalsInstall());
  PetscCall(LamSamplerCreate(b->scene, &b->sampler));
  PetscCall(LamDispatchCreate(PETSC_COMM_WORLD, LamSamplerSolve, &b->sampler, sizeof(LamResponse), &b->dispatch));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Build *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(b->waiting));
  PetscCall(PetscFree(b->solved));
  PetscCall(PetscFree(b->errors));
  PetscCall(LamDatabaseClose(&b->database));
  PetscCall(LamDispatchDestroy(&b->dispatch));
  PetscCall(LamSamplerDestroy(&b->sampler));
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
  PetscCall(LamOptionsParse(args, "build SCENE -d DB.h5 [--resume] [--json] [--quiet]",
                            "Solves the states of the scene's sample box and stores their responses.", options, 1,
                            &scene_path, &done, exit_status));
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
