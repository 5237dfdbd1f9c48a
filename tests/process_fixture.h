/* What tests of processes share: a scene's process followed with direct solves, and its states. */
#ifndef LAM_PROCESS_FIXTURE_H
#define LAM_PROCESS_FIXTURE_H

#include "support/test.h"
#include <lamella/lamella.h>
#include <string.h>

/* The default tissue of one cell; what follows stands in the same file. */
#define PROCESS_CELL                                                                                                   \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  mesh: {along: 4, through: 1}\n"

enum { FOLLOWED_STATES = 4000 };

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamResponder direct;
  LamProcess process;
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE];
  PetscInt count;
  LamProcessState *states; /* [FOLLOWED_STATES] */
} Followed;

static inline PetscErrorCode KeepState(const LamProcessState *state, void *ctx)
{
  Followed *f = (Followed *)ctx;

  assert_true(f->count < FOLLOWED_STATES);
  f->states[f->count++] = *state;
  return 0;
}

static inline PetscErrorCode ChangeModuli(void *ctx, const PetscReal factor[LAM_WALL_PARAMETER_COUNT])
{
  Followed *f = (Followed *)ctx;
  LamMicrostructure micro = f->scene->micro;

  LamWallMultiply(&micro.wall, factor);
  return LamRVEChangeModuli(f->rve, &micro);
}

static inline Followed Follow(const char text[])
{
  Followed f = {0};

  assert_int_equal(LamSceneReadText("process.yaml", text, &f.scene), 0);
  f.states = (LamProcessState *)calloc(FOLLOWED_STATES, sizeof(LamProcessState));
  assert_non_null(f.states);
  assert_int_equal(LamRVECreate(PETSC_COMM_SELF, &f.rve), 0);
  assert_int_equal(LamRVESetMicrostructure(f.rve, &f.scene->micro), 0);
  assert_int_equal(LamRVESetUp(f.rve), 0);
  assert_int_equal(LamRVEResponderCreate(f.rve, 1, &f.direct), 0);
  assert_int_equal(LamProcessCreate(f.scene, &f.process), 0);
  assert_int_equal(LamProcessSetResponder(f.process, &f.direct), 0);
  assert_int_equal(LamProcessSetWalls(f.process, ChangeModuli, &f), 0);
  assert_int_equal(LamProcessSetMonitor(f.process, KeepState, &f), 0);
  assert_int_equal(LamProcessRun(f.process, &f.reason, f.message), 0);
  return f;
}

/* The same, where it must come to its end. */
static inline Followed FollowToEnd(const char text[])
{
  const Followed f = Follow(text);

  if (f.reason != LAM_PROCESS_DONE) fail_msg("%s", f.message);
  return f;
}

static inline void Forget(Followed *f)
{
  assert_int_equal(LamProcessDestroy(&f->process), 0);
  assert_int_equal(f->direct.destroy(&f->direct.ctx), 0);
  assert_int_equal(LamRVEDestroy(&f->rve), 0);
  assert_int_equal(LamSceneDestroy(&f->scene), 0);
  free(f->states);
}

static inline const LamProcessState *LastState(const Followed *f)
{
  return &f->states[f->count - 1];
}

/* The first state at an event; NULL: it did not happen. */
static inline const LamProcessState *FindEvent(const Followed *f, LamEvent event)
{
  for (PetscInt k = 0; k < f->count; k++)
    if (f->states[k].event == event) return &f->states[k];
  return NULL;
}

#endif
