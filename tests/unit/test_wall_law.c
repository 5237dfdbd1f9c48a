/* Wall law kernels against closed forms and against finite differences at random states. */
#include "support/test.h"
#include "support/kernels.h"
#include "wall_law.h"
#include "support/random_reals.h"

#define STATES 40

static const LamWall wall = {
    .law = LAM_WALL_FIBRE_MOONEY_RIVLIN, .C1 = 0.7, .C2 = 0.3, .C4 = 12.0, .bulk_modulus = 1000.0};

/* Relative to 1 + |expected|. */
static void AssertClose(double value, double expected, double tolerance)
{
  assert_near(value, expected, tolerance * (1.0 + fabs(expected)));
}

static void RandomState(uint64_t *seed, double F[4], double *F33)
{
  for (int i = 0; i < 4; i++) F[i] = (i % 3 == 0 ? 1.0 : 0.0) + RandomReal(seed, -0.35, 0.35);
  *F33 = RandomReal(seed, 0.8, 1.3);
}

/* Exponential fibres as stiff at rest as those of `wall`. */
static LamWall Stiffening(double k2)
{
  return (LamWall){.law = LAM_WALL_FIBRE_EXPONENTIAL, .C1 = 0.7, .C2 = 0.3, .k1 = 6.0, .k2 = k2, .bulk_modulus = 1000};
}

static MatrixPoint Matrix(const double F[4], double F33)
{
  const LamWallLaw *law;

  assert_int_equal(LamWallLawGet(LAM_WALL_MOONEY_RIVLIN, &law), 0);
  return MatrixAt(law, &wall, F, F33);
}

static KernelPoint Fibre(const LamWall *of, double I4)
{
  const LamWallLaw *law;

  assert_int_equal(LamWallLawGet(of->law, &law), 0);
  return FibreAt(law, of, I4 - 1.0);
}

/* Uniaxial tension of an incompressible body: W and s1 - s2 = C1 (l^2 - 1/l) + C2 (l - 1/l^2) (Mooney). */
TEST(MatrixUniaxialIsExact)
{
  for (double l = 0.6; l < 2.1; l += 0.3) {
    const double r = 1.0 / sqrt(l), F[4] = {l, 0, 0, r};
    const MatrixPoint k = Matrix(F, r);

    AssertClose(k.W, 0.5 * wall.C1 * (l * l + 2.0 / l - 3.0) + 0.5 * wall.C2 * (2.0 * l + 1.0 / (l * l) - 3.0), 1e-13);
    AssertClose(l * k.P[0] - r * k.P[3], wall.C1 * (l * l - 1.0 / l) + wall.C2 * (l - 1.0 / (l * l)), 1e-13);
    AssertClose(r * k.P[4], r * k.P[3], 1e-13);
  }
}

/* Simple shear: s12 = (C1 + C2) g, s11 - s33 = C1 g^2, s22 - s33 = -C2 g^2 (Rivlin). */
TEST(MatrixSimpleShearIsExact)
{
  for (double g = -1.0; g < 1.1; g += 0.4) {
    const double F[4] = {1, g, 0, 1};
    const MatrixPoint k = Matrix(F, 1.0);
    const double s11 = k.P[0] + g * k.P[1], s22 = k.P[3], s12 = k.P[1];

    AssertClose(k.W, 0.5 * (wall.C1 + wall.C2) * g * g, 1e-13);
    AssertClose(s12, (wall.C1 + wall.C2) * g, 1e-13);
    AssertClose(s11 - k.P[4], wall.C1 * g * g, 1e-13);
    AssertClose(s22 - k.P[4], -wall.C2 * g * g, 1e-13);
  }
}

/* A change of volume neither stores energy in the matrix nor gives it a pressure. */
TEST(MatrixIsIsochoric)
{
  uint64_t seed = 3;

  for (int n = 0; n < STATES; n++) {
    double F[4], G[4], F33, trace;
    MatrixPoint k;

    RandomState(&seed, F, &F33);
    for (int i = 0; i < 4; i++) G[i] = 1.2 * F[i];
    k = Matrix(F, F33);
    trace = F33 * k.P[4];
    for (int i = 0; i < 4; i++) trace += F[i] * k.P[i];
    AssertClose(Matrix(G, 1.2 * F33).W, k.W, 1e-12);
    AssertClose(trace, 0.0, 1e-12);
  }
}

/* Uniaxial tension along the fibres adds the Cauchy stress 2 I4 dW/dI4 = C4 l^2 (l^2 - 1) to the matrix's. */
TEST(FibreUniaxialIsExact)
{
  for (double l = 0.6; l < 2.1; l += 0.3) {
    const KernelPoint k = Fibre(&wall, l * l);

    AssertClose(k.W, 0.25 * wall.C4 * pow(l * l - 1.0, 2), 1e-13);
    AssertClose(2.0 * l * l * k.d, wall.C4 * l * l * (l * l - 1.0), 1e-13);
  }
}

/* Shear across the fibres, M = e2, Fm = (g, 1): the fibres add C4 g^3, the cubic of Mihai, Safar & Wyatt, eq. 3.26. */
TEST(FibreSimpleShearIsExact)
{
  for (double g = -1.0; g < 1.1; g += 0.4) {
    const KernelPoint k = Fibre(&wall, 1.0 + g * g);

    AssertClose(2.0 * k.d * g, wall.C4 * g * g * g, 1e-13);
  }
}

/* `fibres: tension` leaves shortened fibres slack and changes nothing for stretched ones. */
TEST(SlackFibresCarryNothing)
{
  LamWall tension = wall;
  KernelPoint slack, taut, both;

  tension.fibres = LAM_FIBRES_TENSION;
  slack = Fibre(&tension, 0.81);
  taut = Fibre(&tension, 1.21);
  both = Fibre(&wall, 1.21);
  assert_true(slack.W == 0.0 && slack.d == 0.0 && slack.dd == 0.0);
  assert_true(taut.W == both.W && taut.d == both.d && taut.dd == both.dd);
}

TEST(PlainLawHasNoFibres)
{
  const LamWallLaw *law;

  assert_int_equal(LamWallLawGet(LAM_WALL_MOONEY_RIVLIN, &law), 0);
  assert_null(law->fibre);
}

/* One number of the kernel as a function of component c of (F, F33), and its fourth-order central difference. */
static double MatrixDifference(const double F[4], double F33, int c, int value)
{
  static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  const double h = 2e-4;
  double sum = 0.0;

  for (int k = 0; k < 4; k++) {
    double G[5] = {F[0], F[1], F[2], F[3], F33};
    MatrixPoint kernel;

    G[c] += at[k] * h;
    kernel = Matrix(G, G[4]);
    sum += weight[k] * (value < 0 ? kernel.W : kernel.P[value]);
  }
  return sum / (12.0 * h);
}

TEST(MatrixStressIsDerivativeOfEnergy)
{
  uint64_t seed = 11;

  for (int n = 0; n < STATES; n++) {
    double F[4], F33;

    RandomState(&seed, F, &F33);
    for (int c = 0; c < LAM_KERNEL_COMPONENTS; c++)
      AssertClose(Matrix(F, F33).P[c], MatrixDifference(F, F33, c, -1), 1e-9);
  }
}

TEST(MatrixTangentIsDerivativeOfStress)
{
  uint64_t seed = 12;

  for (int n = 0; n < STATES; n++) {
    double F[4], F33;

    RandomState(&seed, F, &F33);
    for (int c = 0; c < LAM_KERNEL_COMPONENTS; c++)
      for (int r = 0; r < LAM_KERNEL_COMPONENTS; r++)
        AssertClose(Matrix(F, F33).A[r][c], MatrixDifference(F, F33, c, r), 1e-9);
  }
}

TEST(FibreDerivativesFollowFromEnergy)
{
  const double h = 1e-3;

  for (double I4 = 0.5; I4 < 2.0; I4 += 0.2) { /* central differences are exact for a quadratic */
    AssertClose(Fibre(&wall, I4).d, (Fibre(&wall, I4 + h).W - Fibre(&wall, I4 - h).W) / (2.0 * h), 1e-10);
    AssertClose(Fibre(&wall, I4).dd, (Fibre(&wall, I4 + h).d - Fibre(&wall, I4 - h).d) / (2.0 * h), 1e-10);
  }
}

TEST(VolumetricDerivativesFollowFromEnergy)
{
  const double h = 1e-5;

  for (double J = 0.8; J < 1.3; J += 0.07) {
    KernelPoint k, plus, minus;

    k = VolumetricAt(&wall, J - 1.0);
    plus = VolumetricAt(&wall, J - 1.0 + h);
    minus = VolumetricAt(&wall, J - 1.0 - h);
    AssertClose(k.W, 0.25 * wall.bulk_modulus * (J * J - 1.0 - 2.0 * log(J)), 1e-12);
    AssertClose(k.d, (plus.W - minus.W) / (2.0 * h), 1e-6);
    AssertClose(k.dd, (plus.d - minus.d) / (2.0 * h), 1e-6);
  }
}

/* Small strains: shear modulus C1 + C2, bulk modulus kappa. */
TEST(SmallStrainModuliAreThoseOfTheLaw)
{
  const double unit[4] = {1, 0, 0, 1};
  const MatrixPoint k = Matrix(unit, 1.0);
  KernelPoint u;

  u = VolumetricAt(&wall, 0.0);
  AssertClose(k.A[1][1], wall.C1 + wall.C2, 1e-13);
  AssertClose(k.A[0][0] - k.A[0][3], 2.0 * (wall.C1 + wall.C2), 1e-13);
  AssertClose(u.dd, wall.bulk_modulus, 1e-13);
}

/* Uniaxial tension along the fibres, and shear across them: 2 k1 l^2 e exp(k2 e^2) with e = l^2 - 1, and 2 k1 g^3
   exp(k2 g^4) beside the matrix's (Holzapfel, Gasser & Ogden 2000, eq. 65 with 2 d/dI4). */
TEST(ExponentialFibresAreExact)
{
  const LamWall of = Stiffening(1.5);

  for (double l = 0.6; l < 1.6; l += 0.1) {
    const double e = l * l - 1.0;
    const KernelPoint k = Fibre(&of, l * l);

    AssertClose(k.W, of.k1 / (2.0 * of.k2) * (exp(of.k2 * e * e) - 1.0), 1e-13);
    AssertClose(2.0 * l * l * k.d, 2.0 * of.k1 * l * l * e * exp(of.k2 * e * e), 1e-12);
  }
  for (double g = -1.0; g < 1.1; g += 0.4)
    AssertClose(2.0 * Fibre(&of, 1.0 + g * g).d * g, 2.0 * of.k1 * pow(g, 3) * exp(of.k2 * pow(g, 4)), 1e-12);
}

TEST(ExponentialFibresFollowFromTheirEnergy)
{
  const double h = 1e-5;
  uint64_t seed = 11;

  for (int n = 0; n < STATES; n++) {
    const LamWall of = Stiffening(RandomReal(&seed, 0.0, 4.0));
    const double I4 = RandomReal(&seed, 0.4, 1.9);
    const KernelPoint k = Fibre(&of, I4), plus = Fibre(&of, I4 + h), minus = Fibre(&of, I4 - h);

    AssertClose(k.d, (plus.W - minus.W) / (2.0 * h), 1e-6);
    AssertClose(k.dd, (plus.d - minus.d) / (2.0 * h), 1e-6);
  }
}

/* As k2 goes to 0 they are quadratic fibres with C4 = 2 k1; also where k2 is next to nothing. */
TEST(ExponentialFibresBecomeQuadratic)
{
  const double small[] = {0.0, 1e-300, 1e-15};

  assert_near(LamWallFibreModulus(&(LamWall){.law = LAM_WALL_FIBRE_EXPONENTIAL, .k1 = 6.0, .k2 = 3.0}), wall.C4, 0.0);
  for (size_t s = 0; s < PETSC_STATIC_ARRAY_LENGTH(small); s++)
    for (double I4 = 0.5; I4 < 2.0; I4 += 0.1) {
      const LamWall of = Stiffening(small[s]);
      const KernelPoint k = Fibre(&of, I4), quadratic = Fibre(&wall, I4);

      AssertClose(k.W, quadratic.W, 1e-13);
      AssertClose(k.d, quadratic.d, 1e-13);
      AssertClose(k.dd, quadratic.dd, 1e-13);
    }
}

/* Slack under compression with `fibres: tension`, and infinite, never a NaN, where the exponential overflows. */
TEST(ExponentialFibresGoSlackAndOverflow)
{
  LamWall of = Stiffening(1e6);

  assert_true(isinf(Fibre(&of, 3.0).W) && Fibre(&of, 3.0).W > 0.0);
  assert_true(isinf(Fibre(&of, 0.1).W));
  assert_true(isfinite(Fibre(&of, 1.01).dd));
  of.fibres = LAM_FIBRES_TENSION;
  assert_near(Fibre(&of, 0.1).W, 0.0, 0.0);
  assert_near(Fibre(&of, 0.1).d, 0.0, 0.0);
  assert_near(Fibre(&of, 0.1).dd, 0.0, 0.0);
}
