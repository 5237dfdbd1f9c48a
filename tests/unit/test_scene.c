/* What a scene becomes: nondimensional data, defaults, ramps. */
#include "support/test.h"
#include "unit/test_scene.h"
#include <string.h>

#define SCENES LAMELLA_SOURCE_DIR "/tests/scenes/"
#define TURGID RVE "  turgor: {mode: prescribed, pressure: 0.022 MPa}\n"
#define MACRO "macro:\n  mesh: {box: [10 mm, 5 mm], elements: [8, 4]}\n  boundary:\n"
#define CLAMPED MACRO "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"

static void AssertNear(PetscReal value, PetscReal expected)
{
  if (!(fabs(value - expected) <= 1e-13 * PetscMax(1.0, fabs(expected)))) fail_msg("%.17g, not %.17g", value, expected);
}

static void AssertF(const PetscReal F[9], PetscReal F11, PetscReal F12, PetscReal F21, PetscReal F22, PetscReal F33)
{
  const PetscReal expected[9] = {F11, F12, 0, F21, F22, 0, 0, 0, F33};

  for (int i = 0; i < 9; i++) AssertNear(F[i], expected[i]);
}

TEST(the_cell_is_measured_in_apothems_and_moduli)
{
  OwnedScene *scene;

  assert_int_equal(LamSceneRead(SCENES "shear-bonded.yaml", &scene), 0);
  AssertNear(scene->scales.length * 1e6, 75.0);
  AssertNear(scene->scales.stress * 1e-6, 0.11);
  AssertNear(scene->micro.wall_thickness, 0.15);
  AssertNear(scene->micro.wall.C1, 10.0 / 11);
  AssertNear(scene->micro.wall.C2, 1.0 / 11);
  AssertNear(scene->micro.wall.C4, 100.0 / 11);
  AssertNear(scene->micro.wall.bulk_modulus, 1e5 / 11);
  AssertNear(scene->turgor, 2.0 / 11);
}

TEST(the_mesh_and_the_states_are_as_written)
{
  OwnedScene *scene;

  assert_int_equal(LamSceneRead(SCENES "shear-bonded.yaml", &scene), 0);
  assert_int_equal(scene->micro.along, 6);
  assert_int_equal(scene->micro.through, 2);
  assert_int_equal(scene->load_count, 3);
  AssertF(scene->loads[2].F, 1, 0.5, 0, 1, 1);
  AssertNear(scene->loads[2].turgor, 2.0 / 11);
  assert_false(scene->has_sample);
  assert_false(scene->has_macro);
}

TEST(the_file_and_its_text_are_kept)
{
  LamScene *scene;

  assert_int_equal(LamSceneRead(SCENES "tissue-block.yaml", &scene), 0);
  assert_string_equal(scene->path, SCENES "tissue-block.yaml");
  assert_non_null(strstr(scene->text, "FE2: a 10 mm block"));
  assert_int_equal(LamSceneDestroy(&scene), 0);
  assert_null(scene);
}

TEST(the_macro_block_is_measured_in_its_first_edge)
{
  OwnedScene *scene;

  assert_int_equal(LamSceneRead(SCENES "tissue-block.yaml", &scene), 0);
  assert_true(scene->has_macro);
  AssertNear(scene->scales.macro_length, 0.01);
  AssertNear(scene->macro.box[0], 1.0);
  AssertNear(scene->macro.box[1], 1.0);
  assert_int_equal(scene->macro.boundary_count, 2);
  assert_string_equal(scene->macro.boundary[1].on, "top");
  AssertNear(scene->macro.boundary[1].displacement[0], 0.2);
  assert_true(scene->macro.inflate);
  assert_int_equal(scene->macro.steps, 5);
}

TEST(the_sample_is_as_written)
{
  OwnedScene *scene;

  assert_int_equal(LamSceneRead(SCENES "tissue-block.yaml", &scene), 0);
  assert_true(scene->has_sample);
  AssertNear(scene->sample.stretch_min, -0.02);
  AssertNear(scene->sample.stretch_max, 0.25);
  AssertNear(scene->sample.turgor_max, 5.0 / 11);
  assert_int_equal(scene->sample.count, 0);
  AssertNear(scene->sample.accuracy, 0.01);
}

TEST(what_is_left_out_has_its_default)
{
  OwnedScene *scene = Read(RVE);

  AssertNear(scene->micro.orientation, 0.0);
  assert_int_equal(scene->micro.cells[0], 1);
  assert_int_equal(scene->micro.cells[1], 1);
  AssertNear(scene->micro.wall.bulk_modulus, 1000.0);
  assert_int_equal(scene->micro.wall.fibres, LAM_FIBRES_BOTH);
  assert_int_equal(scene->micro.interface, LAM_INTERFACE_BONDED);
  assert_int_equal(scene->strategy, LAM_ONE_STEP);
  AssertNear(scene->turgor, 0.0);
  AssertNear(scene->cohesion, 0.0);
  AssertNear(scene->accuracy, 0.01);
  assert_int_equal(scene->micro.along, 0);
  assert_int_equal(scene->load_count, 0);
}

TEST(cells_that_come_apart_have_cohesion_clearance_and_a_strategy)
{
  OwnedScene *scene = Read(RVE "  interface: {law: contact, cohesion: 0.011 MPa, clearance: 0.75 um}\n"
                               "  strategy: one_step\n"
                               "load:\n  - {F: [[1, 0], [0, 1]]}\n  - {F: [[1, 0], [0, 1]], cohesion: 0 MPa}\n");

  assert_int_equal(scene->micro.interface, LAM_INTERFACE_CONTACT);
  assert_int_equal(scene->strategy, LAM_ONE_STEP);
  AssertNear(scene->cohesion, 0.1);
  AssertNear(scene->micro.clearance, 0.01);
  AssertNear(scene->loads[0].cohesion, 0.1);
  AssertNear(scene->loads[1].cohesion, 0.0);
}

TEST(one_number_of_the_mesh_may_be_given_alone)
{
  OwnedScene *scene = Read(RVE "  mesh: {through: 3}\n");

  assert_int_equal(scene->micro.along, 0);
  assert_int_equal(scene->micro.through, 3);
}

TEST(a_sample_without_turgor_takes_that_of_the_scene)
{
  OwnedScene *scene = Read(TURGID "sample: {stretch: {min: 0, max: 0.1}}\naccuracy: 0.02\n");

  AssertNear(scene->sample.turgor_min, 0.2);
  AssertNear(scene->sample.turgor_max, 0.2);
  AssertNear(scene->sample.accuracy, 0.02);
}

TEST(a_sample_with_a_count_has_no_accuracy)
{
  OwnedScene *scene = Read(TURGID "sample: {stretch: {min: 0, max: 0.1}, count: 7}\n");

  assert_int_equal(scene->sample.count, 7);
  AssertNear(scene->sample.accuracy, 0.0);
}

TEST(a_ramp_starts_undeformed_and_then_from_the_state_before)
{
  OwnedScene *scene = Read(RVE "load:\n  - {ramp: {to: [[1.2, 0.4], [0, 1]], steps: 4}}\n"
                               "  - {ramp: {to: [[1, 0], [0, 1]], steps: 2}}\n");

  assert_int_equal(scene->load_count, 6);
  AssertF(scene->loads[0].F, 1.05, 0.1, 0, 1, 1);
  AssertF(scene->loads[3].F, 1.2, 0.4, 0, 1, 1);
  AssertF(scene->loads[4].F, 1.1, 0.2, 0, 1, 1);
  AssertF(scene->loads[5].F, 1, 0, 0, 1, 1);
}

TEST(the_turgor_of_an_entry_holds_for_it_alone)
{
  OwnedScene *scene = Read(TURGID "load:\n  - {ramp: {to: [[1, 0.1], [0, 1]], steps: 2}, turgor: 0.11 MPa}\n"
                                  "  - {F: [[1, 0.2], [0, 1]]}\n");

  AssertNear(scene->loads[0].turgor, 1.0);
  AssertNear(scene->loads[1].turgor, 1.0);
  AssertNear(scene->loads[2].turgor, 0.2);
}

TEST(turgor_may_be_suction)
{
  OwnedScene *scene = Read(RVE "load: [{F: [[1, 0], [0, 1]], turgor: -0.011 MPa}]\n");

  AssertNear(scene->loads[0].turgor, -0.1);
}

TEST(a_3x3_gradient_may_stretch_out_of_plane)
{
  OwnedScene *scene = Read(RVE "load: [{F: [[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1.5]]}]\n");

  AssertF(scene->loads[0].F, 1, 0.1, 0.2, 1, 1.5);
}

TEST(the_plain_law_needs_no_fibres)
{
  OwnedScene *scene = Read("version: 1\nrve: {cell: {apothem: 75 um, wall_thickness: 1 um, orientation: 30 deg}, "
                           "wall: {law: mooney_rivlin, C1: 1 MPa, C2: 0 MPa}}\n");

  assert_int_equal(scene->micro.wall.law, LAM_WALL_MOONEY_RIVLIN);
  AssertNear(scene->micro.wall.C1, 1.0);
  AssertNear(scene->micro.wall.C4, 0.0);
  AssertNear(scene->micro.orientation, PETSC_PI / 6);
}

TEST(units_do_not_change_the_microstructure)
{
  OwnedScene *a = Read(TURGID);
  OwnedScene *b = Read("version: 1\nrve:\n  cell: {apothem: 0.075 mm, wall_thickness: 1.125e-5 m}\n  wall: {law: "
                       "fibre_mooney_rivlin, C1: 1 bar, C2: 10 kPa, C4: 1 N/mm2}\n  turgor: {pressure: 22000 Pa}\n");

  AssertNear(a->micro.wall_thickness, b->micro.wall_thickness);
  AssertNear(a->micro.wall.C1, b->micro.wall.C1);
  AssertNear(a->micro.wall.C4, b->micro.wall.C4);
  AssertNear(a->turgor, b->turgor);
}

TEST(anchors_aliases_quotes_and_CRLF_are_read)
{
  OwnedScene *scene =
      Read("\xef\xbb\xbfversion: 1\r\nrve:\r\n  cell: {apothem: &a \"75 um\", wall_thickness: '15 um'}\r\n"
           "  wall: {law: fibre_mooney_rivlin, C1: &C 0.1 MPa, C2: *C, C4: 1 MPa}\r\n"
           "load:\r\n  - &F {F: [[1, 0.1], [0, 1]]}\r\n  - *F\r\n");

  AssertNear(scene->micro.wall_thickness, 0.2);
  AssertNear(scene->micro.wall.C2, 0.5);
  assert_int_equal(scene->load_count, 2);
  AssertF(scene->loads[1].F, 1, 0.1, 0, 1, 1);
}

TEST(inflation_is_asked_for_by_turgor)
{
  OwnedScene *turgid = Read(TURGID CLAMPED), *dry = Read(RVE CLAMPED),
             *told = Read(TURGID CLAMPED "  inflate: false\n");

  assert_true(turgid->macro.inflate);
  assert_false(dry->macro.inflate);
  assert_false(told->macro.inflate);
  assert_int_equal(turgid->macro.steps, 10);
}

/* A body of contact tissue that is held, or whose lamella has cohesion, may carry turgor; tests/scenes/bad.txt has the
 * rest.
 */
TEST(contact_tissue_inflates_with_cohesion)
{
  OwnedScene *cohesive = Read(TURGID "  interface: {law: contact, cohesion: 0.001 MPa}\n" CLAMPED);
  OwnedScene *held = Read(TURGID "  interface: {law: contact}\n" CLAMPED "  inflate: false\n");

  assert_true(cohesive->macro.inflate);
  assert_false(held->macro.inflate);
}

TEST(rollers_leave_a_component_free)
{
  OwnedScene *scene = Read(RVE MACRO "    - {on: bottom, displacement: [free, 0 mm]}\n"
                                     "    - {on: left, displacement: [0 mm, free]}\n"
                                     "    - {on: top, displacement: [free, -1 mm]}\n");

  assert_false(scene->macro.boundary[0].given[0]);
  assert_true(scene->macro.boundary[0].given[1]);
  assert_true(scene->macro.boundary[1].given[0]);
  AssertNear(scene->macro.boundary[2].displacement[1], -0.1);
  AssertNear(scene->macro.box[1], 0.5);
}

TEST(opposite_sides_hold_the_rotation)
{
  OwnedScene *scene = Read(RVE MACRO "    - {on: bottom, displacement: [0 mm, free]}\n"
                                     "    - {on: top, displacement: [1 mm, free]}\n"
                                     "    - {on: left, displacement: [free, 0 mm]}\n");

  assert_int_equal(scene->macro.boundary_count, 3);
}

TEST(strengths_are_measured_in_moduli_and_may_be_left_out)
{
  LamScene *scene = Read(RVE "strength: {wall: 0.55 MPa, lamella_shear: 11 kPa}\n");

  AssertNear(scene->strength.wall, 5);
  assert_true(isnan(scene->strength.lamella_normal));
  AssertNear(scene->strength.lamella_shear, 0.1);
  assert_int_equal(LamSceneDestroy(&scene), 0);
  scene = Read(RVE);
  assert_true(isnan(scene->strength.wall));
  assert_int_equal(LamSceneDestroy(&scene), 0);
}
