/*
  What `lamella process` tells of each output and event.
*/
#include "process_run.h"
#include <lamella/clock.h>
#include <math.h>
#include <string.h>

const char *LamTimeUnit(PetscReal duration, PetscReal *seconds)
{
  static const struct {
    const char *name;
    PetscReal seconds;
  } units[] = {{"day", 86400}, {"h", 3600}, {"min", 60}, {"s", 1}};
  size_t k = 0;

  while (k + 1 < PETSC_STATIC_ARRAY_LENGTH(units) && duration < 2 * units[k].seconds) k++;
  *seconds = units[k].seconds;
  return units[k].name;
}

static const char *EventName(const LamProcessState *state)
{
  return state->event == LAM_EVENT_COUNT ? "" : LamEventNames[state->event];
}

/* ---- JSON ---- */

/* Strength that the state still has, over what is asked of it: at 1 it gives way. */
static void SetStrengths(json_t *o, const LamProcessState *state, const LamStrength *strength)
{
  const LamResponse *r = &state->response;
  const PetscReal lamella = state->factor[LAM_CHANGING_LAMELLA], wall = state->factor[LAM_CHANGING_WALL_STRENGTH];

  if (isfinite(strength->lamella_normal))
    json_object_set_new(o, "lamella_normal_ratio", LamJSONReal(r->max_traction / (lamella * strength->lamella_normal)));
  if (isfinite(strength->lamella_shear))
    json_object_set_new(o, "lamella_shear_ratio",
                        LamJSONReal(r->max_lamella_shear / (lamella * strength->lamella_shear)));
  if (isfinite(strength->wall))
    json_object_set_new(o, "wall_ratio", LamJSONReal(r->max_wall_tension / (wall * strength->wall)));
}

static json_t *FactorsToJSON(const LamProcessState *state, const LamProcessSpec *spec)
{
  json_t *o = json_object();

  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++)
    if (spec->kinetics[k].law != LAM_KINETIC_CONSTANT)
      json_object_set_new(o, LamChangingNames[k], LamJSONReal(state->factor[k]));
  return o;
}

static PetscErrorCode ReportJSON(const LamProcessRunState *run, const LamProcessState *state)
{
  const LamScales *scales = &run->scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o;

  PetscFunctionBeginUser;
  PetscCall(LamResponseToJSON(&state->response, scales, run->history.count, PETSC_FALSE, &o));
  json_object_set_new(o, "time", LamJSONReal(state->time));
  json_object_set_new(o, "temperature", LamJSONReal(state->temperature));
  json_object_set_new(o, "F_inflated", LamJSONReals(9, state->F, 1));
  json_object_set_new(o, "water", LamJSONReal(state->water));
  json_object_set_new(o, "osmotic_pressure", LamJSONReal(state->osmotic * MPa));
  json_object_set_new(o, "outside", LamJSONReal(state->outside * MPa));
  json_object_set_new(o, "firmness", LamJSONReal(state->firmness * MPa));
  json_object_set_new(o, "walls", LamJSONReal(state->walls));
  json_object_set_new(o, "factors", FactorsToJSON(state, &run->scene->process));
  SetStrengths(o, state, &run->scene->strength);
  if (state->event != LAM_EVENT_COUNT) json_object_set_new(o, "event", json_string(EventName(state)));
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

/* ---- table ---- */

static void PrintHeader(const LamProcessRunState *run, const char unit[])
{
  const PetscBool contact = (PetscBool)(run->scene->micro.interface == LAM_INTERFACE_CONTACT);

  printf("%10s %8s %9s %9s %9s %9s %9s %9s %9s", "time", "temp.", "turgor", "osmotic", "lamella", "walls", "firmness",
         "F11", "F22");
  printf(contact ? " %9s %8s" : " %9s %9s", contact ? "opening" : "traction", contact ? "debonded" : "tension");
  printf("  %s\n", "event");
  printf("%10s %8s %9s %9s %9s %9s %9s %9s %9s", unit, "degC", "MPa", "MPa", "share", "share", "MPa", "", "");
  printf(contact ? " %9s %8s" : " %9s %9s", contact ? "of V0" : "MPa", contact ? "share" : "MPa");
  printf("\n");
}

static void PrintNumber(int width, PetscReal number)
{
  if (isfinite(number))
    printf(" %*.4g", width, (double)number);
  else
    printf(" %*s", width, "-");
}

static PetscErrorCode PrintRow(const LamProcessRunState *run, const LamProcessState *state)
{
  const PetscReal MPa = run->scene->scales.stress * 1e-6;
  const PetscBool contact = (PetscBool)(run->scene->micro.interface == LAM_INTERFACE_CONTACT);
  const LamResponse *r = &state->response;
  PetscReal seconds;
  const char *unit = LamTimeUnit(run->scene->process.duration, &seconds);

  PetscFunctionBeginUser;
  if (run->history.count == 1) PrintHeader(run, unit);
  printf("%10.5g %8.4g", (double)(state->time / seconds), (double)(state->temperature - 273.15));
  PrintNumber(9, state->turgor * MPa);
  PrintNumber(9, state->osmotic * MPa);
  PrintNumber(9, state->factor[LAM_CHANGING_LAMELLA]);
  PrintNumber(9, state->walls);
  PrintNumber(9, state->firmness * MPa);
  PrintNumber(9, state->F[0]);
  PrintNumber(9, state->F[4]);
  PrintNumber(9, contact ? r->opening_fraction : r->max_traction * MPa);
  PrintNumber(contact ? 8 : 9, contact ? r->debonded_fraction : r->max_wall_tension * MPa);
  printf("  %s\n", EventName(state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessReport(const LamProcessRunState *run)
{
  const LamProcessState *state = &run->history.states[run->history.count - 1];

  PetscFunctionBeginUser;
  if (run->json)
    PetscCall(ReportJSON(run, state));
  else
    PetscCall(PrintRow(run, state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessReportEnd(const LamProcessRunState *run, LamProcessReason reason, const char message[])
{
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  if (reason == LAM_PROCESS_ENDED) fprintf(stderr, "lamella process: %s: %s\n", run->scene->path, message);
  if (run->json) PetscFunctionReturn(0);
  PetscCall(LamProcessGetCounts(run->process, &counts));
  printf("%d steps of time, %d questions, %.3g s\n", (int)counts.steps, (int)counts.questions,
         (double)(LamClock() - run->start));
  if (run->out_path) printf("wrote %s\n", run->out_path);
  PetscFunctionReturn(0);
}
