/*
  Segment mortar contact of two chains of quadratic edges: geometry, weighted gaps and their first and second variation.
  Independent of cells; all formulas are derived in docs/theory/mortar.md.

  The slave chain has n edges and nodes x[2n+1], the master chain m edges and nodes y[2m+1] (of the image that faces the
  slave). Both loops run counter-clockwise around their own cell, so the chains run in opposite directions. Edge e
  has nodes 2e, 2e+1 (middle), 2e+2. The slave coordinate is s in [0, n].

    gap      gamma(s) = (X(s) - y(eta)).n, y(eta) the closest point, n the normal outward from the master
    hats     phi_A, A = 0..2n, piecewise linear in s with nodes at s = A/2
    weight   D_A = int phi_A J0 ds        weighted gap  G_A = int phi_A gamma J0 ds       over the overlap of the chains
  J0: reference length of a slave edge, so multipliers are nominal pressures.

  Derivatives are with respect to dofs 2 a + component, a = 0..2n slave nodes, then 2n+1.. master nodes.
*/
#ifndef LAM_RVE_MORTAR_H
#define LAM_RVE_MORTAR_H

#include <petscsys.h>

#define LAM_MORTAR_POINTS 4 /* Gauss points of a segment */

typedef struct {
  PetscInt n, m;
  const PetscReal (*x)[2], (*y)[2]; /* [2n+1], [2m+1] current positions; borrowed */
  const PetscReal *J0;              /* [n]; borrowed */
} LamMortarChains;

static inline PetscInt LamMortarDofs(PetscInt n, PetscInt m)
{
  return 2 * (2 * n + 1) + 2 * (2 * m + 1);
}

/* Break points of the integration: half-edges of the slave, planes through master vertices, ends of the overlap. */
typedef struct {
  PetscReal
      *cut; /* [m+1]: s where the plane of a master vertex cuts the slave; n or 0 if the cut lies beyond the end */
  PetscBool *is_cut;    /* [m+1]: the plane cuts the slave, so the break point moves */
  PetscInt count;       /* break points; 0: no overlap */
  PetscReal *s;         /* [count] ascending */
  PetscInt *vertex;     /* [count]: master vertex of a moving break point; -1: fixed */
  PetscInt *master;     /* [count-1]: master edge of each segment */
  PetscReal ramp[2][2]; /* lower, upper end of the overlap: first and second derivative of its ramp */
} LamMortarSegments;

PetscErrorCode LamMortarSegmentsCreate(PetscInt n, PetscInt m, LamMortarSegments *segments);
PetscErrorCode LamMortarSegmentsDestroy(LamMortarSegments *segments);
void LamMortarFindSegments(const LamMortarChains *chains, LamMortarSegments *segments);

typedef struct {
  PetscReal *weight;  /* [2n+1] D */
  PetscReal *gap;     /* [2n+1] G */
  PetscReal *dgap;    /* [2n+1][dofs] dG */
  PetscReal *hessian; /* [dofs][dofs] second derivative of sum_A lambda_A G_A */
} LamMortarResult;

PetscErrorCode LamMortarResultCreate(PetscInt n, PetscInt m, LamMortarResult *result);
PetscErrorCode LamMortarResultDestroy(LamMortarResult *result);
/* lambda [2n+1]: multipliers of the hats. points: Gauss points per segment, 4 or 8. */
void LamMortarEvaluate(const LamMortarChains *chains, const LamMortarSegments *segments, const PetscReal lambda[],
                       PetscInt points, LamMortarResult *result);

/* Gap at s from master edge `edge`, and the closest point there. */
PetscReal LamMortarGap(const LamMortarChains *chains, PetscReal s, PetscInt edge, PetscReal nearest[2]);
/* Distance of the slave point s from master edge `edge`, without extension past the edge's ends. */
PetscReal LamMortarDistance(const LamMortarChains *chains, PetscReal s, PetscInt edge);
/* Position and tangent dX/ds of the slave at s. */
void LamMortarSlavePoint(const LamMortarChains *chains, PetscReal s, PetscReal X[2], PetscReal Xs[2]);

#endif
