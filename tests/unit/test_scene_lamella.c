/* What law `lamella` in a scene becomes, in units of 0.11 MPa, 75 um, 8.25 J/m^2 and 0.11/0.075 MPa/mm.
   tests/scenes/bad.txt has what is refused. */
#include "support/test.h"
#include "unit/test_scene.h"

#define PLAIN "  interface: {law: lamella, strength: 0.055 MPa, fracture_energy: 0.825 J/m^2}\n"
#define EVERY                                                                                                          \
  "  interface:\n    law: lamella\n    strength: 55 kPa\n    fracture_energy: 0.825e-3 N/mm\n"                         \
  "    stiffness: 1100 MPa/mm\n    shear: {strength: 0.022 MPa, fracture_energy: 1.65 J/m^2}\n    mixing: 1.5\n"       \
  "    softening: exponential\n    junction: {length: 7.5 um, strength: 2, fracture_energy: 3}\n"                      \
  "    faces: {strength: [1, 1, 0.5], fracture_energy: [1, 2, 0.25]}\n"                                                \
  "    residual_cohesion: 0.0011 MPa\n"
#define CLUSTERS "    between_clusters: {strength: 0.3, fracture_energy: 0.2}\n"
#define KINDS                                                                                                          \
  "  cells: [1, 2]\n  variation: {kinds: [{lamella_strength: 0.5, lamella_energy: 0.75, cluster: 4}], list: [0, 1]}\n"
#define BODY                                                                                                           \
  "macro:\n  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"                                                          \
  "  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]\n"

static const PetscReal tolerance = 1e-13;

TEST(a_lamella_is_measured_in_apothems_and_moduli)
{
  OwnedScene *scene = Read(RVE EVERY CLUSTERS KINDS);
  const LamLamella *lamella = &scene->micro.lamella;

  assert_int_equal(scene->micro.interface, LAM_INTERFACE_LAMELLA);
  assert_int_equal(lamella->softening, LAM_SOFTENING_EXPONENTIAL);
  assert_near(lamella->strength, 0.5, tolerance);
  assert_near(lamella->energy, 0.1, tolerance);
  assert_near(lamella->stiffness, 750, 1e-10);
  assert_near(lamella->shear_strength, 0.2, tolerance);
  assert_near(lamella->shear_energy, 0.2, tolerance);
  assert_near(lamella->mixing, 1.5, 0);
  assert_near(lamella->junction_length, 0.1, tolerance);
  assert_near(scene->cohesion, 0.01, tolerance);
}

TEST(factors_are_as_written)
{
  OwnedScene *scene = Read(RVE EVERY CLUSTERS KINDS);
  const LamLamella *lamella = &scene->micro.lamella;

  assert_near(lamella->junction_strength, 2, 0);
  assert_near(lamella->junction_energy, 3, 0);
  assert_near(lamella->face_strength[2], 0.5, 0);
  assert_near(lamella->face_energy[1], 2, 0);
  assert_near(lamella->between_strength, 0.3, 0);
  assert_near(lamella->between_energy, 0.2, 0);
  assert_near(scene->micro.cell[1].lamella_strength, 0.5, 0);
  assert_near(scene->micro.cell[1].lamella_energy, 0.75, 0);
  assert_int_equal(scene->micro.cell[1].cluster, 4);
  assert_int_equal(scene->micro.cell[0].cluster, 0);
}

TEST(a_lamella_has_the_same_hash_in_other_units)
{
  OwnedScene *one = Read(RVE PLAIN);
  OwnedScene *other = Read("version: 1\nrve:\n  cell: {apothem: 0.075 mm, wall_thickness: 0.01125 mm}\n"
                           "  wall: {law: fibre_mooney_rivlin, C1: 1 bar, C2: 10 kPa, C4: 1 MPa}\n  interface: {law: "
                           "lamella, strength: 0.55 bar, fracture_energy: 825 mJ/m2}\n");
  char hash[2][LAM_HASH_LENGTH], *json;

  assert_int_equal(LamMicrostructureDescribe(&one->micro, &json, hash[0]), 0);
  PetscFree(json);
  assert_int_equal(LamMicrostructureDescribe(&other->micro, &json, hash[1]), 0);
  PetscFree(json);
  assert_string_equal(hash[0], hash[1]);
}

TEST(what_is_left_out_of_a_lamella_has_its_default)
{
  OwnedScene *scene = Read(RVE PLAIN);
  LamLamella expected = LAM_LAMELLA_UNIFORM;

  expected.strength = expected.shear_strength = scene->micro.lamella.strength;
  expected.energy = expected.shear_energy = scene->micro.lamella.energy;
  expected.stiffness = LamLamellaDefaultStiffness(&scene->micro);
  assert_memory_equal(&scene->micro.lamella, &expected, sizeof(expected));
  assert_near(scene->cohesion, 0, 0);
}

TEST(energies_that_are_equal_but_for_their_units_are_equal)
{
  OwnedScene *scene = Read(RVE "  interface: {law: lamella, strength: 0.05 MPa, fracture_energy: 0.7 J/m^2, shear: "
                               "{fracture_energy: 0.0007 N/mm}}\n");

  assert_true(scene->micro.lamella.shear_energy == scene->micro.lamella.energy);
}

TEST(shear_may_be_unresisted)
{
  OwnedScene *scene =
      Read(RVE "  interface: {law: lamella, strength: 0.05 MPa, fracture_energy: 1 J/m^2, shear: {strength: 0 MPa}}\n");

  assert_near(scene->micro.lamella.shear_strength, 0, 0);
}

TEST(a_lamella_holds_the_free_sides_of_a_patch_and_what_is_inflated)
{
  OwnedScene *scene = Read(RVE PLAIN "  patch: {columns: 4, rows: 3, sides: free}\n"
                                     "  turgor: {pressure: 0.02 MPa}\n");
  OwnedScene *inflated = Read(RVE PLAIN "  turgor: {pressure: 0.02 MPa}\nload: [{inflate: true}]\n");
  OwnedScene *body = Read(RVE PLAIN "  turgor: {pressure: 0.02 MPa}\n" BODY);

  assert_int_equal(scene->micro.sides, LAM_SIDES_FREE);
  assert_true(inflated->inflate);
  assert_true(body->macro.inflate);
}

TEST(a_field_varies_strength_and_energy_alike)
{
  OwnedScene *scene = Read(RVE PLAIN "  cells: [2, 2]\n  variation: {field: {lamella: 0.3}}\n");
  const LamCell *cell = scene->micro.cell;

  assert_non_null(cell);
  for (int c = 0; c < 4; c++) assert_near(cell[c].lamella_strength, cell[c].lamella_energy, 0);
  assert_true(cell[0].lamella_strength != cell[1].lamella_strength);
  assert_near(cell[0].cohesion, 1, 0);
}

/* A region of half the apothem and twice the moduli. */
TEST(a_region_has_the_lamella_of_the_scene_in_its_own_units)
{
  OwnedScene *scene = Read(RVE EVERY BODY "  regions: [{name: skin, cell: {apothem: 37.5 um}, "
                                          "wall: {C1: 0.2 MPa, C2: 0.02 MPa}}]\n");
  const LamLamella *lamella = &scene->regions->micro.lamella;

  assert_near(lamella->strength, 0.25, tolerance);
  assert_near(lamella->energy, 0.1, tolerance);
  assert_near(lamella->shear_energy, 0.2, tolerance);
  assert_near(lamella->stiffness, 187.5, 1e-10);
  assert_near(lamella->junction_length, 0.2, tolerance);
  assert_near(scene->regions->cohesion, 0.005, tolerance);
}

TEST(a_region_may_have_its_own_strength_and_energy)
{
  OwnedScene *scene = Read(RVE PLAIN BODY "  regions: [{name: skin, interface: {strength: 0.11 MPa, fracture_energy: "
                                          "0.165 J/m^2}}]\n");
  const LamLamella *lamella = &scene->regions->micro.lamella;

  assert_near(lamella->strength, 1, tolerance);
  assert_near(lamella->shear_strength, 1, tolerance);
  assert_near(lamella->energy, 0.02, tolerance);
  assert_near(lamella->shear_energy, 0.02, tolerance);
  assert_near(lamella->stiffness, LamLamellaDefaultStiffness(&scene->regions->micro), 0);
}

TEST(a_region_may_be_bonded_or_in_contact)
{
  OwnedScene *scene = Read(RVE PLAIN BODY "  regions: [{name: skin, interface: {law: bonded}}, "
                                          "{name: core, interface: {law: contact, cohesion: 0.011 MPa}}]\n");

  assert_int_equal(scene->regions[0].micro.interface, LAM_INTERFACE_BONDED);
  assert_int_equal(scene->regions[1].micro.interface, LAM_INTERFACE_CONTACT);
  assert_near(scene->regions[1].cohesion, 0.1, tolerance);
}
