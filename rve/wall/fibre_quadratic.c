/*
  Fibres along the wall, W = C4/4 (I4 - 1)^2, I4 = M.CM of the full C (Mihai, Safar & Wyatt, eq. 4.1); with
  `fibres: tension` only where I4 > 1.
*/
#include "wall_law.h"

void LamFibreQuadratic(const LamWall *wall, const LamPoints strain, LamKernel1 *out)
{
  LAM_EACH_POINT(g)
  {
    const PetscReal active = wall->fibres == LAM_FIBRES_TENSION && strain[g] <= 0.0 ? 0.0 : wall->C4;

    out->W[g] = 0.25 * active * strain[g] * strain[g];
    out->d[g] = 0.5 * active * strain[g];
    out->dd[g] = 0.5 * active;
  }
}
