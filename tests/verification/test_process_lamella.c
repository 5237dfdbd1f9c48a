/* Tissue at a material point whose lamella breaks and weakens in time: creep, its end, and energies. */
#include "support/rve_fixture.h"
#include <lamella/study.h>
#include <stdio.h>
#include "fe2_run.h"

enum { MOST_STATES = 400 };

/* Under a turgor of 0.05 MPa and a stress of 0.02 MPa from the start on, while the lamella loses its strength. */
#define SCENE                                                                                                          \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  interface: {law: lamella, strength: 0.08 MPa, fracture_energy: 0.5 J/m^2}\n"                                      \
  "  turgor: {mode: prescribed, pressure: 0.05 MPa}\n"                                                                 \
  "  mesh: {along: 4, through: 1}\n"                                                                                   \
  "process:\n"                                                                                                         \
  "  duration: %g day\n"                                                                                               \
  "  output: %g day\n"                                                                                                 \
  "  kinetics: [{of: %s, law: first_order, rate: %g /day}]\n"                                                          \
  "  program:\n"                                                                                                       \
  "    - {for: 0 s, F: [[free, 0], [0, free]], P: [[0 MPa, x], [x, 0.02 MPa]]}\n"                                      \
  "    - {for: %g day}\n"

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE];
  int count;
  LamProcessState states[MOST_STATES];
} Creep;

static PetscErrorCode KeepState(const LamProcessState *state, void *ctx)
{
  Creep *c = (Creep *)ctx;

  assert_true(c->count < MOST_STATES);
  c->states[c->count++] = *state;
  return 0;
}

static PetscErrorCode SetTissue(void *ctx, const LamTissueFactors *factors)
{
  const Creep *c = (const Creep *)ctx;

  return LamFE2ChangeRVE(c->rve, &c->scene->micro, factors);
}

static void Follow(const char of[], double rate, double days, Creep *c)
{
  LamResponder direct;
  LamProcess process;
  char text[2048];

  snprintf(text, sizeof(text), SCENE, days, days / 20, of, rate, days);
  *c = (Creep){0};
  CHECK(LamSceneReadText("creep.yaml", text, &c->scene));
  c->rve = NewRVE(&c->scene->micro);
  CHECK(LamRVEResponderCreate(c->rve, 1, &direct));
  CHECK(LamProcessCreate(c->scene, &process));
  CHECK(LamProcessSetResponder(process, direct));
  CHECK(LamProcessSetTissue(process, SetTissue, c));
  CHECK(LamProcessSetMonitor(process, KeepState, c));
  CHECK(LamProcessRun(process, &c->reason, c->message));
  CHECK(LamProcessDestroy(&process));
  CHECK(LamResponderDestroy(&direct));
}

static void Forget(Creep *c)
{
  CHECK(LamRVEDestroy(&c->rve));
  CHECK(LamSceneDestroy(&c->scene));
}

static const LamProcessState *Last(const Creep *c)
{
  return &c->states[c->count - 1];
}

/* Nothing but the kinetics has a time: at four times the rate the same happens in a quarter of it. */
TEST(CreepEndsAtATimeThatGoesWithTheRate)
{
  static Creep slow, fast;

  Follow("lamella", 0.05, 40, &slow);
  Follow("lamella", 0.2, 10, &fast);
  assert_int_equal(slow.reason, LAM_PROCESS_ENDED);
  assert_int_equal(Last(&slow)->event, LAM_EVENT_LIMIT);
  assert_int_equal(Last(&fast)->event, LAM_EVENT_LIMIT);
  assert_non_null(strstr(fast.message, "does not bear its stress"));
  assert_near(Last(&slow)->time, 4 * Last(&fast)->time, 2e-3 * Last(&slow)->time);
  assert_true(Last(&fast)->factor[LAM_CHANGING_LAMELLA] < 0.8 && Last(&fast)->factor[LAM_CHANGING_LAMELLA] > 0.3);
  for (int k = 1; k < fast.count; k++) {
    assert_true(fast.states[k].response.broken_fraction > fast.states[k - 1].response.broken_fraction - 1e-9);
    assert_true(fast.states[k].response.dissipated > fast.states[k - 1].response.dissipated - 1e-12);
    assert_near(fast.states[k].response.P[4] * 0.11, 0.02, 1e-4);
  }
  Forget(&slow);
  Forget(&fast);
}

/* Softer walls do not break the lamella by themselves, and energies stay in the unit of the start. */
TEST(WallsThatSoftenLeaveTheLamellaItsStrength)
{
  static Creep c;

  Follow("walls", 0.02, 5, &c);
  assert_int_equal(c.reason, LAM_PROCESS_DONE);
  assert_near(Last(&c)->walls, exp(-0.1), 1e-3);
  assert_near(Last(&c)->factor[LAM_CHANGING_LAMELLA], 1.0, 1e-12);
  assert_near(Last(&c)->response.P[4] * 0.11, 0.02, 1e-4);
  assert_true(Last(&c)->F[4] > c.states[1].F[4] + 1e-3);
  Forget(&c);
}

TEST_GROUP(.petsc = 1);
