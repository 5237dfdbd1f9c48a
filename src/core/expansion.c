/*
  Record to expansion: with dF_a = 1/2 F^-T D_a, D = I, diag(1,-1), offdiag(1,1), a change dF_a changes c_a alone;
    E_a  = P : dF_a,   E_ab = dF_a : A : dF_b - S : sym(dF_a^T dF_b),   S = F^-1 P
  (the second term because C varies along a straight line: F^T d2F + d2F^T F = -2 sym(dF_a^T dF_b)).
  Expansion to response: with K_a = F D_a, S = sum E_a D_a
    P = F S,   A_iJkL = delta_ik S_JL + sum E_ab (K_a)_iJ (K_b)_kL.
*/
#include "expansion.h"
#include <math.h>
#include <string.h>

#define TURGOR 3
#define COHESION 4

static const PetscReal D[3][2][2] = {{{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}};

typedef PetscReal Tensor[2][2];

/* ---- kinematics ---- */

static void InPlane(const PetscReal full[9], Tensor a)
{
  a[0][0] = full[0];
  a[0][1] = full[1];
  a[1][0] = full[3];
  a[1][1] = full[4];
}

static PetscReal Contract(Tensor a, Tensor b)
{
  return a[0][0] * b[0][0] + a[0][1] * b[0][1] + a[1][0] * b[1][0] + a[1][1] * b[1][1];
}

void LamVariables(const LamLoad *load, PetscReal x[LAM_VARIABLES])
{
  const PetscReal *F = load->F, C11 = F[0] * F[0] + F[3] * F[3], C22 = F[1] * F[1] + F[4] * F[4];

  x[0] = 0.5 * (C11 + C22);
  x[1] = 0.5 * (C11 - C22);
  x[2] = F[0] * F[1] + F[3] * F[4];
  x[TURGOR] = load->turgor;
  x[COHESION] = load->cohesion;
}

/* J = sqrt(c0^2 - c1^2 - c2^2) with its gradient and Hessian. */
static PetscReal Volume(const PetscReal c[3], PetscReal gradient[3], PetscReal hessian[3][3])
{
  const PetscReal sign[3] = {1, -1, -1}, J = sqrt(c[0] * c[0] - c[1] * c[1] - c[2] * c[2]);

  for (int a = 0; a < 3; a++) gradient[a] = sign[a] * c[a] / J;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) hessian[a][b] = ((a == b ? sign[a] : 0) - gradient[a] * gradient[b]) / J;
  return J;
}

/* Adds s p J to the energy, and its derivative in F33 to P33, with all their derivatives; J here: in the plane. */
static void AddFluid(PetscReal s, LamExpansion *e)
{
  PetscReal JC[3], JCC[3][3];
  const PetscReal J = Volume(e->x, JC, JCC), p = e->x[TURGOR], sF = s * e->F33;

  e->energy += sF * p * J;
  e->gradient[TURGOR] += sF * J;
  e->P33 += s * p * J;
  e->P33_gradient[TURGOR] += s * J;
  for (int a = 0; a < 3; a++) {
    e->gradient[a] += sF * p * JC[a];
    e->P33_gradient[a] += s * p * JC[a];
    e->hessian[a][TURGOR] += sF * JC[a];
    e->hessian[TURGOR][a] += sF * JC[a];
    for (int b = 0; b < 3; b++) e->hessian[a][b] += sF * p * JCC[a][b];
  }
}

/* K_a = F D_a: the derivative of c_a with respect to F. */
static void Slopes(Tensor F, Tensor K[3])
{
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) K[a][i][j] = F[i][0] * D[a][0][j] + F[i][1] * D[a][1][j];
}

void LamStressMetric(const PetscReal F[9], PetscReal B[3][3])
{
  Tensor plane, K[3];

  InPlane(F, plane);
  Slopes(plane, K);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) B[a][b] = Contract(K[a], K[b]);
}

/* ---- record to expansion ---- */

/* dF_a = 1/2 F^-T D_a. */
static void Variations(Tensor F, Tensor dF[3])
{
  const PetscReal J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  const Tensor half = {{0.5 * F[1][1] / J, -0.5 * F[1][0] / J}, {-0.5 * F[0][1] / J, 0.5 * F[0][0] / J}};

  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) dF[a][i][j] = half[i][0] * D[a][0][j] + half[i][1] * D[a][1][j];
}

/* a : A : b for the in-plane part of a tangent. */
static PetscReal Bilinear(const PetscReal A[81], Tensor a, Tensor b)
{
  PetscReal sum = 0;

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) sum += a[i][j] * A[27 * i + 9 * j + 3 * k + l] * b[k][l];
  return sum;
}

/* S : (a^T b), with S = sum S_a D_a given by its three coefficients. */
static PetscReal Curvature(const PetscReal S[3], Tensor a, Tensor b)
{
  const PetscReal t00 = a[0][0] * b[0][0] + a[1][0] * b[1][0], t11 = a[0][1] * b[0][1] + a[1][1] * b[1][1];
  const PetscReal t01 = a[0][0] * b[0][1] + a[1][0] * b[1][1], t10 = a[0][1] * b[0][0] + a[1][1] * b[1][0];

  return S[0] * (t00 + t11) + S[1] * (t00 - t11) + S[2] * (t01 + t10);
}

static void ExpandStrain(const LamResponse *r, Tensor dF[3], LamExpansion *e)
{
  Tensor P, A33;

  InPlane(r->P, P);
  InPlane(&r->tangent[72], A33);
  e->energy = r->energy;
  e->P33 = r->P[8];
  for (int a = 0; a < 3; a++) {
    e->gradient[a] = Contract(P, dF[a]);
    e->P33_gradient[a] = Contract(A33, dF[a]);
  }
  for (int a = 0; a < 3; a++)
    for (int b = 0; b <= a; b++) {
      const PetscReal bending = 0.5 * (Curvature(e->gradient, dF[a], dF[b]) + Curvature(e->gradient, dF[b], dF[a]));

      e->hessian[a][b] = 0.5 * (Bilinear(r->tangent, dF[a], dF[b]) + Bilinear(r->tangent, dF[b], dF[a])) - bending;
      e->hessian[b][a] = e->hessian[a][b];
    }
}

/* Derivatives with respect to turgor or cohesion: first, second, and that of P. */
static void ExpandPressure(int at, PetscReal first, PetscReal second, const PetscReal P_slope[9], Tensor dF[3],
                           LamExpansion *e)
{
  Tensor slope;

  InPlane(P_slope, slope);
  e->gradient[at] = first;
  e->hessian[at][at] = second;
  e->P33_gradient[at] = P_slope[8];
  for (int a = 0; a < 3; a++) e->hessian[a][at] = e->hessian[at][a] = Contract(slope, dF[a]);
}

/* Floating cells have a stress, but may have no tangent. */
static PetscBool IsFinite(const LamExpansion *e)
{
  PetscReal sum = e->energy + e->P33;

  for (int a = 0; a < LAM_VARIABLES; a++) {
    sum += e->gradient[a] + e->P33_gradient[a];
    for (int b = 0; b < LAM_VARIABLES; b++) sum += e->hessian[a][b];
  }
  return (PetscBool)isfinite(sum);
}

PetscBool LamExpansionMake(const LamResponse *record, PetscBool bonded, LamExpansion *e)
{
  Tensor F, dF[3];

  memset(e, 0, sizeof(*e));
  LamVariables(&record->load, e->x);
  e->F33 = record->load.F[8];
  InPlane(record->load.F, F);
  Variations(F, dF);
  ExpandStrain(record, dF, e);
  ExpandPressure(TURGOR, record->energy_turgor, record->energy_turgor2, record->P_turgor, dF, e);
  if (!bonded) {
    ExpandPressure(COHESION, record->energy_cohesion, record->energy_cohesion2, record->P_cohesion, dF, e);
    e->hessian[TURGOR][COHESION] = e->hessian[COHESION][TURGOR] = record->energy_turgor_cohesion;
  }
  AddFluid(1, e);
  return IsFinite(e);
}

void LamExpansionMove(const LamExpansion *expansion, const PetscReal x[LAM_VARIABLES], LamExpansion *moved)
{
  const LamExpansion e = *expansion;

  *moved = e;
  memcpy(moved->x, x, sizeof(moved->x));
  for (int a = 0; a < LAM_VARIABLES; a++) {
    const PetscReal step = x[a] - e.x[a];
    PetscReal slope = 0;

    for (int b = 0; b < LAM_VARIABLES; b++) slope += e.hessian[a][b] * (x[b] - e.x[b]);
    moved->energy += (e.gradient[a] + 0.5 * slope) * step;
    moved->gradient[a] += slope;
    moved->P33 += e.P33_gradient[a] * step;
  }
}

void LamExpansionStretch(PetscReal A3333, PetscReal F33, LamExpansion *e)
{
  const PetscReal step = F33 - e->F33;

  e->F33 = F33;
  e->energy += (e->P33 + 0.5 * A3333 * step) * step;
  e->P33 += A3333 * step;
  for (int a = 0; a < LAM_VARIABLES; a++) e->gradient[a] += e->P33_gradient[a] * step;
}

/* ---- expansion to response ---- */

/* sum_a v_a K_a into the in-plane part of a 3x3 tensor. */
static void PushForward(Tensor K[3], const PetscReal v[3], PetscReal full[9])
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) full[3 * i + j] = v[0] * K[0][i][j] + v[1] * K[1][i][j] + v[2] * K[2][i][j];
}

static void FillTangent(const LamExpansion *e, Tensor K[3], PetscReal A3333, PetscReal A[81])
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      PetscReal slope[3] = {0}, *row = &A[27 * i + 9 * j], rest[9];

      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) slope[b] += K[a][i][j] * e->hessian[a][b];
      PushForward(K, slope, rest);
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) {
          PetscReal S = 0;

          for (int a = 0; a < 3; a++) S += e->gradient[a] * D[a][j][l];
          row[3 * k + l] = rest[3 * k + l] + (i == k ? S : 0);
        }
    }
  PushForward(K, e->P33_gradient, &A[72]);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) A[27 * i + 9 * j + 8] = A[72 + 3 * i + j];
  A[80] = A3333;
}

/* dP/dp or dP/dg. */
static void FillPressure(const LamExpansion *e, Tensor K[3], int at, PetscReal P_slope[9])
{
  for (int i = 0; i < 9; i++) P_slope[i] = 0;
  PushForward(K, e->hessian[at], P_slope);
  P_slope[8] = e->P33_gradient[at];
}

void LamExpansionToResponse(const LamExpansion *expansion, PetscReal A3333, LamResponse *r)
{
  LamExpansion whole = *expansion;
  Tensor F, K[3];

  AddFluid(-1, &whole);
  InPlane(r->load.F, F);
  Slopes(F, K);
  for (int i = 0; i < 9; i++) r->P[i] = 0; /* plane strain has no out-of-plane shear stress */
  PushForward(K, whole.gradient, r->P);
  r->P[8] = whole.P33;
  FillPressure(&whole, K, TURGOR, r->P_turgor);
  FillPressure(&whole, K, COHESION, r->P_cohesion);
  r->energy = whole.energy;
  r->energy_turgor = whole.gradient[TURGOR];
  r->energy_turgor2 = whole.hessian[TURGOR][TURGOR];
  r->energy_cohesion = whole.gradient[COHESION];
  r->energy_cohesion2 = whole.hessian[COHESION][COHESION];
  r->energy_turgor_cohesion = whole.hessian[TURGOR][COHESION];
  FillTangent(&whole, K, A3333, r->tangent);
}
