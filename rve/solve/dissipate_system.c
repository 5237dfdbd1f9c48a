#include "dissipate.h"

#define GROWTH 6.0 /* of shifts, as in minimise.c */
#define DECAY 5.0
#define LEAST_SHIFT 1e-7

PetscErrorCode LamDissipationCreate(LamRVE rve, const LamDissipationPath *path, LamDissipation *t)
{
  static const LamStressControl none = {0};
  const PetscInt n = rve->linear->n;

  PetscFunctionBeginUser;
  *t = (LamDissipation){.rve = rve, .path = path};
  t->face = rve->micro.lamella.energy * rve->mesh.mean_length;
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

PetscErrorCode LamDissipationDestroy(LamDissipation *t)
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

LamLoad LamDissipationLoadAt(const LamDissipation *t, PetscReal share)
{
  LamLoad load = t->path->to;

  for (PetscInt i = 0; i < 9; ++i) load.F[i] = t->path->from.F[i] + share * t->along[i];
  return load;
}

void LamDissipationBegin(LamDissipation *t, LamRVEState at, PetscReal share)
{
  const LamRVE rve = t->rve;

  t->share = share;
  t->border->load = LamDissipationLoadAt(t, share);
  (void)PetscArraycpy(rve->y, at->y, rve->length);
  (void)LamSetConsistentStresses(rve, &t->border->load, rve->y);
}

/* Norm of r + mu c, of what moves. */
static PetscReal NormOf(const LamDissipation *t, PetscReal mu)
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

PetscErrorCode LamDissipationAssemble(LamDissipation *t, PetscBool *valid)
{
  const LamRVE rve = t->rve;
  PetscReal Lq[LAM_F_COUNT], Lqq[LAM_F_COUNT][LAM_F_COUNT];

  PetscFunctionBeginUser;
  PetscCall(LamAssemble(rve, &t->border->load, rve->y, &t->energy, rve->residual, valid));
  if (!*valid) PetscFunctionReturn(0);
  t->norm = NormOf(t, 0.0);
  t->spent = LamLayerSpent(rve, &t->border->load, rve->y, t->along, t->gradient, &t->slope, t->by_cell);
  if (t->window || t->is_held) PetscFunctionReturn(0); /* the column does not change there, or is not needed */
  PetscCall(LamAssembleGradient(rve, &t->border->load, Lq, Lqq, t->R));
  for (PetscInt i = 0; i < rve->linear->n; ++i) {
    t->column[i] = 0.0;
    for (PetscInt q = 0; q < LAM_F_COUNT; ++q)
      t->column[i] += t->R[q * rve->linear->n + i] * t->along[LamFComponent[q]];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAll(LamDissipation *t, PetscInt *negative, PetscBool *ok)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;

  PetscFunctionBeginUser;
  PetscCall(LamRVEFactor(rve, LAM_PROXIMAL + t->shift, negative, ok));
  if (!*ok) PetscFunctionReturn(0);
  *negative -= LamExpectedNegative(rve);
  for (PetscInt i = 0; i < n; ++i) {
    t->rhs[i] = -rve->residual[i + 2];
    if (t->is_held) continue;
    t->rhs[n + i] = -t->column[i];
    t->rhs[2 * n + i] = t->c[i];
  }
  PetscCall(LamLinearSolve(rve->linear, t->is_held ? 1 : 3, t->rhs, t->solution));
  PetscFunctionReturn(0);
}

/* Outside the window a and e are 0, and b is `far`. */
static PetscErrorCode SolveWindow(LamDissipation *t, PetscInt *negative, PetscBool *ok)
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

PetscErrorCode LamDissipationSolve(LamDissipation *t, PetscBool *convex, PetscBool *ok)
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

PetscErrorCode LamDissipationSolveAgain(LamDissipation *t)
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

/* Length of a step: how far nodes move in their cells. Cells of a large patch go farther. */
static PetscReal Reach(const LamDissipation *t)
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

void LamDissipationSetStep(LamDissipation *t, PetscReal with, PetscReal ds, PetscReal mu, PetscReal *largest)
{
  const LamRVE rve = t->rve;
  const PetscInt n = rve->linear->n;

  rve->step[0] = rve->step[1] = 0.0;
  for (PetscInt i = 0; i < n; ++i)
    rve->step[i + 2] = with * t->solution[i] + ds * t->solution[n + i] - mu * t->solution[2 * n + i];
  for (PetscInt i = 0; i < 9; ++i) t->border->dF[i] = ds * t->along[i];
  *largest = Reach(t);
}

void LamDissipationTake(LamDissipation *t, PetscReal ds, PetscReal alpha)
{
  LamTakeStep(t->rve, &t->border->load, t->border, alpha);
  t->share += alpha * ds;
  t->border->load = LamDissipationLoadAt(t, t->share);
}

PetscReal LamDissipationSpentAt(LamDissipation *t, PetscReal ds)
{
  const LamLoad load = LamDissipationLoadAt(t, t->share + ds);
  PetscReal slope, largest;

  LamDissipationSetStep(t, 0.0, ds, 0.0, &largest);
  LamTrialPosition(t->rve, 1.0);
  return LamLayerSpent(t->rve, &load, t->rve->trial, t->along, t->gradient, &slope, t->by_cell);
}

void LamDissipationSetOpening(LamDissipation *t)
{
  const PetscInt n = t->rve->linear->n;
  const PetscReal norm = PetscSqrtReal(LamInnerProduct(n, t->gradient + 2, t->gradient + 2));

  for (PetscInt i = 0; i < n; ++i) t->c[i] = t->gradient[i + 2] / norm;
}
