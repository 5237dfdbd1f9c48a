/*
  Isochoric Mooney-Rivlin matrix, W = C1/2 (I1bar - 3) + C2/2 (I2bar - 3)  (Mihai, Safar & Wyatt, eq. 4.1).

  Method. In plane strain with stretch f = F33 the isotropic invariants are functions of a = |F|^2 (in-plane), j = det
  F (in-plane) and f:  I1 = a + f^2,  I2 = j^2 + f^2 a,  J = j f. With C = J^(2/3), K1 = C1/C and K2 = C2 f^2/C^2
    W = K1/2 (I1 - 3 C) + K2/(2 f^2) (I2 - 3 C^2),
  and derivatives in F follow from da/dF = 2F, dj/dF = cof F.

  Rounding. Near F = 1 every term is a difference of numbers near 1. With H = F - 1, H33 = f - 1 the quantities
    delta = j - 1 = tr H + det H,   phi = f^2 - 1,   s2 = a - 2j = (H11 - H22)^2 + (H12 + H21)^2,
    C - 1 = (J^2 - 1)/(C^2 + C + 1)
  keep all digits of H. Energy and stress are written in these, with the first-order terms cancelled by hand.
*/
#include "wall_law.h"

typedef struct {
  PetscReal j, f, a, delta, phi, s2; /* as above */
  PetscReal K1, K2, C;
} Invariants;

static inline Invariants FindInvariants(const LamWall *wall, const PetscReal H[4], PetscReal H33)
{
  Invariants v;
  PetscReal root;

  v.delta = H[0] + H[3] + (H[0] * H[3] - H[1] * H[2]);
  v.phi = H33 * (2.0 + H33);
  v.s2 = PetscSqr(H[0] - H[3]) + PetscSqr(H[1] + H[2]);
  v.j = 1.0 + v.delta;
  v.f = 1.0 + H33;
  v.a = 2.0 * v.j + v.s2;
  root = cbrt(v.j * v.f);
  v.C = root * root;
  v.K1 = wall->C1 / v.C;
  v.K2 = wall->C2 * PetscSqr(v.f / v.C);
  return v;
}

static inline PetscReal Energy(const Invariants *v)
{
  const PetscReal delta2 = v->delta * (2.0 + v->delta); /* j^2 - 1 */
  const PetscReal m = delta2 * (1.0 + v->phi) + v->phi; /* J^2 - 1 */
  const PetscReal c1 = m / (v->C * v->C + v->C + 1.0);  /* C - 1 */
  const PetscReal c2 = c1 * (v->C + 1.0);               /* C^2 - 1 */
  const PetscReal common = v->s2 - v->delta * v->delta;
  const PetscReal I1 = common - delta2 * v->phi + c1 * c1 * (v->C + 2.0); /* I1 - 3 C */
  const PetscReal I2 =
      common + (v->s2 - 2.0 * v->delta * v->j) * v->phi - m * m + c2 * c2 * (v->C * v->C + 2.0); /* I2 - 3 C^2 */

  return 0.5 * (v->K1 * I1 + v->K2 / (v->f * v->f) * I2);
}

void LamMatrixMooneyRivlin(const LamWall *wall, const PetscReal H[4], PetscReal H33, LamKernel *out)
{
  const PetscReal F[4] = {1.0 + H[0], H[1], H[2], 1.0 + H[3]}, cof[4] = {F[3], -F[2], -F[1], F[0]};
  const PetscReal apart[4] = {H[0] - H[3], H[1] + H[2], H[1] + H[2], H[3] - H[0]}; /* F - cof F */
  const Invariants v = FindInvariants(wall, H, H33);
  const PetscReal f2 = v.f * v.f, jf = v.j * v.j / f2, ij = 1.0 / v.j, i_f = 1.0 / v.f, over = v.delta - v.phi;
  const PetscReal two_a = v.K1 + v.K2;                                                              /* 2 dW/da */
  const PetscReal mean = (v.K1 * (over - v.s2) + v.K2 * (v.j * over / f2 - 2.0 * v.s2)) * ij / 3.0; /* 2 W_a + W_j */
  const PetscReal w_j = mean - two_a, w_aj = -(v.K1 + 2.0 * v.K2) * ij / 3.0, w_af = (v.K2 - v.K1) * i_f / 3.0;
  const PetscReal w_jj = (5.0 * v.K1 * (v.a + f2) + v.K2 * (14.0 * v.a - jf)) * ij * ij / 9.0;
  const PetscReal w_jf = (v.K1 * (2.0 * v.a - 4.0 * f2) - 4.0 * v.K2 * (jf + v.a)) * ij * i_f / 9.0;

  out->W = Energy(&v);
  for (PetscInt r = 0; r < 4; ++r) {
    out->P[r] = two_a * apart[r] + mean * cof[r];
    for (PetscInt c = 0; c < 4; ++c)
      out->A[r][c] = 2.0 * w_aj * (F[r] * cof[c] + cof[r] * F[c]) + w_jj * cof[r] * cof[c];
    out->A[r][r] += two_a;
    out->A[r][4] = out->A[4][r] = 2.0 * w_af * F[r] + w_jf * cof[r];
  }
  out->A[0][3] += w_j; /* d2j/dFdF */
  out->A[3][0] += w_j;
  out->A[1][2] -= w_j;
  out->A[2][1] -= w_j;
  out->P[4] = -(v.K1 * (2.0 * over + v.s2) + v.K2 * (2.0 * v.j * over / f2 - v.s2)) * i_f / 3.0;
  out->A[4][4] = (v.K1 * (5.0 * v.a + 2.0 * f2) + v.K2 * (14.0 * jf - v.a)) * i_f * i_f / 9.0;
}
