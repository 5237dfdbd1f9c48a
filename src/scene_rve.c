/*
  The `rve` block of a scene, and the scales that make it nondimensional.
*/
#include "scene_keys.h"
#include <math.h>

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
  LamValue cells, along, through;

  PetscFunctionBeginUser;
  PetscCall(GetReal(document, "rve.cell.apothem", &node, &scene->scales.length));
  PetscCall(GetReal(document, "rve.cell.wall_thickness", &node, &thickness));
  if (thickness >= scene->scales.length) {
    PetscCall(LamSceneFail(document, node, "the wall fills the cell; write a thickness less than the apothem"));
  }
  PetscCall(LamSceneScale(document, node, thickness, scene->scales.length, &micro->wall_thickness));
  PetscCall(GetReal(document, "rve.cell.orientation", NULL, &micro->orientation));
  PetscCall(LamSceneGet(document->root, "rve.cells", NULL, &cells));
  for (PetscInt i = 0; i < 2; i++) micro->cells[i] = (PetscInt)cells.number[i];
  /* what is not given stays 0: the planner chooses */
  PetscCall(LamSceneGet(document->root, "rve.mesh.along", NULL, &along));
  PetscCall(LamSceneGet(document->root, "rve.mesh.through", NULL, &through));
  micro->along = (PetscInt)along.number[0];
  micro->through = (PetscInt)through.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildWall(const LamDocument *document, LamScene *scene)
{
  LamWall *wall = &scene->micro.wall;
  const LamNode *C1_node, *C2_node, *C4_node, *bulk_node, *map = NULL;
  PetscReal C1, C2, C4, bulk;
  PetscInt law, fibres;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "rve.wall", &map, &unused));
  PetscCall(GetName(document, "rve.wall.law", NULL, &law));
  PetscCall(GetName(document, "rve.wall.fibres", NULL, &fibres));
  PetscCall(GetReal(document, "rve.wall.C1", &C1_node, &C1));
  PetscCall(GetReal(document, "rve.wall.C2", &C2_node, &C2));
  PetscCall(GetReal(document, "rve.wall.C4", &C4_node, &C4));
  PetscCall(GetReal(document, "rve.wall.bulk_modulus", &bulk_node, &bulk));
  if (law == LAM_WALL_FIBRE_MOONEY_RIVLIN && !C4_node) {
    PetscCall(LamSceneFailMissing(document, map, "C4",
                                  "missing; write the fibre modulus, such as 1 MPa, or law: mooney_rivlin"));
  }
  if (law == LAM_WALL_MOONEY_RIVLIN && C4 > 0.0) {
    PetscCall(LamSceneFail(document, C4_node,
                           "law mooney_rivlin has no fibres; leave C4 out, or write law: "
                           "fibre_mooney_rivlin"));
  }
  if (!bulk_node) bulk = 1000.0 * (C1 + C2);
  if (bulk <= C1 + C2) {
    PetscCall(LamSceneFail(document, bulk_node,
                           "cell walls are nearly incompressible; write more than C1 + C2 = %g MPa",
                           (double)(C1 + C2) * 1e-6));
  }
  scene->scales.stress = C1 + C2;
  wall->law = (LamWallLawType)law;
  wall->fibres = (LamFibres)fibres;
  PetscCall(LamSceneScale(document, C1_node, C1, C1 + C2, &wall->C1));
  PetscCall(LamSceneScale(document, C2_node, C2, C1 + C2, &wall->C2));
  PetscCall(LamSceneScale(document, C4_node, C4, C1 + C2, &wall->C4));
  PetscCall(LamSceneScale(document, bulk_node ? bulk_node : C1_node, bulk, C1 + C2, &wall->bulk_modulus));
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

static PetscErrorCode BuildTurgor(const LamDocument *document, LamScene *scene)
{
  const LamNode *mode_node, *pressure_node;
  LamValue mode, pressure;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "rve.turgor.mode", &mode_node, &mode));
  PetscCall(LamSceneGet(document->root, "rve.turgor.pressure", &pressure_node, &pressure));
  if (mode_node && (LamTurgorMode)mode.number[0] == LAM_TURGOR_PRESCRIBED && !pressure_node) {
    PetscCall(LamSceneFailMissing(document, mode_node->parent, "pressure",
                                  "missing; write a stress with its unit, such as 0.02 MPa, or mode: none"));
  }
  PetscCall(LamSceneCheckTurgor(document, pressure_node, pressure.number[0]));
  PetscCall(LamSceneScale(document, pressure_node, pressure.number[0], scene->scales.stress, &scene->turgor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildRVE(const LamDocument *document, LamScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(BuildCell(document, scene));
  PetscCall(BuildWall(document, scene));
  PetscCall(BuildInterface(document, scene));
  PetscCall(BuildTurgor(document, scene));
  PetscCall(GetReal(document, "accuracy", NULL, &scene->accuracy));
  PetscFunctionReturn(0);
}
