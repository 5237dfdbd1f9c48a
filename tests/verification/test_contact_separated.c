/* Cells that nothing holds together: no stress, no stiffness, and a state that says so. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"

#define C1 (0.1 / TISSUE_STRESS)
#define APART 4

#define FAR 2 /* from here on also cells that cohesion swells are apart */

static const double apart[APART][4] = {
    {1.03, 0, 0, 1.03}, {1.05, 0.1, 0, 1.05}, {1.1, 0, 0, 1.1}, {1.15, 0.1, 0, 1.15}};

/* Free tissue moved apart; cohesion in MPa. */
static LamResponse SolveApart(int k, double cohesion)
{
  return SolveContactTissue(ContactLoad(apart[k][0], apart[k][1], apart[k][2], apart[k][3], 0, cohesion));
}

TEST(StateIsConvergedAndFloats)
{
  for (int k = 0; k < APART; k++) {
    const LamResponse r = SolveApart(k, 0.0);

    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.stable);
    assert_int_equal(r.floating_cells, 1);
  }
}

TEST(StressVanishes)
{
  for (int k = 0; k < APART; k++) {
    const LamResponse r = SolveApart(k, 0.0);

    for (int i = 0; i < 9; i++) assert_near(r.P[i], 0.0, 1e-8 * C1);
  }
}

TEST(StiffnessVanishes)
{
  for (int k = 0; k < APART; k++) {
    const LamResponse r = SolveApart(k, 0.0);

    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++)
        assert_near(r.tangent[9 * contact_components[i] + contact_components[j]], 0.0, 1e-8 * C1);
  }
}

/* Two separate rings too, each of which can move and spin on its own. */
TEST(EveryCellFloats)
{
  LamMicrostructure micro = ContactTissue(6, 2);
  LamResponse r;

  micro.cells[0] = 2;
  r = SolveTissue(&micro, ContactLoad(1.1, 0, 0, 1.1, 0, 0));
  assert_int_equal(r.status, LAM_CONVERGED);
  assert_int_equal(r.floating_cells, 2);
  assert_int_equal(r.cell_clusters, 2);
  for (int i = 0; i < 9; i++) assert_near(r.P[i], 0.0, 1e-8 * C1);
}

TEST(OpeningIsTheGrowthOfTheTissue)
{
  for (int k = 0; k < APART; k++) {
    const LamResponse r = SolveApart(k, 0.0);

    assert_near(r.opening_fraction, apart[k][0] * apart[k][3] - apart[k][1] * apart[k][2] - 1.0, 1e-8);
  }
}

/* Parallel faces: twice the apothem's growth, where cells keep their orientation. */
TEST(GapIsThatOfTheFaces)
{
  assert_near(SolveApart(0, 0.0).max_gap, 2.0 * (apart[0][0] - 1.0), 1e-3);
  assert_near(SolveApart(2, 0.0).max_gap, 2.0 * (apart[2][0] - 1.0), 1e-3);
}

/* Walls of a cell that bulges face each other at their middles, wherever the next cell is. */
TEST(SmallestGapGivesTheWidthOfTheCell)
{
  double width[3];

  for (int k = 0; k < 3; k++) {
    const double stretch = exp(0.2 + 0.3 * k);
    const LamResponse r = SolveContactTissue(ContactLoad(stretch, 0, 0, stretch, 0.03, 0.0025));

    assert_int_equal(r.floating_cells, 1);
    width[k] = 2.0 * stretch - r.min_gap;
    assert_near(width[k], width[0], 1e-7);
  }
  assert_true(width[0] > 2.2 && width[0] < 2.5);
}

TEST(SmallestGapIsZeroWhereWallsTouch)
{
  const LamResponse r = SolveContactTissue(ContactLoad(1.0, 0.3, 0, 1.0, 0, 0.0025));

  assert_true(r.open_fraction > 0.1 && r.debonded_fraction < 1.0);
  assert_true(r.min_gap == 0.0);
}

TEST(BondedTissueHasNoSmallestGap)
{
  const LamResponse r = SolveDefaultTissue(PlaneLoad(1.0, 0.1, 0, 1.0, 0.1));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_true(isnan(r.min_gap));
}

/* The middle lamella pulls with g on everything: P = g cof F in the plane. */
TEST(CohesionAloneIsAHydrostaticStress)
{
  for (int k = FAR; k < APART; k++) {
    const LamResponse r = SolveApart(k, 0.005);
    const double *F = r.load.F, cofactor[4] = {F[4], -F[3], -F[1], F[0]};

    assert_int_equal(r.status, LAM_CONVERGED);
    assert_int_equal(r.floating_cells, 1);
    for (int i = 0; i < 4; i++) assert_near(r.P[contact_components[i]], r.load.cohesion * cofactor[i], 1e-8 * C1);
  }
}

/* Free rings under suction are the same wherever they are. */
TEST(RingsApartDoNotFeelTheDistance)
{
  double ring[APART];

  for (int k = FAR; k < APART; k++) {
    const LamResponse r = SolveApart(k, 0.005);
    const double *F = r.load.F;

    ring[k] = r.energy - r.load.cohesion * (F[0] * F[4] - F[1] * F[3]);
    assert_near(ring[k], ring[FAR], 1e-9);
  }
}

/* What is not known is NaN by its meaning only: out-of-plane shear, the second mesh, the softest mode, the estimate. */
TEST(EverythingElseIsANumber)
{
  for (int k = 0; k < 2 * APART; k++) {
    const LamResponse r = SolveApart(k / 2, k % 2 ? 0.005 : 0.0);
    const double reals[] = {r.energy,         r.energy_turgor2,   r.energy_cohesion2,  r.energy_turgor_cohesion,
                            r.lumen_fraction, r.opening_fraction, r.debonded_fraction, r.open_fraction,
                            r.mean_gap,       r.max_gap,          r.min_gap,           r.max_penetration,
                            r.max_traction};

    for (size_t i = 0; i < sizeof(reals) / sizeof(reals[0]); i++) assert_true(isfinite(reals[i]));
    for (int i = 0; i < 3; i++) {
      assert_true(isfinite(r.mean_face_traction[i]) && isfinite(r.opening_by_face[i]));
      assert_true(isfinite(r.debonded_by_face[i]) && isfinite(r.open_by_face[i]) && isfinite(r.fabric[i]));
    }
    for (int i = 0; i < 9; i++) assert_true(isfinite(r.P[i]) && isfinite(r.P_turgor[i]) && isfinite(r.P_cohesion[i]));
    for (int i = 0; i < 5; i++)
      for (int j = 0; j < 5; j++) assert_true(isfinite(r.tangent[9 * contact_components[i] + contact_components[j]]));
  }
}
