/* What other languages call: units, states as bytes, errors. */
#include "support/test.h"
#include <lamella/bind.h>
#include <lamella/error.h>
#include <lamella/lamella.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char Text[] = "version: 1\n"
                           "rve:\n"
                           "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                           "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                           "  turgor: {mode: prescribed, pressure: 0.02 MPa}\n"
                           "  mesh: {along: 2, through: 1}\n"
                           "load:\n"
                           "  - {F: [[1, 0.1], [0, 1]]}\n"
                           "  - {F: [[1, 0.2], [0, 1]], turgor: 0.01 MPa}\n";

enum { LOAD = 11, STATES = 2 };

typedef struct {
  LamBindScene scene;
  LamBindRVE rve;
  double loads[STATES * LOAD], P[STATES * 9];
  LamResponse responses[STATES];
} Bound;

static void Enter(Bound *b)
{
  assert_int_equal(LamBindSceneRead("test", Text, &b->scene), 0);
  assert_int_equal(LamBindSceneLoads(b->scene, b->loads, b->P), STATES);
  assert_int_equal(LamBindRVECreate(b->scene, &b->rve), 0);
}

static void Leave(Bound *b)
{
  LamBindRVEDestroy(b->rve);
  LamBindSceneDestroy(b->scene);
}

TEST_ON(loads_are_in_pascals, Bound, b, Enter(b), Leave(b))
{
  assert_near(b->loads[9], 2e4, 1e-9);
  assert_near(b->loads[LOAD + 9], 1e4, 1e-9);
  assert_near(b->loads[LOAD + 1], 0.2, 0);
}

TEST_ON(numbers_are_the_apothem_the_moduli_and_the_pressures, Bound, b, Enter(b), Leave(b))
{
  const double expected[4] = {75e-6, 1.1e5, 2e4, 0};
  double numbers[4];

  LamBindSceneNumbers(b->scene, numbers);
  for (int i = 0; i < 4; i++) assert_near(numbers[i], expected[i], 1e-12 * expected[i]);
}

/* The same solve by the library's own functions, which count stresses in C1 + C2. */
TEST_ON(responses_are_in_pascals, Bound, b, Enter(b), Leave(b))
{
  LamLoad load = {.F = {1, 0.1, 0, 0, 1, 0, 0, 0, 1}, .turgor = 2e4 / 1.1e5};
  LamResponse direct;
  LamRVEState state;
  LamScene *scene;
  LamRVE rve;

  assert_int_equal(LamBindRVESolve(b->rve, 1, b->loads, NULL, 1, 0, b->responses), 0);
  assert_int_equal(LamSceneReadText("test", Text, &scene), 0);
  assert_int_equal(LamRVECreate(PETSC_COMM_SELF, &rve), 0);
  assert_int_equal(LamRVESetMicrostructure(rve, &scene->micro), 0);
  assert_int_equal(LamRVESetUp(rve), 0);
  assert_int_equal(LamRVEStateCreate(rve, &state), 0);
  assert_int_equal(LamRVESolve(rve, &load, state, &direct), 0);
  assert_int_equal(direct.status, LAM_CONVERGED);
  for (int i = 0; i < 9; i++) assert_near(b->responses[0].P[i], 1.1e5 * direct.P[i], 1e-9 * 1.1e5);
  assert_near(b->responses[0].tangent[0], 1.1e5 * direct.tangent[0], 1e-9 * 1.1e5);
  assert_near(b->responses[0].lumen_fraction, direct.lumen_fraction, 1e-12);
  assert_int_equal(LamRVEStateDestroy(&state), 0);
  assert_int_equal(LamRVEDestroy(&rve), 0);
  assert_int_equal(LamSceneDestroy(&scene), 0);
}

TEST_ON(a_solve_goes_on_from_a_state_that_was_kept, Bound, b, Enter(b), Leave(b))
{
  LamResponse again;
  size_t size;
  void *bytes;

  assert_int_equal(LamBindRVESolve(b->rve, 1, b->loads, NULL, 1, 0, b->responses), 0);
  assert_int_equal(LamBindRVEStateSize(b->rve, &size), 0);
  bytes = malloc(size);
  assert_int_equal(LamBindRVEGetState(b->rve, bytes), 0);
  assert_int_equal(LamBindRVEReset(b->rve), 0);
  assert_int_equal(LamBindRVESetState(b->rve, bytes), 0);
  assert_int_equal(LamBindRVESolve(b->rve, 1, b->loads, NULL, 1, 0, &again), 0);
  assert_near(again.P[1], b->responses[0].P[1], 1e-9 * fabs(b->responses[0].P[1]));
  assert_true(again.newton_iterations < b->responses[0].newton_iterations);
  free(bytes);
}

/* The stress of a state, prescribed in one component, gives its F there. */
TEST_ON(F_is_found_where_P_is_prescribed, Bound, b, Enter(b), Leave(b))
{
  LamResponse found;

  assert_int_equal(LamBindRVESolve(b->rve, 1, b->loads, NULL, 1, 0, b->responses), 0);
  assert_int_equal(LamBindRVEReset(b->rve), 0);
  b->loads[0] = NAN;
  b->P[0] = b->responses[0].P[0];
  assert_int_equal(LamBindRVESolve(b->rve, 1, b->loads, b->P, 1, 0, &found), 0);
  assert_int_equal(found.status, LAM_CONVERGED);
  assert_near(found.load.F[0], 1, 1e-6);
  assert_near(found.P[1], b->responses[0].P[1], 1e-6 * 1.1e5);
}

TEST_ON(F_and_P_of_a_component_are_a_mistake, Bound, b, Enter(b), Leave(b))
{
  b->P[4] = 0;
  assert_int_equal(LamBindErrorKind(LamBindRVESolve(b->rve, 2, b->loads, b->P, 1, 0, b->responses)), 'i');
  assert_non_null(strstr(LamErrorMessage(), "state 0: F22 and P22 are both given"));
}

/* From undeformed tissue, whatever was solved before. */
TEST_ON(own_loads_are_those_of_the_scene, Bound, b, Enter(b), Leave(b))
{
  LamResponse own[STATES];
  int count;

  assert_int_equal(LamBindRVESolve(b->rve, STATES, b->loads, NULL, 1, 0, b->responses), 0);
  assert_int_equal(LamBindRVESolveOwnLoads(b->rve, 1, 1, own, &count), 0);
  assert_int_equal(count, STATES);
  for (int k = 0; k < STATES; k++) assert_near(own[k].P[1], b->responses[k].P[1], 1e-9 * 1.1e5);
  assert_true(own[0].error_estimate > 0);
}

TEST_ON(a_state_without_an_answer_is_no_error, Bound, b, Enter(b), Leave(b))
{
  b->loads[0] = -1;
  assert_int_equal(LamBindRVESolve(b->rve, 1, b->loads, NULL, 1, 0, b->responses), 0);
  assert_int_not_equal(b->responses[0].status, LAM_CONVERGED);
  assert_true(b->responses[0].reason[0] != '\0');
}

/* The text above without its line of the mesh. */
TEST(a_mesh_that_is_left_open_is_chosen)
{
  const char *mesh = strstr(Text, "  mesh:"), *rest = strstr(Text, "load:");
  char open[sizeof(Text)];
  LamBindScene scene;
  LamResponse response;
  double loads[STATES * LOAD], P[STATES * 9];
  LamBindRVE rve;

  snprintf(open, sizeof(open), "%.*s%s", (int)(mesh - Text), Text, rest);
  CHECK(LamBindSceneRead("test", open, &scene));
  LamBindSceneLoads(scene, loads, P);
  CHECK(LamBindRVECreate(scene, &rve));
  CHECK(LamBindRVESolve(rve, 1, loads, NULL, 0, 0, &response));
  assert_int_equal(response.status, LAM_CONVERGED);
  LamBindRVEDestroy(rve);
  LamBindSceneDestroy(scene);
}

/* Another program prescribes turgor, and takes a material point. */
TEST(sealed_cells_and_patches_are_no_material)
{
  static const char *const texts[] = {"version: 1\n"
                                      "rve:\n"
                                      "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                      "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n",
                                      "  turgor: {mode: sealed, pressure: 0.02 MPa}\n",
                                      "  patch: {columns: 2, rows: 2, sides: free}\n"};
  static const char *const words[] = {"", "rve.turgor.mode: sealed", "rve.patch"};

  for (int k = 0; k < 3; k++) {
    LamBindScene scene;
    char text[1024];
    int code;

    snprintf(text, sizeof(text), "%s%s", texts[0], k ? texts[k] : "");
    CHECK(LamBindSceneRead("test", text, &scene));
    code = LamBindSceneIsMaterial(scene);
    assert_int_equal(code != 0, k > 0);
    if (k) assert_non_null(strstr(LamErrorMessage(), words[k]));
    LamBindSceneDestroy(scene);
  }
}

TEST(a_mistake_is_an_error_of_the_input)
{
  LamBindScene scene;
  const int code = LamBindSceneRead("wrong.yaml", "version: 1\nrve: {cel: 3}\n", &scene);

  assert_int_equal(LamBindErrorKind(code), 'i');
  assert_non_null(strstr(LamErrorMessage(), "wrong.yaml:2:7: rve.cel: unknown key; did you mean cell?"));
}

TEST(members_are_those_of_a_response)
{
  int count, found = 0;
  const char *name, *unit, *help;
  size_t offset;
  char type;

  for (int i = 0; (name = LamBindMember(i, &type, &count, &offset, &unit, &help)); i++) {
    assert_true(offset < LamBindResponseSize());
    if (!strcmp(name, "tangent")) {
      assert_int_equal(offset, offsetof(LamResponse, tangent));
      assert_int_equal(count, 81);
      assert_string_equal(unit, "Pa");
      ++found;
    }
    if (!strcmp(name, "status")) {
      assert_int_equal(type, 'e');
      assert_string_equal(LamBindMemberName(i, LAM_CONVERGED), "converged");
      ++found;
    }
  }
  assert_int_equal(found, 2);
}

static int Start(void **state)
{
  (void)state;
  return LamBindStart();
}

TEST_GROUP(.petsc = 1, .setup = Start);
