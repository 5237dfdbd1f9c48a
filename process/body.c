/*
  Time loop of a body: segments, jumps and events.
*/
#include "body_impl.h"
#include "clock.h"
#include <math.h>
#include <string.h>

enum { MAX_HALVINGS = 12 };

/* ---- creation and destruction ---- */

/* Checks that prescribed turgor can be written as a factor on the turgor of the points. */
static PetscErrorCode CheckTurgor(const LamScene *scene)
{
  const LamProcessSpec *spec = &scene->process;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < spec->surroundings_count && !spec->has_water; k++)
    PetscCheck(spec->surroundings[k].turgor == scene->turgor || scene->turgor > 0, PETSC_COMM_SELF,
               PETSC_ERR_USER_INPUT,
               "%s: process.surroundings: turgor in a body is told as a multiple of rve.turgor, which is not above 0; "
               "write the largest pressure there",
               scene->path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyCreate(const LamScene *scene, LamMacro macro, LamBody *body)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(body));
  (*body)->macro = macro;
  PetscCall(LamMacroGetComm(macro, &(*body)->comm));
  PetscCallMPI(MPI_Comm_rank((*body)->comm, &(*body)->rank));
  PetscCall(LamProcessCreate(scene, &(*body)->process));
  PetscCall(CheckTurgor(scene));
  if (scene->process.has_water) PetscCall(LamMacroSetWaterLaw(macro, LamBodyWaterLaw, *body));
  PetscFunctionReturn(0);
}

/* Allocates what depends on the sizes of the macroscale problem, which are known after its set-up. */
static PetscErrorCode Allocate(LamBody body)
{
  LamMacroSizes *sizes = &body->sizes;
  PetscReal volume = 0;

  PetscFunctionBeginUser;
  if (body->u) PetscFunctionReturn(0);
  PetscCall(LamMacroGetSizes(body->macro, sizes));
  PetscCall(PetscCalloc5(sizes->points, &body->share, sizes->points, &body->membrane, sizes->points, &body->cells,
                         sizes->points, &body->opening, sizes->points, &body->drive));
  PetscCall(PetscCalloc3(sizes->displacements + 1, &body->u, sizes->elements * sizes->modes, &body->pressures,
                         sizes->points, &body->water));
  PetscCall(LamMacroGetVolumes(body->macro, body->share));
  for (PetscInt p = 0; p < sizes->points; p++) {
    volume += body->share[p];
    body->membrane[p] = body->process->cells.membrane;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPIU_REAL, MPIU_SUM, body->comm));
  for (PetscInt p = 0; p < sizes->points; p++) body->share[p] /= volume;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySetMembranes(LamBody body, const PetscReal membrane[])
{
  PetscFunctionBeginUser;
  PetscCall(Allocate(body));
  PetscCall(PetscArraycpy(body->membrane, membrane, body->sizes.points));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySetWalls(LamBody body,
                               PetscErrorCode (*set)(void *ctx, const PetscReal factor[LAM_WALL_PARAMETER_COUNT]),
                               void *ctx)
{
  PetscFunctionBeginUser;
  PetscCall(LamProcessSetWalls(body->process, set, ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySetMonitor(LamBody body, LamBodyMonitor monitor, void *ctx)
{
  PetscFunctionBeginUser;
  body->monitor = monitor;
  body->monitor_ctx = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyGetCounts(LamBody body, LamProcessCounts *counts)
{
  PetscFunctionBeginUser;
  *counts = body->process->counts;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyDestroy(LamBody *body)
{
  PetscFunctionBeginUser;
  if (!*body) PetscFunctionReturn(0);
  PetscCall(PetscFree5((*body)->share, (*body)->membrane, (*body)->cells, (*body)->opening, (*body)->drive));
  PetscCall(PetscFree3((*body)->u, (*body)->pressures, (*body)->water));
  PetscCall(LamProcessDestroy(&(*body)->process));
  PetscCall(PetscFree(*body));
  PetscFunctionReturn(0);
}

/* ---- state at a time ---- */

PetscErrorCode LamBodySetTime(LamBody body, PetscReal time, const PetscReal x[], PetscBool *ok)
{
  LamProcess process = body->process;
  LamEvaluation *now = &body->now;
  PetscReal ratio[LAM_WALL_PARAMETER_COUNT];

  PetscFunctionBeginUser;
  LamProcessProperties(process, time, x, now, ratio);
  *ok = (PetscBool)(now->walls > 0 && isfinite(now->walls));
  if (!*ok) {
    PetscCall(PetscStrncpy(process->trouble, "nothing is left of the walls", sizeof(process->trouble)));
    PetscFunctionReturn(0);
  }
  if (!process->walls_alike && memcmp(process->told_walls, ratio, sizeof(ratio)))
    PetscCall(LamMacroForget(body->macro));
  PetscCall(LamProcessTellWalls(process, ratio));
  if (process->spec->has_water) LamBodyDrives(body);
  PetscFunctionReturn(0);
}

LamMacroInstant LamBodyInstant(LamBody body, PetscReal time)
{
  const LamSegment *segment = &body->process->segment;
  const PetscReal elapsed = time - segment->start, turgor = body->process->scene->turgor;
  LamMacroInstant instant = {.load = LamRampAt(&segment->load, elapsed),
                             .turgor = 1,
                             .lamella = body->now.factor[LAM_CHANGING_LAMELLA].value,
                             .walls = body->now.walls};

  if (!body->process->spec->has_water && turgor != 0) instant.turgor = LamRampAt(&segment->turgor, elapsed) / turgor;
  return instant;
}

LamWaterMode LamBodyAtOnce(LamBody body)
{
  return isfinite(body->process->spec->water.permeability) ? LAM_WATER_GIVEN : LAM_WATER_OSMOSIS;
}

PetscErrorCode LamBodyFillWater(LamBody body)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < body->sizes.points && body->process->spec->has_water; p++) {
    LamMacroPoint point;
    PetscReal slope;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    body->water[p] = LamBodyProtoplast(body, p, PetscMax(point.load->turgor, 0), &slope);
  }
  PetscFunctionReturn(0);
}

/* Equilibrium under the conditions; it becomes the present state. */
static PetscErrorCode Balance(LamBody body, LamWaterMode mode, const LamMacroInstant *instant, PetscBool *ok)
{
  LamProcess process = body->process;

  PetscFunctionBeginUser;
  body->evaluated = NAN;
  body->mode = mode;
  PetscCall(LamMacroBalance(body->macro, instant, body->u, body->pressures, ok));
  process->counts.questions++;
  if (!*ok) {
    PetscCall(PetscStrncpy(process->trouble, LamMacroTrouble(body->macro), sizeof(process->trouble)));
    PetscCall(LamMacroStopped(body->macro, &process->stopped));
    PetscCall(LamMacroReject(body->macro));
    body->mode = LamBodyAtOnce(body);
    PetscFunctionReturn(0);
  }
  PetscCall(LamMacroAccept(body->macro));
  PetscCall(LamMacroGetState(body->macro, body->u, body->pressures));
  PetscCall(LamBodyFillWater(body));
  body->mode = LamBodyAtOnce(body);
  PetscFunctionReturn(0);
}

static PetscErrorCode Settle(LamBody body, LamWaterMode mode, PetscReal time, PetscBool *ok)
{
  const LamProcessTissue *tissue = &body->process->tissue;

  PetscFunctionBeginUser;
  PetscCall(LamBodySetTime(body, time, tissue->x, ok));
  if (!*ok) PetscFunctionReturn(0);
  const LamMacroInstant instant = LamBodyInstant(body, time);
  PetscCall(Balance(body, mode, &instant, ok));
  if (*ok) body->evaluated = time;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySettle(LamBody body, PetscReal time, PetscBool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(Settle(body, LamBodyAtOnce(body), time, ok));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySettleStep(LamBody body, PetscReal time, PetscReal c, PetscReal start[], PetscReal slope[],
                                 PetscBool *ok)
{
  PetscFunctionBeginUser;
  body->cj = c;
  body->start = start;
  body->slope = slope;
  PetscCall(Settle(body, LAM_WATER_PASSES, time, ok));
  PetscFunctionReturn(0);
}

/* ---- jumps ---- */

static PetscReal Between(PetscReal from, PetscReal to, PetscReal share)
{
  return from + share * (to - from);
}

/* Conditions during a jump. */
typedef struct {
  LamMacroInstant instant;
  PetscReal temperature, outside;
} Conditions;

static Conditions Mix(const Conditions *from, const Conditions *to, PetscReal share)
{
  Conditions mix = *to;

  mix.instant.load = Between(from->instant.load, to->instant.load, share);
  mix.instant.turgor = Between(from->instant.turgor, to->instant.turgor, share);
  mix.temperature = Between(from->temperature, to->temperature, share);
  mix.outside = Between(from->outside, to->outside, share);
  return mix;
}

/* Moves from one set of conditions to the other in as many steps as needed, without time passing; *reached: the last
   conditions with equilibrium. */
static PetscErrorCode Walk(LamBody body, const Conditions *from, const Conditions *to, Conditions *reached,
                           PetscBool *ok)
{
  LamProcess process = body->process;
  const LamSegment segment = process->segment;
  const LamProcessTissue *tissue = &process->tissue;
  PetscReal done = 0, step = 1;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  *reached = *from;
  while (done < 1 && !process->stopped) {
    const PetscReal next = PetscMin(1, done + step);
    const Conditions at = Mix(from, to, next);

    process->segment.temperature.from = at.temperature;
    process->segment.outside.from = at.outside;
    PetscCall(LamBodySetTime(body, tissue->time, tissue->x, ok));
    if (*ok) PetscCall(Balance(body, LamBodyAtOnce(body), &at.instant, ok));
    if (*ok) {
      done = next;
      step *= 2;
      *reached = at;
    } else {
      step = 0.5 * (next - done);
      if (step < PetscPowRealInt(0.5, MAX_HALVINGS)) break;
    }
  }
  process->segment = segment;
  if (process->stopped) *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Moves the body to an equilibrium under the conditions of the segment's start, also to remove errors of rounding and
   interpolation. If there is none, returns to the conditions `from`. */
static PetscErrorCode Jump(LamBody body, const Conditions *from, PetscBool *ok)
{
  LamProcess process = body->process;
  const LamSegment *segment = &process->segment;
  const Conditions to = {LamBodyInstant(body, process->tissue.time), segment->temperature.from, segment->outside.from};
  char why[sizeof(process->trouble)];
  Conditions reached, back;
  PetscBool returned;

  PetscFunctionBeginUser;
  PetscCall(Walk(body, from, &to, &reached, ok));
  if (*ok || process->stopped) PetscFunctionReturn(0);
  PetscCall(PetscStrncpy(why, process->trouble, sizeof(why)));
  PetscCall(Walk(body, &reached, from, &back, &returned));
  PetscCall(PetscStrncpy(process->trouble, why, sizeof(why)));
  PetscFunctionReturn(0);
}

/* Equilibrates the body at the start of the segment. */
static PetscErrorCode EnterSegment(LamBody body, PetscBool *ok)
{
  LamProcess process = body->process;
  LamProcessTissue *tissue = &process->tissue;
  const LamSegment *segment = &process->segment;
  Conditions from;

  PetscFunctionBeginUser;
  PetscCall(LamBodySetTime(body, tissue->time, tissue->x, ok));
  if (!*ok) PetscFunctionReturn(0);
  from = (Conditions){LamBodyInstant(body, tissue->time), tissue->temperature, tissue->outside};
  from.instant.load = tissue->load;
  from.instant.turgor = body->turgor_share;
  PetscCall(LamMacroForget(body->macro)); /* a cache may have been extended meanwhile */
  PetscCall(Jump(body, &from, ok));
  if (!*ok) PetscFunctionReturn(0);
  tissue->load = segment->load.from;
  body->turgor_share = LamBodyInstant(body, tissue->time).turgor;
  tissue->temperature = segment->temperature.from;
  tissue->outside = segment->outside.from;
  PetscCall(LamBodySetTime(body, tissue->time, tissue->x, ok));
  body->evaluated = tissue->time;
  PetscFunctionReturn(0);
}

/* ---- reports ---- */

/* Sums and extremes over the material points of the present state. */
static PetscErrorCode Summarise(LamBody body, LamBodyState *state)
{
  const LamStrength *strength = &body->process->scene->strength;
  const PetscReal lamella = body->now.factor[LAM_CHANGING_LAMELLA].value,
                  wall = body->now.factor[LAM_CHANGING_WALL_STRENGTH].value;
  PetscReal sum[3] = {0}, most[2 + LAM_RATIO_COUNT] = {-PETSC_INFINITY, -PETSC_INFINITY};

  PetscFunctionBeginUser;
  for (int k = 2; k < 2 + LAM_RATIO_COUNT; k++) most[k] = -PETSC_INFINITY;
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    most[0] = PetscMax(most[0], -point.load->turgor);
    most[1] = PetscMax(most[1], point.load->turgor);
    most[2] = PetscMax(most[2], point.field[LAM_POINT_NORMAL] / (lamella * strength->lamella_normal));
    most[3] = PetscMax(most[3], point.field[LAM_POINT_SHEAR] / (lamella * strength->lamella_shear));
    most[4] = PetscMax(most[4], point.field[LAM_POINT_WALL] / (wall * strength->wall));
    sum[0] += body->share[p] * body->water[p];
    sum[1] += body->share[p] * body->cells[p].water;
    if (point.load->turgor < LamBodyNoTurgor(body)) sum[2] += body->share[p];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, body->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2 + LAM_RATIO_COUNT, MPIU_REAL, MPIU_MAX, body->comm));
  state->turgor_min = -most[0];
  state->turgor_max = most[1];
  state->ratio[LAM_RATIO_LAMELLA_NORMAL] = isfinite(strength->lamella_normal) ? most[2] : NAN;
  state->ratio[LAM_RATIO_LAMELLA_SHEAR] = isfinite(strength->lamella_shear) ? most[3] : NAN;
  state->ratio[LAM_RATIO_WALL] = isfinite(strength->wall) ? most[4] : NAN;
  state->water = body->process->spec->has_water ? sum[0] / sum[1] : NAN;
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
  PetscCall(LamBodyExcess(body, 1, &event, &excess, &p));
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

static PetscErrorCode TellEvent(LamBody body, LamEvent event)
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

PetscErrorCode LamBodyTell(LamBody body, const PetscBool happened[LAM_EVENT_COUNT])
{
  LamProcess process = body->process;

  PetscFunctionBeginUser;
  if (!happened) PetscCall(TellEvent(body, LAM_EVENT_COUNT));
  for (PetscInt k = 0; k < LAM_EVENT_COUNT && happened; k++) {
    if (!happened[k]) continue;
    if (k == LAM_EVENT_TURGOR_LOST || k == LAM_EVENT_TURGOR_FOUND)
      process->plasmolysed = (PetscBool)(k == LAM_EVENT_TURGOR_LOST); /* at some point */
    else
      process->found[k] = PETSC_TRUE;
    PetscCall(TellEvent(body, (LamEvent)k));
  }
  PetscFunctionReturn(0);
}

/* ---- time loop ---- */

/* Reports events that have occurred at the present state, such as those passed in a jump at the start of a segment. */
static PetscErrorCode TellPassed(LamBody body)
{
  PetscBool happened[LAM_EVENT_COUNT] = {PETSC_FALSE};
  LamEvent events[LAM_EVENT_COUNT];
  const PetscInt n = LamBodyListEvents(body, events);
  PetscReal excess[LAM_EVENT_COUNT];
  PetscInt points[LAM_EVENT_COUNT];

  PetscFunctionBeginUser;
  PetscCall(LamBodyExcess(body, n, events, excess, points));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, excess, (PetscMPIInt)n, MPIU_REAL, MPIU_MAX, body->comm));
  for (PetscInt k = 0; k < n; k++)
    happened[events[k]] = (PetscBool)(events[k] == LAM_EVENT_TURGOR_FOUND ? excess[k] < 0 : excess[k] > 0);
  PetscCall(LamBodyTell(body, happened));
  PetscFunctionReturn(0);
}

static PetscErrorCode FollowSegment(LamBody body, PetscBool *ok)
{
  const PetscReal none[9] = {0};
  LamProcess process = body->process;
  const LamSegment before = process->segment;
  PetscBool happened[LAM_EVENT_COUNT] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  LamProcessNextSegment(process, &process->segment);
  PetscCall(EnterSegment(body, ok));
  if (!*ok) { /* the body is still at the end of the previous segment */
    process->segment = before;
    PetscFunctionReturn(0);
  }
  PetscCall(TellPassed(body));
  if (process->next_output <= process->tissue.time) {
    PetscCall(LamBodyTell(body, NULL));
    LamProcessNextOutput(process);
  }
  if (process->segment.end > process->segment.start) PetscCall(LamBodyIntegrate(body, happened, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamBodyTell(body, happened));
  LamProcessEndSegment(process, none);
  PetscFunctionReturn(0);
}

static PetscErrorCode Start(LamBody body, PetscBool *ok, char message[LAM_PROCESS_MESSAGE])
{
  LamProcess process = body->process;
  LamProcessTissue *tissue = &process->tissue;
  char why[LAM_MESSAGE_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(Allocate(body));
  LamProcessClear(process);
  LamProcessStartProgram(process, (const PetscReal[9]){0});
  LamProcessNextSegment(process, &process->segment);
  process->temperature = tissue->temperature = process->segment.temperature.from;
  tissue->outside = process->segment.outside.from;
  body->told = 0;
  body->turgor_share = 1;
  body->clock = LamClock();
  PetscCall(LamBodySetTime(body, 0, tissue->x, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamMacroStart(body->macro, ok, why));
  PetscCall(PetscStrncpy(message, why, LAM_PROCESS_MESSAGE));
  PetscCall(LamMacroStopped(body->macro, &process->stopped));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamMacroGetState(body->macro, body->u, body->pressures));
  process->pressure = PetscMax(1e-3, process->scene->turgor);
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    body->opening[p] = point.field[LAM_POINT_OPENING];
  }
  if (process->spec->has_water) PetscCall(LamBodyWaterCreate(body));
  if (process->spec->has_water && isfinite(process->spec->water.osmotic) && LamBodyAtOnce(body) == LAM_WATER_OSMOSIS)
    tissue->outside = process->spec->water.osmotic - process->scene->turgor / process->spec->water.reflection;
  for (PetscInt p = 0; p < body->sizes.points && process->spec->has_water; p++)
    process->pressure = PetscMax(process->pressure, body->cells[p].osmotic);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &process->pressure, 1, MPIU_REAL, MPIU_MAX, body->comm));
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    if (point.load->turgor < LamBodyNoTurgor(body)) process->plasmolysed = PETSC_TRUE; /* from the start: no event */
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &process->plasmolysed, 1, MPIU_BOOL, MPI_LOR, body->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode FollowAll(LamBody body, PetscBool *ok, char message[LAM_PROCESS_MESSAGE])
{
  LamProcess process = body->process;

  PetscFunctionBeginUser;
  PetscCall(Start(body, ok, message));
  while (*ok && !process->stopped && process->tissue.time < process->spec->duration) PetscCall(FollowSegment(body, ok));
  PetscFunctionReturn(0);
}

/* Reports the last state if the run ends early. */
static PetscErrorCode TellLast(LamBody body)
{
  char why[sizeof(body->process->trouble)];
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(why, body->process->trouble, sizeof(why)));
  PetscCall(LamBodySettle(body, body->process->tissue.time, &ok));
  if (ok) PetscCall(LamBodyTell(body, NULL));
  PetscCall(PetscStrncpy(body->process->trouble, why, sizeof(why)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyRun(LamBody body, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE])
{
  LamProcess process = body->process;
  PetscBool ok = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCheck(
      process->walls_alike || process->set_walls, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "%s: process.kinetics: the parameters of the walls do not change alike, and what answers knows only tissue "
      "whose walls keep their proportions; solve directly",
      process->scene->path);
  message[0] = '\0';
  PetscCall(FollowAll(body, &ok, message));
  *reason = process->stopped ? LAM_PROCESS_STOPPED : ok ? LAM_PROCESS_DONE : LAM_PROCESS_ENDED;
  if (*reason != LAM_PROCESS_ENDED || message[0]) PetscFunctionReturn(0);
  if (process->tissue.time > 0) PetscCall(TellLast(body));
  PetscCall(PetscSNPrintf(message, LAM_PROCESS_MESSAGE, "ended at %.6g s: %s", (double)process->tissue.time,
                          process->trouble));
  PetscFunctionReturn(0);
}
