#include "digits.h"
#include "tissue.h"

static int DigitsSolve(void *ctx, const double rhs[], double solution[])
{
  return (int)LamLinearSolve(((LamRVE)ctx)->linear, 1, rhs, solution);
}

static ExtendedCase DigitsCase(const LamMicrostructure *micro, const LamLoad *load)
{
  ExtendedCase c = {.thickness = micro->wall_thickness,
                    .orientation = micro->orientation,
                    .grading = micro->grading,
                    .clearance = micro->clearance,
                    .cells = {(int)micro->cells[0], (int)micro->cells[1]},
                    .along = (int)micro->along,
                    .through = (int)micro->through,
                    .law = (int)micro->wall.law,
                    .fibres = (int)micro->wall.fibres,
                    .contact = micro->interface == LAM_INTERFACE_CONTACT,
                    .bulk_modulus = micro->wall.bulk_modulus,
                    .turgor = load->turgor,
                    .cohesion = load->cohesion};

  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; ++k) c.parameter[k] = LamWallGet(&micro->wall, k);
  for (PetscInt i = 0; i < 9; ++i) c.F[i] = load->F[i];
  return c;
}

/* Relative error over the entries that both have. */
static double DigitsError(PetscInt n, const double a[], const double b[])
{
  double error = 0, size = 0;

  for (PetscInt i = 0; i < n; ++i) {
    if (PetscIsInfOrNanReal(a[i]) || PetscIsInfOrNanReal(b[i])) continue;
    error += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return PetscSqrtReal(error / PetscMax(size, PETSC_MIN_REAL));
}

/* The extended answer from the state in rve, and how far the response is from it. */
static PetscErrorCode DigitsCompare(LamRVE rve, const LamResponse *response, LamRVEState state, Extended solve,
                                    Digits *digits)
{
  const LamLoad *load = &response->load;
  const ExtendedCase c = DigitsCase(&rve->micro, load);
  ExtendedAnswer answer;
  PetscInt negative;
  int *active = NULL;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(state->multipliers, &active));
  for (PetscInt h = 0; h < state->multipliers; ++h) active[h] = rve->contact->active[h];
  PetscCall(LamFactorConsistent(rve, load, &negative, &ok));
  PetscCall((PetscErrorCode)solve(
      &c, &(ExtendedStart){state->y, state->lambda, (const int(*)[2])state->hats, active, DigitsSolve, rve},
      (rve->wanted & LAM_WANT_DERIVATIVES) != 0, &answer));
  PetscCall(PetscFree(active));
  digits->P = DigitsError(9, response->P, answer.P);
  digits->energy = DigitsError(1, &response->energy, &answer.energy);
  digits->lumen = DigitsError(1, &response->lumen_fraction, &answer.lumen);
  digits->opening = PetscAbsReal(response->opening_fraction - answer.opening);
  digits->tangent = DigitsError(81, response->tangent, answer.tangent);
  digits->size = 0;
  for (PetscInt i = 0; i < 9; ++i) digits->size += PetscSqr(answer.P[i]);
  digits->size = PetscSqrtReal(digits->size);
  digits->moved = answer.moved;
  digits->residual = answer.rounding;
  digits->left = answer.residual;
  digits->iterations = answer.iterations;
  PetscFunctionReturn(0);
}

PetscErrorCode DigitsMeasure(const LamMicrostructure *micro, const LamLoad *load, PetscInt steps, LamWanted wanted,
                             Extended solve, Digits *digits)
{
  const LamLoad zero = PlaneLoad(1, 0, 0, 1, load->turgor);
  LamRVE rve;
  LamRVEState state;
  LamResponse response;

  PetscFunctionBeginUser;
  *digits = (Digits){0};
  PetscCall(NewTissue(micro, &rve, NULL));
  PetscCall(LamRVESetWanted(rve, wanted));
  PetscCall(LamRVEStateCreate(rve, &state));
  for (PetscInt k = 1; k <= steps; ++k) {
    LamLoad part = k == steps ? *load : LamLoadBetween(&zero, load, (PetscReal)k / (PetscReal)steps);

    part.cohesion = load->cohesion;
    PetscCall(LamRVESolve(rve, &part, state, &response));
    if (response.status != LAM_CONVERGED) break;
  }
  digits->status = response.status;
  digits->unknowns = rve->linear->n;
  digits->tolerance = LamNewtonTolerance(rve);
  if (response.status == LAM_CONVERGED) PetscCall(DigitsCompare(rve, &response, state, solve, digits));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}
