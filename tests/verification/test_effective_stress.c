/* Effective-stress principle of bonded tissue: P + p J F^-T does not depend on p as the walls become incompressible. */
#include "support/rve_fixture.h"
#include "support/effective_stress.h"

static double remainders[3]; /* at kappa = 1e2, 1e3, 1e4 */

static int SolveAll(void **state)
{
  for (int k = 0; k < 3; k++)
    if (EffectiveStressRemainder(pow(10.0, 2 + k), &remainders[k])) return 1;
  return 0;
}

TEST_IS(RemainderIsSmall, assert_true(remainders[1] < 0.02));

TEST(RemainderFallsAsOneOverBulkModulus)
{
  for (int k = 1; k < 3; k++) assert_in_range((int)(100.0 * remainders[k - 1] / remainders[k]), 900, 1100);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
