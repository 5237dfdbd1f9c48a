/* Large deformations are answered with stable states; impossible ones with a true reason. */
#include "support/rve_fixture.h"
#include "support/extreme_tissue.h"

TEST(LargeDeformationsAreAnswered)
{
  Extreme list[EXTREMES];

  ListExtremes(list);
  for (int k = 0; k < EXTREMES; k++) {
    const LamResponse r = SolveDefaultTissue(list[k].load);

    if (r.status != LAM_CONVERGED)
      fail_msg("%s, turgor %g: %s: %s", list[k].name, r.load.turgor, LamStatusNames[r.status], r.reason);
    assert_true(r.stable);
    assert_int_equal(r.negative_eigenvalues, 0);
    assert_string_equal(r.reason, "");
  }
}

/* Asked in small steps, the tissue reaches the state that it reaches at one go. */
TEST(OneGoAndSmallStepsAgree)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamResponse once = SolveTissue(&micro, PlaneLoad(1, 0.8, 0, 1, 0.02 / TISSUE_STRESS));
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse r;

  for (int k = 1; k <= 8; k++) {
    const LamLoad load = PlaneLoad(1, 0.1 * k, 0, 1, 0.02 / TISSUE_STRESS);

    assert_int_equal(LamRVESolve(rve, &load, point, &r), 0);
  }
  assert_true(StressError(r.P, once.P) < 1e-8);
}

static void AssertInvalid(LamLoad load, const char fragment[])
{
  const LamResponse r = SolveDefaultTissue(load);

  assert_int_equal(r.status, LAM_INVALID_F);
  if (!strstr(r.reason, fragment)) fail_msg("reason \"%s\" lacks \"%s\"", r.reason, fragment);
  assert_false(r.stable);
  assert_true(isnan(r.P[0]));
}

TEST(InsideOutIsInvalid)
{
  AssertInvalid(PlaneLoad(-1, 0, 0, 1, 0), "inside out");
  AssertInvalid(PlaneLoad(1, 1, 1, 1, 0), "inside out");
}

TEST(NegativeThicknessIsInvalid)
{
  LamLoad load = PlaneLoad(1, 0, 0, 1, 0);

  load.F[8] = -1.0;
  AssertInvalid(load, "F33");
}

TEST(NotANumberIsInvalid)
{
  AssertInvalid(PlaneLoad(NAN, 0, 0, 1, 0), "not finite");
  AssertInvalid(PlaneLoad(1, INFINITY, 0, 1, 0), "not finite");
  AssertInvalid(PlaneLoad(1, 0, 0, 1, NAN), "not finite");
}

TEST(OutOfPlaneShearIsInvalid)
{
  LamLoad load = PlaneLoad(1, 0, 0, 1, 0);

  load.F[2] = 0.1;
  AssertInvalid(load, "out-of-plane");
}

/* Walls that have passed through each other are not an answer. */
TEST(CollapsedLumenIsRefused)
{
  const LamResponse open = SolveDefaultTissue(PlaneLoad(0.7, 0, 0, 1, 0));
  const LamResponse closed = SolveDefaultTissue(PlaneLoad(0.4, 0, 0, 1, 0));

  assert_int_equal(open.status, LAM_CONVERGED);
  assert_int_equal(closed.status, LAM_NO_EQUILIBRIUM);
  assert_non_null(strstr(closed.reason, "collapses between"));
}

/* A failed solve leaves the state as it was: the next load is answered as if nothing had happened. */
TEST(FailureLeavesTheStateAsItWas)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad first = PlaneLoad(1, 0.1, 0, 1, 0.1), bad = PlaneLoad(0, 0, 0, 0, 0.1);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse before, failed, after;

  assert_int_equal(LamRVESolve(rve, &first, point, &before), 0);
  assert_int_equal(LamRVESolve(rve, &bad, point, &failed), 0);
  assert_int_equal(failed.status, LAM_INVALID_F);
  assert_int_equal(LamRVESolve(rve, &first, point, &after), 0);
  assert_int_equal(after.newton_iterations, 0);
}
