/* Localisation of tissue and kinks of walls, against long waves of rows of cells, exact cases and finer meshes. */
#include "support/rve_fixture.h"
#include "support/localisation.h"

/* The hexagonal cell is isotropic at F = I: every band resists with its shear modulus. */
TEST(UndeformedTissueHasItsShearModulus)
{
  const LamResponse r = SolveDefaultTissue(PlaneLoad(1, 0, 0, 1, 0));

  assert_near(r.ellipticity, r.tangent[9 * 1 + 1], 1e-9);
  assert_near(r.localisation_normal[0], 1, 1e-6);
  assert_near(r.localisation_mode[1], 1, 1e-6);
  assert_near(r.wall_ellipticity, 1, 1e-9); /* C1 + C2 */
  assert_near(r.kinked_fraction, 0, 0);
}

/* Psi and Phi = Psi + p J: at fixed walls turgor adds -p J, which no band feels. */
TEST(TurgorMovesNoBand)
{
  LamMicrostructure micro = DefaultTissue();
  LamResponse dry, turgid;

  micro.wall.bulk_modulus = 1e5;
  dry = SolveTissue(&micro, PlaneLoad(1.05, 0.1, 0, 0.98, 0));
  turgid = SolveTissue(&micro, PlaneLoad(1.05, 0.1, 0, 0.98, 0.3));
  assert_true(fabs(turgid.tangent[4] - dry.tangent[4]) > 0.25); /* A1122 */
  assert_near(turgid.ellipticity, dry.ellipticity, 1e-4 * dry.ellipticity);
  assert_near(LamBandAngle(turgid.localisation_normal), LamBandAngle(dry.localisation_normal), 0.01);
  assert_near(turgid.kinked_fraction, dry.kinked_fraction, 0);
}

TEST(TurningTheTissueTurnsTheMode)
{
  const double c = cos(0.4), s = sin(0.4);
  const LamResponse a = SolveDefaultTissue(PlaneLoad(1.05, 0.1, 0, 0.98, 0));
  const LamResponse b = SolveDefaultTissue(PlaneLoad(1.05 * c, 0.1 * c - 0.98 * s, 1.05 * s, 0.1 * s + 0.98 * c, 0));
  double turn = LamBandAngle(b.localisation_mode) - LamBandAngle(a.localisation_mode) - 0.4 * 180 / M_PI;

  turn -= 180 * floor(turn / 180 + 0.5);
  assert_near(b.ellipticity, a.ellipticity, 1e-8);
  assert_near(LamBandAngle(b.localisation_normal), LamBandAngle(a.localisation_normal), 1e-4);
  assert_near(turn, 0, 1e-4);
  assert_near(b.wall_ellipticity, a.wall_ellipticity, 1e-8);
}

/* Waves of n cells lose stability at a strain that rises with n to that at which the tangent loses ellipticity, with an
   error of 1/n^2; the waves run along the normal of the band. */
TEST(LongWavesAreLostWhereTheTangentIs)
{
  static const int n[] = {3, 4, 6};
  LamMicrostructure micro = DefaultTissue();
  double wave[3], lost = 0, normal = 0, limit;

  micro.along = 4;
  micro.through = 1;
  assert_int_equal(EllipticityOnset(&micro, 1e-5, &lost, &normal), 0);
  assert_near(normal, 90, 1e-3);
  for (int k = 0; k < 3; k++) assert_int_equal(LongestWaveOnset(&micro, n[k], 1e-5, &wave[k]), 0);
  assert_true(wave[0] < wave[1] && wave[1] < wave[2] && wave[2] < lost);
  limit = LongWaveLimit(n, wave);
  assert_near(limit, lost, 0.01 * lost);
}

/* Biaxially, patterns of two cells come first (0.0114), then the tangent, then one cell (0.0227). */
TEST(LocalisationIsBetweenTheBucklingOfTwoCellsAndOfOne)
{
  assert_true(SolveDefaultTissue(PlaneLoad(1 - 0.0114, 0, 0, 1 - 0.0114, 0)).ellipticity > 0);
  assert_true(SolveDefaultTissue(PlaneLoad(1 - 0.0226, 0, 0, 1 - 0.0226, 0)).ellipticity < 0);
}

TEST(LossOfEllipticityIsNoInstabilityOfTheCell)
{
  const LamResponse r = SolveDefaultTissue(PlaneLoad(0.98, 0, 0, 0.98, 0));

  assert_true(LamEllipticityIsLost(r.ellipticity));
  assert_int_equal(r.status, LAM_CONVERGED);
  assert_true(r.stable);
}

/* Short of kinks the smallest mean stiffness of the walls hardly depends on the mesh, and next to nothing has kinked.
 */
TEST(StiffnessOfWallsConverges)
{
  LamMicrostructure micro = DefaultTissue();
  const LamResponse coarse = SolveTissue(&micro, PlaneLoad(1, 0.3, 0, 1, 0));
  LamResponse fine;

  micro.along = 12;
  micro.through = 4;
  fine = SolveTissue(&micro, PlaneLoad(1, 0.3, 0, 1, 0));
  assert_near(coarse.wall_ellipticity, fine.wall_ellipticity, 0.005 * fine.wall_ellipticity);
  assert_true(coarse.kinked_fraction < 0.002 && fine.kinked_fraction < 0.002);
}

/* Sheared by 0.5 the walls kink, and their stress differs from mesh to mesh; with fibres in tension alone nothing does.
 */
TEST(ShearedWallsKinkUnlessTheirFibresGoSlack)
{
  LamMicrostructure micro = DefaultTissue();

  assert_true(SolveTissue(&micro, PlaneLoad(1, 0.5, 0, 1, 0)).kinked_fraction > LAM_KINKED_SHARE);
  micro.wall.fibres = LAM_FIBRES_TENSION;
  assert_near(SolveTissue(&micro, PlaneLoad(1, 0.5, 0, 1, 0)).kinked_fraction, 0, 0);
}
