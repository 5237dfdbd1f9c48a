/*
  Answers for tissue between tissues that differ in one number v, the knots.

  Their potentials are combined with fixed weights w_i(v), so that stress and tangent are still the exact derivatives
  of one potential:  Psi = sum_i w_i(v) Psi_i(F, p, g),  sum w_i = 1.
  Weights: the polynomial in ln v through the nearest four knots (or all, where there are fewer); in v where the first
  knot is 0. What is no derivative of Psi keeps its bounds: it is interpolated between the two knots next to v.
*/
#ifndef LAMELLA_BLEND_H
#define LAMELLA_BLEND_H

#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

enum { LAM_BLEND_TERMS = 4 };

/* What a knot contributes. Each of the three sums up to 1 over the terms. */
typedef struct {
  PetscInt knot;
  PetscReal weight; /* of its potential */
  PetscReal coarse; /* likewise, without the knot farthest from v; of two knots, a quarter of the way to the other */
  PetscReal share;  /* of its indicators, in [0, 1] */
} LamBlendTerm;

/* The terms at `value`, which lies between the first and the last of n ascending knots; how many they are. */
LAM_EXPORT PetscInt LamBlendAt(PetscInt n, const PetscReal knots[], PetscReal value,
                               LamBlendTerm terms[LAM_BLEND_TERMS]);

/*
  The answer of n terms; at[i], which has fields, belongs to terms[i]. All in the same units, for the load that
  *response was initialised with (LamResponseInit). error_estimate: the terms' own, and the change of P with the coarse
  weights. Converged, or unstable where a term is so.
*/
LAM_EXPORT void LamBlend(PetscInt n, const LamBlendTerm terms[], const LamResponse at[], LamResponse *response);

LAM_C_END

#endif
