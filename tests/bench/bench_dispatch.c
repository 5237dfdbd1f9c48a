/*
  What a piece costs the ranks that hand out (dispatch.c): pieces without work, and results of the size of a bonded
  node's record and of a contact node's with its state. Prints figures, asserts nothing.
    mpirun -n 2 bench_dispatch         rank 0 hands out and works
    mpirun -n 5 bench_dispatch         the same, and groups of 2: rank 0, two leaders, one more rank each
    mpirun -n 40 bench_dispatch --sleep [SCALE] [GROUP]
                                       pieces that sleep as long as contact nodes take, 100 a rank, on more ranks than
                                       there are processors: the figure that bench_schedule is held against
  Processor time, as the machine may be busy; looking for messages that are not there is in it.
*/
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <dispatch.h>
#include <figures_work.h>
#include "work_table.h"

enum { PIECES = 100000, DESCRIPTION = 64, RECORD = 2000, SLEEPS_A_RANK = 100, CLASS_SHIFT = 56, SEED = 1 };

typedef struct {
  LamDispatch dispatch;
  size_t bytes; /* of a result */
  PetscInt64 done, own;
  WorkTable table; /* for pieces that sleep */
  PetscReal scale, asleep;
} Work;

static double Processor(void)
{
  struct timespec t;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double Wall(void)
{
  struct timespec t;

  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static PetscErrorCode Describe(void *ctx, PetscInt64 piece, void *input, size_t *size)
{
  PetscFunctionBeginUser;
  memset(input, (int)(piece & 127), DESCRIPTION);
  *size = DESCRIPTION;
  PetscFunctionReturn(0);
}

static PetscErrorCode Nothing(void *ctx, PetscInt64 piece, const void *input, void *result, size_t *size)
{
  Work *w = ctx;

  PetscFunctionBeginUser;
  w->own++;
  memset(result, *(const char *)input, w->bytes);
  *size = w->bytes;
  (void)LamDispatchServeWaiting(w->dispatch);
  PetscFunctionReturn(0);
}

static PetscErrorCode Worked(void *ctx, PetscInt64 piece, const void *result)
{
  PetscFunctionBeginUser;
  ((Work *)ctx)->done++;
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(size_t bytes, PetscInt group, PetscInt64 pieces)
{
  Work w = {.bytes = bytes};
  const LamDispatchJob job = {.ctx = &w,
                              .input_size = DESCRIPTION,
                              .result_size = bytes,
                              .describe = Describe,
                              .work = Nothing,
                              .worked = Worked};
  PetscMPIInt rank, size;
  double wall, processor;
  PetscBool complete;

  PetscFunctionBeginUser;
  PetscCall(LamDispatchCreate(PETSC_COMM_WORLD, &job, group, &w.dispatch));
  PetscCall(LamDispatchGetRank(w.dispatch, &rank, &size));
  wall = Wall();
  processor = Processor();
  if (rank) {
    PetscCall(LamDispatchServe(w.dispatch));
  } else {
    PetscCall(LamDispatchAdd(w.dispatch, 0, pieces, 1));
    PetscCall(LamDispatchRun(w.dispatch, NULL, NULL, &complete));
    wall = Wall() - wall;
    processor = Processor() - processor;
    printf("%5d %5s %7zu %9lld %9lld %9.1f %9.2f\n", (int)size, size - 1 > group ? "tree" : "flat", bytes,
           (long long)w.done, (long long)w.own, 1e-3 * (double)w.done / wall, 1e6 * processor / (double)w.done);
    fflush(stdout);
  }
  PetscCall(LamDispatchDestroy(&w.dispatch));
  PetscFunctionReturn(0);
}

/* ---- pieces that sleep ---- */

/* In as many parts as a solve has factorisations; messages are answered between them. */
static PetscErrorCode Sleep(void *ctx, PetscInt64 piece, const void *input, void *result, size_t *size)
{
  Work *w = ctx;
  const double begin = Wall();
  const PetscReal seconds =
      w->scale * DrawWork(&w->table, (int)(piece >> CLASS_SHIFT), MixBits((uint64_t)piece + SEED));
  const PetscReal part = w->scale * w->table.factorisation;
  double rest = seconds;

  PetscFunctionBeginUser;
  for (; rest > 0 && !LamDispatchServeWaiting(w->dispatch); rest = begin + seconds - Wall()) {
    const long ns = (long)(1e9 * PetscMin(rest, part));
    const struct timespec time = {ns / 1000000000, ns % 1000000000};

    nanosleep(&time, NULL);
  }
  memset(result, 0, w->bytes);
  memcpy(result, &seconds, sizeof(seconds));
  *size = w->bytes;
  PetscFunctionReturn(0);
}

static PetscErrorCode Slept(void *ctx, PetscInt64 piece, const void *result)
{
  Work *w = ctx;
  PetscReal seconds;

  PetscFunctionBeginUser;
  memcpy(&seconds, result, sizeof(seconds));
  w->asleep += seconds;
  w->done++;
  PetscFunctionReturn(0);
}

static PetscErrorCode AddSleeps(Work *w, PetscInt64 pieces)
{
  PetscFunctionBeginUser;
  for (int c = 0; c < WORK_CLASSES; c++) {
    PetscCall(LamDispatchAdd(w->dispatch, (PetscInt64)c << CLASS_SHIFT, ShareOfClass(&w->table, pieces, c),
                             w->table.classes[c].predicted));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode RunAsleep(PetscReal scale, PetscInt group)
{
  Work w = {.bytes = RECORD, .scale = scale};
  const LamDispatchJob job = {.ctx = &w,
                              .input_size = DESCRIPTION,
                              .result_size = RECORD,
                              .describe = Describe,
                              .work = Sleep,
                              .worked = Slept};
  PetscMPIInt rank, size;
  PetscBool complete;
  double wall;

  PetscFunctionBeginUser;
  PetscCall(
      FiguresWorkTable(sizeof(contact_work) / sizeof(*contact_work), contact_work, CONTACT_FACTORISATION, &w.table));
  PetscCall(LamDispatchCreate(PETSC_COMM_WORLD, &job, group, &w.dispatch));
  PetscCall(LamDispatchGetRank(w.dispatch, &rank, &size));
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  wall = Wall();
  if (rank) {
    PetscCall(LamDispatchServe(w.dispatch));
  } else {
    PetscCall(AddSleeps(&w, SLEEPS_A_RANK * (PetscInt64)size));
    PetscCall(LamDispatchRun(w.dispatch, NULL, NULL, &complete));
    wall = Wall() - wall;
    printf("%d ranks, %s, %lld pieces of %.3g ms: %.4g s, busy %.1f %%\n", (int)size,
           size - 1 > group ? "tree" : "flat", (long long)w.done, 1e3 * w.asleep / (double)w.done, wall,
           100 * w.asleep / (wall * size));
  }
  PetscCall(LamDispatchDestroy(&w.dispatch));
  DestroyWorkTable(&w.table);
  PetscFunctionReturn(0);
}

/* ---- */

static PetscErrorCode RunAll(void)
{
  static const size_t bytes[] = {64, 2000, 15000};
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (!rank) printf("ranks  tree   bytes    pieces  by rank 0  1000/s wall  us of rank 0's processor per piece\n");
  for (int k = 0; k < 3; k++) {
    PetscCall(Run(bytes[k], LAM_DISPATCH_GROUP, PIECES));
    if (size > 3) PetscCall(Run(bytes[k], 2, PIECES));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscErrorCode ierr = PetscInitialize(&argc, &argv, NULL, NULL);

  if (!ierr && argc > 1 && !strcmp(argv[1], "--sleep"))
    ierr = RunAsleep(argc > 2 ? atof(argv[2]) : 1, argc > 3 ? atoi(argv[3]) : LAM_DISPATCH_GROUP);
  else if (!ierr)
    ierr = RunAll();
  if (ierr) MPI_Abort(MPI_COMM_WORLD, 1);
  return PetscFinalize() ? 1 : 0;
}
