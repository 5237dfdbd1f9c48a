/* Everything a response holds is a derivative of its energy: finite differences at random states, F33 != 1 among them.
 */
#include "support/test.h"
#include "support/rve_fixture.h"
#include "support/derivative_checks.h"

#define STATES 6

static Sweep sweeps[STATES];

static int SolveAll(void **state)
{
  for (int s = 0; s < STATES; s++) {
    uint64_t seed = (uint64_t)(100 + s);
    LamMicrostructure micro = RandomTissue(&seed);
    const LamLoad load = RandomLoad(&seed);

    if (s == 0) {
      micro.wall.law = LAM_WALL_FIBRE_EXPONENTIAL;
      micro.wall.k1 = 0.5 * micro.wall.C4;
      micro.wall.k2 = 3.0;
      micro.wall.dispersion = 0.1;
      micro.wall.C4 = 0.0;
    }
    if (s == STATES - 1) micro.wall.law = LAM_WALL_MOONEY_RIVLIN;
    if (s == STATES - 2) micro.cells[0] = 2;
    if (SweepLoads(&micro, &load, &sweeps[s])) return 1;
    if (sweeps[s].response.status != LAM_CONVERGED) return 1;
  }
  return 0;
}

TEST(StressIsDerivativeOfEnergy)
{
  for (int s = 0; s < STATES; s++)
    for (int c = 0; c < 5; c++)
      assert_near(sweeps[s].response.P[sweep_columns[c]], sweeps[s].energy[sweep_columns[c]], 1e-8);
}

TEST(LumenIsDerivativeOfEnergy)
{
  for (int s = 0; s < STATES; s++)
    assert_near(-sweeps[s].response.lumen_fraction, sweeps[s].energy[SWEEP_TURGOR], 1e-8);
}

TEST(TangentIsDerivativeOfStress)
{
  for (int s = 0; s < STATES; s++) {
    const LamResponse *r = &sweeps[s].response;
    double largest = 0.0;

    for (int k = 0; k < 5; k++) largest = fmax(largest, r->tangent[10 * sweep_columns[k]]);
    for (int i = 0; i < 5; i++)
      for (int k = 0; k < 5; k++) {
        const int row = sweep_columns[i], column = sweep_columns[k];

        assert_near(r->tangent[9 * row + column], sweeps[s].P[column][row], 1e-7 * largest);
      }
  }
}

TEST(TangentHasMajorSymmetry)
{
  for (int s = 0; s < STATES; s++)
    for (int i = 0; i < 5; i++)
      for (int k = 0; k < 5; k++) {
        const int a = sweep_columns[i], b = sweep_columns[k];

        assert_near(sweeps[s].response.tangent[9 * a + b], sweeps[s].response.tangent[9 * b + a], 1e-10);
      }
}

TEST(TurgorCouplingIsDerivativeOfStress)
{
  for (int s = 0; s < STATES; s++)
    for (int i = 0; i < 5; i++)
      assert_near(sweeps[s].response.P_turgor[sweep_columns[i]], sweeps[s].P[SWEEP_TURGOR][sweep_columns[i]], 1e-7);
}

TEST(TurgorCouplingIsDerivativeOfLumen)
{
  for (int s = 0; s < STATES; s++)
    for (int i = 0; i < 5; i++)
      assert_near(sweeps[s].response.P_turgor[sweep_columns[i]], -sweeps[s].lumen[sweep_columns[i]], 1e-7);
}

TEST(SecondTurgorDerivativeIsThatOfLumen)
{
  for (int s = 0; s < STATES; s++) assert_near(sweeps[s].response.energy_turgor2, -sweeps[s].lumen[SWEEP_TURGOR], 1e-7);
}

/* What plane strain cannot know is not a number, never zero. */
TEST(OutOfPlaneShearTangentIsUnknown)
{
  static const int unknown[4] = {2, 5, 6, 7};

  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 9; k++) {
      assert_true(isnan(sweeps[0].response.tangent[9 * unknown[i] + k]));
      assert_true(isnan(sweeps[0].response.tangent[9 * k + unknown[i]]));
    }
}

/* At F = I under turgor walls and fluid carry the same pressure: P = -p 1 up to the walls' compressibility p/kappa. */
TEST(PressureFillsTheTissueAsBulkModulusGrows)
{
  const double p = 0.02 / TISSUE_STRESS;
  double previous = 1.0;

  for (double kappa = 1e3; kappa < 2e6; kappa *= 10.0) {
    LamMicrostructure micro = DefaultTissue();
    LamResponse response;
    double error = 0.0;

    micro.wall.bulk_modulus = kappa;
    response = SolveTissue(&micro, PlaneLoad(1, 0, 0, 1, p));
    for (int i = 0; i < 9; i += 4) error = fmax(error, fabs(response.P[i] + p));
    assert_true(error < p * 100.0 * p / kappa);
    assert_true(error < 0.2 * previous);
    previous = error;
  }
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
