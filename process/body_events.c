/*
  Events in a body that changes in time, at the material point with the largest event function; and reports of states.
*/
#include "body_impl.h"
#include "clock.h"
#include <math.h>

static const PetscReal MOST_SLACK = 1e-4;

PetscReal LamBodyNoTurgor(LamBody body)
{
  return PetscMin(LamPlasmolysisTolerance(body->process), MOST_SLACK) * body->process->pressure;
}

PetscInt LamBodyListEvents(LamBody body, LamEvent events[LAM_EVENT_COUNT])
{
  const PetscInt n = LamProcessListEvents(body->process, events);
  PetscInt kept = 0;

  for (PetscInt k = 0; k < n; k++)
    if (events[k] != LAM_EVENT_LIMIT) events[kept++] = events[k]; /* the run of a body ends there */
  return kept;
}

static LamEventMeasures Measures(const LamMacroPoint *point)
{
  return (LamEventMeasures){point->field[LAM_POINT_NORMAL], point->field[LAM_POINT_SHEAR], point->field[LAM_POINT_WALL],
                            point->field[LAM_POINT_OPENING], point->percolating};
}

/* Event function of a point: rises through 0 at the event. */
static PetscReal Excess(LamBody body, LamEvent event, PetscInt p, const LamMacroPoint *point)
{
  const LamEventMeasures measures = Measures(point);

  switch (event) {
  case LAM_EVENT_TURGOR_LOST:
    return LamBodyNoTurgor(body) - point->load->turgor;
  case LAM_EVENT_TURGOR_FOUND: /* largest at the point that regains turgor last */
    return 2 * LamBodyNoTurgor(body) - point->load->turgor;
  default:
    return LamProcessMeasureExcess(body->process, event, body->now.factor, &measures, body->opening[p]);
  }
}

/* The largest event functions over this rank's points; points [n]: where. */
static PetscErrorCode FindLargest(LamBody body, PetscInt n, const LamEvent events[], PetscReal excess[],
                                  PetscInt points[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    excess[k] = -PETSC_INFINITY;
    points[k] = -1;
  }
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal at = Excess(body, events[k], p, &point);

      if (!(at > excess[k])) continue; /* not a number: unknown there */
      excess[k] = at;
      points[k] = p;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyExcess(LamBody body, PetscInt n, const LamEvent events[], PetscReal excess[])
{
  PetscInt points[LAM_EVENT_COUNT];

  PetscFunctionBeginUser;
  PetscCall(FindLargest(body, n, events, excess, points));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, excess, (PetscMPIInt)n, MPIU_REAL, MPIU_MAX, body->comm));
  for (PetscInt k = 0; k < n; k++)
    if (events[k] == LAM_EVENT_TURGOR_FOUND) excess[k] = -excess[k]; /* when all points have regained turgor */
  PetscFunctionReturn(0);
}

/* ---- reports ---- */

/* Sums and extremes over the material points of the present state. */
static PetscErrorCode Summarise(LamBody body, LamBodyState *state)
{
  const PetscBool moves = (PetscBool)(body->transport.count > 0);
  PetscReal sum[5] = {0}, most[2 + LAM_RATIO_COUNT];

  PetscFunctionBeginUser;
  for (int k = 0; k < 2 + LAM_RATIO_COUNT; k++) most[k] = -PETSC_INFINITY;
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    PetscReal ratio[LAM_RATIO_COUNT];
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    const LamEventMeasures measures = Measures(&point);
    LamProcessRatios(body->process, body->now.factor, &measures, ratio);
    most[0] = PetscMax(most[0], -point.load->turgor);
    most[1] = PetscMax(most[1], point.load->turgor);
    for (int k = 0; k < LAM_RATIO_COUNT; k++) most[2 + k] = PetscMax(most[2 + k], ratio[k]);
    sum[0] += body->share[p] * body->water[p];
    sum[1] += body->share[p] * body->cells[p].water;
    sum[4] += body->share[p] * (body->water[p] - body->cells[p].water);
    if (point.load->turgor < LamBodyNoTurgor(body)) sum[2] += body->share[p];
  }
  sum[3] = body->rank ? 0 : body->inflow;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 5, MPIU_REAL, MPIU_SUM, body->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2 + LAM_RATIO_COUNT, MPIU_REAL, MPIU_MAX, body->comm));
  state->turgor_min = -most[0];
  state->turgor_max = most[1];
  for (int k = 0; k < LAM_RATIO_COUNT; k++) state->ratio[k] = most[2 + k] > -PETSC_INFINITY ? most[2 + k] : NAN;
  state->water = body->process->spec->has_water ? sum[0] / sum[1] : NAN;
  state->inflow = moves ? sum[3] / sum[1] : NAN;
  state->water_balance = moves ? (sum[4] - sum[3]) / sum[1] : NAN;
  state->plasmolysed = body->process->spec->has_water ? sum[2] : NAN;
  PetscFunctionReturn(0);
}

/* Finds the material point with the largest event function. */
static PetscErrorCode Locate(LamBody body, LamEvent event, LamBodyState *state)
{
  struct {
    double excess;
    int rank;
  } mine, most;
  PetscReal excess;
  PetscInt p, local, found[2] = {-1, -1};

  PetscFunctionBeginUser;
  PetscCall(FindLargest(body, 1, &event, &excess, &p));
  mine.excess = excess;
  mine.rank = body->rank;
  PetscCallMPI(MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, body->comm));
  if (body->rank == most.rank && p >= 0) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    PetscCall(LamMacroGetElement(body->macro, p, &local, &found[0], &found[1]));
    for (int i = 0; i < 2; i++) state->place[i] = point.place[i];
  }
  PetscCallMPI(MPI_Bcast(found, 2, MPIU_INT, most.rank, body->comm));
  PetscCallMPI(MPI_Bcast(state->place, 2, MPIU_REAL, most.rank, body->comm));
  state->element = found[0];
  state->point = found[1];
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportEvent(LamBody body, LamEvent event)
{
  const LamProcess process = body->process;
  LamBodyState state = {.number = body->told++,
                        .time = process->tissue.time,
                        .temperature = body->now.temperature,
                        .outside = body->now.outside,
                        .walls = body->now.walls,
                        .load = process->tissue.load,
                        .event = event,
                        .element = -1,
                        .point = -1,
                        .place = {NAN, NAN}};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) state.factor[k] = body->now.factor[k].value;
  PetscCall(Summarise(body, &state));
  if (event != LAM_EVENT_COUNT) PetscCall(Locate(body, event, &state));
  PetscCall(LamMacroDescribe(body->macro, state.number, state.time, body->clock, &state.step));
  body->clock = LamClock();
  if (body->monitor) PetscCall(body->monitor(&state, body->monitor_ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyReport(LamBody body, const PetscBool happened[LAM_EVENT_COUNT])
{
  LamProcess process = body->process;

  PetscFunctionBeginUser;
  if (!happened) PetscCall(ReportEvent(body, LAM_EVENT_COUNT));
  for (PetscInt k = 0; k < LAM_EVENT_COUNT && happened; k++) {
    if (!happened[k]) continue;
    if (k == LAM_EVENT_TURGOR_LOST || k == LAM_EVENT_TURGOR_FOUND)
      process->plasmolysed = (PetscBool)(k == LAM_EVENT_TURGOR_LOST); /* at some point */
    else
      process->found[k] = PETSC_TRUE;
    PetscCall(ReportEvent(body, (LamEvent)k));
  }
  PetscFunctionReturn(0);
}
