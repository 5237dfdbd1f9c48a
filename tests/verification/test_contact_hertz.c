/* Hertz contact of a cylinder with a flat and with an equal cylinder, plane strain. */
#include "support/rve_fixture.h"
#include "support/contact_blocks.h"

#define TOLERANCE 5e-3

static Hertz coarse[2], fine[2]; /* by curvature of the base */

static int Solve(void **state)
{
  for (int k = 0; k < 2; k++) {
    if (ComputeHertz(8, k, &coarse[k])) return 1;
    if (ComputeHertz(32, k, &fine[k])) return 1;
  }
  return 0;
}

static double PeakError(const Hertz *hertz)
{
  return fabs(hertz->peak / hertz->peak_theory - 1.0);
}

static double HalfWidthError(const Hertz *hertz)
{
  return fabs(hertz->half_width / hertz->half_width_theory - 1.0);
}

TEST_IS(PeakPressureOnAFlat, assert_near(PeakError(&fine[0]), 0.0, TOLERANCE));
TEST_IS(HalfWidthOnAFlat, assert_near(HalfWidthError(&fine[0]), 0.0, TOLERANCE));
TEST_IS(PeakPressureOnACylinder, assert_near(PeakError(&fine[1]), 0.0, TOLERANCE));
TEST_IS(HalfWidthOnACylinder, assert_near(HalfWidthError(&fine[1]), 0.0, TOLERANCE));

TEST(ErrorsFallWithTheMesh)
{
  for (int k = 0; k < 2; k++) {
    assert_true(PeakError(&fine[k]) < 0.5 * PeakError(&coarse[k]));
    assert_true(HalfWidthError(&fine[k]) < 0.5 * HalfWidthError(&coarse[k]));
  }
}

TEST_GROUP(.petsc = 1, .setup = Solve);
