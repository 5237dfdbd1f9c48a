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
               "%s: process.surroundings: turgor in a body is a multiple of rve.turgor, which is not above 0; "
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
  PetscCall(LamBodyTransportCreate(*body));
  PetscFunctionReturn(0);
}

/* Allocates what depends on the sizes of the macroscale problem, which are known after its set-up. */
static PetscErrorCode Allocate(LamBody body)
{
  LamMacroSizes *sizes = &body->sizes;
  PetscReal *volume = &body->volume;

  PetscFunctionBeginUser;
  if (body->u) PetscFunctionReturn(0);
  PetscCall(LamMacroGetSizes(body->macro, sizes));
  PetscCall(PetscCalloc5(sizes->points, &body->share, sizes->points, &body->membrane, sizes->points, &body->cells,
                         sizes->points, &body->opening, sizes->points, &body->drive));
  PetscCall(PetscCalloc4(sizes->displacements + 1, &body->u, sizes->elements * sizes->modes, &body->pressures,
                         sizes->potentials, &body->potentials, sizes->points, &body->water));
  PetscCall(LamMacroGetVolumes(body->macro, body->share));
  for (PetscInt p = 0; p < sizes->points; p++) {
    *volume += body->share[p];
    body->membrane[p] = body->process->cells.membrane;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, volume, 1, MPIU_REAL, MPIU_SUM, body->comm));
  for (PetscInt p = 0; p < sizes->points; p++) body->share[p] /= *volume;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySetMembranes(LamBody body, const PetscReal membrane[])
{
  PetscFunctionBeginUser;
  PetscCall(Allocate(body));
  PetscCall(PetscArraycpy(body->membrane, membrane, body->sizes.points));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySetTissue(LamBody body, PetscErrorCode (*set)(void *ctx, const LamTissueFactors *factors),
                                void *ctx)
{
  PetscFunctionBeginUser;
  PetscCall(LamProcessSetTissue(body->process, set, ctx));
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
  PetscCall(PetscFree4((*body)->u, (*body)->pressures, (*body)->potentials, (*body)->water));
  PetscCall(LamProcessDestroy(&(*body)->process));
  PetscCall(PetscFree(*body));
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
    if (*ok) PetscCall(LamBodyBalance(body, LamBodyAtOnce(body), &at.instant, ok));
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

/* ---- time loop ---- */

/* Reports events that have occurred at the present state, such as those passed in a jump at the start of a segment. */
static PetscErrorCode ReportPassed(LamBody body)
{
  PetscBool happened[LAM_EVENT_COUNT] = {PETSC_FALSE};
  LamEvent events[LAM_EVENT_COUNT];
  const PetscInt n = LamBodyListEvents(body, events);
  PetscReal excess[LAM_EVENT_COUNT];

  PetscFunctionBeginUser;
  PetscCall(LamBodyExcess(body, n, events, excess));
  for (PetscInt k = 0; k < n; k++) happened[events[k]] = (PetscBool)(excess[k] > 0);
  PetscCall(LamBodyReport(body, happened));
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
  PetscCall(ReportPassed(body));
  if (process->next_output <= process->tissue.time) {
    PetscCall(LamBodyReport(body, NULL));
    LamProcessNextOutput(process);
  }
  if (process->segment.end > process->segment.start) PetscCall(LamBodyIntegrate(body, happened, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamBodyReport(body, happened));
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
  PetscCall(LamProcessBegin(process));
  body->told = 0;
  body->turgor_share = 1;
  body->clock = LamClock();
  PetscCall(LamBodySetTime(body, 0, tissue->x, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamMacroStart(body->macro, ok, why));
  PetscCall(PetscStrncpy(message, why, LAM_PROCESS_MESSAGE));
  PetscCall(LamMacroStopped(body->macro, &process->stopped));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamMacroGetState(body->macro, body->u, body->pressures, body->potentials));
  process->pressure = PetscMax(1e-3, process->scene->turgor);
  if (process->spec->has_water) PetscCall(LamBodyWaterCreate(body));
  if (process->spec->has_water && isfinite(process->spec->water.osmotic) && LamBodyAtOnce(body) == LAM_WATER_OSMOSIS)
    tissue->outside = process->spec->water.osmotic - process->scene->turgor / process->spec->water.reflection;
  for (PetscInt p = 0; p < body->sizes.points && process->spec->has_water; p++)
    process->pressure = PetscMax(process->pressure, body->cells[p].osmotic);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &process->pressure, 1, MPIU_REAL, MPIU_MAX, body->comm));
  for (PetscInt p = 0; p < body->sizes.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    body->opening[p] = point.field[LAM_POINT_OPENING];
    if (point.load->turgor < LamBodyNoTurgor(body)) process->plasmolysed = PETSC_TRUE; /* from the start: no event */
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &process->plasmolysed, 1, MPIU_BOOL, MPI_LOR, body->comm));
  PetscFunctionReturn(0);
}

/* Reports the last state if the run ends early. */
static PetscErrorCode ReportLast(LamBody body)
{
  char why[sizeof(body->process->trouble)];
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(why, body->process->trouble, sizeof(why)));
  PetscCall(LamBodySettle(body, LamBodyAtOnce(body), body->process->tissue.time, &ok));
  if (ok) PetscCall(LamBodyReport(body, NULL));
  PetscCall(PetscStrncpy(body->process->trouble, why, sizeof(why)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyRun(LamBody body, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE])
{
  LamProcess process = body->process;
  PetscBool ok = PETSC_TRUE;

  PetscFunctionBeginUser;
  message[0] = '\0';
  PetscCall(Start(body, &ok, message));
  while (ok && !process->stopped && process->tissue.time < process->spec->duration) PetscCall(FollowSegment(body, &ok));
  *reason = process->stopped ? LAM_PROCESS_STOPPED : ok ? LAM_PROCESS_DONE : LAM_PROCESS_ENDED;
  if (*reason != LAM_PROCESS_ENDED || message[0]) PetscFunctionReturn(0);
  if (process->tissue.time > 0) PetscCall(ReportLast(body));
  PetscCall(PetscSNPrintf(message, LAM_PROCESS_MESSAGE, "ended at %.6g s: %s", (double)process->tissue.time,
                          process->trouble));
  PetscFunctionReturn(0);
}
