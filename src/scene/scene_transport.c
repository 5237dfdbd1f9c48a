/*
  The block `process.transport` of a scene: water that moves through a body.
*/
#include "scene_rows.h"
#include "quantity_text.h"
#include <math.h>
#include <string.h>

static const LamKey transport_keys[] = {
    {MAP("process.transport"), .default_words = "each cell exchanges water with the surroundings directly",
     .example = "{apoplast: 1e-10 m^2/s/MPa, cell_to_cell: 1e-11 m^2/s/MPa, surface: [{on: right}]}",
     .help = "Of a body (`macro`) with `process.water`: water moves along the walls and from cell to cell, and enters "
             "or leaves at its surface."},
    {CONDUCTIVITY("process.transport.apoplast"), INTO(LamTransportSpec, apoplast), FROM(0), .free_word = "infinite",
     .default_value = "0 m^2/s/MPa", .example = "1e-10 m^2/s/MPa",
     .help =
         "Hydraulic conductivity of the walls and the spaces between cells, per area of the tissue; `infinite`: all "
         "cells meet the surroundings directly."},
    {CONDUCTIVITY("process.transport.cell_to_cell"), INTO(LamTransportSpec, cell_to_cell), FROM(0),
     .default_value = "0 m^2/s/MPa", .example = "1e-11 m^2/s/MPa",
     .help = "Hydraulic conductivity from cell to cell, through plasmodesmata or membranes; of membranes alone it is "
             "permeability times apothem."},
    {LIST("process.transport.surface"), .default_words = "all sides are sealed", .example = "[{on: right}]",
     .help = "Sides that meet the surroundings; the others are sealed."},
    {MAP("process.transport.surface[]"), .example = "{on: right}", .help = "One side."},
    {TEXT("process.transport.surface[].on"), INTO(LamSurface, on), REQUIRED, .example = "right",
     .help = "Its name, as in `macro.boundary`."},
    {PERMEABILITY("process.transport.surface[].conductance"), INTO(LamSurface, conductance), ABOVE(0),
     .free_word = "infinite", .default_words = "infinite", .example = "1e-9 m/s/MPa",
     .help = "Conductance of a skin, or of the air there: flow per area and difference of water potential."},
};
LAM_KEY_TABLE(LamTransportKeys, transport_keys);

static PetscErrorCode BuildSurface(const LamNode *list, LamScene *scene)
{
  LamTransportSpec *spec = &scene->process.transport;

  PetscFunctionBeginUser;
  LamSceneCheckName(!list || list->count <= LAM_MAX_BOUNDARIES, list, "has %d entries; at most %d are allowed",
                    (int)list->count, LAM_MAX_BOUNDARIES);
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) {
    const LamNode *on = LamNodeFind(entry, "on"), *conductance = LamNodeFind(entry, "conductance");
    LamSurface *surface = &spec->surface[spec->surface_count];
    PetscInt side;

    PetscCall(LamSceneCheckSide(on, &scene->macro, &side));
    PetscCall(LamSceneFill(entry, &scene->scales, LamSurface, surface));
    surface->place = LamNodePlace(on);
    if (!conductance || conductance->value.is_free[0]) surface->conductance = INFINITY;
    for (PetscInt k = 0; k < spec->surface_count; k++)
      LamSceneCheck(strcmp(spec->surface[k].on, surface->on), on, "has an entry already; leave one of them out");
    spec->surface_count++;
  }
  PetscFunctionReturn(0);
}

/* What water cannot follow. */
static PetscErrorCode CheckTransport(const LamNode *block, const LamScene *scene)
{
  const LamTransportSpec *spec = &scene->process.transport;
  const LamWaterSpec *water = &scene->process.water;
  const LamNode *apoplast = LamNodeFind(block, "apoplast"), *cells = LamNodeFind(block, "cell_to_cell");

  PetscFunctionBeginUser;
  if (isfinite(spec->apoplast)) {
    LamSceneCheckName(
        isfinite(water->permeability), block,
        "needs membranes that resist, but process.water.permeability is infinite; write a large one, such "
        "as 1e-5 m/s/MPa: the cells are then in equilibrium with the apoplast around them");
    PetscFunctionReturn(0);
  }
  LamSceneCheck(spec->cell_to_cell == 0, cells,
                "does nothing where all cells meet the surroundings directly (apoplast: infinite); leave it out");
  LamSceneCheck(spec->surface_count > 0, apoplast,
                "lets all cells meet the surroundings, but all sides are sealed; write surface: [{on: right}], or "
                "process.water.permeability: 0 m/s/MPa for cells that keep their water");
  for (PetscInt k = 0; k < spec->surface_count; k++)
    LamSceneCheck(!isfinite(spec->surface[k].conductance), apoplast,
                  "lets all cells meet the surroundings, but %s has a skin; write a conductivity, such as 1e-6 "
                  "m^2/s/MPa",
                  spec->surface[k].on);
  PetscFunctionReturn(0);
}

/* Surroundings that change do nothing to a body that is sealed. */
static PetscErrorCode CheckSealed(const LamNode *block, const LamNode *surroundings, const LamScene *scene)
{
  const LamProcessSpec *spec = &scene->process;

  PetscFunctionBeginUser;
  for (PetscInt k = 1; k < spec->surroundings_count && !spec->transport.surface_count; k++)
    LamSceneCheckName(
        spec->surroundings[k].outside == spec->surroundings[0].outside, surroundings,
        "change outside the cells, but all sides are sealed (line %d); write surface: [{on: right}] there",
        block->line);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildTransport(const LamNode *process, LamScene *scene)
{
  const LamNode *block = LamNodeFind(process, "transport"), *apoplast = LamNodeFind(block, "apoplast");
  LamTransportSpec *spec = &scene->process.transport;

  PetscFunctionBeginUser;
  if (!block) PetscFunctionReturn(0);
  spec->given = PETSC_TRUE;
  LamSceneCheckName(scene->has_macro, block,
                    "is for a body, but there is no block macro; leave it out, or write that block");
  LamSceneCheckName(scene->process.has_water, block,
                    "moves the water of cells, but there is no process.water; write that block");
  PetscCall(LamSceneFill(block, &scene->scales, LamTransportSpec, spec));
  if (apoplast && apoplast->value.is_free[0]) spec->apoplast = INFINITY;
  PetscCall(BuildSurface(LamNodeFind(block, "surface"), scene));
  PetscCall(CheckTransport(block, scene));
  PetscCall(CheckSealed(block, LamNodeFind(process, "surroundings"), scene));
  PetscFunctionReturn(0);
}
