/*
  Private to the cache: what its material points are answered by (cache_point.c).
*/
#ifndef LAM_CACHE_IMPL_H
#define LAM_CACHE_IMPL_H

#include <lamella/cache.h>
#include "scatter_model.h"

/* What of a material point outlasts a load step. */
typedef struct {
  LamScatterModel model; /* state -1: none */
  PetscBool answers;     /* it answered last, not a table */
} LamCacheHeld;

/* What answers a material point. */
typedef struct {
  LamTable table; /* owned: the last to answer in this load step; NULL: none */
  LamCacheHeld held, accepted;
  PetscInt self_solves; /* in this load step: states solved for the point itself, and times it took to a model */
} LamCachePoint;

typedef struct {
  MPI_Comm comm;
  LamDatabase database;       /* borrowed */
  LamResponder *solver;       /* borrowed; NULL: database only */
  const LamNodeSolver *nodes; /* borrowed; NULL: by the solver */
  LamOutside outside;
  LamResponder *self; /* the responder's counters; borrowed */
  PetscReal accuracy;
  LamTable newest;       /* owned within a `respond`; NULL: the database has no grid */
  LamCachePoint *points; /* [n_points] */
  PetscInt n_points;
} LamCache;

/* point: -1: of no material point. */

/* What answered the point last is asked first; LAM_OUT_OF_REACH where nothing answers. */
PetscErrorCode LamCacheAsk(LamCache *cache, const LamLoad *load, PetscInt point, LamResponse *response);
/*
  Records of no grid. Beside a solver the question's own state alone: blends of states around change with each record.
*/
PetscErrorCode LamCacheAskRecords(LamCache *cache, const LamLoad *load, LamResponse *response);
/* The point takes to the nearest model, where that is so near that it will go on to answer; else nothing changes. */
PetscErrorCode LamCacheAdopt(LamCache *cache, const LamLoad *load, PetscInt point, LamResponse *response);
/* The state solved for the point answers it from now on, unless it failed or is unstable. */
void LamCacheAssignLocalModel(LamCache *cache, const LamLoad *load, PetscInt point);
/* No table is asked for it in this load step. */
PetscBool LamCacheUsesDirectSolve(const LamCache *cache, PetscInt point);
/* A load step ends, by `accept` or not: the next one begins with the newest table. */
PetscErrorCode LamCacheEndStep(LamCache *cache, PetscBool accept);
/* The responder's. */
PetscErrorCode LamCacheStateSize(void *ctx, size_t *bytes);
PetscErrorCode LamCacheSave(void *ctx, PetscInt point, void *bytes);
PetscErrorCode LamCacheLoad(void *ctx, PetscInt point, const void *bytes);

#endif
