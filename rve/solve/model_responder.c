/*
  A responder of tissue with a lamella whose material points hold models.

  Method. A query is answered by the model of the point (point_model.h) where the model's error is within the accuracy,
  and else by a solve from the state of the point's last solve with the history of its last accepted load, which leaves
  a new model. As long as the iterates of a load step stay within its reach, they see one quadratic potential, and a
  model outlasts the step: nothing is solved anew where the tissue has not changed by more than the accuracy lets it.

  History. What is accepted is that of the load that was asked last, whether it was solved or not: of a model it is that
  of the predicted jumps, so that a point that goes on and then back breaks as much as it would have with a solve at
  each step, but for the model's error. A solve in a step is kept with its model, where the step is accepted; its
  history is not, as an iterate may have gone too far.
*/
#include "point_model.h"
#include "solve.h"
#include <string.h>

typedef struct {
  LamRVEState state, latest; /* of the last solve: accepted, with the accepted history, and in this step */
  LamPointModel held, fresh; /* their models */
  LamLoad asked;             /* last, in this step */
  PetscBool is_asked, is_solved;
} Point;

typedef struct {
  LamRVE rve; /* borrowed */
  PetscReal accuracy;
  PetscInt count;
  Point *points;
  LamBondRates rates;
  LamResponder direct; /* of one point: solves, and repeats what it has just solved */
  LamResponderCounters counters;
  size_t size;      /* of a packed state, bytes */
  char *bytes;      /* [size] */
  PetscInt changes; /* rve->changes of the models */
} Models;

static const LamPointModel *ModelOf(const Point *point)
{
  return point->is_solved ? &point->fresh : &point->held;
}

static PetscErrorCode Solve(Models *models, Point *point, const LamLoad *load, LamResponse *response)
{
  const PetscInt first = 0;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStatePack(point->state, models->bytes));
  PetscCall(LamResponderLoad(models->direct, first, models->bytes));
  models->rve->rates = &models->rates;
  PetscCall(LamResponderRespond(models->direct, 1, load, &first, response));
  PetscCall(LamResponderAccept(models->direct));
  PetscCall(LamResponderSave(models->direct, first, models->bytes));
  PetscCall(LamRVEStateUnpack(models->bytes, point->latest));
  point->fresh.curvature = ModelOf(point)->curvature;
  PetscCall(LamPointModelTake(models->rve, response, &point->fresh));
  models->rve->rates = NULL;
  point->is_solved = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Learns from a solve behind a model's guess: the error of the guess, and that of the new model where the last solve
   was, which is the larger one where the response bends more and more. */
static PetscErrorCode Learn(Models *models, const LamResponse *before, const LamResponse *guess,
                            const LamModelError *error, LamPointModel *fresh)
{
  const LamStressScale scale = LamStressScaleOf(&models->rve->micro);
  LamModelError back_error;
  LamResponse back;

  PetscFunctionBeginUser;
  PetscCall(LamPointModelRespond(models->rve, fresh, &before->load, &back, &back_error));
  LamPointModelLearn(
      error, PetscMax(LamStressError(scale, guess->P, fresh->response.P), LamStressError(scale, back.P, before->P)),
      &fresh->curvature);
  PetscFunctionReturn(0);
}

static PetscErrorCode RespondAt(Models *models, Point *point, const LamLoad *load, LamResponse *response)
{
  const LamPointModel *model = ModelOf(point);
  const PetscBool was_known = model->known;
  LamModelError error;
  LamResponse guess, before;

  PetscFunctionBeginUser;
  point->asked = *load;
  point->is_asked = PETSC_TRUE;
  if (model->known) {
    PetscCall(LamPointModelRespond(models->rve, model, load, response, &error));
    if (response->error_estimate <= models->accuracy) {
      models->counters.hits++;
      models->counters.interpolated++;
      PetscFunctionReturn(0);
    }
    guess = *response;
    before = model->response;
  }
  PetscCall(Solve(models, point, load, response));
  if (was_known && point->fresh.known) PetscCall(Learn(models, &before, &guess, &error, &point->fresh));
  PetscFunctionReturn(0);
}

/* Models of other walls are none. */
static void ForgetChanged(Models *models)
{
  if (models->changes == models->rve->changes) return;
  for (PetscInt p = 0; p < models->count; ++p)
    models->points[p].held.known = models->points[p].fresh.known = PETSC_FALSE;
  models->changes = models->rve->changes;
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  Models *models = (Models *)ctx;
  LamResponderCounters solves;

  PetscFunctionBeginUser;
  ForgetChanged(models);
  for (PetscInt i = 0; i < n; ++i) {
    PetscCheck(points && points[i] >= 0 && points[i] < models->count, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "models are those of material points 0 to %d, not of %d", (int)models->count - 1,
               points ? (int)points[i] : -1);
    PetscCall(RespondAt(models, &models->points[points[i]], &loads[i], &responses[i]));
  }
  solves = LamResponderGetCounters(models->direct);
  models->counters.queries += n;
  models->counters.solves = solves.solves;
  models->counters.failures = solves.failures;
  models->counters.solve_seconds = solves.solve_seconds;
  PetscFunctionReturn(0);
}

/* The last solve becomes that of the point, and the history that of the load asked last. */
static PetscErrorCode AcceptPoint(Models *models, Point *point)
{
  const PetscBool at_solve =
      (PetscBool)(point->is_solved && !memcmp(&point->asked, &point->latest->load, sizeof(LamLoad)));
  LamRVEState state = point->state;

  PetscFunctionBeginUser;
  if (point->is_solved) {
    const LamPointModel held = point->held;

    PetscCall(LamRVEStateCopy(point->latest, state));
    point->held = point->fresh;
    point->fresh = held;
  }
  if (at_solve) {
    point->held.spent = state->spent;
    PetscCall(PetscArraycpy(point->held.history, state->history, state->points));
  } else if (point->is_asked && point->held.known) {
    LamPointModelAccept(models->rve, &point->asked, &point->held);
    state->spent = point->held.spent;
    PetscCall(PetscArraycpy(state->history, point->held.history, state->points));
  }
  point->is_asked = point->is_solved = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  Models *models = (Models *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < models->count; ++p) PetscCall(AcceptPoint(models, &models->points[p]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Reject(void *ctx)
{
  Models *models = (Models *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < models->count; ++p) models->points[p].is_asked = models->points[p].is_solved = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* ---- serialisation ---- */

enum { PARTS = 4 };

typedef struct {
  void *at;
  size_t bytes;
} Part;

/* The model of a point; its history is that of its state. */
static void FindParts(const Models *models, Point *point, Part parts[PARTS])
{
  const size_t bonds = (size_t)models->rve->layer->count;
  const Part all[PARTS] = {{&point->held.known, sizeof(point->held.known)},
                           {&point->held.curvature, sizeof(point->held.curvature)},
                           {&point->held.response, sizeof(point->held.response)},
                           {point->held.bond, bonds * sizeof(*point->held.bond)}};

  memcpy(parts, all, sizeof(all));
}

static PetscErrorCode StateSize(void *ctx, size_t *bytes)
{
  Models *models = (Models *)ctx;
  Part parts[PARTS];

  PetscFunctionBeginUser;
  *bytes = 0;
  if (!models->count) PetscFunctionReturn(0);
  *bytes = models->size;
  FindParts(models, &models->points[0], parts);
  for (PetscInt k = 0; k < PARTS; ++k) *bytes += parts[k].bytes;
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(void *ctx, PetscInt p, void *bytes)
{
  Models *models = (Models *)ctx;
  char *to = (char *)bytes + models->size;
  Part parts[PARTS];

  PetscFunctionBeginUser;
  memset(bytes, 0, models->size); /* cells that can be sealed, and are not */
  PetscCall(LamRVEStatePack(models->points[p].state, bytes));
  FindParts(models, &models->points[p], parts);
  for (PetscInt k = 0; k < PARTS; to += parts[k++].bytes) PetscCall(PetscMemcpy(to, parts[k].at, parts[k].bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(void *ctx, PetscInt p, const void *bytes)
{
  Models *models = (Models *)ctx;
  const char *from = (const char *)bytes + models->size;
  LamRVEState state = models->points[p].state;
  Part parts[PARTS];

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateUnpack(bytes, state));
  PetscCall(PetscArraycpy(models->points[p].held.history, state->history, state->points));
  models->points[p].held.spent = state->spent;
  FindParts(models, &models->points[p], parts);
  for (PetscInt k = 0; k < PARTS; from += parts[k++].bytes) PetscCall(PetscMemcpy(parts[k].at, from, parts[k].bytes));
  models->points[p].is_asked = models->points[p].is_solved = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* ---- lifecycle ---- */

static PetscErrorCode Destroy(void **ctx)
{
  Models *models = (Models *)*ctx;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < models->count; ++p) {
    Point *point = &models->points[p];

    PetscCall(LamRVEStateDestroy(&point->state));
    PetscCall(LamRVEStateDestroy(&point->latest));
    PetscCall(LamPointModelDestroy(&point->held));
    PetscCall(LamPointModelDestroy(&point->fresh));
  }
  PetscCall(LamResponderDestroy(&models->direct));
  PetscCall(PetscFree2(models->rates.bond, models->rates.before));
  PetscCall(PetscFree(models->bytes));
  PetscCall(PetscFree(models->points));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreatePoint(LamRVE rve, Point *point)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &point->state));
  PetscCall(LamRVEStateCreate(rve, &point->latest));
  PetscCall(LamPointModelCreate(rve, &point->held));
  PetscCall(LamPointModelCreate(rve, &point->fresh));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEModelResponderCreate(LamRVE rve, PetscInt points, PetscReal accuracy, LamResponder *responder)
{
  const LamResponderFunctions functions = {.respond = Respond,
                                           .accept = Accept,
                                           .reject = Reject,
                                           .destroy = Destroy,
                                           .state_size = StateSize,
                                           .save = Save,
                                           .load = Load};
  Models *models;

  PetscFunctionBeginUser;
  PetscCheck(accuracy > 0.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "accuracy %g must be positive",
             (double)accuracy);
  PetscCheck(rve->layer, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "only tissue with a lamella has such models");
  PetscCall(PetscNew(&models));
  models->rve = rve;
  models->accuracy = accuracy;
  models->count = points;
  models->changes = rve->changes;
  PetscCall(PetscCalloc1(points, &models->points));
  for (PetscInt p = 0; p < points; ++p) PetscCall(CreatePoint(rve, &models->points[p]));
  PetscCall(PetscCalloc2(rve->layer->count, &models->rates.bond, rve->layer->count, &models->rates.before));
  PetscCall(LamRVEResponderCreate(rve, 1, &models->direct));
  PetscCall(LamResponderGetStateSize(models->direct, &models->size));
  PetscCall(PetscCalloc1(models->size, &models->bytes));
  PetscCall(LamResponderCreate(&functions, models, &models->counters, responder));
  PetscFunctionReturn(0);
}
