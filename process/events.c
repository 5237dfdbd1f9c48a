/*
  Events in time: functions that rise through 0 at the event.

  All except percolation, which is a count, are continuous and converge with the mesh: tractions and tensions are means
  over a wall's thickness, volumes are derivatives of the potential.
*/
#include "process_impl.h"
#include <math.h>

#define NAME(symbol, name) name,
const char *const LamEventNames[] = {LAM_EVENTS(NAME)};
const char *const LamRatioNames[] = {LAM_RATIOS(NAME)};

void LamProcessRatios(LamProcess process, const LamEvaluation *e, PetscReal ratio[LAM_RATIO_COUNT])
{
  const LamStrength *strength = &process->scene->strength;
  const PetscReal lamella = e->factor[LAM_CHANGING_LAMELLA].value, wall = e->factor[LAM_CHANGING_WALL_STRENGTH].value;

  ratio[LAM_RATIO_LAMELLA_NORMAL] = e->response.max_traction / (lamella * strength->lamella_normal);
  ratio[LAM_RATIO_LAMELLA_SHEAR] = e->response.max_lamella_shear / (lamella * strength->lamella_shear);
  ratio[LAM_RATIO_WALL] = e->response.max_wall_tension / (wall * strength->wall);
}

/* Whether any part of the tissue has this interface. */
static PetscBool Has(const LamScene *scene, LamInterfaceLawType interface)
{
  PetscBool has = (PetscBool)(scene->micro.interface == interface);

  for (PetscInt r = 0; r < scene->region_count; r++)
    has = (PetscBool)(has || scene->regions[r].micro.interface == interface);
  return has;
}

static PetscBool Applies(LamProcess process, LamEvent event)
{
  const PetscBool contact = Has(process->scene, LAM_INTERFACE_CONTACT),
                  bonded = Has(process->scene, LAM_INTERFACE_BONDED);
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
  const LamStrength *strength = &process->scene->strength;
  const PetscReal lamella = e->factor[LAM_CHANGING_LAMELLA].value, wall = e->factor[LAM_CHANGING_WALL_STRENGTH].value;
  const LamResponse *r = &e->response;

  switch (event) {
  case LAM_EVENT_LAMELLA_NORMAL:
    return r->max_traction - lamella * strength->lamella_normal;
  case LAM_EVENT_LAMELLA_SHEAR:
    return r->max_lamella_shear - lamella * strength->lamella_shear;
  case LAM_EVENT_WALL:
    return r->max_wall_tension - wall * strength->wall;
  case LAM_EVENT_OPENING:
    return r->opening_fraction - process->opening - process->spec->opening;
  case LAM_EVENT_PERCOLATION:
    return r->percolating_directions < 0 ? -1 : 1.5 - (PetscReal)r->percolating_directions; /* below 0: unknown */
  case LAM_EVENT_TURGOR_LOST:
    return -turgor - LamPlasmolysisTolerance(process) * process->pressure;
  case LAM_EVENT_TURGOR_FOUND:
    return water + r->energy_turgor - LamPlasmolysisTolerance(process) * process->cells.water;
  case LAM_EVENT_LIMIT:
    return LimitExcess(process, e);
  default:
    return -1;
  }
}
