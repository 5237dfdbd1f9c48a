/* The wall element: patch test, derivatives, projection, invariance. */
#include "support/rve_fixture.h"
#include "support/kernels.h"
#include "support/displaced.h"

static const LamWall quadratic = {.C1 = 0.7, .C2 = 0.3, .C4 = 12.0, .bulk_modulus = 1000.0};
static LamWall wall = {.C1 = 0.7, .C2 = 0.3, .C4 = 12.0, .bulk_modulus = 1000.0};
static const double fibre[2] = {0.8, 0.6};
/* node order of LamMesh in units of half edges */
static const int grid[9][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}};

typedef struct {
  LamElementGeometry geometry;
  const LamWallLaw *law;
  double X[9][2], x[9][2], F33;
  LamElementStress stress;
} Element;

/* An element of size about 0.4 x 0.2 with curved edges. */
static void NewElement(Element *element, uint64_t *seed)
{
  memset(element, 0, sizeof(*element));
  assert_int_equal(LamWallLawGet(wall.law, &element->law), 0);
  for (int a = 0; a < 9; a++) {
    element->X[a][0] = 0.2 * grid[a][0] + RandomReal(seed, -0.02, 0.02);
    element->X[a][1] = 0.1 * grid[a][1] + RandomReal(seed, -0.015, 0.015);
  }
  assert_int_equal(LamElementSetGeometry((const double(*)[2])element->X, fibre, &element->geometry), 0);
  element->F33 = 1.0;
}

static void MoveAffinely(Element *element, const double F[4])
{
  for (int a = 0; a < 9; a++)
    for (int i = 0; i < 2; i++) element->x[a][i] = F[2 * i] * element->X[a][0] + F[2 * i + 1] * element->X[a][1] + 0.3;
}

static NodeVectors Displacements(const Element *element)
{
  return Displaced((const double(*)[2])element->X, (const double(*)[2])element->x);
}

/* A deformed state far from affine, with F33 != 1 and consistent independent stresses. */
static Element RandomElement(uint64_t *seed)
{
  const double F[4] = {1.1, 0.2, -0.05, 0.95};
  Element element;

  NewElement(&element, seed);
  MoveAffinely(&element, F);
  for (int a = 0; a < 9; a++)
    for (int i = 0; i < 2; i++) element.x[a][i] += RandomReal(seed, -0.006, 0.006);
  element.F33 = RandomReal(seed, 0.9, 1.15);
  assert_true(LamElementSetConsistentStress(&element.geometry, element.law, &wall,
                                            (const double(*)[2])Displacements(&element).u, element.F33,
                                            &element.stress));
  return element;
}

static LamElementResult Evaluate(Element *element)
{
  LamElementResult result;
  PetscBool valid;

  LamElementEvaluate(&element->geometry, element->law, &wall, NULL, (const double(*)[2])Displacements(element).u,
                     element->F33, &element->stress, &result, &valid);
  assert_true(valid);
  return result;
}

static double Energy(const Element *element)
{
  double energy = 0.0;
  PetscBool valid;

  LamElementEnergy(&element->geometry, element->law, &wall, NULL, (const double(*)[2])Displacements(element).u,
                   element->F33, &energy, &valid);
  assert_true(valid);
  return energy;
}

/* Energy density and stress of a homogeneous F, straight from the kernels. */
static double Homogeneous(const Element *element, const double F[4], double P[4])
{
  const double J = F[0] * F[3] - F[1] * F[2], cof[4] = {F[3], -F[2], -F[1], F[0]};
  const double Fm[2] = {F[0] * fibre[0] + F[1] * fibre[1], F[2] * fibre[0] + F[3] * fibre[1]};
  MatrixPoint matrix;
  KernelPoint u, fibres;

  matrix = MatrixAt(element->law, &wall, F, 1.0);
  u = VolumetricAt(&wall, J - 1.0);
  fibres = FibreAt(element->law, &wall, Fm[0] * Fm[0] + Fm[1] * Fm[1] - 1.0);
  for (int c = 0; c < 4; c++) P[c] = matrix.P[c] + u.d * cof[c] + 2.0 * fibres.d * Fm[c / 2] * fibre[c % 2];
  return matrix.W + u.W + fibres.W;
}

static double Area(const Element *element)
{
  double area = 0.0;

  for (int g = 0; g < LAM_GAUSS; g++) area += element->geometry.weight[g];
  return area;
}

/* Affine field in a distorted element: energy W(F) area, and nodal forces with sum f (x) X = P area. */
TEST(AffineFieldIsExact)
{
  const double F[4] = {1.2, 0.3, -0.1, 0.9};
  Element element;
  LamElementResult result;
  double P[4], W, moment[4] = {0, 0, 0, 0};

  NewElement(&element, &(uint64_t){5});
  MoveAffinely(&element, F);
  W = Homogeneous(&element, F, P);
  result = Evaluate(&element);
  for (int a = 0; a < 9; a++)
    for (int c = 0; c < 4; c++) moment[c] += result.f[2 * a + c / 2] * element.X[a][c % 2];
  assert_near(result.energy, W * Area(&element), 1e-12 * result.energy);
  for (int c = 0; c < 4; c++) assert_near(moment[c], P[c] * Area(&element), 1e-12 * result.energy);
}

#define PATCH 5 /* nodes a side: 2 x 2 elements */

/* An affine field balances the inner nodes of a patch of distorted elements. */
TEST(PatchOfDistortedElementsIsInEquilibrium)
{
  const double F[4] = {1.2, 0.3, -0.1, 0.9};
  uint64_t seed = 6;
  double X[PATCH][PATCH][2], f[PATCH][PATCH][2] = {{{0}}}, largest = 0.0;
  Element element;

  for (int i = 0; i < PATCH; i++)
    for (int j = 0; j < PATCH; j++) {
      X[i][j][0] = 0.2 * i + RandomReal(&seed, -0.02, 0.02);
      X[i][j][1] = 0.1 * j + RandomReal(&seed, -0.015, 0.015);
    }
  for (int e = 0; e < 4; e++) {
    const int i0 = 2 * (e % 2), j0 = 2 * (e / 2);
    LamElementResult result;

    NewElement(&element, &seed);
    for (int a = 0; a < 9; a++)
      for (int d = 0; d < 2; d++) element.X[a][d] = X[i0 + grid[a][0]][j0 + grid[a][1]][d];
    assert_int_equal(LamElementSetGeometry((const double(*)[2])element.X, fibre, &element.geometry), 0);
    MoveAffinely(&element, F);
    result = Evaluate(&element);
    for (int a = 0; a < 9; a++)
      for (int d = 0; d < 2; d++) f[i0 + grid[a][0]][j0 + grid[a][1]][d] += result.f[2 * a + d];
  }
  for (int d = 0; d < 2; d++) largest = fmax(largest, fabs(f[0][0][d]));
  for (int i = 1; i < PATCH - 1; i++)
    for (int j = 1; j < PATCH - 1; j++)
      for (int d = 0; d < 2; d++) assert_true(fabs(f[i][j][d]) < 1e-12 * largest);
}

/* Fourth-order central difference of the energy (component < 0) or of one nodal force along one position, or along
   F33 (dof 18). Independent stresses do not enter. */
static double Difference(const Element *at, int dof, int component)
{
  static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  const double h = dof < 18 ? 1e-5 : 1e-4;
  double sum = 0.0;

  for (int k = 0; k < 4; k++) {
    Element moved = *at;

    if (dof < 18)
      moved.x[dof / 2][dof % 2] += step[k] * h;
    else
      moved.F33 += step[k] * h;
    sum += weight[k] * (component < 0 ? Energy(&moved) : Evaluate(&moved).f[component]);
  }
  return sum / (12.0 * h);
}

TEST(ResidualIsDerivativeOfEnergy)
{
  Element element = RandomElement(&(uint64_t){7});
  const LamElementResult result = Evaluate(&element);

  assert_near(result.energy, Energy(&element), 1e-13 * result.energy);
  for (int i = 0; i < 18; i++) assert_near(result.f[i], Difference(&element, i, -1), 1e-7);
}

TEST(ConsistentTangentIsDerivativeOfResidual)
{
  Element element = RandomElement(&(uint64_t){8});
  const LamElementResult result = Evaluate(&element);
  double largest = 0.0;

  for (int i = 0; i < 18; i++) largest = fmax(largest, result.K[i][i]);
  for (int i = 0; i < 18; i++)
    for (int j = 0; j < 18; j++) assert_near(result.K[i][j], Difference(&element, j, i), 1e-8 * largest);
}

TEST(TangentIsSymmetric)
{
  Element element = RandomElement(&(uint64_t){9});
  LamElementResult result;

  for (int k = 0; k < LAM_PRESSURES; k++) element.stress.p[k] += 0.3; /* also away from consistent stresses */
  for (int g = 0; g < LAM_GAUSS; g++) element.stress.s[g] -= 0.4;
  result = Evaluate(&element);
  for (int i = 0; i < 18; i++)
    for (int j = 0; j < i; j++) assert_true(fabs(result.K[i][j] - result.K[j][i]) < 1e-11 * result.K[i][i]);
}

TEST(ResidualDoesNotDependOnIndependentStresses)
{
  Element element = RandomElement(&(uint64_t){10});
  const LamElementResult before = Evaluate(&element);
  LamElementResult after;

  for (int k = 0; k < LAM_PRESSURES; k++) element.stress.p[k] += 0.3;
  for (int g = 0; g < LAM_GAUSS; g++) element.stress.s[g] -= 0.4;
  after = Evaluate(&element);
  assert_memory_equal(before.f, after.f, sizeof(before.f));
}

TEST(Stretch33DerivativesFollowFromEnergy)
{
  Element element = RandomElement(&(uint64_t){13}), moved;
  double force[3], fx[18], ff, scratch;

  (void)Evaluate(&element);
  LamElementStretch33(&element.geometry, element.law, &wall, NULL, (const double(*)[2])Displacements(&element).u,
                      element.F33, &element.stress, &force[0], fx, &ff);
  assert_near(force[0], Difference(&element, 18, -1), 1e-8);
  for (int i = 0; i < 18; i++) assert_near(fx[i], Difference(&element, 18, i), 1e-7);
  for (int k = 1; k < 3; k++) {
    double column[18];

    moved = element;
    moved.F33 += k == 1 ? 1e-5 : -1e-5;
    (void)Evaluate(&moved);
    LamElementStretch33(&moved.geometry, moved.law, &wall, NULL, (const double(*)[2])Displacements(&moved).u, moved.F33,
                        &moved.stress, &force[k], column, &scratch);
  }
  assert_near(ff, (force[1] - force[2]) / 2e-5, 1e-6 * ff);
}

/* A rigid rotation keeps the energy and turns the forces. */
TEST(RotationTurnsTheForces)
{
  const double c = cos(0.9), s = sin(0.9);
  Element element = RandomElement(&(uint64_t){14}), turned = element;
  const LamElementResult before = Evaluate(&element);
  LamElementResult after;

  for (int a = 0; a < 9; a++) {
    turned.x[a][0] = c * element.x[a][0] - s * element.x[a][1];
    turned.x[a][1] = s * element.x[a][0] + c * element.x[a][1];
  }
  after = Evaluate(&turned);
  assert_near(after.energy, before.energy, 1e-12 * before.energy);
  for (int a = 0; a < 9; a++) {
    assert_near(after.f[2 * a], c * before.f[2 * a] - s * before.f[2 * a + 1], 1e-11);
    assert_near(after.f[2 * a + 1], s * before.f[2 * a] + c * before.f[2 * a + 1], 1e-11);
  }
}

/* A parallelogram moved by x1 = X1 + c X1^2/2, x2 = X2, which quadratic shape functions hold exactly: J = 1 + c X1. */
static Element Parallelogram(double c)
{
  Element element;

  NewElement(&element, &(uint64_t){1});
  for (int a = 0; a < 9; a++) {
    element.X[a][0] = 0.2 * grid[a][0] + 0.05 * grid[a][1];
    element.X[a][1] = 0.02 * grid[a][0] + 0.1 * grid[a][1];
    element.x[a][0] = element.X[a][0] + 0.5 * c * element.X[a][0] * element.X[a][0];
    element.x[a][1] = element.X[a][1];
  }
  assert_int_equal(LamElementSetGeometry((const double(*)[2])element.X, fibre, &element.geometry), 0);
  return element;
}

/* A dilatation that is linear in X is its own projection: the volumetric energy is that of J = 1 + c X1. */
TEST(LinearDilatationIsProjectedOntoItself)
{
  const LamWall fluid = {.bulk_modulus = 1000.0};
  const double c = 0.3;
  Element element = Parallelogram(c);
  double energy = 0.0, expected = 0.0;
  PetscBool valid;

  LamElementEnergy(&element.geometry, element.law, &fluid, NULL, (const double(*)[2])Displacements(&element).u, 1.0,
                   &energy, &valid);
  assert_true(valid);
  for (int g = 0; g < LAM_GAUSS; g++) {
    double xi, eta, weight, N[9], dN[9][2], X1 = 0.0;
    KernelPoint u;

    LamGaussPoint(g, &xi, &eta, &weight);
    LamShape(xi, eta, N, dN);
    for (int a = 0; a < 9; a++) X1 += N[a] * element.X[a][0];
    u = VolumetricAt(&fluid, c * X1);
    expected += element.geometry.weight[g] * u.W;
  }
  assert_near(energy, expected, 1e-12 * expected);
}

/* The pressure functions are orthonormal over the element. */
TEST(PressureBasisIsOrthonormal)
{
  Element element;

  NewElement(&element, &(uint64_t){15});
  for (int k = 0; k < LAM_PRESSURES; k++)
    for (int l = 0; l < LAM_PRESSURES; l++) {
      double dot = 0.0;

      for (int g = 0; g < LAM_GAUSS; g++)
        dot += element.geometry.weight[g] * element.geometry.psi[k][g] * element.geometry.psi[l][g];
      assert_near(dot, k == l ? 1.0 : 0.0, 1e-13);
    }
}

/* A full update along dx and dF33 leads the independent stresses to those of x + dx, F33 + dF33, up to the square. */
TEST(StressUpdateIsTheLinearisation)
{
  double error[2];

  for (int k = 0; k < 2; k++) {
    const double size = k == 0 ? 1e-3 : 5e-4;
    uint64_t seed = 16, direction = 17;
    Element element = RandomElement(&seed), moved = element;
    double dx[9][2];

    (void)Evaluate(&element);
    for (int a = 0; a < 9; a++)
      for (int i = 0; i < 2; i++) {
        dx[a][i] = size * RandomReal(&direction, -1, 1);
        moved.x[a][i] += dx[a][i];
      }
    moved.F33 += size;
    assert_true(LamElementSetConsistentStress(&moved.geometry, moved.law, &wall,
                                              (const double(*)[2])Displacements(&moved).u, moved.F33, &moved.stress));
    LamElementUpdateStress(&element.geometry, &wall, (const double(*)[2])Displacements(&element).u,
                           (const double(*)[2])dx, element.F33, size, 1.0, &element.stress);
    error[k] = 0.0;
    for (int p = 0; p < LAM_PRESSURES; p++) error[k] += fabs(element.stress.p[p] - moved.stress.p[p]);
    for (int g = 0; g < LAM_GAUSS; g++) error[k] += fabs(element.stress.s[g] - moved.stress.s[g]);
  }
  assert_true(fabs(error[0] / error[1] - 4.0) < 0.1);
}

TEST(InsideOutElementIsInvalid)
{
  const double mirror[4] = {-1, 0, 0, 1};
  Element element;
  LamElementResult result;
  PetscBool valid;

  NewElement(&element, &(uint64_t){18});
  MoveAffinely(&element, mirror);
  LamElementEvaluate(&element.geometry, element.law, &wall, NULL, (const double(*)[2])Displacements(&element).u, 1.0,
                     &element.stress, &result, &valid);
  assert_false(valid);
  assert_false(LamElementIsValid(&element.geometry, (const double(*)[2])Displacements(&element).u, 1.0));
}

/* Fields of a homogeneous stretch along the fibres: sqrt(I4) and the principal stress of the kernels. */
TEST(FieldsOfAffineStretchAreExact)
{
  const double F[4] = {1.2, 0.3, -0.1, 0.9}, J = F[0] * F[3] - F[1] * F[2];
  Element element;
  double stretch[LAM_GAUSS], stress[LAM_GAUSS], P[4], s11, s12, s22;

  NewElement(&element, &(uint64_t){19});
  MoveAffinely(&element, F);
  LamElementFields(&element.geometry, element.law, &wall, NULL, (const double(*)[2])Displacements(&element).u, 1.0,
                   stretch, stress);
  (void)Homogeneous(&element, F, P);
  s11 = (P[0] * F[0] + P[1] * F[1]) / J;
  s12 = (P[0] * F[2] + P[1] * F[3]) / J;
  s22 = (P[2] * F[2] + P[3] * F[3]) / J;
  for (int g = 0; g < LAM_GAUSS; g++) {
    assert_near(stretch[g], hypot(F[0] * fibre[0] + F[1] * fibre[1], F[2] * fibre[0] + F[3] * fibre[1]), 1e-12);
    assert_near(stress[g], 0.5 * (s11 + s22) + hypot(0.5 * (s11 - s22), s12), 1e-10);
  }
}

/* A state whose energy overflows is refused by all that evaluates it. */
TEST(OverflowIsInvalid)
{
  const LamWall steep = {
      .law = LAM_WALL_FIBRE_EXPONENTIAL, .C1 = 0.7, .C2 = 0.3, .k1 = 1.0, .k2 = 1e6, .bulk_modulus = 1000.0};
  const double F[4] = {1.5, 0, 0, 1.0};
  LamElementResult result;
  PetscBool valid;
  Element element;
  double energy;

  NewElement(&element, &(uint64_t){5});
  assert_int_equal(LamWallLawGet(steep.law, &element.law), 0);
  MoveAffinely(&element, F);
  const NodeVectors u = Displacements(&element);

  LamElementEnergy(&element.geometry, element.law, &steep, NULL, (const double(*)[2])u.u, 1.0, &energy, &valid);
  assert_false(valid);
  LamElementEvaluate(&element.geometry, element.law, &steep, NULL, (const double(*)[2])u.u, 1.0, &element.stress,
                     &result, &valid);
  assert_false(valid);
  assert_false(LamElementSetConsistentStress(&element.geometry, element.law, &steep, (const double(*)[2])u.u, 1.0,
                                             &element.stress));
}

/* All derivatives of the element, with fibres that are dispersed: E depends on I1, and so on F33. */
TEST(DispersedFibresFollowFromTheirEnergy)
{
  wall = (LamWall){.law = LAM_WALL_FIBRE_EXPONENTIAL,
                   .C1 = 0.7,
                   .C2 = 0.3,
                   .k1 = 6.0,
                   .k2 = 1.5,
                   .dispersion = 0.2,
                   .bulk_modulus = 1000.0};
  ResidualIsDerivativeOfEnergy(state);
  ConsistentTangentIsDerivativeOfResidual(state);
  TangentIsSymmetric(state);
  Stretch33DerivativesFollowFromEnergy(state);
  RotationTurnsTheForces(state);
  StressUpdateIsTheLinearisation(state);
  wall = quadratic;
}

/* Affine F and F33 with k1/(2 k2) (exp(k2 E^2) - 1), E = d (I1 - 3) + (1 - 3 d) (I4 - 1) (Gasser, Ogden & Holzapfel
   2006); for d = 1/3 the direction of the fibres plays no part. */
TEST(DispersedFibresHaveTheEnergyOfTheirPaper)
{
  const double F[4] = {1.2, 0.3, -0.1, 0.9}, F33 = 1.1, Fm[2] = {1.2 * 0.8 + 0.3 * 0.6, -0.1 * 0.8 + 0.9 * 0.6};
  const double I1 = 1.2 * 1.2 + 0.3 * 0.3 + 0.1 * 0.1 + 0.9 * 0.9 + 1.1 * 1.1, I4 = Fm[0] * Fm[0] + Fm[1] * Fm[1];
  const double dispersion[3] = {0.0, 0.15, 1.0 / 3.0};
  Element element;

  NewElement(&element, &(uint64_t){5});
  MoveAffinely(&element, F);
  element.F33 = F33;
  const double plain = (wall.C4 = 0.0, Energy(&element));

  wall =
      (LamWall){.law = LAM_WALL_FIBRE_EXPONENTIAL, .C1 = 0.7, .C2 = 0.3, .k1 = 6.0, .k2 = 1.5, .bulk_modulus = 1000.0};
  assert_int_equal(LamWallLawGet(wall.law, &element.law), 0);
  for (int d = 0; d < 3; d++) {
    const double E = dispersion[d] * (I1 - 3.0) + (1.0 - 3.0 * dispersion[d]) * (I4 - 1.0);

    wall.dispersion = dispersion[d];
    assert_near(Energy(&element) - plain, Area(&element) * 2.0 * expm1(1.5 * E * E), 1e-12 * plain);
  }
  wall = quadratic;
}
