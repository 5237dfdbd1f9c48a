/*
  Tension of the walls against statics. At F = lambda 1 the line along a face normal through the centre of a cell is a
  line of symmetry: it stays straight and bears no shear. It cuts two walls of current thickness h each across and the
  lumen between, in all 2 lambda (F33 = 1), so with the macroscopic Cauchy stress Sigma
    2 lambda Sigma = 2 h sigma - p (2 lambda - 2 h),      T h = lambda (Sigma + p),      T = sigma + p
  sigma the mean stress along the wall there, where it is largest, but for the corners, and uniform; T is the tension.
  At Sigma = 0 the double wall's 2 T h is sqrt(3) p l, l = 2 lambda/sqrt(3) the length of a face.
*/
#include "support/rve_fixture.h"

#define ALONG 16 /* even: the middle of a face is a node */

static LamMicrostructure Thin(double thickness)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall_thickness = thickness;
  micro.along = ALONG;
  return micro;
}

/* Distance of the inner from the outer node in the middle of face 0. */
static double MiddleThickness(LamRVE rve, LamRVEState state)
{
  const PetscInt radial = 2 * 2 + 1; /* nodes through two elements */
  PetscReal *x;
  LamRVEMesh mesh;
  double h;

  assert_int_equal(LamRVEGetMesh(rve, &mesh), 0);
  assert_int_equal(PetscMalloc1(2 * mesh.node_count, &x), 0);
  assert_int_equal(LamRVEGetFields(rve, state, x, NULL, NULL), 0);
  {
    const PetscReal *inner = &x[2 * radial * ALONG], *outer = &x[2 * (radial * ALONG + radial - 1)];

    h = hypot(outer[0] - inner[0], outer[1] - inner[1]);
  }
  assert_int_equal(PetscFree(x), 0);
  return h;
}

/* T h over lambda (Sigma + p). */
static double OverStatics(double thickness, double stretch, double turgor)
{
  const LamMicrostructure micro = Thin(thickness);
  const LamLoad load = PlaneLoad(stretch, 0, 0, stretch, turgor);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);
  LamResponse r;
  double h;

  assert_int_equal(LamRVESolve(rve, &load, state, &r), 0);
  h = MiddleThickness(rve, state);
  return r.max_wall_tension * h / (stretch * (r.P[0] / stretch + turgor));
}

TEST(LargestTensionIsThatOfTheCut)
{
  static const double thickness[3] = {0.15, 0.08, 0.04}, stretch[2] = {1.03, 1.1}, turgor[2] = {0.0, 0.2};

  for (int t = 0; t < 3; t++)
    for (int s = 0; s < 2; s++)
      for (int p = 0; p < 2; p++) assert_near(OverStatics(thickness[t], stretch[s], turgor[p]), 1.0, 0.004);
}

/* The turgor that leaves no total stress at this stretch: P = P0 - p J F^-T but for the walls' compressibility. */
TEST(FreeTissueHasTheTensionOfTheHexagon)
{
  const double stretch = 1.04;
  const LamMicrostructure micro = Thin(0.05);
  LamLoad load = PlaneLoad(stretch, 0, 0, stretch, 0);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse r;
  double tension;

  for (int k = 0; k < 3; k++) {
    assert_int_equal(LamRVESolve(rve, &load, point, &r), 0);
    load.turgor += r.P[0] / stretch;
  }
  assert_near(r.P[0], 0.0, 1e-6 * r.load.turgor);
  tension = 2 * r.max_wall_tension * MiddleThickness(rve, point);
  assert_near(tension / (sqrt(3.0) * r.load.turgor * (2 * stretch / sqrt(3.0))), 1.0, 0.003);
}

/* Bonded walls do not feel turgor at a given F, but for the pressure that they stand in, to O(p/kappa). */
TEST(TurgorLeavesTheTensionAsItIs)
{
  const LamResponse dry = SolveDefaultTissue(PlaneLoad(1.05, 0.1, 0, 1, 0));
  const LamResponse turgid = SolveDefaultTissue(PlaneLoad(1.05, 0.1, 0, 1, 0.2));

  assert_near(turgid.max_wall_tension, dry.max_wall_tension, 2e-3);
  for (int k = 0; k < 3; k++) assert_near(turgid.mean_wall_tension[k], dry.mean_wall_tension[k], 2e-3);
  assert_near(turgid.max_fibre_stretch, dry.max_fibre_stretch, 2e-4);
}

/* At F = I the walls, held along themselves, are pressed thinner by p/kappa; a uniaxial strain e, with the shear
   modulus 2 (C1 + C2), leaves stresses that differ by 4 (C1 + C2) e: T = 4 p/kappa, but for the corners. */
TEST(ConfinedTissueHasNoTension)
{
  const double turgor = 0.5;

  for (double kappa = 1e3; kappa < 2e4; kappa *= 10) {
    LamMicrostructure micro = DefaultTissue();

    micro.wall.bulk_modulus = kappa;
    assert_near(SolveTissue(&micro, PlaneLoad(1, 0, 0, 1, turgor)).max_wall_tension * kappa / (4 * turgor), 1.0, 0.04);
  }
}

/* The fluid that a wall stands in is that of its own cell. */
TEST(TensionIsAgainstTheFluidOfTheCell)
{
  LamMicrostructure micro = DefaultTissue();
  const LamResponse alike = SolveTissue(&micro, PlaneLoad(1.05, 0.1, 0, 1, 0.2));
  LamCell cell = {.wall_thickness = micro.wall_thickness, .wall = micro.wall, .turgor = 2, .cohesion = 1};
  LamResponse twice;

  micro.cell = &cell;
  twice = SolveTissue(&micro, PlaneLoad(1.05, 0.1, 0, 1, 0.1));
  assert_near(twice.max_wall_tension, alike.max_wall_tension, 1e-9);
  for (int k = 0; k < 3; k++) assert_near(twice.mean_wall_tension[k], alike.mean_wall_tension[k], 1e-9);
}

/* Means over windows: not those at points, which diverge at the corners. */
TEST(MeasuresConverge)
{
  static const int mesh[2][2] = {{12, 2}, {24, 4}};
  LamResponse r[2];

  for (int m = 0; m < 2; m++) {
    LamMicrostructure micro = DefaultTissue();

    micro.along = mesh[m][0];
    micro.through = mesh[m][1];
    r[m] = SolveTissue(&micro, PlaneLoad(1, 0.2, 0, 1, 0.2));
  }
  assert_near(r[0].max_wall_tension, r[1].max_wall_tension, 0.02 * r[1].max_wall_tension);
  assert_near(r[0].max_lamella_shear, r[1].max_lamella_shear, 0.02 * r[1].max_lamella_shear);
  assert_near(r[0].max_wall_energy, r[1].max_wall_energy, 0.02 * r[1].max_wall_energy);
  assert_near(r[0].max_fibre_stretch - 1, r[1].max_fibre_stretch - 1, 0.02 * (r[1].max_fibre_stretch - 1));
}

/* F = diag: the lamella of face 0 bears no shear by symmetry; that of a bonded honeycomb under equal stretch none at
   all. */
TEST(NoShearWhereSymmetryForbidsIt)
{
  const LamResponse equal = SolveDefaultTissue(PlaneLoad(1.05, 0, 0, 1.05, 0.2));
  const LamResponse pulled = SolveDefaultTissue(PlaneLoad(1.1, 0, 0, 0.95, 0.2));

  assert_near(equal.max_lamella_shear, 0.0, 1e-9);
  assert_true(pulled.max_lamella_shear > 0.05 && pulled.shear_place[1] > 0);
}

/* Another sign of shear is a mirror image: faces 1 and 2 change places, and run the other way. */
TEST(PlacesFollowTheMirror)
{
  const LamResponse a = SolveDefaultTissue(PlaneLoad(1.05, 0.1, 0, 1, 0.2));
  const LamResponse b = SolveDefaultTissue(PlaneLoad(1.05, -0.1, 0, 1, 0.2));

  assert_near(b.max_wall_tension, a.max_wall_tension, 1e-9);
  assert_near(b.max_lamella_shear, a.max_lamella_shear, 1e-9);
  for (int k = 0; k < 3; k++) assert_near(b.mean_wall_tension[k], a.mean_wall_tension[(3 - k) % 3], 1e-9);
  assert_near(fmod(b.normal_place[1] + a.normal_place[1], 3), 0.0, 0);
}

/* Contact bears no more than the cohesion, and no shear. */
TEST(ContactBearsTheCohesionAtMost)
{
  LamMicrostructure micro = DefaultTissue();
  LamLoad load = PlaneLoad(1.06, 0, 0, 1, 0.2);
  LamResponse r;

  micro.interface = LAM_INTERFACE_CONTACT;
  load.cohesion = 0.02;
  r = SolveTissue(&micro, load);
  assert_near(r.max_traction, 0.02, 1e-12);
  assert_true(r.max_gap > LAM_VISIBLE_GAP && r.gap_place[2] >= 0 && r.gap_place[2] <= 1);
  assert_near(r.max_lamella_shear, 0.0, 0);
}
