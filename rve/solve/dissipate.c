/*
  Equilibrium on a straight path of F, F = F_0 + s D, controlled by what the lamella dissipates.

  Method. Where F is prescribed, tissue that softens faster than what is around it unloads falls to another state. Here
  the share s of the path is an unknown, and an opening of the lamella is prescribed instead: c.y, with the weights

    c = dD/dy,       D: energy dissipated in the step,

  of the first guess, a step along b = -K^-1 dr/ds at fixed damage that dissipates the energy asked for. D only grows,
  so the path of states is followed through limits of F and snap-back.

  At fixed s and opening a state is a minimum of the energy, under a force -mu c on the lamella; s is sought for which
  mu = 0. With a = -K^-1 r and e = K^-1 c,

    dy = a - mu e,  mu = c.a / c.e        lowers the energy at fixed s, with c.dy = 0: shortened until it does,
    dy = a + ds b,  ds = -c.a / c.b       Newton's step of y and s, taken where the rest is small against mu c.

  K is convex on motions with c.dy = 0 if it has no negative eigenvalue and c.e > 0, or one and c.e < 0. Where it is
  not, or a step was short, the lamella's upper bound serves (cohesive.h). The state found is stable under the control
  if its K is so, with c of the state.

  Where less than the energy asked for is dissipated, s is prescribed: a step at most `most` farther.

  References. Gutierrez, Commun. Numer. Meth. Engng 20 (2004) 19; Verhoosel, Remmers & Gutierrez, Int. J. Numer. Meth.
  Engng 77 (2009) 1290.
*/
#include "contact_find.h"
#include "clock.h"
#include "part.h"

#define ITERATIONS 60
#define LIMIT 0.15 /* apothems: longest step */
#define EXCESS 1.5 /* of the energy asked for, up to which a step of prescribed s stands */
#define HALVINGS 6
#define BISECTIONS 12
#define ARMIJO 1e-4
#define GROWTH 6.0 /* of shifts, as in minimise.c */
#define DECAY 5.0
#define LEAST_SHIFT 1e-7
#define CORRECTIONS 2
#define WORTH_CORRECTING 0.2 /* least share of a step that is corrected */
#define LEAST_STEP 1e-4      /* least share of a step */
#define SHORT 0.3            /* share of a step after which the upper bound serves */
#define REST 0.3             /* of the residual, beside mu c, below which s is changed */
#define PROGRESS 0.5
#define HALF 0.5     /* share of tau that the first guess of a prescribed s dissipates: in the end it is more */
#define FIRST 0.1    /* share of tau that the first guess dissipates, ... */
#define STAGES 5     /* ... and steps from there to tau, ... */
#define SHORTER 0.05 /* ... of at most this length */
#define WORTH 0.1    /* energy dissipated at a cell, of the largest, that makes it one that breaks */
#define LAYERS 2     /* of cells around these that move in the window */
#define WINDOW 2     /* least ratio of all cells to those */
#define PART_TOLERANCE 1e-5
#define PART_ITERATIONS 30
#define ROUNDS 12 /* of the window, and then all unknowns once, ... */
#define SOME 8    /* iterations, where the window would be too large, */
#define FINE 1e-2 /* ... until this residual */
#define IDLE 1    /* Newton's steps without progress after which s is kept again */

typedef struct {
  LamRVE rve;
  const LamDissipationPath *path;
  PetscReal along[9];     /* D */
  LamBorder *border;      /* its load and step are those of the iterate */
  PetscReal face;         /* energy of fracture of a face */
  PetscReal share;        /* of the iterate */
  PetscReal spent, slope; /* D and D_s there */
  PetscReal *gradient;    /* [length] D_y */
  PetscReal *c;           /* [n]; zero where s is prescribed */
  PetscReal energy, rounding;
  PetscReal *R, *column;     /* [LAM_F_COUNT][n], dr/ds [n] */
  PetscReal *rhs, *solution; /* [3][n]: of a, b and e */
  PetscReal shift;           /* of the matrix, where walls are not convex either */
  PetscReal ca, cb, ce;      /* products */
  LamPartSystem window;      /* NULL: all unknowns move */
  PetscReal *far;            /* [n] of the window: b outside it */
  PetscReal *by_cell;        /* [cell] D at the faces of a cell */
  PetscReal *y, *step;       /* [length] before a correction */
  LamElementStress *stress;  /* [element] likewise */
  PetscReal norm, rest;      /* of the residual, and without mu c */
  PetscBool free;            /* Newton's steps of y and s are taken */
  PetscBool stuck;           /* no step was found */
} Tearing;

static PetscErrorCode Create(LamRVE rve, const LamDissipationPath *path, Tearing *t)
{
  static const LamStressControl none = {0};
  const PetscInt n = rve->linear->n;

  PetscFunctionBeginUser;
  *t = (Tearing){.rve = rve, .path = path};
  t->face = rve->micro.lamella.energy * LamFaceLength(&rve->mesh);
  for (PetscInt i = 0; i < 9; ++i) t->along[i] = path->to.F[i] - path->from.F[i];
  PetscCall(LamBorderCreate(rve, &path->to, &none, &t->border));
  PetscCall(PetscMalloc5(rve->length, &t->gradient, LAM_F_COUNT * n, &t->R, n, &t->column, 3 * n + 6, &t->rhs, 3 * n,
                         &t->solution));
  PetscCall(PetscCalloc1(n, &t->c));
  PetscCall(PetscMalloc3(rve->length, &t->y, rve->length, &t->step, rve->mesh.element_count, &t->stress));
  PetscCall(PetscMalloc1(rve->mesh.cell_count, &t->by_cell));
  t->rounding = 1e-14 * rve->stiffest * rve->mesh.V0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Tearing *t)
{
  PetscFunctionBeginUser;
  t->rve->layer->secant = PETSC_FALSE;
  PetscCall(LamBorderDestroy(&t->border));
  PetscCall(PetscFree(t->c));
  PetscCall(PetscFree3(t->y, t->step, t->stress));
  PetscCall(PetscFree(t->by_cell));
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

/* Norm of r + mu c, of what moves. */
static PetscReal NormOf(const Tearing *t, PetscReal mu)
{
  const LamRVE rve = t->rve;
  const PetscInt *unknown = NULL;
  const PetscInt n = t->window ? LamPartSystemUnknowns(t->window, &unknown) : rve->linear->n;
  PetscReal sum = t->window ? 0.0 : LamSealError(rve, rve->residual);

  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt i = unknown ? unknown[k] : k;

    if (i < rve->linear->positions) sum += PetscSqr(rve->residual[i + 2] + mu * t->c[i]);
  }
  return PetscSqrtReal(sum);
}

/* Residual, matrix, D and derivatives at the iterate. */
static PetscErrorCode Assemble(Tearing *t, PetscBool *valid)
{
  const LamRVE rve = t->rve;
  PetscReal Lq[LAM_F_COUNT], Lqq[LAM_F_COUNT][LAM_F_COUNT];

  PetscFunctionBeginUser;
  PetscCall(LamAssemble(rve, &t->border->load, rve->y, &t->energy, rve->residual, valid));
  if (!*valid) PetscFunctionReturn(0);
  t->norm = NormOf(t, 0.0);
  t->spent = LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &t->slope, t->by_cell);
  if (t->window) PetscFunctionReturn(0); /* the column does not change there */
  PetscCall(LamAssembleGradient(rve, &t->border->load, Lq, Lqq, t->R));
  for (PetscInt i = 0; i < rve->linear->n; ++i) {
    t->column[i] = 0.0;
    for (PetscInt q = 0; q < LAM_F_COUNT; ++q)
      t->column[i] += t->R[q * rve->linear->n + i] * t->along[LamFComponent[q]];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAll(Tearing *t, PetscInt *negative, PetscBool *ok)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;

  PetscFunctionBeginUser;
  PetscCall(LamRVEFactor(rve, LAM_PROXIMAL + t->shift, negative, ok));
  if (!*ok) PetscFunctionReturn(0);
  *negative -= LamExpectedNegative(rve);
  for (PetscInt i = 0; i < n; ++i) {
    t->rhs[i] = -rve->residual[i + 2];
    t->rhs[n + i] = -t->column[i];
    t->rhs[2 * n + i] = t->c[i];
  }
  PetscCall(LamLinearSolve(rve->linear, 3, t->rhs, t->solution));
  PetscFunctionReturn(0);
}

/* Outside the window a and e are 0, and b is `far`. */
static PetscErrorCode SolveWindow(Tearing *t, PetscInt *negative, PetscBool *ok)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n, *unknown, count = LamPartSystemUnknowns(t->window, &unknown);
  PetscReal *rhs = t->rhs, *solution = t->rhs + 3 * count; /* the window has less than half of the cells */

  PetscFunctionBeginUser;
  PetscCall(LamPartSystemFactor(rve, t->window, LAM_PROXIMAL + t->shift, negative, ok));
  if (!*ok) PetscFunctionReturn(0);
  LamPartSystemMultiply(rve, t->window, t->far, rhs + count);
  for (PetscInt k = 0; k < count; ++k) {
    rhs[k] = -rve->residual[unknown[k] + 2];
    rhs[count + k] = -rhs[count + k] - t->column[unknown[k]];
    rhs[2 * count + k] = t->c[unknown[k]];
  }
  PetscCall(LamPartSystemSolve(t->window, 3, rhs, solution));
  for (PetscInt q = 0; q < 3; ++q)
    for (PetscInt k = 0; k < count; ++k) t->solution[q * n + unknown[k]] = solution[q * count + k];
  PetscFunctionReturn(0);
}

/* a, b and e, with the matrix of the iterate; *convex: on motions with c.dy = 0, also with a shift
   if the tangent is the upper bound. */
static PetscErrorCode Solve(Tearing *t, PetscBool *convex, PetscBool *ok)
{
  const PetscReal diagonal = LamLargestDiagonal(t->rve->linear);
  const PetscReal least = PetscMin(LEAST_SHIFT * diagonal, LamBendingStiffness(t->rve));
  const PetscInt n = t->rve->linear->n;
  PetscInt negative;

  PetscFunctionBeginUser;
  t->shift = t->shift / DECAY < least ? 0.0 : t->shift / DECAY;
  for (;;) {
    PetscCall(t->window ? SolveWindow(t, &negative, ok) : SolveAll(t, &negative, ok));
    if (!*ok) PetscFunctionReturn(0);
    t->ca = LamInnerProduct(n, t->c, t->solution);
    t->cb = LamInnerProduct(n, t->c, t->solution + n);
    t->ce = LamInnerProduct(n, t->c, t->solution + 2 * n);
    *convex = (PetscBool)((negative == 0 && t->ce >= 0.0) || (negative == 1 && t->ce < 0.0));
    if (*convex || !t->rve->layer->secant || t->shift > diagonal) break;
    t->shift = t->shift > 0.0 ? GROWTH * t->shift : least;
  }
  t->rest = NormOf(t, t->ce == 0.0 ? 0.0 : t->ca / t->ce);
  PetscFunctionReturn(0);
}

/* Length of a step: how far nodes move in their cells. Cells of a large patch go farther. */
static PetscReal Reach(const Tearing *t)
{
  const LamMesh *mesh = &t->rve->mesh;
  const PetscInt nodes = mesh->node_count / mesh->cell_count;
  PetscReal largest = LamLargestEntry(9, t->border->dF);

  for (PetscInt c = 0; c < mesh->cell_count; ++c)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal *dF = &t->border->dF[3 * d];
      PetscReal low = PETSC_INFINITY, high = -PETSC_INFINITY;

      for (PetscInt node = c * nodes; node < (c + 1) * nodes; ++node) {
        const PetscReal *S = &mesh->shift[2 * node];
        const PetscReal moved = t->rve->step[2 * mesh->node_class[node] + d] + dF[0] * S[0] + dF[1] * S[1];

        low = PetscMin(low, moved);
        high = PetscMax(high, moved);
      }
      largest = PetscMax(largest, 0.5 * (high - low));
    }
  return largest;
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
  *largest = Reach(t);
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
  return LamLayerSpent(t->rve, &load, t->rve->trial, t->along, t->gradient, &slope, t->by_cell);
}

static PetscErrorCode Report(const Tearing *t, const char tier[], PetscInt it, PetscReal largest, PetscReal tau)
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

/* c, from the gradient of D. */
static void SetOpening(Tearing *t)
{
  const PetscInt n = t->rve->linear->n;
  const PetscReal norm = PetscSqrtReal(LamInnerProduct(n, t->gradient + 2, t->gradient + 2));

  for (PetscInt i = 0; i < n; ++i) t->c[i] = t->gradient[i + 2] / norm;
}

/* The first guess, along b at fixed damage, where it dissipates tau. With s prescribed it is at most `most` far. */
static PetscErrorCode Guess(Tearing *t, PetscReal tau, PetscReal most, PetscBool is_held, PetscBool *ok)
{
  PetscReal low = 0.0, high = most, largest, alpha;
  PetscBool valid, convex;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(t->c, t->rve->linear->n));
  PetscCall(Assemble(t, &valid));
  *ok = valid;
  if (valid) PetscCall(Solve(t, &convex, ok));
  if (!*ok) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < BISECTIONS && !is_held && SpentAt(t, high) <= tau; ++k) high *= 2.0;
  for (PetscInt k = 0; k < BISECTIONS && SpentAt(t, high) > tau; ++k) {
    const PetscReal middle = 0.5 * (low + high);

    *(SpentAt(t, middle) > tau ? &high : &low) = middle;
  }
  (void)SpentAt(t, high); /* also for the window */
  if (!is_held) SetOpening(t);
  SetStep(t, 0.0, high, 0.0, &largest);
  alpha = LamValidStep(t->rve, &t->border->load, t->border, PetscMin(1.0, LIMIT / largest), LAM_LEAST_STEP);
  *ok = (PetscBool)(alpha > 0.0);
  if (*ok) Take(t, high, alpha);
  PetscFunctionReturn(0);
}

/* a for the residual of the iterate, with the factor of the one before. */
static PetscErrorCode SolveAgain(Tearing *t)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n, *unknown = NULL;
  const PetscInt count = t->window ? LamPartSystemUnknowns(t->window, &unknown) : n;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; ++k) t->rhs[k] = -rve->residual[(unknown ? unknown[k] : k) + 2];
  if (!t->window) {
    PetscCall(LamLinearSolve(rve->linear, 1, t->rhs, t->solution));
    PetscFunctionReturn(0);
  }
  PetscCall(LamPartSystemSolve(t->window, 1, t->rhs, t->rhs + count));
  for (PetscInt k = 0; k < count; ++k) t->solution[unknown[k]] = t->rhs[count + k];
  PetscFunctionReturn(0);
}

/* Takes a step of `alpha` that did not lower the energy, because it violates the stiff constraints of the walls, and
   corrects it with the same factor. *moved: the energy is then at most `most`. */
static PetscErrorCode Correct(Tearing *t, PetscReal alpha, PetscReal most, PetscBool *moved)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n, couplings = rve->smooth->count;

  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  PetscCall(PetscArraycpy(t->y, rve->y, rve->length));
  PetscCall(PetscArraycpy(t->step, rve->step, rve->length));
  PetscCall(PetscArraycpy(t->stress, rve->stress, rve->mesh.element_count));
  Take(t, 0.0, alpha);
  for (PetscInt k = 0; k < CORRECTIONS && !*moved; ++k) {
    PetscReal energy, largest;
    PetscBool valid;

    PetscCall(LamAssemble(rve, &t->border->load, rve->y, &energy, rve->residual, &valid));
    if (!valid || rve->smooth->count != couplings) break; /* the matrix has grown: there is no factor */
    PetscCall(SolveAgain(t));
    SetStep(t, 1.0, 0.0, t->ce == 0.0 ? 0.0 : LamInnerProduct(n, t->c, t->solution) / t->ce, &largest);
    if (largest > LIMIT || LamValidStep(rve, &t->border->load, t->border, 1.0, 0.5) == 0.0) break;
    Take(t, 0.0, 1.0);
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
static PetscErrorCode Descend(Tearing *t, PetscReal largest, PetscReal *alpha)
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
    if (lower) Take(t, 0.0, *alpha);
    if (valid && !lower && !corrected && *alpha >= WORTH_CORRECTING) {
      corrected = PETSC_TRUE;
      PetscCall(Correct(t, *alpha, most, &lower));
    }
    if (lower) PetscFunctionReturn(0);
  }
  *alpha = 0.0;
  PetscFunctionReturn(0);
}

/* At most `most` iterations from the first guess to a state. is_held: s is prescribed, and the energy dissipated may
   reach `tau` times EXCESS. */
static PetscErrorCode Iterate(Tearing *t, PetscReal tau, PetscReal tolerance, PetscBool is_held, PetscInt most,
                              PetscBool *converged)
{
  const LamRVE rve = t->rve;
  PetscReal least = PETSC_INFINITY;
  PetscInt idle = 0;

  PetscFunctionBeginUser;
  *converged = PETSC_FALSE;
  t->stuck = PETSC_TRUE;
  rve->layer->secant = PETSC_FALSE;
  for (PetscInt it = 0; it < ITERATIONS && LamMayIterate(rve); ++it) {
    const PetscReal previous = t->norm;
    PetscReal ds, mu, largest, alpha = 1.0;
    PetscBool valid, convex, ok;

    PetscCall(Assemble(t, &valid));
    if (!valid) break;
    *converged = (PetscBool)(t->norm <= tolerance);
    if (*converged || (is_held && t->spent > EXCESS * tau)) break;
    if (it >= most) t->stuck = PETSC_FALSE;
    if (it >= most) break;
    PetscCall(Solve(t, &convex, &ok));
    if (!ok || (!convex && rve->layer->secant)) break;
    if (!convex) {
      rve->layer->secant = PETSC_TRUE;
      continue;
    }
    idle = t->free && t->norm > PROGRESS * previous ? idle + 1 : 0;
    least = PetscMin(least, t->norm);
    if (idle > IDLE || t->norm > 1e3 * least) t->free = PETSC_FALSE;
    if (idle == 0 && !is_held && t->rest < REST * t->norm) t->free = PETSC_TRUE;
    ds = t->free ? -t->ca / t->cb : 0.0;
    mu = t->free || is_held ? 0.0 : t->ca / t->ce;
    if (!isfinite(ds)) break;
    SetStep(t, 1.0, ds, mu, &largest);
    PetscCall(Report(t, t->window ? "part" : t->free ? "free" : is_held ? "load" : "spend", it, largest, tau));
    if (it > 0 && (t->free || is_held) && LamAtRounding(rve, t->norm, tolerance, largest)) {
      *converged = PETSC_TRUE;
      break;
    }
    if (t->free) {
      alpha = LamValidStep(rve, &t->border->load, t->border, PetscMin(1.0, SHORTER / largest), LAM_LEAST_STEP);
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

/* Newton's steps from there towards tau. */
static PetscErrorCode Advance(Tearing *t, PetscReal tau)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;
  PetscBool valid = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt k = 1; k <= STAGES && valid && LamMayIterate(rve); ++k) {
    const PetscReal target = tau * (FIRST + (1.0 - FIRST) * (PetscReal)k / STAGES);
    PetscReal ds, largest, alpha;
    PetscBool convex, ok;

    PetscCall(Assemble(t, &valid));
    if (!valid) break;
    SetOpening(t);
    PetscCall(Solve(t, &convex, &ok));
    if (!ok) break;
    ds = (target - t->spent - LamInnerProduct(n, t->gradient + 2, t->solution)) /
         (t->slope + LamInnerProduct(n, t->gradient + 2, t->solution + n));
    if (!isfinite(ds)) break;
    SetStep(t, 1.0, ds, 0.0, &largest);
    PetscCall(Report(t, "next", k, largest, tau));
    alpha = LamValidStep(rve, &t->border->load, t->border, PetscMin(1.0, SHORTER / largest), LAM_LEAST_STEP);
    if (alpha == 0.0) break;
    Take(t, ds, alpha);
  }
  if (valid) PetscCall(Assemble(t, &valid));
  if (valid) SetOpening(t);
  PetscFunctionReturn(0);
}

/* The cells at which most is dissipated, and those where the residual is largest. */
static void FindSeeds(const Tearing *t, PetscReal residual[], PetscBool seed[])
{
  const LamMesh *mesh = &t->rve->mesh;
  const PetscInt nodes = mesh->node_count / mesh->cell_count;
  PetscReal most;

  for (PetscInt c = 0; c < mesh->cell_count; ++c) {
    residual[c] = 0.0;
    for (PetscInt node = c * nodes; node < (c + 1) * nodes && t->norm < PETSC_INFINITY; ++node)
      for (PetscInt d = 0; d < 2 && mesh->node_class[node] > 0; ++d)
        residual[c] = PetscMax(residual[c], PetscAbsReal(t->rve->residual[2 * mesh->node_class[node] + d]));
  }
  most = LamLargestEntry(mesh->cell_count, t->by_cell);
  for (PetscInt c = 0; c < mesh->cell_count; ++c) seed[c] = (PetscBool)(t->by_cell[c] > WORTH * most);
  most = LamLargestEntry(mesh->cell_count, residual);
  for (PetscInt c = 0; c < mesh->cell_count; ++c) seed[c] = (PetscBool)(seed[c] || residual[c] > WORTH * most);
}

/* Takes the stresses outside the window to those of its last step of s. */
static PetscErrorCode MoveOutside(Tearing *t, const LamPart *part, PetscReal ds)
{
  const LamRVE rve = t->rve;
  const LamLoad before = LoadAt(t, t->share - ds);
  LamPart outside = *part;
  PetscReal dF[9];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rve->mesh.cell_count, &outside.moves));
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) outside.moves[c] = (PetscBool)!part->moves[c];
  for (PetscInt i = 0; i < 9; ++i) dF[i] = ds * t->along[i];
  rve->step[0] = rve->step[1] = 0.0;
  for (PetscInt i = 0; i < rve->linear->positions; ++i) rve->step[i + 2] = ds * t->far[i];
  LamTrialPosition(rve, -1.0);
  rve->part = &outside;
  LamUpdateStresses(rve, &before, rve->trial, rve->step, dF, 1.0);
  rve->part = NULL;
  PetscCall(PetscFree(outside.moves));
  PetscFunctionReturn(0);
}

/* A better guess: the same in a window of cells around what opens, the others going along b. With s prescribed they
   stay where they are. */
static PetscErrorCode InWindow(Tearing *t, const LamPart *part, PetscReal tau, PetscBool is_held, PetscBool advances)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n, *unknown;
  const PetscReal share = t->share;
  PetscBool converged;
  PetscInt count;

  PetscFunctionBeginUser;
  PetscCall(LamPartSystemCreate(rve, part, &t->window));
  count = LamPartSystemUnknowns(t->window, &unknown);
  PetscCall(PetscMalloc1(n, &t->far));
  PetscCall(PetscArraycpy(t->far, t->solution + n, n));
  for (PetscInt k = 0; k < count; ++k) t->far[unknown[k]] = 0.0;
  PetscCall(PetscArrayzero(t->solution, 3 * n));
  PetscCall(PetscArraycpy(t->solution + n, t->far, n));
  LamPartUse(rve, part);
  if (advances) PetscCall(Advance(t, tau));
  PetscCall(Iterate(t, tau, PetscMax(PART_TOLERANCE, 1e-3 * t->norm), is_held, PART_ITERATIONS, &converged));
  LamPartUse(rve, NULL);
  PetscCall(MoveOutside(t, part, t->share - share));
  PetscCall(PetscFree(t->far));
  PetscCall(LamPartSystemDestroy(&t->window));
  (void)LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &t->slope, t->by_cell);
  if (!is_held) SetOpening(t);
  PetscFunctionReturn(0);
}

static PetscErrorCode Approach(Tearing *t, PetscReal tau, PetscBool is_held, PetscBool advances, PetscBool *serves)
{
  const LamRVE rve = t->rve;
  const PetscInt cells = rve->mesh.cell_count;
  PetscBool *seed;
  PetscReal *residual;
  LamPart *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(cells, &seed, cells, &residual));
  FindSeeds(t, residual, seed);
  PetscCall(LamPartCreate(rve, seed, LAYERS, &part));
  *serves = (PetscBool)(WINDOW * part->moving < cells && !rve->linear->lumens && t->path->to.cohesion == 0.0);
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  window of %d of %d cells%s\n", (int)part->moving,
                           (int)cells, *serves ? "" : ": too large"));
  if (*serves)
    PetscCall(InWindow(t, part, tau, is_held, advances));
  else if (advances)
    PetscCall(Advance(t, tau));
  PetscCall(LamPartDestroy(&part));
  PetscCall(PetscFree2(seed, residual));
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
  (void)LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &slope, t->by_cell);
  PetscCall(PetscArraycpy(t->rhs, t->gradient + 2, n));
  PetscCall(LamLinearSolve(rve->linear, 1, t->rhs, t->solution));
  *stable = (PetscBool)(LamInnerProduct(n, t->rhs, t->solution) < 0.0);
  PetscFunctionReturn(0);
}

/* One step from a state, with s prescribed or not; *found: a stable state is in rve->y. */
static PetscErrorCode Step(Tearing *t, LamRVEState at, PetscReal share, PetscReal tau, PetscReal most,
                           PetscBool is_held, PetscBool *found, PetscInt *negative)
{
  const PetscReal limit = t->path->faces * t->face; /* of a step of prescribed s */

  PetscFunctionBeginUser;
  Begin(t, at, share);
  PetscCall(Guess(t, (is_held ? HALF : FIRST) * tau, most, is_held, found));
  t->stuck = (PetscBool) !*found;
  *found = t->free = PETSC_FALSE;
  t->norm = PETSC_INFINITY;
  for (PetscInt k = 0; k < ROUNDS && !*found && !t->stuck; ++k) {
    PetscBool serves = PETSC_FALSE;

    if (!(is_held && k == 0) && t->norm > FINE)
      PetscCall(Approach(t, is_held ? limit : tau, is_held, (PetscBool)(!is_held && k == 0), &serves));
    PetscCall(Iterate(t, is_held ? limit : tau, LamNewtonTolerance(t->rve), is_held,
                      serves || (is_held && k == 0) ? 1
                      : k + 1 < ROUNDS              ? SOME
                                                    : ITERATIONS,
                      found));
  }
  if (*found && !is_held && t->share > share + EXCESS * most) *found = PETSC_FALSE; /* the load ends the step */
  if (*found) PetscCall(CheckStability(t, is_held, found, negative));
  PetscFunctionReturn(0);
}

static PetscErrorCode Find(Tearing *t, LamRVEState at, LamDissipationPoint *point, LamResponse *response)
{
  const LamRVE rve = t->rve;
  const PetscReal most = PetscMin(t->path->most, 1.0 - point->share);
  PetscReal tau[2] = {t->path->faces * t->face, t->path->faces * t->face}; /* of both kinds of steps */
  PetscBool found = PETSC_FALSE, is_held = (PetscBool)!point->dissipates;
  PetscInt negative = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k <= 2 * HALVINGS && !found && !rve->work.stopped; ++k) {
    if (k > 0) is_held = (PetscBool)!is_held;
    PetscCall(Step(t, at, point->share, tau[is_held], most, is_held, &found, &negative));
    tau[is_held] *= 0.5;
  }
  if (found) {
    point->share = t->share;
    point->dissipates = (PetscBool)!is_held;
    response->load = t->border->load;
    response->status = LAM_CONVERGED;
    response->negative_eigenvalues = negative;
    PetscFunctionReturn(0);
  }
  PetscCall(LamRefuse(response, LAM_NOT_CONVERGED,
                      "no state found that dissipates down to %.3g of a face, after %d iterations: try other `faces`",
                      (double)(tau[0] / t->face), (int)rve->work.iterations));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESolveDissipating(LamRVE rve, const LamDissipationPath *path, LamDissipationPoint *point,
                                      LamRVEState state, LamResponse *response)
{
  const PetscReal begin = LamClock(), asked = rve->micro.contact_width;
  LamRVEState before;
  Tearing t;

  PetscFunctionBeginUser;
  PetscCheck(rve->layer, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "only tissue with a lamella dissipates");
  PetscCheck(!rve->mesh.cuts, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "cells whose walls tear burst between states: their turgor is not under control of what is dissipated");
  PetscCheck(path->most > 0.0 && path->most <= 1.0 && path->faces > 0.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a step of %g of the path and %g faces; both must be positive, the first at most 1", (double)path->most,
             (double)path->faces);
  PetscCheck(state->solved, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "the state is no solution");
  PetscCall(LamRVEStateCreate(rve, &before));
  PetscCall(LamRVEStateCopy(state, before));
  PetscCall(LamBeginResponse(rve, &path->to, state, response));
  PetscCall(LamUseSmoothLaw(rve, asked > 0.0 ? asked : LAM_USUAL_WIDTH));
  PetscCall(Create(rve, path, &t));
  PetscCall(Find(&t, before, point, response));
  PetscCall(LamEndResponse(rve, &t.border->load, state, response));
  if (response->status == LAM_CONVERGED)
    response->work = state->work = before->work + LamStepWorkOf(before, state).work;
  PetscCall(Destroy(&t));
  PetscCall(LamRVEStateDestroy(&before));
  response->seconds = LamClock() - begin;
  PetscFunctionReturn(0);
}
