/*
  Fibres along the wall, W = C4/4 (I4 - 1)^2, I4 = M.CM of the full C (Mihai, Safar & Wyatt, eq. 4.1); with
  `fibres: tension` only where I4 > 1.
*/
#include "wall_law.h"

void LamFibreQuadratic(const LamWall *wall, PetscReal strain, LamKernel1 *out)
{
  const PetscReal active = wall->fibres == LAM_FIBRES_TENSION && strain <= 0.0 ? 0.0 : wall->C4;

  out->W = 0.25 * active * strain * strain;
  out->d = 0.5 * active * strain;
  out->dd = 0.5 * active;
}
