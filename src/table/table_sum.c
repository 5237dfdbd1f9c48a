/*
  Evaluation of the table at a point: columns at its suction, cells of all levels, their sum.
*/
#include "table_column.h"
#include <math.h>

/* ---- cells ---- */

PetscBool LamTableCellIsComplete(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool *good)
{
  *good = PETSC_TRUE;
  for (int c = 0; c < 8; c++) {
    const LamTableState *ends[2];

    if (cell->node[c] == LAM_NODE_FLOATING) continue;
    if (cell->node[c] == LAM_NODE_MISSING) return PETSC_FALSE;
    for (int line = 0; line < LamTableLines(table); line++) {
      LamTableBracket(table, &table->nodes[cell->node[c]], point, line, ends);
      for (int e = 0; e < 2; e++) {
        if (!LamTableRestsOn(ends, e, point)) continue;
        if (!ends[e] || (!ends[e]->has_data && !cell->level)) return PETSC_FALSE;
        if (!ends[e]->good) *good = PETSC_FALSE;
      }
    }
  }
  return PETSC_TRUE;
}

/* The same of a column, derivative of order order_tau in tau. */
static LamJet TurgorJet(const LamTableColumn *column, int order_tau, PetscReal t, PetscReal w)
{
  return LamTableTurgorJet(&column->turgor1[order_tau], column->turgor2[order_tau], t, w);
}

/* The step d in turgor, without bubbles: adds the derivative in d, and the change of Phi where d is not 0. */
static void AddTurgor(LamTable table, const LamTableColumn columns[8], PetscReal h, const PetscReal t[3], PetscReal d,
                      LamTableSum *sum)
{
  LamJet corner[8], along[3] = {0}, rate_tau = {0};

  for (int c = 0; c < 8; c++) corner[c] = TurgorJet(&columns[c], 0, 1, d);
  LamHermiteCubic(corner, h, t, &sum->turgor1);
  if (LamGridHasColumns(table->grid)) {
    for (int c = 0; c < 8; c++) corner[c] = TurgorJet(&columns[c], 1, 1, d);
    LamHermiteCubic(corner, h, t, &rate_tau);
    sum->turgor1_tau += rate_tau.value;
  }
  if (d == 0) return;
  for (int order_tau = 0; order_tau < (LamGridHasColumns(table->grid) ? 3 : 1); order_tau++) {
    for (int c = 0; c < 8; c++) corner[c] = TurgorJet(&columns[c], order_tau, d, 0.5 * d * d);
    LamHermiteCubic(corner, h, t, order_tau ? &along[order_tau] : &sum->phi);
  }
  sum->tau1 += along[1].value;
  sum->tau2 += along[2].value;
  for (int k = 0; k < 3; k++) sum->gradient_tau[k] += along[1].gradient[k];
}

/* Whether a node lacks a state around the point; NULL: it is missing itself. */
static PetscBool LacksStates(LamTable table, const LamTableNode *node, const LamTablePoint *point)
{
  for (int line = 0; node && line < LamTableLines(table); line++) {
    const LamTableState *ends[2];

    LamTableBracket(table, node, point, line, ends);
    for (int e = 0; e < 2; e++)
      if (!ends[e] && LamTableRestsOn(ends, e, point)) return PETSC_TRUE;
  }
  return (PetscBool)!node;
}

PetscReal LamTableMissingShare(LamTable table, const LamTableCell *cell, const LamTablePoint *point)
{
  PetscReal missing = 0, all = 0;

  for (int c = 0; c < 8; c++) {
    const LamTableNode *node = cell->node[c] >= 0 ? &table->nodes[cell->node[c]] : NULL;
    PetscReal weight = 1;

    if (cell->node[c] == LAM_NODE_FLOATING || (node && node->level < cell->level)) continue;
    for (int k = 0; k < 3; k++) {
      const PetscReal t = (point->u[k] - cell->i[k]) / (LAM_ROOT >> cell->level);

      weight *= c >> k & 1 ? t : 1 - t;
    }
    all += weight;
    if (LacksStates(table, node, point)) missing += weight;
  }
  return all > 0 ? missing / all : 0;
}

void LamTableAddCell(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool estimate,
                     LamTableSum *sum)
{
  const int size = LAM_ROOT >> cell->level, orders = LamGridHasColumns(table->grid) ? 3 : 1;
  const PetscReal h = table->grid->step / (1 << cell->level);
  LamJet corner[3][8], first = {0}, second = {0};
  LamTableColumn columns[8];
  LamTableInterval interval;
  PetscReal t[3], bump[3] = {0};

  if (table->grid->z_cells) {
    LamTableAddSheets(table, cell, point, estimate, sum);
    return;
  }
  for (int k = 0; k < 3; k++) t[k] = (point->u[k] - cell->i[k]) / size;
  for (int c = 0; c < 8; c++) {
    PetscReal weight = 1;

    LamTableMakeColumn(table, cell, c, point, 0, &interval, &columns[c]);
    for (int d = 0; d < orders; d++) corner[d][c] = columns[c].phi[d];
    for (int k = 0; k < 3; k++)
      weight *= c >> k & 1 ? t[k] * t[k] * (3 - 2 * t[k]) : (1 - t[k]) * (1 - t[k]) * (1 + 2 * t[k]);
    sum->turgor2 += weight * columns[c].turgor2[0];
    for (int k = 0; k < 3; k++) bump[k] += columns[c].bump[k] * columns[c].bump[k] / 8;
  }
  if (estimate) LamHermiteSizes(corner[0], h, sum->bend, sum->spread);
  for (int k = 0; k < 3; k++) sum->bump[k] = sqrt(sum->bump[k] * sum->bump[k] + bump[k]);
  LamHermiteQuintic(corner[0], h, t, &sum->phi);
  AddTurgor(table, columns, h, t, point->step, sum);
  if (!LamGridHasColumns(table->grid)) return;
  LamHermiteQuintic(corner[1], h, t, &first);
  LamHermiteQuintic(corner[2], h, t, &second);
  sum->tau1 += first.value;
  sum->tau2 += second.value;
  for (int k = 0; k < 3; k++) sum->gradient_tau[k] += first.gradient[k];
}

void LamTableAddFloating(LamTable table, const LamTablePoint *point, LamTableSum *sum)
{
  const PetscReal d = point->step;
  LamTableColumn c = {0};

  if (table->grid->z_cells) {
    LamTableAddFloatingSheet(table, point, sum);
    return;
  }
  LamTableFloatingColumn(table, 0, 0, point, &c);
  sum->phi.value += c.phi[0].value + TurgorJet(&c, 0, d, 0.5 * d * d).value;
  sum->tau1 += c.phi[1].value + TurgorJet(&c, 1, d, 0.5 * d * d).value;
  sum->tau2 += c.phi[2].value + TurgorJet(&c, 2, d, 0.5 * d * d).value;
  sum->turgor1.value += TurgorJet(&c, 0, 1, d).value;
  sum->turgor1_tau += TurgorJet(&c, 1, 1, d).value;
  sum->turgor2 += c.turgor2[0];
}
