/* Rounding errors of responses: the shipped answer against that of the same discrete problem in more digits. */
#ifndef LAM_SUPPORT_DIGITS_H
#define LAM_SUPPORT_DIGITS_H

#include "extended/extended.h"
#include "solve.h"
#include "tissue.h"

typedef int (*Extended)(const ExtendedCase *c, const ExtendedStart *start, int tangent, ExtendedAnswer *answer);

/* Relative errors in the Frobenius norm; opening over V0. */
typedef struct {
  LamStatus status;
  double P, energy, lumen, opening, tangent;
  double size;      /* of P */
  double moved;     /* largest error of a position */
  double residual;  /* of the double-precision positions, evaluated in extended precision */
  double tolerance; /* of the Newton iteration */
  double left;      /* residual that the extended iteration leaves */
  int iterations;   /* of the extended iteration */
  PetscInt unknowns;
} Digits;

/* Solves the load from F = I in `steps` and measures the last state. */
PetscErrorCode DigitsMeasure(const LamMicrostructure *micro, const LamLoad *load, PetscInt steps, LamWanted wanted,
                             Extended solve, Digits *digits);

#endif
