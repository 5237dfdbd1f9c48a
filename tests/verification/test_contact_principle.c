/* Effective-stress principle of contact tissue: turgor and cohesion act through their sum s; P + p J F^-T depends on it
   alone as the walls become incompressible. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

static double differences[3][PRINCIPLE_LOADS]; /* over s, at kappa / C1 = 1e3, 1e4, 1e5 */
static int converged;

static int SolveAll(void **state)
{
  for (int k = 0; k < 3; k++) {
    int count;

    if (ComputePrinciple(pow(10.0, 3 + k), 6, 2, differences[k], &count)) return 1;
    converged += count;
  }
  return 0;
}

TEST_IS(AllStatesConverge, assert_int_equal(converged, 3 * PRINCIPLE_LOADS * PRINCIPLE_PAIRS));

TEST(DifferencesAreSmall)
{
  for (int i = 0; i < PRINCIPLE_LOADS; i++) assert_near(differences[1][i], 0.0, 2e-3);
}

TEST(DifferencesFallAsOneOverBulkModulus)
{
  for (int k = 1; k < 3; k++)
    for (int i = 0; i < PRINCIPLE_LOADS; i++) assert_near(differences[k - 1][i] / differences[k][i], 10.0, 0.5);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
