/*
  The `rve` block of a scene, and the scales that make it nondimensional.
*/
#include "scene_keys.h"
#include <math.h>

/* SI: within these nothing that is told over- or underflows, such as work, a stress times an area. */
#define LARGEST_SCALE 1e100

/* Ratios to the apothem and to C1 + C2 beyond which double precision holds nothing of the walls. */
#define LARGEST_RATIO 1e9

PetscErrorCode LamSceneScale(const LamDocument *document, const LamNode *node, PetscReal si, PetscReal scale,
                             PetscReal *number)
{
  PetscFunctionBeginUser;
  *number = si / scale;
  if (node && !(fabs(*number) <= LARGEST_RATIO)) {
    PetscCall(LamSceneFail(document, node, "is beyond all measure against the cell's apothem or C1 + C2; check units"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckScale(const LamDocument *document, const LamNode *node, PetscReal si)
{
  PetscFunctionBeginUser;
  if (!(si >= 1.0 / LARGEST_SCALE && si <= LARGEST_SCALE))
    PetscCall(LamSceneFail(document, node, "is %g in SI units, beyond %g to %g, all that is reckoned with; check units",
                           (double)si, 1.0 / LARGEST_SCALE, LARGEST_SCALE));
  PetscFunctionReturn(0);
}

static PetscErrorCode GetReal(const LamDocument *document, const char path[], const LamNode **node, PetscReal *si)
{
  LamValue value;

  PetscFunctionBeginUser;
  *si = 0.0;
  PetscCall(LamSceneGet(document->root, path, node, &value));
  *si = value.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode GetName(const LamDocument *document, const char path[], const LamNode **node, PetscInt *index)
{
  PetscReal number;

  PetscFunctionBeginUser;
  *index = 0;
  PetscCall(GetReal(document, path, node, &number));
  *index = (PetscInt)number;
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildCell(const LamDocument *document, LamScene *scene)
{
  LamMicrostructure *micro = &scene->micro;
  const LamNode *node;
  PetscReal thickness;
  LamValue along, through;

  PetscFunctionBeginUser;
  PetscCall(GetReal(document, "rve.cell.apothem", &node, &scene->scales.length));
  PetscCall(LamSceneCheckScale(document, node, scene->scales.length));
  PetscCall(GetReal(document, "rve.cell.wall_thickness", &node, &thickness));
  if (thickness >= scene->scales.length) {
    PetscCall(LamSceneFail(document, node, "the wall fills the cell; write a thickness less than the apothem"));
  }
  PetscCall(LamSceneScale(document, node, thickness, scene->scales.length, &micro->wall_thickness));
  PetscCall(GetReal(document, "rve.cell.orientation", NULL, &micro->orientation));
  /* what is not given stays 0, or negative: the planner chooses */
  PetscCall(LamSceneGet(document->root, "rve.mesh.along", NULL, &along));
  PetscCall(LamSceneGet(document->root, "rve.mesh.through", NULL, &through));
  micro->along = (PetscInt)along.number[0];
  micro->through = (PetscInt)through.number[0];
  PetscCall(GetReal(document, "rve.mesh.grading", &node, &micro->grading));
  if (!node) micro->grading = micro->along ? 0.0 : -1.0;
  PetscCall(LamSceneGet(document->root, "rve.mesh.measured", &node, &along));
  if (node) PetscCall(LamSceneResolvePath(document, node, scene->measured));
  PetscFunctionReturn(0);
}

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

/* The wall of the tissue; its C1 + C2 is the unit of stress. */
static PetscErrorCode BuildWall(const LamDocument *document, LamScene *scene)
{
  const LamNode *node;
  PetscReal C1, C2;

  PetscFunctionBeginUser;
  PetscCall(GetReal(document, "rve.wall.C1", &node, &C1));
  PetscCall(GetReal(document, "rve.wall.C2", NULL, &C2));
  scene->scales.stress = C1 + C2;
  PetscCall(LamSceneCheckScale(document, node, C1 + C2));
  PetscCall(LamSceneReadWall(document, document->root, "rve.wall", C1 + C2, NULL, &scene->micro.wall));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildInterface(const LamDocument *document, LamScene *scene)
{
  const LamNode *cohesion_node, *clearance_node;
  PetscReal cohesion, clearance;
  PetscInt law, strategy;

  PetscFunctionBeginUser;
  PetscCall(GetName(document, "rve.interface.law", NULL, &law));
  PetscCall(GetReal(document, "rve.interface.cohesion", &cohesion_node, &cohesion));
  PetscCall(GetReal(document, "rve.interface.clearance", &clearance_node, &clearance));
  if (law == LAM_INTERFACE_BONDED && (cohesion > 0.0 || clearance > 0.0)) {
    PetscCall(LamSceneFail(document, cohesion > 0.0 ? cohesion_node : clearance_node,
                           "contradicts law: bonded, whose cells never part; leave it out"));
  }
  PetscCall(GetName(document, "rve.strategy", NULL, &strategy));
  scene->micro.interface = (LamInterfaceLawType)law;
  scene->strategy = (LamStrategy)strategy;
  PetscCall(GetReal(document, "rve.tolerance", NULL, &scene->tolerance));
  PetscCall(LamSceneScale(document, cohesion_node, cohesion, scene->scales.stress, &scene->cohesion));
  PetscCall(LamSceneScale(document, clearance_node, clearance, scene->scales.length, &scene->micro.clearance));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckTurgor(const LamDocument *document, const LamNode *node, PetscReal turgor)
{
  const LamNode *mode_node;
  PetscInt mode;

  PetscFunctionBeginUser;
  PetscCall(GetName(document, "rve.turgor.mode", &mode_node, &mode));
  if (mode_node && mode == LAM_TURGOR_NONE && turgor != 0.0) {
    PetscCall(LamSceneFail(document, node, "contradicts turgor mode: none in line %d; write mode: prescribed there",
                           mode_node->line));
  }
  PetscFunctionReturn(0);
}

/* Water that cells keep. */
static PetscErrorCode BuildSeal(const LamDocument *document, const LamNode *mode_node, LamTurgorMode mode,
                                LamScene *scene)
{
  const LamNode *water_node;
  PetscReal water;

  PetscFunctionBeginUser;
  scene->sealed = (PetscBool)(mode_node && mode == LAM_TURGOR_SEALED);
  PetscCall(GetReal(document, "rve.turgor.water_bulk_modulus", &water_node, &water));
  if (water_node && !scene->sealed)
    PetscCall(
        LamSceneFailName(document, water_node, "says nothing where the cells are not sealed; write mode: sealed"));
  PetscCall(LamSceneScale(document, water_node, water, scene->scales.stress, &scene->water_bulk_modulus));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildTurgor(const LamDocument *document, LamScene *scene)
{
  const LamNode *mode_node, *pressure_node;
  LamValue mode, pressure;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "rve.turgor.mode", &mode_node, &mode));
  PetscCall(LamSceneGet(document->root, "rve.turgor.pressure", &pressure_node, &pressure));
  PetscCall(BuildSeal(document, mode_node, (LamTurgorMode)mode.number[0], scene));
  if (mode_node && (LamTurgorMode)mode.number[0] != LAM_TURGOR_NONE && !pressure_node) {
    PetscCall(LamSceneFailMissing(document, mode_node->parent, "pressure",
                                  "missing; write a stress with its unit, such as 0.02 MPa, or mode: none"));
  }
  PetscCall(LamSceneCheckTurgor(document, pressure_node, pressure.number[0]));
  PetscCall(LamSceneScale(document, pressure_node, pressure.number[0], scene->scales.stress, &scene->turgor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckClearance(const LamDocument *document, const LamNode *node, const LamScales *scales,
                                      const LamMicrostructure *micro)
{
  const PetscInt count = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal thickest = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < count; c++) thickest = PetscMax(thickest, LamWallThickness(micro, c));
  if (thickest < LamOuterApothem(micro)) PetscFunctionReturn(0);
  PetscCall(LamSceneFail(document, node,
                         "half of it, %g um, and a wall of %g um leave no lumen in an apothem of %g um; write less",
                         (double)(0.5e6 * micro->clearance * scales->length), (double)(1e6 * thickest * scales->length),
                         (double)(1e6 * scales->length)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildRVE(const LamDocument *document, LamScene *scene)
{
  const LamNode *clearance;
  PetscReal unused;

  PetscFunctionBeginUser;
  PetscCall(BuildCell(document, scene));
  PetscCall(BuildWall(document, scene));
  PetscCall(BuildInterface(document, scene));
  PetscCall(BuildTurgor(document, scene));
  PetscCall(LamSceneBuildCells(document, scene));
  PetscCall(GetReal(document, "rve.interface.clearance", &clearance, &unused));
  PetscCall(LamSceneCheckClearance(document, clearance, &scene->scales, &scene->micro));
  PetscCall(GetReal(document, "accuracy", NULL, &scene->accuracy));
  PetscFunctionReturn(0);
}
