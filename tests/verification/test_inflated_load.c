/* Loads that count from the inflated tissue, against the same states given from the tissue at rest. */
#include "support/rve_fixture.h"
#include "rve_run.h"
#include <string.h>

TEST_GROUP(.petsc = 1);

#define CELL                                                                                                           \
  "version: 1\nrve:\n  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                             \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  turgor: {pressure: 0.03 MPa}\n  mesh: {along: 6, through: 2}\n"
#define STRESS 1.1e5 /* C1 + C2, Pa */
#define TURGOR (0.03e6 / STRESS)

typedef struct {
  PetscInt count;
  LamResponse response[16];
} Seen;

static PetscErrorCode See(void *ctx, const LamRVERun *run, const LamResponse responses[2])
{
  Seen *seen = (Seen *)ctx;

  PetscFunctionBeginUser;
  (void)run;
  seen->response[seen->count++] = responses[0];
  PetscFunctionReturn(0);
}

/* Runs the load of a scene; the caller destroys the run. */
static void RunText(const char text[], Seen *seen, LamRVERun *run)
{
  *seen = (Seen){0};
  *run = (LamRVERun){.no_estimate = PETSC_TRUE, .readings = PETSC_TRUE, .state = See, .reporter = {.ctx = seen}};
  CHECK(LamSceneReadText("inflated.yaml", text, &run->scene));
  CHECK(LamRVERunPrepare(run));
  CHECK(LamRVERunSolve(run));
}

static void Run(const char load[], Seen *seen, LamRVERun *run)
{
  char text[2000];

  CHECK(PetscSNPrintf(text, sizeof(text), "%sload:\n%s", CELL, load));
  RunText(text, seen, run);
}

#define PULL(reference)                                                                                                \
  "  - {inflate: true, reference: " reference "}\n"                                                                    \
  "  - ramp: {to: [[1.1, 0], [0, free]], P: [[x, x], [x, -0.01 MPa]], steps: 4}\n"

/* F of the inflated tissue without prescribed stress: P = 0. */
TEST(TheInflatedTissueIsFreeOfStress)
{
  LamRVERun run;
  Seen seen;

  Run(PULL("rest"), &seen, &run);
  assert_near(seen.response[0].P[0], 0, 1e-11);
  assert_near(seen.response[0].P[4], 0, 1e-11);
  assert_true(seen.response[0].load.F[0] > 1.01);
  CHECK(LamRVERunDestroy(&run));
}

static void AssertStates(const char load[], PetscBool per_inflated_area)
{
  LamMicrostructure micro = DefaultTissue();
  LamRVE rve;
  LamRVEState state;
  LamRVERun run;
  PetscReal F0[9], J0;
  Seen seen;

  Run(load, &seen, &run);
  assert_int_equal(seen.count, 5);
  for (int i = 0; i < 9; i++) F0[i] = seen.response[0].load.F[i];
  J0 = F0[0] * F0[4];
  micro.grading = run.scene->micro.grading;
  CHECK(NewTissue(&micro, &rve, &state));
  for (int k = 1; k <= 4; k++) {
    const LamLoad load_k = {.F = {F0[0] * (1 + 0.025 * k), 0, 0, 0, F0[4], 0, 0, 0, 1}, .turgor = TURGOR};
    const PetscReal P22 = -0.01e6 / STRESS * k / 4;
    const LamStressControl control = {.given = {[4] = PETSC_TRUE},
                                      .P = {[4] = per_inflated_area ? P22 * J0 / F0[4] : P22}};
    LamResponse r;

    CHECK(LamRVESolveMixed(rve, &load_k, &control, state, &r));
    for (int i = 0; i < 9; i += 4) {
      assert_near(seen.response[k].load.F[i], r.load.F[i], 1e-9);
      assert_near(seen.response[k].P[i], r.P[i], 1e-9);
    }
  }
  CHECK(DestroyTissue(&rve, &state));
  CHECK(LamRVERunDestroy(&run));
}

TEST_IS(FCountsFromTheInflatedTissue, AssertStates(PULL("rest"), PETSC_FALSE));
TEST_IS(StressPerInflatedArea, AssertStates(PULL("inflated"), PETSC_TRUE));

/* Slopes of the curve against differences over a tenth of a step; both areas. */
static void AssertModulus(const char reference[])
{
  char load[400];
  LamRVERun run;
  Seen seen;

  CHECK(PetscSNPrintf(load, sizeof(load),
                      "  - {inflate: true, reference: %s}\n"
                      "  - {F: [[1.0499, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}\n"
                      "  - {F: [[1.05, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}\n"
                      "  - {F: [[1.0501, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}\n",
                      reference));
  Run(load, &seen, &run);
  assert_int_equal(run.test.count, 4);
  {
    const LamTestPoint *p = run.test.points;
    PetscReal F[2][9], P[9];

    for (int k = 0; k < 2; k++) LamTestMeasures(&run.test, &seen.response[1 + 2 * k], F[k], P);
    assert_near((p[3].stress - p[1].stress) / 2e-4, p[2].modulus, 1e-6 * p[2].modulus);
    assert_near(-(F[1][4] - F[0][4]) / 2e-4, p[2].poisson, 1e-6);
  }
  CHECK(LamRVERunDestroy(&run));
}

TEST_IS(ModulusIsTheSlopePerRestArea, AssertModulus("rest"));
TEST_IS(ModulusIsTheSlopePerInflatedArea, AssertModulus("inflated"));

/* The first modulus of cells that are sealed in the inflated tissue is that of cells which keep their water. */
TEST(ModulusOfSealedTissueIsTheSlope)
{
  const char load[] = "  - {inflate: true}\n"
                      "  - {F: [[0.9999, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}\n"
                      "  - {F: [[1.0001, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}\n",
             *cell = CELL, *turgor = strstr(cell, "0.03 MPa"), *rest = strchr(turgor, '}');
  char text[2000];
  LamRVERun run;
  Seen seen;

  CHECK(PetscSNPrintf(text, sizeof(text), "%.*s, mode: sealed%sload:\n%s", (int)(rest - cell), cell, rest, load));
  RunText(text, &seen, &run);
  assert_int_equal(run.test.count, 3);
  {
    const LamTestPoint *p = run.test.points;

    assert_near((p[2].stress - p[1].stress) / 2e-4, p[0].modulus, 1e-6 * p[0].modulus);
  }
  CHECK(LamRVERunDestroy(&run));
}

/* The work per volume at rest is the change of the energy, turgor being part of it. */
TEST(WorkIsTheChangeOfEnergy)
{
  const PetscInt steps = 8;
  LamTestReadings readings;
  LamRVERun run;
  Seen seen;

  Run("  - {inflate: true}\n  - ramp: {to: [[1.1, 0], [0, free]], P: [[x, x], [x, 0 MPa]], steps: 8}\n", &seen, &run);
  LamTestRead(&run.test, &readings);
  assert_near(readings.work, seen.response[steps].energy - seen.response[0].energy, 1e-6 * readings.work);
  CHECK(LamRVERunDestroy(&run));
}
