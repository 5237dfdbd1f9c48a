/*
  Records that belong to no grid: what each may answer, and its model of the potential.
*/
#include "database_internal.h"
#include <math.h>
#include <string.h>

/* Bits of the images of a state that fall on no earlier one: on a mirror plane of the lattice they come in pairs. */
static PetscInt DistinctImages(const LamImages *images, const PetscReal x[LAM_VARIABLES])
{
  PetscReal at[LAM_MAX_IMAGES][LAM_VARIABLES];
  PetscInt distinct = 0;

  for (PetscInt i = 0; i < images->count; i++) {
    PetscBool fresh = PETSC_TRUE;

    memcpy(at[i], x, sizeof(at[i]));
    LamImagesBack(images, i, at[i]);
    for (PetscInt j = 0; j < i; j++)
      if (hypot(at[i][1] - at[j][1], at[i][2] - at[j][2]) < LAM_OWN_STATE) fresh = PETSC_FALSE;
    if (fresh) distinct |= 1 << i;
  }
  return distinct;
}

LamScatterPlace LamScatterPlaceOf(const PetscReal x[LAM_VARIABLES])
{
  return (LamScatterPlace){x[0], hypot(x[1], x[2]), x[3], x[4]};
}

/* PETSC_FALSE: a record without a place among the states of plane strain. */
static PetscBool HasPlace(const LamLoad *load)
{
  PetscReal sum = load->turgor + load->cohesion;

  for (int i = 0; i < 9; i++) sum += load->F[i];
  return (PetscBool)(isfinite(sum) && LamPlaneStrain(load->F) && load->F[0] * load->F[4] > load->F[1] * load->F[3]);
}

static LamScattered StateOf(const LamImages *images, PetscBool bonded, const LamResponse *record)
{
  LamScattered state = {.use = LAM_SCATTER_REFUSES};

  LamVariables(&record->load, state.model.x);
  if (record->status == LAM_CONVERGED && record->stable && LamExpansionMake(record, bonded, &state.model))
    state.use = record->branch ? LAM_SCATTER_ALONE : LAM_SCATTER_BLENDS;
  state.images = DistinctImages(images, state.model.x);
  return state;
}

static PetscErrorCode Reserve(LamScatter *scatter)
{
  PetscFunctionBeginUser;
  if (scatter->n < scatter->capacity) PetscFunctionReturn(0);
  scatter->capacity = PetscMax(2 * scatter->capacity, 64);
  PetscCall(PetscRealloc((size_t)scatter->capacity * sizeof(*scatter->records), &scatter->records));
  PetscCall(PetscRealloc((size_t)scatter->capacity * sizeof(*scatter->states), &scatter->states));
  PetscCall(PetscRealloc((size_t)scatter->capacity * sizeof(*scatter->places), &scatter->places));
  PetscFunctionReturn(0);
}

PetscErrorCode LamScatterAdd(LamScatter *scatter, const LamImages *images, PetscBool bonded, const LamResponse *record)
{
  const PetscInt at = scatter->n;

  PetscFunctionBeginUser;
  PetscCall(Reserve(scatter));
  scatter->n++;
  scatter->records[at] = *record;
  if (HasPlace(&record->load)) {
    scatter->states[at] = StateOf(images, bonded, record);
    scatter->places[at] = LamScatterPlaceOf(scatter->states[at].model.x);
  } else {
    scatter->states[at] = (LamScattered){.use = LAM_SCATTER_REFUSES};
    scatter->places[at] = (LamScatterPlace){.mean = INFINITY};
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamScatterDestroy(LamScatter *scatter)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(scatter->records));
  PetscCall(PetscFree(scatter->states));
  PetscCall(PetscFree(scatter->places));
  *scatter = (LamScatter){0};
  PetscFunctionReturn(0);
}
