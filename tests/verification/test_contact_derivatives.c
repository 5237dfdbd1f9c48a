/* Everything a contact response holds is a derivative of its energy: finite differences inside one contact set. */
#include "rve_fixture.h"
#include "figures_contact_derivatives.h"

static ContactSweep sweeps[CONTACT_STATES];
static ContactDerivativeError errors[CONTACT_STATES];

static int SweepAll(void **state)
{
  ContactState list[CONTACT_STATES];

  ListContactStates(list);
  for (int s = 0; s < CONTACT_STATES; s++) {
    if (SweepContact(&list[s], &sweeps[s])) return 1;
    errors[s] = DerivativeError(&sweeps[s]);
  }
  return 0;
}

static void StatesConvergeInsideOneContactSet(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) {
    assert_int_equal(sweeps[s].response.status, LAM_CONVERGED);
    assert_int_equal(sweeps[s].switches, 0);
  }
}

static void StressIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].stress < 1e-8);
}

static void LumenIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].lumen < 1e-8);
}

static void OpeningIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].opening < 1e-8);
}

static void TangentIsDerivativeOfStress(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].tangent < 1e-7);
}

static void DifferencesOfTheStressHaveMajorSymmetry(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].symmetry < 1e-8);
}

static void TurgorCouplingIsDerivativeOfStressAndLumen(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].turgor_coupling < 1e-7);
}

static void CohesionCouplingIsDerivativeOfStressAndOpening(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].cohesion_coupling < 1e-7);
}

static void SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes(void **state)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].volumes < 1e-7);
}

static int Run(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(StatesConvergeInsideOneContactSet),
      cmocka_unit_test(StressIsDerivativeOfEnergy),
      cmocka_unit_test(LumenIsDerivativeOfEnergy),
      cmocka_unit_test(OpeningIsDerivativeOfEnergy),
      cmocka_unit_test(TangentIsDerivativeOfStress),
      cmocka_unit_test(DifferencesOfTheStressHaveMajorSymmetry),
      cmocka_unit_test(TurgorCouplingIsDerivativeOfStressAndLumen),
      cmocka_unit_test(CohesionCouplingIsDerivativeOfStressAndOpening),
      cmocka_unit_test(SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes),
  };

  return cmocka_run_group_tests(tests, SweepAll, NULL);
}

int main(int argc, char **argv)
{
  return RunWithPetsc(argc, argv, Run);
}
