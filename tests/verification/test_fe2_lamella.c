/* FE2 of tissue whose lamella breaks: what is accepted is broken, and nothing else; energies of the body. */
#include <math.h>
#include <string.h>
#include "support/rve_fixture.h"

/* Tissue of `turgor` MPa, clamped; the top is moved by u mm, along the factors of a history, in so many steps. */
static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                                 "  interface: {law: lamella, strength: 0.02 MPa, fracture_energy: 0.4 J/m^2, "
                                 "sharpness: smooth}\n"
                                 "  turgor: {mode: prescribed, pressure: %g MPa}\n"
                                 "  mesh: {along: 3, through: 1}\n"
                                 "macro:\n"
                                 "  mesh: {box: [1 mm, 1 mm], elements: [1, 1]}\n"
                                 "  boundary:\n"
                                 "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"
                                 "    - {on: top, displacement: [%g mm, %g mm], history: [[0, 0], [0.5, 1], [1, %g]]}\n"
                                 "  inflate: false\n"
                                 "  steps: %d\n";

typedef struct {
  double turgor, u[2], end;
  int steps;
} Program;

enum { MOST_STEPS = 16 };

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamMacro macro;
  LamResponder direct, responder; /* of RVEs; what the body asks */
  int batches, fails;             /* number of the batch to be without response; 0: none */
  int count;
  LamMacroStep steps[MOST_STEPS];
} Body;

/* ---- a responder that lets a step be given up ---- */

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[], LamResponse r[])
{
  Body *body = (Body *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderRespond(body->direct, n, loads, points, r));
  if (++body->batches == body->fails) r[0].status = LAM_NOT_CONVERGED;
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  return LamResponderAccept(((Body *)ctx)->direct);
}

static PetscErrorCode Reject(void *ctx)
{
  return LamResponderReject(((Body *)ctx)->direct);
}

static PetscErrorCode Note(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  Body *body = (Body *)ctx;

  (void)macro;
  (void)stop;
  assert_true(body->count < MOST_STEPS);
  body->steps[body->count++] = *step;
  return 0;
}

/* ---- bodies ---- */

static void Create(Body *body, Program p)
{
  const LamResponderFunctions functions = {.respond = Respond, .accept = Accept, .reject = Reject};
  char text[sizeof(scene_text) + 128];
  PetscInt points;

  memset(body, 0, sizeof(*body));
  snprintf(text, sizeof(text), scene_text, p.turgor, p.u[0], p.u[1], p.end, p.steps);
  CHECK(LamSceneReadText("lamella", text, &body->scene));
  body->rve = NewRVE(&body->scene->micro);
  CHECK(LamMacroCreate(PETSC_COMM_SELF, &body->macro));
  CHECK(LamMacroSetScene(body->macro, body->scene));
  CHECK(LamMacroSetUp(body->macro));
  CHECK(LamMacroGetPointCount(body->macro, &points));
  CHECK(LamRVEResponderCreate(body->rve, points, &body->direct));
  CHECK(LamResponderCreate(&functions, body, NULL, &body->responder));
  CHECK(LamMacroSetResponder(body->macro, body->responder));
  CHECK(LamMacroSetMonitor(body->macro, Note, body));
}

static void Destroy(Body *body)
{
  CHECK(LamMacroDestroy(&body->macro));
  CHECK(LamResponderDestroy(&body->responder));
  CHECK(LamResponderDestroy(&body->direct));
  CHECK(LamRVEDestroy(&body->rve));
  CHECK(LamSceneDestroy(&body->scene));
}

static void Run(Body *body)
{
  char message[LAM_MESSAGE_LENGTH];
  LamMacroReason reason;

  CHECK(LamMacroSolve(body->macro, &reason, message));
  assert_int_equal(reason, LAM_MACRO_DONE);
}

static const LamMacroStep *Last(const Body *body)
{
  return &body->steps[body->count - 1];
}

/* The response of point 0 to F22, accepted or not. */
static LamResponse Ask(const Body *body, double F22, PetscBool accepted)
{
  const LamLoad load = PlaneLoad(1, 0, 0, F22, body->scene->turgor);
  const PetscInt point = 0;
  LamResponse r;

  CHECK(LamResponderRespond(body->direct, 1, &load, &point, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  if (accepted) CHECK(LamResponderAccept(body->direct));
  return r;
}

/* A response is that of the state accepted last, bit for bit: what Newton's method asks in between, and what a step
   asked that is given up, breaks nothing. */
TEST(WhatIsNotAcceptedBreaksNothing)
{
  const Program program = {0.01, {0, 0.1}, 1, 1};
  LamResponse alone, after_another, after_reject;
  Body body;

  Create(&body, program);
  (void)Ask(&body, 1.05, PETSC_TRUE);
  alone = Ask(&body, 1.08, PETSC_FALSE);
  assert_true(Ask(&body, 1.3, PETSC_FALSE).broken_fraction > 2 * alone.broken_fraction);
  after_another = Ask(&body, 1.08, PETSC_FALSE);
  assert_memory_equal(after_another.P, alone.P, sizeof(alone.P));
  (void)Ask(&body, 1.3, PETSC_FALSE);
  CHECK(LamResponderReject(body.direct));
  after_reject = Ask(&body, 1.08, PETSC_FALSE);
  assert_memory_equal(after_reject.P, alone.P, sizeof(alone.P));
  assert_true(after_reject.broken_fraction == alone.broken_fraction && after_reject.work == alone.work);
  Destroy(&body);
}

/* A step to the end is given up in its third iteration, with its points far torn, and goes in halves: that is the run
   of two steps, bit for bit. */
TEST(AStepGivenUpBreaksNothing)
{
  const Program whole = {0, {0.05, 0.3}, 1, 1}, halves = {0, {0.05, 0.3}, 1, 2};
  Body given_up, undisturbed;

  Create(&given_up, whole);
  given_up.fails = 3;
  Run(&given_up);
  Create(&undisturbed, halves);
  Run(&undisturbed);
  assert_int_equal(Last(&given_up)->cutbacks, 1);
  assert_true(Last(&given_up)->broken_fraction > 0.05);
  assert_memory_equal(Last(&given_up)->reaction, Last(&undisturbed)->reaction, sizeof(Last(&given_up)->reaction));
  assert_true(Last(&given_up)->dissipated == Last(&undisturbed)->dissipated);
  Destroy(&given_up);
  Destroy(&undisturbed);
}

/* Of a body that is torn and goes back: the work at its sides is that of its tissue (Hill and Mandel), which is stored,
   dissipated or released; both to second order in the step. What is broken stays broken, and so does the verdict on
   the mesh where no point localises any more. */
TEST(WorkIsStoredDissipatedOrReleased)
{
  const Program program = {0, {0.1, 0.25}, 0, 10};
  Body body;

  Create(&body, program);
  Run(&body);
  for (int k = 0; k < body.count; k++) {
    const LamMacroStep *s = &body.steps[k], *before = &body.steps[PetscMax(k - 1, 0)];

    assert_true(fabs(s->tissue_work - s->work) < 0.05 * Last(&body)->dissipated);
    assert_true(fabs(s->stored + s->dissipated + s->released - s->tissue_work) < 0.05 * Last(&body)->dissipated);
    assert_true(s->broken_fraction >= before->broken_fraction && s->released >= before->released);
    assert_true(s->mesh_dependent == (before->mesh_dependent || s->localised_points > 0));
  }
  assert_true(Last(&body)->broken_fraction > 0.1);
  assert_true(Last(&body)->mesh_dependent && Last(&body)->localised_points == 0);
  Destroy(&body);
}

/* Tissue of another law has no such numbers. */
TEST(WithoutALamellaTheyAreUnknown)
{
  const Program program = {0, {0.05, 0.05}, 1, 1};
  LamMicrostructure micro;
  Body body;

  Create(&body, program);
  micro = body.scene->micro;
  micro.interface = LAM_INTERFACE_BONDED;
  CHECK(LamResponderDestroy(&body.direct));
  CHECK(LamRVEDestroy(&body.rve));
  body.rve = NewRVE(&micro);
  CHECK(LamRVEResponderCreate(body.rve, 0, &body.direct));
  Run(&body);
  assert_true(isnan(Last(&body)->broken_fraction) && isnan(Last(&body)->stored) && isnan(Last(&body)->tissue_work));
  assert_false(Last(&body)->mesh_dependent);
  Destroy(&body);
}
