/* The weakest band of a tangent and the weakest shear band of a wall: exact cases, and searches over all directions. */
#include "support/test.h"
#include "support/kernels.h"
#include <string.h>
#include <lamella/ellipticity.h>
#include "support/random_reals.h"
#include "wall_law.h"
#include "wall_ellipticity.h"

#define STATES 60
#define DIRECTIONS 1440

/* Components of a 2x2 tensor in the order 11 12 21 22. */
static void Isotropic(double lambda, double mu, double A[16])
{
  const double trace[4] = {1, 0, 0, 1};

  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) A[4 * a + b] = lambda * trace[a] * trace[b] + (a == b ? mu : 0);
  A[0] += mu;         /* delta_il delta_jk: 11 11, */
  A[15] += mu;        /* 22 22, */
  A[4 * 1 + 2] += mu; /* 12 21, */
  A[4 * 2 + 1] += mu; /* 21 12 */
}

static void RandomTangent(uint64_t *seed, double A[16])
{
  for (int a = 0; a < 4; a++)
    for (int b = 0; b <= a; b++) A[4 * a + b] = A[4 * b + a] = RandomReal(seed, -1, 1);
  for (int a = 0; a < 4; a++) A[5 * a] += 1;
}

static double Stiffness(const double A[16], const double N[2], const double m[2])
{
  double sum = 0;

  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) sum += m[a / 2] * N[a % 2] * A[4 * a + b] * m[b / 2] * N[b % 2];
  return sum;
}

/* Smallest eigenvalue of the acoustic tensor at one direction. */
static double SmallestAt(const double A[16], double angle)
{
  const double N[2] = {cos(angle), sin(angle)}, e1[2] = {1, 0}, e2[2] = {0, 1}, d[2] = {M_SQRT1_2, M_SQRT1_2};
  const double Q11 = Stiffness(A, N, e1), Q22 = Stiffness(A, N, e2), Q12 = Stiffness(A, N, d) - 0.5 * (Q11 + Q22);

  return 0.5 * (Q11 + Q22) - hypot(0.5 * (Q11 - Q22), Q12);
}

static void AssertDirection(const double direction[2], double x, double y)
{
  assert_near(direction[0], x, 1e-9);
  assert_near(direction[1], y, 1e-9);
}

TEST(IsotropicSolidHasItsShearModulus)
{
  double A[16];
  LamBand band;

  Isotropic(2.0, 0.7, A);
  LamBandFind(A, &band);
  assert_near(band.value, 0.7, 1e-15);
  AssertDirection(band.normal, 1, 0);
  AssertDirection(band.mode, 0, 1);
  Isotropic(-1.0, 0.7, A); /* lambda + 2 mu < mu: the longitudinal wave is the slower one */
  LamBandFind(A, &band);
  assert_near(band.value, 0.4, 1e-15);
  AssertDirection(band.normal, 1, 0);
  AssertDirection(band.mode, 1, 0);
}

/* Layers across X2, half and half: in series they shear as their harmonic mean, and nothing is weaker. */
TEST(LaminateShearsAlongItsLayers)
{
  const double mu[2] = {1.0, 10.0}, lambda[2] = {1.0, 4.0};
  const double series = 2 / (1 / mu[0] + 1 / mu[1]);
  double stiff = 0, across = 0, along = 0, transfer = 0, A[16] = {0};
  LamBand band;

  for (int k = 0; k < 2; k++) {
    const double M = lambda[k] + 2 * mu[k];

    across += 0.5 / M;
    transfer += 0.5 * lambda[k] / M;
    stiff += 0.5 * (M - lambda[k] * lambda[k] / M);
  }
  along = stiff + transfer * transfer / across;
  A[0] = along;
  A[15] = 1 / across;
  A[3] = A[12] = transfer / across;
  A[5] = A[6] = A[9] = A[10] = series;
  LamBandFind(A, &band);
  assert_near(band.value, series, 1e-14);
  AssertDirection(band.normal, 1, 0); /* as far as linear elasticity knows, along X2 just as well: the first is told */
  AssertDirection(band.mode, 0, 1);
  A[5] += 0.1; /* pulled along X2: dP12/dF12 and dP21/dF21 differ by the tension */
  LamBandFind(A, &band);
  AssertDirection(band.mode, 0, 1);
  A[5] -= 0.2;
  LamBandFind(A, &band);
  assert_near(band.value, series - 0.1, 1e-14);
  AssertDirection(band.normal, 0, 1);
  AssertDirection(band.mode, 1, 0);
}

TEST(NoDirectionIsWeaker)
{
  uint64_t seed = 3;

  for (int n = 0; n < STATES; n++) {
    double A[16], least = INFINITY;
    LamBand band;

    RandomTangent(&seed, A);
    LamBandFind(A, &band);
    for (int k = 0; k < DIRECTIONS; k++) least = fmin(least, SmallestAt(A, k * M_PI / DIRECTIONS));
    assert_true(band.value <= least + 1e-14);
    assert_near(band.value, least, 1e-4);
    assert_near(band.value, Stiffness(A, band.normal, band.mode), 1e-13);
    assert_near(hypot(band.normal[0], band.normal[1]), 1, 1e-15);
    assert_near(hypot(band.mode[0], band.mode[1]), 1, 1e-15);
  }
}

/* -p J adds nothing: its second derivative vanishes along m (x) N. */
TEST(TurgorAtFixedWallsAddsNothing)
{
  double A[16];
  LamBand dry, wet;

  RandomTangent(&(uint64_t){4}, A);
  LamBandFind(A, &dry);
  A[3] -= 0.3;
  A[12] -= 0.3;
  A[6] += 0.3;
  A[9] += 0.3;
  LamBandFind(A, &wet);
  assert_near(wet.value, dry.value, 1e-14);
  AssertDirection(wet.normal, dry.normal[0], dry.normal[1]);
  AssertDirection(wet.mode, dry.mode[0], dry.mode[1]);
}

/* F -> R F turns the mode and leaves normal and value. */
TEST(ModeTurnsWithTheBody)
{
  const double c = cos(0.3), s = sin(0.3), R[2][2] = {{c, -s}, {s, c}};
  double A[16], turned[16] = {0};
  LamBand before, after;

  RandomTangent(&(uint64_t){5}, A);
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++)
      for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
          turned[4 * a + b] += R[a / 2][i] * R[b / 2][k] * A[4 * (2 * i + a % 2) + 2 * k + b % 2];
  LamBandFind(A, &before);
  LamBandFind(turned, &after);
  assert_near(after.value, before.value, 1e-14);
  AssertDirection(after.normal, before.normal[0], before.normal[1]);
  assert_near(fabs((c * before.mode[0] - s * before.mode[1]) * after.mode[0] +
                   (s * before.mode[0] + c * before.mode[1]) * after.mode[1]),
              1, 1e-12);
}

TEST(UnknownTangentHasNoBand)
{
  double A[16] = {1, [7] = NAN};
  LamBand band;
  LamResponse response;
  const LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

  LamBandFind(A, &band);
  assert_true(isnan(band.value) && isnan(band.normal[0]) && isnan(band.mode[1]));
  assert_int_equal(LamResponseInit(&load, &response), 0);
  LamResponseFindBand(&response);
  assert_true(isnan(response.ellipticity) && isnan(response.localisation_normal[2]));
}

/* Out-of-plane entries do not count: in plane strain they are not known. */
TEST(BandOfAResponseIsThatOfItsPlane)
{
  const LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  LamResponse response;
  double A[16];
  LamBand band;

  RandomTangent(&(uint64_t){6}, A);
  assert_int_equal(LamResponseInit(&load, &response), 0);
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) response.tangent[9 * (3 * (a / 2) + a % 2) + 3 * (b / 2) + b % 2] = A[4 * a + b];
  LamBandFind(A, &band);
  LamResponseFindBand(&response);
  assert_near(response.ellipticity, band.value, 0);
  AssertDirection(response.localisation_normal, band.normal[0], band.normal[1]);
  assert_near(response.localisation_mode[2], 0, 0);
}

/* ---- walls ---- */

/* Second derivative in F at F33 = 1, without the volumetric part: fibres along (cos, sin)(angle). */
static void WallTangent(const LamWall *wall, const double F[4], double angle, double A[4][4])
{
  const double M[2] = {cos(angle), sin(angle)};
  const double Fm[2] = {F[0] * M[0] + F[1] * M[1], F[2] * M[0] + F[3] * M[1]};
  const LamWallLaw *law;
  MatrixPoint matrix;
  KernelPoint fibre;

  assert_int_equal(LamWallLawGet(wall->law, &law), 0);
  matrix = MatrixAt(law, wall, F, 1.0);
  fibre = FibreAt(law, wall, Fm[0] * Fm[0] + Fm[1] * Fm[1] - 1.0);
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      A[a][b] = matrix.A[a][b] + 4 * fibre.dd * Fm[a / 2] * M[a % 2] * Fm[b / 2] * M[b % 2];
      if (a / 2 == b / 2) A[a][b] += 2 * fibre.d * M[a % 2] * M[b % 2];
    }
}

static LamWall Wall(void)
{
  return (LamWall){.law = LAM_WALL_FIBRE_MOONEY_RIVLIN, .C1 = 0.9, .C2 = 0.1, .C4 = 10.0, .bulk_modulus = 1000.0};
}

static void RandomState(uint64_t *seed, double F[4])
{
  double J;

  do {
    for (int i = 0; i < 4; i++) F[i] = (i % 3 == 0 ? 1.0 : 0.0) + RandomReal(seed, -0.4, 0.4);
    J = F[0] * F[3] - F[1] * F[2];
  } while (J < 0.3);
  for (int i = 0; i < 4; i++) F[i] /= sqrt(J);
}

/* Compressed along its fibres the wall kinks at C4 (1 - I4) = C1 + C2, in bands whose normal is along the fibre. */
TEST(FibresKinkAcrossThemselves)
{
  const LamWall wall = Wall();
  const double critical = sqrt(1 - (wall.C1 + wall.C2) / wall.C4);

  for (int k = -2; k <= 2; k++) {
    const double l = critical + 0.005 * k, F[4] = {l, 0, 0, 1 / l};
    const double exact = wall.C1 + wall.C2 - wall.C4 * (1 - l * l);
    double A[4][4];
    LamBand band;

    WallTangent(&wall, F, 0, A);
    assert_near(LamShearBandStiffness((const PetscReal(*)[4])A, F), l * l * exact, 1e-12);
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < 4; b++) { /* as a tangent: with the volume */
        const double cofactor[4] = {F[3], -F[2], -F[1], F[0]};

        A[a][b] += wall.bulk_modulus * cofactor[a] * cofactor[b];
      }
    LamBandFind((const double *)A, &band);
    assert_near(band.value, exact, 1e-12);
    AssertDirection(band.normal, 1, 0);
    AssertDirection(band.mode, 0, 1);
  }
}

TEST(NoShearBandOfAWallIsWeaker)
{
  const LamWall wall = Wall();
  uint64_t seed = 8;

  for (int n = 0; n < STATES; n++) {
    double F[4], A[4][4], least = INFINITY, found;

    RandomState(&seed, F);
    WallTangent(&wall, F, RandomReal(&seed, 0, M_PI), A);
    found = LamShearBandStiffness((const PetscReal(*)[4])A, F);
    for (int k = 0; k < DIRECTIONS; k++) {
      const double c = cos(k * M_PI / DIRECTIONS), s = sin(k * M_PI / DIRECTIONS);
      const double m[2] = {-s, c}, N[2] = {F[0] * c + F[2] * s, F[1] * c + F[3] * s};

      least = fmin(least, Stiffness((const double *)A, N, m));
    }
    assert_true(found <= least + 1e-9);
    assert_near(found, least, 1e-3);
  }
}

/* With all jumps allowed, not only those that keep the volume, the weakest is weaker by a share of 1/kappa. */
TEST(FiniteBulkModulusDiffersByItsInverse)
{
  const LamWall wall = Wall();
  uint64_t seed = 9;

  for (int n = 0; n < STATES; n++) {
    double F[4], A[4][4], spatial[16], lower[2];

    RandomState(&seed, F);
    WallTangent(&wall, F, RandomReal(&seed, 0, M_PI), A);
    for (int k = 0; k < 2; k++) {
      const double kappa = k ? 1e5 : 1e4, identity[4] = {1, 0, 0, 1};
      LamBand band;

      memset(spatial, 0, sizeof(spatial));
      for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++) {
          for (int j = 0; j < 2; j++)
            for (int l = 0; l < 2; l++)
              spatial[4 * a + b] += A[2 * (a / 2) + j][2 * (b / 2) + l] * F[2 * (a % 2) + j] * F[2 * (b % 2) + l];
          spatial[4 * a + b] += kappa * identity[a] * identity[b];
        }
      LamBandFind(spatial, &band);
      lower[k] = LamShearBandStiffness((const PetscReal(*)[4])A, F) - band.value;
      assert_true(lower[k] > -1e-9 && lower[k] < 1000 / kappa);
    }
    assert_near(lower[0], 10 * lower[1], 0.2 * lower[0] + 1e-8);
  }
}

TEST(FibresInTensionAloneNeverKink)
{
  LamWall wall = Wall();
  uint64_t seed = 10;

  wall.fibres = LAM_FIBRES_TENSION;
  for (int n = 0; n < 10 * STATES; n++) {
    double F[4], A[4][4];

    RandomState(&seed, F);
    WallTangent(&wall, F, RandomReal(&seed, 0, M_PI), A);
    assert_true(LamShearBandStiffness((const PetscReal(*)[4])A, F) > 0);
  }
}
