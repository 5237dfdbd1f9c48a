/*
  Safe tier of prescribed stress: continuation, then descent.

  Method. (i) Continuation: stress, prescribed components of F, turgor and cohesion follow a straight path from the
  previous state, in steps of the fast tier. A step is halved if it fails or its solution is not stable under the
  prescribed stress.
  (ii) Descent on Psi(F) - P.F over the free components from the last state reached, with one full solve per F. Newton
  steps with the absolute values of the eigenvalues of dP/dF are descent directions even if the tissue is not stable
  under the prescribed stress. They are limited in length and halved until the potential decreases sufficiently. A
  saddle is left along its softest mode. If a step is short, the fast tier is tried. So the tissue snaps to another
  stable state if there is one. Beyond a limit load there is none, and F diverges; the bracket of (i) is then reported.

  Out of the plane there is (ii) alone.

  The iterates of a descent leave no damage in a lamella: all have the history of the state that it started from. Walls
  with memory have that of the state before in all of the search, whose loads are those of one step.

  Reference. Nocedal & Wright, Numerical Optimization, 3.4.
*/
#include "mixed.h"

#define BUDGET 400 /* iterations of continuation, and of each descent */
#define LEAST_SHARE (1.0 / 512.0)
#define FOLD_MARGIN 4.0 /* bracket widths within which the extrapolated stiffness vanishes at a limit load */
#define DESCENTS 30
#define LOST 5 /* successive unstable steps after which F is taken to diverge */
#define HALVINGS 6
#define STEP_LIMIT 0.25      /* of a component of F */
#define NEAR_STEP 0.2        /* of a component of F: at shorter steps the fast tier is tried */
#define KICK 0.01            /* of F along an unstable mode */
#define LEAST_STIFFNESS 1e-3 /* C1 + C2: lower bound of stiffness, which bounds the steps of very soft tissue */
#define STRESS_TOLERANCE 1e-9
#define ARMIJO 1e-4
#define ROUNDING 1e-13 /* of the potential, times the bulk modulus */

/* A state with its response and its view under the control. */
typedef struct {
  LamRVEState state;
  LamResponse response;
  LamMixedView view;
} Iterate;

typedef struct {
  LamRVE rve;
  LamRVEState before;  /* of the step; borrowed */
  LamRVEState history; /* of a descent: that of the state it starts from; NULL: each state has its own */
  const LamStressControl *control;
  const LamLoad *load;
  Iterate now, next;
  PetscReal step[LAM_SMALL], slope, longest; /* descent step, its slope, its largest component before limiting */
  PetscReal reached, failed;                 /* path parameters of the last stable state and of the next failure */
  PetscReal first_stiffness, stiffness;      /* at the previous state and at `reached` */
  PetscReal earlier, earlier_stiffness;      /* path parameter before `reached`, and the stiffness there */
  char refusal[192];                         /* reason of the last failed solve */
  PetscInt iterations, factorisations, most; /* most: iteration limit of the current phase */
  PetscBool descends;                        /* there is no fast tier */
  PetscBool stopped;                         /* by the interrupt; no further solves */
} Search;

static void Count(Search *s, const LamResponse *response)
{
  s->iterations += response->newton_iterations;
  s->factorisations += response->factorisations;
  if (LamWasStopped(response)) s->stopped = PETSC_TRUE;
}

static PetscBool MayIterate(const Search *s)
{
  return (PetscBool)(s->iterations < s->most && !s->stopped);
}

static void Swap(Search *s)
{
  const Iterate before = s->now;

  s->now = s->next;
  s->next = before;
}

/* next := the full solve at `load` from `from`; unchanged after a stop. */
static PetscErrorCode SolveAt(Search *s, const LamLoad *load, LamRVEState from)
{
  PetscFunctionBeginUser;
  if (s->stopped) PetscFunctionReturn(0);
  PetscCall(LamRVEStateCopy(from, s->next.state));
  if (s->history) PetscCall(LamCopyHistory(s->history, s->next.state));
  PetscCall(LamCopyMemory(s->before, s->next.state));
  PetscCall(LamRVESolve(s->rve, load, s->next.state, &s->next.response));
  Count(s, &s->next.response);
  if (LamResponseHasFields(&s->next.response)) PetscCall(LamMixedLook(s->control, &s->next.response, &s->next.view));
  PetscFunctionReturn(0);
}

/* next := the fast tier from `now`; *solved: it is stable under the control. */
static PetscErrorCode TryFast(Search *s, const LamLoad *guess, const LamStressControl *control, PetscBool *solved)
{
  LamLoad load = *guess;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(s->now.state, s->next.state));
  if (s->history) PetscCall(LamCopyHistory(s->history, s->next.state));
  PetscCall(LamCopyMemory(s->before, s->next.state));
  PetscCall(LamMixedFast(s->rve, &load, control, s->next.state, &s->next.response));
  Count(s, &s->next.response);
  PetscCall(PetscStrncpy(s->refusal, s->next.response.reason, sizeof(s->refusal)));
  *solved = LamResponseHasFields(&s->next.response);
  if (!*solved) PetscFunctionReturn(0);
  PetscCall(LamMixedLook(control, &s->next.response, &s->next.view));
  *solved = LamMixedIsStable(&s->next.view);
  PetscFunctionReturn(0);
}

/* Load and control at path parameter t from `start`; the free components of F are guessed from `now`. */
static void ControlBetween(const Search *s, const LamResponse *start, PetscReal t, LamLoad *load,
                           LamStressControl *control)
{
  *load = LamLoadBetween(&start->load, s->load, t);
  *control = *s->control;
  for (PetscInt i = 0; i < 9; ++i) {
    if (!control->given[i]) continue;
    load->F[i] = s->now.response.load.F[i];
    control->P[i] = (1.0 - t) * start->P[i] + t * s->control->P[i];
  }
}

/* Continuation of stable states from `now`, the previous state, towards the prescribed load. */
static PetscErrorCode Continue(Search *s)
{
  const LamResponse start = s->now.response;
  PetscReal step = 0.5;

  PetscFunctionBeginUser;
  s->first_stiffness = s->stiffness = s->now.view.w[0];
  s->most = s->iterations + BUDGET;
  while (s->reached < 1.0 && step >= LEAST_SHARE && MayIterate(s)) {
    const PetscReal t = PetscMin(1.0, s->reached + step);
    LamStressControl control;
    LamLoad load;
    PetscBool solved;

    ControlBetween(s, &start, t, &load, &control);
    PetscCall(TryFast(s, &load, &control, &solved));
    if (solved) {
      Swap(s);
      s->earlier = s->reached;
      s->earlier_stiffness = s->stiffness;
      s->reached = t;
      s->stiffness = s->now.view.w[0];
      step *= 2.0;
    } else {
      s->failed = t;
      step *= 0.5;
    }
  }
  PetscFunctionReturn(0);
}

static PetscReal Tolerance(LamRVE rve)
{
  return PetscMax(STRESS_TOLERANCE, 10.0 * LamNewtonTolerance(rve));
}

/* Computes a descent step from `now`. */
static void FindStep(Search *s)
{
  const LamMixedView *view = &s->now.view;
  const PetscBool kick = (PetscBool)(view->largest <= Tolerance(s->rve)); /* balanced but not stable: a saddle */

  s->longest = s->slope = 0.0;
  for (PetscInt k = 0; k < view->count; ++k) s->step[k] = kick ? KICK * view->V[0][k] : 0.0;
  for (PetscInt m = 0; m < view->count && !kick; ++m) {
    PetscReal share = 0.0;

    for (PetscInt k = 0; k < view->count; ++k) share -= view->V[m][k] * view->excess[k];
    share /= PetscMax(PetscAbsReal(view->w[m]), LEAST_STIFFNESS);
    for (PetscInt k = 0; k < view->count; ++k) s->step[k] += share * view->V[m][k];
  }
  for (PetscInt k = 0; k < view->count; ++k) s->longest = PetscMax(s->longest, PetscAbsReal(s->step[k]));
  for (PetscInt k = 0; k < view->count; ++k) {
    s->step[k] *= PetscMin(1.0, STEP_LIMIT / PetscMax(s->longest, 1e-300));
    s->slope += s->step[k] * view->excess[k];
  }
}

/* Whether `next` is better: a sufficiently lower potential or, if the difference is at rounding level, a smaller stress
   residual. */
static PetscBool IsBetter(const Search *s, PetscReal alpha)
{
  const PetscReal rounding = ROUNDING * s->rve->micro.wall.bulk_modulus;
  const PetscReal fall = s->now.view.potential - s->next.view.potential;

  if (s->next.response.status != LAM_CONVERGED) return PETSC_FALSE;
  if (fall > rounding) return (PetscBool)(fall >= -ARMIJO * alpha * s->slope);
  return (PetscBool)(fall >= -rounding && s->next.view.largest <= 0.5 * s->now.view.largest);
}

/* One descent step; *moved: `next` was better and is now `now`. */
static PetscErrorCode TakeStep(Search *s, PetscBool *moved)
{
  PetscReal alpha = 1.0;

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  for (PetscInt k = 0; k < HALVINGS && !*moved && MayIterate(s); ++k, alpha *= 0.5) {
    LamLoad load = s->now.response.load;

    for (PetscInt i = 0; i < s->now.view.count; ++i) load.F[s->now.view.component[i]] += alpha * s->step[i];
    PetscCall(SolveAt(s, &load, s->now.state));
    *moved = IsBetter(s, alpha);
  }
  if (*moved) Swap(s);
  PetscFunctionReturn(0);
}

/* Descent from `now`; *found: an equilibrium at the prescribed stress, stable or the last saddle. */
static PetscErrorCode Descend(Search *s, PetscBool *found)
{
  PetscInt lost = 0;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (PetscInt it = 0; it < DESCENTS && lost < LOST && !s->stopped; ++it) {
    const PetscBool there = (PetscBool)(s->now.view.largest <= Tolerance(s->rve));
    const PetscBool stable = LamMixedIsStable(&s->now.view);
    PetscBool moved;

    *found = (PetscBool)(there && stable);
    if (*found) break;
    FindStep(s);
    if (!there && stable && s->longest <= NEAR_STEP && !s->descends)
      PetscCall(TryFast(s, &s->now.response.load, s->control, found));
    if (*found) {
      Swap(s);
      break;
    }
    PetscCall(TakeStep(s, &moved));
    *found = (PetscBool)(there && !moved);
    if (!moved) break;
    lost = stable ? 0 : lost + 1;
  }
  PetscFunctionReturn(0);
}

/* Full solve at `load` from `from`, then descent. */
static PetscErrorCode DescendFrom(Search *s, const LamLoad *load, LamRVEState from, PetscBool *found)
{
  const PetscBool looks_back = s->rve->looks_back; /* of a step that is taken again in parts, of which this is one */

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  s->most = s->iterations + BUDGET;
  if (s->rve->layer) {
    PetscCall(LamRVEStateCreate(s->rve, &s->history));
    PetscCall(LamRVEStateCopy(from, s->history));
    s->rve->looks_back = PETSC_TRUE;
  }
  PetscCall(SolveAt(s, load, from));
  if (LamResponseHasFields(&s->next.response)) {
    Swap(s);
    PetscCall(Descend(s, found));
  } else {
    PetscCall(PetscStrncpy(s->refusal, s->next.response.reason, sizeof(s->refusal)));
  }
  s->rve->looks_back = looks_back;
  PetscCall(LamRVEStateDestroy(&s->history));
  PetscFunctionReturn(0);
}

/* Continuation from the previous state, then descent from its end. Contact tissue without a previous solution first
   tries descent from the guess of F. */
static PetscErrorCode Find(Search *s, LamRVEState state, PetscBool *found)
{
  LamLoad start = state->load, load = *s->load;

  PetscFunctionBeginUser;
  start.duration = load.duration;
  if (s->descends) {
    PetscCall(DescendFrom(s, &load, state, found));
    PetscFunctionReturn(0);
  }
  if (s->rve->contact && !state->solved) {
    PetscCall(DescendFrom(s, &load, state, found));
    if (*found && LamMixedIsStable(&s->now.view)) PetscFunctionReturn(0);
  }
  PetscCall(SolveAt(s, &start, state));
  if (!LamResponseHasFields(&s->next.response)) {
    PetscCall(DescendFrom(s, &load, state, found));
    PetscFunctionReturn(0);
  }
  Swap(s);
  PetscCall(Continue(s));
  *found = (PetscBool)(s->reached >= 1.0);
  if (*found) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < s->now.view.count; ++k)
    load.F[s->now.view.component[k]] = s->now.response.load.F[s->now.view.component[k]];
  PetscCall(DescendFrom(s, &load, s->now.state, found));
  PetscFunctionReturn(0);
}

/*
  Whether the stable states end in a fold (limit load). Near it the stiffness falls as the square root of the remaining
  load, so its square, extrapolated linearly from the last two states, vanishes in the bracket or soon after it.
*/
static PetscBool EndsInFold(const Search *s)
{
  const PetscReal bracket = s->failed - s->reached;
  const PetscReal fall = PetscSqr(s->earlier_stiffness) - PetscSqr(s->stiffness);

  if (s->reached <= s->earlier || bracket > 2.0 * LEAST_SHARE || fall <= 0.0) return PETSC_FALSE;
  return (PetscBool)(PetscSqr(s->stiffness) * (s->reached - s->earlier) / fall <= FOLD_MARGIN * bracket);
}

/* Sets status and reason of a failed search. */
static PetscErrorCode GiveReason(const Search *s, LamResponse *response)
{
  const PetscBool limit = EndsInFold(s);
  const LamStatus status = limit ? LAM_NO_EQUILIBRIUM : LAM_NOT_CONVERGED;

  PetscFunctionBeginUser;
  if (s->failed == 0.0) /* no solution to continue from */
    PetscCall(LamRefuse(response, status, "%s", s->refusal));
  else if (s->first_stiffness <= LAM_MIXED_SOFTEST)
    PetscCall(LamRefuse(response, status,
                        "the state before is not stable under the prescribed stress (stiffness %.3g C1+C2), and no "
                        "stable one was found from there: prescribe F",
                        (double)s->first_stiffness));
  else
    PetscCall(LamRefuse(response, status,
                        "%s between %.4g and %.4g of the way from the state before; stiffness under the prescribed "
                        "stress %.3g before, %.3g there (C1+C2)%s%.60s",
                        limit ? "a limit load lies" : "no stable state was found", (double)s->reached,
                        (double)s->failed, (double)s->first_stiffness, (double)s->stiffness, s->refusal[0] ? "; " : "",
                        s->refusal));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMixedSafe(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response)
{
  Search s = {.rve = rve,
              .before = state,
              .control = control,
              .load = load,
              .descends = LamMixedIsOutOfPlane(rve, load, control, state)};
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &s.now.state));
  PetscCall(LamRVEStateCreate(rve, &s.next.state));
  PetscCall(Find(&s, state, &found));
  if (found && !s.stopped) {
    *response = s.now.response;
    if (!LamMixedIsStable(&s.now.view)) response->status = LAM_UNSTABLE;
    PetscCall(LamRVEStateCopy(s.now.state, state));
  } else {
    PetscCall(LamBeginResponse(rve, load, state, response));
    PetscCall(s.stopped ? LamGiveUp(response) : GiveReason(&s, response));
  }
  response->newton_iterations = s.iterations;
  response->factorisations = s.factorisations;
  PetscCall(LamRVEStateDestroy(&s.now.state));
  PetscCall(LamRVEStateDestroy(&s.next.state));
  PetscFunctionReturn(0);
}
