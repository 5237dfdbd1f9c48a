/*
  Stability of a converged state: inertia of the consistent tangent, and its softest mode.

  Method. A state is stable if the consistent tangent has no negative eigenvalue (prescribed turgor, bonded walls). In
  contact only motions that keep the active gaps closed count, and for sealed lumens the pressures are eliminated: the
  tangent of a stable state then has as many negative eigenvalues as there are active multipliers and sealed lumens.
  The lowest eigenvalue and its mode come from inverse iteration on K + shift 1. The shift is just large enough to
  make it positive definite, bracketed by the inertia, so that the lowest mode dominates the inverse.
*/
#include "rve_impl.h"

PetscInt LamExpectedNegative(LamRVE rve)
{
  return (LamIsExact(rve) ? LamContactCountActive(rve->contact) : 0) + (rve->seal.closed ? rve->linear->lumens : 0);
}

/* Factors with a shift; negative: eigenvalues beyond the expected ones. */
static PetscErrorCode FactorShifted(LamRVE rve, PetscReal shift, PetscInt *negative, PetscBool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEFactor(rve, shift, negative, ok));
  *negative -= LamExpectedNegative(rve);
  PetscFunctionReturn(0);
}

/*
  Contact tissue may have motions that do not change the energy: cells that slide or rotate freely. If inverse
  iteration finds an eigenvalue of absolute value at most LAM_ZERO_MODE, the inertia on both sides of zero counts these
  modes. They do not count as negative. The factor keeps the shift, which is harmless: no force acts along these
  modes.
*/
static PetscErrorCode CountZeroModes(LamRVE rve, PetscInt *negative, PetscBool *ok)
{
  PetscReal *mode, *image, eigenvalue = 0.0;
  PetscInt below, above;

  PetscFunctionBeginUser;
  if (*ok) {
    PetscCall(PetscMalloc2(rve->linear->n, &mode, rve->linear->n, &image));
    LamStartMode(rve, mode);
    PetscCall(LamImproveSoftestMode(rve, 3, mode));
    eigenvalue = LamModeCurvature(rve, mode, image);
    PetscCall(PetscFree2(mode, image));
    if (PetscAbsReal(eigenvalue) > LAM_ZERO_MODE) PetscFunctionReturn(0);
  }
  PetscCall(FactorShifted(rve, -LAM_ZERO_MODE, &below, ok));
  if (*ok) PetscCall(FactorShifted(rve, LAM_ZERO_MODE, &above, ok));
  if (!*ok) PetscFunctionReturn(0);
  rve->zero_modes = below - above;
  rve->lowest_eigenvalue = eigenvalue;
  *negative = above;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorConsistent(LamRVE rve, const LamLoad *load, PetscInt *negative, PetscBool *ok)
{
  PetscReal energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  *negative = 0;
  rve->zero_modes = 0;
  *ok = (PetscBool)(rve->consistent || LamSetConsistentStresses(rve, load, rve->y));
  if (!*ok) PetscFunctionReturn(0);
  if (!rve->consistent) PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  rve->consistent = PETSC_FALSE;
  if (LamIsExact(rve)) {
    PetscCall(LamContactEvaluate(rve, load, rve->y));
    LamContactAddCurvature(rve);
    LamContactSetRows(rve);
  }
  PetscCall(FactorShifted(rve, 0.0, negative, ok));
  if (rve->contact) PetscCall(CountZeroModes(rve, negative, ok));
  PetscFunctionReturn(0);
}

/* Finds the smallest shift, within a factor of 1.2, for which K + shift 1 is positive definite, or 0. Leaves the factor
   with that shift. */
static PetscErrorCode BracketLowest(LamRVE rve, PetscReal *shift)
{
  const PetscReal diagonal = LamLargestDiagonal(rve->linear);
  PetscReal low = 0.0, high = 0.0;
  PetscInt negative;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LamRVEFactor(rve, 0.0, &negative, &ok));
  *shift = 0.0;
  if (ok && negative == LamExpectedNegative(rve)) PetscFunctionReturn(0);
  for (high = PetscMin(1e-8 * diagonal, LamBendingStiffness(rve)); high < 1e3 * diagonal; high *= 4.0) {
    PetscCall(LamRVEFactor(rve, high, &negative, &ok));
    if (ok && negative == LamExpectedNegative(rve)) break;
    low = high;
  }
  while (low > 0.0 && high > 1.2 * low) {
    const PetscReal middle = PetscSqrtReal(low * high);

    PetscCall(LamRVEFactor(rve, middle, &negative, &ok));
    if (ok && negative == LamExpectedNegative(rve))
      high = middle;
    else
      low = middle;
  }
  PetscCall(LamRVEFactor(rve, high, &negative, &ok));
  *shift = high;
  PetscFunctionReturn(0);
}

void LamStartMode(LamRVE rve, PetscReal mode[])
{
  for (PetscInt i = 0; i < rve->linear->n; ++i) mode[i] = 0.0; /* modes have no multiplier components */
  for (PetscInt i = 0; i < rve->linear->positions; ++i) mode[i] = PetscSinReal(1.0 + 2.399963 * (PetscReal)i);
}

PetscErrorCode LamImproveSoftestMode(LamRVE rve, PetscInt iterations, PetscReal mode[])
{
  const PetscInt n = rve->linear->n, positions = rve->linear->positions, pressures = n - rve->linear->lumens;
  PetscReal largest = 0.0, *next;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &next));
  for (PetscInt it = 0; it < iterations; ++it) {
    PetscReal norm;

    PetscCall(PetscArrayzero(mode + pressures,
                             rve->linear->lumens)); /* the pressures of the solution follow from its positions */
    PetscCall(LamLinearSolve(rve->linear, 1, mode, next));
    PetscCall(PetscArraycpy(mode, next, positions));
    norm = PetscSqrtReal(LamInnerProduct(positions, mode, mode));
    for (PetscInt i = 0; i < positions; ++i) mode[i] /= norm;
    for (PetscInt i = pressures; i < n; ++i) mode[i] = next[i] / norm;
  }
  PetscCall(PetscFree(next));
  for (PetscInt i = 0; i < positions; ++i)
    if (PetscAbsReal(mode[i]) > PetscAbsReal(largest) * (1.0 + 1e-6)) largest = mode[i];
  if (largest < 0.0)
    for (PetscInt i = 0; i < n; ++i) mode[i] = -mode[i];
  PetscFunctionReturn(0);
}

void LamAddMode(LamRVE rve, PetscReal factor, const PetscReal mode[], PetscReal to[])
{
  for (PetscInt i = 0; i < rve->linear->positions; ++i) to[2 + i] += factor * mode[i];
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) to[rve->ndof + c] += factor * mode[rve->linear->pressures + c];
}

PetscReal LamModeSlope(LamRVE rve, const PetscReal mode[], const PetscReal residual[])
{
  return LamInnerProduct(rve->linear->positions, mode, residual + 2) +
         LamInnerProduct(rve->linear->lumens, mode + rve->linear->pressures, residual + rve->ndof);
}

PetscReal LamModeCurvature(LamRVE rve, const PetscReal mode[], PetscReal image[])
{
  LamLinearMultiply(rve->linear, mode, image);
  return LamInnerProduct(rve->linear->n, mode, image);
}

PetscErrorCode LamSoftestMode(LamRVE rve, PetscReal *eigenvalue, PetscReal mode[])
{
  PetscReal shift, *image;

  PetscFunctionBeginUser;
  LamStartMode(rve, mode);
  *eigenvalue = NAN;
  PetscCall(BracketLowest(rve, &shift));
  if (rve->work.stopped) PetscFunctionReturn(0);
  PetscCall(LamImproveSoftestMode(rve, 30, mode));
  PetscCall(PetscMalloc1(rve->linear->n, &image));
  *eigenvalue = LamModeCurvature(rve, mode, image);
  PetscCall(PetscFree(image));
  PetscFunctionReturn(0);
}
