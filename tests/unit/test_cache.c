/*
  Claims about answers from a database with a solver behind it. Runs on any number of ranks.
*/
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <lamella/cache.h>
#include "synthetic_responder.h"

#define assert_ok(call) assert_int_equal((call), 0)

enum { POINTS = 12 };

/* The trust radius is calibrated for tissue; the third derivatives of the synthetic material are larger. */
#define ACCURACY 0.0025

typedef struct {
  LamScene scene;
  LamDatabase database;
  LamResponder solver, cache;
  Synthetic *material;
  LamLoad loads[POINTS];
  PetscInt points[POINTS];
  LamResponse responses[POINTS];
} Fixture;

static void SetUp(Fixture *fixture, MPI_Comm comm, PetscBool solve)
{
  memset(fixture, 0, sizeof(*fixture));
  fixture->scene.scales = (LamScales){.length = 75e-6, .stress = 0.11e6, .macro_length = 0.01};
  fixture->scene.accuracy = ACCURACY;
  fixture->scene.micro = (LamMicrostructure){.wall_thickness = 0.15,
                                             .cells = {1, 1},
                                             .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000},
                                             .along = 4,
                                             .through = 1};
  assert_ok(LamDatabaseCreateEmpty(&fixture->scene, &fixture->database));
  assert_ok(SyntheticCreate(POINTS, &fixture->solver, &fixture->material));
  assert_ok(LamCacheResponderCreate(comm, fixture->database, solve ? &fixture->solver : NULL, ACCURACY, POINTS,
                                    &fixture->cache));
}

static void TearDown(Fixture *fixture)
{
  assert_ok(fixture->cache.destroy(&fixture->cache.ctx));
  assert_ok(fixture->solver.destroy(&fixture->solver.ctx));
  assert_ok(LamDatabaseClose(&fixture->database));
}

static void SetLoad(Fixture *fixture, PetscInt p, PetscReal stretch)
{
  fixture->loads[p] = (LamLoad){{1 + stretch, 0, 0, 0, 1, 0, 0, 0, 1}, 0.2, 0};
  fixture->points[p] = p;
}

static void Respond(Fixture *fixture, PetscInt n)
{
  assert_ok(fixture->cache.respond(fixture->cache.ctx, n, fixture->loads, fixture->points, fixture->responses));
}

static PetscInt RecordCount(const Fixture *fixture)
{
  PetscInt n;

  assert_ok(LamDatabaseGetRecords(fixture->database, &n, NULL, NULL));
  return n;
}

/* Error of an answer against the material. */
static PetscReal Error(const Fixture *fixture, PetscInt p)
{
  LamResponse exact;

  assert_ok(LamResponseInit(&fixture->loads[p], &exact));
  SyntheticEvaluate(fixture->material, &fixture->loads[p], &exact);
  return LamStressError(fixture->responses[p].P, exact.P);
}

/* What is asked the first time is solved, the second time it is found. */
static void SecondQuestionIsAHit(void **state)
{
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  SetLoad(&fixture, 0, 0.1);
  Respond(&fixture, 1);
  assert_int_equal(fixture.cache.hits, 0);
  assert_int_equal(fixture.cache.solves, 1);
  Respond(&fixture, 1);
  assert_int_equal(fixture.cache.hits, 1);
  assert_int_equal(fixture.cache.solves, 1);
  assert_int_equal(fixture.cache.queries, 2);
  TearDown(&fixture);
}

static void AnswersAreAccurate(void **state)
{
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  for (PetscInt p = 0; p < POINTS; p++) SetLoad(&fixture, p, 0.01 * p);
  Respond(&fixture, POINTS);
  for (PetscInt p = 0; p < POINTS; p++) {
    assert_int_equal(fixture.responses[p].status, LAM_CONVERGED);
    assert_true(Error(&fixture, p) < 0.01);
  }
  TearDown(&fixture);
}

/* Close questions share a solve. */
static void CloseQuestionsShareASolve(void **state)
{
  const PetscReal step = 0.2 * (0.28 * PetscSqrtReal(ACCURACY));
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  for (PetscInt p = 0; p < 4; p++) SetLoad(&fixture, p, step * p);
  Respond(&fixture, 4);
  assert_int_equal(fixture.cache.solves, 1);
  for (PetscInt p = 0; p < 4; p++) assert_true(LamResponseHasFields(&fixture.responses[p]));
  TearDown(&fixture);
}

static void DatabaseAloneNeverSolves(void **state)
{
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_FALSE);
  SetLoad(&fixture, 0, 0.1);
  Respond(&fixture, 1);
  assert_int_equal(fixture.responses[0].status, LAM_OUT_OF_REACH);
  assert_int_equal(fixture.cache.failures, 1);
  assert_int_equal(fixture.material->calls, 0);
  TearDown(&fixture);
}

/* A failed solve answers the questions that relied on it, with its status and reason. */
static void FailedSolveIsTheAnswer(void **state)
{
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  fixture.material->largest_strain = 0.05;
  SetLoad(&fixture, 0, 0.1);
  SetLoad(&fixture, 1, 0.1001);
  Respond(&fixture, 2);
  for (PetscInt p = 0; p < 2; p++) {
    assert_int_equal(fixture.responses[p].status, LAM_NOT_CONVERGED);
    assert_string_equal(fixture.responses[p].reason, "too far");
    assert_true(fixture.responses[p].load.F[0] == fixture.loads[p].F[0]);
  }
  assert_int_equal(fixture.cache.failures, 2);
  TearDown(&fixture);
}

/* queries = hits + solved for + failures: close questions are solved for by one solve, a new record is no hit. */
static void CountsAddUp(void **state)
{
  const PetscReal step = 0.2 * (0.28 * PetscSqrtReal(ACCURACY));
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  fixture.material->largest_strain = 0.2;
  for (PetscInt p = 0; p < 4; p++) SetLoad(&fixture, p, step * p);
  SetLoad(&fixture, 4, 0.25);
  Respond(&fixture, 5);
  assert_int_equal(fixture.cache.queries, 5);
  assert_int_equal(fixture.cache.hits, 0);
  assert_int_equal(fixture.cache.solves, 2);
  assert_int_equal(fixture.cache.failures, 1);
  fixture.loads[5] = fixture.loads[0];
  fixture.loads[5].F[0] = -1; /* a query refuses it: no hit */
  fixture.points[5] = 5;
  Respond(&fixture, 6);
  assert_int_equal(fixture.cache.queries, 11);
  assert_int_equal(fixture.cache.hits, 4);
  assert_int_equal(fixture.cache.failures, 3);
  TearDown(&fixture);
}

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

/* Of a batch that the solver left unfinished the solved part is kept, and nothing else. */
static void StoppedBatchKeepsWhatIsSolved(void **state)
{
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  fixture.solver.respond = RespondStopped;
  for (PetscInt p = 0; p < 3; p++) SetLoad(&fixture, p, 0.1 * p);
  Respond(&fixture, 3);
  assert_int_equal(fixture.responses[0].status, LAM_CONVERGED);
  assert_int_equal(fixture.responses[1].status, LAM_OUT_OF_REACH);
  assert_int_equal(fixture.responses[2].status, LAM_OUT_OF_REACH);
  assert_int_equal(RecordCount(&fixture), 1);
  TearDown(&fixture);
}

/* Within a load step a point stays with its record though another has come nearer; after it the nearest answers. */
static void PointKeepsItsRecordWithinAStep(void **state)
{
  const PetscReal radius = (0.28 * PetscSqrtReal(ACCURACY));
  PetscReal kept;
  Fixture fixture;

  SetUp(&fixture, PETSC_COMM_SELF, PETSC_TRUE);
  SetLoad(&fixture, 0, 0);
  Respond(&fixture, 1);
  SetLoad(&fixture, 0, 0.9 * radius);
  Respond(&fixture, 1);
  kept = fixture.responses[0].distance;
  assert_true(kept > 0.5 * radius);
  SyntheticEvaluate(fixture.material, &fixture.loads[0], &fixture.responses[0]);
  assert_ok(LamDatabaseAdd(fixture.database, 1, NULL, &fixture.responses[0]));
  Respond(&fixture, 1);
  assert_true(fixture.responses[0].distance == kept);
  assert_ok(fixture.cache.accept(fixture.cache.ctx));
  Respond(&fixture, 1);
  assert_true(fixture.responses[0].distance < 1e-9);
  TearDown(&fixture);
}

/* The same questions spread over the ranks leave the same records, in the same order, as on one rank. */
static void RecordsDoNotDependOnRanks(void **state)
{
  const PetscReal rounding = 1e-14; /* of another order of summation */
  PetscMPIInt rank, ranks;
  PetscInt n = 0;
  const LamResponse *a, *b;
  Fixture one, all;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  SetUp(&one, PETSC_COMM_SELF, PETSC_TRUE);
  SetUp(&all, PETSC_COMM_WORLD, PETSC_TRUE);
  for (PetscInt p = 0; p < POINTS; p++) {
    SetLoad(&one, p, 0.1 - 0.008 * p);
    if (p % ranks == rank) SetLoad(&all, n++, 0.1 - 0.008 * p + rank * rounding);
  }
  Respond(&one, POINTS);
  Respond(&all, n);
  assert_true(RecordCount(&one) > 3 && RecordCount(&one) < POINTS);
  assert_int_equal(RecordCount(&one), RecordCount(&all));
  assert_ok(LamDatabaseGetRecords(one.database, NULL, &a, NULL));
  assert_ok(LamDatabaseGetRecords(all.database, NULL, &b, NULL));
  for (PetscInt k = 0; k < RecordCount(&one); k++) {
    assert_memory_equal(&a[k].load, &b[k].load, sizeof(LamLoad));
    assert_memory_equal(a[k].P, b[k].P, sizeof(a[k].P));
  }
  TearDown(&one);
  TearDown(&all);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(SecondQuestionIsAHit),          cmocka_unit_test(AnswersAreAccurate),
      cmocka_unit_test(CloseQuestionsShareASolve),     cmocka_unit_test(DatabaseAloneNeverSolves),
      cmocka_unit_test(FailedSolveIsTheAnswer),        cmocka_unit_test(PointKeepsItsRecordWithinAStep),
      cmocka_unit_test(RecordsDoNotDependOnRanks),     cmocka_unit_test(CountsAddUp),
      cmocka_unit_test(StoppedBatchKeepsWhatIsSolved),
  };
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  cmocka_set_message_output(CM_OUTPUT_STDOUT);
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
