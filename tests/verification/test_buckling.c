/* Tissue buckles under biaxial compression; the buckled state is found and followed. */
#include "rve_fixture.h"
#include "assert_near.h"
#include "figures_buckling.h"

#define BEYOND 0.03 /* strain past the onset */

static LamRVE CellsRVE(int n)
{
  LamMicrostructure micro = DefaultTissue();

  micro.cells[0] = micro.cells[1] = n;
  return NewRVE(&micro);
}

static void AssertOnset(int cells, double turgor, double expected, double tolerance)
{
  LamRVE rve = CellsRVE(cells);
  double low = 0.002, high = 0.03, energy;
  PetscInt negative[2];

  assert_int_equal(BucklingOnset(rve, turgor, 1e-4, &low, &high), 0);
  assert_int_equal(SymmetricSolution(rve, low, turgor, &energy, &negative[0]), 0);
  assert_int_equal(SymmetricSolution(rve, high, turgor, &energy, &negative[1]), 0);
  assert_int_equal(negative[0], 0);
  assert_true(negative[1] > 0);
  assert_near(0.5 * (low + high), expected, tolerance);
  assert_int_equal(LamRVEDestroy(&rve), 0);
}

static void OneCellBucklesAtTwoPercent(void **state)
{
  AssertOnset(1, 0.0, 0.0227, 2e-4);
}

/* A pattern of two cells needs half the strain. */
static void FourCellsBuckleAtHalfThatStrain(void **state)
{
  AssertOnset(2, 0.0, 0.0114, 2e-4);
}

/* Past the onset the answer is stable and has less energy than the symmetric solution. */
static void BuckledStateHasLessEnergy(void **state)
{
  for (int cells = 1; cells < 3; cells++) {
    LamRVE rve = CellsRVE(cells);
    const LamResponse r = SolveFromReference(rve, PlaneLoad(1 - BEYOND, 0, 0, 1 - BEYOND, 0));
    double symmetric;
    PetscInt negative;

    assert_int_equal(SymmetricSolution(rve, BEYOND, 0.0, &symmetric, &negative), 0);
    assert_true(negative > 0);
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.stable);
    assert_int_equal(r.negative_eigenvalues, 0);
    assert_true(r.energy < 0.98 * symmetric);
    assert_int_equal(LamRVEDestroy(&rve), 0);
  }
}

/* Loaded step by step past the onset the stress hardly grows (before: by 0.0078 a step), and the energy gained is the
   work of the stress. */
static void BuckledBranchIsFollowed(void **state)
{
  const double step = 0.002;
  LamRVE rve = CellsRVE(1);
  LamRVEState point;
  LamResponse now, before;
  double first = 0.0, work = 0.0;

  assert_int_equal(LamRVEStateCreate(rve, &point), 0);
  for (int k = 0; k <= 5; k++) {
    const double stretch = 0.976 - step * k;
    const LamLoad load = PlaneLoad(stretch, 0, 0, stretch, 0);

    if (k > 0) before = now;
    assert_int_equal(LamRVESolve(rve, &load, point, &now), 0);
    assert_int_equal(now.status, LAM_CONVERGED);
    if (k == 0) {
      first = now.energy;
      continue;
    }
    work -= 0.5 * step * (now.P[0] + now.P[4] + before.P[0] + before.P[4]);
    assert_true(fabs(now.P[0] - before.P[0]) < 0.05 * 0.0078);
  }
  assert_near(now.energy - first, work, 1e-6);
  assert_int_equal(LamRVEStateDestroy(&point), 0);
  assert_int_equal(LamRVEDestroy(&rve), 0);
}

/* At prescribed F turgor does not hold buckling back: in bonded tissue it only adds -p J F^-T (effective stress). */
static void TurgorDoesNotMoveTheOnset(void **state)
{
  AssertOnset(1, 0.02 / TISSUE_STRESS, 0.0227, 3e-4);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(OneCellBucklesAtTwoPercent), cmocka_unit_test(FourCellsBuckleAtHalfThatStrain),
      cmocka_unit_test(BuckledStateHasLessEnergy),  cmocka_unit_test(BuckledBranchIsFollowed),
      cmocka_unit_test(TurgorDoesNotMoveTheOnset),
  };
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
