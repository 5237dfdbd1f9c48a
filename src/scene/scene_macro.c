/*
  The `macro` block of a scene.
*/
#include "scene_rows.h"
#include <stdio.h>
#include <string.h>

enum { MAX_STEPS = 1000000 };

const char *const LamDiscPartNames[] = {LAM_DISC_PARTS(LAM_NAME_ENTRY)};

static const LamKey mesh_keys[] = {
    {MAP("macro"), .example = "{mesh: {...}, boundary: [...]}", .help = "The body for `lamella fe2`, in plane strain."},
    {MAP("macro.mesh"), REQUIRED, .example = "{box: [10 mm, 10 mm], elements: [8, 8]}", .help = "Its mesh."},
    {LENGTH("macro.mesh.box", "mm"), .size = 2, ABOVE(0), .default_words = "none: one of `box`, `disc`, `gmsh`",
     .example = "[10 mm, 10 mm]",
     .help = "Edges of a rectangular block along X1 and X2; its corner is the origin. Its sides are `left`, `right`, "
             "`bottom`, `top`."},
    {LENGTH("macro.mesh.disc", "mm"), ABOVE(0), .default_words = "none: one of `box`, `disc`, `gmsh`",
     .example = "5 mm",
     .help = "Radius of a disc about the origin. Its sides are `rim` and, of a part, `bottom` (X2 = 0) and `left` "
             "(X1 = 0)."},
    {NAME("macro.mesh.part", LamDiscPartNames), .default_value = "whole", .example = "quarter",
     .help = "Of a disc: `whole`, `half` (X2 >= 0) or `quarter` (X1 >= 0, too)."},
    {INTEGER("macro.mesh.elements"), .size = 2, FROM(1), TO(1000),
     .default_words = "none: required with `box` and `disc`", .example = "[8, 8]",
     .help = "Quadratic elements: of a box along X1 and X2; of a disc along an eighth of the rim, and from the rim to "
             "the square in its middle, half as wide."},
    {TEXT("macro.mesh.gmsh"), .default_words = "none: one of `box`, `disc`, `gmsh`", .example = "fruit.msh",
     .help =
         "A Gmsh file, its path relative to the scene's folder: triangles and quadrilaterals in the plane, straight "
         "or quadratic. Physical curves and points are boundaries, physical surfaces are regions, by their names."},
    {LENGTH("macro.mesh.unit", "mm"), ABOVE(0), .default_value = "1 mm", .example = "1 cm",
     .help = "Unit of length of the Gmsh file."},
};
LAM_KEY_TABLE(LamMeshKeys, mesh_keys);

static const LamKey program_keys[] = {
    {MAP("macro.control"), .default_words = "tractions follow their histories",
     .example = "{on: top, displacement: [free, -1 mm]}",
     .help = "Prescribes the mean displacement of a side instead of the tractions, whose common factor is found: past "
             "the largest load, too."},
    {TEXT("macro.control.on"), REQUIRED, .example = "top", .help = "The side."},
    {LENGTH("macro.control.displacement", "mm"), .size = 2, REQUIRED, FREE, .example = "[free, -1 mm]",
     .help = "Its mean displacement at load parameter 1: one component, the other one `free`."},
    {BOOL("macro.inflate"), .default_words = "true with turgor, else false", .example = "true",
     .help = "First bring turgor up with only rigid motions held; displacements then count from there. With law "
             "`contact` it needs a cohesion: nothing else holds free tissue together."},
    {INTEGER("macro.steps"), FROM(1), TO(10000), .default_words = "10; with `program`: that of its parts",
     .example = "10", .help = "Equal steps of the load parameter from 0 to 1, after inflation."},
    {LIST("macro.program"), .default_words = "one ramp from 0 to 1",
     .example = "[{to: 1, steps: 10}, {to: 0, steps: 10}]",
     .help = "Ramps of the load parameter, which begins at 0, instead of `steps`."},
    {MAP("macro.program[]"), .example = "{to: 1, steps: 10}", .help = "One ramp."},
    {REAL("macro.program[].to"), REQUIRED, FROM(-1000), TO(1000), .example = "1", .help = "Load parameter at its end."},
    {INTEGER("macro.program[].steps"), REQUIRED, FROM(1), TO(10000), .example = "10", .help = "Its equal steps."},
    {INTEGER("macro.repeat"), FROM(1), TO(1000), .default_value = "1", .example = "3",
     .help = "How often `program` is gone through."},
    {LIST("macro.zoom"), .default_words = "where the tissue is nearest to failure, and the middle",
     .example = "[[5 mm, 5 mm], [9 mm, 9 mm]]",
     .help = "Places, at most three, at whose nearest material points the microstructure is kept for pictures."},
    {LENGTH("macro.zoom[]", "mm"), .size = 2, .example = "[5 mm, 5 mm]", .help = "Position in the undeformed body."},
};
LAM_KEY_TABLE(LamProgramKeys, program_keys);

/* Exactly one of box, disc and gmsh says where the mesh comes from. */
static PetscErrorCode ChooseSource(const LamDocument *document, LamMacroSpec *spec, const LamNode **node)
{
  static const char *const paths[] = {"macro.mesh.box", "macro.mesh.disc", "macro.mesh.gmsh"};
  const LamNode *mesh, *given[3];
  LamValue unused;
  int count = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.mesh", &mesh, &unused));
  for (int k = 0; k < 3; k++) {
    PetscCall(LamSceneGet(document->root, paths[k], &given[k], &unused));
    if (!given[k]) continue;
    spec->source = (LamMeshSource)k;
    *node = given[k];
    count++;
  }
  if (!count)
    PetscCall(LamSceneFailMissing(document, mesh, "box",
                                  "missing; write box: [10 mm, 10 mm], or disc: 5 mm, or gmsh: file.msh"));
  if (count > 1)
    PetscCall(LamSceneFail(document, *node, "the mesh is one of box, disc and gmsh; leave the others out"));
  PetscFunctionReturn(0);
}

/* A key that belongs to one source of meshes alone. */
static PetscErrorCode CheckBelongs(const LamDocument *document, const char path[], LamMeshSource source,
                                   const char owner[], const LamMacroSpec *spec)
{
  const LamNode *node;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, path, &node, &unused));
  if (node && spec->source != source)
    PetscCall(LamSceneFail(document, node, "belongs to %s, which this mesh is not; leave it out", owner));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildMesh(const LamDocument *document, LamScene *scene)
{
  LamMacroSpec *spec = &scene->macro;
  const LamNode *node = NULL, *mesh;
  LamValue size, elements, other;

  PetscFunctionBeginUser;
  PetscCall(ChooseSource(document, spec, &node));
  PetscCall(CheckBelongs(document, "macro.mesh.part", LAM_MESH_DISC, "a disc", spec));
  PetscCall(CheckBelongs(document, "macro.mesh.unit", LAM_MESH_GMSH, "a Gmsh file", spec));
  PetscCall(LamSceneGet(document->root, "macro.mesh", &mesh, &other));
  PetscCall(LamSceneGet(document->root, "macro.mesh.elements", NULL, &elements));
  if (spec->source == LAM_MESH_GMSH) {
    if (elements.count)
      PetscCall(
          LamSceneFail(document, LamNodeFindPath(mesh, "elements"), "a Gmsh file has its own elements; leave it out"));
    PetscCall(LamSceneResolvePath(document, node, spec->gmsh));
    PetscCall(LamSceneGet(document->root, "macro.mesh.unit", NULL, &size));
    scene->scales.macro_length = size.number[0];
    PetscCall(LamSceneCheckScale(document, LamNodeFindPath(mesh, "unit"), size.number[0]));
    PetscFunctionReturn(0);
  }
  if (!elements.count)
    PetscCall(LamSceneFailMissing(document, mesh, "elements", "missing; write two numbers, such as [8, 8]"));
  for (PetscInt i = 0; i < 2; i++) spec->elements[i] = (PetscInt)elements.number[i];
  PetscCall(
      LamSceneGet(document->root, spec->source == LAM_MESH_BOX ? "macro.mesh.box" : "macro.mesh.disc", &node, &size));
  scene->scales.macro_length = size.number[0];
  PetscCall(LamSceneCheckScale(document, node, size.number[0]));
  for (PetscInt i = 0; i < size.count; i++)
    PetscCall(LamSceneScale(document, node, size.number[i], scene->scales.macro_length, &spec->box[i]));
  PetscCall(LamSceneGet(document->root, "macro.mesh.part", NULL, &other));
  spec->disc = (LamDiscPart)other.number[0];
  PetscFunctionReturn(0);
}

/*
  A body that inflates freely ends at zero total stress, where every mean face traction is zero, whatever the turgor is:
  contact alone then holds no cell.
*/
static PetscErrorCode CheckInflation(const LamDocument *document, const LamNode *block, const LamNode *inflate_node,
                                     const LamScene *scene)
{
  static const char *const remedy =
      "free tissue is held together only by the lamella; give interface.cohesion > 0, or inflate: false";

  PetscFunctionBeginUser;
  if (!scene->macro.inflate || scene->micro.interface != LAM_INTERFACE_CONTACT || scene->cohesion > 0.0)
    PetscFunctionReturn(0);
  if (inflate_node)
    PetscCall(LamSceneFail(document, inflate_node, "law: contact has no cohesion; %s", remedy));
  else
    PetscCall(LamSceneFailMissing(document, block, "inflate",
                                  "missing, so true with turgor, but law: contact has no cohesion; %s", remedy));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildLegs(const LamDocument *document, const LamNode *list, LamMacroSpec *spec)
{
  const LamNode *repeat_node;
  LamValue repeat, to, steps;
  PetscReal from = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.repeat", &repeat_node, &repeat));
  if (list->count > LAM_MAX_LEGS)
    PetscCall(LamSceneFailName(document, list, "has %d ramps; at most %d are allowed", (int)list->count, LAM_MAX_LEGS));
  for (const LamNode *item = list->first; item; item = item->next) {
    PetscCall(LamSceneGet(item, "macro.program[].to", NULL, &to));
    PetscCall(LamSceneGet(item, "macro.program[].steps", NULL, &steps));
    if (to.number[0] == from)
      PetscCall(LamSceneFail(document, LamNodeFindPath(item, "to"),
                             "is where the parameter is already; write another one, or leave the ramp out"));
    from = to.number[0];
    spec->legs[spec->leg_count++] = (LamLeg){to.number[0], (PetscInt)steps.number[0]};
    spec->steps += (PetscInt)steps.number[0];
  }
  if (repeat.number[0] * spec->steps > MAX_STEPS)
    PetscCall(LamSceneFailName(document, repeat_node ? repeat_node : list, "gives %g steps; at most %d are allowed",
                               (double)(repeat.number[0] * spec->steps), (int)MAX_STEPS));
  spec->steps *= (PetscInt)repeat.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildControl(const LamDocument *document, LamScene *scene)
{
  LamMacroSpec *spec = &scene->macro;
  LamLoadControl *control = &spec->control;
  const LamNode *block, *on, *node;
  LamValue value;
  PetscInt side, tractions = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.control", &block, &value));
  if (!block) PetscFunctionReturn(0);
  PetscCall(LamSceneGet(document->root, "macro.control.on", &on, &value));
  PetscCall(LamSceneCheckSide(document, on, spec, &side));
  PetscCall(PetscStrncpy(control->on, on->text, sizeof(control->on)));
  PetscCall(LamSceneGet(document->root, "macro.control.displacement", &node, &value));
  if (value.is_free[0] == value.is_free[1])
    PetscCall(LamSceneFail(document, node, "gives %s; give one and write free for the other, such as [free, -1 mm]",
                           value.is_free[0] ? "no component" : "both components"));
  control->component = value.is_free[0] ? 1 : 0;
  PetscCall(LamSceneScale(document, node, value.number[control->component], scene->scales.macro_length,
                          &control->displacement));
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscBool loads = boundary->traction[0] != 0 || boundary->traction[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
    if (loads) tractions++;
    if (loads && boundary->history.count)
      PetscCall(LamSceneFailName(document, block,
                                 "finds the factor of the tractions, but that on %s has a history; leave one of them "
                                 "out",
                                 boundary->on));
    if (boundary->kind == LAM_BOUNDARY_DISPLACEMENT && boundary->given[control->component] &&
        !strcmp(boundary->on, control->on))
      PetscCall(LamSceneFail(document, on, "its displacement along X%d is prescribed in macro.boundary; leave it free",
                             (int)control->component + 1));
  }
  if (!tractions)
    PetscCall(LamSceneFailName(document, block,
                               "finds the factor of the tractions, but there is none in "
                               "macro.boundary; give a traction or pressure, or leave control out"));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildProgram(const LamDocument *document, LamScene *scene)
{
  const LamNode *steps_node, *list, *repeat;
  LamValue steps, unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.steps", &steps_node, &steps));
  PetscCall(LamSceneGet(document->root, "macro.program", &list, &unused));
  PetscCall(LamSceneGet(document->root, "macro.repeat", &repeat, &unused));
  if (list && steps_node)
    PetscCall(LamSceneFailName(document, steps_node,
                               "stands beside program, whose parts have their own steps; leave "
                               "one of them out"));
  if (repeat && !list)
    PetscCall(LamSceneFailName(document, repeat,
                               "repeats a program, but there is none; write one, such as program: "
                               "[{to: 1, steps: 10}, {to: 0, steps: 10}]"));
  if (list)
    PetscCall(BuildLegs(document, list, &scene->macro));
  else
    scene->macro.steps = steps_node ? (PetscInt)steps.number[0] : 10;
  PetscCall(BuildControl(document, scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildZoom(const LamDocument *document, LamScene *scene)
{
  const LamNode *list;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.zoom", &list, &unused));
  if (!list) PetscFunctionReturn(0);
  if (list->count > LAM_MAX_ZOOMS)
    PetscCall(LamSceneFail(document, list, "has more than %d places; leave some out", LAM_MAX_ZOOMS));
  for (const LamNode *item = list->first; item; item = item->next) {
    PetscReal *place = scene->macro.zoom[scene->macro.zoom_count++];
    for (int i = 0; i < 2; i++)
      PetscCall(LamSceneScale(document, item, item->value.number[i], scene->scales.macro_length, &place[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildMacro(const LamDocument *document, LamScene *scene)
{
  const LamNode *block, *inflate_node;
  LamValue inflate, unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro", &block, &unused));
  if (!block) PetscFunctionReturn(0);
  scene->has_macro = PETSC_TRUE;
  PetscCall(BuildMesh(document, scene));
  PetscCall(LamSceneGet(document->root, "macro.inflate", &inflate_node, &inflate));
  scene->macro.inflate = scene->turgor != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  if (inflate_node) scene->macro.inflate = inflate.number[0] != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(CheckInflation(document, block, inflate_node, scene));
  PetscCall(LamSceneBuildBoundaries(document, scene));
  PetscCall(BuildProgram(document, scene));
  PetscCall(BuildZoom(document, scene));
  PetscFunctionReturn(0);
}
