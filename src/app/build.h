/*
  Private to `lamella build`: which states are sampled, and who solves them.
*/
#ifndef LAM_BUILD_H
#define LAM_BUILD_H

#include "app.h"

/* ---- build_sample.c ---- */

/*
  The state number `index` (0, 1, ...) of the scene's sample box: point index + 1 of the Halton sequence with bases
  2, 3, 5, 7 for two principal logarithmic strains, the angle between the first and face normal 0, and turgor. F is the
  right stretch U. With six-fold symmetry 30 degrees of angle are all there is, else 90.
  Source: J. H. Halton, Numer. Math. 2 (1960) 84-90.
*/
void LamSampleLoad(const LamScene *scene, PetscInt64 index, LamLoad *load);

/* ---- build_dispatch.c: work handed out by rank 0, one state at a time ---- */

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank, size;
  const LamScene *scene; /* borrowed */
  LamRVE rve;            /* owned */
  LamRVEState state;     /* owned */
} LamDispatch;

/* Called on rank 0 for each solved state, in any order. */
typedef PetscErrorCode (*LamSolved)(void *ctx, PetscInt64 index, const LamResponse *response);

/* Every rank gets an RVE of its own. Collective. */
PetscErrorCode LamDispatchCreate(MPI_Comm comm, const LamScene *scene, LamDispatch *dispatch);
/* Rank 0: has states first..last-1 solved; fewer where a stop is requested (none is begun after that). */
PetscErrorCode LamDispatchRun(LamDispatch *dispatch, PetscInt64 first, PetscInt64 last, LamSolved solved, void *ctx);
/* Rank 0: sends the others home. */
PetscErrorCode LamDispatchEnd(LamDispatch *dispatch);
/* Other ranks: solve what rank 0 sends until it says the end. */
PetscErrorCode LamDispatchServe(LamDispatch *dispatch);
PetscErrorCode LamDispatchDestroy(LamDispatch *dispatch);

#endif
