/*
  Fibres along the wall that stiffen exponentially, W = k1/(2 k2) (exp(k2 (I4 - 1)^2) - 1), I4 = M.CM of the full C;
  with `fibres: tension` only where I4 > 1. As k2 goes to 0 they become quadratic fibres with C4 = 2 k1.

  Reference: Holzapfel, Gasser & Ogden, J. Elasticity 61 (2000) 1-48, eq. 65; their I4 is isochoric.
*/
#include "wall_law.h"
#include <math.h>

/* Exponents beyond this are rejected: sums of squares of stresses would overflow (e^300 is 1e130). */
#define LARGEST_EXPONENT 300.0

void LamFibreExponential(const LamWall *wall, PetscReal extension, LamKernel1 *out)
{
  const PetscReal square = extension * extension, x = wall->k2 * square;
  PetscReal growth, slope;

  *out = (LamKernel1){0};
  if (wall->fibres == LAM_FIBRES_TENSION && extension <= 0.0) return;
  if (!(x <= LARGEST_EXPONENT)) {
    out->W = (PetscReal)INFINITY; /* the element rejects this state */
    return;
  }
  growth = expm1(x);
  slope = wall->k1 * (1.0 + growth);
  out->W = 0.5 * wall->k1 * square * (x > 0.0 ? growth / x : 1.0);
  out->d = slope * extension;
  out->dd = slope * (1.0 + 2.0 * x);
}
