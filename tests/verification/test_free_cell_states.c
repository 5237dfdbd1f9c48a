/* Cells that touch no one: states of the tissue itself against what is known of them. */
#include "support/rve_fixture.h"
#include "free_cell.h"

#define KNOTS 17
#define MPA (1.0 / TISSUE_STRESS)
#define COHESION (0.0025 * MPA)
#define SUCTION_MIN (0.005 * MPA)
#define SUCTION_MAX (0.06 * MPA)
#define SCALE (SUCTION_MAX / 32.0)

static LamRVE rve;
static LamFreeCell cell;

static LamFreeCell Make(LamRVE solved, const LamMicrostructure *micro, PetscInt n)
{
  OWNED(LamResponder, LamResponderDestroy) solver;
  LamFreeCell made;

  assert_int_equal(LamRVEResponderCreate(solved, 0, &solver), 0);
  assert_int_equal(LamFreeCellMake(micro, COHESION, SUCTION_MIN, SUCTION_MAX, SCALE, n, NULL, solver, &made), 0);
  return made;
}

static int SetUp(void **state)
{
  const LamMicrostructure micro = ContactTissue(6, 2);

  rve = NewRVE(&micro);
  cell = Make(rve, &micro, KNOTS);
  return cell.n == KNOTS ? 0 : -1;
}

static int TearDown(void **state)
{
  return LamFreeCellDestroy(&cell) || LamRVEDestroy(&rve);
}

/* F = U of lattice strains x along the directions at 0, 60 and 120 degrees: lambda_k^2 = n_k.C n_k; F upper triangular.
 */
static LamLoad LatticeLoad(const double x[3], double turgor, double cohesion)
{
  const double l0 = exp(2 * x[0]), l1 = exp(2 * x[1]), l2 = exp(2 * x[2]);
  const double C22 = (2 * (l1 + l2) - l0) / 3, C12 = (l1 - l2) / sqrt(3.0), F11 = sqrt(l0), F12 = C12 / F11;
  LamLoad load = PlaneLoad(F11, F12, 0, sqrt(C22 - F12 * F12), turgor);

  load.cohesion = cohesion;
  return load;
}

static LamResponse SolveApart(double x, double turgor, double cohesion)
{
  const LamResponse r = SolveFromReference(rve, LatticeLoad((double[3]){x, x, x}, turgor, cohesion));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_int_equal(r.floating_cells, 1);
  return r;
}

/* Phi at p and g. */
static double SolveEnergy(double turgor, double cohesion)
{
  const LamResponse r = SolveApart(0.35, turgor, cohesion);

  return r.energy - cohesion * r.load.F[0] * r.load.F[4];
}

/* States between the knots, at another spacing than the knots' own. A cell that touches no one may have turned a little
   on its way there, which changes its distances. */
TEST(WidthIsThatOfStatesBetweenTheKnots)
{
  for (int j = 0; j < KNOTS - 1; j += 5) {
    const double s = 0.5 * (cell.suction[j] + cell.suction[j + 1]);
    double a[3];

    LamFreeCellStrain(&cell, s, a);
    assert_near(a[0], log(exp(0.35) - 0.5 * SolveApart(0.35, s - COHESION, COHESION).min_gap), 1e-6);
  }
}

TEST(EnergyIsThatOfStatesBetweenTheKnots)
{
  for (int j = 0; j < KNOTS - 1; j += 5) {
    const double s = 0.5 * (cell.suction[j] + cell.suction[j + 1]), J = exp(0.7);
    const LamResponse r = SolveApart(0.35, s - COHESION, COHESION);
    double energy[3], turgor[2][3];

    LamFreeCellEnergy(&cell, 0, s, energy, turgor);
    assert_near(energy[0], r.energy - COHESION * J, 1e-9);
    assert_near(energy[1], r.energy_turgor, 1e-7);
    assert_near(energy[2], r.energy_turgor2, 1e-5);
    assert_near(turgor[0][0], r.energy_turgor - r.energy_cohesion + J, 1e-7);
    assert_near(turgor[1][0], r.energy_turgor2 - 2 * r.energy_turgor_cohesion + r.energy_cohesion2, 1e-7);
  }
}

TEST(SlopesAreDifferencesOfSolves)
{
  for (int j = 0; j < KNOTS; j += 8) {
    const double p = cell.suction[j] - COHESION, h = 1e-3;
    const double left = SolveEnergy(p - h, COHESION), at = SolveEnergy(p, COHESION),
                 right = SolveEnergy(p + h, COHESION);

    assert_near(cell.slope[j], (right - left) / (2 * h), 1e-5);
    assert_near(cell.curvature[j], (right - 2 * at + left) / (h * h), 1e-4);
  }
}

/* At fixed suction: what cohesion gives turgor takes. The second derivative is small; so is what differences tell. */
TEST(TurgorSlopesAreDifferencesAtFixedSuction)
{
  for (int j = 0; j < KNOTS; j += 8) {
    const double g = COHESION, p = cell.suction[j] - g, h = 0.02;
    const double left = SolveEnergy(p - h, g + h), at = SolveEnergy(p, g), right = SolveEnergy(p + h, g - h);

    assert_near(cell.turgor_slope[j], (right - left) / (2 * h), 1e-8);
    assert_near(cell.turgor_curvature[j], (right - 2 * at + left) / (h * h), 1e-6);
  }
}

/* A state in which direction k has strain a(s) + y, the others up to 0.1 more. */
static LamLoad RandomShape(uint64_t *seed, const LamFreeCell *free, int k, double y)
{
  const double s = RandomReal(seed, 0.01 * MPA, 0.05 * MPA);
  double a[3], x[3];

  LamFreeCellStrain(free, s, a);
  for (int i = 0; i < 3; i++) x[i] = a[0] + y + (i == k ? 0 : RandomReal(seed, 0.002, 0.1));
  return LatticeLoad(x, s - COHESION, COHESION);
}

TEST(CellsFloatAboveTheirWidthInEveryDirection)
{
  uint64_t seed = 1;

  for (int k = 0; k < 6; k++) {
    const LamResponse r = SolveFromReference(rve, RandomShape(&seed, &cell, k % 3, 1e-3));

    assert_int_equal(r.status, LAM_CONVERGED);
    assert_int_equal(r.floating_cells, 1);
  }
}

TEST(CellsTouchBelowTheirWidthInEveryDirection)
{
  uint64_t seed = 2;

  for (int k = 0; k < 6; k++) {
    const LamResponse r = SolveFromReference(rve, RandomShape(&seed, &cell, k % 3, -2e-3));

    assert_int_equal(r.status, LAM_CONVERGED);
    assert_int_equal(r.floating_cells, 0);
    assert_true(r.debonded_by_face[k % 3] < 1.0);
  }
}

/* P = g J F^-T. */
TEST(StressOfFloatingCellsIsThatOfTheCohesion)
{
  uint64_t seed = 3;

  for (int k = 0; k < 6; k++) {
    const LamLoad load = RandomShape(&seed, &cell, k % 3, 5e-3);
    const LamResponse r = SolveFromReference(rve, load);
    const double *F = load.F, cofactor[4] = {F[4], -F[3], -F[1], F[0]};
    static const int component[4] = {0, 1, 3, 4};

    for (int i = 0; i < 4; i++) assert_near(r.P[component[i]], COHESION * cofactor[i], 1e-9);
  }
}

/* Cells that lie apart are smaller: such a cell is that of the same shape that fills its place, scaled. */
TEST(CellsThatLieApartAreSmaller)
{
  LamMicrostructure apart = ContactTissue(6, 2), same = apart;
  LamFreeCell with, without;
  LamRVE solved, scaled;
  double outer;

  apart.clearance = 0.01;
  outer = 1.0 - 0.5 * apart.clearance;
  same.wall_thickness = apart.wall_thickness / outer;
  solved = NewRVE(&apart);
  scaled = NewRVE(&same);
  with = Make(solved, &apart, 5);
  without = Make(scaled, &same, 5);
  for (int j = 0; j < 5; j += 2) {
    assert_near(exp(with.strain[j]), outer * exp(without.strain[j]), 1e-6);
    for (int above = 0; above < 2; above++) {
      const double x = with.strain[j] + (above ? 1e-3 : -2e-3);
      const LamResponse r = SolveFromReference(
          solved, LatticeLoad((double[3]){x, x + 0.05, x + 0.05}, with.suction[j] - COHESION, COHESION));

      assert_int_equal(r.status, LAM_CONVERGED);
      assert_int_equal(r.floating_cells, above);
    }
  }
  LamFreeCellDestroy(&with);
  LamFreeCellDestroy(&without);
  assert_int_equal(LamRVEDestroy(&solved), 0);
  assert_int_equal(LamRVEDestroy(&scaled), 0);
}

TEST_GROUP(.petsc = 1, .setup = SetUp, .teardown = TearDown);
