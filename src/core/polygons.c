/*
  Method. Vertices that coincide, in a period also those a whole number of periods apart, are one point: each vertex
  is its point plus so many periods. Two edges are the same face if they run between the same points in opposite
  directions and their ends are the same number of periods apart. An edge with no other is a border: to air, or to the
  outside of a patch. Borders form loops; they enclose a patch or an air space, so that the areas must add up to that
  of the period: otherwise cells overlap.
*/
#include "polygons.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME 1e-6         /* of the size of a cell: vertices nearer than this are one point; files have more digits */
#define MOST_AROUND 16    /* cells at a junction (rve/cells/mesh.h) */
#define MOST_SETBACK 0.45 /* of an edge: something of it is left between the air at both its ends */
#define MUST(condition, ...) PetscCheck(condition, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, __VA_ARGS__)

/* An edge of a cell between two points. */
typedef struct {
  PetscInt face;
  PetscInt key[4]; /* points in increasing order, and periods from the first to the second */
  PetscBool forward;
} Edge;

typedef struct {
  const LamPolygons *of;
  LamTissue tissue;
  PetscReal size;                        /* of a cell */
  PetscReal period[2][2], inverse[2][2]; /* of a patch: a box that is larger than it; x = m period, m = x inverse */
  PetscInt *point;                       /* [vertex] the first vertex at the same point */
  PetscInt (*wrap)[2];                   /* [vertex] periods from there */
  PetscInt *around;                      /* [vertex] faces that start at this point */
  PetscBool *outer;                      /* [face] a border to the outside of a patch, not to an air space within it */
  PetscReal air, outside;                /* areas that loops of borders enclose: air spaces, and all of a patch */
} Builder;

static PetscReal Cross(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[1] - a[1] * b[0];
}

static const PetscReal *VertexOf(const LamPolygons *p, PetscInt cell, PetscInt k)
{
  const PetscInt n = p->first[cell + 1] - p->first[cell];

  return p->vertex[p->corner[p->first[cell] + (k % n)]];
}

static PetscReal AreaOf(const LamPolygons *p, PetscInt cell)
{
  PetscReal area = 0.0;

  for (PetscInt k = 0; k < p->first[cell + 1] - p->first[cell]; k++)
    area += 0.5 * Cross(VertexOf(p, cell, k), VertexOf(p, cell, k + 1));
  return area;
}

/* ---- cells ---- */

static PetscReal Side(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2])
{
  const PetscReal u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - a[0], c[1] - a[1]};

  return Cross(u, v);
}

static PetscBool CrossEachOther(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2], const PetscReal d[2])
{
  return (PetscBool)(Side(a, b, c) * Side(a, b, d) < 0.0 && Side(c, d, a) * Side(c, d, b) < 0.0);
}

static PetscErrorCode CheckCell(const LamPolygons *p, PetscInt cell)
{
  const PetscInt n = p->first[cell + 1] - p->first[cell];
  PetscReal area;

  PetscFunctionBeginUser;
  MUST(n >= 3, "%s: cells[%d] has %d vertices; a cell has 3 at least", p->name, (int)cell, (int)n);
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt v = p->corner[p->first[cell] + k];

    MUST(v >= 0 && v < p->vertices, "%s: cells[%d] has vertex %d; they are numbered from 0 to %d", p->name, (int)cell,
         (int)v, (int)p->vertices - 1);
  }
  area = AreaOf(p, cell);
  MUST(area > 0.0, "%s: cells[%d] runs clockwise, or has no area; write its vertices counter-clockwise", p->name,
       (int)cell);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = i + 2; j < n; j++)
      MUST((i == 0 && j == n - 1) || !CrossEachOther(VertexOf(p, cell, i), VertexOf(p, cell, i + 1),
                                                     VertexOf(p, cell, j), VertexOf(p, cell, j + 1)),
           "%s: cells[%d] crosses itself: the edges from its vertices %d and %d", p->name, (int)cell,
           (int)p->corner[p->first[cell] + i], (int)p->corner[p->first[cell] + j]);
  PetscFunctionReturn(0);
}

/* ---- points ---- */

static PetscErrorCode SetPeriod(Builder *b)
{
  const LamPolygons *p = b->of;
  PetscReal det, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};

  PetscFunctionBeginUser;
  (void)PetscMemcpy(b->period, p->period, sizeof(b->period));
  for (PetscInt v = 0; v < p->vertices && p->is_patch; v++)
    for (int d = 0; d < 2; d++) {
      low[d] = PetscMin(low[d], p->vertex[v][d]);
      high[d] = PetscMax(high[d], p->vertex[v][d]);
    }
  for (int k = 0; k < 2 && p->is_patch; k++)
    for (int d = 0; d < 2; d++) b->period[k][d] = k == d ? 4.0 * PetscMax(high[0] - low[0], high[1] - low[1]) : 0.0;
  det = Cross(b->period[0], b->period[1]);
  MUST(det > 0.0, "%s: period: its two vectors must span an area, the second one to the left of the first", p->name);
  b->inverse[0][0] = b->period[1][1] / det;
  b->inverse[0][1] = -b->period[0][1] / det;
  b->inverse[1][0] = -b->period[1][0] / det;
  b->inverse[1][1] = b->period[0][0] / det;
  PetscFunctionReturn(0);
}

/* Vertices by their places in a grid over the period. */
typedef struct {
  PetscInt n, *head, *next; /* [n][n], [vertex] */
} Grid;

/* Place of a vertex in periods. */
static void Place(const Builder *b, PetscInt v, PetscReal at[2])
{
  const PetscReal *x = b->of->vertex[v];

  for (int d = 0; d < 2; d++) at[d] = x[0] * b->inverse[0][d] + x[1] * b->inverse[1][d];
}

static PetscInt BoxOf(const Grid *grid, PetscReal at)
{
  const PetscInt k = (PetscInt)floor((at - floor(at)) * (PetscReal)grid->n);

  return PetscMin(k, grid->n - 1);
}

/* Whether vertex v lies whole periods from vertex w. */
static PetscBool Coincide(const Builder *b, PetscInt v, PetscInt w, PetscInt wrap[2])
{
  PetscReal at[2], to[2], off[2];

  Place(b, v, at);
  Place(b, w, to);
  for (int d = 0; d < 2; d++) {
    wrap[d] = (PetscInt)floor(at[d] - to[d] + 0.5);
    off[d] = at[d] - to[d] - (PetscReal)wrap[d];
  }
  for (int d = 0; d < 2; d++)
    if (fabs(off[0] * b->period[0][d] + off[1] * b->period[1][d]) > SAME * b->size) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Finds the point of a vertex among those before it, in its box and those beside it. */
static PetscInt FindPoint(const Builder *b, const Grid *grid, PetscInt v, PetscInt wrap[2])
{
  PetscReal at[2];

  Place(b, v, at);
  for (PetscInt i = -1; i <= 1; i++)
    for (PetscInt j = -1; j <= 1; j++) {
      const PetscInt k = (BoxOf(grid, at[0]) + i + grid->n) % grid->n, l = (BoxOf(grid, at[1]) + j + grid->n) % grid->n;

      for (PetscInt w = grid->head[k * grid->n + l]; w >= 0; w = grid->next[w])
        if (Coincide(b, v, w, wrap)) return w;
    }
  wrap[0] = wrap[1] = 0;
  return v;
}

static PetscErrorCode FindPoints(Builder *b)
{
  const PetscInt n = b->of->vertices;
  Grid grid = {.n = PetscMax(1, (PetscInt)sqrt((double)n))};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(grid.n * grid.n, &grid.head, n, &grid.next));
  for (PetscInt k = 0; k < grid.n * grid.n; k++) grid.head[k] = -1;
  for (PetscInt v = 0; v < n; v++) {
    PetscReal at[2];
    PetscInt *head;

    b->point[v] = FindPoint(b, &grid, v, b->wrap[v]);
    if (b->point[v] != v) continue;
    Place(b, v, at);
    head = &grid.head[BoxOf(&grid, at[0]) * grid.n + BoxOf(&grid, at[1])];
    grid.next[v] = *head;
    *head = v;
  }
  PetscCall(PetscFree2(grid.head, grid.next));
  PetscFunctionReturn(0);
}

/* ---- faces ---- */

static PetscInt EndOf(const Builder *b, PetscInt face)
{
  return b->of->corner[LamTissueNext(b->tissue, face)];
}

static Edge EdgeOf(const Builder *b, PetscInt face)
{
  const PetscInt v = b->of->corner[face], w = EndOf(b, face), p = b->point[v], q = b->point[w];
  const PetscInt step[2] = {b->wrap[w][0] - b->wrap[v][0], b->wrap[w][1] - b->wrap[v][1]};
  const PetscBool forward = (PetscBool)(p < q || (p == q && (step[0] > 0 || (step[0] == 0 && step[1] > 0))));
  const PetscInt sign = forward ? 1 : -1;

  return (Edge){face, {forward ? p : q, forward ? q : p, sign * step[0], sign * step[1]}, forward};
}

static int CompareEdges(const void *one, const void *other)
{
  const Edge *a = (const Edge *)one, *b = (const Edge *)other;

  for (int k = 0; k < 4; k++)
    if (a->key[k] != b->key[k]) return a->key[k] < b->key[k] ? -1 : 1;
  return a->face < b->face ? -1 : a->face > b->face;
}

static void Join(Builder *b, PetscInt face, PetscInt partner)
{
  const PetscInt v = b->of->corner[face], w = EndOf(b, partner);

  b->tissue->partner[face] = partner;
  for (int d = 0; d < 2; d++) b->tissue->wraps[face][d] = b->wrap[v][d] - b->wrap[w][d];
}

static PetscErrorCode FindPartners(Builder *b)
{
  const LamTissue t = b->tissue;
  Edge *edges;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(t->faces, &edges));
  for (PetscInt k = 0; k < t->faces; k++) edges[k] = EdgeOf(b, k);
  qsort(edges, (size_t)t->faces, sizeof(*edges), CompareEdges);
  for (PetscInt k = 0; k + 1 < t->faces; k++) {
    const Edge *one = &edges[k], *other = &edges[k + 1];

    if (memcmp(one->key, other->key, sizeof(one->key))) continue;
    MUST(one->forward != other->forward && t->partner[one->face] < 0,
         "%s: cells[%d] and cells[%d] both have the edge from vertex %d on the same side: they overlap", b->of->name,
         (int)t->cell[one->face], (int)t->cell[other->face], (int)b->of->corner[one->face]);
    Join(b, one->face, other->face);
    Join(b, other->face, one->face);
  }
  PetscCall(PetscFree(edges));
  PetscFunctionReturn(0);
}

/* ---- loops of borders ---- */

/* The border behind a border: around the cells that meet at its end. */
static PetscInt NextBorder(LamTissue t, PetscInt face)
{
  PetscInt next = LamTissueNext(t, face);

  while (t->partner[next] >= 0) next = LamTissueNext(t, t->partner[next]);
  return next;
}

/* Area to the left of a loop of borders, negative for an air space; infinite for one that goes on to its own image. */
static PetscReal LoopArea(const Builder *b, PetscInt start)
{
  PetscReal area = 0.0, x[2] = {0.0, 0.0};
  PetscInt face = start;

  do {
    const PetscReal *v = b->of->vertex[b->of->corner[face]], *w = b->of->vertex[EndOf(b, face)];
    const PetscReal next[2] = {x[0] + w[0] - v[0], x[1] + w[1] - v[1]};

    area += 0.5 * Cross(x, next);
    x[0] = next[0];
    x[1] = next[1];
    face = NextBorder(b->tissue, face);
  } while (face != start);
  return hypot(x[0], x[1]) > 1e-3 * b->size ? INFINITY : area;
}

static PetscErrorCode FindLoops(Builder *b)
{
  const LamTissue t = b->tissue;
  PetscBool *met;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(t->faces, &met));
  for (PetscInt k = 0; k < t->faces; k++) {
    if (t->partner[k] >= 0 || met[k]) continue;
    const PetscReal area = LoopArea(b, k);

    if (area > 0.0)
      b->outside += area;
    else
      b->air -= area;
    for (PetscInt face = k; !met[face]; face = NextBorder(t, face)) {
      met[face] = PETSC_TRUE;
      b->outer[face] = (PetscBool)(area > 0.0);
    }
  }
  PetscCall(PetscFree(met));
  PetscFunctionReturn(0);
}

/* Outer walls of a patch that follow F: with affine sides all to the outside, otherwise those at the lowest and highest
   X2. */
static PetscErrorCode HoldFaces(Builder *b)
{
  const LamPolygons *p = b->of;
  PetscReal low = INFINITY, high = -INFINITY, where[2] = {INFINITY, -INFINITY};

  PetscFunctionBeginUser;
  if (!p->is_patch) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < b->tissue->faces; k++) {
    low = PetscMin(low, p->vertex[p->corner[k]][1]);
    high = PetscMax(high, p->vertex[p->corner[k]][1]);
  }
  for (PetscInt k = 0; k < b->tissue->faces; k++) {
    const PetscReal y[2] = {p->vertex[p->corner[k]][1], p->vertex[EndOf(b, k)][1]};
    const PetscReal top = PetscMax(y[0], y[1]), bottom = PetscMin(y[0], y[1]), off = 100.0 * SAME * b->size;

    if (b->tissue->partner[k] >= 0) continue;
    if (top - low <= off) where[0] = low;
    if (high - bottom <= off) where[1] = high;
    b->tissue->held[k] =
        (PetscBool)((p->sides == LAM_SIDES_AFFINE && b->outer[k]) || top - low <= off || high - bottom <= off);
  }
  MUST(
      p->sides == LAM_SIDES_AFFINE || (where[0] == low && where[1] == high),
      "%s: no edge lies along the %s end of the patch, X2 = %.6g, where the grip holds; a patch has straight ends, and "
      "a tissue that repeats has a period",
      p->name, where[0] == low ? "upper" : "lower", (double)(where[0] == low ? high : low));
  PetscFunctionReturn(0);
}

static void SetDirections(Builder *b)
{
  const LamTissue t = b->tissue;

  for (PetscInt k = 0; k < t->faces; k++) {
    const PetscReal *v = b->of->vertex[b->of->corner[k]], *w = b->of->vertex[EndOf(b, k)];
    const PetscReal normal = atan2(v[0] - w[0], w[1] - v[1]) - b->of->orientation;
    const PetscInt nearest = (PetscInt)floor(normal / (PETSC_PI / 3.0) + 0.5);

    if (t->partner[k] >= 0 && t->partner[k] < k) {
      t->direction[k] = (t->direction[t->partner[k]] + LAM_DIRECTIONS / 2) % LAM_DIRECTIONS;
      continue;
    }
    t->direction[k] =
        b->of->face_class ? b->of->face_class[k] : (nearest % LAM_DIRECTIONS + LAM_DIRECTIONS) % LAM_DIRECTIONS;
  }
}

/* ---- air at junctions ---- */

static PetscErrorCode SetSetbacks(Builder *b)
{
  const LamPolygons *p = b->of;
  const LamTissue t = b->tissue;
  PetscBool *outer; /* [vertex] an outer wall that follows F ends there: no air */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(p->vertices, &outer));
  for (PetscInt k = 0; k < t->faces; k++) {
    b->around[b->point[p->corner[k]]]++;
    if (t->held[k]) outer[b->point[p->corner[k]]] = outer[b->point[EndOf(b, k)]] = PETSC_TRUE;
  }
  for (PetscInt k = 0; k < t->faces; k++) {
    const PetscInt v = p->corner[k], point = b->point[v];
    const PetscBool bend = (PetscBool)(b->around[point] == 2 && t->partner[k] >= 0 &&
                                       t->partner[LamTissuePrevious(t, k)] >= 0); /* of a face between two cells */

    MUST(fabs(p->setback[v] - p->setback[point]) <= SAME * b->size,
         "%s: corner_radius: vertices %d and %d are the same point, and have different ones", p->name, (int)point,
         (int)v);
    if (!outer[point] && !bend) t->setback[k] = p->setback[point];
  }
  PetscCall(PetscFree(outer));
  for (PetscInt k = 0; k < t->faces; k++) {
    const PetscReal *v = p->vertex[p->corner[k]], *w = p->vertex[EndOf(b, k)], edge = hypot(w[0] - v[0], w[1] - v[1]);
    const PetscReal ends[2] = {t->setback[k], t->setback[LamTissueNext(t, k)]};

    MUST(b->around[b->point[p->corner[k]]] <= MOST_AROUND, "%s: more than %d cells meet at vertex %d", p->name,
         MOST_AROUND, (int)p->corner[k]);
    for (int i = 0; i < 2; i++)
      MUST(ends[i] <= MOST_SETBACK * edge,
           "%s: corner_radius: air at vertex %d begins %.3g from it along an edge of cells[%d] that is %.3g long; it "
           "may begin at %.2g of the edge at most: write a smaller radius",
           p->name, (int)(i ? EndOf(b, k) : p->corner[k]), (double)ends[i], (int)t->cell[k], (double)edge,
           MOST_SETBACK);
  }
  PetscFunctionReturn(0);
}

/* ---- areas ---- */

/* Of a period whose cells leave a way through the air between all of them, an island or a strip, the outline says
   nothing of that air. */
static PetscErrorCode SetArea(Builder *b)
{
  const LamPolygons *p = b->of;
  const PetscReal period = Cross(b->period[0], b->period[1]);
  PetscReal cells = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt cell = 0; cell < p->cells; cell++) cells += AreaOf(p, cell);
  b->tissue->area = p->is_patch ? b->outside : period;
  MUST(fabs(b->tissue->area - cells - b->air) < 1e-5 * b->tissue->area ||
           (!p->is_patch && b->outside > (1.0 - SAME) * cells),
       "%s: cells of %.8g and air spaces of %.8g do not add up to the area of %.8g: cells overlap, or vertices where "
       "three cells meet are missing in one of them",
       p->name, (double)cells, (double)b->air, (double)b->tissue->area);
  PetscFunctionReturn(0);
}

/* Whether all cells hang together. */
static PetscErrorCode CheckConnection(const Builder *b)
{
  const LamTissue t = b->tissue;
  PetscInt *queue, count = 1, lost = -1;
  PetscBool *met;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(t->cells, &queue));
  PetscCall(PetscCalloc1(t->cells, &met));
  queue[0] = 0;
  met[0] = PETSC_TRUE;
  for (PetscInt i = 0; i < count; i++)
    for (PetscInt k = t->first[queue[i]]; k < t->first[queue[i] + 1]; k++) {
      const PetscInt other = t->partner[k] < 0 ? queue[i] : t->cell[t->partner[k]];

      if (met[other]) continue;
      met[other] = PETSC_TRUE;
      queue[count++] = other;
    }
  for (PetscInt cell = 0; cell < t->cells && lost < 0; cell++)
    if (!met[cell]) lost = cell;
  PetscCall(PetscFree(queue));
  PetscCall(PetscFree(met));
  MUST(lost < 0, "%s: cells[%d] shares no edge with the cells that hang together with cells[0]; nothing holds it",
       b->of->name, (int)lost);
  PetscFunctionReturn(0);
}

/* ---- all of it ---- */

static void Scale(Builder *b, PetscReal apothem)
{
  const LamTissue t = b->tissue;

  for (PetscInt k = 0; k < t->faces; k++) {
    for (int d = 0; d < 2; d++) t->corner[k][d] = b->of->vertex[b->of->corner[k]][d] / apothem;
    t->setback[k] /= apothem;
    if (b->of->share) t->share[k] = b->of->share[k];
  }
  for (int k = 0; k < 4 && !b->of->is_patch; k++) t->period[k / 2][k % 2] = b->period[k / 2][k % 2] / apothem;
  t->area /= apothem * apothem;
}

static PetscErrorCode Build(Builder *b)
{
  const LamPolygons *p = b->of;
  PetscReal area = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt cell = 0; cell < p->cells; cell++) {
    PetscCall(CheckCell(p, cell));
    area += AreaOf(p, cell) / (PetscReal)p->cells;
    for (PetscInt k = p->first[cell]; k < p->first[cell + 1]; k++) b->tissue->cell[k] = cell;
  }
  (void)PetscArraycpy(b->tissue->first, p->first, p->cells + 1);
  b->size = sqrt(area);
  PetscCall(SetPeriod(b));
  PetscCall(FindPoints(b));
  for (PetscInt k = 0; k < b->tissue->faces; k++) {
    const PetscInt v = p->corner[k], w = EndOf(b, k);

    MUST(b->point[v] != b->point[w] || memcmp(b->wrap[v], b->wrap[w], sizeof(b->wrap[v])),
         "%s: vertices %d and %d of cells[%d] are at the same place", p->name, (int)v, (int)w, (int)b->tissue->cell[k]);
  }
  PetscCall(FindPartners(b));
  PetscCall(FindLoops(b));
  PetscCall(HoldFaces(b));
  SetDirections(b);
  PetscCall(SetSetbacks(b));
  PetscCall(SetArea(b));
  PetscCall(CheckConnection(b));
  Scale(b, sqrt(area / (2.0 * sqrt(3.0))));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueFromPolygons(const LamPolygons *p, PetscReal *apothem, LamTissue *tissue)
{
  Builder b = {.of = p};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *tissue = NULL;
  MUST(p->cells > 0, "%s: cells: there is none", p->name);
  PetscCall(LamTissueAllocate(p->cells, p->first[p->cells], &b.tissue));
  PetscCall(PetscMalloc2(p->vertices, &b.point, p->vertices, &b.wrap));
  PetscCall(PetscCalloc2(p->vertices, &b.around, b.tissue->faces, &b.outer));
  ierr = Build(&b);
  PetscCall(PetscFree2(b.point, b.wrap));
  PetscCall(PetscFree2(b.around, b.outer));
  if (ierr) PetscCall(LamTissueDestroy(&b.tissue));
  PetscCall(ierr);
  *apothem = b.size / sqrt(2.0 * sqrt(3.0));
  *tissue = b.tissue;
  PetscFunctionReturn(0);
}
