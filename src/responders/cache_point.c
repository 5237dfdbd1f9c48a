/*
  Responses at the material points of a cache: from tables, and from the models they hold (cache.c, steps 1 and 3).
*/
#include "cache_impl.h"
#include <string.h>
#include "rounded_load.h"

/* Times the accuracy: largest error estimate at which a point switches to a model. */
static const PetscReal ADOPTS = 0.25;
static const PetscReal OWN_STATE = 1e-8; /* strain: distance of a query from its own record, which is rounded twice */
enum { SELF_STAYS = 2 };

PetscBool LamCacheUsesDirectSolve(const LamCache *cache, PetscInt index)
{
  return (PetscBool)(index >= 0 && cache->points[index].self_solves >= SELF_STAYS);
}

/* NULL: no material point. */
static LamCachePoint *PointOf(const LamCache *cache, PetscInt point)
{
  return point < 0 ? NULL : &cache->points[point];
}

/* Queries the point's table, then the newest, which becomes the point's if it responds. Else LAM_OUT_OF_REACH. */
static PetscErrorCode QueryTables(LamCache *cache, const LamLoad *load, LamCachePoint *point, LamResponse *response)
{
  PetscFunctionBeginUser;
  if (point && point->table) {
    PetscCall(LamTableQuery(point->table, load, cache->accuracy, response));
    if (response->status != LAM_OUT_OF_REACH || point->table == cache->newest) PetscFunctionReturn(0);
  }
  PetscCall(LamTableQuery(cache->newest, load, cache->accuracy, response));
  if (!point || response->status == LAM_OUT_OF_REACH) PetscFunctionReturn(0);
  PetscCall(LamTableDestroy(&point->table));
  PetscCall(LamDatabaseGetTable(cache->database, &point->table));
  PetscFunctionReturn(0);
}

/* From now on the model is the point's source. */
static void TakeTo(LamCachePoint *point, LamScatterModel model)
{
  point->held = (LamCacheHeld){model, PETSC_TRUE};
  point->self_solves++;
}

/* Writes the model's response if its error estimate is within the accuracy; else leaves the response unchanged. */
static PetscErrorCode TryModel(LamCache *cache, const LamScatterModel *model, const LamLoad *load, PetscReal accuracy,
                               LamResponse *response)
{
  LamResponse found;

  PetscFunctionBeginUser;
  if (model->state < 0) PetscFunctionReturn(0);
  PetscCall(LamScatterModelQuery(cache->database, model, load, accuracy, &found));
  if (LamResponseHasFields(&found)) *response = found;
  PetscFunctionReturn(0);
}

static PetscErrorCode QueryModel(LamCache *cache, const LamLoad *load, LamCachePoint *point, LamResponse *response)
{
  PetscFunctionBeginUser;
  if (!point) PetscFunctionReturn(0);
  PetscCall(TryModel(cache, &point->held.model, load, cache->accuracy, response));
  if (LamResponseHasFields(response) && !point->held.responds) TakeTo(point, point->held.model);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheQueryRecords(LamCache *cache, const LamLoad *load, LamResponse *response)
{
  const LamLoad query = cache->solver ? LamLoadRound(load) : *load;
  LamResponse found;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseQuery(cache->database, &query, cache->accuracy, &found));
  if (found.status == LAM_INVALID_F) *response = found;
  if (found.status == LAM_INVALID_F || (cache->solver && !(found.distance <= OWN_STATE))) PetscFunctionReturn(0);
  LamResponseCorrectToLoad(load, &found);
  *response = found;
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheQuery(LamCache *cache, const LamLoad *load, PetscInt index, LamResponse *response)
{
  LamCachePoint *point = PointOf(cache, index);

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->status = LAM_OUT_OF_REACH;
  if (point && point->held.responds) PetscCall(QueryModel(cache, load, point, response));
  if (response->status != LAM_OUT_OF_REACH) PetscFunctionReturn(0);
  if (cache->newest && !LamCacheUsesDirectSolve(cache, index)) PetscCall(QueryTables(cache, load, point, response));
  if (point && LamResponseHasFields(response)) point->held.responds = PETSC_FALSE;
  if (response->status == LAM_OUT_OF_REACH) PetscCall(QueryModel(cache, load, point, response));
  if (response->status == LAM_OUT_OF_REACH) PetscCall(LamCacheQueryRecords(cache, load, response));
  PetscFunctionReturn(0);
}

/* ---- models ---- */

PetscErrorCode LamCacheAdopt(LamCache *cache, const LamLoad *load, PetscInt index, LamResponse *response)
{
  LamCachePoint *point = PointOf(cache, index);
  const LamLoad query = LamLoadRound(load);
  LamScatterModel model;
  LamResponse found = {.status = LAM_OUT_OF_REACH};

  PetscFunctionBeginUser;
  if (!point || LamCacheUsesDirectSolve(cache, index)) PetscFunctionReturn(0);
  LamScatterModelFind(cache->database, &query, &model);
  PetscCall(TryModel(cache, &model, &query, ADOPTS * cache->accuracy, &found));
  if (!LamResponseHasFields(&found)) PetscFunctionReturn(0);
  PetscCall(TryModel(cache, &model, load, cache->accuracy, response));
  TakeTo(point, model);
  PetscFunctionReturn(0);
}

void LamCacheAssignLocalModel(LamCache *cache, const LamLoad *load, PetscInt index)
{
  const LamLoad query = LamLoadRound(load);
  LamCachePoint *point = PointOf(cache, index);
  LamScatterModel model;

  if (!point) return;
  LamScatterModelFind(cache->database, &query, &model);
  TakeTo(point, model.state < 0 ? point->held.model : model);
}

/* ---- load steps ---- */

PetscErrorCode LamCacheEndStep(LamCache *cache, PetscBool accept)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < cache->n_points; p++) {
    LamCachePoint *point = &cache->points[p];

    PetscCall(LamTableDestroy(&point->table));
    point->self_solves = 0;
    if (accept)
      point->accepted = point->held;
    else
      point->held = point->accepted;
  }
  PetscFunctionReturn(0);
}

/* LamCacheHeld as bytes. The model is stored as the load of its record, since indices differ between files. */
typedef struct {
  LamLoad record;
  PetscInt image; /* -1: no model */
  PetscBool responds;
} Kept;

PetscErrorCode LamCacheStateSize(void *ctx, size_t *bytes)
{
  PetscFunctionBeginUser;
  *bytes = sizeof(Kept);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheSave(void *ctx, PetscInt point, void *bytes)
{
  const LamCache *cache = (const LamCache *)ctx;
  const LamCacheHeld *held = &cache->points[point].accepted;
  Kept kept;

  PetscFunctionBeginUser;
  memset(&kept, 0, sizeof(kept));
  kept.image = -1;
  kept.responds = held->responds;
  if (held->model.state >= 0) {
    kept.record = LamScatterModelLoad(cache->database, &held->model);
    kept.image = held->model.image;
  }
  memcpy(bytes, &kept, sizeof(kept));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheLoad(void *ctx, PetscInt point, const void *bytes)
{
  LamCache *cache = (LamCache *)ctx;
  LamCacheHeld held = {.model = {.state = -1}};
  Kept kept;

  PetscFunctionBeginUser;
  memcpy(&kept, bytes, sizeof(kept));
  if (kept.image >= 0) LamScatterModelFind(cache->database, &kept.record, &held.model);
  held.model.image = kept.image;
  held.responds = kept.responds;
  cache->points[point].held = cache->points[point].accepted = held;
  PetscFunctionReturn(0);
}
