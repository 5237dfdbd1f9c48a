/* States that follow each other by increments of 1e-13 to 1e-4, and steps that are too large. */
#include "support/rve_fixture.h"
#include "support/load_increments.h"

#define ROUNDING 2e-11 /* C1 + C2: of P, largest of the states here; measured 1.2e-11 */

static const double increments[] = {1e-13, 1e-12, 1e-9, 1e-6, 1e-4};
#define INCREMENTS ((int)PETSC_STATIC_ARRAY_LENGTH(increments))

static void ForAllKinds(void (*check)(double h, const IncrementWalk *walk))
{
  for (int kind = 0; kind < INCREMENT_KIND_COUNT; kind++) {
    OWNED(IncrementTissue, IncrementDestroy) t;

    assert_int_equal(IncrementCreate((IncrementKind)kind, &t), 0);
    assert_int_equal(t.at.status, LAM_CONVERGED);
    for (int i = 0; i < INCREMENTS; i++) {
      IncrementWalk walk;

      assert_int_equal(IncrementWalkBy(&t, increments[i], &walk), 0);
      assert_int_equal(walk.solved, INCREMENT_STEPS);
      check(increments[i], &walk);
    }
  }
}

/* Of order h^3 beyond rounding: the mean of two tangents; K_w and contact that changes make its factor large. */
static void CheckStress(double h, const IncrementWalk *walk)
{
  assert_near(walk->error, 0.0, ROUNDING + 1e3 * h * h * h);
  assert_near(walk->stress, 0.0, ROUNDING);
}

TEST_IS(StressFollowsTheTangent, ForAllKinds(CheckStress));

/* One iteration solves; a second follows where the first step was not small. None: an answer that was not solved. */
static void CheckWork(double h, const IncrementWalk *walk)
{
  assert_in_range(walk->iterations, 1, h <= 1e-9 ? 1 : 3);
  assert_in_range(walk->fewest, h <= 1e-12 ? 0 : 1, 3);
  assert_in_range(walk->factorisations, 1, walk->iterations + 2);
}

TEST_IS(NoIterationIsWasted, ForAllKinds(CheckWork));

/* Turgid bonded tissue at one go and in fifty steps: the same state. */
TEST(LargeStepsEndWhereSmallOnesDo)
{
  const LamMicrostructure micro = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);

  for (int k = 0; k < LARGE_STEPS; k++) {
    LargeResult l;

    if (k == 2 || k == 3) continue; /* shear of 2 and 3: as that of 1, and they take longest */
    assert_int_equal(LargeStepSolve(rve, &large_steps[k], 0.2, 20, &l), 0);
    if (l.once.status == LAM_CONVERGED && !l.failed)
      assert_near(l.apart, 0.0, 1e-8);
    else
      assert_int_equal(l.once.status, l.small.status);
  }
}
