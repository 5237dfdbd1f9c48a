/*
  Method
    Each part of the function is a sum over an n x n x n array of data times tensor products of functions of one
    variable. Cubic: n = 4 (value functions of the two ends, then slope functions). Bubbles along one direction: n = 2
    (the edge's two bubbles in this direction, value functions in the others). Contracting one direction after another
    gives all derivatives up to the second.
*/
#include <math.h>
#include "hermite_cell.h"

/* Functions of one direction: [order of derivative with respect to the coordinate h t][function]. */
typedef PetscReal Functions[3][4];

/* Cubic Hermite functions: values V_0, V_1 (the first two columns), slopes D_0, D_1. */
static inline void HermiteFunctions(PetscReal t, PetscReal h, Functions u)
{
  const PetscReal s = 1 - t;

  u[0][0] = s * s * (1 + 2 * t);
  u[0][1] = t * t * (3 - 2 * t);
  u[0][2] = h * t * s * s;
  u[0][3] = -h * t * t * s;
  u[1][0] = -6 * t * s / h;
  u[1][1] = -u[1][0];
  u[1][2] = s * (1 - 3 * t);
  u[1][3] = t * (3 * t - 2);
  u[2][0] = (12 * t - 6) / (h * h);
  u[2][1] = -u[2][0];
  u[2][2] = (6 * t - 4) / h;
  u[2][3] = (6 * t - 2) / h;
}

/* h^2 q_0, h^2 q_1: second derivative 1 at their own end, 0 at the other; value and slope 0 at both ends. */
static inline void BubbleFunctions(PetscReal t, PetscReal h, Functions u)
{
  const PetscReal s = 1 - t, ts = t * s;

  u[0][0] = 0.5 * h * h * ts * ts * s;
  u[0][1] = 0.5 * h * h * ts * ts * t;
  u[1][0] = 0.5 * h * ts * s * (2 - 5 * t);
  u[1][1] = 0.5 * h * ts * t * (3 - 5 * t);
  u[2][0] = s * (1 - 8 * t + 10 * t * t);
  u[2][1] = t * (3 - 12 * t + 10 * t * t);
}

static inline PetscReal Dot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/*
  Derivatives up to `order` (0, 1 or 2) of the sum over data[k][j][i] u0[i] u1[j] u2[k], i, j, k < n, added to *jet.
  Constant n and order unroll the loops.
*/
static inline void Contract(PetscInt n, PetscInt order, const Functions u0, const Functions u1, const Functions u2,
                            const PetscReal data[], LamJet *jet)
{
  PetscReal plane[3][16], line[3][3][4]; /* [order in direction 2][i, j], [order in direction 2][in direction 1][i] */

  for (PetscInt c = 0; c <= order; c++)
    for (PetscInt a = 0; a < n * n; a++) {
      plane[c][a] = 0;
      for (PetscInt k = 0; k < n; k++) plane[c][a] += u2[c][k] * data[n * n * k + a];
    }
  for (PetscInt c = 0; c <= order; c++)
    for (PetscInt b = 0; b <= order - c; b++)
      for (PetscInt i = 0; i < n; i++) {
        line[c][b][i] = 0;
        for (PetscInt j = 0; j < n; j++) line[c][b][i] += u1[b][j] * plane[c][n * j + i];
      }
  jet->value += Dot(n, u0[0], line[0][0]);
  if (order < 1) return;
  jet->gradient[0] += Dot(n, u0[1], line[0][0]);
  jet->gradient[1] += Dot(n, u0[0], line[0][1]);
  jet->gradient[2] += Dot(n, u0[0], line[1][0]);
  if (order < 2) return;
  jet->hessian[0] += Dot(n, u0[2], line[0][0]);
  jet->hessian[1] += Dot(n, u0[0], line[0][2]);
  jet->hessian[2] += Dot(n, u0[0], line[2][0]);
  jet->hessian[3] += Dot(n, u0[0], line[1][1]);
  jet->hessian[4] += Dot(n, u0[1], line[1][0]);
  jet->hessian[5] += Dot(n, u0[1], line[0][1]);
}

static inline void AddCubic(const LamJet corner[8], const Functions u[3], PetscInt order, LamJet *sum)
{
  PetscReal data[4][4][4]; /* in each direction: values at the two ends, slopes at the two ends */

  for (PetscInt c = 0; c < 8; c++) {
    const PetscInt i = c & 1, j = c >> 1 & 1, k = c >> 2;
    const LamJet *at = &corner[c];

    data[k][j][i] = at->value;
    data[k][j][i + 2] = at->gradient[0];
    data[k][j + 2][i] = at->gradient[1];
    data[k + 2][j][i] = at->gradient[2];
    data[k + 2][j + 2][i] = at->hessian[3];
    data[k + 2][j][i + 2] = at->hessian[4];
    data[k][j + 2][i + 2] = at->hessian[5];
    data[k + 2][j + 2][i + 2] = at->third;
  }
  Contract(4, order, u[0], u[1], u[2], &data[0][0][0], sum);
}

/* d_0, d_1 of the edges along direction k: known second derivatives at the ends minus those of the cubic. */
static inline void CurvatureSurplus(const LamJet corner[8], PetscInt k, PetscReal h, PetscReal surplus[8])
{
  const PetscInt end = 1 << k;
  const PetscReal per_h = 1 / h;

  for (PetscInt c = 0; c < 8; c++) {
    const LamJet *at = &corner[c], *low = &corner[c & ~end], *high = &corner[c | end];
    const PetscReal slope = (high->value - low->value) * per_h, sign = c & end ? -1 : 1;
    const PetscReal cubic = sign * (6 * slope - 2 * (low->gradient[k] + high->gradient[k] + at->gradient[k])) * per_h;

    surplus[c] = isnan(at->hessian[k]) ? 0 : at->hessian[k] - cubic;
  }
}

static inline void AddBubbles(const LamJet corner[8], PetscReal h, const PetscReal t[3], PetscInt order,
                              const Functions u[3], LamJet *sum)
{
  Functions q;

  for (PetscInt k = 0; k < 3; k++) {
    PetscReal surplus[8];
    LamJet jet = {0};

    CurvatureSurplus(corner, k, h, surplus);
    BubbleFunctions(t[k], h, q);
    Contract(2, order, k == 0 ? q : u[0], k == 1 ? q : u[1], k == 2 ? q : u[2], surplus, &jet);
    sum->value += jet.value;
    for (PetscInt i = 0; i < 3 && order > 0; i++) sum->gradient[i] += jet.gradient[i];
    for (PetscInt i = 0; i < 6 && order > 1; i++) sum->hessian[i] += jet.hessian[i];
  }
}

void LamHermiteQuintic(const LamJet corner[8], PetscReal h, const PetscReal t[3], LamJet *sum)
{
  Functions u[3];

  for (PetscInt k = 0; k < 3; k++) HermiteFunctions(t[k], h, u[k]);
  AddCubic(corner, u, 2, sum);
  AddBubbles(corner, h, t, 2, u, sum);
}

void LamHermiteQuinticSlope(const LamJet corner[8], PetscReal h, const PetscReal t[3], LamJet *sum)
{
  Functions u[3];

  for (PetscInt k = 0; k < 3; k++) HermiteFunctions(t[k], h, u[k]);
  AddCubic(corner, u, 1, sum);
  AddBubbles(corner, h, t, 1, u, sum);
}

PetscReal LamHermiteQuinticValue(const LamJet corner[8], PetscReal h, const PetscReal t[3])
{
  LamJet sum = {0};
  Functions u[3];

  for (PetscInt k = 0; k < 3; k++) HermiteFunctions(t[k], h, u[k]);
  AddCubic(corner, u, 0, &sum);
  AddBubbles(corner, h, t, 0, u, &sum);
  return sum.value;
}

void LamHermiteCubic(const LamJet corner[8], PetscReal h, const PetscReal t[3], LamJet *sum)
{
  Functions u[3];

  for (PetscInt k = 0; k < 3; k++) HermiteFunctions(t[k], h, u[k]);
  AddCubic(corner, u, 2, sum);
}

void LamHermiteSizes(const LamJet corner[8], PetscReal h, PetscReal bend[3], PetscReal spread[3])
{
  for (PetscInt k = 0; k < 3; k++) {
    PetscReal sum = 0, square = 0;
    PetscInt known = 0;

    for (PetscInt e = 0; e < 4; e++) { /* edges along k, from c */
      const PetscInt c = e % (1 << k) + (e >> k << (k + 1));
      const LamJet *low = &corner[c], *high = &corner[c | 1 << k];
      const PetscReal rise = 6 * (high->value - low->value), g0 = h * low->gradient[k], g1 = h * high->gradient[k];
      const PetscReal d0 = h * h * low->hessian[k] - (rise - 4 * g0 - 2 * g1),
                      d1 = h * h * high->hessian[k] - (2 * g0 + 4 * g1 - rise);

      for (PetscInt end = 0; end < 2; end++) {
        const PetscReal d = end ? d1 : d0;

        if (isnan(d)) continue;
        known++;
        sum += d;
        square += d * d;
      }
    }
    bend[k] = sqrt(square / 8) / h;
    spread[k] = known ? sqrt(PetscMax(0, square - sum * sum / (PetscReal)known) / 8) / h : 0;
  }
}

/*
  The trilinear function of the values, plus for each edge the difference between its cubic and its line:
  D_0 (g_0 - slope) + D_1 (g_1 - slope), g the gradient along the edge, slope that of the line.
*/
void LamHermiteEdges(const LamJet corner[8], PetscReal h, const PetscReal t[3], PetscReal *value, PetscReal gradient[3])
{
  Functions linear[3], rise;
  PetscReal data[8];
  LamJet jet = {0};

  for (PetscInt k = 0; k < 3; k++) {
    linear[k][0][0] = 1 - t[k];
    linear[k][0][1] = t[k];
    linear[k][1][0] = -1 / h;
    linear[k][1][1] = 1 / h;
  }
  for (PetscInt c = 0; c < 8; c++) data[c] = corner[c].value;
  Contract(2, 1, linear[0], linear[1], linear[2], data, &jet);
  for (PetscInt k = 0; k < 3; k++) {
    Functions u;

    HermiteFunctions(t[k], h, u);
    for (PetscInt d = 0; d < 2; d++)
      for (PetscInt e = 0; e < 2; e++) rise[d][e] = u[d][e + 2];
    for (PetscInt c = 0; c < 8; c++)
      data[c] = corner[c].gradient[k] - (corner[c | 1 << k].value - corner[c & ~(1 << k)].value) / h;
    Contract(2, 1, k == 0 ? rise : linear[0], k == 1 ? rise : linear[1], k == 2 ? rise : linear[2], data, &jet);
  }
  *value = jet.value;
  for (PetscInt i = 0; i < 3; i++) gradient[i] = jet.gradient[i];
}
