/* slow: the difference between FE2 and a direct patch of n x n cells halves as n doubles, and nothing is left of it. */
#include "support/rve_fixture.h"
#include "support/fe2_patch.h"

/* Blocks of 2 x 2, 4 x 4 and 8 x 8 cells in one step, against FE2 on meshes of `elements` and twice as many; `opening`:
   what may be left of the difference of the gaps. */
static void CheckHalves(int which, int elements, double opening)
{
  const ScalesCase *c = &scales_cases[which];
  ScalesCurve block[3] = {{0}}, limit = {0}, extrapolated;
  double difference[3];

  assert_int_equal(ScalesSolveLimit(c, elements, 1, &limit), 0);
  assert_int_equal(limit.steps, 1);
  for (int k = 0; k < 3; k++) {
    assert_int_equal(ScalesSolveCells(c, 2 << k, PETSC_TRUE, 1, &block[k]), 0);
    assert_int_equal(block[k].steps, 1);
    difference[k] = ScalesDifference(1, block[k].stress, limit.stress);
  }
  assert_true(difference[1] < 0.65 * difference[0]);
  assert_near(difference[2] / difference[1], 0.5, 0.1);
  extrapolated = ScalesExtrapolated(&block[1], &block[2]);
  assert_near(ScalesDifference(1, extrapolated.stress, limit.stress), 0.0, 0.04);
  if (c->interface == LAM_INTERFACE_CONTACT)
    assert_near(ScalesDifference(1, extrapolated.opening, limit.opening), 0.0, opening);
}

TEST_IS(BondedFreeSidesSheared, CheckHalves(SCALES_BONDED_FREE_SHEARED, 4, 0));
TEST_IS(ContactFreeSidesPulled, CheckHalves(SCALES_CONTACT_FREE_PULLED, 2, 0.12));
TEST_IS(ContactAffineSidesSheared, CheckHalves(SCALES_CONTACT_AFFINE_SHEARED, 0, 0.1));

/* Its cells buckle, two to a period: that is what blocks tend to, not tissue of one cell a period. */
TEST(ContactAffineSidesPressed)
{
  const ScalesCase *c = &scales_cases[SCALES_CONTACT_AFFINE_PRESSED];
  ScalesCurve cell = {0}, pair = {0};

  CheckHalves(SCALES_CONTACT_AFFINE_PRESSED, 0, 0.4);
  assert_int_equal(ScalesSolveCells(c, 1, PETSC_FALSE, 1, &cell), 0);
  assert_int_equal(ScalesSolveCells(c, 2, PETSC_FALSE, 1, &pair), 0);
  assert_true(ScalesDifference(1, cell.stress, pair.stress) > 0.1);
}

TEST_GROUP(.petsc = 1);
