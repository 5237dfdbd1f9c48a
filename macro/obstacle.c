/*
  Rigid, frictionless obstacles: flat plates and round indenters, in unilateral contact with the nodes of a named side.

  Each node is constrained by its nearest obstacle only: simultaneous contact of a node with two obstacles (a wedge)
  is not covered.
*/
#include <math.h>
#include "macro_impl.h"

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

/* Distance along its normal or path by which the obstacle moves until it touches the first of its nodes. */
static PetscReal Reach(LamMacro macro, const LamObstacle *obstacle, PetscInt o, const PetscScalar u[])
{
  const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
  const PetscReal *d = obstacle->normal; /* for an indenter the direction of its path */
  PetscReal reach = PETSC_INFINITY;

  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    PetscReal x[2], along, aside;
    if (!(node->obstacles >> o & 1)) continue;
    for (int i = 0; i < 2; i++)
      x[i] = macro->position[2 * (node->point - macro->mesh_start) + i] + PetscRealPart(u[node->local + i]) -
             boundary->at[i];
    along = x[0] * d[0] + x[1] * d[1];
    aside = x[0] * d[1] - x[1] * d[0];
    if (boundary->kind == LAM_BOUNDARY_PLATE)
      reach = PetscMin(reach, along);
    else if (PetscAbsReal(aside) < boundary->radius)
      reach = PetscMin(reach, along - PetscSqrtReal(PetscSqr(boundary->radius) - PetscSqr(aside)));
  }
  return reach;
}

/* From the plate into the body, or along the indenter's path. */
static PetscErrorCode Direction(LamMacro macro, const LamBoundary *boundary, PetscReal direction[2])
{
  const PetscReal length = hypot(boundary->displacement[0], boundary->displacement[1]);

  PetscFunctionBeginUser;
  if (boundary->kind == LAM_BOUNDARY_INDENTER) {
    for (int i = 0; i < 2; i++) direction[i] = boundary->displacement[i] / length;
  } else if (boundary->normal[0] != 0 || boundary->normal[1] != 0) {
    for (int i = 0; i < 2; i++) direction[i] = boundary->normal[i];
  } else {
    PetscCall(LamMacroStraightNormal(macro, boundary, direction));
    for (int i = 0; i < 2; i++) direction[i] = -direction[i];
  }
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
  PetscFunctionReturn(0);
}

void LamMacroObstaclesMove(LamMacro macro)
{
  for (PetscInt o = 0; o < macro->obstacle_count; o++) {
    LamObstacle *obstacle = &macro->obstacles[o];
    const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
    const PetscReal factor = LamHistoryFactor(&boundary->history, macro->parameter), *d = boundary->displacement;
    if (boundary->kind == LAM_BOUNDARY_PLATE) {
      obstacle->place[0] = obstacle->start + factor * (d[0] * obstacle->normal[0] + d[1] * obstacle->normal[1]);
    } else {
      for (int i = 0; i < 2; i++) obstacle->place[i] = obstacle->first[i] + factor * d[i];
    }
  }
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
  }
}

LamTouch LamMacroNearest(LamMacro macro, const LamObstacleNode *node, const PetscScalar u[])
{
  const PetscReal *X = &macro->position[2 * (node->point - macro->mesh_start)];
  LamTouch nearest = {.gap = PETSC_INFINITY};

  for (PetscInt o = 0; o < macro->obstacle_count; o++) {
    const LamObstacle *obstacle = &macro->obstacles[o];
    const LamBoundary *boundary = &macro->scene->macro.boundary[obstacle->entry];
    LamTouch touch = {.obstacle = o, .normal = {obstacle->normal[0], obstacle->normal[1]}};
    const PetscReal x[2] = {X[0] + PetscRealPart(u[node->local]), X[1] + PetscRealPart(u[node->local + 1])};
    if (!(node->obstacles >> o & 1)) continue;
    if (boundary->kind == LAM_BOUNDARY_PLATE) {
      touch.gap = x[0] * touch.normal[0] + x[1] * touch.normal[1] - obstacle->place[0];
    } else {
      const PetscReal from[2] = {x[0] - obstacle->place[0], x[1] - obstacle->place[1]},
                      distance = PetscMax(PetscSqrtReal(PetscSqr(from[0]) + PetscSqr(from[1])), PETSC_SMALL);
      touch.gap = distance - boundary->radius;
      touch.curvature = 1 / distance;
      for (int i = 0; i < 2; i++) touch.normal[i] = from[i] / distance;
    }
    if (touch.gap < nearest.gap) nearest = touch;
  }
  return nearest;
}
