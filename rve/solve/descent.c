/*
  Watchdog and line search of the safe tiers (newton.c, contact_safe.c).

  Method. Steps need not decrease the merit: a large step first violates stiff constraints, and the next ones restore
  them. After WATCHDOG steps without decrease the iteration returns to the best point and makes a line search.

  Reference. Chamberlain et al., Math. Prog. Study 16 (1982) 1.
*/
#include "solve.h"

#define WATCHDOG 4 /* steps without decrease before returning to the best point */
#define ARMIJO 1e-4
#define LEAST_STEP_LIMIT 1e-3 /* apothems */

PetscErrorCode LamDescentCreate(LamRVE rve, LamDescent *descent)
{
  PetscFunctionBeginUser;
  *descent = (LamDescent){.limit = LAM_DESCENT_LIMIT, .rounding = 1e-14 * rve->stiffest * rve->mesh.V0};
  PetscCall(PetscMalloc2(rve->length, &descent->y, rve->contact ? rve->contact->count : 0, &descent->lambda));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDescentDestroy(LamDescent *descent)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(descent->y, descent->lambda));
  PetscFunctionReturn(0);
}

static PetscReal Value(LamMerit merit, PetscReal mu)
{
  return merit.energy + mu * merit.violation;
}

LamMerit LamMeritOf(LamRVE rve, PetscReal energy)
{
  const LamContact *contact = rve->contact;
  LamMerit merit = {energy, 0.0};

  for (PetscInt h = 0; contact && h < contact->count; ++h)
    merit.violation += contact->weight[h] * PetscMax(0.0, -contact->gap[h]);
  return merit;
}

PetscErrorCode LamDescentSearch(LamRVE rve, const LamLoad *load, LamMerit now, LamDescent *descent, PetscReal *alpha)
{
  PetscReal slope = LamInnerProduct(rve->ndof - 2, rve->residual + 2, rve->step + 2);

  PetscFunctionBeginUser;
  if (!descent->monotone) PetscFunctionReturn(0);
  descent->monotone = PETSC_FALSE;
  slope = PetscMin(0.0, slope - descent->mu * now.violation);
  for (; *alpha > 1e-5; *alpha *= 0.5) {
    PetscReal energy;
    PetscBool valid;

    LamTrialPosition(rve, *alpha);
    PetscCall(LamAssembleEnergy(rve, load, rve->trial, &energy, &valid));
    if (!valid) continue;
    if (rve->contact) PetscCall(LamContactEvaluate(rve, load, rve->trial, PETSC_FALSE));
    if (Value(LamMeritOf(rve, energy), descent->mu) <=
        Value(now, descent->mu) + ARMIJO * *alpha * slope + descent->rounding)
      PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

void LamDescentKeep(LamRVE rve, LamMerit merit, LamDescent *descent)
{
  (void)PetscArraycpy(descent->y, rve->y, rve->length);
  if (rve->contact) (void)PetscArraycpy(descent->lambda, rve->contact->lambda, rve->contact->count);
  descent->merit = merit;
  descent->known = PETSC_TRUE;
  descent->without_decrease = 0;
}

PetscErrorCode LamDescentWatch(LamRVE rve, const LamLoad *load, LamMerit now, PetscBool valid, LamDescent *descent,
                               PetscBool *moved)
{
  const PetscReal value = Value(now, descent->mu), best = Value(descent->merit, descent->mu);

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  if (valid && (!descent->known || value < best)) {
    LamDescentKeep(rve, now, descent);
    descent->limit = PetscMin(LAM_DESCENT_LIMIT, 1.3 * descent->limit);
    PetscFunctionReturn(0);
  }
  if (valid && value <= best + descent->rounding) PetscFunctionReturn(0);
  if (valid && ++descent->without_decrease <= WATCHDOG) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(rve->y, descent->y, rve->length));
  if (rve->contact) {
    PetscCall(PetscArraycpy(rve->contact->lambda, descent->lambda, rve->contact->count));
    descent->known = PETSC_FALSE; /* its merit depends on the junction status */
  }
  (void)LamSetConsistentStresses(rve, load, rve->y);
  LamSealSetConsistent(rve, load, rve->y);
  descent->without_decrease = 0;
  descent->monotone = PETSC_TRUE;
  descent->limit = PetscMax(LEAST_STEP_LIMIT, 0.25 * descent->limit);
  *moved = PETSC_TRUE;
  PetscFunctionReturn(0);
}
