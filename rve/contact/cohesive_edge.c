#include "cohesive_edge.h"

/* Gauss's rule on [0, 1]. */
static const PetscReal place[LAM_EDGE_POINTS] = {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155,
                                                 0.953089922969332};
static const PetscReal share[LAM_EDGE_POINTS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                                 0.23931433524968324, 0.11846344252809454};

PetscReal LamEdgePlace(PetscInt q)
{
  return place[q];
}

PetscReal LamEdgeWeight(PetscInt q)
{
  return share[q];
}

void LamBondTake(const LamBondHistory *history, LamBond *bond)
{
  bond->before = *history;
  bond->now = LamEnvelopeOf(&bond->law, history->mode);
  bond->kappa = LamEnvelopeReach(&bond->now, history->integrity);
  bond->pressing = bond->closes || LamBondIsUndamaged(bond) ? bond->law.stiffness : 0.0;
}

LamBondHistory LamBondKeep(const LamBond *bond, const LamJump *jump, const LamCohesiveStep *step)
{
  LamBondHistory history = bond->before;

  if (step->kappa > bond->kappa) history.integrity = LamEnvelopeIntegrity(&bond->now, step->kappa);
  history.mode = LamJumpMode(jump, bond->law.beta, history.mode);
  return history;
}

/* What jump and tangent at a place depend on: z = sum weight[k] x_k. */
static void WeighNodes(PetscReal s, PetscReal weight[LAM_EDGE_NODES][2])
{
  const PetscReal N[3] = {(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)};
  const PetscReal dN[3] = {4.0 * s - 3.0, 4.0 - 8.0 * s, 4.0 * s - 1.0};

  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k) {
    weight[k][0] = k < 3 ? N[k] : -N[k - 3];
    weight[k][1] = 0.5 * dN[k % 3];
  }
}

static void FindJump(const PetscReal X[][2], const PetscReal u[][2], const PetscReal weight[LAM_EDGE_NODES][2],
                     PetscReal beta, LamJump *jump)
{
  PetscReal difference[2] = {0.0}, tangent[2] = {0.0};

  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k)
    for (PetscInt d = 0; d < 2; ++d) {
      difference[d] += weight[k][0] * u[k][d];
      tangent[d] += weight[k][1] * (X[k][d] + u[k][d]);
    }
  LamJumpEvaluate(difference, tangent, beta, jump);
}

void LamEdgeJump(const PetscReal X[][2], const PetscReal u[][2], PetscReal s, PetscReal beta, LamJump *jump)
{
  PetscReal weight[LAM_EDGE_NODES][2];

  WeighNodes(s, weight);
  FindJump(X, u, (const PetscReal(*)[2])weight, beta, jump);
}

static void Evaluate(const PetscReal X[][2], const PetscReal u[][2], const PetscReal weight[LAM_EDGE_NODES][2],
                     const LamBond *bond, LamJump *jump, LamCohesiveStep *step)
{
  FindJump(X, u, weight, bond->law.beta, jump);
  jump->axial = bond->axial;
  jump->q += PetscSqr(bond->law.beta * bond->axial);
  LamCohesiveStepEvaluate(&bond->now, bond->kappa, jump->q, step);
}

void LamEdgePlaceEvaluate(const PetscReal X[][2], const PetscReal u[][2], PetscReal at, const LamBond *bond,
                          LamJump *jump, LamCohesiveStep *step)
{
  PetscReal weight[LAM_EDGE_NODES][2];

  WeighNodes(at, weight);
  Evaluate(X, u, (const PetscReal(*)[2])weight, bond, jump, step);
}

void LamEdgeJumpWeights(PetscInt q, PetscReal jump[LAM_EDGE_NODES])
{
  PetscReal weight[LAM_EDGE_NODES][2];

  WeighNodes(place[q], weight);
  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k) jump[k] = weight[k][0];
}

void LamEdgeSpread(PetscInt q, PetscReal factor, const PetscReal dz[4], PetscReal gradient[LAM_EDGE_DOFS])
{
  PetscReal weight[LAM_EDGE_NODES][2];

  WeighNodes(place[q], weight);
  for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i)
    gradient[i] = factor * (weight[i / 2][0] * dz[i % 2] + weight[i / 2][1] * dz[2 + i % 2]);
}

/* Adds w (phi(q(z)) + 1/2 pressing r(z)) and its derivatives. */
static void AddPoint(const LamJump *jump, const LamCohesiveStep *step, PetscReal pressing, PetscReal w,
                     const PetscReal weight[LAM_EDGE_NODES][2], LamCohesiveSum *sum)
{
  const PetscReal half = 0.5 * pressing;
  PetscReal t[4], H[4][4];

  for (PetscInt a = 0; a < 4; ++a) {
    t[a] = step->d * jump->dq[a] + half * jump->dr[a];
    for (PetscInt b = 0; b < 4; ++b)
      H[a][b] = step->dd * jump->dq[a] * jump->dq[b] + step->d * jump->ddq[a][b] + half * jump->ddr[a][b];
  }
  sum->energy += w * (step->phi + half * jump->r);
  for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) {
    const PetscInt d = i % 2;
    const PetscReal jumping = w * weight[i / 2][0], turning = w * weight[i / 2][1];
    PetscReal row[4];

    sum->f[i] += jumping * t[d] + turning * t[2 + d];
    for (PetscInt b = 0; b < 4; ++b) row[b] = jumping * H[d][b] + turning * H[2 + d][b];
    for (PetscInt j = 0; j < LAM_EDGE_DOFS; ++j)
      sum->K[i][j] += row[j % 2] * weight[j / 2][0] + row[2 + j % 2] * weight[j / 2][1];
  }
}

void LamEdgeAdd(const PetscReal X[][2], const PetscReal u[][2], PetscReal at, PetscReal w, const LamBond *bond,
                PetscBool secant, LamCohesiveSum *sum)
{
  PetscReal weight[LAM_EDGE_NODES][2];
  LamCohesiveStep step;
  LamJump jump;

  WeighNodes(at, weight);
  Evaluate(X, u, (const PetscReal(*)[2])weight, bond, &jump, &step);
  if (secant) step.dd = 0.0;
  AddPoint(&jump, &step, bond->pressing, w, (const PetscReal(*)[2])weight, sum);
}

void LamEdgeEvaluate(const PetscReal X[][2], const PetscReal u[][2], const LamBond bonds[], PetscReal length,
                     PetscBool secant, LamCohesiveSum *sum)
{
  *sum = (LamCohesiveSum){0};
  for (PetscInt q = 0; q < LAM_EDGE_POINTS; ++q) LamEdgeAdd(X, u, place[q], length * share[q], &bonds[q], secant, sum);
}
