/*
  Displacement conditions on the named sides of the body, reactions there and their work.

  Prescribed components stay unknowns. Their equation is (displacement - target) = 0, in units of C1 + C2; their columns
  of the tangent are kept. So the first Newton iteration after a change of the targets spreads the change through the
  whole body by the tangent of the last converged state: no layer of elements at the boundary is ever crushed.
*/
#include "macro_impl.h"

static unsigned int SideFromName(const char name[])
{
  static const char *const names[] = {"bottom", "right", "top", "left"};

  for (int s = 0; s < 4; s++) {
    if (!strcmp(name, names[s])) return 1u << s;
  }
  return 0;
}

static PetscBool SidesMeet(unsigned int a, unsigned int b)
{
  unsigned int both = a | b;

  return both == (LAM_SIDE_BOTTOM | LAM_SIDE_TOP) || both == (LAM_SIDE_LEFT | LAM_SIDE_RIGHT) ? PETSC_FALSE
                                                                                              : PETSC_TRUE;
}

PetscErrorCode LamMacroBoundaryCheck(const LamMacroSpec *spec)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < spec->boundary_count; m++) {
    const LamBoundary *one = &spec->boundary[m];
    PetscCheck(SideFromName(one->on), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "macro.boundary: on: %s: no such side of the body; there are left, right, bottom, top", one->on);
    for (PetscInt n = 0; n < m; n++) {
      const LamBoundary *other = &spec->boundary[n];
      if (!SidesMeet(SideFromName(one->on), SideFromName(other->on))) continue;
      for (PetscInt i = 0; i < 2; i++) {
        PetscCheck(!one->given[i] || !other->given[i] || one->displacement[i] == other->displacement[i],
                   PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
                   "macro.boundary: %s and %s prescribe different %s displacements where they meet; "
                   "leave that component `free` on one of them",
                   other->on, one->on, i ? "vertical" : "horizontal");
      }
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBoundaryNames(const LamMacroSpec *spec, LamMacroStep *step)
{
  PetscFunctionBeginUser;
  step->boundary_count = 0;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    PetscInt s = 0;
    while (s < step->boundary_count && strcmp(step->boundary[s], spec->boundary[b].on)) s++;
    if (s < step->boundary_count) continue;
    PetscCall(PetscStrncpy(step->boundary[s], spec->boundary[b].on, LAM_NAME_LENGTH));
    step->boundary_count++;
  }
  PetscFunctionReturn(0);
}

/* Place of a mesh point's first displacement component in this rank's part of a global vector; negative: not owned. */
static PetscErrorCode OwnedIndex(LamMacro macro, PetscInt p, PetscInt *local)
{
  PetscSection section;
  PetscInt offset, start;

  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalSection(macro->dm, &section));
  PetscCall(PetscSectionGetOffset(section, p, &offset));
  PetscCall(VecGetOwnershipRange(macro->u, &start, NULL));
  *local = offset < 0 ? -1 : offset - start;
  PetscFunctionReturn(0);
}

static void AddConstraint(LamMacro macro, PetscInt local, PetscReal base, PetscReal end, unsigned int sides)
{
  macro->constraints[macro->constraint_count++] = (LamConstraint){local, base, end, base, sides};
}

PetscErrorCode LamMacroHoldRigidMotions(LamMacro macro)
{
  PetscFunctionBeginUser;
  macro->constraint_count = 0;
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    unsigned int sides = macro->sides[p - macro->mesh_start];
    PetscInt local = -1;
    PetscCall(OwnedIndex(macro, p, &local));
    if (local < 0) continue;
    if (sides == (LAM_SIDE_BOTTOM | LAM_SIDE_LEFT)) AddConstraint(macro, local, 0, 0, 0);
    if (sides == (LAM_SIDE_BOTTOM | LAM_SIDE_LEFT) || sides == (LAM_SIDE_BOTTOM | LAM_SIDE_RIGHT))
      AddConstraint(macro, local + 1, 0, 0, 0);
  }
  PetscFunctionReturn(0);
}

/* The sides (bits of the step's names) that prescribe component i of a node on `sides`, and the displacement. */
static unsigned int Prescribed(LamMacro macro, unsigned int sides, PetscInt i, PetscReal *displacement)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  unsigned int by = 0;

  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    if (!boundary->given[i] || !(SideFromName(boundary->on) & sides)) continue;
    *displacement = boundary->displacement[i];
    for (PetscInt s = 0; s < macro->step.boundary_count; s++) {
      if (!strcmp(macro->step.boundary[s], boundary->on)) by |= 1u << s;
    }
  }
  return by;
}

/* The conditions hold the body where the Gram matrix of its three rigid motions at them is regular. */
static PetscErrorCode CheckRigidMotions(LamMacro macro, PetscReal gram[9])
{
  const PetscReal tiny = 1e-10; /* of numbers of order one and more: lengths are in edges of the box */
  PetscReal *g = gram;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gram, 9, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscReal det =
      g[0] * (g[4] * g[8] - g[5] * g[7]) - g[1] * (g[3] * g[8] - g[5] * g[6]) + g[2] * (g[3] * g[7] - g[4] * g[6]);
  PetscCheck(det > tiny, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "macro.boundary: the displacements leave the body free to move or turn as a whole; "
             "prescribe both components somewhere, and enough to prevent rotation");
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroHoldBoundaries(LamMacro macro)
{
  PetscReal gram[9] = {0};
  const PetscScalar *u;

  PetscFunctionBeginUser;
  macro->constraint_count = 0;
  PetscCall(VecGetArrayRead(macro->u, &u));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    const PetscReal *X = &macro->position[2 * (p - macro->mesh_start)];
    const PetscReal motion[2][3] = {{1, 0, -X[1]}, {0, 1, X[0]}};
    PetscInt local = -1;
    PetscCall(OwnedIndex(macro, p, &local));
    for (PetscInt i = 0; i < 2 && local >= 0; i++) {
      PetscReal end = 0;
      unsigned int by = Prescribed(macro, macro->sides[p - macro->mesh_start], i, &end);
      if (!by) continue;
      AddConstraint(macro, local + i, PetscRealPart(u[local + i]), end, by);
      for (int k = 0; k < 9; k++) gram[k] += motion[i][k / 3] * motion[i][k % 3];
    }
  }
  PetscCall(VecRestoreArrayRead(macro->u, &u));
  PetscCall(CheckRigidMotions(macro, gram));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetLoadFactor(LamMacro macro, PetscReal load_factor)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    LamConstraint *constraint = &macro->constraints[k];
    constraint->target = constraint->base + load_factor * constraint->end;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroConstrainResidual(LamMacro macro, Vec u, Vec residual)
{
  const PetscScalar *displacement;
  PetscScalar *r;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(u, &displacement));
  PetscCall(VecGetArray(residual, &r));
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    const LamConstraint *constraint = &macro->constraints[k];
    r[constraint->local] = displacement[constraint->local] - constraint->target;
  }
  PetscCall(VecRestoreArray(residual, &r));
  PetscCall(VecRestoreArrayRead(u, &displacement));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroConstrainTangent(LamMacro macro, Mat tangent)
{
  PetscInt start, *rows;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(macro->u, &start, NULL));
  PetscCall(PetscMalloc1(macro->constraint_count, &rows));
  for (PetscInt k = 0; k < macro->constraint_count; k++) rows[k] = start + macro->constraints[k].local;
  PetscCall(MatZeroRows(tangent, macro->constraint_count, rows, 1, NULL, NULL));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroAddWork(LamMacro macro)
{
  const PetscScalar *u0, *u1, *f0, *f1;
  PetscReal work = 0;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(macro->u, &u0));
  PetscCall(VecGetArrayRead(macro->trial, &u1));
  PetscCall(VecGetArrayRead(macro->force_accepted, &f0));
  PetscCall(VecGetArrayRead(macro->force, &f1));
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    PetscInt i = macro->constraints[k].local;
    work += 0.5 * PetscRealPart((f0[i] + f1[i]) * (u1[i] - u0[i]));
  }
  PetscCall(VecRestoreArrayRead(macro->u, &u0));
  PetscCall(VecRestoreArrayRead(macro->trial, &u1));
  PetscCall(VecRestoreArrayRead(macro->force_accepted, &f0));
  PetscCall(VecRestoreArrayRead(macro->force, &f1));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &work, 1, MPIU_REAL, MPIU_SUM, macro->comm));
  macro->step.work += work;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroReactions(LamMacro macro, LamMacroStep *step)
{
  const PetscScalar *force;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(&step->reaction[0][0], 2 * LAM_MAX_BOUNDARIES));
  PetscCall(VecGetArrayRead(macro->force_accepted, &force));
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    const LamConstraint *constraint = &macro->constraints[k];
    /* A corner's force belongs to the sides that prescribe it, in equal shares: so the reactions of all sides balance.
     */
    PetscReal share = PetscRealPart(force[constraint->local]) / PetscMax(1, __builtin_popcount(constraint->sides));
    for (PetscInt s = 0; s < step->boundary_count; s++) {
      if (constraint->sides >> s & 1) step->reaction[s][constraint->local % 2] += share;
    }
  }
  PetscCall(VecRestoreArrayRead(macro->force_accepted, &force));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, &step->reaction[0][0], 2 * LAM_MAX_BOUNDARIES, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscFunctionReturn(0);
}
