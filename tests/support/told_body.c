#include "told_body.h"
#include "support/test.h"
#include <lamella/relaxing.h>
#include <stdio.h>
#include <string.h>

/* The lamella bears the mean stress of the plane. */
static PetscErrorCode BodyRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                  LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(SyntheticRespond(ctx, n, loads, points, responses));
  for (PetscInt i = 0; i < n; i++) responses[i].max_traction = 0.5 * (responses[i].P[0] + responses[i].P[4]);
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepBody(const LamBodyState *state, void *ctx)
{
  Told *told = (Told *)ctx;

  assert_true(told->count < BODY_STATES);
  told->bodies[told->count++] = *state;
  if (told->look) told->look(told);
  return 0;
}

static PetscErrorCode KeepPoint(const LamProcessState *state, void *ctx)
{
  Told *told = (Told *)ctx;

  assert_true(told->count < BODY_STATES);
  told->points[told->count++] = *state;
  return 0;
}

/* A soft tissue whose lumens grow with the turgor. */
static void MakeMaterial(PetscInt points, Told *told)
{
  const LamRelaxation *relaxation = &told->scene->micro.relaxation;
  Synthetic *material;

  assert_int_equal(SyntheticCreate(points, &told->elastic, &material), 0);
  told->material = told->elastic;
  if (relaxation->terms)
    assert_int_equal(LamRelaxingResponderCreate(told->elastic, relaxation, points, &told->material), 0);
  material->phi = 0.7;
  material->c = 0.05;
  material->respond = BodyRespond;
}

static void FreeMaterial(Told *told)
{
  if (told->material != told->elastic) assert_int_equal(LamResponderDestroy(&told->material), 0);
  assert_int_equal(LamResponderDestroy(&told->elastic), 0);
}

/* Reads the scene, and changes its tolerance where one is given. */
void ReadScene(const char text[], PetscReal tolerance, Told *told)
{
  char whole[4096];

  memset(told, 0, sizeof(*told));
  snprintf(whole, sizeof(whole), BODY_TISSUE "%s", text);
  assert_int_equal(LamSceneReadText("body.yaml", whole, &told->scene), 0);
  if (strstr(text, BODY_RELAXES))
    told->scene->micro.relaxation = (LamRelaxation){.terms = 2, .share = {0.3, 0.3}, .time = {10, 100}};
  if (tolerance > 0) told->scene->process.tolerance = tolerance;
  told->bodies = (LamBodyState *)calloc(BODY_STATES, PetscMax(sizeof(LamBodyState), sizeof(LamProcessState)));
  assert_non_null(told->bodies);
}

void RunBody(Told *told)
{
  PetscInt points;
  LamMacro macro;
  LamBody body;

  assert_int_equal(LamMacroCreate(PETSC_COMM_SELF, &macro), 0);
  told->macro = macro;
  assert_int_equal(LamMacroSetScene(macro, told->scene), 0);
  assert_int_equal(LamBodyCreate(told->scene, macro, &body), 0);
  told->body = body;
  assert_int_equal(LamMacroSetUp(macro), 0);
  assert_int_equal(LamMacroGetPointCount(macro, &points), 0);
  MakeMaterial(points, told);
  assert_int_equal(LamMacroSetResponder(macro, told->material), 0);
  assert_int_equal(LamBodySetMonitor(body, KeepBody, told), 0);
  assert_int_equal(LamBodyRun(body, &told->reason, told->message), 0);
  assert_int_equal(LamBodyGetCounts(body, &told->counts), 0);
  assert_int_equal(LamBodyDestroy(&body), 0);
  assert_int_equal(LamMacroDestroy(&macro), 0);
  FreeMaterial(told);
}

Told FollowBody(const char text[], PetscReal tolerance)
{
  Told told;

  ReadScene(text, tolerance, &told);
  RunBody(&told);
  return told;
}

/* The same, where it must come to its end. */
Told FollowBodyToEnd(const char text[], PetscReal tolerance)
{
  const Told told = FollowBody(text, tolerance);

  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
  return told;
}

/* One material point of the same tissue. */
Told FollowPoint(const char text[], PetscReal tolerance)
{
  LamProcess process;
  Told told;

  ReadScene(text, tolerance, &told);
  MakeMaterial(1, &told);
  assert_int_equal(LamProcessCreate(told.scene, &process), 0);
  assert_int_equal(LamProcessSetResponder(process, told.material), 0);
  assert_int_equal(LamProcessSetMonitor(process, KeepPoint, &told), 0);
  assert_int_equal(LamProcessRun(process, &told.reason, told.message), 0);
  assert_int_equal(LamProcessDestroy(&process), 0);
  FreeMaterial(&told);
  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
  return told;
}

void ForgetTold(Told *told)
{
  assert_int_equal(LamSceneDestroy(&told->scene), 0);
  free(told->bodies);
}

const LamBodyState *LastBody(const Told *told)
{
  return &told->bodies[told->count - 1];
}

/* The first state at an event; NULL: it did not happen. */
const LamBodyState *FindBodyEvent(const Told *told, LamEvent event)
{
  for (PetscInt k = 0; k < told->count; k++)
    if (told->bodies[k].event == event) return &told->bodies[k];
  return NULL;
}

/* Force on the body at a named side, over C1 + C2 and the macro length. */
const PetscReal *BodyReaction(const LamBodyState *state, const char name[])
{
  const LamMacroStep *step = &state->step;

  for (PetscInt s = 0; s < step->boundary_count; s++)
    if (!strcmp(step->boundary[s], name)) return step->reaction[s];
  fail_msg("no side %s", name);
  return NULL;
}
