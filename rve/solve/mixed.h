/* Shared by the files that find states under prescribed stress: mixed.c, mixed_fast.c, mixed_safe.c. */
#ifndef LAM_RVE_MIXED_H
#define LAM_RVE_MIXED_H

#include "solve.h"

#define LAM_MIXED_SOFTEST 1e-9 /* C1 + C2: stiffness under prescribed stress that counts as none */

/* A solved state as the control sees it: over the free components of F. */
typedef struct {
  PetscInt count;
  PetscInt component[LAM_F_COUNT];       /* [count] their places in a row-major 3 x 3 */
  PetscReal excess[LAM_F_COUNT];         /* [count] P - prescribed P */
  PetscReal largest;                     /* of |excess| */
  PetscReal A[LAM_F_COUNT][LAM_F_COUNT]; /* dP/dF of the free components */
  PetscReal w[LAM_F_COUNT];              /* [count] eigenvalues of A, ascending */
  PetscReal V[LAM_F_COUNT][LAM_F_COUNT]; /* [count] their eigenvectors */
  PetscReal potential;                   /* Psi - P.F, which a stable state minimises over them */
} LamMixedView;

/* ---- mixed.c ---- */
PetscErrorCode LamMixedLook(const LamStressControl *control, const LamResponse *response, LamMixedView *view);
static inline PetscBool LamMixedIsStable(const LamMixedView *view)
{
  return (PetscBool)(view->w[0] > LAM_MIXED_SOFTEST);
}

/* ---- mixed_fast.c, mixed_safe.c ---- */
/* From `state`, which a solution replaces, with the first guess load->F; iterations and factorisations of the response
   count all of it. Fast: one Newton iteration on positions and F; what it finds need not be stable under the control,
   and where it fails load->F may be a better guess. Safe: continuation from `state`, then descent on the potential. */
PetscErrorCode LamMixedFast(LamRVE rve, LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response);
PetscErrorCode LamMixedSafe(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response);

#endif
