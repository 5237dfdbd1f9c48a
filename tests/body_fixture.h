/* What tests of bodies that change in time share: a scene followed with the synthetic material, and what is told. */
#ifndef LAM_BODY_FIXTURE_H
#define LAM_BODY_FIXTURE_H

#include "support/test.h"
#include <lamella/lamella.h>
#include "synthetic_responder.h"
#include <string.h>

/* C1 + C2 is 0.11 MPa, the apothem 75 um; what the walls are the synthetic material does not know. */
#define BODY_TISSUE                                                                                                    \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}\n"                                                          \
  "  turgor: {pressure: 0.05 MPa}\n"                                                                                   \
  "strength: {lamella_normal: 0.1 MPa}\n"

enum { BODY_STATES = 4000 };

typedef struct {
  LamScene *scene;
  LamResponder material;
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE];
  LamProcessCounts counts;
  PetscInt count;
  union {
    LamBodyState *bodies; /* [BODY_STATES] */
    LamProcessState *points;
  };
} Told;

/* The lamella bears the mean stress of the plane. */
static inline PetscErrorCode BodyRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                         LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(SyntheticRespond(ctx, n, loads, points, responses));
  for (PetscInt i = 0; i < n; i++) responses[i].max_traction = 0.5 * (responses[i].P[0] + responses[i].P[4]);
  PetscFunctionReturn(0);
}

static inline PetscErrorCode KeepBody(const LamBodyState *state, void *ctx)
{
  Told *told = (Told *)ctx;

  assert_true(told->count < BODY_STATES);
  told->bodies[told->count++] = *state;
  return 0;
}

static inline PetscErrorCode KeepPoint(const LamProcessState *state, void *ctx)
{
  Told *told = (Told *)ctx;

  assert_true(told->count < BODY_STATES);
  told->points[told->count++] = *state;
  return 0;
}

/* A soft tissue whose lumens grow with the turgor. */
static inline void MakeMaterial(PetscInt points, Told *told)
{
  Synthetic *material;

  assert_int_equal(SyntheticCreate(points, &told->material, &material), 0);
  material->phi = 0.7;
  material->c = 0.05;
  told->material.respond = BodyRespond;
}

/* Reads the scene, and changes its tolerance where one is given. */
static inline void ReadScene(const char text[], PetscReal tolerance, Told *told)
{
  memset(told, 0, sizeof(*told));
  assert_int_equal(LamSceneReadText("body.yaml", text, &told->scene), 0);
  if (tolerance > 0) told->scene->process.tolerance = tolerance;
  told->bodies = (LamBodyState *)calloc(BODY_STATES, PetscMax(sizeof(LamBodyState), sizeof(LamProcessState)));
  assert_non_null(told->bodies);
}

static inline void RunBody(Told *told)
{
  PetscInt points;
  LamMacro macro;
  LamBody body;

  assert_int_equal(LamMacroCreate(PETSC_COMM_SELF, &macro), 0);
  assert_int_equal(LamMacroSetScene(macro, told->scene), 0);
  assert_int_equal(LamBodyCreate(told->scene, macro, &body), 0);
  assert_int_equal(LamMacroSetUp(macro), 0);
  assert_int_equal(LamMacroGetPointCount(macro, &points), 0);
  MakeMaterial(points, told);
  assert_int_equal(LamMacroSetResponder(macro, &told->material), 0);
  assert_int_equal(LamBodySetMonitor(body, KeepBody, told), 0);
  assert_int_equal(LamBodyRun(body, &told->reason, told->message), 0);
  assert_int_equal(LamBodyGetCounts(body, &told->counts), 0);
  assert_int_equal(LamBodyDestroy(&body), 0);
  assert_int_equal(LamMacroDestroy(&macro), 0);
  assert_int_equal(told->material.destroy(&told->material.ctx), 0);
}

static inline Told FollowBody(const char text[], PetscReal tolerance)
{
  Told told;

  ReadScene(text, tolerance, &told);
  RunBody(&told);
  return told;
}

/* The same, where it must come to its end. */
static inline Told FollowBodyToEnd(const char text[], PetscReal tolerance)
{
  const Told told = FollowBody(text, tolerance);

  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
  return told;
}

/* One material point of the same tissue. */
static inline Told FollowPoint(const char text[], PetscReal tolerance)
{
  LamProcess process;
  Told told;

  ReadScene(text, tolerance, &told);
  MakeMaterial(1, &told);
  assert_int_equal(LamProcessCreate(told.scene, &process), 0);
  assert_int_equal(LamProcessSetResponder(process, &told.material), 0);
  assert_int_equal(LamProcessSetMonitor(process, KeepPoint, &told), 0);
  assert_int_equal(LamProcessRun(process, &told.reason, told.message), 0);
  assert_int_equal(LamProcessDestroy(&process), 0);
  assert_int_equal(told.material.destroy(&told.material.ctx), 0);
  if (told.reason != LAM_PROCESS_DONE) fail_msg("%s", told.message);
  return told;
}

static inline void ForgetTold(Told *told)
{
  assert_int_equal(LamSceneDestroy(&told->scene), 0);
  free(told->bodies);
}

static inline const LamBodyState *LastBody(const Told *told)
{
  return &told->bodies[told->count - 1];
}

/* The first state at an event; NULL: it did not happen. */
static inline const LamBodyState *FindBodyEvent(const Told *told, LamEvent event)
{
  for (PetscInt k = 0; k < told->count; k++)
    if (told->bodies[k].event == event) return &told->bodies[k];
  return NULL;
}

/* Force on the body at a named side, over C1 + C2 and the macro length. */
static inline const PetscReal *BodyReaction(const LamBodyState *state, const char name[])
{
  const LamMacroStep *step = &state->step;

  for (PetscInt s = 0; s < step->boundary_count; s++)
    if (!strcmp(step->boundary[s], name)) return step->reaction[s];
  fail_msg("no side %s", name);
  return NULL;
}

#endif
