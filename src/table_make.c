/*
  From records to a table.

  Algorithm
    1. Records whose keys are nodes, sorted by level, place and suction; nodes and their columns.
    2. Cells: all that touch a node on its own level, in the sorted order of axes where the grid is symmetric.
    3. Level by level, of each state: Phi and its derivatives in the grid's coordinates, less the sum of the coarser
       levels there. On a face of coarser cells the pure second derivatives are taken from the cells on either side.
*/
#include "table.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- data of one record, in the grid's coordinates ---- */

static PetscReal Bilinear(const PetscReal A[16], const PetscReal a[4], const PetscReal b[4])
{
  PetscReal sum = 0;

  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) sum += 0.5 * (A[4 * i + j] + A[4 * j + i]) * a[i] * b[j];
  return sum;
}

static PetscReal Contract(const PetscReal a[4], const PetscReal b[4])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* S : sym(a^T b), S = F^-1 P. */
static PetscReal Bending(const PetscReal F[4], const PetscReal P[4], const PetscReal a[4], const PetscReal b[4])
{
  const PetscReal J = F[0] * F[3] - F[1] * F[2];
  const PetscReal S[4] = {(F[3] * P[0] - F[1] * P[2]) / J, (F[3] * P[1] - F[1] * P[3]) / J,
                          (F[0] * P[2] - F[2] * P[0]) / J, (F[0] * P[3] - F[2] * P[1]) / J};
  const PetscReal t[4] = {a[0] * b[0] + a[2] * b[2], a[0] * b[1] + a[2] * b[3], a[1] * b[0] + a[3] * b[2],
                          a[1] * b[1] + a[3] * b[3]};

  return S[0] * t[0] + S[3] * t[3] + 0.5 * (S[1] + S[2]) * 0.5 * (t[1] + t[2]) * 2;
}

static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};

/* Psi + factor J and its derivatives in x. */
static void StrainJet(const struct LamGrid_s *grid, const LamNodeData *r, PetscReal factor, LamJet *jet,
                      PetscReal dF[3][4], PetscReal J_x[3])
{
  const LamLatticeState at = LamLatticeStateOf(&grid->axes, r->F);
  PetscReal J_xx[6], J;

  J = LamLatticeVolume(&grid->axes, &at, J_x, J_xx);
  LamLatticeVariations(&grid->axes, &at, r->F, dF);
  jet->value = r->energy + factor * J;
  for (int k = 0; k < 3; k++) jet->gradient[k] = Contract(r->P, dF[k]) + factor * J_x[k];
  for (int m = 0; m < 6; m++) {
    const PetscReal *a = dF[row[m]], *b = dF[column[m]];

    jet->hessian[m] = Bilinear(r->tangent, a, b) - Bending(r->F, r->P, a, b) + factor * J_xx[m] +
                      (row[m] == column[m] ? 2 * Contract(r->P, a) : 0);
  }
}

/* (y, s) instead of (x, s): x = y + a(s); then tau instead of s. */
static void MoveAlong(const struct LamGrid_s *grid, PetscReal s, PetscReal phi_s, PetscReal phi_ss,
                      const PetscReal gradient_s[3], LamTableState *state)
{
  static const int entry[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  const PetscReal rate = s + grid->suction_scale; /* ds/dtau = d2s/dtau2 */
  PetscReal a[3] = {0};

  if (grid->free.n) LamFreeCellStrain(&grid->free, s, a);
  for (int k = 0; k < 3; k++) {
    PetscReal moved = gradient_s[k];

    for (int l = 0; l < 3; l++) {
      moved += a[1] * state->phi.hessian[entry[k][l]];
      phi_ss += a[1] * a[1] * state->phi.hessian[entry[k][l]];
    }
    phi_s += a[1] * state->phi.gradient[k];
    state->turgor_tau += a[1] * state->turgor_gradient[k];
    phi_ss += 2 * a[1] * gradient_s[k] + a[2] * state->phi.gradient[k];
    state->gradient_tau[k] = moved * rate;
  }
  state->tau1 = phi_s * rate;
  state->tau2 = phi_ss * rate * rate + phi_s * rate;
  state->tau2_minus = state->tau2;
  state->turgor_tau *= rate;
}

/* Bonded: Psi + p J; contact: Psi - g J = Psi + p J - s J. */
static void FillState(const struct LamGrid_s *grid, const LamNodeData *r, LamTableState *state)
{
  const PetscReal factor = grid->contact ? -r->cohesion : r->turgor, J = r->F[0] * r->F[3] - r->F[1] * r->F[2];
  PetscReal dF[3][4], J_x[3], along[3], at_rest[4];

  StrainJet(grid, r, factor, &state->phi, dF, J_x);
  for (int k = 0; k < 3; k++) state->minus[k] = state->phi.hessian[k];
  /* dPhi/dp at fixed s, with contact at the cost of cohesion */
  for (int i = 0; i < 4; i++) at_rest[i] = r->P_turgor[i] - (grid->contact ? r->P_cohesion[i] : 0);
  state->turgor1 = r->energy_turgor + J - (grid->contact ? r->energy_cohesion : 0);
  state->turgor2 = r->energy_turgor2;
  if (grid->contact) state->turgor2 += r->energy_cohesion2 - 2 * r->energy_turgor_cohesion;
  for (int k = 0; k < 3; k++) {
    state->turgor_gradient[k] = Contract(at_rest, dF[k]) + J_x[k];
    along[k] = Contract(r->P_turgor, dF[k]);
  }
  if (!grid->contact) return; /* bonded tissue does not feel cohesion, whose derivatives need not be known */
  state->turgor_tau = r->energy_turgor2 - r->energy_turgor_cohesion; /* in s, at fixed x */
  MoveAlong(grid, r->turgor + r->cohesion, r->energy_turgor, r->energy_turgor2, along, state);
}

static PetscBool IsFinite(const LamTableState *s)
{
  PetscReal sum = s->phi.value + s->tau1 + s->tau2 + s->turgor1 + s->turgor2 + s->turgor_tau;

  for (int k = 0; k < 3; k++) sum += s->phi.gradient[k] + s->gradient_tau[k] + s->turgor_gradient[k];
  for (int m = 0; m < 6; m++) sum += s->phi.hessian[m];
  return (PetscBool)isfinite(sum);
}

/*
  Whether the walls are on another branch than their neighbours in strain. Cells that barely touch leave saddles of
  another kind, of the motions in which they roll off each other, and end on the one branch that there is.
*/
#define BARELY_TOUCHING 0.75 /* share of the interface without contact */
static PetscBool HasBuckled(const LamNodeData *r)
{
  return (PetscBool)(r->branch > 0 && !(r->debonded_fraction > BARELY_TOUCHING));
}

/* A solve knows the symmetry of its state only to its own tolerance: means over the axes whose places are equal. */
static void Symmetrise(const int i[3], LamTableState *state)
{
  PetscReal *const triples[] = {state->phi.gradient, state->phi.hessian,  state->phi.hessian + 3,
                                state->minus,        state->gradient_tau, state->turgor_gradient};

  for (size_t n = 0; n < PETSC_STATIC_ARRAY_LENGTH(triples); n++) {
    const PetscReal old[3] = {triples[n][0], triples[n][1], triples[n][2]};

    for (int k = 0; k < 3; k++) {
      PetscReal sum = 0;
      int count = 0;

      for (int l = 0; l < 3; l++)
        if (i[l] == i[k]) {
          sum += old[l];
          count++;
        }
      triples[n][k] = sum / count;
    }
  }
}

static void MakeState(const struct LamGrid_s *grid, const LamNodeData *r, PetscInt data, const LamNodePlace *place,
                      LamTableState *state)
{
  const int j = place->j;

  *state = (LamTableState){.j = j, .data = data};
  if (r->status != LAM_CONVERGED && r->status != LAM_UNSTABLE) return;
  FillState(grid, r, state);
  if (grid->symmetric) Symmetrise(place->i, state);
  state->has_data = IsFinite(state);
  state->good = (PetscBool)(state->has_data && r->status == LAM_CONVERGED && r->stable && !HasBuckled(r));
  if (!state->has_data) *state = (LamTableState){.j = j, .data = data};
}

/* ---- nodes ---- */

typedef struct {
  PetscInt64 key;
  PetscInt data;
  int level;
} Entry;

static int CompareEntries(const void *first, const void *second)
{
  const Entry *a = first, *b = second;

  if (a->level != b->level) return a->level - b->level;
  if (a->key != b->key) return a->key < b->key ? -1 : 1;
  return a->data < b->data ? -1 : a->data > b->data;
}

/* Others are left out: they come from damaged files. */
static PetscBool IsPlace(const struct LamGrid_s *grid, const LamNodePlace *place)
{
  const int *i = place->i, reach = LAM_GRID_REACH - 2 * LAM_ROOT;

  for (int k = 0; k < 3; k++)
    if (i[k] < -reach || i[k] > reach) return PETSC_FALSE;
  if (grid->symmetric && (i[0] > i[1] || i[1] > i[2])) return PETSC_FALSE;
  return (PetscBool)(place->j <= LAM_ROOT * grid->tau_cells && !LamPlaceIsFloating(grid, i));
}

static PetscErrorCode CollectEntries(LamTable table, PetscInt *n, Entry **entries)
{
  const LamDatabase db = table->database;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(db->node_count + 1, entries));
  *n = 0;
  for (PetscInt d = 0; d < db->node_count; d++) {
    const LamNodePlace place = LamNodePlaceOf(db->nodes[d].key);

    if (!LamNodeIsFree(&place)) {
      if (IsPlace(table->grid, &place)) (*entries)[(*n)++] = (Entry){db->nodes[d].key, d, LamNodeLevel(&place)};
      continue;
    }
    for (PetscInt m = 0; m < table->grid->free.n; m++)
      if (table->grid->free_keys[m] == db->nodes[d].key) table->free_data[m] = d;
  }
  qsort(*entries, (size_t)*n, sizeof(Entry), CompareEntries);
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeNodes(LamTable table)
{
  LamTableNode *node = NULL;
  Entry *entries;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(CollectEntries(table, &n, &entries));
  PetscCall(PetscMalloc1(n + 1, &table->states));
  PetscCall(PetscMalloc1(n + 1, &table->nodes));
  PetscCall(LamPlaceMapCreate(n, &table->node_map));
  for (PetscInt e = 0; e < n; e++) {
    const LamNodePlace place = LamNodePlaceOf(entries[e].key);

    if (e && entries[e].key == entries[e - 1].key) continue; /* solved twice: the first counts */
    if (!node || memcmp(node->i, place.i, sizeof(place.i)) != 0) {
      node = &table->nodes[table->node_count];
      *node = (LamTableNode){.level = entries[e].level, .first = table->state_count};
      memcpy(node->i, place.i, sizeof(place.i));
      LamPlaceMapSet(&table->node_map, LamPlaceMapKey(0, place.i), table->node_count++);
    }
    MakeState(table->grid, &table->database->nodes[entries[e].data], entries[e].data, &place,
              &table->states[table->state_count++]);
    node->count++;
  }
  PetscCall(PetscFree(entries));
  PetscFunctionReturn(0);
}

/* ---- cells ---- */

/* Sorts i ascending where directions are alike; order: the axis of the sorted that each axis is. */
static int SortAxes(PetscBool symmetric, const int i[3], int sorted[3])
{
  int rank[3] = {0, 1, 2};

  if (symmetric)
    for (int k = 0; k < 3; k++) {
      rank[k] = 0;
      for (int l = 0; l < 3; l++) rank[k] += i[l] < i[k] || (i[l] == i[k] && l < k);
    }
  for (int k = 0; k < 3; k++) sorted[rank[k]] = i[k];
  for (int o = 0; o < 6; o++)
    if (!memcmp(rank, LamAxisOrder[o], sizeof(rank))) return o;
  return 0;
}

static void FillCell(LamTable table, int level, const int i[3], LamTableCell *cell)
{
  const int size = LAM_ROOT >> level;

  *cell = (LamTableCell){.level = level, .i = {i[0], i[1], i[2]}};
  for (int c = 0; c < 8; c++) {
    int at[3], sorted[3];

    for (int k = 0; k < 3; k++) at[k] = i[k] + (c >> k & 1 ? size : 0);
    cell->order[c] = (unsigned char)SortAxes(table->grid->symmetric, at, sorted);
    cell->node[c] = LamPlaceMapGet(&table->node_map, LamPlaceMapKey(0, sorted));
    if (cell->node[c] < 0) cell->node[c] = LamPlaceIsFloating(table->grid, at) ? LAM_NODE_FLOATING : LAM_NODE_MISSING;
  }
}

/* A place of a node, one of up to six that its sorted coordinates stand for: its eight cells. */
static void AddCellsAround(LamTable table, int level, const int at[3])
{
  const int size = LAM_ROOT >> level;

  for (int c = 0; c < 8; c++) {
    int i[3], sorted[3];

    for (int k = 0; k < 3; k++) i[k] = at[k] - (c >> k & 1 ? size : 0);
    if (SortAxes(table->grid->symmetric, i, sorted) || LamPlaceMapGet(&table->cell_map, LamPlaceMapKey(level, i)) >= 0)
      continue;
    FillCell(table, level, i, &table->cells[table->cell_count]);
    LamPlaceMapSet(&table->cell_map, LamPlaceMapKey(level, i), table->cell_count++);
  }
}

static PetscErrorCode MakeCells(LamTable table)
{
  const PetscInt most = 8 * table->node_count; /* of sorted cells around a sorted node there are at most 8 */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(most + 1, &table->cells));
  PetscCall(LamPlaceMapCreate(most, &table->cell_map));
  for (PetscInt n = 0; n < table->node_count; n++) {
    const LamTableNode *node = &table->nodes[n];

    table->levels = PetscMax(table->levels, node->level + 1);
    for (int o = 0; o < (table->grid->symmetric ? 6 : 1); o++) {
      int at[3];

      for (int k = 0; k < 3; k++) at[k] = node->i[LamAxisOrder[o][k]];
      AddCellsAround(table, node->level, at);
    }
  }
  PetscCall(PetscRealloc((size_t)(table->cell_count + 1) * sizeof(*table->cells), &table->cells));
  PetscFunctionReturn(0);
}

/* ---- surplus ---- */

/* Entry of a Hessian between two axes. */
static int Entry3(int a, int b)
{
  return a == b ? a : 6 - a - b;
}

/* The sum of the coarser levels at a node and v along suction, in the cells on the given sides (bit k: below) of it. */
static PetscBool CoarseSum(LamTable table, const LamTableNode *node, PetscReal v, int sides, LamTableSum *sum,
                           int order[3])
{
  LamTablePoint point = {.tau = table->grid->tau_min + table->grid->tau_step * v / LAM_ROOT, .v = v};
  PetscReal nudged[3];

  memset(sum, 0, sizeof(*sum));
  point.s = table->grid->contact ? table->grid->suction_scale * expm1(point.tau) : 0;
  point.root = PetscMin((int)v / LAM_ROOT, (int)table->grid->tau_cells - 1) * LAM_ROOT;
  /* sorted with the sides, so that the cells are found by their sorted corner */
  for (int k = 0; k < 3; k++) nudged[k] = node->i[k] + (sides >> k & 1 ? -0.25 : 0.25);
  for (int k = 0; k < 3; k++) {
    order[k] = 0;
    for (int l = 0; l < 3 && table->grid->symmetric; l++)
      order[k] += nudged[l] < nudged[k] || (nudged[l] == nudged[k] && l < k);
    if (!table->grid->symmetric) order[k] = k;
  }
  for (int level = 0; level < node->level; level++) {
    const LamTableCell *cell;

    for (int k = 0; k < 3; k++) point.u[order[k]] = nudged[k];
    cell = LamTableFindCell(table, &point, level);
    for (int k = 0; k < 3; k++) point.u[order[k]] = node->i[k];
    if (!level && !cell) return PETSC_FALSE;
    if (cell) LamTableAddCell(table, cell, &point, PETSC_FALSE, sum);
  }
  return PETSC_TRUE;
}

static void SubtractSum(const LamTableSum *sum, const int order[3], LamTableState *state)
{
  static const int pair[3][2] = {{1, 2}, {0, 2}, {0, 1}};

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
    state->phi.hessian[3 + k] -= sum->phi.hessian[Entry3(order[pair[k][0]], order[pair[k][1]])];
  }
}

#define BESIDE 1e-6 /* units of suction */

/*
  Takes the sum of the coarser levels off a state. Value, gradient and mixed derivatives are the same in all cells that
  meet there; a pure second derivative is that of any cell on its side, that along tau of the intervals on its side,
  which alone need be complete.
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
    int order[3];

    if ((sides & ~faces) || !CoarseSum(table, node, state->j, sides, &sum, order)) continue;
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
    if (CoarseSum(table, node, PetscMax(state->j - BESIDE, 0), sides, &sum, order)) state->tau2_minus -= sum.tau2;
    subtracted = PETSC_TRUE;
  }
  for (int k = 0; k < 3; k++) {
    state->minus[k] -= minus[k];
    state->phi.hessian[k] -= plus[k];
  }
  if (!subtracted || !isfinite(state->phi.value)) /* nothing coarser to stand on */
    *state = (LamTableState){.j = state->j, .data = state->data};
}

/* ---- mixed third derivatives ---- */

/*
  What the node at a place adds on a level at suction j; NULL: not known. Nodes of coarser levels and floating cells add
  nothing. order: as SortAxes gives it.
*/
static const LamTableState *FindState(LamTable table, int level, const int at[3], int j, int *order)
{
  static const LamTableState nothing = {0};
  const LamTableNode *node;
  PetscInt n;
  int sorted[3];

  *order = SortAxes(table->grid->symmetric, at, sorted);
  n = LamPlaceMapGet(&table->node_map, LamPlaceMapKey(0, sorted));
  if (n < 0) return LamPlaceIsFloating(table->grid, at) ? &nothing : NULL;
  node = &table->nodes[n];
  for (PetscInt s = 0; s < node->count; s++)
    if (table->states[node->first + s].j == j && table->states[node->first + s].has_data)
      return node->level < level ? &nothing : &table->states[node->first + s];
  return NULL;
}

/* Difference quotient of d2Phi/dx_a dx_b along the third axis k; *sides: 2 where it is central, 0: there is none. */
static PetscReal MixedSlope(LamTable table, const LamTableNode *node, const LamTableState *state, int k, int *sides)
{
  const int size = LAM_ROOT >> node->level, a = (k + 1) % 3, b = (k + 2) % 3;
  PetscReal mixed[2], length = 0;

  *sides = 0;
  mixed[0] = mixed[1] = state->phi.hessian[3 + k];
  for (int side = 0; side < 2; side++) {
    int at[3] = {node->i[0], node->i[1], node->i[2]}, order;
    const LamTableState *next;

    at[k] += side ? size : -size;
    next = FindState(table, node->level, at, state->j, &order);
    if (!next) continue;
    mixed[side] = next->phi.hessian[Entry3(LamAxisOrder[order][a], LamAxisOrder[order][b])];
    length += table->grid->step / (1 << node->level);
    (*sides)++;
  }
  return *sides ? (mixed[1] - mixed[0]) / length : 0;
}

/* d3/dx_1 dx_2 dx_3 of what the level adds: mean over the axes, of central differences alone where there are any. */
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
  Slopes of the second derivatives in tau: those of the parabola through a state and its neighbours in the column, of
  the line where there are two states.
*/
static void SlopesAlongSuction(LamTable table, const LamTableNode *node)
{
  LamTableState *states = &table->states[node->first];
  const PetscReal unit = table->grid->tau_step / LAM_ROOT;
  const PetscInt n = PetscMin(node->count, 3);

  for (PetscInt s = 0; s < node->count; s++) {
    const PetscInt first = PetscMax(0, PetscMin(s - 1, node->count - n));
    PetscBool known = (PetscBool)(n > 1);

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

/* Level by level: nodes are sorted so. */
static void MakeLevels(LamTable table)
{
  for (PetscInt first = 0, last; first < table->node_count; first = last) {
    const int level = table->nodes[first].level;

    for (last = first; last < table->node_count && table->nodes[last].level == level; last++)
      for (PetscInt s = 0; s < table->nodes[last].count && level; s++) {
        LamTableState *state = &table->states[table->nodes[last].first + s];

        if (state->has_data) MakeSurplus(table, &table->nodes[last], state);
      }
    for (PetscInt n = first; n < last; n++) {
      for (PetscInt s = 0; s < table->nodes[n].count; s++) {
        LamTableState *state = &table->states[table->nodes[n].first + s];

        if (state->has_data) state->phi.third = MixedThird(table, &table->nodes[n], state);
      }
      if (table->grid->contact) SlopesAlongSuction(table, &table->nodes[n]);
    }
  }
}

/* ---- the table ---- */

PetscErrorCode LamTableMake(LamDatabase database, LamTable *table)
{
  LamTable t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->references = 1;
  t->database = database;
  t->grid = database->grid;
  PetscCall(PetscMalloc1(t->grid->free.n + 1, &t->free_data));
  for (PetscInt m = 0; m < t->grid->free.n; m++) t->free_data[m] = -1;
  PetscCall(MakeNodes(t));
  PetscCall(MakeCells(t));
  MakeLevels(t);
  *table = t;
  PetscFunctionReturn(0);
}

/* Of one table several readers may hold references at once, in threads too. */
LamTable LamTableReference(LamTable table)
{
  if (table) atomic_fetch_add(&table->references, 1);
  return table;
}

PetscErrorCode LamTableDestroy(LamTable *table)
{
  LamTable t = *table;

  PetscFunctionBeginUser;
  *table = NULL;
  if (!t || atomic_fetch_sub(&t->references, 1) > 1) PetscFunctionReturn(0);
  PetscCall(LamPlaceMapDestroy(&t->node_map));
  PetscCall(LamPlaceMapDestroy(&t->cell_map));
  PetscCall(PetscFree(t->states));
  PetscCall(PetscFree(t->nodes));
  PetscCall(PetscFree(t->cells));
  PetscCall(PetscFree(t->free_data));
  PetscCall(PetscFree(t));
  PetscFunctionReturn(0);
}
