/* Tissue in which the fluid does not fill what the walls leave: its response depends on turgor by more than -p J, and
   its tables have turgor as an axis. */
#include "support/test.h"
#include <lamella/lamella.h>
#include <lamella/tissue.h>
#include <grid.h>
#include "support/table_fixture.h"
#include "support/tissue.h"

#define TISSUE                                                                                                         \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  mesh: {along: 4, through: 1}\n"
#define UNEQUAL "  cells: [2, 1]\n  variation: {kinds: [{turgor: 0.5}], list: [0, 1]}\n"
#define BOX "sample:\n  stretch: {min: 0.02, max: 0.12}\n  turgor: {min: 0 MPa, max: 0.05 MPa}\n"

static const char unequal[] = TISSUE UNEQUAL BOX, unequal_axial[] = TISSUE UNEQUAL BOX "  F33: {min: 0.9, max: 1.1}\n";

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamResponder solver;
  LamDatabase database;
  LamTable table; /* of the cells around `load` */
  LamLoad load;
} Tissue;

static void Start(const char scene[], PetscReal F33, Tissue *t)
{
  LamGrid grid;

  t->load = (LamLoad){.F = {1.07, 0.02, 0, 0.01, 1.05, 0, 0, 0, F33}, .turgor = 0.21};
  assert_int_equal(LamSceneReadText("test_unfilled", scene, &t->scene), 0);
  assert_int_equal(NewTissue(&t->scene->micro, &t->rve, NULL), 0);
  assert_int_equal(LamRVEResponderCreate(t->rve, 0, &t->solver), 0);
  assert_int_equal(LamGridCreate(t->scene, t->solver, &grid), 0);
  assert_int_equal(LamDatabaseCreateEmpty(t->scene, &t->database), 0);
  assert_int_equal(LamDatabaseSetGrid(t->database, &grid), 0);
  assert_int_equal(RefineTable(t->database, t->solver, &t->load, PETSC_INFINITY), 0);
  assert_int_equal(LamDatabaseGetTable(t->database, &t->table), 0);
}

static void Finish(Tissue *t)
{
  assert_int_equal(LamTableDestroy(&t->table), 0);
  assert_int_equal(LamDatabaseClose(&t->database), 0);
  assert_int_equal(LamResponderDestroy(&t->solver), 0);
  assert_int_equal(LamRVEDestroy(&t->rve), 0);
  LamSceneDestroy(&t->scene);
}

static LamResponse Query(const Tissue *t, const LamLoad *load)
{
  LamResponse r;

  assert_int_equal(LamTableQuery(t->table, load, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

static LamResponse Solve(const Tissue *t, const LamLoad *load)
{
  LamResponse r;

  assert_int_equal(LamResponderRespond(t->solver, 1, load, NULL, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

/* ---- which tissue it is ---- */

static void assert_fills(const char scene[], PetscBool expected)
{
  LamScene *read;
  PetscBool fills;

  assert_int_equal(LamSceneReadText("test_unfilled", scene, &read), 0);
  assert_int_equal(LamFluidFills(&read->micro, &fills), 0);
  assert_int_equal(fills, expected);
  LamSceneDestroy(&read);
}

TEST(fluid_fills_tissue_of_cells_alike)
{
  assert_fills(TISSUE, PETSC_TRUE);
  assert_fills(TISSUE "  cells: [2, 1]\n  variation: {kinds: [{wall_thickness: 8 um}], list: [0, 1]}\n", PETSC_TRUE);
}

TEST(fluid_does_not_fill_tissue_of_unequal_turgor)
{
  assert_fills(unequal, PETSC_FALSE);
  assert_fills(TISSUE "  cells: [2, 1]\n  variation: {kinds: [{turgor: 0.5}], list: [1, 1]}\n", PETSC_FALSE);
}

TEST(air_at_junctions_is_not_filled)
{
  LamScene *scene;
  LamTissue tissue;
  PetscBool fills;

  assert_int_equal(LamSceneReadText("test_unfilled", TISSUE, &scene), 0);
  assert_int_equal(LamTissueCreate(&scene->micro, &tissue), 0);
  scene->micro.tissue = tissue; /* the same hexagons, as polygons */
  assert_int_equal(LamFluidFills(&scene->micro, &fills), 0);
  assert_true(fills);
  for (PetscInt face = 0; face < tissue->faces; face++) tissue->setback[face] = 0.1;
  assert_int_equal(LamFluidFills(&scene->micro, &fills), 0);
  assert_false(fills);
  LamSceneDestroy(&scene); /* with its tissue */
}

/* ---- the table ---- */

TEST(a_filled_tissue_has_no_axis_of_turgor)
{
  static const char *const scenes[] = {TISSUE BOX, unequal};

  for (int n = 0; n < 2; n++) {
    LamScene *scene;
    LamGrid grid;

    assert_int_equal(LamSceneReadText("test_unfilled", scenes[n], &scene), 0);
    assert_int_equal(LamGridCreate(scene, NULL, &grid), 0);
    assert_int_equal(LamGridHasColumns(grid), n == 1);
    assert_int_equal(LamGridDestroy(&grid), 0);
    LamSceneDestroy(&scene);
  }
}

static const int in_plane[4] = {0, 1, 3, 4};
#define STEP 1e-6

/* Differences of the energy and of P in F and p are P, tangent and the derivatives in p. */
static void check_derivatives(const char scene[], PetscReal F33)
{
  LamResponse at;
  Tissue t;

  Start(scene, F33, &t);
  at = Query(&t, &t.load);
  for (int k = 0; k < 6; k++) {
    const int entry = k < 4 ? in_plane[k] : 8; /* F11 .. F22, p, F33 */
    LamResponse pair[2];

    if (k == 5 && !(t.scene->sample.F33_max > 1)) continue;
    for (int side = 0; side < 2; side++) {
      LamLoad load = t.load;
      PetscReal *moved = k == 4 ? &load.turgor : &load.F[entry];

      *moved += side ? STEP : -STEP;
      pair[side] = Query(&t, &load);
    }
    assert_near((pair[1].energy - pair[0].energy) / (2 * STEP), k == 4 ? at.energy_turgor : at.P[entry], 1e-8);
    if (k == 4) assert_near((pair[1].energy_turgor - pair[0].energy_turgor) / (2 * STEP), at.energy_turgor2, 1e-6);
    for (int i = 0; i < 4; i++)
      assert_near((pair[1].P[in_plane[i]] - pair[0].P[in_plane[i]]) / (2 * STEP),
                  k == 4 ? at.P_turgor[in_plane[i]] : at.tangent[9 * in_plane[i] + entry], 1e-6);
  }
  assert_int_equal(at.energy_cohesion, 0);
  Finish(&t);
}

TEST_IS(derivatives_in_strain_and_turgor_belong_to_one_energy, check_derivatives(unequal, 1));
TEST_IS(derivatives_in_F33_do_so_too, check_derivatives(unequal_axial, 1.03));

/* At a node stress, tangent and derivatives in p are those of the solve. */
TEST(nodes_have_the_response_of_their_solve)
{
  LamResponse answer, solve;
  PetscInt64 key;
  LamLoad turned, node;
  LamGrid grid;
  Tissue t;

  Start(unequal, 1, &t);
  assert_int_equal(LamTableTurn(t.table, &t.load, &turned, &key), 0);
  assert_int_equal(LamDatabaseGetGrid(t.database, &grid), 0);
  assert_int_equal(LamGridNodeLoad(grid, key, &node), 0);
  answer = Query(&t, &node);
  solve = Solve(&t, &node);
  for (int i = 0; i < 4; i++) {
    assert_near(answer.P[in_plane[i]], solve.P[in_plane[i]], 1e-10);
    assert_near(answer.P_turgor[in_plane[i]], solve.P_turgor[in_plane[i]], 1e-9);
    for (int j = 0; j < 4; j++)
      assert_near(answer.tangent[9 * in_plane[i] + in_plane[j]], solve.tangent[9 * in_plane[i] + in_plane[j]], 1e-8);
  }
  assert_near(answer.P[8], solve.P[8], 1e-10);
  assert_near(answer.energy_turgor, solve.energy_turgor, 1e-10);
  Finish(&t);
}

TEST(between_nodes_the_error_is_at_most_three_times_its_estimate)
{
  LamStressScale scale;
  Tissue t;

  Start(unequal, 1, &t);
  scale = LamStressScaleOf(&t.scene->micro);
  for (int n = 0; n < 5; n++) {
    LamResponse answer, solve;

    t.load.turgor = 0.02 + 0.09 * n;
    assert_int_equal(RefineTable(t.database, t.solver, &t.load, 0.01), 0);
    assert_int_equal(LamTableDestroy(&t.table), 0);
    assert_int_equal(LamDatabaseGetTable(t.database, &t.table), 0);
    answer = Query(&t, &t.load);
    solve = Solve(&t, &t.load);
    assert_true(answer.error_estimate <= 0.01);
    assert_true(LamStressError(scale, answer.P, solve.P) < 3 * answer.error_estimate);
    assert_true(LamTangentError(scale, answer.tangent, solve.tangent) < 3 * answer.tangent_error_estimate);
  }
  Finish(&t);
}

/* A grid of version 0.1 has nodes at one turgor alone: it serves that turgor. */
TEST(grids_without_the_axis_serve_their_own_turgor)
{
  static const char text[] = "{\"origin\": 0.02, \"step\": 0.1, \"turgor\": 0.2}";
  LamLoad load = {.F = {1.07, 0, 0, 0, 1.05, 0, 0, 0, 1}, .turgor = 0.2};
  LamTable table;
  LamResponse r;
  LamGrid grid;
  Tissue t;

  Start(unequal, 1, &t);
  assert_int_equal(LamTableDestroy(&t.table), 0);
  assert_int_equal(LamDatabaseClose(&t.database), 0);
  assert_int_equal(LamGridFromText("test_unfilled", &t.scene->micro, text, &grid), 0);
  assert_int_equal(LamDatabaseCreateEmpty(t.scene, &t.database), 0);
  assert_int_equal(LamDatabaseSetGrid(t.database, &grid), 0);
  assert_int_equal(RefineTable(t.database, t.solver, &load, PETSC_INFINITY), 0);
  assert_int_equal(LamDatabaseGetTable(t.database, &table), 0);
  assert_int_equal(LamTableQuery(table, &load, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  load.turgor = 0.1;
  assert_int_equal(LamTableQuery(table, &load, PETSC_INFINITY, &r), 0);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_non_null(strstr(r.reason, "build it anew"));
  t.table = table;
  Finish(&t);
}

/* ---- scattered records ---- */

/* The record at turgor 1.4 of tissue with unequal cells does not serve turgor 0.2; that of filled tissue does. */
TEST(a_record_serves_the_turgor_around_its_own)
{
  static const char *const scenes[] = {unequal, TISSUE BOX};

  for (int n = 0; n < 2; n++) {
    LamLoad load = {.F = {1.1, 0, 0, 0, 1.1, 0, 0, 0, 1}, .turgor = 1.4};
    const PetscInt64 key = 1;
    LamDatabase database;
    LamResponse record, r;
    Tissue t;

    Start(scenes[n], 1, &t);
    record = Solve(&t, &load);
    assert_int_equal(LamDatabaseCreateEmpty(t.scene, &database), 0);
    assert_int_equal(LamDatabaseAdd(database, 1, &key, &record), 0);
    load.turgor = 0.2;
    assert_int_equal(LamDatabaseQuery(database, &load, 0.01, &r), 0);
    assert_int_equal(r.status, n ? LAM_CONVERGED : LAM_OUT_OF_REACH);
    assert_int_equal(LamDatabaseClose(&database), 0);
    Finish(&t);
  }
}

TEST_GROUP(.petsc = 1);
