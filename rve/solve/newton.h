/*
  What the tiers of the Newton iteration share.
*/
#ifndef LAM_NEWTON_H
#define LAM_NEWTON_H

#include "solve.h"

/* Factors K + shift 1 with the smallest tried shift that leaves no negative eigenvalue but those expected; least: the
   first shift tried, if below 1e-7 of the diagonal; last_shift: of the factorisation before. */
PetscErrorCode LamFactorPositive(LamRVE rve, PetscReal least, PetscReal *last_shift, PetscBool *ok);
/* rve->step := -K^-1 residual with the present factor, or that of the bordered system; the held class does not move. */
PetscErrorCode LamSolveStep(LamRVE rve, LamBorder *border);
/* Largest of 1, 1/2, ... 1/64 for which no volume along rve->step turns inside out; 0: none. */
PetscErrorCode LamValidStep(LamRVE rve, const LamLoad *load, const LamBorder *border, PetscReal *alpha);
/* Positions, independent stresses and the free components of F move by alpha steps. */
void LamTakeStep(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal alpha);
/* A step that moves nothing by more than rounding ends the iteration, also where the residual cannot come down to the
   tolerance because large stresses cancel in it. */
PetscBool LamAtRounding(LamRVE rve, PetscReal norm, PetscReal tolerance, PetscReal largest);
/* For the monitor. */
PetscErrorCode LamReportIteration(LamRVE rve, const char tier[], PetscInt iteration, PetscReal residual, PetscReal step,
                                  PetscReal shift);

#endif
