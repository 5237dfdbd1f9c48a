/*
  Components of F as unknowns of a Newton iteration, for prescribed stress (docs/theory/solver.md, Mixed control).

  Method. The iteration seeks a stationary point of L(y, q) - V0 P.q over the positions y (in contact with the active
  multipliers) and the free components q of F. Its linear system is bordered,

    [ K    R    ] [ dy ]     [ r            ]
    [ R^T  L_qq ] [ dq ] = - [ L_q - V0 P   ],       R = L_yq,

  and is solved with the factor of K that the iteration has anyway: one more right-hand side per free component.
*/
#ifndef LAM_RVE_BORDER_H
#define LAM_RVE_BORDER_H

#include "measure.h"

typedef struct {
  LamLoad load;                    /* of the iterate: F moves with it */
  PetscInt count;                  /* of free components */
  PetscInt q[LAM_F_COUNT];         /* [count] which, of LAM_F_COUNT */
  PetscReal P[LAM_F_COUNT];        /* [count] the stress prescribed there */
  PetscReal residual[LAM_F_COUNT]; /* [count] L_q - V0 P of the iterate */
  PetscReal rest[LAM_F_COUNT];     /* [count] the same without the multipliers, for which the linear system is solved */
  PetscReal Lqq[LAM_F_COUNT][LAM_F_COUNT];
  PetscReal *R;              /* [LAM_F_COUNT][n] */
  PetscReal *rhs, *solution; /* [count + 1][n] */
  PetscReal dF[9];           /* the step */
  PetscBool freeze_F;        /* F does in this iteration */
  PetscInt patience;         /* iterations left in which F waits for contact to settle where the step would be long */
} LamBorder;

/* Where a border may be NULL, F is prescribed. */
PetscErrorCode LamBorderCreate(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamBorder **border);
PetscErrorCode LamBorderDestroy(LamBorder **border);
/* After LamAssemble at the iterate: L_q, L_qq, R; norm becomes that of both residuals. */
PetscErrorCode LamBorderAssemble(LamRVE rve, LamBorder *border, PetscReal *norm);
/* solution = dy for K dy + R dq = rhs, with the present factor, and the step of F; both of length n. */
PetscErrorCode LamBorderSolve(LamRVE rve, LamBorder *border, const PetscReal rhs[], PetscReal solution[]);
/* How far a step dy [positions, without the held class] goes beyond the affine part of the step of F, apothems, or the
   latter, if it is larger. */
PetscReal LamBorderReach(LamRVE rve, const LamBorder *border, const PetscReal dy[]);
/* The step of F, zero where it is prescribed. */
const PetscReal *LamBorderStep(const LamBorder *border);
/* `load` with F moved by alpha along the step. */
LamLoad LamBorderMoved(const LamBorder *border, const LamLoad *load, PetscReal alpha);
/* Eigenvalues w, ascending, and unit eigenvectors V[k] of the symmetric A[n][n]. */
PetscErrorCode LamSmallEigenvectors(PetscInt n, const PetscReal A[LAM_F_COUNT][LAM_F_COUNT], PetscReal w[LAM_F_COUNT],
                                    PetscReal V[LAM_F_COUNT][LAM_F_COUNT]);

#endif
