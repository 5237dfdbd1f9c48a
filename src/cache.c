/*
  Responders that answer from a database: alone, or with a solver for what it lacks.

  Method. Answers come from the table of a database, whose nodes are solved where questions fall and shared by all
  questions around. Where no node helps, as next to a change of branch, the state asked for is solved itself, and the
  second-order model of its potential answers the point, and others around, while its estimated error is small enough:
  in situ adaptive tabulation (Pope, Combust. Theory Model. 1 (1997) 41) with a model for each point to hold.

  Algorithm, of one `respond`:
  1. Ask for all questions: what answered the point last, its model or the table of this load step, then the newest
     table, then the model, then the records for the question's own state.
  2. The keys of the nodes that the newest table lacks for what is left, from all ranks, sorted, are dealt out in turn,
     solved, gathered, and added on all ranks in that order. From 1 with what is left, MAX_ROUNDS times at most.
  3. Where no node helps any more, points whose nearest model is good to ADOPTS of the accuracy take to it. Of what is
     left, turned and mirrored to the states of nodes (LamTableTurn), from all ranks and sorted, each SHARE-th is dealt
     out, solved, from the nearest node where there is one, and added as states of no grid, which answer. So on until
     none is left; or it stays without answer (LAM_OUTSIDE_STOP).

  Rounding. In 2 and 3 questions are rounded, so that what is solved does not depend on the ranks' order of summation;
  the answer to a rounded question is led back to the one asked by its tangent.

  Convergence. A point that took to a model, or was solved for itself, SELF_STAYS times in this load step goes on
  without tables: at the edge of what they answer, iterations that step to and fro between two answers would not end.
*/
#include <lamella/cache.h>
#include <lamella/clock.h>
#include <stdlib.h>
#include <string.h>
#include "gather.h"
#include "rounded_load.h"
#include "scatter_model.h"

enum { MAX_ROUNDS = 12, SELF_STAYS = 2, SHARE = 8, LEAST_SHARE = 4 };
/* Of the accuracy: with a model whose error is estimated above that a point does not begin. */
static const PetscReal ADOPTS = 0.25;
static const PetscReal OWN_STATE = 1e-8; /* distance of a question from its own record, rounded twice; a strain */

/* What of a material point outlasts a load step. */
typedef struct {
  LamScatterModel model; /* state -1: none */
  PetscBool answers;     /* it answered last, not a table */
} Held;

/* What answers a material point. */
typedef struct {
  LamTable table; /* owned: the last to answer in this load step; NULL: none */
  Held held, accepted;
  PetscInt self_solves; /* in this load step: states solved for the point itself, and times it took to a model */
} Point;

typedef struct {
  MPI_Comm comm;
  LamDatabase database;       /* borrowed */
  LamResponder *solver;       /* borrowed; NULL: database only */
  const LamNodeSolver *nodes; /* borrowed; NULL: by the solver */
  LamOutside outside;
  LamResponder *self; /* the responder's counters; borrowed */
  PetscReal accuracy;
  LamTable newest; /* owned within a `respond`; NULL: the database has no grid */
  Point *points;   /* [n_points] */
  PetscInt n_points;
} Cache;

/* Questions of one `respond` that have no answer yet. */
typedef struct {
  const LamLoad *loads;
  const PetscInt *points;
  LamResponse *responses;
  PetscInt n, *at;  /* places in the three */
  PetscBool solved; /* the database is no longer as it was */
} Missing;

/* What is to be solved, the same on all ranks: nodes, or states where keys is NULL. */
typedef struct {
  PetscInt n;
  PetscInt64 *keys;
  LamLoad *loads;
  LamResponse *responses;
} Batch;

/* ---- step 1: asking ---- */

static PetscBool GoesOnByItself(const Point *point)
{
  return (PetscBool)(point && point->self_solves >= SELF_STAYS);
}

/* NULL: the question is of no material point. */
static Point *PointOf(const Cache *cache, PetscInt point)
{
  return point < 0 ? NULL : &cache->points[point];
}

/* Out of reach where neither the point's table nor the newest one answers; the newest is its own from then on. */
static PetscErrorCode AskTables(Cache *cache, const LamLoad *load, Point *point, LamResponse *response)
{
  PetscFunctionBeginUser;
  if (!cache->newest || GoesOnByItself(point)) PetscFunctionReturn(0);
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

/* From now on the model answers. */
static void TakeTo(Point *point, LamScatterModel model)
{
  point->held = (Held){model, PETSC_TRUE};
  point->self_solves++;
}

/* Answers, if the model is good to the accuracy; else the response stays as it is. */
static PetscErrorCode TryModel(Cache *cache, const LamScatterModel *model, const LamLoad *load, PetscReal accuracy,
                               LamResponse *response)
{
  LamResponse answer;

  PetscFunctionBeginUser;
  if (model->state < 0) PetscFunctionReturn(0);
  PetscCall(LamScatterModelQuery(cache->database, model, load, accuracy, &answer));
  if (LamResponseHasFields(&answer)) *response = answer;
  PetscFunctionReturn(0);
}

static PetscErrorCode AskModel(Cache *cache, const LamLoad *load, Point *point, LamResponse *response)
{
  PetscFunctionBeginUser;
  if (!point) PetscFunctionReturn(0);
  PetscCall(TryModel(cache, &point->held.model, load, cache->accuracy, response));
  if (LamResponseHasFields(response) && !point->held.answers) TakeTo(point, point->held.model);
  PetscFunctionReturn(0);
}

/*
  Records of no grid. Beside a solver the question's own state alone: blends of states around change with each record.
*/
static PetscErrorCode AskRecords(Cache *cache, const LamLoad *load, LamResponse *response)
{
  const LamLoad question = cache->solver ? LamLoadRound(load) : *load;
  LamResponse answer;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseQuery(cache->database, &question, cache->accuracy, &answer));
  if (answer.status == LAM_INVALID_F) *response = answer;
  if (answer.status == LAM_INVALID_F || (cache->solver && !(answer.distance <= OWN_STATE))) PetscFunctionReturn(0);
  LamLoadLeadBack(load, &answer);
  *response = answer;
  PetscFunctionReturn(0);
}

/* What answered last is asked first. */
static PetscErrorCode Ask(Cache *cache, const LamLoad *load, Point *point, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->status = LAM_OUT_OF_REACH;
  if (point && point->held.answers) PetscCall(AskModel(cache, load, point, response));
  if (response->status != LAM_OUT_OF_REACH) PetscFunctionReturn(0);
  PetscCall(AskTables(cache, load, point, response));
  if (point && LamResponseHasFields(response)) point->held.answers = PETSC_FALSE;
  if (response->status == LAM_OUT_OF_REACH) PetscCall(AskModel(cache, load, point, response));
  if (response->status == LAM_OUT_OF_REACH) PetscCall(AskRecords(cache, load, response));
  PetscFunctionReturn(0);
}

/* Asks for all that is missing; leaves what still is. */
static PetscErrorCode AskAll(Cache *cache, Missing *missing)
{
  const PetscReal start = LamClock();
  PetscInt left = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < missing->n; k++) {
    const PetscInt i = missing->at[k];
    PetscCall(Ask(cache, &missing->loads[i], PointOf(cache, missing->points[i]), &missing->responses[i]));
    if (missing->responses[i].status == LAM_OUT_OF_REACH) missing->at[left++] = i;
  }
  missing->n = left;
  cache->self->query_seconds += LamClock() - start;
  PetscFunctionReturn(0);
}

/* ---- solving ---- */

static PetscErrorCode GetNewest(Cache *cache)
{
  PetscFunctionBeginUser;
  PetscCall(LamTableDestroy(&cache->newest));
  PetscCall(LamDatabaseGetTable(cache->database, &cache->newest));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveNodes(Cache *cache, PetscInt n, const PetscInt64 keys[], LamResponse responses[])
{
  const PetscReal start = LamClock();

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(cache->nodes->solve(cache->nodes->ctx, keys[k], &responses[k]));
    if (responses[k].status != LAM_OUT_OF_REACH) cache->self->solves++;
  }
  cache->self->solve_seconds += LamClock() - start;
  PetscFunctionReturn(0);
}

/* All from the reference state. */
static PetscErrorCode SolveLoads(Cache *cache, PetscInt n, const LamLoad loads[], LamResponse responses[])
{
  const LamResponder before = *cache->solver;
  PetscInt *points;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &points));
  for (PetscInt k = 0; k < n; k++) points[k] = -1;
  PetscCall(cache->solver->respond(cache->solver->ctx, n, loads, points, responses));
  cache->self->solves += cache->solver->solves - before.solves;
  cache->self->solve_seconds += cache->solver->solve_seconds - before.solve_seconds;
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* From the nearest node, else from the reference: the answer must not depend on who solves it. */
static PetscErrorCode SolveNearNodes(Cache *cache, PetscInt n, const LamLoad loads[], LamResponse responses[])
{
  PetscInt64 node;
  LamLoad turned;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal start = LamClock();

    PetscCall(LamTableTurn(cache->newest, &loads[k], &turned, &node));
    if (node < 0) {
      PetscCall(SolveLoads(cache, 1, &loads[k], &responses[k]));
      continue;
    }
    PetscCall(cache->nodes->solve_near(cache->nodes->ctx, node, &loads[k], &responses[k]));
    if (responses[k].status != LAM_OUT_OF_REACH) cache->self->solves++;
    cache->self->solve_seconds += LamClock() - start;
  }
  PetscFunctionReturn(0);
}

/* Item k of the batch is solved by rank k mod ranks; all have all responses then. */
static PetscErrorCode SolveBatch(Cache *cache, Batch *batch)
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
  if (batch->keys && cache->nodes)
    PetscCall(SolveNodes(cache, n, keys, mine));
  else if (cache->newest && cache->nodes && cache->nodes->solve_near)
    PetscCall(SolveNearNodes(cache, n, loads, mine));
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

/* Adds what was solved, failed or not. *stopped: the solver was stopped on the way, and the rest is not there. */
static PetscErrorCode AddBatch(Cache *cache, const Batch *batch, PetscBool *stopped)
{
  LamResponse *records;
  PetscInt64 *keys;
  PetscInt n = 0;

  PetscFunctionBeginUser;
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

static PetscErrorCode SolveAndAdd(Cache *cache, Batch *batch, PetscBool *stopped)
{
  PetscFunctionBeginUser;
  PetscCall(SolveBatch(cache, batch));
  PetscCall(AddBatch(cache, batch, stopped));
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

static int CompareKeys(const void *first, const void *second)
{
  const PetscInt64 a = *(const PetscInt64 *)first, b = *(const PetscInt64 *)second;

  return (a > b) - (a < b);
}

/* The nodes that this rank's questions need, each once. The caller frees *keys. */
static PetscErrorCode FindMyNeeds(Cache *cache, const Missing *missing, PetscInt *n, PetscInt64 **keys)
{
  PetscInt capacity = 16 * LAM_MAX_NEEDS, more;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(capacity, keys));
  for (PetscInt k = 0; k < missing->n; k++) {
    const LamLoad question = LamLoadRound(&missing->loads[missing->at[k]]);

    if (GoesOnByItself(PointOf(cache, missing->points[missing->at[k]]))) continue;
    if (*n + LAM_MAX_NEEDS > capacity) {
      LamSortUnique(n, *keys, sizeof(PetscInt64), CompareKeys);
      capacity = PetscMax(capacity, 2 * (*n + LAM_MAX_NEEDS));
      PetscCall(PetscRealloc(sizeof(PetscInt64) * (size_t)capacity, keys));
    }
    PetscCall(LamTableNeeds(cache->newest, &question, cache->accuracy, &more, *keys + *n));
    *n += more;
  }
  LamSortUnique(n, *keys, sizeof(PetscInt64), CompareKeys);
  PetscFunctionReturn(0);
}

/* One round; *ends: no node helps any more, or the solver was stopped. */
static PetscErrorCode Refine(Cache *cache, Missing *missing, PetscBool *ends, PetscBool *stopped)
{
  PetscInt64 *mine;
  PetscInt n;
  Batch batch = {0};

  PetscFunctionBeginUser;
  PetscCall(FindMyNeeds(cache, missing, &n, &mine));
  PetscCall(LamGatherUnion(cache->comm, sizeof(PetscInt64), CompareKeys, n, mine, &batch.n, (void **)&batch.keys));
  PetscCall(PetscFree(mine));
  *ends = (PetscBool)!batch.n;
  if (!*ends) {
    PetscCall(SolveAndAdd(cache, &batch, stopped));
    missing->solved = PETSC_TRUE;
    PetscCall(AskAll(cache, missing));
  }
  PetscCall(BatchDestroy(&batch));
  PetscFunctionReturn(0);
}

/* ---- step 3: states ---- */

/* The state to solve for a question. */
static PetscErrorCode StateFor(Cache *cache, const LamLoad *load, LamLoad *state)
{
  const LamLoad rounded = LamLoadRound(load);
  PetscInt64 node;

  PetscFunctionBeginUser;
  *state = rounded;
  if (cache->newest) PetscCall(LamTableTurn(cache->newest, &rounded, state, &node));
  *state = LamLoadRound(state);
  PetscFunctionReturn(0);
}

/* Of a state that has just been solved and added. */
static PetscErrorCode TakeOwnState(Cache *cache, const LamLoad *load, const LamResponse *solved, LamResponse *response)
{
  const LamLoad rounded = LamLoadRound(load);
  const PetscInt point = -1;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  if (LamResponseHasFields(solved)) PetscCall(AskRecords(cache, load, response));
  if (!LamResponseHasFields(response)) { /* failed; or unstable, which is no answer of a database */
    *response = *solved;
    if (LamResponseHasFields(solved) && LamLoadCompare(&rounded, &solved->load))
      PetscCall(cache->solver->respond(cache->solver->ctx, 1, &rounded, &point, response));
    LamLoadLeadBack(load, response);
  }
  response->source = LAM_SOURCE_SOLVE;
  PetscFunctionReturn(0);
}

/* The point takes to the nearest model, where that is so near that it will go on to answer. */
static PetscErrorCode Adopt(Cache *cache, const LamLoad *load, Point *point, LamResponse *response)
{
  const LamLoad question = LamLoadRound(load);
  LamScatterModel model;
  LamResponse answer = {.status = LAM_OUT_OF_REACH};

  PetscFunctionBeginUser;
  if (!point || GoesOnByItself(point)) PetscFunctionReturn(0);
  LamScatterModelFind(cache->database, &question, &model);
  PetscCall(TryModel(cache, &model, &question, ADOPTS * cache->accuracy, &answer));
  if (!LamResponseHasFields(&answer)) PetscFunctionReturn(0);
  PetscCall(TryModel(cache, &model, load, cache->accuracy, response));
  TakeTo(point, model);
  PetscFunctionReturn(0);
}

static PetscErrorCode AdoptAll(Cache *cache, Missing *missing)
{
  const PetscReal start = LamClock();
  PetscInt left = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < missing->n; k++) {
    const PetscInt i = missing->at[k];

    PetscCall(Adopt(cache, &missing->loads[i], PointOf(cache, missing->points[i]), &missing->responses[i]));
    if (missing->responses[i].status == LAM_OUT_OF_REACH) missing->at[left++] = i;
  }
  if (!missing->solved) cache->self->hits += missing->n - left;
  missing->n = left;
  cache->self->query_seconds += LamClock() - start;
  PetscFunctionReturn(0);
}

/* A share of what all ranks lack, spread over it, of LEAST_SHARE where there are as many. */
static PetscErrorCode FindShare(Cache *cache, PetscInt n, const LamLoad mine[], Batch *batch)
{
  PetscInt share;

  PetscFunctionBeginUser;
  PetscCall(LamGatherUnion(cache->comm, sizeof(LamLoad), LamLoadCompare, n, mine, &batch->n, (void **)&batch->loads));
  share = PetscMin(batch->n, PetscMax(batch->n / SHARE, LEAST_SHARE));
  for (PetscInt k = 0; k < share; k++) batch->loads[k] = batch->loads[(PetscInt64)k * batch->n / share];
  batch->n = share;
  PetscFunctionReturn(0);
}

/* The state solved for the point answers it from now on, unless it failed or is unstable. */
static void TakeToOwnState(const Cache *cache, const LamLoad *load, Point *point)
{
  const LamLoad question = LamLoadRound(load);
  LamScatterModel model;

  LamScatterModelFind(cache->database, &question, &model);
  TakeTo(point, model.state < 0 ? point->held.model : model);
}

static PetscErrorCode SolveShare(Cache *cache, Missing *missing, PetscBool *stopped)
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
    if (missing->points[i] >= 0) TakeToOwnState(cache, load, &cache->points[missing->points[i]]);
  }
  missing->n = left;
  PetscCall(PetscFree(mine));
  PetscCall(BatchDestroy(&batch));
  PetscFunctionReturn(0);
}

static PetscErrorCode CountMissing(Cache *cache, const Missing *missing, PetscInt *anywhere)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&missing->n, anywhere, 1, MPIU_INT, MPI_SUM, cache->comm));
  PetscFunctionReturn(0);
}

/* Step 3. */
static PetscErrorCode SolveThemselves(Cache *cache, Missing *missing)
{
  PetscBool stopped = PETSC_FALSE;
  PetscInt anywhere;

  PetscFunctionBeginUser;
  while (!stopped) {
    PetscCall(AdoptAll(cache, missing));
    PetscCall(CountMissing(cache, missing, &anywhere));
    if (!anywhere) break;
    PetscCall(SolveShare(cache, missing, &stopped));
  }
  PetscFunctionReturn(0);
}

/* Steps 2 and 3. */
static PetscErrorCode SolveMissing(Cache *cache, Missing *missing)
{
  PetscBool ends = (PetscBool)!cache->newest, stopped = PETSC_FALSE;
  PetscInt anywhere;

  PetscFunctionBeginUser;
  for (PetscInt round = 0; !stopped; round++) {
    PetscCall(CountMissing(cache, missing, &anywhere));
    if (!anywhere) break;
    if (ends || round == MAX_ROUNDS) {
      if (cache->outside == LAM_OUTSIDE_SOLVE) PetscCall(SolveThemselves(cache, missing));
      break;
    }
    PetscCall(Refine(cache, missing, &ends, &stopped));
  }
  PetscFunctionReturn(0);
}

/* ---- responder ---- */

static PetscErrorCode CacheRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                   LamResponse responses[])
{
  Cache *cache = (Cache *)ctx;
  Missing missing = {.loads = loads, .points = points, .responses = responses, .n = n};

  PetscFunctionBeginUser;
  PetscCall(GetNewest(cache));
  PetscCall(PetscMalloc1(n, &missing.at));
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(points[i] < cache->n_points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "material point %" PetscInt_FMT ", of %" PetscInt_FMT, points[i], cache->n_points);
    missing.at[i] = i;
  }
  PetscCall(AskAll(cache, &missing));
  for (PetscInt i = 0; i < n; i++) cache->self->hits += LamResponseHasFields(&responses[i]);
  cache->self->queries += n;
  if (cache->solver) PetscCall(SolveMissing(cache, &missing));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool answered = LamResponseHasFields(&responses[i]);

    cache->self->failures += !answered;
    cache->self->interpolated += answered && responses[i].source == LAM_SOURCE_DATABASE;
  }
  PetscCall(PetscFree(missing.at));
  PetscCall(LamTableDestroy(&cache->newest));
  PetscFunctionReturn(0);
}

/* A load step ends: the next one begins with the newest table. */
static PetscErrorCode Forget(Cache *cache)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < cache->n_points; p++) {
    PetscCall(LamTableDestroy(&cache->points[p].table));
    cache->points[p].self_solves = 0;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheAccept(void *ctx)
{
  Cache *cache = (Cache *)ctx;

  PetscFunctionBeginUser;
  PetscCall(Forget(cache));
  for (PetscInt p = 0; p < cache->n_points; p++) cache->points[p].accepted = cache->points[p].held;
  if (cache->solver && cache->solver->accept) PetscCall(cache->solver->accept(cache->solver->ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheReject(void *ctx)
{
  Cache *cache = (Cache *)ctx;

  PetscFunctionBeginUser;
  PetscCall(Forget(cache));
  for (PetscInt p = 0; p < cache->n_points; p++) cache->points[p].held = cache->points[p].accepted;
  if (cache->solver && cache->solver->reject) PetscCall(cache->solver->reject(cache->solver->ctx));
  PetscFunctionReturn(0);
}

/* Held, as bytes; of the model the load of its record, as another file has others before it. */
typedef struct {
  LamLoad record;
  PetscInt image; /* -1: no model */
  PetscBool answers;
} Kept;

static PetscErrorCode CacheStateSize(void *ctx, size_t *bytes)
{
  PetscFunctionBeginUser;
  *bytes = sizeof(Kept);
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheSave(void *ctx, PetscInt point, void *bytes)
{
  const Cache *cache = (const Cache *)ctx;
  const Held *held = &cache->points[point].accepted;
  Kept kept;

  PetscFunctionBeginUser;
  memset(&kept, 0, sizeof(kept));
  kept.image = -1;
  kept.answers = held->answers;
  if (held->model.state >= 0) {
    kept.record = LamScatterModelLoad(cache->database, &held->model);
    kept.image = held->model.image;
  }
  memcpy(bytes, &kept, sizeof(kept));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheLoad(void *ctx, PetscInt point, const void *bytes)
{
  Cache *cache = (Cache *)ctx;
  Held held = {.model = {.state = -1}};
  Kept kept;

  PetscFunctionBeginUser;
  memcpy(&kept, bytes, sizeof(kept));
  if (kept.image >= 0) LamScatterModelFind(cache->database, &kept.record, &held.model);
  held.model.image = kept.image;
  held.answers = kept.answers;
  cache->points[point].held = cache->points[point].accepted = held;
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheDestroy(void **ctx)
{
  Cache *cache = (Cache *)*ctx;

  PetscFunctionBeginUser;
  if (!cache) PetscFunctionReturn(0);
  PetscCall(Forget(cache));
  PetscCall(LamTableDestroy(&cache->newest)); /* of a `respond` that ended with an error */
  PetscCall(PetscFree(cache->points));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheResponderCreate(MPI_Comm comm, LamDatabase database, LamResponder *solver,
                                       const LamNodeSolver *nodes, LamOutside outside, PetscReal accuracy,
                                       PetscInt points, LamResponder *responder)
{
  Cache *cache;

  PetscFunctionBeginUser;
  PetscCheck(accuracy > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "accuracy %g must be positive", (double)accuracy);
  PetscCall(PetscNew(&cache));
  cache->comm = comm;
  cache->database = database;
  cache->solver = solver;
  cache->nodes = nodes;
  cache->self = responder;
  cache->outside = outside;
  cache->accuracy = accuracy;
  cache->n_points = points;
  PetscCall(PetscCalloc1(points, &cache->points));
  for (PetscInt p = 0; p < points; p++) cache->points[p].held.model.state = cache->points[p].accepted.model.state = -1;
  *responder = (LamResponder){
      .ctx = cache, .respond = CacheRespond, .accept = CacheAccept, .reject = CacheReject, .destroy = CacheDestroy};
  if (!solver) PetscFunctionReturn(0);
  responder->state_size = CacheStateSize;
  responder->save = CacheSave;
  responder->load = CacheLoad;
  PetscFunctionReturn(0);
}
