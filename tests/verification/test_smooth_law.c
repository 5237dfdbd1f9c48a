/* Solutions with the smooth law of contact: its width and what the width costs, what they must not depend on, and what
   tells them from those of the exact law. Derivatives: test_derivatives. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"
#include "support/random_contact.h"
#include "support/turned_response.h"

#define USUAL_WIDTH 3e-3 /* apothems */
#define TOLERANCE 1e-8   /* of solves, whose residual is at rounding level */

enum { OPEN, SLID, STATES }; /* faces partly open; most of the force is between walls that do not face each other */
#define FOR_STATES(k) for (int k = 0; k < STATES; k++)

static LamLoad LoadOf(int k)
{
  return k == OPEN ? ContactLoad(1.04, 0.12, -0.03, 0.99, 0.02, 0.002) : ContactLoad(1, 1.2, 0, 1, 0.02, 0.002);
}

static LamMicrostructure SmoothTissue(double width)
{
  LamMicrostructure micro = ContactTissue(6, 2);

  micro.sharpness = LAM_SHARPNESS_SMOOTH;
  micro.contact_width = width;
  return micro;
}

static LamResponse SolveSmooth(double width, LamLoad load)
{
  const LamMicrostructure micro = SmoothTissue(width);

  return SolveTissue(&micro, load);
}

/* ---- the width ---- */

TEST(WidthIsTheUsualOneUnlessAskedFor)
{
  FOR_STATES(k)
  {
    assert_near(SolveSmooth(0.0, LoadOf(k)).contact_width, USUAL_WIDTH, 0.0);
    assert_near(SolveSmooth(2e-3, LoadOf(k)).contact_width, 2e-3, 0.0);
  }
}

TEST(ExactStatesHaveNoWidth)
{
  const LamResponse r = SolveContactTissue(LoadOf(OPEN));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_near(r.contact_width, 0.0, 0.0);
  assert_near(r.contact_error, 0.0, 0.0);
}

/* P - w dP/dw, dP/dw from central differences of solves at two widths. */
TEST(ContactErrorIsTheChangeToNoWidthToFirstOrder)
{
  const double w = USUAL_WIDTH, step = 1e-3 * w;

  FOR_STATES(k)
  {
    const LamResponse r = SolveSmooth(w, LoadOf(k)), up = SolveSmooth(w + step, LoadOf(k)),
                      down = SolveSmooth(w - step, LoadOf(k));
    double P[9];

    for (int i = 0; i < 9; i++) P[i] = r.P[i] - w * (up.P[i] - down.P[i]) / (2.0 * step);
    assert_near(r.contact_error / StressError(P, r.P), 1.0, 1e-4);
  }
}

/* Points come into reach as the width changes: the first order is a third of the whole at least. */
TEST(ContactErrorIsOfTheSizeOfTheChangeToASmallWidth)
{
  FOR_STATES(k)
  {
    const LamResponse r = SolveSmooth(USUAL_WIDTH, LoadOf(k)), narrow = SolveSmooth(0.1 * USUAL_WIDTH, LoadOf(k));
    const double ratio = r.contact_error / StressError(narrow.P, r.P);

    assert_int_equal(narrow.status, LAM_CONVERGED);
    assert_true(ratio > 1.0 / 3.0 && ratio < 3.0);
  }
}

/* ---- turgor alone: at F = I walls are pressed together everywhere, and P = -p but for the walls' compressibility ----
 */

static LamLoad Pressed(void)
{
  return ContactLoad(1, 0, 0, 1, 0.02, 0.002);
}

/* The force is that of turgor and suction, which walls bear from both sides. Contours are rounder at corners than walls
   are, which costs two percent on this mesh. */
TEST(PressedWallsBearTurgorAndSuction)
{
  const LamMicrostructure micro = SmoothTissue(0.0);
  const LamLoad load = Pressed();
  const double length = 2.0 * sqrt(3.0); /* of three faces */
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  LamTouchForces forces;

  assert_int_equal(SolveFromReference(rve, load).status, LAM_CONVERGED);
  CHECK(LamSmoothPressures(rve, &load, &forces));
  assert_near(forces.facing / ((load.turgor + load.cohesion) * length), 1.0, 0.03);
}

/* Spline contours do not pass a uniform pressure on exactly: nodes in the middle of elements give way by about the
   width. The stress converges with the first order of the element size. */
TEST(ErrorUnderTurgorFallsWithTheMesh)
{
  double error[2];

  for (int k = 0; k < 2; k++) {
    LamMicrostructure micro = SmoothTissue(0.0), exact;

    micro.along = k ? 24 : 6;
    exact = micro;
    exact.sharpness = LAM_SHARPNESS_EXACT;
    error[k] = fabs(SolveTissue(&micro, Pressed()).P[0] - SolveTissue(&exact, Pressed()).P[0]);
  }
  assert_true(error[1] < error[0] / 3.0);
}

/* ---- what the answer must not depend on ---- */

/* P(Q F R^T) = Q P(F) R^T, and the tangent likewise. */
static void AssertTurns(int k, const double Q[9], const double R[9])
{
  const LamLoad load = LoadOf(k);
  LamLoad turned = load;
  LamResponse a, b;

  TurnTensor(Q, load.F, R, turned.F);
  a = SolveSmooth(0.0, load);
  b = SolveSmooth(0.0, turned);
  assert_int_equal(b.status, LAM_CONVERGED);
  assert_near(TurnedStressError(&a, &b, Q, R), 0.0, TOLERANCE);
  assert_near(TurnedTangentError(&a, &b, Q, R), 0.0, TOLERANCE);
}

TEST(RotationOfTheObserver)
{
  double Q[9];

  RotationTensor(0.7, Q);
  FOR_STATES(k) AssertTurns(k, Q, turned_identity);
}

/* Nothing distinguishes master from slave: unlike the exact law, which has one in each face, the smooth law has the
   symmetry of the hexagon. */
TEST(SymmetriesOfTheLattice)
{
  static const double mirror[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
  double R[9];

  AssertTurns(OPEN, mirror, mirror);
  for (int n = 1; n < 4; n++) {
    RotationTensor(n * PETSC_PI / 3.0, R);
    AssertTurns(OPEN, R, R);
  }
}

TEST(NumberOfCells)
{
  FOR_STATES(k)
  {
    const LamResponse one = SolveSmooth(0.0, LoadOf(k));

    for (int d = 0; d < 2; d++) {
      LamMicrostructure micro = SmoothTissue(0.0);
      LamResponse two;

      micro.cells[d] = 2;
      two = SolveTissue(&micro, LoadOf(k));
      assert_int_equal(two.status, LAM_CONVERGED);
      for (int i = 0; i < 9; i++) assert_near(two.P[i], one.P[i], TOLERANCE);
    }
  }
}

/* ---- states ---- */

static void AssertEqual(const LamResponse *a, const LamResponse *b)
{
  assert_int_equal(a->status, LAM_CONVERGED);
  assert_int_equal(a->newton_iterations, b->newton_iterations);
  assert_memory_equal(a->P, b->P, sizeof(a->P));
  assert_memory_equal(&a->energy, &b->energy, sizeof(a->energy));
  assert_memory_equal(&a->contact_error, &b->contact_error, sizeof(a->contact_error));
}

static LamLoad Further(LamLoad load)
{
  load.F[1] += 0.02;
  return load;
}

static LamResponse Solve(LamRVE rve, LamLoad load, LamRVEState at)
{
  LamResponse r;

  CHECK(LamRVESolve(rve, &load, at, &r));
  return r;
}

static void AssertPackedGoesOn(const LamMicrostructure *micro, int k)
{
  OWNED(LamRVE, LamRVEDestroy) first = NewRVE(micro);
  OWNED(LamRVE, LamRVEDestroy) second = NewRVE(micro);
  OWNED(LamRVEState, LamRVEStateDestroy) a = NewState(first);
  OWNED(LamRVEState, LamRVEStateDestroy) b = NewState(second);
  LamResponse ra, rb;
  size_t size;
  void *bytes;

  (void)Solve(first, LoadOf(k), a);
  CHECK(LamRVEStateSize(a, &size));
  bytes = malloc(size);
  CHECK(LamRVEStatePack(a, bytes));
  CHECK(LamRVEStateUnpack(bytes, b));
  free(bytes);
  ra = Solve(first, Further(LoadOf(k)), a);
  rb = Solve(second, Further(LoadOf(k)), b);
  AssertEqual(&ra, &rb);
}

TEST(PackedStateGoesOnBitForBit)
{
  const LamMicrostructure micro = SmoothTissue(0.0);

  FOR_STATES(k) AssertPackedGoesOn(&micro, k);
}

/* One state is of the exact law, and goes on with it; the other one is not. */
TEST(PackedStateRemembersItsLaw)
{
  const LamMicrostructure micro = ContactTissue(6, 2);

  assert_near(SolveTissue(&micro, LoadOf(OPEN)).contact_width, 0.0, 0.0);
  assert_true(SolveTissue(&micro, LoadOf(SLID)).contact_width > 0.0);
  FOR_STATES(k) AssertPackedGoesOn(&micro, k);
}

/* Where the exact law is tried from a smooth state and fails, the response is that of the smooth state. */
TEST(NothingOfAFailedExactLawIsLeft)
{
  uint64_t seed = 1;
  RandomContact s;
  LamResponse tried, alone;

  for (int k = 0; k <= 3; k++) s = DrawContact(BOX_WIDE, k, 6, 2, &seed); /* it stalls at the last one */
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&s.micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  tried = Solve(rve, s.load, at);
  assert_true(tried.contact_width > 0.0 && tried.third_fraction < 0.01);

  s.micro.sharpness = LAM_SHARPNESS_SMOOTH;
  OWNED(LamRVE, LamRVEDestroy) smooth = NewRVE(&s.micro);
  alone = Solve(smooth, s.load, at);
  assert_near(StressError(tried.P, alone.P), 0.0, TOLERANCE);
  assert_near(tried.energy / alone.energy, 1.0, TOLERANCE);
  assert_near(tried.contact_error / alone.contact_error, 1.0, TOLERANCE);
}

/* A solve that has met other walls, for which the matrix has grown, leaves no trace. */
TEST(SolveDependsOnLoadAndStateAlone)
{
  const LamMicrostructure micro = SmoothTissue(0.0);

  FOR_STATES(k)
  {
    OWNED(LamRVE, LamRVEDestroy) fresh = NewRVE(&micro);
    OWNED(LamRVE, LamRVEDestroy) used = NewRVE(&micro);
    LamResponse a, b;

    assert_true(SolveFromReference(used, LoadOf(SLID)).third_fraction > 0.5);
    a = SolveFromReference(fresh, LoadOf(k));
    b = SolveFromReference(used, LoadOf(k));
    AssertEqual(&a, &b);
  }
}

TEST_GROUP(.petsc = 1);
