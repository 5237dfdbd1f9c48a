/* Walls with memory in a process at a material point: creep against many small steps, relaxation, walls that soften. */
#include "support/rve_fixture.h"
#include <stdio.h>

enum { MOST_STATES = 400 };
#define SCENE                                                                                                          \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall:\n"                                                                                                          \
  "    law: fibre_mooney_rivlin\n"                                                                                     \
  "    C1: 0.1 MPa\n"                                                                                                  \
  "    C2: 0.01 MPa\n"                                                                                                 \
  "    C4: 1 MPa\n"                                                                                                    \
  "    relaxation: [{share: 0.5, time: 1 min}]\n"                                                                      \
  "  turgor: {mode: prescribed, pressure: 0.05 MPa}\n"                                                                 \
  "  mesh: {along: 4, through: 1}\n"                                                                                   \
  "process:\n"                                                                                                         \
  "  tolerance: %g\n"                                                                                                  \
  "  output: %g s\n"                                                                                                   \
  "  kinetics: [{of: walls, law: first_order, rate: %g /min}]\n"                                                       \
  "  program:\n"                                                                                                       \
  "    - {for: 0 s, %s}\n"                                                                                             \
  "    - {for: 2 min}\n"
#define HELD "F: [[1.05, 0], [0, 1]]"
#define LOADED "F: [[free, 0], [0, free]], P: [[0.02 MPa, x], [x, 0 MPa]]"

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamProcessCounts counts;
  int count;
  LamProcessState states[MOST_STATES];
} Run;

static PetscErrorCode KeepState(const LamProcessState *state, void *ctx)
{
  Run *r = (Run *)ctx;

  assert_true(r->count < MOST_STATES);
  r->states[r->count++] = *state;
  return 0;
}

static void Follow(const char program[], double tolerance, double output, double rate, Run *r)
{
  char text[2048], message[LAM_PROCESS_MESSAGE];
  LamProcessReason reason;
  LamResponder direct;
  LamProcess process;

  snprintf(text, sizeof(text), SCENE, tolerance, output, rate, program);
  *r = (Run){0};
  CHECK(LamSceneReadText("memory.yaml", text, &r->scene));
  r->rve = NewRVE(&r->scene->micro);
  CHECK(LamRVEResponderCreate(r->rve, 1, &direct));
  CHECK(LamProcessCreate(r->scene, &process));
  CHECK(LamProcessSetResponder(process, direct));
  CHECK(LamProcessSetMonitor(process, KeepState, r));
  CHECK(LamProcessRun(process, &reason, message));
  assert_int_equal(reason, LAM_PROCESS_DONE);
  CHECK(LamProcessGetCounts(process, &r->counts));
  CHECK(LamProcessDestroy(&process));
  CHECK(LamResponderDestroy(&direct));
}

static void Forget(Run *r)
{
  CHECK(LamRVEDestroy(&r->rve));
  CHECK(LamSceneDestroy(&r->scene));
}

static const LamProcessState *Last(const Run *r)
{
  return &r->states[r->count - 1];
}

static LamResponse Mixed(LamRVE rve, LamRVEState state, double P11, double duration)
{
  const LamStressControl control = {.given = {1, 0, 0, 0, 1}, .P = {P11}, .share = 1};
  LamLoad load = state->load;
  LamResponse response;

  load.turgor = 0.05 / TISSUE_STRESS;
  load.duration = duration;
  CHECK(LamRVESolveMixed(rve, &load, &control, state, &response));
  assert_int_equal(response.status, LAM_CONVERGED);
  return response;
}

/* F11 over that of the inflated tissue two minutes after the load, in n steps. */
static double Creep(const Run *r, int n)
{
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(r->rve);
  const double inflated = Mixed(r->rve, at, 0, PETSC_INFINITY).load.F[0], P11 = 0.02 / TISSUE_STRESS;
  double F = Mixed(r->rve, at, P11, 0).load.F[0];

  assert_near(r->states[0].F[0], F / inflated, 1e-7);
  for (int k = 0; k < n; k++) F = Mixed(r->rve, at, P11, 120.0 / n).load.F[0];
  return F / inflated;
}

TEST(creep_is_that_of_many_small_steps)
{
  static Run r;
  double coarse, fine, exact;

  Follow(LOADED, 1e-5, 60, 0, &r);
  coarse = Creep(&r, 40);
  fine = Creep(&r, 80);
  exact = fine + (fine - coarse) / 3;
  assert_true(exact > r.states[0].F[0] + 0.01);
  assert_near(Last(&r)->F[0], exact, 1e-5);
  Forget(&r);
}

/* The strain is held, and that of the walls changes little: one step of two relaxation times is nearly that of many. */
TEST(relaxation_has_little_error_of_time)
{
  static Run r, rare;

  Follow(HELD, 1e-5, 10, 0, &r);
  Follow(HELD, 1e-5, 120, 0, &rare);
  for (int i = 0; i < 9; i++)
    assert_near(Last(&r)->response.P[i], Last(&rare)->response.P[i], 3e-4 * Last(&r)->response.P[0]);
  assert_true(Last(&r)->response.P[0] < 0.8 * r.states[0].response.P[0]);
  for (int k = 1; k < r.count; k++) assert_true(r.states[k].response.P[0] < r.states[k - 1].response.P[0]);
  Forget(&r);
  Forget(&rare);
}

/* A fast test after any time has the moduli that are given, here of the relaxed tissue. */
TEST(firmness_is_that_of_a_fast_test)
{
  static Run r;

  Follow(HELD, 1e-5, 120, 0, &r);
  assert_near(Last(&r)->firmness / r.states[0].firmness, 1, 0.2);
  Forget(&r);
}

/* Walls lose half of their moduli, and of what they remember, while the strain is held without turgor's help. */
TEST(the_past_softens_with_the_walls)
{
  static Run stays, softens;
  const double left = exp(-0.35 * 2);

  Follow(HELD, 1e-6, 120, 0, &stays);
  Follow(HELD, 1e-6, 120, 0.35, &softens);
  assert_near(Last(&softens)->walls, left, 1e-4);
  assert_true(Last(&softens)->response.P[0] < Last(&stays)->response.P[0]);
  assert_true(isnan(Last(&softens)->response.dissipated));
  Forget(&stays);
  Forget(&softens);
}

TEST_GROUP(.petsc = 1);
