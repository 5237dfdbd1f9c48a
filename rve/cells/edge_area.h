/*
  Area between one quadratic edge and the origin, nodes 0 (start), 1 (middle), 2 (end): 1/2 sum_{a<b} D_ab x_a x x_b.
  The sum over the edges of a closed loop is the enclosed area. Positions x enter quadratically, so the Hessian is
  constant. edge: three local nodes of an element, counter-clockwise around the area.
*/
#ifndef LAM_RVE_EDGE_AREA_H
#define LAM_RVE_EDGE_AREA_H

#include "element.h"

static const PetscReal lam_edge_area[3][3] = {
    {0.0, 4.0 / 3.0, -1.0 / 3.0}, {-4.0 / 3.0, 0.0, 4.0 / 3.0}, {1.0 / 3.0, -4.0 / 3.0, 0.0}};

static inline PetscReal LamEdgeArea(const PetscInt edge[3], const PetscReal x[LAM_ELEMENT_NODES][2])
{
  PetscReal area = 0.0;

  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt b = a + 1; b < 3; ++b) {
      const PetscReal *xa = x[edge[a]], *xb = x[edge[b]];

      area += 0.5 * lam_edge_area[a][b] * (xa[0] * xb[1] - xa[1] * xb[0]);
    }
  return area;
}

/* Adds factor * d(area)/dx and, if K is not NULL, factor * d2(area)/dxdx. */
static inline void LamAddEdgeArea(const PetscInt edge[3], const PetscReal x[LAM_ELEMENT_NODES][2], PetscReal factor,
                                  PetscReal f[LAM_ELEMENT_DOFS], PetscReal K[LAM_ELEMENT_DOFS][LAM_ELEMENT_DOFS])
{
  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt b = 0; b < 3; ++b) {
      const PetscInt na = edge[a], nb = edge[b];
      const PetscReal c = 0.5 * factor * lam_edge_area[a][b];

      f[2 * na] += c * x[nb][1];
      f[2 * na + 1] -= c * x[nb][0];
      if (K) {
        K[2 * na][2 * nb + 1] += c;
        K[2 * nb + 1][2 * na] += c;
      }
    }
}

#endif
