/*
  One step of a path that is controlled by what the lamella dissipates (dissipate.c): the linear systems and the steps.

    dissipate_system.c    residual, matrix and solves at an iterate, of all unknowns or of a window
    dissipate_iterate.c   the iteration from a first guess to a state
*/
#ifndef LAM_RVE_DISSIPATE_H
#define LAM_RVE_DISSIPATE_H

#include "contact_find.h"
#include "part.h"

#define LAM_DISSIPATION_FINE                                                                                           \
  1e-2 /* residual near a state: no window helps, and a matrix that is not convex tells of a limit */
#define LAM_DISSIPATION_ITERATIONS 60
#define LAM_DISSIPATION_EXCESS 1.5 /* of the energy asked for, up to which a step of prescribed s stands */
#define LAM_DISSIPATION_FIRST 0.1  /* share of tau that the first guess dissipates, ... */

typedef struct {
  LamRVE rve;
  const LamDissipationPath *path;
  PetscReal along[9];     /* D */
  LamBorder *border;      /* its load and step are those of the iterate */
  PetscReal face;         /* energy of fracture of a face */
  PetscReal share;        /* of the iterate */
  PetscReal spent, slope; /* D and D_s there */
  PetscReal *gradient;    /* [length] D_y */
  PetscReal *c;           /* [n]; zero where s is prescribed */
  PetscReal energy, rounding;
  PetscReal *R, *column;     /* [LAM_F_COUNT][n], dr/ds [n] */
  PetscReal *rhs, *solution; /* [3][n]: of a, b and e */
  PetscReal shift;           /* of the matrix, where walls are not convex either */
  PetscReal ca, cb, ce;      /* products */
  LamPartSystem window;      /* NULL: all unknowns move */
  PetscReal *far;            /* [n] of the window: b outside it */
  PetscReal *by_cell;        /* [cell] D at the faces of a cell */
  PetscReal *y, *step;       /* [length] before a correction */
  LamElementStress *stress;  /* [element] likewise */
  PetscReal norm, rest;      /* of the residual, and without mu c */
  PetscBool is_held;         /* s is prescribed: only a is solved for */
  PetscBool free;            /* Newton's steps of y and s are taken */
  PetscBool stuck;           /* no step was found */
} LamDissipation;

/* For a path; the smooth law is in use. */
PetscErrorCode LamDissipationCreate(LamRVE rve, const LamDissipationPath *path, LamDissipation *t);
PetscErrorCode LamDissipationDestroy(LamDissipation *t);
LamLoad LamDissipationLoadAt(const LamDissipation *t, PetscReal share);
/* Begins at a state. */
void LamDissipationBegin(LamDissipation *t, LamRVEState at, PetscReal share);
/* Residual, matrix, D and derivatives at the iterate. */
PetscErrorCode LamDissipationAssemble(LamDissipation *t, PetscBool *valid);
/* a, b and e, with the matrix of the iterate; *convex: on motions with c.dy = 0, also with a shift
   if the tangent is the upper bound. */
PetscErrorCode LamDissipationSolve(LamDissipation *t, PetscBool *convex, PetscBool *ok);
/* a for the residual of the iterate, with the factor of the one before. */
PetscErrorCode LamDissipationSolveAgain(LamDissipation *t);
/* Sets the step to with a + ds b - mu e, and its length. */
void LamDissipationSetStep(LamDissipation *t, PetscReal with, PetscReal ds, PetscReal mu, PetscReal *largest);
/* Takes alpha times the step, whose change of s is ds. */
void LamDissipationTake(LamDissipation *t, PetscReal ds, PetscReal alpha);
/* D at a step of `ds` along b, whose gradient becomes that of D there. */
PetscReal LamDissipationSpentAt(LamDissipation *t, PetscReal ds);
/* c, from the gradient of D. */
void LamDissipationSetOpening(LamDissipation *t);
/* The first guess, along b at fixed damage, where it dissipates tau. With s prescribed it is at most `most` far. */
PetscErrorCode LamDissipationGuess(LamDissipation *t, PetscReal tau, PetscReal most, PetscBool is_held, PetscBool *ok);
/* At most `most` iterations from the first guess to a state. is_held: s is prescribed, and the energy dissipated may
   reach `tau` times EXCESS. */
PetscErrorCode LamDissipationIterate(LamDissipation *t, PetscReal tau, PetscReal tolerance, PetscBool is_held,
                                     PetscInt most, PetscBool *converged);
/* Newton's steps from there towards tau. */
PetscErrorCode LamDissipationAdvance(LamDissipation *t, PetscReal tau);

#endif
