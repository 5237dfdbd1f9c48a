/*
  What a task costs rank 0, and how busy it keeps the ranks (dispatch.c). Prints figures, asserts nothing.
    mpirun -n 8 bench_dispatch             tasks without work: processor time of rank 0 for each task of a worker, with
                                           messages as large as a number, a bonded node's record, a contact node's state
    mpirun -n N bench_dispatch MS PARTS [NODES]
                                           100 tasks a rank that sleep MS ms on average (from a quarter to four times
                                           the median), each in so many parts: messages are handled between two.
                                           Or so many nodes in rounds, as `build` has them: two are open, of a twelfth
  of the nodes that are done, at least 32; the costs are predicted exactly Tasks that sleep show the idle time of more
  ranks than there are processors.
*/
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <dispatch.h>

enum { TASKS = 100000, SLEEPS_A_RANK = 100, STATE = 13000, RECORD = 2000, LEAST_ROUND = 32, ROUND_SHARE = 12 };

typedef struct {
  LamDispatch dispatch;
  size_t bytes; /* of an input or result */
  PetscReal median, parts, asleep;
  PetscInt64 done, own; /* own: by this rank */
  PetscInt64 tasks, added;
  PetscBool in_rounds;
  PetscInt64 second, missing[2]; /* the younger round's first task; results that are missing of the two rounds */
} Work;

static double Seconds(clockid_t which)
{
  struct timespec t;

  clock_gettime(which, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static PetscErrorCode Describe(void *ctx, PetscInt64 task, void *input, size_t *size)
{
  const Work *w = ctx;

  PetscFunctionBeginUser;
  memset(input, (int)(task & 127), w->bytes);
  *size = w->bytes;
  PetscFunctionReturn(0);
}

/* Spread evenly on a logarithmic scale, each time by the number of the task. */
static PetscReal TimeOf(const Work *w, PetscInt64 task)
{
  return w->median * pow(4, 2 * fmod(0.6180339887498949 * (PetscReal)task, 1) - 1);
}

static PetscErrorCode Sleep(void *ctx, PetscInt64 task, const void *input, size_t input_size, void *result,
                            size_t *size)
{
  Work *w = ctx;
  const PetscReal seconds = TimeOf(w, task), end = Seconds(CLOCK_MONOTONIC) + seconds;
  PetscReal rest = seconds;

  PetscFunctionBeginUser;
  for (; rest > 0 && !LamDispatchInterrupt(w->dispatch); rest = end - Seconds(CLOCK_MONOTONIC)) {
    const long ns = (long)(1e9 * PetscMin(rest, seconds / w->parts));
    const struct timespec time = {ns / 1000000000, ns % 1000000000};

    nanosleep(&time, NULL);
  }
  if (!w->median) (void)LamDispatchInterrupt(w->dispatch);
  w->own++;
  memcpy(result, input, input_size);
  *size = input_size;
  PetscFunctionReturn(0);
}

/* The younger round becomes the older one. */
static PetscErrorCode OpenRound(Work *w)
{
  const PetscInt64 round = w->in_rounds ? PetscMax(LEAST_ROUND, w->done / ROUND_SHARE) : w->tasks;
  const PetscInt64 n = PetscMin(round, w->tasks - w->added);
  const PetscInt turn = (PetscInt)w->added; /* the older round first */

  PetscFunctionBeginUser;
  w->missing[0] = w->missing[1];
  w->missing[1] = n;
  w->second = w->added;
  for (PetscInt64 i = 0; i < n; i++, w->added++)
    PetscCall(LamDispatchAdd(w->dispatch, w->added, 1, turn, 1 + TimeOf(w, w->added)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Worked(void *ctx, PetscInt64 task, const void *result)
{
  Work *w = ctx;

  PetscFunctionBeginUser;
  w->asleep += TimeOf(w, task);
  w->done++;
  w->missing[task >= w->second]--;
  while (!w->missing[0] && w->added < w->tasks) PetscCall(OpenRound(w));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(Work w)
{
  const LamDispatchJob job = {&w, w.bytes, w.bytes, Describe, Sleep, Worked};
  PetscMPIInt rank, size;
  PetscBool complete;
  double wall, processor;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(LamDispatchCreate(PETSC_COMM_WORLD, &job, &w.dispatch));
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  wall = Seconds(CLOCK_MONOTONIC);
  processor = Seconds(CLOCK_PROCESS_CPUTIME_ID);
  if (rank) {
    PetscCall(LamDispatchServe(w.dispatch));
  } else {
    PetscCall(OpenRound(&w));
    PetscCall(OpenRound(&w));
    PetscCall(LamDispatchRun(w.dispatch, NULL, NULL, &complete));
    wall = Seconds(CLOCK_MONOTONIC) - wall;
    processor = Seconds(CLOCK_PROCESS_CPUTIME_ID) - processor;
    printf("%5d %7zu %8lld %10.3g %9.4g %9.2f %9.1f\n", (int)size, w.bytes, (long long)w.done,
           1e3 * w.asleep / (double)w.done, wall, 1e6 * processor / (double)(w.done - w.own),
           100 * w.asleep / (wall * size));
    fflush(stdout);
  }
  PetscCall(LamDispatchDestroy(&w.dispatch));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunAll(int argc, char **argv)
{
  const PetscReal mean = (4 - 0.25) / log(16); /* over the median */
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "ranks   bytes    tasks    ms each    s wall  us/task  busy %%\n"));
  if (argc > 2) {
    PetscCall(Run((Work){.bytes = STATE,
                         .median = 1e-3 * atof(argv[1]) / mean,
                         .parts = atof(argv[2]),
                         .in_rounds = (PetscBool)(argc > 3),
                         .tasks = argc > 3 ? atoi(argv[3]) : SLEEPS_A_RANK * (PetscInt64)size}));
    PetscFunctionReturn(0);
  }
  PetscCall(Run((Work){.bytes = 8, .tasks = TASKS}));
  PetscCall(Run((Work){.bytes = RECORD, .tasks = TASKS}));
  PetscCall(Run((Work){.bytes = RECORD + STATE, .tasks = TASKS}));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscErrorCode ierr = PetscInitialize(&argc, &argv, NULL, NULL);

  if (!ierr) ierr = RunAll(argc, argv);
  if (ierr) MPI_Abort(MPI_COMM_WORLD, 1);
  return PetscFinalize() ? 1 : 0;
}
