/*
  Fibres along the wall that stiffen exponentially, W = k1/(2 k2) (exp(k2 E^2) - 1), E as in wall_law.h; with
  `fibres: tension` only where E > 0. As k2 goes to 0 they become quadratic fibres with C4 = 2 k1.

  Reference: Holzapfel, Gasser & Ogden, J. Elasticity 61 (2000) 1-48, eq. 65; their I4 is isochoric.
*/
#include "wall_law.h"
#include <math.h>

/* Exponents beyond this are rejected: sums of squares of stresses would overflow (e^300 is 1e130). */
#define LARGEST_EXPONENT 300.0

static void AtPoint(const LamWall *wall, PetscReal strain, PetscReal *W, PetscReal *d, PetscReal *dd)
{
  const PetscReal square = strain * strain, x = wall->k2 * square;
  PetscReal growth, slope;

  *W = *d = *dd = 0.0;
  if (wall->fibres == LAM_FIBRES_TENSION && strain <= 0.0) return;
  if (!(x <= LARGEST_EXPONENT)) {
    *W = (PetscReal)INFINITY; /* the element rejects this state */
    return;
  }
  growth = expm1(x);
  slope = wall->k1 * (1.0 + growth);
  *W = 0.5 * wall->k1 * square * (x > 0.0 ? growth / x : 1.0);
  *d = slope * strain;
  *dd = slope * (1.0 + 2.0 * x);
}

void LamFibreExponential(const LamWall *wall, const LamPoints strain, LamKernel1 *out)
{
  LAM_EACH_POINT(g) AtPoint(wall, strain[g], &out->W[g], &out->d[g], &out->dd[g]);
}
