/* The kernel of the smooth contact law: law, spline, closest point and variations of the gap against finite
   differences, and what of it is known in advance. */
#include "support/test.h"
#include "support/random_reals.h"
#include "smooth.h"

#define DRAWS 20

/* Sixth-order central difference: weights of the values at +-1, +-2, +-3 steps. */
static const double central[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};

/* ---- the law ---- */

#define LAW_STEP 1e-3  /* of the differences, widths: their error is 1e-3^6 times derivatives of at most e^6 2^7 */
#define LAW_ERROR 1e-9 /* of values that are e^4 where walls lie deepest: rounding over the step */
static const double branches[3][2] = {{-4.0, -2.01}, {-1.99, -0.01}, {0.01, 0.99}}; /* widths; the seams left out */

typedef struct {
  double gap, width;
} LawPoint;
static LawPoint points[3 * DRAWS];
#define FOR_POINTS(p) for (const LawPoint *p = points; p < points + 3 * DRAWS; p++)

static LamTouchLaw LawAt(double gap, double width)
{
  LamTouchLaw law;

  LamTouchLawEvaluate(gap, width, &law);
  return law;
}

/* Differences of phi and phi' in the gap, or in the width. */
static LamTouchLaw LawDifference(const LawPoint *p, int in_width)
{
  const double step = LAW_STEP * p->width;
  LamTouchLaw sum = {.phi = 0.0};

  for (int k = 1; k <= 3; k++)
    for (int side = -1; side <= 1; side += 2) {
      const double moved = side * k * step, w = side * central[k - 1] / step;
      const LamTouchLaw law = LawAt(p->gap + (in_width ? 0.0 : moved), p->width + (in_width ? moved : 0.0));

      sum.phi += w * law.phi;
      sum.d += w * law.d;
    }
  return sum;
}

static void DrawPoints(void)
{
  uint64_t seed = 5;

  for (int k = 0; k < 3 * DRAWS; k++) {
    const double *range = branches[k / DRAWS];

    points[k].width = RandomReal(&seed, 1e-3, 3e-2);
    points[k].gap = points[k].width * RandomReal(&seed, range[0], range[1]);
  }
}

TEST(PressureIsDerivativeOfEnergy)
{
  FOR_POINTS(p) assert_near(LawAt(p->gap, p->width).d, LawDifference(p, 0).phi, LAW_ERROR);
}

TEST(StiffnessIsDerivativeOfPressure)
{
  FOR_POINTS(p) assert_near(p->width * LawAt(p->gap, p->width).dd, p->width * LawDifference(p, 0).d, LAW_ERROR);
}

TEST(WidthDerivativeOfEnergy)
{
  FOR_POINTS(p) assert_near(LawAt(p->gap, p->width).phi_width, LawDifference(p, 1).phi, LAW_ERROR);
}

TEST(WidthDerivativeOfPressure)
{
  FOR_POINTS(p)
  assert_near(p->width * LawAt(p->gap, p->width).d_width, p->width * LawDifference(p, 1).d, LAW_ERROR);
}

TEST(BranchesMeetWithTwoDerivatives)
{
  static const double seams[3] = {-LAM_SOFT_WIDTHS, 0.0, 1.0};
  const double width = 0.003, near = 1e-12; /* widths; the third derivative is at most 4 e^4 */

  for (int k = 0; k < 3; k++) {
    const LamTouchLaw a = LawAt((seams[k] - near) * width, width), b = LawAt((seams[k] + near) * width, width);

    assert_near(a.phi / width, b.phi / width, 1e-9);
    assert_near(a.d, b.d, 1e-9);
    assert_near(a.dd * width, b.dd * width, 1e-9);
  }
}

TEST(StrengthIsThePressureOfWallsThatJustTouch)
{
  assert_near(LawAt(0.0, 0.003).d, -1.0, 1e-15);
}

TEST(PressureIsQuadraticInTheGapOfSeparatedWalls)
{
  for (double x = 0.1; x < 1.0; x += 0.2) assert_near(LawAt(0.003 * x, 0.003).d, -(1.0 - x) * (1.0 - x), 1e-14);
}

TEST(PressureGrowsExponentiallyWithPenetration)
{
  for (double x = -1.9; x < 0.0; x += 0.2) assert_near(LawAt(0.003 * x, 0.003).d / exp(-2.0 * x), -1.0, 1e-14);
}

TEST(PressureContinuesInItsTangentWhereWallsLieDeep)
{
  const double width = 0.003, e4 = exp(2.0 * LAM_SOFT_WIDTHS);

  for (double deeper = 0.0; deeper < 10.0; deeper += 1.0)
    assert_near(LawAt(-(LAM_SOFT_WIDTHS + deeper) * width, width).d, -e4 * (1.0 + 2.0 * deeper), 1e-12 * e4 * 20.0);
}

TEST(NothingActsBeyondTheWidth)
{
  const LamTouchLaw law = LawAt(0.0031, 0.003);

  assert_true(law.phi == 0.0 && law.d == 0.0 && law.dd == 0.0 && law.phi_width == 0.0 && law.d_width == 0.0);
}

/* ---- the spline ---- */

#define SPLINE_STEP 1e-2 /* the differences are exact for cubics */
#define SPLINE_ERROR 1e-13

static LamSplineWeights WeightsAt(double t)
{
  LamSplineWeights w;

  LamSplineWeightsAt(t, &w);
  return w;
}

TEST(WeightsSumToOneEverywhere)
{
  for (double t = 0.0; t <= 1.0; t += 0.125) {
    const LamSplineWeights w = WeightsAt(t);

    assert_near(w.N[0] + w.N[1] + w.N[2] + w.N[3], 1.0, 1e-15);
    assert_near(w.dN[0] + w.dN[1] + w.dN[2] + w.dN[3], 0.0, 1e-15);
    assert_near(w.ddN[0] + w.ddN[1] + w.ddN[2] + w.ddN[3], 0.0, 1e-15);
  }
}

TEST(DerivativesOfTheWeights)
{
  for (double t = 0.0; t <= 1.0; t += 0.125) {
    const LamSplineWeights w = WeightsAt(t);

    for (int a = 0; a < LAM_SPAN; a++) {
      double d = 0.0, dd = 0.0;

      for (int k = 1; k <= 3; k++) {
        const LamSplineWeights up = WeightsAt(t + k * SPLINE_STEP), down = WeightsAt(t - k * SPLINE_STEP);

        d += central[k - 1] * (up.N[a] - down.N[a]) / SPLINE_STEP;
        dd += central[k - 1] * (up.dN[a] - down.dN[a]) / SPLINE_STEP;
      }
      assert_near(w.dN[a], d, SPLINE_ERROR);
      assert_near(w.ddN[a], dd, SPLINE_ERROR);
    }
  }
}

/* Control point a + 1 of a span is control point a of the next one. */
TEST(SpansMeetWithTwoDerivatives)
{
  const LamSplineWeights end = WeightsAt(1.0), start = WeightsAt(0.0);

  assert_near(end.N[0], 0.0, 0.0);
  assert_near(start.N[LAM_SPAN - 1], 0.0, 0.0);
  for (int a = 0; a + 1 < LAM_SPAN; a++) {
    assert_near(end.N[a + 1], start.N[a], 1e-15);
    assert_near(end.dN[a + 1], start.dN[a], 1e-15);
    assert_near(end.ddN[a + 1], start.ddN[a], 1e-15);
  }
}

TEST(ContourOfEvenlySpacedNodesIsTheLineThroughThem)
{
  static const double c[LAM_SPAN][2] = {{-1, -3}, {0, 0}, {1, 3}, {2, 6}};

  for (double t = 0.0; t <= 1.0; t += 0.125) {
    const LamSplineWeights w = WeightsAt(t);
    double y[2];

    LamSplineSum(w.N, c, y);
    assert_near(y[0], t, 1e-15);
    assert_near(y[1], 3.0 * t, 1e-14);
  }
}

/* ---- a point near an arc ---- */

#define ARCS 40
#define ARC_STEP                                                                                                       \
  1e-3                /* of the differences; gaps vary over the span's length, 0.1: errors of (1e-2)^6, and rounding   \
                       */
#define SCATTER 0.012 /* of the control points about a circle: a tenth of a span */
#define ARC_DEPTH 0.1 /* of the point, to both sides; less than the radius of curvature, 0.4 */

/* Control points of the point, which lies at `at` on its own contour, and of the span. */
typedef struct {
  double x[2 * LAM_SPAN][2], at;
} Arc;
#define ARC_DOFS (4 * LAM_SPAN)
static Arc arcs[ARCS];
#define FOR_ARCS(arc) for (const Arc *arc = arcs; arc < arcs + ARCS; arc++)

static const double (*SpanOf(const Arc *arc))[2]
{
  return (const double(*)[2])(arc->x + LAM_SPAN);
}

static void PointOf(const Arc *arc, double X[2])
{
  const LamSplineWeights w = WeightsAt(arc->at);

  LamSplineSum(w.N, (const double(*)[2])arc->x, X);
}

/* (X - y).tau at t. */
static double AlongAt(const double c[LAM_SPAN][2], const double X[2], double t)
{
  const LamSplineWeights w = WeightsAt(t);
  double y[2], tau[2];

  LamSplineSum(w.N, c, y);
  LamSplineSum(w.dN, c, tau);
  return (X[0] - y[0]) * tau[0] + (X[1] - y[1]) * tau[1];
}

/* Whether it is positive at the start and negative at the end, with a margin. */
static int IsBeside(const Arc *arc)
{
  double X[2];

  PointOf(arc, X);
  return AlongAt(SpanOf(arc), X, 0.05) > 0.0 && AlongAt(SpanOf(arc), X, 0.95) < 0.0;
}

/* Control points near a circle of radius 0.4, 0.3 apart in angle, counter-clockwise; the point's own ones near a line
   beside it, in the other direction. */
static Arc RandomArc(double depth, uint64_t *seed)
{
  Arc arc = {.at = RandomReal(seed, 0.0, 1.0)};

  for (int a = 0; a < LAM_SPAN; a++) {
    const double angle = 0.3 * (a - 1.5);

    arc.x[LAM_SPAN + a][0] = 0.4 * cos(angle) + RandomReal(seed, -SCATTER, SCATTER);
    arc.x[LAM_SPAN + a][1] = 0.4 * sin(angle) + RandomReal(seed, -SCATTER, SCATTER);
    arc.x[a][0] = 0.4 + depth + RandomReal(seed, -SCATTER, SCATTER);
    arc.x[a][1] = 0.12 * (1.5 - a) + RandomReal(seed, -SCATTER, SCATTER);
  }
  return arc;
}

static int DrawAll(void **state)
{
  uint64_t seed = 7;

  for (int k = 0; k < ARCS; k++) do {
      arcs[k] = RandomArc(ARC_DEPTH * (2.0 * k / (ARCS - 1) - 1.0), &seed);
    } while (!IsBeside(&arcs[k]));
  DrawPoints();
  return 0;
}

static LamSplineCurve CurveOf(const Arc *arc)
{
  LamSplineCurve curve;

  LamSplineCurveOf(SpanOf(arc), &curve);
  return curve;
}

static double ClosestTo(const Arc *arc)
{
  const LamSplineCurve curve = CurveOf(arc);
  double X[2], t;

  PointOf(arc, X);
  assert_true(LamSplineClosest(&curve, X, (double[]){AlongAt(SpanOf(arc), X, 0.0), AlongAt(SpanOf(arc), X, 1.0)},
                               PETSC_TRUE, &t));
  return t;
}

static LamTouchGap GapOf(const Arc *arc)
{
  const LamSplineCurve curve = CurveOf(arc);
  LamTouchGap gap;
  double X[2];

  PointOf(arc, X);
  LamTouchGapAt(&curve, X, ClosestTo(arc), &gap);
  return gap;
}

/* The contour's point at t. */
static void ContourAt(const Arc *arc, double t, double y[2])
{
  const LamSplineWeights w = WeightsAt(t);

  LamSplineSum(w.N, SpanOf(arc), y);
}

/* Distance from the contour's point at t; *along (or NULL): its component along the tangent. */
static double DistanceAt(const Arc *arc, double t, double *along)
{
  const LamSplineWeights w = WeightsAt(t);
  double X[2], y[2], tau[2];

  PointOf(arc, X);
  LamSplineSum(w.N, SpanOf(arc), y);
  LamSplineSum(w.dN, SpanOf(arc), tau);
  if (along) *along = ((X[0] - y[0]) * tau[0] + (X[1] - y[1]) * tau[1]) / hypot(tau[0], tau[1]);
  return hypot(X[0] - y[0], X[1] - y[1]);
}

TEST(CurveIsTheSpline)
{
  FOR_ARCS(arc)
  for (double t = 0.0; t <= 1.0; t += 0.125) {
    const LamSplineCurve curve = CurveOf(arc);
    const LamSplineWeights w = WeightsAt(t);
    double at[3][2], sum[3][2];

    LamSplineAt(&curve, t, at[0], at[1], at[2]);
    LamSplineSum(w.N, SpanOf(arc), sum[0]);
    LamSplineSum(w.dN, SpanOf(arc), sum[1]);
    LamSplineSum(w.ddN, SpanOf(arc), sum[2]);
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < 2; d++) assert_near(at[k][d], sum[k][d], 1e-15);
  }
}

TEST(InASharpBendTheNearerSideIsTheClosest)
{
  static const double bend[LAM_SPAN][2] = {{-0.6, -0.1}, {0.05, -0.04}, {0.05, 0.04}, {-0.6, 0.1}};
  LamSplineCurve curve;

  LamSplineCurveOf(bend, &curve);
  for (double side = -0.0295; side < 0.03; side += 0.001) { /* behind both sides, whose distances differ */
    const double X[2] = {-0.04, side}, ends[2] = {AlongAt(bend, X, 0.0), AlongAt(bend, X, 1.0)};
    double t, least = INFINITY, y[2], tau[2], second[2];

    assert_true(LamSplineClosest(&curve, X, ends, PETSC_FALSE, &t));
    for (double s = 0.0; s <= 1.0; s += 1e-3) {
      LamSplineAt(&curve, s, y, tau, second);
      least = fmin(least, hypot(X[0] - y[0], X[1] - y[1]));
    }
    LamSplineAt(&curve, t, y, tau, second);
    assert_in_range(1e6 * (least - hypot(X[0] - y[0], X[1] - y[1])), 0, 10);
  }
}

TEST(ArcsLieOnBothSidesOfTheirPoints)
{
  int outside = 0;

  FOR_ARCS(arc) outside += GapOf(arc).gap > 0.0;
  assert_in_range(outside, ARCS / 4, 3 * ARCS / 4);
}

TEST(ClosestPointIsPerpendicular)
{
  FOR_ARCS(arc)
  {
    double along;

    (void)DistanceAt(arc, ClosestTo(arc), &along);
    assert_near(along, 0.0, 1e-15); /* a few roundings of positions of 0.5 */
  }
}

TEST(NoPointOfTheArcIsCloser)
{
  FOR_ARCS(arc)
  {
    const double least = DistanceAt(arc, ClosestTo(arc), NULL);

    for (int k = 0; k <= 1000; k++) assert_true(DistanceAt(arc, k / 1000.0, NULL) >= least * (1.0 - 1e-14));
  }
}

/* The arcs run counter-clockwise about the origin: their right side is outside. */
TEST(GapIsTheDistancePositiveOutside)
{
  FOR_ARCS(arc)
  {
    const LamTouchGap gap = GapOf(arc);
    double X[2], y[2];

    PointOf(arc, X);
    ContourAt(arc, gap.t, y);
    assert_near(fabs(gap.gap), hypot(X[0] - y[0], X[1] - y[1]), 1e-15);
    assert_true((gap.gap > 0.0) == (hypot(X[0], X[1]) > hypot(y[0], y[1])));
  }
}

/* ---- variations: of the function a gap + b gap^2/2, whose derivatives are a + b gap and b ---- */

#define SLOPE 0.7 /* a */
#define BEND 3.0  /* b */

static double FunctionOf(const Arc *arc)
{
  const double gap = GapOf(arc).gap;

  return SLOPE * gap + 0.5 * BEND * gap * gap;
}

/* Control points for nodes: those of the point's arc, then those of the other one; the last of either is not used. */
static int NodeOf(int i)
{
  return i < LAM_SPAN ? i : i - LAM_SPAN + LAM_SPAN_NODES;
}

static void VariationOf(const Arc *arc, double f[ARC_DOFS], double K[ARC_DOFS][ARC_DOFS])
{
  const LamTouchGap gap = GapOf(arc);
  const LamSplineWeights point = WeightsAt(arc->at), closest = WeightsAt(gap.t);
  LamTouchWeights weights = {0};
  double of_nodes[LAM_BLOCK_DOFS] = {0}, by_nodes[LAM_BLOCK_DOFS][LAM_BLOCK_DOFS] = {{0}};

  for (int a = 0; a < LAM_SPAN; a++) {
    weights.N[NodeOf(a)] = point.N[a];
    weights.N[NodeOf(LAM_SPAN + a)] = -closest.N[a];
    weights.dN[NodeOf(LAM_SPAN + a)] = closest.dN[a];
  }
  LamTouchAddVariation(&gap, &weights, SLOPE + BEND * gap.gap, BEND, of_nodes, K ? by_nodes : NULL);
  for (int i = 0; i < ARC_DOFS; i++) {
    f[i] = of_nodes[2 * NodeOf(i / 2) + i % 2];
    for (int j = 0; K && j < ARC_DOFS; j++) {
      const int p = 2 * NodeOf(i / 2) + i % 2, q = 2 * NodeOf(j / 2) + j % 2;

      K[i][j] = p >= 2 * LAM_SPAN_NODES && q < 2 * LAM_SPAN_NODES ? by_nodes[q][p] : by_nodes[p][q];
    }
  }
}

TEST(FirstVariationIsDerivativeOfTheGap)
{
  FOR_ARCS(arc)
  {
    double f[ARC_DOFS];

    VariationOf(arc, f, NULL);
    for (int i = 0; i < ARC_DOFS; i++) {
      double difference = 0.0;

      for (int k = 1; k <= 3; k++)
        for (int side = -1; side <= 1; side += 2) {
          Arc moved = *arc;

          moved.x[i / 2][i % 2] += side * k * ARC_STEP;
          difference += side * central[k - 1] * FunctionOf(&moved) / ARC_STEP;
        }
      assert_near(f[i], difference, 1e-11);
    }
  }
}

TEST(SecondVariationIsDerivativeOfTheFirst)
{
  FOR_ARCS(arc)
  {
    double f[ARC_DOFS], K[ARC_DOFS][ARC_DOFS];

    VariationOf(arc, f, K);
    for (int i = 0; i < ARC_DOFS; i++) {
      double difference[ARC_DOFS] = {0};

      for (int k = 1; k <= 3; k++)
        for (int side = -1; side <= 1; side += 2) {
          Arc moved = *arc;

          moved.x[i / 2][i % 2] += side * k * ARC_STEP;
          VariationOf(&moved, f, NULL);
          for (int j = 0; j < ARC_DOFS; j++) difference[j] += side * central[k - 1] * f[j] / ARC_STEP;
        }
      for (int j = 0; j < ARC_DOFS; j++) assert_near(K[i][j], difference[j], 1e-8);
    }
  }
}

/* At the centre of curvature the closest point is not unique, and the second derivative of the gap is infinite. */
TEST(SecondVariationIsBoundedAtTheCentreOfCurvature)
{
  FOR_ARCS(arc)
  {
    const LamSplineCurve curve = CurveOf(arc);
    LamTouchGap gap = GapOf(arc);
    double X[2], y[2];

    ContourAt(arc, gap.t, y);
    for (int d = 0; d < 2; d++) X[d] = y[d] + gap.normal[d] * gap.m / gap.b;
    LamTouchGapAt(&curve, X, 0.5, &gap);
    assert_true(gap.H > 0.04 * gap.m);
  }
}

TEST_GROUP(.setup = DrawAll);
