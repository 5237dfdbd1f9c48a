/*
  Walls in a scene: `rve.wall`, and those of kinds of cells and of regions.
*/
#include "scene_rows.h"

static const LamKey wall_keys[] = {
    {MAP("rve.wall"), REQUIRED, .example = "{law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}",
     .help = "Material of the cell walls. The small-strain shear modulus without fibres is C1 + C2."},
    {NAME_OF("rve.wall.law", LamWallLawNames, LAM_WALL_LAW_COUNT), REQUIRED, .example = "fibre_mooney_rivlin",
     .help = "`fibre_mooney_rivlin`: Mooney-Rivlin with fibres along the wall; `mooney_rivlin`: without fibres."},
    {STRESS("rve.wall.C1"), REQUIRED, ABOVE(0), .example = "0.1 MPa", .help = "First Mooney-Rivlin modulus."},
    {STRESS("rve.wall.C2"), REQUIRED, FROM(0), .example = "0.01 MPa", .help = "Second Mooney-Rivlin modulus."},
    {STRESS("rve.wall.C4"), FROM(0), .default_words = "none: required by law `fibre_mooney_rivlin`", .example = "1 MPa",
     .help = "Fibre modulus; only with law `fibre_mooney_rivlin`."},
    {STRESS("rve.wall.bulk_modulus"), ABOVE(0), .default_words = "1000 (C1 + C2)", .example = "110 MPa",
     .help = "Bulk modulus, larger than C1 + C2: walls are nearly incompressible."},
    {NAME_OF("rve.wall.fibres", LamFibresNames, LAM_FIBRES_COUNT), .default_value = "both", .example = "tension",
     .help = "Whether fibres also resist compression along the wall (`both`) or stretch alone (`tension`)."},
};
LAM_KEY_TABLE(LamWallKeys, wall_keys);

/* Reads <prefix>.<name>; *number stays as it is where the file does not give it. */
static PetscErrorCode GetPart(const LamNode *base, const char prefix[], const char name[], const LamNode **node,
                              PetscReal *number)
{
  char path[80];
  LamValue value;

  PetscFunctionBeginUser;
  snprintf(path, sizeof(path), "%s.%s", prefix, name);
  PetscCall(LamSceneGet(base, path, node, &value));
  if (value.count) *number = value.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode GetModulus(const LamDocument *document, const LamNode *base, const char prefix[],
                                 const char name[], PetscReal stress, const LamNode **node, PetscReal *modulus)
{
  PetscReal si = 0.0;

  PetscFunctionBeginUser;
  PetscCall(GetPart(base, prefix, name, node, &si));
  if (*node) PetscCall(LamSceneScale(document, *node, si, stress, modulus));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckFibres(const LamDocument *document, const LamNode *map, const LamNode *C4_node,
                                  PetscBool has_C4, LamWall *wall)
{
  PetscFunctionBeginUser;
  if (wall->law == LAM_WALL_FIBRE_MOONEY_RIVLIN && !has_C4) {
    PetscCall(LamSceneFailMissing(document, map, "C4",
                                  "missing; write the fibre modulus, such as 1 MPa, or law: mooney_rivlin"));
  }
  if (wall->law == LAM_WALL_FIBRE_MOONEY_RIVLIN) PetscFunctionReturn(0);
  if (C4_node && wall->C4 > 0.0) {
    PetscCall(LamSceneFail(document, C4_node,
                           "law mooney_rivlin has no fibres; leave C4 out, or write law: "
                           "fibre_mooney_rivlin"));
  }
  wall->C4 = 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadWall(const LamDocument *document, const LamNode *base, const char prefix[], PetscReal stress,
                                const LamWall *own, LamWall *wall)
{
  const PetscReal bulk_ratio = own ? own->bulk_modulus / (own->C1 + own->C2) : 1000.0;
  const LamNode *map, *node, *C4_node, *bulk_node;
  PetscBool has_C4 = (PetscBool)(own && own->law == LAM_WALL_FIBRE_MOONEY_RIVLIN);
  PetscReal law, fibres;
  LamValue unused;

  PetscFunctionBeginUser;
  *wall = own ? *own : (LamWall){0};
  law = (PetscReal)wall->law;
  fibres = (PetscReal)wall->fibres;
  PetscCall(LamSceneGet(base, prefix, &map, &unused));
  PetscCall(GetPart(base, prefix, "law", &node, &law));
  PetscCall(GetPart(base, prefix, "fibres", &node, &fibres));
  wall->law = (LamWallLawType)law;
  wall->fibres = (LamFibres)fibres;
  PetscCall(GetModulus(document, base, prefix, "C1", stress, &node, &wall->C1));
  PetscCall(GetModulus(document, base, prefix, "C2", stress, &node, &wall->C2));
  PetscCall(GetModulus(document, base, prefix, "C4", stress, &C4_node, &wall->C4));
  PetscCall(CheckFibres(document, map, C4_node, (PetscBool)(C4_node || has_C4), wall));
  wall->bulk_modulus = bulk_ratio * (wall->C1 + wall->C2);
  PetscCall(GetModulus(document, base, prefix, "bulk_modulus", stress, &bulk_node, &wall->bulk_modulus));
  if (wall->bulk_modulus <= wall->C1 + wall->C2) {
    PetscCall(LamSceneFail(document, bulk_node ? bulk_node : map,
                           "cell walls are nearly incompressible; write a bulk modulus of more than C1 + C2 = %g MPa",
                           (double)((wall->C1 + wall->C2) * stress) * 1e-6));
  }
  PetscFunctionReturn(0);
}
