/*
  Equations of nodes with prescribed displacement or in contact with an obstacle.

  Prescribed directions stay unknowns: n . u - target = 0, in units of C1 + C2, replaces the force along n; along the
  tangent t of a node with one direction the equation stays t . r = 0. The first Newton iteration after a change of
  the targets therefore distributes the change over the whole body by the tangent of the last converged state, and no
  layer of elements at the boundary is crushed.

  Obstacles: with the gap g(x) and its normal n(x) = dg/dx, the force of an obstacle on a node is lambda n, so the
  unbalanced force is r = lambda n, and lambda = n . r needs no additional unknown. The complementarity g >= 0, lambda
  >= 0, g lambda = 0 is min(lambda, g) = 0 (stresses in C1 + C2, lengths in macro lengths). A node is active if lambda
  > g; its equations are then g = 0 and t . r = 0, otherwise r = 0. Newton's method for this piecewise smooth function
  is the primal-dual active set method. At the start of an increment the obstacles have moved but the forces have not
  changed. Nodes in contact therefore stay active in the first iteration; otherwise all of them would be released at
  the first retreat of an obstacle. Derivatives: dg = n . dx; with dn = kappa t (t . dx), kappa = 1 / |x - centre|,
  and t normal to n, d(t . r) = t . dr - kappa lambda t . dx.

  Reference: Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2003) 865-888.
*/
#include "macro_impl.h"

/* The largest component of a direction: its equation is replaced. */
static PetscInt Largest(const PetscReal normal[2])
{
  return PetscAbsReal(normal[1]) > PetscAbsReal(normal[0]) ? 1 : 0;
}

static PetscReal Target(LamMacro macro, const LamConstraint *constraint)
{
  return constraint->target + (constraint->border < 0 ? 0 : macro->borders[constraint->border].now);
}

/* Sets row i to normal . u - target, with the given value. */
static void PrescribeRow(LamNodeRows *rows, PetscInt i, const PetscReal normal[2], PetscReal value)
{
  rows->value[i] = value;
  for (PetscInt j = 0; j < 2; j++) {
    rows->combine[2 * i + j] = 0;
    rows->add[2 * i + j] = normal[j];
  }
}

/* Sets row i to t . r, with t the tangent of a normal, and includes the derivative of t. */
static void TangentRow(LamNodeRows *rows, PetscInt i, const PetscReal normal[2], PetscReal turning)
{
  const PetscReal sign = i == 0 ? -1 : 1, t[2] = {-sign * normal[1], sign * normal[0]};

  for (PetscInt j = 0; j < 2; j++) {
    rows->combine[2 * i + j] = t[j];
    rows->add[2 * i + j] = -turning * t[j];
  }
}

/* Rows of a node with `count` prescribed directions. */
static LamNodeRows HeldRows(LamMacro macro, const LamConstraint constraints[], PetscInt count, const PetscScalar u[])
{
  LamNodeRows rows = {.local = constraints[0].local};
  const PetscInt first = Largest(constraints[0].normal);

  for (PetscInt k = 0; k < count; k++) {
    const LamConstraint *constraint = &constraints[k];
    const PetscReal value = constraint->normal[0] * PetscRealPart(u[rows.local]) +
                            constraint->normal[1] * PetscRealPart(u[rows.local + 1]) - Target(macro, constraint);
    PrescribeRow(&rows, k == 0 ? first : 1 - first, constraint->normal, value);
  }
  if (count == 1) TangentRow(&rows, 1 - first, constraints[0].normal, 0);
  return rows;
}

/* Rows of a node without prescribed direction; *active on entry: in contact before, on return: in contact. */
static LamNodeRows TouchRows(const LamTouch *touch, PetscInt local, const PetscScalar r[], PetscBool *active)
{
  const PetscReal lambda = touch->normal[0] * PetscRealPart(r[local]) + touch->normal[1] * PetscRealPart(r[local + 1]);
  const PetscInt i = Largest(touch->normal);
  LamNodeRows rows = {.local = local};

  *active = *active || lambda > touch->gap ? PETSC_TRUE : PETSC_FALSE;
  if (!*active) return rows;
  PrescribeRow(&rows, i, touch->normal, touch->gap);
  TangentRow(&rows, 1 - i, touch->normal, touch->curvature * lambda);
  return rows;
}

/* Rows of a node with one prescribed direction m. It moves along s, the tangent of m: lambda n . s = s . r. */
static void TouchHeldRows(const LamTouch *touch, const PetscReal m[2], const PetscScalar r[], LamNodeRows *rows,
                          PetscBool *active)
{
  const PetscReal aside = 0.1; /* an obstacle whose normal is closer to m cannot constrain the node */
  const PetscInt i = 1 - Largest(m);
  const PetscReal s[2] = {-m[1], m[0]}, along = touch->normal[0] * s[0] + touch->normal[1] * s[1];

  if (PetscAbsReal(along) < aside) *active = PETSC_FALSE;
  if (PetscAbsReal(along) < aside) return;
  const PetscReal force = s[0] * PetscRealPart(r[rows->local]) + s[1] * PetscRealPart(r[rows->local + 1]);
  *active = *active || force / along > touch->gap ? PETSC_TRUE : PETSC_FALSE;
  if (*active) PrescribeRow(rows, i, touch->normal, touch->gap);
}

/* Rows of the prescribed directions, one for each node, in the order of macro->constraints. */
static void FillHeldRows(LamMacro macro, const PetscScalar u[])
{
  PetscInt next;

  macro->row_count = 0;
  for (PetscInt k = 0; k < macro->constraint_count; k = next) {
    next = k + 1;
    if (next < macro->constraint_count && macro->constraints[next].local == macro->constraints[k].local) next++;
    macro->constraints[k].row = macro->row_count;
    macro->rows[macro->row_count++] = HeldRows(macro, &macro->constraints[k], next - k, u);
  }
}

static PetscErrorCode FillObstacleRows(LamMacro macro, const PetscScalar u[], const PetscScalar r[])
{
  PetscFunctionBeginUser;
  macro->violation = 0;
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    LamObstacleNode *node = &macro->obstacle_nodes[k];
    const LamTouch touch = LamMacroNearest(macro, node, u);
    PetscBool active = macro->fresh ? node->accepted : PETSC_FALSE;
    if (node->constraint < 0) {
      const LamNodeRows rows = TouchRows(&touch, node->local, r, &active);
      if (active) macro->rows[macro->row_count++] = rows;
    } else {
      const LamConstraint *held = &macro->constraints[node->constraint];
      TouchHeldRows(&touch, held->normal, r, &macro->rows[held->row], &active);
    }
    node->active = active;
    macro->violation = PetscMax(macro->violation, active ? PetscAbsReal(touch.gap) : -touch.gap);
  }
  macro->fresh = PETSC_FALSE;
  if (macro->obstacle_count)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &macro->violation, 1, MPIU_REAL, MPIU_MAX, macro->comm));
  PetscFunctionReturn(0);
}

/* Replaces the components of one node. */
static void ApplyRows(const LamNodeRows *rows, PetscBool values, PetscScalar r[])
{
  const PetscScalar old[2] = {r[rows->local], r[rows->local + 1]};

  for (PetscInt i = 0; i < 2; i++)
    r[rows->local + i] =
        rows->combine[2 * i] * old[0] + rows->combine[2 * i + 1] * old[1] + (values ? rows->value[i] : 0);
}

PetscErrorCode LamMacroConstrainResidual(LamMacro macro, Vec u, Vec residual)
{
  const PetscScalar *displacement;
  PetscScalar *r;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(u, &displacement));
  PetscCall(VecGetArray(residual, &r));
  FillHeldRows(macro, displacement);
  PetscCall(FillObstacleRows(macro, displacement, r));
  for (PetscInt k = 0; k < macro->row_count; k++) ApplyRows(&macro->rows[k], PETSC_TRUE, r);
  PetscCall(VecRestoreArray(residual, &r));
  PetscCall(VecRestoreArrayRead(u, &displacement));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroCombineRows(LamMacro macro, Vec force)
{
  PetscScalar *r;

  PetscFunctionBeginUser;
  PetscCall(VecGetArray(force, &r));
  for (PetscInt k = 0; k < macro->row_count; k++) ApplyRows(&macro->rows[k], PETSC_FALSE, r);
  PetscCall(VecRestoreArray(force, &r));
  PetscFunctionReturn(0);
}

/* New entries [2][n] of a node's rows; both have the same columns. */
static PetscErrorCode NewEntries(Mat tangent, PetscInt start, const LamNodeRows *rows, PetscInt n, PetscInt columns[],
                                 PetscScalar entries[])
{
  const PetscInt row = start + rows->local;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(entries, 2 * n));
  for (PetscInt j = 0; j < 2; j++) {
    const PetscInt *where;
    const PetscScalar *old;
    PetscInt count;
    PetscCall(MatGetRow(tangent, row + j, &count, &where, &old));
    PetscCheck(count == n, PETSC_COMM_SELF, PETSC_ERR_PLIB, "rows of a node differ in their pattern");
    PetscCall(PetscArraycpy(columns, where, n));
    for (PetscInt i = 0; i < 2; i++) {
      for (PetscInt k = 0; k < n; k++) entries[i * n + k] += rows->combine[2 * i + j] * old[k];
    }
    PetscCall(MatRestoreRow(tangent, row + j, &count, &where, &old));
  }
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt j = columns[k] - row;
    for (PetscInt i = 0; i < 2 && j >= 0 && j < 2; i++) entries[i * n + k] += rows->add[2 * i + j];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroConstrainTangent(LamMacro macro, Mat tangent)
{
  PetscInt start, total = 0, *sizes, *columns, at = 0;
  PetscScalar *entries;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(tangent, &start, NULL));
  PetscCall(PetscMalloc1(macro->row_count, &sizes));
  for (PetscInt k = 0; k < macro->row_count; k++) {
    PetscInt size;
    PetscCall(MatGetRow(tangent, start + macro->rows[k].local, &size, NULL, NULL));
    total += sizes[k] = size;
    PetscCall(MatRestoreRow(tangent, start + macro->rows[k].local, &size, NULL, NULL));
  }
  PetscCall(PetscMalloc2(total, &columns, 2 * total, &entries));
  for (PetscInt k = 0; k < macro->row_count; k++) { /* all are read before any is written */
    PetscCall(NewEntries(tangent, start, &macro->rows[k], sizes[k], &columns[at], &entries[2 * at]));
    at += sizes[k];
  }
  at = 0;
  for (PetscInt k = 0; k < macro->row_count; k++) {
    const PetscInt rows[2] = {start + macro->rows[k].local, start + macro->rows[k].local + 1};
    PetscCall(MatSetValues(tangent, 2, rows, sizes[k], &columns[at], &entries[2 * at], INSERT_VALUES));
    at += sizes[k];
  }
  PetscCall(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree2(columns, entries));
  PetscCall(PetscFree(sizes));
  PetscFunctionReturn(0);
}
