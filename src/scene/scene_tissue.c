/*
  Cells of a tissue file in a scene: those of `rve`, and of a region.
*/
#include <string.h>
#include <lamella/tissue.h>
#include "scene_keys.h"
#include "tissue_file.h"

static PetscErrorCode RefuseHexagons(const LamNode *rve, PetscBool thickness)
{
  static const char *const keys[] = {"cell.apothem", "cells",       "patch.columns",
                                     "patch.rows",   "patch.notch", "cell.wall_thickness"};

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(keys) - !thickness; k++) {
    const LamNode *node = LamNodeFind(rve, keys[k]);

    LamSceneCheckName(!node, node, "given together with tissue in line %d, whose file has the cells%s; leave it out",
                      LamNodeFind(rve, "tissue")->name_line, strstr(keys[k], "wall") ? " and their walls" : "");
  }
  PetscFunctionReturn(0);
}

/* Sets the cells and the scale of lengths, and what the file says of walls and classes. */
static PetscErrorCode ReadFile(const LamNode *node, LamPatchSides sides, PetscReal orientation,
                               LamMicrostructure *micro, LamScales *scales, LamSceneTissue *tissue)
{
  char path[PETSC_MAX_PATH_LEN];
  LamTissueFile file;

  PetscFunctionBeginUser;
  PetscCall(LamSceneResolvePath(node, path));
  PetscCall(LamTissueFileRead(path, sides, orientation, &file));
  *tissue = (LamSceneTissue){file.thickness, file.class};
  micro->tissue = file.tissue; /* destroyed with the microstructure */
  micro->is_patch = file.is_patch;
  micro->cells[0] = file.tissue->cells;
  micro->cells[1] = 1;
  scales->length = file.apothem;
  LamSceneCheck(file.tissue->cells <= LAM_MAX_CELLS * LAM_MAX_CELLS, node, "has %d cells; %d are the most",
                (int)file.tissue->cells, LAM_MAX_CELLS * LAM_MAX_CELLS);
  PetscCall(LamSceneCheckScale(node, file.apothem));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadTissue(const LamNode *root, LamScene *scene, LamSceneTissue *tissue)
{
  const LamNode *rve = LamNodeFind(root, "rve"), *patch = LamNodeFind(rve, "patch"), *found;
  LamValue sides, orientation;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(root, "rve.patch.sides", &found, &sides));
  PetscCall(LamSceneGet(root, "rve.cell.orientation", &found, &orientation));
  PetscCall(ReadFile(LamNodeFind(rve, "tissue"), (LamPatchSides)sides.number[0], orientation.number[0], &scene->micro,
                     &scene->scales, tissue));
  PetscCall(RefuseHexagons(rve, (PetscBool)(tissue->thickness != NULL)));
  LamSceneCheckName(!patch || scene->micro.is_patch, patch, "the cells of the tissue have a period; leave it out");
  if (!tissue->thickness) {
    PetscCall(LamSceneNeed(rve, "rve.cell"));
    PetscCall(LamSceneNeed(LamNodeFind(rve, "cell"), "rve.cell.wall_thickness"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadRegionTissue(const LamNode *entry, LamRegion *region, LamSceneTissue *tissue)
{
  const LamNode *node = LamNodeFind(entry, "tissue");
  LamMicrostructure *micro = &region->micro;

  PetscFunctionBeginUser;
  if (!node) PetscFunctionReturn(0);
  PetscCall(PetscFree(micro->cell));
  PetscCall(LamTissueDestroy(&micro->tissue));
  micro->orientation = region->reference = 0.0; /* as in the file */
  PetscCall(ReadFile(node, LAM_SIDES_AFFINE, 0.0, micro, &region->scales, tissue));
  PetscCall(RefuseHexagons(entry, (PetscBool)(tissue->thickness != NULL)));
  LamSceneCheck(!micro->is_patch, node,
                "is a patch between grips, no material point; name a file whose tissue has a period");
  for (PetscInt c = 0; tissue->class && c < micro->tissue->cells; c++)
    LamSceneCheck(tissue->class[c] == 0, node,
                  "cell %d is of class %d, a kind of rve.variation, which says what the cells of rve alone are; name a "
                  "file without classes",
                  (int)c, (int)tissue->class[c]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildTissue(const LamNode *node, const LamSceneTissue *tissue, const LamScales *scales,
                                   LamMicrostructure *micro)
{
  PetscReal sum = 0.0;

  PetscFunctionBeginUser;
  if (!node) PetscFunctionReturn(0);
  micro->cells[0] = micro->tissue->cells; /* of what hexagons would have */
  micro->cells[1] = 1;
  for (PetscInt c = 0; c < micro->tissue->cells && tissue->thickness; c++) sum += tissue->thickness[c] / scales->length;
  if (tissue->thickness) micro->wall_thickness = sum / (PetscReal)micro->tissue->cells;
  LamSceneCheck(micro->wall_thickness < 1.0, node,
                "the walls, %.3g um, fill cells of the apothem %.3g um; their file or cell.wall_thickness is wrong",
                (double)(1e6 * micro->wall_thickness * scales->length), (double)(1e6 * scales->length));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneDestroyTissue(LamSceneTissue *tissue)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(tissue->thickness));
  PetscCall(PetscFree(tissue->class));
  PetscFunctionReturn(0);
}
