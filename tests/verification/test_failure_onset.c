/* Where tissue fails along a load: on finer meshes the same, in step with what is known of buckling and of turgor, and
   independent of the steps in which the load is given. */
#include "support/rve_fixture.h"
#include "support/failing_tissue.h"

static LamFailure Follow(const LamMicrostructure *micro, LamFailureProgram program)
{
  LamFailure failure;

  assert_int_equal(FollowProgram(micro, program, &failure), 0);
  return failure;
}

static LamFailure Pull(PetscInt along, PetscInt through)
{
  LamMicrostructure micro = DefaultTissue();
  LamLoad loads[PULL_STATES];

  micro.along = along;
  micro.through = through;
  PullLoads(loads);
  return Follow(&micro, (LamFailureProgram){.strength = &failing_strength, .count = PULL_STATES, .loads = loads});
}

TEST(OnsetsConvergeWithTheMesh)
{
  static const LamCriterion criteria[3] = {LAM_CRITERION_LAMELLA_NORMAL, LAM_CRITERION_LAMELLA_SHEAR,
                                           LAM_CRITERION_WALL};
  const LamFailure coarse = Pull(24, 4), fine = Pull(36, 4);

  for (int k = 0; k < 3; k++) {
    const double factor = fine.onset[criteria[k]].factor;

    assert_near(coarse.onset[criteria[k]].factor, factor, 0.02 * factor);
  }
}

/* At the load that is given, and a resolution below it not yet. */
TEST(OnsetIsWhereTheStrengthIsReached)
{
  const LamFailure failure = Pull(6, 2);
  const LamCriterionOnset *wall = &failure.onset[LAM_CRITERION_WALL];

  assert_int_equal(failure.mode, LAM_FAILURE_SEPARATION);
  assert_near(failure.response.max_traction, failing_strength.lamella_normal, 2e-3 * failing_strength.lamella_normal);
  assert_true(failure.response.max_traction >= failing_strength.lamella_normal);
  assert_near(wall->response.max_wall_tension, failing_strength.wall, 2e-3 * failing_strength.wall);
  assert_true(wall->bracket[1] - wall->bracket[0] <= 1e-3);
}

/* Biaxial compression of dry tissue: 2.27 % (test_buckling). */
TEST(BucklingIsFoundWhereTheTangentLosesStability)
{
  const LamMicrostructure micro = DefaultTissue();
  LamLoad loads[2];

  for (int k = 0; k < 2; k++) loads[k] = PlaneLoad(0.985 - 0.015 * k, 0, 0, 0.985 - 0.015 * k, 0);
  {
    const LamFailure failure = Follow(&micro, (LamFailureProgram){.count = 2, .loads = loads});

    assert_int_equal(failure.mode, LAM_FAILURE_BUCKLING);
    assert_near(1 - failure.load.F[0], 0.0227, 3e-4);
  }
}

/* Turgor adds -p J F^-T to bonded tissue and nothing to its shape: its walls are slack at the same F whatever p. */
TEST(WallsGetSlackAtADeformationThatTurgorDoesNotMove)
{
  const LamMicrostructure micro = DefaultTissue();
  double F[2];

  for (int k = 0; k < 2; k++) {
    const double p = 0.02 * (k + 1) / TISSUE_STRESS;
    const LamLoad loads[2] = {PlaneLoad(1.03, 0, 0, 1.02, p), PlaneLoad(0.985, 0, 0, 0.985, p)};
    const LamFailure failure = Follow(&micro, (LamFailureProgram){.count = 2, .loads = loads});

    assert_int_equal(failure.mode, LAM_FAILURE_TURGOR_LOSS);
    F[k] = failure.load.F[0];
  }
  assert_near(F[0], F[1], 2e-4);
}

TEST(TurgorThatIsTakenAwayIsLost)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad loads[2] = {PlaneLoad(1.02, 0, 0, 1.02, 0.1), PlaneLoad(1.02, 0, 0, 1.02, -0.1)};
  const LamFailure failure = Follow(&micro, (LamFailureProgram){.count = 2, .loads = loads});

  assert_int_equal(failure.mode, LAM_FAILURE_TURGOR_LOSS);
  assert_near(failure.factor, 1.5, 1e-3);
}

/* Stopped at the first, the verdict is the same, and what comes later is not sought. */
TEST(StoppingAtTheFirstGivesTheSameVerdict)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamFailure all = Pull(6, 2);
  LamLoad loads[PULL_STATES];
  LamFailure first;

  PullLoads(loads);
  first = Follow(&micro, (LamFailureProgram){
                             .strength = &failing_strength, .count = PULL_STATES, .loads = loads, .stop_at_first = 1});
  assert_int_equal(first.mode, all.mode);
  assert_near(first.factor, all.factor, 0);
  assert_true(first.followed < all.followed && isnan(first.onset[LAM_CRITERION_WALL].factor));
}

/* One long step that ends without an answer, collapsed: what lies on the way is still found. */
TEST(FailureBeforeALoadWithoutAnswerIsFound)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(0.6, 0, 0, 0.6, 0);
  const LamFailure failure = Follow(&micro, (LamFailureProgram){.count = 1, .loads = &load});

  assert_int_equal(failure.mode, LAM_FAILURE_BUCKLING);
  assert_near(1 - failure.load.F[0], 0.0227, 1e-3);
  assert_true(failure.reason[0] != '\0' && failure.followed < 1);
}

TEST_GROUP(.petsc = 1);
