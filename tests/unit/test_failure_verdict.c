/* The verdict from what a load program gave: which criterion decides, when, and when there is none. */
#include "support/test.h"
#include "failure.h"

static const LamStrength strength = {.wall = 5, .lamella_normal = 1, .lamella_shear = 0.5};

/* A failure under way: nothing reached yet, the program followed to state 4. */
static LamFailure Begun(LamInterfaceLawType interface, const LamStrength *given)
{
  LamFailure failure = {.factor = NAN, .followed = 4, .criterion = LAM_CRITERION_COUNT};

  failure.program.interface = interface;
  failure.program.strength = given;
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) failure.onset[c].factor = NAN;
  return failure;
}

static LamResponse Response(PetscReal turgor)
{
  const LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = turgor};
  LamResponse response;

  assert_int_equal(LamResponseInit(&load, &response), 0);
  response.status = LAM_CONVERGED;
  response.max_traction = response.max_lamella_shear = response.max_wall_tension = 0.25;
  response.max_gap = 0;
  for (int k = 0; k < 3; k++) {
    response.mean_face_traction[k] = -1;
    response.mean_wall_tension[k] = 1;
  }
  return response;
}

/* A response whose walls bear this tension on average. */
static LamResponse WithTension(PetscReal turgor, PetscReal tension)
{
  LamResponse response = Response(turgor);

  for (int k = 0; k < 3; k++) response.mean_wall_tension[k] = k * tension;
  return response;
}

static PetscReal Excess(LamCriterion criterion, const LamFailure *failure, LamResponse before, LamResponse now)
{
  const LamResponse both_before[2] = {before, before}, both_now[2] = {now, now};

  return LamCriterionExcess(criterion, failure, both_before, both_now);
}

static LamFailureMode Conclude(LamFailure *failure)
{
  assert_int_equal(LamFailureConclude(failure), 0);
  return failure->mode;
}

TEST(measures_are_held_against_their_strengths)
{
  const LamFailure failure = Begun(LAM_INTERFACE_BONDED, &strength);
  const LamResponse r = Response(0);

  (void)state;
  assert_near(Excess(LAM_CRITERION_LAMELLA_NORMAL, &failure, r, r), -0.75, 1e-15);
  assert_near(Excess(LAM_CRITERION_LAMELLA_SHEAR, &failure, r, r), -0.5, 1e-15);
  assert_near(Excess(LAM_CRITERION_WALL, &failure, r, r), -0.95, 1e-15);
}

TEST(a_branch_that_is_left_is_an_instability)
{
  const LamFailure failure = Begun(LAM_INTERFACE_BONDED, &strength);
  LamResponse before = Response(0), now = Response(0);

  (void)state;
  before.branch = now.branch = 1;
  assert_true(Excess(LAM_CRITERION_STABILITY, &failure, before, now) < 0);
  now.branch = 2;
  assert_true(Excess(LAM_CRITERION_STABILITY, &failure, before, now) >= 0);
  now.branch = 1;
  now.status = LAM_UNSTABLE;
  assert_true(Excess(LAM_CRITERION_STABILITY, &failure, before, now) >= 0);
}

/* Dry tissue has no turgor to lose, however its walls are pressed. */
TEST(only_turgor_that_was_there_is_lost)
{
  LamFailure failure = Begun(LAM_INTERFACE_BONDED, &strength);
  const LamResponse taut = Response(0.1), slack = WithTension(0.1, -0.01), dry = Response(0);

  (void)state;
  assert_true(Excess(LAM_CRITERION_TURGOR, &failure, dry, slack) < 0);
  failure.turgid = PETSC_TRUE;
  assert_true(Excess(LAM_CRITERION_TURGOR, &failure, taut, slack) < 0);
  assert_true(Excess(LAM_CRITERION_TURGOR, &failure, taut, dry) >= 0);
  failure.taut = PETSC_TRUE;
  assert_true(Excess(LAM_CRITERION_TURGOR, &failure, taut, taut) < 0);
  assert_true(Excess(LAM_CRITERION_TURGOR, &failure, taut, slack) >= 0);
}

/* At F = I turgor gives walls the little tension of their compressibility: that is not taut. */
TEST(walls_are_taut_from_a_share_of_the_turgor_on)
{
  const LamResponse slack = WithTension(0.1, 0.9 * LAM_TAUT * 0.1);
  LamResponse r = WithTension(0.1, 1.1 * LAM_TAUT * 0.1);

  (void)state;
  assert_false(LamIsTaut(&slack));
  assert_true(LamIsTaut(&r));
  r.load.turgor = 0;
  assert_false(LamIsTaut(&r));
}

TEST(without_strengths_only_what_needs_none_is_judged)
{
  static const LamStrength none = {NAN, NAN, NAN};

  (void)state;
  for (int c = 0; c < LAM_CRITERION_COUNT; c++) {
    const LamCriterion criterion = (LamCriterion)c;
    const PetscBool free_of_it = (PetscBool)(c == LAM_CRITERION_STABILITY || c == LAM_CRITERION_TURGOR);

    assert_int_equal(LamCriterionIsJudged(criterion, LAM_INTERFACE_BONDED, &none), free_of_it);
    assert_int_equal(LamCriterionIsJudged(criterion, LAM_INTERFACE_CONTACT, &none),
                     free_of_it || c == LAM_CRITERION_CONTACT);
    assert_int_equal(LamCriterionIsJudged(criterion, LAM_INTERFACE_BONDED, &strength), c != LAM_CRITERION_CONTACT);
  }
}

TEST(the_first_criterion_decides)
{
  LamFailure failure = Begun(LAM_INTERFACE_BONDED, &strength);

  (void)state;
  failure.onset[LAM_CRITERION_LAMELLA_NORMAL].factor = 3.5;
  failure.onset[LAM_CRITERION_WALL].factor = 2.25;
  failure.onset[LAM_CRITERION_TURGOR].factor = 3;
  assert_int_equal(Conclude(&failure), LAM_FAILURE_RUPTURE);
  assert_int_equal(failure.criterion, LAM_CRITERION_WALL);
  assert_near(failure.factor, 2.25, 0);
}

TEST(of_two_at_once_the_first_in_the_list_decides)
{
  LamFailure failure = Begun(LAM_INTERFACE_BONDED, &strength);

  (void)state;
  failure.onset[LAM_CRITERION_STABILITY].factor = failure.onset[LAM_CRITERION_LAMELLA_SHEAR].factor = 2;
  assert_int_equal(Conclude(&failure), LAM_FAILURE_SEPARATION);
}

TEST(a_program_without_an_answer_is_unknown_unless_something_came_before)
{
  LamFailure failure = Begun(LAM_INTERFACE_BONDED, &strength);

  (void)state;
  assert_int_equal(Conclude(&failure), LAM_FAILURE_NONE);
  failure.reason[0] = 'x';
  assert_int_equal(Conclude(&failure), LAM_FAILURE_UNKNOWN);
  assert_true(isnan(failure.factor));
  failure.onset[LAM_CRITERION_STABILITY].factor = 1;
  assert_int_equal(Conclude(&failure), LAM_FAILURE_BUCKLING);
}
