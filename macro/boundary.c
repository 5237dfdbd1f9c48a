/*
  Displacement conditions on the named sides of the body, reactions there and their work.

  Prescribed components stay unknowns. Their equation is (displacement - target) = 0, in units of C1 + C2; their columns
  of the tangent are kept. So the first Newton iteration after a change of the targets spreads the change through the
  whole body by the tangent of the last converged state: no layer of elements at the boundary is ever crushed.
*/
#include <math.h>
#include "macro_impl.h"

/* Whether a mesh point lies on the boundary that the condition names. */
static PetscBool IsOn(LamMacro macro, PetscInt p, const LamBoundary *boundary)
{
  return (PetscBool)(macro->sets[p - macro->mesh_start] >> LamMacroFindSet(macro, boundary->on) & 1);
}

static PetscErrorCode CheckNames(LamMacro macro)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    char names[LAM_MESSAGE_LENGTH] = "";
    if (LamMacroFindSet(macro, spec->boundary[b].on) >= 0) continue;
    for (PetscInt s = 0; s < macro->set_count; s++) {
      PetscCall(PetscStrlcat(names, s ? ", " : "", sizeof(names)));
      PetscCall(PetscStrlcat(names, macro->set_name[s], sizeof(names)));
    }
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "macro.boundary: on: %s: no such boundary of the mesh; there %s %s",
            spec->boundary[b].on, macro->set_count == 1 ? "is" : "are", macro->set_count ? names : "none");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBoundaryCheck(LamMacro macro)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  PetscInt worst = -1; /* (one, other, component) as one number */

  PetscFunctionBeginUser;
  PetscCall(CheckNames(macro));
  for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
    for (PetscInt m = 0; m < spec->boundary_count; m++) {
      for (PetscInt n = 0; n < m && macro->sets[p - macro->mesh_start]; n++) {
        const LamBoundary *one = &spec->boundary[m], *other = &spec->boundary[n];
        if (!IsOn(macro, p, one) || !IsOn(macro, p, other)) continue;
        for (PetscInt i = 0; i < macro->dim; i++) {
          if (one->given[i] && other->given[i] && one->displacement[i] != other->displacement[i])
            worst = PetscMax(worst, (m * LAM_MAX_BOUNDARIES + n) * LAM_MACRO_DIM + i);
        }
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_INT, MPI_MAX, macro->comm));
  PetscCheck(worst < 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "macro.boundary: %s and %s prescribe different displacements along X%d where they meet; "
             "leave that component `free` on one of them",
             spec->boundary[worst / LAM_MACRO_DIM % LAM_MAX_BOUNDARIES].on,
             spec->boundary[worst / LAM_MACRO_DIM / LAM_MAX_BOUNDARIES].on, (int)(worst % LAM_MACRO_DIM) + 1);
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

static void AddConstraint(LamMacro macro, PetscInt local, PetscInt component, PetscReal base, PetscReal end,
                          unsigned int sides)
{
  macro->constraints[macro->constraint_count++] = (LamConstraint){local + component, component, base, end, base, sides};
}

/* A node of the whole mesh. */
typedef struct {
  int number, rank;
  PetscInt point; /* on that rank */
  PetscReal X[LAM_MACRO_DIM];
} Place;

/* The owned node that is farthest from `from` (NULL: the one of the lowest number); of equal ones the lowest. */
static PetscErrorCode FindNode(LamMacro macro, const Place *from, Place *found)
{
  PetscReal farthest = -1, best;
  struct {
    int number, rank;
  } mine = {PETSC_MPI_INT_MAX, 0}, first;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(macro->comm, &rank));
  for (int pass = 0; pass < 2; pass++) { /* the greatest distance, then who has it */
    for (PetscInt p = macro->mesh_start; p < macro->mesh_end; p++) {
      const PetscInt number = macro->node_number[p - macro->mesh_start];
      PetscReal distance = 0;
      PetscInt local;
      PetscCall(LamMacroOwnedIndex(macro, p, &local));
      if (local < 0) continue;
      for (PetscInt i = 0; i < macro->dim && from; i++)
        distance += PetscSqr(macro->position[macro->dim * (p - macro->mesh_start) + i] - from->X[i]);
      if (pass == 0) farthest = PetscMax(farthest, distance);
      if (pass == 0 || distance < best * (1 - 1e-9) || number >= mine.number) continue;
      mine.number = number;
      found->point = p;
    }
    if (pass == 0) PetscCallMPI(MPI_Allreduce(&farthest, &best, 1, MPIU_REAL, MPIU_MAX, macro->comm));
  }
  mine.rank = rank;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_2INT, MPI_MINLOC, macro->comm));
  found->number = first.number;
  found->rank = first.rank;
  if (rank == first.rank)
    PetscCall(PetscArraycpy(found->X, &macro->position[macro->dim * (found->point - macro->mesh_start)], macro->dim));
  PetscCallMPI(MPI_Bcast(found->X, LAM_MACRO_DIM, MPIU_REAL, first.rank, macro->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode HoldNode(LamMacro macro, const Place *place, PetscInt component)
{
  PetscMPIInt rank;
  PetscInt local;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(macro->comm, &rank));
  if (rank != place->rank) PetscFunctionReturn(0);
  PetscCall(LamMacroOwnedIndex(macro, place->point, &local));
  AddConstraint(macro, local, component, 0, 0, 0);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroHoldRigidMotions(LamMacro macro)
{
  Place one, other;

  PetscFunctionBeginUser;
  PetscCheck(macro->dim == 2, macro->comm, PETSC_ERR_SUP, "rigid motions are those of the plane");
  macro->constraint_count = 0;
  PetscCall(FindNode(macro, NULL, &one));
  PetscCall(FindNode(macro, &one, &other));
  for (PetscInt i = 0; i < 2; i++) PetscCall(HoldNode(macro, &one, i));
  /* a rotation about the first node moves the other one most along the component in which they differ least */
  PetscCall(HoldNode(macro, &other, PetscAbsReal(other.X[0] - one.X[0]) < PetscAbsReal(other.X[1] - one.X[1]) ? 0 : 1));
  PetscFunctionReturn(0);
}

/* The names (bits of the step's) that prescribe component i of a node, and the displacement. */
static unsigned int Prescribed(LamMacro macro, PetscInt p, PetscInt i, PetscReal *displacement)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  unsigned int by = 0;

  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    if (!boundary->given[i] || !IsOn(macro, p, boundary)) continue;
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
    const PetscReal *X = &macro->position[macro->dim * (p - macro->mesh_start)];
    const PetscReal motion[2][3] = {{1, 0, -X[1]}, {0, 1, X[0]}};
    PetscInt local;
    if (!macro->sets[p - macro->mesh_start]) continue;
    PetscCall(LamMacroOwnedIndex(macro, p, &local));
    for (PetscInt i = 0; i < 2 && local >= 0; i++) {
      PetscReal end = 0;
      unsigned int by = Prescribed(macro, p, i, &end);
      if (!by) continue;
      AddConstraint(macro, local, i, PetscRealPart(u[local + i]), end, by);
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

/* During inflation the sides are not held yet: their displacements are 0. */
void LamMacroDisplacements(LamMacro macro, LamMacroStep *step)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (PetscInt i = 0; i < 2; i++) {
      step->displacement[s][i] = NAN;
      for (PetscInt b = 0; b < spec->boundary_count; b++) {
        const LamBoundary *boundary = &spec->boundary[b];
        if (boundary->given[i] && !strcmp(boundary->on, step->boundary[s]))
          step->displacement[s][i] = step->load_factor * boundary->displacement[i];
      }
    }
  }
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
      if (constraint->sides >> s & 1) step->reaction[s][constraint->component] += share;
    }
  }
  PetscCall(VecRestoreArrayRead(macro->force_accepted, &force));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, &step->reaction[0][0], 2 * LAM_MAX_BOUNDARIES, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscFunctionReturn(0);
}
