/*
  Numbered pieces of work that do not depend on each other, handed out by rank 0 of a communicator.
*/
#ifndef LAM_DISPATCH_H
#define LAM_DISPATCH_H

#include "app.h"

/* Does piece `index`, on whichever rank; `result` has the dispatch's result_size bytes and holds plain data. */
typedef PetscErrorCode (*LamWork)(void *ctx, PetscInt64 index, void *result);
/* Called on rank 0 for each result, in any order. */
typedef PetscErrorCode (*LamWorked)(void *ctx, PetscInt64 index, const void *result);

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank, size;
  LamWork work;
  void *ctx; /* of work; borrowed */
  size_t result_size;
  void *buffer; /* one message: index and result; owned */
} LamDispatch;

/* Collective. */
PetscErrorCode LamDispatchCreate(MPI_Comm comm, LamWork work, void *ctx, size_t result_size, LamDispatch *dispatch);
/* Rank 0: has pieces first..last-1 done; fewer where a stop is requested (none is begun after that). */
PetscErrorCode LamDispatchRun(LamDispatch *dispatch, PetscInt64 first, PetscInt64 last, LamWorked worked, void *ctx);
/* Rank 0: sends the others home. */
PetscErrorCode LamDispatchEnd(LamDispatch *dispatch);
/* Other ranks: do what rank 0 sends until it says the end. */
PetscErrorCode LamDispatchServe(LamDispatch *dispatch);
PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch);
/* An error of rank 0 ends every rank; it has been told once. Collective; returns rank 0's. */
PetscErrorCode LamDispatchShare(LamDispatch *dispatch, PetscErrorCode ierr);

#endif
