/*
  Nodes solved by all ranks of a dispatch, each once and from the state of its parent.

  Rank 0 keeps the states of solved nodes and sends them with the tasks of their children. A node waits until its parent
  is solved. A parent whose state is not kept, or whose record is only in the file, is solved again for its state.
*/
#ifndef LAM_NODE_WORK_H
#define LAM_NODE_WORK_H

#include "dispatch.h"
#include "known_records.h"
#include "node_solver.h"

typedef struct LamNodeWork_s *LamNodeWork;

/* Callbacks on rank 0. */
typedef struct {
  void *ctx; /* borrowed */
  /* Receives the response of a requested node. */
  PetscErrorCode (*arrived)(void *ctx, PetscInt64 key, const LamResponse *response);
  const LamKnownRecords *known; /* records of the file; NULL: none. Borrowed */
} LamNodeCallbacks;

/* Collective over comm; borrows rve, grid and callbacks (NULL on workers). `memory`: bytes for states on rank 0. */
#define LAM_NODE_WORK_MEMORY ((size_t)2 << 30)
PetscErrorCode LamNodeWorkCreate(MPI_Comm comm, LamRVE rve, LamInterfaceLawType interface, LamGrid grid, size_t memory,
                                 const LamNodeCallbacks *callbacks, LamNodeWork *work);
PetscErrorCode LamNodeWorkDestroy(LamNodeWork *work);

/* Rank 0: requests a node with this turn and predicted cost (dispatch.h). `arrived` may be called before this returns.
 */
PetscErrorCode LamNodeWorkRequest(LamNodeWork work, PetscInt64 key, PetscInt turn, PetscReal cost);
/* Rank 0: returns when all requested nodes have arrived, or after a signal; `stopped` as in LamDispatchRun. */
PetscErrorCode LamNodeWorkRun(LamNodeWork work, PetscErrorCode (*stopped)(void *ctx));
PetscErrorCode LamNodeWorkServe(LamNodeWork work); /* workers */
/* Rank 0, in work of its own: nodes may arrive and others are handed out. `work`: a LamNodeWork. */
PetscErrorCode LamNodeWorkLook(void *work);

#endif
