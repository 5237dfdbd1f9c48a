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
  PetscReal cohesion; /* factor of its loop on the load's cohesion */
  PetscInt entry[2];  /* in the matrix, of (a_1, b_2) and (a_2, b_1); -1: prescribed */
} LamGapPair;

typedef struct {
  PetscInt count;
  LamGapPair *pairs; /* owned */
} LamGapArea;

/* Factor of the interface of two cells on the load's cohesion. */
static inline PetscReal LamFaceCohesion(const LamMicrostructure *micro, PetscInt a, PetscInt b)
{
  return micro->cell ? PetscMin(micro->cell[a].cohesion, micro->cell[b].cohesion) : 1.0;
}

/* Area weighted with the cohesion factors of its loops; plain (may be NULL): unweighted. */
PetscReal LamGapAreaEvaluate(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal *plain);
/* The functions below add derivatives of factor times the weighted area. */
void LamGapAreaAddGradient(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal factor,
                           PetscReal gradient[]);
void LamGapAreaAddHessian(const LamGapArea *area, PetscReal factor, PetscReal values[]);
/* First and second derivatives in F11, F12, F21, F22, and mixed derivatives in F and y; the last two may be NULL. */
void LamGapAreaAddShifts(const LamGapArea *area, const PetscReal F[9], const PetscReal y[], PetscReal factor,
                         PetscReal force[4], PetscReal force_force[4][4], PetscReal *force_y[4]);

PetscErrorCode LamGapAreaCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamGapArea *area);
void LamGapAreaSetMatrix(const LamLinear *linear, LamGapArea *area);
PetscErrorCode LamGapAreaDestroy(LamGapArea *area);

#endif
