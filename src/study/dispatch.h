/*
  Distribution of independent tasks: rank 0 of a communicator sends them to the other ranks (workers) and does tasks
  itself.

  For up to some hundred ranks (docs/results/scaling.md). For more, run several jobs with a shard each.
*/
#ifndef LAM_DISPATCH_H
#define LAM_DISPATCH_H

#include "study.h"

typedef struct LamDispatch_s *LamDispatch;

/* Inputs and results are plain data of at most these sizes. */
typedef struct {
  void *ctx; /* of all calls; borrowed */
  size_t input_size, result_size;
  /* Rank 0, when a task is sent: writes its input. NULL: tasks have no input but their number. */
  PetscErrorCode (*describe)(void *ctx, PetscInt64 task, void *input, size_t *size);
  /* Any rank: does the task. It must call LamDispatchInterrupt often; when that is true it may return any result. */
  PetscErrorCode (*work)(void *ctx, PetscInt64 task, const void *input, size_t input_size, void *result, size_t *size);
  /* Rank 0: receives a result; may add tasks. Results come in any order, also while rank 0 does a task. */
  PetscErrorCode (*worked)(void *ctx, PetscInt64 task, const void *result);
} LamDispatchJob;

/* Collective. */
PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamDispatchJob *job, LamDispatch *dispatch);
PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch);

/* Rank 0: adds tasks first .. first + count - 1, each with this predicted cost (any unit). Those of a lower turn are
   done first, then those of larger cost. */
PetscErrorCode LamDispatchAdd(LamDispatch dispatch, PetscInt64 first, PetscInt64 count, PetscInt turn, PetscReal cost);
/*
  Rank 0: runs all tasks, including those that `worked` adds. A signal on any rank ends the run: current tasks are
  interrupted, and `stopped` (or NULL) is called with `ctx` at once, before the workers have left. Results that they
  have sent by then are still passed to `worked`. *complete (or NULL): all tasks are done.
*/
PetscErrorCode LamDispatchRun(LamDispatch dispatch, PetscErrorCode (*stopped)(void *ctx), void *ctx,
                              PetscBool *complete);
/* Workers: does tasks until rank 0 ends the run. */
PetscErrorCode LamDispatchServe(LamDispatch dispatch);

/*
  Callback for LamRVESetInterrupt, PetscBool (*)(void *): handles messages that have arrived; true: the current task is
  to be abandoned. `dispatch`: a LamDispatch.
*/
PetscBool LamDispatchInterrupt(void *dispatch);
/* Rank 0, in work of its own that is long for a task: handles messages that have arrived. */
PetscErrorCode LamDispatchLook(LamDispatch dispatch);
/* Time that this rank has spent in LamDispatchInterrupt, s. */
PetscReal LamDispatchServiceTime(LamDispatch dispatch);

#endif
