/*
  Private to the table: a node's states interpolated along suction, and along ln F33 (table_column.c, table_sheet.c).
*/
#ifndef LAM_TABLE_COLUMN_H
#define LAM_TABLE_COLUMN_H

#include "table.h"

/* Position of a point between two states of a column: t in [0, 1], h: step in tau (of a sheet: in ln F33).
 */
typedef struct {
  const LamTableState *end[2]; /* NULL: missing */
  PetscReal t, h;
  PetscReal V[2][3], D[2][3], q[2][3]; /* Hermite functions of the ends, their first and second derivatives in tau */
} LamTableInterval;

/* A column at a suction: jets of Phi and dPhi/dp, d2Phi/dp2, with their first and second derivatives in tau. */
typedef struct {
  LamJet phi[3], turgor1[3];
  PetscReal turgor2[3], bump[3];
} LamTableColumn;

/* Fills V, D, q from t and h. */
void LamTableHermite(LamTableInterval *a);
/* The states of line `line` around the point. */
void LamTableIntervalOf(LamTable table, const LamTableNode *node, const LamTablePoint *point, int line,
                        LamTableInterval *a);
/* Given second derivatives in tau at the ends minus those of the cubic: coefficients of the quintic's bubbles. */
void LamTableDefects(const LamTableInterval *a, const PetscReal value[2], const PetscReal slope[2],
                     const PetscReal curvature[2], PetscReal d[2]);
/* The column of line `line` (0 without the axis F33) at a corner of the cell; the states, except for those without
   data, are left in *a. */
void LamTableMakeColumn(LamTable table, const LamTableCell *cell, int corner, const LamTablePoint *point, int line,
                        LamTableInterval *a, LamTableColumn *c);
/* Floating cells; plane: of the free cell. */
void LamTableFloatingColumn(LamTable table, int level, PetscInt plane, const LamTablePoint *point, LamTableColumn *c);

/* t dPhi/dp + w d2Phi/dp2. */
static inline LamJet LamTableTurgorJet(const LamJet *turgor1, PetscReal turgor2, PetscReal t, PetscReal w)
{
  LamJet jet = {.value = t * turgor1->value + w * turgor2};

  for (int k = 0; k < 3; k++) jet.gradient[k] = t * turgor1->gradient[k];
  return jet;
}

/* ---- table_sheet.c: with the axis F33 ---- */
void LamTableAddSheets(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool estimate,
                       LamTableSum *sum);
void LamTableAddFloatingSheet(LamTable table, const LamTablePoint *point, LamTableSum *sum);

#endif
