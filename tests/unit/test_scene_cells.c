/* Patches and cells that differ, as a scene becomes them. tests/scenes/bad.txt has what is refused. */
#include "support/test.h"
#include "unit/test_scene.h"

#define CONTACT "  interface: {law: contact, cohesion: 0.001 MPa}\n"
#define TWO_BY_THREE RVE "  cells: [2, 3]\n"
#define KINDS "  variation:\n    kinds: [{turgor: 0.5}, {turgor: 0}]\n"

static void AssertTurgor(const LamScene *scene, int n, const double turgor[])
{
  assert_int_equal(scene->micro.cells[0] * scene->micro.cells[1], n);
  assert_non_null(scene->micro.cell);
  for (int c = 0; c < n; c++) assert_near(scene->micro.cell[c].turgor, turgor[c], 1e-15);
}

TEST(a_patch_has_columns_rows_and_affine_sides)
{
  OwnedScene *scene = Read(RVE "  patch: {columns: 4, rows: 3}\n");

  assert_true(scene->micro.is_patch);
  assert_int_equal(scene->micro.sides, LAM_SIDES_AFFINE);
  assert_int_equal(scene->micro.cells[0], 4);
  assert_int_equal(scene->micro.cells[1], 3);
  assert_null(scene->micro.cell);
}

/* Bonded cells, cells with cohesion, and cells that a grip holds each stay where they are; tests/scenes/bad.txt has the
 * rest. */
TEST(free_sides_are_accepted_where_something_holds_the_cells)
{
  const char *const scenes[] = {
      RVE "  patch: {columns: 4, rows: 3, sides: free}\n",
      RVE CONTACT "  patch: {columns: 4, rows: 3, sides: free}\n",
      RVE "  interface: {law: contact}\n  patch: {columns: 4, rows: 2, sides: free}\n",
      RVE "  interface: {law: contact}\n  patch: {columns: 4, rows: 3, sides: free}\n"
          "load: [{F: [[1, 0], [0, 1]], cohesion: 0.001 MPa}]\n",
  };

  for (size_t i = 0; i < sizeof(scenes) / sizeof(scenes[0]); i++) {
    OwnedScene *scene = Read(scenes[i]);

    assert_int_equal(scene->micro.sides, LAM_SIDES_FREE);
  }
}

TEST(a_list_gives_each_cell_its_kind)
{
  OwnedScene *scene = Read(TWO_BY_THREE KINDS "    list: [0, 1, 2, 2, 1, 0]\n");

  AssertTurgor(scene, 6, (double[]){1, 0.5, 0, 0, 0.5, 1});
}

TEST(a_pattern_repeats_over_the_block)
{
  OwnedScene *scene = Read(TWO_BY_THREE KINDS "    pattern: [[0, 1], [2, 0]]\n");

  AssertTurgor(scene, 6, (double[]){1, 0.5, 1, 0, 1, 0});
}

/* Of ten cells three and two; where they lie is that of an independent program. */
TEST(random_kinds_have_their_shares_and_fall_the_same_everywhere)
{
  OwnedScene *scene = Read(RVE "  cells: [2, 5]\n" KINDS "    random: {shares: [0.3, 0.2], seed: 7}\n");

  AssertTurgor(scene, 10, (double[]){1, 1, 1, 1, 0.5, 0.5, 0, 1, 0.5, 0});
}

TEST(a_kind_leaves_what_it_does_not_say)
{
  OwnedScene *scene = Read(CELL WALL CONTACT "  variation:\n    kinds:\n      - wall: {C1: 0.2 MPa, C2: 0.02 MPa}\n"
                                             "        wall_thickness: 7.5 um\n        cohesion: 0.8\n    list: [1]\n");
  const LamCell *cell = &scene->micro.cell[0];

  assert_near(cell->wall_thickness, 0.1, 1e-14);
  assert_near(cell->wall.C1, 20.0 / 11, 1e-13);
  assert_near(cell->wall.C4, 100.0 / 11, 1e-13);
  assert_near(cell->wall.bulk_modulus, 2000.0, 1e-9); /* in proportion to C1 + C2 */
  assert_near(cell->turgor, 1.0, 0.0);
  assert_near(cell->cohesion, 0.8, 1e-15);
}

TEST(a_kind_may_have_a_law_of_its_own)
{
  OwnedScene *scene = Read(RVE "  variation: {kinds: [{wall: {law: mooney_rivlin}}], list: [1]}\n");

  assert_int_equal(scene->micro.wall.law, LAM_WALL_FIBRE_MOONEY_RIVLIN);
  assert_int_equal(scene->micro.cell[0].wall.law, LAM_WALL_MOONEY_RIVLIN);
  assert_near(scene->micro.cell[0].wall.C4, 0.0, 0.0);
}

TEST(cells_that_are_all_the_scenes_own_are_no_variation)
{
  OwnedScene *zeros = Read(TWO_BY_THREE KINDS "    pattern: [[0]]\n");
  OwnedScene *same = Read(RVE "  variation: {kinds: [{wall_thickness: 0.01125 mm, turgor: 1}], list: [1]}\n");
  OwnedScene *still = Read(TWO_BY_THREE "  variation: {field: {seed: 3, wall: 0}}\n");

  assert_null(zeros->micro.cell);
  assert_null(same->micro.cell);
  assert_null(still->micro.cell);
}

TEST(a_field_multiplies_all_moduli_of_a_wall_together)
{
  OwnedScene *scene = Read(TWO_BY_THREE "  variation: {field: {wall: 0.3, wall_thickness: 0.1, seed: 5}}\n");
  const LamWall *own = &scene->micro.wall;

  for (int c = 0; c < 6; c++) {
    const LamWall *wall = &scene->micro.cell[c].wall;
    const double factor = wall->C1 / own->C1;

    assert_true(factor != 1.0);
    assert_near(wall->C2, factor * own->C2, 1e-12);
    assert_near(wall->C4, factor * own->C4, 1e-12);
    assert_near(wall->bulk_modulus, factor * own->bulk_modulus, 1e-9);
    assert_near(scene->micro.cell[c].turgor, 1.0, 0.0);
  }
}

/* The walls of a seed stay what they are when turgor begins to vary, too. */
TEST(one_property_of_a_field_leaves_the_others)
{
  OwnedScene *one = Read(TWO_BY_THREE "  variation: {field: {wall: 0.3, correlation: 1}}\n");
  OwnedScene *two = Read(TWO_BY_THREE "  variation: {field: {wall: 0.3, turgor: 0.2, correlation: 1}}\n");

  for (int c = 0; c < 6; c++) {
    assert_near(one->micro.cell[c].wall.C1, two->micro.cell[c].wall.C1, 0.0);
    assert_true(two->micro.cell[c].turgor != 1.0);
  }
}
