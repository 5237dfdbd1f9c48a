/*
  Law `lamella` in the block `rve.interface` of a scene: a middle lamella that breaks.
*/
#include "scene_rows.h"
#include <math.h>
#include <string.h>

#define SAME 1e-12 /* relative: energies that are equal up to rounding of units */

/* Factors of strength and energy: INTO the members, or the vectors of them. */
#define FACTOR(key_path, member, words)                                                                                \
  {                                                                                                                    \
    REAL(key_path), INTO(LamScene, micro.lamella.member), FROM(0), TO(1000), .default_value = "1", .example = "0.5",   \
                                                                             .help = words                             \
  }
#define FACE_FACTORS(key_path, member, words)                                                                          \
  {                                                                                                                    \
    REAL(key_path), INTO(LamScene, micro.lamella.member), .size = 3, FROM(0), TO(1000), .default_value = "[1, 1, 1]",  \
                                                          .example = "[1, 1, 0.5]", .help = words                      \
  }
#define REQUIRED_BY_LAW "none: required by law `lamella`"

static const LamKey lamella_keys[] = {
    {STRESS("rve.interface.strength"), INTO(LamScene, micro.lamella.strength), ABOVE(0),
     .default_words = REQUIRED_BY_LAW, .example = "0.05 MPa",
     .help = "Largest traction that the lamella bears in tension. This key and those down to "
             "`residual_cohesion` only with law `lamella`."},
    {AREAL_ENERGY("rve.interface.fracture_energy"), INTO(LamScene, micro.lamella.energy), ABOVE(0),
     .default_words = REQUIRED_BY_LAW, .example = "1 J/m^2",
     .help = "Energy that it takes in tension until nothing holds, per area at rest."},
    {STIFFNESS("rve.interface.stiffness"), INTO(LamScene, micro.lamella.stiffness), ABOVE(0),
     .default_words = "costs 0.08 % of the tissue's stiffness, or less of a brittle lamella", .example = "1000 MPa/mm",
     .help = "Traction over opening of the undamaged lamella; larger than strength^2/(2 fracture_energy), at most "
             "1e7 (C1 + C2)/apothem."},
    {MAP("rve.interface.shear"), .default_words = "as in tension",
     .example = "{strength: 0.03 MPa, fracture_energy: 2 J/m^2}", .help = "The lamella in shear."},
    {STRESS("rve.interface.shear.strength"), INTO(LamScene, micro.lamella.shear_strength), FROM(0),
     .default_words = "that in tension", .example = "0.03 MPa",
     .help = "Largest traction in shear; 0: shear is not resisted."},
    {AREAL_ENERGY("rve.interface.shear.fracture_energy"), INTO(LamScene, micro.lamella.shear_energy), ABOVE(0),
     .default_words = "that in tension", .example = "2 J/m^2", .help = "Energy of fracture in shear."},
    {REAL("rve.interface.mixing"), INTO(LamScene, micro.lamella.mixing), ABOVE(0), .default_value = "2", .example = "2",
     .help = "Exponent of Benzeggagh and Kenane between the energies of tension and shear."},
    {NAME_OF("rve.interface.softening", LamSofteningNames, LAM_SOFTENING_COUNT),
     INTO(LamScene, micro.lamella.softening), .default_value = "bilinear",
     .help = "How traction falls behind the strength: linearly in the opening, to zero at about 2 fracture_energy/"
             "strength, or exponentially."},
    {MAP("rve.interface.junction"), .default_words = "as along faces",
     .example = "{length: 5 um, strength: 2, fracture_energy: 2}",
     .help = "The lamella beside corners, where three cells meet: `strength`, `fracture_energy` or both."},
    {LENGTH("rve.interface.junction.length", "um"), INTO(LamScene, micro.lamella.junction_length), REQUIRED, ABOVE(0),
     .example = "5 um", .help = "Distance from a corner along a face; at most half a face, apothem/sqrt(3)."},
    FACTOR("rve.interface.junction.strength", junction_strength, "Factor of the strengths there."),
    FACTOR("rve.interface.junction.fracture_energy", junction_energy, "Factor of the energies there."),
    {MAP("rve.interface.faces"), .default_words = "all alike", .example = "{strength: [1, 1, 0.5]}",
     .help = "Weak planes: the lamella on faces with normal 0, 1 and 2."},
    FACE_FACTORS("rve.interface.faces.strength", face_strength, "Factors of the strengths."),
    FACE_FACTORS("rve.interface.faces.fracture_energy", face_energy, "Factors of the energies."),
    {MAP("rve.interface.between_clusters"), .default_words = "as within clusters",
     .example = "{strength: 0.3, fracture_energy: 0.2}",
     .help = "The lamella between cells of different `rve.variation.kinds[].cluster`."},
    FACTOR("rve.interface.between_clusters.strength", between_strength, "Factor of the strengths."),
    FACTOR("rve.interface.between_clusters.fracture_energy", between_energy, "Factor of the energies."),
    {STRESS("rve.interface.residual_cohesion"), INTO(LamScene, cohesion), FROM(0), .default_words = "`0 MPa`",
     .example = "0.001 MPa",
     .help = "Suction that is left at any gap where the lamella is broken: the cohesion of the load."},
};
LAM_KEY_TABLE(LamLamellaKeys, lamella_keys);

/* Whether a key of an interface, of rve or of a region, is of law lamella alone. */
static PetscBool IsOfLamella(const char name[])
{
  static const char block[] = "rve.interface.";

  for (PetscInt k = 0; k < LamLamellaKeys.count; k++)
    if (!strcmp(lamella_keys[k].path + strlen(block), name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode LamSceneCheckLaw(const LamNode *interface, LamInterfaceLawType law)
{
  const LamNode *cohesion = LamNodeFind(interface, "cohesion"), *clearance = LamNodeFind(interface, "clearance");

  PetscFunctionBeginUser;
  if (law == LAM_INTERFACE_LAMELLA) {
    LamSceneCheckName(!cohesion, cohesion,
                      "contradicts law: lamella, which holds by its strength; write strength, or residual_cohesion for "
                      "the suction that is left where it is broken");
    LamSceneCheck(!clearance || !(clearance->value.number[0] > 0.0), clearance,
                  "contradicts law: lamella, whose faces lie on each other at rest; leave it out, or write law: "
                  "contact");
    PetscFunctionReturn(0);
  }
  if (law == LAM_INTERFACE_BONDED) {
    LamSceneCheck(!cohesion || !(cohesion->value.number[0] > 0.0), cohesion, LAM_BONDED_PARTS);
    LamSceneCheck(!clearance || !(clearance->value.number[0] > 0.0), clearance, LAM_BONDED_PARTS);
  }
  for (const LamNode *entry = interface ? interface->first : NULL; entry; entry = entry->next)
    LamSceneCheckName(!IsOfLamella(entry->name), entry, LAM_NOT_LAMELLA, LamInterfaceLawNames[law]);
  PetscFunctionReturn(0);
}

/* ---- the law ---- */

static PetscErrorCode BuildShear(const LamNode *interface, LamLamella *lamella)
{
  const LamNode *strength = LamNodeFind(interface, "shear.strength"), *mixing = LamNodeFind(interface, "mixing");
  const LamNode *energy = LamNodeFind(interface, "shear.fracture_energy");

  PetscFunctionBeginUser;
  if (!strength) lamella->shear_strength = lamella->strength;
  LamSceneCheckName(!energy || lamella->shear_strength > 0.0, energy,
                    "says nothing where shear is not resisted; leave it out, or write a strength in shear larger than "
                    "0 MPa");
  if (!energy || fabs(lamella->shear_energy - lamella->energy) <= SAME * lamella->energy)
    lamella->shear_energy = lamella->energy;
  LamSceneCheckName(!mixing || lamella->shear_energy != lamella->energy, mixing,
                    "says nothing where the energies of tension and shear are equal; leave it out, or write "
                    "shear.fracture_energy");
  PetscFunctionReturn(0);
}

static PetscBool HasClusters(const LamMicrostructure *micro)
{
  for (PetscInt c = 1; micro->cell && c < micro->cells[0] * micro->cells[1]; c++)
    if (micro->cell[c].cluster != micro->cell[0].cluster) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The blocks of factors. */
static PetscErrorCode CheckFactors(const LamNode *interface, const LamScales *scales, const LamMicrostructure *micro)
{
  static const char *const blocks[] = {"junction", "faces", "between_clusters"};
  const LamNode *length = LamNodeFind(interface, "junction.length");
  const LamNode *between = LamNodeFind(interface, "between_clusters");
  const PetscReal half_face = 1.0 / sqrt(3.0);

  PetscFunctionBeginUser;
  for (size_t b = 0; b < PETSC_STATIC_ARRAY_LENGTH(blocks); b++) {
    const LamNode *block = LamNodeFind(interface, blocks[b]);

    LamSceneCheckName(!block || LamNodeFind(block, "strength") || LamNodeFind(block, "fracture_energy"), block,
                      "changes nothing; write a factor, such as strength or fracture_energy, or leave it out");
  }
  LamSceneCheck(micro->lamella.junction_length <= (1.0 + SAME) * half_face, length,
                "is more than half a face, %g um; write at most that", (double)(1e6 * half_face * scales->length));
  LamSceneCheckName(!between || HasClusters(micro), between,
                    "says nothing where all cells are of one cluster; give a kind in rve.variation.kinds its cluster, "
                    "such as cluster: 1, or leave it out");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneSetStiffness(const LamNode *given, const LamNode *energy, const LamScales *scales,
                                    LamMicrostructure *micro)
{
  const PetscReal unit = 1e-9 * scales->stress / scales->length; /* MPa/mm */
  const PetscReal least = LamLamellaLeastStiffness(micro);

  PetscFunctionBeginUser;
  LamSceneCheck(least < LAM_LAMELLA_STIFFEST, energy,
                "with its factors the energy of the lamella is so small for its strength that traction would fall in "
                "a jump at any stiffness; write a larger fracture_energy, or a smaller strength");
  if (!given) micro->lamella.stiffness = LamLamellaDefaultStiffness(micro);
  LamSceneCheck(micro->lamella.stiffness > least, given,
                "traction would fall in a jump: the stiffness must be larger than strength^2/(2 fracture_energy); "
                "write more than %g MPa/mm, or leave it out",
                (double)(least * unit));
  LamSceneCheck(micro->lamella.stiffness <= LAM_LAMELLA_STIFFEST, given,
                "rounding of openings would spoil the traction; write at most %g MPa/mm, or leave it out",
                (double)(LAM_LAMELLA_STIFFEST * unit));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildLamella(const LamNode *interface, LamScene *scene)
{
  const LamNode *energy = LamNodeFind(interface, "fracture_energy");
  LamMicrostructure *micro = &scene->micro;

  PetscFunctionBeginUser;
  LamSceneRequire(LamNodeFind(interface, "strength"), interface, "strength",
                  "missing; write the largest traction of the lamella, such as 0.05 MPa");
  LamSceneRequire(energy, interface, "fracture_energy",
                  "missing; write the energy that breaks the lamella, such as 1 J/m^2");
  PetscCall(BuildShear(interface, &micro->lamella));
  PetscCall(CheckFactors(interface, &scene->scales, micro));
  PetscCall(LamSceneSetStiffness(LamNodeFind(interface, "stiffness"), energy, &scene->scales, micro));
  PetscFunctionReturn(0);
}
