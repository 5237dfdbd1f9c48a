/* Everything a contact response holds is a derivative of its energy: finite differences inside one contact set. */
#include "support/test.h"
#include "support/rve_fixture.h"
#include "support/contact_tissue.h"

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

TEST(StatesConvergeInsideOneContactSet)
{
  for (int s = 0; s < CONTACT_STATES; s++) {
    assert_int_equal(sweeps[s].response.status, LAM_CONVERGED);
    assert_int_equal(sweeps[s].switches, 0);
  }
}

TEST(StressIsDerivativeOfEnergy)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].stress < 1e-8);
}

TEST(LumenIsDerivativeOfEnergy)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].lumen < 1e-8);
}

TEST(OpeningIsDerivativeOfEnergy)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].opening < 1e-8);
}

TEST(TangentIsDerivativeOfStress)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].tangent < 1e-7);
}

TEST(DifferencesOfTheStressHaveMajorSymmetry)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].symmetry < 1e-8);
}

TEST(TurgorCouplingIsDerivativeOfStressAndLumen)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].turgor_coupling < 1e-7);
}

TEST(CohesionCouplingIsDerivativeOfStressAndOpening)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].cohesion_coupling < 1e-7);
}

TEST(SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes)
{
  for (int s = 0; s < CONTACT_STATES; s++) assert_true(errors[s].volumes < 1e-7);
}

TEST_GROUP(.petsc = 1, .setup = SweepAll);
