/* Effective-stress principle of contact tissue: turgor and cohesion act through their sum s; P + p J F^-T depends on it
   alone as the walls become incompressible. It holds of both laws of contact. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

enum { EXACT, SMOOTH, LAWS };
static double differences[LAWS][3][PRINCIPLE_LOADS]; /* over s, at kappa / C1 = 1e3, 1e4, 1e5 */
static int converged[LAWS];
#define FOR_LAWS(law) for (int law = 0; law < LAWS; law++)

static int SolveAll(void **state)
{
  FOR_LAWS(law)
  {
    LamMicrostructure micro = ContactTissue(6, 2);

    micro.sharpness = law == SMOOTH ? LAM_SHARPNESS_SMOOTH : LAM_SHARPNESS_EXACT;
    for (int k = 0; k < 3; k++) {
      int count;

      if (ComputePrinciple(micro, pow(10.0, 3 + k), differences[law][k], &count)) return 1;
      converged[law] += count;
    }
  }
  return 0;
}

TEST(AllStatesConverge)
{
  FOR_LAWS(law) assert_int_equal(converged[law], 3 * PRINCIPLE_LOADS * PRINCIPLE_PAIRS);
}

TEST(DifferencesAreSmall)
{
  FOR_LAWS(law)
  for (int i = 0; i < PRINCIPLE_LOADS; i++) assert_near(differences[law][1][i], 0.0, 2e-3);
}

TEST(DifferencesFallAsOneOverBulkModulus)
{
  FOR_LAWS(law)
  for (int k = 1; k < 3; k++)
    for (int i = 0; i < PRINCIPLE_LOADS; i++)
      assert_near(differences[law][k - 1][i] / differences[law][k][i], 10.0, 0.5);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
