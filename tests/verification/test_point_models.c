/* Models of material points whose lamella breaks: accuracy, branches, history, what is given up and what is restored.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "support/lamella_tissue.h"
#include "support/rve_fixture.h"

static const double TURGOR = 0.1;

typedef struct {
  LamMicrostructure micro;
  LamRVE rve;
  LamResponder models, direct;
} Tissue;

/* range: as of LamellaTissue. */
static void CreateOf(double range, double accuracy, Tissue *t)
{
  LamMicrostructure micro = LamellaTissue(range);

  micro.sharpness = LAM_SHARPNESS_SMOOTH; /* one law of contact in all states */
  micro.contact_width = LAM_USUAL_WIDTH;
  t->micro = micro;
  t->rve = NewRVE(&micro);
  CHECK(LamRVEModelResponderCreate(t->rve, 1, accuracy, &t->models));
  CHECK(LamRVEResponderCreate(t->rve, 1, &t->direct));
}

static void Create(Tissue *t, double accuracy)
{
  CreateOf(0.2, accuracy, t);
}

static void Destroy(Tissue *t)
{
  CHECK(LamResponderDestroy(&t->models));
  CHECK(LamResponderDestroy(&t->direct));
  CHECK(LamRVEDestroy(&t->rve));
}

/* A stretch across with some shear, e of each. */
static LamLoad At(double e)
{
  return PlaneLoad(1, 0.5 * e, 0, 1 + e, TURGOR);
}

static LamResponse AskLoad(LamResponder responder, LamLoad load)
{
  const PetscInt point = 0;
  LamResponse r;

  CHECK(LamResponderRespond(responder, 1, &load, &point, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

static LamResponse Ask(LamResponder responder, double e)
{
  return AskLoad(responder, At(e));
}

static LamResponse Take(LamResponder responder, double e)
{
  const LamResponse r = Ask(responder, e);

  CHECK(LamResponderAccept(responder));
  return r;
}

static double Difference(const LamResponse *a, const LamResponse *b)
{
  double sum = 0;

  for (int i = 0; i < 9; i++) sum += (a->P[i] - b->P[i]) * (a->P[i] - b->P[i]);
  return sqrt(sum);
}

/* Far on the softening branch, where all that breaks goes on breaking. */
static const double SOFTENED = 0.12;

static void Soften(LamResponder responder)
{
  for (int k = 1; k <= 6; k++) assert_true(isfinite(Take(responder, (SOFTENED - 1e-6) * k / 6).dissipated));
  Take(responder, SOFTENED);
}

static void Copy(LamResponder from, LamResponder to)
{
  size_t size;
  void *bytes;

  CHECK(LamResponderGetStateSize(from, &size));
  bytes = malloc(size);
  CHECK(LamResponderSave(from, 0, bytes));
  CHECK(LamResponderLoad(to, 0, bytes));
  free(bytes);
}

/* Models from the solves of a softened point, which answer whatever the estimate; `direct` is at the same state. */
static void CreateSoftened(Tissue *t)
{
  LamResponder solves;

  Create(t, 1e6);
  CHECK(LamRVEModelResponderCreate(t->rve, 1, 1e-15, &solves));
  Soften(solves);
  Soften(t->direct);
  Copy(solves, t->models);
  CHECK(LamResponderDestroy(&solves));
}

/* ---- accuracy ---- */

/* Where all points of the lamella stay on their branch, stress and dissipation are those of a solve but for terms of
   second order in the change of the load, along whichever direction. */
TEST(AModelIsOfSecondOrder)
{
  const LamLoad ways[2] = {PlaneLoad(0, 0.5, 0, 1, 0), PlaneLoad(0.1, 0.3, -0.2, 1, 0)};
  Tissue t;

  CreateSoftened(&t);
  for (int w = 0; w < 2; w++) {
    double of_P[2], of_spent[2];

    for (int k = 0; k < 2; k++) {
      const double step = 2e-5 / (1 << k);
      LamLoad load = At(SOFTENED);
      LamResponse model, solve;

      for (int i = 0; i < 9; i++) load.F[i] += i < 8 ? step * ways[w].F[i] : 0;
      model = AskLoad(t.models, load);
      solve = AskLoad(t.direct, load);
      assert_int_equal(model.source, LAM_SOURCE_DATABASE);
      assert_true(solve.dissipated > Ask(t.direct, SOFTENED).dissipated);
      of_P[k] = Difference(&model, &solve);
      of_spent[k] = fabs(model.dissipated - solve.dissipated);
      assert_near(model.stored + model.dissipated, model.energy, 1e-12);
      assert_near(model.work, solve.work, 1e-10);
    }
    assert_near(of_P[0] / of_P[1], 4, 0.2);
    assert_near(of_spent[0] / of_spent[1], 4, 0.2);
  }
  Destroy(&t);
}

/* Where points change their branch, on the way on and back, the error is of first order, and the estimate knows it. */
TEST(TheEstimateKnowsTheBranch)
{
  const double steps[] = {-4e-3, -1e-3, -1e-4, 5e-4, 2e-3, 8e-3};
  Tissue t;

  CreateSoftened(&t);
  for (size_t k = 0; k < sizeof(steps) / sizeof(steps[0]); k++) {
    const LamResponse model = Ask(t.models, SOFTENED + steps[k]), solve = Ask(t.direct, SOFTENED + steps[k]);
    const double error = LamStressError(LamStressScaleOf(&t.micro), model.P, solve.P);

    assert_true(error < 4 * model.error_estimate && error > 0.25 * model.error_estimate);
    if (steps[k] < 0) assert_true(error > -0.5 * steps[k]); /* back on the softening branch */
  }
  Destroy(&t);
}

/* Going on is within the reach of the model where going back as far is not, which is solved, and then has a model. */
TEST(UnloadingIsSolved)
{
  const double step = 1e-3;
  Tissue t;

  Create(&t, 0.01);
  Soften(t.models);
  assert_int_equal(Ask(t.models, SOFTENED + step).source, LAM_SOURCE_DATABASE);
  assert_int_equal(Take(t.models, SOFTENED - step).source, LAM_SOURCE_SOLVE);
  assert_int_equal(Take(t.models, SOFTENED - 2 * step).source, LAM_SOURCE_DATABASE);
  assert_int_equal(Take(t.models, SOFTENED - 0.5 * step).source, LAM_SOURCE_DATABASE);
  Destroy(&t);
}

/* ---- history ---- */

/* A program of small steps on, back and on again, with jumps: points answered by models break as those that are solved.
   A model may be late for a jump by its reach; the solve behind it makes up for that. */
TEST(ModelsBreakAsSolvesDo)
{
  const double turns[] = {0.15, 0.09, 0.17, 0};
  double at = SOFTENED;
  LamResponderCounters counters;
  Tissue t;

  Create(&t, 0.01);
  Soften(t.models);
  Soften(t.direct);
  for (size_t turn = 0; turn < sizeof(turns) / sizeof(turns[0]); turn++)
    for (const double way = turns[turn] > at ? 0.002 : -0.002; fabs(turns[turn] - at) > 1e-9; at += way) {
      const LamResponse model = Take(t.models, at + way), solve = Take(t.direct, at + way);
      const double share = model.source == LAM_SOURCE_SOLVE ? 0.015 : 0.1;

      assert_true(LamStressError(LamStressScaleOf(&t.micro), model.P, solve.P) < (share < 0.1 ? 0.015 : 0.05));
      assert_near(model.broken_fraction, solve.broken_fraction, share * solve.broken_fraction);
      assert_near(model.dissipated, solve.dissipated, share * solve.dissipated);
      assert_near(model.stored, solve.stored, share * solve.dissipated);
    }
  counters = LamResponderGetCounters(t.models);
  assert_true(counters.hits > counters.queries / 2 && counters.hits + counters.solves == counters.queries);
  Destroy(&t);
}

/* Back from where a model has answered, and been accepted, the branch is that of what broke there. */
TEST(WhatAModelBreaksStaysBroken)
{
  const double step = 0.002;
  LamResponse on, back;
  Tissue t;

  CreateSoftened(&t);
  on = Take(t.models, SOFTENED + step);
  back = Ask(t.models, SOFTENED);
  assert_true(on.dissipated > Ask(t.direct, SOFTENED).dissipated);
  assert_near(back.dissipated, on.dissipated, 1e-15);
  CHECK(LamResponderReject(t.models));
  Destroy(&t);
}

/* What Newton's method asks in between, and a step that is given up, leave nothing. */
TEST(WhatIsNotAcceptedLeavesNothing)
{
  LamResponse alone, after;
  Tissue t;

  Create(&t, 0.01);
  Soften(t.models);
  alone = Ask(t.models, SOFTENED + 0.02);
  CHECK(LamResponderReject(t.models));
  assert_true(Ask(t.models, SOFTENED + 0.2).broken_fraction > alone.broken_fraction);
  CHECK(LamResponderReject(t.models));
  after = Ask(t.models, SOFTENED + 0.02);
  assert_memory_equal(after.P, alone.P, sizeof(alone.P));
  assert_true(after.dissipated == alone.dissipated && after.work == alone.work && after.source == alone.source);
  Destroy(&t);
}

/* A point that is saved and loaded, also while a model answers for it, goes on bit for bit. */
TEST(ALoadedPointGoesOn)
{
  const double program[] = {0.122, 0.125, 0.14, 0.13, 0.12, 0.16};
  LamResponder other;
  Tissue t;

  Create(&t, 0.01);
  CHECK(LamRVEModelResponderCreate(t.rve, 1, 0.01, &other));
  Soften(t.models);
  (void)Take(t.models, SOFTENED + 0.0005);
  Copy(t.models, other);
  for (size_t k = 0; k < sizeof(program) / sizeof(program[0]); k++) {
    const LamResponse r = Take(t.models, program[k]), q = Take(other, program[k]);

    assert_memory_equal(r.P, q.P, sizeof(r.P));
    assert_true(r.source == q.source && r.dissipated == q.dissipated && r.work == q.work);
  }
  CHECK(LamResponderDestroy(&other));
  Destroy(&t);
}

/* ---- jumps ---- */

/* Stretched in steps until the point jumps in one, which is not accepted; its end. */
static double StretchToJump(LamResponder responder)
{
  const double step = 0.002;
  double e = step;

  while (!Ask(responder, e).jumped) {
    CHECK(LamResponderAccept(responder));
    e += step;
    assert_true(e < 0.3);
  }
  return e;
}

/* Solved directly, what has jumped in a load step stays behind the jump where Newton's method asks nearby, and only
   there: the body may be in equilibrium on neither side. */
TEST(AJumpOfAStepStays)
{
  LamResponse jumped, near, far;
  double e;
  Tissue t;

  CreateOf(0.05, 0.01, &t);
  e = StretchToJump(t.direct);
  jumped = Ask(t.direct, e);
  near = Ask(t.direct, e - 5e-4);
  assert_true(near.dissipated == jumped.dissipated && near.released == jumped.released);
  far = Ask(t.direct, e - 1.9e-3);
  assert_true(far.dissipated < jumped.dissipated);
  Destroy(&t);
}

/* A model behind a jump is one of the branch there, on which it is asked again. */
TEST(AModelBehindAJumpIsOfItsBranch)
{
  LamResponse jumped, near;
  double e;
  Tissue t;

  CreateOf(0.05, 0.01, &t);
  e = StretchToJump(t.models);
  jumped = Ask(t.models, e);
  near = Ask(t.models, e + 1e-5);
  assert_int_equal(near.source, LAM_SOURCE_DATABASE);
  assert_near(near.dissipated, jumped.dissipated, 1e-3 * jumped.dissipated);
  assert_true(near.released == jumped.released && near.released > 0 && !near.jumped);
  Destroy(&t);
}

/* ---- input ---- */

TEST(OnlyTissueWithALamellaHasModels)
{
  LamMicrostructure micro = LamellaTissue(0.2);
  LamResponder responder;
  LamRVE rve;

  micro.interface = LAM_INTERFACE_CONTACT;
  rve = NewRVE(&micro);
  CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  assert_int_equal(LamRVEModelResponderCreate(rve, 1, 0.01, &responder), PETSC_ERR_ARG_WRONGSTATE);
  CHECK(PetscPopErrorHandler());
  CHECK(LamRVEDestroy(&rve));
}
