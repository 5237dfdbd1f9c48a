#include "smooth.h"

#define LEAST_H 0.05 /* of m: bounds d2(gap) where a wall is bent as sharply as a point lies deep in it */
#define ROOT_STEPS 60

void LamTouchLawEvaluate(PetscReal gap, PetscReal width, LamTouchLaw *law)
{
  const PetscReal x = gap / width, e = PetscExpReal(-2.0 * PetscMax(x, -LAM_SOFT_WIDTHS)), rest = 1.0 - x;
  PetscReal f, t, dt; /* phi / (s w) = f(x), t / s = -f', dt = -t' = f'' */

  if (x >= 1.0) {
    f = t = dt = 0.0;
  } else if (x >= 0.0) {
    f = rest * rest * rest / 3.0;
    t = rest * rest;
    dt = 2.0 * rest;
  } else {
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

/* Newton's method on (X - y).tau = 0, safeguarded by bisection. */
PetscReal LamSplineClosest(const PetscReal c[LAM_SPAN][2], const PetscReal X[2])
{
  PetscReal low = 0.0, high = 1.0, t = 0.5;

  for (PetscInt k = 0; k < ROOT_STEPS; ++k) {
    LamSplineWeights w;
    PetscReal y[2], tau[2], bend[2], next;

    LamSplineWeightsAt(t, &w);
    LamSplineSum(w.N, c, y);
    LamSplineSum(w.dN, c, tau);
    LamSplineSum(w.ddN, c, bend);

    const PetscReal z[2] = {X[0] - y[0], X[1] - y[1]};
    const PetscReal value = Dot(z, tau), slope = Dot(z, bend) - Dot(tau, tau);

    if (value > 0.0)
      low = t;
    else
      high = t;
    next = t - value / slope;
    if (!(slope < 0.0 && next >= low && next <= high)) next = 0.5 * (low + high);
    if (PetscAbsReal(next - t) <= 2.0 * PETSC_MACHINE_EPSILON) return next;
    t = next;
  }
  return t;
}

void LamTouchGapAt(const PetscReal c[LAM_SPAN][2], const PetscReal X[2], PetscReal t, LamTouchGap *gap)
{
  PetscReal y[2], bend[2], length;

  LamSplineWeightsAt(t, &gap->master);
  LamSplineSum(gap->master.N, c, y);
  LamSplineSum(gap->master.dN, c, gap->tangent);
  LamSplineSum(gap->master.ddN, c, bend);
  gap->m = Dot(gap->tangent, gap->tangent);
  length = PetscSqrtReal(gap->m);
  gap->normal[0] = gap->tangent[1] / length;
  gap->normal[1] = -gap->tangent[0] / length;
  gap->gap = (X[0] - y[0]) * gap->normal[0] + (X[1] - y[1]) * gap->normal[1];
  gap->b = Dot(bend, gap->normal);
  gap->H = PetscMax(gap->m - gap->gap * gap->b, LEAST_H * gap->m);
}

/* d2(gap) = -(N0 T + T N0 + gap N0 N0 + (b/m) T T) / H with N = n.(dX - dy), T = tau.(dX - dy), N0 = n.dy_u. */
void LamTouchAddVariation(const LamTouchGap *gap, const PetscReal slave[LAM_SPAN], PetscReal factor1, PetscReal factor2,
                          PetscReal f[LAM_TOUCH_DOFS], PetscReal K[LAM_TOUCH_DOFS][LAM_TOUCH_DOFS])
{
  const PetscReal over = factor1 / gap->H;
  PetscReal N[LAM_TOUCH_DOFS], T[LAM_TOUCH_DOFS], N0[LAM_TOUCH_DOFS];

  for (PetscInt a = 0; a < LAM_SPAN; ++a)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt s = 2 * a + d, m = 2 * (LAM_SPAN + a) + d;

      N[s] = slave[a] * gap->normal[d];
      T[s] = slave[a] * gap->tangent[d];
      N0[s] = 0.0;
      N[m] = -gap->master.N[a] * gap->normal[d];
      T[m] = -gap->master.N[a] * gap->tangent[d];
      N0[m] = gap->master.dN[a] * gap->normal[d];
    }
  for (PetscInt i = 0; i < LAM_TOUCH_DOFS; ++i) f[i] += factor1 * N[i];
  if (!K) return;
  for (PetscInt i = 0; i < LAM_TOUCH_DOFS; ++i) {
    const PetscReal n = factor2 * N[i], n0 = -over * (T[i] + gap->gap * N0[i]);
    const PetscReal t = -over * (N0[i] + gap->b / gap->m * T[i]);

    for (PetscInt j = 0; j < LAM_TOUCH_DOFS; ++j) K[i][j] += n * N[j] + n0 * N0[j] + t * T[j];
  }
}
