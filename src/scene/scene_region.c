/*
  `macro.regions` and `macro.fields` of a scene: tissue that differs from place to place.
*/
#include "scene_rows.h"
#include "quantity_text.h"
#include <string.h>

const char *const LamTissueFieldNames[] = {LAM_TISSUE_FIELDS(LAM_NAME_ENTRY)};

#define AS_RVE "as in `rve`"

/* A field is an expression or a table; `expression` and `table` are texts, read by muParser and as a file. */
#define TISSUE_FIELD(field, sample, expression_sample, unit_sample, words)                                             \
  {MAP("macro.fields." field), .default_words = "does not vary", .example = sample, .help = words},                    \
      {TEXT("macro.fields." field ".expression"), .default_words = "none: a table instead",                            \
       .example = expression_sample, .help = "Its number in the unit, of x and y in mm."},                             \
      {TEXT("macro.fields." field ".table"), .default_words = "none: an expression instead", .example = field ".csv",  \
       .help = "File beside the scene: a line of names, then lines x, y, value with the positions of a grid in mm."},  \
  {                                                                                                                    \
    TEXT("macro.fields." field ".unit"), REQUIRED, .example = unit_sample, .help = "Unit of its numbers."              \
  }

static const LamKey region_keys[] = {
    {LIST("macro.regions"), .default_words = "one tissue",
     .example = "[{name: skin, where: y > 9, cell: {wall_thickness: 20 um}}]",
     .help =
         "Parts of the body whose tissue is another; what an entry leaves out is as in `rve`. Where several cover a "
         "point the last one holds."},
    {MAP("macro.regions[]"), .example = "{name: skin, where: y > 9, cell: {wall_thickness: 20 um}}",
     .help = "One region."},
    {TEXT("macro.regions[].name"), REQUIRED, .example = "skin",
     .help = "Its name, of letters, digits, - and _: also of its database, DB.skin.h5."},
    {TEXT("macro.regions[].where"), .default_words = "the mesh's physical group of this name", .example = "y > 9",
     .help = "Expression of x and y in mm that holds (is not 0) in the region."},
    {MAP("macro.regions[].cell"), .example = "{wall_thickness: 20 um}", .help = "Its cell, as `rve.cell`."},
    {LENGTH("macro.regions[].cell.apothem", "um"), ABOVE(0), .default_words = AS_RVE, .example = "40 um",
     .help = "Apothem."},
    {LENGTH("macro.regions[].cell.wall_thickness", "um"), ABOVE(0), .default_words = AS_RVE, .example = "20 um",
     .help = "Thickness of one cell's wall."},
    {ANGLE("macro.regions[].cell.orientation"), FROM(-360), TO(360), .default_words = AS_RVE, .example = "30 deg",
     .help = "Angle of face normal 0 to the X1 axis."},
    {MAP("macro.regions[].wall"), .example = "{C1: 0.2 MPa}", .help = "Its wall, as `rve.wall`."},
    {NAME_OF("macro.regions[].wall.law", LamWallLawNames, LAM_WALL_LAW_COUNT), .default_words = AS_RVE,
     .example = "mooney_rivlin", .help = "Law of its wall."},
    {STRESS("macro.regions[].wall.C1"), ABOVE(0), .default_words = AS_RVE, .example = "0.2 MPa",
     .help = "First Mooney-Rivlin modulus."},
    {STRESS("macro.regions[].wall.C2"), FROM(0), .default_words = AS_RVE, .example = "0.02 MPa",
     .help = "Second Mooney-Rivlin modulus."},
    {STRESS("macro.regions[].wall.C4"), FROM(0), .default_words = AS_RVE, .example = "2 MPa", .help = "Fibre modulus."},
    {STRESS("macro.regions[].wall.bulk_modulus"), ABOVE(0), .default_words = AS_RVE ", in proportion to C1 + C2",
     .example = "220 MPa", .help = "Bulk modulus."},
    {NAME_OF("macro.regions[].wall.fibres", LamFibresNames, LAM_FIBRES_COUNT), .default_words = AS_RVE,
     .example = "tension", .help = "Whether fibres resist compression."},
    {MAP("macro.regions[].interface"), .example = "{law: bonded}", .help = "Its middle lamella, as `rve.interface`."},
    {NAME_OF("macro.regions[].interface.law", LamInterfaceLawNames, LAM_INTERFACE_LAW_COUNT), .default_words = AS_RVE,
     .example = "bonded", .help = "`bonded` or `contact`."},
    {STRESS("macro.regions[].interface.cohesion"), FROM(0), .default_words = AS_RVE, .example = "0.01 MPa",
     .help = "Cohesion; only with law `contact`."},
    {LENGTH("macro.regions[].interface.clearance", "um"), FROM(0), .default_words = AS_RVE, .example = "0.1 um",
     .help = "Distance between facing walls at rest; only with law `contact`."},
    {MAP("macro.regions[].turgor"), .example = "{pressure: 0.05 MPa}", .help = "Its turgor."},
    {STRESS("macro.regions[].turgor.pressure"), .default_words = AS_RVE, .example = "0.05 MPa", .help = "Pressure."},
    {MAP("macro.regions[].mesh"), .default_words = AS_RVE, .example = "{along: 6, through: 2}",
     .help = "Finite elements of its cell, as `rve.mesh`."},
    {INTEGER("macro.regions[].mesh.along"), FROM(1), TO(200), .default_words = AS_RVE, .example = "6",
     .help = "Elements along one face."},
    {INTEGER("macro.regions[].mesh.through"), FROM(1), TO(50), .default_words = AS_RVE, .example = "2",
     .help = "Elements through one wall."},
    {REAL("macro.regions[].mesh.grading"), FROM(0), BELOW(1), .default_words = AS_RVE, .example = "0.6",
     .help = "How much smaller elements at the ends of a face are."},
    {MAP("macro.fields"), .default_words = "nothing varies", .example = "{orientation: {expression: 3 * x, unit: deg}}",
     .help = "Numbers that vary with the reference position, replacing those of `rve` and `macro.regions`."},
    TISSUE_FIELD("orientation", "{expression: 3 * x, unit: deg}", "3 * x", "deg",
                 "Angle of face normal 0 to the X1 axis."),
    TISSUE_FIELD("turgor", "{table: turgor.csv, unit: MPa}", "0.05 * (1 - y / 10)", "MPa", "Turgor."),
    TISSUE_FIELD("cohesion", "{expression: 0.01 + 0.001 * y, unit: MPa}", "0.01 + 0.001 * y", "MPa",
                 "Cohesion, at least 0, of tissue with law `contact`."),
    TISSUE_FIELD("wall_thickness", "{expression: 11 + 0.2 * y, unit: um}", "11 + 0.2 * y", "um",
                 "Thickness of one cell's wall: a few thicknesses are solved, answers between them blended."),
    {INTEGER("macro.fields.wall_thickness.levels"), FROM(2), TO(8), .default_words = CHOSEN, .example = "5",
     .help = "How many thicknesses of each tissue are solved."},
};
LAM_KEY_TABLE(LamRegionKeys, region_keys);

#define ITEM "macro.regions[]"

/* ---- a region's tissue ---- */

/* *si stays as it is where the entry does not give it. */
static PetscErrorCode GetLength(const LamNode *entry, const char path[], const LamNode **node, PetscReal *si)
{
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, path, node, &value));
  if (*node) *si = value.number[0];
  PetscFunctionReturn(0);
}

/* What is not given is as long as in the scene's own tissue. */
static PetscErrorCode BuildCell(const LamDocument *document, const LamNode *entry, const LamScene *scene, LamRegion *r)
{
  PetscReal thickness = scene->micro.wall_thickness * scene->scales.length;
  const LamNode *apothem_node, *thickness_node, *node;
  LamValue orientation;

  PetscFunctionBeginUser;
  PetscCall(GetLength(entry, ITEM ".cell.apothem", &apothem_node, &r->scales.length));
  PetscCall(GetLength(entry, ITEM ".cell.wall_thickness", &thickness_node, &thickness));
  node = thickness_node ? thickness_node : apothem_node;
  if (apothem_node) PetscCall(LamSceneCheckScale(document, apothem_node, r->scales.length));
  if (node && thickness >= r->scales.length)
    PetscCall(LamSceneFail(document, node, "the wall, %g um, fills the cell; write a thickness less than the apothem",
                           (double)thickness * 1e6));
  PetscCall(LamSceneScale(document, node, thickness, r->scales.length, &r->micro.wall_thickness));
  PetscCall(LamSceneGet(entry, ITEM ".cell.orientation", &node, &orientation));
  if (node) r->micro.orientation = orientation.number[0];
  PetscFunctionReturn(0);
}

/* The region's own C1 + C2 is its unit of stress. */
static PetscErrorCode BuildWall(const LamDocument *document, const LamNode *entry, const LamScene *scene, LamRegion *r)
{
  LamWall *wall = &r->micro.wall;
  const LamNode *node;
  LamValue unused;
  PetscReal unit;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, ITEM ".wall", &node, &unused));
  if (!node) PetscFunctionReturn(0);
  PetscCall(LamSceneReadWall(document, entry, ITEM ".wall", scene->scales.stress, &scene->micro.wall, wall));
  unit = wall->C1 + wall->C2;
  PetscCall(LamSceneCheckScale(document, node, unit * scene->scales.stress));
  wall->C1 /= unit;
  wall->C2 /= unit;
  wall->C4 /= unit;
  wall->bulk_modulus /= unit;
  r->scales.stress *= unit;
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildInterface(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                     LamRegion *r)
{
  const LamNode *law_node, *cohesion_node, *clearance_node;
  PetscReal cohesion = scene->cohesion * scene->scales.stress,
            clearance = scene->micro.clearance * scene->scales.length;
  LamValue law, value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, ITEM ".interface.law", &law_node, &law));
  PetscCall(LamSceneGet(entry, ITEM ".interface.cohesion", &cohesion_node, &value));
  if (cohesion_node) cohesion = value.number[0];
  PetscCall(GetLength(entry, ITEM ".interface.clearance", &clearance_node, &clearance));
  if (law_node) r->micro.interface = (LamInterfaceLawType)law.number[0];
  if (r->micro.interface == LAM_INTERFACE_BONDED) {
    const LamNode *node = cohesion_node && cohesion > 0     ? cohesion_node
                          : clearance_node && clearance > 0 ? clearance_node
                                                            : NULL;

    if (node) PetscCall(LamSceneFail(document, node, "contradicts law: bonded, whose cells never part; leave it out"));
    cohesion = clearance = 0;
  }
  PetscCall(LamSceneScale(document, cohesion_node, cohesion, r->scales.stress, &r->cohesion));
  PetscCall(LamSceneScale(document, clearance_node, clearance, r->scales.length, &r->micro.clearance));
  PetscCall(LamSceneCheckClearance(document, clearance_node ? clearance_node : entry, &r->scales, &r->micro));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildTurgor(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                  LamRegion *r)
{
  PetscReal turgor = scene->turgor * scene->scales.stress;
  const LamNode *node;
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, ITEM ".turgor.pressure", &node, &value));
  if (node) {
    turgor = value.number[0];
    PetscCall(LamSceneCheckTurgor(document, node, turgor));
  }
  PetscCall(LamSceneScale(document, node, turgor, r->scales.stress, &r->turgor));
  PetscFunctionReturn(0);
}

/* Cells that differ have thicknesses and moduli of their own. */
static PetscErrorCode CheckVariation(const LamDocument *document, const LamNode *entry, const LamScene *scene)
{
  static const char *const own[] = {ITEM ".cell.apothem", ITEM ".cell.wall_thickness", ITEM ".wall"};
  LamValue unused;

  PetscFunctionBeginUser;
  for (size_t i = 0; scene->micro.cell && i < PETSC_STATIC_ARRAY_LENGTH(own); i++) {
    const LamNode *node;

    PetscCall(LamSceneGet(entry, own[i], &node, &unused));
    if (node)
      PetscCall(LamSceneFailName(document, node,
                                 "rve.variation says what the cells are, and it is the same in all regions; leave out "
                                 "one of them"));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildTissue(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                  LamRegion *r)
{
  const LamNode *node;
  LamValue along, through, grading;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureCopy(&scene->micro, &r->micro));
  r->scales = scene->scales;
  PetscCall(CheckVariation(document, entry, scene));
  PetscCall(BuildCell(document, entry, scene, r));
  PetscCall(BuildWall(document, entry, scene, r));
  PetscCall(BuildInterface(document, entry, scene, r));
  PetscCall(BuildTurgor(document, entry, scene, r));
  PetscCall(LamSceneGet(entry, ITEM ".mesh.along", &node, &along));
  if (node) r->micro.along = (PetscInt)along.number[0];
  PetscCall(LamSceneGet(entry, ITEM ".mesh.through", &node, &through));
  if (node) r->micro.through = (PetscInt)through.number[0];
  PetscCall(LamSceneGet(entry, ITEM ".mesh.grading", &node, &grading));
  if (node) r->micro.grading = grading.number[0];
  if (r->micro.along && r->micro.grading < 0.0) r->micro.grading = 0.0;
  PetscFunctionReturn(0);
}

/* ---- where it lies ---- */

/* What messages call a field: file, line, key. */
static void NameField(const LamDocument *document, const LamNode *node, const char key[], char name[PETSC_MAX_PATH_LEN])
{
  snprintf(name, PETSC_MAX_PATH_LEN, "%s:%d: %s", document->name, node->line, key);
}

static PetscErrorCode ReadExpression(const LamDocument *document, const LamNode *node, const char key[],
                                     LamPlaceField *field)
{
  char name[PETSC_MAX_PATH_LEN], reason[LAM_PLACE_FIELD_REASON];

  PetscFunctionBeginUser;
  NameField(document, node, key, name);
  PetscCall(LamPlaceFieldFromExpression(name, node->text, field, reason));
  if (reason[0]) PetscCall(LamSceneFail(document, node, "%s", reason));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildPlace(const LamDocument *document, const LamNode *entry, const LamScene *scene, LamRegion *r)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  const LamNode *name_node, *where_node;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, ITEM ".name", &name_node, &unused));
  PetscCall(LamSceneGet(entry, ITEM ".where", &where_node, &unused));
  if (!name_node->text[0] || strlen(name_node->text) >= sizeof(r->name) ||
      strspn(name_node->text, letters) != strlen(name_node->text))
    PetscCall(LamSceneFail(document, name_node,
                           "is part of a file's name; write letters, digits, - and _, less than %d",
                           (int)sizeof(r->name)));
  for (PetscInt k = 0; k < scene->region_count; k++)
    if (!strcmp(scene->regions[k].name, name_node->text))
      PetscCall(LamSceneFail(document, name_node, "another region has this name; give each its own"));
  PetscCall(PetscStrncpy(r->name, name_node->text, sizeof(r->name)));
  if (where_node) PetscCall(ReadExpression(document, where_node, ITEM ".where", &r->where));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildAllRegions(const LamDocument *document, const LamNode *list, LamScene *scene)
{
  PetscFunctionBeginUser;
  if (list->count > LAM_MAX_REGIONS)
    PetscCall(LamSceneFail(document, list, "has %d regions; at most %d can be told apart", (int)list->count,
                           (int)LAM_MAX_REGIONS));
  PetscCall(PetscCalloc1(LAM_MAX_REGIONS, &scene->regions));
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    LamRegion *region = &scene->regions[scene->region_count];

    PetscCall(BuildPlace(document, entry, scene, region));
    scene->region_count++;
    PetscCall(BuildTissue(document, entry, scene, region));
  }
  PetscFunctionReturn(0);
}

/* ---- fields ---- */

static const LamDimension dimensions[] = {LAM_DIMENSION_ANGLE, LAM_DIMENSION_STRESS, LAM_DIMENSION_STRESS,
                                          LAM_DIMENSION_LENGTH};

/* A table lies beside the scene, unless its path is a whole one. */
static PetscErrorCode ReadTable(const LamDocument *document, const LamNode *node, const char key[],
                                LamPlaceField *field)
{
  const char *slash = strrchr(document->name, '/');
  const int folder = slash && node->text[0] != '/' ? (int)(slash - document->name) + 1 : 0;
  char name[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], reason[LAM_PLACE_FIELD_REASON];

  PetscFunctionBeginUser;
  NameField(document, node, key, name);
  snprintf(path, sizeof(path), "%.*s%s", folder, document->name, node->text);
  PetscCall(LamPlaceFieldFromTable(name, path, field, reason));
  if (reason[0]) PetscCall(LamSceneFail(document, node, "%s", reason));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadUnit(const LamDocument *document, const LamNode *node, LamDimension dimension, PetscReal *si)
{
  char one[80], reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  snprintf(one, sizeof(one), "1 %.70s", node->text);
  PetscCall(LamQuantityRead(one, dimension, si, reason));
  if (reason[0])
    PetscCall(LamSceneFail(document, node, "%s; write the unit of a %s alone", reason, LamDimensionNames[dimension]));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildField(const LamDocument *document, LamTissueField which, LamScene *scene)
{
  LamTissueFields *fields = &scene->fields;
  const LamNode *block, *nodes[3];
  static const char *const keys[] = {"expression", "table", "unit"};
  char paths[3][80], path[80];
  LamValue unused;

  PetscFunctionBeginUser;
  snprintf(path, sizeof(path), "macro.fields.%s", LamTissueFieldNames[which]);
  PetscCall(LamSceneGet(document->root, path, &block, &unused));
  if (!block) PetscFunctionReturn(0);
  for (int i = 0; i < 3; i++) {
    snprintf(paths[i], sizeof(paths[i]), "macro.fields.%s.%s", LamTissueFieldNames[which], keys[i]);
    PetscCall(LamSceneGet(document->root, paths[i], &nodes[i], &unused));
  }
  if (nodes[0] && nodes[1])
    PetscCall(LamSceneFailName(document, nodes[1], "given together with expression; a field is one of them"));
  if (!nodes[0] && !nodes[1])
    PetscCall(LamSceneFailMissing(document, block, "expression", "missing; write one of x and y in mm, or a table"));
  PetscCall(ReadUnit(document, nodes[2], dimensions[which], &fields->unit[which]));
  if (nodes[0])
    PetscCall(ReadExpression(document, nodes[0], paths[0], &fields->value[which]));
  else
    PetscCall(ReadTable(document, nodes[1], paths[1], &fields->value[which]));
  if (which == LAM_TISSUE_WALL_THICKNESS && scene->micro.cell)
    PetscCall(LamSceneFailName(document, block, "rve.variation gives each cell its thickness; leave out one of them"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildRegions(const LamDocument *document, LamScene *scene)
{
  const LamNode *list;
  LamValue unused, levels;

  PetscFunctionBeginUser;
  if (!scene->has_macro) PetscFunctionReturn(0);
  PetscCall(LamSceneGet(document->root, "macro.regions", &list, &unused));
  if (list) PetscCall(BuildAllRegions(document, list, scene));
  for (LamTissueField k = 0; k < LAM_TISSUE_FIELD_COUNT; k++) PetscCall(BuildField(document, k, scene));
  PetscCall(LamSceneGet(document->root, "macro.fields.wall_thickness.levels", NULL, &levels));
  scene->fields.levels = (PetscInt)levels.number[0];
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneDestroyRegions(LamScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; scene->regions && k < LAM_MAX_REGIONS; k++) {
    LamRegion *region = &scene->regions[k];

    PetscCall(LamPlaceFieldDestroy(&region->where));
    PetscCall(LamMicrostructureDestroy(&region->micro));
  }
  PetscCall(PetscFree(scene->regions));
  for (int k = 0; k < LAM_TISSUE_FIELD_COUNT; k++) PetscCall(LamPlaceFieldDestroy(&scene->fields.value[k]));
  PetscFunctionReturn(0);
}
