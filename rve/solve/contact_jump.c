/*
  Whether a branch of contact states has ended between two loads, so that the state fell to the next minimum.

  Method. On a branch the change of Psi is the work of its derivatives, by the trapezoidal rule up to third order in the
  change of load. What a jump loses is missing:
    defect = Psi_1 - Psi_0 - 1/2 (Psi,q_0 + Psi,q_1).(q_1 - q_0) < 0,     q = (F11, F12, F21, F22, F33, p, g, F31, F32).
  A large defect may also come from curvature. The interval is therefore bisected, and the half with the lower defect
  kept: a defect of curvature falls at least fourfold each time, that of a jump stays.
*/
#include "solve.h"

#define FARTHEST 0.25   /* change of a component of F, turgor or cohesion (C1 + C2) beyond which nothing is said */
#define SUSPICIOUS 0.02 /* share of the work that a jump must lose to be looked for, ... */
#define HALVINGS 4
#define STAYS 0.5 /* share of the defect that is left of a jump */

void LamKeepEnergy(const LamResponse *response, LamRVEState state)
{
  state->energy[0] = state->pairs ? response->stored + response->dissipated : response->energy;
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) state->energy[1 + q] = response->P[LamFComponent[q]];
  state->energy[6] = response->energy_turgor;
  state->energy[7] = response->energy_cohesion;
  for (PetscInt l = 0; l < 2; ++l) state->energy[8 + l] = state->axial ? response->P[6 + l] : 0.0;
}

/* Change of q from one load to another; returns the largest component. */
static PetscReal Change(const LamLoad *from, const LamLoad *to, PetscReal dq[9])
{
  for (PetscInt q = 0; q < LAM_F_COUNT; ++q) dq[q] = to->F[LamFComponent[q]] - from->F[LamFComponent[q]];
  dq[5] = to->turgor - from->turgor;
  dq[6] = to->cohesion - from->cohesion;
  for (PetscInt l = 0; l < 2; ++l) dq[7 + l] = to->F[6 + l] - from->F[6 + l];
  return LamLargestEntry(9, dq);
}

LamStepWork LamStepWorkOf(const LamRVEState from, const LamRVEState to)
{
  LamStepWork step = {0};
  PetscReal dq[9];

  step.largest = Change(&from->load, &to->load, dq);
  for (PetscInt k = 0; k < 9; ++k) {
    step.work += 0.5 * (from->energy[1 + k] + to->energy[1 + k]) * dq[k];
    step.turnover += PetscAbsReal(0.5 * (to->energy[1 + k] - from->energy[1 + k]) * dq[k]);
  }
  step.work += to->work - from->work; /* of fluid from cells that have burst */
  step.defect = to->energy[0] - from->energy[0] - step.work;
  return step;
}

/* NaN: energies of different laws do not compare. */
static PetscReal Defect(const LamRVEState from, const LamRVEState to)
{
  return from->width == to->width ? LamStepWorkOf(from, to).defect : NAN;
}

static PetscBool IsSuspicious(const LamStepWork *step)
{
  return (PetscBool)(step->defect < -PetscMax(LAM_LEAST_LOSS, SUSPICIOUS * step->turnover));
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
    PetscReal halves[2];
    LamResponse response;

    PetscCall(LamRVEStateCopy(low, middle));
    PetscCall(LamRVESolve(rve, &load, middle, &response));
    rve->work.iterations += work.iterations;
    rve->work.factorisations += work.factorisations;
    *defect = NAN;
    if (response.status != LAM_CONVERGED) break;
    halves[0] = Defect(low, middle);
    halves[1] = Defect(middle, high);
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
  LamStepWork step;

  PetscFunctionBeginUser;
  if (width > 0.0) {
    rve->micro.sharpness = LAM_SHARPNESS_SMOOTH;
    rve->micro.contact_width = width;
    PetscCall(MakeSmooth(rve, low));
    PetscCall(MakeSmooth(rve, high));
  }
  step = LamStepWorkOf(low, high);
  *left = *defect = step.defect;
  if (IsSuspicious(&step)) PetscCall(Bisect(rve, low, high, left));
  rve->micro.sharpness = sharpness;
  rve->micro.contact_width = asked;
  PetscFunctionReturn(0);
}

PetscErrorCode LamSeeJump(LamRVE rve, LamRVEState before, LamRVEState state, LamResponse *response)
{
  const LamStepWork step = LamStepWorkOf(before, state);
  PetscReal defect = 0.0, left = 0.0;
  LamRVEState high;

  PetscFunctionBeginUser;
  if (response->status != LAM_CONVERGED || rve->work.stopped) PetscFunctionReturn(0);
  if (step.largest > FARTHEST) PetscFunctionReturn(0);
  if (before->width == state->width && !IsSuspicious(&step)) PetscFunctionReturn(0);
  PetscCall(LamRVEStateCreate(rve, &high));
  PetscCall(LamRVEStateCopy(state, high));
  rve->looks_back = PETSC_TRUE;
  PetscCall(Look(rve, before, high, &defect, &left));
  rve->looks_back = PETSC_FALSE;
  PetscCall(LamRVEStateDestroy(&high));
  if (defect < 0.0 && left <= STAYS * defect && left < -LAM_LEAST_LOSS) {
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
