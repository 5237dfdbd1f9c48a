/* Answers for walls between databases, against solves of those walls. */
#include "support/test.h"
#include <string.h>
#include "support/polygons.h"
#include "support/table_fixture.h"
#include "support/tissue.h"

enum { KNOTS = 4, STATES = 6 };
#define ASKED 0.005

static const LamLoad loads[STATES] = {
    {.F = {1.05, 0.04, 0, 0.0, 1.02, 0, 0, 0, 1}, .turgor = 0.1},
    {.F = {1.02, 0.1, 0, 0.03, 1.1, 0, 0, 0, 1}, .turgor = 0.3},
    {.F = {1.15, 0.0, 0, 0.0, 1.0, 0, 0, 0, 1}, .turgor = 0.2},
    {.F = {1.1, -0.05, 0, 0.02, 1.1, 0, 0, 0, 1}},
    {.F = {1.0, 0.12, 0, 0.0, 1.03, 0, 0, 0, 1}, .turgor = 0.4},
    {.F = {1.2, 0.02, 0, -0.02, 1.12, 0, 0, 0, 1}, .turgor = 0.1},
};

/* A database that answers the loads to ASKED / 5. */
static void Build(const LamMicrostructure *micro, LamDatabase *db)
{
  LamScene scene = {.micro = *micro, .accuracy = ASKED, .scales = {75e-6, 0.11e6, 0}, .turgor = 0.2};
  OWNED(LamRVE, LamRVEDestroy) rve;
  OWNED(LamResponder, LamResponderDestroy) solver;
  LamGrid grid;

  assert_int_equal(NewTissue(micro, &rve, NULL), 0);
  assert_int_equal(LamRVEResponderCreate(rve, 0, &solver), 0);
  assert_int_equal(LamGridCreate(&scene, NULL, &grid), 0);
  assert_int_equal(LamDatabaseCreateEmpty(&scene, db), 0);
  assert_int_equal(LamDatabaseSetGrid(*db, &grid), 0);
  for (int s = 0; s < STATES; s++) assert_int_equal(RefineTable(*db, solver, &loads[s], ASKED / 5), 0);
}

/* The family first: it borrows the databases. */
static void Close(LamParametricDatabase *family, int n, LamDatabase databases[])
{
  CHECK(LamParametricDatabaseDestroy(family));
  for (int i = 0; i < n; i++) CHECK(LamDatabaseClose(&databases[i]));
}

static LamMicrostructure Tissue(LamParametricAxis axis, PetscReal value)
{
  LamMicrostructure micro = DefaultTissue();

  if (axis == LAM_FAMILY_WALL_THICKNESS) micro.wall_thickness = value;
  if (axis == LAM_FAMILY_C4) micro.wall.C4 = value * micro.wall.C1;
  if (axis >= LAM_FAMILY_k1 && axis <= LAM_FAMILY_dispersion) {
    micro.wall = (LamWall){.law = LAM_WALL_FIBRE_EXPONENTIAL,
                           .C1 = micro.wall.C1,
                           .C2 = micro.wall.C2,
                           .k2 = 3,
                           .k1 = 0.5 * micro.wall.C4,
                           .bulk_modulus = micro.wall.bulk_modulus};
    if (axis == LAM_FAMILY_k1) micro.wall.k1 = value * micro.wall.C1;
    if (axis == LAM_FAMILY_k2) micro.wall.k2 = value;
    if (axis == LAM_FAMILY_dispersion) micro.wall.dispersion = value;
  }
  if (axis == LAM_FAMILY_MATRIX) {
    micro.wall.C1 = 1 / (1 + value);
    micro.wall.C2 = value / (1 + value);
  }
  return micro;
}

/* Knots in an order that is not ascending; errors at a value between them. */
static void CheckAxis(LamParametricAxis axis, const PetscReal values[KNOTS], PetscReal between)
{
  LamDatabase databases[KNOTS];
  LamMicrostructure micro = Tissue(axis, between);
  LamParametricDatabase family;
  LamParametricAxis found;
  PetscReal least, most;

  for (int i = 0; i < KNOTS; i++) {
    const LamMicrostructure knot = Tissue(axis, values[(i + 2) % KNOTS]);

    Build(&knot, &databases[i]);
  }
  assert_int_equal(LamParametricDatabaseCreate(KNOTS, databases, &family), 0);
  assert_int_equal(LamParametricDatabaseGetAxis(family, &found, &least, &most), 0);
  assert_int_equal(found, axis);
  assert_near(least, values[0], 1e-12);
  assert_near(most, values[KNOTS - 1], 1e-12);
  for (int s = 0; s < STATES; s++) {
    LamResponse truth, answer;
    PetscReal error;

    assert_int_equal(SolveOnce(&micro, &loads[s], &truth), 0);
    assert_int_equal(LamParametricDatabaseQuery(family, between, &loads[s], INFINITY, &answer), 0);
    assert_int_equal(answer.status, LAM_CONVERGED);
    error = LamStressError(LamStressScaleOf(&micro), answer.P, truth.P);
    assert_true(error < (answer.error_estimate <= ASKED ? ASKED : 2 * ASKED));
    assert_true(error < 2 * answer.error_estimate + ASKED / 10);
    assert_near(answer.lumen_fraction, truth.lumen_fraction, 1e-3);
  }
  Close(&family, KNOTS, databases);
}

TEST(walls_of_any_thickness)
{
  static const PetscReal values[KNOTS] = {0.1, 0.13, 0.17, 0.22};

  CheckAxis(LAM_FAMILY_WALL_THICKNESS, values, 0.15);
}

TEST(fibres_of_any_stiffness)
{
  static const PetscReal values[KNOTS] = {4, 7, 12, 20};

  CheckAxis(LAM_FAMILY_C4, values, 9);
}

TEST(parameters_of_exponential_fibres)
{
  static const PetscReal k1[KNOTS] = {2, 4, 6, 10}, k2[KNOTS] = {0, 2, 4, 6}, dispersion[KNOTS] = {0, 0.04, 0.08, 0.12};

  CheckAxis(LAM_FAMILY_k1, k1, 5);
  CheckAxis(LAM_FAMILY_k2, k2, 3);
  CheckAxis(LAM_FAMILY_dispersion, dispersion, 0.05);
}

TEST(matrices_of_any_kind)
{
  static const PetscReal values[KNOTS] = {0.05, 0.15, 0.4, 1};

  CheckAxis(LAM_FAMILY_MATRIX, values, 0.25);
}

/* C4/C1 = 8 and 10. */
static void BuildPair(LamDatabase databases[2])
{
  for (int i = 0; i < 2; i++) {
    const LamMicrostructure micro = Tissue(LAM_FAMILY_C4, i ? 10 : 8);

    Build(&micro, &databases[i]);
  }
}

TEST(at_a_knot_the_answer_is_its_database_s)
{
  LamDatabase databases[2];
  LamParametricDatabase family;

  BuildPair(databases);
  assert_int_equal(LamParametricDatabaseCreate(2, databases, &family), 0);
  for (int s = 0; s < STATES; s++) {
    LamResponse own, answer;

    assert_int_equal(LamDatabaseQuery(databases[0], &loads[s], INFINITY, &own), 0);
    assert_int_equal(LamParametricDatabaseQuery(family, 8, &loads[s], INFINITY, &answer), 0);
    for (int i = 0; i < 9; i++) assert_near(answer.P[i], own.P[i], 1e-12);
  }
  Close(&family, 2, databases);
}

TEST(beyond_the_knots_is_refused)
{
  LamDatabase databases[2];
  LamParametricDatabase family;
  LamResponse answer;

  BuildPair(databases);
  assert_int_equal(LamParametricDatabaseCreate(2, databases, &family), 0);
  assert_int_equal(LamParametricDatabaseQuery(family, 11, &loads[0], INFINITY, &answer), 0);
  assert_int_equal(answer.status, LAM_OUT_OF_REACH);
  assert_non_null(strstr(answer.reason, "C4/C1 = 11"));
  Close(&family, 2, databases);
}

/* Opens a family of two databases of polygons, which differ in their thickness. */
static PetscErrorCode PolygonFamily(Displacement one, Displacement other)
{
  LamParametricDatabase family = NULL;
  LamDatabase databases[2];
  PetscErrorCode error;

  for (int i = 0; i < 2; i++) {
    LamScene scene = {.micro = Tissue(LAM_FAMILY_WALL_THICKNESS, 0.1 + 0.05 * i), .scales = {75e-6, 0.11e6, 0}};

    scene.micro.cells[0] = 4;
    CHECK(PolygonsCreate(2, i ? other : one, &scene.micro.tissue));
    CHECK(LamDatabaseCreateEmpty(&scene, &databases[i]));
    CHECK(LamTissueDestroy(&scene.micro.tissue));
  }
  CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = LamParametricDatabaseCreate(2, databases, &family);
  CHECK(PetscPopErrorHandler());
  Close(&family, 2, databases);
  return error;
}

TEST(polygons_of_two_thicknesses_are_a_family_if_they_are_the_same)
{
  CHECK(PolygonFamily(Waves, Waves));
  assert_int_equal(PolygonFamily(Waves, OddWaves), PETSC_ERR_USER_INPUT);
}

TEST_GROUP(.petsc = 1);
