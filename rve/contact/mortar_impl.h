/* Shared by the files of the mortar kernel: quadratic edges and small vectors. */
#ifndef LAM_RVE_MORTAR_IMPL_H
#define LAM_RVE_MORTAR_IMPL_H

#include "mortar.h"

#define LAM_SHORT_SEGMENT 1e-11 /* fraction of an edge; shorter segments are dropped */

static inline PetscReal LamDot(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[0] + a[1] * b[1];
}

static inline void LamEdgeShape(PetscReal xi, PetscReal N[3], PetscReal dN[3])
{
  N[0] = 0.5 * xi * (xi - 1.0);
  N[1] = 1.0 - xi * xi;
  N[2] = 0.5 * xi * (xi + 1.0);
  dN[0] = xi - 0.5;
  dN[1] = -2.0 * xi;
  dN[2] = xi + 0.5;
}

/* sum_a N_a x_a over the nodes of one edge. */
static inline void LamEdgeSum(const PetscReal x[][2], const PetscReal N[3], PetscReal sum[2])
{
  for (PetscInt d = 0; d < 2; ++d) sum[d] = N[0] * x[0][d] + N[1] * x[1][d] + N[2] * x[2][d];
}

/* dx/dxi of one edge at xi. */
static inline void LamEdgeTangent(const PetscReal x[][2], PetscReal xi, PetscReal tangent[2])
{
  PetscReal N[3], dN[3];

  LamEdgeShape(xi, N, dN);
  LamEdgeSum(x, dN, tangent);
}

/* d2x/dxi2 of one edge. */
static inline void LamEdgeCurvature(const PetscReal x[][2], PetscReal curvature[2])
{
  for (PetscInt d = 0; d < 2; ++d) curvature[d] = x[0][d] - 2.0 * x[1][d] + x[2][d];
}

#endif
