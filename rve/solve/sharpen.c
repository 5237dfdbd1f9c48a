/*
  From a state near it to equilibrium with the exact law of contact between facing walls.

  Method. Primal-dual active set, which is a semi-smooth Newton method. The hats with lambda - c gap > 0 are active:
  their linearised weighted gaps are set to zero, and their multipliers are solved for, not incremented. All other
  multipliers are zero. The tangent has independent wall stresses, and a shift if it is not positive definite on the
  free motions; near a saddle the softest mode is added, downhill. The junction status follows the positions
  in the first iterations; if the solution disagrees with it, the iteration continues with that of the solution.

    [ K - sum lambda d2G + shift   -B^T ] [ dx         ]   [ -r0 ]      r0: residual without contact forces
    [ -B                            0   ] [ lambda_new ] = [  G  ]

  The initial guess is a state of the smooth law, or a solution at a near load. Where the iteration does not progress,
  it ends: there is a smooth state to return to.

  References. Hueber & Wohlmuth, Comput. Methods Appl. Mech. Engrg 194 (2005) 3147; Popp, Gee & Wall, Int. J. Numer.
  Meth. Engng 79 (2009) 1354.
*/
#include "contact_find.h"

#define ITERATIONS 40
#define STEP_LIMIT 0.02  /* apothems, from a smooth state */
#define LEAST_STEP 1e-4  /* least share of a step */
#define LEAST_SHIFT 1e-9 /* of the largest diagonal entry; small, as cells that hardly touch have little stiffness */
#define SHIFT_GROWTH 30.0
#define SHIFTS 9
#define NEAR_SHIFTS 4 /* from a near solution */
#define FOLLOW 5      /* first iterations after which the junction status follows, ... */
#define NEAR_FOLLOW 3 /* ... from a near solution not before this one: the first steps may be long */
#define IDLE 12 /* iterations without progress that end the iteration; of stiff walls the residual grows for a few */
#define NEAR_IDLE 5
#define PROGRESS 0.7          /* steps halved to break a cycle reduce the residual by half */
#define RESTARTS 2            /* after a solution has changed the junction status */
#define CYCLE_AFTER 9         /* iterations, after which steps that change the active set are halved to break cycles */
#define ROUNDING_MARGIN 100.0 /* times the tolerance: smaller residuals may be rounding errors, ... */
#define ROUNDING_STEP 1e-11   /* ... if the step is at most this share of the extent */

typedef struct {
  LamRVE rve;
  LamBorder *border;
  PetscReal *rhs, *solution; /* [n + 2], [n] */
  PetscReal *lambda;         /* [multipliers] after the step */
  PetscReal *image;          /* [n] */
  PetscBool near;            /* from a near solution: there are other ways if it goes astray */
  PetscReal shift, before;   /* before: largest entry of the previous step */
} Step;

/* Tolerance on max |min(lambda, c gap)|. */
static PetscReal GapTolerance(LamRVE rve)
{
  return PetscMax(1e-10, rve->tolerance);
}

static PetscReal ResidualNorm(Step *step)
{
  (void)PetscArraycpy(step->rhs, step->rve->residual, step->rve->length);
  LamContactAddForce(step->rve, step->rhs);
  return LamResidualNorm(step->rve, step->rhs);
}

/* Factors with the first of increasing shifts that leaves no more negative eigenvalues than expected. */
static PetscErrorCode Factor(Step *step, PetscBool *ok)
{
  const LamRVE rve = step->rve;
  const PetscInt expected = LamExpectedNegative(rve);
  PetscReal next = PetscMin(LEAST_SHIFT * LamLargestDiagonal(rve->linear), LamBendingStiffness(rve));
  PetscInt negative;

  PetscFunctionBeginUser;
  if (step->shift > LAM_PROXIMAL) next = PetscMax(step->shift / SHIFT_GROWTH, SHIFT_GROWTH * LAM_PROXIMAL);
  step->shift = LAM_PROXIMAL;
  for (PetscInt k = 0; k < (step->near ? NEAR_SHIFTS : SHIFTS); ++k) {
    PetscCall(LamRVEFactor(rve, step->shift, &negative, ok));
    if (*ok && negative <= expected) PetscFunctionReturn(0);
    step->shift = k == 0 ? next : SHIFT_GROWTH * step->shift;
  }
  *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Adds the softest mode, downhill, where the iteration is near a saddle. */
static PetscErrorCode LeaveSaddle(Step *step, PetscReal norm)
{
  const LamRVE rve = step->rve;
  const PetscReal largest = LamLargestEntry(rve->ndof, rve->step);

  PetscFunctionBeginUser;
  if (step->shift > LAM_PROXIMAL && largest < 0.5 * LAM_ESCAPE_STEP &&
      (norm < LAM_SADDLE_RESIDUAL || largest > LAM_CREEPING * step->before)) {
    (void)ResidualNorm(step);
    LamStartMode(rve, step->solution);
    PetscCall(LamAddNegativeCurvature(rve, 12, step->rhs, step->solution, step->image));
  }
  step->before = largest;
  PetscFunctionReturn(0);
}

/* rve->step and step->lambda for the present active set. */
static PetscErrorCode Solve(Step *step, PetscBool *ok)
{
  const LamRVE rve = step->rve;
  const LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear->positions, pressures = rve->linear->pressures;

  PetscFunctionBeginUser;
  LamContactSetRows(rve);
  PetscCall(Factor(step, ok));
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < positions; ++i) step->rhs[i] = -rve->residual[i + 2];
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) step->rhs[pressures + c] = -rve->residual[rve->ndof + c];
  for (PetscInt h = 0; h < contact->count; ++h)
    step->rhs[positions + h] = contact->active[h] ? contact->gap[h] * contact->weight[h] : 0.0;
  PetscCall(LamBorderSolve(rve, step->border, step->rhs, step->solution));
  rve->step[0] = rve->step[1] = 0.0;
  PetscCall(PetscArraycpy(rve->step + 2, step->solution, positions));
  PetscCall(PetscArraycpy(rve->step + rve->ndof, step->solution + pressures, rve->linear->lumens));
  for (PetscInt h = 0; h < contact->count; ++h)
    step->lambda[h] = contact->active[h] ? step->solution[positions + h] : 0.0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(LamRVE rve, PetscInt it, PetscReal norm, PetscReal gap, PetscInt changes, PetscReal step,
                             PetscReal shift)
{
  PetscFunctionBeginUser;
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "  exact %3d  residual %9.3e  complementarity %9.3e  active %3d (%d changed)  largest step "
                           "%9.3e  shift %g\n",
                           (int)it, (double)norm, (double)gap, (int)LamContactCountActive(rve->contact), (int)changes,
                           (double)step, (double)shift));
  PetscFunctionReturn(0);
}

/* Whether the residual is at rounding level: rounding errors of stiff walls can keep it above the tolerance, and soft
   modes amplify them to steps longer than the last digits of a position. */
static PetscBool IsAtRounding(const Step *step, PetscReal norm, PetscReal tolerance, PetscReal largest)
{
  const PetscReal extent = PetscMax(1.0, LamLargestEntry(step->rve->ndof, step->rve->y));

  return (PetscBool)(step->shift <= LAM_PROXIMAL && norm <= ROUNDING_MARGIN * tolerance &&
                     largest <= ROUNDING_STEP * extent);
}

PetscErrorCode LamSharpen(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal reach,
                          LamNewtonOutcome *outcome)
{
  const PetscReal tolerance = LamNewtonTolerance(rve), limit = reach > 0.0 ? PETSC_INFINITY : STEP_LIMIT;
  const PetscInt n = rve->linear->n;
  PetscReal least = PETSC_INFINITY;
  PetscInt idle = 0, restarts = 0, started = 0;
  PetscBool at_rounding = PETSC_FALSE;
  Step step = {.rve = rve, .border = border, .near = (PetscBool)(reach > 0.0), .before = PETSC_INFINITY};

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  LamForgetTangent(rve);
  PetscCall(PetscMalloc4(n + 2, &step.rhs, n, &step.solution, rve->contact->count, &step.lambda, n, &step.image));
  for (PetscInt it = 0; it <= ITERATIONS && LamMayIterate(rve); ++it) {
    PetscReal energy, norm, gap, largest, alpha;
    PetscInt changes;
    PetscBool valid, ok;

    if (it >= (step.near ? NEAR_FOLLOW : 1) && it <= FOLLOW) (void)LamContactMerge(rve, load, rve->y);
    PetscCall(LamContactEvaluate(rve, load, rve->y));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (!valid) break;
    changes = it == 0 && reach == 0.0 ? 0 : LamContactFindActive(rve->contact);
    norm = ResidualNorm(&step);
    PetscCall(LamBorderAssemble(rve, border, &norm));
    gap = LamContactComplementarity(rve->contact);
    if ((norm <= tolerance || at_rounding) && gap <= GapTolerance(rve) && it > 0) {
      PetscCall(Report(rve, it, norm, gap, changes, 0.0, 0.0));
      *outcome = LAM_NEWTON_CONVERGED;
      if (restarts++ == RESTARTS || !LamContactMerge(rve, load, rve->y)) break;
      *outcome = LAM_NEWTON_STALLED;
      started = it;
      idle = 0;
      least = PETSC_INFINITY;
      continue;
    }
    idle = norm + gap < PROGRESS * least ? 0 : idle + 1;
    if (it > 0)
      least = PetscMin(least, norm + gap); /* a smooth state violates the exact law little, but has far to go */
    if (idle > (step.near ? NEAR_IDLE : IDLE)) break;
    LamContactAddCurvature(rve);
    PetscCall(Solve(&step, &ok));
    if (!ok) break;
    PetscCall(LeaveSaddle(&step, norm));
    largest = LamBorderReach(rve, border, rve->step + 2);
    PetscCall(Report(rve, it, norm, gap, changes, largest, step.shift));
    if (reach > 0.0 && largest > reach) break;
    alpha = LamValidStep(rve, load, border, PetscMin(1.0, limit / PetscMax(largest, 1e-300)), LEAST_STEP);
    if (alpha == 0.0) break;
    at_rounding = (PetscBool)(changes == 0 && IsAtRounding(&step, norm, tolerance, largest));
    if (it >= started + CYCLE_AFTER && changes > 0) alpha *= 0.5;
    LamTakeStep(rve, load, border, alpha);
    for (PetscInt h = 0; h < rve->contact->count; ++h)
      rve->contact->lambda[h] += alpha * (step.lambda[h] - rve->contact->lambda[h]);
  }
  PetscCall(PetscFree4(step.rhs, step.solution, step.lambda, step.image));
  PetscFunctionReturn(0);
}
