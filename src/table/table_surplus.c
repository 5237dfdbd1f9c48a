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
  The sum of the coarser levels at a node and v along suction, in the cells on the given sides (bit k: below), at the
  knot z in its interval above (below: `low` 1). *order: axis k of the node is axis order[k] of the sum.
*/
static PetscBool CoarseSum(LamTable table, const LamTableNode *node, PetscReal v, int z, int low, int sides,
                           LamTableSum *sum, const int **order)
{
  LamTablePoint point = {
      .tau = table->grid->tau_min + table->grid->tau_step * v / LAM_ROOT, .v = v, .w = z - 1, .z = z - low};
  int shifted[3], sorted[3]; /* in quarters */

  memset(sum, 0, sizeof(*sum));
  point.s = LamGridHasColumns(table->grid) ? LamGridSuctionAt(table->grid, point.tau) : 0;
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

static void SubtractAxial(const LamTableSum *sum, const int order[3], LamTableAxial *axial)
{
  axial->first -= sum->z1;
  axial->mixed -= sum->tau_z;
  axial->turgor -= sum->turgor1_z;
  for (int k = 0; k < 3; k++) axial->gradient[k] -= sum->gradient_z[order[k]];
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

/* The knot's interval of z below (1) or above (0), another at the ends. */
static int Beside(const struct LamGrid_s *grid, int z, int below)
{
  return z == 1 ? 0 : z > grid->z_cells ? 1 : below;
}

/* As tau2_minus: d2Phi/dz2 of the coarser sum jumps where the gradient's cubic along z does. */
static void SubtractAlongZ(LamTable table, const LamTableNode *node, const LamTableState *state, int sides,
                           LamTableAxial *axial)
{
  for (int below = 0; below < 2; below++) {
    const int low = Beside(table->grid, state->z, below);
    LamTableSum sum;
    const int *order;

    if (!CoarseSum(table, node, state->j, state->z, low, sides, &sum, &order)) continue;
    if (below)
      axial->second_minus -= sum.z2;
    else {
      axial->second -= sum.z2;
      SubtractAxial(&sum, order, axial);
    }
  }
}

/*
  Subtracts the sum of the coarser levels from a state. Value, gradient and mixed derivatives are equal in all cells
  that meet there. A pure second derivative is taken from any cell on its side, that along tau from the intervals on its
  side; only these need to be complete.
*/
static void MakeSurplus(LamTable table, const LamTableNode *node, LamTableState *state, LamTableAxial *axial)
{
  const int coarse = LAM_ROOT >> (node->level - 1);
  PetscReal plus[3], minus[3];
  PetscBool subtracted = PETSC_FALSE;
  const int low = axial ? Beside(table->grid, state->z, 0) : 0;
  int faces = 0;

  for (int k = 0; k < 3; k++) {
    plus[k] = minus[k] = NAN;
    faces |= (node->i[k] % coarse == 0) << k;
  }
  for (int sides = 0; sides < 8; sides++) {
    LamTableSum sum;
    const int *order;

    if ((sides & ~faces) || !CoarseSum(table, node, state->j, state->z, low, sides, &sum, &order)) continue;
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
    if (axial) SubtractAlongZ(table, node, state, sides, axial);
    if (CoarseSum(table, node, PetscMax(state->j - BESIDE, 0), state->z, low, sides, &sum, &order))
      state->tau2_minus -= sum.tau2;
    subtracted = PETSC_TRUE;
  }
  for (int k = 0; k < 3; k++) {
    state->minus[k] -= minus[k];
    state->phi.hessian[k] -= plus[k];
  }
  if (subtracted && isfinite(state->phi.value)) return;
  *state = (LamTableState){.j = state->j, .z = state->z, .data = state->data}; /* no coarser level covers the state */
  if (axial) *axial = (LamTableAxial){0};
}

/* ---- mixed third derivatives ---- */

/*
  The surplus of the node at a place on a level at suction j and knot z; NULL: unknown. It is 0 for nodes of coarser
  levels and floating cells. order: as returned by LamTableSortAxes.
*/
static const LamTableState *FindState(LamTable table, int level, const int at[3], int j, int z, int *order)
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
  for (const LamTableState *state = &table->states[node->first]; state < &table->states[node->first] + node->count;
       state++)
    if (state->j == j && state->z == z && state->has_data) return node->level < level ? &nothing : state;
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
    next = FindState(table, node->level, at, state->j, state->z, &order);
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

/* ---- slopes along suction and along z ---- */

/* Of n <= 3 states at `at` (in `unit`s): weights of their numbers in the slope at number s of the parabola, or line. */
static void SlopeWeights(PetscInt n, const int at[], PetscInt s, PetscReal unit, PetscReal weight[])
{
  for (PetscInt a = 0; a < n; a++) {
    PetscReal rise = n == 2 ? 1 : 0, run = 1;

    for (PetscInt b = 0; b < n; b++) {
      if (b == a) continue;
      if (n == 3) rise += unit * (at[s] - at[b]);
      run *= unit * (at[a] - at[b]);
    }
    weight[a] = rise / run;
  }
}

static void AddSlope(LamTable table, PetscReal weight, PetscInt from, PetscInt to)
{
  const LamTableState *other = &table->states[from];
  LamTableState *state = &table->states[to];

  for (int m = 0; m < 6; m++) state->hessian_tau[m] += weight * other->phi.hessian[m];
  for (int k = 0; k < 3; k++) state->minus_tau[k] += weight * other->minus[k];
  if (!table->axial) return;
  table->axial[to].second_tau[0] += weight * table->axial[from].second;
  table->axial[to].second_tau[1] += weight * table->axial[from].second_minus;
  for (int k = 0; k < 3; k++) table->axial[to].gradient_tau[k] += weight * table->axial[from].gradient[k];
}

/*
  Slopes of the second derivatives in tau: of the parabola through three neighbouring states of the column, or of the
  line through two. The column: `count` states from `from` on.
*/
static void SlopesAlongSuction(LamTable table, PetscInt from, PetscInt count)
{
  LamTableState *states = &table->states[from];
  const PetscReal unit = table->grid->tau_step / LAM_ROOT;
  const PetscInt n = PetscMin(count, 3);

  for (PetscInt s = 0; s < count; s++) {
    const PetscInt first = PetscMax(0, PetscMin(s - 1, count - n));
    PetscBool known = (PetscBool)(n > 1);
    PetscReal weight[3];
    int at[3];

    states[s].alone = (PetscBool)(n == 1);
    for (PetscInt a = 0; a < n; a++) {
      known = (PetscBool)(known && states[first + a].has_data);
      at[a] = states[first + a].j;
    }
    if (!known) continue;
    SlopeWeights(n, at, s - first, unit, weight);
    for (PetscInt a = 0; a < n; a++) AddSlope(table, weight[a], from + first + a, from + s);
  }
}

/* The columns of a node: one, or one for each knot of z. */
static void SlopesAlongColumns(LamTable table, const LamTableNode *node)
{
  const LamTableState *states = &table->states[node->first];
  PetscInt count;

  for (PetscInt s = 0; s < node->count; s += count) {
    for (count = 1; s + count < node->count && states[s + count].z == states[s].z;) count++;
    SlopesAlongSuction(table, node->first + s, count);
  }
}

/* The node's state at the suction of state number s, `knots` knots of z away; -1: unknown. */
static PetscInt Neighbour(LamTable table, const LamTableNode *node, PetscInt s, int knots)
{
  const LamTableState *states = table->states;

  for (PetscInt n = node->first; n < node->first + node->count; n++)
    if (states[n].z == states[s].z + knots && states[n].j == states[s].j && states[n].has_data) return n;
  return -1;
}

/* Slopes of the second derivatives in z, likewise from up to three knots with a state of this suction: the next on
   either side, or two on one. */
static void SlopesAlongZ(LamTable table, const LamTableNode *node, PetscInt s)
{
  static const int triples[3][2] = {{-1, 1}, {1, 2}, {-1, -2}}, singles[2] = {1, -1};
  LamTableAxial *axial = &table->axial[s];
  PetscInt of[3] = {s}, n = 1;
  PetscReal weight[3];
  int at[3] = {0};

  for (int k = 0; k < 3 && n < 3; k++)
    for (n = 1; n < 3 && (of[n] = Neighbour(table, node, s, triples[k][n - 1])) >= 0; n++) at[n] = triples[k][n - 1];
  for (int k = 0; k < 2 && n < 2; k++)
    if ((of[1] = Neighbour(table, node, s, singles[k])) >= 0) at[n++] = singles[k];
  if (n < 2) return;
  SlopeWeights(n, at, 0, table->grid->z_step, weight);
  for (PetscInt a = 0; a < n; a++) {
    const LamTableState *state = &table->states[of[a]];

    for (int m = 0; m < 6; m++) axial->hessian[m] += weight[a] * state->phi.hessian[m];
    for (int k = 0; k < 3; k++) axial->minus[k] += weight[a] * state->minus[k];
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

    LamTableAxial *axial = table->axial ? &table->axial[s] : NULL;

    LamTableMakeState(table->grid, &table->source->data[table->data[s]], table->data[s], state, axial);
    if (state->has_data && node->level) MakeSurplus(table, node, state, axial);
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
    if (LamGridHasColumns(table->grid)) SlopesAlongColumns(table, node);
    for (PetscInt s = node->first; table->axial && s < node->first + node->count; s++)
      if (table->states[s].has_data) SlopesAlongZ(table, node, s);
    atomic_store_explicit(&node->stage, LAM_NODE_MADE, memory_order_release);
  }
  mtx_unlock(&table->lock);
}
