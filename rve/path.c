/*
  From a known state to the equilibrium at a new load.

  Method. (i) The state is turned rigidly so that its stretch axes follow the new load's rotation, and moved affinely by
  the rest of the change of F. (ii) Fast tier, then safe tier, at the full load. (iii) Where both fail, the same along
  the straight line in (F, turgor) in substeps, halved on failure and doubled on success. (iv) A converged state with
  negative eigenvalues is a saddle: it is left along its unstable mode, downhill, to a stable branch.
*/
#include "rve_impl.h"

#define MIN_SUBSTEP (1.0 / 512.0)
#define MAX_BRANCH_SWITCHES 6
#define KICK 0.02 /* apothems: start along an unstable mode */

/* Rotation angle of the polar decomposition of the in-plane part of F. */
PetscReal LamRotationAngle(const PetscReal F[9])
{
  return atan2(F[3] - F[1], F[0] + F[4]);
}

void LamRotatePositions(PetscInt n, PetscReal y[], PetscReal F[9], PetscReal angle)
{
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);

  for (PetscInt i = 0; i < n; i += 2) {
    const PetscReal y0 = y[i], y1 = y[i + 1];

    y[i] = c * y0 - s * y1;
    y[i + 1] = s * y0 + c * y1;
  }
  for (PetscInt J = 0; J < 2; ++J) {
    const PetscReal F0 = F[J], F1 = F[3 + J];

    F[J] = c * F0 - s * F1;
    F[3 + J] = s * F0 + c * F1;
  }
}

void LamMoveAffinely(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to)
{
  const PetscReal *A = load_from->F, *B = load_to->F;

  (void)LamSetConsistentStresses(rve, load_from, from);
  for (PetscInt c = 0; c < rve->mesh.class_count; ++c) {
    const PetscReal *X = &rve->mesh.class_X[2 * c];

    rve->y[2 * c] = from[2 * c] + (B[0] - A[0]) * X[0] + (B[1] - A[1]) * X[1];
    rve->y[2 * c + 1] = from[2 * c + 1] + (B[3] - A[3]) * X[0] + (B[4] - A[4]) * X[1];
  }
  for (PetscInt i = rve->ndof; i < rve->length; ++i) rve->y[i] = from[i];
}

/* Leaves saddles downhill until the state is stable. Ends with the consistent tangent factored. */
static PetscErrorCode LeaveSaddle(LamRVE rve, const LamLoad *load, PetscInt *branch, PetscInt *negative, PetscBool *ok)
{
  PetscReal *mode, *saddle;
  PetscInt unstable;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, load, negative, ok));
  if (!*ok || *negative == 0) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(rve->linear.n, &mode, rve->length, &saddle));
  for (PetscInt k = 0; k<MAX_BRANCH_SWITCHES && * ok && * negative> 0; ++k) {
    LamNewtonOutcome outcome;

    PetscCall(PetscArraycpy(saddle, rve->y, rve->length));
    unstable = *negative;
    PetscCall(LamSoftestMode(rve, &rve->lowest_eigenvalue, mode));
    if (rve->monitor)
      PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                             "  saddle: %d negative eigenvalues, lowest %.3e; leaving it\n", (int)unstable,
                             (double)rve->lowest_eigenvalue));
    LamAddMode(rve, KICK / LamLargestEntry(rve->linear.positions, mode), mode, rve->y);
    PetscCall(LamNewtonSafe(rve, load, &outcome));
    if (outcome == LAM_NEWTON_CONVERGED) {
      ++*branch;
      PetscCall(LamFactorConsistent(rve, load, negative, ok));
    } else {
      PetscCall(PetscArraycpy(rve->y, saddle, rve->length));
      PetscCall(LamFactorConsistent(rve, load, negative, ok));
      break;
    }
  }
  PetscCall(PetscFree2(mode, saddle));
  PetscFunctionReturn(0);
}

/* One step from (from, load_from) to load_to; *reached where a stable state was found, now in rve->y. */
static PetscErrorCode Step(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to,
                           PetscInt *branch, PetscInt *negative, PetscBool *converged)
{
  const PetscInt escapes = rve->work.escapes;
  LamNewtonOutcome outcome;
  PetscBool ok = PETSC_FALSE;

  PetscFunctionBeginUser;
  LamMoveAffinely(rve, from, load_from, load_to);
  PetscCall(LamNewtonFast(rve, load_to, NULL, &outcome));
  if (outcome == LAM_NEWTON_STALLED) {
    LamMoveAffinely(rve, from, load_from, load_to);
    PetscCall(LamNewtonSafe(rve, load_to, &outcome));
  } else if (outcome == LAM_NEWTON_NEAR_SADDLE) {
    PetscCall(LamNewtonSafe(rve, load_to, &outcome));
  }
  if (rve->work.escapes > escapes) ++*branch;
  if (outcome == LAM_NEWTON_CONVERGED) PetscCall(LeaveSaddle(rve, load_to, branch, negative, &ok));
  *converged = ok;
  PetscFunctionReturn(0);
}

LamLoad LamLoadBetween(const LamLoad *a, const LamLoad *b, PetscReal t)
{
  LamLoad load = *b;

  for (PetscInt i = 0; i < 9; ++i) load.F[i] = (1.0 - t) * a->F[i] + t * b->F[i];
  load.turgor = (1.0 - t) * a->turgor + t * b->turgor;
  load.cohesion = (1.0 - t) * a->cohesion + t * b->cohesion;
  return load;
}

/* Substeps from `start` to `load`; y_from holds the last converged positions. */
static PetscErrorCode Substeps(LamRVE rve, PetscReal y_from[], const LamLoad *start, const LamLoad *load,
                               PetscInt *branch, PetscInt *negative, PetscReal *reached)
{
  LamLoad at = *start;
  PetscReal step = 0.25;

  PetscFunctionBeginUser;
  *reached = 0.0;
  while (*reached < 1.0 && LamMayIterate(rve)) {
    const PetscReal t = PetscMin(1.0, *reached + step);
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(start, load, t);
    PetscInt switches = *branch;
    PetscBool converged = PETSC_FALSE;

    PetscCall(Step(rve, y_from, &at, &next, &switches, negative, &converged));
    if (converged && *negative == 0) {
      PetscCall(PetscArraycpy(y_from, rve->y, rve->length));
      at = next;
      *reached = t;
      *branch = switches;
      step = PetscMin(2.0 * step, 1.0);
    } else {
      step *= 0.5;
      if (step < MIN_SUBSTEP) break;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, PetscInt *branch, PetscInt *negative,
                             LamStatus *status, char reason[], size_t length)
{
  LamLoad start = state->load;
  PetscReal *from, *saddle, reached = 1.0;
  PetscInt saddle_negative, saddle_branch;
  PetscBool converged = PETSC_FALSE, is_saddle;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(rve->length, &from, rve->length, &saddle));
  PetscCall(PetscArraycpy(from, state->y, rve->length));
  LamRotatePositions(rve->ndof, from, start.F, LamRotationAngle(load->F) - LamRotationAngle(start.F));
  *branch = state->branch;
  PetscCall(Step(rve, from, &start, load, branch, negative, &converged));
  is_saddle = (PetscBool)(converged && *negative > 0);
  if (!converged || is_saddle) {
    PetscCall(PetscArraycpy(saddle, rve->y, rve->length));
    saddle_negative = *negative;
    saddle_branch = *branch;
    *branch = state->branch;
    PetscCall(Substeps(rve, from, &start, load, branch, negative, &reached));
    converged = (PetscBool)(reached >= 1.0);
    if (!converged && is_saddle) { /* the unstable state is all there is: give it, and say so */
      PetscCall(PetscArraycpy(rve->y, saddle, rve->length));
      PetscCall(LamFactorConsistent(rve, load, negative, &converged));
      *negative = saddle_negative;
      *branch = saddle_branch;
    }
  }
  PetscCall(PetscFree2(from, saddle));
  *status = converged ? (*negative > 0 ? LAM_UNSTABLE : LAM_CONVERGED) : LAM_NOT_CONVERGED;
  if (*status == LAM_UNSTABLE)
    PetscCall(PetscSNPrintf(reason, length, "only a saddle was found: %d negative eigenvalues, lowest %.3g (C1+C2)",
                            (int)*negative, (double)rve->lowest_eigenvalue));
  if (*status == LAM_NOT_CONVERGED)
    PetscCall(PetscSNPrintf(
        reason, length, "no equilibrium found beyond %.4g of the way from the state before, after %d iterations%s",
        (double)reached, (int)rve->work.iterations,
        rve->work.iterations < LAM_ITERATION_BUDGET ? " and the smallest substep" : ": give states in between"));
  PetscFunctionReturn(0);
}
