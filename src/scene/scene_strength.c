/*
  The `strength` block of a scene: strengths of walls and lamella.
*/
#include "scene_rows.h"
#include <math.h>

static const LamKey strength_keys[] = {
    {MAP("strength"), .default_words = "not known: no verdict that needs it",
     .example = "{wall: 0.5 MPa, lamella_normal: 0.02 MPa, lamella_shear: 0.05 MPa}",
     .help = "What the tissue bears, for `lamella rve --failure`."},
    {STRESS("strength.wall"), INTO(LamStrength, wall), ABOVE(0), .default_words = "not known", .example = "0.5 MPa",
     .help = "Tension of a wall at which it tears: Cauchy stress along it plus the turgor of its cell, averaged over "
             "the wall's thickness and as long a stretch."},
    {STRESS("strength.lamella_normal"), INTO(LamStrength, lamella_normal), ABOVE(0), .default_words = "not known",
     .example = "0.02 MPa",
     .help = "Normal traction, averaged over one wall thickness, that parts bonded cells; contact has its cohesion."},
    {STRESS("strength.lamella_shear"), INTO(LamStrength, lamella_shear), ABOVE(0), .default_words = "not known",
     .example = "0.05 MPa", .help = "Shear traction, likewise, that parts bonded cells."},
};
LAM_KEY_TABLE(LamStrengthKeys, strength_keys);

PetscErrorCode LamSceneBuildStrength(const LamNode *root, LamScene *scene)
{
  const LamNode *block = LamNodeFind(root, "strength"), *lamella;

  PetscFunctionBeginUser;
  scene->strength = (LamStrength){NAN, NAN, NAN};
  PetscCall(LamSceneFill(root, &scene->scales, LamStrength, &scene->strength));
  lamella = LamNodeFind(block, "lamella_normal");
  if (!lamella) lamella = LamNodeFind(block, "lamella_shear");
  LamSceneCheck(
      !lamella || scene->micro.interface == LAM_INTERFACE_BONDED, lamella, "contradicts law: %s; leave it out",
      scene->micro.interface == LAM_INTERFACE_CONTACT ? "contact, whose lamella bears the cohesion and no shear"
                                                      : "lamella, which has the strengths of rve.interface");
  PetscFunctionReturn(0);
}
