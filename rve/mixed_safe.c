/*
  Safe tier of prescribed stress: descent on Psi(F) - P.F over the free components of F.

  Method. At each F a full solve gives Psi, P and dP/dF. Newton steps with the absolute values of the eigenvalues of
  dP/dF lead downhill also where the tissue is not stable under the prescribed stress; they are limited in length and
  halved until the potential falls enough. At a saddle the step is along the softest mode. Where the next step is short
  the fast tier is tried from there. A stress beyond a limit load has no minimum: F runs away, which the reason tells.

  Reference. Nocedal & Wright, Numerical Optimization, 3.4.
*/
#include "mixed.h"

#define ITERATIONS 30
#define HALVINGS 6
#define STEP_LIMIT 0.25      /* of a component of F */
#define NEAR_STEP 0.1        /* from here on the fast tier has a chance */
#define KICK 0.01            /* of F along an unstable mode */
#define LEAST_STIFFNESS 1e-3 /* C1 + C2: bounds the steps of tissue that has next to none */
#define STRESS_TOLERANCE 1e-9
#define ARMIJO 1e-4
#define ROUNDING 1e-13 /* of the potential, times the bulk modulus */

typedef struct {
  LamRVEState state;
  LamResponse response;
  LamMixedView view;
} Iterate;

typedef struct {
  LamRVE rve;
  const LamStressControl *control;
  Iterate now, next;
  PetscReal step[LAM_F_COUNT], slope, longest;
  PetscInt iterations, factorisations;
} Descent;

static PetscErrorCode Count(Descent *d, const LamResponse *response)
{
  PetscFunctionBeginUser;
  d->iterations += response->newton_iterations;
  d->factorisations += response->factorisations;
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAt(Descent *d, const LamLoad *load, LamRVEState from, Iterate *iterate)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(from, iterate->state));
  PetscCall(LamRVESolve(d->rve, load, iterate->state, &iterate->response));
  PetscCall(Count(d, &iterate->response));
  if (LamResponseHasFields(&iterate->response)) PetscCall(LamMixedLook(d->control, &iterate->response, &iterate->view));
  PetscFunctionReturn(0);
}

static PetscReal Tolerance(LamRVE rve)
{
  return PetscMax(STRESS_TOLERANCE, 10.0 * LamNewtonTolerance(rve));
}

/* The step from `now`, downhill. */
static void FindStep(Descent *d)
{
  const LamMixedView *view = &d->now.view;
  const PetscBool kick = (PetscBool)(view->largest <= Tolerance(d->rve)); /* then at a saddle */

  d->longest = d->slope = 0.0;
  for (PetscInt k = 0; k < view->count; ++k) d->step[k] = kick ? KICK * view->V[0][k] : 0.0;
  for (PetscInt m = 0; m < view->count && !kick; ++m) {
    PetscReal share = 0.0;

    for (PetscInt k = 0; k < view->count; ++k) share -= view->V[m][k] * view->excess[k];
    share /= PetscMax(PetscAbsReal(view->w[m]), LEAST_STIFFNESS);
    for (PetscInt k = 0; k < view->count; ++k) d->step[k] += share * view->V[m][k];
  }
  for (PetscInt k = 0; k < view->count; ++k) d->longest = PetscMax(d->longest, PetscAbsReal(d->step[k]));
  for (PetscInt k = 0; k < view->count; ++k) {
    d->step[k] *= PetscMin(1.0, STEP_LIMIT / PetscMax(d->longest, 1e-300));
    d->slope += d->step[k] * view->excess[k];
  }
}

/* Whether `next` is better: a lower potential, or near the solution, where its differences drown in rounding, less
   stress that is not balanced. */
static PetscBool IsBetter(const Descent *d, PetscReal alpha)
{
  const PetscReal rounding = ROUNDING * d->rve->micro.wall.bulk_modulus;
  const PetscReal fall = d->now.view.potential - d->next.view.potential;

  if (d->next.response.status != LAM_CONVERGED) return PETSC_FALSE;
  if (fall > rounding) return (PetscBool)(fall >= -ARMIJO * alpha * d->slope);
  return (PetscBool)(fall >= -rounding && d->next.view.largest <= 0.5 * d->now.view.largest);
}

/* One step; *moved is PETSC_FALSE where none leads down. */
static PetscErrorCode TakeStep(Descent *d, PetscBool *moved)
{
  PetscReal alpha = 1.0;

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  for (PetscInt k = 0; k < HALVINGS && !*moved; ++k, alpha *= 0.5) {
    LamLoad load = d->now.response.load;

    for (PetscInt i = 0; i < d->now.view.count; ++i) load.F[d->now.view.component[i]] += alpha * d->step[i];
    PetscCall(SolveAt(d, &load, d->now.state, &d->next));
    *moved = IsBetter(d, alpha);
  }
  if (*moved) {
    const Iterate before = d->now;

    d->now = d->next;
    d->next = before;
  }
  PetscFunctionReturn(0);
}

/* The fast tier from `now`. */
static PetscErrorCode TryFast(Descent *d, PetscBool *solved)
{
  LamLoad load = d->now.response.load;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(d->now.state, d->next.state));
  PetscCall(LamMixedFast(d->rve, &load, d->control, d->next.state, &d->next.response));
  PetscCall(Count(d, &d->next.response));
  *solved = LamResponseHasFields(&d->next.response);
  if (!*solved) PetscFunctionReturn(0);
  PetscCall(LamMixedLook(d->control, &d->next.response, &d->next.view));
  *solved = LamMixedIsStable(&d->next.view);
  if (*solved) {
    const Iterate before = d->now;

    d->now = d->next;
    d->next = before;
  }
  PetscFunctionReturn(0);
}

/* Descends from `now`; *found: an equilibrium at the prescribed stress, stable or the last saddle. */
static PetscErrorCode Descend(Descent *d, PetscBool *found)
{
  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (PetscInt it = 0; it < ITERATIONS && d->iterations < LAM_ITERATION_BUDGET; ++it) {
    const PetscBool there = (PetscBool)(d->now.view.largest <= Tolerance(d->rve));
    PetscBool moved;

    if (there && LamMixedIsStable(&d->now.view)) {
      *found = PETSC_TRUE;
      break;
    }
    FindStep(d);
    if (!there && d->longest <= NEAR_STEP && LamMixedIsStable(&d->now.view)) {
      PetscCall(TryFast(d, found));
      if (*found) break;
    }
    PetscCall(TakeStep(d, &moved));
    *found = (PetscBool)(there && !moved);
    if (!moved) break;
  }
  PetscFunctionReturn(0);
}

/* Why there is no answer. */
static PetscErrorCode GiveReason(const Descent *d, LamResponse *response)
{
  const LamMixedView *view = &d->now.view;
  const PetscReal *F = d->now.response.load.F;
  const char *why = !LamMixedIsStable(view)                   ? "it has passed a limit load: prescribe F"
                    : LamResponseHasFields(&d->next.response) ? "give states in between"
                                                              : d->next.response.reason;

  PetscFunctionBeginUser;
  response->status = LAM_NOT_CONVERGED;
  PetscCall(PetscSNPrintf(response->reason, sizeof(response->reason),
                          "the prescribed stress is not reached: off by %.3g (C1+C2) at F = [%.4g, %.4g; %.4g, %.4g], "
                          "F33 %.4g, stiffness there %.3g; %s",
                          (double)view->largest, (double)F[0], (double)F[1], (double)F[3], (double)F[4], (double)F[8],
                          (double)view->w[0], why));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMixedSafe(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamRVEState state,
                            LamResponse *response)
{
  Descent d = {.rve = rve, .control = control};
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &d.now.state));
  PetscCall(LamRVEStateCreate(rve, &d.next.state));
  PetscCall(SolveAt(&d, load, state, &d.now));
  if (LamResponseHasFields(&d.now.response)) {
    PetscCall(Descend(&d, &found));
    if (found) {
      *response = d.now.response;
      if (!LamMixedIsStable(&d.now.view)) response->status = LAM_UNSTABLE;
      PetscCall(LamRVEStateCopy(d.now.state, state));
    } else {
      PetscCall(LamBeginResponse(rve, load, response));
      PetscCall(GiveReason(&d, response));
    }
  } else {
    *response = d.now.response; /* no answer at the first guess: for the reason it gives */
  }
  response->newton_iterations = d.iterations;
  response->factorisations = d.factorisations;
  PetscCall(LamRVEStateDestroy(&d.now.state));
  PetscCall(LamRVEStateDestroy(&d.next.state));
  PetscFunctionReturn(0);
}
