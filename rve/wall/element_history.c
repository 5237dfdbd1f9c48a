/* The history of walls with memory in an element: what it adds to the results of element.c and element_fields.c, whose
   code is that of walls without one. */
#include "element_points.h"

LAM_CLONES static PetscReal HistoryEnergy(const LamElementGeometry *geometry, const LamPoints *history,
                                          const PetscReal u[][2], PetscReal F33)
{
  LamPoints H[4], E[4], energy;

  Gradient(geometry, u, H);
  GreenStrain(H, F33 - 1.0, E);
  LAM_EACH_POINT(g)
  {
    energy[g] = geometry->weight[g] * (history[0][g] * E[0][g] + 2.0 * history[1][g] * E[1][g] +
                                       history[2][g] * E[2][g] + history[3][g] * E[3][g]);
  }
  return Total(energy);
}

PetscReal LamHistoryEnergy(const LamElementGeometry *geometry, const LamPoints *history, const PetscReal u[][2],
                           PetscReal F33)
{
  return HistoryEnergy(geometry, history, u, F33);
}

/* f += w F history dN, and with K NULL or [node][node] K += w dN.history dN. */
LAM_CLONES static void AddHistoryNodes(const LamElementGeometry *geometry, const LamPoints *history,
                                       const PetscReal u[][2], PetscReal f[LAM_ELEMENT_DOFS],
                                       PetscReal K[LAM_ELEMENT_NODES][LAM_PADDED_NODES])
{
  PetscReal sum[2][LAM_PADDED_NODES] = {{0.0}};
  LamPoints H[4], F[4];

  Gradient(geometry, u, H);
  Deformation(H, F);
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal *dX = geometry->dN[2 * g], *dY = geometry->dN[2 * g + 1], w = geometry->weight[g];
    PetscReal X[LAM_PADDED_NODES], Y[LAM_PADDED_NODES]; /* w history dN */

    for (PetscInt a = 0; a < LAM_PADDED_NODES; ++a) {
      X[a] = w * (history[0][g] * dX[a] + history[1][g] * dY[a]);
      Y[a] = w * (history[1][g] * dX[a] + history[2][g] * dY[a]);
      for (PetscInt i = 0; i < 2; ++i) sum[i][a] += F[2 * i][g] * X[a] + F[2 * i + 1][g] * Y[a];
    }
    for (PetscInt a = 0; K && a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt b = 0; b < LAM_PADDED_NODES; ++b) K[a][b] += dX[a] * X[b] + dY[a] * Y[b];
  }
  for (PetscInt d = 0; d < LAM_ELEMENT_DOFS; ++d) f[d] += sum[d % 2][d / 2];
}

void LamHistoryForces(const LamElementGeometry *geometry, const LamPoints *history, const PetscReal u[][2],
                      PetscReal f[LAM_ELEMENT_DOFS])
{
  AddHistoryNodes(geometry, history, u, f, NULL);
}

void LamHistoryEvaluate(const LamElementGeometry *geometry, const LamPoints *history, const PetscReal u[][2],
                        PetscReal F33, LamElementResult *out)
{
  PetscReal K[LAM_ELEMENT_NODES][LAM_PADDED_NODES] = {{0.0}};

  out->energy += HistoryEnergy(geometry, history, u, F33);
  AddHistoryNodes(geometry, history, u, out->f, K);
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt b = 0; b < LAM_ELEMENT_NODES; ++b)
      for (PetscInt i = 0; i < 2; ++i) out->K[2 * a + i][2 * b + i] += K[a][b];
}

void LamHistoryStretch33(const LamElementGeometry *geometry, const LamPoints *history, PetscReal F33, PetscReal *force,
                         PetscReal *ff)
{
  LamPoints second;

  LAM_EACH_POINT(g) second[g] = geometry->weight[g] * history[3][g];
  *ff += Total(second);
  *force += F33 * Total(second);
}

void LamHistoryPoints(const LamElementGeometry *geometry, const LamPoints *history, const LamPoints F[4],
                      PointStress *out)
{
  for (PetscInt r = 0; r < 4; ++r) {
    const PetscInt row = r - r % 2;
    const PetscReal *S[2] = {history[r % 2], history[1 + r % 2]}; /* history 1J and 2J */

    LAM_EACH_POINT(g) out->P[r][g] += geometry->weight[g] * (F[row][g] * S[0][g] + F[row + 1][g] * S[1][g]);
    for (PetscInt c = r; c < row + 2; ++c) LAM_EACH_POINT(g) out->A[r][c][g] += geometry->weight[g] * S[c % 2][g];
  }
}
