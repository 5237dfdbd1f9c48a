/*
  Equilibrium of the RVE at one load.

  Method. (K(x, p*, s*) + shift 1) dx = -r(x) with the residual of the energy and the tangent with independent stresses
  (element.h). The shift is zero if K is positive definite, otherwise just large enough (inertia correction). Sealed
  lumens add their pressures to x, and one negative eigenvalue each (turgor.c). Steps are full, shortened only if an
  element volume would be inverted.

  Reference. Magisano, Leonetti & Garcea, Int. J. Numer. Meth. Engng 109 (2017) 1237 (mixed integration points).
*/
#include "solve.h"

#define FAST_ITERATIONS 25
#define LEAST_SHIFT 1e-7     /* of the largest diagonal entry */
#define SADDLE_RESIDUAL 1e-4 /* residual norm below which an indefinite state is taken to be near a saddle */

PetscReal LamNewtonTolerance(LamRVE rve)
{
  /* Pressure and fibre forces have a rounding error of eps times their stiffness in each of n entries. Gradients are
     differences of positions, so it grows with RVE size over element depth. The floor measured for t = 0.003 to 0.5 and
     up to 8 x 8 cells stays below 0.6 slenderness x size (docs/results/verification.md). */
  const PetscReal depth = rve->mesh.thinnest / (PetscReal)rve->mesh.through;
  const PetscReal slenderness = PetscMax(rve->mesh.longest / depth, depth / rve->mesh.shortest);
  const PetscReal rounding = PETSC_MACHINE_EPSILON * rve->stiffest * PetscSqrtReal((PetscReal)rve->ndof);

  return PetscMax(PetscMax(1e-11, rve->tolerance), PetscMax(4.0, slenderness * rve->mesh.size) * rounding);
}

PetscErrorCode LamReportIteration(LamRVE rve, const char tier[], PetscInt iteration, PetscReal residual, PetscReal step,
                                  PetscReal shift)
{
  PetscFunctionBeginUser;
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  %-5s %3d  residual %10.3e  largest step %9.3e  shift %g\n",
                           tier, (int)iteration, (double)residual, (double)step, (double)shift));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSolveStep(LamRVE rve, LamBorder *border)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 2; i < rve->length; ++i) rve->trial[i] = -rve->residual[i];
  PetscCall(LamBorderSolve(rve, border, rve->trial + 2, rve->step + 2));
  rve->step[0] = rve->step[1] = 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorShifted(LamRVE rve, PetscReal base, PetscReal next, PetscReal growth, PetscReal *shift,
                                PetscBool *ok)
{
  const PetscReal diagonal = LamLargestDiagonal(rve->linear);
  PetscInt negative;

  PetscFunctionBeginUser;
  for (PetscInt attempt = 0; attempt < 60; ++attempt) {
    PetscCall(LamRVEFactor(rve, *shift, &negative, ok));
    if (*ok && negative <= LamExpectedNegative(rve)) break;
    *ok = PETSC_FALSE;
    if (*shift > diagonal) break;
    *shift = *shift > base ? growth * *shift : next;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorPositive(LamRVE rve, PetscReal least, PetscReal *last_shift, PetscBool *ok)
{
  const PetscReal first = PetscMin(least, LEAST_SHIFT * LamLargestDiagonal(rve->linear));
  const PetscReal next = PetscMax(*last_shift / 8.0, first);

  PetscFunctionBeginUser;
  *last_shift = 0.0;
  PetscCall(LamFactorShifted(rve, 0.0, next, 4.0, last_shift, ok));
  PetscFunctionReturn(0);
}

PetscBool LamAtRounding(LamRVE rve, PetscReal norm, PetscReal tolerance, PetscReal largest)
{
  const PetscReal extent = PetscMax(1.0, LamLargestEntry(rve->ndof, rve->y));

  return (PetscBool)(largest <= 500.0 * PETSC_MACHINE_EPSILON * extent && norm <= LAM_ROUNDING_MARGIN * tolerance);
}

PetscReal LamValidStep(LamRVE rve, const LamLoad *load, const LamBorder *border, PetscReal alpha, PetscReal least)
{
  for (; alpha > least; alpha *= 0.5) {
    const LamLoad moved = LamBorderMoved(border, load, alpha);

    LamTrialPosition(rve, alpha);
    if (LamPositionsAreValid(rve, &moved, rve->trial)) return alpha;
  }
  return 0.0;
}

void LamTakeStep(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal alpha)
{
  LamUpdateStresses(rve, load, rve->y, rve->step, LamBorderStep(border), alpha);
  for (PetscInt i = 0; i < rve->length; ++i) rve->y[i] += alpha * rve->step[i];
  if (border) border->load = LamBorderMoved(border, load, alpha);
  ++rve->work.iterations;
}

PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamBorder *border, LamNewtonOutcome *outcome)
{
  const PetscReal tolerance = LamNewtonTolerance(rve);
  PetscReal first = 0.0, previous = PETSC_INFINITY, shift = 0.0;
  PetscBool last = PETSC_FALSE; /* the last step is expected to have converged */
  PetscInt growth = 0;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  LamForgetTangent(rve);
  for (PetscInt it = 0; it <= FAST_ITERATIONS && !rve->work.stopped; ++it) {
    PetscReal energy, norm, largest, alpha;
    PetscBool valid, ok;

    if (last) last = LamSetConsistentStresses(rve, load, rve->y);
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    if (!valid) break;
    norm = LamResidualNorm(rve, rve->residual);
    PetscCall(LamBorderAssemble(rve, border, &norm));
    if (it == 0) first = norm;
    if (norm <= tolerance && (it > 0 || !rve->moved)) { /* an affinely moved initial guess does not count */
      PetscCall(LamReportIteration(rve, "fast", it, norm, 0.0, 0.0));
      *outcome = LAM_NEWTON_CONVERGED;
      rve->consistent = last;
      break;
    }
    growth = norm > previous ? growth + 1 : 0;
    last = (PetscBool)(norm * PetscSqr(norm / previous) <=
                       LAM_ROUNDING_MARGIN * tolerance); /* assuming quadratic convergence */
    previous = norm;
    /* the residual may grow for a few steps while the stiff constraints are violated */
    if (it == FAST_ITERATIONS || growth >= 4 || !(norm < 1e8 * (1.0 + first))) break;
    if (it == 0 || border) last = PETSC_FALSE;
    PetscCall(LamFactorPositive(rve, PETSC_INFINITY, &shift, &ok));
    if (!ok) break;
    PetscCall(LamSolveStep(rve, border));
    largest = LamBorderReach(rve, border, rve->step + 2);
    PetscCall(LamReportIteration(rve, "fast", it, norm, largest, shift));
    if (LamAtRounding(rve, norm, tolerance, largest)) {
      if (it == 0 && shift == 0.0) LamTakeStep(rve, load, border, 1.0);
      *outcome = LAM_NEWTON_CONVERGED;
      break;
    }
    if (shift > 0.0 && norm < SADDLE_RESIDUAL) {
      *outcome = LAM_NEWTON_NEAR_SADDLE;
      break;
    }
    if (!(largest < 10.0)) break;
    alpha = LamValidStep(rve, load, border, 1.0, LAM_LEAST_STEP);
    if (alpha == 0.0) break;
    LamTakeStep(rve, load, border, alpha);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamAddNegativeCurvature(LamRVE rve, PetscInt iterations, const PetscReal residual[], PetscReal mode[],
                                       PetscReal image[])
{
  PetscReal largest, sign;

  PetscFunctionBeginUser;
  PetscCall(LamImproveSoftestMode(rve, iterations, mode));
  if (LamModeCurvature(rve, mode, image) >= (rve->contact ? -LAM_ZERO_MODE : 0.0)) PetscFunctionReturn(0);
  largest = LamLargestEntry(rve->linear->positions, mode);
  /* if the slope is zero, the mode's own sign */
  sign = LamModeSlope(rve, mode, residual) > LamNewtonTolerance(rve) ? -1.0 : 1.0;
  LamAddMode(rve, sign * LAM_ESCAPE_STEP / largest, mode, rve->step);
  ++rve->work.escapes;
  PetscFunctionReturn(0);
}
