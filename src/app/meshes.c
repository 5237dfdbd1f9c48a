/*
  One tissue on two meshes: what the second says of the first.
*/
#include "onset.h"
#include <math.h>

const char *const LamSeparationNames[] = {LAM_SEPARATIONS(LAM_NAME_ENTRY)};

static PetscErrorCode CreateOne(MPI_Comm comm, const LamScene *scene, PetscInt refinement, LamRVE *rve,
                                LamRVEState *state)
{
  LamMicrostructure micro = scene->micro;

  PetscFunctionBeginUser;
  micro.along *= refinement;
  PetscCall(LamRVECreate(comm, rve));
  PetscCall(LamRVESetMicrostructure(*rve, &micro));
  PetscCall(LamRVESetStrategy(*rve, scene->strategy));
  PetscCall(LamRVESetUp(*rve));
  PetscCall(LamRVEStateCreate(*rve, state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesCreate(MPI_Comm comm, const LamScene *scene, PetscInt count, LamMeshes *meshes)
{
  PetscFunctionBeginUser;
  *meshes = (LamMeshes){.count = count, .F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (PetscInt m = 0; m < count; m++) PetscCall(CreateOne(comm, scene, m + 1, &meshes->rve[m], &meshes->state[m]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesSetInterrupt(LamMeshes *meshes, PetscBool (*interrupt)(void *ctx), void *ctx)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVESetInterrupt(meshes->rve[m], interrupt, ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesDestroy(LamMeshes *meshes)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < meshes->count; m++) {
    PetscCall(LamRVEStateDestroy(&meshes->state[m]));
    PetscCall(LamRVEDestroy(&meshes->rve[m]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesSolve(LamMeshes *meshes, const LamLoad *load, const LamStressControl *control,
                              LamResponse responses[2])
{
  static const LamStressControl none = {0};
  const LamLoad asked = LamLoadAfter(load, control, meshes->F);
  LamResponse *first = &responses[0];
  const LamResponse *second = &responses[1];

  PetscFunctionBeginUser;
  PetscCall(LamRVESolveMixed(meshes->rve[0], &asked, control ? control : &none, meshes->state[0], first));
  if (LamResponseHasFields(first)) PetscCall(PetscArraycpy(meshes->F, first->load.F, 9));
  for (PetscInt m = 1; m < meshes->count && first->status != LAM_OUT_OF_REACH; m++) {
    PetscCall(LamRVESolve(meshes->rve[m], &first->load, meshes->state[m], &responses[m]));
    if (second->status == LAM_OUT_OF_REACH) *first = *second;
  }
  if (first->status == LAM_OUT_OF_REACH) {
    meshes->stopped = PETSC_TRUE;
    responses[1] = *first;
  }
  if (meshes->count < 2 || !LamResponseHasFields(first) || !LamResponseHasFields(second)) PetscFunctionReturn(0);
  first->error_estimate = LamStressError(first->P, second->P);
  first->debonded_spread = fabs(first->debonded_fraction - second->debonded_fraction);
  first->open_spread = fabs(first->open_fraction - second->open_fraction);
  PetscFunctionReturn(0);
}
