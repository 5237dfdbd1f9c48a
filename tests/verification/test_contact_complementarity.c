/* Pressure only where cells touch, no tension, no overlap on average, and equilibrium. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

#define MESHES 3

static Complementarity results[PENETRATION_LOADS][MESHES];

static int SolveAll(void **state)
{
  static const int along[MESHES] = {6, 12, 24};

  for (int k = 0; k < PENETRATION_LOADS; k++)
    for (int m = 0; m < MESHES; m++) {
      const LamMicrostructure micro = ContactTissue(along[m], m == 0 ? 2 : 4);
      const LamLoad load = PenetrationLoad(k);

      if (ComputeComplementarity(&micro, &load, &results[k][m])) return 1;
      if (results[k][m].response.status != LAM_CONVERGED) return 1;
    }
  return 0;
}

static void AssertNone(size_t offset)
{
  for (int k = 0; k < PENETRATION_LOADS; k++)
    for (int m = 0; m < MESHES; m++) assert_near(*(const double *)((const char *)&results[k][m] + offset), 0.0, 1e-9);
}

TEST_IS(PressureTimesGapVanishes, AssertNone(offsetof(Complementarity, product)));
TEST_IS(NoHatPulls, AssertNone(offsetof(Complementarity, tension)));
TEST_IS(NoHatOverlaps, AssertNone(offsetof(Complementarity, overlap)));

/* From one mesh to the next it may rise a little: there are discrete solutions that differ in hats at junctions. */
TEST(PointwisePenetrationFallsWithTheMesh)
{
  for (int k = 0; k < MODERATE_LOADS; k++)
    for (int m = 1; m < MESHES; m++)
      assert_true(results[k][m].response.max_penetration < 0.6 * results[k][0].response.max_penetration);
}

/* Where a sharp corner presses into a wall, pressure and penetration are singular: they stay small. */
TEST(PenetrationAtPressingCornersStaysSmall)
{
  for (int k = MODERATE_LOADS; k < PENETRATION_LOADS; k++)
    for (int m = 0; m < MESHES; m++) assert_true(results[k][m].response.max_penetration < 5e-3);
}

/* Where fields are given, also those of an unstable state, they are of an equilibrium at the load that was asked. */
TEST(AnswersAreEquilibria)
{
  const LamLoad loads[] = {ContactLoad(1.1, 0, 0, 1.1, 0, 0.005), ContactLoad(1.07, 0, 0, 1.07, 0, 0.005),
                           ContactLoad(1, 0.1, 0, 1, 0, 0), ContactLoad(0.97, 0, 0, 1.1, 0, 0)};
  LamMicrostructure micro = ContactTissue(6, 2);

  micro.cells[0] = 2;
  for (size_t k = 0; k < sizeof(loads) / sizeof(loads[0]); k++) {
    Complementarity result;

    assert_int_equal(ComputeComplementarity(&micro, &loads[k], &result), 0);
    assert_true(result.residual < 10.0);
  }
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
