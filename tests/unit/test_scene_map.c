/* The axes of a map: what a scene's block becomes. */
#include "support/test.h"
#include "unit/test_scene.h"
#include <string.h>

#define SCENE RVE "  interface: {law: contact}\nload:\n  - {ramp: {to: [[1, 0.3], [0, 1]], steps: 3}}\n"
#define TURGOR "  x: {quantity: turgor, from: 0 MPa, to: 2.2 bar, points: 5}\n"
#define SHEAR "  y: {quantity: shear, from: 0.1, to: 0.3, points: 3}\n"

TEST(a_scene_without_the_block_has_no_map)
{
  OwnedScene *scene = Read(SCENE);

  assert_false(scene->has_map);
}

TEST(stresses_become_multiples_of_C1_and_C2)
{
  OwnedScene *scene = Read(SCENE "map:\n" TURGOR SHEAR);

  assert_true(scene->has_map);
  assert_int_equal(scene->map[LAM_MAP_X].quantity, LAM_MAP_TURGOR);
  assert_int_equal(scene->map[LAM_MAP_X].points, 5);
  assert_near(LamMapAxisValue(&scene->map[LAM_MAP_X], 0), 0, 1e-14);
  assert_near(LamMapAxisValue(&scene->map[LAM_MAP_X], 4), 2, 1e-14);
}

TEST(linear_points_have_equal_differences)
{
  OwnedScene *scene = Read(SCENE "map:\n" TURGOR SHEAR);
  const LamMapAxis *y = &scene->map[LAM_MAP_Y];

  for (int i = 0; i < 3; i++) assert_near(LamMapAxisValue(y, i), 0.1 * (i + 1), 1e-15);
}

TEST(log_points_have_equal_ratios)
{
  OwnedScene *scene =
      Read(SCENE "map:\n" TURGOR "  y: {quantity: C4, from: 0.11 MPa, to: 11 MPa, points: 3, spacing: log}\n");
  const LamMapAxis *y = &scene->map[LAM_MAP_Y];

  for (int i = 0; i < 3; i++) assert_near(LamMapAxisValue(y, i), pow(10, i), 1e-12);
}

TEST(units_bring_the_numbers_back)
{
  OwnedScene *scene =
      Read(SCENE "map:\n" TURGOR "  y: {quantity: wall_thickness, from: 7.5 um, to: 15 um, points: 2}\n");
  PetscReal scale;

  assert_string_equal(LamMapQuantityUnit(LAM_MAP_TURGOR, &scene->scales, &scale), "MPa");
  assert_near(scale * scene->map[LAM_MAP_X].to, 0.22, 1e-15);
  assert_string_equal(LamMapQuantityUnit(LAM_MAP_WALL_THICKNESS, &scene->scales, &scale), "um");
  assert_near(scale * scene->map[LAM_MAP_Y].to, 15, 1e-13);
  assert_string_equal(LamMapQuantityUnit(LAM_MAP_SHEAR, &scene->scales, &scale), "1");
}
