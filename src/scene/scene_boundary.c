/*
  The conditions on the sides of the macroscale body: `macro.boundary`.
*/
#include "scene_rows.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const LamBoundaryKindNames[] = {LAM_BOUNDARY_KINDS(LAM_NAME_ENTRY)};

static const LamKey boundary_keys[] = {
    {LIST("macro.boundary"), REQUIRED, .example = "[{on: bottom, displacement: [0 mm, 0 mm]}]",
     .help =
         "What acts on the sides; each entry is one of `displacement`, `symmetry`, `traction`, `pressure`, `plate`, "
         "`indenter` and `grip`. A side may have several that do not contradict each other. Displacements, "
         "symmetry and grips together hold the body against rigid motion; obstacles do not count."},
    {MAP("macro.boundary[]"), .example = "{on: bottom, displacement: [0 mm, 0 mm]}", .help = "One condition."},
    {TEXT("macro.boundary[].on"), REQUIRED, .example = "bottom",
     .help = "The name of a side of the box or disc, or of a physical group of the Gmsh file."},
    {TEXT("macro.boundary[].name"), .default_words = "that of the side", .example = "upper plate",
     .help = "The name under which its force is reported."},
    {LENGTH("macro.boundary[].displacement", "mm"), .size = 2, FREE, .example = "[0 mm, free]",
     .help = "At load parameter 1, along X1 and X2; `free` leaves a component. All displacements count from the "
             "inflated state."},
    {BOOL("macro.boundary[].symmetry"), .example = "true",
     .help = "The side, which is straight, does not move along its normal, also while the body inflates."},
    {STRESS("macro.boundary[].traction"), .size = 2, .example = "[0 MPa, 0.01 MPa]",
     .help = "Force per reference area at load parameter 1, along X1 and X2. With `follower`: per present area, along "
             "the present tangent (the outward normal turned by +90 deg) and the present outward normal."},
    {BOOL("macro.boundary[].follower"), .default_value = "false", .example = "true",
     .help = "Whether `traction` turns with the side."},
    {STRESS("macro.boundary[].pressure"), .example = "0.01 MPa",
     .help = "At load parameter 1, against the present outward normal, per present area."},
    {MAP("macro.boundary[].plate"), .example = "{displacement: [0 mm, -1 mm]}",
     .help = "A rigid, flat, frictionless plate that first touches the side and may leave it and come back."},
    {LENGTH("macro.boundary[].plate.displacement", "mm"), .size = 2, REQUIRED, .example = "[0 mm, -1 mm]",
     .help = "Of the plate at load parameter 1; only its part along the normal matters."},
    {REAL("macro.boundary[].plate.normal"), .size = 2, .default_words = "that of the side, where this is straight",
     .example = "[0, -1]", .help = "From the plate into the body."},
    {MAP("macro.boundary[].indenter"), .example = "{radius: 2 mm, at: [5 mm, 10 mm], displacement: [0 mm, -1 mm]}",
     .help = "A rigid, round, frictionless indenter that first touches the side and may leave it and come back."},
    {LENGTH("macro.boundary[].indenter.radius", "mm"), REQUIRED, ABOVE(0), .example = "2 mm", .help = "Its radius."},
    {LENGTH("macro.boundary[].indenter.at", "mm"), .size = 2, REQUIRED, .example = "[5 mm, 10 mm]",
     .help = "A point on the line along which its centre moves, such as the point of the side that it touches first."},
    {LENGTH("macro.boundary[].indenter.displacement", "mm"), .size = 2, REQUIRED, .example = "[0 mm, -1 mm]",
     .help = "At load parameter 1; not zero: it is the direction from which the indenter comes."},
    {LENGTH("macro.boundary[].grip", "mm"), .size = 2, FREE, .example = "[1 mm, free]",
     .help = "A rigid grip: all points of the side move alike. A `free` component bears no total force."},
    {LIST("macro.boundary[].history"), .default_words = "the load parameter itself",
     .example = "[[0, 0], [1, 1], [2, 1]]",
     .help =
         "By which factor the entry's displacement, traction or pressure is multiplied: pairs of load parameter and "
         "factor, straight in between, constant beyond."},
    {REAL("macro.boundary[].history[]"), .size = 2, .example = "[1, 0.5]", .help = "Load parameter and factor."},
};
LAM_KEY_TABLE(LamBoundaryKeys, boundary_keys);

/* What is known of the entries so far. */
typedef struct {
  const LamNode *entry[LAM_MAX_BOUNDARIES]; /* in the file */
  PetscInt side[LAM_MAX_BOUNDARIES];        /* of a box or disc; -1: of a Gmsh file */
  PetscBool held[LAM_MAX_BOUNDARIES][2];    /* components that the entry prescribes all along the side */
} Conditions;

static const char *const box_sides[] = {LAM_SIDES(LAM_NAME_ENTRY) NULL};

/* The sides that a box or a disc has, by name; NULL: the mesh's file names them. */
static const char *const *SideNames(const LamMacroSpec *spec)
{
  static const char *const disc[][4] = {
      [LAM_DISC_WHOLE] = {"rim"}, [LAM_DISC_HALF] = {"rim", "bottom"}, [LAM_DISC_QUARTER] = {"rim", "bottom", "left"}};

  if (spec->source == LAM_MESH_GMSH) return NULL;
  return spec->source == LAM_MESH_BOX ? box_sides : disc[spec->disc];
}

PetscErrorCode LamSceneCheckSide(const LamDocument *document, const LamNode *on, const LamMacroSpec *spec,
                                 PetscInt *side)
{
  const char *const *names = SideNames(spec);
  char known[80] = "";

  PetscFunctionBeginUser;
  *side = -1;
  if (strlen(on->text) >= LAM_NAME_LENGTH)
    PetscCall(LamSceneFail(document, on, "is too long; names have less than %d letters", LAM_NAME_LENGTH));
  for (PetscInt k = 0; names && names[k]; k++) {
    if (!strcmp(names[k], on->text)) *side = k;
    snprintf(known + strlen(known), sizeof(known) - strlen(known), "%s%s", k ? ", " : "", names[k]);
  }
  if (names && *side < 0)
    PetscCall(LamSceneFail(document, on, "is none of the names known here; write one of %s", known));
  PetscFunctionReturn(0);
}

/* The component along the normal of a straight side of a box or disc; -1: not straight, or not known. */
static PetscInt NormalComponent(const LamMacroSpec *spec, PetscInt side)
{
  const char *name = side < 0 ? "" : SideNames(spec)[side];

  if (!strcmp(name, "left") || !strcmp(name, "right")) return 0;
  return !strcmp(name, "bottom") || !strcmp(name, "top") ? 1 : -1;
}

/* ---- the kinds of conditions ---- */

static PetscErrorCode ReadVector(const LamDocument *document, const LamNode *entry, const char path[], PetscReal scale,
                                 PetscReal vector[2], PetscBool given[2])
{
  const LamNode *node;
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, path, &node, &value));
  for (PetscInt c = 0; c < 2; c++) {
    if (given) given[c] = value.is_free[c] ? PETSC_FALSE : PETSC_TRUE;
    PetscCall(LamSceneScale(document, node, value.number[c], scale, &vector[c]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadPlate(const LamDocument *document, const LamNode *entry, const LamScene *scene, PetscInt side,
                                LamBoundary *boundary)
{
  const LamNode *node, *plate;
  LamValue normal;

  PetscFunctionBeginUser;
  PetscCall(ReadVector(document, entry, "macro.boundary[].plate.displacement", scene->scales.macro_length,
                       boundary->displacement, NULL));
  PetscCall(LamSceneGet(entry, "macro.boundary[].plate", &plate, &normal));
  PetscCall(LamSceneGet(entry, "macro.boundary[].plate.normal", &node, &normal));
  if (!node) {
    if (side >= 0 && NormalComponent(&scene->macro, side) < 0)
      PetscCall(LamSceneFailMissing(document, plate, "normal",
                                    "missing, and %s is curved; write from where the plate looks into the body, such "
                                    "as normal: [0, -1]",
                                    boundary->on));
    PetscFunctionReturn(0);
  }
  const PetscReal length = PetscSqrtReal(PetscSqr(normal.number[0]) + PetscSqr(normal.number[1]));
  if (!(length > 0) || PetscIsInfOrNanReal(length))
    PetscCall(LamSceneFail(document, node, "is no direction; write two numbers that are not both 0, such as [0, -1]"));
  for (PetscInt c = 0; c < 2; c++) boundary->normal[c] = normal.number[c] / length;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadIndenter(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                   LamBoundary *boundary)
{
  const PetscReal length = scene->scales.macro_length;
  const LamNode *node;
  LamValue radius;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].indenter.radius", &node, &radius));
  PetscCall(LamSceneScale(document, node, radius.number[0], length, &boundary->radius));
  PetscCall(ReadVector(document, entry, "macro.boundary[].indenter.at", length, boundary->at, NULL));
  PetscCall(
      ReadVector(document, entry, "macro.boundary[].indenter.displacement", length, boundary->displacement, NULL));
  PetscCall(LamSceneGet(entry, "macro.boundary[].indenter.displacement", &node, &radius));
  if (boundary->displacement[0] == 0 && boundary->displacement[1] == 0)
    PetscCall(LamSceneFail(document, node,
                           "is zero, so the indenter comes from nowhere; write how it moves, such as [0 mm, -1 mm]"));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadTraction(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                   LamBoundary *boundary)
{
  const LamNode *node;
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].follower", &node, &value));
  boundary->follower = value.number[0] != 0 ? PETSC_TRUE : PETSC_FALSE;
  if (boundary->kind == LAM_BOUNDARY_TRACTION) {
    PetscCall(ReadVector(document, entry, "macro.boundary[].traction", scene->scales.stress, boundary->traction, NULL));
    PetscFunctionReturn(0);
  }
  boundary->follower = PETSC_TRUE;
  PetscCall(LamSceneGet(entry, "macro.boundary[].pressure", &node, &value));
  PetscCall(LamSceneScale(document, node, -value.number[0], scene->scales.stress, &boundary->traction[1]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadSymmetry(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                   PetscInt side, const LamBoundary *boundary)
{
  const LamNode *node;
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].symmetry", &node, &value));
  if (value.number[0] == 0) PetscCall(LamSceneFail(document, node, "says nothing; write true, or leave the entry out"));
  if (side >= 0 && NormalComponent(&scene->macro, side) < 0)
    PetscCall(LamSceneFail(document, node, "%s is curved; only a straight side can be one of symmetry", boundary->on));
  PetscFunctionReturn(0);
}

/* ---- one entry ---- */

/* Exactly one key says what the entry is. */
static PetscErrorCode ChooseKind(const LamDocument *document, const LamNode *entry, LamBoundary *boundary)
{
  const LamNode *chosen = NULL, *follower;
  LamValue unused;

  PetscFunctionBeginUser;
  for (PetscInt kind = 0; kind < LAM_BOUNDARY_KIND_COUNT; kind++) {
    const LamNode *node = LamNodeFindPath(entry, LamBoundaryKindNames[kind]);
    if (!node) continue;
    if (chosen)
      PetscCall(LamSceneFailName(document, node, "stands beside %s; write an entry of its own for it, on the same side",
                                 chosen->name));
    chosen = node;
    boundary->kind = (LamBoundaryKind)kind;
  }
  if (!chosen)
    PetscCall(LamSceneFailMissing(document, entry, "displacement",
                                  "missing; write one of displacement, symmetry, traction, pressure, plate, indenter, "
                                  "grip, such as displacement: [0 mm, free]"));
  PetscCall(LamSceneGet(entry, "macro.boundary[].follower", &follower, &unused));
  if (follower && boundary->kind != LAM_BOUNDARY_TRACTION)
    PetscCall(LamSceneFailName(document, follower, "belongs to traction; leave it out (a pressure always follows)"));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadHistory(const LamDocument *document, const LamNode *entry, LamBoundary *boundary)
{
  LamHistory *history = &boundary->history;
  const LamNode *list;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].history", &list, &unused));
  if (!list) PetscFunctionReturn(0);
  if (boundary->kind == LAM_BOUNDARY_SYMMETRY)
    PetscCall(LamSceneFailName(document, list, "a side of symmetry does not move; leave it out"));
  if (list->count > LAM_HISTORY_POINTS)
    PetscCall(
        LamSceneFail(document, list, "has %d points; at most %d are allowed", (int)list->count, LAM_HISTORY_POINTS));
  for (const LamNode *item = list->first; item; item = item->next) {
    const PetscReal parameter = item->value.number[0];
    if (history->count && parameter <= history->parameter[history->count - 1])
      PetscCall(LamSceneFail(document, item, "comes after parameter %g; write the points with rising parameters",
                             (double)history->parameter[history->count - 1]));
    history->parameter[history->count] = parameter;
    history->factor[history->count++] = item->value.number[1];
  }
  PetscFunctionReturn(0);
}

static void FindHeld(const LamMacroSpec *spec, PetscInt side, const LamBoundary *boundary, PetscBool held[2])
{
  for (PetscInt c = 0; c < 2; c++) {
    held[c] = PETSC_FALSE;
    if (boundary->kind == LAM_BOUNDARY_DISPLACEMENT) held[c] = boundary->given[c];
    if (boundary->kind == LAM_BOUNDARY_GRIP) held[c] = PETSC_TRUE;
    if (boundary->kind == LAM_BOUNDARY_SYMMETRY) held[c] = NormalComponent(spec, side) == c ? PETSC_TRUE : PETSC_FALSE;
  }
}

/* Conditions on one side do not prescribe the same component, nor load or press on what is prescribed. */
static PetscErrorCode CheckSameSide(const LamDocument *document, const LamScene *scene, PetscInt b,
                                    const Conditions *conditions)
{
  const LamBoundary *boundary = &scene->macro.boundary[b];

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < b; a++) {
    const LamBoundary *other = &scene->macro.boundary[a];
    if (strcmp(other->on, boundary->on)) continue;
    for (PetscInt c = 0; c < 2; c++) {
      const PetscBool one = conditions->held[a][c], two = conditions->held[b][c];
      if (one && two)
        PetscCall(LamSceneFail(document, LamNodeFindPath(conditions->entry[b], "on"),
                               "its displacement along X%d is prescribed already, in line %d; leave it to one of them",
                               (int)c + 1, conditions->entry[a]->line));
      if ((one && !boundary->follower && boundary->traction[c] != 0) ||
          (two && !other->follower && other->traction[c] != 0))
        PetscCall(LamSceneFail(document, LamNodeFindPath(conditions->entry[b], "on"),
                               "its displacement along X%d is prescribed, so the traction there (lines %d and %d) does "
                               "nothing; leave one of them out",
                               (int)c + 1, conditions->entry[a]->line, conditions->entry[b]->line));
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildBoundary(const LamDocument *document, const LamNode *entry, LamScene *scene,
                                    Conditions *conditions)
{
  const PetscInt b = scene->macro.boundary_count++;
  LamBoundary *boundary = &scene->macro.boundary[b];
  const PetscReal length = scene->scales.macro_length;
  const LamNode *on, *name;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].on", &on, &unused));
  PetscCall(LamSceneCheckSide(document, on, &scene->macro, &conditions->side[b]));
  PetscCall(PetscStrncpy(boundary->on, on->text, sizeof(boundary->on)));
  PetscCall(LamSceneGet(entry, "macro.boundary[].name", &name, &unused));
  if (name && strlen(name->text) >= sizeof(boundary->name))
    PetscCall(LamSceneFail(document, name, "is too long; names have less than %d letters", LAM_NAME_LENGTH));
  if (name) PetscCall(PetscStrncpy(boundary->name, name->text, sizeof(boundary->name)));
  PetscCall(ChooseKind(document, entry, boundary));
  switch (boundary->kind) {
  case LAM_BOUNDARY_SYMMETRY:
    PetscCall(ReadSymmetry(document, entry, scene, conditions->side[b], boundary));
    break;
  case LAM_BOUNDARY_TRACTION:
  case LAM_BOUNDARY_PRESSURE:
    PetscCall(ReadTraction(document, entry, scene, boundary));
    break;
  case LAM_BOUNDARY_PLATE:
    PetscCall(ReadPlate(document, entry, scene, conditions->side[b], boundary));
    break;
  case LAM_BOUNDARY_INDENTER:
    PetscCall(ReadIndenter(document, entry, scene, boundary));
    break;
  default:
    PetscCall(
        ReadVector(document, entry,
                   boundary->kind == LAM_BOUNDARY_GRIP ? "macro.boundary[].grip" : "macro.boundary[].displacement",
                   length, boundary->displacement, boundary->given));
  }
  PetscCall(ReadHistory(document, entry, boundary));
  conditions->entry[b] = entry;
  FindHeld(&scene->macro, conditions->side[b], boundary, conditions->held[b]);
  PetscCall(CheckSameSide(document, scene, b, conditions));
  PetscFunctionReturn(0);
}

/* ---- boxes, whose sides are known before there is a mesh ---- */

/* Sides that meet share a corner: both move it, so they agree. */
static PetscErrorCode CheckCorners(const LamDocument *document, const LamMacroSpec *spec, const Conditions *conditions)
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < spec->boundary_count; a++) {
    for (PetscInt b = 0; b < spec->boundary_count; b++) {
      const LamNode *node = LamNodeFindPath(conditions->entry[a], LamBoundaryKindNames[spec->boundary[a].kind]);
      if (NormalComponent(spec, conditions->side[a]) != 0 || NormalComponent(spec, conditions->side[b]) != 1) continue;
      for (PetscInt c = 0; c < 2; c++) {
        const LamBoundary *upright = &spec->boundary[a], *level = &spec->boundary[b];
        if (!conditions->held[a][c] || !conditions->held[b][c]) continue;
        const PetscBool loose = (upright->kind == LAM_BOUNDARY_GRIP && !upright->given[c]) ||
                                        (level->kind == LAM_BOUNDARY_GRIP && !level->given[c])
                                    ? PETSC_TRUE
                                    : PETSC_FALSE;
        if (!loose && upright->displacement[c] == level->displacement[c] &&
            (level->displacement[c] == 0 || LamHistoriesAgree(&upright->history, &level->history)))
          continue;
        PetscCall(LamSceneFail(document, node,
                               "%s and %s (line %d) move their common corner differently along X%d; write equal "
                               "displacements, or free in one of them",
                               upright->on, level->on, conditions->entry[b]->line, (int)c + 1));
      }
    }
  }
  PetscFunctionReturn(0);
}

/*
  Rigid motions of a box: along X1, along X2, and the rotation u = w (-X2, X1). A side holds a translation where its
  component is given. The rotation changes u1 along the upright sides and u2 along the level ones, so one of these holds
  it; a component that is constant along its side holds it only together with the opposite side. A grip never turns.
*/
static PetscErrorCode CheckRigidMotions(const LamDocument *document, const LamNode *list, const LamMacroSpec *spec,
                                        const Conditions *conditions)
{
  PetscBool given[LAM_BOX_COUNT][2] = {{PETSC_FALSE}}, held[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  static const char *const names[] = {"along X1", "along X2", "by a rotation"};
  static const char *const remedies[] = {
      "give the first displacement component on a side", "give the second displacement component on a side",
      "give the first component on left or right, or the second on bottom or top, or one on both opposite sides"};

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    for (PetscInt c = 0; c < 2; c++) {
      if (!conditions->held[b][c]) continue;
      if (boundary->kind == LAM_BOUNDARY_GRIP) held[2] = PETSC_TRUE;
      if (boundary->kind == LAM_BOUNDARY_GRIP && !boundary->given[c]) continue;
      given[conditions->side[b]][c] = held[c] = PETSC_TRUE;
    }
  }
  if (given[LAM_BOX_LEFT][0] || given[LAM_BOX_RIGHT][0] || given[LAM_BOX_BOTTOM][1] || given[LAM_BOX_TOP][1] ||
      (given[LAM_BOX_LEFT][1] && given[LAM_BOX_RIGHT][1]) || (given[LAM_BOX_BOTTOM][0] && given[LAM_BOX_TOP][0]))
    held[2] = PETSC_TRUE;
  for (PetscInt i = 0; i < 3; i++) {
    if (!held[i]) PetscCall(LamSceneFailName(document, list, "the body can still move %s; %s", names[i], remedies[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildBoundaries(const LamDocument *document, LamScene *scene)
{
  Conditions conditions = {0};
  const LamNode *list;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.boundary", &list, &unused));
  if (list->count > LAM_MAX_BOUNDARIES)
    PetscCall(LamSceneFailName(document, list, "has %d entries; at most %d are allowed", (int)list->count,
                               LAM_MAX_BOUNDARIES));
  for (const LamNode *entry = list->first; entry; entry = entry->next)
    PetscCall(BuildBoundary(document, entry, scene, &conditions));
  if (scene->macro.source == LAM_MESH_BOX) { /* of other bodies the macroscale solver checks it */
    PetscCall(CheckCorners(document, &scene->macro, &conditions));
    PetscCall(CheckRigidMotions(document, list, &scene->macro, &conditions));
  }
  PetscFunctionReturn(0);
}
