/*
  Forces on the body at its named sides, and their work.
*/
#include <math.h>
#include "macro_impl.h"

PetscErrorCode LamMacroAddWork(LamMacro macro)
{
  PetscReal now, before;

  PetscFunctionBeginUser;
  /* internal forces are in equilibrium with those of the boundary throughout: other nodes contribute nothing */
  PetscCall(VecWAXPY(macro->external, -1, macro->u, macro->trial));
  PetscCall(VecDot(macro->force, macro->external, &now));
  PetscCall(VecDot(macro->force_accepted, macro->external, &before));
  macro->step.work += 0.5 * (now + before);
  PetscFunctionReturn(0);
}

/* Components of a node's force along its one or two directions. */
static void Decompose(PetscInt count, const PetscReal directions[2][2], const PetscReal force[2], PetscReal part[2])
{
  const PetscReal *m = directions[0], *n = directions[1];

  if (count == 1) {
    part[0] = force[0] * m[0] + force[1] * m[1];
  } else {
    const PetscReal det = m[0] * n[1] - m[1] * n[0];
    part[0] = (force[0] * n[1] - force[1] * n[0]) / det;
    part[1] = (m[0] * force[1] - m[1] * force[0]) / det;
  }
}

/* Distributes a corner's force equally over the sides that prescribe it, so that the reactions of all sides balance. */
static void Share(unsigned int sides, PetscReal part, const PetscReal direction[2], PetscReal reaction[][2])
{
  for (PetscInt s = 0; sides >> s; s++) {
    for (PetscInt i = 0; i < 2 && sides >> s & 1; i++)
      reaction[s][i] += part * direction[i] / __builtin_popcount(sides);
  }
}

PetscInt LamMacroNextHeld(LamMacro macro, PetscInt k)
{
  const PetscInt next = k + 1;

  return next < macro->constraint_count && macro->constraints[next].local == macro->constraints[k].local ? next + 1
                                                                                                         : next;
}

void LamMacroShareHeld(LamMacro macro, PetscInt k, const PetscReal force[2], PetscReal reaction[][2])
{
  const LamConstraint *one = &macro->constraints[k];
  const PetscInt count = LamMacroNextHeld(macro, k) - k;
  PetscReal directions[2][2], part[2];

  for (PetscInt d = 0; d < count; d++) {
    for (PetscInt i = 0; i < 2; i++) directions[d][i] = one[d].normal[i];
  }
  Decompose(count, (const PetscReal(*)[2])directions, force, part);
  for (PetscInt d = 0; d < count; d++) Share(one[d].sides, part[d], directions[d], reaction);
}

void LamMacroShareTouched(LamMacro macro, const LamObstacleNode *node, const LamTouch *touch, const PetscReal force[2],
                          PetscReal reaction[][2])
{
  const unsigned int side = 1u << macro->obstacles[touch->obstacle].side;
  const LamConstraint *held = node->constraint < 0 ? NULL : &macro->constraints[node->constraint];
  const PetscInt own = held ? 1 : 0;
  PetscReal directions[2][2], part[2];

  for (PetscInt i = 0; i < 2 && !held && touch->friction > 0; i++)
    reaction[macro->obstacles[touch->obstacle].side][i] += force[i];
  if (!held && touch->friction > 0) return;
  for (PetscInt i = 0; i < 2; i++) {
    directions[own][i] = touch->normal[i];
    if (held) directions[0][i] = held->normal[i];
  }
  if (held && PetscAbsReal(directions[0][0] * touch->normal[1] - directions[0][1] * touch->normal[0]) < 0.1) return;
  Decompose(own + 1, (const PetscReal(*)[2])directions, force, part);
  Share(side, part[own], touch->normal, reaction);
  if (held) { /* LamMacroShareHeld assigned all of the force along the direction to these sides */
    const PetscReal along = directions[0][0] * touch->normal[0] + directions[0][1] * touch->normal[1];
    Share(held->sides, -part[own] * along, directions[0], reaction);
  }
}

/* Adds the forces r of all nodes. */
static void AddNodes(LamMacro macro, const PetscScalar u[], const PetscScalar r[], PetscReal reaction[][2])
{
  for (PetscInt k = 0; k < macro->constraint_count; k = LamMacroNextHeld(macro, k)) {
    const PetscInt at = macro->constraints[k].local;
    LamMacroShareHeld(macro, k, (PetscReal[2]){PetscRealPart(r[at]), PetscRealPart(r[at + 1])}, reaction);
  }
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    const LamTouch touch = LamMacroNearest(macro, node, u, NULL);
    const PetscReal force[2] = {PetscRealPart(r[node->local]), PetscRealPart(r[node->local + 1])};
    LamMacroShareTouched(macro, node, &touch, force, reaction);
  }
}

/* During inflation the sides are not prescribed yet: their displacements are 0. */
void LamMacroDisplacements(LamMacro macro, LamMacroStep *step)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  for (PetscInt s = 0; s < step->boundary_count; s++) step->displacement[s][0] = step->displacement[s][1] = NAN;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscBool obstacle = LamMacroIsObstacle(boundary);
    PetscReal *displacement = step->displacement[LamMacroSideNumber(step, boundary)];
    if (!obstacle && boundary->kind != LAM_BOUNDARY_DISPLACEMENT && boundary->kind != LAM_BOUNDARY_GRIP) continue;
    for (int i = 0; i < 2; i++) {
      if (obstacle || boundary->given[i])
        displacement[i] = LamHistoryFactor(&boundary->history, step->load_factor) * boundary->displacement[i];
    }
  }
}

PetscErrorCode LamMacroReactions(LamMacro macro, LamMacroStep *step)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  const PetscScalar *r, *u;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(&step->reaction[0][0], 2 * LAM_MAX_BOUNDARIES));
  PetscCall(LamMacroExternalForce(macro, macro->u, macro->external));
  PetscCall(VecAYPX(macro->external, -LamMacroTractionFactor(macro), macro->force_accepted));
  PetscCall(VecGetArrayRead(macro->external, &r));
  PetscCall(VecGetArrayRead(macro->u, &u));
  AddNodes(macro, u, r, step->reaction);
  PetscCall(VecRestoreArrayRead(macro->u, &u));
  PetscCall(VecRestoreArrayRead(macro->external, &r));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, &step->reaction[0][0], 2 * LAM_MAX_BOUNDARIES, MPIU_REAL, MPIU_SUM, macro->comm));
  for (PetscInt b = 0; b < spec->boundary_count && macro->loaded; b++) {
    const PetscInt side = LamMacroSideNumber(step, &spec->boundary[b]);
    PetscReal sum[2];
    PetscCall(LamMacroTractionSum(macro, b, macro->u, sum));
    for (PetscInt i = 0; i < 2; i++) step->reaction[side][i] += sum[i];
  }
  PetscFunctionReturn(0);
}
