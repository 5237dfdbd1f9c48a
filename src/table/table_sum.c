/*
  Evaluation of the table at a point: columns at its suction, cells of all levels, their sum.
*/
#include "table.h"
#include <math.h>
#include <string.h>

/* ---- columns ---- */

/* Position of a point between two states of a column: t in [0, 1], h: step in tau. */
typedef struct {
  const LamTableState *end[2]; /* NULL: missing */
  PetscReal t, h;
  PetscReal V[2][3], D[2][3], q[2][3]; /* Hermite functions of the ends, their first and second derivatives in tau */
} Interval;

void LamTableBracket(LamTable table, const LamTableNode *node, const LamTablePoint *point, const LamTableState *ends[2])
{
  const LamTableState *states = LamTableStates(table, node);
  const int last = point->root + LAM_ROOT;
  PetscInt low = 0, high = node->count;

  ends[0] = ends[1] = NULL;
  if (!table->grid->contact) {
    ends[0] = ends[1] = states;
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
  if (low < node->count && states[low].j <= last) ends[1] = &states[low];
}

static void IntervalOf(LamTable table, const LamTableNode *node, const LamTablePoint *point, Interval *a)
{
  const PetscReal unit = table->grid->tau_step / LAM_ROOT;
  PetscReal t, s, h, from, to;

  LamTableBracket(table, node, point, a->end);
  if (!table->grid->contact) return;
  from = a->end[0] ? a->end[0]->j : point->root;
  to = a->end[1] ? a->end[1]->j : point->root + LAM_ROOT;
  a->h = h = (to - from) * unit;
  a->t = t = (point->v - from) / (to - from);
  s = 1 - t;
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

/* A column at a suction: jets of Phi and dPhi/dp, d2Phi/dp2, with their first and second derivatives in tau. */
typedef struct {
  LamJet phi[3], turgor1[3];
  PetscReal turgor2[3], bump[3];
} Column;

/* Given second derivatives in tau at the ends minus those of the cubic: coefficients of the quintic's bubbles. */
static void Defects(const Interval *a, const PetscReal value[2], const PetscReal slope[2], const PetscReal curvature[2],
                    PetscReal d[2])
{
  const PetscReal delta = value[1] - value[0], h = a->h;

  d[0] = curvature[0] - (6 * delta / (h * h) - (4 * slope[0] + 2 * slope[1]) / h);
  d[1] = curvature[1] - (-6 * delta / (h * h) + (2 * slope[0] + 4 * slope[1]) / h);
}

static void AddState(const Interval *a, int e, const int order[3], int corner, Column *c)
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
static void AddHigherOrder(const Interval *a, const int order[3], Column *c)
{
  PetscReal value[2], slope[2], curvature[2], d[2];

  for (int e = 0; e < 2; e++) {
    value[e] = a->end[e] ? a->end[e]->phi.value : 0;
    slope[e] = a->end[e] ? a->end[e]->tau1 : 0;
    curvature[e] = !a->end[e] ? 0 : e ? a->end[e]->tau2_minus : a->end[e]->tau2;
  }
  Defects(a, value, slope, curvature, d);
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

/* Bonded tissue: the column is a single state. */
static void TakeState(const LamTableState *state, const int order[3], int corner, Column *c)
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

/* Floating cells: Phi depends on suction alone; pure second derivatives are unknown on the side of contact. */
static void FloatingColumn(LamTable table, int level, const LamTablePoint *point, Column *c)
{
  const PetscReal rate = point->s + table->grid->suction_scale; /* ds/dtau = d2s/dtau2 */
  PetscReal energy[3], turgor[2][3];

  for (int k = 0; k < 3; k++) c->phi[0].hessian[k] = c->phi[1].hessian[k] = c->phi[2].hessian[k] = NAN;
  if (level) return;
  LamFreeCellEnergy(&table->grid->free, point->s, energy, turgor);
  c->phi[0].value = energy[0];
  c->phi[1].value = energy[1] * rate;
  c->phi[2].value = energy[2] * rate * rate + energy[1] * rate;
  for (int d = 0; d < 3; d++) {
    c->turgor1[d].value = turgor[0][d];
    c->turgor2[d] = turgor[1][d];
  }
}

static void MakeColumn(LamTable table, const LamTableCell *cell, int corner, const LamTablePoint *point, Column *c)
{
  const PetscInt n = cell->node[corner];
  const LamTableNode *node = &table->nodes[n];
  const int *order = LamAxisOrder[cell->order[corner]];
  Interval a;

  memset(c, 0, sizeof(*c));
  if (n == LAM_NODE_FLOATING) FloatingColumn(table, cell->level, point, c);
  if (n < 0 || node->level != cell->level) return;
  IntervalOf(table, node, point, &a);
  if (!table->grid->contact) {
    if (a.end[0]->has_data) TakeState(a.end[0], order, corner, c);
    return;
  }
  for (int e = 0; e < 2; e++) {
    if (a.end[e] && !a.end[e]->has_data) a.end[e] = NULL;
    if (a.end[e]) AddState(&a, e, order, corner, c);
  }
  AddHigherOrder(&a, order, c);
}

/* ---- cells ---- */

PetscBool LamTableCellIsComplete(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool *good)
{
  *good = PETSC_TRUE;
  for (int c = 0; c < 8; c++) {
    const LamTableState *ends[2];

    if (cell->node[c] == LAM_NODE_FLOATING) continue;
    if (cell->node[c] == LAM_NODE_MISSING) return PETSC_FALSE;
    LamTableBracket(table, &table->nodes[cell->node[c]], point, ends);
    for (int e = 0; e < 2; e++) {
      if (!LamTableRestsOn(ends, e, point)) continue;
      if (!ends[e] || (!ends[e]->has_data && !cell->level)) return PETSC_FALSE;
      if (!ends[e]->good) *good = PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

/* t dPhi/dp + w d2Phi/dp2 of a column, derivative of order order_tau in tau. */
static LamJet TurgorJet(const Column *column, int order_tau, PetscReal t, PetscReal w)
{
  const LamJet *turgor1 = &column->turgor1[order_tau];
  LamJet jet = {.value = t * turgor1->value + w * column->turgor2[order_tau]};

  for (int k = 0; k < 3; k++) jet.gradient[k] = t * turgor1->gradient[k];
  return jet;
}

/* The step d in turgor, without bubbles: adds the derivative in d, and the change of Phi where d is not 0. */
static void AddTurgor(LamTable table, const Column columns[8], PetscReal h, const PetscReal t[3], PetscReal d,
                      LamTableSum *sum)
{
  LamJet corner[8], along[3] = {0}, rate_tau = {0};

  for (int c = 0; c < 8; c++) corner[c] = TurgorJet(&columns[c], 0, 1, d);
  LamHermiteCubic(corner, h, t, &sum->turgor1);
  if (table->grid->contact) {
    for (int c = 0; c < 8; c++) corner[c] = TurgorJet(&columns[c], 1, 1, d);
    LamHermiteCubic(corner, h, t, &rate_tau);
    sum->turgor1_tau += rate_tau.value;
  }
  if (d == 0) return;
  for (int order_tau = 0; order_tau < (table->grid->contact ? 3 : 1); order_tau++) {
    for (int c = 0; c < 8; c++) corner[c] = TurgorJet(&columns[c], order_tau, d, 0.5 * d * d);
    LamHermiteCubic(corner, h, t, order_tau ? &along[order_tau] : &sum->phi);
  }
  sum->tau1 += along[1].value;
  sum->tau2 += along[2].value;
  for (int k = 0; k < 3; k++) sum->gradient_tau[k] += along[1].gradient[k];
}

PetscReal LamTableMissingShare(LamTable table, const LamTableCell *cell, const LamTablePoint *point)
{
  PetscReal missing = 0, all = 0;

  for (int c = 0; c < 8; c++) {
    const LamTableNode *node = cell->node[c] >= 0 ? &table->nodes[cell->node[c]] : NULL;
    const LamTableState *ends[2] = {NULL, NULL};
    PetscReal weight = 1;

    if (cell->node[c] == LAM_NODE_FLOATING || (node && node->level < cell->level)) continue;
    for (int k = 0; k < 3; k++) {
      const PetscReal t = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);

      weight *= c >> k & 1 ? t : 1 - t;
    }
    if (node) LamTableBracket(table, node, point, ends);
    all += weight;
    for (int e = 0; e < 2; e++) {
      if (ends[e] || !LamTableRestsOn(ends, e, point)) continue;
      missing += weight;
      break;
    }
  }
  return all > 0 ? missing / all : 0;
}

void LamTableAddCell(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool estimate,
                     LamTableSum *sum)
{
  const int size = LAM_ROOT >> cell->level, orders = table->grid->contact ? 3 : 1;
  const PetscReal h = table->grid->step / (1 << cell->level);
  LamJet corner[3][8], first = {0}, second = {0};
  Column columns[8];
  PetscReal t[3], bump[3] = {0};

  for (int k = 0; k < 3; k++) t[k] = (point->u[k] - cell->i[k]) / size;
  for (int c = 0; c < 8; c++) {
    PetscReal weight = 1;

    MakeColumn(table, cell, c, point, &columns[c]);
    for (int d = 0; d < orders; d++) corner[d][c] = columns[c].phi[d];
    for (int k = 0; k < 3; k++)
      weight *= c >> k & 1 ? t[k] * t[k] * (3 - 2 * t[k]) : (1 - t[k]) * (1 - t[k]) * (1 + 2 * t[k]);
    sum->turgor2 += weight * columns[c].turgor2[0];
    for (int k = 0; k < 3; k++) bump[k] += columns[c].bump[k] * columns[c].bump[k] / 8;
  }
  if (estimate) LamHermiteSizes(corner[0], h, sum->bend, sum->turn);
  for (int k = 0; k < 3; k++) sum->bump[k] = sqrt(sum->bump[k] * sum->bump[k] + bump[k]);
  LamHermiteQuintic(corner[0], h, t, &sum->phi);
  AddTurgor(table, columns, h, t, point->step, sum);
  if (!table->grid->contact) return;
  LamHermiteQuintic(corner[1], h, t, &first);
  LamHermiteQuintic(corner[2], h, t, &second);
  sum->tau1 += first.value;
  sum->tau2 += second.value;
  for (int k = 0; k < 3; k++) sum->gradient_tau[k] += first.gradient[k];
}

void LamTableAddFloating(LamTable table, const LamTablePoint *point, LamTableSum *sum)
{
  const PetscReal d = point->step;
  Column c = {0};

  FloatingColumn(table, 0, point, &c);
  sum->phi.value += c.phi[0].value + TurgorJet(&c, 0, d, 0.5 * d * d).value;
  sum->tau1 += c.phi[1].value + TurgorJet(&c, 1, d, 0.5 * d * d).value;
  sum->tau2 += c.phi[2].value + TurgorJet(&c, 2, d, 0.5 * d * d).value;
  sum->turgor1.value += TurgorJet(&c, 0, 1, d).value;
  sum->turgor1_tau += TurgorJet(&c, 1, 1, d).value;
  sum->turgor2 += c.turgor2[0];
}
