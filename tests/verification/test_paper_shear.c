/* Generalised shear, Section 3 of Mihai, Safar & Wyatt: kernels and element against the closed forms of
 * docs/results/paper.md.
 */
#include "support/rve_fixture.h"
#include "support/kernels.h"
#include "support/gap_between_walls.h"
#include "support/paper_shear.h"

#define TOLERANCE 1e-11

static ShearErrors errors;

static int Compare(void **state)
{
  return ComputeShearErrors(&errors) ? 1 : 0;
}

TEST_IS(NominalStressOfTheKernelsIsExact, assert_near(errors.nominal, 0.0, TOLERANCE));
TEST_IS(CauchyStressOfTheKernelsIsExact, assert_near(errors.cauchy, 0.0, TOLERANCE));
TEST_IS(TractionsOnMaterialPlanesAreExact, assert_near(errors.traction, 0.0, TOLERANCE));
TEST_IS(NodalForcesOfTheElementAreExact, assert_near(errors.force, 0.0, TOLERANCE));

TEST(FieldsOfTheElementAreExact)
{
  assert_near(errors.stretch, 0.0, TOLERANCE);
  assert_near(errors.principal, 0.0, TOLERANCE);
}

/* Fibres at random angles, where sigma12 rises with the shear: C4 <= 3 (C1 + C2). */
TEST(CubicIsSolvedByItsRoot)
{
  uint64_t seed = 43;

  for (int n = 0; n < SHEAR_STATES; n++) {
    ShearState random = RandomShear(&seed);

    random.psi = RandomReal(&seed, 0.2, 2.9);
    random.wall.C4 = RandomReal(&seed, 0.1, 3.0);
    assert_near(ShearOfStress(&random.wall, random.psi, ShearFlow(&random.wall, random.psi, random.s)), random.s, 1e-9);
  }
}

TEST(ProfileHasTheShearOfTheCubic)
{
  const LamWall wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9.0};
  const double a = 1.5, b = 0.2, h = 1e-4;

  for (double X2 = 0.1; X2 < 1.0; X2 += 0.2) {
    const double rise = ShearProfile(&wall, GAP_PSI, a, b, X2 + h) - ShearProfile(&wall, GAP_PSI, a, b, X2 - h);

    assert_near(rise / (2.0 * h), ShearOfStress(&wall, GAP_PSI, a * X2 + b), 1e-7);
  }
}

/* d P12 / d F12 of the kernels. */
static double ShearTangent(const LamWall *wall, double psi, double s)
{
  const double F[4] = {1.0, s, 0.0, 1.0}, Fm1 = cos(psi) + s * sin(psi), M2 = sin(psi);
  const LamWallLaw law = {LAM_WALL_FIBRE_MOONEY_RIVLIN, LamMatrixMooneyRivlin, NULL, LamFibreQuadratic};
  const MatrixPoint matrix = MatrixAt(&law, wall, F, 1.0);
  const KernelPoint fibre = FibreAt(&law, wall, Fm1 * Fm1 + M2 * M2 - 1.0);

  return matrix.A[1][1] + 4.0 * fibre.dd * PetscSqr(Fm1 * M2) + 2.0 * fibre.d * M2 * M2;
}

/* Its least value, C1 + C2 - C4 (sin psi cos psi)^2, is where the fibres are shortest, s = -cot psi. */
TEST(ObliqueFibresMakeTheShearStressFall)
{
  const LamWall wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9.0};

  for (double psi = 0.3; psi < 1.5; psi += 0.1) {
    const double least = 1.0 - 9.0 * PetscSqr(sin(psi) * cos(psi));

    assert_near(ShearTangent(&wall, psi, -1.0 / tan(psi)), least, 1e-12);
    assert_true(ShearTangent(&wall, psi, -1.0 / tan(psi) + 0.1) > least);
    assert_true(ShearTangent(&wall, psi, -1.0 / tan(psi) - 0.1) > least);
  }
}

/* Whatever their stiffness, fibres in the plane of the interface do not relieve it of its shear traction. */
TEST(ShearedInterfaceAlongFibresHasFriction)
{
  for (double s = -1.0; s < 1.1; s += 0.25)
    for (double C4 = 0.0; C4 < 1e4; C4 = 10.0 * C4 + 1.0) {
      const ShearState sheared = {
          .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = C4, .bulk_modulus = 1e3}, .psi = GAP_PSI, .s = s};
      double P[5] = {0};

      assert_int_equal(KernelStress(&sheared, P), 0);
      assert_near((P[2] + s * P[0]) / (1.0 + s * s), s / (1.0 + s * s), 1e-12 * (1.0 + C4));
    }
}

static Gap GapOf(double C4, double k)
{
  const LamWall wall = {.C1 = 0.9, .C2 = 0.1, .C4 = C4};

  return ComputeGap(&wall, k);
}

/* 1/4 at X2 = 1 where fibres carry all, and 1/2 where they carry nothing, as at small k. */
TEST(GapHasThePowerOfStiffFibresOnly)
{
  assert_near(GapOf(1e9, 0.5).gap, 0.25, 1e-5);
  assert_near(GapOf(9.0, 1e-4).gap, 0.5, 1e-6);
}

/* Over k and k^2, the tractions that the faces should not carry tend to C1 + C2 and to 3/2 (C1 + C2) + C4. */
TEST(UnwantedTractionsVanishOnlyWithTheShear)
{
  for (double k = 0.1; k > 1e-3; k *= 0.1) {
    assert_near(GapOf(9.0, k).shear / k, 1.0, 2.0 * k * k);
    assert_near(GapOf(9.0, k).spread / (k * k), 1.5 + 9.0, 10.0 * k * k);
  }
}

TEST_GROUP(.petsc = 1, .setup = Compare);
