/*
  What a piece costs the ranks that hand out (dispatch.c): pieces without work, and results of the size of a bonded
  node's record and of a contact node's with its state. Prints figures, asserts nothing.
    mpirun -n 2 bench_dispatch         rank 0 hands out and works
    mpirun -n 5 bench_dispatch         the same, and with --group 2: rank 0, two leaders, one more rank each
  Processor time, as the machine may be busy; looking for messages that are not there is in it.
*/
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <dispatch.h>

enum { PIECES = 100000, DESCRIPTION = 64 };

typedef struct {
  LamDispatch dispatch;
  size_t bytes; /* of a result */
  PetscInt64 done, own;
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

  if (!ierr) ierr = RunAll();
  if (ierr) MPI_Abort(MPI_COMM_WORLD, 1);
  return PetscFinalize() ? 1 : 0;
}
