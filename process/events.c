/*
  Events in time: functions that rise through 0 at the event; and reports of states.

  All except percolation, which is a count, are continuous and converge with the mesh: tractions and tensions are means
  over a wall's thickness, volumes are derivatives of the potential.
*/
#include "process_impl.h"
#include <math.h>

#define NAME(symbol, name) name,
const char *const LamEventNames[] = {LAM_EVENTS(NAME)};
const char *const LamRatioNames[] = {LAM_RATIOS(NAME)};

/* ---- measures ---- */

static LamEventMeasures Measures(const LamResponse *r)
{
  return (LamEventMeasures){r->max_traction, r->max_lamella_shear, r->max_wall_tension, r->opening_fraction,
                            r->percolating_directions};
}

void LamProcessRatios(LamProcess process, const LamProcessFactor factor[], const LamEventMeasures *m,
                      PetscReal ratio[LAM_RATIO_COUNT])
{
  const LamStrength *strength = &process->scene->strength;
  const PetscReal lamella = factor[LAM_CHANGING_LAMELLA].value, wall = factor[LAM_CHANGING_WALL_STRENGTH].value;

  ratio[LAM_RATIO_LAMELLA_NORMAL] = m->normal / (lamella * strength->lamella_normal);
  ratio[LAM_RATIO_LAMELLA_SHEAR] = m->shear / (lamella * strength->lamella_shear);
  ratio[LAM_RATIO_WALL] = m->wall / (wall * strength->wall);
}

PetscReal LamProcessMeasureExcess(LamProcess process, LamEvent event, const LamProcessFactor factor[],
                                  const LamEventMeasures *m, PetscReal opening)
{
  const LamStrength *strength = &process->scene->strength;
  const PetscReal lamella = factor[LAM_CHANGING_LAMELLA].value, wall = factor[LAM_CHANGING_WALL_STRENGTH].value;

  switch (event) {
  case LAM_EVENT_LAMELLA_NORMAL:
    return m->normal - lamella * strength->lamella_normal;
  case LAM_EVENT_LAMELLA_SHEAR:
    return m->shear - lamella * strength->lamella_shear;
  case LAM_EVENT_WALL:
    return m->wall - wall * strength->wall;
  case LAM_EVENT_OPENING:
    return m->opening - opening - process->spec->opening;
  case LAM_EVENT_PERCOLATION:
    return m->percolating < 0 ? -1 : 1.5 - (PetscReal)m->percolating; /* below 0: unknown */
  default:
    return -1;
  }
}

/* ---- events of a material point ---- */

/* Whether the cells of any part of the tissue can part, or cannot. */
static PetscBool Has(const LamScene *scene, PetscBool parting)
{
  PetscBool has = (PetscBool)(LamCellsPart(scene->micro.interface) == parting);

  for (PetscInt r = 0; r < scene->region_count; r++)
    has = (PetscBool)(has || LamCellsPart(scene->regions[r].micro.interface) == parting);
  return has;
}

static PetscBool Applies(LamProcess process, LamEvent event)
{
  const PetscBool contact = Has(process->scene, PETSC_TRUE), bonded = Has(process->scene, PETSC_FALSE);
  const LamStrength *strength = &process->scene->strength;

  switch (event) {
  case LAM_EVENT_LAMELLA_NORMAL:
    return (PetscBool)(bonded && isfinite(strength->lamella_normal));
  case LAM_EVENT_LAMELLA_SHEAR:
    return (PetscBool)(bonded && isfinite(strength->lamella_shear));
  case LAM_EVENT_WALL:
    return (PetscBool)isfinite(strength->wall);
  case LAM_EVENT_OPENING:
  case LAM_EVENT_PERCOLATION:
    return contact;
  case LAM_EVENT_SNAP:
    return PETSC_FALSE; /* found when the integrator fails */
  case LAM_EVENT_TURGOR_LOST:
    return (PetscBool)!process->plasmolysed;
  case LAM_EVENT_TURGOR_FOUND:
    return process->plasmolysed;
  default:
    return PETSC_TRUE;
  }
}

PetscInt LamProcessListEvents(LamProcess process, LamEvent events[LAM_EVENT_COUNT])
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++)
    if (!process->found[k] && Applies(process, (LamEvent)k)) events[n++] = (LamEvent)k;
  return n;
}

/* Coefficient of -P_p (x) P_p that the cells' water adds to dP/dF. Either no water flows, dv = 0, or without resistance
   to the flow dp = d dv with d = dp/dV of equilibrium; dv = -P_p . dF - Psi_pp dp. */
static PetscReal WaterStiffness(LamProcess process, const LamEvaluation *e)
{
  LamFlow flow;

  if (!process->spec->has_water || process->plasmolysed) return 0;
  if (isfinite(process->spec->water.permeability)) return 1 / LamResponseConcavity(&e->response);
  LamProcessFlow(process, &process->cells, e, -e->response.energy_turgor, e->load.turgor, &flow);
  return flow.drive_water / (1 + flow.drive_water * LamResponseConcavity(&e->response));
}

/*
  Minus the stiffness in the free components, over C1 + C2: the smallest eigenvalue of the symmetric part of dP/dF,
  with the water of the cells. Without free components: whether the state is stable.
*/
static PetscReal LimitExcess(LamProcess process, const LamEvaluation *e)
{
  const LamResponse *r = &e->response;
  const PetscReal water = WaterStiffness(process, e);
  PetscReal A[9][9];
  PetscInt free[9], n = 0;

  for (PetscInt i = 0; i < 9; i++)
    if (process->segment.given[i]) free[n++] = i;
  if (!n || r->status == LAM_UNSTABLE) return r->status == LAM_UNSTABLE ? 1 : -1;
  for (PetscInt a = 0; a < n; a++)
    for (PetscInt b = 0; b < n; b++) {
      A[a][b] = r->tangent[9 * free[a] + free[b]];
      A[a][b] -= r->P_turgor[free[a]] * r->P_turgor[free[b]] * water;
    }
  /* Gaussian elimination: the smallest pivot has the sign of the smallest eigenvalue as long as only that one changes
     sign */
  PetscReal smallest = PETSC_INFINITY;
  for (PetscInt k = 0; k < n; k++) {
    smallest = PetscMin(smallest, A[k][k]);
    for (PetscInt a = k + 1; a < n; a++)
      for (PetscInt b = k + 1; b < n; b++) A[a][b] -= A[a][k] * A[k][b] / A[k][k];
  }
  return -smallest / e->walls;
}

PetscReal LamProcessExcess(LamProcess process, LamEvent event, const LamEvaluation *e, PetscReal water,
                           PetscReal turgor)
{
  const LamEventMeasures measures = Measures(&e->response);

  switch (event) {
  case LAM_EVENT_TURGOR_LOST:
    return -turgor - LamPlasmolysisTolerance(process) * process->pressure;
  case LAM_EVENT_TURGOR_FOUND:
    return water + e->response.energy_turgor - LamPlasmolysisTolerance(process) * process->cells.water;
  case LAM_EVENT_LIMIT:
    return LimitExcess(process, e);
  default:
    return LamProcessMeasureExcess(process, event, e->factor, &measures, process->opening);
  }
}

/* ---- reports ---- */

/* dP11/dF11 at constant P22. seals: no water flows, dP = A dF + P_p dp with dv = 0. */
static PetscReal Firmness(const LamResponse *r, PetscBool seals)
{
  const int at[2] = {0, 4};
  PetscReal A[2][2];

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      A[i][j] = r->tangent[9 * at[i] + at[j]];
      if (seals) A[i][j] -= r->P_turgor[at[i]] * r->P_turgor[at[j]] / LamResponseConcavity(r);
    }
  return A[0][0] - A[0][1] * A[1][0] / A[1][1];
}

/* Sets the complete state for the monitor. */
static PetscErrorCode Describe(LamProcess process, const LamProcessTissue *tissue, LamProcessState *state)
{
  LamEvaluation e;
  LamFlow flow;

  PetscFunctionBeginUser;
  PetscCall(LamProcessEvaluate(process, tissue->time, tissue->x, tissue->F, tissue->turgor, &e));
  PetscCall(LamProcessQueryReference(process, &e));
  *state = (LamProcessState){.time = tissue->time,
                             .temperature = e.temperature,
                             .walls = e.walls,
                             .turgor = tissue->turgor,
                             .cohesion = e.cohesion,
                             .water = NAN,
                             .osmotic = NAN,
                             .outside = e.outside,
                             .firmness = NAN,
                             .response = e.response,
                             .event = LAM_EVENT_COUNT};
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) state->factor[k] = e.factor[k].value;
  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) state->ratio[k] = NAN;
  PetscCall(PetscArraycpy(state->F, tissue->F, 9));
  if (process->spec->has_water) {
    LamProcessFlow(process, &process->cells, &e, tissue->water, tissue->turgor, &flow);
    state->water = tissue->water;
    state->osmotic = flow.osmotic;
  }
  const LamEventMeasures measures = Measures(&e.response);
  if (e.ok) LamProcessRatios(process, e.factor, &measures, state->ratio);
  if (e.ok) state->firmness = Firmness(&e.response, (PetscBool)(process->spec->has_water && !process->plasmolysed));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessReport(LamProcess process, const LamProcessTissue *tissue, LamEvent event)
{
  LamProcessState state;

  PetscFunctionBeginUser;
  PetscCall(Describe(process, tissue, &state));
  state.event = event;
  if (process->monitor) PetscCall(process->monitor(&state, process->monitor_ctx));
  PetscFunctionReturn(0);
}
