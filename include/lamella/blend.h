/*
  Interpolation of responses between tissues (the knots) that differ in one number v.

  Their potentials are combined with fixed weights w_i(v), so that stress and tangent are the exact derivatives of one
  potential:  Psi = sum_i w_i(v) Psi_i(F, p, g),  sum w_i = 1. Weights: Lagrange interpolation in ln v through the
  nearest four knots (or all, if there are fewer); in v if the first knot is 0. Quantities that are not derivatives of
  Psi are interpolated linearly between the two knots next to v, which keeps their bounds.
*/
#ifndef LAMELLA_BLEND_H
#define LAMELLA_BLEND_H

#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

enum { LAM_BLEND_TERMS = 4 };

/* Contribution of a knot. Each of the three weights sums to 1 over the terms. */
typedef struct {
  PetscInt knot;
  PetscReal weight; /* of its potential */
  PetscReal coarse; /* likewise, without the knot farthest from v; of two knots, shifted by 1/4 */
  PetscReal share;  /* of its indicators, in [0, 1] */
} LamBlendTerm;

/* Computes the terms at `value`, which must lie between the first and the last of n ascending knots; returns their
   number. */
LAM_EXPORT PetscInt LamBlendAt(PetscInt n, const PetscReal knots[], PetscReal value,
                               LamBlendTerm terms[LAM_BLEND_TERMS]);

/*
  Combines the responses of n terms; at[i], which has fields, belongs to terms[i]. All are in the same units, for the
  load with which *response was initialised (LamResponseInit). error_estimate: the weighted estimates of the terms
  plus the change of P with the coarse weights. Status: converged, or unstable if a term is unstable.
*/
LAM_EXPORT void LamBlend(LamStressScale scale, PetscInt n, const LamBlendTerm terms[], const LamResponse at[],
                         LamResponse *response);

LAM_C_END

#endif
