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
     .help =
         "Tension of a wall at which it tears: Cauchy stress along it plus the turgor of its cell, averaged over "
         "the wall's thickness and as long a stretch. With `strength.wall_fracture_energy` also the nominal tension "
         "at which a cut opens."},
    {AREAL_ENERGY("strength.wall_fracture_energy"), INTO(LamScene, micro.tearing.energy), ABOVE(0),
     .default_words = "walls do not tear", .example = "10 J/m^2",
     .help = "With law `lamella`: walls tear at both ends and in the middle of faces, where the nominal tension across "
             "reaches `strength.wall`, and spend this energy per area of the cut; a torn cell bursts and loses its "
             "turgor. The number of elements along a face is then even, and contact is that of `sharpness: smooth`."},
    {STRESS("strength.lamella_normal"), INTO(LamStrength, lamella_normal), ABOVE(0), .default_words = "not known",
     .example = "0.02 MPa",
     .help = "Normal traction, averaged over one wall thickness, that parts bonded cells; contact has its cohesion."},
    {STRESS("strength.lamella_shear"), INTO(LamStrength, lamella_shear), ABOVE(0), .default_words = "not known",
     .example = "0.05 MPa", .help = "Shear traction, likewise, that parts bonded cells."},
};
LAM_KEY_TABLE(LamStrengthKeys, strength_keys);

PetscErrorCode LamSceneCheckTearing(const LamNode *energy, const LamNode *along, LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  if (!LamWallsTear(micro)) PetscFunctionReturn(0);
  LamSceneCheck(LamTearingLeastStiffness(&micro->tearing) < LAM_LAMELLA_STIFFEST, energy,
                "is so small for strength.wall that tension would fall in a jump at any stiffness; write more");
  micro->tearing.stiffness = LamTearingDefaultStiffness(micro);
  LamSceneCheck(micro->along % 2 == 0, along,
                "is odd, and walls that tear are cut in the middle of faces, too; write %d", (int)micro->along + 1);
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildTearing(const LamNode *root, LamScene *scene)
{
  const LamNode *energy = LamNodeFind(root, "strength.wall_fracture_energy");
  const LamNode *sharpness = LamNodeFind(root, "rve.interface.sharpness");
  LamMicrostructure *micro = &scene->micro;

  PetscFunctionBeginUser;
  if (!energy) PetscFunctionReturn(0);
  LamSceneCheck(!isnan(scene->strength.wall), energy, "needs strength.wall, the tension at which walls tear; write it");
  LamSceneCheck(
      micro->interface == LAM_INTERFACE_LAMELLA, energy,
      "contradicts rve.interface.law: %s: walls tear only with law: lamella; write that, with a large strength "
      "if cells shall not part, or leave this out",
      LamInterfaceLawNames[micro->interface]);
  LamSceneCheck(
      micro->sharpness != LAM_SHARPNESS_EXACT, sharpness,
      "contradicts strength.wall_fracture_energy: contact of walls that tear is smooth; write smooth, or leave "
      "it out");
  if (micro->sharpness == LAM_SHARPNESS_AUTO) micro->contact_width = LAM_USUAL_WIDTH;
  micro->sharpness = LAM_SHARPNESS_SMOOTH;
  micro->tearing.strength = scene->strength.wall;
  PetscCall(LamSceneCheckTearing(energy, LamNodeFind(root, "rve.mesh.along"), micro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildStrength(const LamNode *root, LamScene *scene)
{
  const LamNode *block = LamNodeFind(root, "strength"), *lamella;

  PetscFunctionBeginUser;
  scene->strength = (LamStrength){NAN, NAN, NAN};
  PetscCall(LamSceneFill(root, &scene->scales, LamStrength, &scene->strength));
  PetscCall(BuildTearing(root, scene));
  lamella = LamNodeFind(block, "lamella_normal");
  if (!lamella) lamella = LamNodeFind(block, "lamella_shear");
  LamSceneCheck(
      !lamella || scene->micro.interface == LAM_INTERFACE_BONDED, lamella, "contradicts law: %s; leave it out",
      scene->micro.interface == LAM_INTERFACE_CONTACT ? "contact, whose lamella bears the cohesion and no shear"
                                                      : "lamella, which has the strengths of rve.interface");
  PetscFunctionReturn(0);
}
