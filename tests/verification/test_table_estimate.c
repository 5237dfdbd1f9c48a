/* What a table says of its own answers, against fresh solves of states that it has not seen: the error estimate, and
   which indicators are trusted. The figures of docs/results/verification.md with slack: small samples. */
#include "support/test.h"
#include <lamella/lamella.h>
#include "support/random_reals.h"
#include "support/table_fixture.h"
#include "support/tissue.h"

#define BONDED_STATES 60
#define CONTACT_STATES 40

#define TISSUE                                                                                                         \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  mesh: {along: 6, through: 2}\n"

static const char bonded_scene[] = TISSUE "  interface: {law: bonded}\n"
                                          "sample:\n"
                                          "  stretch: {min: -0.02, max: 0.25}\n"
                                          "  turgor: {min: 0 MPa, max: 0.05 MPa}\n";
static const char contact_scene[] = TISSUE "  interface: {law: contact}\n"
                                           "sample:\n"
                                           "  stretch: {min: 0.04, max: 0.11}\n"
                                           "  turgor: {min: 0.02 MPa, max: 0.04 MPa}\n";

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamResponder solver;
  LamDatabase database;
} Tissue;

/* The answer of the table and a fresh solve of the same state. */
typedef struct {
  LamResponse answer, solve;
} Pair;

static LamResponse Solve(const Tissue *t, const LamLoad *load)
{
  LamResponse r;

  assert_int_equal(LamResponderRespond(t->solver, 1, load, NULL, &r), 0);
  return r;
}

static void Start(const char scene[], Tissue *t)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamGrid grid;
  PetscInt n;

  assert_int_equal(LamSceneReadText("test_table_estimate", scene, &t->scene), 0);
  assert_int_equal(NewTissue(&t->scene->micro, &t->rve, NULL), 0);
  assert_int_equal(LamRVEResponderCreate(t->rve, 0, &t->solver), 0);
  assert_int_equal(LamGridCreate(t->scene, t->solver, &grid), 0);
  assert_int_equal(LamDatabaseCreateEmpty(t->scene, &t->database), 0);
  assert_int_equal(LamGridGetRecords(grid, &n, &keys, &records), 0);
  assert_int_equal(LamDatabaseAdd(t->database, n, keys, records), 0);
  assert_int_equal(LamDatabaseSetGrid(t->database, &grid), 0);
}

static void Finish(Tissue *t)
{
  assert_int_equal(LamDatabaseClose(&t->database), 0);
  assert_int_equal(LamResponderDestroy(&t->solver), 0);
  assert_int_equal(LamRVEDestroy(&t->rve), 0);
  LamSceneDestroy(&t->scene);
}

static LamLoad RandomLoad(uint64_t *seed, const LamSample *box)
{
  const double e0 = exp(RandomReal(seed, box->stretch_min, box->stretch_max)),
               e1 = exp(RandomReal(seed, box->stretch_min, box->stretch_max)), angle = RandomReal(seed, 0, PETSC_PI),
               c = cos(angle), s = sin(angle);
  LamLoad load = {
      .F = {c * c * e0 + s * s * e1, c * s * (e0 - e1), 0, c * s * (e0 - e1), s * s * e0 + c * c * e1, 0, 0, 0, 1}};

  load.turgor = RandomReal(seed, box->turgor_min, box->turgor_max);
  if (box->F33_max > box->F33_min) load.F[8] = RandomReal(seed, box->F33_min, box->F33_max);
  return load;
}

/* Builds a table that answers n random states to the accuracy, then asks n others. Returns how many it answers. */
static int Compare(Tissue *t, PetscReal accuracy, int n, Pair pairs[])
{
  uint64_t seed = 1;
  OWNED(LamTable, LamTableDestroy) table;
  int answered = 0;

  for (int i = 0; i < n; i++) {
    const LamLoad load = RandomLoad(&seed, &t->scene->sample);

    assert_int_equal(RefineTable(t->database, t->solver, &load, accuracy), 0);
  }
  assert_int_equal(LamDatabaseGetTable(t->database, &table), 0);
  for (int i = 0; i < n; i++) {
    const LamLoad load = RandomLoad(&seed, &t->scene->sample);
    Pair *pair = &pairs[answered];

    assert_int_equal(LamTableQuery(table, &load, PETSC_INFINITY, &pair->answer), 0);
    if (pair->answer.status != LAM_CONVERGED || pair->answer.error_estimate == 0) continue;
    pair->solve = Solve(t, &load);
    if (pair->solve.status == LAM_CONVERGED) answered++;
  }
  return answered;
}

/* Errors of P and of the tangent are at most three times their estimates, or a tenth of the accuracy, but for a share
   `missed`; half of the estimates of P are at most ten times the error; no accepted P is beyond three times the
   accuracy. */
static void check_estimates(const Pair pairs[], int n, double missed, PetscReal accuracy)
{
  int near = 0, low = 0, tangent_low = 0;

  for (int i = 0; i < n; i++) {
    const LamResponse *answer = &pairs[i].answer, *solve = &pairs[i].solve;
    const LamMicrostructure micro = DefaultTissue();
    const double error = StressError(answer->P, solve->P);
    const double tangent = LamTangentError(LamStressScaleOf(&micro), answer->tangent, solve->tangent);

    near += answer->error_estimate < 10 * error;
    low += error > 3 * answer->error_estimate && error > 0.1 * accuracy;
    tangent_low += tangent > 3 * answer->tangent_error_estimate && tangent > 0.1 * accuracy;
    if (answer->error_estimate <= accuracy) assert_true(error <= 3 * accuracy);
  }
  assert_true(near >= 0.5 * n);
  assert_true(low <= missed * n);
  assert_true(tangent_low <= 0.05 * n);
}

static PetscBool IsClose(double a, double b)
{
  return (PetscBool)(fabs(a - b) < 0.1 * (fabs(b) + 0.0227));
}

/* Nineteen of twenty trusted answers: largest stresses within 10 %, shares of the interface within 0.1. */
static void check_trust(const Pair pairs[], int n, double least)
{
  int trusted = 0, close = 0;

  for (int i = 0; i < n; i++) {
    const LamResponse *a = &pairs[i].answer, *b = &pairs[i].solve;

    if (!a->indicators_trusted) continue;
    trusted++;
    close += IsClose(a->max_wall_tension, b->max_wall_tension) && IsClose(a->max_traction, b->max_traction) &&
             fabs(a->open_fraction - b->open_fraction) < 0.1 && fabs(a->debonded_fraction - b->debonded_fraction) < 0.1;
  }
  assert_true(trusted >= least * n);
  assert_true(close >= 0.93 * trusted);
}

static void check_bounds(const Pair pairs[], int n)
{
  for (int i = 0; i < n; i++) {
    const LamResponse *a = &pairs[i].answer;
    const PetscReal shares[] = {a->open_fraction, a->debonded_fraction, a->open_by_face[0], a->debonded_by_face[2]};

    for (int k = 0; k < 4; k++) assert_true(shares[k] >= 0 && shares[k] <= 1);
    assert_true(a->opening_fraction >= 0 && a->max_gap >= 0 && a->opening_by_face[1] >= 0);
  }
}

TEST(bonded_answers_know_their_error)
{
  Pair pairs[BONDED_STATES];
  Tissue t;
  int n;

  Start(bonded_scene, &t);
  n = Compare(&t, 0.01, BONDED_STATES, pairs);
  assert_int_equal(n, BONDED_STATES);
  check_estimates(pairs, n, 0.03, 0.01);
  check_trust(pairs, n, 0); /* of so coarse a table none is */
  check_bounds(pairs, n);
  Finish(&t);
}

TEST(contact_answers_know_their_error)
{
  Pair pairs[CONTACT_STATES];
  Tissue t;
  int n;

  Start(contact_scene, &t);
  n = Compare(&t, 0.03, CONTACT_STATES, pairs);
  assert_true(n > CONTACT_STATES / 2);
  check_estimates(pairs, n, 0.03, 0.03);
  check_trust(pairs, n, 0.1);
  check_bounds(pairs, n);
  Finish(&t);
}

/* ---- a range of F33 ---- */

static const char bonded_axial[] = TISSUE "  interface: {law: bonded}\n"
                                          "sample:\n"
                                          "  stretch: {min: -0.02, max: 0.25}\n"
                                          "  turgor: {min: 0 MPa, max: 0.05 MPa}\n"
                                          "  F33: {min: 0.85, max: 1.15}\n";
static const char contact_axial[] = TISSUE "  interface: {law: contact}\n"
                                           "sample:\n"
                                           "  stretch: {min: 0.04, max: 0.1}\n"
                                           "  turgor: {min: 0.02 MPa, max: 0.04 MPa}\n"
                                           "  F33: {min: 0.9, max: 1.1}\n";

/* P33, a derivative of the potential, is as near to the solves as P. */
static void check_axial(const char scene[], PetscReal accuracy, int states, int least)
{
  Pair pairs[BONDED_STATES];
  int n, near = 0;
  LamStressScale scale;
  Tissue t;

  Start(scene, &t);
  scale = LamStressScaleOf(&t.scene->micro);
  n = Compare(&t, accuracy, states, pairs);
  assert_true(n >= least);
  check_estimates(pairs, n, 0.03, accuracy);
  for (int i = 0; i < n; i++) near += LamAxialError(scale, pairs[i].answer.P, pairs[i].solve.P) < accuracy;
  assert_true(near >= 0.95 * n);
  Finish(&t);
}

TEST_IS(bonded_answers_at_any_F33_know_their_error, check_axial(bonded_axial, 0.01, BONDED_STATES, 50));
TEST_IS(contact_answers_at_any_F33_know_their_error, check_axial(contact_axial, 0.03, CONTACT_STATES, 15));

static PetscReal Sum(const PetscReal a[3])
{
  return a[0] + a[1] + a[2];
}

/* Same F, other turgor (with contact at the cost of cohesion): tension stays, tractions change by as much. */
static void check_shift(const char scene[], LamLoad near, PetscReal d)
{
  PetscInt64 keys[LAM_MAX_NEEDS];
  LamResponse answer, solve;
  LamTable table;
  LamGrid grid;
  LamLoad load;
  PetscInt n;
  Tissue t;

  Start(scene, &t);
  assert_int_equal(LamDatabaseGetGrid(t.database, &grid), 0);
  assert_int_equal(LamDatabaseGetTable(t.database, &table), 0);
  assert_int_equal(LamTableNeeds(table, &near, 1, NULL, &n, keys), 0);
  assert_int_equal(LamTableDestroy(&table), 0);
  assert_int_equal(RefineTable(t.database, t.solver, &near, PETSC_INFINITY), 0);
  assert_int_equal(LamDatabaseGetTable(t.database, &table), 0);
  /* at a node, where interpolation adds no error: the first whose cell is there */
  answer.status = LAM_OUT_OF_REACH;
  for (PetscInt k = 0; k < n && answer.status != LAM_CONVERGED; k++) {
    assert_int_equal(LamGridNodeLoad(grid, keys[k], &load), 0);
    for (int i = 0; i < 9; i += 4) load.F[i] *= i < 8 ? 1 + 1e-9 : 1; /* into the cell */
    load.turgor += d;
    if (t.scene->micro.interface == LAM_INTERFACE_CONTACT) load.cohesion -= d;
    assert_int_equal(LamTableQuery(table, &load, PETSC_INFINITY, &answer), 0);
  }
  assert_int_equal(LamTableDestroy(&table), 0);
  assert_int_equal(answer.status, LAM_CONVERGED);
  solve = Solve(&t, &load);
  assert_near(answer.max_wall_tension, solve.max_wall_tension, 2e-3);
  assert_near(answer.max_traction, solve.max_traction, 2e-3);
  /* which of three families that are alike comes apart is not determined */
  assert_near(Sum(answer.mean_face_traction), Sum(solve.mean_face_traction), 2e-3);
  Finish(&t);
}

TEST(turgor_at_fixed_walls_shifts_tractions_alone)
{
  const LamLoad bonded = {.F = {1.1, 0, 0, 0, 1.05, 0, 0, 0, 1}, .turgor = 0.2},
                contact = {.F = {1.02, 0, 0, 0, 1.01, 0, 0, 0, 1}, .turgor = 0.3};

  check_shift(bonded_scene, bonded, 0.2);
  check_shift(contact_scene, contact, -0.1);
}

TEST_GROUP(.petsc = 1);
