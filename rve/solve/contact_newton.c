/*
  Contact equilibrium at one load, starting from rve->y and contact->lambda.

  Method. Primal-dual active set, which is a semi-smooth Newton method. The hats with lambda - c gap > 0 are active:
  their linearised weighted gaps are set to zero, and their multipliers are solved for, not incremented. All other
  multipliers are zero. As in the bonded tiers, the tangent has independent wall stresses, and a shift if it is not
  positive definite on the free motions. If the initial guess is far from contact, the rows of the first iterations have
  a decreasing compliance, G + c D lambda = 0, and steps are short. If it is near, steps are full, and a step that is
  too long ends the iteration. Late steps that still change the active set are halved, to break cycles. The junction
  status is updated in the first iterations and then frozen, so that it cannot alternate. If a solution changes the
  status, the iteration continues with the new one.

    [ K - sum lambda d2G + shift   -B^T  ] [ dx         ]   [ -r0 ]      r0: residual without contact forces
    [ -B                           -c D  ] [ lambda_new ] = [  G  ]

  References. Hueber & Wohlmuth, Comput. Methods Appl. Mech. Engrg 194 (2005) 3147; Popp, Gee & Wall, Int. J. Numer.
  Meth. Engng 79 (2009) 1354.
*/
#include "solve.h"

#define ITERATIONS 40 /* initial guess far from contact */
#define CYCLE_AFTER 9 /* iterations, after which steps that change the active set are halved to break cycles */
#define NEAR_ITERATIONS 20
#define FOLLOW_ITERATIONS 6 /* first iterations, in which the junction status is updated */
#define FOLLOW_FAR 25       /* the same, while steps are shortened */
#define RESTARTS 3          /* after a solution has changed the junction status */
#define COMPLIANT_ITERATIONS 4
#define COMPLIANCE 0.033      /* apothems / (C1 + C2), in the first iteration */
#define USUAL_PRESSURE 0.5    /* C1 + C2: larger turgor + cohesion reduces the compliance */
#define COMPLIANCE_DECAY 0.3  /* factor per iteration */
#define STEP_LIMIT 0.02       /* apothems, initial guess far from contact */
#define NEAR_LIMIT 0.2        /* apothems, otherwise */
#define LEAST_STEP 1e-4       /* least share of a step */
#define LOOSE_TOLERANCE 1e-4  /* during release of the interface */
#define ROUNDING_MARGIN 100.0 /* times the tolerance: smaller residuals may be rounding errors, ... */
#define ROUNDING_STEP 1e-11   /* ... if the step is at most this share of the extent */

/*
  Whether the residual is at rounding level. Rounding errors of stiff walls can keep it above the tolerance, and soft
  modes amplify them to steps longer than the last digits of a position.
*/
static PetscBool IsAtRounding(LamRVE rve, const LamContactStep *step, PetscReal norm, PetscReal tolerance)
{
  const PetscReal extent = PetscMax(1.0, LamLargestEntry(rve->ndof, rve->y));

  return (PetscBool)(step->shift <= LAM_CONTACT_PROXIMAL && norm <= ROUNDING_MARGIN * tolerance &&
                     rve->contact->largest_step <= ROUNDING_STEP * extent);
}

static PetscErrorCode Report(LamRVE rve, PetscInt it, PetscReal norm, PetscReal gap, PetscInt changes, PetscReal step,
                             PetscReal alpha, PetscReal shift)
{
  PetscFunctionBeginUser;
  if (rve->monitor)
    PetscCall(
        PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                     "  contact %3d  residual %9.3e  complementarity %9.3e  active %3d (%d changed)  largest step "
                     "%9.3e x %.3g  shift %g\n",
                     (int)it, (double)norm, (double)gap, (int)LamContactCountActive(rve->contact), (int)changes,
                     (double)step, (double)alpha, (double)shift));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactNewton(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal reach,
                                LamNewtonOutcome *outcome)
{
  const PetscBool compliant = (PetscBool)(reach == LAM_FAR);
  const PetscBool under_way = (PetscBool)(rve->contact->share > 0.0);
  const PetscReal tolerance = under_way ? LOOSE_TOLERANCE : LamNewtonTolerance(rve);
  const PetscReal gap_tolerance = under_way ? LOOSE_TOLERANCE : LamGapTolerance(rve);
  /* overlap = compliance x pressure must not grow with the pressure */
  const PetscReal first = COMPLIANCE * PetscMin(1.0, USUAL_PRESSURE / PetscMax(1e-300, load->turgor + load->cohesion));
  const PetscInt most = compliant ? ITERATIONS : NEAR_ITERATIONS;
  PetscInt follow_until = FOLLOW_ITERATIONS, restarts = 0;
  PetscBool at_rounding = PETSC_FALSE;
  LamContactStep step;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  rve->contact->hysteresis = LAM_HYSTERESIS;
  PetscCall(LamContactStepCreate(rve, border, &step));
  for (PetscInt it = 0; it <= most && LamMayIterate(rve); ++it) {
    const PetscReal compliance =
        compliant && it < COMPLIANT_ITERATIONS ? first * PetscPowReal(COMPLIANCE_DECAY, (PetscReal)it) : 0.0;
    PetscReal energy, norm, gap, alpha;
    PetscInt changes;
    PetscBool valid, ok;

    PetscCall(LamContactEvaluate(rve, load, rve->y, (PetscBool)(it < follow_until)));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (!valid) break;
    changes = LamContactFindActive(rve->contact, compliance);
    LamContactResidual(rve, &step, &norm);
    PetscCall(LamBorderAssemble(rve, border, &norm));
    gap = LamContactComplementarity(rve->contact);
    if (compliance == 0.0 && (norm <= tolerance || at_rounding) && gap <= gap_tolerance) {
      PetscCall(Report(rve, it, norm, gap, changes, 0.0, 0.0, 0.0));
      if (LamContactStatusHolds(rve, load, rve->y)) *outcome = LAM_NEWTON_CONVERGED;
      if (*outcome == LAM_NEWTON_CONVERGED || restarts++ == RESTARTS) break;
      rve->contact->hysteresis += LAM_MORE_HYSTERESIS;
      follow_until = it + 2;
      continue;
    }
    LamContactAddCurvature(rve);
    PetscCall(LamContactSolveStep(rve, norm, compliance, &step, &ok));
    if (!ok) break;
    rve->contact->largest_step = LamBorderReach(rve, border, rve->step + 2);
    alpha = PetscMin(1.0, (compliant ? STEP_LIMIT : NEAR_LIMIT) / PetscMax(rve->contact->largest_step, 1e-300));
    alpha = LamValidStep(rve, load, border, alpha, LEAST_STEP);
    PetscCall(Report(rve, it, norm, gap, changes, rve->contact->largest_step, alpha, step.shift));
    if (alpha == 0.0 || (!compliant && rve->contact->largest_step > reach)) break;
    at_rounding = (PetscBool)(changes == 0 && IsAtRounding(rve, &step, norm, tolerance));
    if (it >= CYCLE_AFTER && changes > 0) alpha *= 0.5;
    if (alpha < 1.0 && it < FOLLOW_FAR) follow_until = PetscMax(follow_until, it + 3);
    LamContactTakeStep(rve, load, alpha, &step);
  }
  PetscCall(LamContactStepDestroy(&step));
  PetscFunctionReturn(0);
}
