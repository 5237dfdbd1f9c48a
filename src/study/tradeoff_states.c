/*
  States solved with each setting: those of the scene's load; without a load, states of its sample box; without either,
  shears and stretches.

  All settings are solved at the same F. Where the load prescribes stress in place of components of F, these components
  are found first, on the planned mesh.
*/
#include "tradeoff.h"
#include "build.h"
#include "onset.h"

enum { SAMPLED = 8 }; /* number of states of the sample box */

static const PetscReal Shears[] = {0.05, 0.1, 0.15, 0.2};
static const PetscReal Stretches[][2] = {{1.05, 1}, {1, 1.05}, {1.03, 1.03}};
enum { SHEARS = PETSC_STATIC_ARRAY_LENGTH(Shears), STRETCHES = PETSC_STATIC_ARRAY_LENGTH(Stretches) };

static void Default(const LamScene *scene, LamStates *states)
{
  const LamLoad undeformed = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = scene->turgor, .cohesion = scene->cohesion};

  for (PetscInt s = 0; s < SHEARS + STRETCHES; s++) {
    LamLoad *load = &states->loads[states->n++];

    *load = undeformed;
    if (s < SHEARS) {
      load->F[1] = Shears[s];
    } else {
      load->F[0] = Stretches[s - SHEARS][0];
      load->F[4] = Stretches[s - SHEARS][1];
    }
  }
  states->origin = "default";
}

/* Finds the free components of F; states that do not converge are dropped. */
static PetscErrorCode FindFree(const LamScene *scene, LamStates *states)
{
  LamResponse responses[2];
  LamMeshes meshes;

  PetscFunctionBeginUser;
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, scene, 1, &meshes));
  PetscCall(LamMeshesSetInterrupt(&meshes, LamStopInterrupt, NULL));
  PetscCall(LamMeshesSeal(&meshes, scene, &scene->loads[0]));
  for (PetscInt s = 0; s < scene->load_count && !meshes.stopped; s++) {
    PetscCall(LamMeshesSolve(&meshes, &scene->loads[s], &scene->controls[s], responses));
    if (LamResponseHasFields(&responses[0])) states->loads[states->n++] = responses[0].load;
  }
  PetscCall(LamMeshesDestroy(&meshes));
  states->dropped = scene->load_count - states->n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamStatesMake(const LamScene *scene, LamStates *states)
{
  PetscFunctionBeginUser;
  *states = (LamStates){.origin = "load", .chained = PETSC_TRUE};
  PetscCall(PetscCalloc1(PetscMax(scene->load_count, SAMPLED), &states->loads));
  if (scene->load_count && scene->controls) {
    PetscCall(FindFree(scene, states));
  } else if (scene->load_count) {
    PetscCall(PetscArraycpy(states->loads, scene->loads, scene->load_count));
    states->n = scene->load_count;
  } else if (scene->has_sample) {
    for (; states->n < SAMPLED; states->n++) LamSampleLoad(scene, states->n, &states->loads[states->n]);
    states->origin = "sample";
    states->chained = PETSC_FALSE;
  } else {
    Default(scene, states);
    states->chained = PETSC_FALSE;
  }
  PetscCall(PetscCalloc1(PetscMax(states->n, 1), &states->skip));
  PetscFunctionReturn(0);
}

PetscInt LamStatesCount(const LamStates *states)
{
  PetscInt count = 0;

  for (PetscInt s = 0; s < states->n; s++) count += !states->skip[s];
  return count;
}

PetscErrorCode LamStatesDestroy(LamStates *states)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(states->loads));
  PetscCall(PetscFree(states->skip));
  PetscFunctionReturn(0);
}
