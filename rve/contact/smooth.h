/*
  Kernel of the smooth contact potential: law, spline contour, closest point, first and second variation of the gap.
  Independent of cells; all formulas are derived in docs/theory/contact.md (The smooth law).

  A contour is a closed uniform cubic B-spline y(u). Its span k, with local coordinate t in [0, 1], has the four control
  points k - 1, k, k + 1, k + 2. The outward side lies to the right of the direction of increasing u:
  n = (tau_2, -tau_1)/|tau|, tau = y_u.
*/
#ifndef LAM_RVE_SMOOTH_H
#define LAM_RVE_SMOOTH_H

#include <petscsys.h>

#define LAM_SPAN 4                           /* control points of a span */
#define LAM_SPAN_NODES 5                     /* nodes that these depend on */
#define LAM_BLOCK_NODES (2 * LAM_SPAN_NODES) /* of a point, then of the span that it is near to */
#define LAM_BLOCK_DOFS (2 * LAM_BLOCK_NODES) /* 2 node + component */
#define LAM_SOFT_WIDTHS 2.0                  /* penetration, in widths, beyond which the energy is quadratic */

/* Energy of a gap per strength s and length, and its derivatives with respect to the gap and the width:
     t = -phi' = s (1 - g/w)^2 for 0 <= g <= w,  s exp(-2 g/w) for -2 w <= g <= 0,  further in its tangent. */
typedef struct {
  PetscReal phi, d, dd;         /* phi/s, phi'/s, phi''/s */
  PetscReal phi_width, d_width; /* derivatives of phi/s and phi'/s with respect to the width */
} LamTouchLaw;
void LamTouchLawEvaluate(PetscReal gap, PetscReal width, LamTouchLaw *law);

/* Weights of the control points and their first and second derivatives at t. */
typedef struct {
  PetscReal N[LAM_SPAN], dN[LAM_SPAN], ddN[LAM_SPAN];
} LamSplineWeights;
void LamSplineWeightsAt(PetscReal t, LamSplineWeights *weights);
static inline void LamSplineSum(const PetscReal N[LAM_SPAN], const PetscReal c[LAM_SPAN][2], PetscReal sum[2])
{
  for (PetscInt d = 0; d < 2; ++d) sum[d] = N[0] * c[0][d] + N[1] * c[1][d] + N[2] * c[2][d] + N[3] * c[3][d];
}

/* A span as a polynomial: y = a0 + a1 t + a2 t^2 + a3 t^3. */
typedef struct {
  PetscReal a[LAM_SPAN][2];
} LamSplineCurve;
void LamSplineCurveOf(const PetscReal c[LAM_SPAN][2], LamSplineCurve *curve);
/* y, y_u and y_uu at t. */
static inline void LamSplineAt(const LamSplineCurve *curve, PetscReal t, PetscReal y[2], PetscReal tau[2],
                               PetscReal bend[2])
{
  for (PetscInt d = 0; d < 2; ++d) {
    const PetscReal a1 = curve->a[1][d], a2 = curve->a[2][d], a3 = curve->a[3][d];

    y[d] = curve->a[0][d] + t * (a1 + t * (a2 + t * a3));
    tau[d] = a1 + t * (2.0 * a2 + t * 3.0 * a3);
    bend[d] = 2.0 * a2 + t * 6.0 * a3;
  }
}

/* t of the point of a span where the distance of X is least of its minima, in which (X - y).tau goes from above 0 to
   below; its values at both ends are given, so that spans that follow each other agree. PETSC_FALSE: there is none.
   has_one: there is one at most, otherwise there may be some where the span is bent sharply. */
PetscBool LamSplineClosest(const LamSplineCurve *curve, const PetscReal X[2], const PetscReal ends[2],
                           PetscBool has_one, PetscReal *t);

/* Gap of a point X from the closest point of a span, and what its variation needs. */
typedef struct {
  PetscReal t, gap;
  PetscReal normal[2], tangent[2]; /* n, tau */
  PetscReal m, b, H;               /* tau.tau, y_uu.n, m - gap b (kept above a share of m) */
} LamTouchGap;
void LamTouchGapAt(const LamSplineCurve *curve, const PetscReal X[2], PetscReal t, LamTouchGap *gap);

/* Dependence on the nodes: X - y = sum N x, y_u = sum dN x; dN is zero for the nodes of the point. */
typedef struct {
  PetscReal N[LAM_BLOCK_NODES], dN[LAM_BLOCK_NODES];
} LamTouchWeights;
/* Adds factor1 d(gap) to f, and factor1 d2(gap) + factor2 d(gap) d(gap) to K (may be NULL), which is symmetric: its
   rows of the span's nodes are not set in the columns of the point's nodes. */
void LamTouchAddVariation(const LamTouchGap *gap, const LamTouchWeights *weights, PetscReal factor1, PetscReal factor2,
                          PetscReal f[LAM_BLOCK_DOFS], PetscReal K[LAM_BLOCK_DOFS][LAM_BLOCK_DOFS]);

#endif
