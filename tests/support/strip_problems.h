/*
  The finite element strip of strip_fixture.h against generalised shear: errors that the test asserts and the bench
  program prints. Root mean squares over the strip, of stresses over the largest sigma12.
*/
#ifndef LAM_SUPPORT_STRIP_PROBLEMS_H
#define LAM_SUPPORT_STRIP_PROBLEMS_H

#include "strip.h"

typedef struct {
  double displacement, gradient; /* x1 - X1 against f(X2); F12 against f'(X2) */
  double nodal;                  /* largest error of x1 at a node */
  double lateral;                /* x2 - X2, which is zero */
  double shear, normal;          /* P12 = sigma12; P22 = sigma22, whose mean is free */
  PetscInt iterations;
} StripErrors;

/* Default tissue, C1 : C2 : C4 = 10 : 1 : 100, fibres along X2; sigma12 rises from 0.2 to 1.7, the shear to 0.5. */
StripProblem DefaultStrip(PetscInt rows, double bulk);
PetscErrorCode ComputeStrip(StripProblem problem, StripErrors *errors);

#endif
