/*
  Nodes solved by all ranks of a dispatch, each from its parent's state, each once.

  Rank 0 keeps the states of the nodes that were solved and sends them along with their children. A node waits until its
  parent is done; a parent whose state is not there any more, or that only the file knows, is solved for its state.
*/
#ifndef LAM_NODE_WORK_H
#define LAM_NODE_WORK_H

#include "dispatch.h"
#include "node_solver.h"

typedef struct LamNodeWork_s *LamNodeWork;

/* What rank 0 does with a response that was wanted. */
typedef PetscErrorCode (*LamNodeArrived)(void *ctx, PetscInt64 key, const LamResponse *response);
/* The record of a node that a file has, or NULL. */
typedef const LamResponse *(*LamNodeKnown)(void *ctx, PetscInt64 key);

typedef struct {
  void *ctx; /* borrowed */
  LamNodeArrived arrived;
  LamNodeKnown known;
} LamNodeCustomer;

/*
  Collective over comm; borrows rve, grid and customer, of which rank 0 alone needs one. `memory`: bytes for states on
  rank 0. `group`: see LamDispatchCreate.
*/
#define LAM_NODE_WORK_MEMORY ((size_t)2 << 30)
PetscErrorCode LamNodeWorkCreate(MPI_Comm comm, LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                 PetscInt group, const LamNodeCustomer *customer, LamNodeWork *work);
PetscErrorCode LamNodeWorkDestroy(LamNodeWork *work);

/* Rank 0: has this node solved; `cost` as predicted. `arrived` may be called before this returns. */
PetscErrorCode LamNodeWorkWant(LamNodeWork work, PetscInt64 key, PetscReal cost);
/* Rank 0: until all that is wanted has arrived, or a signal comes: then `stopped` (or NULL) at once. */
PetscErrorCode LamNodeWorkRun(LamNodeWork work, PetscErrorCode (*stopped)(void *ctx), PetscBool *complete);
/* The other ranks. */
PetscErrorCode LamNodeWorkServe(LamNodeWork work);

#endif
