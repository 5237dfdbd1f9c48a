/*
  One step of an active-set iteration: residual, linear system, active set, escape from a saddle.

  Method. For one linearisation of the gaps, the active set is made consistent with the step: hats whose multiplier
  becomes tensile are removed, hats whose gap becomes negative are added, and the system is solved again. The matrix
  gets the smallest shift tried that leaves no more negative eigenvalues than expected (one per active hat and sealed
  lumen). The shift is never below LAM_CONTACT_PROXIMAL, so that a cell without contact does not make the matrix
  singular.
*/
#include "solve.h"

#define ACTIVE_SET_SOLVES 3 /* solves per linearisation until the active set is consistent with the step */
#define LEAST_SHIFT 1e-9    /* of the largest diagonal entry; small, as cells that hardly touch have little stiffness */
#define SADDLE_RESIDUAL 1e-3 /* norm below which a small step of an indefinite state is taken to be near a saddle */
#define CREEPING 0.6         /* the same for small steps longer than this share of the previous one */

PetscErrorCode LamContactStepCreate(LamRVE rve, LamBorder *border, LamContactStep *step)
{
  const PetscInt n = rve->linear->n;

  PetscFunctionBeginUser;
  *step = (LamContactStep){.before = PETSC_INFINITY, .border = border};
  PetscCall(PetscMalloc6(n + 2, &step->rhs, n, &step->solution, rve->contact->count, &step->lambda, n, &step->image, n,
                         &step->first, rve->contact->count, &step->factored));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactStepDestroy(LamContactStep *step)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(step->rhs, step->solution, step->lambda, step->image, step->first, step->factored));
  PetscFunctionReturn(0);
}

void LamContactResidual(LamRVE rve, LamContactStep *step, PetscReal *norm)
{
  const LamContact *contact = rve->contact;

  if (contact->share > 0.0)
    for (PetscInt i = 0; i < rve->ndof; ++i) rve->residual[i] -= contact->share * contact->held[i];
  for (PetscInt i = 0; i < rve->length; ++i) step->rhs[i] = rve->residual[i];
  LamContactAddForce(rve, step->rhs);
  *norm = LamResidualNorm(rve, step->rhs);
}

/* Factors with the first of increasing shifts, from the floor, that leaves no more negative eigenvalues than expected;
   again: from the last shift. After a shifted iteration the next one tries smaller shifts again, as shifts larger than
   needed slow down convergence. */
static PetscErrorCode FactorStable(LamRVE rve, PetscBool again, LamContactStep *step, PetscBool *ok)
{
  PetscReal next = PetscMin(LEAST_SHIFT * LamLargestDiagonal(rve->linear), LamBendingStiffness(rve));

  PetscFunctionBeginUser;
  if (step->shift > LAM_CONTACT_PROXIMAL) next = PetscMax(step->shift / 8.0, 8.0 * LAM_CONTACT_PROXIMAL);
  if (!again) step->shift = PetscMax(step->floor, LAM_CONTACT_PROXIMAL);
  PetscCall(LamFactorShifted(rve, LAM_CONTACT_PROXIMAL, next, 8.0, &step->shift, ok));
  PetscFunctionReturn(0);
}

/* Solves with the current factorisation. */
static PetscErrorCode Solve(LamRVE rve, LamContactStep *step)
{
  const LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear->positions, pressures = rve->linear->pressures;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < positions; ++i) step->rhs[i] = -rve->residual[i + 2];
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) step->rhs[pressures + c] = -rve->residual[rve->ndof + c];
  for (PetscInt h = 0; h < contact->count; ++h)
    step->rhs[positions + h] = contact->active[h] ? contact->gap[h] * contact->weight[h] : 0.0;
  PetscCall(LamBorderSolve(rve, step->border, step->rhs, step->solution));
  PetscFunctionReturn(0);
}

/* Copies the solution to rve->step and the new multipliers. */
static void TakeSolution(LamRVE rve, LamContactStep *step)
{
  const LamContact *contact = rve->contact;
  const PetscInt positions = rve->linear->positions, pressures = rve->linear->pressures;

  rve->step[0] = rve->step[1] = 0.0;
  (void)PetscArraycpy(rve->step + 2, step->solution, positions);
  (void)PetscArraycpy(rve->step + rve->ndof, step->solution + pressures, rve->linear->lumens);
  for (PetscInt h = 0; h < contact->count; ++h)
    step->lambda[h] = contact->active[h] ? step->solution[positions + h] : 0.0;
}

/* Factors, solves and stores the solution for LamContactUpdateStep, which requires a prescribed F and the minimum
   shift. */
static PetscErrorCode FactorAndSolve(LamRVE rve, PetscReal compliance, PetscBool again, LamContactStep *step,
                                     PetscBool *ok)
{
  PetscFunctionBeginUser;
  LamContactSetRows(rve, compliance);
  PetscCall(FactorStable(rve, again, step, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(Solve(rve, step));
  step->updates = (PetscBool)(!step->border && step->shift <= LAM_CONTACT_PROXIMAL);
  PetscCall(PetscArraycpy(step->factored, rve->contact->active, rve->contact->count));
  PetscCall(PetscArraycpy(step->first, step->solution, rve->linear->n));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactSolveStep(LamRVE rve, PetscReal norm, PetscReal compliance, LamContactStep *step,
                                   PetscBool *ok)
{
  PetscReal largest;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < ACTIVE_SET_SOLVES; ++k) {
    PetscBool updated = PETSC_FALSE;

    if (k > 0 && step->updates)
      PetscCall(LamContactUpdateStep(rve, step->factored, step->first, compliance, step->solution, &updated));
    if (!updated) PetscCall(FactorAndSolve(rve, compliance, (PetscBool)(k > 0), step, ok));
    if (!*ok) PetscFunctionReturn(0);
    TakeSolution(rve, step);
    if (k + 1 == ACTIVE_SET_SOLVES) break;
    if (!LamContactPredictActive(rve, rve->step, LamBorderStep(step->border), step->lambda, compliance)) break;
  }
  largest = LamLargestEntry(rve->ndof, rve->step);
  if (step->shift > LAM_CONTACT_PROXIMAL && largest < 0.5 * LAM_ESCAPE_STEP &&
      (norm < SADDLE_RESIDUAL || largest > CREEPING * step->before)) {
    PetscCall(PetscArraycpy(step->rhs, rve->residual, rve->length));
    LamContactAddForce(rve, step->rhs);
    LamStartMode(rve, step->solution);
    PetscCall(LamAddNegativeCurvature(rve, 12, step->rhs, step->solution, step->image));
  }
  step->before = largest;
  PetscFunctionReturn(0);
}

void LamContactTakeStep(LamRVE rve, const LamLoad *load, PetscReal alpha, const LamContactStep *step)
{
  LamContact *contact = rve->contact;

  LamTakeStep(rve, load, step->border, alpha);
  for (PetscInt h = 0; h < contact->count; ++h) contact->lambda[h] += alpha * (step->lambda[h] - contact->lambda[h]);
}
