/*
  What a run leaves of tissue with a lamella: fields in the file, columns in the table.
*/
#include "support/rve_fixture.h"
#include "rve_run.h"
#include <stdio.h>
#include <string.h>

#define LAMELLA "test_lamella_file"
#define CONTACT "test_contact_file"
#define STATES 4

static char tissue[] = "version: 1\n"
                       "rve:\n"
                       "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                       "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                       "  interface: {law: contact}\n"
                       "  turgor: {mode: prescribed, pressure: 0.01 MPa}\n"
                       "  mesh: {along: 6, through: 1}\n"
                       "load: [{F: [[1, 0], [0, 1]]}, {ramp: {to: [[1, 0.3], [0, 1]], steps: 3}}]\n";

static LamResponse last; /* of tissue with a lamella, with its fields */
static PetscInt dims[2];
static LamRVELamella fields;

/* As LamRVERun.state. */
static PetscErrorCode See(void *ctx, const LamRVERun *run, const LamResponse responses[2])
{
  LamInterfaceLawType law;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetInterfaceLaw(run->meshes.rve[0], &law));
  if (law != LAM_INTERFACE_LAMELLA || run->solved < STATES) PetscFunctionReturn(0);
  last = responses[0];
  PetscCall(LamRVEGetInterfaceSize(run->meshes.rve[0], &dims[0], &dims[1]));
  n = dims[0] * dims[1];
  PetscCall(PetscMalloc7(2 * n, &fields.across, n, &fields.damage, n, &fields.broken, n, &fields.opening, n,
                         &fields.slip, n, &fields.normal_traction, n, &fields.shear_traction));
  PetscCall(LamRVEGetLamella(run->meshes.rve[0], run->meshes.state[0], &fields));
  PetscFunctionReturn(0);
}

static void Run(const char out[], PetscBool has_lamella)
{
  LamRVERun run = {.out_path = out, .no_estimate = PETSC_TRUE, .state = See};

  CHECK(LamSceneReadText("scene.yaml", tissue, &run.scene));
  if (has_lamella) {
    LamMicrostructure *micro = &run.scene->micro;

    micro->interface = LAM_INTERFACE_LAMELLA;
    micro->lamella = LAM_LAMELLA_UNIFORM;
    micro->lamella.stiffness = 700.0;
    micro->lamella.strength = micro->lamella.shear_strength = 0.2;
    micro->lamella.energy = micro->lamella.shear_energy = 2.5e-3;
  }
  CHECK(LamRVERunPrepare(&run));
  CHECK(LamRVERunSolve(&run));
  assert_int_equal(run.solved, STATES);
  assert_int_equal(run.failed, 0);
  CHECK(LamRVERunDestroy(&run));
}

static int RunBoth(void **state)
{
  Run(LAMELLA ".h5", PETSC_TRUE);
  Run(CONTACT ".h5", PETSC_FALSE);
  return 0;
}

static int Leave(void **state)
{
  static const char *const files[] = {LAMELLA ".h5", LAMELLA ".csv", LAMELLA ".xdmf",
                                      CONTACT ".h5", CONTACT ".csv", CONTACT ".xdmf"};

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(files); k++) remove(files[k]);
  CHECK(PetscFree7(fields.across, fields.damage, fields.broken, fields.opening, fields.slip, fields.normal_traction,
                   fields.shear_traction));
  return 0;
}

static void FileHas(const char name[], PetscInt columns, const PetscReal wanted[], PetscReal scale)
{
  char path[64];
  PetscInt rank, size[4];
  PetscReal *values;
  PetscBool found;

  snprintf(path, sizeof path, "/fields/%d/interface/%s", STATES, name);
  CHECK(LamFileReadReals(LAMELLA ".h5", path, &found, &rank, size, &values));
  assert_true(found);
  assert_int_equal(rank, columns > 1 ? 3 : 2);
  for (int k = 0; k < 2; k++) assert_int_equal(size[k], dims[k]);
  for (PetscInt k = 0; k < columns * dims[0] * dims[1]; k++) assert_near(values[k], scale * wanted[k], 1e-15);
  CHECK(PetscFree(values));
}

TEST_IS(TheFileHasTheFarSide, FileHas("across", 2, fields.across, 1.0));
TEST_IS(TheFileHasDamage, FileHas("damage", 1, fields.damage, 1.0));
TEST_IS(TheFileHasWhatIsBroken, FileHas("broken", 1, fields.broken, 1.0));
TEST_IS(TheFileHasOpening, FileHas("opening", 1, fields.opening, 1.0));
TEST_IS(TheFileHasSlip, FileHas("slip", 1, fields.slip, 1.0));
TEST_IS(TheFileHasNormalTraction, FileHas("normal_traction", 1, fields.normal_traction, TISSUE_STRESS));
TEST_IS(TheFileHasShearTraction, FileHas("shear_traction", 1, fields.shear_traction, TISSUE_STRESS));

static PetscBool ContactHas(const char name[])
{
  PetscInt rank, shape[4];
  PetscReal *values = NULL;
  PetscBool found;

  CHECK(LamFileReadReals(CONTACT ".h5", name, &found, &rank, shape, &values));
  CHECK(PetscFree(values));
  return found;
}

TEST(ContactHasNoLamellaInItsFile)
{
  assert_true(ContactHas("/fields/1/interface/pressure"));
  assert_false(ContactHas("/fields/1/interface/broken"));
}

/* Number in column `name` of the last line; NAN: there is no such column. */
static double Cell(const char path[], const char name[])
{
  char line[2][2048] = {"", ""}, *head = line[0], *row = line[1];
  FILE *file = fopen(path, "r");
  double value = NAN;

  assert_non_null(file);
  assert_non_null(fgets(line[0], sizeof line[0], file));
  for (int k = 0; k < STATES; k++) assert_non_null(fgets(line[1], sizeof line[1], file));
  fclose(file);
  for (char *title; (title = strsep(&head, ",\n"));) {
    const char *cell = strsep(&row, ",\n");

    assert_non_null(cell);
    if (!strcmp(title, name)) value = strtod(cell, NULL);
  }
  return value;
}

TEST(TheTableHasBrokenShareAndEnergies)
{
  const double energy = TISSUE_STRESS * 1e3; /* kJ/m^3 */

  assert_near(Cell(LAMELLA ".csv", "broken_fraction"), last.broken_fraction, 1e-9);
  assert_near(Cell(LAMELLA ".csv", "stored (kJ/m^3)"), last.stored * energy, 1e-9);
  assert_near(Cell(LAMELLA ".csv", "dissipated (kJ/m^3)"), last.dissipated * energy, 1e-9);
  assert_near(Cell(LAMELLA ".csv", "released (kJ/m^3)"), last.released * energy, 1e-9);
  assert_true(last.broken_fraction > 0.1 && last.dissipated > 0.0);
  assert_true(isnan(Cell(CONTACT ".csv", "broken_fraction")));
}

TEST_GROUP(.petsc = 1, .setup = RunBoth, .teardown = Leave);
