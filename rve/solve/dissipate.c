/*
  Equilibrium on a straight path of F, F = F_0 + s D, controlled by what the lamella dissipates.

  Method. Where F is prescribed, tissue that softens faster than what is around it unloads falls to another state. Here
  the share s of the path is an unknown, and an opening of the lamella is prescribed instead: c.y, with the weights

    c = dD/dy,       D: energy dissipated in the step,

  of the first guess, a step along b = -K^-1 dr/ds at fixed damage that dissipates the energy asked for. D only grows, so
  the path of states is followed through limits of F and snap-back.

  At fixed s and opening a state is a minimum of the energy, under a force -mu c on the lamella; s is sought for which
  mu = 0. With a = -K^-1 r and e = K^-1 c,

    dy = a - mu e,  mu = c.a / c.e        lowers the energy at fixed s, with c.dy = 0: shortened until it does,
    dy = a + ds b,  ds = -c.a / c.b       Newton's step of y and s, taken where the rest is small against mu c.

  K is convex on motions with c.dy = 0 if it has no negative eigenvalue and c.e > 0, or one and c.e < 0. Where it is not,
  or a step was short, the lamella's upper bound serves (cohesive.h). The state found is stable under the control if its
  K is so, with c of the state.

  Where less than the energy asked for is dissipated, s is prescribed: a step at most `most` farther.

  References. Gutierrez, Commun. Numer. Meth. Engng 20 (2004) 19; Verhoosel, Remmers & Gutierrez, Int. J. Numer. Meth.
  Engng 77 (2009) 1290.
*/
#include "contact_find.h"
#include "clock.h"

#define ITERATIONS 60
#define LIMIT 0.15      /* apothems: longest step */
#define EXCESS 1.5      /* of the energy asked for, up to which a step of prescribed s stands */
#define HALVINGS 6
#define BISECTIONS 12
#define ARMIJO 1e-4
#define LEAST_STEP 1e-4 /* least share of a step */
#define SHORT 0.3       /* share of a step after which the upper bound serves */
#define REST 0.3        /* of the residual, beside mu c, below which s is changed */
#define PROGRESS 0.5
#define IDLE 2          /* Newton's steps without progress after which s is kept again */

typedef struct {
  LamRVE rve;
  const LamDissipationPath *path;
  PetscReal along[9]; /* D */
  LamBorder *border;  /* its load and step are those of the iterate */
  PetscReal share;    /* of the iterate */
  PetscReal spent, slope; /* D and D_s there */
  PetscReal *gradient; /* [length] D_y */
  PetscReal *c;        /* [n]; zero where s is prescribed */
  PetscReal energy, rounding;
  PetscReal *R, *column; /* [LAM_F_COUNT][n], dr/ds [n] */
  PetscReal *rhs, *solution; /* [3][n]: of a, b and e */
  PetscReal ca, cb, ce;      /* products */
  PetscReal norm, rest;      /* of the residual, and without mu c */
} Tearing;

static PetscErrorCode Create(LamRVE rve, const LamDissipationPath *path, Tearing *t)
{
  static const LamStressControl none = {0};
  const PetscInt n = rve->linear->n;

  PetscFunctionBeginUser;
  *t = (Tearing){.rve = rve, .path = path};
  for (PetscInt i = 0; i < 9; ++i) t->along[i] = path->to.F[i] - path->from.F[i];
  PetscCall(LamBorderCreate(rve, &path->to, &none, &t->border));
  PetscCall(PetscMalloc5(rve->length, &t->gradient, LAM_F_COUNT * n, &t->R, n, &t->column, 3 * n, &t->rhs, 3 * n,
                         &t->solution));
  PetscCall(PetscCalloc1(n, &t->c));
  t->rounding = 1e-14 * rve->stiffest * rve->mesh.V0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Tearing *t)
{
  PetscFunctionBeginUser;
  t->rve->layer->secant = PETSC_FALSE;
  PetscCall(LamBorderDestroy(&t->border));
  PetscCall(PetscFree(t->c));
  PetscCall(PetscFree5(t->gradient, t->R, t->column, t->rhs, t->solution));
  PetscFunctionReturn(0);
}

static LamLoad LoadAt(const Tearing *t, PetscReal share)
{
  LamLoad load = t->path->to;

  for (PetscInt i = 0; i < 9; ++i) load.F[i] = t->path->from.F[i] + share * t->along[i];
  return load;
}

/* Begins at a state. */
static void Begin(Tearing *t, LamRVEState at, PetscReal share)
{
  const LamRVE rve = t->rve;

  t->share = share;
  t->border->load = LoadAt(t, share);
  (void)PetscArraycpy(rve->y, at->y, rve->length);
  (void)LamSetConsistentStresses(rve, &t->border->load, rve->y);
}

/* Residual, matrix, D and derivatives at the iterate. */
static PetscErrorCode Assemble(Tearing *t, PetscBool *valid)
{
  const LamRVE rve = t->rve;
  PetscReal Lq[LAM_F_COUNT], Lqq[LAM_F_COUNT][LAM_F_COUNT];

  PetscFunctionBeginUser;
  PetscCall(LamAssemble(rve, &t->border->load, rve->y, &t->energy, rve->residual, valid));
  if (!*valid) PetscFunctionReturn(0);
  t->norm = LamResidualNorm(rve, rve->residual);
  t->spent = LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &t->slope);
  PetscCall(LamAssembleGradient(rve, &t->border->load, Lq, Lqq, t->R));
  for (PetscInt i = 0; i < rve->linear->n; ++i) {
    t->column[i] = 0.0;
    for (PetscInt q = 0; q < LAM_F_COUNT; ++q) t->column[i] += t->R[q * rve->linear->n + i] * t->along[LamFComponent[q]];
  }
  PetscFunctionReturn(0);
}

/* a, b and e, with the matrix of the iterate; *convex: on motions with c.dy = 0. */
static PetscErrorCode Solve(Tearing *t, PetscBool *convex, PetscBool *ok)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;
  PetscReal mu, sum = 0.0;
  PetscInt negative;

  PetscFunctionBeginUser;
  PetscCall(LamRVEFactor(rve, LAM_PROXIMAL, &negative, ok));
  if (!*ok) PetscFunctionReturn(0);
  negative -= LamExpectedNegative(rve);
  for (PetscInt i = 0; i < n; ++i) {
    t->rhs[i] = -rve->residual[i + 2];
    t->rhs[n + i] = -t->column[i];
    t->rhs[2 * n + i] = t->c[i];
  }
  PetscCall(LamLinearSolve(rve->linear, 3, t->rhs, t->solution));
  t->ca = LamInnerProduct(n, t->c, t->solution);
  t->cb = LamInnerProduct(n, t->c, t->solution + n);
  t->ce = LamInnerProduct(n, t->c, t->solution + 2 * n);
  *convex = (PetscBool)((negative == 0 && t->ce >= 0.0) || (negative == 1 && t->ce < 0.0));
  mu = t->ce == 0.0 ? 0.0 : t->ca / t->ce;
  for (PetscInt i = 0; i < n; ++i) sum += PetscSqr(rve->residual[i + 2] + mu * t->c[i]);
  t->rest = PetscSqrtReal(sum);
  PetscFunctionReturn(0);
}

/* Sets the step to with a + ds b - mu e, and its length. */
static void SetStep(Tearing *t, PetscReal with, PetscReal ds, PetscReal mu, PetscReal *largest)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;

  rve->step[0] = rve->step[1] = 0.0;
  for (PetscInt i = 0; i < n; ++i)
    rve->step[i + 2] = with * t->solution[i] + ds * t->solution[n + i] - mu * t->solution[2 * n + i];
  for (PetscInt i = 0; i < 9; ++i) t->border->dF[i] = ds * t->along[i];
  *largest = LamBorderReach(rve, t->border, rve->step + 2);
}

static void Take(Tearing *t, PetscReal ds, PetscReal alpha)
{
  LamTakeStep(t->rve, &t->border->load, t->border, alpha);
  t->share += alpha * ds;
  t->border->load = LoadAt(t, t->share);
}

/* D at a step of `ds` along b, whose gradient becomes that of D there. */
static PetscReal SpentAt(Tearing *t, PetscReal ds)
{
  const LamLoad load = LoadAt(t, t->share + ds);
  PetscReal slope, largest;

  SetStep(t, 0.0, ds, 0.0, &largest);
  LamTrialPosition(t->rve, 1.0);
  return LamLayerSpent(t->rve, &load, t->rve->trial, t->along, t->gradient, &slope);
}

/* The first guess of a step that dissipates tau, with its c; where a step of `most` dissipates less, that is prescribed:
   *is_held. */
static PetscErrorCode Guess(Tearing *t, PetscReal tau, PetscReal most, PetscBool spends, PetscBool *is_held,
                            PetscBool *ok)
{
  const PetscInt n = t->rve->linear->n;
  PetscReal low = 0.0, high = most, largest, alpha, sum;
  PetscBool valid, convex;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(t->c, n));
  PetscCall(Assemble(t, &valid));
  *ok = valid;
  if (valid) PetscCall(Solve(t, &convex, ok));
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < BISECTIONS && spends && SpentAt(t, high) <= tau; ++k) high *= 2.0;
  *is_held = (PetscBool)(SpentAt(t, high) <= tau);
  for (PetscInt k = 0; k < BISECTIONS && !*is_held; ++k) {
    const PetscReal middle = 0.5 * (low + high);

    *(SpentAt(t, middle) > tau ? &high : &low) = middle;
  }
  (void)SpentAt(t, high);
  sum = PetscSqrtReal(LamInnerProduct(n, t->gradient + 2, t->gradient + 2));
  for (PetscInt i = 0; i < n && !*is_held; ++i) t->c[i] = t->gradient[i + 2] / sum;
  SetStep(t, 0.0, high, 0.0, &largest);
  alpha = LamValidStep(t->rve, &t->border->load, t->border, PetscMin(1.0, LIMIT / largest), LAM_LEAST_STEP);
  *ok = (PetscBool)(alpha > 0.0);
  if (*ok) Take(t, high, alpha);
  PetscFunctionReturn(0);
}

/* Takes the part of a step at fixed s that lowers the energy. *alpha: that part. */
static PetscErrorCode Descend(Tearing *t, PetscReal largest, PetscReal *alpha)
{
  const LamRVE rve = t->rve;
  const PetscReal slope = PetscMin(0.0, LamInnerProduct(rve->linear->n, rve->residual + 2, rve->step + 2));

  PetscFunctionBeginUser;
  for (*alpha = PetscMin(1.0, LIMIT / largest); *alpha > LEAST_STEP; *alpha *= 0.5) {
    PetscReal energy;
    PetscBool valid;

    LamTrialPosition(rve, *alpha);
    PetscCall(LamAssembleEnergy(rve, &t->border->load, rve->trial, &energy, &valid));
    if (valid && energy <= t->energy + ARMIJO * *alpha * slope + t->rounding) break;
  }
  if (*alpha > LEAST_STEP)
    Take(t, 0.0, *alpha);
  else
    *alpha = 0.0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(const Tearing *t, const char tier[], PetscInt it, PetscReal largest, PetscReal tau)
{
  PetscFunctionBeginUser;
  if (t->rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "  %-5s %3d  residual %10.3e  rest %10.3e  largest step %9.3e  share %.8g  spent %.4g of it%s\n",
                           tier, (int)it, (double)t->norm, (double)t->rest, (double)largest, (double)t->share,
                           (double)(t->spent / tau), t->rve->layer->secant ? "  bound" : ""));
  PetscFunctionReturn(0);
}

/* From the first guess to a state. is_held: s is prescribed, and the energy dissipated may reach `tau` times EXCESS. */
static PetscErrorCode Iterate(Tearing *t, PetscReal tau, PetscBool is_held, PetscBool *converged)
{
  const LamRVE rve = t->rve;
  const PetscReal tolerance = LamNewtonTolerance(rve);
  PetscReal least = PETSC_INFINITY;
  PetscBool free = PETSC_FALSE; /* Newton's steps of y and s */
  PetscInt idle = 0;

  PetscFunctionBeginUser;
  *converged = PETSC_FALSE;
  rve->layer->secant = PETSC_FALSE;
  for (PetscInt it = 0; it < ITERATIONS && LamMayIterate(rve); ++it) {
    const PetscReal previous = t->norm;
    PetscReal ds, mu, largest, alpha = 1.0;
    PetscBool valid, convex, ok;

    PetscCall(Assemble(t, &valid));
    if (!valid) break;
    *converged = (PetscBool)(t->norm <= tolerance && (it > 0 || !is_held));
    if (*converged || (is_held && t->spent > 2.0 * EXCESS * tau)) break;
    PetscCall(Solve(t, &convex, &ok));
    if (!ok || (!convex && rve->layer->secant)) break;
    if (!convex) {
      rve->layer->secant = PETSC_TRUE;
      continue;
    }
    idle = free && t->norm > PROGRESS * previous ? idle + 1 : 0;
    least = PetscMin(least, t->norm);
    if (idle > IDLE || t->norm > 1e3 * least) free = PETSC_FALSE;
    if (idle == 0 && !is_held && t->rest < REST * t->norm) free = PETSC_TRUE;
    ds = free ? -t->ca / t->cb : 0.0;
    mu = free || is_held ? 0.0 : t->ca / t->ce;
    if (!isfinite(ds)) break;
    SetStep(t, 1.0, ds, mu, &largest);
    PetscCall(Report(t, free ? "free" : is_held ? "load" : "spend", it, largest, tau));
    if (it > 0 && (free || is_held) && LamAtRounding(rve, t->norm, tolerance, largest)) {
      *converged = PETSC_TRUE;
      break;
    }
    if (free) {
      alpha = LamValidStep(rve, &t->border->load, t->border, PetscMin(1.0, LIMIT / largest), LAM_LEAST_STEP);
      if (alpha > 0.0) Take(t, ds, alpha);
    } else {
      PetscCall(Descend(t, largest, &alpha));
    }
    if (alpha == 0.0) break;
    rve->layer->secant = (PetscBool)(!rve->layer->secant && alpha < SHORT);
  }
  rve->layer->secant = PETSC_FALSE;
  if (is_held && t->spent > EXCESS * tau) *converged = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether the state found is stable under its control; its consistent tangent is then factored. */
static PetscErrorCode CheckStability(Tearing *t, PetscBool is_held, PetscBool *stable, PetscInt *negative)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;
  PetscReal slope;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, &t->border->load, negative, stable));
  if (!*stable) PetscFunctionReturn(0);
  *stable = (PetscBool)(*negative == 0);
  if (is_held || *stable || *negative > 1) PetscFunctionReturn(0);
  (void)LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &slope);
  PetscCall(PetscArraycpy(t->rhs, t->gradient + 2, n));
  PetscCall(LamLinearSolve(rve->linear, 1, t->rhs, t->solution));
  *stable = (PetscBool)(LamInnerProduct(n, t->rhs, t->solution) < 0.0);
  PetscFunctionReturn(0);
}

/* One step from a state; *found: a stable state is in rve->y. */
static PetscErrorCode Step(Tearing *t, LamRVEState at, PetscReal share, PetscReal tau, PetscReal most, PetscBool *found,
                           PetscInt *negative)
{
  PetscBool is_held;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscBool spends = (PetscBool)(k > 0);

    Begin(t, at, share);
    PetscCall(Guess(t, tau, most, spends, &is_held, found));
    if (*found) PetscCall(Iterate(t, tau, is_held, found));
    if (*found) PetscCall(CheckStability(t, is_held, found, negative));
    if (*found || !is_held || t->rve->work.stopped) break;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Find(Tearing *t, LamRVEState at, PetscReal *share, LamResponse *response)
{
  const LamRVE rve = t->rve;
  const PetscReal face = rve->micro.lamella.energy * LamFaceLength(&rve->mesh);
  PetscReal tau = t->path->faces * face, most = PetscMin(t->path->most, 1.0 - *share);
  PetscBool found = PETSC_FALSE;
  PetscInt negative = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k <= HALVINGS && !found && !rve->work.stopped; ++k) {
    PetscCall(Step(t, at, *share, tau, most, &found, &negative));
    tau *= 0.5;
    most *= 0.5;
  }
  if (found) {
    *share = t->share;
    response->load = t->border->load;
    response->status = LAM_CONVERGED;
    response->negative_eigenvalues = negative;
    PetscFunctionReturn(0);
  }
  PetscCall(LamRefuse(response, LAM_NOT_CONVERGED,
                      "no state found that dissipates down to %.3g of a face, after %d iterations: try other `faces`",
                      (double)(2.0 * tau / face), (int)rve->work.iterations));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESolveDissipating(LamRVE rve, const LamDissipationPath *path, PetscReal *share, LamRVEState state,
                                      LamResponse *response)
{
  const PetscReal begin = LamClock(), asked = rve->micro.contact_width;
  LamRVEState before;
  Tearing t;

  PetscFunctionBeginUser;
  PetscCheck(rve->layer, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "only tissue with a lamella dissipates");
  PetscCheck(path->most > 0.0 && path->most <= 1.0 && path->faces > 0.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a step of %g of the path and %g faces; both must be positive, the first at most 1", (double)path->most,
             (double)path->faces);
  PetscCheck(state->solved, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "the state is no solution");
  PetscCall(LamRVEStateCreate(rve, &before));
  PetscCall(LamRVEStateCopy(state, before));
  PetscCall(LamBeginResponse(rve, &path->to, state, response));
  PetscCall(LamUseSmoothLaw(rve, asked > 0.0 ? asked : LAM_USUAL_WIDTH));
  PetscCall(Create(rve, path, &t));
  PetscCall(Find(&t, before, share, response));
  PetscCall(LamEndResponse(rve, &t.border->load, state, response));
  if (response->status == LAM_CONVERGED) response->work = state->work = before->work + LamStepWorkOf(before, state).work;
  PetscCall(Destroy(&t));
  PetscCall(LamRVEStateDestroy(&before));
  response->seconds = LamClock() - begin;
  PetscFunctionReturn(0);
}
