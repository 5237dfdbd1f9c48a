/*
  Shared parts of the Newton tiers.
*/
#ifndef LAM_NEWTON_H
#define LAM_NEWTON_H

#include "solve.h"

/* Factors K + shift 1 with the first shift of an increasing sequence, from 0, that leaves no more negative eigenvalues
   than expected. least: first nonzero shift tried, if below 1e-7 of the largest diagonal entry; last_shift: in, of the
   previous factorisation, an eighth of which is tried first if larger; out, of this one. */
PetscErrorCode LamFactorPositive(LamRVE rve, PetscReal least, PetscReal *last_shift, PetscBool *ok);
/* rve->step := -K^-1 residual with the current factorisation, or the step of the bordered system; zero for the held
   class. */
PetscErrorCode LamSolveStep(LamRVE rve, LamBorder *border);
/* alpha: the largest of 1, 1/2, ... 1/64 for which rve->y + alpha rve->step inverts no element volume; 0: none. */
PetscErrorCode LamValidStep(LamRVE rve, const LamLoad *load, const LamBorder *border, PetscReal *alpha);
/* Updates positions, independent stresses and free components of F by alpha times the step. */
void LamTakeStep(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal alpha);
/* Whether a step is at rounding level, so that the iteration ends although the residual, in which large stresses
   cancel, may stay above the tolerance. largest: of the step's entries. */
PetscBool LamAtRounding(LamRVE rve, PetscReal norm, PetscReal tolerance, PetscReal largest);
/* Prints one line if the monitor is on. */
PetscErrorCode LamReportIteration(LamRVE rve, const char tier[], PetscInt iteration, PetscReal residual, PetscReal step,
                                  PetscReal shift);

#endif
