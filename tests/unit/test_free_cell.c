/* Cells that touch no one, of a tissue with known answers: what lies between the knots, and the text of them. */
#include "support/test.h"
#include <stdio.h>
#include <stdlib.h>
#include "free_cell.h"
#include "support/random_reals.h"
#include "test_scene_message.h"

#define KNOTS 17
#define COHESION 0.1
#define SCALE 0.02
#define SUCTION_MIN 0.05
#define SUCTION_MAX 0.6

static const LamMicrostructure tissue = {.wall_thickness = 0.15, .cells = {1, 1}, .interface = LAM_INTERFACE_CONTACT};

/* ---- the tissue: polynomials that the interpolation reproduces ---- */

static double Tau(double s)
{
  return log1p(s / SCALE);
}

/* Value and first two derivatives of sum c_i x^i. */
static void Polynomial(int degree, const double c[], double x, double y[3])
{
  y[0] = y[1] = y[2] = 0;
  for (int i = degree; i >= 0; i--) {
    y[2] = y[2] * x + 2 * y[1];
    y[1] = y[1] * x + y[0];
    y[0] = y[0] * x + c[i];
  }
}

static const double width_of_tau[4] = {-0.02, 0.05, -0.01, 0.01};
static const double energy_of_s[6] = {0.1, -1, -0.7, 0.4, -0.3, 0.2};
static const double turgor_of_tau[2][4] = {{0.2, 0.02, -0.01, 0.003}, {-0.01, 0.001, 0.002, -0.0005}};

static LamResponse Answer(const LamLoad *load)
{
  const double J = load->F[0] * load->F[4] - load->F[1] * load->F[3], s = load->turgor + load->cohesion;
  double a[3], E[3], T[3], U[3];
  LamResponse r;

  assert_int_equal(LamResponseInit(load, &r), 0);
  Polynomial(3, width_of_tau, Tau(s), a);
  Polynomial(5, energy_of_s, s, E);
  Polynomial(3, turgor_of_tau[0], Tau(s), T);
  Polynomial(3, turgor_of_tau[1], Tau(s), U);
  r.min_gap = fmax(0, 2 * (load->F[0] - exp(a[0])));
  r.floating_cells = r.min_gap > 0 ? 1 : 0;
  r.status = LAM_CONVERGED;
  r.energy = E[0] + load->cohesion * J;
  r.energy_turgor = E[1];
  r.energy_cohesion = E[1] + J - T[0];
  r.energy_turgor2 = E[2];
  r.energy_turgor_cohesion = 0.3;
  r.energy_cohesion2 = U[0] - E[2] + 2 * r.energy_turgor_cohesion;
  return r;
}

typedef struct {
  int solves;
  PetscReal failing;  /* suction from which on nothing converges */
  PetscReal touching; /* suction from which on nothing floats */
} Tissue;

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  Tissue *known = ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    assert_int_equal(points[i], -1);
    responses[i] = Answer(&loads[i]);
    if (loads[i].turgor + loads[i].cohesion >= known->failing) responses[i].status = LAM_NOT_CONVERGED;
    if (loads[i].turgor + loads[i].cohesion >= known->touching) responses[i].floating_cells = 0;
  }
  known->solves += (int)n;
  PetscFunctionReturn(0);
}

static LamFreeCell MakeOf(const LamMicrostructure *micro, Tissue *known)
{
  const LamResponderFunctions functions = {.respond = Respond};
  OWNED(LamResponder, LamResponderDestroy) solver;
  LamFreeCell cell;

  assert_int_equal(LamResponderCreate(&functions, known, NULL, &solver), 0);
  assert_int_equal(LamFreeCellMake(micro, COHESION, SUCTION_MIN, SUCTION_MAX, SCALE, KNOTS, NULL, solver, &cell), 0);
  return cell;
}

static LamFreeCell Make(void)
{
  Tissue known = {.failing = INFINITY, .touching = INFINITY};

  return MakeOf(&tissue, &known);
}

/* A test on a `LamFreeCell *cell` that `make` gives. */
#define CELL_TEST(name, make) TEST_ON(name, LamFreeCell, cell, *cell = make, LamFreeCellDestroy(cell))

static double RandomSuction(uint64_t *seed)
{
  return RandomReal(seed, SUCTION_MIN, SUCTION_MAX);
}

/* ---- the states ---- */

TEST(states_are_moved_apart_until_they_float)
{
  Tissue known = {.failing = INFINITY, .touching = INFINITY};
  OWNED(LamFreeCell, LamFreeCellDestroy) cell = MakeOf(&tissue, &known);
  int solves = 0;

  for (int j = 0; j < KNOTS; j++) {
    double a[3];

    Polynomial(3, width_of_tau, Tau(cell.suction[j]), a);
    solves += 1 + (int)fmax(0, ceil((a[0] - 0.15) / 0.1));
    assert_int_equal(cell.records[j].floating_cells, 1);
    assert_near(cell.records[j].load.turgor + COHESION, cell.suction[j], 1e-15);
    assert_true(cell.records[j].load.cohesion == COHESION);
  }
  assert_int_equal(known.solves, solves);
  assert_true(solves > KNOTS);
}

CELL_TEST(knots_are_even_between_the_ends, Make())
{
  assert_true(cell->suction[0] == SUCTION_MIN && cell->suction[KNOTS - 1] == SUCTION_MAX);
  for (int j = 2; j < KNOTS; j++)
    assert_near(Tau(cell->suction[j]) - 2 * Tau(cell->suction[j - 1]) + Tau(cell->suction[j - 2]), 0, 1e-13);
}

static void AssertNone(Tissue known)
{
  OWNED(LamFreeCell, LamFreeCellDestroy) cell = MakeOf(&tissue, &known);

  assert_int_equal(cell.n, 0);
  assert_null(cell.suction);
  assert_null(cell.records);
}

TEST_IS(a_state_that_fails_leaves_none, AssertNone((Tissue){.failing = 0.5, .touching = INFINITY}));
TEST_IS(a_cell_that_stays_in_touch_leaves_none, AssertNone((Tissue){.failing = INFINITY, .touching = 0.5}));

TEST(tissue_without_free_cells_is_not_solved)
{
  LamMicrostructure none[4] = {tissue, tissue, tissue, tissue};
  LamCell differing = {.turgor = 0.5};

  none[0].interface = LAM_INTERFACE_BONDED;
  none[1].is_patch = PETSC_TRUE;
  none[2].cell = &differing;
  none[3].cells[1] = 2; /* these drift apart */
  for (int k = 0; k < 4; k++) {
    Tissue known = {.failing = INFINITY, .touching = INFINITY};
    OWNED(LamFreeCell, LamFreeCellDestroy) cell = MakeOf(&none[k], &known);

    assert_int_equal(cell.n, 0);
    assert_int_equal(known.solves, 0);
  }
}

/* ---- between the knots ---- */

/* With the chain rule from tau to s. */
CELL_TEST(the_spline_is_exact_for_a_cubic_in_tau, Make())
{
  uint64_t seed = 1;

  for (int k = 0; k < 200; k++) {
    const double s = RandomSuction(&seed), rate = 1 / (s + SCALE);
    double a[3], strain[3];

    Polynomial(3, width_of_tau, Tau(s), a);
    LamFreeCellStrain(cell, s, strain);
    assert_near(strain[0], a[0], 1e-14);
    assert_near(strain[1], a[1] * rate, 1e-12);
    assert_near(strain[2], (a[2] - a[1]) * rate * rate, 1e-9);
  }
}

CELL_TEST(the_energy_is_exact_for_a_quintic, Make())
{
  uint64_t seed = 2;

  for (int k = 0; k < 200; k++) {
    const double s = RandomSuction(&seed);
    double exact[3], energy[3], turgor[2][3];

    Polynomial(5, energy_of_s, s, exact);
    LamFreeCellEnergy(cell, 0, s, energy, turgor);
    assert_near(energy[0], exact[0], 1e-14);
    assert_near(energy[1], exact[1], 1e-13);
    assert_near(energy[2], exact[2], 1e-10);
  }
}

CELL_TEST(the_step_in_turgor_is_exact_for_a_cubic_in_tau, Make())
{
  uint64_t seed = 3;

  for (int k = 0; k < 200; k++) {
    const double s = RandomSuction(&seed);
    double energy[3], turgor[2][3];

    LamFreeCellEnergy(cell, 0, s, energy, turgor);
    for (int i = 0; i < 2; i++) {
      double exact[3];

      Polynomial(3, turgor_of_tau[i], Tau(s), exact);
      for (int order = 0; order < 3; order++) assert_near(turgor[i][order], exact[order], order < 2 ? 1e-13 : 1e-11);
    }
  }
}

/* Knots with values that fit nothing. */
static void Roughen(LamFreeCell *cell)
{
  uint64_t seed = 4;

  for (int j = 0; j < KNOTS; j++) {
    cell->energy[j] += RandomReal(&seed, -0.1, 0.1);
    cell->slope[j] += RandomReal(&seed, -0.1, 0.1);
    cell->curvature[j] += RandomReal(&seed, -0.1, 0.1);
    cell->turgor_slope[j] += RandomReal(&seed, -0.1, 0.1);
    cell->turgor_curvature[j] += RandomReal(&seed, -0.1, 0.1);
  }
}

/* strain and its derivatives, the energy and its, what the step in turgor needs. */
static void All(const LamFreeCell *cell, double s, double y[8])
{
  double turgor[2][3];

  LamFreeCellStrain(cell, s, y);
  LamFreeCellEnergy(cell, 0, s, y + 3, turgor);
  y[6] = turgor[0][0];
  y[7] = turgor[1][0];
}

CELL_TEST(derivatives_are_those_of_the_values, Make())
{
  uint64_t seed = 5;

  Roughen(cell);
  for (int k = 0; k < 200; k++) {
    const double s = RandomSuction(&seed), h = 1e-6 * (s + SCALE);
    const double from = fmax(s - h, SUCTION_MIN), to = fmin(s + h, SUCTION_MAX);
    double at[8], left[8], right[8];

    All(cell, 0.5 * (from + to), at);
    All(cell, from, left);
    All(cell, to, right);
    for (int i = 0; i < 6; i++)
      if (i % 3 < 2) assert_near((right[i] - left[i]) / (to - from), at[i + 1], 1e-5 * (1 + fabs(at[i + 1])));
  }
}

CELL_TEST(nothing_jumps_at_a_knot, Make())
{
  Roughen(cell);
  for (int j = 1; j < KNOTS - 1; j++) {
    const double h = 1e-12 * cell->suction[j];
    double left[8], right[8];

    All(cell, cell->suction[j] - h, left);
    All(cell, cell->suction[j] + h, right);
    for (int i = 0; i < 8; i++) assert_near(right[i], left[i], 1e-5 * (1 + fabs(left[i])));
    assert_near(right[3], cell->energy[j], 1e-8);
    assert_near(right[4], cell->slope[j], 1e-6);
    assert_near(right[5], cell->curvature[j], 1e-3);
    assert_near(right[6], cell->turgor_slope[j], 1e-7);
    assert_near(right[7], cell->turgor_curvature[j], 1e-7);
  }
}

CELL_TEST(the_step_in_turgor_has_a_continuous_slope, Make())
{
  Roughen(cell);
  for (int j = 1; j < KNOTS - 1; j++) {
    const double s = cell->suction[j], h = 1e-6 * s;
    double left[8], at[8], right[8];

    All(cell, s - h, left);
    All(cell, s, at);
    All(cell, s + h, right);
    for (int i = 6; i < 8; i++) assert_near((right[i] - at[i]) / h, (at[i] - left[i]) / h, 1e-2);
  }
}

/* ---- JSON ---- */

static json_t *TextAndBack(const LamFreeCell *cell)
{
  json_t *object, *read;
  char *text;

  assert_int_equal(LamFreeCellToJSON(cell, &object), 0);
  text = json_dumps(object, 0);
  assert_non_null(text);
  read = json_loads(text, 0, NULL);
  free(text);
  json_decref(object);
  assert_non_null(read);
  return read;
}

static void AssertSameNumbers(const PetscReal a[], const PetscReal b[])
{
  assert_memory_equal(a, b, KNOTS * sizeof(PetscReal));
}

CELL_TEST(the_text_keeps_every_bit, Make())
{
  OWNED(LamFreeCell, LamFreeCellDestroy) copy;
  json_t *object = TextAndBack(cell);

  assert_int_equal(LamFreeCellFromJSON("a.h5", object, &copy), 0);
  json_decref(object);
  assert_int_equal(copy.n, KNOTS);
  assert_true(copy.scale == cell->scale && copy.cohesion == cell->cohesion);
  assert_null(copy.records);
  AssertSameNumbers(copy.suction, cell->suction);
  AssertSameNumbers(copy.strain, cell->strain);
  AssertSameNumbers(copy.strain_curvature, cell->strain_curvature);
  AssertSameNumbers(copy.energy, cell->energy);
  AssertSameNumbers(copy.slope, cell->slope);
  AssertSameNumbers(copy.curvature, cell->curvature);
  AssertSameNumbers(copy.turgor_slope, cell->turgor_slope);
  AssertSameNumbers(copy.turgor_curvature, cell->turgor_curvature);
}

TEST(no_free_cell_has_a_text_too)
{
  const LamFreeCell none = {.n = 0};
  json_t *object = TextAndBack(&none);
  OWNED(LamFreeCell, LamFreeCellDestroy) copy;

  assert_int_equal(LamFreeCellFromJSON("a.h5", object, &copy), 0);
  assert_int_equal(copy.n, 0);
  json_decref(object);
}

/* Takes over the object. */
static void AssertRefused(json_t *object, const char what[])
{
  PetscErrorCode error;
  OWNED(LamFreeCell, LamFreeCellDestroy) copy;

  CATCH(LamFreeCellFromJSON("a.h5", object, &copy), error);
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(scene_message, "a.h5"));
  if (!strstr(scene_message, what)) fail_msg("\"%s\" does not name %s", scene_message, what);
  json_decref(object);
}

CELL_TEST(damage_is_refused, Make())
{
  json_t *object;

  AssertRefused(json_pack("[f]", 1.0), "free cell");
  AssertRefused(json_object(), "scale");
  object = TextAndBack(cell);
  json_object_del(object, "slope");
  AssertRefused(object, "slope");
  object = TextAndBack(cell);
  json_array_remove(json_object_get(object, "energy"), 3);
  AssertRefused(object, "energy");
  object = TextAndBack(cell);
  json_array_set_new(json_object_get(object, "strain"), 3, json_null());
  AssertRefused(object, "strain");
  object = TextAndBack(cell);
  json_array_set_new(json_object_get(object, "suction"), 3, json_real(1.01 * cell->suction[3]));
  AssertRefused(object, "suction");
  object = TextAndBack(cell);
  json_object_set_new(object, "scale", json_real(-1));
  AssertRefused(object, "scale");
  object = TextAndBack(cell);
  json_object_set_new(object, "suction", json_pack("[f, f]", 0.1, 0.2));
  AssertRefused(object, "2 knots");
}
