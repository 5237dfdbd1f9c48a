/*
  The output of `info` on a table: nodes and cells per level, their ranges, unusable states.
*/
#include "table.h"
#include "range.h"

enum { TRIED = 16 }; /* suctions tested in a root interval */

typedef struct {
  PetscInt nodes[LAM_FINEST + 1];                           /* states by the level of their place */
  PetscInt complete[LAM_FINEST + 1], mixed[LAM_FINEST + 1]; /* cells, counted per root interval of suction and of F33 */
  PetscInt unstable, other_branch, failed, floating, free_cell; /* states */
  LamRange strain, suction;                                     /* of good states */
} Census;

/* ---- nodes ---- */

static void CountState(LamTable table, const LamTableState *state, int level, Census *c)
{
  const LamNodeData *data = &table->source->data[state->data];

  c->nodes[level]++;
  if (data->status == LAM_UNSTABLE || (data->status == LAM_CONVERGED && !data->stable))
    c->unstable++;
  else if (data->status != LAM_CONVERGED)
    c->failed++;
  else if (data->branch)
    c->other_branch++;
  if (data->floating_cells > 0) c->floating++;
  if (!state->good) return;
  for (int k = 0; k < 3; k++) LamRangeWiden(&c->strain, LamLatticeStateOf(&table->grid->axes, data->F).x[k]);
  LamRangeWiden(&c->suction, LamGridSuctionOf(table->grid, data->turgor, data->cohesion));
}

static void CountNodes(LamTable table, Census *c)
{
  for (PetscInt n = 0; n < table->node_count; n++)
    for (PetscInt s = 0; s < table->nodes[n].count; s++)
      CountState(table, &LamTableStates(table, &table->nodes[n])[s], table->nodes[n].level, c);
  for (PetscInt m = 0; m < LamFreeCellStates(&table->grid->free); m++) c->free_cell += table->free_data[m] >= 0;
}

/* ---- cells ---- */

/* Whether a cell is complete at some suction of a root interval, and between knots z and z + 1 of F33; *mixed: not all
   of these states are good. */
static PetscBool IsComplete(LamTable table, const LamTableCell *cell, int root, int z, PetscBool *mixed)
{
  PetscBool complete = PETSC_FALSE, good;

  *mixed = PETSC_FALSE;
  for (int k = 0; k < (LamGridHasColumns(table->grid) ? TRIED : 1) && !*mixed; k++) {
    const LamTablePoint point = {.v = root + (k + 0.5) * LAM_ROOT / TRIED, .root = root, .z = z};

    if (!LamTableCellIsComplete(table, cell, &point, &good)) continue;
    complete = PETSC_TRUE;
    *mixed = (PetscBool)!good;
  }
  return complete;
}

static void CountCell(LamTable table, const LamTableCell *cell, Census *c)
{
  const int intervals = LamGridHasColumns(table->grid) ? (int)table->grid->tau_cells : 1;
  const int knots = PetscMax(1, (int)table->grid->z_cells);

  for (int n = 0; n < intervals * knots; n++) {
    PetscBool mixed;

    if (!IsComplete(table, cell, LAM_ROOT * (n % intervals), 1 + n / intervals, &mixed)) continue;
    c->complete[cell->level]++;
    c->mixed[cell->level] += mixed;
  }
}

/* Counts each cell once: at its first corner whose own level is the cell's. */
static PetscBool IsFirstCorner(LamTable table, const LamTableCell *cell, int corner)
{
  for (int c = 0; c < corner; c++)
    if (cell->node[c] >= 0 && table->nodes[cell->node[c]].level == cell->level) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether axis a of the sorted coordinates comes before axis b. */
static PetscBool IsBefore(const int order[3], int a, int b)
{
  return (PetscBool)(order[0] == a || (order[0] != b && order[1] == a));
}

/* Counts the cells of a node's level around `at`, one of the places that its sorted coordinates represent. */
static void CountCellsAround(LamTable table, int level, const int at[3], Census *c)
{
  const int size = LAM_ROOT >> level;

  for (int corner = 0; corner < 8; corner++) {
    int i[3], sorted[3];
    LamTableCell cell;

    for (int k = 0; k < 3; k++) i[k] = at[k] - (corner >> k & 1 ? size : 0);
    if (LamTableSortAxes(table->grid->symmetric, i, sorted)) continue;
    if (LamTableCellAt(table, level, i, &cell) && IsFirstCorner(table, &cell, corner)) CountCell(table, &cell, c);
  }
}

static void CountCells(LamTable table, Census *c)
{
  for (PetscInt n = 0; n < table->node_count; n++) {
    const int *i = table->nodes[n].i;

    for (int o = 0; o < (table->grid->symmetric ? 6 : 1); o++) {
      const int *order = LamAxisOrder[o];
      const int at[3] = {i[order[0]], i[order[1]], i[order[2]]};

      /* equal coordinates in one order only: the other gives the same place */
      if ((i[0] == i[1] && IsBefore(order, 1, 0)) || (i[1] == i[2] && IsBefore(order, 2, 1))) continue;
      CountCellsAround(table, table->nodes[n].level, at, c);
    }
  }
}

/* ---- JSON ---- */

static json_t *Levels(LamTable table, const PetscInt counts[])
{
  json_t *list = json_array();

  for (int level = 0; level < table->levels; level++) json_array_append_new(list, json_integer(counts[level]));
  return list;
}

static json_t *GridToJSON(const struct LamGrid_s *grid, PetscReal MPa)
{
  json_t *object =
      json_pack("{s:f, s:f, s:b}", "step", grid->step, "origin", grid->origin, "symmetric", (int)grid->symmetric);
  LamRange suction, strain = {PETSC_INFINITY, PETSC_NINFINITY};

  if (grid->z_cells) {
    const LamRange F33 = {LamGridF33(grid, 1), LamGridF33(grid, 1 + (int)grid->z_cells)};

    json_object_set_new(object, "F33", LamRangeToJSON(&F33, 1));
    json_object_set_new(object, "F33_intervals", json_integer(grid->z_cells));
  }
  if (!LamGridHasColumns(grid)) {
    json_object_set_new(object, "turgor", json_real(grid->turgor * MPa));
    return object;
  }
  suction = (LamRange){LamGridSuction(grid, 0), LamGridSuction(grid, LAM_ROOT * grid->tau_cells)};
  for (PetscInt m = 0; m < LamFreeCellStates(&grid->free); m++) LamRangeWiden(&strain, grid->free.strain[m]);
  if (grid->contact) json_object_set_new(object, "cohesion", json_real(grid->cohesion * MPa));
  json_object_set_new(object, "suction", LamRangeToJSON(&suction, MPa));
  json_object_set_new(object, "suction_intervals", json_integer(grid->tau_cells));
  json_object_set_new(object, "free_cell_strain", LamRangeToJSON(&strain, 1));
  return object;
}

PetscErrorCode LamTableDescribe(LamTable table, PetscReal MPa, json_t **object)
{
  const LamRange nothing = {PETSC_INFINITY, PETSC_NINFINITY};
  Census c = {.strain = nothing, .suction = nothing};

  PetscFunctionBeginUser;
  CountNodes(table, &c);
  CountCells(table, &c);
  *object = json_pack("{s:I, s:I, s:o, s:o, s:o, s:o}", "nodes", (json_int_t)table->state_count, "places",
                      (json_int_t)table->node_count, "nodes_by_level", Levels(table, c.nodes), "cells_by_level",
                      Levels(table, c.complete), "mixed_cells_by_level", Levels(table, c.mixed), "lattice_strain",
                      LamRangeToJSON(&c.strain, 1));
  if (LamGridHasColumns(table->grid)) json_object_set_new(*object, "suction", LamRangeToJSON(&c.suction, MPa));
  json_object_set_new(*object, "flags",
                      json_pack("{s:I, s:I, s:I, s:I}", "unstable", (json_int_t)c.unstable, "other_branch",
                                (json_int_t)c.other_branch, "failed", (json_int_t)c.failed, "floating",
                                (json_int_t)c.floating));
  json_object_set_new(*object, "free_cell_states", json_integer(c.free_cell));
  json_object_set_new(*object, "grid", GridToJSON(table->grid, MPa));
  PetscFunctionReturn(0);
}
