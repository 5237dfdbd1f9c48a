/* Pictures of whole files: each kind is drawn in each format, and what cannot be drawn is refused with the reason. */
#include "support/test.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "plot.h"
#include "support/error_message.h"

#define RVE_FILE "test_plot_rve.h5"
#define FE2_FILE "test_plot_fe2.h5"
#define DATABASE_FILE "test_plot_database.h5"
#define MAP_FILE "test_plot_map.h5"
#define SIDES 12 /* of the body */

static LamScene Scene;

static void fill_scene(void)
{
  static char text[] = "version: 1\n";

  Scene.text = text;
  snprintf(Scene.path, sizeof Scene.path, "test.yaml");
  Scene.scales = (LamScales){75e-6, 0.11e6, 0.01};
  Scene.micro = (LamMicrostructure){.wall_thickness = 0.5, .cells = {1, 1}, .along = 1, .through = 1};
  Scene.micro.wall = (LamWall){
      .law = LAM_WALL_FIBRE_MOONEY_RIVLIN, .C1 = 10. / 11, .C2 = 1. / 11, .C4 = 100. / 11, .bulk_modulus = 1000};
  Scene.accuracy = 0.01;
}

/* One hexagonal ring of wall thickness 0.5: nodes on three hexagons, twelve each, corners first. */
static void make_ring(PetscReal nodes[36][2], PetscInt elements[6][9])
{
  for (int layer = 0; layer < 3; layer++) {
    for (int i = 0; i < 12; i++) {
      const double radius = (0.5 + 0.25 * layer) * (i % 2 ? 1 : 2 / sqrt(3)), angle = M_PI / 6 * (i - 1);

      nodes[12 * layer + i][0] = radius * cos(angle);
      nodes[12 * layer + i][1] = radius * sin(angle);
    }
  }
  for (int e = 0; e < 6; e++) {
    const PetscInt a = 2 * e, m = a + 1, b = (a + 2) % 12;
    const PetscInt list[9] = {a, 24 + a, 24 + b, b, 12 + a, 24 + m, 12 + b, m, 12 + m};

    memcpy(elements[e], list, sizeof list);
  }
}

/* States 1 and 2 of simple shear; state 3 has no answer. */
static void write_states(LamRecordWriter writer, PetscReal nodes[36][2])
{
  const PetscInt points[2] = {36, 2}, values[1] = {36};
  PetscReal x[36][2], field[36];
  char name[64];

  for (PetscInt64 k = 1; k <= 3; k++) {
    const LamLoad load = {{1, 0.1 * k, 0, 0, 1, 0, 0, 0, 1}, 0.2, 0};
    LamResponse response;

    CHECK(LamResponseInit(&load, &response));
    for (int i = 0; i < 9; i++) response.P[i] = 0.01 * k * i;
    response.status = k < 3 ? LAM_CONVERGED : LAM_NO_EQUILIBRIUM;
    if (k == 3) snprintf(response.reason, sizeof response.reason, "limit load");
    CHECK(LamRecordWriterCommit(writer, 1, &k, &response));
    if (k == 3) return;
    for (int i = 0; i < 36; i++) {
      x[i][0] = nodes[i][0] + load.F[1] * nodes[i][1];
      x[i][1] = nodes[i][1];
      field[i] = 1 + 0.1 * k * nodes[i][0];
    }
    snprintf(name, sizeof name, "/fields/%d/x", (int)k);
    CHECK(LamRecordWriterReals(writer, name, 2, points, &x[0][0], "apothem"));
    snprintf(name, sizeof name, "/fields/%d/wall_stress", (int)k);
    CHECK(LamRecordWriterReals(writer, name, 1, values, field, "MPa"));
    snprintf(name, sizeof name, "/fields/%d/fibre_stretch", (int)k);
    CHECK(LamRecordWriterReals(writer, name, 1, values, field, "1"));
  }
}

static void write_rve(void)
{
  const PetscReal period[2][2] = {{2, 0}, {1, sqrt(3)}};
  const PetscInt points[2] = {36, 2}, quads[2] = {6, 9}, cells[1] = {6}, two[2] = {2, 2}, cell_of[6] = {0};
  PetscReal nodes[36][2];
  PetscInt elements[6][9];
  LamRecordWriter writer;

  make_ring(nodes, elements);
  CHECK(LamRecordWriterOpen(RVE_FILE, "rve", LAM_WRITE_CREATE, &Scene, &writer));
  CHECK(LamRecordWriterReals(writer, "/mesh/nodes", 2, points, &nodes[0][0], "apothem"));
  CHECK(LamRecordWriterInts(writer, "/mesh/elements", 2, quads, &elements[0][0]));
  CHECK(LamRecordWriterInts(writer, "/mesh/cell_of", 1, cells, cell_of));
  CHECK(LamRecordWriterReals(writer, "/mesh/period", 2, two, &period[0][0], "apothem"));
  write_states(writer, nodes);
  CHECK(LamRecordWriterClose(&writer));
}

/* One element of 10 mm, sheared by plates and let go half-way; sides with long names. */
static void write_fe2(void)
{
  static const PetscReal nodes[9][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 0}, {10, 5}, {5, 10}, {0, 5}, {5, 5}};
  const PetscInt elements[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8}, gripped[9] = {1, 1, 0, 0, 1}, points[2] = {9, 2},
                 one[2] = {1, 9}, four[2] = {1, 4};
  const PetscInt steps[3] = {0, 1, 2}, count[1] = {3}, curve[3] = {3, SIDES, 2}, pair[2] = {2, 5};
  const PetscReal tensor[9] = {0.1, 0.2, 0, 0.2, 0.3, 0, 0, 0, 0.1}, indicator[4] = {0.7, 0, 0, 0.02},
                  load[3] = {0, 1, 0.5}, obstacles[2][5] = {{0, 10, 0, -1, 0}, {12, 5, -1, 0, 2}};
  PetscReal reaction[3][SIDES][2] = {{{0}}};
  char names[SIDES * 48] = "", side[48];
  LamRecordWriter writer;
  char name[64];

  CHECK(LamRecordWriterOpen(FE2_FILE, "fe2", LAM_WRITE_CREATE, &Scene, &writer));
  CHECK(LamRecordWriterReals(writer, "/macro/nodes", 2, points, &nodes[0][0], "mm"));
  CHECK(LamRecordWriterInts(writer, "/macro/elements", 2, one, elements));
  CHECK(LamRecordWriterInts(writer, "/macro/gripped", 1, points, gripped));
  for (int s = 0; s < SIDES; s++) {
    snprintf(side, sizeof side, "a_side_with_quite_a_long_name_%d\n", s);
    strcat(names, side);
    for (int k = 0; k < 6; k++) reaction[k / 2][s][k % 2] = load[k / 2] * (1 + s + k % 2);
  }
  CHECK(LamRecordWriterText(writer, "/macro/boundaries", names));
  for (int k = 0; k < 3; k++) {
    PetscReal u[9][2];

    for (int i = 0; i < 9; i++) {
      u[i][0] = 0.1 * k * nodes[i][1];
      u[i][1] = 0;
    }
    snprintf(name, sizeof name, "/macro/step/%d/u", k);
    CHECK(LamRecordWriterReals(writer, name, 2, points, &u[0][0], "mm"));
    snprintf(name, sizeof name, "/macro/step/%d/cauchy", k);
    CHECK(LamRecordWriterReals(writer, name, 2, one, tensor, "MPa"));
    snprintf(name, sizeof name, "/macro/step/%d/obstacles", k);
    if (k) CHECK(LamRecordWriterReals(writer, name, 2, pair, &obstacles[0][0], "mm"));
    snprintf(name, sizeof name, "/macro/step/%d/indicator", k);
    CHECK(LamRecordWriterReals(writer, name, 2, four, indicator, "1"));
  }
  CHECK(LamRecordWriterReals(writer, "/macro/curve/load_factor", 1, count, load, "1"));
  CHECK(LamRecordWriterReals(writer, "/macro/curve/reaction", 3, curve, &reaction[0][0][0], "N/mm"));
  CHECK(LamRecordWriterInts(writer, "/macro/steps", 1, count, steps));
  CHECK(LamRecordWriterClose(&writer));
}

static void write_database(void)
{
  LamRecordWriter writer;

  CHECK(LamRecordWriterOpen(DATABASE_FILE, "database", LAM_WRITE_CREATE, &Scene, &writer));
  for (PetscInt64 k = 0; k < 4; k++) {
    const LamLoad load = {{1 + 0.05 * k, 0.1, 0, 0, 1, 0, 0, 0, 1}, 0, 0};
    LamResponse response;

    CHECK(LamResponseInit(&load, &response));
    for (int i = 0; i < 9; i++) response.P[i] = 0.1 * k;
    response.status = k ? LAM_CONVERGED : LAM_NOT_CONVERGED;
    CHECK(LamRecordWriterCommit(writer, 1, &k, &response));
  }
  CHECK(LamRecordWriterClose(&writer));
}

/* Two by three points, the last one not solved yet. */
static void write_map(void)
{
  static const char *const texts[][2] = {{"/map/x/quantity", "shear"},
                                         {"/map/x/spacing", "linear"},
                                         {"/map/x/unit", "1"},
                                         {"/map/y/quantity", "turgor"},
                                         {"/map/y/spacing", "linear"},
                                         {"/map/y/unit", "MPa"},
                                         {"/map/modes", "none\nseparation\nrupture\n"}};
  const PetscInt dims[2] = {2, 3}, nx[1] = {3}, ny[1] = {2}, mode[6] = {0, 1, 1, 0, 2, -1};
  const PetscReal x[3] = {0, 0.1, 0.2}, y[2] = {0, 0.05}, factor[6] = {NAN, 0.5, 0.5, NAN, 0.9, NAN};
  LamRecordWriter writer;

  CHECK(LamRecordWriterOpen(MAP_FILE, "map", LAM_WRITE_CREATE, &Scene, &writer));
  for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++)
    CHECK(LamRecordWriterText(writer, texts[k][0], texts[k][1]));
  CHECK(LamRecordWriterReals(writer, "/map/x/values", 1, nx, x, "1"));
  CHECK(LamRecordWriterReals(writer, "/map/y/values", 1, ny, y, "MPa"));
  CHECK(LamRecordWriterInts(writer, "/map/mode", 2, dims, mode));
  CHECK(LamRecordWriterReals(writer, "/map/load_factor", 2, dims, factor, "1"));
  for (PetscInt64 k = 0; k < 5; k++) {
    const LamLoad load = {{1, 0.05 * k, 0, 0, 1, 0, 0, 0, 1}, 0, 0};
    LamResponse response;

    CHECK(LamResponseInit(&load, &response));
    response.status = LAM_CONVERGED;
    CHECK(LamRecordWriterCommit(writer, 1, &k, &response));
  }
  CHECK(LamRecordWriterClose(&writer));
}

static int write_files(void **state)
{
  KeepErrorMessages();
  fill_scene();
  write_rve();
  write_fe2();
  write_database();
  write_map();
  return 0;
}

static int remove_files(void **state)
{
  remove(RVE_FILE);
  remove(FE2_FILE);
  remove(DATABASE_FILE);
  remove(MAP_FILE);
  PetscPopErrorHandler();
  return 0;
}

/* Draws with `plot` into `output`, and checks how the file starts. */
static void draws(PetscErrorCode (*plot)(const LamPlotRequest *), const char input[], const char output[],
                  const char start[])
{
  const LamPlotRequest request = {.input = input, .output = output, .state = -1};
  char bytes[16] = "";
  FILE *file;

  CHECK(plot(&request));
  file = fopen(output, "rb");
  assert_non_null(file);
  assert_true(fread(bytes, 1, sizeof bytes - 1, file) > strlen(start));
  fclose(file);
  remove(output);
  assert_memory_equal(bytes, start, strlen(start));
}

TEST_IS(rve_states_are_drawn_as_png, draws(LamPlotRVE, RVE_FILE, "test_plot_rve.png", "\x89PNG"));
TEST_IS(rve_states_are_drawn_as_svg, draws(LamPlotRVE, RVE_FILE, "test_plot_rve.svg", "<?xml"));
TEST_IS(rve_states_are_drawn_as_pdf, draws(LamPlotRVE, RVE_FILE, "test_plot_rve.PDF", "%PDF"));
TEST_IS(fe2_runs_are_drawn, draws(LamPlotFE2, FE2_FILE, "test_plot_fe2.pdf", "%PDF"));
TEST_IS(databases_are_drawn, draws(LamPlotDatabase, DATABASE_FILE, "test_plot_db.pdf", "%PDF"));
TEST_IS(maps_are_drawn, draws(LamPlotMap, MAP_FILE, "test_plot_map.pdf", "%PDF"));

typedef PetscErrorCode (*Plot)(const LamPlotRequest *);

/* Expects that `plot` refuses this state and field (NULL: the default) with a message that contains `words`, and writes
   nothing. */
static void refuses(Plot plot, const char input[], PetscInt state, const char field[], const char words[])
{
  const LamPlotRequest request = {.input = input, .output = "test_plot_none.pdf", .state = state, .field = field};

  assert_int_equal(plot(&request), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(ErrorMessage, words));
  assert_int_not_equal(access(request.output, F_OK), 0);
}

TEST_IS(a_state_that_is_not_there_is_refused, refuses(LamPlotRVE, RVE_FILE, 7, NULL, "states 1 to 3"));
TEST_IS(a_state_without_an_answer_is_refused_with_its_reason, refuses(LamPlotRVE, RVE_FILE, 3, NULL, "limit load"));
TEST_IS(an_unknown_field_is_refused_with_the_known_ones, refuses(LamPlotFE2, FE2_FILE, -1, "colour", "von_mises, "));
TEST_IS(a_step_that_is_not_there_is_refused, refuses(LamPlotFE2, FE2_FILE, 9, NULL, "steps 0 to 2"));
TEST_IS(a_field_that_the_file_lacks_is_refused, refuses(LamPlotFE2, FE2_FILE, -1, "P_12", "/macro/step/1/P"));
TEST_IS(a_field_that_no_record_has_is_refused, refuses(LamPlotMap, MAP_FILE, -1, "colour", "load_factor"));
TEST_IS(a_state_of_a_database_is_refused, refuses(LamPlotDatabase, DATABASE_FILE, 1, NULL, "--state"));

/* ---- texts ---- */

static struct {
  int n;
  char text[256][256];
  LamRect box[256];
} Texts;

static void keep_text(const char text[], LamRect box)
{
  assert_true(Texts.n < 256);
  snprintf(Texts.text[Texts.n], sizeof Texts.text[0], "%s", text);
  Texts.box[Texts.n++] = box;
}

/* Draws, and keeps the texts of the picture. */
static void draw_texts(Plot plot, const char input[], PetscInt state, PetscBool strip)
{
  const LamPlotRequest request = {.input = input, .output = "test_plot_texts.pdf", .state = state, .strip = strip};

  Texts.n = 0;
  LamPlotTextVisit = keep_text;
  CHECK(plot(&request));
  LamPlotTextVisit = NULL;
  remove(request.output);
}

/* How many texts start like this. */
static int count_texts(const char start[])
{
  int count = 0;

  for (int k = 0; k < Texts.n; k++) count += !strncmp(Texts.text[k], start, strlen(start));
  return count;
}

/* The picture has as many texts that start with `start`. */
static void shows(Plot plot, const char input[], PetscInt state, PetscBool strip, int count, const char start[])
{
  draw_texts(plot, input, state, strip);
  assert_int_equal(count_texts(start), count);
}

TEST_IS(an_rve_is_drawn_at_the_peak, shows(LamPlotRVE, RVE_FILE, LAM_PLOT_PEAK, 0, 1, "State 2, peak:"));
TEST_IS(the_title_tells_the_state, shows(LamPlotRVE, RVE_FILE, 1, 0, 1, "State 1:"));
TEST_IS(a_body_is_drawn_at_the_peak, shows(LamPlotFE2, FE2_FILE, LAM_PLOT_PEAK, 0, 1, "Step 1, peak:"));
TEST_IS(the_last_step_can_be_drawn, shows(LamPlotFE2, FE2_FILE, LAM_PLOT_LAST, 0, 1, "Step 2:"));
TEST_IS(a_strip_of_an_rve_has_all_states_with_an_answer, shows(LamPlotRVE, RVE_FILE, LAM_PLOT_PEAK, 1, 2, "State "));
TEST_IS(a_strip_of_a_body_has_all_steps, shows(LamPlotFE2, FE2_FILE, LAM_PLOT_PEAK, 1, 3, "Step "));
TEST_IS(the_legend_names_obstacles, shows(LamPlotFE2, FE2_FILE, 1, 0, 1, "plate, indenter, grip"));
TEST_IS(the_legend_names_the_dashed_line, shows(LamPlotFE2, FE2_FILE, 1, 0, 1, "undeformed"));

/* No text of the picture lies on another. */
static void texts_are_apart(Plot plot, const char input[], PetscBool strip)
{
  draw_texts(plot, input, LAM_PLOT_PEAK, strip);
  assert_true(Texts.n > 5);
  for (int i = 0; i < Texts.n; i++) {
    for (int k = 0; k < i; k++) {
      const LamRect a = Texts.box[i], b = Texts.box[k];

      if (a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height)
        fail_msg("\"%s\" lies on \"%s\"", Texts.text[i], Texts.text[k]);
    }
  }
}

TEST_IS(texts_of_an_rve_are_apart, texts_are_apart(LamPlotRVE, RVE_FILE, PETSC_FALSE));
TEST_IS(texts_of_a_strip_are_apart, texts_are_apart(LamPlotRVE, RVE_FILE, PETSC_TRUE));
TEST_IS(texts_of_a_body_with_many_sides_are_apart, texts_are_apart(LamPlotFE2, FE2_FILE, PETSC_FALSE));
TEST_IS(texts_of_a_database_are_apart, texts_are_apart(LamPlotDatabase, DATABASE_FILE, PETSC_FALSE));
TEST_IS(texts_of_a_map_are_apart, texts_are_apart(LamPlotMap, MAP_FILE, PETSC_FALSE));

TEST(a_strip_has_the_first_the_peak_and_the_last_of_many_states)
{
  PetscInt chosen[LAM_STRIP_PANELS];

  for (PetscInt peak = 0; peak < 50; peak++) {
    PetscBool has = PETSC_FALSE;

    assert_int_equal(LamStripChoose(50, peak, chosen), LAM_STRIP_PANELS);
    assert_int_equal(chosen[0], 0);
    assert_int_equal(chosen[LAM_STRIP_PANELS - 1], 49);
    for (int k = 0; k < LAM_STRIP_PANELS; k++) {
      assert_true(!k || chosen[k] > chosen[k - 1]);
      if (chosen[k] == peak) has = PETSC_TRUE;
    }
    assert_true(has);
  }
}

TEST(an_output_that_cannot_be_written_is_an_error_of_output)
{
  const LamPlotRequest request = {.input = DATABASE_FILE, .output = "no-such-folder/a.pdf", .state = -1};

  assert_int_equal(LamPlotDatabase(&request), PETSC_ERR_FILE_WRITE);
  assert_non_null(strstr(ErrorMessage, "no-such-folder/a.pdf"));
}

TEST(only_three_formats_are_accepted)
{
  assert_int_equal(LamCanvasCheckPath("a.gif"), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(ErrorMessage, ".png, .svg or .pdf"));
}

TEST_GROUP(.setup = write_files, .teardown = remove_files);
