/*
  Equilibrium of contact tissue at one load, from rve->y and contact->lambda.

  Method. Primal-dual active set, which is a semi-smooth Newton method: the hats with lambda - c gap > 0 are active,
  their weighted gaps are linearised to zero, the other multipliers are zero; multipliers of active hats are solved for,
  not incremented. As in the bonded tiers the tangent has independent wall stresses, and a shift where it is not
  positive definite on the free motions. With first iterates far from contact the rows get a compliance that fades:
  G + c D lambda = 0. Steps are limited in length. The junction status follows the iterate for a while and is then
  frozen, so that it cannot flicker; a solution whose status has changed is iterated on.

    [ K - sum lambda d2G + shift   -B^T  ] [ dx         ]   [ -r0 ]      r0: residual without contact forces
    [ -B                           -c D  ] [ lambda_new ] = [  G  ]

  References. Hueeber & Wohlmuth, Comput. Methods Appl. Mech. Engrg 194 (2005) 3147; Popp, Gee & Wall, Int. J. Numer.
  Meth. Engng 79 (2009) 1354.
*/
#include "rve_impl.h"

#define ITERATIONS 40 /* from a start far from contact */
#define NEAR_ITERATIONS 20
#define ACTIVE_SET_SOLVES 6 /* solves with one linearisation until the active set fits the step */
#define RUNAWAY 0.5         /* apothems: a step this large from a near start leads nowhere */
#define FOLLOW_ITERATIONS 6 /* in which the junction status follows the iterate */
#define FOLLOW_FAR 25       /* the same while steps are shortened */
#define COMPLIANT_ITERATIONS 4
#define COMPLIANCE 0.033 /* apothems / (C1 + C2), in the first iteration; falls by the same factor each time */
#define COMPLIANCE_DECAY 0.3
#define STEP_LIMIT 0.02      /* apothems, from a start far from contact */
#define FAR_LIMIT 0.2        /* else */
#define LOOSE_TOLERANCE 1e-4 /* while the interface is being released */

static PetscReal LargestEntry(PetscInt n, const PetscReal v[])
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, PetscAbsReal(v[i]));
  return largest;
}

/* Factors with the smallest tried shift that leaves as many negative eigenvalues as active hats. */
static PetscErrorCode FactorStable(LamRVE rve, PetscReal *last_shift, PetscBool *ok)
{
  const PetscInt active = LamContactCountActive(rve->contact);
  PetscReal diagonal = 0.0, shift = LAM_CONTACT_PROXIMAL;
  PetscInt negative;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rve->linear.positions; ++i)
    diagonal = PetscMax(diagonal, PetscAbsReal(rve->linear.values[rve->linear.row[i]]));
  for (PetscInt attempt = 0; attempt < 40; ++attempt) {
    PetscCall(LamLinearFactor(&rve->linear, shift, &negative, ok));
    ++rve->work.factorisations;
    if (*ok && negative <= active) break;
    *ok = PETSC_FALSE;
    if (shift > diagonal) break;
    shift = attempt == 0 ? PetscMax(*last_shift / 8.0, 1e-7 * diagonal) : 4.0 * shift;
  }
  *last_shift = shift;
  PetscFunctionReturn(0);
}

/* Solves for rve->step and the new multipliers, rhs and solution [n] being work space. residual: without contact. */
static PetscErrorCode SolveStep(LamRVE rve, const PetscReal residual[], PetscReal rhs[], PetscReal solution[],
                                PetscReal lambda_new[])
{
  const LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear.positions;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < positions; ++i) rhs[i] = -residual[i + 2];
  for (PetscInt h = 0; h < contact->count; ++h)
    rhs[positions + h] = contact->active[h] ? contact->gap[h] * contact->weight[h] : 0.0;
  PetscCall(LamLinearSolve(&rve->linear, 1, rhs, solution));
  rve->step[0] = rve->step[1] = 0.0;
  PetscCall(PetscArraycpy(rve->step + 2, solution, positions));
  for (PetscInt h = 0; h < contact->count; ++h) lambda_new[h] = contact->active[h] ? solution[positions + h] : 0.0;
  PetscFunctionReturn(0);
}

/* Step length: limited, and halved until no volume turns inside out; 0: none. */
static PetscErrorCode StepLength(LamRVE rve, const LamLoad *load, PetscReal limit, PetscReal *alpha)
{
  const PetscReal largest = LargestEntry(rve->ndof, rve->step);

  PetscFunctionBeginUser;
  for (*alpha = PetscMin(1.0, limit / PetscMax(largest, 1e-300)); *alpha > 1e-4; *alpha *= 0.5) {
    for (PetscInt i = 0; i < rve->ndof; ++i) rve->trial[i] = rve->y[i] + *alpha * rve->step[i];
    if (LamPositionsAreValid(rve, load, rve->trial)) PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

static void TakeStep(LamRVE rve, const LamLoad *load, PetscReal alpha, const PetscReal lambda_new[])
{
  LamContact *contact = rve->contact;

  LamUpdateStresses(rve, load, rve->y, rve->step, alpha);
  for (PetscInt i = 0; i < rve->ndof; ++i) rve->y[i] += alpha * rve->step[i];
  for (PetscInt h = 0; h < contact->count; ++h) contact->lambda[h] += alpha * (lambda_new[h] - contact->lambda[h]);
  ++rve->work.iterations;
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

PetscErrorCode LamContactNewton(LamRVE rve, const LamLoad *load, PetscBool compliant, LamNewtonOutcome *outcome)
{
  const PetscBool under_way = (PetscBool)(rve->contact->share > 0.0);
  const PetscReal tolerance = under_way ? LOOSE_TOLERANCE : LamNewtonTolerance(rve);
  const PetscReal gap_tolerance = under_way ? LOOSE_TOLERANCE : 1e-10;
  LamContact *contact = rve->contact;
  PetscReal shift = 0.0, *rhs, *solution, *lambda_new;
  PetscInt follow_until = FOLLOW_ITERATIONS;
  PetscInt restarts = 0;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  PetscCall(
      PetscMalloc3(PetscMax(rve->ndof, rve->linear.n), &rhs, rve->linear.n, &solution, contact->count, &lambda_new));
  for (PetscInt it = 0; it <= (compliant ? ITERATIONS : NEAR_ITERATIONS) && rve->work.iterations < LAM_ITERATION_BUDGET;
       ++it) {
    const PetscReal compliance =
        compliant && it < COMPLIANT_ITERATIONS ? COMPLIANCE * PetscPowReal(COMPLIANCE_DECAY, (PetscReal)it) : 0.0;
    PetscReal energy, norm, gap, alpha;
    PetscInt changes;
    PetscBool valid, ok;

    PetscCall(LamContactEvaluate(rve, load, rve->y, (PetscBool)(it < follow_until)));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (!valid) break;
    changes = LamContactFindActive(contact, compliance);
    if (contact->share > 0.0)
      for (PetscInt i = 0; i < rve->ndof; ++i) rve->residual[i] -= contact->share * contact->held[i];
    PetscCall(PetscArraycpy(rhs, rve->residual, rve->ndof));
    LamContactAddForce(rve, rhs);
    norm = LamResidualNorm(rve, rhs);
    gap = LamContactComplementarity(contact);
    if (compliance == 0.0 && norm <= tolerance && gap <= gap_tolerance) {
      PetscBool holds;

      PetscCall(Report(rve, it, norm, gap, changes, 0.0, 0.0, 0.0));
      PetscCall(LamContactStatusHolds(rve, load, rve->y, &holds));
      *outcome = LAM_NEWTON_CONVERGED;
      if (holds || restarts++ > 2) break;
      *outcome = LAM_NEWTON_STALLED;
      follow_until = it + 2;
      continue;
    }
    LamContactAddCurvature(rve);
    for (PetscInt k = 0; k < ACTIVE_SET_SOLVES; ++k) {
      PetscInt more;

      LamContactSetRows(rve, compliance);
      PetscCall(FactorStable(rve, &shift, &ok));
      if (!ok) break;
      PetscCall(SolveStep(rve, rve->residual, rhs, solution, lambda_new));
      if (k + 1 == ACTIVE_SET_SOLVES) break;
      more = LamContactPredictActive(rve, rve->step, lambda_new, compliance);
      changes += more;
      if (more == 0) break;
    }
    if (!ok) break;
    PetscCall(StepLength(rve, load, compliant ? STEP_LIMIT : FAR_LIMIT, &alpha));
    PetscCall(Report(rve, it, norm, gap, changes, LargestEntry(rve->ndof, rve->step), alpha, shift));
    if (alpha == 0.0 || (!compliant && LargestEntry(rve->ndof, rve->step) > RUNAWAY)) break;
    if (alpha < 1.0 && it < FOLLOW_FAR) follow_until = PetscMax(follow_until, it + 3);
    TakeStep(rve, load, alpha, lambda_new);
  }
  PetscCall(PetscFree3(rhs, solution, lambda_new));
  PetscFunctionReturn(0);
}
