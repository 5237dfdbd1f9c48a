/*
  Effective stress, tangent and couplings of a converged state.

  Method. Psi(q) = (1/V0) min_y L(y, q) with q = (F11, F12, F21, F22, F33, p). F enters L through the image shifts
  x_a = y + F S_a, through F33 in the walls and in the lumen volume F33 A_lumen; p through -p F33 A_lumen. Then
    dPsi/dq   = L_q / V0,
    d2Psi/dq2 = (L_qq - L_qy K^-1 L_yq) / V0         (static condensation with the factor of the converged state).
  So P_ij = (1/V0) sum_a f_ai S_aj over shifted nodes, f_a the nodal forces of the walls, and the tangent is symmetric
  by construction.
*/
#include "rve_impl.h"

#define NQ 6
#define Q_F33 4
#define Q_TURGOR 5

typedef struct {
  PetscReal Lq[NQ], Lqq[NQ][NQ];
  PetscReal *R; /* [NQ][ndof]: L_yq, one column after the other, the held class included */
} Condensation;

/* F couplings of one element that has shifted nodes. */
static void AddShifted(LamRVE rve, PetscInt e, const LamElementResult *element, const PetscReal fx[LAM_ELEMENT_DOFS],
                       Condensation *c)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt *nodes = &mesh->elements[LAM_ELEMENT_NODES * e];

  for (PetscInt b = 0; b < LAM_ELEMENT_NODES; ++b) {
    const PetscReal *Sb = &mesh->shift[2 * nodes[b]];

    if (Sb[0] == 0.0 && Sb[1] == 0.0) continue;
    for (PetscInt k = 0; k < 2; ++k)
      for (PetscInt l = 0; l < 2; ++l) {
        const PetscInt q = 2 * k + l;
        PetscReal *column = c->R + q * rve->ndof;

        c->Lq[q] += element->f[2 * b + k] * Sb[l];
        c->Lqq[q][Q_F33] += fx[2 * b + k] * Sb[l];
        for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
          const PetscReal *Sa = &mesh->shift[2 * nodes[a]];

          for (PetscInt i = 0; i < 2; ++i) {
            const PetscReal K = element->K[2 * a + i][2 * b + k] * Sb[l];

            column[2 * mesh->node_class[nodes[a]] + i] += K;
            for (PetscInt j = 0; j < 2; ++j) c->Lqq[2 * i + j][q] += K * Sa[j];
          }
        }
      }
  }
}

static void AddElement(LamRVE rve, const LamLoad *load, PetscInt e, Condensation *c)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt *nodes = &mesh->elements[LAM_ELEMENT_NODES * e];
  PetscReal x[LAM_ELEMENT_NODES][2], force33, ff, fx[LAM_ELEMENT_DOFS];

  LamGatherElement(rve, load->F, rve->y, e, x);
  LamElementStretch33(&rve->geometry[e], rve->law, &rve->micro.wall, (const PetscReal(*)[2])x, load->F[8],
                      &rve->stress[e], &force33, fx, &ff);
  c->Lq[Q_F33] += force33;
  c->Lqq[Q_F33][Q_F33] += ff;
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt i = 0; i < 2; ++i) c->R[Q_F33 * rve->ndof + 2 * mesh->node_class[nodes[a]] + i] += fx[2 * a + i];
  if (mesh->has_shift[e]) {
    LamElementResult element;
    PetscBool valid;

    LamElementEvaluate(&rve->geometry[e], rve->law, &rve->micro.wall, (const PetscReal(*)[2])x, load->F[8],
                       &rve->stress[e], &element, &valid);
    AddShifted(rve, e, &element, fx, c);
  }
}

/* Terms of the lumen volume F33 A. */
static void AddLumen(LamRVE rve, const LamLoad *load, Condensation *c)
{
  const PetscReal area = LamLumenArea(rve, rve->y, -load->turgor, c->R + Q_F33 * rve->ndof);

  (void)LamLumenArea(rve, rve->y, -load->F[8], c->R + Q_TURGOR * rve->ndof);
  c->Lq[Q_F33] -= load->turgor * area;
  c->Lq[Q_TURGOR] -= load->F[8] * area;
  c->Lqq[Q_F33][Q_TURGOR] -= area;
}

/* H = (L_qq - R^T K^-1 R) / V0. */
static PetscErrorCode Condense(LamRVE rve, Condensation *c, PetscReal H[NQ][NQ])
{
  const PetscInt n = rve->linear.n;
  PetscReal *R, *X;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(NQ * n, &R, NQ * n, &X));
  for (PetscInt q = 0; q < NQ; ++q) PetscCall(PetscArraycpy(R + q * n, c->R + q * rve->ndof + 2, n));
  PetscCall(LamLinearSolve(&rve->linear, NQ, R, X));
  for (PetscInt q = 0; q < NQ; ++q)
    for (PetscInt r = q; r < NQ; ++r) {
      PetscReal a = 0.0, b = 0.0;

      for (PetscInt i = 0; i < n; ++i) {
        a += R[q * n + i] * X[r * n + i];
        b += R[r * n + i] * X[q * n + i];
      }
      H[q][r] = H[r][q] = (c->Lqq[q][r] - 0.5 * (a + b)) / rve->mesh.V0;
    }
  PetscCall(PetscFree2(R, X));
  PetscFunctionReturn(0);
}

PetscErrorCode LamHomogenise(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  static const PetscInt component[5] = {0, 1, 3, 4, 8}; /* of F11 F12 F21 F22 F33 in row-major 3x3 */
  Condensation c = {0};
  PetscReal H[NQ][NQ], energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(NQ * rve->ndof, &c.R));
  PetscCall(LamAssembleEnergy(rve, load, rve->y, &energy, &valid));
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) AddElement(rve, load, e, &c);
  AddLumen(rve, load, &c);
  PetscCall(Condense(rve, &c, H));
  PetscCall(PetscFree(c.R));
  response->energy = energy / rve->mesh.V0;
  response->lumen_fraction = -c.Lq[Q_TURGOR] / rve->mesh.V0;
  for (PetscInt i = 0; i < 9; ++i) response->P[i] = response->P_turgor[i] = response->P_cohesion[i] = 0.0;
  for (PetscInt q = 0; q < 5; ++q) {
    response->P[component[q]] = c.Lq[q] / rve->mesh.V0;
    response->P_turgor[component[q]] = H[q][Q_TURGOR];
    for (PetscInt r = 0; r < 5; ++r) response->tangent[9 * component[q] + component[r]] = H[q][r];
  }
  response->energy_turgor2 = H[Q_TURGOR][Q_TURGOR];
  PetscFunctionReturn(0);
}
