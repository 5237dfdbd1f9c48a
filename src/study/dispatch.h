/*
  Independent tasks, handed out by rank 0 of a communicator to the other ranks (workers); rank 0 does tasks as well.

  For up to some hundred ranks (docs/results/scaling.md). Beyond that: several jobs with a shard each.
*/
#ifndef LAM_DISPATCH_H
#define LAM_DISPATCH_H

#include "study.h"

typedef struct LamDispatch_s *LamDispatch;

/* Inputs and results are plain data of at most these sizes. */
typedef struct {
  void *ctx; /* of all calls; borrowed */
  size_t input_size, result_size;
  /* Rank 0, when it hands the task out: writes its input. NULL: the number of the task is enough. */
  PetscErrorCode (*describe)(void *ctx, PetscInt64 task, void *input, size_t *size);
  /* Any rank: does the task. It calls LamDispatchInterrupt often; where that is true it returns any result. */
  PetscErrorCode (*work)(void *ctx, PetscInt64 task, const void *input, size_t input_size, void *result, size_t *size);
  /* Rank 0: takes a result, in any order, and may add tasks. Also called while rank 0 does a task. */
  PetscErrorCode (*worked)(void *ctx, PetscInt64 task, const void *result);
} LamDispatchJob;

/* Collective. */
PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamDispatchJob *job, LamDispatch *dispatch);
PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch);

/* Rank 0: tasks first .. first + count - 1, each of this predicted cost (any unit). */
PetscErrorCode LamDispatchAdd(LamDispatch dispatch, PetscInt64 first, PetscInt64 count, PetscReal cost);
/*
  Rank 0: has all tasks done, with those that `worked` adds. A signal on any rank ends it: no task under way is
  finished, and `stopped` (or NULL) is called with `ctx` at once, before the workers have left; results that they have
  sent by then still come to `worked`. *complete: all tasks are done.
*/
PetscErrorCode LamDispatchRun(LamDispatch dispatch, PetscErrorCode (*stopped)(void *ctx), void *ctx,
                              PetscBool *complete);
/* Workers: do tasks until rank 0 ends it. */
PetscErrorCode LamDispatchServe(LamDispatch dispatch);

/*
  A PetscBool (*)(void *) for LamRVESetInterrupt: handles the messages that have arrived; true: the task under way is to
  be given up. `dispatch`: a LamDispatch.
*/
PetscBool LamDispatchInterrupt(void *dispatch);
/* Time of this rank in LamDispatchInterrupt, s. */
PetscReal LamDispatchServiceTime(LamDispatch dispatch);

#endif
