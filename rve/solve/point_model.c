#include "point_model.h"
#include <lamella/ellipticity.h>
#include "expansion.h"
#include "solve.h"
#include <math.h>
#include <string.h>

/* Of the sum of the tractions' errors, and of the square of the distance: chosen from the measured medians, 0.13 and
   45, so that early steps, cheap and of small reactions, are the more accurate (docs/theory/lamella.md, Models of
   material points). */
static const PetscReal BRANCH_SHARE = 0.15, FIRST_CURVATURE = 75;
static const PetscReal LEAST_CURVATURE = 40, MOST_CURVATURE = 1000;
static const PetscReal JUMPED_CURVATURE = 200; /* at least, behind a jump: its branch begins near an end */
/* What one solve changes the curvature by at most; the exponent with which it falls, for what errs seldom errs much. */
static const PetscReal MOST_LEARNT = 4, FORGETS = 0.25;

PetscErrorCode LamPointModelCreate(LamRVE rve, LamPointModel *model)
{
  const PetscInt count = rve->layer->count;

  PetscFunctionBeginUser;
  *model = (LamPointModel){.curvature = FIRST_CURVATURE};
  PetscCall(PetscCalloc2(count, &model->bond, count, &model->history));
  for (PetscInt p = 0; p < count; ++p) model->history[p] = LAM_UNDAMAGED;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPointModelDestroy(LamPointModel *model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(model->bond, model->history));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPointModelTake(LamRVE rve, const LamResponse *response, LamPointModel *model)
{
  const LamBondRates *rates = rve->rates;
  LamExpansion expansion;

  PetscFunctionBeginUser;
  model->known =
      (PetscBool)(response->status == LAM_CONVERGED && !memcmp(&rates->load, &response->load, sizeof(LamLoad)) &&
                  LamExpansionMake(response, PETSC_FALSE, &expansion));
  if (!model->known) PetscFunctionReturn(0);
  model->response = *response;
  if (response->jumped) model->curvature = PetscMax(model->curvature, JUMPED_CURVATURE);
  model->spent = rates->spent;
  PetscCall(PetscArraycpy(model->bond, rates->bond, rve->layer->count));
  PetscCall(PetscArraycpy(model->history, rates->before, rve->layer->count));
  PetscFunctionReturn(0);
}

void LamPointModelLearn(const LamModelError *error, PetscReal actual, PetscReal *curvature)
{
  const PetscReal least_distance2 = 1e-8; /* below it rounding and the tolerance of solves count */
  PetscReal ratio;

  if (error->distance2 < least_distance2) return;
  ratio = actual / (error->branch + error->smooth);
  ratio = PetscMin(PetscMax(ratio, 1.0 / MOST_LEARNT), MOST_LEARNT);
  *curvature *= ratio > 1.0 ? ratio : PetscPowReal(ratio, FORGETS);
  *curvature = PetscMin(PetscMax(*curvature, LEAST_CURVATURE), MOST_CURVATURE);
}

/* Change of F11, F12, F21, F22, p, where F is turned as the solve was. */
static void FindChange(const LamLoad *from, const LamLoad *to, PetscReal change[LAM_BOND_RATES])
{
  const PetscInt component[4] = {0, 1, 3, 4};
  LamLoad turned = *to;

  LamRotatePositions(0, NULL, turned.F, LamRotationAngle(from->F) - LamRotationAngle(to->F));
  for (PetscInt q = 0; q < 4; ++q) change[q] = turned.F[component[q]] - from->F[component[q]];
  change[4] = to->turgor - from->turgor;
}

/* As of records (docs/theory/database.md, Scattered records). */
static PetscReal Distance2(const LamExpansion *from, const LamExpansion *to)
{
  PetscReal sum = 0.0;

  for (PetscInt a = 0; a < 3; ++a) sum += 0.25 * PetscSqr(to->x[a] - from->x[a]);
  return sum + PetscSqr(LAM_TURGOR_WEIGHT * (to->x[3] - from->x[3])) +
         PetscSqr(LAM_SUCTION_WEIGHT * (to->x[3] + to->x[4] - from->x[3] - from->x[4]));
}

/* Work of P, turgor and suction from the solve, by the trapezoidal rule, as LamStepWorkOf. */
static PetscReal WorkBetween(const LamResponse *from, const LamResponse *to)
{
  PetscReal work = 0.5 * (from->energy_turgor + to->energy_turgor) * (to->load.turgor - from->load.turgor) +
                   0.5 * (from->energy_cohesion + to->energy_cohesion) * (to->load.cohesion - from->load.cohesion);

  for (PetscInt i = 0; i < 9; ++i) work += 0.5 * (from->P[i] + to->P[i]) * (to->load.F[i] - from->load.F[i]);
  return work;
}

static PetscReal Scaled(PetscReal value, const LamLoad *from, const LamLoad *to)
{
  return from->turgor == to->turgor ? value : from->turgor != 0.0 ? value * to->turgor / from->turgor : NAN;
}

/* Completes a response by what is no derivative of the energy. */
static void Fill(LamRVE rve, const LamResponse *solve, const LamLayerPrediction *layer, PetscReal spent, LamResponse *r)
{
  const PetscReal same = 1e-10;

  LamResponseFindBand(r);
  r->lumen_fraction =
      PetscAbsReal(solve->lumen_fraction + solve->energy_turgor) <= same ? -r->energy_turgor : (PetscReal)NAN;
  r->opening_fraction = PetscAbsReal(solve->opening_fraction - solve->energy_cohesion) <= same
                            ? PetscMax(0.0, r->energy_cohesion)
                            : (PetscReal)NAN;
  r->turgor_mean = Scaled(solve->turgor_mean, &solve->load, &r->load);
  r->turgor_spread = Scaled(solve->turgor_spread, &solve->load, &r->load);
  LamDamageFill(&layer->damage, r);
  r->dissipated = spent + layer->damage.dissipated / rve->mesh.V0;
  r->stored = r->energy - r->dissipated;
  r->work = solve->work + WorkBetween(solve, r);
  r->jumped = PETSC_FALSE;
  r->energy_released = NAN;
  r->source = LAM_SOURCE_DATABASE;
  r->indicators_trusted = PETSC_FALSE;
  r->newton_iterations = r->factorisations = 0;
  r->seconds = 0.0;
}

PetscErrorCode LamPointModelRespond(LamRVE rve, const LamPointModel *model, const LamLoad *load, LamResponse *response,
                                    LamModelError *error)
{
  const LamResponse *solve = &model->response;
  const LamStressScale scale = LamStressScaleOf(&rve->micro);
  LamExpansion expansion, moved;
  LamLayerPrediction layer;
  PetscReal x[LAM_VARIABLES], change[LAM_BOND_RATES];

  PetscFunctionBeginUser;
  PetscCheck(LamExpansionMake(solve, PETSC_FALSE, &expansion), PETSC_COMM_SELF, PETSC_ERR_PLIB, "not a model");
  LamVariables(load, x);
  LamExpansionMove(&expansion, x, &moved);
  FindChange(&solve->load, load, change);
  LamLayerPredict(rve, model->bond, change, model->history, NULL, &layer);
  *response = *solve;
  response->load = *load;
  LamExpansionToResponse(&moved, solve->tangent[80], response);
  Fill(rve, solve, &layer, model->spent, response);
  error->distance2 = Distance2(&expansion, &moved);
  error->branch = BRANCH_SHARE * LamStressErrorOfSize(scale, layer.error, response->P);
  error->smooth = model->curvature * error->distance2;
  response->distance = PetscSqrtReal(error->distance2);
  response->error_estimate = error->branch + error->smooth;
  PetscFunctionReturn(0);
}

void LamPointModelAccept(LamRVE rve, const LamLoad *load, LamPointModel *model)
{
  LamLayerPrediction layer;
  PetscReal change[LAM_BOND_RATES];

  FindChange(&model->response.load, load, change);
  LamLayerPredict(rve, model->bond, change, model->history, model->history, &layer);
  model->spent += layer.damage.dissipated / rve->mesh.V0;
}
