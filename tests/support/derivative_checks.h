/*
  A state and the finite differences of its energy, stress and lumen in each component of (F, p): what the test asserts
  and the bench program prints. Fourth-order central differences of warm-started solves.
*/
#ifndef LAM_SUPPORT_DERIVATIVE_CHECKS_H
#define LAM_SUPPORT_DERIVATIVE_CHECKS_H

#include "tissue.h"
#include "random_reals.h"

#define SWEEP_TURGOR 9 /* column of the turgor; columns 0..8 are components of F */
static const int sweep_columns[6] = {0, 1, 3, 4, 8, SWEEP_TURGOR};

typedef struct {
  LamResponse response;
  double energy[10], lumen[10], P[10][9]; /* differences, by column */
} Sweep;

/* A wall thickness, orientation, mesh position and load that nothing singles out; F33 differs from 1. */
LamMicrostructure RandomTissue(uint64_t *seed);
LamLoad RandomLoad(uint64_t *seed);
PetscErrorCode SweepLoads(const LamMicrostructure *micro, const LamLoad *load, Sweep *sweep);

#endif
