/* Thin-walled honeycombs against beam theory. */
#include "support/rve_fixture.h"
#include "support/honeycomb.h"

#define ALONG 80 /* elements per wall: the theory's error is about 1 %, the mesh's must be smaller */

static double ratios[3][3]; /* [h/l][E*, G*, K*] */

static int SolveAll(void **state)
{
  static const double h_l[3] = {0.035, 0.02, 0.01};

  for (int k = 0; k < 3; k++)
    if (HoneycombModuli(h_l[k], ALONG, 1, ratios[k])) return 1;
  return 0;
}

static void ApproachesTheory(int modulus)
{
  assert_near(ratios[0][modulus], 1.0, 0.04);
  for (int k = 1; k < 3; k++) assert_true(fabs(ratios[k][modulus] - 1.0) < fabs(ratios[k - 1][modulus] - 1.0));
}

TEST_IS(YoungsModulusApproachesTheory, ApproachesTheory(0));
TEST_IS(ShearModulusApproachesTheory, ApproachesTheory(1));
TEST_IS(BulkModulusApproachesTheory, ApproachesTheory(2));

/* Hexagonal symmetry: A1111 - A1122 = 2 A1212 at F = I, as far as rounding of kappa >> G* lets it. */
TEST(UnloadedHoneycombIsIsotropic)
{
  const LamMicrostructure micro = Honeycomb(0.035, 12, 1);
  const LamResponse r = SolveTissue(&micro, PlaneLoad(1, 0, 0, 1, 0));

  assert_near(r.tangent[0], r.tangent[40], 1e-7 * r.tangent[0]);
  assert_near(r.tangent[0] - r.tangent[4], 2.0 * r.tangent[10], 1e-7 * r.tangent[0]);
}

/* Weak and strong pressure, mu = 1 and 4: the walls stiffen as beams under tension. */
TEST(PressurisedShearModulusFollowsTheory)
{
  static const double mu[3] = {1.0, 2.0, 4.0};

  for (int k = 0; k < 3; k++) {
    double thick = 0.0, thin = 0.0;

    assert_int_equal(PressurisedShearModulus(0.035, mu[k], 40, 1, &thick), 0);
    assert_int_equal(PressurisedShearModulus(0.01, mu[k], 40, 1, &thin), 0);
    assert_near(thick, 1.0, 0.04);
    assert_near(thin, 1.0, 0.01);
  }
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
