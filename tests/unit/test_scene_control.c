/* Mixed control in scenes: which components are prescribed, ramps of stress, ramps that go on from a state whose F is
   not known when the scene is read. */
#include "support/test.h"
#include "unit/test_scene.h"

#define LOAD RVE "load:\n"

static void AssertGiven(const LamStressControl *control, const int given[9])
{
  for (int i = 0; i < 9; i++) assert_int_equal(control->given[i], given[i]);
}

TEST(free_components_have_a_stress)
{
  const int given[9] = {1, 0, 0, 0, 1, 0, 0, 0, 0};
  OwnedScene *scene = Read(LOAD "  - {F: [[free, 0.1], [0, free]], P: [[0 MPa, x], [x, 22 kPa]]}\n");

  AssertGiven(&scene->controls[0], given);
  assert_near(scene->controls[0].P[4], 0.2, 1e-14);
  assert_near(scene->loads[0].F[1], 0.1, 0);
  assert_near(scene->loads[0].F[8], 1.0, 0);
}

TEST(F33_may_be_free)
{
  const int given[9] = {0, 0, 0, 0, 0, 0, 0, 0, 1};
  OwnedScene *scene =
      Read(LOAD "  - {F: [[1, 0, 0], [0, 1.1, 0], [0, 0, free]], P: [[x, x, x], [x, x, x], [x, x, 0 MPa]]}\n");

  AssertGiven(&scene->controls[0], given);
}

TEST(plain_scenes_have_no_controls)
{
  OwnedScene *scene = Read(LOAD "  - {F: [[1, 0.1], [0, 1]]}\n");

  assert_null(scene->controls);
}

/* Stress from 0, then from what was prescribed; a given F straight. */
TEST(stress_ramps_straight)
{
  OwnedScene *scene = Read(LOAD "  - {ramp: {to: [[free, 0.1], [0, 1]], P: [[0.11 MPa, x], [x, x]], steps: 2}}\n"
                                "  - {ramp: {to: [[free, 0.3], [0, 1]], P: [[0.33 MPa, x], [x, x]], steps: 2}}\n");
  const double P11[4] = {0.5, 1, 2, 3}, F12[4] = {0.05, 0.1, 0.2, 0.3};

  assert_int_equal(scene->load_count, 4);
  for (int k = 0; k < 4; k++) {
    assert_near(scene->controls[k].P[0], P11[k], 1e-14);
    assert_near(scene->loads[k].F[1], F12[k], 1e-15);
  }
}

/* F22 was free: its ramp goes straight from what it turned out to be, here 1.06. */
TEST(a_ramp_goes_on_from_the_F_found)
{
  OwnedScene *scene = Read(LOAD "  - {F: [[free, 0], [0, free]], P: [[0 MPa, x], [x, 0 MPa]]}\n"
                                "  - {ramp: {to: [[free, 0], [0, 1.3]], P: [[0 MPa, x], [x, x]], steps: 3}}\n");
  const double expected[4] = {1.06, 1.14, 1.22, 1.3};
  double F[9] = {1.05, 0, 0, 0, 1.06, 0, 0, 0, 1};

  assert_int_equal(scene->load_count, 4);
  for (int k = 0; k < 4; k++) {
    const LamLoad load = LamLoadAfter(&scene->loads[k], &scene->controls[k], F);

    assert_near(load.F[0], 1.05, 0); /* free: the guess is what was found */
    assert_near(load.F[4], expected[k], 1e-14);
    for (int i = 0; i < 9; i++) F[i] = load.F[i];
  }
}

TEST(prescribed_F_is_what_it_says_after_free_F)
{
  const double before[9] = {1.05, 0, 0, 0, 1.06, 0, 0, 0, 1};
  OwnedScene *scene = Read(LOAD "  - {F: [[free, 0], [0, free]], P: [[0 MPa, x], [x, 0 MPa]]}\n"
                                "  - {F: [[1.2, 0.1], [0, 0.9]]}\n");
  const LamLoad load = LamLoadAfter(&scene->loads[1], &scene->controls[1], before);

  for (int i = 0; i < 9; i++) assert_near(load.F[i], ((double[9]){1.2, 0.1, 0, 0, 0.9, 0, 0, 0, 1})[i], 0);
}
