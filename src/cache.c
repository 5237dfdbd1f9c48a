/*
  Responders that answer from a database: alone, or with a solver for what it lacks.

  Method. Answers come from the nearest record by its second-order expansion. Questions out of reach are collected over
  all ranks, and only a thinned set of them is solved: a question within the trust radius of a chosen one is answered
  from that one's record.

  Algorithm, of one `respond`:
  1. Query all; the rest is missing. Done where nothing is missing on any rank.
  2. Gather the missing questions on all ranks, rounded to a grid and sorted: the same list whatever the ranks are.
  3. Choose greedily in that order: a question further than the radius from all chosen ones is chosen.
  4. Deal the chosen out in turn, solve, gather the responses on all ranks, add them to each rank's database in order.
  5. Query the missing again; from 1 with what is still missing. Each round answers at least the chosen ones.

  Reference: Pope, Combustion Theory and Modelling 1 (1997) 41, for storing and retrieving with a trusted neighbourhood.
*/
#include <lamella/cache.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  MPI_Comm comm;
  LamDatabase database; /* borrowed */
  LamResponder *solver; /* borrowed; NULL: database only */
  LamResponder *self;   /* the responder's counters; borrowed */
  PetscReal radius;
  PetscInt points;
  PetscInt *hint; /* [points] record that answered last in this load step, -1: none */
} Cache;

/* Questions of one round: all that are missing, then the chosen of them. */
typedef struct {
  PetscInt chosen_count;
  LamLoad *chosen;     /* sorted */
  LamResponse *solved; /* of each chosen question */
} Round;

/* Binary grid of 2^-33, about 1e-10: sums in another order end on the same question, and rounding is exact. */
static PetscReal OnGrid(PetscReal x)
{
  return ldexp(rint(ldexp(x, 33)), -33);
}

static LamLoad RoundLoad(const LamLoad *load)
{
  LamLoad rounded;

  for (int k = 0; k < 9; k++) rounded.F[k] = OnGrid(load->F[k]);
  rounded.turgor = OnGrid(load->turgor);
  rounded.cohesion = OnGrid(load->cohesion);
  return rounded;
}

/* Order of the keys: F, then turgor, then cohesion. */
static int CompareLoads(const void *first, const void *second)
{
  const LamLoad *a = (const LamLoad *)first, *b = (const LamLoad *)second;

  for (int k = 0; k < 9; k++) {
    if (a->F[k] != b->F[k]) return a->F[k] < b->F[k] ? -1 : 1;
  }
  if (a->turgor != b->turgor) return a->turgor < b->turgor ? -1 : 1;
  if (a->cohesion != b->cohesion) return a->cohesion < b->cohesion ? -1 : 1;
  return 0;
}

/* Distance of two questions, a strain: half the change of (C11 + C22)/2, (C11 - C22)/2, C12, as in a database; and
 * turgor. */
static PetscReal LoadDistance(const LamLoad *a, const LamLoad *b)
{
  PetscReal sum = PetscSqr(a->turgor - b->turgor) + PetscSqr(a->cohesion - b->cohesion);

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      PetscReal difference = 0;
      for (int k = 0; k < 3; k++) difference += a->F[3 * k + i] * a->F[3 * k + j] - b->F[3 * k + i] * b->F[3 * k + j];
      sum += 0.125 * PetscSqr(difference);
    }
  }
  return PetscSqrtReal(sum);
}

/* The first chosen question within the radius, -1: none. */
static PetscInt Covering(const Cache *cache, const Round *round, const LamLoad *load)
{
  for (PetscInt c = 0; c < round->chosen_count; c++) {
    if (LoadDistance(load, &round->chosen[c]) <= cache->radius) return c;
  }
  return -1;
}

/* Gathers items of `size` bytes from all ranks on all ranks; starts[ranks + 1] counts items. The caller frees both. */
static PetscErrorCode AllGather(MPI_Comm comm, size_t size, PetscInt n, const void *items, PetscMPIInt **starts,
                                void **all)
{
  PetscMPIInt ranks, bytes, count, *counts;
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(PetscMPIIntCast((PetscInt)size, &bytes));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCall(PetscMalloc1(ranks, &counts));
  PetscCall(PetscMalloc1(ranks + 1, starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  (*starts)[0] = 0;
  for (PetscMPIInt r = 0; r < ranks; r++) (*starts)[r + 1] = (*starts)[r] + counts[r];
  PetscCall(PetscMalloc(size * (*starts)[ranks], all));
  PetscCallMPI(MPI_Type_contiguous(bytes, MPI_BYTE, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCallMPI(MPI_Allgatherv(items, count, type, *all, counts, *starts, type, comm));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(0);
}

/* Steps 2 and 3: the questions to solve, the same on all ranks. */
static PetscErrorCode Choose(const Cache *cache, PetscInt n, const LamLoad missing[], Round *round)
{
  PetscMPIInt ranks, *starts;
  PetscInt total;
  LamLoad *all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(cache->comm, &ranks));
  PetscCall(AllGather(cache->comm, sizeof(LamLoad), n, missing, &starts, (void **)&all));
  total = starts[ranks];
  qsort(all, (size_t)total, sizeof(LamLoad), CompareLoads);
  round->chosen = all; /* chosen in place: the k-th chosen never comes after the question it is copied from */
  round->chosen_count = 0;
  for (PetscInt k = 0; k < total; k++) {
    if (Covering(cache, round, &all[k]) < 0) round->chosen[round->chosen_count++] = all[k];
  }
  PetscCall(PetscFree(starts));
  PetscFunctionReturn(0);
}

/* Adds what was solved, failed or not: all of it, unless the solver was stopped on the way. */
static PetscErrorCode AddSolved(Cache *cache, const Round *round)
{
  LamResponse *records;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(round->chosen_count, &records));
  for (PetscInt k = 0; k < round->chosen_count; k++) {
    if (round->solved[k].status != LAM_OUT_OF_REACH) records[n++] = round->solved[k];
  }
  PetscCall(LamDatabaseAdd(cache->database, n, NULL, records));
  PetscCall(PetscFree(records));
  PetscFunctionReturn(0);
}

/* Step 4: question k goes to rank k mod ranks. */
static PetscErrorCode SolveChosen(Cache *cache, Round *round)
{
  PetscMPIInt rank, ranks, *starts;
  PetscInt n = 0, *points;
  const LamResponder before = *cache->solver;
  LamLoad *loads;
  LamResponse *mine, *all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(cache->comm, &rank));
  PetscCallMPI(MPI_Comm_size(cache->comm, &ranks));
  PetscCall(PetscMalloc3(round->chosen_count, &loads, round->chosen_count, &points, round->chosen_count, &mine));
  for (PetscInt k = rank; k < round->chosen_count; k += ranks) {
    loads[n] = round->chosen[k];
    points[n++] = -1; /* from the reference state: the answer must not depend on who solves it */
  }
  PetscCall(cache->solver->respond(cache->solver->ctx, n, loads, points, mine));
  cache->self->solves += cache->solver->solves - before.solves;
  cache->self->solve_seconds += cache->solver->solve_seconds - before.solve_seconds;
  PetscCall(AllGather(cache->comm, sizeof(LamResponse), n, mine, &starts, (void **)&all));
  PetscCall(PetscMalloc1(round->chosen_count, &round->solved));
  for (PetscInt k = 0; k < round->chosen_count; k++) round->solved[k] = all[starts[k % ranks] + k / ranks];
  PetscCall(AddSolved(cache, round));
  PetscCall(PetscFree(starts));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree3(loads, points, mine));
  PetscFunctionReturn(0);
}

static PetscErrorCode Ask(Cache *cache, const LamLoad *load, PetscInt point, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamDatabaseQuery(cache->database, load, PetscSqr(cache->radius / 0.28), response));
  PetscFunctionReturn(0);
}

/*
  Step 5 for one question; *answered tells whether it has its answer. A failed solve answers all that it was chosen for:
  with the same failure.
*/
static PetscErrorCode AskAgain(Cache *cache, const Round *round, const LamLoad *load, PetscInt point,
                               LamResponse *response, PetscBool *answered)
{
  LamLoad rounded = RoundLoad(load);
  PetscInt c;

  PetscFunctionBeginUser;
  *answered = PETSC_TRUE;
  PetscCall(Ask(cache, load, point, response));
  if (response->status != LAM_OUT_OF_REACH) PetscFunctionReturn(0);
  c = Covering(cache, round, &rounded);
  PetscCheck(c >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a missing question is not covered by the chosen ones");
  if (!LamResponseHasFields(&round->solved[c]) || !CompareLoads(&rounded, &round->chosen[c])) {
    *response = round->solved[c];
    response->load = *load;
  } else
    *answered = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* One round for the `*n` missing questions (places in loads); leaves the still missing ones there. */
static PetscErrorCode SolveMissing(Cache *cache, PetscInt *n, PetscInt missing[], const LamLoad loads[],
                                   const PetscInt points[], LamResponse responses[])
{
  PetscInt left = 0;
  LamLoad *questions;
  Round round = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(*n, &questions));
  for (PetscInt k = 0; k < *n; k++) questions[k] = RoundLoad(&loads[missing[k]]);
  PetscCall(Choose(cache, *n, questions, &round));
  PetscCall(SolveChosen(cache, &round));
  for (PetscInt k = 0; k < *n; k++) {
    PetscInt i = missing[k];
    PetscBool answered;
    PetscCall(AskAgain(cache, &round, &loads[i], points[i], &responses[i], &answered));
    if (!answered) missing[left++] = i;
  }
  *n = left;
  PetscCall(PetscFree(questions));
  PetscCall(PetscFree(round.chosen));
  PetscCall(PetscFree(round.solved));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                   LamResponse responses[])
{
  Cache *cache = (Cache *)ctx;
  PetscInt *missing, left = 0, anywhere;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &missing));
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(points[i] < cache->points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "material point %" PetscInt_FMT ", of %" PetscInt_FMT, points[i], cache->points);
    PetscCall(Ask(cache, &loads[i], points[i], &responses[i]));
    if (responses[i].status == LAM_OUT_OF_REACH) missing[left++] = i;
    if (LamResponseHasFields(&responses[i])) cache->self->hits++;
  }
  cache->self->queries += n;
  while (cache->solver) {
    PetscCallMPI(MPI_Allreduce(&left, &anywhere, 1, MPIU_INT, MPI_SUM, cache->comm));
    if (!anywhere) break;
    PetscCall(SolveMissing(cache, &left, missing, loads, points, responses));
  }
  for (PetscInt i = 0; i < n; i++) {
    if (!LamResponseHasFields(&responses[i])) cache->self->failures++;
  }
  PetscCall(PetscFree(missing));
  PetscFunctionReturn(0);
}

static void ForgetHints(Cache *cache)
{
  for (PetscInt p = 0; p < cache->points; p++) cache->hint[p] = -1;
}

static PetscErrorCode CacheAccept(void *ctx)
{
  Cache *cache = (Cache *)ctx;

  PetscFunctionBeginUser;
  ForgetHints(cache);
  if (cache->solver && cache->solver->accept) PetscCall(cache->solver->accept(cache->solver->ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheReject(void *ctx)
{
  Cache *cache = (Cache *)ctx;

  PetscFunctionBeginUser;
  ForgetHints(cache);
  if (cache->solver && cache->solver->reject) PetscCall(cache->solver->reject(cache->solver->ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode CacheDestroy(void **ctx)
{
  Cache *cache = (Cache *)*ctx;

  PetscFunctionBeginUser;
  if (!cache) PetscFunctionReturn(0);
  PetscCall(PetscFree(cache->hint));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCacheResponderCreate(MPI_Comm comm, LamDatabase database, LamResponder *solver, PetscReal accuracy,
                                       PetscInt points, LamResponder *responder)
{
  Cache *cache;

  PetscFunctionBeginUser;
  PetscCheck(accuracy > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "accuracy %g must be positive", (double)accuracy);
  PetscCall(PetscNew(&cache));
  cache->comm = comm;
  cache->database = database;
  cache->solver = solver;
  cache->self = responder;
  cache->radius = 0.28 * PetscSqrtReal(accuracy);
  cache->points = points;
  PetscCall(PetscMalloc1(points, &cache->hint));
  ForgetHints(cache);
  *responder = (LamResponder){
      .ctx = cache, .respond = CacheRespond, .accept = CacheAccept, .reject = CacheReject, .destroy = CacheDestroy};
  PetscFunctionReturn(0);
}
