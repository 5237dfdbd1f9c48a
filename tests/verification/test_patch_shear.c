/* Section 4.2 of the source paper on 3 x 3 cells: sheared between grips, empty and under turgor, by both strategies. */
#include "support/rve_fixture.h"
#include "support/cell_patch.h"

static LamResponse states[PATCH_TURGORS][LAM_STRATEGY_COUNT];

static int SolveAll(void **state)
{
  return SolvePatchStates(states) ? 1 : 0;
}

TEST(BothStrategiesConverge)
{
  for (int p = 0; p < PATCH_TURGORS; p++)
    for (int strategy = 0; strategy < LAM_STRATEGY_COUNT; strategy++) {
      assert_int_equal(states[p][strategy].status, LAM_CONVERGED);
      assert_true(states[p][strategy].stable);
    }
}

TEST(BothStrategiesFindTheSameStressUnderTurgor)
{
  for (int p = 1; p < PATCH_TURGORS; p++)
    assert_near(StressError(states[p][LAM_ONE_STEP].P, states[p][LAM_TWO_STEP].P), 0.0, 1e-6);
}

/* Empty tissue has several discrete solutions, which differ in hats at junctions. */
TEST_IS(BothStrategiesFindCloseStressesInEmptyTissue,
        assert_near(StressError(states[0][LAM_ONE_STEP].P, states[0][LAM_TWO_STEP].P), 0.0, 5e-3));

TEST(TurgorClosesTheInterfaces)
{
  for (int p = 1; p < PATCH_TURGORS; p++) {
    assert_true(states[p][LAM_TWO_STEP].open_fraction < states[p - 1][LAM_TWO_STEP].open_fraction);
    assert_true(states[p][LAM_TWO_STEP].max_gap < states[p - 1][LAM_TWO_STEP].max_gap);
  }
  assert_true(states[0][LAM_TWO_STEP].open_fraction > 0.5);
  assert_true(states[PATCH_TURGORS - 1][LAM_TWO_STEP].open_fraction < 0.1);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
