/*
  Whether a branch of contact states has ended between two loads, so that the state fell to the next minimum.

  Method. On a branch the change of Psi is the work of its derivatives, by the trapezoidal rule up to third order in the
  change of load. What a jump loses is missing:
    defect = Psi_1 - Psi_0 - 1/2 (Psi,q_0 + Psi,q_1).(q_1 - q_0) < 0,     q = (F11, F12, F21, F22, F33, p, g).
  A large defect may also come from curvature. The interval is therefore bisected, and the half with the lower defect
  kept: a defect of curvature falls at least fourfold each time, that of a jump stays.

  With a lamella the state depends on the way to it, and a jump that is not one breaks what would hold. There a
  suspicious step is taken again in halves, and these again: the state is that at the end of them.
*/
#include "solve.h"

#define FARTHEST 0.25     /* change of a component of F, turgor or cohesion (C1 + C2) beyond which nothing is said */
#define SUSPICIOUS 0.02   /* share of the work that a jump must lose to be looked for, ... */
#define LEAST_ENERGY 1e-7 /* ... and C1 + C2: below it Psi has few digits */
#define HALVINGS 4
#define STAYS 0.5 /* share of the defect that is left of a jump */

void LamKeepEnergy(const LamResponse *response, LamRVEState state)
{
  state->energy[0] = response->energy;
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) state->energy[1 + q] = response->P[LamFComponent[q]];
  state->energy[6] = response->energy_turgor;
  state->energy[7] = response->energy_cohesion;
}

/* Change of q from one load to another; returns the largest component. */
static PetscReal Change(const LamLoad *from, const LamLoad *to, PetscReal dq[7])
{
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) dq[q] = to->F[LamFComponent[q]] - from->F[LamFComponent[q]];
  dq[5] = to->turgor - from->turgor;
  dq[6] = to->cohesion - from->cohesion;
  return LamLargestEntry(7, dq);
}

/* NaN: unknown. work: sum of the absolute values of its parts. */
static PetscReal Defect(const LamRVEState from, const LamRVEState to, PetscReal *work)
{
  PetscReal dq[7], defect = to->energy[0] - from->energy[0];

  *work = 0.0;
  (void)Change(&from->load, &to->load, dq);
  for (PetscInt k = 0; k < 7; ++k) {
    const PetscReal part = 0.5 * (from->energy[1 + k] + to->energy[1 + k]) * dq[k];

    defect -= part;
    *work += PetscAbsReal(0.5 * (to->energy[1 + k] - from->energy[1 + k]) * dq[k]);
  }
  return from->width == to->width || from->points ? defect : NAN;
}

static PetscBool IsSuspicious(PetscReal defect, PetscReal work)
{
  return (PetscBool)(defect < -PetscMax(LEAST_ENERGY, SUSPICIOUS * work));
}

/* Bisects between `low` and `high`; defect: in, of the interval; out, of the last half; NaN: a state was not found. */
static PetscErrorCode Bisect(LamRVE rve, LamRVEState low, LamRVEState high, PetscReal *defect)
{
  LamRVEState middle;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &middle));
  for (PetscInt k = 0; k < HALVINGS; ++k) {
    const LamLoad load = LamLoadBetween(&low->load, &high->load, 0.5);
    const LamWork work = rve->work;
    PetscReal halves[2], unused;
    LamResponse response;

    PetscCall(LamRVEStateCopy(low, middle));
    PetscCall(LamRVESolve(rve, &load, middle, &response));
    rve->work.iterations += work.iterations;
    rve->work.factorisations += work.factorisations;
    *defect = NAN;
    if (response.status != LAM_CONVERGED) break;
    halves[0] = Defect(low, middle, &unused);
    halves[1] = Defect(middle, high, &unused);
    *defect = PetscMin(halves[0], halves[1]);
    PetscCall(LamRVEStateCopy(middle, halves[0] < halves[1] ? high : low));
  }
  PetscCall(LamRVEStateDestroy(&middle));
  PetscFunctionReturn(0);
}

/* Replaces a state of the exact law by that of the smooth law in use at its load. */
static PetscErrorCode MakeSmooth(LamRVE rve, LamRVEState state)
{
  const LamLoad load = state->load;
  LamResponse response;

  PetscFunctionBeginUser;
  if (state->width == 0.0) PetscCall(LamRVESolve(rve, &load, state, &response));
  PetscFunctionReturn(0);
}

/* Energies of different laws do not compare: if one state is of the smooth law, both are to be. */
static PetscErrorCode Look(LamRVE rve, LamRVEState low, LamRVEState high, PetscReal *defect, PetscReal *left)
{
  const LamSharpness sharpness = rve->micro.sharpness;
  const PetscReal asked = rve->micro.contact_width, width = PetscMax(low->width, high->width);
  PetscReal work;

  PetscFunctionBeginUser;
  if (width > 0.0) {
    rve->micro.sharpness = LAM_SHARPNESS_SMOOTH;
    rve->micro.contact_width = width;
    PetscCall(MakeSmooth(rve, low));
    PetscCall(MakeSmooth(rve, high));
  }
  *left = *defect = Defect(low, high, &work);
  if (IsSuspicious(*defect, work)) PetscCall(Bisect(rve, low, high, left));
  rve->micro.sharpness = sharpness;
  rve->micro.contact_width = asked;
  PetscFunctionReturn(0);
}

typedef struct {
  PetscReal first; /* defect of the whole step */
  PetscReal lost;  /* in jumps */
  PetscInt iterations, factorisations;
  LamResponse response; /* of the last state */
} Retracing;

/* Takes the step from `at` to a load, in halves while it is suspicious; on return `at` is the state there. */
static PetscErrorCode Retrace(LamRVE rve, LamRVEState at, const LamLoad *load, PetscInt halvings, Retracing *r)
{
  const LamLoad start = at->load;
  PetscReal defect, work;
  LamRVEState end;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &end));
  PetscCall(LamRVEStateCopy(at, end));
  PetscCall(LamRVESolve(rve, load, end, &r->response));
  r->iterations += r->response.newton_iterations;
  r->factorisations += r->response.factorisations;
  defect = r->response.status == LAM_CONVERGED ? Defect(at, end, &work) : NAN;
  if (IsSuspicious(defect, work) && halvings > 0) {
    const LamLoad middle = LamLoadBetween(&start, load, 0.5);

    PetscCall(Retrace(rve, at, &middle, halvings - 1, r));
    if (r->response.status == LAM_CONVERGED) PetscCall(Retrace(rve, at, load, halvings - 1, r));
  } else if (r->response.status == LAM_CONVERGED) {
    if (defect < STAYS * r->first) r->lost -= defect;
    PetscCall(LamRVEStateCopy(end, at));
  }
  PetscCall(LamRVEStateDestroy(&end));
  PetscFunctionReturn(0);
}

/* Replaces a suspicious state of tissue with a lamella, and its response. */
static PetscErrorCode RetraceStep(LamRVE rve, LamRVEState before, LamRVEState state, LamResponse *response)
{
  const LamLoad middle = LamLoadBetween(&before->load, &state->load, 0.5);
  const LamWork work = rve->work;
  Retracing r = {.iterations = response->newton_iterations, .factorisations = response->factorisations};
  PetscReal unused;

  PetscFunctionBeginUser;
  r.first = Defect(before, state, &unused);
  PetscCall(Retrace(rve, before, &middle, HALVINGS - 1, &r));
  if (r.response.status == LAM_CONVERGED) PetscCall(Retrace(rve, before, &state->load, HALVINGS - 1, &r));
  if (r.response.status == LAM_CONVERGED) {
    PetscCall(LamRVEStateCopy(before, state));
    *response = r.response;
  } else {
    PetscCall(LamTakeState(rve, state));
    r.lost = -r.first;
  }
  rve->work.stopped = (PetscBool)(rve->work.stopped || work.stopped);
  response->newton_iterations = r.iterations;
  response->factorisations = r.factorisations;
  response->jumped = (PetscBool)(r.lost > LEAST_ENERGY);
  if (!response->jumped) PetscFunctionReturn(0);
  response->energy_released = r.lost;
  state->released += r.lost * rve->mesh.V0;
  response->released = state->released / rve->mesh.V0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamSeeJump(LamRVE rve, LamRVEState before, LamRVEState state, LamResponse *response)
{
  PetscReal dq[7], work, defect = 0.0, left = 0.0;
  LamRVEState high;

  PetscFunctionBeginUser;
  if (response->status != LAM_CONVERGED || rve->work.stopped) PetscFunctionReturn(0);
  if (Change(&before->load, &state->load, dq) > FARTHEST) PetscFunctionReturn(0);
  defect = Defect(before, state, &work);
  if (before->width == state->width && !IsSuspicious(defect, work)) PetscFunctionReturn(0);
  if (rve->layer) {
    rve->looks_back = PETSC_TRUE;
    if (IsSuspicious(defect, work)) PetscCall(RetraceStep(rve, before, state, response));
    rve->looks_back = PETSC_FALSE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamRVEStateCreate(rve, &high));
  PetscCall(LamRVEStateCopy(state, high));
  rve->looks_back = PETSC_TRUE;
  PetscCall(Look(rve, before, high, &defect, &left));
  rve->looks_back = PETSC_FALSE;
  PetscCall(LamRVEStateDestroy(&high));
  if (defect < 0.0 && left <= STAYS * defect && left < -LEAST_ENERGY) {
    response->jumped = PETSC_TRUE;
    response->energy_released = -left;
  }
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  contact: energy defect %g, after bisection %g\n",
                           (double)defect, (double)left));
  response->newton_iterations = rve->work.iterations;
  response->factorisations = rve->work.factorisations;
  PetscCall(LamTakeState(rve, state));
  PetscFunctionReturn(0);
}
