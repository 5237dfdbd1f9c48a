/*
  The `strength` block of a scene: what walls and lamella bear.
*/
#include "scene_rows.h"
#include <math.h>

static const LamKey strength_keys[] = {
    {MAP("strength"), .default_words = "not known: no verdict that needs it",
     .example = "{wall: 0.5 MPa, lamella_normal: 0.02 MPa, lamella_shear: 0.05 MPa}",
     .help = "What the tissue bears, for `lamella rve --failure`."},
    {STRESS("strength.wall"), ABOVE(0), .default_words = "not known", .example = "0.5 MPa",
     .help =
         "Tension of a wall at which it tears: Cauchy stress along it plus the turgor of its cell, averaged over the "
         "wall's thickness and as long a stretch."},
    {STRESS("strength.lamella_normal"), ABOVE(0), .default_words = "not known", .example = "0.02 MPa",
     .help = "Normal traction, averaged over one wall thickness, that parts bonded cells; contact has its cohesion."},
    {STRESS("strength.lamella_shear"), ABOVE(0), .default_words = "not known", .example = "0.05 MPa",
     .help = "Shear traction, likewise, that parts bonded cells."},
};
LAM_KEY_TABLE(LamStrengthKeys, strength_keys);

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
