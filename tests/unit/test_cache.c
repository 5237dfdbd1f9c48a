/* Claims about answers from a database with a solver behind it. Runs on any number of ranks. */
#include "support/test.h"
#include "support/tissue.h"
#include <lamella/cache.h>
#include "support/synthetic_responder.h"

enum { POINTS = 12 };

#define ACCURACY 0.01

typedef struct {
  LamScene scene;
  LamDatabase database;
  LamResponder solver, cache;
  LamNodeSolver nodes;
  PetscInt node_calls, near_calls;
  Synthetic *material;
  LamLoad loads[POINTS];
  PetscInt points[POINTS];
  LamResponse responses[POINTS];
} Fixture;

/* ---- the two solvers ---- */

static PetscErrorCode SolveNode(void *ctx, PetscInt64 key, LamResponse *response)
{
  Fixture *fixture = (Fixture *)ctx;
  LamGrid grid;
  LamLoad load;

  PetscFunctionBeginUser;
  fixture->node_calls++;
  PetscCall(LamDatabaseGetGrid(fixture->database, &grid));
  PetscCall(LamGridNodeLoad(grid, key, &load));
  PetscCall(LamResponseInit(&load, response));
  SyntheticEvaluate(fixture->material, &load, response);
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveNear(void *ctx, PetscInt64 key, const LamLoad *load, LamResponse *response)
{
  Fixture *fixture = (Fixture *)ctx;

  PetscFunctionBeginUser;
  PetscCheck(LamKeyIsNode(key), PETSC_COMM_SELF, PETSC_ERR_PLIB, "key %lld", (long long)key);
  fixture->near_calls++;
  PetscCall(LamResponseInit(load, response));
  SyntheticEvaluate(fixture->material, load, response);
  PetscFunctionReturn(0);
}

static PetscErrorCode FailNode(void *ctx, PetscInt64 key, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(SolveNode(ctx, key, response));
  response->status = LAM_NOT_CONVERGED;
  PetscFunctionReturn(0);
}

/* The first question alone is solved. */
static PetscErrorCode RespondStopped(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                     LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(SyntheticRespond(ctx, n, loads, points, responses));
  for (PetscInt k = 1; k < n; k++) {
    PetscCall(LamResponseInit(&loads[k], &responses[k]));
    responses[k].status = LAM_OUT_OF_REACH;
  }
  PetscFunctionReturn(0);
}

/* ---- fixture ---- */

typedef enum {
  NO_SOLVER,
  NO_GRID,
  CACHE,
  CACHE_OF_F33,
  CACHE_WITH_NODES,
  CACHE_WITH_BAD_NODES,
  STOPPING_CACHE,
  STOPPING_WITH_BAD_NODES
} Kind;

static void SetUp(Fixture *fixture, MPI_Comm comm, Kind kind)
{
  LamGrid grid;

  memset(fixture, 0, sizeof(*fixture));
  fixture->scene.scales = (LamScales){.length = 75e-6, .stress = 0.11e6, .macro_length = 0.01};
  fixture->scene.accuracy = ACCURACY;
  fixture->scene.has_sample = PETSC_TRUE;
  fixture->scene.sample = (LamSample){.stretch_min = -0.02, .stretch_max = 0.25, .turgor_min = 0, .turgor_max = 0.4};
  fixture->scene.micro = (LamMicrostructure){.wall_thickness = 0.15,
                                             .cells = {1, 1},
                                             .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000},
                                             .along = 4,
                                             .through = 1};
  if (kind == CACHE_OF_F33) fixture->scene.sample.F33_min = 0.9, fixture->scene.sample.F33_max = 1.2;
  CHECK(LamDatabaseCreateEmpty(&fixture->scene, &fixture->database));
  if (kind != NO_GRID) {
    CHECK(LamGridCreate(&fixture->scene, NULL, &grid));
    CHECK(LamDatabaseSetGrid(fixture->database, &grid));
  }
  CHECK(SyntheticCreate(POINTS, &fixture->solver, &fixture->material));
  fixture->nodes =
      (LamNodeSolver){fixture, kind == CACHE_WITH_NODES || kind == STOPPING_CACHE ? SolveNode : FailNode, NULL};
  CHECK(LamCacheResponderCreate(comm, fixture->database, kind == NO_SOLVER ? NULL : fixture->solver,
                                kind >= CACHE_WITH_NODES ? &fixture->nodes : NULL,
                                kind >= STOPPING_CACHE ? LAM_OUTSIDE_STOP : LAM_OUTSIDE_SOLVE, ACCURACY, POINTS,
                                &fixture->cache));
}

static void TearDown(Fixture *fixture)
{
  CHECK(LamResponderDestroy(&fixture->cache));
  CHECK(LamResponderDestroy(&fixture->solver));
  CHECK(LamDatabaseClose(&fixture->database));
}

/* A test with a `Fixture *fixture` of this kind. */
#define CACHE_TEST(name, kind) TEST_ON(name, Fixture, fixture, SetUp(fixture, PETSC_COMM_SELF, kind), TearDown(fixture))

static void SetLoad(Fixture *fixture, PetscInt p, PetscReal stretch)
{
  fixture->loads[p] = (LamLoad){.F = {1 + stretch, 0.3 * stretch, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.1};
  fixture->points[p] = p;
}

static void Respond(Fixture *fixture, PetscInt n)
{
  CHECK(LamResponderRespond(fixture->cache, n, fixture->loads, fixture->points, fixture->responses));
}

/* One point, stretched so. */
static void RespondAt(Fixture *fixture, PetscReal stretch)
{
  SetLoad(fixture, 0, stretch);
  Respond(fixture, 1);
}

static PetscInt RecordCount(const Fixture *fixture)
{
  PetscInt n;

  CHECK(LamDatabaseGetRecords(fixture->database, &n, NULL, NULL));
  return n;
}

/* Error of an answer against the material. */
static PetscReal Error(const Fixture *fixture, PetscInt p)
{
  LamResponse exact;

  CHECK(LamResponseInit(&fixture->loads[p], &exact));
  SyntheticEvaluate(fixture->material, &fixture->loads[p], &exact);
  return StressError(fixture->responses[p].P, exact.P);
}

/* Nodes around a state, as a question that asks for more accuracy would add them. */
static void RefineAround(Fixture *fixture, const LamLoad *load)
{
  PetscInt64 keys[LAM_MAX_NEEDS];
  LamResponse records[LAM_MAX_NEEDS];
  LamTable table;
  PetscInt n;

  for (int round = 0; round < 4; round++) {
    CHECK(LamDatabaseGetTable(fixture->database, &table));
    CHECK(LamTableNeeds(table, load, 1e-6, NULL, &n, keys));
    for (PetscInt k = 0; k < n; k++) CHECK(SolveNode(fixture, keys[k], &records[k]));
    CHECK(LamDatabaseAdd(fixture->database, n, keys, records));
    CHECK(LamTableDestroy(&table));
  }
}

/* ---- what is solved ---- */

/* What is asked the first time is solved for, the second time it is found. */
CACHE_TEST(SecondQuestionIsAHit, CACHE)
{
  PetscInt64 solves;

  RespondAt(fixture, 0.1);
  assert_int_equal(fixture->responses[0].source, LAM_SOURCE_DATABASE);
  assert_int_equal(LamResponderGetCounters(fixture->cache).hits, 0);
  assert_true((solves = LamResponderGetCounters(fixture->cache).solves) > 0);
  Respond(fixture, 1);
  assert_int_equal(LamResponderGetCounters(fixture->cache).hits, 1);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, solves);
  assert_int_equal(LamResponderGetCounters(fixture->cache).queries, 2);
}

CACHE_TEST(AnswersAreAccurate, CACHE)
{
  for (PetscInt p = 0; p < POINTS; p++) SetLoad(fixture, p, 0.02 * p);
  Respond(fixture, POINTS);
  for (PetscInt p = 0; p < POINTS; p++) {
    assert_int_equal(fixture->responses[p].status, LAM_CONVERGED);
    assert_true(Error(fixture, p) < ACCURACY);
  }
}

/* Questions around share the nodes: of many questions most cost nothing. */
CACHE_TEST(QuestionsShareNodes, CACHE)
{
  PetscInt64 solves;

  RespondAt(fixture, 0.1);
  solves = LamResponderGetCounters(fixture->cache).solves;
  for (PetscInt p = 0; p < POINTS; p++) SetLoad(fixture, p, 0.1 + 1e-3 * p);
  Respond(fixture, POINTS);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, solves);
}

CACHE_TEST(NodesAreTheNodeSolvers, CACHE_WITH_NODES)
{
  RespondAt(fixture, 0.1);
  assert_true(Error(fixture, 0) < ACCURACY);
  assert_int_equal(fixture->material->calls, 0);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, fixture->node_calls);
  assert_int_equal(RecordCount(fixture), fixture->node_calls);
}

/* With more accuracy than nodes can give: a query and its mirror image share a solve, each with its own response. */
CACHE_TEST(StatesBesideTheTableStartFromANode, CACHE_WITH_NODES)
{
  const PetscReal c = cos(0.3), s = sin(0.3);

  fixture->nodes.solve_near = SolveNear;
  CHECK(LamResponderDestroy(&fixture->cache));
  CHECK(LamCacheResponderCreate(PETSC_COMM_SELF, fixture->database, fixture->solver, &fixture->nodes, LAM_OUTSIDE_SOLVE,
                                1e-14, POINTS, &fixture->cache));
  SetLoad(fixture, 0, 0.1);
  fixture->loads[1] = fixture->loads[0];
  fixture->loads[1].F[1] *= -1;
  fixture->loads[2] = fixture->loads[0]; /* R F */
  for (int j = 0; j < 2; j++) {
    fixture->loads[2].F[j] = c * fixture->loads[0].F[j] - s * fixture->loads[0].F[3 + j];
    fixture->loads[2].F[3 + j] = s * fixture->loads[0].F[j] + c * fixture->loads[0].F[3 + j];
  }
  for (PetscInt p = 0; p < 3; p++) fixture->points[p] = p;
  Respond(fixture, 3);
  assert_int_equal(fixture->near_calls, 1);
  for (PetscInt p = 0; p < 3; p++) {
    assert_int_equal(fixture->responses[p].source, LAM_SOURCE_SOLVE);
    assert_true(Error(fixture, p) < 1e-10);
  }
}

/* Where no node helps the state is solved as it was asked for, and is found when it is asked for again. */
CACHE_TEST(WithoutNodesTheStateIsSolved, CACHE_WITH_BAD_NODES)
{
  PetscInt64 solves;

  RespondAt(fixture, 0.1);
  assert_int_equal(fixture->responses[0].status, LAM_CONVERGED);
  assert_int_equal(fixture->responses[0].source, LAM_SOURCE_SOLVE);
  assert_true(Error(fixture, 0) < 1e-13);
  solves = LamResponderGetCounters(fixture->cache).solves;
  assert_int_equal(solves, fixture->node_calls + 1);
  Respond(fixture, 1);
  assert_true(Error(fixture, 0) < 1e-12);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, solves);
  assert_int_equal(LamResponderGetCounters(fixture->cache).hits, 1);
}

/* A database without a grid: equal questions, and they alone, share a solve. */
CACHE_TEST(WithoutAGridStatesAreSolved, NO_GRID)
{
  for (PetscInt p = 0; p < 4; p++) SetLoad(fixture, p, 0.1 + 1e-4 * (p / 2) + 1e-15 * p);
  Respond(fixture, 4);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, 2);
  for (PetscInt p = 0; p < 4; p++) assert_true(Error(fixture, p) < 1e-13);
}

CACHE_TEST(DatabaseAloneNeverSolves, NO_SOLVER)
{
  LamResponse answer;
  OWNED(LamTable, LamTableDestroy) table;

  RespondAt(fixture, 0.1);
  assert_int_equal(fixture->responses[0].status, LAM_OUT_OF_REACH);
  assert_int_equal(LamResponderGetCounters(fixture->cache).failures, 1);
  assert_int_equal(fixture->material->calls, 0);
  CHECK(LamDatabaseGetTable(fixture->database, &table));
  CHECK(LamTableQuery(table, &fixture->loads[0], ACCURACY, &answer));
  assert_true(answer.reason[0]);
  assert_string_equal(fixture->responses[0].reason, answer.reason);
}

/* ---- what fails ---- */

/* A failed solve is the answer to its question, with its status and reason. */
CACHE_TEST(FailedSolveIsTheAnswer, CACHE)
{
  fixture->material->largest_strain = 0.05;
  SetLoad(fixture, 0, 0.1);
  SetLoad(fixture, 1, 0.1001);
  Respond(fixture, 2);
  for (PetscInt p = 0; p < 2; p++) {
    assert_int_equal(fixture->responses[p].status, LAM_NOT_CONVERGED);
    assert_string_equal(fixture->responses[p].reason, "too far");
    assert_true(fixture->responses[p].load.F[0] == fixture->loads[p].F[0]);
  }
  assert_int_equal(LamResponderGetCounters(fixture->cache).failures, 2);
}

/* queries = hits + solved for + failures: close questions are solved for by the same nodes, a new answer is no hit. */
CACHE_TEST(CountsAddUp, CACHE)
{
  fixture->material->largest_strain = 0.3;
  for (PetscInt p = 0; p < 4; p++) SetLoad(fixture, p, 0.01 * p);
  SetLoad(fixture, 4, 0.35);
  Respond(fixture, 5);
  assert_int_equal(LamResponderGetCounters(fixture->cache).queries, 5);
  assert_int_equal(LamResponderGetCounters(fixture->cache).hits, 0);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, LamResponderGetCounters(fixture->solver).solves);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, RecordCount(fixture));
  assert_int_equal(LamResponderGetCounters(fixture->cache).failures, 1);
  fixture->loads[5] = fixture->loads[0];
  fixture->loads[5].F[0] = -1; /* a query refuses it: no hit */
  fixture->points[5] = 5;
  Respond(fixture, 6);
  assert_int_equal(LamResponderGetCounters(fixture->cache).queries, 11);
  assert_int_equal(LamResponderGetCounters(fixture->cache).hits, 4);
  assert_int_equal(LamResponderGetCounters(fixture->cache).failures, 3);
}

/* Of a batch that the solver left unfinished the solved part is kept, and nothing else; nothing is asked again. */
CACHE_TEST(StoppedBatchKeepsWhatIsSolved, CACHE)
{
  fixture->material->respond = RespondStopped;
  RespondAt(fixture, 0.1);
  assert_int_equal(fixture->responses[0].status, LAM_OUT_OF_REACH);
  assert_int_equal(RecordCount(fixture), 1);
  assert_int_equal(fixture->material->calls, 1);
}

/* It refines its table, but solves no state for itself. */
CACHE_TEST(StoppingCacheSolvesNodes, STOPPING_CACHE)
{
  RespondAt(fixture, 0.1);
  assert_int_equal(fixture->responses[0].status, LAM_CONVERGED);
  assert_int_equal(LamResponderGetCounters(fixture->cache).interpolated, 1);
}

CACHE_TEST(StoppingCacheSolvesNothingElse, STOPPING_WITH_BAD_NODES)
{
  RespondAt(fixture, 0.1);
  assert_int_equal(fixture->responses[0].status, LAM_OUT_OF_REACH);
  assert_true(fixture->responses[0].reason[0] != 0);
  assert_int_equal(fixture->material->calls, 0);
  assert_int_equal(LamResponderGetCounters(fixture->cache).interpolated, 0);
  assert_int_equal(LamResponderGetCounters(fixture->cache).failures, 1);
}

/* ---- models of states beside the table ---- */

/* Where no node helps, the state solved for a point answers it in a neighbourhood, also in the next load step. */
CACHE_TEST(SolvedStateAnswersAround, CACHE_WITH_BAD_NODES)
{
  PetscInt64 solves;

  RespondAt(fixture, 0.1);
  solves = LamResponderGetCounters(fixture->cache).solves;
  for (PetscInt k = 1; k <= 4; k++) {
    RespondAt(fixture, 0.1 + 2e-3 * (PetscReal)k);
    assert_int_equal(fixture->responses[0].source, LAM_SOURCE_DATABASE);
    assert_true(Error(fixture, 0) < ACCURACY);
    CHECK(LamResponderAccept(fixture->cache));
  }
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, solves);
  RespondAt(fixture, 0.2);
  assert_int_equal(fixture->responses[0].source, LAM_SOURCE_SOLVE);
}

/* Stress is the derivative of the energy, and the tangent that of stress, away from the state that was solved. */
CACHE_TEST(AnswersAroundAreOfOnePotential, CACHE_WITH_BAD_NODES)
{
  const PetscReal h = 1e-5;
  LamResponse at[3];

  RespondAt(fixture, 0.1);
  for (int k = 0; k < 3; k++) {
    SetLoad(fixture, 0, 0.108);
    fixture->loads[0].F[1] += h * (k - 1);
    Respond(fixture, 1);
    assert_int_equal(fixture->responses[0].source, LAM_SOURCE_DATABASE);
    at[k] = fixture->responses[0];
  }
  assert_float_equal((at[2].energy - at[0].energy) / (2 * h), at[1].P[1], 1e-8);
  assert_float_equal(at[1].lumen_fraction, -at[1].energy_turgor, 1e-14);
  for (int i = 0; i < 9; i++) {
    if (i % 3 == 2 || i / 3 == 2) continue;
    assert_float_equal((at[2].P[i] - at[0].P[i]) / (2 * h), at[1].tangent[9 * i + 1], 1e-7);
  }
}

/* What a point took to in a step that was given up is forgotten with it. */
CACHE_TEST(RejectedStepGivesTheModelBack, CACHE_WITH_BAD_NODES)
{
  RespondAt(fixture, 0.1);
  CHECK(LamResponderAccept(fixture->cache));
  RespondAt(fixture, 0.2);
  CHECK(LamResponderReject(fixture->cache));
  SetLoad(fixture, 0, 0.13); /* too far away to take to the model anew */
  Respond(fixture, 1);
  assert_int_equal(fixture->responses[0].source, LAM_SOURCE_DATABASE);
}

CACHE_TEST(QuestionThatIsNoNumberIsInvalid, NO_GRID)
{
  RespondAt(fixture, NAN);
  assert_int_equal(fixture->responses[0].status, LAM_INVALID_F);
  assert_int_equal(RecordCount(fixture), 0);
}

/* A run that goes on with the bytes of another one, and its records in another order, has the same answer. */
TEST(KeptModelIsFoundAgain)
{
  Fixture first, second;
  const LamResponse *records;
  LamResponse record;
  size_t size;
  char *bytes;

  SetUp(&first, PETSC_COMM_SELF, CACHE_WITH_BAD_NODES);
  SetUp(&second, PETSC_COMM_SELF, CACHE_WITH_BAD_NODES);
  for (PetscInt p = 0; p < 2; p++) SetLoad(&first, p, p ? 0.1 : 0.2);
  Respond(&first, 2);
  CHECK(LamResponderAccept(first.cache));
  CHECK(LamDatabaseGetRecords(first.database, NULL, &records, NULL));
  for (PetscInt k = RecordCount(&first) - 1; k >= RecordCount(&first) - 2; k--) {
    record = records[k];
    CHECK(LamDatabaseAdd(second.database, 1, NULL, &record));
  }
  CHECK(LamResponderGetStateSize(first.cache, &size));
  CHECK(PetscMalloc(size, &bytes));
  CHECK(LamResponderSave(first.cache, 1, bytes));
  CHECK(LamResponderLoad(second.cache, 1, bytes));
  SetLoad(&first, 1, 0.13); /* too far away to take to the model anew */
  Respond(&first, 2);
  second.loads[0] = first.loads[1];
  second.points[0] = 1;
  Respond(&second, 1);
  assert_int_equal(second.responses[0].source, LAM_SOURCE_DATABASE);
  assert_memory_equal(second.responses[0].P, first.responses[1].P, sizeof(first.responses[1].P));
  CHECK(PetscFree(bytes));
  TearDown(&first);
  TearDown(&second);
}

/* Points close to each other share the states of a few of them. */
CACHE_TEST(NeighboursShareModels, CACHE_WITH_BAD_NODES)
{
  for (PetscInt p = 0; p < POINTS; p++) SetLoad(fixture, p, 0.1 + 1e-3 * (PetscReal)p);
  Respond(fixture, POINTS);
  assert_int_equal(LamResponderGetCounters(fixture->cache).solves, fixture->node_calls + 4);
  for (PetscInt p = 0; p < POINTS; p++) assert_true(Error(fixture, p) < ACCURACY / 4);
}

/* A state that failed may be on the other side of a loss of stability: what is not much nearer to one that answers is
   solved. */
CACHE_TEST(NoModelIsTakenToBesideAFailure, CACHE_WITH_BAD_NODES)
{
  const PetscReal stretch[] = {0.11, 0.09, 0.098};

  fixture->material->largest_strain = 0.11;
  for (PetscInt k = 0; k < 3; k++) {
    SetLoad(fixture, 0, stretch[k]);
    fixture->points[0] = k;
    Respond(fixture, 1);
    assert_int_equal(fixture->responses[0].status, k == 0 ? LAM_NOT_CONVERGED : LAM_CONVERGED);
    assert_int_equal(fixture->responses[0].source, LAM_SOURCE_SOLVE);
  }
}

static PetscReal AxialError(const Fixture *fixture, PetscInt p)
{
  LamResponse exact;

  CHECK(LamResponseInit(&fixture->loads[p], &exact));
  SyntheticEvaluate(fixture->material, &fixture->loads[p], &exact);
  return fabs(fixture->responses[p].P[8] - exact.P[8]) / fmax(fabs(exact.P[8]), 0.1);
}

/* A question adds the nodes of the knots of F33 next to it; another interval of F33 has one of them already. */
CACHE_TEST(NodesAreSolvedAtTheKnotsAroundAnF33, CACHE_OF_F33)
{
  SetLoad(fixture, 0, 0.1);
  fixture->loads[0].F[8] = 0.95;
  Respond(fixture, 1);
  const PetscInt first = RecordCount(fixture);
  assert_int_equal(first % 2, 0);
  assert_int_equal(fixture->responses[0].status, LAM_CONVERGED);
  assert_true(Error(fixture, 0) < ACCURACY && AxialError(fixture, 0) < ACCURACY);
  fixture->loads[0].F[8] = 1.07;
  Respond(fixture, 1);
  assert_int_equal(RecordCount(fixture), first + first / 2);
  assert_true(Error(fixture, 0) < ACCURACY && AxialError(fixture, 0) < ACCURACY);
  assert_int_equal(LamResponderGetCounters(fixture->cache).interpolated, 2);
}

/* Outside of the range, and in a table that has none, a state is solved; its model serves F33 nearby, too. */
CACHE_TEST(AModelServesF33NextToItsState, CACHE)
{
  for (PetscInt k = 0; k < 2; k++) {
    SetLoad(fixture, 0, 0.1);
    fixture->loads[0].F[8] = 1.1 + 2e-3 * (PetscReal)k;
    Respond(fixture, 1);
    assert_int_equal(fixture->responses[0].source, k ? LAM_SOURCE_DATABASE : LAM_SOURCE_SOLVE);
    assert_true(Error(fixture, 0) < 1e-4 && AxialError(fixture, 0) < 1e-4);
  }
  assert_int_equal(RecordCount(fixture), 1);
}

/* ---- within a load step ---- */

/* The answer to the first question stays when the table is refined, until the step is accepted or rejected. */
static void CheckThatAnswerStays(Fixture *fixture, PetscErrorCode (*end)(LamResponder))
{
  LamResponse before;

  RespondAt(fixture, 0.1);
  before = fixture->responses[0];
  RefineAround(fixture, &fixture->loads[0]);
  Respond(fixture, 1);
  assert_memory_equal(fixture->responses[0].P, before.P, sizeof(before.P));
  assert_memory_equal(&fixture->responses[0].energy, &before.energy, sizeof(before.energy));
  CHECK(end(fixture->cache));
  Respond(fixture, 1);
  assert_memory_not_equal(fixture->responses[0].P, before.P, sizeof(before.P));
  assert_true(Error(fixture, 0) < 1e-4);
}

CACHE_TEST(AnswerStaysUntilTheStepIsAccepted, CACHE)
{
  CheckThatAnswerStays(fixture, LamResponderAccept);
}

CACHE_TEST(AnswerStaysUntilTheStepIsRejected, CACHE)
{
  CheckThatAnswerStays(fixture, LamResponderReject);
}

/* A point whose states are solved for themselves goes on so within the step: here out of the plane, then in it. */
CACHE_TEST(SolvedPointStaysSolved, CACHE)
{
  for (PetscInt k = 0; k < 3; k++) {
    SetLoad(fixture, 0, 0.1);
    if (k < 2) fixture->loads[0].F[8] = 1.1 + 0.1 * (PetscReal)k;
    Respond(fixture, 1);
    assert_int_equal(fixture->responses[0].source, LAM_SOURCE_SOLVE);
  }
  assert_int_equal(RecordCount(fixture), 3);
  CHECK(LamResponderAccept(fixture->cache));
  fixture->loads[0].F[0] += 1e-3;
  Respond(fixture, 1);
  assert_int_equal(fixture->responses[0].source, LAM_SOURCE_DATABASE);
}

/* ---- ranks ---- */

/* The same questions spread over the ranks leave the same records, in the same order, as on one rank. */
TEST(RecordsDoNotDependOnRanks)
{
  const PetscReal rounding = 1e-14; /* of another order of summation */
  PetscMPIInt rank, ranks;
  PetscInt n = 0;
  const LamResponse *a, *b;
  const PetscInt64 *a_keys, *b_keys;
  Fixture one, all;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  SetUp(&one, PETSC_COMM_SELF, CACHE);
  SetUp(&all, PETSC_COMM_WORLD, CACHE);
  one.material->largest_strain = all.material->largest_strain = 0.3; /* some nodes fail: states are solved, too */
  for (PetscInt p = 0; p < POINTS; p++) {
    SetLoad(&one, p, 0.25 - 0.02 * p);
    if (p % ranks == rank) SetLoad(&all, n++, 0.25 - 0.02 * p + rank * rounding);
  }
  Respond(&one, POINTS);
  Respond(&all, n);
  assert_true(RecordCount(&one) > 10);
  assert_int_equal(RecordCount(&one), RecordCount(&all));
  CHECK(LamDatabaseGetRecords(one.database, NULL, &a, &a_keys));
  CHECK(LamDatabaseGetRecords(all.database, NULL, &b, &b_keys));
  for (PetscInt k = 0; k < RecordCount(&one); k++) {
    assert_int_equal(a_keys[k], b_keys[k]);
    assert_memory_equal(&a[k].load, &b[k].load, sizeof(LamLoad));
    assert_memory_equal(a[k].P, b[k].P, sizeof(a[k].P));
  }
  TearDown(&one);
  TearDown(&all);
}

TEST_GROUP(.petsc = 1);
