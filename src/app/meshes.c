/*
  One tissue on two meshes: what the second says of the first.
*/
#include "onset.h"
#include <math.h>

const char *const LamSeparationNames[] = {LAM_SEPARATIONS(LAM_NAME_ENTRY)};

/* How near to the cohesion a mean face traction reaches it, as a share of p + g. */
#define REACHED 1e-3

static PetscErrorCode CreateOne(const LamScene *scene, PetscInt refinement, LamRVE *rve, LamRVEState *state)
{
  LamMicrostructure micro = scene->micro;

  PetscFunctionBeginUser;
  micro.along *= refinement;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, rve));
  PetscCall(LamRVESetMicrostructure(*rve, &micro));
  PetscCall(LamRVESetStrategy(*rve, scene->strategy));
  PetscCall(LamRVESetUp(*rve));
  PetscCall(LamRVEStateCreate(*rve, state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshesCreate(const LamScene *scene, PetscInt count, LamMeshes *meshes)
{
  PetscFunctionBeginUser;
  *meshes = (LamMeshes){.count = count};
  for (PetscInt m = 0; m < count; m++) PetscCall(CreateOne(scene, m + 1, &meshes->rve[m], &meshes->state[m]));
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

PetscErrorCode LamMeshesSolve(LamMeshes *meshes, const LamLoad *load, LamResponse responses[2])
{
  LamResponse *first = &responses[0];
  const LamResponse *second = &responses[1];

  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < meshes->count; m++)
    PetscCall(LamRVESolve(meshes->rve[m], load, meshes->state[m], &responses[m]));
  if (meshes->count < 2 || !LamResponseHasFields(first) || !LamResponseHasFields(second)) PetscFunctionReturn(0);
  first->error_estimate = LamStressError(first->P, second->P);
  first->debonded_spread = fabs(first->debonded_fraction - second->debonded_fraction);
  first->open_spread = fabs(first->open_fraction - second->open_fraction);
  PetscFunctionReturn(0);
}

/* Whether a face family carries no contact any more. */
static PetscBool TractionReached(const LamResponse *r)
{
  const PetscReal g = r->load.cohesion, margin = REACHED * (r->load.turgor + g);

  for (PetscInt k = 0; k < 3; k++)
    if (r->mean_face_traction[k] >= g - margin) return PETSC_TRUE;
  return PETSC_FALSE;
}

LamSeparation LamSeparationOf(const LamResponse responses[2])
{
  const LamResponse *a = &responses[0], *b = &responses[1];

  if (!LamResponseHasFields(a) || !LamResponseHasFields(b)) return LAM_SEPARATION_UNKNOWN;
  if (a->max_gap > LAM_VISIBLE_GAP && b->max_gap > LAM_VISIBLE_GAP) return LAM_SEPARATION_GAP;
  if (TractionReached(a) && TractionReached(b)) return LAM_SEPARATION_TRACTION;
  return LAM_SEPARATION_NONE;
}
