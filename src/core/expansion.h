/*
  Second-order model of the potential of a response, in variables that are invariant under rotation.
*/
#ifndef LAM_EXPANSION_H
#define LAM_EXPANSION_H

#include <lamella/response.h>

/* x = (c0, c1, c2, p, g): c0 = (C11 + C22)/2, c1 = (C11 - C22)/2, c2 = C12, turgor, cohesion; at one F33. */
#define LAM_VARIABLES 5
/*
  In the distance of loads, strain per pressure in units of C1 + C2: of turgor, which only compresses walls; of turgor
  with cohesion; and of turgor where the fluid does not fill what the walls leave (LamFluidFills).
*/
#define LAM_TURGOR_WEIGHT 0.011
#define LAM_SUCTION_WEIGHT 0.5
#define LAM_UNFILLED_WEIGHT 0.25

/*
  Value, gradient and Hessian at x of Phi = Psi + p J, J = det F. Without the fluid's part -p J the potential varies slowly with J
  and hardly with p (effective-stress principle, docs/theory/homogenisation.md). dPhi/dF33, i.e. P33 plus p times
  J in the plane, is a scalar function of the same variables, with its gradient. Bonded tissue does not depend on g: derivatives with respect to g are 0.
*/
typedef struct {
  PetscReal x[LAM_VARIABLES];
  PetscReal energy, gradient[LAM_VARIABLES], hessian[LAM_VARIABLES][LAM_VARIABLES];
  PetscReal F33, P33, P33_gradient[LAM_VARIABLES]; /* of dPhi/dF33 */
} LamExpansion;

/* The variables of a load. */
void LamVariables(const LamLoad *load, PetscReal x[LAM_VARIABLES]);
/* From a record with fields; PETSC_FALSE if one of its derivatives is unknown. */
PetscBool LamExpansionMake(const LamResponse *record, PetscBool bonded, LamExpansion *expansion);
/* The same model at x, with the Hessian of the expansion. `moved` may be `expansion`. */
void LamExpansionMove(const LamExpansion *expansion, const PetscReal x[LAM_VARIABLES], LamExpansion *moved);
/* The same model at another F33, to second order; A3333: as below. */
void LamExpansionStretch(PetscReal A3333, PetscReal F33, LamExpansion *expansion);
/*
  The metric of P in its derivatives with respect to C: |P|^2 in the plane = sum_ab v_a B_ab v_b for P = sum v_a K_a,
  K_a = dc_a/dF.
*/
void LamStressMetric(const PetscReal F[9], PetscReal B[3][3]);
/*
  Writes energy, P, tangent and the derivatives with respect to turgor and cohesion into `response`, whose load must be
  the state of the expansion. A3333: entry 33, 33 of the tangent, which does not follow from the expansion.
*/
void LamExpansionToResponse(const LamExpansion *expansion, PetscReal A3333, LamResponse *response);

#endif
