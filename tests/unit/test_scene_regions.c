/* What the regions and fields of a scene become. */
#include "support/test.h"
#include <lamella/tissue.h>
#include <stdlib.h>
#include <unistd.h>
#include "unit/test_scene.h"
#include "unit/test_scene_message.h"

#define SCENE                                                                                                          \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um, orientation: 10 deg}\n"                                          \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  interface: {law: contact, cohesion: 0.011 MPa, clearance: 0.75 um}\n"                                             \
  "  turgor: {pressure: 0.022 MPa}\n"                                                                                  \
  "  mesh: {along: 6, through: 2}\n"                                                                                   \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                                  \
  "  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]\n"

TEST(what_a_region_leaves_out_is_the_scene_s)
{
  OwnedScene *scene = Read(SCENE "  regions: [{name: core}]\n");
  const LamRegion *region = scene->regions;

  assert_int_equal(scene->region_count, 1);
  assert_string_equal(region->name, "core");
  assert_null(region->where);
  assert_memory_equal(&region->micro, &scene->micro, sizeof(region->micro));
  assert_memory_equal(&region->scales, &scene->scales, sizeof(region->scales));
  assert_near(region->turgor, scene->turgor, 0);
  assert_near(region->cohesion, scene->cohesion, 0);
}

TEST(a_region_is_measured_in_its_own_units)
{
  OwnedScene *scene =
      Read(SCENE "  regions: [{name: skin, where: y > 9, cell: {apothem: 30 um}, wall: {C1: 0.2 MPa, C2: 0.02 MPa}, "
                 "turgor: {pressure: 0.044 MPa}, mesh: {along: 12}}]\n");
  const LamRegion *region = scene->regions;

  assert_non_null(region->where);
  assert_near(region->scales.length, 30e-6, 1e-18);
  assert_near(region->scales.stress, 0.22e6, 1e-6);
  assert_near(region->micro.wall_thickness, 11.25 / 30, 1e-14);
  assert_near(region->micro.clearance, 0.75 / 30, 1e-14);
  assert_near(region->micro.wall.C1 + region->micro.wall.C2, 1, 1e-14);
  assert_near(region->micro.wall.C4, 1 / 0.22, 1e-13);
  assert_near(region->micro.wall.bulk_modulus, 1000, 1e-9);
  assert_near(region->turgor, 0.2, 1e-14);
  assert_near(region->cohesion, 0.05, 1e-14);
  assert_int_equal(region->micro.along, 12);
  assert_int_equal(region->micro.through, 2);
}

TEST(a_bonded_region_has_no_cohesion)
{
  OwnedScene *scene = Read(SCENE "  regions: [{name: skin, interface: {law: bonded}}]\n");

  assert_int_equal(scene->regions[0].micro.interface, LAM_INTERFACE_BONDED);
  assert_near(scene->regions[0].cohesion, 0, 0);
  assert_near(scene->regions[0].micro.clearance, 0, 0);
}

TEST(fields_have_units)
{
  const PetscReal X[2] = {4, 5};
  OwnedScene *scene = Read(SCENE "  fields:\n"
                                 "    orientation: {expression: 3 * x, unit: deg}\n"
                                 "    turgor: {expression: 0.01 * y, unit: MPa}\n"
                                 "    wall_thickness: {expression: 11, unit: um, levels: 5}\n");
  const LamTissueFields *fields = &scene->fields;
  PetscReal value;

  assert_int_equal(LamPlaceFieldEvaluate(fields->value[LAM_TISSUE_ORIENTATION], X, &value), 0);
  assert_near(value * fields->unit[LAM_TISSUE_ORIENTATION], PETSC_PI / 15, 1e-14);
  assert_int_equal(LamPlaceFieldEvaluate(fields->value[LAM_TISSUE_TURGOR], X, &value), 0);
  assert_near(value * fields->unit[LAM_TISSUE_TURGOR], 50e3, 1e-9);
  assert_null(fields->value[LAM_TISSUE_COHESION]);
  assert_near(fields->unit[LAM_TISSUE_WALL_THICKNESS], 1e-6, 1e-20);
  assert_int_equal(fields->levels, 5);
}

/* ---- cells of a file ---- */

/* One hexagon of apothem 30 um, a corner at X1, with more keys. */
#define FILE_OF_A_HEXAGON                                                                                              \
  "{\"lamella_tissue\": 1, \"unit\": \"um\", \"vertices\": [[34.64101615137754, 0], [17.32050807568877, 30], "         \
  "[-17.32050807568877, 30], [-34.64101615137754, 0], [-17.32050807568877, -30], [17.32050807568877, -30]], "          \
  "\"cells\": [[0, 1, 2, 3, 4, 5]], "
#define PERIOD "\"period\": [[51.96152422706631, 30], [0, 60]]"

/* Writes a file and returns its name. */
static const char *File(const char more[])
{
  static char path[64];
  FILE *file;

  snprintf(path, sizeof(path), "/tmp/lamella-region-XXXXXX");
  file = fdopen(mkstemp(path), "w");
  fprintf(file, "%s%s}", FILE_OF_A_HEXAGON, more);
  fclose(file);
  return path;
}

/* The scene with the text, in which %s is the name of the file. */
static PetscErrorCode ReadWith(const char more[], const char text[], LamScene **scene)
{
  const char *path = File(more);
  char whole[2000];
  PetscErrorCode error;

  snprintf(whole, sizeof(whole), text, path);
  CATCH(LamSceneReadText("scene.yaml", whole, scene), error);
  unlink(path);
  return error;
}

TEST(a_region_has_the_cells_and_the_scale_of_its_file)
{
  OwnedScene *scene = NULL;
  const LamRegion *region;

  CHECK(ReadWith(PERIOD ", \"wall_thickness\": 6",
                 SCENE "  regions: [{name: skin, where: y > 9, tissue: %s, cell: {orientation: 20 deg}}]\n", &scene));
  region = scene->regions;
  assert_null(scene->micro.tissue);
  assert_int_equal(region->micro.tissue->cells, 1);
  assert_near(region->scales.length, 30e-6, 1e-17);
  assert_near(region->micro.wall_thickness, 0.2, 1e-12);
  assert_near(region->micro.clearance, 0.75 / 30, 1e-12);
  assert_near(region->micro.orientation, PETSC_PI / 9, 1e-14);
  assert_near(region->reference, 0, 0);
}

TEST(a_region_without_a_file_has_that_of_the_scene)
{
  OwnedScene *scene = NULL;

  CHECK(ReadWith(PERIOD ", \"wall_thickness\": [[6, 6, 6, 6, 6, 5]]",
                 "version: 1\n"
                 "rve:\n"
                 "  tissue: %s\n" WALL "macro:\n"
                 "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"
                 "  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}]\n"
                 "  regions: [{name: skin, where: y > 9, wall: {C1: 0.2 MPa}}]\n",
                 &scene));
  assert_true(LamTissuesAgree(scene->regions[0].micro.tissue, scene->micro.tissue, 0));
  assert_ptr_not_equal(scene->regions[0].micro.tissue, scene->micro.tissue);
}

TEST(walls_of_a_file_that_differ_are_of_the_region)
{
  OwnedScene *scene = NULL;
  const LamMicrostructure *micro;

  CHECK(ReadWith("\"period\": [[51.96152422706631, 30], [0, 60]], \"wall_thickness\": [6]",
                 SCENE "  regions: [{name: skin, where: y > 9, tissue: %s, wall: {C1: 0.3 MPa}}]\n", &scene));
  micro = &scene->regions[0].micro;
  assert_null(micro->cell);
  assert_near(micro->wall.C1, 0.3 / 0.31, 1e-12);
}

TEST(mistakes_of_files_of_regions_are_named)
{
#define REGION(keys) SCENE "  regions: [{name: a, where: x > 1, tissue: %s" keys "}]\n"
#define VARIED                                                                                                         \
  "version: 1\n"                                                                                                       \
  "rve:\n  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n" WALL "  cells: [1, 2]\n"                                \
  "  variation: {kinds: [{wall_thickness: 9 um}], list: [0, 1]}\n"                                                     \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                                  \
  "  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}]\n"
#define OF_THE_FILE                                                                                                    \
  "version: 1\n"                                                                                                       \
  "rve:\n  tissue: %s\n" WALL "macro:\n"                                                                               \
  "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                                  \
  "  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}]\n"
  static const struct {
    const char *file, *text, *fragment;
  } bad[] = {
      {PERIOD ", \"wall_thickness\": 6", REGION(", cell: {apothem: 40 um}"),
       "macro.regions[0].cell.apothem: given together with tissue"},
      {PERIOD ", \"wall_thickness\": 6", REGION(", cell: {wall_thickness: 4 um}"), "has the cells and their walls"},
      {PERIOD ", \"wall_thickness\": 40", REGION(""), "macro.regions[0].tissue"},
      {PERIOD, REGION(", cell: {wall_thickness: 31 um}"), "the walls, 31 um, fill cells"},
      {PERIOD ", \"classes\": [1]", REGION(""), "cell 0 is of class 1"},
      {"\"wall_thickness\": 6", REGION(""), "is a patch between grips, no material point"},
      {PERIOD, VARIED "  regions: [{name: a, where: x > 1, tissue: %s}]\n", "rve.variation says what the cells are"},
      {PERIOD ", \"wall_thickness\": 6", OF_THE_FILE "  regions: [{name: a, where: x > 1, cell: {apothem: 40 um}}]\n",
       "the cells of this region are those of the file of rve.tissue (line 3)"},
      {"\"wall_thickness\": 6", OF_THE_FILE, "a patch (line 3) is a body between grips"},
  };

  for (size_t i = 0; i < sizeof(bad) / sizeof(*bad); i++) {
    LamScene *scene;

    assert_int_equal(ReadWith(bad[i].file, bad[i].text, &scene), PETSC_ERR_USER_INPUT);
    if (!strstr(scene_message, bad[i].fragment)) fail_msg("\"%s\" lacks \"%s\"", scene_message, bad[i].fragment);
  }
}

TEST(mistakes_are_named)
{
  static const struct {
    const char *text, *fragment;
  } bad[] = {
      {"  regions: [{where: y > 9}]\n", "macro.regions[0].name: missing"},
      {"  regions: [{name: a/b}]\n", "part of a file's name"},
      {"  regions: [{name: a}, {name: a}]\n", "another region has this name"},
      {"  regions: [{name: a, where: y >}]\n", "is no expression of x and y"},
      {"  regions: [{name: a, tissue: nowhere.json}]\n", "nowhere.json: the tissue cannot be read"},
      {"  regions: [{name: a, cell: {apothem: 10 um}}]\n", "the wall, 11.25 um, fills the cell"},
      {"  regions: [{name: a, cell: {wall_thickness: 75 um}}]\n", "the wall, 75 um, fills the cell"},
      {"  regions: [{name: a, interface: {law: bonded, cohesion: 1 MPa}}]\n", "contradicts law: bonded"},
      {"  regions: [{name: a, wall: {law: mooney_rivlin, C4: 1 MPa}}]\n", "macro.regions[0].wall.C4"},
      {"  fields: {turgor: {unit: MPa}}\n", "macro.fields.turgor.expression: missing"},
      {"  fields: {turgor: {expression: x, table: a.csv, unit: MPa}}\n", "given together with expression"},
      {"  fields: {turgor: {expression: x, unit: mm}}\n", "write the unit of a stress alone"},
      {"  fields: {turgor: {table: nowhere.csv, unit: MPa}}\n", "cannot be opened"},
      {"  fields: {wall_thickness: {expression: x, unit: um, levels: 9}}\n", "out of range"},
  };

  for (size_t i = 0; i < sizeof(bad) / sizeof(*bad); i++) {
    char text[2000];
    LamScene *scene;
    PetscErrorCode error;

    snprintf(text, sizeof(text), SCENE "%s", bad[i].text);
    CATCH(LamSceneReadText("scene.yaml", text, &scene), error);
    assert_int_equal(error, PETSC_ERR_USER_INPUT);
    assert_null(scene);
    if (!strstr(scene_message, bad[i].fragment)) fail_msg("\"%s\" lacks \"%s\"", scene_message, bad[i].fragment);
  }
}
