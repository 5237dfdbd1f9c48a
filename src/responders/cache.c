/*
  Responders backed by a database: alone, or with a solver for states that it does not cover.

  Method. Responses are interpolated from the table of a database. Its nodes are solved where queries fall and shared by
  all queries nearby. Where no node helps, as next to a change of branch, the queried state is solved directly. The
  second-order model of its potential then serves this point and nearby ones while its estimated error is small enough:
  in situ adaptive tabulation (Pope, Combust. Theory Model. 1 (1997) 41), with one model held per point
  (cache_point.c).

  Algorithm of one `respond`:
  1. Query all loads. Order of sources: the last source of the point (its model or its table of this load step), the
     newest table, the model, the records of the queried state itself.
  2. For the remaining queries, gather the keys of the nodes that the newest table lacks from all ranks and sort them.
     Distribute them in turn, solve, gather, and add them on all ranks in that order. Repeat from 1 with the remaining
     queries, at most MAX_ROUNDS times.
  3. Where no node helps any more, assign the nearest model to points where its error is within ADOPTS of the accuracy.
     Map the remaining loads by the symmetry to the states of nodes (LamTableTurn), gather them from all ranks and sort
     them. Distribute every SHARE-th, solve it (from the nearest node if there is one) and add it outside the grid.
     Repeat until no query remains. With LAM_OUTSIDE_STOP the remaining queries get no response.

  Rounding. Steps 2 and 3 round the loads, so that the set of solved states does not depend on the ranks' order of
  summation. The response is corrected from the rounded to the queried load by its tangent.

  Convergence. A point that switched to a model or was solved directly SELF_STAYS times in this load step skips tables
  from then on: at the edge of a table, iterations that alternate between two responses would not converge.
*/
#include "clock.h"
#include <stdlib.h>
#include "cache_impl.h"
#include "gather.h"
#include "rounded_load.h"

enum { MAX_ROUNDS = 12, SHARE = 8, LEAST_SHARE = 4 };

/* Queries of one `respond` without a response yet. */
typedef struct {
  const LamLoad *loads;
  const PetscInt *points;
  LamResponse *responses;
  PetscInt n, *at;  /* [n] indices into the three */
  PetscBool solved; /* states were added to the database */
} Missing;

/* The states to solve, the same on all ranks: nodes, or other states where keys is NULL. */
typedef struct {
  PetscInt n;
  PetscInt64 *keys;
  LamLoad *loads;
  LamResponse *responses;
} Batch;

/* ---- step 1: query ---- */

/* Queries a source for all missing loads; keeps those still without a response. */
static PetscErrorCode QueryAll(LamCache *cache, Missing *missing,
                               PetscErrorCode (*ask)(LamCache *, const LamLoad *, PetscInt, LamResponse *))
{
  const PetscReal start = LamClock();
  PetscInt left = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < missing->n; k++) {
    const PetscInt i = missing->at[k];

    PetscCall(ask(cache, &missing->loads[i], missing->points[i], &missing->responses[i]));
    if (missing->responses[i].status == LAM_OUT_OF_REACH) missing->at[left++] = i;
  }
  missing->n = left;
  cache->counters.query_seconds += LamClock() - start;
  PetscFunctionReturn(0);
}

/* ---- solving ---- */

static PetscErrorCode GetNewest(LamCache *cache)
{
  PetscFunctionBeginUser;
  PetscCall(LamTableDestroy(&cache->newest));
  PetscCall(LamDatabaseGetTable(cache->database, &cache->newest));
  PetscFunctionReturn(0);
}

/* Solves all from the reference state. */
static PetscErrorCode SolveLoads(LamCache *cache, PetscInt n, const LamLoad loads[], LamResponse responses[])
{
  const LamResponderCounters before = LamResponderGetCounters(cache->solver);
  LamResponderCounters after;
  PetscInt *points;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &points));
  for (PetscInt k = 0; k < n; k++) points[k] = -1;
  PetscCall(LamResponderRespond(cache->solver, n, loads, points, responses));
  after = LamResponderGetCounters(cache->solver);
  cache->counters.solves += after.solves - before.solves;
  cache->counters.solve_seconds += after.solve_seconds - before.solve_seconds;
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/*
  Solves nodes (keys not NULL), or else other states. These start at the nearest node, or at the reference state: the
  response must not depend on the rank that solves.
*/
static PetscErrorCode SolveWithNodes(LamCache *cache, PetscInt n, const PetscInt64 keys[], const LamLoad loads[],
                                     LamResponse responses[])
{
  const LamNodeSolver *nodes = cache->nodes;
  PetscInt64 node;
  LamLoad turned;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal start = LamClock();

    if (keys) {
      PetscCall(nodes->solve(nodes->ctx, keys[k], &responses[k]));
    } else {
      PetscCall(LamTableTurn(cache->newest, &loads[k], &turned, &node));
      if (node < 0) {
        PetscCall(SolveLoads(cache, 1, &loads[k], &responses[k]));
        continue;
      }
      PetscCall(nodes->solve_near(nodes->ctx, node, &loads[k], &responses[k]));
    }
    if (responses[k].status != LAM_OUT_OF_REACH) cache->counters.solves++;
    cache->counters.solve_seconds += LamClock() - start;
  }
  PetscFunctionReturn(0);
}

/* Rank k mod ranks solves item k of the batch; then all ranks hold all responses. */
static PetscErrorCode SolveBatch(LamCache *cache, Batch *batch)
{
  PetscMPIInt rank, ranks, *starts;
  LamGrid grid;
  LamLoad *loads;
  LamResponse *mine, *all;
  PetscInt64 *keys;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(cache->comm, &rank));
  PetscCallMPI(MPI_Comm_size(cache->comm, &ranks));
  PetscCall(LamDatabaseGetGrid(cache->database, &grid));
  PetscCall(PetscMalloc3(batch->n, &loads, batch->n, &keys, batch->n, &mine));
  for (PetscInt k = rank; k < batch->n; k += ranks, n++) {
    if (batch->keys) {
      keys[n] = batch->keys[k];
      PetscCall(LamGridNodeLoad(grid, keys[n], &loads[n]));
    } else
      loads[n] = batch->loads[k];
  }
  if (cache->nodes && (batch->keys || (cache->newest && cache->nodes->solve_near)))
    PetscCall(SolveWithNodes(cache, n, batch->keys ? keys : NULL, loads, mine));
  else
    PetscCall(SolveLoads(cache, n, loads, mine));
  PetscCall(LamGather(cache->comm, sizeof(LamResponse), n, mine, &starts, (void **)&all));
  PetscCall(PetscMalloc1(batch->n, &batch->responses));
  for (PetscInt k = 0; k < batch->n; k++) batch->responses[k] = all[starts[k % ranks] + k / ranks];
  PetscCall(PetscFree(starts));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree3(loads, keys, mine));
  PetscFunctionReturn(0);
}

/* Solves and adds all states, failed ones too. *stopped: the solver was stopped before it finished the batch. */
static PetscErrorCode SolveAndAdd(LamCache *cache, Batch *batch, PetscBool *stopped)
{
  LamResponse *records;
  PetscInt64 *keys;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(SolveBatch(cache, batch));
  PetscCall(PetscMalloc2(batch->n, &records, batch->n, &keys));
  for (PetscInt k = 0; k < batch->n; k++) {
    if (batch->responses[k].status == LAM_OUT_OF_REACH) continue;
    if (batch->keys) keys[n] = batch->keys[k];
    records[n++] = batch->responses[k];
  }
  *stopped = (PetscBool)(n < batch->n);
  PetscCall(LamDatabaseAdd(cache->database, n, batch->keys ? keys : NULL, records));
  PetscCall(PetscFree2(records, keys));
  PetscCall(GetNewest(cache));
  PetscFunctionReturn(0);
}

static PetscErrorCode BatchDestroy(Batch *batch)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(batch->keys));
  PetscCall(PetscFree(batch->loads));
  PetscCall(PetscFree(batch->responses));
  PetscFunctionReturn(0);
}

/* ---- step 2: nodes ---- */

/* The nodes that this rank's queries need, each once. The caller frees *keys. */
static PetscErrorCode FindMyNeeds(LamCache *cache, const Missing *missing, PetscInt *n, PetscInt64 **keys)
{
  PetscInt capacity = 16 * LAM_MAX_NEEDS, more;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(capacity, keys));
  for (PetscInt k = 0; k < missing->n; k++) {
    const LamLoad question = LamLoadRound(&missing->loads[missing->at[k]]);

    if (LamCacheUsesDirectSolve(cache, missing->points[missing->at[k]])) continue;
    if (*n + LAM_MAX_NEEDS > capacity) {
      LamSortUnique(n, *keys, sizeof(PetscInt64), LamCompareKeys);
      capacity = PetscMax(capacity, 2 * (*n + LAM_MAX_NEEDS));
      PetscCall(PetscRealloc(sizeof(PetscInt64) * (size_t)capacity, keys));
    }
    PetscCall(LamTableNeeds(cache->newest, &question, cache->accuracy, NULL, &more, *keys + *n));
    *n += more;
  }
  LamSortUnique(n, *keys, sizeof(PetscInt64), LamCompareKeys);
  PetscFunctionReturn(0);
}

/* One round of step 2. *ends: no further node helps. *stopped: the solver was stopped. */
static PetscErrorCode Refine(LamCache *cache, Missing *missing, PetscBool *ends, PetscBool *stopped)
{
  PetscInt64 *mine;
  PetscInt n;
  Batch batch = {0};

  PetscFunctionBeginUser;
  PetscCall(FindMyNeeds(cache, missing, &n, &mine));
  PetscCall(LamGatherUnion(cache->comm, sizeof(PetscInt64), LamCompareKeys, n, mine, &batch.n, (void **)&batch.keys));
  PetscCall(PetscFree(mine));
  *ends = (PetscBool)!batch.n;
  if (!*ends) {
    PetscCall(SolveAndAdd(cache, &batch, stopped));
    missing->solved = PETSC_TRUE;
    PetscCall(QueryAll(cache, missing, LamCacheQuery));
  }
  PetscCall(BatchDestroy(&batch));
  PetscFunctionReturn(0);
}

/* ---- step 3: states ---- */

/* The state to solve for a query. */
static PetscErrorCode StateFor(LamCache *cache, const LamLoad *load, LamLoad *state)
{
  const LamLoad rounded = LamLoadRound(load);
  PetscInt64 node;

  PetscFunctionBeginUser;
  *state = rounded;
  if (cache->newest) PetscCall(LamTableTurn(cache->newest, &rounded, state, &node));
  *state = LamLoadRound(state);
  PetscFunctionReturn(0);
}

/* The response of a state that has just been solved and added. */
static PetscErrorCode TakeOwnState(LamCache *cache, const LamLoad *load, const LamResponse *solved,
                                   LamResponse *response)
{
  const LamLoad rounded = LamLoadRound(load);
  const PetscInt point = -1;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  if (LamResponseHasFields(solved)) PetscCall(LamCacheQueryRecords(cache, load, response));
  if (!LamResponseHasFields(response)) { /* failed, or unstable: a database does not return unstable states */
    *response = *solved;
    if (LamResponseHasFields(solved) && LamLoadCompare(&rounded, &solved->load))
      PetscCall(LamResponderRespond(cache->solver, 1, &rounded, &point, response));
    LamResponseCorrectToLoad(load, response);
  }
  response->source = LAM_SOURCE_SOLVE;
  PetscFunctionReturn(0);
}

/* An evenly spread subset of the states that all ranks lack: one in SHARE, but at least LEAST_SHARE (or all). */
static PetscErrorCode FindShare(LamCache *cache, PetscInt n, const LamLoad mine[], Batch *batch)
{
  PetscInt share;

  PetscFunctionBeginUser;
  PetscCall(LamGatherUnion(cache->comm, sizeof(LamLoad), LamLoadCompare, n, mine, &batch->n, (void **)&batch->loads));
  share = PetscMin(batch->n, PetscMax(batch->n / SHARE, LEAST_SHARE));
  for (PetscInt k = 0; k < share; k++) batch->loads[k] = batch->loads[(PetscInt64)k * batch->n / share];
  batch->n = share;
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveShare(LamCache *cache, Missing *missing, PetscBool *stopped)
{
  PetscInt left = 0;
  LamLoad *mine;
  Batch batch = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(missing->n, &mine));
  for (PetscInt k = 0; k < missing->n; k++) PetscCall(StateFor(cache, &missing->loads[missing->at[k]], &mine[k]));
  PetscCall(FindShare(cache, missing->n, mine, &batch));
  PetscCall(SolveAndAdd(cache, &batch, stopped));
  missing->solved = PETSC_TRUE;
  for (PetscInt k = 0; k < missing->n; k++) {
    const PetscInt i = missing->at[k];
    const LamLoad *load = &missing->loads[i], *found;

    found = (const LamLoad *)bsearch(&mine[k], batch.loads, (size_t)batch.n, sizeof(LamLoad), LamLoadCompare);
    if (!found) {
      missing->at[left++] = i;
      continue;
    }
    PetscCall(TakeOwnState(cache, load, &batch.responses[found - batch.loads], &missing->responses[i]));
    LamCacheAssignLocalModel(cache, load, missing->points[i]);
  }
  missing->n = left;
  PetscCall(PetscFree(mine));
  PetscCall(BatchDestroy(&batch));
  PetscFunctionReturn(0);
}

/* Steps 2 and 3. */
static PetscErrorCode SolveMissing(LamCache *cache, Missing *missing)
{
  PetscBool ends = (PetscBool)!cache->newest, stopped = PETSC_FALSE; /* ends: no further node helps */
  PetscInt anywhere;

  PetscFunctionBeginUser;
  for (PetscInt round = 0; !stopped; round++) {
    const PetscBool themselves = (PetscBool)(ends || round >= MAX_ROUNDS);
    const PetscInt before = missing->n;

    if (themselves && cache->outside == LAM_OUTSIDE_SOLVE) {
      PetscCall(QueryAll(cache, missing, LamCacheAdopt));
      if (!missing->solved) cache->counters.hits += before - missing->n;
    }
    PetscCallMPI(MPI_Allreduce(&missing->n, &anywhere, 1, MPIU_INT, MPI_SUM, cache->comm));
    if (!anywhere || (themselves && cache->outside == LAM_OUTSIDE_STOP)) break;
    if (themselves)
      PetscCall(SolveShare(cache, missing, &stopped));
    else
      PetscCall(Refine(cache, missing, &ends, &stopped));
  }
  PetscFunctionReturn(0);
}

/* ---- responder ---- */

static PetscErrorCode CacheRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                   LamResponse responses[])
{
  LamCache *cache = (LamCache *)ctx;
  Missing missing = {.loads = loads, .points = points, .responses = responses, .n = n};

  PetscFunctionBeginUser;
  PetscCall(GetNewest(cache));
  PetscCall(PetscMalloc1(n, &missing.at));
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(points[i] < cache->n_points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "material point %" PetscInt_FMT ", of %" PetscInt_FMT, points[i], cache->n_points);
    missing.at[i] = i;
  }
  PetscCall(QueryAll(cache, &missing, LamCacheQuery));
  for (PetscInt i = 0; i < n; i++) cache->counters.hits += LamResponseHasFields(&responses[i]);
  cache->counters.queries += n;
  if (cache->solver) PetscCall(SolveMissing(cache, &missing));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool answered = LamResponseHasFields(&responses[i]);

    cache->counters.failures += !answered;
    cache->counters.interpolated += answered && responses[i].source == LAM_SOURCE_DATABASE;
  }
  PetscCall(PetscFree(missing.at));
  PetscCall(LamTableDestroy(&cache->newest));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheAccept(void *ctx)
{
  LamCache *cache = (LamCache *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamCacheEndStep(cache, PETSC_TRUE));
  if (cache->solver) PetscCall(LamResponderAccept(cache->solver));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheReject(void *ctx)
{
  LamCache *cache = (LamCache *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamCacheEndStep(cache, PETSC_FALSE));
  if (cache->solver) PetscCall(LamResponderReject(cache->solver));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheDestroy(void **ctx)
{
  LamCache *cache = (LamCache *)*ctx;

  PetscFunctionBeginUser;
  if (!cache) PetscFunctionReturn(0);
  PetscCall(LamCacheEndStep(cache, PETSC_FALSE));
  PetscCall(LamTableDestroy(&cache->newest)); /* left by a `respond` that returned an error */
  PetscCall(PetscFree(cache->points));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheResponderCreate(MPI_Comm comm, LamDatabase database, LamResponder solver,
                                       const LamNodeSolver *nodes, LamOutside outside, PetscReal accuracy,
                                       PetscInt points, LamResponder *responder)
{
  LamResponderFunctions functions = {
      .respond = CacheRespond, .accept = CacheAccept, .reject = CacheReject, .destroy = CacheDestroy};
  LamCache *cache;

  PetscFunctionBeginUser;
  PetscCheck(accuracy > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "accuracy %g must be positive", (double)accuracy);
  PetscCall(PetscNew(&cache));
  cache->comm = comm;
  cache->database = database;
  cache->solver = solver;
  cache->nodes = nodes;
  cache->outside = outside;
  cache->accuracy = accuracy;
  cache->n_points = points;
  PetscCall(PetscCalloc1(points, &cache->points));
  for (PetscInt p = 0; p < points; p++) cache->points[p].held.model.state = cache->points[p].accepted.model.state = -1;
  if (solver) {
    functions.state_size = LamCacheStateSize;
    functions.save = LamCacheSave;
    functions.load = LamCacheLoad;
  }
  PetscCall(LamResponderCreate(&functions, cache, &cache->counters, responder));
  PetscFunctionReturn(0);
}
