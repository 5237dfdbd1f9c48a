/*
  Rigid obstacles, with or without friction (rows.c): flat plates and indenters, in unilateral contact with the nodes of
  a named side.

  An indenter is all that is nearer to its core than the radius of its edge. The core of a round one is its centre; that
  of a cylinder with a flat end is the cylinder less this distance all around, a half strip in the plane of the mesh.
  The gap is the distance from the core less the radius of the edge; within the core the distance to its nearest side
  counts, negative, but to its end if the node was before that in the last converged state. Around a sharp edge, of
  radius 0, the larger of the distances from the planes of end and shaft takes the place of the distance, whose normal
  has no value at the edge itself.

  Each node is constrained by its nearest obstacle only: simultaneous contact of a node with two obstacles (a wedge)
  is not covered.
*/
#include <math.h>
#include "macro_impl.h"

/* Rounding of places, macro lengths: above it (PENETRATION in stepping.c), end and shaft of an indenter are told apart.
 */
static const PetscReal TIE = 1e-9;

/* Nodes of the obstacles' sides that have at most one prescribed direction; macro->constraints is in their order. */
static PetscErrorCode ListNodes(LamMacro macro)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(macro->obstacle_nodes));
  PetscCall(PetscMalloc1(macro->node_count, &macro->obstacle_nodes));
  macro->obstacle_node_count = 0;
  for (PetscInt n = 0; n < macro->node_count; n++) {
    const PetscInt p = macro->nodes[n].point;
    LamObstacleNode node = {.point = p, .local = macro->nodes[n].local, .constraint = -1};
    PetscInt directions = 0;
    for (PetscInt o = 0; o < macro->obstacle_count; o++) {
      if (LamMacroIsOn(macro, p, macro->scene->macro.boundary[macro->obstacles[o].entry].on)) node.obstacles |= 1u << o;
    }
    if (!node.obstacles) continue;
    for (PetscInt k = 0; k < macro->constraint_count; k++) {
      if (macro->constraints[k].local != node.local) continue;
      node.constraint = k;
      directions++;
    }
    if (directions < 2) macro->obstacle_nodes[macro->obstacle_node_count++] = node;
  }
  PetscFunctionReturn(0);
}

/* Radius of an indenter's edge, and half the width of its core. */
static PetscReal Edge(const LamBoundary *boundary, PetscReal *half)
{
  const PetscReal edge = boundary->shaft ? boundary->edge : boundary->radius;

  *half = boundary->radius - edge;
  return edge;
}

/* Distance along its normal or path by which the obstacle moves until it touches the first of its nodes. */
static PetscReal Reach(LamMacro macro, const LamObstacle *obstacle, PetscInt o, const PetscScalar u[])
{
  const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
  const PetscReal *d = obstacle->normal; /* for an indenter the direction of its path */
  PetscReal reach = PETSC_INFINITY, half;
  const PetscReal edge = Edge(boundary, &half);

  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    PetscReal x[2], along, aside;
    if (!(node->obstacles >> o & 1)) continue;
    for (int i = 0; i < 2; i++)
      x[i] = macro->position[2 * (node->point - macro->mesh_start) + i] + PetscRealPart(u[node->local + i]) -
             boundary->at[i];
    along = x[0] * d[0] + x[1] * d[1];
    aside = PetscMax(0, PetscAbsReal(x[0] * d[1] - x[1] * d[0]) - half);
    if (boundary->kind == LAM_BOUNDARY_PLATE)
      reach = PetscMin(reach, along);
    else if (aside <= edge)
      reach = PetscMin(reach, along - PetscSqrtReal(PetscSqr(edge) - PetscSqr(aside)));
  }
  return reach;
}

/* From the plate into the body, or along the indenter's path. */
static PetscErrorCode Direction(LamMacro macro, const LamBoundary *boundary, PetscReal direction[2])
{
  const PetscReal length = hypot(boundary->displacement[0], boundary->displacement[1]);
  PetscBool faces;

  PetscFunctionBeginUser;
  if (boundary->kind == LAM_BOUNDARY_INDENTER) {
    for (int i = 0; i < 2; i++) direction[i] = boundary->displacement[i] / length;
  } else if (boundary->normal[0] != 0 || boundary->normal[1] != 0) {
    for (int i = 0; i < 2; i++) direction[i] = boundary->normal[i];
  } else {
    PetscCall(LamMacroStraightNormal(macro, boundary, direction));
    for (int i = 0; i < 2; i++) direction[i] = -direction[i];
  }
  PetscCall(LamMacroFaces(macro, boundary->on, direction, &faces));
  LamMacroRequire(faces, macro, &boundary->place, "macro.boundary: on: %s: %s: no part of this side faces it; %s",
                  boundary->on, LamBoundaryKindNames[boundary->kind],
                  boundary->kind == LAM_BOUNDARY_PLATE
                      ? "write its normal from the plate into the body, such as the opposite one"
                      : "write a displacement into the body, such as the opposite one");
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroObstaclesCreate(LamMacro macro)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  const PetscScalar *u;

  PetscFunctionBeginUser;
  macro->obstacle_count = macro->obstacle_node_count = 0;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    if (!LamMacroIsObstacle(&spec->boundary[b])) continue;
    LamObstacle *obstacle = &macro->obstacles[macro->obstacle_count++];
    *obstacle = (LamObstacle){.entry = b, .side = LamMacroSideNumber(&macro->step, &spec->boundary[b])};
    PetscCall(Direction(macro, &spec->boundary[b], obstacle->normal));
  }
  if (!macro->obstacle_count) PetscFunctionReturn(0);
  PetscCall(ListNodes(macro));
  PetscCall(VecGetArrayRead(macro->u, &u));
  for (PetscInt o = 0; o < macro->obstacle_count; o++) {
    LamObstacle *obstacle = &macro->obstacles[o];
    const LamBoundary *boundary = &spec->boundary[obstacle->entry];
    obstacle->start = Reach(macro, obstacle, o, u);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &obstacle->start, 1, MPIU_REAL, MPIU_MIN, macro->comm));
    LamMacroRequire(obstacle->start < PETSC_INFINITY, macro, &boundary->place, "macro.boundary: on: %s: %s: %s",
                    boundary->on, LamBoundaryKindNames[boundary->kind],
                    boundary->kind == LAM_BOUNDARY_PLATE
                        ? "all nodes of this side are prescribed, so the plate meets nothing; leave one of them out"
                        : "its path misses the nodes of this side; move `at`, or take a larger radius or a finer mesh");
    for (int i = 0; i < 2; i++) obstacle->first[i] = boundary->at[i] + obstacle->start * obstacle->normal[i];
  }
  PetscCall(VecRestoreArrayRead(macro->u, &u));
  LamMacroObstaclesMove(macro);
  LamMacroObstaclesAccept(macro);
  PetscFunctionReturn(0);
}

void LamMacroObstaclesMove(LamMacro macro)
{
  for (PetscInt o = 0; o < macro->obstacle_count; o++) {
    LamObstacle *obstacle = &macro->obstacles[o];
    const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
    const PetscReal factor = LamHistoryFactor(&boundary->history, macro->parameter), *d = obstacle->moved;
    for (int i = 0; i < 2; i++) obstacle->moved[i] = factor * boundary->displacement[i];
    if (boundary->kind == LAM_BOUNDARY_PLATE) {
      obstacle->place[0] = obstacle->start + d[0] * obstacle->normal[0] + d[1] * obstacle->normal[1];
    } else {
      for (int i = 0; i < 2; i++) obstacle->place[i] = obstacle->first[i] + d[i];
    }
  }
}

void LamMacroObstaclesAccept(LamMacro macro)
{
  for (PetscInt o = 0; o < macro->obstacle_count; o++)
    for (int i = 0; i < 2; i++) macro->obstacles[o].accepted[i] = macro->obstacles[o].moved[i];
}

void LamMacroObstaclesDescribe(LamMacro macro, LamMacroStep *step)
{
  step->obstacle_count = macro->obstacle_count;
  for (PetscInt o = 0; o < macro->obstacle_count; o++) {
    const LamObstacle *obstacle = &macro->obstacles[o];
    const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
    const PetscBool plate = (PetscBool)(boundary->kind == LAM_BOUNDARY_PLATE);
    for (int i = 0; i < 2; i++) {
      step->obstacle[o][i] = plate ? obstacle->place[0] * obstacle->normal[i] : obstacle->place[i];
      step->obstacle[o][2 + i] = obstacle->normal[i];
    }
    step->obstacle[o][4] = plate ? 0 : boundary->radius;
    step->obstacle[o][5] = plate ? 0 : boundary->shaft ? boundary->edge : boundary->radius;
  }
}

/* Gap, normal and curvature of an indenter at x; was_before: it was before the flat end in the last converged state. */
static void TouchIndenter(const LamObstacle *obstacle, const LamBoundary *boundary, const PetscReal x[2],
                          PetscBool was_before, LamTouch *touch)
{
  const PetscReal *d = obstacle->normal, from[2] = {x[0] - obstacle->place[0], x[1] - obstacle->place[1]};
  const PetscReal behind = -from[0] * d[0] - from[1] * d[1], aside = from[1] * d[0] - from[0] * d[1];
  PetscReal half, side, back; /* of x from the nearest point of the core */
  const PetscReal edge = Edge(boundary, &half);

  side = aside - PetscMin(PetscMax(aside, -half), half);
  back = boundary->shaft ? PetscMin(behind, 0) : behind;
  const PetscBool corner = (PetscBool)(side != 0 && back != 0 && edge > 0);
  if (boundary->shaft && side == 0 && back == 0) { /* within the core */
    const PetscReal depth = half - PetscAbsReal(aside), sign = aside < 0 ? -1 : 1;
    const PetscBool front = (PetscBool)(was_before || behind <= depth + TIE);
    touch->gap = -(front ? behind : depth) - edge;
    touch->normal[0] = front ? d[0] : -sign * d[1];
    touch->normal[1] = front ? d[1] : sign * d[0];
    return;
  }
  if (boundary->shaft && edge == 0 && side != 0 && back != 0) { /* beside a sharp edge */
    if (-back >= PetscAbsReal(side))
      side = 0;
    else
      back = 0;
  }
  const PetscReal distance = PetscMax(hypot(side, back), PETSC_SMALL);
  touch->gap = distance - edge;
  touch->curvature = corner || !boundary->shaft ? 1 / distance : 0;
  touch->normal[0] = (-side * d[1] - back * d[0]) / distance;
  touch->normal[1] = (side * d[0] - back * d[1]) / distance;
}

/* Whether a node was before the end of an indenter with a shaft in the last converged state. Then it is that end that
   has come upon it, even if the shaft is nearer now. */
static PetscBool WasBefore(LamMacro macro, const LamObstacle *obstacle, const LamObstacleNode *node,
                           const PetscScalar before[])
{
  const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
  const PetscReal *X = &macro->position[2 * (node->point - macro->mesh_start)];
  PetscReal along = 0;

  if (!before || !boundary->shaft) return PETSC_FALSE;
  for (int i = 0; i < 2; i++)
    along += (X[i] + PetscRealPart(before[node->local + i]) - obstacle->first[i] - obstacle->accepted[i]) *
             obstacle->normal[i];
  return along > boundary->edge - TIE ? PETSC_TRUE : PETSC_FALSE;
}

/* Motion of a node along its obstacle since the last converged state. */
static void FindSlid(LamMacro macro, const LamObstacleNode *node, const PetscScalar u[], const PetscScalar before[],
                     LamTouch *touch)
{
  const LamObstacle *obstacle = &macro->obstacles[touch->obstacle];

  for (int i = 0; i < 2; i++)
    touch->slid[i] = PetscRealPart(u[node->local + i]) - PetscRealPart(before[node->local + i]) - obstacle->moved[i] +
                     obstacle->accepted[i];
}

LamTouch LamMacroNearest(LamMacro macro, const LamObstacleNode *node, const PetscScalar u[], const PetscScalar before[])
{
  const PetscReal *X = &macro->position[2 * (node->point - macro->mesh_start)];
  LamTouch nearest = {.gap = PETSC_INFINITY};

  for (PetscInt o = 0; o < macro->obstacle_count; o++) {
    const LamObstacle *obstacle = &macro->obstacles[o];
    const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
    LamTouch touch = {
        .obstacle = o, .normal = {obstacle->normal[0], obstacle->normal[1]}, .friction = boundary->friction};
    const PetscReal x[2] = {X[0] + PetscRealPart(u[node->local]), X[1] + PetscRealPart(u[node->local + 1])};
    if (!(node->obstacles >> o & 1)) continue;
    if (boundary->kind == LAM_BOUNDARY_PLATE)
      touch.gap = x[0] * touch.normal[0] + x[1] * touch.normal[1] - obstacle->place[0];
    else
      TouchIndenter(obstacle, boundary, x, WasBefore(macro, obstacle, node, before), &touch);
    if (touch.gap < nearest.gap) nearest = touch;
  }
  if (before && nearest.friction > 0) FindSlid(macro, node, u, before, &nearest);
  return nearest;
}
