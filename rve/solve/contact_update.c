/*
  Step for an active set that differs in a few hats from the one whose matrix is factored.

  Method. A0 is the factored matrix, x0 = A0^-1 b its solution. Removed hats keep their row and get an unknown force mu
  that makes their multiplier zero. Added hats get their row of gap gradients as a border, with mu as their multiplier:
    [ A0  B ] [ x  ]   [ b ]        column of B: unit vector of a removed hat,  -dG of an added one
    [ B^T D ] [ mu ] = [ d ],       D, d: 0, 0 and -compliance weight, gap weight
  so with Y = A0^-1 B and S = B^T Y - D:  mu = S^-1 (B^T x0 - d),  x = x0 - Y mu.
  By Sylvester's law the bordered matrix has as many negative eigenvalues as A0 and -S together; each removed hat
  accounts for one that the matrix of the new set does not have. A few right-hand sides cost a quarter of a
  factorisation.
*/
#include "solve.h"
#include <petscblaslapack.h>

#define MOST_CHANGES 8
#define LEAST_EIGENVALUE 1e-10 /* of S, over its largest */

typedef struct {
  PetscInt count, hat[MOST_CHANGES];
  PetscBool taken[MOST_CHANGES]; /* added, else removed */
} Changes;

/* Returns PETSC_FALSE if there are more than MOST_CHANGES. */
static PetscBool FindChanges(const LamContact *contact, const PetscBool before[], Changes *c)
{
  c->count = 0;
  for (PetscInt h = 0; h < contact->count; ++h) {
    if (contact->active[h] == before[h]) continue;
    if (c->count == MOST_CHANGES) return PETSC_FALSE;
    c->taken[c->count] = contact->active[h];
    c->hat[c->count++] = h;
  }
  return PETSC_TRUE;
}

static void SetColumn(LamRVE rve, PetscInt hat, PetscBool taken, PetscReal column[])
{
  const LamContact *contact = rve->contact;
  const PetscInt *classes = &contact->classes[hat / contact->hats * contact->chain];
  const PetscReal *row = &contact->rows[hat * contact->dofs];

  if (!taken) column[rve->linear->positions + hat] = 1.0;
  for (PetscInt i = 0; i < contact->dofs && taken; ++i)
    if (classes[i / 2] > 0) column[LamUnknown(classes[i / 2], i % 2)] -= row[i];
}

/* mu = S^-1 r by the eigenvectors of S; positive: number of positive eigenvalues. *ok: S is not singular. */
static PetscErrorCode SolveSmall(PetscInt m, PetscReal S[], const PetscReal r[], PetscReal mu[], PetscInt *positive,
                                 PetscBool *ok)
{
  PetscBLASInt size = (PetscBLASInt)m, length = 8 * MOST_CHANGES, info;
  PetscReal w[MOST_CHANGES], work[8 * MOST_CHANGES];

  PetscFunctionBeginUser;
  LAPACKsyev_("V", "U", &size, S, &size, w, work, &length, &info);
  *ok = (PetscBool)(info == 0);
  *positive = 0;
  for (PetscInt k = 0; k < m; ++k) mu[k] = 0.0;
  for (PetscInt k = 0; k < m && *ok; ++k) {
    const PetscReal share = LamInnerProduct(m, &S[k * m], r) / w[k];

    if (!(PetscAbsReal(w[k]) > LEAST_EIGENVALUE * PetscMax(PetscAbsReal(w[0]), PetscAbsReal(w[m - 1]))))
      *ok = PETSC_FALSE;
    *positive += w[k] > 0.0;
    for (PetscInt l = 0; l < m; ++l) mu[l] += share * S[k * m + l];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactUpdateStep(LamRVE rve, const PetscBool before[], const PetscReal first[], PetscReal compliance,
                                    PetscReal solution[], PetscBool *ok)
{
  const LamContact *contact = rve->contact;
  const PetscInt n = rve->linear->n, positions = rve->linear->positions;
  PetscReal S[MOST_CHANGES * MOST_CHANGES], r[MOST_CHANGES], mu[MOST_CHANGES], *B, *Y;
  PetscInt positive, dropped = 0;
  Changes c;

  PetscFunctionBeginUser;
  *ok = FindChanges(contact, before, &c);
  PetscCall(PetscArraycpy(solution, first, n));
  if (!*ok || c.count == 0) PetscFunctionReturn(0); /* no changes: `first` is the solution */
  PetscCall(PetscMalloc2(c.count * n, &B, c.count * n, &Y));
  PetscCall(PetscArrayzero(B, c.count * n));
  for (PetscInt k = 0; k < c.count; ++k) SetColumn(rve, c.hat[k], c.taken[k], &B[k * n]);
  PetscCall(LamLinearSolveOnce(rve->linear, c.count, B, Y));
  for (PetscInt k = 0; k < c.count; ++k) {
    const PetscReal weight = contact->weight[c.hat[k]];

    dropped += !c.taken[k];
    for (PetscInt l = 0; l < c.count; ++l) S[k * c.count + l] = LamInnerProduct(n, &B[k * n], &Y[l * n]);
    if (c.taken[k]) S[k * c.count + k] += compliance * weight;
    r[k] = LamInnerProduct(n, &B[k * n], first) - (c.taken[k] ? contact->gap[c.hat[k]] * weight : 0.0);
  }
  PetscCall(SolveSmall(c.count, S, r, mu, &positive, ok));
  if (rve->linear->negative + positive - dropped > LamExpectedNegative(rve)) *ok = PETSC_FALSE;
  for (PetscInt k = 0; k < c.count; ++k)
    for (PetscInt i = 0; i < n; ++i) solution[i] -= mu[k] * Y[k * n + i];
  for (PetscInt k = 0; k < c.count; ++k) solution[positions + c.hat[k]] = c.taken[k] ? mu[k] : 0.0;
  PetscCall(PetscFree2(B, Y));
  PetscFunctionReturn(0);
}
