/*
  Isochoric Mooney-Rivlin matrix, W = C1/2 (I1bar - 3) + C2/2 (I2bar - 3)  (Mihai, Safar & Wyatt, eq. 4.1).

  Method. In plane strain with stretch f = F33 the isotropic invariants are functions of a = |F|^2 (in-plane),
  j = det F (in-plane) and f:  I1 = a + f^2,  I2 = j^2 + f^2 a,  J = j f, so that
    W = C1/2 (a j^-2/3 f^-2/3 + j^-2/3 f^4/3) + C2/2 (j^2/3 f^-4/3 + a j^-4/3 f^2/3) - 3 (C1 + C2)/2,
  a sum of monomials c a^m j^n f^q with m = 0 or 1. Derivatives in F follow from da/dF = 2F, dj/dF = cof F.
*/
#include "wall_law.h"

/* First and second derivatives of W in (a, j, f). */
typedef struct {
  PetscReal W, a, j, f, aj, af, jj, jf, ff;
} Invariants;

static inline void AddMonomial(Invariants *w, PetscReal c, PetscReal a, PetscInt m, PetscReal j, PetscReal jn,
                               PetscReal n, PetscReal f, PetscReal fq, PetscReal q)
{
  const PetscReal slope = c * jn * fq; /* without the factor a^m */
  const PetscReal value = m ? slope * a : slope;

  w->W += value;
  w->j += value * n / j;
  w->f += value * q / f;
  w->jj += value * n * (n - 1.0) / (j * j);
  w->jf += value * n * q / (j * f);
  w->ff += value * q * (q - 1.0) / (f * f);
  if (m) {
    w->a += slope;
    w->aj += slope * n / j;
    w->af += slope * q / f;
  }
}

void LamMatrixMooneyRivlin(const LamWall *wall, const PetscReal F[4], PetscReal F33, LamKernel *out)
{
  const PetscReal cof[4] = {F[3], -F[2], -F[1], F[0]};
  const PetscReal a = F[0] * F[0] + F[1] * F[1] + F[2] * F[2] + F[3] * F[3], j = F[0] * F[3] - F[1] * F[2], f = F33;
  const PetscReal j13 = cbrt(j), f13 = f == 1.0 ? 1.0 : cbrt(f);
  const PetscReal j23 = j13 * j13, f23 = f13 * f13;
  Invariants w = {0};

  AddMonomial(&w, 0.5 * wall->C1, a, 1, j, 1.0 / j23, -2.0 / 3.0, f, 1.0 / f23, -2.0 / 3.0);
  AddMonomial(&w, 0.5 * wall->C1, a, 0, j, 1.0 / j23, -2.0 / 3.0, f, f23 * f23, 4.0 / 3.0);
  AddMonomial(&w, 0.5 * wall->C2, a, 0, j, j23, 2.0 / 3.0, f, 1.0 / (f23 * f23), -4.0 / 3.0);
  AddMonomial(&w, 0.5 * wall->C2, a, 1, j, 1.0 / (j23 * j23), -4.0 / 3.0, f, f23, 2.0 / 3.0);

  out->W = w.W - 1.5 * (wall->C1 + wall->C2);
  for (PetscInt r = 0; r < 4; ++r) {
    out->P[r] = 2.0 * w.a * F[r] + w.j * cof[r];
    for (PetscInt c = 0; c < 4; ++c)
      out->A[r][c] = 2.0 * w.aj * (F[r] * cof[c] + cof[r] * F[c]) + w.jj * cof[r] * cof[c];
    out->A[r][r] += 2.0 * w.a;
    out->A[r][4] = out->A[4][r] = 2.0 * w.af * F[r] + w.jf * cof[r];
  }
  out->A[0][3] += w.j; /* d2j/dFdF */
  out->A[3][0] += w.j;
  out->A[1][2] -= w.j;
  out->A[2][1] -= w.j;
  out->P[4] = w.f;
  out->A[4][4] = w.ff;
}
