/*
  The states of a node at a suction: its column.
*/
#include "table_column.h"
#include <math.h>
#include <string.h>

/* The states of a knot of F33; returns their number. */
static PetscInt FindLine(const LamTableNode *node, int z, const LamTableState **states)
{
  PetscInt low = 0, end, high = node->count;

  while (low < high) { /* the first state of this or a larger F33 */
    const PetscInt middle = (low + high) / 2;

    if ((*states)[middle].z >= z)
      high = middle;
    else
      low = middle + 1;
  }
  for (end = low; end < node->count && (*states)[end].z == z;) end++;
  *states += low;
  return end - low;
}

void LamTableBracket(LamTable table, const LamTableNode *node, const LamTablePoint *point, int line,
                     const LamTableState *ends[2])
{
  const LamTableState *states = LamTableStates(table, node);
  const int last = point->root + LAM_ROOT;
  const PetscInt count = table->grid->z_cells ? FindLine(node, point->z + line, &states) : node->count;
  PetscInt low = 0, high = count;

  ends[0] = ends[1] = NULL;
  if (!LamGridHasColumns(table->grid)) {
    if (count) ends[0] = ends[1] = states;
    return;
  }
  while (low < high) { /* the first state beyond the point, or at the end of the root interval */
    const PetscInt middle = (low + high) / 2;

    if (states[middle].j > point->v || states[middle].j >= last)
      high = middle;
    else
      low = middle + 1;
  }
  if (low > 0 && states[low - 1].j >= point->root) ends[0] = &states[low - 1];
  if (low < count && states[low].j <= last) ends[1] = &states[low];
}

void LamTableHermite(LamTableInterval *a)
{
  const PetscReal t = a->t, h = a->h, s = 1 - t;

  for (int e = 0; e < 2; e++) {
    const PetscReal r = e ? t : s, sign = e ? 1 : -1; /* r = 1 at this end; d/dtau = sign d/dr / h */

    a->V[e][0] = r * r * (3 - 2 * r);
    a->V[e][1] = sign * 6 * r * (1 - r) / h;
    a->V[e][2] = 6 * (1 - 2 * r) / (h * h);
    a->D[e][0] = -sign * h * r * r * (1 - r);
    a->D[e][1] = -(2 * r - 3 * r * r);
    a->D[e][2] = -sign * (2 - 6 * r) / h;
    a->q[e][0] = 0.5 * h * h * (1 - r) * (1 - r) * r * r * r;
    a->q[e][1] = sign * 0.5 * h * (3 * r * r * (1 - r) * (1 - r) - 2 * r * r * r * (1 - r));
    a->q[e][2] = 0.5 * (6 * r * (1 - r) * (1 - r) - 12 * r * r * (1 - r) + 2 * r * r * r);
  }
}

void LamTableIntervalOf(LamTable table, const LamTableNode *node, const LamTablePoint *point, int line,
                        LamTableInterval *a)
{
  const PetscReal unit = table->grid->tau_step / LAM_ROOT;
  PetscReal from, to;

  LamTableBracket(table, node, point, line, a->end);
  if (!LamGridHasColumns(table->grid)) return;
  from = a->end[0] ? a->end[0]->j : point->root;
  to = a->end[1] ? a->end[1]->j : point->root + LAM_ROOT;
  a->h = (to - from) * unit;
  a->t = (point->v - from) / (to - from);
  LamTableHermite(a);
}

void LamTableDefects(const LamTableInterval *a, const PetscReal value[2], const PetscReal slope[2],
                     const PetscReal curvature[2], PetscReal d[2])
{
  const PetscReal delta = value[1] - value[0], h = a->h;

  d[0] = curvature[0] - (6 * delta / (h * h) - (4 * slope[0] + 2 * slope[1]) / h);
  d[1] = curvature[1] - (-6 * delta / (h * h) + (2 * slope[0] + 4 * slope[1]) / h);
}

static void AddState(const LamTableInterval *a, int e, const int order[3], int corner, LamTableColumn *c)
{
  const LamTableState *state = a->end[e];
  const PetscBool alone =
      (PetscBool)(state->alone && a->t == e); /* its second derivatives at other suctions are unknown */

  for (int d = 0; d < 3; d++) {
    const PetscReal V = a->V[e][d], D = a->D[e][d];
    LamJet *jet = &c->phi[d], *turgor1 = &c->turgor1[d];

    jet->value += V * state->phi.value + D * state->tau1;
    jet->third += V * state->phi.third;
    for (int k = 0; k < 3; k++) {
      const int n = order[k];
      const PetscReal pure = corner >> k & 1 ? state->minus[n] : state->phi.hessian[n];
      const PetscReal pure_tau = corner >> k & 1 ? state->minus_tau[n] : state->hessian_tau[n];

      jet->gradient[k] += V * state->phi.gradient[n] + D * state->gradient_tau[n];
      jet->hessian[k] += alone && d ? NAN : V * pure + D * pure_tau;
      jet->hessian[3 + k] +=
          V * state->phi.hessian[3 + n] + D * state->hessian_tau[3 + n]; /* entry 3 + k lacks axis k */
      turgor1->gradient[k] += V * state->turgor_gradient[n];
    }
    turgor1->value += V * state->turgor1 + D * state->turgor_tau;
    c->turgor2[d] += V * state->turgor2;
  }
}

/* The quintic's bubbles in the value; `bump`: contribution of the gradient's cubic beyond the next lower order. */
static void AddHigherOrder(const LamTableInterval *a, const int order[3], LamTableColumn *c)
{
  PetscReal value[2], slope[2], curvature[2], d[2];

  for (int e = 0; e < 2; e++) {
    value[e] = a->end[e] ? a->end[e]->phi.value : 0;
    slope[e] = a->end[e] ? a->end[e]->tau1 : 0;
    curvature[e] = !a->end[e] ? 0 : e ? a->end[e]->tau2_minus : a->end[e]->tau2;
  }
  LamTableDefects(a, value, slope, curvature, d);
  for (int order_tau = 0; order_tau < 3; order_tau++)
    c->phi[order_tau].value += a->q[0][order_tau] * d[0] + a->q[1][order_tau] * d[1];
  for (int k = 0; k < 3; k++) {
    PetscReal bend = 0;

    for (int e = 0; e < 2; e++)
      if (a->end[e])
        bend += a->h * a->end[e]->gradient_tau[order[k]] + (e ? -2 : 2) * a->end[e]->phi.gradient[order[k]];
    c->bump[k] = 0.5 * a->t * (1 - a->t) * bend;
  }
}

/* Without columns: a single state. */
static void TakeState(const LamTableState *state, const int order[3], int corner, LamTableColumn *c)
{
  c->phi[0].value = state->phi.value;
  c->phi[0].third = state->phi.third;
  c->turgor1[0].value = state->turgor1;
  c->turgor2[0] = state->turgor2;
  for (int k = 0; k < 3; k++) {
    const int n = order[k];

    c->phi[0].gradient[k] = state->phi.gradient[n];
    c->phi[0].hessian[k] = corner >> k & 1 ? state->minus[n] : state->phi.hessian[n];
    c->phi[0].hessian[3 + k] = state->phi.hessian[3 + n];
    c->turgor1[0].gradient[k] = state->turgor_gradient[n];
  }
}

/* Phi depends on suction alone; pure second derivatives are unknown on the side of contact. */
void LamTableFloatingColumn(LamTable table, int level, PetscInt plane, const LamTablePoint *point, LamTableColumn *c)
{
  const PetscReal rate = LamGridSuctionRate(table->grid, point->s);
  PetscReal energy[3], turgor[2][3];

  for (int k = 0; k < 3; k++) c->phi[0].hessian[k] = c->phi[1].hessian[k] = c->phi[2].hessian[k] = NAN;
  if (level) return;
  LamFreeCellEnergy(&table->grid->free, plane, point->s, energy, turgor);
  c->phi[0].value = energy[0];
  c->phi[1].value = energy[1] * rate;
  c->phi[2].value = energy[2] * rate * rate + energy[1] * rate;
  for (int d = 0; d < 3; d++) {
    c->turgor1[d].value = turgor[0][d];
    c->turgor2[d] = turgor[1][d];
  }
}

void LamTableMakeColumn(LamTable table, const LamTableCell *cell, int corner, const LamTablePoint *point, int line,
                        LamTableInterval *a, LamTableColumn *c)
{
  const PetscInt n = cell->node[corner];
  const LamTableNode *node = &table->nodes[n];
  const int *order = LamAxisOrder[cell->order[corner]];

  memset(c, 0, sizeof(*c));
  a->end[0] = a->end[1] = NULL;
  if (n == LAM_NODE_FLOATING) LamTableFloatingColumn(table, cell->level, LamTablePlane(point, line), point, c);
  if (n < 0 || node->level != cell->level) return;
  LamTableIntervalOf(table, node, point, line, a);
  for (int e = 0; e < 2; e++)
    if (a->end[e] && !a->end[e]->has_data) a->end[e] = NULL;
  if (!LamGridHasColumns(table->grid)) {
    if (a->end[0]) TakeState(a->end[0], order, corner, c);
    return;
  }
  for (int e = 0; e < 2; e++)
    if (a->end[e]) AddState(a, e, order, corner, c);
  AddHigherOrder(a, order, c);
}
