/*
  The `rve` block of a scene, and the scales that make it nondimensional.
*/
#include "scene_rows.h"
#include <math.h>

static const char *const turgor_mode_names[] = {LAM_TURGOR_MODES(LAM_NAME_ENTRY)};

static const LamKey cell_keys[] = {
    {MAP("rve"), REQUIRED, .example = "{cell: {...}, wall: {...}}",
     .help = "The representative volume element: whole hexagonal cells that repeat periodically, or a patch of them."},
    {MAP("rve.cell"), REQUIRED, .example = "{apothem: 75 um, wall_thickness: 11.25 um}", .help = "One cell."},
    {LENGTH("rve.cell.apothem", "um"), REQUIRED, ABOVE(0), .example = "75 um",
     .help = "Distance a from the centre of the hexagon to the middle lamella."},
    {LENGTH("rve.cell.wall_thickness", "um"), REQUIRED, ABOVE(0), .example = "11.25 um",
     .help = "Thickness t of one cell's wall, less than the apothem; two lumens are 2t apart."},
    {ANGLE("rve.cell.orientation"), FROM(-360), TO(360), .default_value = "0 deg", .example = "30 deg",
     .help = "Angle of face normal 0 to the X1 axis; the other normals follow at 60 deg."},
    {INTEGER("rve.cells"), .size = 2, FROM(1), TO(64), .default_value = "[1, 1]", .example = "[2, 2]",
     .help = "Cells in one period along lattice vectors 0 and 1."},
    {MAP("rve.patch"), .example = "{columns: 6, rows: 6, sides: affine}",
     .help =
         "A block of cells between grips instead of `rve.cells`: the outer walls of its bottom and top rows follow F. "
         "It is a body, no material point: solved by `rve` and `map`, without `sample` and `macro`."},
    {INTEGER("rve.patch.columns"), REQUIRED, FROM(1), TO(64), .example = "6", .help = "Cells in a row, along X1."},
    {INTEGER("rve.patch.rows"), REQUIRED, FROM(1), TO(64), .example = "6", .help = "Rows of cells, along X2."},
    {NAME_OF("rve.patch.sides", LamPatchSidesNames, LAM_PATCH_SIDES_COUNT), .default_value = "affine",
     .example = "free",
     .help =
         "Whether the lateral outer walls follow F, too (`affine`), or are left `free`. Free sides need law `bonded` "
         "or a cohesion: nothing else holds the outer cells between the grips."},
};
LAM_KEY_TABLE(LamCellKeys, cell_keys);

static const LamKey tissue_keys[] = {
    {MAP("rve.interface"), .example = "{law: bonded}", .help = "The middle lamella between the cells."},
    {NAME_OF("rve.interface.law", LamInterfaceLawNames, LAM_INTERFACE_LAW_COUNT), .default_value = "bonded",
     .example = "contact", .help = "`bonded`: cells never part; `contact`: they may part and slide without friction."},
    {STRESS("rve.interface.cohesion"), FROM(0), .default_value = "0 MPa", .example = "0.001 MPa",
     .help = "Normal traction that parts the cells; only with law `contact`."},
    {LENGTH("rve.interface.clearance", "um"), FROM(0), .default_value = "0 um", .example = "0.1 um",
     .help =
         "Distance between facing walls at rest: each cell is smaller than its place by half of it all around; only "
         "with law `contact`."},
    {MAP("rve.turgor"), .example = "{mode: prescribed, pressure: 0.02 MPa}", .help = "Pressure in the lumens."},
    {NAME("rve.turgor.mode", turgor_mode_names), .default_words = "`prescribed` where a pressure is given, else `none`",
     .example = "prescribed",
     .help =
         "`prescribed`: the pressure is given; `sealed`: each cell keeps the water that it has at F = I under that "
         "pressure (in `fe2` with `macro.inflate`: in the inflated body), and its pressure follows. `build` tabulates "
         "prescribed turgor alone."},
    {STRESS("rve.turgor.pressure"), .default_words = "none: required by modes `prescribed` and `sealed`",
     .example = "0.02 MPa", .help = "Turgor of the tissue; negative is suction."},
    {STRESS("rve.turgor.water_bulk_modulus"), ABOVE(0), .default_value = "2200 MPa", .example = "2.2 GPa",
     .help = "How water in sealed cells resists compression; only with mode `sealed`."},
    {MAP("rve.mesh"), .default_words = CHOSEN, .example = "{along: 6, through: 2}",
     .help = "Finite elements of one cell."},
    {INTEGER("rve.mesh.along"), FROM(1), TO(200), .default_words = CHOSEN, .example = "6",
     .help = "Elements along one face."},
    {INTEGER("rve.mesh.through"), FROM(1), TO(50), .default_words = CHOSEN, .example = "2",
     .help = "Elements through one wall."},
    {REAL("rve.mesh.grading"), FROM(0), BELOW(1),
     .default_words = "chosen for the accuracy where `along` is; else 0: elements are alike", .example = "0.6",
     .help = "How much smaller elements at the ends of a face, where stresses are singular, are than in its middle: "
             "about 1 - grading to 1 + grading."},
    {TEXT("rve.mesh.measured"), .default_words = "the program's own figures", .example = "tradeoff/model.json",
     .help =
         "File of errors that `lamella tradeoff` has measured for this tissue: what is left open of the mesh is the "
         "cheapest of those that meets the accuracy."},
    {REAL("rve.tolerance"), ABOVE(0), TO(0.1), .default_words = "rounding", .example = "1e-6",
     .help =
         "Where Newton iterations of the RVE end: residual (forces over (C1 + C2) apothem) and violation of contact. "
         "Not below rounding."},
    {NAME_OF("rve.strategy", LamStrategyNames, LAM_STRATEGY_COUNT), .default_value = "two_step", .example = "two_step",
     .help = "How contact is reached: from the bonded state (`two_step`) or at once (`one_step`). No effect on bonded "
             "tissue."},
};
LAM_KEY_TABLE(LamTissueKeys, tissue_keys);

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
