/*
  Creation of a table from the records whose keys are nodes, sorted by level, place, F33 and suction. The surplus of a
  node is computed when a cell first needs it (table_surplus.c), so that a table of a million nodes is available at
  once.
*/
#include "table.h"
#include <stdlib.h>
#include <string.h>

/* ---- nodes ---- */

typedef struct {
  PetscInt64 key;
  PetscInt data;
  int level, z;
} Entry;

/* The key without z, so that the states of a place follow one another. */
static PetscInt64 PlaceKey(const Entry *entry)
{
  return entry->key - ((PetscInt64)entry->z << 54);
}

static int CompareEntries(const void *first, const void *second)
{
  const Entry *a = first, *b = second;
  const PetscInt64 i = PlaceKey(a) >> 12, k = PlaceKey(b) >> 12; /* j is left out */

  if (a->level != b->level) return a->level - b->level;
  if (i != k) return i < k ? -1 : 1;
  if (a->key != b->key) return a->key < b->key ? -1 : 1;
  return a->data < b->data ? -1 : a->data > b->data;
}

/* Other places are skipped: they come from damaged files. */
static PetscBool IsPlace(const struct LamGrid_s *grid, const LamNodePlace *place)
{
  const int *i = place->i, reach = LAM_GRID_REACH - 2 * LAM_ROOT;

  for (int k = 0; k < 3; k++)
    if (i[k] < -reach || i[k] > reach) return PETSC_FALSE;
  if (grid->symmetric && (i[0] > i[1] || i[1] > i[2])) return PETSC_FALSE;
  if (grid->z_cells ? place->z < 1 || place->z > grid->z_cells + 1 : place->z != 0) return PETSC_FALSE;
  return (PetscBool)(place->j <= LAM_ROOT * grid->tau_cells && !LamPlaceIsFloating(grid, i));
}

static PetscErrorCode CollectEntries(LamTable table, PetscInt *n, Entry **entries)
{
  const LamNodeSet *source = table->source;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(source->count + 1, entries));
  *n = 0;
  for (PetscInt d = 0; d < source->count; d++) {
    const LamNodePlace place = LamNodePlaceOf(source->data[d].key);

    if (!LamNodeIsFree(&place)) {
      if (IsPlace(table->grid, &place))
        (*entries)[(*n)++] = (Entry){source->data[d].key, d, LamNodeLevel(&place), place.z};
      continue;
    }
    for (PetscInt m = 0; m < LamFreeCellStates(&table->grid->free); m++)
      if (table->grid->free_keys[m] == source->data[d].key) table->free_data[m] = d;
  }
  qsort(*entries, (size_t)*n, sizeof(Entry), CompareEntries);
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeNodes(LamTable table)
{
  LamTableNode *node = NULL;
  Entry *entries;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(CollectEntries(table, &n, &entries));
  PetscCall(PetscMalloc1(n + 1, &table->states));
  if (table->grid->z_cells) PetscCall(PetscMalloc1(n + 1, &table->axial));
  PetscCall(PetscMalloc1(n + 1, &table->nodes));
  PetscCall(PetscMalloc1(n + 1, &table->data));
  PetscCall(LamPlaceMapCreate((size_t)n, &table->node_map));
  for (PetscInt e = 0; e < n; e++) {
    const LamNodePlace place = LamNodePlaceOf(entries[e].key);

    if (e && entries[e].key == entries[e - 1].key) continue; /* solved twice: keep the first */
    if (!node || memcmp(node->i, place.i, sizeof(place.i)) != 0) {
      node = &table->nodes[table->node_count];
      memset(node, 0, sizeof(*node));
      memcpy(node->i, place.i, sizeof(place.i));
      node->level = entries[e].level;
      node->first = table->state_count;
      atomic_init(&node->stage, LAM_NODE_RAW);
      PetscCall(LamPlaceMapSet(&table->node_map, LamPlaceMapKey(place.i), table->node_count++));
    }
    table->data[table->state_count++] = entries[e].data;
    node->count++;
  }
  if (node) table->levels = node->level + 1; /* the last node is of the finest level */
  PetscCall(PetscFree(entries));
  PetscFunctionReturn(0);
}

/* ---- the table ---- */

PetscErrorCode LamTableMake(const LamNodeSet *source, LamGrid grid, const LamMicrostructure *micro, LamTable *table)
{
  LamTable t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->references = 1;
  t->source = source;
  t->grid = grid;
  t->uniform = (PetscBool)!micro->cell;
  t->scale = LamStressScaleOf(micro);
  PetscCall(PetscMalloc1(LamFreeCellStates(&t->grid->free) + 1, &t->free_data));
  for (PetscInt m = 0; m < LamFreeCellStates(&t->grid->free); m++) t->free_data[m] = -1;
  /* recursive, because computing a node computes nodes of coarser levels */
  PetscCheck(mtx_init(&t->lock, mtx_plain | mtx_recursive) == thrd_success, PETSC_COMM_SELF, PETSC_ERR_SYS,
             "the lock of a table cannot be made");
  PetscCall(MakeNodes(t));
  *table = t;
  PetscFunctionReturn(0);
}

/* Thread-safe. */
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
  mtx_destroy(&t->lock);
  PetscCall(PetscFree(t->states));
  PetscCall(PetscFree(t->axial));
  PetscCall(PetscFree(t->nodes));
  PetscCall(PetscFree(t->data));
  PetscCall(PetscFree(t->free_data));
  PetscCall(PetscFree(t));
  PetscFunctionReturn(0);
}
