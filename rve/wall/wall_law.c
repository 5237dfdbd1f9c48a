#include "wall_law.h"

static const LamWallLaw laws[] = {
    {LAM_WALL_FIBRE_MOONEY_RIVLIN, LamMatrixMooneyRivlin, LamFibreQuadratic},
    {LAM_WALL_FIBRE_EXPONENTIAL, LamMatrixMooneyRivlin, LamFibreExponential},
    {LAM_WALL_MOONEY_RIVLIN, LamMatrixMooneyRivlin, NULL},
};

PetscReal LamWallFibreModulus(const LamWall *wall)
{
  LamWall both = *wall;
  const LamPoints at_rest = {0};
  LamKernel1 fibre = {0};

  both.fibres = LAM_FIBRES_BOTH;
  for (size_t i = 0; i < sizeof(laws) / sizeof(laws[0]); ++i)
    if (laws[i].type == wall->law && laws[i].fibre) laws[i].fibre(&both, at_rest, &fibre);
  return 2.0 * fibre.dd[0] * PetscSqr(1.0 - 3.0 * wall->dispersion); /* at rest tr C = 3 to first order */
}

PetscErrorCode LamWallLawGet(LamWallLawType type, const LamWallLaw **law)
{
  PetscFunctionBeginUser;
  *law = NULL;
  for (size_t i = 0; i < sizeof(laws) / sizeof(laws[0]); ++i)
    if (laws[i].type == type) *law = &laws[i];
  PetscCheck(*law, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "no wall law has the number %d", (int)type);
  PetscFunctionReturn(0);
}
