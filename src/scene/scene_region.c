/*
  `macro.regions` and `macro.fields` of a scene: tissue that varies with the position.
*/
#include "scene_rows.h"
#include "quantity_text.h"
#include <math.h>
#include <string.h>

const char *const LamTissueFieldNames[] = {LAM_TISSUE_FIELDS(LAM_NAME_ENTRY)};

#define AS_RVE "as in `rve`"

/* A field is an expression or a table; both are texts: `expression` for muParser, `table` a file name. */
#define TISSUE_FIELD(field, sample, expression_sample, unit_sample, words)                                             \
  {MAP("macro.fields." field), .default_words = "does not vary", .example = sample, .help = words},                    \
      {TEXT("macro.fields." field ".expression"), .default_words = "none: a table instead",                            \
       .example = expression_sample, .help = "Its number in the unit, of x and y in mm."},                             \
      {PATH("macro.fields." field ".table"), .default_words = "none: an expression instead", .example = field ".csv",  \
       .help = "File beside the scene: a line of names, then lines x, y, value with the positions of a grid in mm."},  \
  {                                                                                                                    \
    TEXT("macro.fields." field ".unit"), REQUIRED, .example = unit_sample, .help = "Unit of its numbers."              \
  }

static const LamKey region_keys[] = {
    {LIST("macro.regions"), .default_words = "one tissue",
     .example = "[{name: skin, where: y > 9, cell: {wall_thickness: 20 um}}]",
     .help = "Parts of the body whose tissue is another; what an entry leaves out is as in `rve`. Where several cover "
             "a point the last one holds."},
    {MAP("macro.regions[]"), .example = "{name: skin, where: y > 9, cell: {wall_thickness: 20 um}}",
     .help = "One region."},
    {TEXT("macro.regions[].name"), INTO(LamRegion, name), REQUIRED, .example = "skin",
     .help = "Its name, of letters, digits, - and _: also of its database, DB.skin.h5."},
    {TEXT("macro.regions[].where"), .default_words = "the mesh's physical group of this name", .example = "y > 9",
     .help = "Expression of x and y in mm that holds (is not 0) in the region."},
    {PATH("macro.regions[].tissue"), INTO(LamRegion, tissue), .default_words = AS_RVE, .example = "skin.json",
     .help = "File of its own cells, instead of hexagons or of the file of `rve`; they have a period and one class."},
    {MAP("macro.regions[].cell"), .example = "{wall_thickness: 20 um}", .help = "Its cell, as `rve.cell`."},
    {LENGTH("macro.regions[].cell.apothem", "um"), ABOVE(0), .default_words = AS_RVE, .example = "40 um",
     .help = "Apothem, of hexagons."},
    {LENGTH("macro.regions[].cell.wall_thickness", "um"), INTO(LamRegion, micro.wall_thickness), ABOVE(0),
     .default_words = AS_RVE, .example = "20 um",
     .help = "Thickness of one cell's wall, unless a file of cells gives it."},
    {LENGTH("macro.regions[].cell.length", "um"), INTO(LamRegion, micro.length), ABOVE(0), .default_words = AS_RVE,
     .example = "100 um", .help = "Length of its cells, as `rve.cell.length`."},
    {ANGLE("macro.regions[].cell.orientation"), INTO(LamRegion, micro.orientation), FROM(-360), TO(360),
     .default_words = AS_RVE "; of a file of its own 0 deg", .example = "30 deg",
     .help = "Angle of face normal 0 to the X1 axis: the cells of a region, also of a file, are turned."},
    {MAP("macro.regions[].wall"), .example = "{C1: 0.2 MPa}", .help = "Its wall, as `rve.wall`."},
    LAM_OTHER_WALL("macro.regions[].wall", AS_RVE),
    {MAP("macro.regions[].interface"), .example = "{law: bonded}", .help = "Its middle lamella, as `rve.interface`."},
    {NAME_OF("macro.regions[].interface.law", LamInterfaceLawNames, LAM_INTERFACE_LAW_COUNT),
     INTO(LamRegion, micro.interface), .default_words = AS_RVE,
     .help = "`bonded`, `contact`, or `lamella` where `rve` has it, too."},
    {STRESS("macro.regions[].interface.cohesion"), INTO(LamRegion, cohesion), FROM(0), .default_words = AS_RVE,
     .example = "0.01 MPa", .help = "Cohesion; only with law `contact`."},
    {LENGTH("macro.regions[].interface.clearance", "um"), INTO(LamRegion, micro.clearance), FROM(0),
     .default_words = AS_RVE, .example = "0.1 um",
     .help = "Distance between facing walls at rest; only with law `contact`."},
    {STRESS("macro.regions[].interface.strength"), INTO(LamRegion, micro.lamella.strength), ABOVE(0),
     .default_words = AS_RVE, .example = "0.03 MPa",
     .help = "Strength of its lamella; that in shear is in proportion. Only with law `lamella`, whose other keys are "
             "those of `rve`."},
    {AREAL_ENERGY("macro.regions[].interface.fracture_energy"), INTO(LamRegion, micro.lamella.energy), ABOVE(0),
     .default_words = AS_RVE, .example = "0.5 J/m^2", .help = "Its energy of fracture, likewise."},
    {MAP("macro.regions[].turgor"), .example = "{pressure: 0.05 MPa}", .help = "Its turgor."},
    {STRESS("macro.regions[].turgor.pressure"), INTO(LamRegion, turgor), .default_words = AS_RVE, .example = "0.05 MPa",
     .help = "Pressure."},
    {MAP("macro.regions[].mesh"), .default_words = AS_RVE, .example = "{along: 6, through: 2}",
     .help = "Finite elements of its cell, as `rve.mesh`."},
    {INTEGER("macro.regions[].mesh.along"), INTO(LamRegion, micro.along), FROM(1), TO(200), .default_words = AS_RVE,
     .example = "6", .help = "Elements along one face."},
    {INTEGER("macro.regions[].mesh.through"), INTO(LamRegion, micro.through), FROM(1), TO(50), .default_words = AS_RVE,
     .example = "2", .help = "Elements through one wall."},
    {REAL("macro.regions[].mesh.grading"), INTO(LamRegion, micro.grading), FROM(0), BELOW(1), .default_words = AS_RVE,
     .example = "0.6", .help = "How much smaller elements at the ends of a face are."},
    {MAP("macro.fields"), .default_words = "nothing varies", .example = "{orientation: {expression: 3 * x, unit: deg}}",
     .help = "Numbers that vary with the reference position, replacing those of `rve` and `macro.regions`."},
    TISSUE_FIELD("orientation", "{expression: 3 * x, unit: deg}", "3 * x", "deg",
                 "Angle of face normal 0 to the X1 axis: the cells of a point, also of a file, are turned."),
    TISSUE_FIELD("turgor", "{table: turgor.csv, unit: MPa}", "0.05 * (1 - y / 10)", "MPa", "Turgor."),
    TISSUE_FIELD("cohesion", "{expression: 0.01 + 0.001 * y, unit: MPa}", "0.01 + 0.001 * y", "MPa",
                 "Cohesion, at least 0, of tissue with law `contact`; the residual one with law `lamella`."),
    TISSUE_FIELD("wall_thickness", "{expression: 11 + 0.2 * y, unit: um}", "11 + 0.2 * y", "um",
                 "Thickness of one cell's wall: a few thicknesses are solved, responses between them blended."),
    {INTEGER("macro.fields.wall_thickness.levels"), INTO(LamTissueFields, levels), FROM(2), TO(8),
     .default_words = CHOSEN, .example = "5", .help = "How many thicknesses of each tissue are solved."},
};
LAM_KEY_TABLE(LamRegionKeys, region_keys);

/* ---- a region's tissue ---- */

/* The region's own apothem and C1 + C2 are its units. */
static PetscErrorCode BuildScales(const LamNode *entry, const LamScene *scene, LamRegion *r)
{
  const LamNode *apothem = LamNodeFind(entry, "cell.apothem"), *node = LamNodeFind(entry, "wall");
  LamWall *wall = &r->micro.wall;
  PetscReal unit;

  PetscFunctionBeginUser;
  if (apothem) {
    r->scales.length = apothem->value.number[0];
    PetscCall(LamSceneCheckScale(apothem, r->scales.length));
  }
  if (!node) PetscFunctionReturn(0);
  PetscCall(LamSceneReadWall(node, &scene->scales, &scene->micro.wall, wall));
  unit = wall->C1 + wall->C2;
  PetscCall(LamSceneCheckScale(node, unit * scene->scales.stress));
  LamWallScale(wall, 1.0, unit);
  r->scales.stress *= unit;
  for (PetscInt c = 0; r->micro.cell && c < r->micro.cells[0]; c++) r->micro.cell[c].wall = *wall; /* of a file */
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckTissue(const LamNode *entry, LamRegion *r)
{
  const LamNode *apothem = LamNodeFind(entry, "cell.apothem"), *thickness = LamNodeFind(entry, "cell.wall_thickness");
  const LamNode *clearance = LamNodeFind(entry, "interface.clearance"), *turgor = LamNodeFind(entry, "turgor.pressure");
  const LamNode *length = LamNodeFind(entry, "cell.length");

  PetscFunctionBeginUser;
  LamSceneCheck(r->micro.wall_thickness < 1.0,
                thickness ? thickness
                : apothem ? apothem
                          : entry,
                "the wall, %g um, fills the cell; write a thickness less than the apothem",
                (double)(r->micro.wall_thickness * r->scales.length) * 1e6);
  PetscCall(LamSceneCheckLaw(LamNodeFind(entry, "interface"), r->micro.interface));
  if (!LamCellsPart(r->micro.interface)) r->cohesion = r->micro.clearance = 0;
  PetscCall(LamSceneCheckClearance(clearance ? clearance : entry, &r->scales, &r->micro));
  PetscCall(LamSceneCheckLength(length ? length : entry, &r->micro));
  if (turgor) PetscCall(LamSceneCheckTurgor(turgor, turgor->value.number[0]));
  PetscFunctionReturn(0);
}

/* Refuses what rve.variation says of each cell, and what the file of rve.tissue does. */
static PetscErrorCode CheckCells(const LamNode *entry, const LamScene *scene)
{
  static const char *const keys[] = {"cell.apothem", "cell.wall_thickness", "wall", "tissue"};
  const LamNode *root = entry->document->root, *file = LamNodeFind(root, "rve.tissue");
  const PetscBool varies = (PetscBool)(LamNodeFind(root, "rve.variation") && scene->micro.cell);
  const PetscBool has[] = {(PetscBool)(file != NULL), (PetscBool)(file && scene->micro.cell), PETSC_FALSE, PETSC_FALSE};
  const PetscBool own = (PetscBool)(LamNodeFind(entry, "tissue") != NULL);

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(keys); i++) {
    const LamNode *node = LamNodeFind(entry, keys[i]);

    LamSceneCheckName(!node || !varies, node,
                      "rve.variation says what the cells are, and it is the same in all regions; leave out one of "
                      "them");
    LamSceneCheckName(!node || own || !has[i], node,
                      "the cells of this region are those of the file of rve.tissue (line %d), which says it; leave it "
                      "out, or name a file of its own",
                      file->name_line);
  }
  PetscFunctionReturn(0);
}

/* What the region does not say is that of the scene's own lamella: `own`, in the region's units. */
static PetscErrorCode BuildLamella(const LamNode *entry, const LamScene *scene, const LamLamella *own, LamRegion *r)
{
  const LamNode *stiffness = LamNodeFind(entry->document->root, "rve.interface.stiffness");
  const LamNode *energy = LamNodeFind(entry, "interface.fracture_energy"), *law = LamNodeFind(entry, "interface.law");
  LamLamella *lamella = &r->micro.lamella;

  PetscFunctionBeginUser;
  if (r->micro.interface != LAM_INTERFACE_LAMELLA) PetscFunctionReturn(0);
  LamSceneCheck(scene->micro.interface == LAM_INTERFACE_LAMELLA, law,
                "a region has the lamella of rve.interface, with its own strength and fracture_energy; write law: "
                "lamella there, too");
  lamella->shear_strength *= lamella->strength / own->strength;
  lamella->shear_energy *= lamella->energy / own->energy;
  if (!energy) energy = entry;
  LamSceneCheck(lamella->junction_length * sqrt(3.0) <= 1.0 + 1e-12, entry,
                "rve.interface.junction.length is more than half a face of its cell; write it shorter there");
  PetscCall(LamSceneSetStiffness(stiffness ? energy : NULL, energy, &r->scales, &r->micro));
  PetscFunctionReturn(0);
}

/* Other units: lengths and stresses are multiplied by these. */
static void ScaleLamella(PetscReal length, PetscReal stress, LamLamella *lamella)
{
  lamella->strength *= stress;
  lamella->shear_strength *= stress;
  lamella->energy *= stress * length;
  lamella->shear_energy *= stress * length;
  lamella->stiffness *= stress / length;
  lamella->junction_length *= length;
}

static void ScaleTearing(PetscReal length, PetscReal stress, LamTearing *tearing)
{
  tearing->strength *= stress;
  tearing->energy *= stress * length;
}

/* Missing lengths and moduli have the same physical value as in the scene's own tissue. */
static PetscErrorCode FillTissue(const LamNode *entry, const LamScene *scene, LamSceneTissue *file, LamRegion *r)
{
  const LamScales *own = &scene->scales, *scales = &r->scales;
  LamMicrostructure *micro = &r->micro;
  LamLamella lamella;

  PetscFunctionBeginUser;
  PetscCall(LamSceneReadRegionTissue(entry, r, file));
  PetscCall(BuildScales(entry, scene, r));
  micro->wall_thickness = micro->wall_thickness * own->length / scales->length;
  micro->length = micro->length * own->length / scales->length;
  micro->clearance = micro->clearance * own->length / scales->length;
  ScaleLamella(own->length / scales->length, own->stress / scales->stress, &micro->lamella);
  ScaleTearing(own->length / scales->length, own->stress / scales->stress, &micro->tearing);
  lamella = micro->lamella;
  r->cohesion = scene->cohesion * own->stress / scales->stress;
  r->turgor = scene->turgor * own->stress / scales->stress;
  PetscCall(LamSceneFill(entry, scales, LamRegion, r));
  PetscCall(LamSceneBuildTissue(LamNodeFind(entry, "tissue"), file, scales, micro));
  if (file->thickness)
    PetscCall(LamSceneSetThickness(LamNodeFind(entry, "tissue"), file->thickness, scales->length, micro));
  PetscCall(CheckTissue(entry, r));
  PetscCall(BuildLamella(entry, scene, &lamella, r));
  PetscCall(LamSceneCheckTearing(entry, LamNodeFind(entry, "mesh.along"), micro));
  if (micro->along && micro->grading < 0.0) micro->grading = 0.0;
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildTissue(const LamNode *entry, const LamScene *scene, LamRegion *r)
{
  LamSceneTissue file = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(CheckCells(entry, scene));
  PetscCall(LamMicrostructureCopy(&scene->micro, &r->micro));
  r->scales = scene->scales;
  r->reference = scene->micro.orientation;
  ierr = FillTissue(entry, scene, &file, r);
  PetscCall(LamSceneDestroyTissue(&file));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- location ---- */

/* An expression of x and y in mm, or the file name of a table. */
static PetscErrorCode ReadField(const LamNode *node, LamPlaceField *field)
{
  char name[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], reason[LAM_PLACE_FIELD_REASON];

  PetscFunctionBeginUser;
  snprintf(name, sizeof(name), "%s:%d: %s", node->document->name, node->line, node->key->path);
  if (node->key->type == LAM_KEY_PATH) {
    PetscCall(LamSceneResolvePath(node, path));
    PetscCall(LamPlaceFieldFromTable(name, path, field, reason));
  } else {
    PetscCall(LamPlaceFieldFromExpression(name, node->text, field, reason));
  }
  LamSceneCheck(!reason[0], node, "%s", reason);
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildPlace(const LamNode *entry, const LamScene *scene, LamRegion *r)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  const LamNode *name = LamNodeFind(entry, "name"), *where = LamNodeFind(entry, "where");

  PetscFunctionBeginUser;
  LamSceneCheck(name->text[0] && strlen(name->text) < sizeof(r->name) &&
                    strspn(name->text, letters) == strlen(name->text),
                name, "is part of a file's name; write letters, digits, - and _, less than %d", (int)sizeof(r->name));
  for (PetscInt k = 0; k < scene->region_count; k++)
    LamSceneCheck(strcmp(scene->regions[k].name, name->text), name, "another region has this name; give each its own");
  PetscCall(PetscStrncpy(r->name, name->text, sizeof(r->name)));
  r->place = LamNodePlace(where ? where : name);
  if (where) PetscCall(ReadField(where, &r->where));
  PetscFunctionReturn(0);
}

/* ---- fields ---- */

static PetscErrorCode BuildField(const LamNode *block, LamTissueField which, LamScene *scene)
{
  static const LamDimension dimensions[] = {LAM_DIMENSION_ANGLE, LAM_DIMENSION_STRESS, LAM_DIMENSION_STRESS,
                                            LAM_DIMENSION_LENGTH};
  const LamNode *expression = LamNodeFind(block, "expression"), *table = LamNodeFind(block, "table");
  const LamNode *field = expression ? expression : table, *unit = LamNodeFind(block, "unit");
  char one[80], reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  LamSceneCheckName(!expression || !table, table, "given together with expression; a field is one of them");
  LamSceneRequire(field, block, "expression", "missing; write one of x and y in mm, or a table");
  snprintf(one, sizeof(one), "1 %.70s", unit->text);
  PetscCall(LamQuantityRead(one, dimensions[which], &scene->fields.unit[which], reason));
  LamSceneCheck(!reason[0], unit, "%s; write the unit of a %s alone", reason, LamDimensionNames[dimensions[which]]);
  PetscCall(ReadField(field, &scene->fields.value[which]));
  scene->fields.place[which] = LamNodePlace(field);
  for (PetscInt r = -1; which == LAM_TISSUE_WALL_THICKNESS && r < scene->region_count; r++)
    LamSceneCheckName(!(r < 0 ? scene->micro.cell : scene->regions[r].micro.cell), block,
                      "rve.variation, or the file of a tissue, gives each cell its thickness; leave out one of them");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildRegions(const LamNode *root, LamScene *scene)
{
  const LamNode *list = LamNodeFind(root, "macro.regions");

  PetscFunctionBeginUser;
  if (!scene->has_macro) PetscFunctionReturn(0);
  if (list) PetscCall(PetscCalloc1(LAM_MAX_REGIONS, &scene->regions));
  LamSceneCheck(!list || list->count <= LAM_MAX_REGIONS, list, "has %d regions; at most %d can be distinguished",
                (int)list->count, (int)LAM_MAX_REGIONS);
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) {
    LamRegion *region = &scene->regions[scene->region_count];

    PetscCall(BuildPlace(entry, scene, region));
    scene->region_count++;
    PetscCall(BuildTissue(entry, scene, region));
  }
  for (LamTissueField k = 0; k < LAM_TISSUE_FIELD_COUNT; k++) {
    const LamNode *field = LamNodeFind(LamNodeFind(root, "macro.fields"), LamTissueFieldNames[k]);

    if (field) PetscCall(BuildField(field, k, scene));
  }
  PetscCall(LamSceneFill(root, &scene->scales, LamTissueFields, &scene->fields));
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
