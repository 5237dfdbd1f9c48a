/*
  Private to the table: positions of the nodes of a grid.

  A node has integer coordinates i[0..2] on the finest level and, where the grid has columns, j along suction s:
    bonded   x_k = origin + unit i_k,  s = p
    contact  x_k = a(s) + unit i_k,    s = p + g
    s = zero + scale (exp(tau) - 1),   tau = tau_min + tau_unit j
  with a(s) the strain at which free cells touch (free_cell.h). Bonded tissue has columns where its response depends on
  turgor by more than -p J (LamFluidFills), and else the turgor of all its nodes. One unit is 2^-LAM_FINEST of a root
  cell. The level of a node is the coarsest that contains all its i. Where the three directions are equivalent, i is
  sorted, ascending. A grid may also have the axis z = ln F33, with knots z_min + z_step k, k = 0 .. z_cells, not
  refined; a depends on it.
*/
#ifndef LAM_GRID_H
#define LAM_GRID_H

#include <lamella/database.h>
#include "free_cell.h"
#include "lattice_strain.h"

enum { LAM_FINEST = 6, LAM_ROOT = 1 << LAM_FINEST, LAM_GRID_REACH = 8192, LAM_MOST_Z_CELLS = 62 };

struct LamGrid_s {
  PetscBool contact, symmetric, filled; /* filled: LamFluidFills */
  LamLatticeAxes axes;
  PetscReal origin, step; /* step: edge of a root cell */
  PetscReal turgor;       /* of bonded nodes without columns */
  PetscReal turgor_reach; /* largest difference in turgor from the nodes, covered by their derivatives */
  PetscReal cohesion;     /* of contact nodes; their turgor is s - cohesion */
  PetscReal suction_zero, suction_scale, tau_min, tau_step;
  PetscInt tau_cells; /* root intervals along tau; 0: no columns */
  PetscReal z_min, z_step;
  PetscInt z_cells; /* intervals of ln F33; 0: F33 = 1 */
  LamFreeCell free; /* n = 0: none */
  PetscInt64 *free_keys;
};

typedef struct {
  int i[3], j, z; /* z: 1 + knot of ln F33; 0: the grid has no such axis */
} LamNodePlace;

PetscInt64 LamNodeKeyOf(const LamNodePlace *place);
LamNodePlace LamNodePlaceOf(PetscInt64 key);
/* Level of the strains alone; 0: coarsest. */
int LamNodeLevel(const LamNodePlace *place);
/* Whether the place is that of a free cell's state. */
PetscBool LamNodeIsFree(const LamNodePlace *place);
/* Whether cells float at this place, so that it needs no solve. */
PetscBool LamPlaceIsFloating(const struct LamGrid_s *grid, const int i[3]);
/* Whether nodes are columns of states along suction. */
static inline PetscBool LamGridHasColumns(const struct LamGrid_s *grid)
{
  return (PetscBool)(grid->tau_cells > 0);
}
static inline PetscReal LamGridSuctionOf(const struct LamGrid_s *grid, PetscReal turgor, PetscReal cohesion)
{
  return grid->contact ? turgor + cohesion : turgor;
}
static inline PetscReal LamGridTau(const struct LamGrid_s *grid, PetscReal s)
{
  return log1p((s - grid->suction_zero) / grid->suction_scale);
}
static inline PetscReal LamGridSuctionAt(const struct LamGrid_s *grid, PetscReal tau)
{
  return grid->suction_zero + grid->suction_scale * expm1(tau);
}
static inline PetscReal LamGridSuction(const struct LamGrid_s *grid, PetscInt j)
{
  return LamGridSuctionAt(grid, grid->tau_min + grid->tau_step * (PetscReal)j / LAM_ROOT);
}
/* ds/dtau = d2s/dtau2. */
static inline PetscReal LamGridSuctionRate(const struct LamGrid_s *grid, PetscReal s)
{
  return s - grid->suction_zero + grid->suction_scale;
}
/*
  The difference of a load's turgor from that of the nodes at its suction, which their derivatives in turgor bridge:
  bonded p - p0, contact g0 - g (suction is that of the load, and so p - (s - g0)), with columns of turgor 0.
*/
static inline PetscReal LamGridTurgorStep(const struct LamGrid_s *grid, PetscReal turgor, PetscReal cohesion)
{
  return grid->contact ? grid->cohesion - cohesion : LamGridHasColumns(grid) ? 0 : turgor - grid->turgor;
}
/* a(s) and its derivatives, 0 without free cells: a, a_s, a_ss, a_z, a_zz, a_sz; w: knot of ln F33, from 0 on. */
static inline void LamGridFreeStrain(const struct LamGrid_s *grid, PetscReal s, PetscReal w, PetscReal strain[6])
{
  for (int k = 0; k < 6; k++) strain[k] = 0;
  if (!grid->free.n) return;
  if (grid->z_cells)
    LamFreeCellStrains(&grid->free, s, w, strain);
  else
    LamFreeCellStrain(&grid->free, s, strain);
}
static inline PetscReal LamGridF33(const struct LamGrid_s *grid, int z)
{
  return z ? exp(grid->z_min + grid->z_step * (PetscReal)(z - 1)) : 1;
}

#endif
