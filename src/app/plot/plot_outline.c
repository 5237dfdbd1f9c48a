/*
  Edges and closed outlines of meshes of nine-node quadrilaterals and six-node triangles.

  Algorithm. Sort all edges by group and nodes: an edge that occurs twice is interior, one that occurs once is on the
  boundary of its group. Boundary edges keep the direction of their element, so the outer loop of a ring runs
  counter-clockwise and that of its lumen clockwise.
*/
#include "plot.h"
#include <stdlib.h>

static int CompareEdges(const void *a, const void *b)
{
  const LamEdge *p = (const LamEdge *)a, *q = (const LamEdge *)b;
  const PetscInt keys[3][2] = {{p->group, q->group},
                               {PetscMin(p->start, p->end), PetscMin(q->start, q->end)},
                               {PetscMax(p->start, p->end), PetscMax(q->start, q->end)}};

  for (int k = 0; k < 3; k++)
    if (keys[k][0] != keys[k][1]) return keys[k][0] < keys[k][1] ? -1 : 1;
  return 0;
}

static int CompareStarts(const void *a, const void *b)
{
  const LamEdge *p = (const LamEdge *)a, *q = (const LamEdge *)b;

  if (p->boundary != q->boundary) return p->boundary ? -1 : 1;
  if (p->group != q->group) return p->group < q->group ? -1 : 1;
  return (p->start > q->start) - (p->start < q->start);
}

/* The boundary edge of the group that starts at `node`, among the first n edges sorted by CompareStarts; -1: none. */
static PetscInt FindStart(PetscInt n, const LamEdge edges[], PetscInt group, PetscInt node)
{
  const LamEdge wanted = {node, -1, -1, group, PETSC_TRUE, -1};
  const LamEdge *found = (const LamEdge *)bsearch(&wanted, edges, (size_t)n, sizeof *edges, CompareStarts);

  return found ? (PetscInt)(found - edges) : -1;
}

/* Follows boundary edges from end to start until each is part of a loop. */
static PetscErrorCode ChainLoops(PetscInt boundary_count, LamOutline *outline)
{
  PetscBool *used;
  PetscInt placed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(boundary_count, &used));
  PetscCall(PetscMalloc1(boundary_count, &outline->loop_edges));
  PetscCall(PetscMalloc1(boundary_count + 1, &outline->loop_start));
  for (PetscInt first = 0; first < boundary_count; first++) {
    if (used[first]) continue;
    outline->loop_start[outline->loop_count++] = placed;
    for (PetscInt i = first; i >= 0 && !used[i];
         i = FindStart(boundary_count, outline->edges, outline->edges[i].group, outline->edges[i].end)) {
      used[i] = PETSC_TRUE;
      outline->loop_edges[placed++] = i;
    }
  }
  outline->loop_start[outline->loop_count] = placed;
  PetscCall(PetscFree(used));
  PetscFunctionReturn(0);
}

PetscErrorCode LamOutlineCreate(PetscInt element_count, const PetscInt elements[], const PetscInt groups[],
                                LamOutline *outline)
{
  LamEdge *edges;
  PetscInt total = 0, n = 0, boundary_count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(outline, sizeof *outline));
  PetscCall(PetscMalloc1(4 * element_count, &edges));
  for (PetscInt e = 0; e < element_count; e++) {
    const PetscInt *nodes = &elements[9 * e];
    const int corners = LamElementNodes(nodes) == 6 ? 3 : 4;

    for (int k = 0; k < corners; k++)
      edges[total++] =
          (LamEdge){nodes[k], nodes[corners + k], nodes[(k + 1) % corners], groups ? groups[e] : 0, PETSC_TRUE, e};
  }
  qsort(edges, (size_t)total, sizeof *edges, CompareEdges);
  for (PetscInt i = 0; i < total; i++) {
    if (n && !CompareEdges(&edges[n - 1], &edges[i])) {
      boundary_count -= edges[n - 1].boundary;
      edges[n - 1].boundary = PETSC_FALSE;
    } else {
      edges[n++] = edges[i];
      boundary_count++;
    }
  }
  qsort(edges, (size_t)n, sizeof *edges, CompareStarts);
  outline->edge_count = n;
  outline->edges = edges;
  PetscCall(ChainLoops(boundary_count, outline));
  PetscFunctionReturn(0);
}

PetscErrorCode LamOutlineDestroy(LamOutline *outline)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(outline->edges));
  PetscCall(PetscFree(outline->loop_start));
  PetscCall(PetscFree(outline->loop_edges));
  PetscCall(PetscMemzero(outline, sizeof *outline));
  PetscFunctionReturn(0);
}

PetscReal LamOutlineLoopArea(const LamOutline *outline, PetscInt loop, const PetscReal x[])
{
  PetscReal area = 0;

  for (PetscInt i = outline->loop_start[loop]; i < outline->loop_start[loop + 1]; i++) {
    const LamEdge *edge = &outline->edges[outline->loop_edges[i]];
    const PetscReal *a = &x[2 * edge->start], *m = &x[2 * edge->middle], *b = &x[2 * edge->end];
    const PetscReal am = a[0] * m[1] - a[1] * m[0], mb = m[0] * b[1] - m[1] * b[0], ab = a[0] * b[1] - a[1] * b[0];

    /* exact half of the integral of X dY - Y dX along the quadratic edge */
    area += (4 * am + 4 * mb - ab) / 6;
  }
  return area;
}

/* A cubic Bezier curve: the parabola's control point is 2m - (a + b)/2. */
void LamOutlineEdgePath(LamCanvas canvas, const LamView *view, const LamEdge *edge, const PetscReal x[],
                        const PetscReal shift[2], PetscBool joined)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const PetscReal dx = shift ? shift[0] : 0, dy = shift ? shift[1] : 0;
  double a[2], m[2], b[2], p[2], q[2];

  LamViewPoint(view, x[2 * edge->start] + dx, x[2 * edge->start + 1] + dy, a);
  LamViewPoint(view, x[2 * edge->middle] + dx, x[2 * edge->middle + 1] + dy, m);
  LamViewPoint(view, x[2 * edge->end] + dx, x[2 * edge->end + 1] + dy, b);
  for (int k = 0; k < 2; k++) {
    const double control = 2 * m[k] - 0.5 * (a[k] + b[k]);

    p[k] = a[k] + 2.0 / 3.0 * (control - a[k]);
    q[k] = b[k] + 2.0 / 3.0 * (control - b[k]);
  }
  if (!joined) cairo_move_to(cr, a[0], a[1]);
  cairo_curve_to(cr, p[0], p[1], q[0], q[1], b[0], b[1]);
}

void LamOutlineLoopPath(LamCanvas canvas, const LamView *view, const LamOutline *outline, PetscInt loop,
                        const PetscReal x[], const PetscReal shift[2])
{
  const PetscInt first = outline->loop_start[loop];

  for (PetscInt i = first; i < outline->loop_start[loop + 1]; i++)
    LamOutlineEdgePath(canvas, view, &outline->edges[outline->loop_edges[i]], x, shift, (PetscBool)(i > first));
  cairo_close_path(LamCanvasCairo(canvas));
}

void LamOutlineInnerPath(LamCanvas canvas, const LamView *view, const LamOutline *outline, const PetscReal x[])
{
  for (PetscInt i = 0; i < outline->edge_count; i++)
    if (!outline->edges[i].boundary) LamOutlineEdgePath(canvas, view, &outline->edges[i], x, NULL, PETSC_FALSE);
}
