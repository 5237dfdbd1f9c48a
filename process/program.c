/*
  Prescribed quantities and surroundings of the tissue at a time.

  All of them are linear in time between the times at which something jumps or has a kink: the entries of the
  surroundings, the points of tabulated kinetics, the ends of the parts of the load program. A segment is the interval
  between two such times.
*/
#include "process_impl.h"
#include <math.h>

static PetscBool IsOver(LamProcess process)
{
  return (PetscBool)(process->cycle >= process->spec->repeat);
}

/* The present part of the program, or its last part once it is over. */
static const LamProcessLeg *Leg(LamProcess process)
{
  return &process->spec->legs[IsOver(process) ? process->spec->leg_count - 1 : process->leg];
}

static void StartLeg(LamProcess process, const PetscReal P[9])
{
  process->leg_start = process->tissue.time;
  process->leg_load = process->tissue.load;
  for (int i = 0; i < 9; i++) {
    process->leg_F[i] = process->tissue.F[i];
    process->leg_P[i] = P[i];
  }
}

void LamProcessStartProgram(LamProcess process, const PetscReal P[9])
{
  process->leg = process->cycle = 0;
  StartLeg(process, P);
}

/* ---- surroundings ---- */

static void Surround(LamProcess process, LamSegment *segment)
{
  const LamSurroundings *at = process->spec->surroundings;
  const PetscInt n = process->spec->surroundings_count;
  const PetscReal t = segment->start;
  PetscInt after = 0;

  while (after < n && at[after].time <= t + LamTimeTolerance(process)) after++;
  const LamSurroundings *a = &at[PetscMax(after - 1, 0)], *b = &at[PetscMin(after, n - 1)];
  const PetscReal span = b->time - a->time, share = span > 0 ? (t - a->time) / span : 0;

#define STRAIGHT(member)                                                                                               \
  (LamRamp){a->member + share * (b->member - a->member), span > 0 ? (b->member - a->member) / span : 0}
  segment->temperature = STRAIGHT(temperature);
  segment->outside = STRAIGHT(outside);
  segment->turgor = STRAIGHT(turgor);
  if (after < n) segment->end = PetscMin(segment->end, at[after].time);
}

static void EndAtTables(LamProcess process, LamSegment *segment)
{
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    const LamKinetics *kinetics = &process->spec->kinetics[k];

    for (PetscInt i = 0; i < kinetics->count; i++)
      if (kinetics->time[i] > segment->start + LamTimeTolerance(process))
        segment->end = PetscMin(segment->end, kinetics->time[i]);
  }
}

/* ---- load ---- */

/* The loads of the body have a kink where the load parameter passes a point of a history. */
static void EndAtHistories(LamProcess process, LamSegment *segment)
{
  const LamMacroSpec *macro = &process->scene->macro;

  if (segment->load.slope == 0) return;
  for (PetscInt b = 0; b < macro->boundary_count; b++)
    for (PetscInt k = 0; k < macro->boundary[b].history.count; k++) {
      const PetscReal after = (macro->boundary[b].history.parameter[k] - segment->load.from) / segment->load.slope;

      if (after > LamTimeTolerance(process)) segment->end = PetscMin(segment->end, segment->start + after);
    }
}

/* A stress that a part prescribes, per area at rest. */
static PetscReal Prescribed(LamProcess process, const LamProcessLeg *leg, int i)
{
  const PetscReal *F0 = process->inflation, J0 = F0[0] * F0[4] * F0[8];

  return leg->control.P[i] * (process->spec->area == LAM_AREA_INFLATED ? J0 / F0[4 * (i % 3)] : 1);
}

static void Load(LamProcess process, LamSegment *segment)
{
  const LamProcessLeg *leg = Leg(process);
  const PetscBool moves = (PetscBool)(!IsOver(process) && leg->duration > 0);
  const PetscReal share = moves ? (segment->start - process->leg_start) / leg->duration : 1;

  for (int i = 0; i < 9; i++) {
    const PetscReal dF = leg->F[i] - process->leg_F[i], dP = Prescribed(process, leg, i) - process->leg_P[i];

    segment->given[i] = leg->control.given[i];
    segment->F[i] = (LamRamp){process->leg_F[i] + share * dF, moves ? dF / leg->duration : 0};
    segment->P[i] = (LamRamp){process->leg_P[i] + share * dP, moves ? dP / leg->duration : 0};
  }
  segment->load = (LamRamp){process->leg_load + share * (leg->load - process->leg_load),
                            moves ? (leg->load - process->leg_load) / leg->duration : 0};
  if (IsOver(process)) return;
  segment->end = PetscMin(segment->end, process->leg_start + leg->duration);
  EndAtHistories(process, segment);
}

void LamProcessNextSegment(LamProcess process, LamSegment *segment)
{
  segment->start = process->tissue.time;
  segment->end = process->spec->duration;
  Surround(process, segment);
  EndAtTables(process, segment);
  Load(process, segment);
  if (segment->end - segment->start < LamTimeTolerance(process)) segment->end = segment->start;
  if (process->spec->duration - segment->end < LamTimeTolerance(process)) segment->end = process->spec->duration;
}

void LamProcessEndSegment(LamProcess process, const PetscReal P[9])
{
  const LamProcessLeg *leg = Leg(process);
  PetscReal stress[9];

  if (IsOver(process) || process->tissue.time < process->leg_start + leg->duration - LamTimeTolerance(process)) return;
  for (int i = 0; i < 9; i++) stress[i] = leg->control.given[i] ? Prescribed(process, leg, i) : P[i];
  if (++process->leg == process->spec->leg_count) {
    process->leg = 0;
    process->cycle++;
  }
  StartLeg(process, stress);
}

/* ---- outputs ---- */

/* A part of the program: number, repetition, and the time at which it begins. */
typedef struct {
  PetscInt leg, cycle;
  PetscReal start;
} Part;

static const LamProcessLeg *LegOf(LamProcess process, const Part *part)
{
  return part->cycle < process->spec->repeat ? &process->spec->legs[part->leg] : NULL;
}

/* The sums are those of StartLeg, so that ends of parts are the same numbers. */
static void Advance(LamProcess process, Part *part)
{
  part->start += process->spec->legs[part->leg].duration;
  if (++part->leg < process->spec->leg_count) return;
  part->leg = 0;
  part->cycle++;
}

PetscReal LamProcessOutputInterval(LamProcess process)
{
  const Part part = {process->leg, process->cycle, process->leg_start};
  const LamProcessLeg *leg = LegOf(process, &part);

  return leg && leg->output > 0 ? leg->output : process->spec->output;
}

/* The first multiple of an interval, counted from `start`, after a time. */
static PetscReal NextMultiple(PetscReal start, PetscReal interval, PetscReal time)
{
  const PetscReal rounding = 1e-6; /* of the interval: more than a million outputs have, less than anyone sees */

  return start + (PetscFloorReal((time - start) / interval + rounding) + 1) * interval;
}

/* Multiples of the interval of the process; within a part that has its own, multiples of that, its start and its end.
 */
void LamProcessNextOutput(LamProcess process)
{
  const PetscReal end = process->spec->duration, now = process->next_output, tolerance = LamTimeTolerance(process);
  Part part = {process->leg, process->cycle, process->leg_start};
  const LamProcessLeg *leg;

  if (now >= end) {
    process->next_output = PETSC_INFINITY;
    return;
  }
  while ((leg = LegOf(process, &part)) && part.start + leg->duration <= now + tolerance) Advance(process, &part);
  if (leg && leg->output > 0) {
    process->next_output = PetscMin(NextMultiple(part.start, leg->output, now), part.start + leg->duration);
  } else {
    process->next_output = NextMultiple(0, process->spec->output, now);
    for (; leg && part.start < process->next_output; leg = LegOf(process, &part)) {
      if (leg->output > 0 && leg->duration > 0) process->next_output = part.start;
      Advance(process, &part);
    }
  }
  if (process->next_output > end * (1 - 1e-12)) process->next_output = end; /* the last one */
}

/* ---- the start ---- */

PetscErrorCode LamProcessBegin(LamProcess process)
{
  LamProcessTissue *tissue = &process->tissue;

  PetscFunctionBeginUser;
  PetscCheck(!process->changes_tissue || process->set_tissue, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: process.kinetics: the parameters of the walls do not change alike, and the source of responses knows "
             "only tissue "
             "whose walls keep their proportions; solve directly",
             process->scene->path);
  *tissue = (LamProcessTissue){.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++)
    LamKineticsStart(&process->spec->kinetics[k], &tissue->x[LAM_KINETIC_STATES * k]);
  for (int i = 0; i < 9; i++) process->inflation[i] = i % 4 == 0 ? 1 : 0;
  process->plasmolysed = process->stopped = process->last_known = process->reference_response_known = PETSC_FALSE;
  for (PetscInt k = 0; k < LAM_EVENT_COUNT; k++) process->found[k] = PETSC_FALSE;
  process->passed = (LamTissueFactors){.lamella = 1, .wall_strength = 1};
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) process->passed.walls[k] = 1;
  process->next_output = 0;
  process->snaps = 0;
  process->accepted = -PETSC_INFINITY;
  process->counts = (LamProcessCounts){0};
  LamProcessStartProgram(process, (const PetscReal[9]){0});
  LamProcessNextSegment(process, &process->segment);
  process->temperature = tissue->temperature = process->segment.temperature.from;
  tissue->outside = process->segment.outside.from;
  PetscFunctionReturn(0);
}
