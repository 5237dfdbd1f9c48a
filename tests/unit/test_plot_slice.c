/* Slices through a table: what they hold is what the table answers, and nodes lie where their strains are. */
#include "support/test.h"
#include <unistd.h>
#include "plot_slice.h"
#include "support/error_message.h"
#include "support/table_fixture.h"

#define FILE_NAME "test_plot_slice.h5"
static const char Text[] = "version: 1\n"
                           "rve:\n"
                           "  cell: {apothem: 75 um, wall_thickness: 11.25 um, orientation: 20 deg}\n"
                           "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                           "  interface: {law: bonded}\n"
                           "  mesh: {along: 4, through: 1}\n"
                           "sample:\n"
                           "  stretch: {min: 0, max: 0.1}\n"
                           "  turgor: {min: 0.01 MPa, max: 0.03 MPa}\n"
                           "accuracy: 0.02\n";
static const PetscReal MPa = 0.11; /* C1 + C2 */
static const Synthetic Material = {.mu = 1, .lambda = 2};

/* U with logarithmic strains e1 and e2 along the angle and across. */
static LamLoad load_of(PetscReal e1, PetscReal e2, PetscReal angle)
{
  const PetscReal n[2] = {cos(angle), sin(angle)}, m[2] = {-sin(angle), cos(angle)};
  LamLoad load = {.F = {0, 0, 0, 0, 0, 0, 0, 0, 1}, .turgor = 0.02 / MPa};

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) load.F[3 * i + j] = exp(e1) * n[i] * n[j] + exp(e2) * m[i] * m[j];
  return load;
}

static int write_file(void **state)
{
  const LamLoad loads[] = {load_of(0.02, 0.05, 0.4), load_of(0.08, 0.01, 0.4), load_of(0.07, 0.08, 0.4)};
  OWNED(LamScene *, LamSceneDestroy) scene;

  KeepErrorMessages();
  CHECK(LamSceneReadText("test.yaml", Text, &scene));
  CHECK(TableFixtureWrite(FILE_NAME, scene, &Material, 3, loads, 1e-4));
  return 0;
}

static int remove_file(void **state)
{
  remove(FILE_NAME);
  PetscPopErrorHandler();
  return 0;
}

static LamSlice read_slice(const LamPlotRequest *request)
{
  OWNED(LamDatabase, LamDatabaseClose) database;
  LamSlice slice;

  CHECK(LamDatabaseOpen(FILE_NAME, &database));
  CHECK(LamSliceRead(request, database, &slice));
  return slice;
}

static const LamPlotRequest Default = {.input = FILE_NAME, .output = "test_plot_slice.png", .state = -1};

TEST(strains_and_their_axis_come_from_F)
{
  const LamLoad load = load_of(0.2, -0.05, 0.7);
  PetscReal strain[2], angle;

  LamPrincipalStrains(load.F, strain, &angle);
  assert_near(strain[0], 0.2, 1e-14);
  assert_near(strain[1], -0.05, 1e-14);
  assert_near(angle, 0.7, 1e-14);
}

/* Wherever the table answers to its accuracy: the stress and potential of the tissue at the deformation of the sample.
 */
TEST(a_slice_holds_the_answers_of_the_tissue)
{
  const LamPlotRequest request = {.input = FILE_NAME, .state = -1, .angle = "15 deg"};
  PetscInt compared = 0;
  OWNED(LamSlice, LamSliceDestroy) slice = read_slice(&request);

  for (PetscInt at = 0; at < LAM_SLICE_SAMPLES * LAM_SLICE_SAMPLES; at += 37) {
    const LamLoad load = load_of(LamSliceStrain(&slice, at % LAM_SLICE_SAMPLES),
                                 LamSliceStrain(&slice, at / LAM_SLICE_SAMPLES), 35 * PETSC_PI / 180);
    LamResponse truth;
    PetscReal square = 0;

    if (slice.verdict[at] != LAM_SLICE_RESPONDS) continue;
    compared++;
    CHECK(LamResponseInit(&load, &truth));
    SyntheticEvaluate(&Material, &load, &truth);
    for (int k = 0; k < 9; k++) square += truth.P[k] * truth.P[k];
    assert_near(slice.value[LAM_SLICE_STRESS][at], sqrt(square) * MPa, 0.02 * MPa);
    assert_near(slice.value[LAM_SLICE_POTENTIAL][at], (truth.energy + load.turgor * truth.lumen_fraction) * MPa,
                1e-3 * MPa);
    assert_near(slice.value[LAM_SLICE_INDICATOR][at], 100 * truth.lumen_fraction, 0.1);
  }
  assert_true(compared > 100);
}

/* What is above the diagonal at 0 degrees is what is below it at 30: one square shows both ways of stretching a cell.
 */
TEST(thirty_degrees_are_zero_across)
{
  const LamPlotRequest request = {.input = FILE_NAME, .state = -1, .angle = "30 deg"};
  const PetscInt n = LAM_SLICE_SAMPLES;
  OWNED(LamSlice, LamSliceDestroy) zero = read_slice(&Default);
  OWNED(LamSlice, LamSliceDestroy) thirty = read_slice(&request);

  for (PetscInt i = 0; i < n; i += 7)
    for (PetscInt j = 0; j < n; j += 5) {
      assert_int_equal(zero.verdict[j * n + i], thirty.verdict[i * n + j]);
      if (zero.verdict[j * n + i] != LAM_SLICE_RESPONDS) continue;
      assert_near(zero.value[LAM_SLICE_ERROR][j * n + i], thirty.value[LAM_SLICE_ERROR][i * n + j], 1e-4);
    }
  assert_true(zero.node_count == thirty.node_count);
}

TEST(the_edges_of_a_slice_lie_outside_the_table)
{
  OWNED(LamSlice, LamSliceDestroy) slice = read_slice(&Default);

  assert_int_equal(slice.verdict[0], LAM_SLICE_NOTHING);
  assert_true(isnan(slice.value[LAM_SLICE_STRESS][0]));
}

TEST(more_accuracy_is_refused_in_more_places)
{
  const LamPlotRequest strict = {.input = FILE_NAME, .state = -1, .accuracy = 1e-6};
  OWNED(LamSlice, LamSliceDestroy) loose = read_slice(&Default);
  OWNED(LamSlice, LamSliceDestroy) tight = read_slice(&strict);

  assert_true(tight.count[LAM_SLICE_INACCURATE] > loose.count[LAM_SLICE_INACCURATE]);
  assert_true(tight.count[LAM_SLICE_NOTHING] == loose.count[LAM_SLICE_NOTHING]);
}

/* The logarithms of the stretches of the three lattice directions, ascending. */
static void lattice_strains(const PetscReal F[9], PetscReal x[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscReal angle = 20 * PETSC_PI / 180 + k * PETSC_PI / 3, c = cos(angle), s = sin(angle);

    x[k] = log(hypot(F[0] * c + F[1] * s, F[3] * c + F[4] * s));
  }
  CHECK(PetscSortReal(3, x));
}

TEST(nodes_are_drawn_where_their_strains_are)
{
  const LamResponse *records;
  OWNED(LamDatabase, LamDatabaseClose) database;
  OWNED(LamSlice, LamSliceDestroy) slice = read_slice(&Default);
  PetscInt n;

  CHECK(LamDatabaseOpen(FILE_NAME, &database));
  CHECK(LamDatabaseGetRecords(database, &n, &records, NULL));
  assert_true(slice.node_count > 8);
  for (PetscInt i = 0; i < slice.node_count; i++) {
    const LamLoad load = load_of(slice.nodes[i].at[0], slice.nodes[i].at[1], 20 * PETSC_PI / 180);
    PetscReal best = PETSC_INFINITY, x[3], y[3];

    lattice_strains(load.F, x);
    for (PetscInt r = 0; r < n; r++) {
      lattice_strains(records[r].load.F, y);
      best = PetscMin(best, hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]));
    }
    assert_near(best, 0, 1e-9); /* at 0 degrees all nodes lie in the slice, where two strains are equal, or far out */
  }
}

static void refuses(LamPlotRequest request, const char words[])
{
  request.input = FILE_NAME;
  request.output = "none.png";
  request.state = -1;
  assert_int_equal(LamPlotDatabase(&request), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(ErrorMessage, words));
}

TEST_IS(bonded_tissue_has_no_suction, refuses((LamPlotRequest){.suction = "0.02 MPa"}, "--suction 0.02 MPa"));
TEST_IS(an_angle_needs_its_unit, refuses((LamPlotRequest){.angle = "15"}, "unit"));
TEST_IS(the_records_of_a_table_have_no_slice,
        refuses((LamPlotRequest){.field = "stress", .angle = "15 deg"}, "--angle 15 deg"));

TEST(a_table_is_drawn)
{
  CHECK(LamPlotDatabase(&Default));
  assert_int_equal(access(Default.output, F_OK), 0);
  remove(Default.output);
}

TEST_GROUP(.setup = write_file, .teardown = remove_file);
