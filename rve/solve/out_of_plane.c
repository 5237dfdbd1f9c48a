/*
  Equilibrium at any F: the third component of positions.

  Method. Psi(QF) = Psi(F), so F is turned until the third axis of the frame is that of the cells, F_13 = F_23 = 0:
  what is left are the section, G = (F_31, F_32) and z (antiplane.h). Energy as a function of z alone, with the
  positions in the section at their equilibrium, has the gradient L_z and the second derivative S = L_zz - L_zy K^-1
  L_yz. Newton's method on it: each iteration solves for the section at fixed z, from the state of the one before, as if
  there were no third component (path.c, contact_path.c), and S dz = -L_z by conjugate gradients. Where that fails the
  load is approached in steps, which are halved. Loads, states and responses of all other functions are those of the
  turned frame; only LamRVESolve turns.
*/
#include "antiplane.h"
#include "solve.h"

#define MOST_ITERATIONS 25      /* of a load; four to six are usual, and of more a shorter way is better */
#define LEAST_STEP (1.0 / 64.0) /* of the way to the load, chosen: the section itself is continued in finer steps */

PetscBool LamIsOutOfPlane(LamRVE rve, const LamLoad *load, const LamRVEState state)
{
  PetscBool any = (PetscBool)(load->F[6] != 0.0 || load->F[7] != 0.0);

  if (!rve->antiplane) return PETSC_FALSE;
  for (PetscInt c = 0; c < state->axial && !any; ++c) any = (PetscBool)(state->z[c] != 0.0);
  return (PetscBool)(any || LamWallsTilt(&rve->micro));
}

/* Sets z and G: of a state, and moved affinely to the G of a load. */
static void StartFrom(LamRVE rve, const LamRVEState state, const LamLoad *load)
{
  LamAntiplane t = rve->antiplane;
  const PetscReal *X = rve->mesh.class_X;

  for (PetscInt l = 0; l < 2; ++l) t->G[l] = load->F[6 + l];
  for (PetscInt c = 0; c < t->classes; ++c) {
    t->z[c] = state->z[c];
    for (PetscInt l = 0; l < 2; ++l) t->z[c] += (load->F[6 + l] - state->load.F[6 + l]) * (X[2 * c + l] - X[l]);
  }
  LamAntiplaneUse(rve);
}

void LamTakeAxial(LamRVE rve, const LamRVEState state)
{
  if (rve->antiplane) StartFrom(rve, state, &state->load);
}

void LamKeepAxial(LamRVE rve, LamRVEState state)
{
  for (PetscInt c = 0; c < state->axial; ++c) state->z[c] = rve->antiplane->z[c];
}

/* The section at fixed z, from `at`, which becomes its solution. */
static PetscErrorCode SolveSection(LamRVE rve, const LamLoad *load, LamRVEState start, LamRVEState at,
                                   LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(rve->contact ? LamContactFollowPath(rve, load, at, response) : LamFollowPath(rve, load, at, response));
  if (response->status != LAM_CONVERGED) PetscFunctionReturn(0);
  LamKeepState(rve, load, response->branch, at);
  if (rve->layer) PetscCall(LamCopyHistory(start, at)); /* that of the start of the step */
  PetscFunctionReturn(0);
}

/* One load, from `at`, which becomes its solution; start: with the history at the start of the step. */
static PetscErrorCode SolveLoad(LamRVE rve, const LamLoad *load, LamRVEState start, LamRVEState at,
                                LamResponse *response)
{
  LamAntiplane t = rve->antiplane;
  const PetscReal tolerance = LamNewtonTolerance(rve);
  PetscReal *step, before = PETSC_INFINITY;
  PetscBool convex, stable = PETSC_FALSE, done = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(t->classes, &step));
  StartFrom(rve, at, load);
  for (PetscInt it = 0; it < MOST_ITERATIONS && !done; ++it) {
    PetscReal norm = 0.0;

    PetscCall(SolveSection(rve, load, start, at, response));
    if (response->status != LAM_CONVERGED) break;
    PetscCall(LamAntiplaneAssemble(rve, load, &convex));
    for (PetscInt c = 1; c < t->classes; ++c) norm += t->f[c] * t->f[c];
    norm = PetscSqrtReal(norm);
    if (rve->monitor)
      PetscCall(
          PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  out of plane %2d  residual %10.3e\n", (int)it, (double)norm));
    if (convex) PetscCall(LamAntiplaneSolve(rve, t->f, step, &stable));
    done = (PetscBool)(convex && stable &&
                       (norm <= tolerance || (norm >= 0.5 * before && norm <= LAM_ROUNDING_MARGIN * tolerance)));
    if (done || !convex || !stable) break;
    before = norm;
    for (PetscInt c = 1; c < t->classes; ++c) t->z[c] -= step[c];
    LamAntiplaneUse(rve);
  }
  if (response->status == LAM_CONVERGED && !done)
    PetscCall(stable ? LamRefuse(response, LAM_NOT_CONVERGED, "the displacements along the cells did not converge")
                     : LamRefuse(response, LAM_NOT_CONVERGED, "no state found that is stable along the cells"));
  PetscCall(PetscFree(step));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSolveOutOfPlane(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  const LamLoad first = state->load;
  PetscReal reached = 0.0, step = 1.0;
  LamRVEState at, last;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &at));
  PetscCall(LamRVEStateCreate(rve, &last));
  PetscCall(LamRVEStateCopy(state, last));
  while (reached < 1.0 && step >= LEAST_STEP && LamMayIterate(rve)) {
    const PetscReal t = PetscMin(1.0, reached + step);
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(&first, load, t);

    PetscCall(LamRVEStateCopy(last, at));
    response->status = LAM_NOT_CONVERGED;
    response->reason[0] = '\0';
    PetscCall(SolveLoad(rve, &next, state, at, response));
    if (response->status == LAM_CONVERGED) {
      PetscCall(LamRVEStateCopy(at, last));
      reached = t;
    } else {
      step *= 0.5;
    }
  }
  PetscCall(LamRVEStateDestroy(&last));
  PetscCall(LamRVEStateDestroy(&at));
  PetscFunctionReturn(0);
}
