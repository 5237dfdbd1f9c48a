/* Tasks that rank 0 hands out: on one rank, and on several by tests/mpi/dispatch.sh. */
#include <signal.h>
#include <string.h>
#include <time.h>
#include <dispatch.h>
#include <support/test.h>

TEST_GROUP(.petsc = 1);

enum { TASKS = 300, MOST = 2 * TASKS, FAIL_AFTER = 20 };
enum { BYTES = 20000 }; /* larger than what MPI sends before the receiver takes it */

typedef struct {
  LamDispatch dispatch;
  PetscMPIInt rank, size;
  PetscInt64 count, more; /* tasks that `worked` adds, one for each of the first */
  PetscInt64 fail_after;  /* results; 0: never */
  PetscInt64 order[MOST];
  PetscInt done[MOST];
  PetscBool stopped;
} Run;

static void Pause(long us)
{
  nanosleep(&(struct timespec){0, 1000 * us}, NULL);
}

/* An input as long as the task's number makes it. */
static size_t SizeOf(PetscInt64 task)
{
  return (size_t)(8 + task * 61 % (BYTES - 8));
}

static PetscErrorCode Describe(void *ctx, PetscInt64 task, void *input, size_t *size)
{
  (void)ctx;
  *size = SizeOf(task);
  memset(input, (int)(task & 127), *size);
  return 0;
}

/* Returns its input, if that is as described. */
static PetscErrorCode Work(void *ctx, PetscInt64 task, const void *input, size_t input_size, void *result, size_t *size)
{
  const Run *run = ctx;
  const char *bytes = input;

  if (input_size != SizeOf(task) || bytes[0] != (task & 127) || bytes[input_size - 1] != bytes[0])
    return PETSC_ERR_PLIB;
  for (int k = 0; k < 5 && !LamDispatchInterrupt(run->dispatch); k++) Pause(task % 7 ? 50 : 500);
  memcpy(result, input, input_size);
  *size = input_size;
  return 0;
}

static PetscErrorCode Worked(void *ctx, PetscInt64 task, const void *result)
{
  Run *run = ctx;

  if (*(const char *)result != (task & 127)) return PETSC_ERR_PLIB;
  run->done[task]++;
  run->order[run->count++] = task;
  if (run->more-- > 0) CHECK(LamDispatchAdd(run->dispatch, task + TASKS, 1, 0, 1));
  return run->count == run->fail_after ? PETSC_ERR_USER : 0;
}

static PetscErrorCode Stopped(void *ctx)
{
  ((Run *)ctx)->stopped = PETSC_TRUE;
  return 0;
}

static void Begin(Run *run)
{
  const LamDispatchJob job = {run, BYTES, BYTES, Describe, Work, Worked};

  CHECK(LamDispatchCreate(PETSC_COMM_WORLD, &job, &run->dispatch));
  MPI_Comm_rank(PETSC_COMM_WORLD, &run->rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &run->size);
}

/* Results of all tasks, with those that were added meanwhile, once each. */
TEST(test_all_once)
{
  static Run run = {.more = TASKS / 2};
  PetscBool complete;

  Begin(&run);
  if (run.rank) {
    CHECK(LamDispatchServe(run.dispatch));
  } else {
    CHECK(LamDispatchAdd(run.dispatch, 0, TASKS, 0, 1));
    CHECK(LamDispatchRun(run.dispatch, Stopped, &run, &complete));
    assert_true(complete);
    assert_false(run.stopped);
    assert_int_equal(run.count, TASKS + TASKS / 2);
    for (PetscInt64 i = 0; i < run.count; i++) assert_int_equal(run.done[run.order[i]], 1);
  }
  CHECK(LamDispatchDestroy(&run.dispatch));
}

/* By predicted cost, whatever the order in which they were added. */
TEST(test_longest_first)
{
  static Run run;
  PetscBool complete;

  Begin(&run);
  if (run.rank) {
    CHECK(LamDispatchServe(run.dispatch));
  } else {
    for (PetscInt64 i = 0; i < TASKS; i++)
      CHECK(LamDispatchAdd(run.dispatch, i * 7 % TASKS, 1, 0, (PetscReal)(TASKS - i * 7 % TASKS)));
    CHECK(LamDispatchRun(run.dispatch, NULL, NULL, &complete));
    for (PetscInt64 i = 0; i < TASKS && run.size == 1; i++) assert_int_equal(run.order[i], i);
    assert_int_equal(run.count, TASKS);
  }
  CHECK(LamDispatchDestroy(&run.dispatch));
}

/* An error of `worked` ends all ranks, which have rank 0's code. */
TEST(test_error)
{
  static Run run = {.fail_after = FAIL_AFTER};
  PetscErrorCode ierr = 0;
  PetscBool complete;

  CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  Begin(&run);
  if (run.rank) {
    CHECK(LamDispatchServe(run.dispatch));
  } else {
    CHECK(LamDispatchAdd(run.dispatch, 0, TASKS, 0, 1));
    ierr = LamDispatchRun(run.dispatch, Stopped, &run, &complete);
    assert_int_equal(run.count, FAIL_AFTER);
  }
  assert_int_equal(LamShareError(PETSC_COMM_WORLD, ierr), PETSC_ERR_USER);
  CHECK(LamDispatchDestroy(&run.dispatch));
  CHECK(PetscPopErrorHandler());
}

/* A signal on the last rank alone ends all. The last test: the request stays. */
TEST(test_signal)
{
  static Run run;
  PetscBool complete;

  Begin(&run);
  signal(SIGTERM, LamStopRequest);
  if (run.rank == run.size - 1) raise(SIGTERM);
  if (run.rank) {
    CHECK(LamDispatchServe(run.dispatch));
  } else {
    CHECK(LamDispatchAdd(run.dispatch, 0, TASKS, 0, 1));
    CHECK(LamDispatchRun(run.dispatch, Stopped, &run, &complete));
    assert_true(run.stopped);
    assert_false(complete);
    assert_in_range(run.count, 0, TASKS - 1);
  }
  CHECK(LamDispatchDestroy(&run.dispatch));
}
