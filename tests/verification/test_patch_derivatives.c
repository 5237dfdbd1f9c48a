/* Everything that a patch answers is a derivative of its energy: finite differences at a general F. */
#include "rve_fixture.h"
#include "assert_near.h"
#include "figures_patch.h"

#define STATES 5
static ContactSweep sweeps[STATES];
static ContactDerivativeError errors[STATES];

static ContactState PatchState(const char *name, PetscInt columns, PetscInt rows, double orientation,
                               LamInterfaceLawType interface, LamPatchSides sides)
{
  ContactState state = {.name = name,
                        .micro = PatchTissue(columns, rows, orientation, interface),
                        .load = ContactLoad(1.02, 0.08, -0.03, 1.01, 0.02, 0),
                        .step = CONTACT_STEP_LARGE_RVE};

  state.load.F[8] = 1.01;
  state.micro.sides = sides;
  state.micro.along = 4;
  if (interface == LAM_INTERFACE_CONTACT) state.load.cohesion = 0.005 / TISSUE_STRESS;
  return state;
}

static int SweepAll(void **state)
{
  const ContactState list[STATES] = {
      PatchState("bonded", 2, 2, 30, LAM_INTERFACE_BONDED, LAM_SIDES_AFFINE),
      PatchState("bonded, free sides", 2, 2, 0, LAM_INTERFACE_BONDED, LAM_SIDES_FREE),
      PatchState("contact, on a corner", 2, 3, 0, LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE),
      PatchState("contact, on an edge", 3, 2, 30, LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE),
      PatchState("contact, free sides", 2, 3, 30, LAM_INTERFACE_CONTACT, LAM_SIDES_FREE),
  };

  for (int s = 0; s < STATES; s++) {
    if (SweepContact(&list[s], &sweeps[s])) return 1;
    errors[s] = DerivativeError(&sweeps[s]);
  }
  return 0;
}

static void StatesConvergeInsideOneContactSet(void **state)
{
  for (int s = 0; s < STATES; s++) {
    assert_int_equal(sweeps[s].response.status, LAM_CONVERGED);
    assert_int_equal(sweeps[s].switches, 0);
  }
}

static void StressIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < STATES; s++) assert_near(errors[s].stress, 0.0, 1e-8);
}

static void LumenIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < STATES; s++) {
    assert_near(errors[s].turgor, 0.0, 1e-8);
    assert_near(errors[s].lumen, 0.0, 1e-8);
  }
}

static void OpeningIsDerivativeOfEnergy(void **state)
{
  for (int s = 0; s < STATES; s++) {
    assert_near(errors[s].cohesion, 0.0, 1e-8);
    assert_near(errors[s].opening, 0.0, 1e-8);
  }
}

static void TangentIsDerivativeOfStress(void **state)
{
  for (int s = 0; s < STATES; s++) assert_near(errors[s].tangent, 0.0, 1e-6);
}

static void CouplingsAreDerivativesOfStress(void **state)
{
  for (int s = 0; s < STATES; s++) {
    assert_near(errors[s].turgor_coupling, 0.0, 1e-6);
    assert_near(errors[s].cohesion_coupling, 0.0, 1e-6);
  }
}

static void SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes(void **state)
{
  for (int s = 0; s < STATES; s++) assert_near(errors[s].volumes, 0.0, 1e-6);
}

/* The moments of the forces on the held walls, x = F X, balance: P F^T is symmetric. */
static void MomentsOfTheBoundaryForcesBalance(void **state)
{
  for (int s = 0; s < STATES; s++) {
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
