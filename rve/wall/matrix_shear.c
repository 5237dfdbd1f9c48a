/*
  What shear out of the section adds to the Mooney-Rivlin matrix.

  Cells are prisms. In a frame whose third axis is theirs, F_13 = F_23 = 0, and with g = (F_31, F_32), f = F33, F in the
  plane and J = f det F, which g does not change,
    I1 = |F|^2 + f^2 + |g|^2,   I2 = (det F)^2 + f^2 |F|^2 + |F n|^2,   n = (-g_2, g_1),
  so that W grows by X = k1/2 |g|^2 + k2/2 |F n|^2, k1 = C1 J^(-2/3), k2 = C2 J^(-4/3). Derivatives follow from
  dJ/dF = J F^-T; |F n|^2 = g.Qg with Q = (det F)^2 C^-1 (docs/theory/walls.md, Shear out of the section).
*/
#include "wall_law.h"

typedef struct {
  PetscReal k1, k2, G, B;           /* G = |g|^2, B = |F n|^2 */
  PetscReal N[4], n[2], v[2], q[2]; /* F^-T, n, F n, Q g */
} ShearPoint;

static ShearPoint FindPoint(const LamWall *wall, const PetscReal F[4], PetscReal f, const PetscReal g[2])
{
  const PetscReal j = F[0] * F[3] - F[1] * F[2];
  ShearPoint at = {.k1 = wall->C1 * PetscPowReal(j * f, -2.0 / 3.0), .n = {-g[1], g[0]}};

  at.k2 = wall->C2 * PetscPowReal(j * f, -4.0 / 3.0);
  for (PetscInt i = 0; i < 2; ++i) at.v[i] = F[2 * i] * at.n[0] + F[2 * i + 1] * at.n[1];
  at.q[0] = F[1] * at.v[0] + F[3] * at.v[1];
  at.q[1] = -(F[0] * at.v[0] + F[2] * at.v[1]);
  at.N[0] = F[3] / j;
  at.N[1] = -F[2] / j;
  at.N[2] = -F[1] / j;
  at.N[3] = F[0] / j;
  at.G = g[0] * g[0] + g[1] * g[1];
  at.B = at.v[0] * at.v[0] + at.v[1] * at.v[1];
  return at;
}

/* Second derivatives in the plane and with F33; those with r, c < 4 have r <= c. */
static void AddPlane(const ShearPoint *at, PetscReal f, PetscInt g, LamShearKernel *out)
{
  const PetscReal first = (at->k1 * at->G + 2.0 * at->k2 * at->B) / 3.0; /* -X_J J */
  const PetscReal second = (2.0 * at->k1 * at->G + 8.0 * at->k2 * at->B) / 9.0;

  for (PetscInt r = 0; r < 4; ++r) {
    const PetscReal Dr = at->v[r / 2] * at->n[r % 2];

    out->P[r][g] = at->k2 * Dr - first * at->N[r];
    out->A[r][4][g] = (second * at->N[r] - 4.0 / 3.0 * at->k2 * Dr) / f;
    for (PetscInt c = r; c < 4; ++c) {
      const PetscReal Dc = at->v[c / 2] * at->n[c % 2];
      const PetscReal turned = at->N[r - r % 2 + c % 2] * at->N[c - c % 2 + r % 2]; /* N_iL N_kJ */

      out->A[r][c][g] = second * at->N[r] * at->N[c] + first * turned -
                        4.0 / 3.0 * at->k2 * (at->N[r] * Dc + Dr * at->N[c]) +
                        (r / 2 == c / 2 ? at->k2 * at->n[r % 2] * at->n[c % 2] : 0.0);
    }
  }
  out->P[4][g] = -first / f;
  out->A[4][4][g] = (5.0 * at->k1 * at->G + 14.0 * at->k2 * at->B) / (9.0 * f * f);
}

/* First derivatives by g, and the second ones that involve it. */
static void AddShear(const ShearPoint *at, const PetscReal F[4], PetscReal f, const PetscReal shear[2], PetscInt g,
                     LamShearKernel *out)
{
  static const PetscReal R[2][2] = {{0.0, -1.0}, {1.0, 0.0}}; /* n = R g */

  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal falls = 2.0 / 3.0 * at->k1 * shear[k] + 4.0 / 3.0 * at->k2 * at->q[k];

    out->P[5 + k][g] = at->k1 * shear[k] + at->k2 * at->q[k];
    out->A[4][5 + k][g] = -falls / f;
    for (PetscInt r = 0; r < 4; ++r) {
      const PetscInt i = r / 2, J = r % 2;
      const PetscReal FR = F[2 * i] * R[0][k] + F[2 * i + 1] * R[1][k];

      out->A[r][5 + k][g] = at->k2 * (FR * at->n[J] + at->v[i] * R[J][k]) - falls * at->N[r];
    }
  }
  out->A[5][5][g] = at->k1 + at->k2 * (F[1] * F[1] + F[3] * F[3]);
  out->A[5][6][g] = -at->k2 * (F[0] * F[1] + F[2] * F[3]);
  out->A[6][6][g] = at->k1 + at->k2 * (F[0] * F[0] + F[2] * F[2]);
}

void LamMatrixShear(const LamWall *wall, const LamPoints H[4], PetscReal H33, const LamPoints shear[2],
                    PetscBool derivatives, LamShearKernel *out)
{
  for (PetscInt g = 0; g < LAM_POINTS; ++g) {
    const PetscReal F[4] = {1.0 + H[0][g], H[1][g], H[2][g], 1.0 + H[3][g]}, of[2] = {shear[0][g], shear[1][g]};
    const ShearPoint at = FindPoint(wall, F, 1.0 + H33, of);

    out->W[g] = 0.5 * (at.k1 * at.G + at.k2 * at.B);
    if (!derivatives) continue;
    AddPlane(&at, 1.0 + H33, g, out);
    AddShear(&at, F, 1.0 + H33, of, g, out);
  }
}
