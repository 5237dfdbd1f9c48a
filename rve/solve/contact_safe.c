/*
  Contact equilibrium by descent, for initial guesses from which the fast iteration fails.

  Method. Sequential quadratic programming on the energy Pi of walls, turgor and cohesion subject to G >= 0. Each step
  solves the linear system of the fast iteration with the active set consistent with the step and a matrix shifted to be
  positive definite on the free motions. It is therefore a descent direction of the merit function
      phi = Pi + mu sum_A D_A max(0, -gap_A),      mu > largest multiplier.
  The shift limits the step length. A watchdog allows a few steps without decrease (descent.c). If the matrix is
  indefinite and the step small, part of the unstable mode is added, so that saddles are
  left.

  Reference. Nocedal & Wright, Numerical Optimization, chapters 15 and 18.
*/
#include "solve.h"

#define SAFE_ITERATIONS 120
#define RESTARTS 3           /* after a solution has changed the junction status */
#define FOLLOW_ITERATIONS 60 /* first iterations, in which the junction status is updated */
#define LEAST_WEIGHT 0.01    /* minimum mu, C1 + C2 */
#define SHORTENINGS 6
#define LEAST_FLOOR 1e-4 /* floors of the shift start from at least this and are dropped below it */

/* Keeps mu above the multipliers but of their order: a larger weight on the violation makes steps tiny. */
static void SetWeight(LamRVE rve, const PetscReal lambda[], LamDescent *best)
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

static PetscErrorCode SafeStep(LamRVE rve, const LamLoad *load, PetscReal norm, LamMerit now, LamContactStep *step,
                               LamDescent *best, PetscReal *alpha)
{
  PetscReal largest;
  PetscBool ok;

  PetscFunctionBeginUser;
  *alpha = 0.0;
  PetscCall(ShortStep(rve, norm, best->limit, step, &ok));
  if (!ok) PetscFunctionReturn(0);
  SetWeight(rve, step->lambda, best);
  largest = LamLargestEntry(rve->ndof, rve->step);
  *alpha = PetscMin(1.0, best->limit / PetscMax(largest, 1e-300));
  PetscCall(LamDescentSearch(rve, load, now, best, alpha));
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
  LamContact *contact = rve->contact;
  PetscInt follow_until = FOLLOW_ITERATIONS, restarts = 0;
  LamContactStep step;
  LamDescent best;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  contact->hysteresis = LAM_HYSTERESIS;
  if (!LamSetConsistentStresses(rve, load, rve->y)) PetscFunctionReturn(0);
  LamSealSetConsistent(rve, load, rve->y);
  PetscCall(LamContactStepCreate(rve, NULL, &step));
  PetscCall(LamDescentCreate(rve, &best));
  best.mu = LEAST_WEIGHT;
  for (PetscInt it = 0; it < SAFE_ITERATIONS && LamMayIterate(rve); ++it) {
    PetscReal energy, norm = PETSC_INFINITY, alpha;
    PetscBool valid, moved;
    LamMerit now = {0};

    PetscCall(LamContactEvaluate(rve, load, rve->y, (PetscBool)(it < follow_until)));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (valid) {
      LamContactResidual(rve, &step, &norm);
      (void)LamContactFindActive(contact, 0.0);
      if (norm <= tolerance && LamContactComplementarity(contact) <= LamGapTolerance(rve)) {
        if (LamContactStatusHolds(rve, load, rve->y)) *outcome = LAM_NEWTON_CONVERGED;
        if (*outcome == LAM_NEWTON_CONVERGED || restarts++ == RESTARTS) break;
        contact->hysteresis += LAM_MORE_HYSTERESIS;
        follow_until = it + 2;
        best.known = PETSC_FALSE;
        continue;
      }
      PetscCall(LamAssembleEnergy(rve, load, rve->y, &energy, &valid));
      now = LamMeritOf(rve, energy);
    }
    PetscCall(LamDescentWatch(rve, load, now, valid, &best, &moved));
    if (moved) continue;
    PetscCall(SafeStep(rve, load, norm, now, &step, &best, &alpha));
    if (alpha == 0.0) break;
  }
  PetscCall(LamDescentDestroy(&best));
  PetscCall(LamContactStepDestroy(&step));
  PetscFunctionReturn(0);
}
