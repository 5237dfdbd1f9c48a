/*
  Private to the table: nodes with their surpluses over the coarser levels, cells, and the sum at a point.

  Method
    Phi is a sum over levels. On level l the nodes whose own level is l carry their surplus: their data minus the sum of
  the coarser levels there. All other corners of a cell carry 0. So each level's part, and the sum, is continuously
  differentiable for any set of nodes (hermite_cell.h), and at nodes value, gradient and Hessian are those of the solve.
  A pure second derivative of the coarser sum jumps across the faces of coarse cells: a node stores its surplus on both
  sides. Along suction each node is a column of states. Between two states the value is a quintic in tau, the gradient a
  cubic, the second derivatives a blend. All are continuously differentiable in tau, independently of the states of
  other columns. A missing state at the end of a root interval counts as 0 on finer levels. A cell is complete where all
  eight columns have states on both sides; the finest complete cell gives the error estimate.
  With the axis z = ln F33 a node is a sheet: a line of states along suction (bonded: one state) at each of some knots
  of z. Lines are columns; between two of them Phi is interpolated along z as along suction, from dPhi/dz and d2Phi/dz2.
*/
#ifndef LAM_TABLE_H
#define LAM_TABLE_H

#include <lamella/database.h>
#include <jansson.h>
#include "grid.h"
#include "hermite_cell.h"
#include "node_data.h"
#include <stdatomic.h>
#include <threads.h>

/* The surplus of one solved state. */
typedef struct {
  int j, z;           /* as in LamNodePlace */
  PetscBool good;     /* converged, stable, branch 0 */
  PetscBool has_data; /* else all numbers below but `data` are 0 */
  PetscInt data;      /* index in source->data */
  LamJet phi;         /* pure second derivatives: on the side of larger strain; NaN: unknown */
  PetscReal minus[3]; /* pure second derivatives on the other side */
  PetscReal tau1, tau2, gradient_tau[3];
  PetscReal tau2_minus;                     /* on the side of smaller suction */
  PetscReal hessian_tau[6], minus_tau[3];   /* from differences along the column; 0 if it has no other state */
  PetscBool alone;                          /* the column has no other state */
  PetscReal turgor1, turgor2;               /* dPhi/dp at fixed s, d2Phi/dp2 */
  PetscReal turgor_gradient[3], turgor_tau; /* derivatives of turgor1 */
} LamTableState;

/* Besides, with the axis z = ln F33: derivatives at fixed grid coordinates. */
typedef struct {
  PetscReal first, second, gradient[3];     /* dPhi/dz, d2Phi/dz2 on the side of larger z, d2Phi/dy_k dz */
  PetscReal second_minus;                   /* d2Phi/dz2 on the side of smaller z */
  PetscReal mixed, turgor;                  /* d2Phi/dtau dz, d2Phi/dp dz */
  PetscReal gradient_tau[3], second_tau[2]; /* slopes of gradient, second and second_minus along suction, ... */
  PetscReal hessian[6], minus[3];           /* ... of Phi's second derivatives along z, from differences */
} LamTableAxial;

/* Computed so far of a node's states: nothing; all but mixed third derivatives and slopes along suction; all. */
enum { LAM_NODE_RAW, LAM_NODE_SUBTRACTED, LAM_NODE_MADE };

typedef struct {
  int i[3];
  int level;
  PetscInt first, count; /* states, ascending in z, then j */
  atomic_int stage;
} LamTableNode;

enum { LAM_NODE_MISSING = -1, LAM_NODE_FLOATING = -2 };

/* Cells are not stored: their corners are looked up among the nodes when needed. */
typedef struct {
  int level, i[3]; /* i: corner of least strains */
  PetscInt node[8];
  unsigned char order[8]; /* axis k of the cell is axis LamAxisOrder[order][k] of the corner's node */
} LamTableCell;

extern const int LamAxisOrder[6][3];

/* Hash map with open addressing: index of an item by the key of its place, or another key. */
typedef struct {
  PetscInt64 *keys;
  PetscInt *items;    /* -1: a free slot */
  size_t size, count; /* size: a power of 2 */
} LamPlaceMap;

struct LamTable_s {
  atomic_int references;
  const LamNodeSet *source; /* borrowed; its array may be reallocated between queries */
  struct LamGrid_s *grid;   /* borrowed */
  PetscBool uniform;        /* all cells of the tissue are identical */
  LamStressScale scale;     /* of errors */
  PetscInt state_count, node_count;
  PetscInt *data;        /* [state_count] indices in source->data */
  LamTableState *states; /* written under the lock; valid to read when their node's stage is LAM_NODE_MADE */
  LamTableAxial *axial;  /* [state_count] likewise; NULL: no axis F33 */
  LamTableNode *nodes;   /* ascending in level */
  LamPlaceMap node_map;
  mtx_t lock;
  int levels;          /* finest level of the nodes, plus 1 */
  PetscInt *free_data; /* [LamFreeCellStates] indices in source->data; -1: missing */
};

/* A point in the grid's coordinates, with its axes sorted where the grid is symmetric. */
typedef struct {
  PetscReal u[3];   /* in units of the finest level */
  int axis[3];      /* axis k here is lattice direction axis[k] */
  PetscReal tau, v; /* v: along tau, in units */
  int root;         /* first j of its root interval */
  PetscReal w;      /* along ln F33, in knots from the first */
  int z;            /* that of LamNodePlace, of the knot below; 0: no such axis */
  PetscReal step;   /* d: turgor minus the grid's turgor at this suction */
  PetscReal s;
} LamTablePoint;

/* The sum of the levels, in the point's axes; derivatives with respect to the grid's coordinates y and tau. */
typedef struct {
  LamJet phi; /* Phi + d Phi_p + d^2 Phi_pp / 2 */
  PetscReal tau1, tau2, gradient_tau[3];
  LamJet turgor1; /* derivative of phi in d: value and gradient */
  PetscReal turgor1_tau, turgor2;
  PetscReal z1, z2, tau_z, gradient_z[3], turgor1_z; /* along ln F33 */
  /*
    Input of the error estimate, components of the gradient. bend, spread: LamHermiteSizes of the level's part on the
    finest complete cell. bump: difference between the cubic and the line along tau, between two states of a column;
    root of the sum of squares over the cells of all levels. bump_z: likewise along ln F33.
  */
  PetscReal bend[3], spread[3], bump[3], bump_z[3];
} LamTableSum;

/* ---- table_make.c ---- */
/* Creates a table of the nodes now in `source`, of this tissue; source and grid must outlive it. */
PetscErrorCode LamTableMake(const LamNodeSet *source, LamGrid grid, const LamMicrostructure *micro, LamTable *table);
LamTable LamTableReference(LamTable table); /* adds a reference */

/* For n items at first. */
PetscErrorCode LamPlaceMapCreate(size_t n, LamPlaceMap *map);
PetscErrorCode LamPlaceMapDestroy(LamPlaceMap *map);
PetscErrorCode LamPlaceMapSet(LamPlaceMap *map, PetscInt64 key, PetscInt item); /* key must be new */

static inline size_t LamPlaceMapSlot(const LamPlaceMap *map, PetscInt64 key)
{
  const uint64_t h = (uint64_t)key * 0x9E3779B97F4A7C15u; /* 2^64 over the golden ratio */

  return (size_t)(h >> 20) & (map->size - 1);
}

/* -1: not found. */
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
/* Phi and its derivatives from a record; `data`: its index in the node set; axial: NULL without the axis F33. */
void LamTableMakeState(const struct LamGrid_s *grid, const LamNodeData *r, PetscInt data, LamTableState *state,
                       LamTableAxial *axial);

/* ---- table_surplus.c ---- */
/* Computes node n up to stage LAM_NODE_MADE. Thread-safe. */
void LamTableMakeNode(LamTable table, PetscInt n);

/* The states of a node, ascending in j; computed on first use. */
static inline const LamTableState *LamTableStates(LamTable table, const LamTableNode *node)
{
  if (atomic_load_explicit(&node->stage, memory_order_acquire) != LAM_NODE_MADE)
    LamTableMakeNode(table, (PetscInt)(node - table->nodes));
  return &table->states[node->first];
}

/* ---- table_cell.c ---- */
/* Sorts i ascending if the grid is symmetric. Returns the entry of LamAxisOrder that maps each axis to its rank. */
int LamTableSortAxes(PetscBool symmetric, const int i[3], int sorted[3]);
/* Fills the cell whose corner of least strains is i (sorted). NULL if no corner is a node of the cell's level. */
const LamTableCell *LamTableCellAt(LamTable table, int level, const int i[3], LamTableCell *cell);
/* The same for the cell of a level that contains the point. */
const LamTableCell *LamTableFindCell(LamTable table, const LamTablePoint *point, int level, LamTableCell *cell);

/* ---- table_column.c ---- */
/* Lines of states on both sides of the point: one, or with the axis F33 two. */
static inline int LamTableLines(LamTable table)
{
  return table->grid->z_cells ? 2 : 1;
}
/* The plane of the free cell that goes with a line. */
static inline PetscInt LamTablePlane(const LamTablePoint *point, int line)
{
  return PetscMax(0, point->z - 1) + line;
}
/* The states of a node's column on both sides of the point; NULL: missing. */
void LamTableBracket(LamTable table, const LamTableNode *node, const LamTablePoint *point, int line,
                     const LamTableState *ends[2]);

/* ---- table_sum.c ---- */
/* Whether all corners have states on all sides of the point, or float. *good: all these states are good. */
PetscBool LamTableCellIsComplete(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool *good);
/* Whether a column's value at the point depends on end e of its bracket: not if the other end is at its suction. */
static inline PetscBool LamTableRestsOn(const LamTableState *const ends[2], int e, const LamTablePoint *point)
{
  const LamTableState *other = ends[1 - e];

  return (PetscBool)(!other || other == ends[e] || other->j != point->v);
}
/* Share of corners without states among those of the cell's own level, weighted by linear interpolation, 0 to 1. */
PetscReal LamTableMissingShare(LamTable table, const LamTableCell *cell, const LamTablePoint *point);
/* Adds a cell's part to the sum; `estimate`: also writes bend and spread. */
void LamTableAddCell(LamTable table, const LamTableCell *cell, const LamTablePoint *point, PetscBool estimate,
                     LamTableSum *sum);

/* Adds the free cell's part: the point's cells float. */
void LamTableAddFloating(LamTable table, const LamTablePoint *point, LamTableSum *sum);

/* ---- table_indicators.c ---- */
/* P33, its row and column of the tangent and its derivatives in the pressures. cell NULL: the cells float. */
void LamTableThickness(LamTable table, const LamTablePoint *point, const LamTableCell *cell,
                       const LamLatticeState *lattice, LamResponse *r);
void LamTableIndicators(LamTable table, const LamTablePoint *point, const LamTableCell *cell, LamResponse *r);

/* ---- table_info.c ---- */
/* The member `table` of the output of `info`; MPa: C1 + C2 in MPa. The caller owns it. */
PetscErrorCode LamTableDescribe(LamTable table, PetscReal MPa, json_t **object);

#endif
