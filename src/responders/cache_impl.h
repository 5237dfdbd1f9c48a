/*
  Private to the cache: the source of the response at each material point (cache_point.c).
*/
#ifndef LAM_CACHE_IMPL_H
#define LAM_CACHE_IMPL_H

#include <lamella/cache.h>
#include "scatter_model.h"

/* State of a material point that is kept beyond a load step. */
typedef struct {
  LamScatterModel model; /* state -1: none */
  PetscBool responds;    /* the last response came from the model, not from a table */
} LamCacheHeld;

/* Sources of the response at a material point. */
typedef struct {
  LamTable table; /* owned: the table last used in this load step; NULL: none */
  LamCacheHeld held, accepted;
  PetscInt self_solves; /* in this load step: direct solves for the point, plus switches to a model */
} LamCachePoint;

typedef struct {
  MPI_Comm comm;
  LamDatabase database;       /* borrowed */
  LamResponder solver;        /* borrowed; NULL: database only */
  const LamNodeSolver *nodes; /* borrowed; NULL: `solver` solves nodes */
  LamOutside outside;
  LamResponderCounters counters;
  PetscReal accuracy;
  LamTable newest;       /* owned within a `respond`; NULL: the database has no grid */
  LamCachePoint *points; /* [n_points] */
  PetscInt n_points;
} LamCache;

/* Argument `point`: index of the material point; -1: none. */

/* Queries the point's last source first. LAM_OUT_OF_REACH where no source responds. */
PetscErrorCode LamCacheQuery(LamCache *cache, const LamLoad *load, PetscInt point, LamResponse *response);
/*
  Queries the records outside the grid. With a solver only a record of the queried state itself is used: blends of
  surrounding states would change with each added record.
*/
PetscErrorCode LamCacheQueryRecords(LamCache *cache, const LamLoad *load, LamResponse *response);
/* Assigns the nearest model to the point if its error estimate leaves a margin; else changes nothing. */
PetscErrorCode LamCacheAdopt(LamCache *cache, const LamLoad *load, PetscInt point, LamResponse *response);
/* From now on the model of the state solved for the point is used there, unless the solve failed or is unstable. */
void LamCacheAssignLocalModel(LamCache *cache, const LamLoad *load, PetscInt point);
/* Whether the point skips tables in this load step. */
PetscBool LamCacheUsesDirectSolve(const LamCache *cache, PetscInt point);
/* Ends a load step, accepted or rejected. The next one starts with the newest table. */
PetscErrorCode LamCacheEndStep(LamCache *cache, PetscBool accept);
/* Callbacks of the responder. */
PetscErrorCode LamCacheStateSize(void *ctx, size_t *bytes);
PetscErrorCode LamCacheSave(void *ctx, PetscInt point, void *bytes);
PetscErrorCode LamCacheLoad(void *ctx, PetscInt point, const void *bytes);

#endif
