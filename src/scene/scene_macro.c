/*
  The `macro` block of a scene.
*/
#include "scene_rows.h"
#include <string.h>

enum { DEFAULT_STEPS = 10, MAX_STEPS = 1000000 };

const char *const LamDiscPartNames[] = {LAM_DISC_PARTS(LAM_NAME_ENTRY)};
const char *const LamMacroSymmetryNames[] = {LAM_MACRO_SYMMETRIES(LAM_NAME_ENTRY)};

static const LamKey mesh_keys[] = {
    {MAP("macro"), .example = "{mesh: {...}, boundary: [...]}", .help = "The body for `lamella fe2`."},
    {NAME("macro.symmetry", LamMacroSymmetryNames), INTO(LamMacroSpec, symmetry), .default_value = "plane_strain",
     .help =
         "What the mesh is a section of: a body in `plane_strain`, or an `axisymmetric` one about X1 = 0, such as a "
         "cylinder or a fruit between plates. Then X1 is the radius and X2 the axis, F33 = r/R, the cells' axes lie "
         "along the hoop, and forces are those of the whole circle, in N instead of N/mm."},
    {MAP("macro.mesh"), REQUIRED, .example = "{box: [10 mm, 10 mm], elements: [8, 8]}", .help = "Its mesh."},
    {LENGTH("macro.mesh.box", "mm"), INTO(LamMacroSpec, box), .size = 2, ABOVE(0),
     .default_words = "none: one of `box`, `disc`, `gmsh`", .example = "[10 mm, 10 mm]",
     .help = "Edges of a rectangular block along X1 and X2; its corner is the origin. Its sides are `left`, `right`, "
             "`bottom`, `top`."},
    {LENGTH("macro.mesh.disc", "mm"), INTO(LamMacroSpec, box[0]), ABOVE(0),
     .default_words = "none: one of `box`, `disc`, `gmsh`", .example = "5 mm",
     .help = "Radius of a disc about the origin. Its sides are `rim` and, of a part, `bottom` (X2 = 0) and `left` "
             "(X1 = 0)."},
    {NAME("macro.mesh.part", LamDiscPartNames), INTO(LamMacroSpec, disc), .default_value = "whole",
     .help = "Of a disc: `whole`, `half` (X2 >= 0), `right` (X1 >= 0) or `quarter` (both)."},
    {INTEGER("macro.mesh.elements"), INTO(LamMacroSpec, elements), .size = 2, FROM(1), TO(1000),
     .default_words = "none: required with `box` and `disc`", .example = "[8, 8]",
     .help = "Quadratic elements: of a box along X1 and X2; of a disc along an eighth of the rim, and from the rim to "
             "the square in its middle, half as wide."},
    {REAL("macro.mesh.grading"), INTO(LamMacroSpec, grading), .size = 2, ABOVE(0), .default_words = "equal elements",
     .example = "[10, 0.1]",
     .help =
         "Of a box, along X1 and X2: the edge of the last element over that of the first. The edges between them are "
         "a geometric series: small elements where a probe or a plate presses."},
    {PATH("macro.mesh.gmsh"), INTO(LamMacroSpec, gmsh), .default_words = "none: one of `box`, `disc`, `gmsh`",
     .example = "fruit.msh",
     .help =
         "A Gmsh file of format 2.2, 4.0 or 4.1, its path relative to the scene's folder: triangles of 3 and 6 nodes "
         "and quadrilaterals of 4, 8 and 9 in the plane X3 = 0, in any mixture. Physical curves and points are "
         "boundaries, physical surfaces are regions, by their names. Parts of the body that share no node do not "
         "hang together; each of them must be held."},
    {LENGTH("macro.mesh.unit", "mm"), ABOVE(0), .default_value = "1 mm", .example = "1 cm",
     .help = "Unit of length of the Gmsh file."},
};
LAM_KEY_TABLE(LamMeshKeys, mesh_keys);

static const LamKey program_keys[] = {
    {MAP("macro.control"), .default_words = "tractions follow their histories",
     .example = "{on: top, displacement: [free, -1 mm]}",
     .help = "Prescribes the mean displacement of a side instead of the tractions, whose common factor is found: past "
             "the largest load, too."},
    {TEXT("macro.control.on"), INTO(LamLoadControl, on), REQUIRED, .example = "top", .help = "The side."},
    {LENGTH("macro.control.displacement", "mm"), .size = 2, REQUIRED, FREE, .example = "[free, -1 mm]",
     .help = "Its mean displacement at load parameter 1: one component, the other one `free`."},
    {BOOL("macro.inflate"), INTO(LamMacroSpec, inflate), .default_words = "true with turgor, else false",
     .help = "First bring turgor up with only rigid motions held; displacements then count from there. With law "
             "`contact` it needs a cohesion: nothing else holds free tissue together."},
    {NAME_OF("macro.reference", LamAreaNames, LAM_AREA_COUNT), INTO(LamMacroSpec, area), .default_value = "rest",
     .help =
         "With `inflate`: whether stress that is read off the curve of a box is per area at rest or of the inflated "
         "body. Tractions are per area at rest."},
    {INTEGER("macro.steps"), INTO(LamMacroSpec, steps), FROM(1), TO(10000),
     .default_words = "10; with `program`: that of its parts", .example = "10",
     .help = "Equal steps of the load parameter from 0 to 1, after inflation."},
    {LIST("macro.program"), .default_words = "one ramp from 0 to 1",
     .example = "[{to: 1, steps: 10}, {to: 0, steps: 10}]",
     .help = "Ramps of the load parameter, which begins at 0, instead of `steps`."},
    {MAP("macro.program[]"), .example = "{to: 1, steps: 10}", .help = "One ramp."},
    {REAL("macro.program[].to"), INTO(LamLeg, to), REQUIRED, FROM(-1000), TO(1000), .example = "1",
     .help = "Load parameter at its end."},
    {INTEGER("macro.program[].steps"), INTO(LamLeg, steps), REQUIRED, FROM(1), TO(10000), .example = "10",
     .help = "Its equal steps."},
    {INTEGER("macro.repeat"), FROM(1), TO(1000), .default_value = "1", .example = "3",
     .help = "How often `program` is gone through."},
    {LIST("macro.zoom"), .default_words = "where the tissue is nearest to failure, and the middle",
     .example = "[[5 mm, 5 mm], [9 mm, 9 mm]]",
     .help = "Places, at most three, at whose nearest material points the microstructure is kept for pictures."},
    {LENGTH("macro.zoom[]", "mm"), .size = 2, .example = "[5 mm, 5 mm]", .help = "Position in the undeformed body."},
};
LAM_KEY_TABLE(LamProgramKeys, program_keys);

/* ---- mesh ---- */

/* Exactly one of box, disc and gmsh defines the mesh and the unit of length. */
static PetscErrorCode BuildMesh(const LamNode *mesh, LamScene *scene)
{
  static const char *const sources[] = {"box", "disc", "gmsh"};
  const LamNode *elements = LamNodeFind(mesh, "elements"), *part = LamNodeFind(mesh, "part"),
                *grading = LamNodeFind(mesh, "grading");
  const LamNode *source = NULL, *unit;
  LamMacroSpec *spec = &scene->macro;
  PetscInt count = 0;
  LamValue length;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(mesh, "macro.mesh.unit", &unit, &length));
  for (int k = 0; k < 3; k++) {
    const LamNode *given = LamNodeFind(mesh, sources[k]);

    if (!given) continue;
    spec->source = (LamMeshSource)k;
    source = given;
    count++;
  }
  LamSceneRequire(count, mesh, "box", "missing; write box: [10 mm, 10 mm], or disc: 5 mm, or gmsh: file.msh");
  LamSceneCheck(count == 1, source, "the mesh is one of box, disc and gmsh; leave the others out");
  LamSceneCheck(!part || spec->source == LAM_MESH_DISC, part,
                "belongs to a disc, which this mesh is not; leave it out");
  LamSceneCheck(!grading || spec->source == LAM_MESH_BOX, grading,
                "belongs to a box, which this mesh is not; leave it out");
  LamSceneCheck(!unit || spec->source == LAM_MESH_GMSH, unit,
                "belongs to a Gmsh file, which this mesh is not; leave it out");
  if (spec->source == LAM_MESH_GMSH) {
    LamSceneCheck(!elements, elements, "a Gmsh file has its own elements; leave it out");
    source = unit;
  } else {
    LamSceneRequire(elements, mesh, "elements", "missing; write two numbers, such as [8, 8]");
    length = source->value;
  }
  spec->mesh_place = LamNodePlace(LamNodeFind(mesh, sources[spec->source]));
  scene->scales.macro_length = length.number[0];
  PetscCall(LamSceneCheckScale(source, length.number[0]));
  PetscFunctionReturn(0);
}

/* ---- load program ---- */

static PetscErrorCode BuildProgram(const LamNode *block, LamMacroSpec *spec)
{
  const LamNode *list = LamNodeFind(block, "program"), *steps = LamNodeFind(block, "steps"), *repeat;
  PetscReal from = 0, total = 0;
  LamValue times;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(block, "macro.repeat", &repeat, &times));
  LamSceneCheckName(!list || !steps, steps,
                    "stands beside program, whose parts have their own steps; leave one of them out");
  LamSceneCheckName(list || !repeat, repeat,
                    "repeats a program, but there is none; write one, such as program: [{to: 1, steps: 10}, {to: 0, "
                    "steps: 10}]");
  if (!list) PetscFunctionReturn(0);
  LamSceneCheckName(list->count <= LAM_MAX_LEGS, list, "has %d ramps; at most %d are allowed", (int)list->count,
                    LAM_MAX_LEGS);
  for (const LamNode *item = list->first; item; item = item->next) {
    LamLeg *leg = &spec->legs[spec->leg_count++];

    PetscCall(LamSceneFill(item, NULL, LamLeg, leg));
    LamSceneCheck(leg->to != from, LamNodeFind(item, "to"),
                  "is where the parameter is already; write another one, or leave the ramp out");
    from = leg->to;
    total += times.number[0] * leg->steps;
  }
  LamSceneCheckName(total <= MAX_STEPS, repeat ? repeat : list, "gives %g steps; at most %d are allowed", (double)total,
                    (int)MAX_STEPS);
  spec->steps = (PetscInt)total;
  PetscFunctionReturn(0);
}

/* ---- control of a displacement ---- */

/* Displacement control determines the factor of the tractions. */
static PetscErrorCode CheckTractions(const LamNode *block, const LamMacroSpec *spec)
{
  const LamLoadControl *control = &spec->control;
  PetscInt tractions = 0;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscBool loads = (PetscBool)(boundary->traction[0] != 0 || boundary->traction[1] != 0);

    if (loads) tractions++;
    LamSceneCheckName(!loads || !boundary->history.count, block,
                      "finds the factor of the tractions, but that on %s has a history; leave one of them out",
                      boundary->on);
    LamSceneCheck(boundary->kind != LAM_BOUNDARY_DISPLACEMENT || !boundary->given[control->component] ||
                      strcmp(boundary->on, control->on),
                  LamNodeFind(block, "on"), "its displacement along X%d is prescribed in macro.boundary; leave it free",
                  (int)control->component + 1);
  }
  LamSceneCheckName(tractions, block,
                    "finds the factor of the tractions, but there is none in macro.boundary; give a traction or "
                    "pressure, or leave control out");
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildControl(const LamNode *block, LamScene *scene)
{
  const LamNode *displacement = LamNodeFind(block, "displacement");
  LamLoadControl *control = &scene->macro.control;
  const PetscBool *is_free;
  PetscInt side;

  PetscFunctionBeginUser;
  if (!block) PetscFunctionReturn(0);
  PetscCall(LamSceneCheckSide(LamNodeFind(block, "on"), &scene->macro, &side));
  PetscCall(LamSceneFill(block, &scene->scales, LamLoadControl, control));
  control->place = LamNodePlace(LamNodeFind(block, "on"));
  is_free = displacement->value.is_free;
  LamSceneCheck(is_free[0] != is_free[1], displacement,
                "gives %s; give one and write free for the other, such as [free, -1 mm]",
                is_free[0] ? "no component" : "both components");
  control->component = is_free[0] ? 1 : 0;
  PetscCall(LamSceneScale(displacement, displacement->value.number[control->component], scene->scales.macro_length,
                          &control->displacement));
  PetscCall(CheckTractions(block, &scene->macro));
  PetscFunctionReturn(0);
}

/* ---- the block ---- */

/* The half plane of an axisymmetric body is X1 >= 0. */
static PetscErrorCode CheckSymmetry(const LamNode *mesh, const LamMacroSpec *spec)
{
  const LamNode *part = LamNodeFind(mesh, "part");

  PetscFunctionBeginUser;
  if (spec->symmetry != LAM_AXISYMMETRIC || spec->source != LAM_MESH_DISC) PetscFunctionReturn(0);
  LamSceneCheck(spec->disc == LAM_DISC_RIGHT || spec->disc == LAM_DISC_QUARTER, part ? part : LamNodeFind(mesh, "disc"),
                "reaches beyond the axis X1 = 0 of an axisymmetric body; write part: right or part: quarter");
  PetscFunctionReturn(0);
}

/*
  A body that inflates freely has zero total stress, and hence zero mean traction on every face, at any turgor:
  contact alone then holds no cell.
*/
static PetscErrorCode CheckInflation(const LamNode *block, const LamScene *scene)
{
  static const char *const remedy =
      "free tissue is held together only by the lamella; give interface.cohesion > 0, or inflate: false";
  const LamNode *inflate = LamNodeFind(block, "inflate");

  PetscFunctionBeginUser;
  if (!scene->macro.inflate || scene->micro.interface != LAM_INTERFACE_CONTACT || scene->cohesion > 0.0)
    PetscFunctionReturn(0);
  LamSceneCheck(!inflate, inflate, "law: contact has no cohesion; %s", remedy);
  PetscCall(LamSceneRaise(block, LAM_MISTAKE_MISSING, "inflate",
                          "missing, so true with turgor, but law: contact has no cohesion; %s", remedy));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildMacro(const LamNode *root, LamScene *scene)
{
  const LamNode *block = LamNodeFind(root, "macro"), *zoom = LamNodeFind(block, "zoom");
  LamMacroSpec *spec = &scene->macro;

  PetscFunctionBeginUser;
  if (!block) PetscFunctionReturn(0);
  LamSceneCheckName(!LamWallsRelax(&scene->micro) || LamNodeFind(root, "process"), block,
                    "is loaded without time, on which walls with memory, rve.wall.relaxation, depend; write a block "
                    "process, or leave one of them out");
  scene->has_macro = PETSC_TRUE;
  PetscCall(BuildMesh(LamNodeFind(block, "mesh"), scene));
  spec->inflate = (PetscBool)(scene->turgor != 0.0);
  spec->steps = DEFAULT_STEPS;
  PetscCall(LamSceneFill(block, &scene->scales, LamMacroSpec, spec));
  PetscCall(CheckSymmetry(LamNodeFind(block, "mesh"), spec));
  PetscCall(CheckInflation(block, scene));
  LamSceneCheck(spec->area != LAM_AREA_INFLATED || spec->inflate, LamNodeFind(block, "reference"),
                "needs the inflated body; write a turgor, and no inflate: false");
  PetscCall(LamSceneBuildBoundaries(root, scene));
  PetscCall(BuildProgram(block, spec));
  PetscCall(BuildControl(LamNodeFind(block, "control"), scene));
  LamSceneCheck(!zoom || zoom->count <= LAM_MAX_ZOOMS, zoom, "has more than %d places; leave some out", LAM_MAX_ZOOMS);
  for (const LamNode *item = zoom ? zoom->first : NULL; item; item = item->next, spec->zoom_count++)
    for (int i = 0; i < 2; i++)
      PetscCall(
          LamSceneScale(item, item->value.number[i], scene->scales.macro_length, &spec->zoom[spec->zoom_count][i]));
  PetscFunctionReturn(0);
}

/* ---- the program in the solver: load parameter of a step, histories as functions of it ---- */

PetscReal LamHistoryFactor(const LamHistory *history, PetscReal parameter)
{
  PetscInt k = 0;

  if (!history->count) return parameter;
  while (k < history->count && history->parameter[k] < parameter) k++;
  if (k == 0) return history->factor[0];
  if (k == history->count) return history->factor[k - 1];
  const PetscReal from = history->parameter[k - 1], share = (parameter - from) / (history->parameter[k] - from);
  return (1 - share) * history->factor[k - 1] + share * history->factor[k];
}

PetscBool LamHistoriesAgree(const LamHistory *one, const LamHistory *other)
{
  const LamHistory *both[] = {one, other};

  if (!one->count != !other->count) return PETSC_FALSE;
  for (int h = 0; h < 2; h++) {
    for (PetscInt k = 0; k < both[h]->count; k++) {
      const PetscReal at = both[h]->parameter[k];
      if (LamHistoryFactor(one, at) != LamHistoryFactor(other, at)) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

PetscReal LamMacroParameter(const LamMacroSpec *spec, PetscInt step)
{
  PetscReal from = 0;

  if (!spec->leg_count) return (PetscReal)step / spec->steps;
  for (PetscInt leg = 0;; leg = (leg + 1) % spec->leg_count) {
    const LamLeg *now = &spec->legs[leg];
    if (step <= now->steps) return step == now->steps ? now->to : from + step * (now->to - from) / now->steps;
    step -= now->steps;
    from = now->to;
  }
}
