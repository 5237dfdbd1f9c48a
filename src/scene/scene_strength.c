/*
  The `strength` block of a scene: what walls and lamella bear.
*/
#include "scene_keys.h"
#include <math.h>

static PetscErrorCode GetStrength(const LamDocument *document, const char path[], PetscReal scale, const LamNode **node,
                                  PetscReal *strength)
{
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, path, node, &value));
  *strength = NAN;
  if (*node) PetscCall(LamSceneScale(document, *node, value.number[0], scale, strength));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildStrength(const LamDocument *document, LamScene *scene)
{
  const PetscReal scale = scene->scales.stress;
  const LamNode *wall, *normal, *shear;

  PetscFunctionBeginUser;
  PetscCall(GetStrength(document, "strength.wall", scale, &wall, &scene->strength.wall));
  PetscCall(GetStrength(document, "strength.lamella_normal", scale, &normal, &scene->strength.lamella_normal));
  PetscCall(GetStrength(document, "strength.lamella_shear", scale, &shear, &scene->strength.lamella_shear));
  if (scene->micro.interface == LAM_INTERFACE_CONTACT && (normal || shear)) {
    PetscCall(LamSceneFail(document, normal ? normal : shear,
                           "contradicts law: contact, whose lamella bears the cohesion and no shear; leave it out"));
  }
  PetscFunctionReturn(0);
}
