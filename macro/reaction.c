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
static void Share(LamMacroStep *step, unsigned int sides, PetscReal part, const PetscReal direction[2])
{
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (PetscInt i = 0; i < 2 && sides >> s & 1; i++)
      step->reaction[s][i] += part * direction[i] / __builtin_popcount(sides);
  }
}

static void AddHeld(LamMacro macro, const PetscScalar r[], LamMacroStep *step)
{
  PetscInt next;

  for (PetscInt k = 0; k < macro->constraint_count; k = next) {
    const LamConstraint *one = &macro->constraints[k];
    const PetscReal force[2] = {PetscRealPart(r[one->local]), PetscRealPart(r[one->local + 1])};
    PetscReal directions[2][2], part[2];
    next = k + 1;
    if (next < macro->constraint_count && one[1].local == one->local) next++;
    for (PetscInt d = 0; d < next - k; d++) {
      for (PetscInt i = 0; i < 2; i++) directions[d][i] = one[d].normal[i];
    }
    Decompose(next - k, (const PetscReal(*)[2])directions, force, part);
    for (PetscInt d = 0; d < next - k; d++) Share(step, one[d].sides, part[d], directions[d]);
  }
}

/* Adds the forces of obstacles. For a node that slides along a prescribed direction, the obstacle's part is subtracted
   from the sides that prescribe it. */
static void AddTouched(LamMacro macro, const PetscScalar u[], const PetscScalar r[], LamMacroStep *step)
{
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    const LamTouch touch = LamMacroNearest(macro, node, u);
    const PetscReal force[2] = {PetscRealPart(r[node->local]), PetscRealPart(r[node->local + 1])};
    const unsigned int side = 1u << macro->obstacles[touch.obstacle].side;
    const LamConstraint *held = node->constraint < 0 ? NULL : &macro->constraints[node->constraint];
    PetscReal directions[2][2], part[2];
    const PetscInt own = held ? 1 : 0;
    for (PetscInt i = 0; i < 2; i++) {
      directions[own][i] = touch.normal[i];
      if (held) directions[0][i] = held->normal[i];
    }
    if (held && PetscAbsReal(directions[0][0] * touch.normal[1] - directions[0][1] * touch.normal[0]) < 0.1) continue;
    Decompose(own + 1, (const PetscReal(*)[2])directions, force, part);
    Share(step, side, part[own], touch.normal);
    if (held) { /* AddHeld assigned all of the force along the direction to these sides */
      const PetscReal along = directions[0][0] * touch.normal[0] + directions[0][1] * touch.normal[1];
      Share(step, held->sides, -part[own] * along, directions[0]);
    }
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
  AddHeld(macro, r, step);
  AddTouched(macro, u, r, step);
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
