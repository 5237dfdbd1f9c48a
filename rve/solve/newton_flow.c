/*
  Equilibrium from an unstable start, by a flow.

  Method. Steps of K + shift 1, as in the fast tier, but the shift starts at the bending stiffness of the thinnest wall
  and the residual may grow as long as it likes: the state comes down from where it is unstable, and the stiff
  constraints, violated by each step and restored by the next, say nothing of how far it is. Steps that become long are
  shortened by a larger shift, which still restores the constraints, where shortening them would not. What comes down to
  a lumen that is shut is not followed further: contact inside a lumen is not modelled.
*/
#include "newton.h"

#define ITERATIONS 120
#define BENDING 1.0       /* first shift, in cubes of the thinnest wall */
#define BOLD_ITERATIONS 8 /* unstable steps of any length below ... */
#define BOLD_LIMIT 10.0   /* apothems; then below ... */
#define STEP_LIMIT 0.05
#define SHORTENINGS 12
#define LOOK_EVERY 4    /* unstable steps: for lumens that are shut */
#define MOST_GROWTH 1e8 /* of the residual */
#define DIVERGING 6     /* stable steps in a row by which the residual may grow */
#define SADDLE_RESIDUAL 1e-4

typedef struct {
  PetscReal first, previous; /* residuals */
  PetscReal shift, largest;  /* of the last step */
  PetscInt unstable;         /* steps with a shift so far */
  PetscInt growth;           /* steps in a row without one by which the residual grew */
  PetscInt shut;             /* cell whose lumen was found shut; -1: none */
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

/* Whether the lumen of a cell was shut twice when looked for. */
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

/* Whether the iteration is lost. */
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
  rve->linear.rate = PETSC_INFINITY;
  rve->consistent = PETSC_FALSE;
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
    PetscCall(LamValidStep(rve, load, NULL, &alpha));
    if (alpha == 0.0) break;
    LamTakeStep(rve, load, NULL, alpha);
    if (!(flow.shift > 0.0)) continue;
    ++flow.unstable;
    PetscCall(IsShut(rve, &flow, &is_shut));
    if (!is_shut) continue;
    *shut = flow.shut;
    break;
  }
  if (*outcome == LAM_NEWTON_CONVERGED && flow.unstable) ++rve->work.escapes; /* it has left unstable states */
  PetscFunctionReturn(0);
}
