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

  Friction: r = lambda n + tau t, and with the slip s along t since the last converged state Coulomb's law is
  |tau| <= mu lambda, and where s is not 0, tau = -mu lambda s/|s|. A node that sticks has the equation s = 0; it slips
  as soon as |tau| > mu lambda. One that slips, with the sign sigma of tau, has the equation tau - sigma mu lambda = 0,
  and sticks as soon as sigma s > 0. Nodes go on as they did in the last converged state, new ones stick. With slid the
  motion of the node against the obstacle, s = t . slid, and dt = -kappa n (t . dx), ds = (1 - kappa n . slid) t . dx,
  d(tau - sigma mu lambda) = (t - sigma mu n) . dr
                                                                  - kappa (lambda + sigma mu tau) t . dx.
  Of a node with a prescribed direction that and the gap say where it is: friction changes nothing.

  In a sealed body, which hardly changes its volume, this set may alternate for ever: a node that leaves moves its
  neighbours. There nodes enter at once, but stay, also where the obstacle would have to pull them, until the iteration
  has converged. Then the node that is pulled most leaves, and so on until none is pulled. Likewise nodes begin to slip
  or to stick there once the iteration has converged, all at once: before, lambda errs much.

  References: Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2003) 865-888; Wriggers, Computational Contact Mechanics,
  ch. 9 (friction).
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

/* The tangent that row i is along. */
static void TangentOf(PetscInt i, const PetscReal normal[2], PetscReal t[2])
{
  const PetscReal sign = i == 0 ? -1 : 1;

  t[0] = -sign * normal[1];
  t[1] = sign * normal[0];
}

/* Sets row i to t . r, with t the tangent of a normal, and includes the derivative of t. */
static void TangentRow(LamNodeRows *rows, PetscInt i, const PetscReal normal[2], PetscReal turning)
{
  PetscReal t[2];

  TangentOf(i, normal, t);
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

/* lambda of a node. One with a prescribed direction m moves along s, the tangent of m: lambda n . s = s . r; an
   obstacle whose normal is within ASIDE of m cannot constrain it, which is infinitely little force. */
#define ASIDE 0.1
static PetscReal TouchForce(const LamTouch *touch, const PetscReal m[2], const PetscScalar r[2])
{
  const PetscReal *n = touch->normal;

  if (!m) return n[0] * PetscRealPart(r[0]) + n[1] * PetscRealPart(r[1]);

  const PetscReal s[2] = {-m[1], m[0]}, along = n[0] * s[0] + n[1] * s[1];

  return PetscAbsReal(along) < ASIDE ? -PETSC_INFINITY
                                     : (s[0] * PetscRealPart(r[0]) + s[1] * PetscRealPart(r[1])) / along;
}

static PetscReal Along(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[0] + a[1] * b[1];
}

/* The sign of tau of a node that slips, 0: it sticks; `slip`: of the state before. */
static PetscInt Slips(const LamTouch *touch, PetscInt slip, PetscReal s, PetscReal tau, PetscReal lambda)
{
  if (slip) return (PetscReal)slip * s > 0 ? 0 : slip;
  if (PetscIsInfReal(touch->friction) || PetscAbsReal(tau) <= touch->friction * lambda) return 0;
  return tau > 0 ? 1 : -1;
}

/* Sets row i of a node with friction that the obstacle presses with lambda; r: unbalanced force. */
static void FrictionRow(LamMacro macro, const LamTouch *touch, PetscInt i, PetscReal lambda, const PetscReal r[2],
                        LamObstacleNode *node, LamNodeRows *rows)
{
  const PetscReal *n = touch->normal;
  PetscReal t[2], s, tau;

  TangentOf(i, n, t);
  s = Along(t, touch->slid);
  tau = Along(t, r);
  const PetscInt slip = Slips(touch, node->slip, s, tau, lambda);
  if (!macro->seal || macro->regrips)
    node->slip = slip;
  else if (slip != node->slip)
    macro->any_regrip = PETSC_TRUE;
  if (!node->slip) {
    const PetscReal turned = 1 - touch->curvature * Along(n, touch->slid), turning[2] = {turned * t[0], turned * t[1]};
    PrescribeRow(rows, i, turning, s);
    return;
  }
  const PetscReal share = (PetscReal)node->slip * touch->friction;
  for (PetscInt j = 0; j < 2; j++) {
    rows->combine[2 * i + j] = t[j] - share * n[j];
    rows->add[2 * i + j] = -touch->curvature * (lambda + share * tau) * t[j];
  }
}

/* Rows of a node in contact without prescribed direction, under the force lambda; r: unbalanced forces. */
static LamNodeRows TouchRows(LamMacro macro, const LamTouch *touch, PetscReal lambda, const PetscScalar r[],
                             LamObstacleNode *node)
{
  const PetscReal force[2] = {PetscRealPart(r[node->local]), PetscRealPart(r[node->local + 1])};
  const PetscInt i = Largest(touch->normal);
  LamNodeRows rows = {.local = node->local};

  PrescribeRow(&rows, i, touch->normal, touch->gap);
  if (touch->friction > 0)
    FrictionRow(macro, touch, 1 - i, lambda, force, node, &rows);
  else
    TangentRow(&rows, 1 - i, touch->normal, touch->curvature * lambda);
  return rows;
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

/* Whether a node is in contact, with lambda - g; in a sealed body it leaves only where it is told to (see above). */
static PetscBool IsInContact(LamMacro macro, PetscInt k, PetscReal excess, PetscReal *most_pulled)
{
  const LamObstacleNode *node = &macro->obstacle_nodes[k];
  const PetscBool was = macro->fresh ? node->accepted : node->active;

  if (excess > 0 || (macro->fresh && was && excess > -PETSC_INFINITY && !macro->seal)) return PETSC_TRUE;
  if (!was || !macro->seal || k == macro->released || excess == -PETSC_INFINITY) return PETSC_FALSE;
  if (excess < *most_pulled) macro->pulled = k;
  *most_pulled = PetscMin(*most_pulled, excess);
  return PETSC_TRUE;
}

/* Of the nodes in contact the one that is pulled most, among all ranks; macro->pulled: -1 on the other ranks. */
static PetscErrorCode FindPulled(LamMacro macro, PetscReal most_pulled)
{
  PetscMPIInt rank = 0;
  PetscBool mine = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(LamMacroFindRank(macro, most_pulled, &rank, &mine));
  if (!mine) macro->pulled = -1;
  macro->any_pulled = (PetscBool)(macro->pulled >= 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &macro->any_pulled, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillObstacleRows(LamMacro macro, const PetscScalar u[], const PetscScalar r[])
{
  PetscReal most_pulled = 0;
  const PetscScalar *before;

  PetscFunctionBeginUser;
  macro->violation = 0;
  macro->pulled = -1;
  macro->any_regrip = PETSC_FALSE;
  PetscCall(VecGetArrayRead(macro->u, &before));
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    LamObstacleNode *node = &macro->obstacle_nodes[k];
    const LamConstraint *held = node->constraint < 0 ? NULL : &macro->constraints[node->constraint];
    const LamTouch touch = LamMacroNearest(macro, node, u, before);
    const PetscReal lambda = TouchForce(&touch, held ? held->normal : NULL, &r[node->local]);
    const PetscBool active = IsInContact(macro, k, lambda - touch.gap, &most_pulled);

    if (macro->fresh) node->slip = node->accepted_slip;
    if (!active) node->slip = 0;
    if (active && !held) macro->rows[macro->row_count++] = TouchRows(macro, &touch, lambda, r, node);
    if (active && held) PrescribeRow(&macro->rows[held->row], 1 - Largest(held->normal), touch.normal, touch.gap);
    node->active = active;
    macro->violation = PetscMax(macro->violation, active ? PetscAbsReal(touch.gap) : -touch.gap);
  }
  PetscCall(VecRestoreArrayRead(macro->u, &before));
  macro->fresh = macro->regrips = PETSC_FALSE;
  macro->released = -1;
  if (!macro->obstacle_count) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &macro->violation, 1, MPIU_REAL, MPIU_MAX, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &macro->any_regrip, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  PetscCall(FindPulled(macro, most_pulled));
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

/* New entries [2][n] of a node's rows; both have the same columns. own: they belong to displacements. */
static PetscErrorCode NewEntries(Mat tangent, PetscInt start, const LamNodeRows *rows, PetscBool own, PetscInt n,
                                 PetscInt columns[], PetscScalar entries[])
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
  for (PetscInt k = 0; k < n && own; k++) {
    const PetscInt j = columns[k] - row;
    for (PetscInt i = 0; i < 2 && j >= 0 && j < 2; i++) entries[i * n + k] += rows->add[2 * i + j];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CombineMatrix(LamMacro macro, Mat tangent, PetscBool own)
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
    PetscCall(NewEntries(tangent, start, &macro->rows[k], own, sizes[k], &columns[at], &entries[2 * at]));
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

PetscErrorCode LamMacroConstrainTangent(LamMacro macro, Mat tangent)
{
  PetscFunctionBeginUser;
  PetscCall(CombineMatrix(macro, tangent, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroConstrainColumns(LamMacro macro, Mat columns)
{
  PetscFunctionBeginUser;
  PetscCall(CombineMatrix(macro, columns, PETSC_FALSE));
  PetscFunctionReturn(0);
}
