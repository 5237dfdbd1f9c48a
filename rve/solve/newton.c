/*
  Equilibrium of the RVE at one load.

  Method. Both tiers solve (K(x, p*, s*) + shift 1) dx = -r(x) with the residual of the energy and the tangent with
  independent stresses (element.h). The shift is zero if K is positive definite, otherwise just large enough (inertia
  correction). Sealed lumens add their pressures to x, and one negative eigenvalue each (turgor.c). The fast tier takes
  full steps, shortened only if an element volume would be inverted. The safe tier minimises the energy: steps are
  limited in length, and a watchdog allows a few steps without decrease, as a large step first violates the stiff
  constraints and the next ones restore them; then the iteration returns to the best point and makes a monotone line
  search.

  References. Magisano, Leonetti & Garcea, Int. J. Numer. Meth. Engng 109 (2017) 1237 (mixed integration points);
  Chamberlain et al., Math. Prog. Study 16 (1982) 1 (watchdog); Nocedal & Wright, Numerical Optimization, 3.4.
*/
#include "newton.h"

#define FAST_ITERATIONS 25
#define SAFE_ITERATIONS 400
#define ROUNDING_MARGIN 1e3 /* times the tolerance: residual that rounding of large stresses may leave */
#define WATCHDOG 4          /* steps without decrease before the safe tier returns to the best point */
#define LEAST_SHIFT 1e-7    /* of the largest diagonal entry */
#define STEP_LIMIT 0.05     /* of the safe tier, in apothems */
#define ARMIJO 1e-4
#define SADDLE_RESIDUAL 1e-4 /* residual norm below which an indefinite state is taken to be near a saddle */
#define ESCAPE_STEP 0.01     /* along a direction of negative curvature, in apothems */

PetscReal LamNewtonTolerance(LamRVE rve)
{
  /* Pressure and fibre forces have a rounding error of eps times their stiffness in each of n entries. Gradients are
     differences of positions, so it grows with RVE size over element depth. The floor measured for t = 0.003 to 0.5 and
     up to 8 x 8 cells stays below 0.6 slenderness x size (docs/results/verification.md). */
  const LamMicrostructure *micro = &rve->micro;
  const PetscReal depth = rve->thinnest / (PetscReal)micro->through;
  const PetscReal slenderness = PetscMax(LamLongestEdge(&rve->mesh) / depth, depth / LamShortestEdge(&rve->mesh));
  const PetscReal size = 1.0 + PetscSqrtReal(3.0) * (PetscReal)(PetscMax(micro->cells[0], micro->cells[1]) - 1);
  const PetscReal rounding = PETSC_MACHINE_EPSILON * rve->stiffest * PetscSqrtReal((PetscReal)rve->ndof);

  return PetscMax(PetscMax(1e-11, rve->tolerance), PetscMax(4.0, slenderness * size) * rounding);
}

PetscErrorCode LamReportIteration(LamRVE rve, const char tier[], PetscInt iteration, PetscReal residual, PetscReal step,
                                  PetscReal shift)
{
  PetscFunctionBeginUser;
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  %-5s %3d  residual %10.3e  largest step %9.3e  shift %g\n",
                           tier, (int)iteration, (double)residual, (double)step, (double)shift));
  PetscFunctionReturn(0);
}

/*
  Whether a step with the previous factorisation is expected to reach the tolerance. A Newton step leaves half the
  second-order term of the residual; another step with the same factor leaves about twice that share (linear.rate).
*/
static PetscBool FactorServes(LamRVE rve, PetscReal norm, PetscReal tolerance)
{
  return (PetscBool)(rve->linear.rate <= LAM_NEAR_RATE && rve->linear.rate * norm <= tolerance);
}

PetscErrorCode LamSolveStep(LamRVE rve, LamBorder *border)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 2; i < rve->length; ++i) rve->trial[i] = -rve->residual[i];
  PetscCall(LamBorderSolve(rve, border, rve->trial + 2, rve->step + 2));
  rve->step[0] = rve->step[1] = 0.0;
  PetscFunctionReturn(0);
}

static void TrialPosition(LamRVE rve, PetscReal alpha)
{
  for (PetscInt i = 0; i < rve->ndof; ++i) rve->trial[i] = rve->y[i] + alpha * rve->step[i];
}

PetscErrorCode LamFactorPositive(LamRVE rve, PetscReal least, PetscReal *last_shift, PetscBool *ok)
{
  PetscReal diagonal = 0.0, shift = 0.0;
  PetscInt negative;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rve->linear.positions; ++i)
    diagonal = PetscMax(diagonal, PetscAbsReal(rve->linear.values[rve->linear.row[i]]));
  for (PetscInt attempt = 0; attempt < 40; ++attempt) {
    PetscCall(LamRVEFactor(rve, shift, &negative, ok));
    if (*ok && negative <= LamExpectedNegative(rve)) break;
    *ok = PETSC_FALSE;
    if (shift > diagonal) break;
    shift = shift == 0.0 ? PetscMax(*last_shift / 8.0, PetscMin(least, LEAST_SHIFT * diagonal)) : 4.0 * shift;
  }
  *last_shift = shift;
  PetscFunctionReturn(0);
}

PetscBool LamAtRounding(LamRVE rve, PetscReal norm, PetscReal tolerance, PetscReal largest)
{
  const PetscReal extent = PetscMax(1.0, LamLargestEntry(rve->ndof, rve->y));

  return (PetscBool)(largest <= 500.0 * PETSC_MACHINE_EPSILON * extent && norm <= ROUNDING_MARGIN * tolerance);
}

PetscErrorCode LamValidStep(LamRVE rve, const LamLoad *load, const LamBorder *border, PetscReal *alpha)
{
  PetscFunctionBeginUser;
  for (*alpha = 1.0; *alpha > 0.01; *alpha *= 0.5) {
    const LamLoad moved = LamBorderMoved(border, load, *alpha);

    TrialPosition(rve, *alpha);
    if (LamPositionsAreValid(rve, &moved, rve->trial)) PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

void LamTakeStep(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal alpha)
{
  LamUpdateStresses(rve, load, rve->y, rve->step, LamBorderStep(border), alpha);
  for (PetscInt i = 0; i < rve->length; ++i) rve->y[i] += alpha * rve->step[i];
  if (border) border->load = LamBorderMoved(border, load, alpha);
  ++rve->work.iterations;
}

/* Updates linear.rate, the distance of the factor from the current matrix, after full steps with it; infinite (unknown)
   if the step was shortened, the matrix shifted or the system bordered. */
static void WatchFactor(LamRVE rve, const LamBorder *border, PetscReal shift, PetscReal alpha, PetscReal norm,
                        PetscReal previous, PetscBool fresh)
{
  const PetscReal rate = 2.0 * norm / previous;

  if (border || shift != 0.0 || alpha != 1.0)
    rve->linear.rate = PETSC_INFINITY;
  else
    rve->linear.rate = fresh ? rate : PetscMax(rate, rve->linear.rate);
}

PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamBorder *border, LamNewtonOutcome *outcome)
{
  const PetscReal tolerance = LamNewtonTolerance(rve);
  PetscReal first = 0.0, previous = PETSC_INFINITY, shift = 0.0, alpha = 0.0, largest = PETSC_INFINITY;
  PetscBool fresh = PETSC_FALSE; /* the last step used a new factorisation */
  PetscBool last = PETSC_FALSE;  /* the last step is expected to have converged */
  PetscInt growth = 0;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  rve->linear.rate = PETSC_INFINITY;
  rve->consistent = PETSC_FALSE;
  for (PetscInt it = 0; it <= FAST_ITERATIONS && !rve->work.stopped; ++it) {
    PetscReal energy, norm;
    PetscBool valid, ok = PETSC_TRUE;

    if (last) last = LamSetConsistentStresses(rve, load, rve->y);
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (!valid) break;
    norm = LamResidualNorm(rve, rve->residual);
    PetscCall(LamBorderAssemble(rve, border, &norm));
    if (it == 0) first = norm;
    if (it > 0) WatchFactor(rve, border, shift, alpha, norm, previous, fresh);
    /* an affinely moved initial guess does not count as converged; rate * largest estimates the next step */
    if ((norm <= tolerance && (it > 0 || !rve->moved)) ||
        LamAtRounding(rve, norm, tolerance, rve->linear.rate * largest)) {
      PetscCall(LamReportIteration(rve, "fast", it, norm, 0.0, 0.0));
      *outcome = LAM_NEWTON_CONVERGED;
      rve->consistent = last;
      break;
    }
    growth = norm > previous ? growth + 1 : 0;
    last = (PetscBool)(norm * PetscSqr(norm / previous) <=
                       ROUNDING_MARGIN * tolerance); /* assuming quadratic convergence */
    previous = norm;
    /* the residual may grow for a few steps while the stiff constraints are violated */
    if (it == FAST_ITERATIONS || growth >= 4 || !(norm < 1e8 * (1.0 + first))) break;
    fresh = (PetscBool)!FactorServes(rve, norm, tolerance);
    if (it == 0 || border) last = PETSC_FALSE;
    if (fresh) PetscCall(LamFactorPositive(rve, PETSC_INFINITY, &shift, &ok));
    if (!ok) break;
    PetscCall(LamSolveStep(rve, border));
    largest = LamBorderReach(rve, border, rve->step + 2);
    PetscCall(LamReportIteration(rve, "fast", it, norm, largest, shift));
    if (LamAtRounding(rve, norm, tolerance, largest)) {
      if (it == 0 && shift == 0.0) LamTakeStep(rve, load, border, 1.0);
      *outcome = LAM_NEWTON_CONVERGED;
      break;
    }
    if (shift > 0.0 && norm < SADDLE_RESIDUAL) {
      *outcome = LAM_NEWTON_NEAR_SADDLE;
      break;
    }
    if (!(largest < 10.0)) break;
    PetscCall(LamValidStep(rve, load, border, &alpha));
    if (alpha == 0.0) break;
    LamTakeStep(rve, load, border, alpha);
  }
  PetscFunctionReturn(0);
}

/* State of the safe tier. */
typedef struct {
  PetscReal *best; /* [length] y of the lowest energy so far */
  PetscReal *mode; /* [n] softest mode of the last indefinite matrix */
  PetscReal best_energy, shift, rounding;
  PetscInt without_decrease;
  PetscBool monotone; /* line search on the next step */
} Descent;

/* Halves the step until the energy decreases sufficiently; *alpha = 0 if it does not. */
static PetscErrorCode LineSearch(LamRVE rve, const LamLoad *load, PetscReal energy, PetscReal slope, PetscReal rounding,
                                 PetscReal *alpha)
{
  PetscFunctionBeginUser;
  for (; *alpha > 1e-5; *alpha *= 0.5) {
    PetscReal trial;
    PetscBool valid;

    TrialPosition(rve, *alpha);
    PetscCall(LamAssembleEnergy(rve, load, rve->trial, &trial, &valid));
    if (valid && trial <= energy + ARMIJO * *alpha * slope + rounding) PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

/* Stores the point of lowest energy; returns to it after too many steps without decrease. *moved: rve->y was reset. */
static PetscErrorCode Watch(LamRVE rve, const LamLoad *load, PetscReal energy, PetscBool valid, Descent *descent,
                            PetscBool *moved)
{
  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  if (valid && energy < descent->best_energy) {
    PetscCall(PetscArraycpy(descent->best, rve->y, rve->length));
    descent->best_energy = energy;
    descent->without_decrease = 0;
    PetscFunctionReturn(0);
  }
  if (valid && energy <= descent->best_energy + descent->rounding) PetscFunctionReturn(0);
  if (valid && ++descent->without_decrease <= WATCHDOG) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(rve->y, descent->best, rve->length));
  (void)LamSetConsistentStresses(rve, load, rve->y);
  LamSealSetConsistent(rve, load, rve->y);
  descent->without_decrease = 0;
  descent->monotone = PETSC_TRUE;
  *moved = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/*
  Adds a downhill multiple of the softest mode to the step, if the mode has negative curvature. Used for small Newton
  steps of an indefinite matrix: near a saddle the residual has almost no component along that mode, and Newton alone is
  slow.
*/
static PetscErrorCode AddNegativeCurvature(LamRVE rve, Descent *descent)
{
  PetscReal slope, largest, sign;

  PetscFunctionBeginUser;
  PetscCall(LamImproveSoftestMode(rve, 4, descent->mode));
  if (LamModeCurvature(rve, descent->mode, rve->trial + 2) >= 0.0) PetscFunctionReturn(0);
  slope = LamModeSlope(rve, descent->mode, rve->residual);
  largest = LamLargestEntry(rve->linear.positions, descent->mode);
  sign = slope > LamNewtonTolerance(rve) ? -1.0 : 1.0; /* if the slope is zero, the mode's own sign */
  LamAddMode(rve, sign * ESCAPE_STEP / largest, descent->mode, rve->step);
  ++rve->work.escapes;
  PetscFunctionReturn(0);
}

/* One step of the safe tier from an assembled state; *alpha = 0: no step found. */
static PetscErrorCode SafeStep(LamRVE rve, const LamLoad *load, PetscInt it, PetscReal energy, PetscReal norm,
                               Descent *descent, PetscReal *alpha)
{
  PetscReal largest, slope = 0.0;
  PetscBool ok;

  PetscFunctionBeginUser;
  *alpha = 0.0;
  PetscCall(LamFactorPositive(rve, PETSC_INFINITY, &descent->shift, &ok));
  if (!ok) PetscFunctionReturn(0);
  PetscCall(LamSolveStep(rve, NULL));
  if (descent->shift > 0.0 && LamLargestEntry(rve->ndof, rve->step) < 0.5 * ESCAPE_STEP)
    PetscCall(AddNegativeCurvature(rve, descent));
  largest = LamLargestEntry(rve->ndof, rve->step);
  PetscCall(LamReportIteration(rve, "safe", it, norm, largest, descent->shift));
  *alpha = largest > STEP_LIMIT ? STEP_LIMIT / largest : 1.0;
  if (descent->monotone) {
    for (PetscInt i = 2; i < rve->ndof; ++i) slope += rve->residual[i] * rve->step[i];
    PetscCall(LineSearch(rve, load, energy, slope, descent->rounding, alpha));
    descent->monotone = PETSC_FALSE;
  }
  LamTakeStep(rve, load, NULL, *alpha);
  PetscFunctionReturn(0);
}

PetscErrorCode LamNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome)
{
  const PetscReal tolerance = LamNewtonTolerance(rve);
  Descent descent = {0};
  PetscReal energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  rve->linear.rate = PETSC_INFINITY;
  rve->consistent = PETSC_FALSE;
  PetscCall(LamAssembleEnergy(rve, load, rve->y, &descent.best_energy, &valid));
  if (!valid) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(rve->length, &descent.best, rve->linear.n, &descent.mode));
  LamStartMode(rve, descent.mode);
  LamSealSetConsistent(rve, load, rve->y);
  PetscCall(PetscArraycpy(descent.best, rve->y, rve->length));
  (void)LamSetConsistentStresses(rve, load, rve->y);
  descent.rounding = 1e-14 * rve->stiffest * rve->mesh.V0;
  for (PetscInt it = 0; it < SAFE_ITERATIONS && LamMayIterate(rve); ++it) {
    PetscReal norm, alpha;
    PetscBool moved;

    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    norm = valid ? LamResidualNorm(rve, rve->residual) : PETSC_INFINITY;
    if (norm <= tolerance) {
      *outcome = LAM_NEWTON_CONVERGED;
      break;
    }
    PetscCall(Watch(rve, load, energy, valid, &descent, &moved));
    if (moved) continue;
    PetscCall(SafeStep(rve, load, it, energy, norm, &descent, &alpha));
    if (LamAtRounding(rve, norm, tolerance, LamLargestEntry(rve->ndof, rve->step))) {
      *outcome = LAM_NEWTON_CONVERGED;
      break;
    }
    if (alpha == 0.0) break;
  }
  PetscCall(PetscFree2(descent.best, descent.mode));
  PetscFunctionReturn(0);
}
