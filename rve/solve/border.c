#include "solve.h"
#include <petscblaslapack.h>

#define LEAST_STIFFNESS                                                                                                \
  1e-6 /* C1 + C2: bounds the steps of a descent in F; below that of all tissue that bears a load */

PetscErrorCode LamBorderCreate(LamRVE rve, const LamLoad *load, const LamStressControl *control, LamBorder **out)
{
  /* of the largest of the systems */
  const PetscInt n = rve->systems[LAM_SYSTEM_BASE].n + (rve->contact ? rve->contact->count : 0);
  LamBorder *border;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&border));
  border->load = *load;
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) {
    const PetscInt component = LamFComponent[q];

    if (!control->given[component]) continue;
    border->q[border->count] = q;
    border->P[border->count++] = control->P[component];
  }
  PetscCall(PetscMalloc3(LAM_F_COUNT * n, &border->R, (border->count + 1) * n, &border->rhs, (border->count + 1) * n,
                         &border->solution));
  *out = border;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBorderDestroy(LamBorder **border)
{
  PetscFunctionBeginUser;
  if (!*border) PetscFunctionReturn(0);
  PetscCall(PetscFree3((*border)->R, (*border)->rhs, (*border)->solution));
  PetscCall(PetscFree(*border));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBorderAssemble(LamRVE rve, LamBorder *border, PetscReal *norm)
{
  const PetscInt n = rve->linear->n, multipliers = LamIsExact(rve) ? rve->contact->count : 0;
  PetscReal Lq[LAM_F_COUNT], sum;

  PetscFunctionBeginUser;
  if (!border) PetscFunctionReturn(0);
  sum = *norm * *norm;
  PetscCall(LamAssembleGradient(rve, &border->load, Lq, border->Lqq, border->R));
  for (PetscInt k = 0; k < border->count; ++k) {
    const PetscReal *R = border->R + border->q[k] * n + rve->linear->positions;

    border->rest[k] = Lq[border->q[k]] - rve->mesh.V0 * border->P[k];
    sum += PetscSqr(border->rest[k]);
    for (PetscInt h = 0; h < multipliers; ++h) /* multipliers enter L by -lambda G, so L_q by lambda R */
      if (rve->contact->active[h]) border->rest[k] -= rve->contact->lambda[h] * R[h];
  }
  *norm = PetscSqrtReal(sum);
  PetscFunctionReturn(0);
}

/* Step of positions and F for a change dq of the free components. */
static void SetStep(LamRVE rve, LamBorder *border, const PetscReal dq[], PetscReal solution[])
{
  const PetscInt n = rve->linear->n;

  for (PetscInt i = 0; i < n; ++i) solution[i] = border->solution[i];
  for (PetscInt k = 0; k < border->count; ++k) {
    border->dF[LamFComponent[border->q[k]]] = dq[k];
    for (PetscInt i = 0; i < n; ++i) solution[i] -= dq[k] * border->solution[(k + 1) * n + i];
  }
}

PetscErrorCode LamBorderSolve(LamRVE rve, LamBorder *border, const PetscReal rhs[], PetscReal solution[])
{
  const PetscInt n = rve->linear->n;
  PetscReal S[LAM_SMALL][LAM_SMALL], w[LAM_SMALL], V[LAM_SMALL][LAM_SMALL], b[LAM_SMALL], dq[LAM_SMALL] = {0};

  PetscFunctionBeginUser;
  if (!border) {
    PetscCall(LamLinearSolve(rve->linear, 1, rhs, solution));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArraycpy(border->rhs, rhs, n));
  for (PetscInt k = 0; k < border->count; ++k)
    LamCopyActive(rve, border->R + border->q[k] * n, border->rhs + (k + 1) * n);
  PetscCall(LamLinearSolve(rve->linear, border->count + 1, border->rhs, border->solution));
  for (PetscInt k = 0; k < border->count; ++k) {
    const PetscReal *R = border->rhs + (k + 1) * n;

    b[k] = -border->rest[k] - LamInnerProduct(n, R, border->solution);
    for (PetscInt l = k; l < border->count; ++l)
      S[k][l] = S[l][k] =
          border->Lqq[border->q[k]][border->q[l]] - LamInnerProduct(n, R, border->solution + (l + 1) * n);
  }
  PetscCall(LamSmallEigenvectors(border->count, (const PetscReal(*)[LAM_SMALL])S, w, V));
  for (PetscInt k = 0; k < border->count; ++k) {
    const PetscReal stiffness = border->descend ? PetscMax(PetscAbsReal(w[k]), LEAST_STIFFNESS * rve->mesh.V0) : w[k];
    const PetscReal share = LamInnerProduct(border->count, V[k], b) / stiffness;

    for (PetscInt l = 0; l < border->count; ++l) dq[l] += share * V[k][l];
  }
  SetStep(rve, border, dq, solution);
  PetscFunctionReturn(0);
}

PetscReal LamBorderReach(LamRVE rve, const LamBorder *border, const PetscReal dy[])
{
  const PetscReal *dF = LamBorderStep(border), *held = rve->mesh.class_X;
  PetscReal largest = LamLargestEntry(9, dF);

  for (PetscInt c = 1; c < rve->mesh.class_count; ++c) {
    const PetscReal X[2] = {rve->mesh.class_X[2 * c] - held[0], rve->mesh.class_X[2 * c + 1] - held[1]};

    for (PetscInt i = 0; i < 2; ++i)
      largest = PetscMax(largest, PetscAbsReal(dy[2 * (c - 1) + i] - dF[3 * i] * X[0] - dF[3 * i + 1] * X[1]));
  }
  return largest;
}

const PetscReal *LamBorderStep(const LamBorder *border)
{
  static const PetscReal no_change[9] = {0};

  return border ? border->dF : no_change;
}

LamLoad LamBorderMoved(const LamBorder *border, const LamLoad *load, PetscReal alpha)
{
  const PetscReal *dF = LamBorderStep(border);
  LamLoad moved = *load;

  for (PetscInt i = 0; i < 9; ++i) moved.F[i] += alpha * dF[i];
  return moved;
}

PetscErrorCode LamSmallEigenvectors(PetscInt n, const PetscReal A[LAM_SMALL][LAM_SMALL], PetscReal w[LAM_SMALL],
                                    PetscReal V[LAM_SMALL][LAM_SMALL])
{
  PetscBLASInt size = (PetscBLASInt)n, stride = LAM_SMALL, length = 8 * LAM_SMALL, info;
  PetscReal work[8 * LAM_SMALL];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(&V[0][0], &A[0][0], LAM_SMALL * LAM_SMALL));
  LAPACKsyev_("V", "U", &size, &V[0][0], &stride, w, work, &length, &info);
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev: argument %d", (int)-info);
  if (info > 0) w[0] = NAN; /* A is not finite: marks the result as invalid */
  PetscFunctionReturn(0);
}
