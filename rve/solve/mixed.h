/* States under prescribed stress: mixed.c, mixed_fast.c, mixed_safe.c. */
#ifndef LAM_RVE_MIXED_H
#define LAM_RVE_MIXED_H

#include "solve.h"

#define LAM_MIXED_SOFTEST 1e-9 /* C1 + C2: at or below this, stiffness under prescribed stress counts as zero */

/* A solved state restricted to the free components of F. */
typedef struct {
  PetscInt count;
  PetscInt component[LAM_SMALL];     /* [count] their indices in a row-major 3 x 3 */
  PetscReal excess[LAM_SMALL];       /* [count] P - prescribed P */
  PetscReal largest;                 /* of |excess| */
  PetscReal A[LAM_SMALL][LAM_SMALL]; /* dP/dF of the free components */
  PetscReal w[LAM_SMALL];            /* [count] eigenvalues of A, ascending */
  PetscReal V[LAM_SMALL][LAM_SMALL]; /* [count] their eigenvectors */
  PetscReal potential;               /* Psi - P.F; a stable state minimises it over these components */
} LamMixedView;

/* ---- mixed.c ---- */
PetscErrorCode LamMixedLook(const LamStressControl *control, const LamResponse *response, LamMixedView *view);
static inline PetscBool LamMixedIsStable(const LamMixedView *view)
{
  return (PetscBool)(view->w[0] > LAM_MIXED_SOFTEST);
}

/* Whether positions have a third component: there is no fast tier then. */
PetscBool LamMixedIsOutOfPlane(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state);

/* ---- mixed_fast.c, mixed_safe.c ---- */
/* Solve from `state` with the initial guess load->F; a solution replaces `state`. The response counts all iterations
   and factorisations. Fast: Newton's method on positions and F together; its solution need not be stable under the
   control, and on failure load->F may hold a better guess. Safe: continuation from `state`, then descent on the
   potential. */
PetscErrorCode LamMixedFast(LamRVE rve, LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response);
PetscErrorCode LamMixedSafe(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response);

#endif
