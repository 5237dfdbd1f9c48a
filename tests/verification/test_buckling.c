/* Tissue buckles under biaxial compression; the buckled state is found and followed. */
#include "support/rve_fixture.h"
#include "support/buckling.h"

#define BEYOND 0.03 /* strain past the onset */

static LamRVE CellsRVE(int n)
{
  LamMicrostructure micro = DefaultTissue();

  micro.cells[0] = micro.cells[1] = n;
  return NewRVE(&micro);
}

static void AssertOnset(int cells, double turgor, double expected, double tolerance)
{
  OWNED(LamRVE, LamRVEDestroy) rve = CellsRVE(cells);
  double low = 0.002, high = 0.03, energy;
  PetscInt negative[2];

  assert_int_equal(BucklingOnset(rve, turgor, 1e-4, &low, &high), 0);
  assert_int_equal(SymmetricSolution(rve, low, turgor, &energy, &negative[0]), 0);
  assert_int_equal(SymmetricSolution(rve, high, turgor, &energy, &negative[1]), 0);
  assert_int_equal(negative[0], 0);
  assert_true(negative[1] > 0);
  assert_near(0.5 * (low + high), expected, tolerance);
}

TEST_IS(OneCellBucklesAtTwoPercent, AssertOnset(1, 0.0, 0.0227, 2e-4));

/* A pattern of two cells needs half the strain. */
TEST_IS(FourCellsBuckleAtHalfThatStrain, AssertOnset(2, 0.0, 0.0114, 2e-4));

/* Past the onset the answer is stable and has less energy than the symmetric solution. */
TEST(BuckledStateHasLessEnergy)
{
  for (int cells = 1; cells < 3; cells++) {
    OWNED(LamRVE, LamRVEDestroy) rve = CellsRVE(cells);
    const LamResponse r = SolveFromReference(rve, PlaneLoad(1 - BEYOND, 0, 0, 1 - BEYOND, 0));
    double symmetric;
    PetscInt negative;

    assert_int_equal(SymmetricSolution(rve, BEYOND, 0.0, &symmetric, &negative), 0);
    assert_true(negative > 0);
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.stable);
    assert_int_equal(r.negative_eigenvalues, 0);
    assert_true(r.energy < 0.98 * symmetric);
  }
}

/* Loaded step by step past the onset the stress hardly grows (before: by 0.0078 a step), and the energy gained is the
   work of the stress. */
TEST(BuckledBranchIsFollowed)
{
  const double step = 0.002;
  OWNED(LamRVE, LamRVEDestroy) rve = CellsRVE(1);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse now, before;
  double first = 0.0, work = 0.0;

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
}

/* At prescribed F turgor does not hold buckling back: in bonded tissue it only adds -p J F^-T (effective stress). */
TEST_IS(TurgorDoesNotMoveTheOnset, AssertOnset(1, 0.02 / TISSUE_STRESS, 0.0227, 3e-4));

/* Largest difference of the four cells under biaxial compression. */
static double CellDifference(double strain)
{
  const LamLoad load = PlaneLoad(1 - strain, 0, 0, 1 - strain, 0);
  OWNED(LamRVE, LamRVEDestroy) rve = CellsRVE(2);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  LamResponse r;
  double difference;

  assert_int_equal(LamRVESolve(rve, &load, at, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
  assert_int_equal(LamRVEGetCellDifference(rve, at, &difference), 0);
  return difference;
}

TEST(CellsDifferOnceTheyHaveBuckledInALongerPattern)
{
  assert_near(CellDifference(0.01), 0.0, 1e-9);
  assert_true(CellDifference(0.02) > 0.05);
}

static double Energy(LamRVE rve, const LamLoad *load, const double y[])
{
  double energy;
  PetscBool valid;

  assert_int_equal(LamAssembleEnergy(rve, load, y, &energy, &valid), 0);
  assert_true(valid);
  return energy;
}

/* The mode of a state as a motion of the classes of nodes. */
static void GetMode(LamRVE rve, LamRVEState at, double *eigenvalue, double motion[])
{
  double *mode = calloc((size_t)(2 * rve->mesh.node_count), sizeof(*mode));

  assert_int_equal(LamRVEGetSoftestMode(rve, at, eigenvalue, mode), 0);
  for (int i = 0; i < 2 * rve->mesh.node_count; i++) motion[2 * rve->mesh.node_class[i / 2] + i % 2] = mode[i];
  free(mode);
}

/* d2 Pi(y + s m)/ds2 = eigenvalue m.m along the mode m of an unstable state. */
TEST(EnergyFallsAlongTheModeOfAnUnstableState)
{
  const LamLoad load = PlaneLoad(1 - BEYOND, 0, 0, 1 - BEYOND, 0);
  const double h = 1e-4;
  OWNED(LamRVE, LamRVEDestroy) rve = CellsRVE(1);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  double *mode = calloc((size_t)rve->ndof, sizeof(*mode)), *y = calloc((size_t)rve->ndof, sizeof(*y));
  double eigenvalue, square = 0, second = 0;
  PetscBool ok;

  assert_int_equal(SolveSymmetric(rve, &load, &ok), 0);
  assert_true(ok);
  LamKeepState(rve, &load, 0, at);
  GetMode(rve, at, &eigenvalue, mode);
  for (int i = 0; i < rve->ndof; i++) square += mode[i] * mode[i];
  for (int side = -1; side <= 1; side++) {
    for (int i = 0; i < rve->ndof; i++) y[i] = at->y[i] + side * h * mode[i];
    second += (side ? 1 : -2) * Energy(rve, &load, y) / (h * h);
  }
  assert_true(eigenvalue < 0);
  assert_near(second / (eigenvalue * square), 1.0, 1e-3);
  free(mode);
  free(y);
}
