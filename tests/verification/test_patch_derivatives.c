/* Everything that a patch answers is a derivative of its energy: finite differences at a general F. */
#include "rve_fixture.h"
#include "assert_near.h"
#include "figures_patch.h"

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

static void StatesConvergeInsideOneContactSet(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_int_equal(sweeps[s].response.status, LAM_CONVERGED);
    assert_int_equal(sweeps[s].switches, 0);
  }
}

static void StressIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) assert_near(errors[s].stress, 0.0, 1e-8);
}

static void LumenIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_near(errors[s].turgor, 0.0, 1e-8);
    assert_near(errors[s].lumen, 0.0, 1e-8);
  }
}

static void OpeningIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_near(errors[s].cohesion, 0.0, 1e-8);
    assert_near(errors[s].opening, 0.0, 1e-8);
  }
}

static void TangentIsDerivativeOfStress(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) assert_near(errors[s].tangent, 0.0, 1e-6);
}

static void CouplingsAreDerivativesOfStress(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    assert_near(errors[s].turgor_coupling, 0.0, 1e-6);
    assert_near(errors[s].cohesion_coupling, 0.0, 1e-6);
  }
}

static void SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) assert_near(errors[s].volumes, 0.0, 1e-6);
}

/* The moments of the forces on the held walls, x = F X, balance: P F^T is symmetric. */
static void MomentsOfTheBoundaryForcesBalance(void **state)
{
  for (int s = 0; s < PATCH_STATES; s++) {
    const double *P = sweeps[s].response.P, *F = sweeps[s].response.load.F;

    assert_near(P[0] * F[3] + P[1] * F[4], P[3] * F[0] + P[4] * F[1], 1e-9);
  }
}

static int Run(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(StatesConvergeInsideOneContactSet),
      cmocka_unit_test(StressIsDerivativeOfEnergy),
      cmocka_unit_test(LumenIsDerivativeOfEnergy),
      cmocka_unit_test(OpeningIsDerivativeOfEnergy),
      cmocka_unit_test(TangentIsDerivativeOfStress),
      cmocka_unit_test(CouplingsAreDerivativesOfStress),
      cmocka_unit_test(SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes),
      cmocka_unit_test(MomentsOfTheBoundaryForcesBalance),
  };

  return cmocka_run_group_tests(tests, SweepAll, NULL);
}

int main(int argc, char **argv)
{
  return RunWithPetsc(argc, argv, Run);
}
