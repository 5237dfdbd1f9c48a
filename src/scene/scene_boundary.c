/*
  Boundary conditions of the macroscale body: `macro.boundary`.
*/
#include "scene_rows.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const LamBoundaryKindNames[] = {LAM_BOUNDARY_KINDS(LAM_NAME_ENTRY)};

static const LamKey boundary_keys[] = {
    {LIST("macro.boundary"), REQUIRED, .example = "[{on: bottom, displacement: [0 mm, 0 mm]}]",
     .help = "What acts on the sides; each entry is one of `displacement`, `symmetry`, `traction`, `pressure`, "
             "`plate`, `indenter` and `grip`. A side may have several that do not contradict each other. "
             "Displacements, symmetry and grips together hold the body against rigid motion; obstacles do not count."},
    {MAP("macro.boundary[]"), .example = "{on: bottom, displacement: [0 mm, 0 mm]}", .help = "One condition."},
    {TEXT("macro.boundary[].on"), INTO(LamBoundary, on), REQUIRED, .example = "bottom",
     .help = "The name of a side of the box or disc, or of a physical group of the Gmsh file."},
    {TEXT("macro.boundary[].name"), INTO(LamBoundary, name), .default_words = "that of the side",
     .example = "upper plate", .help = "The name under which its force is reported."},
    {LENGTH("macro.boundary[].displacement", "mm"), INTO(LamBoundary, displacement), GIVEN(LamBoundary, given),
     .size = 2, FREE, .example = "[0 mm, free]",
     .help = "At load parameter 1, along X1 and X2; `free` leaves a component. All displacements count from the "
             "inflated state."},
    {BOOL("macro.boundary[].symmetry"),
     .help = "The side, which is straight, does not move along its normal, also while the body inflates."},
    {STRESS("macro.boundary[].traction"), INTO(LamBoundary, traction), .size = 2, .example = "[0 MPa, 0.01 MPa]",
     .help = "Force per reference area at load parameter 1, along X1 and X2. With `follower`: per present area, along "
             "the present tangent (the outward normal turned by +90 deg) and the present outward normal."},
    {BOOL("macro.boundary[].follower"), INTO(LamBoundary, follower), .default_value = "false",
     .help = "Whether `traction` turns with the side."},
    {STRESS("macro.boundary[].pressure"), INTO(LamBoundary, traction[1]), .example = "0.01 MPa",
     .help = "At load parameter 1, against the present outward normal, per present area."},
    {MAP("macro.boundary[].plate"), .example = "{displacement: [0 mm, -1 mm]}",
     .help = "A rigid, flat plate that first touches the side and may leave it and come back."},
    {LENGTH("macro.boundary[].plate.displacement", "mm"), INTO(LamBoundary, displacement), .size = 2, REQUIRED,
     .example = "[0 mm, -1 mm]",
     .help = "Of the plate at load parameter 1; without friction only its part along the normal matters."},
    {REAL("macro.boundary[].plate.normal"), INTO(LamBoundary, normal), .size = 2,
     .default_words = "that of the side, where this is straight", .example = "[0, -1]",
     .help = "From the plate into the body."},
    {REAL("macro.boundary[].plate.friction"), INTO(LamBoundary, friction), FROM(0), .free_word = "stuck",
     .default_words = "none", .example = "0.3",
     .help =
         "Coefficient of Coulomb's friction between plate and body; `stuck`: what touches it stays where it is on it."},
    {MAP("macro.boundary[].indenter"), .example = "{radius: 2 mm, at: [5 mm, 10 mm], displacement: [0 mm, -1 mm]}",
     .help = "A rigid indenter that first touches the side and may leave it and come back: round, or with `edge` a "
             "flat end "
             "with a shaft. Of an axisymmetric body it is a sphere or a cylinder on the axis."},
    {LENGTH("macro.boundary[].indenter.radius", "mm"), INTO(LamBoundary, radius), REQUIRED, ABOVE(0), .example = "2 mm",
     .help = "Its radius; with `edge` half its width, of an axisymmetric body the radius of the cylinder."},
    {LENGTH("macro.boundary[].indenter.edge", "mm"), INTO(LamBoundary, edge), FROM(0),
     .default_words = "none: it is round, and has no shaft", .example = "0.5 mm",
     .help = "Radius of the rounding between its flat end and its shaft, at most `radius`; 0 mm: a sharp edge."},
    {REAL("macro.boundary[].indenter.friction"), INTO(LamBoundary, friction), FROM(0), .free_word = "stuck",
     .default_words = "none", .example = "0.3", .help = "As of a plate."},
    {LENGTH("macro.boundary[].indenter.at", "mm"), INTO(LamBoundary, at), .size = 2, REQUIRED,
     .example = "[5 mm, 10 mm]",
     .help = "A point on the line along which its centre moves, such as the point of the side that it touches first."},
    {LENGTH("macro.boundary[].indenter.displacement", "mm"), INTO(LamBoundary, displacement), .size = 2, REQUIRED,
     .example = "[0 mm, -1 mm]",
     .help = "At load parameter 1; not zero: it is the direction from which the indenter comes."},
    {LENGTH("macro.boundary[].grip", "mm"), INTO(LamBoundary, displacement), GIVEN(LamBoundary, given), .size = 2, FREE,
     .example = "[1 mm, free]",
     .help = "A rigid grip: all points of the side move alike. A `free` component bears no total force."},
    {LIST("macro.boundary[].history"), .default_words = "the load parameter itself",
     .example = "[[0, 0], [1, 1], [2, 1]]",
     .help = "By which factor the entry's displacement, traction or pressure is multiplied: pairs of load parameter "
             "and factor, straight in between, constant beyond."},
    {REAL("macro.boundary[].history[]"), .size = 2, .example = "[1, 0.5]", .help = "Load parameter and factor."},
};
LAM_KEY_TABLE(LamBoundaryKeys, boundary_keys);

/* The entries read so far. */
typedef struct {
  const LamNode *entry[LAM_MAX_BOUNDARIES]; /* in the file */
  PetscInt side[LAM_MAX_BOUNDARIES];        /* of a box or disc; -1: Gmsh file */
  PetscBool held[LAM_MAX_BOUNDARIES][2];    /* components that the entry prescribes along the whole side */
} Conditions;

static const char *const box_sides[] = {LAM_SIDES(LAM_NAME_ENTRY) NULL};

/* Names of the sides of a box or disc; NULL: they are in the mesh file. */
static const char *const *SideNames(const LamMacroSpec *spec)
{
  static const char *const disc[][4] = {[LAM_DISC_WHOLE] = {"rim"},
                                        [LAM_DISC_HALF] = {"rim", "bottom"},
                                        [LAM_DISC_RIGHT] = {"rim", "left"},
                                        [LAM_DISC_QUARTER] = {"rim", "bottom", "left"}};

  if (spec->source == LAM_MESH_GMSH) return NULL;
  return spec->source == LAM_MESH_BOX ? box_sides : disc[spec->disc];
}

PetscErrorCode LamSceneCheckSide(const LamNode *on, const LamMacroSpec *spec, PetscInt *side)
{
  const char *const *names = SideNames(spec);
  char known[80] = "";

  PetscFunctionBeginUser;
  *side = -1;
  for (PetscInt k = 0; names && names[k]; k++) {
    if (!strcmp(names[k], on->text)) *side = k;
    snprintf(known + strlen(known), sizeof(known) - strlen(known), "%s%s", k ? ", " : "", names[k]);
  }
  LamSceneCheck(!names || *side >= 0, on, "is none of the names known here; write one of %s", known);
  PetscFunctionReturn(0);
}

/* The component along the normal of a straight side of a box or disc; -1: not straight, or unknown. */
static PetscInt NormalComponent(const LamMacroSpec *spec, PetscInt side)
{
  const char *name = side < 0 ? "" : SideNames(spec)[side];

  if (!strcmp(name, "left") || !strcmp(name, "right")) return 0;
  return !strcmp(name, "bottom") || !strcmp(name, "top") ? 1 : -1;
}

/* ---- one entry ---- */

/* Exactly one key determines the kind of the entry. */
static PetscErrorCode ChooseKind(const LamNode *entry, LamBoundary *boundary)
{
  const LamNode *chosen = NULL, *follower = LamNodeFind(entry, "follower");

  PetscFunctionBeginUser;
  for (PetscInt kind = 0; kind < LAM_BOUNDARY_KIND_COUNT; kind++) {
    const LamNode *node = LamNodeFind(entry, LamBoundaryKindNames[kind]);

    if (!node) continue;
    LamSceneCheckName(!chosen, node, "stands beside %s; write an entry of its own for it, on the same side",
                      chosen->name);
    chosen = node;
    boundary->kind = (LamBoundaryKind)kind;
  }
  LamSceneRequire(chosen, entry, "displacement",
                  "missing; write one of displacement, symmetry, traction, pressure, plate, indenter, grip, such as "
                  "displacement: [0 mm, free]");
  LamSceneCheckName(!follower || boundary->kind == LAM_BOUNDARY_TRACTION, follower,
                    "belongs to traction; leave it out (a pressure always follows)");
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckPlate(const LamNode *plate, PetscBool curved, LamBoundary *boundary)
{
  const LamNode *node = LamNodeFind(plate, "normal");
  PetscReal *normal = boundary->normal, length;

  PetscFunctionBeginUser;
  LamSceneRequire(node || !curved, plate, "normal",
                  "missing, and %s is curved; write from where the plate looks into the body, such as normal: [0, -1]",
                  boundary->on);
  if (!node) PetscFunctionReturn(0);
  length = PetscSqrtReal(PetscSqr(normal[0]) + PetscSqr(normal[1]));
  LamSceneCheck(length > 0 && !PetscIsInfOrNanReal(length), node,
                "is no direction; write two numbers that are not both 0, such as [0, -1]");
  for (PetscInt c = 0; c < 2; c++) normal[c] /= length;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckIndenter(const LamNode *indenter, LamBoundary *boundary)
{
  const LamNode *edge = LamNodeFind(indenter, "edge");

  PetscFunctionBeginUser;
  LamSceneCheck(boundary->displacement[0] != 0 || boundary->displacement[1] != 0, LamNodeFind(indenter, "displacement"),
                "is zero, so the indenter comes from nowhere; write how it moves, such as [0 mm, -1 mm]");
  boundary->shaft = (PetscBool)(edge != NULL);
  LamSceneCheck(!edge || boundary->edge <= boundary->radius, edge,
                "is larger than the radius of the indenter; write at most that");
  PetscFunctionReturn(0);
}

/* `stuck` is infinite friction. */
static void FindFriction(const LamNode *obstacle, LamBoundary *boundary)
{
  const LamNode *friction = LamNodeFind(obstacle, "friction");

  if (friction && friction->value.is_free[0]) boundary->friction = INFINITY;
}

/* Checks of the kind beyond the bounds of its keys; `curved`: the side is known and not straight. */
static PetscErrorCode CheckKind(const LamNode *entry, PetscBool curved, LamBoundary *boundary)
{
  const LamNode *chosen = LamNodeFind(entry, LamBoundaryKindNames[boundary->kind]);

  PetscFunctionBeginUser;
  switch (boundary->kind) {
  case LAM_BOUNDARY_SYMMETRY:
    LamSceneCheck(chosen->value.number[0] != 0, chosen, "says nothing; write true, or leave the entry out");
    LamSceneCheck(!curved, chosen, "%s is curved; only a straight side can be one of symmetry", boundary->on);
    break;
  case LAM_BOUNDARY_PRESSURE:
    boundary->follower = PETSC_TRUE;
    boundary->traction[1] = -boundary->traction[1];
    break;
  case LAM_BOUNDARY_PLATE:
    PetscCall(CheckPlate(chosen, curved, boundary));
    break;
  case LAM_BOUNDARY_INDENTER:
    PetscCall(CheckIndenter(chosen, boundary));
    break;
  default:
    break;
  }
  FindFriction(chosen, boundary);
  PetscFunctionReturn(0);
}

/* What an axisymmetric body does not have: a rigid body that moves along the radius. */
static PetscErrorCode CheckAround(const LamNode *entry, const LamBoundary *boundary)
{
  const LamNode *chosen = LamNodeFind(entry, LamBoundaryKindNames[boundary->kind]);

  PetscFunctionBeginUser;
  LamSceneCheck(boundary->kind != LAM_BOUNDARY_GRIP || (boundary->given[0] && boundary->displacement[0] == 0), chosen,
                "a rigid grip of an axisymmetric body cannot move along X1, the radius; write 0 mm for it");
  if (boundary->kind != LAM_BOUNDARY_INDENTER) PetscFunctionReturn(0);
  LamSceneCheck(boundary->at[0] == 0, LamNodeFind(chosen, "at"),
                "an indenter of an axisymmetric body moves along the axis; write 0 mm for X1");
  LamSceneCheck(boundary->displacement[0] == 0, LamNodeFind(chosen, "displacement"),
                "an indenter of an axisymmetric body moves along the axis; write 0 mm for X1");
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadHistory(const LamNode *list, LamBoundary *boundary)
{
  LamHistory *history = &boundary->history;

  PetscFunctionBeginUser;
  if (!list) PetscFunctionReturn(0);
  LamSceneCheckName(boundary->kind != LAM_BOUNDARY_SYMMETRY, list, "a side of symmetry does not move; leave it out");
  LamSceneCheck(list->count <= LAM_HISTORY_POINTS, list, "has %d points; at most %d are allowed", (int)list->count,
                LAM_HISTORY_POINTS);
  for (const LamNode *item = list->first; item; item = item->next) {
    const PetscInt n = history->count++;

    history->parameter[n] = item->value.number[0];
    history->factor[n] = item->value.number[1];
    LamSceneCheck(!n || history->parameter[n] > history->parameter[n - 1], item,
                  "comes after parameter %g; write the points with rising parameters",
                  (double)history->parameter[n - 1]);
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

/* Conditions on one side must not prescribe the same component, nor apply a load to a prescribed component. */
static PetscErrorCode CheckSameSide(const LamMacroSpec *spec, PetscInt b, const Conditions *conditions)
{
  const LamNode *on = LamNodeFind(conditions->entry[b], "on");
  const LamBoundary *boundary = &spec->boundary[b];

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < b; a++) {
    const LamBoundary *other = &spec->boundary[a];

    if (strcmp(other->on, boundary->on)) continue;
    for (PetscInt c = 0; c < 2; c++) {
      const PetscBool one = conditions->held[a][c], two = conditions->held[b][c];

      LamSceneCheck(!one || !two, on,
                    "its displacement along X%d is prescribed already, in line %d; leave it to one of them", (int)c + 1,
                    conditions->entry[a]->line);
      LamSceneCheck((!one || boundary->follower || boundary->traction[c] == 0) &&
                        (!two || other->follower || other->traction[c] == 0),
                    on,
                    "its displacement along X%d is prescribed, so the traction there (lines %d and %d) does nothing; "
                    "leave one of them out",
                    (int)c + 1, conditions->entry[a]->line, conditions->entry[b]->line);
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildBoundary(const LamNode *entry, LamScene *scene, Conditions *conditions)
{
  const PetscInt b = scene->macro.boundary_count++;
  LamBoundary *boundary = &scene->macro.boundary[b];
  PetscInt *side = &conditions->side[b];
  PetscBool curved;

  PetscFunctionBeginUser;
  conditions->entry[b] = entry;
  PetscCall(LamSceneCheckSide(LamNodeFind(entry, "on"), &scene->macro, side));
  PetscCall(ChooseKind(entry, boundary));
  PetscCall(LamSceneFill(entry, &scene->scales, LamBoundary, boundary));
  boundary->place = LamNodePlace(LamNodeFind(entry, "on"));
  curved = (PetscBool)(*side >= 0 && NormalComponent(&scene->macro, *side) < 0);
  PetscCall(CheckKind(entry, curved, boundary));
  if (scene->macro.symmetry == LAM_AXISYMMETRIC) PetscCall(CheckAround(entry, boundary));
  PetscCall(ReadHistory(LamNodeFind(entry, "history"), boundary));
  FindHeld(&scene->macro, *side, boundary, conditions->held[b]);
  PetscCall(CheckSameSide(&scene->macro, b, conditions));
  PetscFunctionReturn(0);
}

/* ---- boxes, whose sides are known without a mesh ---- */

/* True if two conditions that prescribe component c move a shared corner equally. */
static PetscBool MoveAlike(const LamBoundary *one, const LamBoundary *other, PetscInt c)
{
  if ((one->kind == LAM_BOUNDARY_GRIP && !one->given[c]) || (other->kind == LAM_BOUNDARY_GRIP && !other->given[c]))
    return PETSC_FALSE;
  return (PetscBool)(one->displacement[c] == other->displacement[c] &&
                     (one->displacement[c] == 0 || LamHistoriesAgree(&one->history, &other->history)));
}

/* Adjacent sides must move their shared corner equally. */
static PetscErrorCode CheckCorners(const LamMacroSpec *spec, const Conditions *conditions)
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < spec->boundary_count; a++) {
    for (PetscInt b = 0; b < spec->boundary_count; b++) {
      const LamBoundary *upright = &spec->boundary[a], *level = &spec->boundary[b];

      if (NormalComponent(spec, conditions->side[a]) != 0 || NormalComponent(spec, conditions->side[b]) != 1) continue;
      for (PetscInt c = 0; c < 2; c++)
        LamSceneCheck(!conditions->held[a][c] || !conditions->held[b][c] || MoveAlike(upright, level, c),
                      LamNodeFind(conditions->entry[a], LamBoundaryKindNames[upright->kind]),
                      "%s and %s (line %d) move their common corner differently along X%d; write equal displacements, "
                      "or free in one of them",
                      upright->on, level->on, conditions->entry[b]->line, (int)c + 1);
    }
  }
  PetscFunctionReturn(0);
}

/*
  Rigid motions of a box: along X1, along X2, and the rotation u = w (-X2, X1). A side constrains a translation if it
  prescribes the component. The rotation changes u1 along the vertical sides and u2 along the horizontal ones, so that
  prescribing one of these constrains it; a component that is constant along its side constrains it only together with
  the opposite side. A grip never rotates. An axisymmetric body can only move along X2.
*/
static PetscErrorCode CheckRigidMotions(const LamNode *list, const LamMacroSpec *spec, const Conditions *conditions)
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
  if (spec->symmetry == LAM_AXISYMMETRIC) held[0] = held[2] = PETSC_TRUE;
  for (PetscInt i = 0; i < 3; i++)
    LamSceneCheckName(held[i], list, "the body can still move %s; %s", names[i], remedies[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildBoundaries(const LamNode *root, LamScene *scene)
{
  const LamNode *list = LamNodeFind(root, "macro.boundary");
  Conditions conditions = {0};

  PetscFunctionBeginUser;
  LamSceneCheckName(list->count <= LAM_MAX_BOUNDARIES, list, "has %d entries; at most %d are allowed", (int)list->count,
                    LAM_MAX_BOUNDARIES);
  for (const LamNode *entry = list->first; entry; entry = entry->next)
    PetscCall(BuildBoundary(entry, scene, &conditions));
  if (scene->macro.source == LAM_MESH_BOX) { /* the macroscale solver checks other bodies */
    PetscCall(CheckCorners(&scene->macro, &conditions));
    PetscCall(CheckRigidMotions(list, &scene->macro, &conditions));
  }
  PetscFunctionReturn(0);
}
