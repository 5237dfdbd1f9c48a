/*
  One tissue on two meshes; the second gives the error estimate of the first.
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
  PetscCall(LamRVESetTolerance(*rve, scene->tolerance));
  PetscCall(LamRVESetSealable(*rve, scene->sealed));
  PetscCall(LamRVESetOutOfPlane(*rve, scene->out_of_plane));
  PetscCall(LamRVESetUp(*rve));
  PetscCall(LamRVEStateCreate(*rve, state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesCreate(MPI_Comm comm, const LamScene *scene, PetscInt count, LamMeshes *meshes)
{
  PetscFunctionBeginUser;
  *meshes = (LamMeshes){.count = count,
                        .F = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                        .scale = LamStressScaleOf(&scene->micro),
                        .unsealed.status = LAM_CONVERGED};
  for (PetscInt m = 0; m < count; m++) PetscCall(CreateOne(comm, scene, m + 1, &meshes->rve[m], &meshes->state[m]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesSetInterrupt(LamMeshes *meshes, PetscBool (*interrupt)(void *ctx), void *ctx)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < meshes->count; m++) PetscCall(LamRVESetInterrupt(meshes->rve[m], interrupt, ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesSetWanted(LamMeshes *meshes, LamWanted wanted)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < meshes->count; m++)
    PetscCall(LamRVESetWanted(meshes->rve[m], m ? wanted & ~(LAM_WANT_DERIVATIVES | LAM_WANT_JUMPS) : wanted));
  PetscFunctionReturn(0);
}

static PetscErrorCode SealOne(const LamScene *scene, const LamLoad *load, LamRVE rve, LamRVEState state,
                              LamResponse *response)
{
  PetscReal *water;

  PetscFunctionBeginUser;
  PetscCall(LamRVESolve(rve, load, state, response));
  if (response->status != LAM_CONVERGED) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(scene->micro.cells[0] * scene->micro.cells[1], &water));
  PetscCall(LamRVEGetLumens(rve, state, water));
  PetscCall(LamRVESeal(rve, scene->water_bulk_modulus, water));
  PetscCall(PetscFree(water));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesSeal(LamMeshes *meshes, const LamScene *scene, const LamLoad *first)
{
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = first->turgor, .cohesion = first->cohesion};
  LamResponse *response = &meshes->unsealed;
  char reason[sizeof(response->reason)];

  PetscFunctionBeginUser;
  if (scene->inflate) PetscCall(PetscArraycpy(load.F, first->F, 9));
  for (PetscInt m = 0; m < meshes->count && scene->sealed && response->status == LAM_CONVERGED; m++)
    PetscCall(SealOne(scene, &load, meshes->rve[m], meshes->state[m], response));
  if (response->status == LAM_CONVERGED || response->status == LAM_OUT_OF_REACH) PetscFunctionReturn(0);
  PetscCall(PetscStrncpy(reason, response->reason, sizeof(reason)));
  PetscCall(PetscSNPrintf(response->reason, sizeof(reason),
                          "no stable state at F = I in which the cells are sealed: %s", reason));
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

/* Response if the cells could not be sealed: without enclosed water they have no pressure. */
static PetscErrorCode GiveUnsealed(LamMeshes *meshes, const LamLoad *load, LamResponse responses[2])
{
  const LamResponse *why = &meshes->unsealed;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, &responses[0]));
  responses[0].status = why->status == LAM_UNSTABLE ? LAM_NOT_CONVERGED : why->status;
  PetscCall(PetscStrncpy(responses[0].reason, why->reason, sizeof(why->reason)));
  responses[1] = responses[0];
  meshes->stopped = (PetscBool)(why->status == LAM_OUT_OF_REACH);
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
  if (meshes->unsealed.status != LAM_CONVERGED) {
    PetscCall(GiveUnsealed(meshes, &asked, responses));
    PetscFunctionReturn(0);
  }
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
  first->error_estimate = LamStressError(meshes->scale, first->P, second->P);
  first->debonded_spread = fabs(first->debonded_fraction - second->debonded_fraction);
  first->open_spread = fabs(first->open_fraction - second->open_fraction);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesDissipate(LamMeshes *meshes, const LamDissipationPath *path, LamDissipationPoint *point,
                                  LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVESolveDissipating(meshes->rve[0], path, point, meshes->state[0], response));
  if (LamResponseHasFields(response)) PetscCall(PetscArraycpy(meshes->F, response->load.F, 9));
  if (response->status == LAM_OUT_OF_REACH) meshes->stopped = PETSC_TRUE;
  PetscFunctionReturn(0);
}

#define SAME_ENERGY 1e-9 /* C1 + C2: of equal states */

/* Whether a state from another start is to replace one: that has failed, or the other has less energy by the same law.
 */
static PetscBool IsBetter(const LamResponse *other, const LamResponse *than)
{
  if (other->status != LAM_CONVERGED) return PETSC_FALSE;
  if (than->status != LAM_CONVERGED) return PETSC_TRUE;
  return (PetscBool)(other->contact_width == than->contact_width && other->energy < than->energy - SAME_ENERGY);
}

PetscErrorCode LamMeshesSearch(LamMeshes *meshes, LamStrategy strategy, LamResponse *response)
{
  const LamRVE rve = meshes->rve[0];
  LamRVEState state;

  PetscFunctionBeginUser;
  if (response->status == LAM_OUT_OF_REACH || response->status == LAM_INVALID_F) PetscFunctionReturn(0);
  PetscCall(LamRVEStateCreate(rve, &state));
  for (int k = 0; k < LAM_STRATEGY_COUNT; k++) {
    const LamResponse before = *response;
    LamResponse other;

    PetscCall(LamRVESetStrategy(rve, (LamStrategy)k));
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, &before.load, state, &other));
    if (other.status == LAM_OUT_OF_REACH) meshes->stopped = PETSC_TRUE;
    if (IsBetter(&other, &before)) {
      PetscCall(LamRVEStateCopy(state, meshes->state[0]));
      *response = other;
    }
    response->newton_iterations = before.newton_iterations + other.newton_iterations;
    response->factorisations = before.factorisations + other.factorisations;
    response->seconds = before.seconds + other.seconds;
  }
  PetscCall(LamRVESetStrategy(rve, strategy));
  PetscCall(LamRVEStateDestroy(&state));
  PetscFunctionReturn(0);
}
