/*
  The cells of a table: their corners, found among the nodes.
*/
#include "table.h"
#include <math.h>

const int LamAxisOrder[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

int LamTableSortAxes(PetscBool symmetric, const int i[3], int sorted[3])
{
  const int a = symmetric && i[0] > i[1], b = symmetric && i[0] > i[2], c = symmetric && i[1] > i[2];
  const int rank[3] = {a + b, 1 - a + c, 2 - b - c};

  for (int k = 0; k < 3; k++) sorted[rank[k]] = i[k];
  return 2 * rank[0] + (rank[1] > rank[2]); /* LamAxisOrder ascends */
}

const LamTableCell *LamTableCellAt(LamTable table, int level, const int i[3], LamTableCell *cell)
{
  const int size = LAM_ROOT >> level;
  PetscBool touched = PETSC_FALSE;

  cell->level = level;
  for (int k = 0; k < 3; k++) cell->i[k] = i[k];
  for (int c = 0; c < 8; c++) {
    const int at[3] = {i[0] + (c & 1 ? size : 0), i[1] + (c & 2 ? size : 0), i[2] + (c & 4 ? size : 0)};
    int sorted[3];
    PetscInt node;

    cell->order[c] = (unsigned char)LamTableSortAxes(table->grid->symmetric, at, sorted);
    node = LamPlaceMapGet(&table->node_map, LamPlaceMapKey(sorted));
    if (node >= 0)
      touched = (PetscBool)(touched || table->nodes[node].level == level);
    else
      node = LamPlaceIsFloating(table->grid, at) ? LAM_NODE_FLOATING : LAM_NODE_MISSING;
    cell->node[c] = node;
  }
  return touched ? cell : NULL;
}

const LamTableCell *LamTableFindCell(LamTable table, const LamTablePoint *point, int level, LamTableCell *cell)
{
  const int size = LAM_ROOT >> level;
  int i[3];

  for (int k = 0; k < 3; k++) {
    if (!(fabs(point->u[k]) < LAM_GRID_REACH - LAM_ROOT)) return NULL;
    i[k] = (int)floor(point->u[k] / size) * size;
  }
  return LamTableCellAt(table, level, i, cell);
}
