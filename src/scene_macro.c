/*
  The `macro` block of a scene.
*/
#include "scene_keys.h"
#include <string.h>

/* The conditions side by side: which components are held, where. */
typedef struct {
  const LamNode *entry[LAM_BOX_COUNT]; /* NULL: nothing is said about this side */
  PetscBool given[LAM_BOX_COUNT][2];
  PetscReal displacement[LAM_BOX_COUNT][2];
} Sides;

static PetscErrorCode BuildBoundary(const LamDocument *document, const LamNode *entry, LamScene *scene, Sides *sides)
{
  LamBoundary *boundary;
  const LamNode *on_node, *displacement_node;
  LamValue on, displacement;
  LamSide side;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].on", &on_node, &on));
  PetscCall(LamSceneGet(entry, "macro.boundary[].displacement", &displacement_node, &displacement));
  side = (LamSide)on.number[0];
  if (sides->entry[side]) {
    PetscCall(LamSceneFail(document, on_node,
                           "this side has a condition already, in line %d; give one condition for each side",
                           sides->entry[side]->line));
  }
  boundary = &scene->macro.boundary[scene->macro.boundary_count++];
  sides->entry[side] = displacement_node;
  PetscCall(PetscStrncpy(boundary->on, LamSideNames[side], sizeof(boundary->on)));
  for (PetscInt c = 0; c < 2; c++) {
    boundary->given[c] = displacement.is_free[c] ? PETSC_FALSE : PETSC_TRUE;
    PetscCall(LamSceneScale(document, displacement_node, displacement.number[c], scene->scales.macro_length,
                            &boundary->displacement[c]));
    sides->given[side][c] = boundary->given[c];
    sides->displacement[side][c] = boundary->displacement[c];
  }
  PetscFunctionReturn(0);
}

/* Sides that meet share a corner: both move it, so they agree. */
static PetscErrorCode CheckCorners(const LamDocument *document, const Sides *sides)
{
  PetscFunctionBeginUser;
  for (LamSide upright = LAM_BOX_LEFT; upright <= LAM_BOX_RIGHT; upright++) {
    for (LamSide level = LAM_BOX_BOTTOM; level <= LAM_BOX_TOP; level++) {
      for (PetscInt c = 0; c < 2; c++) {
        if (!sides->given[upright][c] || !sides->given[level][c]) continue;
        if (sides->displacement[upright][c] == sides->displacement[level][c]) continue;
        PetscCall(LamSceneFail(document, sides->entry[upright],
                               "%s and %s (line %d) move their common corner differently along X%d; write equal "
                               "displacements, or free in one of them",
                               LamSideNames[upright], LamSideNames[level], sides->entry[level]->line, (int)c + 1));
      }
    }
  }
  PetscFunctionReturn(0);
}

/*
  Rigid motions of a box: along X1, along X2, and the rotation u = w (-X2, X1). A side holds a translation where its
  component is given. The rotation changes u1 along the upright sides and u2 along the level ones, so one of these holds
  it; a component that is constant along its side holds it only together with the opposite side.
*/
static PetscErrorCode CheckRigidMotions(const LamDocument *document, const LamNode *list, const Sides *sides)
{
  const PetscBool(*given)[2] = sides->given;
  PetscBool held[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  static const char *const names[] = {"along X1", "along X2", "by a rotation"};
  static const char *const remedies[] = {
      "give the first displacement component on a side", "give the second displacement component on a side",
      "give the first component on left or right, or the second on bottom or top, or one on both opposite sides"};

  PetscFunctionBeginUser;
  for (LamSide side = 0; side < LAM_BOX_COUNT; side++) {
    for (PetscInt c = 0; c < 2; c++) held[c] = held[c] || given[side][c] ? PETSC_TRUE : PETSC_FALSE;
  }
  held[2] = given[LAM_BOX_LEFT][0] || given[LAM_BOX_RIGHT][0] || given[LAM_BOX_BOTTOM][1] || given[LAM_BOX_TOP][1] ||
                    (given[LAM_BOX_LEFT][1] && given[LAM_BOX_RIGHT][1]) ||
                    (given[LAM_BOX_BOTTOM][0] && given[LAM_BOX_TOP][0])
                ? PETSC_TRUE
                : PETSC_FALSE;
  for (PetscInt i = 0; i < 3; i++) {
    if (!held[i]) PetscCall(LamSceneFailName(document, list, "the body can still move %s; %s", names[i], remedies[i]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildMesh(const LamDocument *document, LamScene *scene)
{
  const LamNode *box_node;
  LamValue box, elements;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.mesh.box", &box_node, &box));
  PetscCall(LamSceneGet(document->root, "macro.mesh.elements", NULL, &elements));
  scene->scales.macro_length = box.number[0];
  for (PetscInt i = 0; i < 2; i++) {
    PetscCall(LamSceneScale(document, box_node, box.number[i], scene->scales.macro_length, &scene->macro.box[i]));
    scene->macro.elements[i] = (PetscInt)elements.number[i];
  }
  PetscFunctionReturn(0);
}

/*
  A body that inflates freely ends at zero total stress, where every mean face traction is zero, whatever the turgor is:
  contact alone then holds no cell.
*/
static PetscErrorCode CheckInflation(const LamDocument *document, const LamNode *block, const LamNode *inflate_node,
                                     const LamScene *scene)
{
  static const char *const remedy =
      "free tissue is held together only by the lamella; give interface.cohesion > 0, or inflate: false";

  PetscFunctionBeginUser;
  if (!scene->macro.inflate || scene->micro.interface != LAM_INTERFACE_CONTACT || scene->cohesion > 0.0)
    PetscFunctionReturn(0);
  if (inflate_node)
    PetscCall(LamSceneFail(document, inflate_node, "law: contact has no cohesion; %s", remedy));
  else
    PetscCall(LamSceneFailMissing(document, block, "inflate",
                                  "missing, so true with turgor, but law: contact has no cohesion; %s", remedy));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildMacro(const LamDocument *document, LamScene *scene)
{
  const LamNode *block, *list, *inflate_node;
  LamValue inflate, steps, unused;
  Sides sides = {0};

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro", &block, &unused));
  if (!block) PetscFunctionReturn(0);
  scene->has_macro = PETSC_TRUE;
  PetscCall(BuildMesh(document, scene));
  PetscCall(LamSceneGet(document->root, "macro.inflate", &inflate_node, &inflate));
  scene->macro.inflate = scene->turgor != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  if (inflate_node) scene->macro.inflate = inflate.number[0] != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(CheckInflation(document, block, inflate_node, scene));
  PetscCall(LamSceneGet(document->root, "macro.steps", NULL, &steps));
  scene->macro.steps = (PetscInt)steps.number[0];
  PetscCall(LamSceneGet(document->root, "macro.boundary", &list, &unused));
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    PetscCall(BuildBoundary(document, entry, scene, &sides));
  }
  PetscCall(CheckCorners(document, &sides));
  PetscCall(CheckRigidMotions(document, list, &sides));
  PetscFunctionReturn(0);
}
