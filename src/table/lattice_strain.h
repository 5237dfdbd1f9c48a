/*
  Lattice strains: the logarithmic stretches of the three lattice directions; stress and tangent from a potential of
  them.

    x_k = ln |F n_k|,  k = 0, 1, 2,   n_k: unit vector at the angle orientation + 60 k degrees (normal of face family k)
    c0 = (C11 + C22)/2, c1 = (C11 - C22)/2, c2 = C12:   exp(2 x_k) = c0 + c1 cos 2 theta_k + c2 sin 2 theta_k
  The three x are one-to-one with C, and invariant under rotation of the frame of F. Rotation of the hexagon by 60
  degrees and mirroring permute them. Where all three are equal the strain is isotropic, and a potential symmetric in
  the three has an isotropic tangent. Derivatives, with f_k = F n_k, q_k = exp(2 x_k): dx_k/dF_iJ = f_i n_J / q_k,
  d2x_k/dF_iJ dF_mN = n_J n_N (delta_im / q_k - 2 f_i f_m / q_k^2) docs/theory/database.md, Lattice strains.
*/
#ifndef LAM_LATTICE_STRAIN_H
#define LAM_LATTICE_STRAIN_H

#include <petscsys.h>
#include <math.h>

typedef struct {
  PetscReal n[3][2]; /* n_k */
  PetscReal c[3][3]; /* c_a = sum_k c[a][k] exp(2 x_k) */
} LamLatticeAxes;

/* Quantities of F in the plane. */
typedef struct {
  PetscReal f[3][2]; /* F n_k */
  PetscReal q[3];    /* |F n_k|^2 */
  PetscReal x[3];
} LamLatticeState;

static inline LamLatticeAxes LamLatticeAxesOf(PetscReal orientation)
{
  LamLatticeAxes axes;

  for (int k = 0; k < 3; k++) {
    const PetscReal angle = orientation + k * PETSC_PI / 3;

    axes.n[k][0] = cos(angle);
    axes.n[k][1] = sin(angle);
    axes.c[0][k] = 1.0 / 3;
    axes.c[1][k] = 2.0 / 3 * cos(2 * angle);
    axes.c[2][k] = 2.0 / 3 * sin(2 * angle);
  }
  return axes;
}

/* F: in-plane part, row-major. Skips the logarithms: x is NaN. */
static inline LamLatticeState LamLatticeSquaresOf(const LamLatticeAxes *axes, const PetscReal F[4])
{
  LamLatticeState s;

  for (int k = 0; k < 3; k++) {
    s.f[k][0] = F[0] * axes->n[k][0] + F[1] * axes->n[k][1];
    s.f[k][1] = F[2] * axes->n[k][0] + F[3] * axes->n[k][1];
    s.q[k] = s.f[k][0] * s.f[k][0] + s.f[k][1] * s.f[k][1];
    s.x[k] = NAN;
  }
  return s;
}

static inline LamLatticeState LamLatticeStateOf(const LamLatticeAxes *axes, const PetscReal F[4])
{
  LamLatticeState s = LamLatticeSquaresOf(axes, F);

  for (int k = 0; k < 3; k++) s.x[k] = 0.5 * log(s.q[k]);
  return s;
}

/* The symmetric F (U) with these strains; PETSC_FALSE if there is none. */
static inline PetscBool LamLatticeStretch(const LamLatticeAxes *axes, const PetscReal x[3], PetscReal U[4])
{
  PetscReal c[3], J2, J, trace;

  for (int a = 0; a < 3; a++)
    c[a] = axes->c[a][0] * exp(2 * x[0]) + axes->c[a][1] * exp(2 * x[1]) + axes->c[a][2] * exp(2 * x[2]);
  J2 = c[0] * c[0] - c[1] * c[1] - c[2] * c[2];
  if (!(J2 > 0) || !(c[0] > 0)) return PETSC_FALSE;
  J = sqrt(J2);
  trace = sqrt(2 * (c[0] + J)); /* U = (C + J 1) / tr U */
  U[0] = (c[0] + c[1] + J) / trace;
  U[1] = U[2] = c[2] / trace;
  U[3] = (c[0] - c[1] + J) / trace;
  return PETSC_TRUE;
}

/* P = sum_k g_k dx_k/dF, in the plane, row-major. */
static inline void LamLatticeStress(const LamLatticeAxes *axes, const LamLatticeState *s, const PetscReal g[3],
                                    PetscReal P[4])
{
  for (int i = 0; i < 4; i++) P[i] = 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) P[2 * i + j] += g[k] / s->q[k] * s->f[k][i] * axes->n[k][j];
}

/* A = sum_kl h_kl x_k,F (x) x_l,F + sum_k g_k x_k,FF; A[iJ][mN], symmetric. h: 11 22 33 23 13 12. */
static inline void LamLatticeTangent(const LamLatticeAxes *axes, const LamLatticeState *s, const PetscReal g[3],
                                     const PetscReal h[6], PetscReal A[4][4])
{
  const PetscReal H[3][3] = {{h[0], h[5], h[4]}, {h[5], h[1], h[3]}, {h[4], h[3], h[2]}};
  PetscReal slope[3][4];

  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 4; i++) slope[k][i] = s->f[k][i / 2] * axes->n[k][i % 2] / s->q[k];
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      PetscReal sum = 0;

      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) sum += H[k][l] * slope[k][a] * slope[l][b];
        sum -= 2 * g[k] * slope[k][a] * slope[k][b];
        if (a / 2 == b / 2) sum += g[k] / s->q[k] * axes->n[k][a % 2] * axes->n[k][b % 2];
      }
      A[a][b] = sum;
    }
}

/*
  From derivatives in F to derivatives in x: dF[k] changes x_k alone, with C following from exp(2 x); the rotation is
  arbitrary.
    g_k = P : dF_k,   h_kl = dF_k : A : dF_l - S : sym(dF_k^T dF_l) + 2 delta_kl g_k,   S = F^-1 P.
*/
static inline void LamLatticeVariations(const LamLatticeAxes *axes, const LamLatticeState *s, const PetscReal F[4],
                                        PetscReal dF[3][4])
{
  const PetscReal J = F[0] * F[3] - F[1] * F[2];
  const PetscReal T[4] = {F[3] / J, -F[2] / J, -F[1] / J, F[0] / J}; /* F^-T */

  for (int k = 0; k < 3; k++) {
    const PetscReal d0 = axes->c[0][k] * s->q[k], d1 = axes->c[1][k] * s->q[k], d2 = axes->c[2][k] * s->q[k];
    const PetscReal D[4] = {d0 + d1, d2, d2, d0 - d1}; /* dC/dx_k / 2 */

    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) dF[k][2 * i + j] = T[2 * i] * D[j] + T[2 * i + 1] * D[2 + j];
  }
}

/* J = det F with its gradient and Hessian (11 22 33 23 13 12) in x. */
static inline PetscReal LamLatticeVolume(const LamLatticeAxes *axes, const LamLatticeState *s, PetscReal g[3],
                                         PetscReal h[6])
{
  static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  const PetscReal sign[3] = {1, -1, -1};
  PetscReal c[3] = {0}, J;

  for (int a = 0; a < 3; a++)
    for (int k = 0; k < 3; k++) c[a] += axes->c[a][k] * s->q[k];
  J = sqrt(c[0] * c[0] - c[1] * c[1] - c[2] * c[2]);
  for (int k = 0; k < 3; k++) {
    g[k] = 0;
    for (int a = 0; a < 3; a++) g[k] += 2 * s->q[k] * axes->c[a][k] * sign[a] * c[a] / J;
  }
  for (int m = 0; m < 6; m++) {
    const int k = row[m], l = column[m];

    h[m] = -g[k] * g[l] / J + (k == l ? 2 * g[k] : 0);
    for (int a = 0; a < 3; a++) h[m] += 4 * s->q[k] * s->q[l] * axes->c[a][k] * axes->c[a][l] * sign[a] / J;
  }
  return J;
}

#endif
