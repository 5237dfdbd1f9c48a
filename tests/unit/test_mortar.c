/* The mortar kernel: its derivatives against finite differences at random states, and rigid motions. */
#include "support/rve_fixture.h"
#include "support/mortar_fixture.h"

#define STATES 12
#define POINTS 8      /* with them the quadrature error of the variation is below the tolerances */
#define STEP 2e-4     /* of the differences */
#define MARGIN 5e-3   /* between break points: the second derivatives jump where two of them meet */
#define RAMP 0.1      /* width of the ramp at the overlap's ends, in edges */
#define RAMP_STATES 4 /* the last ones: one end or both inside the ramp */

/* Distance of the plane of a master end inside the slave's ends, in edges; lower end first. */
static const double ends[STATES][2] = {{-0.4, -0.3},  {-0.3, -0.4}, {0.3, -0.3}, {0.3, -0.2},
                                       {-0.3, 0.3},   {-0.2, 0.3},  {0.3, 0.3},  {0.2, 0.3},
                                       {0.05, -0.03}, {-0.4, 0.05}, {0.05, 0.3}, {0.06, 0.05}};
static Chains states[STATES];
static ChainValues values[STATES];

static PetscBool IsApart(double s, double from[], int count)
{
  for (int k = 0; k < count; k++)
    if (fabs(s - from[k]) < MARGIN) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* No two break points close to each other, no end of the overlap close to either end of its ramp. */
static PetscBool IsSmooth(const ChainValues *v)
{
  double seams[] = {0.0, 0.5, 1.0, 1.5, 2.0, RAMP, SLAVE_EDGES - RAMP};

  for (int k = 0; k + 1 < v->break_count; k++)
    if (v->breaks[k + 1] - v->breaks[k] < MARGIN) return PETSC_FALSE;
  for (int end = 0; end <= MASTER_EDGES; end += MASTER_EDGES)
    if (v->cut[end] > 0.0 && v->cut[end] < SLAVE_EDGES && !IsApart(v->cut[end], seams, 7)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static int DrawStates(void **state)
{
  uint64_t seed = 11;

  for (int k = 0; k < STATES; k++) do {
      states[k] = RandomChains(ends[k][0], ends[k][1], &seed);
      if (EvaluateChains(&states[k], POINTS, &values[k])) return 1;
    } while (!IsSmooth(&values[k]));
  return 0;
}

static double Largest(int n, const double v[])
{
  double largest = 0.0;

  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(v[i]));
  return largest;
}

/* Sixth-order central differences of the values in dof i. */
static ChainValues Difference(const Chains *at, int i)
{
  static const double weight[3] = {45.0, -9.0, 1.0};
  ChainValues sum = {.energy = 0.0};

  for (int k = 1; k <= 3; k++)
    for (int side = -1; side <= 1; side += 2) {
      const double w = side * weight[k - 1] / (60.0 * STEP);
      Chains moved = *at;
      ChainValues v;

      moved.x[i / 2][i % 2] += side * k * STEP;
      assert_int_equal(EvaluateChains(&moved, POINTS, &v), 0);
      for (int A = 0; A < HATS; A++) sum.gap[A] += w * v.gap[A];
      for (int j = 0; j < CHAIN_DOFS; j++) sum.gradient[j] += w * v.gradient[j];
    }
  return sum;
}

TEST(GapRowsAreDerivativesOfWeightedGaps)
{
  for (int k = 0; k < STATES; k++) {
    const double largest = Largest(HATS * CHAIN_DOFS, &values[k].dgap[0][0]);

    for (int i = 0; i < CHAIN_DOFS; i++) {
      const ChainValues difference = Difference(&states[k], i);

      for (int A = 0; A < HATS; A++) assert_near(values[k].dgap[A][i], difference.gap[A], 1e-10 * largest);
    }
  }
}

TEST(HessianIsDerivativeOfGradient)
{
  for (int k = 0; k < STATES; k++) {
    const double largest = Largest(CHAIN_DOFS * CHAIN_DOFS, &values[k].hessian[0][0]);

    for (int i = 0; i < CHAIN_DOFS; i++) {
      const ChainValues difference = Difference(&states[k], i);

      for (int j = 0; j < CHAIN_DOFS; j++) assert_near(values[k].hessian[i][j], difference.gradient[j], 1e-9 * largest);
    }
  }
}

/* The states meant for it do end on the ramp, so that the differences test it. */
TEST(RampStatesEndOnTheRamp)
{
  for (int k = STATES - RAMP_STATES; k < STATES; k++) {
    const double low = values[k].breaks[0], high = SLAVE_EDGES - values[k].breaks[values[k].break_count - 1];

    assert_true((low > 0.0 && low < RAMP) || (high > 0.0 && high < RAMP));
  }
}

TEST(WeightsFillTheOverlap)
{
  for (int k = 0; k < STATES; k++) {
    const double *s = values[k].breaks, from = s[0], to = s[values[k].break_count - 1];
    double sum = 0.0;

    for (int A = 0; A < HATS; A++) sum += values[k].weight[A];
    assert_near(sum, states[k].J0[0] * (1.0 - from) + states[k].J0[1] * (to - 1.0), 1e-14);
  }
}

TEST(ForcesSumToZero)
{
  for (int k = 0; k < STATES; k++)
    for (int A = 0; A < HATS; A++)
      for (int d = 0; d < 2; d++) {
        double sum = 0.0;

        for (int a = 0; a < CHAIN_NODES; a++) sum += values[k].dgap[A][2 * a + d];
        assert_near(sum, 0.0, 1e-14);
      }
}

/* The rotation of all nodes: dx = (-y, x). */
static void RotationField(const Chains *c, double v[CHAIN_DOFS])
{
  for (int a = 0; a < CHAIN_NODES; a++) {
    v[2 * a] = -c->x[a][1];
    v[2 * a + 1] = c->x[a][0];
  }
}

TEST(RotationChangesNoGap)
{
  for (int k = 0; k < STATES; k++) {
    double v[CHAIN_DOFS];

    RotationField(&states[k], v);
    for (int A = 0; A < HATS; A++) {
      double change = 0.0;

      for (int i = 0; i < CHAIN_DOFS; i++) change += values[k].dgap[A][i] * v[i];
      assert_near(change, 0.0, 1e-14);
    }
  }
}

/* The forces turn with the nodes: H v = (-f_y, f_x). */
TEST(RotationTurnsTheForces)
{
  for (int k = 0; k < STATES; k++) {
    const double *f = values[k].gradient;
    double v[CHAIN_DOFS];

    RotationField(&states[k], v);
    for (int i = 0; i < CHAIN_DOFS; i++) {
      double change = 0.0;

      for (int j = 0; j < CHAIN_DOFS; j++) change += values[k].hessian[i][j] * v[j];
      assert_near(change, i % 2 == 0 ? -f[i + 1] : f[i - 1], 1e-12);
    }
  }
}

TEST_GROUP(.setup = DrawStates);
