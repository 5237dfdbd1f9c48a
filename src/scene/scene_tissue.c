/*
  Cells of a tissue file in a scene.
*/
#include <string.h>
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

PetscErrorCode LamSceneReadTissue(const LamNode *root, LamScene *scene, LamSceneTissue *tissue)
{
  const LamNode *rve = LamNodeFind(root, "rve"), *node = LamNodeFind(rve, "tissue");
  const LamNode *patch = LamNodeFind(rve, "patch"), *found;
  char path[PETSC_MAX_PATH_LEN];
  LamValue sides, orientation;
  LamTissueFile file;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(root, "rve.patch.sides", &found, &sides));
  PetscCall(LamSceneGet(root, "rve.cell.orientation", &found, &orientation));
  PetscCall(LamSceneResolvePath(node, path));
  PetscCall(LamTissueFileRead(path, (LamPatchSides)sides.number[0], orientation.number[0], &file));
  *tissue = (LamSceneTissue){file.thickness, file.class};
  scene->micro.tissue = file.tissue; /* the scene owns it */
  scene->micro.is_patch = file.is_patch;
  scene->micro.cells[0] = file.tissue->cells;
  scene->micro.cells[1] = 1;
  scene->scales.length = file.apothem;
  PetscCall(RefuseHexagons(rve, (PetscBool)(file.thickness != NULL)));
  LamSceneCheckName(!patch || file.is_patch, patch, "the cells of the tissue have a period; leave it out");
  LamSceneCheck(file.tissue->cells <= LAM_MAX_CELLS * LAM_MAX_CELLS, node, "has %d cells; %d are the most",
                (int)file.tissue->cells, LAM_MAX_CELLS * LAM_MAX_CELLS);
  PetscCall(LamSceneCheckScale(node, file.apothem));
  if (!file.thickness) {
    PetscCall(LamSceneNeed(rve, "rve.cell"));
    PetscCall(LamSceneNeed(LamNodeFind(rve, "cell"), "rve.cell.wall_thickness"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildTissue(const LamNode *root, const LamSceneTissue *tissue, LamScene *scene)
{
  const LamNode *node = LamNodeFind(root, "rve.tissue");
  LamMicrostructure *micro = &scene->micro;
  PetscReal sum = 0.0;

  PetscFunctionBeginUser;
  if (!node) PetscFunctionReturn(0);
  micro->cells[0] = micro->tissue->cells; /* of what hexagons would have */
  micro->cells[1] = 1;
  for (PetscInt c = 0; c < micro->tissue->cells && tissue->thickness; c++)
    sum += tissue->thickness[c] / scene->scales.length;
  if (tissue->thickness) micro->wall_thickness = sum / (PetscReal)micro->tissue->cells;
  LamSceneCheck(micro->wall_thickness < 1.0, node,
                "the walls, %.3g um, fill cells of the apothem %.3g um; their file or cell.wall_thickness is wrong",
                (double)(1e6 * micro->wall_thickness * scene->scales.length), (double)(1e6 * scene->scales.length));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneDestroyTissue(LamSceneTissue *tissue)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(tissue->thickness));
  PetscCall(PetscFree(tissue->class));
  PetscFunctionReturn(0);
}
