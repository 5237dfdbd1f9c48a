/* The estimate of the error of P from half as many elements, against the error on a fine mesh. */
#include "support/rve_fixture.h"
#include "solve.h"

#define STATES 6

static const double loads[STATES][5] = {{1, 0.1, 0, 1, 0.18},    {1, 0.2, 0, 1, 0.18}, {1, 0.3, 0, 1, 0.3},
                                        {1.05, 0, 0, 1.05, 0.1}, {1.1, 0, 0, 1, 0.18}, {1.1, 0.1, 0, 0.98, 0.2}};

static LamLoad Load(int k)
{
  return PlaneLoad(loads[k][0], loads[k][1], loads[k][2], loads[k][3], loads[k][4]);
}

static LamResponse EstimatedOf(const LamMicrostructure *micro, LamLoad load, LamWanted wanted)
{
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(micro);
  OWNED(LamRVEState, LamRVEStateDestroy) state;
  OWNED(LamRVEEstimate, LamRVEEstimateDestroy) estimate;
  LamResponse response;

  assert_int_equal(LamRVESetWanted(rve, wanted), 0);
  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  assert_int_equal(LamRVEEstimateCreate(rve, &estimate), 0);
  assert_int_equal(LamRVESolve(rve, &load, state, &response), 0);
  assert_int_equal(LamRVEEstimateError(estimate, state, &response), 0);
  return response;
}

static LamResponse Estimated(const LamMicrostructure *micro, LamLoad load)
{
  return EstimatedOf(micro, load, LAM_WANT_ALL);
}

/* Number of states whose estimate is within a factor of the error. */
static int CountWithin(double factor, LamInterfaceLawType interface, double grading, int along)
{
  LamMicrostructure micro = DefaultTissue(), fine;
  int within = 0;

  micro.interface = interface;
  micro.grading = grading;
  fine = micro;
  micro.along = along;
  fine.along = 16;
  fine.through = interface == LAM_INTERFACE_BONDED ? 4 : 3;
  for (int k = 0; k < STATES; k++) {
    const LamResponse r = Estimated(&micro, Load(k)), truth = SolveTissue(&fine, Load(k));
    const double error = LamStressError(r.P, truth.P);

    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.error_estimate > 0);
    within += r.error_estimate > error / factor && r.error_estimate < error * factor;
  }
  return within;
}

/* Finer meshes wrinkle where these cannot: sheared by 0.5, P is 3 % off where half as many elements tell 0.4 %. */
TEST(IsLargerWhereWallsKink)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1, 0.5, 0, 1, 0);
  const LamResponse known = Estimated(&micro, load), unknown = EstimatedOf(&micro, load, LAM_WANT_STRESS);

  assert_true(known.kinked_fraction > LAM_KINKED_SHARE && isnan(unknown.kinked_fraction));
  assert_true(known.error_estimate > 3.0 * unknown.error_estimate);
}

TEST(IsNearTheErrorOfBondedTissue)
{
  assert_int_equal(CountWithin(5, LAM_INTERFACE_BONDED, 0.7, 6), STATES);
  assert_true(CountWithin(3, LAM_INTERFACE_BONDED, 0.0, 6) >= STATES - 1);
}

TEST_IS(IsNearTheErrorOfContactTissue, assert_true(CountWithin(5, LAM_INTERFACE_CONTACT, 0.0, 6) >= STATES - 1));

/* An odd number of elements along a face cannot be halved. */
TEST(IsNotKnownForOddMeshes)
{
  LamMicrostructure micro = DefaultTissue();

  micro.along = 5;
  assert_true(isnan(Estimated(&micro, Load(0)).error_estimate));
}

/* Both meshes are far too coarse for walls of 0.005 apothems, which bend next to junctions. */
TEST(IsNotKnownForMeshesThatTellNothing)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall_thickness = 0.005;
  assert_true(isnan(Estimated(&micro, Load(3)).error_estimate));
}

/* Edges of ten times the thickness: errors fall with the first power of their length, by half for half the length. */
TEST(IsTheWholeDifferenceWhereErrorsFallSlowly)
{
  LamMicrostructure micro = DefaultTissue(), coarse;
  LamResponse estimated, half;

  micro.wall_thickness = 0.01;
  micro.along = 12;
  coarse = micro;
  coarse.along = 6;
  coarse.through = 1;
  estimated = Estimated(&micro, Load(3));
  half = SolveTissue(&coarse, Load(3));
  assert_near(estimated.error_estimate, LamStressError(half.P, estimated.P), 1e-6);
}

TEST(ChangesNothingOfTheState)
{
  LamMicrostructure micro = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  const LamResponse alone = SolveFromReference(rve, Load(1)), both = Estimated(&micro, Load(1));

  assert_int_equal(alone.factorisations, both.factorisations); /* the estimate's are not the state's */
  assert_memory_equal(alone.P, both.P, sizeof(alone.P));
}
