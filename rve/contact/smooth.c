#include "smooth.h"

#define LEAST_H 0.05 /* of m: bounds d2(gap) where a wall is bent as sharply as a point lies deep in it */
#define ROOT_STEPS 60
#define PIECES 8 /* in which minima of the distance are looked for: a span of the degree 3 has 3 at most */

void LamTouchLawEvaluate(PetscReal gap, PetscReal width, LamTouchLaw *law)
{
  const PetscReal x = gap / width, rest = 1.0 - x;
  PetscReal f, t, dt; /* phi / (s w) = f(x), t / s = -f', dt = -t' = f'' */

  if (x >= 1.0) {
    f = t = dt = 0.0;
  } else if (x >= 0.0) {
    f = rest * rest * rest / 3.0;
    t = rest * rest;
    dt = 2.0 * rest;
  } else {
    const PetscReal e = PetscExpReal(-2.0 * PetscMax(x, -LAM_SOFT_WIDTHS));
    const PetscReal deeper = PetscMax(0.0, -LAM_SOFT_WIDTHS - x);

    f = 1.0 / 3.0 + 0.5 * (e - 1.0) + e * (deeper + deeper * deeper);
    t = e * (1.0 + 2.0 * deeper);
    dt = 2.0 * e;
  }
  law->phi = width * f;
  law->d = -t;
  law->dd = dt / width;
  law->phi_width = f + x * t;
  law->d_width = -x * dt / width;
}

void LamSplineWeightsAt(PetscReal t, LamSplineWeights *w)
{
  const PetscReal r = 1.0 - t;

  w->N[0] = r * r * r / 6.0;
  w->N[1] = (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
  w->N[2] = (4.0 - 6.0 * r * r + 3.0 * r * r * r) / 6.0;
  w->N[3] = t * t * t / 6.0;
  w->dN[0] = -0.5 * r * r;
  w->dN[1] = 1.5 * t * t - 2.0 * t;
  w->dN[2] = -1.5 * r * r + 2.0 * r;
  w->dN[3] = 0.5 * t * t;
  w->ddN[0] = r;
  w->ddN[1] = 3.0 * t - 2.0;
  w->ddN[2] = 3.0 * r - 2.0;
  w->ddN[3] = t;
}

static inline PetscReal Dot(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[0] + a[1] * b[1];
}

void LamSplineCurveOf(const PetscReal c[LAM_SPAN][2], LamSplineCurve *curve)
{
  for (PetscInt d = 0; d < 2; ++d) {
    curve->a[0][d] = (c[0][d] + 4.0 * c[1][d] + c[2][d]) / 6.0;
    curve->a[1][d] = (c[2][d] - c[0][d]) / 2.0;
    curve->a[2][d] = (c[0][d] - 2.0 * c[1][d] + c[2][d]) / 2.0;
    curve->a[3][d] = (c[3][d] - c[0][d] + 3.0 * (c[1][d] - c[2][d])) / 6.0;
  }
}

/* (X - y).tau, and its slope. */
static inline PetscReal Along(const LamSplineCurve *curve, const PetscReal X[2], PetscReal t, PetscReal *slope)
{
  PetscReal y[2], tau[2], bend[2];

  LamSplineAt(curve, t, y, tau, bend);

  const PetscReal z[2] = {X[0] - y[0], X[1] - y[1]};

  *slope = Dot(z, bend) - Dot(tau, tau);
  return Dot(z, tau);
}

/* Newton's method on (X - y).tau = 0 from the zero of its chord, safeguarded by bisection. The last step leaves an
   error of about its square, the rounding. */
static PetscReal RootBetween(const LamSplineCurve *curve, const PetscReal X[2], PetscReal low, PetscReal high,
                             const PetscReal ends[2])
{
  PetscReal slope, t = low + (high - low) * PetscMax(0.0, PetscMin(1.0, ends[0] / (ends[0] - ends[1])));

  for (PetscInt k = 0; k < ROOT_STEPS; ++k) {
    const PetscReal value = Along(curve, X, t, &slope), before = t;

    if (value > 0.0)
      low = t;
    else
      high = t;
    t -= value / slope;
    if (!(slope < 0.0 && t >= low && t <= high)) t = 0.5 * (low + high);
    if (PetscAbsReal(t - before) <= PetscSqrtReal(0.5 * PETSC_MACHINE_EPSILON)) break;
  }
  return t;
}

/* Changes of sign of the Bernstein coefficients of (X - y).tau, of the degree 5, but for positive factors: as many
   zeros at most, and an even number less. */
static PetscInt SignChanges(const LamSplineCurve *curve, const PetscReal X[2])
{
  PetscReal z[LAM_SPAN][2], q[LAM_SPAN - 1][2], w[6];
  PetscInt changes = 0;

  for (PetscInt d = 0; d < 2; ++d) {
    const PetscReal a1 = curve->a[1][d] / 3.0, a2 = curve->a[2][d] / 3.0;

    q[0][d] = a1;
    q[1][d] = a1 + a2;
    q[2][d] = a1 + 2.0 * a2 + curve->a[3][d];
    z[0][d] = X[d] - curve->a[0][d];
    for (PetscInt k = 0; k < 3; ++k) z[k + 1][d] = z[k][d] - q[k][d];
  }
  w[0] = Dot(z[0], q[0]);
  w[1] = 2.0 * Dot(z[0], q[1]) + 3.0 * Dot(z[1], q[0]);
  w[2] = Dot(z[0], q[2]) + 6.0 * Dot(z[1], q[1]) + 3.0 * Dot(z[2], q[0]);
  w[3] = 3.0 * Dot(z[1], q[2]) + 6.0 * Dot(z[2], q[1]) + Dot(z[3], q[0]);
  w[4] = 3.0 * Dot(z[2], q[2]) + 2.0 * Dot(z[3], q[1]);
  w[5] = Dot(z[3], q[2]);
  for (PetscInt k = 1; k < 6; ++k) changes += (w[k] > 0.0) != (w[k - 1] > 0.0);
  return changes;
}

PetscBool LamSplineClosest(const LamSplineCurve *curve, const PetscReal X[2], const PetscReal ends[2],
                           PetscBool has_one, PetscReal *t)
{
  PetscReal least = PETSC_INFINITY, at[2] = {ends[0], ends[0]}, slope, y[2], tau[2], bend[2];

  if (has_one || SignChanges(curve, X) < 2) {
    if (!(ends[0] > 0.0) || ends[1] > 0.0) return PETSC_FALSE;
    *t = RootBetween(curve, X, 0.0, 1.0, ends);
    return PETSC_TRUE;
  }
  for (PetscInt k = 1; k <= PIECES; ++k) {
    const PetscReal low = (PetscReal)(k - 1) / PIECES, high = (PetscReal)k / PIECES;

    at[0] = at[1];
    at[1] = k == PIECES ? ends[1] : Along(curve, X, high, &slope);
    if (!(at[0] > 0.0) || at[1] > 0.0) continue;

    const PetscReal root = RootBetween(curve, X, low, high, at);

    LamSplineAt(curve, root, y, tau, bend);
    const PetscReal square = PetscSqr(X[0] - y[0]) + PetscSqr(X[1] - y[1]);

    if (square < least) *t = root;
    least = PetscMin(least, square);
  }
  return (PetscBool)(least < PETSC_INFINITY);
}

void LamTouchGapAt(const LamSplineCurve *curve, const PetscReal X[2], PetscReal t, LamTouchGap *gap)
{
  PetscReal y[2], bend[2], length;

  LamSplineAt(curve, t, y, gap->tangent, bend);
  gap->t = t;
  gap->m = Dot(gap->tangent, gap->tangent);
  length = PetscSqrtReal(gap->m);
  gap->normal[0] = gap->tangent[1] / length;
  gap->normal[1] = -gap->tangent[0] / length;
  gap->gap = (X[0] - y[0]) * gap->normal[0] + (X[1] - y[1]) * gap->normal[1];
  gap->b = Dot(bend, gap->normal);
  gap->H = PetscMax(gap->m - gap->gap * gap->b, LEAST_H * gap->m);
}

/*
  d2(gap) = -(N0 T + T N0 + gap N0 N0 + (b/m) T T) / H with N = n.(dX - dy), T = tau.(dX - dy), N0 = n.dy_u. For nodes i
  and j, components d and e, that is
    N_i N_j A_de + dN_i N_j B_de + N_i dN_j B_ed + dN_i dN_j C_de,
  A = factor2 n n - over b/m tau tau, B = -over n tau, C = -over gap n n, over = factor1/H.
*/
void LamTouchAddVariation(const LamTouchGap *gap, const LamTouchWeights *weights, PetscReal factor1, PetscReal factor2,
                          PetscReal f[LAM_BLOCK_DOFS], PetscReal K[LAM_BLOCK_DOFS][LAM_BLOCK_DOFS])
{
  const PetscReal over = factor1 / gap->H, *n = gap->normal, *tau = gap->tangent, *N = weights->N, *dN = weights->dN;

  for (PetscInt i = 0; i < LAM_BLOCK_DOFS; ++i) f[i] += factor1 * N[i / 2] * n[i % 2];
  if (!K) return;
  for (PetscInt d = 0; d < 2; ++d) {
    PetscReal by_N[LAM_BLOCK_DOFS], by_dN[LAM_BLOCK_DOFS]; /* factors of N_i and dN_i */

    for (PetscInt e = 0; e < 2; ++e) {
      const PetscReal A = factor2 * n[d] * n[e] - over * gap->b / gap->m * tau[d] * tau[e];
      const PetscReal B = -over * n[d] * tau[e], Bt = -over * n[e] * tau[d], C = -over * gap->gap * n[d] * n[e];

      for (PetscInt j = 0; j < LAM_BLOCK_NODES; ++j) {
        by_N[2 * j + e] = A * N[j] + Bt * dN[j];
        by_dN[2 * j + e] = B * N[j] + C * dN[j];
      }
    }
    for (PetscInt i = 0; i < LAM_SPAN_NODES; ++i)
      for (PetscInt j = 0; j < LAM_BLOCK_DOFS; ++j) K[2 * i + d][j] += N[i] * by_N[j];
    for (PetscInt i = LAM_SPAN_NODES; i < LAM_BLOCK_NODES; ++i)
      for (PetscInt j = 2 * LAM_SPAN_NODES; j < LAM_BLOCK_DOFS; ++j)
        K[2 * i + d][j] += N[i] * by_N[j] + dN[i] * by_dN[j];
  }
}
