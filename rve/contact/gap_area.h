/*
  The area between the cells of contact tissue and its derivatives; method in gap_area.c.
*/
#ifndef LAM_RVE_GAP_AREA_H
#define LAM_RVE_GAP_AREA_H

#include "linear.h"

/* The area is the sum of c x_a x x_b over pairs, x = y_class + F S. */
typedef struct {
  PetscInt a, b; /* classes */
  PetscReal Sa[2], Sb[2];
  PetscReal c;
  PetscReal cohesion; /* of its loop, times the load's */
  PetscInt entry[2];  /* in the matrix, of (a_1, b_2) and (a_2, b_1); -1: held */
} LamGapPair;

typedef struct {
  PetscInt count;
  LamGapPair *pairs; /* owned */
} LamGapArea;

/* Of the interface of two cells, times the load's. */
static inline PetscReal LamFaceCohesion(const LamMicrostructure *micro, PetscInt a, PetscInt b)
{
  return micro->cell ? PetscMin(micro->cell[a].cohesion, micro->cell[b].cohesion) : 1.0;
}

/* The area weighted with the cohesion of its loops (and, if asked, the plain one). */
PetscReal LamGapAreaEvaluate(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal *plain);
/* The derivatives below are of factor times the weighted area, and are added. */
void LamGapAreaAddGradient(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal factor,
                           PetscReal gradient[]);
void LamGapAreaAddHessian(const LamGapArea *area, PetscReal factor, PetscReal values[]);
/* With respect to F11, F12, F21, F22, once and twice, and to each of them and y; the last two may be NULL. */
void LamGapAreaAddShifts(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal factor,
                         PetscReal force[4], PetscReal force_force[4][4], PetscReal *force_y[4]);

PetscErrorCode LamGapAreaCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamGapArea *area);
void LamGapAreaSetMatrix(const LamLinear *linear, LamGapArea *area);
PetscErrorCode LamGapAreaDestroy(LamGapArea *area);

#endif
