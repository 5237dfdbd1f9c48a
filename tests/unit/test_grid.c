/* Where nodes lie, their keys, and the text of a grid. */
#include "support/test.h"
#include <stdlib.h>
#include <jansson.h>
#include "support/analytic_table.h"
#include "test_scene_message.h"

static LamGrid Make(PetscBool contact)
{
  AnalyticTissue tissue = {contact, 0.2, PETSC_FALSE};
  const LamScene scene = AnalyticScene(&tissue);
  LamGrid grid;

  CHECK(AnalyticGridCreate(&scene, &tissue, &grid));
  return grid;
}

/* ---- keys ---- */

TEST(keys_and_places_are_one_to_one)
{
  const int far = LAM_GRID_REACH;
  const LamNodePlace places[] = {{{0, 0, 0}, 0, 0},
                                 {{-far, -1, far - 1}, 4095, 0},
                                 {{1, 2, 3}, 4, 1},
                                 {{-far, -far, -far}, 0, 0},
                                 {{far - 1, 0, -far}, 1, 63}};

  for (size_t n = 0; n < sizeof(places) / sizeof(places[0]); n++) {
    const PetscInt64 key = LamNodeKeyOf(&places[n]);
    const LamNodePlace back = LamNodePlaceOf(key);

    assert_true(LamKeyIsNode(key));
    assert_memory_equal(&back, &places[n], sizeof(back));
  }
}

TEST(keys_rise_with_places)
{
  const LamNodePlace places[] = {
      {{-5, 9, 9}, 9, 0}, {{-4, -9, 0}, 0, 0}, {{-4, 3, 0}, 0, 0}, {{-4, 3, 1}, 7, 0}, {{-4, 3, 1}, 8, 0}};

  for (int n = 1; n < 5; n++) assert_true(LamNodeKeyOf(&places[n - 1]) < LamNodeKeyOf(&places[n]));
}

TEST(other_keys_are_of_no_node)
{
  const LamNodePlace last = {{LAM_GRID_REACH - 1, LAM_GRID_REACH - 1, LAM_GRID_REACH - 1}, 4095, 63};

  assert_false(LamKeyIsNode(0));
  assert_false(LamKeyIsNode(-1));
  assert_false(LamKeyIsNode(LAM_NODE_KEY - 1));
  assert_false(LamKeyIsNode(LamNodeKeyOf(&last) + 1));
  assert_false(LamKeyIsNode(LAM_CACHE_KEY));
}

TEST(the_level_is_that_of_the_finest_coordinate)
{
  assert_int_equal(LamNodeLevel(&(LamNodePlace){{0, -LAM_ROOT, 3 * LAM_ROOT}, 5, 0}), 0);
  assert_int_equal(LamNodeLevel(&(LamNodePlace){{0, -LAM_ROOT / 2, LAM_ROOT}, 0, 0}), 1);
  assert_int_equal(LamNodeLevel(&(LamNodePlace){{-LAM_ROOT / 4, LAM_ROOT / 2, 0}, 0, 0}), 2);
  assert_int_equal(LamNodeLevel(&(LamNodePlace){{0, 0, -1}, 0, 0}), LAM_FINEST);
}

/* ---- states ---- */

static void AssertStrains(LamGrid grid, const int i[3], int j)
{
  const LamNodePlace place = {{i[0], i[1], i[2]}, j, 0};
  PetscReal shift[3] = {grid->origin, 0, 0};
  LamLatticeState at;
  LamLoad load;

  CHECK(LamGridNodeLoad(grid, LamNodeKeyOf(&place), &load));
  assert_true(load.F[1] == load.F[3] && load.F[8] == 1);
  if (grid->contact) {
    assert_near(log1p((load.turgor + load.cohesion) / grid->suction_scale),
                grid->tau_min + grid->tau_step * j / LAM_ROOT, 1e-13);
    assert_true(load.cohesion == TISSUE_G0);
    LamFreeCellStrain(&grid->free, load.turgor + load.cohesion, shift);
  } else
    assert_near(load.turgor, TISSUE_P0, 1e-15);
  at = LamLatticeStateOf(&grid->axes, (PetscReal[4]){load.F[0], load.F[1], load.F[3], load.F[4]});
  for (int k = 0; k < 3; k++) assert_near(at.x[k], shift[0] + grid->step * i[k] / LAM_ROOT, 1e-13);
}

TEST(a_node_has_the_strains_of_its_place)
{
  for (int contact = 0; contact < 2; contact++) {
    OWNED(LamGrid, LamGridDestroy) grid = Make((PetscBool)contact);

    AssertStrains(grid, (int[3]){0, 0, 0}, 0);
    AssertStrains(grid, (int[3]){-64, 3, 100}, 17);
  }
}

TEST(strains_that_no_state_has_give_no_F)
{
  OWNED(LamGrid, LamGridDestroy) grid = Make(PETSC_FALSE);
  const LamNodePlace place = {{-6000, -6000, 6000}, 0, 0};
  LamLoad load;

  CHECK(LamGridNodeLoad(grid, LamNodeKeyOf(&place), &load));
  assert_true(load.F[0] == 0 && load.F[4] == 0);
}

TEST(the_box_of_the_sample_is_covered)
{
  LamGrid grid = Make(PETSC_FALSE);
  const double cells = 0.30 / grid->step;

  assert_near(grid->origin, -0.05, 1e-15);
  assert_near(cells, round(cells), 1e-12);
  CHECK(LamGridDestroy(&grid));
  grid = Make(PETSC_TRUE);
  assert_near(LamGridSuction(grid, 0), 0.1 * TISSUE_SUCTION, 1e-13);
  assert_near(LamGridSuction(grid, LAM_ROOT * grid->tau_cells), TISSUE_SUCTION, 1e-13);
  CHECK(LamGridDestroy(&grid));
}

/* Of sorted places sorted ones; a root node has none. */
TEST(parents_are_coarser_until_there_is_none)
{
  OWNED(LamGrid, LamGridDestroy) grid = Make(PETSC_TRUE);
  uint64_t seed = 1;

  for (int n = 0; n < 200; n++) {
    LamNodePlace place = {
        {(int)RandomReal(&seed, -900, -300), (int)RandomReal(&seed, -300, 300), (int)RandomReal(&seed, 300, 900)},
        (int)RandomReal(&seed, 0, LAM_ROOT * (double)grid->tau_cells),
        0};
    int steps = 0;

    for (PetscInt64 key = LamGridNodeParent(grid, LamNodeKeyOf(&place)); key >= 0; steps++) {
      place = LamNodePlaceOf(key);
      assert_true(place.i[0] <= place.i[1] && place.i[1] <= place.i[2]);
      assert_in_range(place.j, 0, LAM_ROOT * grid->tau_cells);
      key = LamGridNodeParent(grid, key);
    }
    assert_in_range(steps, 0, (3 + 1) * LAM_FINEST); /* one axis at a time */
    assert_int_equal(LamNodeLevel(&place), 0);
    assert_int_equal(place.j % LAM_ROOT, 0);
  }
}

/* ---- refusals ---- */

static void AssertNoGrid(const LamScene *scene, const char what[])
{
  AnalyticTissue tissue = {PETSC_TRUE, 0, PETSC_FALSE};
  OWNED(LamGrid, LamGridDestroy) grid = NULL;
  PetscErrorCode error;

  CATCH(AnalyticGridCreate(scene, &tissue, &grid), error);
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  if (!strstr(scene_message, what)) fail_msg("\"%s\" does not name %s", scene_message, what);
}

TEST(a_patch_has_no_grid)
{
  const AnalyticTissue tissue = {PETSC_FALSE, 0, PETSC_FALSE};
  LamScene scene = AnalyticScene(&tissue);

  scene.micro.is_patch = PETSC_TRUE;
  AssertNoGrid(&scene, "rve.patch");
}

TEST(contact_without_suction_has_no_grid)
{
  const AnalyticTissue tissue = {PETSC_TRUE, 0, PETSC_FALSE};
  LamScene scene = AnalyticScene(&tissue);

  scene.cohesion = 0;
  scene.sample.turgor_min = scene.sample.turgor_max = 0;
  AssertNoGrid(&scene, "cohesion");
}

/* ---- text ---- */

static LamMicrostructure MicroOf(PetscBool contact)
{
  const AnalyticTissue tissue = {contact, 0.2, PETSC_FALSE};

  return AnalyticScene(&tissue).micro;
}

TEST(the_text_keeps_every_bit)
{
  for (int contact = 0; contact < 2; contact++) {
    const LamMicrostructure micro = MicroOf((PetscBool)contact);
    OWNED(LamGrid, LamGridDestroy) grid = Make((PetscBool)contact);
    OWNED(LamGrid, LamGridDestroy) copy;
    char *text, *again;

    CHECK(LamGridGetText(grid, &text));
    CHECK(LamGridFromText("a.h5", &micro, text, &copy));
    CHECK(LamGridGetText(copy, &again));
    assert_string_equal(text, again);
    assert_true(copy->symmetric && copy->step == grid->step && copy->tau_cells == grid->tau_cells);
    for (PetscInt m = 0; m < grid->free.n; m++) assert_true(copy->free_keys[m] == grid->free_keys[m]);
    CHECK(PetscFree(text));
    CHECK(PetscFree(again));
  }
}

static void AssertRefused(PetscBool contact, const char text[])
{
  const LamMicrostructure micro = MicroOf(contact);
  LamGrid grid = NULL;
  PetscErrorCode error;

  CATCH(LamGridFromText("a.h5", &micro, text, &grid), error);
  if (error != PETSC_ERR_USER_INPUT) fail_msg("taken: %s", text);
  assert_non_null(strstr(scene_message, "a.h5"));
  assert_null(grid);
}

/* Takes over the value. */
static void AssertMemberRefused(PetscBool contact, const char name[], json_t *value)
{
  OWNED(LamGrid, LamGridDestroy) grid = Make(contact);
  json_t *object;
  char *text;

  CHECK(LamGridGetText(grid, &text));
  object = json_loads(text, 0, NULL);
  assert_non_null(json_object_get(object, name));
  CHECK(PetscFree(text));
  if (value)
    json_object_set_new(object, name, value);
  else
    json_object_del(object, name);
  text = json_dumps(object, 0);
  AssertRefused(contact, text);
  free(text);
  json_decref(object);
}

TEST(a_text_without_a_member_is_refused)
{
  static const char *const names[] = {"origin",  "step",     "turgor",    "cohesion", "suction_scale",
                                      "tau_min", "tau_step", "tau_cells", "free_cell"};

  for (size_t n = 0; n < sizeof(names) / sizeof(names[0]); n++) {
    AssertMemberRefused(PETSC_TRUE, names[n], NULL);
    AssertMemberRefused(PETSC_TRUE, names[n], json_null());
    AssertMemberRefused(PETSC_TRUE, names[n], json_string("1"));
    if (n < 3) AssertMemberRefused(PETSC_FALSE, names[n], NULL);
  }
}

TEST(numbers_that_no_grid_has_are_refused)
{
  AssertMemberRefused(PETSC_FALSE, "step", json_real(0));
  AssertMemberRefused(PETSC_TRUE, "suction_scale", json_real(-1));
  AssertMemberRefused(PETSC_TRUE, "tau_min", json_real(-0.1));
  AssertMemberRefused(PETSC_TRUE, "tau_step", json_real(0));
  AssertMemberRefused(PETSC_TRUE, "tau_cells", json_integer(0));
  AssertMemberRefused(PETSC_TRUE, "tau_cells", json_integer(64));
  AssertMemberRefused(PETSC_TRUE, "tau_cells", json_integer(((json_int_t)1 << 32) + 3));
  AssertMemberRefused(PETSC_TRUE, "tau_cells", json_real(3));
}

TEST(free_cells_of_another_grid_are_refused)
{
  AssertMemberRefused(PETSC_TRUE, "tau_min", json_real(1.5));
  AssertMemberRefused(PETSC_TRUE, "tau_cells", json_integer(2));
  AssertMemberRefused(PETSC_TRUE, "cohesion", json_real(0.2));
}

TEST(what_is_no_object_is_refused)
{
  AssertRefused(PETSC_FALSE, "");
  AssertRefused(PETSC_FALSE, "[1, 2]");
  AssertRefused(PETSC_FALSE, "{\"origin\": 0, \"step\": 0.1, \"turgor\": ");
  AssertRefused(PETSC_FALSE, "{\"origin\": NaN, \"step\": 0.1, \"turgor\": 0}");
  AssertRefused(PETSC_FALSE, "{\"origin\": 1e999, \"step\": 0.1, \"turgor\": 0}");
}
