/* Stiffnesses and process zone of a lamella. */
#include "support/test.h"
#include <lamella/scene.h>
#include <string.h>
#include "lamella_zone.h"

/* Walls of C1 + C2 = 1 and C4 = 9 with a lamella of strength 0.4 and energy 0.1: strength^2/(2 energy) = 0.8. */
static LamMicrostructure Tissue(void)
{
  LamMicrostructure micro = {.wall_thickness = 0.15,
                             .cells = {1, 1},
                             .interface = LAM_INTERFACE_LAMELLA,
                             .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000},
                             .lamella = LAM_LAMELLA_UNIFORM};

  micro.lamella.strength = micro.lamella.shear_strength = 0.4;
  micro.lamella.energy = micro.lamella.shear_energy = 0.1;
  return micro;
}

static const LamCell plain = {.wall_thickness = 0.15,
                              .wall = {.C1 = 0.9, .C2 = 0.1, .C4 = 9, .bulk_modulus = 1000},
                              .turgor = 1,
                              .cohesion = 1,
                              .lamella_strength = 1,
                              .lamella_energy = 1};

static void AssertLeast(const LamMicrostructure *micro, PetscReal expected)
{
  assert_near(LamLamellaLeastStiffness(micro), expected, 1e-14 * expected);
}

TEST(the_least_stiffness_is_that_of_the_smaller_energy)
{
  LamMicrostructure micro = Tissue();

  AssertLeast(&micro, 0.8);
  micro.lamella.shear_energy = 0.05;
  AssertLeast(&micro, 1.6);
  micro.lamella.shear_strength = 0;
  AssertLeast(&micro, 0.8);
}

TEST(the_least_stiffness_is_that_of_the_worst_factors)
{
  LamMicrostructure micro = Tissue();

  micro.lamella.face_strength[1] = 2;
  micro.lamella.face_energy[2] = 0.5;
  AssertLeast(&micro, 3.2);
  micro.lamella.junction_energy = 0.1;
  AssertLeast(&micro, 3.2);
  micro.lamella.junction_length = 0.05;
  AssertLeast(&micro, 32);
}

TEST(a_lamella_without_strength_needs_no_stiffness)
{
  LamMicrostructure micro = Tissue();

  for (int f = 0; f < 3; f++) micro.lamella.face_strength[f] = micro.lamella.face_energy[f] = 0;
  AssertLeast(&micro, 0);
  micro.lamella.face_strength[0] = 1;
  assert_true(isinf(LamLamellaLeastStiffness(&micro)));
}

/* In a row of cells of kinds 0, 1, 1 in a patch: pairs (0, 1) and (1, 1). */
TEST(between_two_cells_the_smaller_factors_act)
{
  LamCell cell[3] = {plain, plain, plain};
  LamMicrostructure micro = Tissue();

  micro.is_patch = PETSC_TRUE;
  micro.cells[0] = 3;
  micro.cell = cell;
  cell[1].lamella_strength = cell[2].lamella_strength = 2;
  AssertLeast(&micro, 3.2);
  cell[1].lamella_energy = cell[2].lamella_energy = 4;
  AssertLeast(&micro, 0.8);
  cell[0].cluster = 7;
  micro.lamella.between_energy = 0.25;
  AssertLeast(&micro, 3.2);
}

TEST(the_default_stiffness_costs_little)
{
  LamMicrostructure micro = Tissue();

  micro.lamella.stiffness = LamLamellaDefaultStiffness(&micro);
  assert_near(micro.lamella.stiffness, 1250 * (1 + 0.8 * 9) * 1.3, 1e-9);
  assert_near(LamLamellaCompliance(&micro), 8e-4, 1e-16);
}

TEST(a_brittle_lamella_is_stiffer)
{
  LamMicrostructure micro = Tissue();

  micro.lamella.energy = 1e-4;
  assert_near(LamLamellaDefaultStiffness(&micro), 50 * 800, 1e-8);
  micro.lamella.energy = 1e-7;
  assert_near(LamLamellaDefaultStiffness(&micro), LAM_LAMELLA_STIFFEST, 0);
}

TEST(the_process_zone_is_that_of_a_beam_or_a_thick_body)
{
  LamMicrostructure micro = Tissue();

  assert_near(LamLamellaZone(&micro), pow(0.15, 0.75) * pow(22 * 0.1 / 0.16, 0.25), 1e-14);
  micro.lamella.energy = 1e-4;
  assert_near(LamLamellaZone(&micro), 22 * 1e-4 / 0.16, 1e-14);
}

TEST(the_process_zone_is_the_shortest_of_all_cells)
{
  LamCell cell[2] = {plain, plain};
  LamMicrostructure micro = Tissue();

  micro.cells[0] = 2;
  micro.cell = cell;
  cell[1].wall_thickness = 0.05;
  assert_near(LamLamellaZone(&micro), pow(0.05, 0.75) * pow(22 * 0.1 / 0.16, 0.25), 1e-14);
}

/* The number of elements that it names is one at which it is silent, and one fewer is not. */
TEST(a_warning_names_the_elements_that_would_do)
{
  const LamScales scales = {.length = 75e-6, .stress = 1e5};
  LamMicrostructure micro = Tissue();
  char text[LAM_ZONE_TEXT];
  int named;

  micro.along = 3;
  micro.grading = 0.5;
  LamZoneWarning(&micro, &scales, text);
  assert_non_null(strstr(text, "over about 34.8 um"));
  assert_int_equal(sscanf(strstr(text, "rve.mesh.along"), "rve.mesh.along: %d or more", &named), 1);
  micro.along = named;
  LamZoneWarning(&micro, &scales, text);
  assert_string_equal(text, "");
  micro.along = named - 1;
  LamZoneWarning(&micro, &scales, text);
  assert_string_not_equal(text, "");
}

TEST(a_warning_tells_where_no_mesh_would_do)
{
  const LamScales scales = {.length = 75e-6, .stress = 1e5};
  LamMicrostructure micro = Tissue();
  char text[LAM_ZONE_TEXT];

  micro.along = 200;
  micro.lamella.energy = 1e-4;
  LamZoneWarning(&micro, &scales, text);
  assert_non_null(strstr(text, "no mesh resolves it; a smaller strength or a larger fracture_energy is needed"));
}

TEST(other_laws_have_no_zone)
{
  const LamScales scales = {.length = 75e-6, .stress = 1e5};
  LamMicrostructure micro = Tissue();
  char text[LAM_ZONE_TEXT];

  micro.along = 1;
  micro.interface = LAM_INTERFACE_CONTACT;
  LamZoneWarning(&micro, &scales, text);
  assert_string_equal(text, "");
}
