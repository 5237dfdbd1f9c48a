/* What `info` tells of a table: its nodes, cells, extent, and what cannot be used. */
#include "support/test.h"
#include "support/synthetic_responder.h"
#include <jansson.h>
#include <lamella/database.h>

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}\n"
                                 "  mesh: {along: 4, through: 1}\n"
                                 "sample:\n"
                                 "  stretch: {min: 0, max: 0.1}\n"
                                 "  turgor: {min: 0 MPa, max: 0.02 MPa}\n";

static LamDatabase Make(void)
{
  LamDatabase database;
  OWNED(LamScene *, LamSceneDestroy) scene;
  LamGrid grid;

  assert_int_equal(LamSceneReadText("test_table_info", scene_text, &scene), 0);
  assert_int_equal(LamDatabaseCreateEmpty(scene, &database), 0);
  assert_int_equal(LamGridCreate(scene, NULL, &grid), 0);
  assert_int_equal(LamDatabaseSetGrid(database, &grid), 0);
  return database;
}

/* The nodes that a question needs, the last of them with another status. */
static PetscInt Fill(LamDatabase database, PetscReal accuracy, LamStatus last)
{
  const LamLoad load = {.F = {1.05, 0, 0, 0, 1.04, 0, 0, 0, 1}, .turgor = 0.1};
  const Synthetic material = {.mu = 0.5, .lambda = 2};
  PetscInt64 keys[LAM_MAX_NEEDS];
  OWNED(LamTable, LamTableDestroy) table;
  LamGrid grid;
  PetscInt n;

  assert_int_equal(LamDatabaseGetGrid(database, &grid), 0);
  assert_int_equal(LamDatabaseGetTable(database, &table), 0);
  assert_int_equal(LamTableNeeds(table, &load, accuracy, NULL, &n, keys), 0);
  for (PetscInt i = 0; i < n; i++) {
    LamResponse response;
    LamLoad node;

    assert_int_equal(LamGridNodeLoad(grid, keys[i], &node), 0);
    LamResponseInit(&node, &response);
    SyntheticEvaluate(&material, &node, &response);
    if (i == n - 1) response.status = last;
    assert_int_equal(LamDatabaseAdd(database, 1, &keys[i], &response), 0);
  }
  return n;
}

static json_t *Info(LamDatabase database)
{
  const char *text;
  json_t *info;

  assert_int_equal(LamDatabaseGetInfo(database, &text), 0);
  info = json_loads(text, 0, NULL);
  assert_non_null(info);
  return info;
}

static json_int_t At(const json_t *table, const char name[], size_t level)
{
  return json_integer_value(json_array_get(json_object_get(table, name), level));
}

TEST(nodes_and_cells_are_counted_by_level)
{
  OWNED(LamDatabase, LamDatabaseClose) database = Make();
  const PetscInt coarse = Fill(database, 1e-3, LAM_CONVERGED), fine = Fill(database, 1e-12, LAM_CONVERGED);
  json_auto_t *info = Info(database);
  json_t *table = json_object_get(info, "table");

  assert_true(coarse > 0 && fine > 0);
  assert_int_equal(json_integer_value(json_object_get(table, "nodes")), coarse + fine);
  assert_int_equal(json_array_size(json_object_get(table, "nodes_by_level")), 2);
  assert_int_equal(At(table, "nodes_by_level", 0), coarse);
  assert_int_equal(At(table, "nodes_by_level", 1), fine);
  assert_int_equal(At(table, "cells_by_level", 0), 1);
  assert_int_equal(At(table, "cells_by_level", 1), 1);
  assert_int_equal(At(table, "mixed_cells_by_level", 0), 0);
}

TEST(the_extent_is_that_of_the_nodes)
{
  OWNED(LamDatabase, LamDatabaseClose) database = Make();
  json_auto_t *info = NULL;
  json_t *table, *strain;

  (void)Fill(database, 1e-3, LAM_CONVERGED);
  info = Info(database);
  table = json_object_get(info, "table");
  strain = json_object_get(table, "lattice_strain");
  assert_near(json_number_value(json_array_get(strain, 0)), 0, 1e-12);
  assert_near(json_number_value(json_array_get(strain, 1)), 0.1, 1e-12);
  assert_near(json_number_value(json_object_get(json_object_get(table, "grid"), "turgor")), 0.01, 1e-12);
}

TEST(a_node_that_cannot_be_used_is_told)
{
  static const struct {
    LamStatus status;
    const char *flag;
    json_int_t complete, mixed;
  } cases[] = {{LAM_UNSTABLE, "unstable", 1, 1}, {LAM_NOT_CONVERGED, "failed", 0, 0}};

  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
    OWNED(LamDatabase, LamDatabaseClose) database = Make();
    json_auto_t *info = NULL;
    json_t *table;

    (void)Fill(database, 1e-3, cases[i].status);
    info = Info(database);
    table = json_object_get(info, "table");
    assert_int_equal(json_integer_value(json_object_get(json_object_get(table, "flags"), cases[i].flag)), 1);
    assert_int_equal(At(table, "cells_by_level", 0), cases[i].complete);
    assert_int_equal(At(table, "mixed_cells_by_level", 0), cases[i].mixed);
  }
}

TEST(records_of_no_grid_are_counted_apart)
{
  const LamLoad load = {.F = {1.05, 0, 0, 0, 1.04, 0, 0, 0, 1}, .turgor = 0.1};
  const Synthetic material = {.mu = 0.5, .lambda = 2};
  OWNED(LamDatabase, LamDatabaseClose) database = Make();
  LamResponse response;
  json_auto_t *info = NULL;

  LamResponseInit(&load, &response);
  SyntheticEvaluate(&material, &load, &response);
  assert_int_equal(LamDatabaseAdd(database, 1, NULL, &response), 0);
  info = Info(database);
  assert_int_equal(json_integer_value(json_object_get(info, "scattered")), 1);
  assert_int_equal(json_integer_value(json_object_get(json_object_get(info, "table"), "nodes")), 0);
}
