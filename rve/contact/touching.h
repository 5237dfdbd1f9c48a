/*
  Walls that are near each other: every outer wall against every image of every cell's outer walls, and the walls of a
  lumen against each other.

  Each cell has two contours (smooth.h): its outer walls, counter-clockwise, and its lumen, clockwise, so that the
  outward side of both is outside the wall. Control points are the nodes at the ends of elements, and at their middle
    c_m = x_m + (2 x_m - x_e - x_f)/6,    x_e, x_f the ends,
  so that a uniform pressure on a straight contour loads the nodes as one on the elements does, 1 : 4 : 1. A corner v of
  a cell has two control points: the contour is straight up to them and rounds the corner within a sixth of a span. For
  wide laws they lie at (1 - bevel) v + bevel m, with the nodes m next to it.

  Walls that can be cut (mesh.h) have such a pair at each cut, whose points are the nodes on both sides of it; the
  middle of an element beside a cut is a control point as it is, so that a span depends on LAM_SPAN_NODES nodes. Once
  the cut is torn both contours end at it, and the span between its sides is not there any more.

  Points of a contour are spread evenly, LAM_TOUCH_POINTS in each span. Nothing distinguishes master from slave: each
  point is held against all contours, and each pair of walls is met from both sides, with half the potential each.

  Closest points are computed where the boxes of two spans lie within reach, and the point is not farther outside the
  other span than the width, as seen along the normal of its chord. One that lies behind a span of another cell has
  entered its wall only if no other span of that loop is nearer.
*/
#ifndef LAM_RVE_TOUCHING_H
#define LAM_RVE_TOUCHING_H

#include <lamella/scene.h>
#include "mesh.h"
#include "smooth.h"

#define LAM_TOUCH_POINTS 6 /* per span: 3 leave a ripple in the tangent, more change little */

typedef struct {
  PetscReal low[2], high[2];
} LamBox;

typedef struct {
  PetscInt first;                                    /* of the nodes of the span, which follow each other; may lie
                                                        before the loop's first one */
  PetscReal share[LAM_SPAN][LAM_SPAN_NODES];         /* control point = sum share node */
  PetscReal point[LAM_TOUCH_POINTS][LAM_SPAN_NODES]; /* point = sum point node */
} LamSpanNodes;

/* A span at the positions last placed. */
typedef struct {
  LamSplineCurve curve;
  PetscReal point[LAM_TOUCH_POINTS][2];
  LamBox box;
  PetscReal outward[2]; /* normal of the chord */
  PetscReal top;        /* most of outward.y; infinite if a normal of the span is not within 90 degrees of outward */
  PetscReal bend[2][2]; /* y_uu at both ends, between which it is linear */
  PetscReal least[2];   /* of y_uu.y with either */
  PetscReal slowest;    /* at most the square of y_u everywhere */
} LamWallSpan;

typedef struct {
  const LamMesh *mesh;                   /* borrowed */
  PetscInt loops;                        /* loop 2 c: outer walls of cell c, loop 2 c + 1: its lumen */
  PetscInt *first;                       /* [loops + 1] first span of a loop, of all */
  PetscInt *node;                        /* [loop][node] nodes of the mesh */
  PetscReal bevel;                       /* of corners, in spans */
  LamSpanNodes *of, *ended;              /* [span] of a loop; and where the contour ends with it, or begins */
  PetscInt per_face, per_part;           /* parts of a face, between corners or cuts, and control points of each */
  PetscInt most;                         /* spans of the longest loop */
  PetscBool *gone;                       /* [loop][span] between the sides of a torn cut */
  PetscBool is_patch;                    /* no images */
  PetscInt apart;                        /* least distance of points of one loop that may touch, in spans */
  PetscReal *weight;                     /* [loop][span][point] reference length */
  PetscReal (*rest)[2];                  /* [loop][span] middle of a span at rest */
  PetscReal *thickness;                  /* [cell] of its wall, at most the depth to which points count */
  LamSplineWeights at[LAM_TOUCH_POINTS]; /* the points of a span */
  const PetscBool *near;                 /* [cell] whose walls are placed and visited; borrowed; NULL: all */
  /* of the positions last placed */
  PetscReal (*x)[2]; /* [loop][span] control points: span k lies between k and k + 1 */
  LamWallSpan *span; /* [loop][span] */
  LamBox *box;       /* [loop] */
  LamBox *group;     /* [loop][group] of spans following each other; those of a loop begin at first / GROUP + loop */
  PetscReal F[9];
} LamWalls;

PetscErrorCode LamWallsCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamWalls *walls);
/* Sets the corners for a law of this width. */
void LamWallsRound(LamWalls *walls, PetscReal width);
PetscErrorCode LamWallsDestroy(LamWalls *walls);
/* Sets which cuts are torn: torn [cut]. */
void LamWallsTearAt(LamWalls *walls, const PetscBool torn[]);
/* Takes the positions of a state. */
void LamWallsPlace(LamWalls *walls, const PetscReal F[9], const PetscReal y[]);

/* A point of a wall near another wall, whose gap is below the width. */
typedef struct {
  PetscInt loop, span, point; /* of the point */
  PetscInt other, at;         /* loop and span that it is near to, ... */
  PetscReal shift[2];         /* ... in the image at F shift */
  PetscReal weight;           /* reference length of the point */
  LamTouchGap gap;
} LamTouching;
typedef void (*LamTouchVisitor)(void *ctx, const LamTouching *touch);
/* Calls the visitor for all such points; those of the same two spans follow each other. */
void LamWallsVisit(const LamWalls *walls, PetscReal width, LamTouchVisitor visitor, void *ctx);

/* Spans and nodes of a loop. */
static inline PetscInt LamWallsSpans(const LamWalls *walls, PetscInt loop)
{
  return walls->first[loop + 1] - walls->first[loop];
}
static inline PetscInt LamWallsNodes(const LamWalls *walls, PetscInt loop)
{
  return LamMeshRingNodes(walls->mesh, loop / 2);
}
static inline PetscInt LamWallsFirstNode(const LamWalls *walls, PetscInt loop)
{
  return LamMeshFirstRing(walls->mesh, loop / 2) + LamMeshFirstRing(walls->mesh, (loop + 1) / 2);
}
/* Mesh node i along a loop, which goes on before its start and behind its end. */
static inline PetscInt LamWallsNodeAt(const LamWalls *walls, PetscInt loop, PetscInt i)
{
  const PetscInt n = LamWallsNodes(walls, loop);

  return walls->node[LamWallsFirstNode(walls, loop) + (i >= 0 && i < n ? i : (i % n + n) % n)];
}
/* Mesh node k = 0..LAM_SPAN_NODES - 1 of a span. */
static inline PetscInt LamWallsNode(const LamWalls *walls, PetscInt loop, PetscInt span, PetscInt k)
{
  return LamWallsNodeAt(walls, loop, walls->of[span].first + k);
}
/* Whether a span is the last or the first one before or behind a torn cut. */
static inline PetscBool LamWallsEnd(const LamWalls *walls, PetscInt loop, PetscInt span)
{
  const PetscBool *gone = &walls->gone[walls->first[loop]];
  const PetscInt spans = LamWallsSpans(walls, loop);

  return (PetscBool)(gone[span + 1 == spans ? 0 : span + 1] || gone[span == 0 ? spans - 1 : span - 1]);
}
static inline const LamSpanNodes *LamWallsSpan(const LamWalls *walls, PetscInt loop, PetscInt span)
{
  return LamWallsEnd(walls, loop, span) ? &walls->ended[span] : &walls->of[span];
}
/* Part of a span, and its place there; that between two parts is the last one of the first. */
static inline PetscInt LamWallsPart(const LamWalls *walls, PetscInt span, PetscInt *at)
{
  *at = span % walls->per_part;
  return span / walls->per_part;
}
/* Face of a span of outer walls, and which of its 2 along halves of edges; at a corner, half 2 along belongs to the
   next face, too. */
static inline PetscInt LamWallsFace(const LamWalls *walls, PetscInt loop, PetscInt span, PetscInt *half)
{
  const PetscInt part = LamWallsPart(walls, span, half);

  *half += part % walls->per_face * (walls->per_part - 1);
  return walls->mesh->tissue->first[loop / 2] + part / walls->per_face;
}
static inline PetscBool LamTouchIsLumen(const LamTouching *touch)
{
  return (PetscBool)(touch->loop % 2 == 1);
}
/* Whether the two walls face each other in the undeformed tissue. */
PetscBool LamTouchIsFacing(const LamWalls *walls, const LamTouching *touch);

#endif
