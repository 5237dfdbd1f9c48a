/* The search for walls near each other: undeformed tissue, sheared tissue against a search over all pairs, lumens that
   are nearly closed. */
#include "support/rve_fixture.h"
#include "support/cell_patch.h"
#include "support/turned_response.h"

#define WIDTH 3e-3 /* apothems: the usual one */
#define ALONG 4
#define PER_FACE (2 * ALONG) /* spans */
#define ROUNDING 1e-14

enum { ONE, FOUR, PATCH, TISSUES };

static LamMicrostructure Tissue(int kind)
{
  LamMicrostructure micro = kind == PATCH ? PatchTissue(3, 3, 30, LAM_INTERFACE_CONTACT) : ContactTissue(ALONG, 1);

  micro.along = ALONG;
  micro.through = 1;
  if (kind == FOUR) micro.cells[0] = micro.cells[1] = 2;
  return micro;
}

static LamWalls *WallsOf(LamRVE rve)
{
  return &rve->smooth->walls;
}

/* Of each loop: all cells are hexagons. */
static int SpansOf(const LamWalls *walls)
{
  return LamWallsSpans(walls, 0);
}

static int NodesOf(const LamWalls *walls)
{
  return LamWallsNodes(walls, 0);
}

/* Number of a point among those of all loops. */
static int PointOf(const LamWalls *walls, const LamTouching *touch)
{
  return LAM_TOUCH_POINTS * (touch->loop * SpansOf(walls) + touch->span) + touch->point;
}

/* The search with undeformed cells whose centres follow F. */
static void Search(LamRVE rve, const double F[9], LamTouchVisitor visitor, void *ctx)
{
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);
  const LamMesh *mesh = &rve->mesh;

  for (int k = 0; k < mesh->node_count; k++) {
    const int class = mesh->node_class[k];
    double centre[2];

    LamTissueCentre(mesh->tissue, LamMeshCellOfNode(mesh, k), centre);
    state->y[2 * class] = mesh->class_X[2 * class] + (F[0] - 1.0) * centre[0] + F[1] * centre[1];
    state->y[2 * class + 1] = mesh->class_X[2 * class + 1] + F[3] * centre[0] + (F[4] - 1.0) * centre[1];
  }
  LamWallsPlace(WallsOf(rve), F, state->y);
  LamWallsVisit(WallsOf(rve), WIDTH, visitor, ctx);
}

/* ---- undeformed tissue ---- */

typedef struct {
  LamRVE rve;
  int *partners;                    /* [loop][span][point] */
  double *gap;                      /* likewise: the last one */
  int count, facing, lumen, across; /* across: of a cell that shares a face in the lattice */
} Rest;
static Rest rest[TISSUES];
#define FOR_TISSUES(r) for (const Rest *r = rest; r < rest + TISSUES; r++)

/* Whether the centres of the two cells are 2 apothems apart. */
static int AreNeighbours(const LamMesh *mesh, const LamTouching *touch)
{
  double a[2], b[2];

  LamTissueCentre(mesh->tissue, touch->loop / 2, a);
  LamTissueCentre(mesh->tissue, touch->other / 2, b);
  return fabs(hypot(b[0] + touch->shift[0] - a[0], b[1] + touch->shift[1] - a[1]) - 2.0) < 1e-6;
}

static void CountAtRest(void *ctx, const LamTouching *touch)
{
  Rest *r = ctx;
  const LamWalls *walls = WallsOf(r->rve);
  const int at = PointOf(walls, touch);

  r->count++;
  r->facing += LamTouchIsFacing(walls, touch);
  r->lumen += LamTouchIsLumen(touch);
  r->across += AreNeighbours(&r->rve->mesh, touch);
  r->partners[at]++;
  r->gap[at] = touch->gap.gap;
}

static int SearchAtRest(void **state)
{
  for (int kind = 0; kind < TISSUES; kind++) {
    const LamMicrostructure micro = Tissue(kind);
    Rest *r = &rest[kind];
    size_t points;

    r->rve = NewRVE(&micro);
    points = (size_t)(LAM_TOUCH_POINTS * WallsOf(r->rve)->loops * SpansOf(WallsOf(r->rve)));
    r->partners = calloc(points, sizeof(*r->partners));
    r->gap = calloc(points, sizeof(*r->gap));
    Search(r->rve, turned_identity, CountAtRest, r);
  }
  return 0;
}

static int LeaveRest(void **state)
{
  for (int kind = 0; kind < TISSUES; kind++) {
    free(rest[kind].partners);
    free(rest[kind].gap);
    if (LamRVEDestroy(&rest[kind].rve)) return 1;
  }
  return 0;
}

TEST(UndeformedTissueTouchesOnlyFacingWalls)
{
  FOR_TISSUES(r) assert_int_equal(r->facing, r->count);
}

TEST(FacingWallsAreOfTheCellAcross)
{
  FOR_TISSUES(r) assert_int_equal(r->across, r->count);
}

TEST(UndeformedLumensAreOpen)
{
  FOR_TISSUES(r) assert_int_equal(r->lumen, 0);
}

/* Points whose own span and that of the wall across have all control points on the flat face. */
#define FOR_FLAT_POINTS(r, cell, face, at)                                                                             \
  for (int cell = 0; cell < r->rve->mesh.cell_count; cell++)                                                           \
    for (int face = 0; face < LAM_FACES; face++)                                                                       \
      for (int at = LAM_TOUCH_POINTS * (2 * cell * SpansOf(WallsOf(r->rve)) + (PER_FACE + 1) * face),                  \
               end_##at = at + LAM_TOUCH_POINTS * PER_FACE;                                                            \
           at < end_##at; at++)

static int HasNeighbour(const Rest *r, int cell, int face)
{
  return LamMeshNeighbour(&r->rve->mesh, LAM_FACES * cell + face) >= 0;
}

TEST(EachPointOfAFaceHasOnePartner)
{
  FOR_TISSUES(r)
  FOR_FLAT_POINTS(r, cell, face, at) if (HasNeighbour(r, cell, face)) assert_int_equal(r->partners[at], 1);
}

TEST(FlatWallsLieAtNoGap)
{
  FOR_TISSUES(r)
  FOR_FLAT_POINTS(r, cell, face, at) if (HasNeighbour(r, cell, face)) assert_near(r->gap[at], 0.0, ROUNDING);
}

TEST(WallsOnTheBorderOfAPatchTouchNothing)
{
  int border = 0;

  FOR_TISSUES(r)
  FOR_FLAT_POINTS(r, cell, face, at)
  {
    if (HasNeighbour(r, cell, face)) continue;
    border++;
    assert_int_equal(r->partners[at], 0);
  }
  assert_true(border > 0);
}

#define NODE_LENGTH (2.0 / sqrt(3.0) / PER_FACE)

TEST(WeightsAreTheLengthOfTheWallsButAtCorners)
{
  FOR_TISSUES(r)
  FOR_FLAT_POINTS(r, cell, face, at)
  {
    const int span = at / LAM_TOUCH_POINTS % (PER_FACE + 1);

    if (span == 0 || span == PER_FACE - 1) continue;
    assert_near(WallsOf(r->rve)->weight[at], NODE_LENGTH / LAM_TOUCH_POINTS, ROUNDING);
  }
}

/* Force on a node of the first face under a pressure of one on the contour of the outer walls of the first cell. */
static double ForceOfPressure(const LamWalls *walls, int node)
{
  double force = 0.0;

  for (int span = 0; span < PER_FACE; span++)
    for (int q = 0; q < LAM_TOUCH_POINTS; q++)
      for (int a = 0; a < LAM_SPAN; a++)
        for (int k = 0; k < LAM_SPAN_NODES; k++)
          if (LamWallsNode(walls, 0, span, k) == walls->node[node])
            force += walls->weight[LAM_TOUCH_POINTS * span + q] * walls->at[q].N[a] * walls->of[span].share[a][k];
  return force;
}

/* Node 4 lies at the end of an element, 3 and 5 in the middle. */
TEST(PressureOnAFlatWallLoadsItAsOnItsElements)
{
  FOR_TISSUES(r)
  for (int node = 3; node <= 5; node++)
    assert_near(ForceOfPressure(WallsOf(r->rve), node), NODE_LENGTH * (node == 4 ? 2.0 : 4.0) / 3.0, ROUNDING);
}

static void LargestGap(void *ctx, const LamTouching *touch)
{
  *(double *)ctx = fmax(*(double *)ctx, touch->gap.gap);
}

TEST(ClearanceIsTheGap)
{
  LamMicrostructure micro = Tissue(ONE);
  double gap = -1.0;

  micro.clearance = 0.9 * WIDTH; /* at corners, which the contours round, walls are farther apart than the width */
  {
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);

    Search(rve, turned_identity, LargestGap, &gap);
  }
  assert_true(gap < WIDTH);
  assert_true(gap > 0.9 * WIDTH - ROUNDING);
}

/* ---- a sheared period ---- */

#define PERIODS 15 /* of the search over all pairs, to both sides */
#define IMAGES (2 * PERIODS + 1)
#define DEEPEST 0.25 /* apothems to which points count (touching.c) */
static const double sheared[9] = {0.25, 2, 0, 0.05, 1.2,
                                  0,    0, 0, 1}; /* cells overlap images far along the first period */

typedef struct {
  const LamWalls *walls;
  signed char *found; /* [image][image][span][point][other span]: how often, less the times it must be */
  int count, farthest, outside;
  int far_facing; /* called facing, though the cells are no neighbours in the lattice */
} Pairs;

static size_t PairOf(const Pairs *p, int i, int j, int span, int point, int other)
{
  const size_t image = (size_t)((i + PERIODS) * IMAGES + j + PERIODS);

  return (image * LAM_TOUCH_POINTS * SpansOf(p->walls) + LAM_TOUCH_POINTS * span + point) * SpansOf(p->walls) + other;
}

static void MarkFound(void *ctx, const LamTouching *touch)
{
  Pairs *p = ctx;
  const double(*L)[2] = p->walls->mesh->period, *S = touch->shift, det = L[0][0] * L[1][1] - L[0][1] * L[1][0];
  const int i = (int)lround((S[0] * L[1][1] - S[1] * L[1][0]) / det);
  const int j = (int)lround((L[0][0] * S[1] - L[0][1] * S[0]) / det);

  if (LamTouchIsLumen(touch)) return;
  p->farthest = PetscMax(p->farthest, abs(i));
  p->count++;
  p->far_facing += LamTouchIsFacing(p->walls, touch) && !AreNeighbours(p->walls->mesh, touch);
  if (abs(i) > PERIODS || abs(j) > PERIODS)
    p->outside++;
  else
    p->found[PairOf(p, i, j, touch->span, touch->point, touch->at)]++;
}

/* Control points of a span of the outer walls of one cell. */
static void SpanOf(const LamWalls *walls, int span, double c[LAM_SPAN][2])
{
  for (int a = 0; a < LAM_SPAN; a++)
    memcpy(c[a], walls->x[(span + a - 1 + SpansOf(walls)) % SpansOf(walls)], sizeof(c[a]));
}

/* (X - y).tau at t. */
static double AlongAt(const double c[LAM_SPAN][2], double t, const double X[2])
{
  LamSplineWeights w;
  double y[2], tau[2];

  LamSplineWeightsAt(t, &w);
  LamSplineSum(w.N, c, y);
  LamSplineSum(w.dN, c, tau);
  return (X[0] - y[0]) * tau[0] + (X[1] - y[1]) * tau[1];
}

/* Gap of a point at X from a span, infinite where the point is not beside it. */
static double GapFrom(const double c[LAM_SPAN][2], const double X[2])
{
  LamSplineCurve curve;
  LamTouchGap gap;
  double t;

  LamSplineCurveOf(c, &curve);
  if (!LamSplineClosest(&curve, X, (double[]){AlongAt(c, 0.0, X), AlongAt(c, 1.0, X)}, PETSC_FALSE, &t))
    return INFINITY;
  LamTouchGapAt(&curve, X, t, &gap);
  return gap.gap;
}

/* Whether a point touches span `other`, from its gaps from all spans of the loop. */
static int Touches(const LamWalls *walls, const double gap[], int other, int itself)
{
  const double depth = -gap[other];

  if (gap[other] >= WIDTH) return 0;
  if (itself) return depth <= walls->thickness[0];
  if (depth <= 0.0) return 1;
  for (int k = 0; k < SpansOf(walls); k++)
    if (k != other && fabs(gap[k]) < depth) return 0;
  return depth <= DEEPEST;
}

/* Takes off what must be found of a point of a wall, in one image. */
static void TakePoint(Pairs *p, int span, int point, int i, int j)
{
  const LamWalls *walls = p->walls;
  const double(*L)[2] = walls->mesh->period, S[2] = {i * L[0][0] + j * L[1][0], i * L[0][1] + j * L[1][1]};
  const int n = SpansOf(walls), itself = i == 0 && j == 0;
  double own[LAM_SPAN][2], c[LAM_SPAN][2], X[2], *gap = calloc((size_t)n, sizeof(*gap));

  SpanOf(walls, span, own);
  LamSplineSum(walls->at[point].N, (const double(*)[2])own, X);
  for (int d = 0; d < 2; d++) X[d] -= sheared[3 * d] * S[0] + sheared[3 * d + 1] * S[1];
  for (int other = 0; other < n; other++) {
    SpanOf(walls, other, c);
    gap[other] = GapFrom((const double(*)[2])c, X);
  }
  for (int other = 0; other < n; other++) {
    const int between = PetscMin(abs(span - other), n - abs(span - other));

    if (itself && between < walls->apart) continue;
    if (Touches(walls, gap, other, itself)) p->found[PairOf(p, i, j, span, point, other)]--;
  }
  free(gap);
}

static void PairsEnter(Pairs *p, LamRVE rve)
{
  const size_t n = (size_t)SpansOf(WallsOf(rve));

  *p = (Pairs){.walls = WallsOf(rve), .found = calloc(IMAGES * IMAGES * LAM_TOUCH_POINTS * n * n, 1)};
  Search(rve, sheared, MarkFound, p);
}

TEST_ON(AllImagesOfAShearedPeriodAreFound, Pairs, p, PairsEnter(p, rest[ONE].rve), free(p->found))
{
  const int n = SpansOf(p->walls);

  assert_int_equal(p->outside, 0);
  for (int i = -PERIODS; i <= PERIODS; i++)
    for (int j = -PERIODS; j <= PERIODS; j++)
      for (int k = 0; k < LAM_TOUCH_POINTS * n; k++) TakePoint(p, k / LAM_TOUCH_POINTS, k % LAM_TOUCH_POINTS, i, j);
  for (size_t k = 0; k < (size_t)(IMAGES * IMAGES * LAM_TOUCH_POINTS * n * n); k++) assert_int_equal(p->found[k], 0);
}

static void CountDeep(void *ctx, const LamTouching *touch)
{
  *(int *)ctx += touch->gap.gap < -WIDTH;
}

/* At a corner of less than 90 degrees points on one wall lie behind the other, which they have not entered. */
TEST(WallsAtAcuteCornersDoNotEnterEachOther)
{
  static const double F[9] = {0.6, 0, 0, 0, 1.7, 0, 0, 0, 1};
  const LamRVE rve = rest[ONE].rve;
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  int deep = 0;

  for (int k = 0; k < rve->ndof; k++) at->y[k] = F[4 * (k % 2)] * rve->mesh.class_X[k];
  LamWallsPlace(WallsOf(rve), F, at->y);
  LamWallsVisit(WallsOf(rve), WIDTH, CountDeep, &deep);
  assert_int_equal(deep, 0);
}

TEST_ON(ShearedPeriodTouchesImagesFarAway, Pairs, p, PairsEnter(p, rest[ONE].rve), free(p->found))
{
  assert_in_range(p->farthest, 5, PERIODS - 1);
  assert_true(p->count > 100);
}

TEST_ON(ImagesFarAwayDoNotFace, Pairs, p, PairsEnter(p, rest[ONE].rve), free(p->found))
{
  assert_int_equal(p->far_facing, 0);
}

typedef struct {
  const LamWalls *walls;
  int count, facing;
} Facing;

static void CountFacing(void *ctx, const LamTouching *touch)
{
  Facing *f = ctx;

  f->count++;
  f->facing += LamTouchIsFacing(f->walls, touch);
}

TEST(WallsThatSlideByLessThanASpanStillFace)
{
  static const double slid[2][9] = {{0.99, 0.03, 0, -0.01, 0.99, 0, 0, 0, 1}, {0.99, -0.03, 0, 0.01, 0.99, 0, 0, 0, 1}};

  for (int k = 0; k < 2; k++) {
    Facing f = {.walls = WallsOf(rest[ONE].rve)};

    Search(rest[ONE].rve, slid[k], CountFacing, &f);
    assert_int_equal(f.facing, f.count);
  }
}

/* ---- the period ---- */

typedef struct {
  int count;
  double sum;
} Total;

static void AddTotal(void *ctx, const LamTouching *touch)
{
  Total *total = ctx;

  total->count++;
  total->sum += touch->weight * touch->gap.gap;
}

TEST(FourCellsTouchAsOftenAsOneCellEach)
{
  Total one = {0}, four = {0};

  Search(rest[ONE].rve, sheared, AddTotal, &one);
  Search(rest[FOUR].rve, sheared, AddTotal, &four);
  assert_int_equal(four.count, 4 * one.count);
  assert_near(four.sum / (4.0 * one.sum), 1.0, 1e-12);
}

/* ---- walls that face each other across a lumen or a cell ---- */

enum { OUTER, LUMEN }; /* loops of the cell */

typedef struct {
  LamRVE rve;
  int loop;
  int *partners;      /* [span][point] of the loop, within itself */
  double least, most; /* gaps of points in the faces that approach */
  int nearest;        /* least distance of two spans that touch */
} Slit;

/* Whether a span lies in one of the two faces across X1, with all its nodes. */
static int IsAcross(const Slit *s, int span)
{
  const LamWalls *walls = WallsOf(s->rve);
  const double apothem = s->loop == LUMEN ? 1.0 - walls->thickness[0] : 1.0;
  int across = 0;

  for (int k = 0; k < LAM_SPAN_NODES; k++)
    across += fabs(fabs(walls->mesh->X[2 * LamWallsNode(walls, s->loop, span, k)]) - apothem) < 1e-9;
  return across == LAM_SPAN_NODES;
}

static void CountSlit(void *ctx, const LamTouching *touch)
{
  Slit *s = ctx;
  const int between = abs(touch->span - touch->at);

  if (touch->loop != s->loop || touch->other != s->loop || hypot(touch->shift[0], touch->shift[1]) > 0.0) return;
  s->nearest = PetscMin(s->nearest, PetscMin(between, SpansOf(WallsOf(s->rve)) - between));
  if (!IsAcross(s, touch->span)) return;
  s->partners[LAM_TOUCH_POINTS * touch->span + touch->point]++;
  s->least = fmin(s->least, touch->gap.gap);
  s->most = fmax(s->most, touch->gap.gap);
}

/* A loop narrowed until two opposite walls are at a distance; negative: they have passed each other. The other loop is
   undeformed. */
static void SlitEnter(Slit *s, int loop, double distance)
{
  const LamRVE rve = rest[ONE].rve;
  const LamWalls *walls = WallsOf(rve);
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);

  *s = (Slit){.rve = rve, .loop = loop, .least = 1.0, .most = -1.0, .nearest = SpansOf(walls)};
  s->partners = calloc((size_t)(LAM_TOUCH_POINTS * SpansOf(walls)), sizeof(*s->partners));
  for (int i = 0; i < NodesOf(walls); i++)
    state->y[2 * rve->mesh.node_class[walls->node[loop * NodesOf(walls) + i]]] *=
        0.5 * distance / (loop == LUMEN ? 1.0 - walls->thickness[0] : 1.0);
  LamWallsPlace(WallsOf(rve), turned_identity, state->y);
  LamWallsVisit(walls, WIDTH, CountSlit, s);
}

static void AssertPartners(const Slit *s, int partners)
{
  int spans = 0;

  for (int span = 0; span < SpansOf(WallsOf(s->rve)); span++) {
    if (!IsAcross(s, span)) continue;
    spans++;
    for (int q = 0; q < LAM_TOUCH_POINTS; q++) assert_int_equal(s->partners[LAM_TOUCH_POINTS * span + q], partners);
  }
  assert_int_equal(spans, 2 * (PER_FACE - 2));
}

static void AssertClosed(const Slit *s, double distance)
{
  AssertPartners(s, 1);
  assert_near(s->least, distance, ROUNDING);
  assert_near(s->most, distance, ROUNDING);
}

TEST_ON(WallsOfANarrowLumenAreFound, Slit, s, SlitEnter(s, LUMEN, 0.5 * WIDTH), free(s->partners))
{
  AssertClosed(s, 0.5 * WIDTH);
}

TEST_ON(WallsOfALumenThatLieInEachOtherAreFound, Slit, s, SlitEnter(s, LUMEN, -0.1), free(s->partners))
{
  AssertClosed(s, -0.1);
}

TEST_ON(WallsOfALumenBeyondTheWidthAreNot, Slit, s, SlitEnter(s, LUMEN, 1.1 * WIDTH), free(s->partners))
{
  AssertPartners(s, 0);
}

/* Between their outer sides lie two walls, of 0.15 each at rest: one side is not what the other one has entered. */
TEST_ON(OppositeWallsOfAFlatCellDoNotTouch, Slit, s, SlitEnter(s, OUTER, 0.2), free(s->partners))
{
  AssertPartners(s, 0);
}

/* At its ends the lumen is as sharp as a needle. */
TEST_ON(NoWallTouchesWhatIsBesideIt, Slit, s, SlitEnter(s, LUMEN, -0.1), free(s->partners))
{
  assert_in_range(s->nearest, ALONG, 2 * ALONG);
}

TEST_GROUP(.petsc = 1, .setup = SearchAtRest, .teardown = LeaveRest);
