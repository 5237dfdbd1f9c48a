/*
  The `rve` block of a scene, and the scales that make it nondimensional.
*/
#include "scene_rows.h"
#include <math.h>

static const char *const turgor_mode_names[] = {LAM_TURGOR_MODES(LAM_NAME_ENTRY)};

#define WITHOUT_TISSUE "none: required without `rve.tissue`"

static const LamKey cell_keys[] = {
    {MAP("rve"), REQUIRED, .example = "{cell: {...}, wall: {...}}",
     .help = "The representative volume element: whole cells that repeat periodically, hexagons or those of a file, or "
             "a patch of them."},
    {PATH("rve.tissue"), INTO(LamScene, tissue), .default_words = "none: hexagons", .example = "apple.json",
     .help = "File of cells of any shape (docs/reference/tissue.md), written by `lamella tissue`, `python3 -m "
             "lamella.cells` or by hand: instead of `rve.cells`, `rve.cell.apothem` and, where the file has it, "
             "`rve.cell.wall_thickness`. The apothem a, the unit of lengths, is that of a hexagon with the mean area of "
             "its cells."},
    {MAP("rve.cell"), .default_words = WITHOUT_TISSUE, .example = "{apothem: 75 um, wall_thickness: 11.25 um}", .help = "One cell."},
    {LENGTH("rve.cell.apothem", "um"), ABOVE(0), .default_words = WITHOUT_TISSUE, .example = "75 um",
     .help = "Distance a from the centre of the hexagon to the middle lamella."},
    {LENGTH("rve.cell.wall_thickness", "um"), INTO(LamScene, micro.wall_thickness), ABOVE(0),
     .default_words = WITHOUT_TISSUE, .example = "11.25 um", .help = "Thickness t of one cell's wall, less than the apothem; two lumens are 2t apart."},
    {LENGTH("rve.cell.length", "um"), INTO(LamScene, micro.length), ABOVE(0),
     .default_words = "prisms without end walls", .example = "150 um",
     .help = "Length of cells across the section: walls of the same thickness close them there, and are sheared with it. With law bonded."},
    {ANGLE("rve.cell.orientation"), INTO(LamScene, micro.orientation), FROM(-360), TO(360), .default_value = "0 deg",
     .example = "30 deg", .help = "Angle of face normal 0 to the X1 axis; the other normals follow at 60 deg."},
    {INTEGER("rve.cells"), INTO(LamScene, micro.cells), .size = 2, FROM(1), TO(LAM_MAX_CELLS),
     .default_value = "[1, 1]", .example = "[2, 2]", .help = "Cells in one period along lattice vectors 0 and 1."},
    {MAP("rve.patch"), .example = "{columns: 6, rows: 6, sides: affine}",
     .help = "A block of cells between grips instead of `rve.cells`: the outer walls of its bottom and top rows "
             "follow F. It is a body, no material point: solved by `rve` and `map`, without `sample` and `macro`."},
    {INTEGER("rve.patch.columns"), INTO(LamScene, micro.cells[0]), FROM(1), TO(LAM_MAX_CELLS),
     .default_words = WITHOUT_TISSUE, .example = "6",
     .help = "Cells in a row, along X1."},
    {INTEGER("rve.patch.rows"), INTO(LamScene, micro.cells[1]), FROM(1), TO(LAM_MAX_CELLS),
     .default_words = WITHOUT_TISSUE, .example = "6",
     .help = "Rows of cells, along X2."},
    {NAME_OF("rve.patch.sides", LamPatchSidesNames, LAM_PATCH_SIDES_COUNT), INTO(LamScene, micro.sides),
     .default_value = "affine",
     .help = "Whether the lateral outer walls follow F, too (`affine`), or are left `free`. Free sides need law "
             "`bonded` or a cohesion: nothing else holds the outer cells between the grips."},
    {MAP("rve.patch.notch"), .default_words = "none", .example = "{row: 3, columns: 2}",
     .help = "A cut from the left side between two rows, where nothing holds; only with law `lamella`."},
    {INTEGER("rve.patch.notch.row"), INTO(LamScene, micro.notch_row), REQUIRED, FROM(1), TO(LAM_MAX_CELLS),
     .example = "3", .help = "Rows below it; less than `rows`."},
    {INTEGER("rve.patch.notch.columns"), INTO(LamScene, micro.notch_columns), REQUIRED, FROM(1), TO(LAM_MAX_CELLS),
     .example = "2", .help = "Cells above it; less than `columns`."},
};
LAM_KEY_TABLE(LamCellKeys, cell_keys);

static const LamKey tissue_keys[] = {
    {MAP("rve.turgor"), .example = "{mode: prescribed, pressure: 0.02 MPa}", .help = "Pressure in the lumens."},
    {NAME("rve.turgor.mode", turgor_mode_names), .default_words = "`prescribed` where a pressure is given, else `none`",
     .help = "`prescribed`: the pressure is given; `sealed`: each cell keeps the water that it has at F = I under "
             "that pressure (in `fe2` with `macro.inflate`: in the inflated body), and its pressure follows. `build` "
             "tabulates prescribed turgor alone."},
    {STRESS("rve.turgor.pressure"), INTO(LamScene, turgor),
     .default_words = "none: required by modes `prescribed` and `sealed`", .example = "0.02 MPa",
     .help = "Turgor of the tissue; negative is suction."},
    {STRESS("rve.turgor.water_bulk_modulus"), INTO(LamScene, water_bulk_modulus), ABOVE(0), .default_value = "2200 MPa",
     .example = "2.2 GPa", .help = "How water in sealed cells resists compression; only with mode `sealed`."},
    {MAP("rve.mesh"), .default_words = CHOSEN, .example = "{along: 6, through: 2}",
     .help = "Finite elements of one cell."},
    {INTEGER("rve.mesh.along"), INTO(LamScene, micro.along), FROM(1), TO(200), .default_words = CHOSEN, .example = "6",
     .help = "Elements along one face."},
    {INTEGER("rve.mesh.through"), INTO(LamScene, micro.through), FROM(1), TO(50), .default_words = CHOSEN,
     .example = "2", .help = "Elements through one wall."},
    {REAL("rve.mesh.grading"), INTO(LamScene, micro.grading), FROM(0), BELOW(1),
     .default_words = "chosen for the accuracy where `along` is; else 0: elements are alike", .example = "0.6",
     .help = "How much smaller elements at the ends of a face, where stresses are singular, are than in its middle: "
             "about 1 - grading to 1 + grading."},
    {PATH("rve.mesh.measured"), INTO(LamScene, measured), .default_words = "the program's own figures",
     .example = "tradeoff/model.json",
     .help = "File of errors that `lamella tradeoff` has measured for this tissue: what is left open of the mesh is "
             "the cheapest of those that meets the accuracy."},
    {REAL("rve.tolerance"), INTO(LamScene, tolerance), ABOVE(0), TO(0.1), .default_words = "rounding",
     .example = "1e-6",
     .help = "Where Newton iterations of the RVE end: residual (forces over (C1 + C2) apothem) and violation of "
             "contact. Not below rounding."},
    {NAME_OF("rve.strategy", LamStrategyNames, LAM_STRATEGY_COUNT), INTO(LamScene, strategy),
     .default_value = "one_step",
     .help = "How contact without a state before is reached: at once (`one_step`) or from the bonded state "
             "(`two_step`). No effect on bonded tissue."},
};
LAM_KEY_TABLE(LamTissueKeys, tissue_keys);

PetscErrorCode LamSceneCheckTurgor(const LamNode *node, PetscReal turgor)
{
  const LamNode *mode = LamNodeFind(node->document->root, "rve.turgor.mode");

  PetscFunctionBeginUser;
  LamSceneCheck(!mode || mode->value.number[0] != LAM_TURGOR_NONE || turgor == 0.0, node,
                "contradicts turgor mode: none in line %d; write mode: prescribed there", mode->line);
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildTurgor(const LamNode *root, LamScene *scene)
{
  const LamNode *mode = LamNodeFind(root, "rve.turgor.mode");
  const LamNode *pressure = LamNodeFind(root, "rve.turgor.pressure");
  const LamNode *water = LamNodeFind(root, "rve.turgor.water_bulk_modulus");

  PetscFunctionBeginUser;
  scene->sealed = (PetscBool)(mode && mode->value.number[0] == LAM_TURGOR_SEALED);
  LamSceneCheckName(!water || scene->sealed, water, "says nothing where the cells are not sealed; write mode: sealed");
  LamSceneRequire(pressure || !mode || mode->value.number[0] == LAM_TURGOR_NONE, mode->parent, "pressure",
                  "missing; write a stress with its unit, such as 0.02 MPa, or mode: none");
  if (pressure) PetscCall(LamSceneCheckTurgor(pressure, pressure->value.number[0]));
  if (pressure) scene->turgor_place = LamNodePlace(pressure);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckNotch(const LamNode *notch, const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  if (!notch) PetscFunctionReturn(0);
  LamSceneCheckName(micro->interface == LAM_INTERFACE_LAMELLA, notch,
                    "cells that a lamella does not join cannot be cut apart; write rve.interface.law: lamella");
  LamSceneCheck(micro->notch_row < micro->cells[1], LamNodeFind(notch, "row"),
                "leaves no row above; the patch has %d rows", (int)micro->cells[1]);
  LamSceneCheck(micro->notch_columns < micro->cells[0], LamNodeFind(notch, "columns"),
                "cuts the patch in two; it has %d columns", (int)micro->cells[0]);
  PetscFunctionReturn(0);
}

/* Hexagons: the scale of lengths, which a tissue file gives otherwise. */
static PetscErrorCode ReadHexagon(const LamNode *rve, LamScales *scales)
{
  const LamNode *apothem, *thickness, *patch = LamNodeFind(rve, "patch");

  PetscFunctionBeginUser;
  PetscCall(LamSceneNeed(rve, "rve.cell"));
  PetscCall(LamSceneNeed(LamNodeFind(rve, "cell"), "rve.cell.apothem"));
  PetscCall(LamSceneNeed(LamNodeFind(rve, "cell"), "rve.cell.wall_thickness"));
  if (patch) PetscCall(LamSceneNeed(patch, "rve.patch.columns"));
  if (patch) PetscCall(LamSceneNeed(patch, "rve.patch.rows"));
  apothem = LamNodeFind(rve, "cell.apothem");
  thickness = LamNodeFind(rve, "cell.wall_thickness");
  scales->length = apothem->value.number[0];
  PetscCall(LamSceneCheckScale(apothem, scales->length));
  LamSceneCheck(thickness->value.number[0] < scales->length, thickness,
                "the wall fills the cell; write a thickness less than the apothem (%s)", apothem->text);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneCheckLength(const LamNode *node, const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  if (!(micro->length > 0)) PetscFunctionReturn(0);
  LamSceneCheck(micro->interface == LAM_INTERFACE_BONDED, node,
                "end walls follow the strain of the tissue, and cells that part do not (interface.law: %s); leave it "
                "out, or write law: bonded",
                LamInterfaceLawNames[micro->interface]);
  LamSceneCheck(!micro->is_patch, node, "this version of Lamella has end walls of periodic tissue alone, not of a "
                                        "patch; leave it out");
  LamSceneCheck(!LamWallsRelax(micro), node, "this version of Lamella has no end walls with memory "
                                             "(rve.wall.relaxation); leave one of them out");
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildRVE(const LamNode *root, const LamSceneTissue *tissue, LamScene *scene)
{
  const LamNode *rve = LamNodeFind(root, "rve"), *cells = LamNodeFind(rve, "cells");
  const LamNode *patch = LamNodeFind(rve, "patch");
  const LamNode *C1 = LamNodeFind(rve, "wall.C1"), *C2 = LamNodeFind(rve, "wall.C2");
  LamMicrostructure *micro = &scene->micro;
  LamScales *scales = &scene->scales;

  PetscFunctionBeginUser;
  scales->stress = C1->value.number[0] + C2->value.number[0];
  PetscCall(LamSceneCheckScale(C1, scales->stress));
  PetscCall(LamSceneReadWall(LamNodeFind(root, "rve.wall"), scales, NULL, &micro->wall));
  PetscCall(LamSceneBuildRelaxation(root, &micro->relaxation));
  micro->grading = LamNodeFind(rve, "mesh.along") ? 0.0 : -1.0; /* negative: the planner chooses */
  PetscCall(LamSceneFill(root, scales, LamScene, scene));
  LamSceneCheckName(!patch || !cells, cells,
                    "given together with patch in line %d; a block of cells is periodic or between grips",
                    patch->name_line);
  if (!scene->tissue[0]) micro->is_patch = (PetscBool)(patch != NULL);
  PetscCall(CheckNotch(LamNodeFind(rve, "patch.notch"), micro));
  PetscCall(BuildTurgor(root, scene));
  PetscCall(LamSceneBuildTissue(LamNodeFind(root, "rve.tissue"), tissue, scales, micro));
  PetscCall(LamSceneBuildCells(root, tissue, scene));
  PetscCall(LamSceneBuildInterface(root, scene));
  PetscCall(LamSceneCheckLength(LamNodeFind(rve, "cell.length"), micro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildRVE(const LamNode *root, LamScene *scene)
{
  LamSceneTissue tissue = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  if (LamNodeFind(root, "rve.tissue"))
    ierr = LamSceneReadTissue(root, scene, &tissue);
  else
    ierr = ReadHexagon(LamNodeFind(root, "rve"), &scene->scales);
  if (!ierr) ierr = BuildRVE(root, &tissue, scene);
  PetscCall(LamSceneDestroyTissue(&tissue));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
