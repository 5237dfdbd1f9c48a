/*
  Private to the table: nodes with what they add to the coarser levels, cells, and the sum at a point.

  Method
    Phi is a sum over levels. On level l the nodes whose own level is l carry their data less the sum of the coarser
  levels there (surplus), all other corners of a cell nothing, so each level's part, and with it the sum, is
  continuously differentiable whatever nodes there are (hermite_cell.h), and at nodes value, gradient and Hessian are
  those of the solve. A pure second derivative of the coarser sum jumps across the faces of coarse cells: a node has its
  surplus on either side. Along suction each node is a column: between two of its states the value is a quintic in tau,
  the gradient a cubic, second derivatives a blend, so all of them are continuously differentiable in tau, whatever
  states other columns have. A state that is missing at the end of a root interval adds nothing on finer levels. A cell
  answers where all its eight columns have states on both sides; the finest such cell gives the error estimate.
*/
#ifndef LAM_TABLE_H
#define LAM_TABLE_H

#include <lamella/database.h>
#include <jansson.h>
#include "grid.h"
#include "hermite_cell.h"
#include "node_data.h"
#include <pthread.h>
#include <stdatomic.h>

/* One solved state: what it adds. */
typedef struct {
  int j;
  PetscBool good;     /* converged, stable, branch 0 */
  PetscBool has_data; /* else the rest is nothing */
  PetscInt data;      /* in source->data */
  LamJet phi;         /* pure second derivatives: on the side of larger strain; NaN: not known */
  PetscReal minus[3]; /* the same on the other side */
  PetscReal tau1, tau2, gradient_tau[3];
  PetscReal tau2_minus;                     /* on the side of smaller suction */
  PetscReal hessian_tau[6], minus_tau[3];   /* of differences along the column, 0 where there is no other state */
  PetscBool alone;                          /* there is none */
  PetscReal turgor1, turgor2;               /* dPhi/dp at fixed s, d2Phi/dp2 */
  PetscReal turgor_gradient[3], turgor_tau; /* of the first */
} LamTableState;

/* What is there of a node's states: nothing; all but mixed third derivatives and slopes along suction; all. */
enum { LAM_NODE_RAW, LAM_NODE_SUBTRACTED, LAM_NODE_MADE };

typedef struct {
  int i[3];
  int level;
  PetscInt first, count; /* states, ascending in j */
  atomic_int stage;
} LamTableNode;

enum { LAM_NODE_MISSING = -1, LAM_NODE_FLOATING = -2 };

/* Of cells there are no lists: whoever needs one finds its corners among the nodes. */
typedef struct {
  int level, i[3]; /* corner of least strains */
  PetscInt node[8];
  unsigned char order[8]; /* how the axes of the corner's node lie: axis k is axis LamAxisOrder[order][k] of the node */
} LamTableCell;

extern const int LamAxisOrder[6][3];

/* Open addressing: place of an item in its array, by its coordinates. */
typedef struct {
  PetscInt64 *keys;
  PetscInt *items;
  size_t size; /* power of 2 */
} LamPlaceMap;

struct LamTable_s {
  atomic_int references;
  const LamNodeSet *source; /* borrowed; its array may move while no query is under way */
  struct LamGrid_s *grid;   /* borrowed */
  PetscBool uniform;        /* all cells are alike */
  PetscInt state_count, node_count;
  PetscInt *data;        /* [state_count] in source->data */
  LamTableState *states; /* written under the lock; read where the stage of their node is LAM_NODE_MADE */
  LamTableNode *nodes;   /* ascending in level */
  LamPlaceMap node_map;
  pthread_mutex_t lock;
  int levels;          /* one more than the finest of the nodes */
  PetscInt *free_data; /* [grid->free.n] in source->data, -1: not there */
};

/* A point in the grid's coordinates, with its axes sorted where the grid is symmetric. */
typedef struct {
  PetscReal u[3];   /* in units of the finest level */
  int axis[3];      /* axis k here is lattice direction axis[k] */
  PetscReal tau, v; /* v: along tau, in units */
  int root;         /* first j of its root interval */
  PetscReal step;   /* d: turgor beyond that of the grid at this suction */
  PetscReal s;
} LamTablePoint;

/* The sum of the levels, in the point's axes; derivatives with respect to the grid's coordinates y and tau. */
typedef struct {
  LamJet phi; /* Phi + d Phi_p + d^2 Phi_pp / 2 */
  PetscReal tau1, tau2, gradient_tau[3];
  LamJet turgor1; /* its derivative in d: value and gradient */
  PetscReal turgor1_tau, turgor2;
  /*
    What the estimate is made of, components of the gradient: sizes over the finest complete cell of what bubbles add
    and of how much the slopes turn (LamHermiteSizes, of what its level adds), and over the cells of all levels, between
    two states of their columns, of the cubic along tau less the line.
  */
  PetscReal bend[3], turn[3], bump[3];
} LamTableSum;

/* ---- table_make.c ---- */
/* A table of the nodes that `source` has now; source and grid must outlive it. */
PetscErrorCode LamTableMake(const LamNodeSet *source, LamGrid grid, PetscBool uniform, LamTable *table);
LamTable LamTableReference(LamTable table); /* one more reference */

/* ---- table_map.c ---- */
PetscErrorCode LamPlaceMapCreate(PetscInt n, LamPlaceMap *map);
PetscErrorCode LamPlaceMapDestroy(LamPlaceMap *map);
void LamPlaceMapSet(LamPlaceMap *map, PetscInt64 key, PetscInt item); /* key must be new */

static inline size_t LamPlaceMapSlot(const LamPlaceMap *map, PetscInt64 key)
{
  const uint64_t h = (uint64_t)key * 0x9E3779B97F4A7C15u; /* 2^64 over the golden ratio */

  return (size_t)(h >> 20) & (map->size - 1);
}

/* -1: not there. */
static inline PetscInt LamPlaceMapGet(const LamPlaceMap *map, PetscInt64 key)
{
  for (size_t k = LamPlaceMapSlot(map, key);; k = (k + 1) & (map->size - 1))
    if (map->items[k] < 0 || map->keys[k] == key) return map->items[k];
}

static inline PetscInt64 LamPlaceMapKey(const int i[3])
{
  PetscInt64 key = 0;

  for (int k = 0; k < 3; k++) key = (key << 15) | (PetscInt64)(i[k] + LAM_GRID_REACH);
  return key;
}

/* ---- table_state.c ---- */
/* Phi and its derivatives of a record; `data`: its number in database->nodes. */
void LamTableMakeState(const struct LamGrid_s *grid, const LamNodeData *r, PetscInt data, LamTableState *state);

/* ---- table_surplus.c ---- */
/* Brings node n to LAM_NODE_MADE. From any thread. */
void LamTableMakeNode(LamTable table, PetscInt n);

/* The states of a node, ascending in j, made where they are not yet. */
static inline const LamTableState *LamTableStates(LamTable table, const LamTableNode *node)
{
  if (atomic_load_explicit(&node->stage, memory_order_acquire) != LAM_NODE_MADE)
    LamTableMakeNode(table, (PetscInt)(node - table->nodes));
  return &table->states[node->first];
}

/* ---- table_cell.c ---- */
/* Sorts i ascending where directions are alike. Returns the entry of LamAxisOrder that says where each axis went. */
int LamTableSortAxes(PetscBool symmetric, const int i[3], int sorted[3]);
/* Fills the cell with its corner of least strains at i (sorted). NULL where no node of its own level touches it. */
const LamTableCell *LamTableCellAt(LamTable table, int level, const int i[3], LamTableCell *cell);
/* The same for the cell of a level that holds the point. */
const LamTableCell *LamTableFindCell(LamTable table, const LamTablePoint *point, int level, LamTableCell *cell);

/* ---- table_sum.c ---- */
/* Whether all corners have states on both sides of the point, or are known to float. *good: all of them are. */
PetscBool LamTableCellIsComplete(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool *good);
/* The states of a node's column on either side of the point; NULL: missing. */
void LamTableBracket(LamTable table, const LamTableNode *node, const LamTablePoint *point,
                     const LamTableState *ends[2]);
/* Whether what a column is at the point rests on an end of its bracket: not where the other end has its suction. */
static inline PetscBool LamTableRestsOn(const LamTableState *const ends[2], int e, const LamTablePoint *point)
{
  const LamTableState *other = ends[1 - e];

  return (PetscBool)(!other || other == ends[e] || other->j != point->v);
}
/* Of the corners whose own level is the cell's: those without states, weighed as by linear interpolation, 0 to 1. */
PetscReal LamTableMissingShare(LamTable table, const LamTableCell *cell, const LamTablePoint *point);
/* Adds a cell's part; `estimate`: writes bend and turn. */
void LamTableAddCell(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool estimate,
                     LamTableSum *sum);

/* Adds what cells are that touch no one. */
void LamTableAddFloating(LamTable table, const LamTablePoint *point, LamTableSum *sum);

/* ---- table_indicators.c ---- */
/* P33, its row and column of the tangent and its pressure derivatives. cell NULL: the cells float. */
void LamTableThickness(LamTable table, const LamTablePoint *point, const LamTableCell *cell,
                       const LamLatticeState *lattice, LamResponse *r);
void LamTableIndicators(LamTable table, const LamTablePoint *point, const LamTableCell *cell, LamResponse *r);

/* ---- table_info.c ---- */
/* The member `table` of what `info` tells; MPa: C1 + C2 in MPa. The caller owns it. */
PetscErrorCode LamTableDescribe(LamTable table, PetscReal MPa, json_t **object);

#endif
