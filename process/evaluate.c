/*
  The tissue at a state: its properties, its response, and the flow of water into its cells.

  With V the volume of the protoplasts over V0 and v(F, p) the lumen, both per V0, turgid cells have V = v, and

    dV/dt = Lp A [ sigma (pi - pi_out) - p ],    pi = pi_0 (T / T_0) (n / n_0) (V_0 - V_b) / (V - V_b),

  A the area of the membranes over V0, that of the lumens of the reference; V_b the non-osmotic volume. Walls with s
  times the moduli of the start have the energy s Psi(F, p / s, g / s), so responses are scaled.

  Sources: Dainty, Adv. Bot. Res. 1 (1963) 279-326 (flow through membranes); van 't Hoff.
*/
#include "process_impl.h"
#include <math.h>
#include <string.h>

/* ---- properties ---- */

PetscReal LamProcessTissueFactors(const LamScene *scene, const PetscReal factor[LAM_CHANGING_COUNT],
                                  LamTissueFactors *factors)
{
  const PetscReal walls = factor[LAM_CHANGING_WALLS] *
                          LamWallRatios(&scene->micro.wall, &factor[LAM_CHANGING_OF_PARAMETER(0)], factors->walls);

  factors->lamella = factor[LAM_CHANGING_LAMELLA];
  factors->wall_strength = factor[LAM_CHANGING_WALL_STRENGTH];
  if (scene->micro.interface != LAM_INTERFACE_LAMELLA) return walls;
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (LamWallParameterIsModulus(k)) factors->walls[k] *= walls;
  return 1;
}

void LamProcessProperties(LamProcess process, PetscReal time, const PetscReal x[], LamEvaluation *e,
                          LamTissueFactors *factors)
{
  const PetscReal elapsed = time - process->segment.start;
  PetscReal factor[LAM_CHANGING_COUNT], ratio[LAM_WALL_PARAMETER_COUNT];

  e->time = time;
  e->temperature = LamRampAt(&process->segment.temperature, elapsed);
  e->outside = LamRampAt(&process->segment.outside, elapsed);
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++)
    e->factor[k].value =
        LamKineticsFactor(&process->spec->kinetics[k], time, &x[LAM_KINETIC_STATES * k], e->factor[k].slope);
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) factor[k] = e->factor[k].value;
  e->walls = factor[LAM_CHANGING_WALLS] *
             LamWallRatios(&process->scene->micro.wall, &factor[LAM_CHANGING_OF_PARAMETER(0)], ratio);
  e->unit = LamProcessTissueFactors(process->scene, factor, factors);
  e->cohesion = process->scene->cohesion * e->factor[LAM_CHANGING_LAMELLA].value;
}

void LamProcessRates(LamProcess process, PetscReal temperature, const PetscReal x[], PetscReal rate[],
                     PetscReal J[][LAM_KINETIC_STATES][LAM_KINETIC_STATES])
{
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    PetscReal *own = &rate[LAM_KINETIC_STATES * k];

    for (PetscInt i = 0; i < LAM_KINETIC_STATES; i++) own[i] = 0;
    if (LamKineticsStates(&process->spec->kinetics[k]))
      LamKineticsRates(&process->spec->kinetics[k], temperature, &x[LAM_KINETIC_STATES * k], own, J[k]);
  }
}

/* ---- response ---- */

static void Multiply(const PetscReal A[9], const PetscReal B[9], PetscReal AB[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) AB[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

static PetscBool SameQuestion(LamProcess process, const LamEvaluation *e)
{
  const LamLoad *a = &process->last.load, *b = &e->load;

  return (PetscBool)(process->last_known && process->last_unit == e->unit && a->turgor == b->turgor &&
                     a->cohesion == b->cohesion && a->duration == b->duration && !memcmp(a->F, b->F, sizeof(a->F)));
}

PetscErrorCode LamProcessPassTissue(LamProcess process, const LamTissueFactors *factors)
{
  PetscFunctionBeginUser;
  if (!process->changes_tissue || !memcmp(&process->passed, factors, sizeof(process->passed))) PetscFunctionReturn(0);
  PetscCall(process->set_tissue(process->tissue_ctx, factors));
  process->passed = *factors;
  process->last_known = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Queries a responder; the response is in units of C1 + C2 at the start. */
static PetscErrorCode QueryResponder(LamProcess process, LamResponder responder, const LamEvaluation *e,
                                     LamResponse *response)
{
  const PetscInt point = 0;
  LamLoad own = e->load;

  PetscFunctionBeginUser;
  own.turgor /= e->unit;
  own.cohesion /= e->unit;
  PetscCall(LamResponderRespond(responder, 1, &own, &point, response));
  process->counts.questions++;
  if (process->has_history && e->unit != 1) /* in the unit of walls that have changed since */
    response->stored = response->dissipated = response->dissipated_walls = response->work = NAN;
  LamResponseScale(e->unit, response);
  response->load = e->load;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessQueryReference(LamProcess process, LamEvaluation *e)
{
  PetscFunctionBeginUser;
  if (!process->reference || !e->ok || e->response.indicators_trusted) PetscFunctionReturn(0);
  if (!process->reference_response_known || process->reference_response_unit != e->unit ||
      memcmp(&process->reference_response.load, &e->load, sizeof(LamLoad)))
    PetscCall(QueryResponder(process, process->reference, e, &process->reference_response));
  process->reference_response_unit = e->unit;
  process->reference_response_known = LamResponseHasFields(&process->reference_response);
  if (process->reference_response_known) e->response = process->reference_response;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessEvaluate(LamProcess process, PetscReal time, const PetscReal x[], const PetscReal F[9],
                                  PetscReal turgor, LamEvaluation *e)
{
  LamTissueFactors factors;

  PetscFunctionBeginUser;
  LamProcessProperties(process, time, x, e, &factors);
  e->load = (LamLoad){.turgor = turgor,
                      .cohesion = e->cohesion,
                      .duration = process->has_history ? PetscMax(0, time - process->accepted) : 0};
  Multiply(F, process->inflation, e->load.F);
  e->ok = (PetscBool)(e->walls > 0 && isfinite(e->walls) && isfinite(turgor));
  if (!e->ok) {
    PetscCall(LamResponseInit(&e->load, &e->response));
    PetscCall(PetscStrncpy(process->trouble, "nothing is left of the walls", sizeof(process->trouble)));
    PetscFunctionReturn(0);
  }
  PetscCall(LamProcessPassTissue(process, &factors));
  if (SameQuestion(process, e)) {
    e->response = process->last.response;
    e->ok = process->last.ok;
    PetscFunctionReturn(0);
  }
  PetscCall(QueryResponder(process, process->responder, e, &e->response));
  e->ok = LamResponseHasFields(&e->response);
  if (!e->ok)
    PetscCall(PetscSNPrintf(process->trouble, sizeof(process->trouble), "%s: %.150s",
                            LamStatusNames[e->response.status], e->response.reason));
  process->last = *e;
  process->last_unit = e->unit;
  process->last_known = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessAccept(LamProcess process)
{
  const LamProcessTissue *tissue = &process->tissue;
  LamEvaluation e;

  PetscFunctionBeginUser;
  if (process->has_history)
    PetscCall(LamProcessEvaluate(process, tissue->time, tissue->x, tissue->F, tissue->turgor, &e));
  PetscCall(LamResponderAccept(process->responder));
  process->accepted = tissue->time;
  if (process->has_history) process->last_known = PETSC_FALSE; /* the same question is now one of another past */
  PetscFunctionReturn(0);
}

PetscReal LamProcessStiffness(LamProcess process, const LamEvaluation *e, PetscInt i, PetscInt k)
{
  PetscReal sum = 0;

  for (int m = 0; m < 3; m++) { /* F = F_rel F_0 */
    const PetscReal inflation = process->inflation[3 * (k % 3) + m];

    if (inflation != 0) sum += e->response.tangent[9 * i + 3 * (k / 3) + m] * inflation;
  }
  return sum;
}

PetscReal LamProcessLumenSlope(LamProcess process, const LamEvaluation *e, PetscInt k)
{
  PetscReal sum = 0;

  for (int m = 0; m < 3; m++) {
    const PetscReal inflation = process->inflation[3 * (k % 3) + m];

    if (inflation != 0) sum -= e->response.P_turgor[3 * (k / 3) + m] * inflation;
  }
  return sum;
}

/* ---- water ---- */

void LamProcessFlow(LamProcess process, const LamCells *cells, const LamEvaluation *e, PetscReal water,
                    PetscReal turgor, LamFlow *flow)
{
  const LamWaterSpec *spec = &process->spec->water;
  const PetscReal dead = spec->non_osmotic * cells->water, room = water - dead;
  const PetscReal n = e->factor[LAM_CHANGING_SOLUTES].value;
  const PetscReal sigma = spec->reflection * e->factor[LAM_CHANGING_REFLECTION].value;
  const PetscReal concentrated =
      cells->osmotic * (e->temperature / process->temperature) * (cells->water - dead) / room;

  flow->conductance = spec->permeability * cells->membrane * e->factor[LAM_CHANGING_PERMEABILITY].value *
                      exp(-spec->activation / LAM_GAS_CONSTANT * (1 / e->temperature - 1 / process->temperature));
  flow->osmotic = n * concentrated;
  flow->drive = sigma * (flow->osmotic - e->outside) - turgor;
  flow->osmotic_water = -flow->osmotic / room;
  flow->osmotic_solutes = concentrated;
  flow->drive_turgor = -1;
  flow->drive_water = -sigma * flow->osmotic / room;
  flow->drive_solutes = sigma * concentrated;
  flow->drive_reflection = spec->reflection * (flow->osmotic - e->outside);
}
