/*
  Contact equilibrium by descent, for initial guesses from which the fast iteration fails.

  Method. Sequential quadratic programming on the energy Pi of walls, turgor and cohesion subject to G >= 0. Each step
  solves the linear system of the fast iteration with the active set consistent with the step and a matrix shifted to be
  positive definite on the free motions. It is therefore a descent direction of the merit function
      phi = Pi + mu sum_A D_A max(0, -gap_A),      mu > largest multiplier.
  The shift limits the step length. A watchdog allows a few steps without decrease, as a large step first violates the
  constraints of the stiff walls and the next ones restore them; then the iteration returns to the best point and makes
  a line search. If the matrix is indefinite and the step small, part of the unstable mode is added, so that saddles are
  left.

  References. Nocedal & Wright, Numerical Optimization, chapters 15 and 18; Chamberlain et al., Math. Prog. Study 16
  (1982) 1 (watchdog).
*/
#include "solve.h"

#define SAFE_ITERATIONS 120
#define RESTARTS 3           /* after a solution has changed the junction status */
#define FOLLOW_ITERATIONS 60 /* first iterations, in which the junction status is updated */
#define WATCHDOG 4           /* steps without decrease before returning to the best point */
#define STEP_LIMIT 0.05      /* apothems; smaller after a failure, down to ... */
#define LEAST_STEP_LIMIT 1e-3
#define LEAST_WEIGHT 0.01 /* minimum mu, C1 + C2 */
#define SHORTENINGS 6
#define LEAST_FLOOR 1e-4 /* floors of the shift start from at least this and are dropped below it */
#define ARMIJO 1e-4

typedef struct {
  PetscReal energy, violation; /* Pi, and sum D max(0, -gap) */
} Merit;

typedef struct {
  PetscReal *y, *lambda; /* the best point so far */
  Merit merit;
  PetscReal mu, limit; /* weight of the violation; limit of the step length, apothems */
  PetscInt without_decrease;
  PetscBool monotone, known;
} Best;

static PetscReal Value(Merit merit, PetscReal mu)
{
  return merit.energy + mu * merit.violation;
}

/* Merit of the contact state last evaluated. */
static Merit MeritOf(LamRVE rve, PetscReal energy)
{
  const LamContact *contact = rve->contact;
  Merit merit = {energy, 0.0};

  for (PetscInt h = 0; h < contact->count; ++h) merit.violation += contact->weight[h] * PetscMax(0.0, -contact->gap[h]);
  return merit;
}

/* Halves the step until the merit decreases sufficiently; *alpha = 0 if it does not. */
static PetscErrorCode LineSearch(LamRVE rve, const LamLoad *load, Merit now, PetscReal mu, PetscReal slope,
                                 PetscReal rounding, PetscReal *alpha)
{
  PetscFunctionBeginUser;
  for (; *alpha > 1e-5; *alpha *= 0.5) {
    PetscReal energy;
    PetscBool valid;

    for (PetscInt i = 0; i < rve->ndof; ++i) rve->trial[i] = rve->y[i] + *alpha * rve->step[i];
    PetscCall(LamAssembleEnergy(rve, load, rve->trial, &energy, &valid));
    if (!valid) continue;
    PetscCall(LamContactEvaluate(rve, load, rve->trial, PETSC_FALSE));
    if (Value(MeritOf(rve, energy), mu) <= Value(now, mu) + ARMIJO * *alpha * PetscMin(0.0, slope) + rounding)
      PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

/* Stores the point of least merit; returns to it after too many steps without decrease. *moved: rve->y was reset. */
static PetscErrorCode Watch(LamRVE rve, const LamLoad *load, Merit now, PetscBool valid, PetscReal rounding, Best *best,
                            PetscBool *moved)
{
  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  if (valid && (!best->known || Value(now, best->mu) < Value(best->merit, best->mu))) {
    PetscCall(PetscArraycpy(best->y, rve->y, rve->length));
    PetscCall(PetscArraycpy(best->lambda, rve->contact->lambda, rve->contact->count));
    best->merit = now;
    best->known = PETSC_TRUE;
    best->without_decrease = 0;
    best->limit = PetscMin(STEP_LIMIT, 1.3 * best->limit);
    PetscFunctionReturn(0);
  }
  if (valid && Value(now, best->mu) <= Value(best->merit, best->mu) + rounding) PetscFunctionReturn(0);
  if (valid && ++best->without_decrease <= WATCHDOG) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(rve->y, best->y, rve->length));
  PetscCall(PetscArraycpy(rve->contact->lambda, best->lambda, rve->contact->count));
  (void)LamSetConsistentStresses(rve, load, rve->y);
  LamSealSetConsistent(rve, load, rve->y);
  best->without_decrease = 0;
  best->known = PETSC_FALSE; /* its merit depends on the junction status */
  best->monotone = PETSC_TRUE;
  best->limit = PetscMax(LEAST_STEP_LIMIT, 0.25 * best->limit);
  *moved = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Keeps mu above the multipliers but of their order: a larger weight on the violation makes steps tiny. */
static void SetWeight(LamRVE rve, const PetscReal lambda[], Best *best)
{
  PetscReal largest = LEAST_WEIGHT;

  for (PetscInt h = 0; h < rve->contact->count; ++h) largest = PetscMax(largest, lambda[h]);
  if (best->mu < 1.2 * largest || best->mu > 4.0 * largest) best->mu = 1.5 * largest;
}

/*
  Computes a step no longer than `limit` by increasing the shift, not by scaling: the step still corrects the whole
  violation of gaps and stiff walls, and only soft motions are shortened.
*/
static PetscErrorCode ShortStep(LamRVE rve, PetscReal norm, PetscReal limit, LamContactStep *step, PetscBool *ok)
{
  PetscFunctionBeginUser;
  LamContactAddCurvature(rve);
  for (PetscInt k = 0; k < SHORTENINGS; ++k) {
    PetscReal ratio;

    PetscCall(LamContactSolveStep(rve, norm, 0.0, step, ok));
    if (!*ok) PetscFunctionReturn(0);
    ratio = LamLargestEntry(rve->ndof, rve->step) / limit;
    if (ratio <= 1.0) {
      if (ratio < 0.3) step->floor = step->floor < LEAST_FLOOR ? 0.0 : 0.25 * step->floor;
      break;
    }
    step->floor = PetscMin(PetscMax(2.0, ratio), 10.0) * PetscMax(step->shift, LEAST_FLOOR);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SafeStep(LamRVE rve, const LamLoad *load, PetscReal norm, Merit now, PetscReal rounding,
                               LamContactStep *step, Best *best, PetscReal *alpha)
{
  PetscReal slope = 0.0, largest;
  PetscBool ok;

  PetscFunctionBeginUser;
  *alpha = 0.0;
  PetscCall(ShortStep(rve, norm, best->limit, step, &ok));
  if (!ok) PetscFunctionReturn(0);
  SetWeight(rve, step->lambda, best);
  largest = LamLargestEntry(rve->ndof, rve->step);
  *alpha = PetscMin(1.0, best->limit / PetscMax(largest, 1e-300));
  if (best->monotone) {
    for (PetscInt i = 2; i < rve->ndof; ++i) slope += rve->residual[i] * rve->step[i];
    PetscCall(LineSearch(rve, load, now, best->mu, slope - best->mu * now.violation, rounding, alpha));
    best->monotone = PETSC_FALSE;
  }
  if (rve->monitor)
    PetscCall(
        PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                     "  safe  residual %9.3e  energy %.10e  violation %9.3e  active %d  step %9.3e x %g  shift %g\n",
                     (double)norm, (double)now.energy, (double)now.violation, (int)LamContactCountActive(rve->contact),
                     (double)largest, (double)*alpha, (double)step->shift));
  LamContactTakeStep(rve, load, *alpha, step);
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome)
{
  const PetscReal tolerance = LamNewtonTolerance(rve);
  const PetscReal rounding = 1e-14 * rve->stiffest * rve->mesh.V0;
  LamContact *contact = rve->contact;
  PetscInt follow_until = FOLLOW_ITERATIONS, restarts = 0;
  LamContactStep step;
  Best best = {.mu = LEAST_WEIGHT, .limit = STEP_LIMIT};

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  contact->hysteresis = LAM_HYSTERESIS;
  if (!LamSetConsistentStresses(rve, load, rve->y)) PetscFunctionReturn(0);
  LamSealSetConsistent(rve, load, rve->y);
  PetscCall(LamContactStepCreate(rve, &step));
  PetscCall(PetscMalloc2(rve->length, &best.y, contact->count, &best.lambda));
  for (PetscInt it = 0; it < SAFE_ITERATIONS && LamMayIterate(rve); ++it) {
    PetscReal energy, norm = PETSC_INFINITY, alpha;
    PetscBool valid, moved;
    Merit now = {0};

    PetscCall(LamContactEvaluate(rve, load, rve->y, (PetscBool)(it < follow_until)));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (valid) {
      LamContactResidual(rve, &step, &norm);
      (void)LamContactFindActive(contact, 0.0);
      if (norm <= tolerance && LamContactComplementarity(contact) <= LamGapTolerance(rve)) {
        PetscBool holds;

        PetscCall(LamContactStatusHolds(rve, load, rve->y, &holds));
        if (holds) *outcome = LAM_NEWTON_CONVERGED;
        if (holds || restarts++ == RESTARTS) break;
        contact->hysteresis += LAM_MORE_HYSTERESIS;
        follow_until = it + 2;
        best.known = PETSC_FALSE;
        continue;
      }
      PetscCall(LamAssembleEnergy(rve, load, rve->y, &energy, &valid));
      now = MeritOf(rve, energy);
    }
    PetscCall(Watch(rve, load, now, valid, rounding, &best, &moved));
    if (moved) continue;
    PetscCall(SafeStep(rve, load, norm, now, rounding, &step, &best, &alpha));
    if (alpha == 0.0) break;
  }
  PetscCall(PetscFree2(best.y, best.lambda));
  PetscCall(LamContactStepDestroy(&step));
  PetscFunctionReturn(0);
}
