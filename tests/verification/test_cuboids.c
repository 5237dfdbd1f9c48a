/* Two cuboids in contact under generalised shear (Mihai, Safar & Wyatt, Section 4.1). */
#include "support/rve_fixture.h"
#include "support/cuboids.h"

#define SHEAR 0.5
#define N 12
#define FINE 16
#define PRESSURES 5

static const double pressures[PRESSURES] = {0.0, 0.01, 0.02, 0.05, 0.1}; /* MPa */
static CuboidsProfile unequal[PRESSURES];

static CuboidsProfile Profile(CuboidsSetup setup)
{
  CuboidsProfile profile;
  OWNED(Cuboids, CuboidsDestroy) cuboids;

  assert_int_equal(CuboidsCompute(&setup, &cuboids, &profile), 0);
  return profile;
}

static int Solve(void **state)
{
  for (int k = 0; k < PRESSURES; k++) unequal[k] = Profile(CuboidsUnequal(N, SHEAR, pressures[k]));
  return 0;
}

TEST(LargestGapIsConvergedTo2PerCent)
{
  const CuboidsProfile fine = Profile(CuboidsUnequal(FINE, SHEAR, pressures[1]));

  assert_near(unequal[1].largest / fine.largest, 1.0, 0.02);
}

TEST(GapOpensWhereFibresAreOfUnequalStiffness)
{
  const CuboidsProfile equal = Profile(CuboidsDefault(N, SHEAR, 0.0));

  assert_true(unequal[0].largest > 5.0 * equal.largest);
  assert_true(unequal[0].apart > 0.3);
}

TEST(PressureClosesTheGap)
{
  for (int k = 1; k < PRESSURES; k++) assert_true(unequal[k].area < unequal[k - 1].area);
  assert_true(unequal[PRESSURES - 1].largest < 0.02 * unequal[0].largest);
}

/* Turning the blocks upside down turns the sign of the shear. */
TEST(OppositeShearTurnsTheGapUpsideDown)
{
  const CuboidsProfile opposite = Profile(CuboidsUnequal(N, -SHEAR, pressures[1]));

  for (int k = 0; k < CUBOIDS_SAMPLES; k++) assert_near(opposite.gap[CUBOIDS_SAMPLES - 1 - k], unequal[1].gap[k], 1e-8);
}

/* Mirrored from left to right, the other body is the slave. */
TEST(ChoiceOfTheSlaveDoesNotMatter)
{
  CuboidsSetup setup = CuboidsUnequal(N, -SHEAR, 0.0);
  const LamWall left = setup.wall[0];
  CuboidsProfile mirrored;

  setup.wall[0] = setup.wall[1];
  setup.wall[1] = left;
  mirrored = Profile(setup);
  assert_near(mirrored.largest / unequal[0].largest, 1.0, 0.02);
  assert_near(mirrored.area / unequal[0].area, 1.0, 0.02);
}

/* Grips, pressure on the outer side and the pressure that the contact gives to the left body. */
TEST(ForcesBalanceAcrossTheInterface)
{
  CuboidsSetup setup = CuboidsUnequal(N, SHEAR, 0.02);
  CuboidsProfile profile;
  OWNED(Cuboids, CuboidsDestroy) cuboids;
  double left[2], right[2], contact[2];

  assert_int_equal(CuboidsCompute(&setup, &cuboids, &profile), 0);
  assert_int_equal(CuboidsGripForce(&cuboids, 0, left), 0);
  assert_int_equal(CuboidsGripForce(&cuboids, 1, right), 0);
  CuboidsContactForce(&cuboids, contact);
  for (int d = 0; d < 2; d++) assert_near(left[d] + right[d], 0.0, 1e-8);
  assert_near(left[0] + contact[0] + setup.pressure, 0.0, 0.01 * setup.pressure);
  assert_near(left[1] + contact[1] - setup.pressure * SHEAR, 0.0, 0.01 * setup.pressure);
}

/* Up to pressure over bulk modulus, here a tenth of the default. */
TEST(CohesionActsAsPressure)
{
  CuboidsSetup setup = CuboidsUnequal(N, SHEAR, pressures[2]);
  CuboidsProfile pressed, held;

  setup.wall[0].bulk_modulus = setup.wall[1].bulk_modulus = 1e4;
  pressed = Profile(setup);
  setup.cohesion = setup.pressure;
  setup.pressure = 0.0;
  held = Profile(setup);
  assert_near(CuboidsGapError(&held, &pressed), 0.0, 4e-3);
}

/* Faces without traction let the blocks thin along X3 and press on each other. */
TEST(FreedomAlongX3ClosesTheGap)
{
  CuboidsSetup setup = CuboidsUnequal(N, 0.2, 0.0);
  CuboidsProfile strain = Profile(setup), stress;

  setup.plane_stress = PETSC_TRUE;
  stress = Profile(setup);
  assert_true(stress.largest < 0.1 * strain.largest);
}

TEST_GROUP(.petsc = 1, .setup = Solve);
