/*
  Steps of tissue with a lamella: their work, and where they jump.

  A state depends on the way to it, and a solver that leaves the branch of the state before, where that has not ended,
  breaks what would have held. Energy tells: on a branch the change of Psi is the work of its derivatives, and a jump
  loses what is missing (contact_jump.c).

  Method. A step that may have jumped, or breaks much, is taken again in halves, and these again: on the branch of the
  exact law as far as it goes, so that a jump is taken once, in the last and smallest part. The state is that at the end
  of them; what they lose is `released`. Work is summed over the parts, so that

    work = stored + dissipated + released

  holds to second order in the step but for the part with the jump, which is 2^-HALVINGS of it.
*/
#include "solve.h"

#define HALVINGS 6
/* For a model of a material point, within whose reach, as long as a part or longer, jumps are not looked for at all. */
#define MODEL_HALVINGS 3
#define BUDGET 1000 /* iterations, after which what is left of a step is taken at once */
/* A jump loses at least these shares of the energy dissipated in the step and of its turnover: less is curvature, in
   nine of ten suspicious steps of random programs. */
#define LOST 0.005
#define LOST_TURNOVER 0.15
#define STAYS                                                                                                          \
  (1.0 / 16.0)   /* share of the defect of the whole step that the last part keeps of a jump; of curvature 4^-HALVINGS \
                  */
#define MOST 0.1 /* share of the lamella that one step may break; with more its curvature hides what a jump loses */

static PetscBool BreaksMuch(LamRVE rve, const LamRVEState from, const LamRVEState to)
{
  return (PetscBool)(to->spent - from->spent > MOST * rve->layer->toughness[0]);
}

/* Most by which energies of different laws of contact differ, per V0: walls of the smooth one lie in each other by a
   part of its width, and there is one length of interface, in apothems, to one area. */
static PetscReal BetweenLaws(const LamRVEState from, const LamRVEState to)
{
  const PetscReal most = PetscMax(LamLargestEntry(LAM_F_COUNT, from->energy + 1),
                                  LamLargestEntry(LAM_F_COUNT, to->energy + 1)); /* P, of the order of pressures */

  return PetscAbsReal(from->width - to->width) * most;
}

static PetscBool HasJumped(const LamRVEState from, const LamRVEState to, const LamStepWork *step)
{
  return (PetscBool)(-step->defect > LAM_LEAST_LOSS + BetweenLaws(from, to) &&
                     -step->defect > LOST * (to->spent - from->spent) &&
                     -step->defect > LOST_TURNOVER * step->turnover);
}

static PetscBool IsTooLong(LamRVE rve, const LamRVEState from, const LamRVEState to, const LamStepWork *step)
{
  return (PetscBool)(HasJumped(from, to, step) || BreaksMuch(rve, from, to));
}

/* Where a step goes: a load, and under prescribed stress P with guesses of the free components of F. */
typedef struct {
  LamLoad load;
  const LamStressControl *given; /* NULL: all of F is given */
  LamStressControl control;      /* its P */
} Target;

/* Half of the way there, in half of the time. */
static Target Middle(const LamRVEState at, const Target *end)
{
  Target middle = *end;

  middle.load = LamLoadBetween(&at->load, &end->load, 0.5);
  middle.load.duration = 0.5 * end->load.duration;
  for (PetscInt q = 0; q < LAM_F_COUNT && end->given; ++q) {
    const PetscInt c = LamFComponent[q];

    if (!end->given->given[c]) continue;
    middle.load.F[c] = at->load.F[c];
    middle.control.P[c] = 0.5 * (at->energy[1 + q] + end->control.P[c]);
  }
  return middle;
}

typedef struct {
  PetscReal first; /* defect of the whole step */
  PetscReal lost;  /* in jumps */
  PetscInt iterations, factorisations;
  LamResponse response; /* of the last state */
} Retracing;

static PetscErrorCode SolveTarget(LamRVE rve, LamRVEState at, const Target *target, LamRVEState end, Retracing *r)
{
  LamLoad load = target->load;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(at, end));
  for (PetscInt i = 0; i < 9 && target->given; ++i)
    if (target->given->given[i]) load.F[i] = at->load.F[i];
  if (target->given)
    PetscCall(LamRVESolveMixed(rve, &load, &target->control, end, &r->response));
  else
    PetscCall(LamRVESolve(rve, &load, end, &r->response));
  r->iterations += r->response.newton_iterations;
  r->factorisations += r->response.factorisations;
  PetscFunctionReturn(0);
}

/* Takes the step from `at` to a target, in halves while it is too long; on return `at` is the state there. */
static PetscErrorCode Retrace(LamRVE rve, LamRVEState at, const Target *target, PetscInt halvings, Retracing *r)
{
  const Target middle = Middle(at, target);
  Target rest = *target;
  PetscBool too_long;
  LamRVEState end;

  PetscFunctionBeginUser;
  if (r->iterations > BUDGET) halvings = 0;
  PetscCall(LamRVEStateCreate(rve, &end));
  rve->near_only = (PetscBool)(halvings > 0 && at->solved && at->width == 0.0);
  PetscCall(SolveTarget(rve, at, target, end, r));
  too_long = rve->near_only;
  rve->near_only = PETSC_FALSE;
  if (r->response.status == LAM_CONVERGED) {
    const LamStepWork step = LamStepWorkOf(at, end);

    too_long = IsTooLong(rve, at, end, &step);
    if (!too_long || halvings == 0) {
      if (HasJumped(at, end, &step) && step.defect < STAYS * r->first) r->lost -= step.defect;
      end->work = at->work + step.work;
      PetscCall(LamRVEStateCopy(end, at));
    }
  }
  if (too_long && halvings > 0 && !rve->work.stopped) {
    PetscCall(Retrace(rve, at, &middle, halvings - 1, r));
    rest.load.duration = middle.load.duration;
    if (r->response.status == LAM_CONVERGED) PetscCall(Retrace(rve, at, &rest, halvings - 1, r));
  }
  PetscCall(LamRVEStateDestroy(&end));
  PetscFunctionReturn(0);
}

/* Replaces a state and its response by those at the end of smaller steps; where these fail, it stays. */
static PetscErrorCode TakeAgain(LamRVE rve, LamRVEState before, const Target *end, LamRVEState state, Retracing *r)
{
  const PetscInt halvings = rve->rates ? MODEL_HALVINGS : HALVINGS;
  const Target middle = Middle(before, end);
  const LamResponse found = r->response;
  Target rest = *end;
  LamRVEState at;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &at));
  PetscCall(LamRVEStateCopy(before, at));
  PetscCall(Retrace(rve, at, &middle, halvings - 1, r));
  rest.load.duration = middle.load.duration;
  if (r->response.status == LAM_CONVERGED) PetscCall(Retrace(rve, at, &rest, halvings - 1, r));
  if (r->response.status == LAM_CONVERGED) {
    PetscCall(LamRVEStateCopy(at, state));
  } else {
    PetscCall(LamTakeState(rve, state));
    r->response = found;
    r->lost = PetscMax(0.0, -r->first);
  }
  PetscCall(LamRVEStateDestroy(&at));
  PetscFunctionReturn(0);
}

PetscErrorCode LamLayerStep(LamRVE rve, LamRVEState before, const LamStressControl *control, LamRVEState state,
                            LamResponse *response)
{
  const LamStepWork step = LamStepWorkOf(before, state);
  Target end = {.load = state->load, .given = control};
  Retracing r = {.first = step.defect,
                 .iterations = response->newton_iterations,
                 .factorisations = response->factorisations,
                 .response = *response};

  PetscFunctionBeginUser;
  if (response->status != LAM_CONVERGED || rve->work.stopped) PetscFunctionReturn(0);
  if (control) end.control = *control;
  state->work = before->work + step.work;
  rve->looks_back = PETSC_TRUE;
  if (IsTooLong(rve, before, state, &step)) PetscCall(TakeAgain(rve, before, &end, state, &r));
  rve->looks_back = PETSC_FALSE;
  *response = r.response;
  response->newton_iterations = r.iterations;
  response->factorisations = r.factorisations;
  response->jumped = (PetscBool)(r.lost > LAM_LEAST_LOSS);
  if (response->jumped) {
    response->energy_released = r.lost;
    state->released += r.lost;
  }
  response->released = state->released;
  response->work = state->work;
  PetscFunctionReturn(0);
}

PetscErrorCode LamHistoryStep(LamRVE rve, LamRVEState before, const LamStressControl *control, LamRVEState state,
                              LamResponse *response)
{
  PetscFunctionBeginUser;
  if (rve->layer) {
    PetscCall(LamLayerStep(rve, before, control, state, response));
  } else if (LamResponseHasFields(response)) {
    state->work = before->work + LamStepWorkOf(before, state).work;
    response->work = state->work;
  }
  PetscFunctionReturn(0);
}
