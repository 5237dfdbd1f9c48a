#include "touching.h"

#define WIDE 0.02      /* apothems: width of a law that needs rounder corners to pass them, ... */
#define WIDE_BEVEL 0.1 /* ... in spans; rounder ones of turgid cells bear too little */
#define DEEPEST 0.25   /* apothems: deeper points belong to another wall; above the longest step of the solver */
#define GROUP 8        /* spans with a common box: about the root of their number on the default mesh */

/* Outer walls counter-clockwise; a lumen backwards from a corner, or from a cut, whose nodes are there twice. */
static void ListNodes(LamWalls *walls)
{
  const LamMesh *mesh = walls->mesh;

  for (PetscInt loop = 0; loop < walls->loops; ++loop) {
    const PetscInt n = LamWallsNodes(walls, loop), first = LamMeshFirstRing(mesh, loop / 2);

    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt back = (2 * n - i - (mesh->cuts ? 1 : 0)) % n;

      walls->node[LamWallsFirstNode(walls, loop) + i] =
          loop % 2 ? LamMeshNode(mesh, first + back, 0) : LamMeshNode(mesh, first + i, mesh->radial_nodes - 1);
    }
  }
}

static PetscInt GroupsOf(PetscInt spans)
{
  return (spans + GROUP - 1) / GROUP;
}

/* Groups of loops follow each other; the last one of a loop may be incomplete. */
static PetscInt FirstGroup(const LamWalls *walls, PetscInt loop)
{
  return walls->first[loop] / GROUP + loop;
}

/* Node of control point i of a loop, and its place in its part: cuts have both nodes of a pair, corners one. Loops
   begin with a part, so that this holds for all of them, also a round before their start and behind their end. */
static PetscInt NodeOf(const LamWalls *walls, PetscInt i, PetscInt *at)
{
  const PetscInt part = LamWallsPart(walls, i + walls->per_part, at) - 1; /* i is -1 at least */

  return part * (walls->per_part - (walls->mesh->cuts ? 0 : 1)) + *at;
}

/* Share of the nodes 0..4 of a span in control point i. */
static void ShareControl(const LamWalls *walls, PetscInt i, PetscInt first, PetscReal share[LAM_SPAN_NODES])
{
  const PetscInt last = walls->per_part - 1;
  PetscInt at;
  const PetscInt node = NodeOf(walls, i, &at) - first;

  (void)PetscArrayzero(share, LAM_SPAN_NODES);
  if (at == 0 || at == last) { /* at a corner or cut */
    share[node] = 1.0 - walls->bevel;
    share[at == 0 ? node + 1 : node - 1] = walls->bevel;
  } else if (walls->mesh->cuts && (at == 1 || at == last - 1)) {
    share[node] = 1.0;
  } else if (at % 2) {
    share[node] = 4.0 / 3.0;
    share[node - 1] = share[node + 1] = -1.0 / 6.0;
  } else {
    share[node] = 1.0;
  }
}

/* ended: control points stay in the part of the span. */
static void ShareSpan(const LamWalls *walls, PetscInt span, PetscBool ended, LamSpanNodes *of)
{
  PetscInt at;
  const PetscInt start = NodeOf(walls, span, &at), last = walls->per_part - 1;

  of->first = start - 2 + at % 2;
  (void)PetscMemzero(of->point, sizeof(of->point));
  for (PetscInt a = 0; a < LAM_SPAN; ++a) {
    const PetscInt place = at + a - 1, inside = ended ? PetscMax(0, PetscMin(last, place)) : place;

    ShareControl(walls, span + inside - at, of->first, of->share[a]);
    for (PetscInt q = 0; q < LAM_TOUCH_POINTS; ++q)
      for (PetscInt i = 0; i < LAM_SPAN_NODES; ++i) of->point[q][i] += walls->at[q].N[a] * of->share[a][i];
  }
}

static void ShareNodes(LamWalls *walls)
{
  for (PetscInt span = 0; span < walls->most; ++span) {
    ShareSpan(walls, span, PETSC_FALSE, &walls->of[span]);
    ShareSpan(walls, span, PETSC_TRUE, &walls->ended[span]);
  }
}

/* Reference lengths of the points, from the contour of the reference positions. */
static void Weigh(const LamMesh *mesh, LamWalls *walls)
{
  for (PetscInt loop = 0; loop < walls->loops; ++loop)
    for (PetscInt span = 0; span < LamWallsSpans(walls, loop); ++span) {
      PetscReal c[LAM_SPAN][2] = {{0}}, tau[2];

      for (PetscInt a = 0; a < LAM_SPAN; ++a)
        for (PetscInt i = 0; i < LAM_SPAN_NODES; ++i)
          for (PetscInt d = 0; d < 2; ++d)
            c[a][d] += walls->of[span].share[a][i] * mesh->X[2 * LamWallsNode(walls, loop, span, i) + d];
      for (PetscInt d = 0; d < 2; ++d) walls->rest[walls->first[loop] + span][d] = 0.5 * (c[1][d] + c[2][d]);
      for (PetscInt q = 0; q < LAM_TOUCH_POINTS; ++q) {
        LamSplineSum(walls->at[q].dN, (const PetscReal(*)[2])c, tau);
        walls->weight[LAM_TOUCH_POINTS * (walls->first[loop] + span) + q] =
            PetscSqrtReal(tau[0] * tau[0] + tau[1] * tau[1]) / LAM_TOUCH_POINTS;
      }
    }
}

void LamWallsRound(LamWalls *walls, PetscReal width)
{
  const PetscReal bevel = width >= WIDE ? WIDE_BEVEL : 0.0;

  if (bevel == walls->bevel) return;
  walls->bevel = bevel;
  ShareNodes(walls);
  Weigh(walls->mesh, walls);
}

PetscErrorCode LamWallsCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamWalls *walls)
{
  PetscInt all;

  PetscFunctionBeginUser;
  *walls = (LamWalls){.mesh = mesh, .loops = 2 * mesh->cell_count, .is_patch = micro->is_patch};
  walls->per_face = mesh->cuts ? LAM_FACE_CUTS : 1;
  walls->per_part = 2 * mesh->along / walls->per_face + 1;
  walls->apart = PetscMax(3, mesh->along);
  PetscCall(PetscMalloc2(walls->loops + 1, &walls->first, 2 * LamMeshFirstRing(mesh, mesh->cell_count), &walls->node));
  walls->first[0] = 0;
  for (PetscInt loop = 0; loop < walls->loops; ++loop) {
    const PetscInt spans = LamMeshFaceCount(mesh, loop / 2) * walls->per_face * walls->per_part;

    walls->first[loop + 1] = walls->first[loop] + spans;
    walls->most = PetscMax(walls->most, spans);
  }
  all = walls->first[walls->loops];
  PetscCall(PetscMalloc5(LAM_TOUCH_POINTS * all, &walls->weight, mesh->cell_count, &walls->thickness, all, &walls->x,
                         walls->most, &walls->of, walls->most, &walls->ended));
  PetscCall(PetscMalloc1(all, &walls->rest));
  PetscCall(PetscCalloc1(all, &walls->gone));
  PetscCall(PetscMalloc3(all, &walls->span, walls->loops, &walls->box, FirstGroup(walls, walls->loops), &walls->group));
  for (PetscInt c = 0; c < mesh->cell_count; ++c) walls->thickness[c] = DEEPEST;
  for (PetscInt face = 0; face < mesh->tissue->faces; ++face) {
    PetscReal *thickness = &walls->thickness[mesh->tissue->cell[face]];

    *thickness = PetscMin(*thickness, mesh->thickness[face]);
  }
  for (PetscInt q = 0; q < LAM_TOUCH_POINTS; ++q)
    LamSplineWeightsAt(((PetscReal)q + 0.5) / LAM_TOUCH_POINTS, &walls->at[q]);
  ListNodes(walls);
  walls->bevel = -1.0;
  LamWallsRound(walls, 0.0);
  PetscFunctionReturn(0);
}

PetscErrorCode LamWallsDestroy(LamWalls *walls)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(walls->first, walls->node));
  PetscCall(PetscFree5(walls->weight, walls->thickness, walls->x, walls->of, walls->ended));
  PetscCall(PetscFree(walls->rest));
  PetscCall(PetscFree(walls->gone));
  PetscCall(PetscFree3(walls->span, walls->box, walls->group));
  PetscFunctionReturn(0);
}

static const LamBox nothing = {{PETSC_MAX_REAL, PETSC_MAX_REAL}, {-PETSC_MAX_REAL, -PETSC_MAX_REAL}};

static void Widen(LamBox *box, const PetscReal low[2], const PetscReal high[2])
{
  for (PetscInt d = 0; d < 2; ++d) {
    box->low[d] = PetscMin(box->low[d], low[d]);
    box->high[d] = PetscMax(box->high[d], high[d]);
  }
}

/* The box moved by -shift, with a margin. */
static LamBox Moved(const LamBox *box, const PetscReal shift[2], PetscReal margin)
{
  return (LamBox){{box->low[0] - shift[0] - margin, box->low[1] - shift[1] - margin},
                  {box->high[0] - shift[0] + margin, box->high[1] - shift[1] + margin}};
}

static inline PetscBool Meet(const LamBox *a, const LamBox *b)
{
  return (PetscBool)(a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
                     b->low[1] <= a->high[1]);
}

/* Where the contour ends its control points are in the part of the span; the span between both sides of a cut goes on
   from the one before it. */
static void End(const LamWalls *walls, PetscInt loop, PetscInt span, PetscReal c[LAM_SPAN][2])
{
  PetscInt at;

  if (!walls->gone[walls->first[loop] + span] && !LamWallsEnd(walls, loop, span)) return;
  (void)LamWallsPart(walls, span, &at);
  for (PetscInt d = 0; d < 2; ++d) {
    if (at == 0) c[0][d] = c[1][d];
    for (PetscInt a = 2; a < LAM_SPAN; ++a)
      if (at + a - 1 >= walls->per_part) c[a][d] = c[a - 1][d];
  }
}

static inline void GatherSpan(const LamWalls *walls, PetscInt loop, PetscInt span, PetscReal c[LAM_SPAN][2])
{
  const PetscInt n = LamWallsSpans(walls, loop);

  for (PetscInt a = 0; a < LAM_SPAN; ++a) {
    const PetscInt i = span + a - 1, k = walls->first[loop] + (i < 0 ? i + n : i >= n ? i - n : i);

    c[a][0] = walls->x[k][0];
    c[a][1] = walls->x[k][1];
  }
  if (walls->mesh->cuts) End(walls, loop, span, c);
}

/* Position of the second control point of a span. */
static void PlaceControl(const LamWalls *walls, const PetscReal F[9], const PetscReal y[], PetscInt loop, PetscInt span,
                         PetscReal c[2])
{
  const LamMesh *mesh = walls->mesh;
  const PetscReal *share = walls->of[span].share[1];

  c[0] = c[1] = 0.0;
  for (PetscInt i = 0; i < LAM_SPAN_NODES; ++i) {
    const PetscInt node = LamWallsNode(walls, loop, span, i);
    PetscReal x[2];

    if (share[i] == 0.0) continue;
    LamImagePosition(F, y, mesh->node_class[node], &mesh->shift[2 * node], x);
    for (PetscInt d = 0; d < 2; ++d) c[d] += share[i] * x[d];
  }
}

/* What a span lies within, from its Bezier points: it lies within their hull, and its tangents within that of their
   differences. */
static void Bound(const PetscReal c[LAM_SPAN][2], LamWallSpan *span)
{
  PetscReal p[LAM_SPAN][2], length, leg[LAM_SPAN - 1];

  for (PetscInt d = 0; d < 2; ++d) {
    p[0][d] = (c[0][d] + 4.0 * c[1][d] + c[2][d]) / 6.0;
    p[1][d] = (2.0 * c[1][d] + c[2][d]) / 3.0;
    p[2][d] = (c[1][d] + 2.0 * c[2][d]) / 3.0;
    p[3][d] = (c[1][d] + 4.0 * c[2][d] + c[3][d]) / 6.0;
  }
  span->box = nothing;
  for (PetscInt a = 0; a < LAM_SPAN; ++a) Widen(&span->box, p[a], p[a]);

  const PetscReal chord[2] = {p[3][0] - p[0][0], p[3][1] - p[0][1]};

  for (PetscInt a = 0; a < LAM_SPAN - 1; ++a)
    leg[a] = (p[a + 1][0] - p[a][0]) * chord[0] + (p[a + 1][1] - p[a][1]) * chord[1];
  for (PetscInt e = 0; e < 2; ++e) {
    PetscReal *b = span->bend[e];

    for (PetscInt d = 0; d < 2; ++d) b[d] = c[e][d] - 2.0 * c[e + 1][d] + c[e + 2][d];
    span->least[e] = PETSC_MAX_REAL;
    for (PetscInt a = 0; a < LAM_SPAN; ++a) span->least[e] = PetscMin(span->least[e], b[0] * p[a][0] + b[1] * p[a][1]);
  }
  span->outward[0] = span->outward[1] = span->slowest = 0.0;
  span->top = PETSC_MAX_REAL;
  if (!(leg[0] > 0.0 && leg[1] >= 0.0 && leg[2] > 0.0)) return;
  length = PetscSqrtReal(chord[0] * chord[0] + chord[1] * chord[1]);
  span->outward[0] = chord[1] / length;
  span->outward[1] = -chord[0] / length;
  span->slowest = PetscSqr(3.0 * PetscMin(leg[0], PetscMin(leg[1], leg[2])) / length);
  span->top = -PETSC_MAX_REAL;
  for (PetscInt a = 0; a < LAM_SPAN; ++a)
    span->top = PetscMax(span->top, span->outward[0] * p[a][0] + span->outward[1] * p[a][1]);
}

static void PlaceSpan(LamWalls *walls, PetscInt loop, PetscInt i)
{
  LamWallSpan *span = &walls->span[walls->first[loop] + i];
  LamBox *group = &walls->group[FirstGroup(walls, loop) + i / GROUP];
  PetscReal c[LAM_SPAN][2];

  GatherSpan(walls, loop, i, c);
  LamSplineCurveOf((const PetscReal(*)[2])c, &span->curve);
  Bound((const PetscReal(*)[2])c, span);
  for (PetscInt q = 0; q < LAM_TOUCH_POINTS; ++q)
    LamSplineSum(walls->at[q].N, (const PetscReal(*)[2])c, span->point[q]);
  if (i % GROUP == 0) *group = nothing;
  Widen(group, span->box.low, span->box.high);
}

void LamWallsTearAt(LamWalls *walls, const PetscBool torn[])
{
  for (PetscInt loop = 0; loop < walls->loops; ++loop) {
    const PetscInt cuts = LAM_FACE_CUTS * LamMeshFaceCount(walls->mesh, loop / 2);
    const PetscInt first = LAM_FACE_CUTS * walls->mesh->tissue->first[loop / 2];

    for (PetscInt part = 0; part < cuts; ++part) {
      const PetscInt cut = loop % 2 ? cuts - 1 - part : (part + 1) % cuts; /* at the end of the part */

      walls->gone[walls->first[loop] + (part + 1) * walls->per_part - 1] = torn[first + cut];
    }
  }
}

void LamWallsPlace(LamWalls *walls, const PetscReal F[9], const PetscReal y[])
{
  (void)PetscArraycpy(walls->F, F, 9);
  for (PetscInt loop = 0; loop < walls->loops; ++loop) {
    if (walls->near && !walls->near[loop / 2]) continue;
    const PetscInt first = walls->first[loop], spans = LamWallsSpans(walls, loop);

    for (PetscInt i = 0; i < spans; ++i) PlaceControl(walls, F, y, loop, i, walls->x[first + i]);
    for (PetscInt i = 0; i < spans; ++i) PlaceSpan(walls, loop, i);
    walls->box[loop] = nothing;
    for (PetscInt g = FirstGroup(walls, loop); g < FirstGroup(walls, loop) + GroupsOf(spans); ++g)
      Widen(&walls->box[loop], walls->group[g].low, walls->group[g].high);
  }
}

/* Two loops, the second in an image. */
typedef struct {
  const LamWalls *walls;
  PetscReal width, reach;
  PetscInt loop, other;
  PetscBool itself;             /* the same loop, not an image of it */
  PetscReal shift[2], moved[2]; /* S and F S of the image */
  LamTouchVisitor visitor;
  void *ctx;
} Pair;

/* Distance of two spans of a loop, in spans. */
static inline PetscInt Between(PetscInt spans, PetscInt i, PetscInt j)
{
  const PetscInt d = i > j ? i - j : j - i;

  return PetscMin(d, spans - d);
}

/* Whether all of a box is farther outside a span than the width. */
static inline PetscBool IsBeyond(const Pair *p, const LamWallSpan *span, const PetscReal low[2],
                                 const PetscReal high[2])
{
  PetscReal least = -span->top;

  for (PetscInt d = 0; d < 2; ++d) least += span->outward[d] * (span->outward[d] > 0.0 ? low[d] : high[d]);
  return (PetscBool)(least > p->width);
}

/* (X - y).tau at the start of a span. */
static inline PetscReal AlongStart(const LamWallSpan *span, const PetscReal X[2])
{
  const PetscReal(*a)[2] = (const PetscReal(*)[2])span->curve.a;

  return (X[0] - a[0][0]) * a[1][0] + (X[1] - a[0][1]) * a[1][1];
}

/* Whether the distance of each point X of a box has one minimum on a span at most: (X - y).tau falls everywhere on it,
   by tau.tau - (X - y).y_uu. */
static inline PetscBool HasOneMinimum(const LamWallSpan *span, const PetscReal low[2], const PetscReal high[2])
{
  PetscReal most = -PETSC_MAX_REAL;

  for (PetscInt e = 0; e < 2; ++e) {
    const PetscReal *b = span->bend[e];

    most = PetscMax(most,
                    b[0] * (b[0] > 0.0 ? high[0] : low[0]) + b[1] * (b[1] > 0.0 ? high[1] : low[1]) - span->least[e]);
  }
  return (PetscBool)(most < span->slowest);
}

/* The gap of X to its closest point on span j of a loop. PETSC_FALSE: it is on another span. has_one: HasOneMinimum is
   known. */
static inline PetscBool FindGap(const LamWalls *walls, PetscInt loop, PetscInt j, const PetscReal X[2],
                                PetscBool has_one, LamTouchGap *gap)
{
  const LamWallSpan *first = &walls->span[walls->first[loop]], *span = first + j;
  const LamWallSpan *next = j + 1 == LamWallsSpans(walls, loop) ? first : span + 1;
  const PetscReal ends[2] = {AlongStart(span, X), AlongStart(next, X)};
  PetscReal t;

  has_one = (PetscBool)(has_one || HasOneMinimum(span, X, X));
  if (!LamSplineClosest(&span->curve, X, ends, has_one, &t)) return PETSC_FALSE;
  LamTouchGapAt(&span->curve, X, t, gap);
  return PETSC_TRUE;
}

/* Whether two spans of a loop belong together: they follow each other, or wall lies between them at rest, as on both
   sides of an acute corner. */
static inline PetscBool AreJoined(const LamWalls *walls, PetscInt loop, PetscInt i, PetscInt j)
{
  const PetscInt a = walls->first[loop] + i, b = walls->first[loop] + j;
  PetscReal reach = walls->thickness[loop / 2];

  if (Between(LamWallsSpans(walls, loop), i, j) < walls->apart) return PETSC_TRUE;
  /* from the middles to the ends of both spans, whose points have equal weights, about */
  reach += 0.5 * LAM_TOUCH_POINTS * (walls->weight[LAM_TOUCH_POINTS * a] + walls->weight[LAM_TOUCH_POINTS * b]);
  return (PetscBool)(PetscSqr(walls->rest[a][0] - walls->rest[b][0]) + PetscSqr(walls->rest[a][1] - walls->rest[b][1]) <
                     reach * reach);
}

/* Whether some other span of the loop is nearer to a point that lies at a depth behind span j: the point is behind that
   span without having entered it, as on the next wall around an acute corner. */
static PetscBool IsNearer(const Pair *p, const PetscReal X[2], PetscInt j, PetscReal depth)
{
  const LamWalls *walls = p->walls;
  const LamWallSpan *first = &walls->span[walls->first[p->other]];
  const PetscInt n = LamWallsSpans(walls, p->other);
  const LamBox near = {{X[0] - depth, X[1] - depth}, {X[0] + depth, X[1] + depth}};

  for (PetscInt g = 0; g < GroupsOf(n); ++g) {
    if (!Meet(&near, &walls->group[FirstGroup(walls, p->other) + g])) continue;
    for (PetscInt k = GROUP * g; k < PetscMin(n, GROUP * (g + 1)); ++k) {
      LamTouchGap gap;

      if (k == j || walls->gone[walls->first[p->other] + k] || !Meet(&near, &first[k].box)) continue;
      if (FindGap(walls, p->other, k, X, PETSC_FALSE, &gap) && PetscAbsReal(gap.gap) < depth) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

/* Beyond the thickness of the wall it enters, a point is nearer to that wall's other side if the wall is that of the
   same cell. In another cell it counts down to DEEPEST, if no other wall of that cell is nearer. */
static PetscBool Counts(const Pair *p, const PetscReal X[2], PetscInt j, PetscReal gap)
{
  if (!(gap < p->width)) return PETSC_FALSE;
  if (p->itself) return (PetscBool)(gap >= -p->walls->thickness[p->other / 2]);
  return (PetscBool)(gap >= 0.0 || (gap >= -DEEPEST && !IsNearer(p, X, j, -gap)));
}

/* Points of one span, within a box, against one span of the other loop. */
static void VisitSpans(const Pair *p, PetscInt i, PetscInt j, const LamBox *here)
{
  const LamWalls *walls = p->walls;
  const LamWallSpan *own = &walls->span[walls->first[p->loop] + i], *other = &walls->span[walls->first[p->other] + j];
  const PetscBool has_one = HasOneMinimum(other, here->low, here->high);
  LamTouching touch;

  for (PetscInt q = 0; q < LAM_TOUCH_POINTS; ++q) {
    const PetscReal X[2] = {own->point[q][0] - p->moved[0], own->point[q][1] - p->moved[1]};

    if (IsBeyond(p, other, X, X) || !FindGap(walls, p->other, j, X, has_one, &touch.gap)) continue;
    if (!Counts(p, X, j, touch.gap.gap)) continue;
    touch.loop = p->loop;
    touch.span = i;
    touch.point = q;
    touch.other = p->other;
    touch.at = j;
    touch.shift[0] = p->shift[0];
    touch.shift[1] = p->shift[1];
    touch.weight = walls->weight[LAM_TOUCH_POINTS * (walls->first[p->loop] + i) + q];
    p->visitor(p->ctx, &touch);
  }
}

/* The spans of two groups. */
static void VisitGroups(const Pair *p, PetscInt a, PetscInt b)
{
  const LamWalls *walls = p->walls;
  const PetscInt n[2] = {LamWallsSpans(walls, p->loop), LamWallsSpans(walls, p->other)};
  const PetscInt end[2] = {PetscMin(n[0], GROUP * (a + 1)), PetscMin(n[1], GROUP * (b + 1))};
  const PetscInt first[2] = {walls->first[p->loop], walls->first[p->other]};
  const LamBox *group = &walls->group[FirstGroup(walls, p->other) + b];

  for (PetscInt i = GROUP * a; i < end[0]; ++i) {
    const LamBox *box = &walls->span[first[0] + i].box;

    if (walls->gone[first[0] + i]) continue;
    const LamBox here = Moved(box, p->moved, 0.0), near = Moved(box, p->moved, p->reach);

    if (!Meet(&near, group)) continue;
    for (PetscInt j = GROUP * b; j < end[1]; ++j) {
      const LamWallSpan *other = &walls->span[first[1] + j];

      if (!walls->gone[first[1] + j] && !(p->itself && AreJoined(walls, p->loop, i, j)) && Meet(&near, &other->box) &&
          !IsBeyond(p, other, here.low, here.high))
        VisitSpans(p, i, j, &here);
    }
  }
}

static void VisitLoops(const Pair *p)
{
  const LamWalls *walls = p->walls;
  const LamBox *here = &walls->group[FirstGroup(walls, p->loop)], *there = &walls->group[FirstGroup(walls, p->other)];

  for (PetscInt a = 0; a < GroupsOf(LamWallsSpans(walls, p->loop)); ++a) {
    const LamBox near = Moved(&here[a], p->moved, p->reach);

    if (!Meet(&near, &walls->box[p->other])) continue;
    for (PetscInt b = 0; b < GroupsOf(LamWallsSpans(walls, p->other)); ++b)
      if (Meet(&near, &there[b])) VisitGroups(p, a, b);
  }
}

/* Range of the images, in periods, whose box may lie near that of the loop. */
static void FindImages(const Pair *p, PetscInt range[2][2])
{
  const LamWalls *walls = p->walls;
  const LamBox *a = &walls->box[p->loop], *b = &walls->box[p->other];
  PetscReal M[2][2], det;

  range[0][0] = range[0][1] = range[1][0] = range[1][1] = 0;
  if (walls->is_patch || p->loop % 2) return;
  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt d = 0; d < 2; ++d)
      M[d][k] = walls->F[3 * d] * walls->mesh->period[k][0] + walls->F[3 * d + 1] * walls->mesh->period[k][1];
  det = M[0][0] * M[1][1] - M[0][1] * M[1][0];
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal row[2] = {(k ? -M[1][0] : M[1][1]) / det, (k ? M[0][0] : -M[0][1]) / det};
    PetscReal low = 0.0, high = 0.0;

    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal ends[2] = {row[d] * (a->low[d] - b->high[d] - p->reach),
                                 row[d] * (a->high[d] - b->low[d] + p->reach)};

      low += PetscMin(ends[0], ends[1]);
      high += PetscMax(ends[0], ends[1]);
    }
    range[k][0] = (PetscInt)PetscCeilReal(low);
    range[k][1] = (PetscInt)PetscFloorReal(high);
  }
}

/* All images of one loop near another. */
static void VisitImages(Pair *p)
{
  const LamWalls *walls = p->walls;
  const LamMesh *mesh = walls->mesh;
  PetscInt range[2][2];
  LamBox near;

  p->reach = PetscMax(p->width, DEEPEST);
  FindImages(p, range);
  for (PetscInt i = range[0][0]; i <= range[0][1]; ++i)
    for (PetscInt j = range[1][0]; j <= range[1][1]; ++j) {
      p->itself = (PetscBool)(p->loop == p->other && i == 0 && j == 0);
      for (PetscInt d = 0; d < 2; ++d)
        p->shift[d] = (PetscReal)i * mesh->period[0][d] + (PetscReal)j * mesh->period[1][d];
      for (PetscInt d = 0; d < 2; ++d) p->moved[d] = walls->F[3 * d] * p->shift[0] + walls->F[3 * d + 1] * p->shift[1];
      p->reach = PetscMax(p->width, p->itself ? walls->thickness[p->other / 2] : DEEPEST);
      near = Moved(&walls->box[p->loop], p->moved, p->reach);
      if (Meet(&near, &walls->box[p->other])) VisitLoops(p);
    }
}

void LamWallsVisit(const LamWalls *walls, PetscReal width, LamTouchVisitor visitor, void *ctx)
{
  static const PetscReal none[2] = {0.0, 0.0};
  Pair p = {.walls = walls, .width = width, .visitor = visitor, .ctx = ctx};

  for (p.loop = 0; p.loop < walls->loops; ++p.loop) {
    const LamBox near = Moved(&walls->box[p.loop], none, PetscMax(width, DEEPEST));

    if (walls->near && !walls->near[p.loop / 2]) continue;
    for (p.other = p.loop % 2 ? p.loop : 0; p.other < walls->loops; p.other += p.loop % 2 ? walls->loops : 2)
      if (!walls->is_patch || Meet(&near, &walls->box[p.other])) VisitImages(&p);
  }
}

PetscBool LamTouchIsFacing(const LamWalls *walls, const LamTouching *touch)
{
  const LamMesh *mesh = walls->mesh;
  PetscInt half, face = LamWallsFace(walls, touch->loop, touch->span, &half);
  const PetscInt neighbour = half == 0                     ? LamTissuePrevious(mesh->tissue, face)
                             : half >= 2 * mesh->along - 1 ? LamTissueNext(mesh->tissue, face)
                                                           : face; /* at a corner, also the face across it */
  const PetscInt faces[2] = {face, neighbour};

  if (LamTouchIsLumen(touch)) return PETSC_FALSE;
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal *image = &mesh->image[2 * faces[k]];

    if (LamMeshNeighbour(mesh, faces[k]) != touch->other / 2) continue;
    if (PetscAbsReal(image[0] - touch->shift[0]) + PetscAbsReal(image[1] - touch->shift[1]) < 1e-6) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
