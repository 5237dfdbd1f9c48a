/*
  The surplus of a node over the coarser levels, computed when a cell first needs it.

  Algorithm
    1. For each state of the column: Phi and its derivatives in the grid's coordinates, minus the sum of the coarser
       levels there; computes their nodes. On a face of coarser cells the pure second derivatives are taken from the
       cells on both sides.
    2. Mixed third derivatives of the level's part, from the neighbours after their step 1; slopes along suction.
  Neither step needs a node of a finer level, or step 2 of a node of its own level. So the recursion ends, with the same
  numbers as a level-by-level computation of all nodes.
*/
#include "table.h"
#include <math.h>
#include <string.h>

static void Subtract(LamTable table, PetscInt n);

/*
  The sum of the coarser levels at a node and v along suction, in the cells on the given sides (bit k: below).
  *order: axis k of the node is axis order[k] of the sum.
*/
static PetscBool CoarseSum(LamTable table, const LamTableNode *node, PetscReal v, int sides, LamTableSum *sum,
                           const int **order)
{
  LamTablePoint point = {.tau = table->grid->tau_min + table->grid->tau_step * v / LAM_ROOT, .v = v};
  int shifted[3], sorted[3]; /* in quarters */

  memset(sum, 0, sizeof(*sum));
  point.s = table->grid->contact ? table->grid->suction_scale * expm1(point.tau) : 0;
  point.root = PetscMin((int)v / LAM_ROOT, (int)table->grid->tau_cells - 1) * LAM_ROOT;
  /* sorted after a shift to the sides, since cells are found by their sorted corner */
  for (int k = 0; k < 3; k++) shifted[k] = 4 * node->i[k] + (sides >> k & 1 ? -1 : 1);
  *order = LamAxisOrder[LamTableSortAxes(table->grid->symmetric, shifted, sorted)];
  for (int level = 0; level < node->level; level++) {
    const LamTableCell *cell;
    LamTableCell around;

    for (int k = 0; k < 3; k++) point.u[k] = 0.25 * sorted[k];
    cell = LamTableFindCell(table, &point, level, &around);
    for (int k = 0; k < 3; k++) point.u[(*order)[k]] = node->i[k];
    if (!level && !cell) return PETSC_FALSE;
    if (cell) LamTableAddCell(table, cell, &point, PETSC_FALSE, sum);
  }
  return PETSC_TRUE;
}

static void SubtractSum(const LamTableSum *sum, const int order[3], LamTableState *state)
{
  state->phi.value -= sum->phi.value;
  state->tau1 -= sum->tau1;
  state->tau2 -= sum->tau2;
  state->turgor1 -= sum->turgor1.value;
  state->turgor_tau -= sum->turgor1_tau;
  state->turgor2 -= sum->turgor2;
  for (int k = 0; k < 3; k++) {
    state->phi.gradient[k] -= sum->phi.gradient[order[k]];
    state->gradient_tau[k] -= sum->gradient_tau[order[k]];
    state->turgor_gradient[k] -= sum->turgor1.gradient[order[k]];
    state->phi.hessian[3 + k] -= sum->phi.hessian[3 + order[k]];
  }
}

#define BESIDE 1e-6 /* in units of j */

/*
  Subtracts the sum of the coarser levels from a state. Value, gradient and mixed derivatives are equal in all cells
  that meet there. A pure second derivative is taken from any cell on its side, that along tau from the intervals on its
  side; only these need to be complete.
*/
static void MakeSurplus(LamTable table, const LamTableNode *node, LamTableState *state)
{
  const int coarse = LAM_ROOT >> (node->level - 1);
  PetscReal plus[3], minus[3];
  PetscBool subtracted = PETSC_FALSE;
  int faces = 0;

  for (int k = 0; k < 3; k++) {
    plus[k] = minus[k] = NAN;
    faces |= (node->i[k] % coarse == 0) << k;
  }
  for (int sides = 0; sides < 8; sides++) {
    LamTableSum sum;
    const int *order;

    if ((sides & ~faces) || !CoarseSum(table, node, state->j, sides, &sum, &order)) continue;
    for (int k = 0; k < 3; k++) {
      const PetscReal pure = sum.phi.hessian[order[k]];

      if (sides >> k & 1)
        minus[k] = pure;
      else
        plus[k] = pure;
      if (!(faces >> k & 1)) minus[k] = pure;
    }
    if (subtracted) continue;
    SubtractSum(&sum, order, state);
    if (CoarseSum(table, node, PetscMax(state->j - BESIDE, 0), sides, &sum, &order)) state->tau2_minus -= sum.tau2;
    subtracted = PETSC_TRUE;
  }
  for (int k = 0; k < 3; k++) {
    state->minus[k] -= minus[k];
    state->phi.hessian[k] -= plus[k];
  }
  if (!subtracted || !isfinite(state->phi.value)) /* no coarser level covers the state */
    *state = (LamTableState){.j = state->j, .data = state->data};
}

/* ---- mixed third derivatives ---- */

/*
  The surplus of the node at a place on a level at suction j; NULL: unknown. It is 0 for nodes of coarser levels and
  floating cells. order: as returned by LamTableSortAxes.
*/
static const LamTableState *FindState(LamTable table, int level, const int at[3], int j, int *order)
{
  static const LamTableState nothing = {0};
  const LamTableNode *node;
  PetscInt n;
  int sorted[3];

  *order = LamTableSortAxes(table->grid->symmetric, at, sorted);
  n = LamPlaceMapGet(&table->node_map, LamPlaceMapKey(sorted));
  if (n < 0) return LamPlaceIsFloating(table->grid, at) ? &nothing : NULL;
  node = &table->nodes[n];
  Subtract(table, n);
  for (PetscInt s = 0; s < node->count; s++)
    if (table->states[node->first + s].j == j && table->states[node->first + s].has_data)
      return node->level < level ? &nothing : &table->states[node->first + s];
  return NULL;
}

/* Difference quotient of d2Phi/dx_a dx_b along the third axis k. *sides: 2 central, 1 one-sided, 0 none. */
static PetscReal MixedSlope(LamTable table, const LamTableNode *node, const LamTableState *state, int k, int *sides)
{
  const int size = LAM_ROOT >> node->level;
  PetscReal mixed[2], length = 0;

  *sides = 0;
  mixed[0] = mixed[1] = state->phi.hessian[3 + k];
  for (int side = 0; side < 2; side++) {
    int at[3] = {node->i[0], node->i[1], node->i[2]}, order;
    const LamTableState *next;

    at[k] += side ? size : -size;
    next = FindState(table, node->level, at, state->j, &order);
    if (!next) continue;
    mixed[side] = next->phi.hessian[3 + LamAxisOrder[order][k]];
    length += table->grid->step / (1 << node->level);
    (*sides)++;
  }
  return *sides ? (mixed[1] - mixed[0]) / length : 0;
}

/* d3/dx_1 dx_2 dx_3 of the level's part: mean over the axes; only central differences if there are any. */
static PetscReal MixedThird(LamTable table, const LamTableNode *node, const LamTableState *state)
{
  PetscReal sum[3] = {0};
  int count[3] = {0};

  for (int k = 0; k < 3; k++) {
    int sides;
    const PetscReal slope = MixedSlope(table, node, state, k, &sides);

    sum[sides] += slope;
    count[sides]++;
  }
  return count[2] ? sum[2] / count[2] : count[1] ? sum[1] / count[1] : 0;
}

/* ---- slopes along suction ---- */

/*
  Slopes of the second derivatives in tau: of the parabola through three neighbouring states of the column, or of the
  line through two.
*/
static void SlopesAlongSuction(LamTable table, const LamTableNode *node)
{
  LamTableState *states = &table->states[node->first];
  const PetscReal unit = table->grid->tau_step / LAM_ROOT;
  const PetscInt n = PetscMin(node->count, 3);

  for (PetscInt s = 0; s < node->count; s++) {
    const PetscInt first = PetscMax(0, PetscMin(s - 1, node->count - n));
    PetscBool known = (PetscBool)(n > 1);

    states[s].alone = (PetscBool)(n == 1);

    for (PetscInt a = first; a < first + n; a++) known = (PetscBool)(known && states[a].has_data);
    for (PetscInt a = first; a < first + n && known; a++) {
      PetscReal rise = n == 2 ? 1 : 0, run = 1;

      for (PetscInt b = first; b < first + n; b++) {
        if (b == a) continue;
        if (n == 3) rise += unit * (states[s].j - states[b].j);
        run *= unit * (states[a].j - states[b].j);
      }
      for (int m = 0; m < 6; m++) states[s].hessian_tau[m] += rise / run * states[a].phi.hessian[m];
      for (int k = 0; k < 3; k++) states[s].minus_tau[k] += rise / run * states[a].minus[k];
    }
  }
}

/* ---- nodes ---- */

/* Step 1. The caller holds the table's lock. */
static void Subtract(LamTable table, PetscInt n)
{
  LamTableNode *node = &table->nodes[n];

  if (atomic_load_explicit(&node->stage, memory_order_relaxed) != LAM_NODE_RAW) return;
  for (PetscInt s = node->first; s < node->first + node->count; s++) {
    LamTableState *state = &table->states[s];

    LamTableMakeState(table->grid, &table->source->data[table->data[s]], table->data[s], state);
    if (state->has_data && node->level) MakeSurplus(table, node, state);
  }
  atomic_store_explicit(&node->stage, LAM_NODE_SUBTRACTED, memory_order_relaxed);
}

void LamTableMakeNode(LamTable table, PetscInt n)
{
  LamTableNode *node = &table->nodes[n];

  mtx_lock(&table->lock);
  if (atomic_load_explicit(&node->stage, memory_order_relaxed) != LAM_NODE_MADE) {
    Subtract(table, n);
    for (PetscInt s = node->first; s < node->first + node->count; s++)
      if (table->states[s].has_data) table->states[s].phi.third = MixedThird(table, node, &table->states[s]);
    if (table->grid->contact) SlopesAlongSuction(table, node);
    atomic_store_explicit(&node->stage, LAM_NODE_MADE, memory_order_release);
  }
  mtx_unlock(&table->lock);
}
