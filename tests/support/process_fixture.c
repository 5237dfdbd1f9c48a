#include "process_fixture.h"
#include "tissue.h"

enum { FOLLOWED_STATES = 4000 };

static PetscErrorCode KeepState(const LamProcessState *state, void *ctx)
{
  Followed *f = (Followed *)ctx;

  assert_true(f->count < FOLLOWED_STATES);
  f->states[f->count++] = *state;
  return 0;
}

static PetscErrorCode ChangeModuli(void *ctx, const PetscReal factor[LAM_WALL_PARAMETER_COUNT])
{
  Followed *f = (Followed *)ctx;
  LamMicrostructure micro = f->scene->micro;

  LamWallMultiply(&micro.wall, factor);
  return LamRVEChangeModuli(f->rve, &micro);
}

Followed Follow(const char text[])
{
  Followed f = {0};

  assert_int_equal(LamSceneReadText("process.yaml", text, &f.scene), 0);
  f.states = (LamProcessState *)calloc(FOLLOWED_STATES, sizeof(LamProcessState));
  assert_non_null(f.states);
  assert_int_equal(NewTissue(&f.scene->micro, &f.rve, NULL), 0);
  assert_int_equal(LamRVEResponderCreate(f.rve, 1, &f.direct), 0);
  assert_int_equal(LamProcessCreate(f.scene, &f.process), 0);
  assert_int_equal(LamProcessSetResponder(f.process, f.direct), 0);
  assert_int_equal(LamProcessSetWalls(f.process, ChangeModuli, &f), 0);
  assert_int_equal(LamProcessSetMonitor(f.process, KeepState, &f), 0);
  assert_int_equal(LamProcessRun(f.process, &f.reason, f.message), 0);
  return f;
}

Followed FollowToEnd(const char text[])
{
  const Followed f = Follow(text);

  if (f.reason != LAM_PROCESS_DONE) fail_msg("%s", f.message);
  return f;
}

void Forget(Followed *f)
{
  assert_int_equal(LamProcessDestroy(&f->process), 0);
  assert_int_equal(LamResponderDestroy(&f->direct), 0);
  assert_int_equal(LamRVEDestroy(&f->rve), 0);
  assert_int_equal(LamSceneDestroy(&f->scene), 0);
  free(f->states);
}

const LamProcessState *LastState(const Followed *f)
{
  return &f->states[f->count - 1];
}

const LamProcessState *FindEvent(const Followed *f, LamEvent event)
{
  for (PetscInt k = 0; k < f->count; k++)
    if (f->states[k].event == event) return &f->states[k];
  return NULL;
}
