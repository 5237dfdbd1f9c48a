/*
  Equilibrium from an unstable initial guess, by a flow.

  Method. Steps of K + shift 1, as in the fast tier, but the shift starts at the bending stiffness of the thinnest wall
  and the residual may grow while the matrix is shifted: each step violates the stiff constraints and the next restores
  them, so the residual does not measure progress. Long steps are shortened by a larger shift, which, unlike scaling,
  still restores the constraints. The iteration ends if a lumen closes, as contact inside a lumen is not modelled.
*/
#include "solve.h"

#define ITERATIONS 120
#define BENDING 1.0       /* first shift, in units of LamBendingStiffness */
#define BOLD_ITERATIONS 8 /* first shifted steps, limited to ... */
#define BOLD_LIMIT 10.0   /* ... this length, apothems; ... */
#define STEP_LIMIT 0.05   /* ... later ones to this */
#define SHORTENINGS 12
#define LOOK_EVERY 4    /* shifted steps between checks for closed lumens */
#define MOST_GROWTH 1e8 /* of the residual, times 1 + the first one */
#define DIVERGING 6     /* successive unshifted steps with a growing residual that end the iteration */
#define SADDLE_RESIDUAL 1e-4

typedef struct {
  PetscReal first, previous; /* residuals */
  PetscReal shift, largest;  /* of the last step */
  PetscInt unstable;         /* number of shifted steps */
  PetscInt growth;           /* successive unshifted steps with a growing residual */
  PetscInt shut;             /* cell whose lumen was closed at the last check; -1: none */
} Flow;

static PetscErrorCode FindStep(LamRVE rve, Flow *flow, PetscBool *ok)
{
  const PetscReal limit = flow->unstable < BOLD_ITERATIONS ? BOLD_LIMIT : STEP_LIMIT;

  PetscFunctionBeginUser;
  PetscCall(LamFactorPositive(rve, BENDING * LamBendingStiffness(rve), &flow->shift, ok));
  for (PetscInt k = 0; *ok; ++k) {
    PetscInt negative;

    PetscCall(LamSolveStep(rve, NULL));
    flow->largest = LamLargestEntry(rve->ndof, rve->step);
    if (flow->shift == 0.0 || flow->largest <= limit || k == SHORTENINGS) break;
    flow->shift *= 4.0;
    PetscCall(LamRVEFactor(rve, flow->shift, &negative, ok));
  }
  PetscFunctionReturn(0);
}

/* Whether a lumen was closed at two successive checks. */
static PetscErrorCode IsShut(LamRVE rve, Flow *flow, PetscBool *shut)
{
  const PetscInt before = flow->shut;

  PetscFunctionBeginUser;
  *shut = PETSC_FALSE;
  if (flow->unstable % LOOK_EVERY) PetscFunctionReturn(0);
  PetscCall(LamFindCollapsedLumen(rve, rve->y, &flow->shut));
  *shut = (PetscBool)(before >= 0 && flow->shut >= 0);
  PetscFunctionReturn(0);
}

/* Whether the iteration diverges. */
static PetscBool IsLost(const Flow *flow, PetscReal norm)
{
  return (PetscBool)(flow->growth >= DIVERGING || !(norm < MOST_GROWTH * (1.0 + flow->first)));
}

PetscErrorCode LamNewtonFlow(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome, PetscInt *shut)
{
  const PetscReal tolerance = LamNewtonTolerance(rve);
  Flow flow = {.previous = PETSC_INFINITY, .largest = PETSC_INFINITY, .shut = -1};

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  *shut = -1;
  LamForgetFactor(rve);
  for (PetscInt it = 0; it < ITERATIONS && LamMayIterate(rve); ++it) {
    PetscReal energy, norm, alpha;
    PetscBool valid, ok, is_shut;

    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (!valid) break;
    norm = LamResidualNorm(rve, rve->residual);
    if (it == 0) flow.first = norm;
    if (flow.shift == 0.0) flow.growth = norm > flow.previous ? flow.growth + 1 : 0;
    flow.previous = norm;
    if (norm <= tolerance) *outcome = LAM_NEWTON_CONVERGED;
    if (norm <= tolerance || IsLost(&flow, norm)) break;
    PetscCall(FindStep(rve, &flow, &ok));
    if (!ok) break;
    PetscCall(LamReportIteration(rve, "flow", it, norm, flow.largest, flow.shift));
    if (LamAtRounding(rve, norm, tolerance, flow.largest))
      *outcome = LAM_NEWTON_CONVERGED;
    else if (flow.shift > 0.0 && norm < SADDLE_RESIDUAL)
      *outcome = LAM_NEWTON_NEAR_SADDLE;
    if (*outcome != LAM_NEWTON_STALLED) break;
    alpha = LamValidStep(rve, load, NULL, 1.0, LAM_LEAST_STEP);
    if (alpha == 0.0) break;
    LamTakeStep(rve, load, NULL, alpha);
    if (!(flow.shift > 0.0)) continue;
    ++flow.unstable;
    PetscCall(IsShut(rve, &flow, &is_shut));
    if (!is_shut) continue;
    *shut = flow.shut;
    break;
  }
  if (*outcome == LAM_NEWTON_CONVERGED && flow.unstable) ++rve->work.escapes; /* unstable states were left */
  PetscFunctionReturn(0);
}
