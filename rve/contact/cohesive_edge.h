/*
  The lamella on one edge of a wall: the cohesive law (cohesive.h) at the Gauss points between two facing edges.

  With the shape functions N of the three nodes of an edge, at the same reference place of both walls,
    jump = sum N (x_slave - x_master),    tangent = 1/2 sum N' (x_slave + x_master),
  energy, forces and tangent are derivatives of sum_q w_q (phi(q) + 1/2 k r), q and r functions of (jump, tangent).
*/
#ifndef LAM_RVE_COHESIVE_EDGE_H
#define LAM_RVE_COHESIVE_EDGE_H

#include <lamella/response.h>
#include "cohesive.h"

#define LAM_EDGE_POINTS 5 /* Gauss points of an edge (docs/theory/lamella.md, Points) */
#define LAM_EDGE_NODES 6  /* start, middle and end of the slave's, then of the master's at the same places */
#define LAM_EDGE_DOFS (2 * LAM_EDGE_NODES)
#define LAM_EDGE_PAIRS (LAM_EDGE_NODES * (LAM_EDGE_NODES + 1) / 2)

/* Place in [0, 1] of point q, and its share of the edge's length. */
PetscReal LamEdgePlace(PetscInt q);
PetscReal LamEdgeWeight(PetscInt q);

/* History of a point. */
typedef struct {
  PetscReal integrity; /* omega: 1 undamaged, 0 broken */
  PetscReal mode;      /* B; negative: it has never been open */
} LamBondHistory;
#define LAM_UNDAMAGED ((LamBondHistory){.integrity = 1.0, .mode = -1.0})

/* A point in a step. */
typedef struct {
  LamCohesive law;
  LamBondHistory before; /* at the start of the step, with ... */
  LamEnvelope now;       /* ... its envelope, ... */
  PetscReal kappa;       /* ... its kappa, ... */
  PetscReal pressing;    /* ... and its stiffness in compression, ... */
  PetscBool closes;      /* ... which damage leaves */
  PetscReal axial;       /* slip along the cells' axis (antiplane.h) */
} LamBond;
/* Begins a step. */
void LamBondTake(const LamBondHistory *history, LamBond *bond);
/* Its history at the end, and the energy per area dissipated in it. */
LamBondHistory LamBondKeep(const LamBond *bond, const LamJump *jump, const LamCohesiveStep *step);
static inline PetscReal LamBondSpent(const LamBond *bond, const LamCohesiveStep *step)
{
  return LamEnvelopeSpent(&bond->now, step->kappa) - LamEnvelopeSpent(&bond->now, bond->kappa);
}

static inline PetscBool LamBondIsUndamaged(const LamBond *bond)
{
  return (PetscBool)(bond->before.integrity >= 1.0 && bond->now.strength > 0.0);
}

/* Whether so much is spent at `kappa` that the point counts as broken. */
static inline PetscBool LamBondIsBroken(const LamBond *bond, PetscReal kappa)
{
  return (PetscBool)(LamEnvelopeSpent(&bond->now, kappa) >= LAM_BROKEN * bond->now.energy);
}

/* Traction, nominal, normal to the middle between the walls and along it, for a secant stiffness omega k. */
static inline void LamBondTraction(const LamBond *bond, const LamJump *jump, PetscReal secant, PetscReal t[2])
{
  t[0] = (jump->normal > 0.0 ? secant : bond->pressing) * jump->normal;
  t[1] = secant * bond->law.beta * bond->law.beta * jump->shear;
}

/* Reference positions X and displacements u of the nodes; the jump is that of the displacements. */
void LamEdgePlaceEvaluate(const PetscReal X[][2], const PetscReal u[][2], PetscReal place, const LamBond *bond,
                          LamJump *jump, LamCohesiveStep *step);
static inline void LamEdgePointEvaluate(const PetscReal X[][2], const PetscReal u[][2], PetscInt q, const LamBond *bond,
                                        LamJump *jump, LamCohesiveStep *step)
{
  LamEdgePlaceEvaluate(X, u, LamEdgePlace(q), bond, jump, step);
}

/* The jump alone, at a place s in [0, 1] of the edge. */
void LamEdgeJump(const PetscReal X[][2], const PetscReal u[][2], PetscReal s, PetscReal beta, LamJump *jump);

/* Shape functions of a jump at point q: jump = sum weight[k] x_k. */
void LamEdgeJumpWeights(PetscInt q, PetscReal weight[LAM_EDGE_NODES]);

/* From the derivatives of a function of (jump, tangent) at point q, times a factor, those in the nodes. */
void LamEdgeSpread(PetscInt q, PetscReal factor, const PetscReal dz[4], PetscReal gradient[LAM_EDGE_DOFS]);

typedef struct {
  PetscReal energy, f[LAM_EDGE_DOFS], K[LAM_EDGE_DOFS][LAM_EDGE_DOFS]; /* dof = 2 node + component */
} LamCohesiveSum;
/* Adds the law at a place in [0, 1] with a weight, which is a length; what LamEdgeEvaluate sums over its rule. secant:
   the tangent is that of fixed omega. */
void LamEdgeAdd(const PetscReal X[][2], const PetscReal u[][2], PetscReal place, PetscReal weight, const LamBond *bond,
                PetscBool secant, LamCohesiveSum *sum);
/* bonds [LAM_EDGE_POINTS]; length: reference length of the edge. */
void LamEdgeEvaluate(const PetscReal X[][2], const PetscReal u[][2], const LamBond bonds[], PetscReal length,
                     PetscBool secant, LamCohesiveSum *sum);

#endif
