/*
  Components of F as unknowns of a Newton iteration, for prescribed stress (docs/theory/solver.md, Mixed control).

  Method. The iteration finds a stationary point of L(y, q) - V0 P.q over the positions y (for contact tissue, also the
  active multipliers) and the free components q of F. Its linear system is bordered,

    [ K    R    ] [ dy ]     [ r            ]
    [ R^T  L_qq ] [ dq ] = - [ L_q - V0 P   ],       R = L_yq,

  and is solved with the iteration's factorisation of K and one more right-hand side per free component.
*/
#ifndef LAM_RVE_BORDER_H
#define LAM_RVE_BORDER_H

#include "measure.h"

#define LAM_SMALL 9 /* most components of F that are free */

typedef struct {
  LamLoad load;                /* of the iterate, with its current F */
  PetscInt count;              /* number of free components */
  PetscInt q[LAM_F_COUNT];     /* [count] their indices, of LAM_F_COUNT */
  PetscReal P[LAM_F_COUNT];    /* [count] prescribed stress */
  PetscReal rest[LAM_F_COUNT]; /* [count] L_q - V0 P at the iterate, without the multiplier terms */
  PetscReal Lqq[LAM_F_COUNT][LAM_F_COUNT];
  PetscReal *R;              /* [LAM_F_COUNT][n] */
  PetscReal *rhs, *solution; /* [count + 1][n] */
  PetscReal dF[9];           /* step of F */
  PetscBool descend;         /* steps of F lower the energy where it is not convex in F */
} LamBorder;

/* A border that may be NULL then stands for a fully prescribed F. */
PetscErrorCode LamBorderCreate(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamBorder **border);
PetscErrorCode LamBorderDestroy(LamBorder **border);
/* Call after LamAssemble at the iterate. Computes L_q, L_qq and R; norm: in, of the residual; out, of both
   residuals. */
PetscErrorCode LamBorderAssemble(LamRVE rve, LamBorder *border, PetscReal *norm);
/* Solves K dy + R dq = rhs with the current factorisation: solution = dy, dF = the step of F. rhs, solution: [n]. */
PetscErrorCode LamBorderSolve(LamRVE rve, LamBorder *border, const PetscReal rhs[], PetscReal solution[]);
/* Length of a step: the larger of max |dF| and max |dy - dF X| in apothems. dy: positions without the held class. */
PetscReal LamBorderReach(LamRVE rve, const LamBorder *border, const PetscReal dy[]);
/* Step of F, row-major 3 x 3; zero for prescribed components. */
const PetscReal *LamBorderStep(const LamBorder *border);
/* Returns `load` with F + alpha dF. */
LamLoad LamBorderMoved(const LamBorder *border, const LamLoad *load, PetscReal alpha);
/* Eigenvalues w, ascending, and unit eigenvectors V[k] of the symmetric A[n][n]. w[0] is NaN if LAPACK fails. */
PetscErrorCode LamSmallEigenvectors(PetscInt n, const PetscReal A[LAM_SMALL][LAM_SMALL], PetscReal w[LAM_SMALL],
                                    PetscReal V[LAM_SMALL][LAM_SMALL]);

#endif
