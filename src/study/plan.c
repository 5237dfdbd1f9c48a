/*
  What a scene requires: mesh, unknowns, number of solves.
*/
#include "mesh_choice.h"
#include "map.h"
#include "plan.h"
#include <lamella/database.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_PER_ELEMENT 9 /* 3 x 3 Gauss points of a quadratic element */

/* An arbitrary order in which equal cells are adjacent; behind the last member is room that nobody sets. */
static int CompareCells(const void *a, const void *b)
{
  return memcmp(a, b, offsetof(LamCell, cluster) + sizeof(PetscInt));
}

static PetscErrorCode CountKinds(PetscInt count, const LamCell cells[], PetscInt *kinds)
{
  LamCell *sorted;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(count, &sorted));
  PetscCall(PetscArraycpy(sorted, cells, count));
  qsort(sorted, (size_t)count, sizeof(*sorted), CompareCells);
  *kinds = 1;
  for (PetscInt c = 1; c < count; c++) *kinds += CompareCells(&sorted[c - 1], &sorted[c]) != 0;
  PetscCall(PetscFree(sorted));
  PetscFunctionReturn(0);
}

static void Widen(PetscBool first, PetscReal value, PetscReal range[2])
{
  range[0] = first ? value : PetscMin(range[0], value);
  range[1] = first ? value : PetscMax(range[1], value);
}

static PetscErrorCode MeasureSpread(const LamMicrostructure *micro, LamCellSpread *spread)
{
  const PetscInt count = micro->cells[0] * micro->cells[1];

  PetscFunctionBeginUser;
  if (!micro->cell) PetscFunctionReturn(0);
  PetscCall(CountKinds(count, micro->cell, &spread->kinds));
  for (PetscInt c = 0; c < count; c++) {
    const LamCell *cell = &micro->cell[c];

    Widen(!c, cell->wall_thickness, spread->wall_thickness);
    Widen(!c, cell->wall.C1 + cell->wall.C2, spread->shear_modulus);
    Widen(!c, cell->turgor, spread->turgor);
    Widen(!c, cell->cohesion, spread->cohesion);
    Widen(!c, cell->lamella_strength, spread->lamella_strength);
    Widen(!c, cell->lamella_energy, spread->lamella_energy);
  }
  PetscFunctionReturn(0);
}

/* Number of elements of the body; 0 if they are in a file that is not read yet. */
static PetscInt CountElements(const LamMacroSpec *macro)
{
  static const PetscInt quadrants[] = {
      [LAM_DISC_WHOLE] = 4, [LAM_DISC_HALF] = 2, [LAM_DISC_RIGHT] = 2, [LAM_DISC_QUARTER] = 1};

  switch (macro->source) {
  case LAM_MESH_BOX:
    return macro->elements[0] * macro->elements[1];
  case LAM_MESH_DISC:
    return quadrants[macro->disc] * macro->elements[0] * (macro->elements[0] + 2 * macro->elements[1]);
  default:
    return 0;
  }
}

PetscErrorCode LamPlanMake(const LamScene *scene, LamPlan *plan)
{
  LamScene meshed = *scene;

  PetscFunctionBeginUser;
  *plan = (LamPlan){.load_states = scene->load_count};
  PetscCall(LamChooseMesh(&meshed, &plan->trial));
  plan->micro = meshed.micro;
  PetscCall(LamRVECountUnknowns(&plan->micro, &plan->unknowns));
  if (scene->sealed) plan->unknowns += scene->micro.cells[0] * scene->micro.cells[1]; /* the pressures */
  PetscCall(MeasureSpread(&plan->micro, &plan->spread));
  if (scene->has_sample) plan->sample_states = scene->sample.count;
  if (scene->has_map) {
    plan->map_points = LamMapPointCount(scene);
    plan->map_states = LamMapPathCount(scene) * LamMapPathStates(scene);
  }
  if (scene->has_macro) {
    const LamMacroSpec *macro = &scene->macro;

    plan->macro_elements = CountElements(macro);
    plan->macro_points = POINTS_PER_ELEMENT * plan->macro_elements;
  }
  PetscFunctionReturn(0);
}
