/*
  Effective stress, tangent and couplings of a converged state.

  Method. Psi(q) = (1/V0) min_y L(y, q) with q = (F11, F12, F21, F22, F33, p, g) and, for the smooth law of contact, its
  width. F enters L through the image shifts
  x_a = y + F S_a and through F33 in the walls and in the volumes; p through -p F33 A_lumen, g through g F33 A_gap. Then
    dPsi/dq   = L_q / V0,
    d2Psi/dq2 = (L_qq - L_qy K^-1 L_yq) / V0         (static condensation with the factor of the converged state),
  where y includes the active multipliers of contact, whose rows are -dG/dF, and the pressures of sealed lumens; for
  these p is the turgor of the load, i.e. the pressure p0 of the water in turgor.c. So P_ij = (1/V0) sum_a f_ai S_aj
  over shifted nodes, f_a the nodal forces of walls or contact, and the tangent is symmetric by construction. Bonded
  tissue does not depend on g. The strength of the smooth law depends on p and g.

  Rounding. Positions have at most 16 digits, so r = L_y is not zero but a few eps times the stiffest modulus, and the
  error of L_F is of the same size. To first order the solution is y - K^-1 r, and there P = (L_F - L_Fy K^-1 r) / V0:
  the work of the wall stresses on the relaxed mode of F, on which stiff walls do no work
  (docs/theory/homogenisation.md, Rounding).
*/
#include "antiplane.h"
#include "end_walls.h"
#include "measure.h"
#include "section_frame.h"
#include <lamella/ellipticity.h>

#define Q_F33 4
#define Q_TURGOR 5
#define Q_COHESION 6
#define Q_WIDTH 7
#define NQ 8

const PetscInt LamFComponent[LAM_F_COUNT] = {0, 1, 3, 4, 8};

typedef struct {
  PetscInt nq;   /* NQ; of the exact law Q_WIDTH, of bonded tissue Q_COHESION: what it does not depend on comes last */
  PetscInt size; /* of a column: the prescribed class, the other positions, the multipliers, the pressures */
  PetscReal Lq[NQ], Lqq[NQ][NQ];
  PetscReal lumen, gap; /* areas */
  PetscReal *R;         /* [nq][size]: L_yq, one column after the other */
} Condensation;

/* Adds the F couplings of an element with shifted nodes. */
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
        PetscReal *column = c->R + q * c->size;

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
  PetscReal u[LAM_ELEMENT_NODES][2], force33, ff, fx[LAM_ELEMENT_DOFS];

  LamGatherDisplacements(rve, load->F, rve->y, e, u);
  LamElementStretch33(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                      (const PetscReal(*)[2])u, load->F[8], &rve->stress[e], &force33, fx, &ff);
  c->Lq[Q_F33] += force33;
  c->Lqq[Q_F33][Q_F33] += ff;
  for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
    for (PetscInt i = 0; i < 2; ++i) c->R[Q_F33 * c->size + 2 * mesh->node_class[nodes[a]] + i] += fx[2 * a + i];
  if (mesh->has_shift[e]) {
    LamElementResult element;
    PetscBool valid;

    LamElementEvaluate(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                       (const PetscReal(*)[2])u, load->F[8], &rve->stress[e], &element, &valid);
    AddShifted(rve, e, &element, fx, c);
  }
}

/* Adds the turgor terms of lumens that are not sealed. */
static void AddTurgor(LamRVE rve, const LamLoad *load, Condensation *c)
{
  const LamSeal *seal = &rve->seal;

  for (PetscInt k = 0; k < rve->mesh.cell_count; ++k) {
    const PetscReal factor = LamTurgorFactor(rve, k);

    seal->factor[k] = -load->F[8] * factor;
    c->Lq[Q_TURGOR] -= load->F[8] * factor * seal->area[k];
    c->Lqq[Q_F33][Q_TURGOR] -= factor * seal->area[k];
  }
  LamLumenAddGradient(rve, rve->y, seal->factor, c->R + Q_TURGOR * c->size);
}

/* Adds the turgor terms of sealed lumens, whose pressures are unknowns: V_w (p - (p - p0)^2 / (2 K_w)). */
static void AddSealedTurgor(LamRVE rve, const LamLoad *load, Condensation *c)
{
  const LamSeal *seal = &rve->seal;
  const PetscInt pressures = c->size - rve->linear->lumens;

  for (PetscInt k = 0; k < rve->linear->lumens; ++k) {
    const PetscReal factor = LamTurgorFactor(rve, k), compliance = seal->water[k] / seal->bulk_modulus;

    if (LamHasBurst(rve, k)) continue;
    c->R[Q_F33 * c->size + pressures + k] -= seal->area[k];
    c->R[Q_TURGOR * c->size + pressures + k] += factor * compliance;
    c->Lq[Q_TURGOR] += factor * compliance * (rve->y[rve->ndof + k] - load->turgor * factor);
    c->Lqq[Q_TURGOR][Q_TURGOR] -= factor * factor * compliance;
  }
}

/* Terms of the lumen volume F33 A. */
static void AddLumen(LamRVE rve, const LamLoad *load, Condensation *c)
{
  const LamSeal *seal = &rve->seal;

  LamLumenAreas(rve, rve->y, seal->area);
  for (PetscInt k = 0; k < rve->mesh.cell_count; ++k) {
    const PetscReal pressure = LamTurgor(rve, load, rve->y, k);

    seal->factor[k] = -pressure;
    c->Lq[Q_F33] -= pressure * seal->area[k];
    c->lumen += seal->area[k];
  }
  LamLumenAddGradient(rve, rve->y, seal->factor, c->R + Q_F33 * c->size);
  if (seal->closed)
    AddSealedTurgor(rve, load, c);
  else
    AddTurgor(rve, load, c);
}

/* Terms of the gap volume F33 A. */
static void AddGapVolume(LamRVE rve, const LamLoad *load, Condensation *c)
{
  const LamGapArea *gaps = &rve->contact->gaps;
  const PetscReal *F = load->F, *y = rve->y, g = load->cohesion, F33 = F[8];
  const PetscReal area = LamGapAreaEvaluate(gaps, F, y, &c->gap);
  PetscReal *R[4], second[4][4] = {{0}}, first[4] = {0};

  for (PetscInt q = 0; q < 4; ++q) R[q] = c->R + q * c->size;
  LamGapAreaAddGradient(gaps, F, y, g, c->R + Q_F33 * c->size);
  LamGapAreaAddGradient(gaps, F, y, F33, c->R + Q_COHESION * c->size);
  LamGapAreaAddShifts(gaps, F, y, 1.0, first, NULL, NULL);
  LamGapAreaAddShifts(gaps, F, y, g * F33, c->Lq, second, R);
  c->Lq[Q_COHESION] += F33 * area;
  c->Lq[Q_F33] += g * area;
  c->Lqq[Q_F33][Q_COHESION] += area;
  for (PetscInt q = 0; q < 4; ++q) {
    c->Lqq[q][Q_F33] += g * first[q];
    c->Lqq[q][Q_COHESION] += F33 * first[q];
    for (PetscInt r = 0; r < 4; ++r) c->Lqq[q][r] += second[q][r];
  }
}

/* Adds the terms of a contact face with shifted nodes. */
static void AddContactFace(LamRVE rve, PetscInt f, Condensation *c)
{
  const LamContact *contact = rve->contact;
  const PetscInt dofs = contact->dofs, *classes = &contact->classes[f * contact->chain];
  const PetscReal *S = &contact->shift[2 * f * contact->chain], *hessian = &contact->hessian[f * dofs * dofs];

  for (PetscInt j = 0; j < dofs; ++j)
    for (PetscInt l = 0; l < 2; ++l) {
      const PetscReal Sj = S[2 * (j / 2) + l];
      const PetscInt q = 2 * (j % 2) + l;
      PetscReal *column = c->R + q * c->size;

      if (Sj == 0.0) continue;
      for (PetscInt i = 0; i < dofs; ++i) {
        column[2 * classes[i / 2] + i % 2] -= hessian[i * dofs + j] * Sj;
        for (PetscInt k = 0; k < 2; ++k) c->Lqq[2 * (i % 2) + k][q] -= S[2 * (i / 2) + k] * hessian[i * dofs + j] * Sj;
      }
      for (PetscInt h = f * contact->hats; h < (f + 1) * contact->hats; ++h) {
        if (contact->active[h]) c->Lq[q] -= contact->lambda[h] * contact->rows[h * dofs + j] * Sj;
        column[rve->ndof + h] -= contact->rows[h * dofs + j] * Sj; /* used only if active (LamCopyActive) */
      }
    }
}

typedef struct {
  LamRVE rve;
  Condensation *c;
  PetscReal F33;
} SmoothTerms;

/* Adds the terms of a pair of spans: F33 s e(x), with s(p, g). */
static void AddTouchBlock(void *ctx, const LamTouchBlock *block)
{
  const SmoothTerms *terms = (const SmoothTerms *)ctx;
  Condensation *c = terms->c;
  const LamTouchStrength *s = &block->strength;
  const PetscReal F33 = terms->F33, factor[3] = {s->s, F33 * s->p, F33 * s->g};
  const PetscInt q3[3] = {Q_F33, Q_TURGOR, Q_COHESION};

  for (PetscInt k = 0; k < 3; ++k) c->Lq[q3[k]] += factor[k] * block->energy;
  c->Lq[Q_WIDTH] += F33 * s->s * block->energy_width;
  c->Lqq[Q_F33][Q_TURGOR] += s->p * block->energy;
  c->Lqq[Q_F33][Q_COHESION] += s->g * block->energy;
  c->Lqq[Q_F33][Q_WIDTH] += s->s * block->energy_width;
  c->Lqq[Q_TURGOR][Q_TURGOR] += F33 * s->pp * block->energy;
  c->Lqq[Q_TURGOR][Q_COHESION] += F33 * s->pg * block->energy;
  c->Lqq[Q_COHESION][Q_COHESION] += F33 * s->gg * block->energy;
  for (PetscInt j = 0; j < LAM_BLOCK_DOFS; ++j) {
    const PetscInt at = 2 * block->class[j / 2] + j % 2;

    for (PetscInt k = 0; k < 3; ++k) c->R[q3[k] * c->size + at] += factor[k] * block->f[j];
    c->R[Q_WIDTH * c->size + at] += F33 * s->s * block->f_width[j];
    for (PetscInt l = 0; l < 2; ++l) {
      const PetscReal Sj = block->shift[j / 2][l];
      const PetscInt q = 2 * (j % 2) + l;

      if (Sj == 0.0) continue;
      c->Lq[q] += F33 * s->s * block->f[j] * Sj;
      for (PetscInt k = 0; k < 3; ++k) c->Lqq[q][q3[k]] += factor[k] * block->f[j] * Sj;
      c->Lqq[q][Q_WIDTH] += F33 * s->s * block->f_width[j] * Sj;
      for (PetscInt i = 0; i < LAM_BLOCK_DOFS; ++i) {
        const PetscReal K = F33 * s->s * block->K[i][j] * Sj;

        c->R[q * c->size + 2 * block->class[i / 2] + i % 2] += K;
        for (PetscInt k = 0; k < 2; ++k) c->Lqq[2 * (i % 2) + k][q] += block->shift[i / 2][k] * K;
      }
    }
  }
}

void LamCopyActive(LamRVE rve, const PetscReal column[], PetscReal copy[])
{
  const PetscInt positions = rve->linear->positions, pressures = rve->linear->pressures;

  for (PetscInt i = 0; i < rve->linear->n; ++i)
    copy[i] = i < positions || i >= pressures || rve->contact->active[i - positions] ? column[i] : 0.0;
}

/* r = L_y [n] at rve->y, with the gaps of active hats; call after LamFactorConsistent at rve->y. */
static void CopyResidual(LamRVE rve, PetscReal r[])
{
  const LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear->positions, pressures = rve->linear->pressures;

  for (PetscInt i = 0; i < rve->ndof; ++i) rve->trial[i] = rve->residual[i];
  if (LamIsExact(rve)) LamContactAddForce(rve, rve->trial);
  for (PetscInt i = 0; i < positions; ++i) r[i] = rve->trial[i + 2];
  for (PetscInt h = 0; LamIsExact(rve) && h < contact->count; ++h)
    r[positions + h] = contact->active[h] ? -contact->gap[h] * contact->weight[h] : 0.0;
  for (PetscInt k = 0; k < rve->linear->lumens; ++k)
    r[pressures + k] = rve->seal.closed ? rve->residual[rve->ndof + k] : 0.0;
}

/* Adds what depends on F alone. */
static PetscErrorCode AddEndWalls(LamRVE rve, const LamLoad *load, Condensation *c)
{
  const PetscReal V0 = rve->mesh.V0;
  LamEndWalls ends;

  PetscFunctionBeginUser;
  if (!(rve->micro.length > 0.0)) PetscFunctionReturn(0);
  PetscCall(LamEndWallsEvaluate(&rve->micro, load->F, &ends));
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) {
    c->Lq[q] += V0 * ends.P[LamFComponent[q]];
    for (PetscInt r = 0; r < LAM_F_COUNT; ++r) c->Lqq[q][r] += V0 * ends.A[LamFComponent[q]][LamFComponent[r]];
  }
  PetscFunctionReturn(0);
}

/* The same of shear out of the section. */
static PetscErrorCode AddShearedEndWalls(LamRVE rve, const LamLoad *load, LamAxialDerivatives *axial)
{
  const PetscReal V0 = rve->mesh.V0;
  LamEndWalls ends;

  PetscFunctionBeginUser;
  if (!(rve->micro.length > 0.0)) PetscFunctionReturn(0);
  PetscCall(LamEndWallsEvaluate(&rve->micro, load->F, &ends));
  for (PetscInt l = 0; l < 2; ++l) {
    PetscReal *H = axial->H[LAM_AXIAL_G + l];

    axial->Lq[LAM_AXIAL_G + l] += V0 * ends.P[6 + l];
    for (PetscInt q = 0; q < LAM_F_COUNT; ++q) H[q] += V0 * ends.A[6 + l][LamFComponent[q]];
    for (PetscInt m = 0; m < 2; ++m) H[LAM_AXIAL_G + m] += V0 * ends.A[6 + l][6 + m];
  }
  PetscFunctionReturn(0);
}

/* Corrects L_F to first order to the solution near the positions, -= L_Fy K^-1 r, and with `derivatives` sets
   H = (L_qq - R^T K^-1 R) / V0. */
static PetscErrorCode Condense(LamRVE rve, const LamLoad *load, Condensation *c, PetscBool derivatives,
                               PetscReal H[NQ][NQ], LamAxialDerivatives *axial)
{
  const PetscInt n = rve->linear->n, nq = c->nq;
  PetscReal *rhs, *solution, *R, *X; /* r and its solution, then the columns and theirs */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2((nq + 1) * n, &rhs, (nq + 1) * n, &solution));
  R = rhs + n;
  X = solution + n;
  CopyResidual(rve, rhs);
  for (PetscInt q = 0; q < nq; ++q) LamCopyActive(rve, c->R + q * c->size + 2, R + q * n);
  PetscCall(LamLinearSolve(rve->linear, derivatives ? nq + 1 : 1, rhs, solution));
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) c->Lq[q] -= LamInnerProduct(n, R + q * n, solution);
  for (PetscInt q = 0; q < nq && derivatives; ++q)
    for (PetscInt r = q; r < nq; ++r) {
      const PetscReal sum = LamInnerProduct(n, R + q * n, X + r * n) + LamInnerProduct(n, R + r * n, X + q * n);

      H[q][r] = H[r][q] = (c->Lqq[q][r] - 0.5 * sum) / rve->mesh.V0;
    }
  if (derivatives && rve->rates) {
    const PetscReal *columns[LAM_BOND_RATES] = {X, X + n, X + 2 * n, X + 3 * n, X + Q_TURGOR * n};

    PetscCall(LamBondRatesFind(rve, load, columns));
  }
  if (rve->antiplane) PetscCall(LamCondenseAxial(rve, load, derivatives ? nq : 0, X, axial));
  if (rve->antiplane && axial->ok) {
    for (PetscInt q = 0; q < nq; ++q) {
      c->Lq[q] += axial->Lq[q];
      for (PetscInt r = 0; r < nq; ++r) H[q][r] += axial->H[q][r] / rve->mesh.V0;
    }
  }
  if (rve->antiplane) PetscCall(AddShearedEndWalls(rve, load, axial));
  PetscCall(PetscFree2(rhs, solution));
  PetscFunctionReturn(0);
}

/* Adds the terms of an edge of the lamella with shifted nodes. */
static void AddLayerEdge(void *ctx, const LamEdgeBlock *block)
{
  Condensation *c = (Condensation *)ctx;
  const LamEdgeNodes *nodes = block->nodes;

  for (PetscInt j = 0; j < LAM_EDGE_DOFS; ++j)
    for (PetscInt l = 0; l < 2; ++l) {
      const PetscReal Sj = nodes->shift[j / 2][l];
      const PetscInt q = 2 * (j % 2) + l;

      if (Sj == 0.0) continue;
      c->Lq[q] += block->sum.f[j] * Sj;
      for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) {
        const PetscReal K = block->sum.K[i][j] * Sj;

        c->R[q * c->size + 2 * nodes->class[i / 2] + i % 2] += K;
        for (PetscInt k = 0; k < 2; ++k) c->Lqq[2 * (i % 2) + k][q] += nodes->shift[i / 2][k] * K;
      }
    }
}

/* Sums L_q, L_qq and R, which the caller frees. */
static PetscErrorCode Assemble(LamRVE rve, const LamLoad *load, Condensation *c)
{
  SmoothTerms terms = {rve, c, load->F[8]};

  PetscFunctionBeginUser;
  c->nq = !rve->contact ? Q_COHESION : LamIsExact(rve) ? Q_WIDTH : NQ;
  c->size = rve->linear->n + 2;
  PetscCall(PetscCalloc1(c->nq * c->size, &c->R));
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) AddElement(rve, load, e, c);
  AddLumen(rve, load, c);
  PetscCall(AddEndWalls(rve, load, c));
  if (rve->contact) {
    AddGapVolume(rve, load, c);
    for (PetscInt f = 0; LamIsExact(rve) && f < rve->contact->face_count; ++f) AddContactFace(rve, f, c);
    if (!LamIsExact(rve)) LamSmoothVisit(rve, load, rve->y, LAM_TOUCH_WIDTH, AddTouchBlock, &terms);
    if (rve->layer) LamLayerVisit(rve, load->F, rve->y, AddLayerEdge, c);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamAssembleGradient(LamRVE rve, const LamLoad *load, PetscReal Lq[LAM_F_COUNT],
                                   PetscReal Lqq[LAM_F_COUNT][LAM_F_COUNT], PetscReal R[])
{
  Condensation c = {0};

  PetscFunctionBeginUser;
  PetscCall(Assemble(rve, load, &c));
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) {
    Lq[q] = c.Lq[q];
    for (PetscInt r = q; r < LAM_F_COUNT; ++r) Lqq[q][r] = Lqq[r][q] = c.Lqq[q][r];
    PetscCall(PetscArraycpy(R + q * rve->linear->n, c.R + q * c.size + 2, rve->linear->n));
  }
  PetscCall(PetscFree(c.R));
  PetscFunctionReturn(0);
}

/* Change of P from the width of the smooth law to none, to first order; 0 for the exact law. */
static PetscReal ContactError(LamRVE rve, const PetscReal H[NQ][NQ], const LamResponse *response)
{
  PetscReal changed[9];

  if (LamIsExact(rve)) return 0.0;
  for (PetscInt i = 0; i < 9; ++i) changed[i] = response->P[i];
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) changed[LamFComponent[q]] -= rve->smooth->width * H[q][Q_WIDTH];
  return LamStressError(LamStressScaleOf(&rve->micro), changed, response->P);
}

static void FillDerivatives(LamRVE rve, const PetscReal H[NQ][NQ], LamResponse *response)
{
  const PetscInt *component = LamFComponent;

  for (PetscInt i = 0; i < 9; ++i) response->P_turgor[i] = response->P_cohesion[i] = 0.0;
  for (PetscInt q = 0; q < 5; ++q) {
    response->P_turgor[component[q]] = H[q][Q_TURGOR];
    response->P_cohesion[component[q]] = H[q][Q_COHESION];
    for (PetscInt r = 0; r < 5; ++r) response->tangent[9 * component[q] + component[r]] = H[q][r];
  }
  LamResponseFindBand(response);
  if (rve->contact) response->contact_error = ContactError(rve, H, response);
  response->energy_turgor2 = H[Q_TURGOR][Q_TURGOR];
  response->energy_cohesion2 = H[Q_COHESION][Q_COHESION];
  response->energy_turgor_cohesion = H[Q_TURGOR][Q_COHESION];
}

/* Derivatives with an index 3, in the frame of the section. */
static void FillAxial(LamRVE rve, const LamLoad *load, const LamAxialDerivatives *axial, LamResponse *response)
{
  const PetscReal V0 = rve->mesh.V0;

  for (PetscInt l = 0; l < 2; ++l) {
    const PetscInt row = 6 + l;

    response->P_turgor[row] = axial->H[LAM_AXIAL_G + l][Q_TURGOR] / V0;
    response->P_cohesion[row] = axial->H[LAM_AXIAL_G + l][Q_COHESION] / V0;
    for (PetscInt q = 0; q < LAM_F_COUNT; ++q)
      response->tangent[9 * row + LamFComponent[q]] = response->tangent[9 * LamFComponent[q] + row] =
          axial->H[LAM_AXIAL_G + l][q] / V0;
    for (PetscInt m = 0; m < 2; ++m)
      response->tangent[9 * row + 6 + m] = axial->H[LAM_AXIAL_G + l][LAM_AXIAL_G + m] / V0;
  }
  LamSectionComplete(load->F, response->P, response->tangent);
  LamSectionCompleteStress(load->F, response->P_turgor);
  LamSectionCompleteStress(load->F, response->P_cohesion);
}

PetscErrorCode LamHomogenise(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const PetscBool derivatives = (PetscBool)((rve->wanted & LAM_WANT_DERIVATIVES) != 0);
  Condensation c = {0};
  LamAxialDerivatives axial = {0};
  PetscReal H[NQ][NQ] = {{0}};

  PetscFunctionBeginUser;
  PetscCall(Assemble(rve, load, &c));
  PetscCall(Condense(rve, load, &c, derivatives, H, &axial));
  for (PetscInt i = 0; i < 9; ++i) response->P[i] = 0.0;
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) response->P[LamFComponent[q]] = c.Lq[q] / rve->mesh.V0;
  for (PetscInt l = 0; l < 2 && rve->antiplane; ++l) response->P[6 + l] = axial.Lq[LAM_AXIAL_G + l] / rve->mesh.V0;
  if (derivatives) FillDerivatives(rve, (const PetscReal(*)[NQ])H, response);
  if (derivatives && rve->antiplane && axial.ok) /* else the plane holds what would give way: entries stay unknown */
    FillAxial(rve, load, &axial, response);
  else if (rve->antiplane)
    LamSectionCompleteStress(load->F, response->P);
  PetscCall(PetscFree(c.R));
  response->energy = rve->energy / rve->mesh.V0;
  response->lumen_fraction = load->F[8] * c.lumen / rve->mesh.V0;
  response->opening_fraction = load->F[8] * c.gap / rve->mesh.V0;
  response->energy_turgor = c.Lq[Q_TURGOR] / rve->mesh.V0;
  response->energy_cohesion = c.Lq[Q_COHESION] / rve->mesh.V0;
  LamTurgorMeasures(rve, load, response);
  PetscFunctionReturn(0);
}
