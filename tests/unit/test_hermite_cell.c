/* Functions on a cube from what is known at its corners: exact there, C1 across faces, derivatives of each other. */
#include "support/test.h"
#include "support/random_reals.h"
#include <hermite_cell.h>

#define H 0.7
#define SAMPLES 50

/* Directions of the entries of a Hessian: 11 22 33 23 13 12. */
static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};

typedef LamJet (*Function)(const double x[3]);

static void RandomPoint(uint64_t *seed, double t[3])
{
  for (int k = 0; k < 3; k++) t[k] = RandomReal(seed, 0, 1);
}

/* A share `unknown` of the pure second derivatives is not known. */
static void RandomJet(uint64_t *seed, double unknown, LamJet *jet)
{
  jet->value = RandomReal(seed, -1, 1);
  for (int i = 0; i < 3; i++) jet->gradient[i] = RandomReal(seed, -1, 1);
  for (int i = 0; i < 6; i++) jet->hessian[i] = RandomReal(seed, -1, 1);
  jet->third = RandomReal(seed, -1, 1);
  for (int i = 0; i < 3; i++)
    if (RandomReal(seed, 0, 1) < unknown) jet->hessian[i] = NAN;
}

static void RandomCorners(uint64_t *seed, double unknown, LamJet corner[8])
{
  for (int c = 0; c < 8; c++) RandomJet(seed, unknown, &corner[c]);
}

static LamJet Quintic(const LamJet corner[8], const double t[3])
{
  LamJet jet = {0};

  LamHermiteQuintic(corner, H, t, &jet);
  return jet;
}

static LamJet Cubic(const LamJet corner[8], const double t[3])
{
  LamJet jet = {0};

  LamHermiteCubic(corner, H, t, &jet);
  return jet;
}

/* The Hessian is not part of it. */
static LamJet Edges(const LamJet corner[8], const double t[3])
{
  LamJet jet = {0};

  LamHermiteEdges(corner, H, t, &jet.value, jet.gradient);
  return jet;
}

static void assert_same_to_first_order(const LamJet *jet, const LamJet *expected, double tolerance)
{
  assert_near(jet->value, expected->value, tolerance);
  for (int i = 0; i < 3; i++) assert_near(jet->gradient[i], expected->gradient[i], tolerance);
}

static void assert_same(const LamJet *jet, const LamJet *expected, double tolerance)
{
  assert_same_to_first_order(jet, expected, tolerance);
  for (int i = 0; i < 6; i++) assert_near(jet->hessian[i], expected->hessian[i], tolerance);
}

TEST(the_quintic_returns_the_data_at_corners)
{
  LamJet corner[8];

  RandomCorners(&(uint64_t){1}, 0, corner);
  for (int c = 0; c < 8; c++) {
    const double t[3] = {c & 1, c >> 1 & 1, c >> 2};
    const LamJet jet = Quintic(corner, t);

    assert_same(&jet, &corner[c], 1e-13);
  }
}

/* Known: the data. Not known: that of the cubic along the edge, and the other end keeps its own. */
TEST(an_unknown_second_derivative_is_that_of_the_cubic)
{
  LamJet corner[8];

  RandomCorners(&(uint64_t){2}, 0.5, corner);
  for (int c = 0; c < 8; c++) {
    const double t[3] = {c & 1, c >> 1 & 1, c >> 2};
    const LamJet cubic = Cubic(corner, t), quintic = Quintic(corner, t);
    LamJet expected = corner[c];

    for (int k = 0; k < 3; k++)
      if (isnan(expected.hessian[k])) expected.hessian[k] = cubic.hessian[k];
    assert_same(&quintic, &expected, 1e-13);
  }
}

TEST(the_cubic_knows_no_pure_second_derivatives)
{
  uint64_t seed = 3;
  LamJet corner[8], other[8];

  RandomCorners(&seed, 0, corner);
  RandomCorners(&seed, 1, other);
  for (int c = 0; c < 8; c++) {
    other[c].value = corner[c].value;
    for (int i = 0; i < 3; i++) other[c].gradient[i] = corner[c].gradient[i];
    for (int i = 3; i < 6; i++) other[c].hessian[i] = corner[c].hessian[i];
    other[c].third = corner[c].third;
  }
  for (int n = 0; n < SAMPLES; n++) {
    double t[3];
    LamJet jet, expected;

    RandomPoint(&seed, t);
    expected = Cubic(corner, t);
    jet = Cubic(other, t);
    assert_same(&jet, &expected, 0);
    jet = Quintic(other, t);
    assert_same(&jet, &expected, 0);
  }
}

/* Central differences of value and gradient, of error 1e-8. */
static void check_derivatives(LamJet (*at)(const LamJet corner[8], const double t[3]), double unknown, int hessian)
{
  const double step = 1e-5;
  uint64_t seed = 4;

  for (int n = 0; n < SAMPLES; n++) {
    LamJet corner[8], jet, ahead[3], behind[3];
    double t[3];

    RandomCorners(&seed, unknown, corner);
    RandomPoint(&seed, t);
    jet = at(corner, t);
    for (int k = 0; k < 3; k++) {
      double forth[3] = {t[0], t[1], t[2]}, back[3] = {t[0], t[1], t[2]};

      forth[k] += step;
      back[k] -= step;
      ahead[k] = at(corner, forth);
      behind[k] = at(corner, back);
      assert_near(jet.gradient[k], (ahead[k].value - behind[k].value) / (2 * step * H), 1e-8);
    }
    for (int i = 0; hessian && i < 6; i++) {
      const int p = first[i], q = second[i];

      assert_near(jet.hessian[i], (ahead[p].gradient[q] - behind[p].gradient[q]) / (2 * step * H), 1e-7);
      assert_near(jet.hessian[i], (ahead[q].gradient[p] - behind[q].gradient[p]) / (2 * step * H), 1e-7);
    }
  }
}

TEST(derivatives_are_those_of_the_function)
{
  check_derivatives(Quintic, 0, 1);
  check_derivatives(Quintic, 0.3, 1);
  check_derivatives(Cubic, 0, 1);
  check_derivatives(Edges, 0, 0);
}

/* x^n and its first two derivatives. */
static void Power(double x, int n, double p[3])
{
  p[0] = pow(x, n);
  p[1] = n > 0 ? n * pow(x, n - 1) : 0;
  p[2] = n > 1 ? n * (n - 1) * pow(x, n - 2) : 0;
}

/* Adds c x^a y^b z^c for exponents n, with its third derivative xyz. */
static void AddMonomial(const double x[3], const int n[3], double c, LamJet *jet)
{
  double p[3][3];

  for (int k = 0; k < 3; k++) Power(x[k], n[k], p[k]);
  jet->value += c * p[0][0] * p[1][0] * p[2][0];
  for (int i = 0; i < 3; i++) {
    int d[3] = {0};

    d[i] = 1;
    jet->gradient[i] += c * p[0][d[0]] * p[1][d[1]] * p[2][d[2]];
  }
  for (int i = 0; i < 6; i++) {
    int d[3] = {0};

    d[first[i]]++;
    d[second[i]]++;
    jet->hessian[i] += c * p[0][d[0]] * p[1][d[1]] * p[2][d[2]];
  }
  jet->third += c * p[0][1] * p[1][1] * p[2][1];
}

/* Cubic in each of two variables, with random coefficients. */
static LamJet PairsOfCubics(const double x[3])
{
  uint64_t seed = 5;
  LamJet jet = {0};

  for (int a = 0; a <= 3; a++)
    for (int b = 0; b <= 3; b++) {
      const int n[3][3] = {{a, b, 0}, {0, a, b}, {b, 0, a}};

      for (int k = 0; k < 3; k++) AddMonomial(x, n[k], RandomReal(&seed, -1, 1), &jet);
    }
  return jet;
}

/* Cubic in each of the three variables. */
static LamJet TensorCubics(const double x[3])
{
  uint64_t seed = 12;
  LamJet jet = {0};

  for (int a = 0; a <= 3; a++)
    for (int b = 0; b <= 3; b++)
      for (int c = 0; c <= 3; c++) {
        const int n[3] = {a, b, c};

        AddMonomial(x, n, RandomReal(&seed, -1, 1), &jet);
      }
  return jet;
}

/* Cubic in each of two variables, and quintics in each. */
static LamJet PairsOfCubicsAndQuintics(const double x[3])
{
  LamJet jet = PairsOfCubics(x);

  for (int k = 0; k < 3; k++)
    for (int power = 4; power <= 5; power++) {
      int n[3] = {0};

      n[k] = power;
      AddMonomial(x, n, 0.5 + k + power, &jet);
    }
  return jet;
}

/* All monomials of degree up to 3. */
static LamJet CompleteCubic(const double x[3])
{
  uint64_t seed = 6;
  LamJet jet = {0};

  for (int a = 0; a <= 3; a++)
    for (int b = 0; a + b <= 3; b++)
      for (int c = 0; a + b + c <= 3; c++) {
        const int n[3] = {a, b, c};

        AddMonomial(x, n, RandomReal(&seed, -1, 1), &jet);
      }
  return jet;
}

/* Corners of a cube of edge H away from the origin. */
static const double origin[3] = {-0.4, 0.3, 0.1};

static void SampleCorners(Function f, LamJet corner[8])
{
  for (int c = 0; c < 8; c++) {
    const double x[3] = {origin[0] + H * (c & 1), origin[1] + H * (c >> 1 & 1), origin[2] + H * (c >> 2)};

    corner[c] = f(x);
  }
}

static void check_reproduces(LamJet (*at)(const LamJet corner[8], const double t[3]), Function f, int hessian)
{
  uint64_t seed = 7;
  LamJet corner[8];

  SampleCorners(f, corner);
  for (int n = 0; n < SAMPLES; n++) {
    double t[3], x[3];
    LamJet jet, expected;

    RandomPoint(&seed, t);
    for (int k = 0; k < 3; k++) x[k] = origin[k] + H * t[k];
    jet = at(corner, t);
    expected = f(x);
    if (hessian)
      assert_same(&jet, &expected, 1e-11);
    else
      assert_same_to_first_order(&jet, &expected, 1e-12);
  }
}

/* Cubics in each variable: x y z among them, of which the third derivative alone knows. */
TEST(functions_of_the_space_are_reproduced)
{
  check_reproduces(Cubic, PairsOfCubics, 1);
  check_reproduces(Cubic, TensorCubics, 1);
  check_reproduces(Quintic, TensorCubics, 1);
  check_reproduces(Quintic, PairsOfCubicsAndQuintics, 1);
}

TEST_IS(edges_reproduce_complete_cubics, check_reproduces(Edges, CompleteCubic, 0));

/* Two cubes side by side in direction k, with random data, known in common on the face between them only. */
static void RandomNeighbours(uint64_t *seed, int k, double unknown, LamJet low[8], LamJet high[8])
{
  RandomCorners(seed, unknown, low);
  RandomCorners(seed, unknown, high);
  for (int c = 0; c < 8; c++)
    if (!(c >> k & 1)) high[c] = low[c | 1 << k];
}

static void check_faces(double unknown)
{
  uint64_t seed = 8;

  for (int k = 0; k < 3; k++)
    for (int n = 0; n < SAMPLES; n++) {
      LamJet low[8], high[8], below, above;
      double t[3];

      RandomNeighbours(&seed, k, unknown, low, high);
      RandomPoint(&seed, t);
      t[k] = 1;
      below = Quintic(low, t);
      t[k] = 0;
      above = Quintic(high, t);
      assert_same_to_first_order(&below, &above, 1e-13);
    }
}

TEST(neighbours_agree_in_value_and_gradient)
{
  check_faces(0);
  check_faces(0.3);
  check_faces(1);
}

TEST(edges_are_continuous)
{
  uint64_t seed = 9;

  for (int k = 0; k < 3; k++)
    for (int n = 0; n < SAMPLES; n++) {
      LamJet low[8], high[8];
      double t[3], below;

      RandomNeighbours(&seed, k, 0, low, high);
      RandomPoint(&seed, t);
      t[k] = 1;
      below = Edges(low, t).value;
      t[k] = 0;
      assert_near(Edges(high, t).value, below, 1e-14);
    }
}

/* 3 y^4: its second derivative less that of the cubic is 6 H^2 at both ends. x^4 z: 2 H^2 z. */
static LamJet Quartics(const double x[3])
{
  const int quartic[3] = {0, 4, 0}, mixed[3] = {4, 0, 1};
  LamJet jet = {0};

  AddMonomial(x, quartic, 3, &jet);
  AddMonomial(x, mixed, 1, &jet);
  return jet;
}

TEST(sizes_are_those_of_fourth_derivatives_and_their_spread)
{
  LamJet corner[8];
  double bend[3], spread[3];

  SampleCorners(Quartics, corner);
  LamHermiteSizes(corner, H, bend, spread);
  assert_near(bend[0], H * H * H * sqrt(2 * (PetscSqr(origin[2]) + PetscSqr(origin[2] + H))), 1e-13);
  assert_near(bend[1], 6 * H * H * H, 1e-13);
  assert_near(bend[2], 0, 1e-13);
  assert_near(spread[0], H * H * H * H, 1e-13);
  assert_near(spread[1], 0, 1e-7);
}

TEST(results_are_added_to_the_sum)
{
  const double t[3] = {0.2, 0.5, 0.9};
  uint64_t seed = 11;
  LamJet corner[8], start, quintic, cubic, sum;

  RandomCorners(&seed, 0, corner);
  RandomJet(&seed, 0, &start);
  quintic = Quintic(corner, t);
  cubic = Cubic(corner, t);
  sum = start;
  LamHermiteQuintic(corner, H, t, &sum);
  LamHermiteCubic(corner, H, t, &sum);
  sum.value -= quintic.value + cubic.value;
  for (int i = 0; i < 3; i++) sum.gradient[i] -= quintic.gradient[i] + cubic.gradient[i];
  for (int i = 0; i < 6; i++) sum.hessian[i] -= quintic.hessian[i] + cubic.hessian[i];
  assert_same(&sum, &start, 1e-13);
}
