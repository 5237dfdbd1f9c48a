/* FE2 against a direct patch of n x n cells: the difference falls with n. Larger blocks: test_fe2_patch_sizes. */
#include "support/rve_fixture.h"
#include "support/fe2_patch.h"

/* From 2 x 2 to 4 x 4 cells, in one step; FE2 on coarse meshes. */
static void CheckFalls(int which, int elements)
{
  const ScalesCase *c = &scales_cases[which];
  ScalesCurve two = {0}, four = {0}, limit = {0};

  assert_int_equal(ScalesSolveLimit(c, elements, 1, &limit), 0);
  assert_int_equal(ScalesSolveCells(c, 2, PETSC_TRUE, 1, &two), 0);
  assert_int_equal(ScalesSolveCells(c, 4, PETSC_TRUE, 1, &four), 0);
  assert_int_equal(limit.steps, 1);
  assert_int_equal(two.steps, 1);
  assert_int_equal(four.steps, 1);
  assert_true(ScalesDifference(1, four.stress, limit.stress) < 0.75 * ScalesDifference(1, two.stress, limit.stress));
  if (c->interface == LAM_INTERFACE_CONTACT)
    assert_true(ScalesDifference(1, four.opening, limit.opening) <
                0.8 * ScalesDifference(1, two.opening, limit.opening));
}

TEST_IS(BondedFreeSidesSheared, CheckFalls(SCALES_BONDED_FREE_SHEARED, 2));
TEST_IS(ContactFreeSidesPulled, CheckFalls(SCALES_CONTACT_FREE_PULLED, 1));
TEST_IS(ContactAffineSidesSheared, CheckFalls(SCALES_CONTACT_AFFINE_SHEARED, 0));

TEST_GROUP(.petsc = 1);
