/*
  The `rve.interface` block of a scene: the middle lamella between the cells.
*/
#include "scene_rows.h"

static const LamKey interface_keys[] = {
    {MAP("rve.interface"), .example = "{law: bonded}", .help = "The middle lamella between the cells."},
    {NAME_OF("rve.interface.law", LamInterfaceLawNames, LAM_INTERFACE_LAW_COUNT), INTO(LamScene, micro.interface),
     .default_value = "bonded",
     .help = "`bonded`: cells never part; `contact`: they may part and slide without friction; `lamella`: a "
             "middle lamella holds them, which softens and breaks for good."},
    {STRESS("rve.interface.cohesion"), INTO(LamScene, cohesion), FROM(0), .default_value = "0 MPa",
     .example = "0.001 MPa",
     .help = "Normal traction that parts the cells, a suction that acts at any gap; only with law `contact`."},
    {LENGTH("rve.interface.clearance", "um"), INTO(LamScene, micro.clearance), FROM(0), .default_value = "0 um",
     .example = "0.1 um",
     .help = "Distance between facing walls at rest: each cell is smaller than its place by half of it all around; "
             "only with law `contact`."},
    {NAME_OF("rve.interface.sharpness", LamSharpnessNames, LAM_SHARPNESS_COUNT), INTO(LamScene, micro.sharpness),
     .default_value = "auto",
     .help = "Law of contact: `exact`: gaps are never negative; where it has no state the smooth law is used; "
             "`smooth`: contact pressure falls over a small gap, so that responses are smooth in F; "
             "`auto`: with law `contact` `exact`, with law `lamella` `smooth`. Not with law `bonded`."},
    {LENGTH("rve.interface.width", "um"), INTO(LamScene, micro.contact_width), ABOVE(0),
     .default_words = "0.003 of the apothem", .example = "0.5 um",
     .help = "Gap at which contact pressure has fallen to none; only with sharpness `smooth`. `contact_error` of "
             "a response tells its price, and `lamella tradeoff` measures it."},
};
LAM_KEY_TABLE(LamInterfaceKeys, interface_keys);

PetscErrorCode LamSceneCheckClearance(const LamNode *node, const LamScales *scales, const LamMicrostructure *micro)
{
  const PetscInt count = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal thickest = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < count; c++) thickest = PetscMax(thickest, LamWallThickness(micro, c));
  LamSceneCheck(thickest < LamOuterApothem(micro), node,
                "half of it, %g um, and a wall of %g um leave no lumen in an apothem of %g um; write less",
                (double)(0.5e6 * micro->clearance * scales->length), (double)(1e6 * thickest * scales->length),
                (double)(1e6 * scales->length));
  PetscFunctionReturn(0);
}

#define LARGEST_WIDTH 0.1 /* of the smooth law of contact, apothems */

static PetscErrorCode BuildContactLaw(const LamNode *interface, LamMicrostructure *micro)
{
  const LamNode *sharpness = LamNodeFind(interface, "sharpness"), *width = LamNodeFind(interface, "width");
  const PetscBool smooth = (PetscBool)(micro->sharpness == LAM_SHARPNESS_SMOOTH);

  PetscFunctionBeginUser;
  if (micro->interface == LAM_INTERFACE_BONDED) LamSceneCheckName(!sharpness, sharpness, LAM_BONDED_PARTS);
  LamSceneCheckName(!width || smooth, width, "says nothing of the exact law; write sharpness: smooth, or leave it out");
  LamSceneCheck(!width || micro->contact_width <= LARGEST_WIDTH, width,
                "is more than a tenth of the apothem; write less");
  if (smooth && !width) micro->contact_width = LAM_USUAL_WIDTH;
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildInterface(const LamNode *root, LamScene *scene)
{
  const LamNode *interface = LamNodeFind(root, "rve.interface");
  LamMicrostructure *micro = &scene->micro;

  PetscFunctionBeginUser;
  PetscCall(LamSceneCheckLaw(interface, micro->interface));
  PetscCall(BuildContactLaw(interface, micro));
  PetscCall(LamSceneCheckClearance(LamNodeFind(interface, "clearance"), &scene->scales, micro));
  if (micro->interface == LAM_INTERFACE_LAMELLA) PetscCall(LamSceneBuildLamella(interface, scene));
  PetscFunctionReturn(0);
}
