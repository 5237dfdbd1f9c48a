/* Tractions between bonded cells. The forces T_k on faces 0, 1, 2 carry the whole stress: P V0 = sum_k T_k (x) L_k. For
   F = lambda 1 symmetry makes T_k normal and equal, sum_k n_k (x) n_k = 3/2 1, and the mean normal traction per current
   length is then the macroscopic Cauchy stress P11/lambda (F33 = 1). */
#include "support/rve_fixture.h"

TEST(EqualBiaxialTractionIsTheCauchyStress)
{
  static const double stretch[4] = {0.99, 1.0, 1.03, 1.1}, turgor[4] = {0.0, 0.2, 0.2, 0.0};

  for (int k = 0; k < 4; k++) {
    LamMicrostructure micro = DefaultTissue();
    LamResponse r;

    micro.orientation = 0.2 * k;
    r = SolveTissue(&micro, PlaneLoad(stretch[k], 0, 0, stretch[k], turgor[k]));
    for (int f = 0; f < 3; f++) assert_near(r.mean_face_traction[f], r.P[0] / stretch[k], 1e-9);
  }
}

/* Symmetry about the face normal: with F = diag the two oblique families share one value. */
TEST(ObliqueFacesShareOneValue)
{
  const LamResponse r = SolveDefaultTissue(PlaneLoad(1.08, 0, 0, 0.99, 0.1));

  assert_near(r.mean_face_traction[1], r.mean_face_traction[2], 1e-9);
}

/* Without load there is no traction. */
TEST(UnloadedTissueHasNoTraction)
{
  const LamResponse r = SolveDefaultTissue(PlaneLoad(1, 0, 0, 1, 0));

  for (int f = 0; f < 3; f++) assert_near(r.mean_face_traction[f], 0.0, 1e-9);
  assert_near(r.max_traction, 0.0, 1e-9);
}

/* Averaged over a wall thickness the largest traction converges, though it diverges pointwise at the lumen corners. */
TEST(LargestTractionConverges)
{
  static const int mesh[3][2] = {{6, 2}, {12, 4}, {20, 6}};
  double largest[3];

  for (int m = 0; m < 3; m++) {
    LamMicrostructure micro = DefaultTissue();

    micro.along = mesh[m][0];
    micro.through = mesh[m][1];
    largest[m] = SolveTissue(&micro, PlaneLoad(1.05, 0.1, 0, 1, 0.1)).max_traction;
  }
  assert_near(largest[0], largest[2], 0.02 * largest[2]);
  assert_near(largest[1], largest[2], 0.01 * largest[2]);
}

/* The largest local average is at least the mean of each face. */
TEST(LargestTractionBoundsTheMeans)
{
  const LamResponse r = SolveDefaultTissue(PlaneLoad(1.05, 0.1, 0, 1, 0.1));

  for (int f = 0; f < 3; f++) assert_true(r.max_traction >= r.mean_face_traction[f]);
}
