/*
  Time loop of the tissue: segments, jumps and events.
*/
#include "process_impl.h"
#include <lamella/body.h>
#include <lamella/tissue.h>
#include <math.h>

enum { MAX_SNAPS = 200 };
#define FIRST_GAP 1e-8 /* smallest and largest time of a snap, as fractions of the duration */
#define LAST_GAP 1e-4
#define STILL 1e-7 /* smaller changes of a prescribed quantity are not a jump */

/* ---- creation and destruction ---- */

/* Marks the parameters that are nonzero in any wall of a tissue. */
static void FindParameters(const LamMicrostructure *micro, PetscBool has[LAM_WALL_PARAMETER_COUNT])
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 0;

  for (PetscInt c = -1; c < cells; c++) {
    const LamWall *wall = c < 0 ? &micro->wall : &micro->cell[c].wall;

    for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) has[k] = (PetscBool)(has[k] || LamWallGet(wall, k) != 0);
  }
}

PetscBool LamProcessWallsStayAlike(const LamScene *scene)
{
  const LamKinetics *kinetics =
      &scene->process.kinetics[LAM_CHANGING_OF_PARAMETER(0)]; /* the parameters start with C1, which all walls have */
  PetscBool has[LAM_WALL_PARAMETER_COUNT] = {PETSC_FALSE};

  FindParameters(&scene->micro, has);
  for (PetscInt r = 0; r < scene->region_count; r++) FindParameters(&scene->regions[r].micro, has);
  for (PetscInt k = 1; k < LAM_WALL_PARAMETER_COUNT; k++) {
    if (!has[k]) continue;
    if (LamWallParameterIsModulus(k) ? !LamKineticsAgree(&kinetics[0], &kinetics[k])
                                     : kinetics[k].law != LAM_KINETIC_CONSTANT)
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* That of the sides of the prisms; of cells with a length that of their ends, too. */
PetscReal LamMembraneArea(const LamMicrostructure *micro)
{
  const LamTissue tissue = micro->tissue;
  const PetscInt cells = micro->cells[0] * micro->cells[1];
  const PetscReal ends = micro->length > 0 ? 2 / micro->length : 0;
  PetscReal area = 0;

  for (PetscInt c = 0; c < cells; c++) {
    const PetscReal t = LamWallThickness(micro, c), inner = LamOuterApothem(micro) - t;

    if (tissue) {
      const PetscReal perimeter = LamTissueInnerPerimeter(tissue, c, t);
      const PetscReal lumen =
          LamTissueCellArea(tissue, c) - 0.5 * t * (LamTissueInnerPerimeter(tissue, c, 0) + perimeter);

      area += (perimeter + ends * lumen) / tissue->area;
    } else {
      area += (2 * inner + ends * PetscSqr(inner)) / (PetscReal)cells;
    }
  }
  return area;
}

PetscErrorCode LamProcessCreate(const LamScene *scene, LamProcess *process)
{
  PetscFunctionBeginUser;
  PetscCheck(scene->has_process, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `process`, which says how the tissue changes", scene->path);
  PetscCall(PetscNew(process));
  (*process)->scene = scene;
  (*process)->spec = &scene->process;
  (*process)->breaks = (PetscBool)(scene->micro.interface == LAM_INTERFACE_LAMELLA);
  (*process)->has_history = LamHasHistory(&scene->micro);
  (*process)->changes_tissue = (PetscBool)((*process)->breaks || !LamProcessWallsStayAlike(scene));
  (*process)->cells.membrane = LamMembraneArea(&scene->micro);
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessSetResponder(LamProcess process, LamResponder responder)
{
  PetscFunctionBeginUser;
  process->responder = responder;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessSetReferenceResponder(LamProcess process, LamResponder reference)
{
  PetscFunctionBeginUser;
  process->reference = reference;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessSetTissue(LamProcess process,
                                   PetscErrorCode (*set)(void *ctx, const LamTissueFactors *factors), void *ctx)
{
  PetscFunctionBeginUser;
  process->set_tissue = set;
  process->tissue_ctx = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessSetMonitor(LamProcess process, LamProcessMonitor monitor, void *ctx)
{
  PetscFunctionBeginUser;
  process->monitor = monitor;
  process->monitor_ctx = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessSetStop(LamProcess process, PetscBool (*stop)(void))
{
  PetscFunctionBeginUser;
  process->stop = stop;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessGetCounts(LamProcess process, LamProcessCounts *counts)
{
  PetscFunctionBeginUser;
  *counts = process->counts;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessDestroy(LamProcess *process)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*process));
  PetscFunctionReturn(0);
}

/* ---- the present state ---- */

static PetscErrorCode EvaluateTissue(LamProcess process, LamEvaluation *e)
{
  const LamProcessTissue *tissue = &process->tissue;

  PetscFunctionBeginUser;
  PetscCall(LamProcessEvaluate(process, tissue->time, tissue->x, tissue->F, tissue->turgor, e));
  PetscFunctionReturn(0);
}

/* The present conditions of the tissue, with the unknowns of the present segment. */
static LamSegment Here(LamProcess process, const PetscReal P[9])
{
  LamSegment here = process->segment;

  for (int i = 0; i < 9; i++) {
    here.F[i] = (LamRamp){process->tissue.F[i], 0};
    here.P[i] = (LamRamp){P[i], 0};
  }
  here.turgor = (LamRamp){process->tissue.turgor, 0};
  here.temperature = (LamRamp){process->tissue.temperature, 0};
  here.outside = (LamRamp){process->tissue.outside, 0};
  return here;
}

/* Whether the conditions jump. Temperature and bath act through the flow of water, hence instantly only if it has no
   resistance. */
static PetscBool Jumps(LamProcess process, const PetscReal P[9])
{
  const PetscBool at_once = (PetscBool)(process->spec->has_water && !isfinite(process->spec->water.permeability));

  const LamSegment *segment = &process->segment;

  for (int i = 0; i < 9; i++) {
    const PetscReal change = segment->given[i] ? segment->P[i].from - P[i] : segment->F[i].from - process->tissue.F[i];

    if (PetscAbsReal(change) > STILL) return PETSC_TRUE;
  }
  if (at_once &&
      (process->tissue.outside != segment->outside.from || process->tissue.temperature != segment->temperature.from))
    return PETSC_TRUE;
  return (PetscBool)(PetscAbsReal(segment->turgor.from - process->tissue.turgor) > STILL);
}

/* ---- events ---- */

/* Consequences of an event: membranes detach or attach again; other events are not searched for again. */
static void Note(LamProcess process, LamEvent event)
{
  if (event == LAM_EVENT_TURGOR_LOST && process->spec->has_water) {
    process->plasmolysed = PETSC_TRUE;
    process->tissue.turgor = 0;
  } else if (event == LAM_EVENT_TURGOR_FOUND) {
    process->plasmolysed = PETSC_FALSE;
  } else {
    process->found[event] = PETSC_TRUE;
  }
}

/* Records and reports the events at the present state; *ends: the tissue cannot continue. */
static PetscErrorCode Happen(LamProcess process, const PetscBool happened[LAM_EVENT_COUNT], PetscBool *ends)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++) {
    if (!happened[k]) continue;
    Note(process, (LamEvent)k);
    PetscCall(LamProcessReport(process, &process->tissue, (LamEvent)k));
    if (k == LAM_EVENT_LIMIT) *ends = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Events passed in a jump. If water is followed, loss and recovery of turgor are treated in ChangeMembranes. */
static PetscErrorCode CheckEvents(LamProcess process, PetscBool *ends)
{
  PetscBool happened[LAM_EVENT_COUNT] = {PETSC_FALSE};
  LamEvent events[LAM_EVENT_COUNT];
  const PetscInt n = LamProcessListEvents(process, events);
  LamEvaluation e;

  PetscFunctionBeginUser;
  PetscCall(EvaluateTissue(process, &e));
  PetscCall(LamProcessQueryReference(process, &e));
  for (PetscInt k = 0; k < n && e.ok; k++) {
    if (process->spec->has_water && (events[k] == LAM_EVENT_TURGOR_LOST || events[k] == LAM_EVENT_TURGOR_FOUND))
      continue;
    happened[events[k]] =
        (PetscBool)(LamProcessExcess(process, events[k], &e, process->tissue.water, process->tissue.turgor) > 0);
  }
  PetscCall(Happen(process, happened, ends));
  PetscFunctionReturn(0);
}

/* ---- segments ---- */

/* Type of equilibrium after an instantaneous change. */
static LamSettle Kind(LamProcess process)
{
  if (!process->spec->has_water || process->plasmolysed) return LAM_SETTLE_TURGOR;
  return isfinite(process->spec->water.permeability) ? LAM_SETTLE_WATER : LAM_SETTLE_OSMOSIS;
}

/* If water is followed, the turgor at the segment's start is that of the tissue. */
static void KeepTurgor(LamProcess process)
{
  if (process->spec->has_water) process->segment.turgor = (LamRamp){process->tissue.turgor, 0};
}

/* Detaches the membranes, or attaches them again, after a jump. */
static PetscErrorCode ChangeMembranes(LamProcess process, PetscBool *ok)
{
  LamEvent event = LAM_EVENT_COUNT;
  LamSegment here;
  LamEvaluation e;

  PetscFunctionBeginUser;
  PetscCall(EvaluateTissue(process, &e));
  if (!process->plasmolysed && process->tissue.turgor < -LamPlasmolysisTolerance(process) * process->pressure)
    event = LAM_EVENT_TURGOR_LOST;
  if (process->plasmolysed &&
      process->tissue.water > -e.response.energy_turgor + LamPlasmolysisTolerance(process) * process->cells.water)
    event = LAM_EVENT_TURGOR_FOUND;
  if (event == LAM_EVENT_COUNT) PetscFunctionReturn(0);
  here = Here(process, e.response.P); /* with its present turgor */
  Note(process, event);
  KeepTurgor(process);
  PetscCall(LamProcessSettle(process, Kind(process), &here, ok));
  if (*ok) PetscCall(LamProcessReport(process, &process->tissue, event));
  PetscFunctionReturn(0);
}

/* Equilibrates the tissue at the start of the segment: by a jump, or to remove errors of rounding and interpolation. */
static PetscErrorCode EnterSegment(LamProcess process, PetscBool *ok)
{
  LamEvaluation e;

  PetscFunctionBeginUser;
  KeepTurgor(process);
  PetscCall(EvaluateTissue(process, &e));
  *ok = e.ok;
  if (!*ok) PetscFunctionReturn(0);
  const LamSegment here = Here(process, e.response.P);

  if (!Jumps(process, e.response.P)) {
    PetscCall(
        LamProcessSettle(process, Kind(process) == LAM_SETTLE_WATER ? LAM_SETTLE_TURGOR : Kind(process), NULL, ok));
    PetscFunctionReturn(0);
  }
  PetscCall(LamProcessSettle(process, Kind(process), &here, ok));
  if (*ok && process->spec->has_water) PetscCall(ChangeMembranes(process, ok));
  PetscFunctionReturn(0);
}

/* ---- snaps ---- */

/* Advances kinetics (midpoint rule) and water (present flow) over a short time. */
static PetscErrorCode Pass(LamProcess process, PetscReal time)
{
  LamProcessTissue *tissue = &process->tissue;
  PetscReal half[LAM_PROCESS_KINETIC], rate[LAM_PROCESS_KINETIC];
  PetscReal J[LAM_CHANGING_COUNT][LAM_KINETIC_STATES][LAM_KINETIC_STATES];
  LamEvaluation e;
  LamFlow flow;

  PetscFunctionBeginUser;
  PetscCall(EvaluateTissue(process, &e));
  LamProcessRates(process, e.temperature, tissue->x, rate, J);
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++) half[k] = tissue->x[k] + 0.5 * time * rate[k];
  LamProcessRates(process, e.temperature, half, rate, J);
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++) tissue->x[k] += time * rate[k];
  if (process->spec->has_water && isfinite(process->spec->water.permeability)) {
    LamProcessFlow(process, &process->cells, &e, tissue->water, tissue->turgor, &flow);
    tissue->water += time * flow.conductance * flow.drive;
  }
  tissue->time += time;
  PetscFunctionReturn(0);
}

/* Reports outputs passed in a snap, with the state before it. */
static PetscErrorCode ReportBefore(LamProcess process, const LamProcessTissue *before)
{
  PetscFunctionBeginUser;
  while (process->next_output < process->tissue.time) {
    LamProcessTissue tissue = *before;

    tissue.time = process->next_output;
    PetscCall(LamProcessReport(process, &tissue, LAM_EVENT_COUNT));
    LamProcessNextOutput(process);
  }
  PetscFunctionReturn(0);
}

/* If no time step converges, however short: finds an equilibrium a moment later. */
static PetscErrorCode Snap(LamProcess process, PetscBool *ok)
{
  const LamProcessTissue before = process->tissue;
  const PetscReal duration = process->spec->duration, left = process->segment.end - before.time;
  char why[sizeof(process->trouble)];
  LamSegment here;
  LamEvaluation e;

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  PetscCall(PetscStrncpy(why, process->trouble, sizeof(why)));
  for (PetscReal gap = FIRST_GAP; gap <= LAST_GAP && !*ok && process->snaps < MAX_SNAPS; gap *= 10) {
    if (gap * duration >= left) break;
    process->tissue = before;
    PetscCall(EvaluateTissue(process, &e));
    if (!e.ok) break;
    here = Here(process, e.response.P);
    PetscCall(Pass(process, gap * duration));
    LamProcessNextSegment(process, &process->segment);
    KeepTurgor(process);
    PetscCall(LamProcessSettle(process, Kind(process), &here, ok));
    if (*ok && process->spec->has_water) PetscCall(ChangeMembranes(process, ok));
  }
  if (*ok) {
    process->snaps++;
    PetscCall(ReportBefore(process, &before));
    PetscCall(LamProcessReport(process, &process->tissue, LAM_EVENT_SNAP));
  } else {
    process->tissue = before;
    PetscCall(PetscStrncpy(process->trouble, why, sizeof(why)));
  }
  PetscFunctionReturn(0);
}

/* Tissue with a lamella under stress that has no equilibrium next to it any more, at once or a moment later, has
   reached the limit of what it bears: the event that ends the process. Its tangent does not tell, as it jumps between
   loading and unloading. */
static PetscErrorCode FindLimit(LamProcess process, PetscBool *ok, PetscBool *ends)
{
  PetscBool happened[LAM_EVENT_COUNT] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  if (*ok || process->stopped || !process->breaks) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < 9; i++)
    if (process->segment.given[i]) happened[LAM_EVENT_LIMIT] = PETSC_TRUE;
  *ok = happened[LAM_EVENT_LIMIT];
  PetscCall(Happen(process, happened, ends));
  PetscFunctionReturn(0);
}

/* One segment, or the part of it up to an event. */
static PetscErrorCode FollowSegment(LamProcess process, PetscBool *ok, PetscBool *ends)
{
  PetscBool happened[LAM_EVENT_COUNT] = {PETSC_FALSE};
  LamEvaluation e;

  PetscFunctionBeginUser;
  LamProcessNextSegment(process, &process->segment);
  PetscCall(EnterSegment(process, ok));
  PetscCall(FindLimit(process, ok, ends));
  if (*ok && !*ends) PetscCall(CheckEvents(process, ends));
  if (!*ok || *ends) PetscFunctionReturn(0);
  if (process->segment.end > process->segment.start) PetscCall(LamProcessIntegrate(process, happened, ok));
  if (!*ok && !process->stopped) PetscCall(Snap(process, ok));
  PetscCall(FindLimit(process, ok, ends));
  if (!*ok || *ends) PetscFunctionReturn(0);
  PetscCall(Happen(process, happened, ends));
  PetscCall(EvaluateTissue(process, &e));
  LamProcessEndSegment(process, e.response.P);
  PetscFunctionReturn(0);
}

/* ---- the start ---- */

/* Finds the stress-free tissue under its turgor, from which deformation is measured. */
static PetscErrorCode Inflate(LamProcess process, PetscBool *ok)
{
  const PetscReal none[9] = {0};
  const PetscInt in_plane[3] = {0, 1, 4}; /* F21 = 0 prevents rotation */
  LamSegment *segment = &process->segment, from;

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++) {
    segment->given[i] = PETSC_FALSE;
    segment->F[i] = (LamRamp){i % 4 == 0 ? 1 : 0, 0};
    segment->P[i] = (LamRamp){0, 0};
  }
  for (int k = 0; k < 3; k++) segment->given[in_plane[k]] = PETSC_TRUE;
  if (process->spec->area == LAM_AREA_INFLATED)
    segment->given[1] = PETSC_FALSE; /* a diagonal F0 keeps components apart */
  from = Here(process, none);
  from.turgor = (LamRamp){0, 0};
  PetscCall(LamProcessSettle(process, LAM_SETTLE_TURGOR, &from, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(process->inflation, process->tissue.F, 9));
  for (int i = 0; i < 9; i++) process->tissue.F[i] = i % 4 == 0 ? 1 : 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Start(LamProcess process, PetscBool *ok)
{
  const LamWaterSpec *water = &process->spec->water;
  LamEvaluation e;
  LamFlow flow;

  PetscFunctionBeginUser;
  process->tissue.turgor = process->segment.turgor.from;
  *ok = PETSC_TRUE;
  if (process->spec->inflate) PetscCall(Inflate(process, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(EvaluateTissue(process, &e));
  *ok = e.ok;
  if (!*ok) PetscFunctionReturn(0);
  if (process->has_history) PetscCall(LamProcessAccept(process)); /* what follows counts from now on */
  process->opening = e.response.opening_fraction;
  LamProcessStartProgram(process, e.response.P);
  process->pressure = PetscMax(1e-3, process->tissue.turgor);
  if (!process->spec->has_water) PetscFunctionReturn(0);
  process->tissue.water = process->cells.water = -e.response.energy_turgor;
  process->cells.osmotic = water->osmotic;
  if (isnan(water->osmotic))
    process->cells.osmotic = e.outside + (water->reflection > 0 ? process->tissue.turgor / water->reflection : 0);
  process->pressure = PetscMax(process->pressure, process->cells.osmotic);
  LamProcessFlow(process, &process->cells, &e, process->tissue.water, 0, &flow);
  process->plasmolysed = (PetscBool)(process->tissue.turgor == 0 && flow.drive < 0);
  PetscFunctionReturn(0);
}

/* ---- time loop ---- */

/* Reports the last state if the run ends early. */
static PetscErrorCode ReportLast(LamProcess process)
{
  char why[sizeof(process->trouble)];
  LamEvaluation e;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(why, process->trouble, sizeof(why)));
  PetscCall(EvaluateTissue(process, &e));
  if (e.ok) PetscCall(LamProcessReport(process, &process->tissue, LAM_EVENT_COUNT));
  PetscCall(PetscStrncpy(process->trouble, why, sizeof(why)));
  PetscFunctionReturn(0);
}

/* Reason of the end. At a limit point of interpolated responses the tissue itself may be able to continue. */
static const char *WhyItEnds(LamProcess process, PetscBool limit)
{
  const PetscBool contact = LamCellsPart(process->scene->micro.interface);

  if (!limit) return process->trouble;
  if (process->breaks)
    return "limit point: the tissue does not bear its stress any more, no equilibrium is found next to the last one";
  return contact && LamResponderGetCounters(process->responder).interpolated
             ? "limit point: nothing is left of the stiffness against what is free, as a database sees it; next to a "
               "loss of contact its tangent may be wrong: solve directly to be sure"
             : "limit point: nothing is left of the stiffness against what is free";
}

PetscErrorCode LamProcessRun(LamProcess process, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE])
{
  PetscBool ok = PETSC_TRUE, ends = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCheck(process->responder, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call LamProcessSetResponder() first");
  PetscCall(LamProcessBegin(process));
  message[0] = '\0';
  PetscCall(Start(process, &ok));
  while (ok && !ends && !process->stopped && process->tissue.time < process->spec->duration)
    PetscCall(FollowSegment(process, &ok, &ends));
  if (!ok && !process->stopped && process->tissue.time > 0) PetscCall(ReportLast(process));
  *reason = process->stopped ? LAM_PROCESS_STOPPED : ok && !ends ? LAM_PROCESS_DONE : LAM_PROCESS_ENDED;
  if (*reason == LAM_PROCESS_ENDED)
    PetscCall(PetscSNPrintf(message, LAM_PROCESS_MESSAGE, "ended at %.6g s: %s", (double)process->tissue.time,
                            WhyItEnds(process, ends)));
  PetscFunctionReturn(0);
}
