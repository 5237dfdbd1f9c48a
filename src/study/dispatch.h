/*
  Numbered pieces of work that do not depend on each other, handed out by rank 0 of a communicator.

  Few ranks take pieces from rank 0, which works as well. Of many, rank 0 hands out to leaders only, and they to the
  ranks of their group. Who is given what: schedule.h.
*/
#ifndef LAM_DISPATCH_H
#define LAM_DISPATCH_H

#include "study.h"

typedef struct LamDispatch_s *LamDispatch;

/* What the work is. Inputs and results are plain data; the sizes are the largest, the calls say what a piece has. */
typedef struct {
  void *ctx; /* of all calls; borrowed */
  size_t input_size, result_size;
  /* Rank 0: what a rank needs to do the piece, told when it is handed out. NULL: its number is enough. */
  PetscErrorCode (*describe)(void *ctx, PetscInt64 piece, void *input, size_t *size);
  /* Any rank: does the piece. It asks LamDispatchServeWaiting often, and where that says so returns with anything. */
  PetscErrorCode (*work)(void *ctx, PetscInt64 piece, const void *input, void *result, size_t *size);
  /* Rank 0: takes a result, in any order, and may add pieces. Also called while rank 0 works on a piece. */
  PetscErrorCode (*worked)(void *ctx, PetscInt64 piece, const void *result);
} LamDispatchJob;

/* Collective. `group`: ranks that one rank hands out to; of more, leaders are made. 0: LAM_DISPATCH_GROUP. */
#define LAM_DISPATCH_GROUP 128
PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamDispatchJob *job, PetscInt group, LamDispatch *dispatch);
PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch);
PetscErrorCode LamDispatchGetRank(LamDispatch dispatch, PetscMPIInt *rank, PetscMPIInt *size);

/* Rank 0: pieces first .. first + count - 1, each of about this predicted cost (in any unit). */
PetscErrorCode LamDispatchAdd(LamDispatch dispatch, PetscInt64 first, PetscInt64 count, PetscReal cost);
/*
  Rank 0: has the pieces done, with those that `worked` adds, and sends the others home. Where a signal has reached any
  rank no piece is finished that is under way, and `stopped` (or NULL) is called with `ctx` at once, before the others
  are home; the results that they bring come to `worked` all the same. *complete tells whether all are done.
*/
PetscErrorCode LamDispatchRun(LamDispatch dispatch, PetscErrorCode (*stopped)(void *ctx), void *ctx,
                              PetscBool *complete);
/* Other ranks: do what they are given until they are sent home. */
PetscErrorCode LamDispatchServe(LamDispatch dispatch);

/*
  A PetscBool (*)(void *) for LamRVESetInterrupt: answers the messages that have come in, and tells whether the piece
  under way is to be given up. `dispatch`: a LamDispatch.
*/
PetscBool LamDispatchServeWaiting(void *dispatch);
/* The time that this rank has spent so within pieces, s. */
PetscReal LamDispatchServiceTime(LamDispatch dispatch);

/* An error of rank 0 ends every rank; it has been told once. Collective; returns rank 0's. */
PetscErrorCode LamDispatchShare(LamDispatch dispatch, PetscErrorCode ierr);

#endif
