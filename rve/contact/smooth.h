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

#define LAM_SPAN 4                    /* control points of a span */
#define LAM_TOUCH_DOFS (4 * LAM_SPAN) /* of a point and a span: 2 node + component, the point's nodes first */
#define LAM_SOFT_WIDTHS 2.0           /* penetration, in widths, beyond which the energy is quadratic */

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

/* t of the point of span c closest to X, whose distance has a minimum inside: (X - y).tau is positive at the start and
   not at the end. */
PetscReal LamSplineClosest(const PetscReal c[LAM_SPAN][2], const PetscReal X[2]);

/* Gap of a point X from the closest point of a span, and what its variation needs. */
typedef struct {
  PetscReal gap;
  PetscReal normal[2], tangent[2]; /* n, tau */
  PetscReal m, b, H;               /* tau.tau, y_uu.n, m - gap b (kept above a share of m) */
  LamSplineWeights master;         /* at the closest point */
} LamTouchGap;
void LamTouchGapAt(const PetscReal c[LAM_SPAN][2], const PetscReal X[2], PetscReal t, LamTouchGap *gap);

/* Adds factor1 d(gap) to f, and factor1 d2(gap) + factor2 d(gap) d(gap) to K (may be NULL), with respect to the control
   points of the point, whose weights are N, and of the span. */
void LamTouchAddVariation(const LamTouchGap *gap, const PetscReal N[LAM_SPAN], PetscReal factor1, PetscReal factor2,
                          PetscReal f[LAM_TOUCH_DOFS], PetscReal K[LAM_TOUCH_DOFS][LAM_TOUCH_DOFS]);

#endif
