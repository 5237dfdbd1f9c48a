/* Rounding errors of shipped responses against the same discrete problem in extended precision. */
#include "support/rve_fixture.h"
#include "support/digits.h"
#include "rounding.h"

#define STRESS_DIGITS (500 * PETSC_MACHINE_EPSILON) /* of P, whatever the walls */

static const LamWanted wanted = LAM_WANT_STRESS | LAM_WANT_DERIVATIVES;

static LamMicrostructure Tissue(double kappa, double thickness, double fibres)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall_thickness = thickness;
  micro.wall.C4 = fibres * micro.wall.C1;
  micro.wall.bulk_modulus = kappa * micro.wall.C1;
  return micro;
}

static Digits Measure(const LamMicrostructure *micro, LamLoad load, Extended extended)
{
  Digits d;

  assert_int_equal(DigitsMeasure(micro, &load, 1, wanted, extended, &d), 0);
  assert_int_equal(d.status, LAM_CONVERGED);
  return d;
}

static void AssertWithinModel(const LamMicrostructure *micro, LamLoad load)
{
  const Digits d = Measure(micro, load, ExtendedLong);

  assert_true(d.P < STRESS_DIGITS);
  assert_true(d.energy < STRESS_DIGITS);
  assert_true(d.lumen < STRESS_DIGITS);
  assert_true(d.tangent < LamTangentRounding(micro));
}

TEST(RandomStatesStayWithinTheModel)
{
  uint64_t seed = 41;

  for (int k = 0; k < 12; k++) {
    const LamMicrostructure micro =
        Tissue(pow(10, RandomReal(&seed, 2, 6)), RandomReal(&seed, 0.02, 0.3), pow(10, RandomReal(&seed, 0, 2)));
    const LamLoad load =
        PlaneLoad(RandomReal(&seed, 1, 1.1), RandomReal(&seed, 0, 0.2), 0, RandomReal(&seed, 1, 1.1), 0.2);

    AssertWithinModel(&micro, load);
  }
}

TEST(ExtremesStayWithinTheModel)
{
  const LamMicrostructure stiff = Tissue(1e7, 0.15, 10), thin = Tissue(1e3, 0.005, 10), thick = Tissue(1e3, 0.8, 10);

  AssertWithinModel(&stiff, PlaneLoad(1, 0.1, 0, 1, 0.2));
  AssertWithinModel(&thin, PlaneLoad(1, 0.1, 0, 1, 0.2));
  AssertWithinModel(&thick, PlaneLoad(1.1, 0, 0, 1.05, 0.2));
}

TEST(ContactLosesNoMore)
{
  LamMicrostructure micro = Tissue(1e6, 0.15, 10);
  LamLoad load = PlaneLoad(1, 0.1, 0, 1, 0.2);

  micro.interface = LAM_INTERFACE_CONTACT;
  load.cohesion = 0.05;
  AssertWithinModel(&micro, load);
}

/* Dry tissue at F = I has no stress at all. */
TEST(SmallStrainsKeepTheirDigits)
{
  const LamMicrostructure micro = Tissue(1e3, 0.15, 10);

  for (double strain = 1e-3; strain > 1e-10; strain *= 1e-3) {
    assert_true(Measure(&micro, PlaneLoad(1, strain, 0, 1, 0), ExtendedQuad).P < STRESS_DIGITS);
    assert_true(Measure(&micro, PlaneLoad(1 + strain, 0, 0, 1 + strain, 0), ExtendedQuad).P < STRESS_DIGITS);
  }
}

/* The reference does not depend on its own precision. */
TEST(LongAndQuadAgree)
{
  const LamMicrostructure micro = Tissue(1e5, 0.05, 10);
  const LamLoad load = PlaneLoad(1, 0.2, 0, 1, 0.2);
  const Digits quad = Measure(&micro, load, ExtendedQuad), longer = Measure(&micro, load, ExtendedLong);

  assert_true(quad.left < 1e-15 * quad.residual);
  assert_true(fabs(quad.P - longer.P) < 4 * PETSC_MACHINE_EPSILON);
  assert_true(fabs(quad.tangent - longer.tangent) < 0.01 * quad.tangent);
}

TEST_GROUP(.petsc = 1);
