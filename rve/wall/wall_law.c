#include "wall_law.h"

static const LamWallLaw laws[] = {
    {LAM_WALL_FIBRE_MOONEY_RIVLIN, LamMatrixMooneyRivlin, LamMatrixShear, LamFibreQuadratic},
    {LAM_WALL_FIBRE_EXPONENTIAL, LamMatrixMooneyRivlin, LamMatrixShear, LamFibreExponential},
    {LAM_WALL_MOONEY_RIVLIN, LamMatrixMooneyRivlin, LamMatrixShear, NULL},
};

PetscErrorCode LamWallLawGet(LamWallLawType type, const LamWallLaw **law)
{
  PetscFunctionBeginUser;
  *law = NULL;
  for (size_t i = 0; i < sizeof(laws) / sizeof(laws[0]); ++i)
    if (laws[i].type == type) *law = &laws[i];
  PetscCheck(*law, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "no wall law has the number %d", (int)type);
  PetscFunctionReturn(0);
}
