/* Failure of the default tissue: what tests assert and the bench program prints. */
#ifndef LAM_FIGURES_FAILURE_H
#define LAM_FIGURES_FAILURE_H

#include "failure.h"
#include "tissue.h"

/* Strengths at which all criteria of bonded tissue are met on the way of PullLoads, C1 + C2. */
static const LamStrength figures_strength = {
    .wall = 0.3 / TISSUE_STRESS, .lamella_normal = 0.1 / TISSUE_STRESS, .lamella_shear = 0.015 / TISSUE_STRESS};

/* Turgid tissue, stretched a little and then pulled along X1 while it shrinks across. */
#define PULL_STATES 5
static inline void PullLoads(LamLoad loads[PULL_STATES])
{
  for (int k = 0; k < PULL_STATES; k++)
    loads[k] = PlaneLoad(1.02 + 0.04 * k, 0, 0, 1.02 - 0.01 * k, 0.02 / TISSUE_STRESS);
}

/* Sheared under turgor, with a cohesion that contact alone feels. */
#define SHEAR_STATES 5
static inline void ShearLoads(double cohesion, LamLoad loads[SHEAR_STATES])
{
  for (int k = 0; k < SHEAR_STATES; k++) {
    loads[k] = PlaneLoad(1, 0.06 * (k + 1), 0, 1, 0.02 / TISSUE_STRESS);
    loads[k].cohesion = cohesion / TISSUE_STRESS;
  }
}

/* Follows a program on new meshes: one, for contact tissue two. */
static inline PetscErrorCode FollowProgram(const LamMicrostructure *micro, LamFailureProgram program,
                                           LamFailure *failure)
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

#endif
