/* Lattice strains: kinematics, and stress and tangent from a potential of them and back. */
#include "support/test.h"
#include <string.h>
#include "lattice_strain.h"
#include "support/random_reals.h"

enum { STATES = 50 };

static void RandomF(uint64_t *seed, double F[4])
{
  F[0] = RandomReal(seed, 0.8, 1.3);
  F[1] = RandomReal(seed, -0.2, 0.2);
  F[2] = RandomReal(seed, -0.2, 0.2);
  F[3] = RandomReal(seed, 0.8, 1.3);
}

/* F11 = 1.1, F12 = 0.2, F22 = 0.9, a lattice direction along X1: n_1 at 60, n_2 at 120 degrees, by hand. */
TEST(strains_are_those_of_the_recipe)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0);
  const double F[4] = {1.1, 0.2, 0, 0.9}, h = sqrt(0.75);
  const LamLatticeState at = LamLatticeStateOf(&axes, F);

  assert_near(at.x[0], log(1.1), 1e-15);
  assert_near(at.x[1], 0.5 * log(pow(0.55 + 0.2 * h, 2) + pow(0.9 * h, 2)), 1e-15);
  assert_near(at.x[2], 0.5 * log(pow(-0.55 + 0.2 * h, 2) + pow(0.9 * h, 2)), 1e-15);
}

TEST(a_turned_lattice_sees_a_turned_strain)
{
  const double angle = 0.4, c = cos(angle), s = sin(angle), F[4] = {1.1, 0.05, -0.1, 0.95};
  const LamLatticeAxes straight = LamLatticeAxesOf(0), turned = LamLatticeAxesOf(angle);
  const double FQ[4] = {F[0] * c + F[1] * s, -F[0] * s + F[1] * c, F[2] * c + F[3] * s, -F[2] * s + F[3] * c};
  const LamLatticeState a = LamLatticeStateOf(&turned, F), b = LamLatticeStateOf(&straight, FQ);

  for (int k = 0; k < 3; k++) assert_near(a.x[k], b.x[k], 1e-15);
}

TEST(strains_do_not_see_the_frame)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0.3);
  const double F[4] = {1.1, 0.05, -0.1, 0.95}, c = cos(0.8), s = sin(0.8);
  const double RF[4] = {c * F[0] - s * F[2], c * F[1] - s * F[3], s * F[0] + c * F[2], s * F[1] + c * F[3]};
  const LamLatticeState a = LamLatticeStateOf(&axes, F), b = LamLatticeStateOf(&axes, RF);

  for (int k = 0; k < 3; k++) assert_near(a.x[k], b.x[k], 1e-15);
}

TEST(strains_make_a_stretch_and_the_stretch_them)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0.3);
  uint64_t seed = 1;

  for (int n = 0; n < STATES; n++) {
    double F[4], U[4] = {0};
    LamLatticeState at;

    RandomF(&seed, F);
    at = LamLatticeStateOf(&axes, F);
    assert_true(LamLatticeStretch(&axes, at.x, U));
    assert_true(U[1] == U[2] && U[0] > 0 && U[0] * U[3] > U[1] * U[2]);
    assert_near(U[0] * U[0] + U[2] * U[2], F[0] * F[0] + F[2] * F[2], 1e-14);
    assert_near(U[0] * U[1] + U[2] * U[3], F[0] * F[1] + F[2] * F[3], 1e-14);
    assert_near(U[1] * U[1] + U[3] * U[3], F[1] * F[1] + F[3] * F[3], 1e-14);
  }
}

/* Two directions cannot shrink to nothing while the third grows. */
TEST(some_strains_have_no_stretch)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0);
  const double x[3] = {1, -1, -1};
  double U[4];

  assert_false(LamLatticeStretch(&axes, x, U));
}

/* ---- derivatives ---- */

/* exp(x0) + x1^2 x2 + sin(x0 - 2 x2): without symmetry. */
static double Energy(const double x[3], double g[3], double h[6])
{
  const double S = sin(x[0] - 2 * x[2]), C = cos(x[0] - 2 * x[2]);

  g[0] = exp(x[0]) + C;
  g[1] = 2 * x[1] * x[2];
  g[2] = x[1] * x[1] - 2 * C;
  h[0] = exp(x[0]) - S;
  h[1] = 2 * x[2];
  h[2] = -4 * S;
  h[3] = 2 * x[1];
  h[4] = 2 * S;
  h[5] = 0;
  return exp(x[0]) + x[1] * x[1] * x[2] + S;
}

static double StressAt(const LamLatticeAxes *axes, const double F[4], double P[4])
{
  const LamLatticeState at = LamLatticeStateOf(axes, F);
  double g[3], h[6];
  const double energy = Energy(at.x, g, h);

  LamLatticeStress(axes, &at, g, P);
  return energy;
}

TEST(stress_and_tangent_are_derivatives)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0.3);
  const double step = 1e-5;
  uint64_t seed = 2;

  for (int n = 0; n < STATES; n++) {
    double F[4], g[3], h[6], P[4], A[4][4];
    LamLatticeState at;

    RandomF(&seed, F);
    at = LamLatticeStateOf(&axes, F);
    Energy(at.x, g, h);
    LamLatticeStress(&axes, &at, g, P);
    LamLatticeTangent(&axes, &at, g, h, A);
    for (int a = 0; a < 4; a++) {
      double left[4], right[4], low[4], high[4];

      memcpy(left, F, sizeof(left));
      memcpy(right, F, sizeof(right));
      left[a] -= step;
      right[a] += step;
      assert_near((StressAt(&axes, right, high) - StressAt(&axes, left, low)) / (2 * step), P[a], 1e-8);
      for (int b = 0; b < 4; b++) {
        assert_near((high[b] - low[b]) / (2 * step), A[b][a], 1e-7);
        assert_near(A[a][b], A[b][a], 1e-13);
      }
    }
  }
}

TEST(the_volume_is_the_determinant)
{
  const LamLatticeAxes axes = LamLatticeAxesOf(0.3);
  uint64_t seed = 3;

  for (int n = 0; n < STATES; n++) {
    double F[4], g[3], h[6], P[4], A[4][4], J;
    LamLatticeState at;

    RandomF(&seed, F);
    at = LamLatticeStateOf(&axes, F);
    J = LamLatticeVolume(&axes, &at, g, h);
    assert_near(J, F[0] * F[3] - F[1] * F[2], 1e-14);
    LamLatticeStress(&axes, &at, g, P);
    LamLatticeTangent(&axes, &at, g, h, A);
    for (int a = 0; a < 4; a++) {
      assert_near(P[a], (a == 1 || a == 2 ? -1 : 1) * F[3 - a], 1e-14); /* cofactor */
      for (int b = 0; b < 4; b++) assert_near(A[a][b], a + b == 3 ? (a == 1 || a == 2 ? -1 : 1) : 0, 1e-13);
    }
  }
}

/* Each changes its own strain alone, and gives back the potential's derivatives from stress and tangent. */
TEST(variations_go_back_to_the_potential)
{
  static const int entry[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  const LamLatticeAxes axes = LamLatticeAxesOf(0.3);
  uint64_t seed = 4;

  for (int n = 0; n < STATES; n++) {
    double F[4], g[3], h[6], P[4], A[4][4], dF[3][4], J;
    LamLatticeState at;

    RandomF(&seed, F);
    J = F[0] * F[3] - F[1] * F[2];
    at = LamLatticeStateOf(&axes, F);
    Energy(at.x, g, h);
    LamLatticeStress(&axes, &at, g, P);
    LamLatticeTangent(&axes, &at, g, h, A);
    LamLatticeVariations(&axes, &at, F, dF);
    for (int k = 0; k < 3; k++) {
      for (int l = 0; l < 3; l++) {
        const double *a = dF[k], *b = dF[l];
        const double S[2][2] = {{(F[3] * P[0] - F[1] * P[2]) / J, (F[3] * P[1] - F[1] * P[3]) / J},
                                {(F[0] * P[2] - F[2] * P[0]) / J, (F[0] * P[3] - F[2] * P[1]) / J}};
        double sum = k == l ? 2 * g[k] : 0, dx = 0;

        for (int i = 0; i < 2; i++)
          for (int j = 0; j < 2; j++) dx += at.f[l][i] * axes.n[l][j] / at.q[l] * a[2 * i + j];
        assert_near(dx, k == l, 1e-14);
        for (int i = 0; i < 4; i++)
          for (int j = 0; j < 4; j++) sum += a[i] * A[i][j] * b[j];
        for (int i = 0; i < 2; i++)
          for (int j = 0; j < 2; j++) sum -= S[i][j] * (a[i] * b[j] + a[2 + i] * b[2 + j]);
        assert_near(sum, h[entry[k][l]], 1e-12);
      }
      assert_near(P[0] * dF[k][0] + P[1] * dF[k][1] + P[2] * dF[k][2] + P[3] * dF[k][3], g[k], 1e-13);
    }
  }
}
