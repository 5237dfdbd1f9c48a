/* The lamella on an edge: energy, forces and tangent at random states of curved edges. */
#include "support/test.h"
#include "support/random_reals.h"
#include "cohesive_edge.h"

#define EDGES 60
#define STEP 1e-5 /* of the differences; openings vary over 0.1 and their branches over 0.01 */

/* Every point of an edge is in one branch of the law. */
typedef enum { UNDAMAGED, SOFTENING, UNLOADING, PRESSED, BROKEN, BRANCHES } Branch;

typedef struct {
  double X[LAM_EDGE_NODES][2], u[LAM_EDGE_NODES][2], length;
  LamBond bond[LAM_EDGE_POINTS];
} Edge;
static Edge edges[EDGES];
#define FOR_EDGES(it) for (const Edge *it = edges; it < edges + EDGES; it++)

static const double central[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};

static void Turn(double angle, const double a[2], double out[2])
{
  out[0] = cos(angle) * a[0] - sin(angle) * a[1];
  out[1] = sin(angle) * a[0] + cos(angle) * a[1];
}

/* Integrity before; openings relative to delta_0 = 0.05 and the range of at least 0.5. */
static double IntegrityBefore(Branch branch)
{
  return branch == BROKEN ? 0.0 : branch == UNLOADING ? 0.05 : 1.0;
}

static double OpeningOf(Branch branch)
{
  return branch == UNDAMAGED ? 0.02 : branch == PRESSED ? -0.1 : 0.15;
}

static Edge RandomEdge(Branch branch, LamSoftening softening, uint64_t *seed)
{
  const double angle = RandomReal(seed, -3.0, 3.0), turn = RandomReal(seed, -0.5, 0.5), opening = OpeningOf(branch);
  const LamBondHistory before = {IntegrityBefore(branch), RandomReal(seed, 0.0, 1.0)};
  const double scatter = branch == UNDAMAGED ? 0.001 : 0.01;
  Edge edge = {.length = RandomReal(seed, 0.5, 2.0)};

  for (int k = 0; k < 3; k++) {
    const double X[2] = {0.5 * k + RandomReal(seed, -0.05, 0.05), RandomReal(seed, -0.05, 0.05)};
    const double jump[2] = {(branch == UNDAMAGED ? 0.01 : 0.04) + RandomReal(seed, -scatter, scatter),
                            opening + RandomReal(seed, -scatter, scatter)};

    for (int side = 0; side < 2; side++) {
      const double x[2] = {X[0] + (side ? -0.5 : 0.5) * jump[0], X[1] + (side ? -0.5 : 0.5) * jump[1]};

      Turn(angle, X, edge.X[3 * side + k]);
      Turn(angle + turn, x, edge.u[3 * side + k]);
      for (int d = 0; d < 2; d++) edge.u[3 * side + k][d] -= edge.X[3 * side + k][d];
    }
  }
  for (int q = 0; q < LAM_EDGE_POINTS; q++) {
    edge.bond[q].law = (LamCohesive){softening, 20.0, 1.0, 1.3, {0.3, 0.5}, 2.0};
    LamBondTake(&before, &edge.bond[q]);
  }
  return edge;
}

static int DrawEdges(void **state)
{
  uint64_t seed = 23;

  for (int k = 0; k < EDGES; k++)
    edges[k] = RandomEdge((Branch)(k % BRANCHES), (LamSoftening)(k / BRANCHES % 2), &seed);
  return 0;
}

static LamCohesiveSum SumOf(const Edge *edge)
{
  LamCohesiveSum sum;

  LamEdgeEvaluate(edge->X, edge->u, edge->bond, edge->length, PETSC_FALSE, &sum);
  return sum;
}

static void PointOf(const Edge *edge, int q, LamJump *jump, LamCohesiveStep *step)
{
  LamEdgePointEvaluate(edge->X, edge->u, q, &edge->bond[q], jump, step);
}

static Branch BranchOf(const Edge *edge, int q)
{
  LamCohesiveStep step;
  LamJump jump;

  PointOf(edge, q, &jump, &step);
  if (edge->bond[q].before.integrity == 0.0) return BROKEN;
  if (jump.normal < 0.0) return PRESSED;
  if (step.kappa > edge->bond[q].kappa) return SOFTENING;
  return edge->bond[q].before.integrity == 1.0 ? UNDAMAGED : UNLOADING;
}

TEST(EdgesAreInTheirBranches)
{
  FOR_EDGES(edge)
  for (int q = 0; q < LAM_EDGE_POINTS; q++) assert_int_equal(BranchOf(edge, q), (edge - edges) % BRANCHES);
}

TEST(RuleIsExactToItsDegree)
{
  for (int power = 0; power < 2 * LAM_EDGE_POINTS; power++) {
    double sum = 0.0;

    for (int q = 0; q < LAM_EDGE_POINTS; q++) sum += LamEdgeWeight(q) * pow(LamEdgePlace(q), power);
    assert_near(sum, 1.0 / (power + 1.0), 1e-15);
  }
}

TEST(EnergyIsTheSumOverPoints)
{
  FOR_EDGES(edge)
  {
    double sum = 0.0;

    for (int q = 0; q < LAM_EDGE_POINTS; q++) {
      LamCohesiveStep step;
      LamJump jump;

      PointOf(edge, q, &jump, &step);
      sum += edge->length * LamEdgeWeight(q) * (step.phi + 0.5 * edge->bond[q].pressing * jump.r);
    }
    assert_near(SumOf(edge).energy, sum, 1e-15);
  }
}

/* A jump that is the same everywhere is that of every point. */
TEST(RigidJumpIsTheJumpOfItsPoints)
{
  Edge edge = {.length = 1.0};

  for (int q = 0; q < LAM_EDGE_POINTS; q++) {
    LamCohesiveStep step;
    LamJump jump;

    edge.bond[q] = edges[0].bond[q];
    for (int k = 0; k < LAM_EDGE_NODES; k++) {
      edge.X[k][0] = 0.5 * (k % 3);
      edge.u[k][0] = k < 3 ? 0.007 : -0.003;
      edge.u[k][1] = k < 3 ? 0.2 : 0.17;
    }
    PointOf(&edge, q, &jump, &step);
    assert_near(jump.shear, 0.01, 1e-16);
    assert_near(jump.normal, 0.03, 1e-16);
  }
}

/* Relative to the largest entry. */
TEST(ForcesAreDerivativesOfTheEnergy)
{
  FOR_EDGES(edge)
  {
    const LamCohesiveSum sum = SumOf(edge);
    double largest = 0.0;

    for (int i = 0; i < LAM_EDGE_DOFS; i++) largest = fmax(largest, fabs(sum.f[i]));
    for (int i = 0; i < LAM_EDGE_DOFS; i++) {
      double f = 0.0;

      for (int k = 1; k <= 3; k++)
        for (int side = -1; side <= 1; side += 2) {
          Edge moved = *edge;

          moved.u[i / 2][i % 2] += side * k * STEP;
          f += side * central[k - 1] * SumOf(&moved).energy / STEP;
        }
      assert_near(sum.f[i], f, 1e-9 * largest);
    }
  }
}

static double LargestOf(const LamCohesiveSum *sum)
{
  double largest = 0.0;

  for (int i = 0; i < LAM_EDGE_DOFS * LAM_EDGE_DOFS; i++) largest = fmax(largest, fabs((&sum->K[0][0])[i]));
  return largest;
}

TEST(TangentIsDerivativeOfTheForces)
{
  FOR_EDGES(edge)
  {
    const LamCohesiveSum sum = SumOf(edge);
    const double largest = LargestOf(&sum);

    for (int j = 0; j < LAM_EDGE_DOFS; j++) {
      double column[LAM_EDGE_DOFS] = {0.0};

      for (int k = 1; k <= 3; k++)
        for (int side = -1; side <= 1; side += 2) {
          Edge moved = *edge;
          LamCohesiveSum there;

          moved.u[j / 2][j % 2] += side * k * STEP;
          there = SumOf(&moved);
          for (int i = 0; i < LAM_EDGE_DOFS; i++) column[i] += side * central[k - 1] * there.f[i] / STEP;
        }
      for (int i = 0; i < LAM_EDGE_DOFS; i++) assert_near(sum.K[i][j], column[i], 1e-8 * largest);
    }
  }
}

TEST(TangentIsSymmetric)
{
  FOR_EDGES(edge)
  {
    const LamCohesiveSum sum = SumOf(edge);

    for (int i = 0; i < LAM_EDGE_DOFS; i++)
      for (int j = 0; j < i; j++) assert_near(sum.K[i][j], sum.K[j][i], 1e-14 * LargestOf(&sum));
  }
}

/* All turned and moved: u = R (X + u) + t - X. */
static Edge Moved(const Edge *edge, double angle)
{
  Edge moved = *edge;

  for (int k = 0; k < LAM_EDGE_NODES; k++) {
    const double x[2] = {edge->X[k][0] + edge->u[k][0], edge->X[k][1] + edge->u[k][1]};

    Turn(angle, x, moved.u[k]);
    moved.u[k][0] += 0.3 - edge->X[k][0];
    moved.u[k][1] -= 0.2 + edge->X[k][1];
  }
  return moved;
}

TEST(ForcesAndTangentTurnWithTheBody)
{
  const double angle = 1.1;

  FOR_EDGES(edge)
  {
    const Edge moved = Moved(edge, angle);
    const LamCohesiveSum sum = SumOf(edge), turned = SumOf(&moved);

    assert_near(turned.energy, sum.energy, 1e-14);
    for (int i = 0; i < LAM_EDGE_DOFS; i += 2) {
      double f[2];

      Turn(angle, &sum.f[i], f);
      for (int d = 0; d < 2; d++) assert_near(turned.f[i + d], f[d], 1e-13);
      for (int j = 0; j < LAM_EDGE_DOFS; j += 2) { /* R K R^T: rows, then columns */
        double rows[2][2], block[2];

        for (int e = 0; e < 2; e++) Turn(angle, (const double[2]){sum.K[i][j + e], sum.K[i + 1][j + e]}, rows[e]);
        for (int d = 0; d < 2; d++) {
          Turn(angle, (const double[2]){rows[0][d], rows[1][d]}, block);
          for (int e = 0; e < 2; e++) assert_near(turned.K[i + d][j + e], block[e], 1e-12 * LargestOf(&sum));
        }
      }
    }
  }
}

/* The frame is that of the middle between both walls. */
TEST(SlaveAndMasterMayBeExchanged)
{
  FOR_EDGES(edge)
  {
    Edge exchanged = *edge;

    for (int k = 0; k < LAM_EDGE_NODES; k++)
      for (int d = 0; d < 2; d++) {
        exchanged.X[k][d] = edge->X[LAM_EDGE_NODES - 1 - k][d];
        exchanged.u[k][d] = edge->u[LAM_EDGE_NODES - 1 - k][d];
      }
    for (int q = 0; q < LAM_EDGE_POINTS; q++) exchanged.bond[q] = edge->bond[LAM_EDGE_POINTS - 1 - q];
    assert_near(SumOf(&exchanged).energy, SumOf(edge).energy, 1e-15);
  }
}

TEST(ForcesAreInEquilibrium)
{
  FOR_EDGES(edge)
  {
    const LamCohesiveSum sum = SumOf(edge);
    double force[2] = {0.0, 0.0}, moment = 0.0;

    for (int k = 0; k < LAM_EDGE_NODES; k++) {
      for (int d = 0; d < 2; d++) force[d] += sum.f[2 * k + d];
      moment += (edge->X[k][0] + edge->u[k][0]) * sum.f[2 * k + 1] - (edge->X[k][1] + edge->u[k][1]) * sum.f[2 * k];
    }
    assert_near(hypot(force[0], force[1]), 0.0, 1e-14);
    assert_near(moment, 0.0, 1e-14);
  }
}

TEST(BrokenEdgesDoNotPull)
{
  for (int k = BROKEN; k < EDGES; k += BRANCHES) {
    const LamCohesiveSum sum = SumOf(&edges[k]);

    for (int i = 0; i < LAM_EDGE_DOFS; i++) assert_near(sum.f[i], 0.0, 0.0);
  }
}

TEST_GROUP(.setup = DrawEdges);
