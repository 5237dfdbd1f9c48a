/*
  The cells of a table: lookup of their corners among the nodes, in a hash map from places to nodes (open addressing,
  linear probing, at most half full).
*/
#include "table.h"
#include <math.h>

const int LamAxisOrder[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

int LamTableSortAxes(PetscBool symmetric, const int i[3], int sorted[3])
{
  const int a = symmetric && i[0] > i[1], b = symmetric && i[0] > i[2], c = symmetric && i[1] > i[2];
  const int rank[3] = {a + b, 1 - a + c, 2 - b - c};

  for (int k = 0; k < 3; k++) sorted[rank[k]] = i[k];
  return 2 * rank[0] + (rank[1] > rank[2]); /* LamAxisOrder is in ascending order */
}

/*
  Finds the node at each corner. Where the cell's coordinates differ, the nodes' axes are in the cell's order, and the
  keys of the corners differ by those of the steps. Returns whether one of the nodes is of the cell's own level.
*/
static PetscBool FindCorners(LamTable table, LamTableCell *cell)
{
  const int size = LAM_ROOT >> cell->level, *i = cell->i;
  const PetscBool differ = (PetscBool)(!table->grid->symmetric || (i[0] < i[1] && i[1] < i[2]));
  const PetscInt64 least = LamPlaceMapKey(i), step[3] = {(PetscInt64)size << 30, (PetscInt64)size << 15, size};
  PetscBool touched = PETSC_FALSE;

  for (int c = 0; c < 8; c++) {
    PetscInt64 key = least + (c & 1) * step[0] + (c >> 1 & 1) * step[1] + (c >> 2) * step[2];

    cell->order[c] = 0;
    if (!differ) {
      const int at[3] = {i[0] + (c & 1) * size, i[1] + (c >> 1 & 1) * size, i[2] + (c >> 2) * size};
      int sorted[3];

      cell->order[c] = (unsigned char)LamTableSortAxes(PETSC_TRUE, at, sorted);
      key = LamPlaceMapKey(sorted);
    }
    cell->node[c] = LamPlaceMapGet(&table->node_map, key);
    if (cell->node[c] >= 0 && table->nodes[cell->node[c]].level == cell->level) touched = PETSC_TRUE;
  }
  return touched;
}

const LamTableCell *LamTableCellAt(LamTable table, int level, const int i[3], LamTableCell *cell)
{
  const int size = LAM_ROOT >> level;

  cell->level = level;
  for (int k = 0; k < 3; k++) cell->i[k] = i[k];
  if (!FindCorners(table, cell)) return NULL;
  for (int c = 0; c < 8; c++) {
    const int at[3] = {i[0] + (c & 1) * size, i[1] + (c >> 1 & 1) * size, i[2] + (c >> 2) * size};

    if (cell->node[c] < 0) cell->node[c] = LamPlaceIsFloating(table->grid, at) ? LAM_NODE_FLOATING : LAM_NODE_MISSING;
  }
  return cell;
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

/* ---- the map ---- */

PetscErrorCode LamPlaceMapCreate(size_t n, LamPlaceMap *map)
{
  PetscFunctionBeginUser;
  map->size = 16;
  map->count = 0;
  while (map->size < 2 * n) map->size *= 2;
  PetscCall(PetscMalloc2(map->size, &map->keys, map->size, &map->items));
  for (size_t k = 0; k < map->size; k++) map->items[k] = -1;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlaceMapDestroy(LamPlaceMap *map)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(map->keys, map->items));
  map->size = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Grow(LamPlaceMap *map)
{
  LamPlaceMap larger;

  PetscFunctionBeginUser;
  PetscCall(LamPlaceMapCreate(map->size, &larger));
  for (size_t k = 0; k < map->size; k++)
    if (map->items[k] >= 0) PetscCall(LamPlaceMapSet(&larger, map->keys[k], map->items[k]));
  PetscCall(LamPlaceMapDestroy(map));
  *map = larger;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlaceMapSet(LamPlaceMap *map, PetscInt64 key, PetscInt item)
{
  size_t k;

  PetscFunctionBeginUser;
  if (2 * map->count == map->size) PetscCall(Grow(map));
  map->count++;
  k = LamPlaceMapSlot(map, key);
  while (map->items[k] >= 0) k = (k + 1) & (map->size - 1);
  map->keys[k] = key;
  map->items[k] = item;
  PetscFunctionReturn(0);
}
