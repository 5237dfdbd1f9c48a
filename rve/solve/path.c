/*
  Equilibrium at a new load, by continuation from a known state.

  Method. (i) The state is rotated rigidly to the rotation of the new F and moved affinely by the rest of the change of
  F. (ii) Full Newton steps, and if they fail minimisation of the energy (minimise.c), at the full load. (iii) If that
  fails, the same in substeps along the straight line in (F, turgor), halved on failure and doubled on success. (iv) A
  converged state with negative eigenvalues is a saddle: it is left along its unstable mode, downhill, to a stable
  branch. (v) The reason for the end of a path is bracketed: a lumen that closes, or walls that lose ellipticity, which
  no mesh resolves.
*/
#include "contact_find.h"

#define MIN_SUBSTEP (1.0 / 512.0)
#define MAX_BRANCH_SWITCHES 6
#define MAX_CONTACT_SWITCHES 4
#define KICK 0.02         /* apothems: perturbation along an unstable mode, ... */
#define CONTACT_KICK 0.01 /* ... of contact tissue */

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

PetscErrorCode LamTurnedState(LamRVE rve, LamRVEState state, const LamLoad *load, LamRVEState *turned)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, turned));
  PetscCall(LamRVEStateCopy(state, *turned));
  LamRotatePositions(rve->ndof, (*turned)->y, (*turned)->load.F,
                     LamRotationAngle(load->F) - LamRotationAngle(state->load.F));
  PetscFunctionReturn(0);
}

void LamMoveAffinely(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to)
{
  const PetscReal *A = load_from->F, *B = load_to->F;

  rve->moved = PETSC_FALSE;
  for (PetscInt i = 0; i < 9; ++i) rve->moved = (PetscBool)(rve->moved || A[i] != B[i]);
  (void)LamSetConsistentStresses(rve, load_from, from);
  for (PetscInt c = 0; c < rve->mesh.class_count; ++c) {
    const PetscReal *X = &rve->mesh.class_X[2 * c];

    rve->y[2 * c] = from[2 * c] + (B[0] - A[0]) * X[0] + (B[1] - A[1]) * X[1];
    rve->y[2 * c + 1] = from[2 * c + 1] + (B[3] - A[3]) * X[0] + (B[4] - A[4]) * X[1];
  }
  for (PetscInt i = rve->ndof; i < rve->length; ++i) rve->y[i] = from[i];
}

PetscErrorCode LamLeaveSaddles(LamRVE rve, const LamLoad *load, PetscInt *branch, PetscInt *negative, PetscBool *ok)
{
  const PetscReal kick = rve->contact ? CONTACT_KICK : KICK;
  LamRVEState saddle;
  PetscReal *mode;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, load, negative, ok));
  if (!*ok || *negative <= 0) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(rve->linear->n, &mode));
  PetscCall(LamRVEStateCreate(rve, &saddle));
  for (PetscInt k = 0; k < (rve->contact ? MAX_CONTACT_SWITCHES : MAX_BRANCH_SWITCHES) && *ok && *negative > 0; ++k) {
    LamNewtonOutcome outcome;
    PetscReal moved = 0.0;

    LamKeepState(rve, load, 0, saddle);
    PetscCall(LamSoftestMode(rve, &rve->lowest_eigenvalue, mode));
    if (rve->monitor)
      PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                             "  saddle: %d negative eigenvalues, lowest %.3e; leaving it\n", (int)*negative,
                             (double)rve->lowest_eigenvalue));
    LamAddMode(rve, kick / LamLargestEntry(rve->linear->positions, mode), mode, rve->y);
    (void)LamSetConsistentStresses(rve, load, rve->y);
    PetscCall(LamMinimise(rve, load, NULL, LamNewtonTolerance(rve), &outcome));
    for (PetscInt i = 0; i < rve->ndof; ++i) moved = PetscMax(moved, PetscAbsReal(rve->y[i] - saddle->y[i]));
    if (outcome == LAM_NEWTON_CONVERGED && moved > 0.1 * kick) {
      ++*branch;
      PetscCall(LamFactorConsistent(rve, load, negative, ok));
    } else {
      PetscCall(LamTakeState(rve, saddle));
      PetscCall(LamFactorConsistent(rve, load, negative, ok));
      break;
    }
  }
  PetscCall(PetscFree(mode));
  PetscCall(LamRVEStateDestroy(&saddle));
  PetscFunctionReturn(0);
}

/* Result of a step. */
typedef struct {
  PetscBool converged;
  PetscInt negative;  /* eigenvalues; > 0: a saddle */
  PetscInt collapsed; /* cell whose lumen has closed, so that the solution is rejected; -1: none */
} Outcome;

static PetscBool IsStable(const Outcome *out)
{
  return (PetscBool)(out->converged && out->negative == 0 && out->collapsed < 0);
}

/* One step from (from, load_from) to load_to; the solution is in rve->y. branch counts saddles left. */
static PetscErrorCode Step(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to,
                           PetscInt *branch, Outcome *out)
{
  const PetscInt escapes = rve->work.escapes;
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  *out = (Outcome){.collapsed = -1};
  LamMoveAffinely(rve, from, load_from, load_to);
  PetscCall(LamNewtonFast(rve, load_to, NULL, &outcome));
  if (outcome == LAM_NEWTON_STALLED) LamMoveAffinely(rve, from, load_from, load_to);
  if (outcome != LAM_NEWTON_CONVERGED) PetscCall(LamMinimise(rve, load_to, NULL, LamNewtonTolerance(rve), &outcome));
  if (rve->work.escapes > escapes) ++*branch;
  if (outcome != LAM_NEWTON_CONVERGED) PetscFunctionReturn(0);
  PetscCall(LamLeaveSaddles(rve, load_to, branch, &out->negative, &out->converged));
  if (out->converged) PetscCall(LamFindCollapsedLumen(rve, rve->y, &out->collapsed));
  PetscFunctionReturn(0);
}

/* Substeps along a straight load path. */
typedef struct {
  PetscReal between[2]; /* path parameters of the last stable state and of the next failure */
  PetscInt branch;
  Outcome end; /* of the last step tried */
  LamKinking kinking;
} Continuation;

static PetscReal LeastStep(const Continuation *path)
{
  return LamIsKinking(&path->kinking) ? LAM_KINKED_SUBSTEP : MIN_SUBSTEP;
}

/* Continuation from `start` to `load`; y_from: in, positions at `start`; out, the last stable ones. */
static PetscErrorCode Substeps(LamRVE rve, PetscReal y_from[], const LamLoad *start, const LamLoad *load,
                               Continuation *path)
{
  LamLoad at = *start;
  PetscReal step = 0.25;

  PetscFunctionBeginUser;
  LamWatchKinks(rve, start, y_from, 0.0, &path->kinking);
  while (path->between[0] < 1.0 && step >= LeastStep(path) && LamMayIterate(rve)) {
    const PetscReal t = PetscMin(1.0, path->between[0] + step);
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(start, load, t);
    PetscInt branch = path->branch;

    PetscCall(Step(rve, y_from, &at, &next, &branch, &path->end));
    if (IsStable(&path->end)) {
      PetscCall(PetscArraycpy(y_from, rve->y, rve->length));
      at = next;
      path->between[0] = t;
      path->branch = branch;
      LamWatchKinks(rve, &next, y_from, t, &path->kinking);
      step = PetscMin(2.0 * step, 1.0);
    } else {
      path->between[1] = t;
      step *= 0.5;
    }
  }
  PetscFunctionReturn(0);
}

/* Status and reason if the path ends before the load. */
static PetscErrorCode EndOfPath(LamRVE rve, const Continuation *path, LamResponse *response)
{
  const PetscBool out_of_work = (PetscBool)(rve->work.iterations >= rve->budget);

  PetscFunctionBeginUser;
  if (path->end.collapsed >= 0 && !out_of_work)
    PetscCall(LamRefuseCollapse(path->end.collapsed, path->between, LAM_NO_EQUILIBRIUM, response));
  else if (LamIsKinking(&path->kinking))
    PetscCall(LamRefuseKinks(&path->kinking, path->between[0], LAM_NO_EQUILIBRIUM, response));
  else
    PetscCall(LamRefuse(response, LAM_NOT_CONVERGED,
                        "no equilibrium found beyond %.4g of the way from the state before, after %d iterations%s",
                        (double)path->between[0], (int)rve->work.iterations,
                        out_of_work ? ": give states in between" : " and the smallest substep"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRefuseSaddle(LamRVE rve, PetscInt negative, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRefuse(response, LAM_UNSTABLE, "only a saddle was found: %d negative eigenvalues, lowest %.3g (C1+C2)",
                      (int)negative, (double)rve->lowest_eigenvalue));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  LamRVEState from;
  PetscReal *saddle;
  Continuation path = {.branch = state->branch, .kinking = LAM_NO_KINKING};
  Outcome out;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rve->length, &saddle));
  PetscCall(LamTurnedState(rve, state, load, &from));
  response->branch = state->branch;
  PetscCall(Step(rve, from->y, &from->load, load, &response->branch, &out));
  if (!IsStable(&out)) {
    PetscCall(PetscArraycpy(saddle, rve->y, rve->length));
    PetscCall(Substeps(rve, from->y, &from->load, load, &path));
    if (path.between[0] >= 1.0) {
      out = path.end;
      response->branch = path.branch;
    } else if (out.converged && out.collapsed < 0) { /* no stable state: return the unstable one */
      PetscInt again;

      PetscCall(PetscArraycpy(rve->y, saddle, rve->length));
      PetscCall(LamFactorConsistent(rve, load, &again, &out.converged));
    }
  }
  PetscCall(LamRVEStateDestroy(&from));
  PetscCall(PetscFree(saddle));
  response->negative_eigenvalues = out.negative;
  if (!out.converged || out.collapsed >= 0) {
    PetscCall(EndOfPath(rve, &path, response));
    PetscFunctionReturn(0);
  }
  response->status = LAM_CONVERGED;
  if (out.negative > 0) PetscCall(LamRefuseSaddle(rve, out.negative, response));
  PetscFunctionReturn(0);
}
