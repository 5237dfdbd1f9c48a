/*
  Private to the table: positions of the nodes of a grid.

  A node has integer coordinates i[0..2] on the finest level and, for contact tissue, j along suction:
    bonded   x_k = origin + unit i_k
    contact  x_k = a(s) + unit i_k,  s = scale (exp(tau) - 1),  tau = tau_min + tau_unit j
  with a(s) the strain at which free cells touch (free_cell.h). One unit is 2^-LAM_FINEST of a root cell. The level of a
  node is the coarsest that contains all its i. Where the three directions are equivalent, i is sorted, ascending.
  A grid may also have the axis z = ln F33, with knots z_min + z_step k, k = 0 .. z_cells, not refined; a depends on it.
*/
#ifndef LAM_GRID_H
#define LAM_GRID_H

#include <lamella/database.h>
#include "free_cell.h"
#include "lattice_strain.h"

enum { LAM_FINEST = 6, LAM_ROOT = 1 << LAM_FINEST, LAM_GRID_REACH = 8192, LAM_MOST_Z_CELLS = 62 };

struct LamGrid_s {
  PetscBool contact, symmetric;
  LamLatticeAxes axes;
  PetscReal origin, step; /* step: edge of a root cell */
  PetscReal turgor;       /* of bonded nodes */
  PetscReal turgor_reach; /* largest difference in turgor from the nodes, covered by their derivatives */
  PetscReal cohesion;     /* of contact nodes; their turgor is s - cohesion */
  PetscReal suction_scale, tau_min, tau_step;
  PetscInt tau_cells; /* root intervals along tau; 0: bonded */
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
static inline PetscReal LamGridTau(const struct LamGrid_s *grid, PetscReal s)
{
  return log1p(s / grid->suction_scale);
}
static inline PetscReal LamGridSuction(const struct LamGrid_s *grid, PetscInt j)
{
  return grid->suction_scale * expm1(grid->tau_min + grid->tau_step * (PetscReal)j / LAM_ROOT);
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
