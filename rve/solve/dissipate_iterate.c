#include "dissipate.h"

#define LIMIT 0.15 /* apothems: longest step */
#define BISECTIONS 12
#define ARMIJO 1e-4
#define CORRECTIONS 2
#define WORTH_CORRECTING 0.2 /* least share of a step that is corrected */
#define LEAST_STEP 1e-4      /* least share of a step */
#define SHORT 0.3            /* share of a step after which the upper bound serves */
#define REST 0.3             /* of the residual, beside mu c, below which s is changed */
#define PROGRESS 0.5
#define STAGES 5     /* ... and steps from there to tau, ... */
#define SHORTER 0.05 /* ... of at most this length */
#define IDLE 1       /* Newton's steps without progress after which s is kept again */

static PetscErrorCode Report(const LamDissipation *t, const char tier[], PetscInt it, PetscReal largest, PetscReal tau)
{
  PetscFunctionBeginUser;
  if (t->rve->monitor)
    PetscCall(
        PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                     "  %-5s %3d  residual %10.3e  rest %10.3e  largest step %9.3e  share %.8g  spent %.4g of it%s\n",
                     tier, (int)it, (double)t->norm, (double)t->rest, (double)largest, (double)t->share,
                     (double)(t->spent / tau), t->rve->layer->secant ? "  bound" : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDissipationGuess(LamDissipation *t, PetscReal tau, PetscReal most, PetscBool is_held, PetscBool *ok)
{
  PetscReal low = 0.0, high = most, largest, alpha;
  PetscBool valid, convex;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(t->c, t->rve->linear->n));
  PetscCall(LamDissipationAssemble(t, &valid));
  *ok = valid;
  if (valid) PetscCall(LamDissipationSolve(t, &convex, ok));
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < BISECTIONS && !is_held && LamDissipationSpentAt(t, high) <= tau; ++k) high *= 2.0;
  for (PetscInt k = 0; k < BISECTIONS && LamDissipationSpentAt(t, high) > tau; ++k) {
    const PetscReal middle = 0.5 * (low + high);

    *(LamDissipationSpentAt(t, middle) > tau ? &high : &low) = middle;
  }
  (void)LamDissipationSpentAt(t, high); /* also for the window */
  if (!is_held) LamDissipationSetOpening(t);
  LamDissipationSetStep(t, 0.0, high, 0.0, &largest);
  alpha = LamValidStep(t->rve, &t->border->load, t->border, PetscMin(1.0, LIMIT / largest), LAM_LEAST_STEP);
  *ok = (PetscBool)(alpha > 0.0);
  if (*ok) LamDissipationTake(t, high, alpha);
  PetscFunctionReturn(0);
}

/* Takes a step of `alpha` that did not lower the energy, because it violates the stiff constraints of the walls, and
   corrects it with the same factor. *moved: the energy is then at most `most`. */
static PetscErrorCode Correct(LamDissipation *t, PetscReal alpha, PetscReal most, PetscBool *moved)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n, couplings = rve->smooth->count;

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  PetscCall(PetscArraycpy(t->y, rve->y, rve->length));
  PetscCall(PetscArraycpy(t->step, rve->step, rve->length));
  PetscCall(PetscArraycpy(t->stress, rve->stress, rve->mesh.element_count));
  LamDissipationTake(t, 0.0, alpha);
  for (PetscInt k = 0; k < CORRECTIONS && !*moved; ++k) {
    PetscReal energy, largest;
    PetscBool valid;

    PetscCall(LamAssemble(rve, &t->border->load, rve->y, &energy, rve->residual, &valid));
    if (!valid || rve->smooth->count != couplings) break; /* the matrix has grown: there is no factor */
    PetscCall(LamDissipationSolveAgain(t));
    LamDissipationSetStep(t, 1.0, 0.0, t->ce == 0.0 ? 0.0 : LamInnerProduct(n, t->c, t->solution) / t->ce, &largest);
    if (largest > LIMIT || LamValidStep(rve, &t->border->load, t->border, 1.0, 0.5) == 0.0) break;
    LamDissipationTake(t, 0.0, 1.0);
    PetscCall(LamAssembleEnergy(rve, &t->border->load, rve->y, &energy, &valid));
    *moved = (PetscBool)(valid && energy <= most);
  }
  if (*moved) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(rve->y, t->y, rve->length));
  PetscCall(PetscArraycpy(rve->step, t->step, rve->length));
  PetscCall(PetscArraycpy(rve->stress, t->stress, rve->mesh.element_count));
  PetscFunctionReturn(0);
}

/* Takes the part of a step at fixed s that lowers the energy. *alpha: that part. */
static PetscErrorCode Descend(LamDissipation *t, PetscReal largest, PetscReal *alpha)
{
  const LamRVE rve = t->rve;
  const PetscReal slope = PetscMin(0.0, LamInnerProduct(rve->linear->n, rve->residual + 2, rve->step + 2));
  PetscBool corrected = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*alpha = PetscMin(1.0, LIMIT / largest); *alpha > LEAST_STEP; *alpha *= 0.5) {
    const PetscReal most = t->energy + ARMIJO * *alpha * slope + t->rounding;
    PetscReal energy;
    PetscBool valid, lower;

    LamTrialPosition(rve, *alpha);
    PetscCall(LamAssembleEnergy(rve, &t->border->load, rve->trial, &energy, &valid));
    lower = (PetscBool)(valid && energy <= most);
    if (lower) LamDissipationTake(t, 0.0, *alpha);
    if (valid && !lower && !corrected && *alpha >= WORTH_CORRECTING) {
      corrected = PETSC_TRUE;
      PetscCall(Correct(t, *alpha, most, &lower));
    }
    if (lower) PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDissipationIterate(LamDissipation *t, PetscReal tau, PetscReal tolerance, PetscBool is_held,
                                     PetscInt most, PetscBool *converged)
{
  const LamRVE rve = t->rve;
  PetscReal least = PETSC_INFINITY;
  PetscInt idle = 0;

  PetscFunctionBeginUser;
  *converged = PETSC_FALSE;
  t->stuck = PETSC_TRUE;
  rve->layer->secant = PETSC_FALSE;
  for (PetscInt it = 0; it < LAM_DISSIPATION_ITERATIONS && LamMayIterate(rve); ++it) {
    const PetscReal previous = t->norm;
    PetscReal ds, mu, largest, alpha = 1.0;
    PetscBool valid, convex, ok;

    PetscCall(LamDissipationAssemble(t, &valid));
    if (!valid) break;
    *converged = (PetscBool)(t->norm <= tolerance);
    if (*converged || (is_held && t->spent > LAM_DISSIPATION_EXCESS * tau)) break;
    if (it >= most) t->stuck = PETSC_FALSE;
    if (it >= most) break;
    PetscCall(LamDissipationSolve(t, &convex, &ok));
    if (!ok || (!convex && rve->layer->secant)) break;
    if (!convex && is_held && t->norm < LAM_DISSIPATION_FINE) break; /* behind a limit of F */
    if (!convex) {
      rve->layer->secant = PETSC_TRUE;
      --it; /* no step has been taken */
      continue;
    }
    idle = t->free && t->norm > PROGRESS * previous ? idle + 1 : 0;
    least = PetscMin(least, t->norm);
    if (idle > IDLE || t->norm > 1e3 * least) t->free = PETSC_FALSE;
    if (idle == 0 && !is_held && t->rest < REST * t->norm) t->free = PETSC_TRUE;
    ds = t->free ? -t->ca / t->cb : 0.0;
    mu = t->free || is_held ? 0.0 : t->ca / t->ce;
    if (!isfinite(ds)) break;
    LamDissipationSetStep(t, 1.0, ds, mu, &largest);
    PetscCall(Report(t, t->window ? "part" : t->free ? "free" : is_held ? "load" : "spend", it, largest, tau));
    if (it > 0 && (t->free || is_held) && LamAtRounding(rve, t->norm, tolerance, largest)) {
      *converged = PETSC_TRUE;
      break;
    }
    if (t->free) {
      alpha = LamValidStep(rve, &t->border->load, t->border, PetscMin(1.0, SHORTER / largest), LAM_LEAST_STEP);
      if (alpha > 0.0) LamDissipationTake(t, ds, alpha);
    } else {
      PetscCall(Descend(t, largest, &alpha));
    }
    if (alpha == 0.0) break;
    rve->layer->secant = (PetscBool)(!rve->layer->secant && alpha < SHORT);
  }
  rve->layer->secant = PETSC_FALSE;
  if (is_held && t->spent > LAM_DISSIPATION_EXCESS * tau) *converged = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDissipationAdvance(LamDissipation *t, PetscReal tau)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;
  PetscBool valid = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt k = 1; k <= STAGES && valid && LamMayIterate(rve); ++k) {
    const PetscReal target = tau * (LAM_DISSIPATION_FIRST + (1.0 - LAM_DISSIPATION_FIRST) * (PetscReal)k / STAGES);
    PetscReal ds, largest, alpha;
    PetscBool convex, ok;

    PetscCall(LamDissipationAssemble(t, &valid));
    if (!valid) break;
    LamDissipationSetOpening(t);
    PetscCall(LamDissipationSolve(t, &convex, &ok));
    if (!ok) break;
    ds = (target - t->spent - LamInnerProduct(n, t->gradient + 2, t->solution)) /
         (t->slope + LamInnerProduct(n, t->gradient + 2, t->solution + n));
    if (!isfinite(ds)) break;
    LamDissipationSetStep(t, 1.0, ds, 0.0, &largest);
    PetscCall(Report(t, "next", k, largest, tau));
    alpha = LamValidStep(rve, &t->border->load, t->border, PetscMin(1.0, SHORTER / largest), LAM_LEAST_STEP);
    if (alpha == 0.0) break;
    LamDissipationTake(t, ds, alpha);
  }
  if (valid) PetscCall(LamDissipationAssemble(t, &valid));
  if (valid) LamDissipationSetOpening(t);
  PetscFunctionReturn(0);
}
