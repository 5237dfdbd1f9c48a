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
#include <stdint.h>
#include <string.h>

#define HALLEY (sizeof(PetscReal) > 8 ? 5 : 3) /* iterations */

typedef struct {
  LamPoints a, j, delta, s2, C, K1, K2; /* as above */
} Invariants;

/* Cube roots of positive numbers: from a third of the exponent of a float (Kahan), by Halley's iteration. */
LAM_INLINE void CubeRoot(const LamPoints x, LamPoints root)
{
  float near[LAM_POINTS];
  int32_t bits[LAM_POINTS];

  LAM_EACH_POINT(g) near[g] = (float)x[g];
  memcpy(bits, near, sizeof(bits));
  LAM_EACH_POINT(g) bits[g] = bits[g] / 3 + 709958130;
  memcpy(near, bits, sizeof(bits));
  LAM_EACH_POINT(g)
  {
    PetscReal r = (PetscReal)near[g];

    for (PetscInt k = 0; k < HALLEY; ++k) { /* each triples the digits, of which a float's exponent gives one */
      const PetscReal cube = r * r * r;

      r *= (cube + 2.0 * x[g]) / (2.0 * cube + x[g]);
    }
    root[g] = r;
  }
}

LAM_INLINE void FindInvariants(const LamWall *wall, const LamPoints H[4], PetscReal f, Invariants *v)
{
  LamPoints J, root;

  LAM_EACH_POINT(g)
  {
    const PetscReal apart = H[0][g] - H[3][g], sum = H[1][g] + H[2][g];

    v->delta[g] = H[0][g] + H[3][g] + (H[0][g] * H[3][g] - H[1][g] * H[2][g]);
    v->s2[g] = apart * apart + sum * sum;
    v->j[g] = 1.0 + v->delta[g];
    v->a[g] = 2.0 * v->j[g] + v->s2[g];
    J[g] = v->j[g] * f;
  }
  CubeRoot(J, root);
  LAM_EACH_POINT(g)
  {
    v->C[g] = root[g] * root[g];
    v->K1[g] = wall->C1 / v->C[g];
    v->K2[g] = wall->C2 * f * f / (v->C[g] * v->C[g]);
  }
}

LAM_INLINE void Energy(const Invariants *v, PetscReal f, PetscReal phi, LamPoints W)
{
  LAM_EACH_POINT(g)
  {
    const PetscReal delta = v->delta[g], j = v->j[g], s2 = v->s2[g], C = v->C[g];
    const PetscReal delta2 = delta * (2.0 + delta); /* j^2 - 1 */
    const PetscReal m = delta2 * (1.0 + phi) + phi; /* J^2 - 1 */
    const PetscReal c1 = m / (C * C + C + 1.0);     /* C - 1 */
    const PetscReal c2 = c1 * (C + 1.0);            /* C^2 - 1 */
    const PetscReal common = s2 - delta * delta;
    const PetscReal I1 = common - delta2 * phi + c1 * c1 * (C + 2.0);                             /* I1 - 3 C */
    const PetscReal I2 = common + (s2 - 2.0 * delta * j) * phi - m * m + c2 * c2 * (C * C + 2.0); /* I2 - 3 C^2 */

    W[g] = 0.5 * (v->K1[g] * I1 + v->K2[g] / (f * f) * I2);
  }
}

LAM_CLONES static void MooneyRivlin(const LamWall *wall, const LamPoints H[4], PetscReal H33, PetscBool derivatives,
                                    LamKernel *out)
{
  const PetscReal f = 1.0 + H33, phi = H33 * (2.0 + H33), f2 = f * f, i_f = 1.0 / f;
  Invariants v;
  LamPoints F[4], cof[4], w_aj, w_jj, w_af, w_jf; /* the first two: 2 W_aj, W_jj and so on */

  FindInvariants(wall, H, f, &v);
  Energy(&v, f, phi, out->W);
  if (!derivatives) return;
  LAM_EACH_POINT(g)
  {
    F[0][g] = cof[3][g] = 1.0 + H[0][g];
    F[1][g] = H[1][g];
    F[2][g] = H[2][g];
    F[3][g] = cof[0][g] = 1.0 + H[3][g];
    cof[1][g] = -H[2][g];
    cof[2][g] = -H[1][g];
  }
  LAM_EACH_POINT(g)
  {
    const PetscReal K1 = v.K1[g], K2 = v.K2[g], a = v.a[g], j = v.j[g], s2 = v.s2[g];
    const PetscReal jf = j * j / f2, ij = 1.0 / j, over = v.delta[g] - phi, two_a = K1 + K2; /* 2 dW/da */
    const PetscReal mean = (K1 * (over - s2) + K2 * (j * over / f2 - 2.0 * s2)) * ij / 3.0;  /* 2 W_a + W_j */
    const PetscReal apart = H[0][g] - H[3][g], sum = H[1][g] + H[2][g];                      /* F - cof F */
    const PetscReal w_j = mean - two_a;

    w_aj[g] = -2.0 * (K1 + 2.0 * K2) * ij / 3.0;
    w_af[g] = 2.0 * (K2 - K1) * i_f / 3.0;
    w_jj[g] = (5.0 * K1 * (a + f2) + K2 * (14.0 * a - jf)) * ij * ij / 9.0;
    w_jf[g] = (K1 * (2.0 * a - 4.0 * f2) - 4.0 * K2 * (jf + a)) * ij * i_f / 9.0;
    out->P[0][g] = two_a * apart + mean * cof[0][g];
    out->P[1][g] = two_a * sum + mean * cof[1][g];
    out->P[2][g] = two_a * sum + mean * cof[2][g];
    out->P[3][g] = -two_a * apart + mean * cof[3][g];
    out->P[4][g] = -(K1 * (2.0 * over + s2) + K2 * (2.0 * j * over / f2 - s2)) * i_f / 3.0;
    out->A[4][4][g] = (K1 * (5.0 * a + 2.0 * f2) + K2 * (14.0 * jf - a)) * i_f * i_f / 9.0;
    /* here the first-order terms, below the others */
    out->A[0][0][g] = out->A[1][1][g] = out->A[2][2][g] = out->A[3][3][g] = two_a;
    out->A[0][3][g] = w_j; /* d2j/dFdF */
    out->A[1][2][g] = -w_j;
    out->A[0][1][g] = out->A[0][2][g] = out->A[1][3][g] = out->A[2][3][g] = 0.0;
  }
  for (PetscInt r = 0; r < 4; ++r) {
    for (PetscInt c = r; c < 4; ++c) LAM_EACH_POINT(g)
      {
        out->A[r][c][g] += w_aj[g] * (F[r][g] * cof[c][g] + cof[r][g] * F[c][g]) + w_jj[g] * cof[r][g] * cof[c][g];
      }
    LAM_EACH_POINT(g) out->A[r][4][g] = w_af[g] * F[r][g] + w_jf[g] * cof[r][g];
  }
}

void LamMatrixMooneyRivlin(const LamWall *wall, const LamPoints H[4], PetscReal H33, PetscBool derivatives,
                           LamKernel *out)
{
  MooneyRivlin(wall, H, H33, derivatives, out);
}
