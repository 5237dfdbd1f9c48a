#include "failing_tissue.h"

void PullLoads(LamLoad loads[PULL_STATES])
{
  for (int k = 0; k < PULL_STATES; k++)
    loads[k] = PlaneLoad(1.02 + 0.04 * k, 0, 0, 1.02 - 0.01 * k, 0.02 / TISSUE_STRESS);
}

void ShearLoads(double cohesion, LamLoad loads[SHEAR_STATES])
{
  for (int k = 0; k < SHEAR_STATES; k++) {
    loads[k] = PlaneLoad(1, 0.06 * (k + 1), 0, 1, 0.02 / TISSUE_STRESS);
    loads[k].cohesion = cohesion / TISSUE_STRESS;
  }
}

PetscErrorCode FollowProgram(const LamMicrostructure *micro, LamFailureProgram program, LamFailure *failure)
{
  LamScene scene = {.micro = *micro};
  LamMeshes meshes;

  PetscFunctionBeginUser;
  program.interface = micro->interface;
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, &scene, micro->interface == LAM_INTERFACE_CONTACT ? 2 : 1, &meshes));
  PetscCall(LamFailureFind(&meshes, &program, failure));
  PetscCall(LamMeshesDestroy(&meshes));
  PetscFunctionReturn(0);
}
