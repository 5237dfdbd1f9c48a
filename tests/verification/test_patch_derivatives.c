/* Everything that a patch answers is a derivative of its energy: finite differences at a general F. */
#include "support/test.h"
#include "support/rve_fixture.h"
#include "support/cell_patch.h"

static ContactSweep sweeps[PATCH_STATES];
static ContactDerivativeError errors[PATCH_STATES];

static int SweepAll(void **state)
{
  ContactState list[PATCH_STATES];

  ListPatchStates(list);
  for (int s = 0; s < PATCH_STATES; s++) {
    if (SweepContact(&list[s], &sweeps[s])) return 1;
    errors[s] = DerivativeError(&sweeps[s]);
  }
  return 0;
}

TEST(StatesConvergeInsideOneContactSet)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_int_equal(sweeps[s].response.status, LAM_CONVERGED);
    assert_int_equal(sweeps[s].switches, 0);
  }
}

TEST(StressIsDerivativeOfEnergy)
{
  for (int s = 0; s < PATCH_STATES; s++) assert_near(errors[s].stress, 0.0, 1e-8);
}

TEST(LumenIsDerivativeOfEnergy)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_near(errors[s].turgor, 0.0, 1e-8);
    assert_near(errors[s].lumen, 0.0, 1e-8);
  }
}

TEST(OpeningIsDerivativeOfEnergy)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_near(errors[s].cohesion, 0.0, 1e-8);
    assert_near(errors[s].opening, 0.0, 1e-8);
  }
}

TEST(TangentIsDerivativeOfStress)
{
  for (int s = 0; s < PATCH_STATES; s++) assert_near(errors[s].tangent, 0.0, 1e-6);
}

TEST(CouplingsAreDerivativesOfStress)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_near(errors[s].turgor_coupling, 0.0, 1e-6);
    assert_near(errors[s].cohesion_coupling, 0.0, 1e-6);
  }
}

TEST(SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes)
{
  for (int s = 0; s < PATCH_STATES; s++) assert_near(errors[s].volumes, 0.0, 1e-6);
}

/* The moments of the forces on the held walls, x = F X, balance: P F^T is symmetric. */
TEST(MomentsOfTheBoundaryForcesBalance)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    const double *P = sweeps[s].response.P, *F = sweeps[s].response.load.F;

    assert_near(P[0] * F[3] + P[1] * F[4], P[3] * F[0] + P[4] * F[1], 1e-9);
  }
}

TEST_GROUP(.petsc = 1, .setup = SweepAll);
