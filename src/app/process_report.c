/*
  Reports of tissue that changes in time, at a material point or of a body: each output and event.
*/
#include "app.h"
#include "plot_time.h"
#include "process_report.h"
#include "clock.h"
#include <math.h>

/* ---- of both ---- */

static const char *EventName(LamEvent event)
{
  return event == LAM_EVENT_COUNT ? "" : LamEventNames[event];
}

static json_t *FactorsToJSON(const LamProcessSpec *spec, const PetscReal factor[])
{
  json_t *o = json_object();

  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++)
    if (spec->kinetics[k].law != LAM_KINETIC_CONSTANT)
      json_object_set_new(o, LamChangingNames[k], LamJSONReal(factor[k]));
  return o;
}

/* The known ratios, and the event, if it is one. */
static void AddRatios(json_t *o, const PetscReal ratio[], LamEvent event)
{
  char name[LAM_NAME_LENGTH];

  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    if (!isfinite(ratio[k])) continue;
    snprintf(name, sizeof(name), "%s_ratio", LamRatioNames[k]);
    json_object_set_new(o, name, LamJSONReal(ratio[k]));
  }
  if (event != LAM_EVENT_COUNT) json_object_set_new(o, "event", json_string(LamEventNames[event]));
}

static void PrintNumber(int width, PetscReal number)
{
  if (isfinite(number))
    printf(" %*.4g", width, (double)number);
  else
    printf(" %*s", width, "-");
}

/* ---- at a material point ---- */

static PetscErrorCode PrintPointObject(const LamProcessStudy *study, const LamProcessState *state)
{
  const LamScales *scales = &study->scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o;

  PetscFunctionBeginUser;
  PetscCall(LamResponseToJSON(&state->response, scales, study->history.count, PETSC_FALSE, &o));
  json_object_set_new(o, "time", LamJSONReal(state->time));
  json_object_set_new(o, "temperature", LamJSONReal(state->temperature));
  json_object_set_new(o, "F_inflated", LamJSONReals(9, state->F, 1));
  json_object_set_new(o, "water", LamJSONReal(state->water));
  json_object_set_new(o, "osmotic_pressure", LamJSONReal(state->osmotic * MPa));
  json_object_set_new(o, "outside", LamJSONReal(state->outside * MPa));
  json_object_set_new(o, "firmness", LamJSONReal(state->firmness * MPa));
  json_object_set_new(o, "walls", LamJSONReal(state->walls));
  json_object_set_new(o, "factors", FactorsToJSON(&study->scene->process, state->factor));
  AddRatios(o, state->ratio, state->event);
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

static void PrintPointHeader(const LamProcessStudy *study, const char unit[])
{
  const PetscBool contact = (PetscBool)(study->scene->micro.interface == LAM_INTERFACE_CONTACT);

  printf("%10s %8s %9s %9s %9s %9s %9s %9s %9s", "time", "temp.", "turgor", "osmotic", "lamella", "walls", "firmness",
         "F11", "F22");
  printf(contact ? " %9s %8s" : " %9s %9s", contact ? "opening" : "traction", contact ? "debonded" : "tension");
  printf("  %s\n", "event");
  printf("%10s %8s %9s %9s %9s %9s %9s %9s %9s", unit, "degC", "MPa", "MPa", "share", "share", "MPa", "", "");
  printf(contact ? " %9s %8s" : " %9s %9s", contact ? "of V0" : "MPa", contact ? "share" : "MPa");
  printf("\n");
}

static PetscErrorCode PrintPointRow(const LamProcessStudy *study, const LamProcessState *state)
{
  const PetscReal MPa = study->scene->scales.stress * 1e-6;
  const PetscBool contact = (PetscBool)(study->scene->micro.interface == LAM_INTERFACE_CONTACT);
  const LamResponse *r = &state->response;
  PetscReal seconds;
  const char *unit = LamTimeUnit(study->scene->process.duration, &seconds);

  PetscFunctionBeginUser;
  if (study->history.count == 1) PrintPointHeader(study, unit);
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
  printf("  %s\n", EventName(state->event));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessReport(void *ctx, const LamProcessStudy *study)
{
  const LamConsole *console = (const LamConsole *)ctx;
  const LamProcessState *state = &study->history.states[study->history.count - 1];

  PetscFunctionBeginUser;
  if (console->json)
    PetscCall(PrintPointObject(study, state));
  else
    PetscCall(PrintPointRow(study, state));
  PetscFunctionReturn(0);
}

/* Warns of events that were found by a database alone from indicators of low accuracy. */
static void WarnOfIndicators(const LamProcessStudy *study)
{
  PetscInt doubtful = 0;

  for (PetscInt k = 0; k < study->history.count; k++)
    doubtful +=
        study->history.states[k].event != LAM_EVENT_COUNT && !study->history.states[k].response.indicators_trusted;
  if (doubtful)
    fprintf(
        stderr,
        "lamella process: events that rest on tractions or gaps of which the database's states around do not agree: "
        "%d; --response cache solves there\n",
        (int)doubtful);
}

PetscErrorCode LamProcessReportEnd(const LamConsole *console, const LamProcessStudy *study, LamProcessReason reason,
                                   const char message[])
{
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  if (!console->quiet) WarnOfIndicators(study);
  if (reason == LAM_PROCESS_ENDED) fprintf(stderr, "lamella process: %s: %s\n", study->scene->path, message);
  if (console->json) PetscFunctionReturn(0);
  PetscCall(LamProcessGetCounts(study->process, &counts));
  printf("%d steps of time, %d questions, %.3g s\n", (int)counts.steps, (int)counts.questions,
         (double)(LamClock() - study->start));
  if (study->out_path) printf("wrote %s\n", study->out_path);
  PetscFunctionReturn(0);
}

/* ---- of a body ---- */

static json_t *BodyToJSON(const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamScales *scales = &study->fe2.scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o = LamFE2StepToJSON(&study->fe2, &state->step, peak_memory);

  json_object_set_new(o, "time", LamJSONReal(state->time));
  json_object_set_new(o, "temperature", LamJSONReal(state->temperature));
  json_object_set_new(o, "outside", LamJSONReal(state->outside * MPa));
  json_object_set_new(o, "walls", LamJSONReal(state->walls));
  json_object_set_new(o, "factors", FactorsToJSON(&study->fe2.scene->process, state->factor));
  json_object_set_new(o, "water", LamJSONReal(state->water));
  json_object_set_new(o, "turgor_min", LamJSONReal(state->turgor_min * MPa));
  json_object_set_new(o, "turgor_max", LamJSONReal(state->turgor_max * MPa));
  json_object_set_new(o, "plasmolysed", LamJSONReal(state->plasmolysed));
  AddRatios(o, state->ratio, state->event);
  if (state->event == LAM_EVENT_COUNT) return o;
  json_object_set_new(o, "element", json_integer((json_int_t)state->element));
  json_object_set_new(o, "point", json_integer((json_int_t)state->point));
  json_object_set_new(o, "place", LamJSONReals(2, state->place, scales->macro_length * 1e3));
  return o;
}

static void PrintBodyHeader(const LamBodyStudy *study, const LamBodyState *state, const char unit[])
{
  const LamMacroStep *step = &state->step;

  printf("Turgor: least, mean and largest; reactions in N per mm of thickness.\n");
  printf("%10s %8s %8s %8s %8s %7s %7s %7s %8s", "time", "temp.", "turgor", "turgor", "turgor", "water", "lamella",
         "walls", "load");
  for (PetscInt s = 0; s < step->boundary_count; s++)
    for (int i = 0; i < 2; i++) printf(" %*s.%c", 9, step->boundary[s], "xy"[i]);
  printf(" %8s  event\n", "debonded");
  printf("%10s %8s %8s %8s %8s %7s %7s %7s\n", unit, "degC", "MPa", "MPa", "MPa", "share", "share", "share");
}

static void PrintBodyRow(const LamBodyStudy *study, const LamBodyState *state)
{
  const LamScene *scene = study->fe2.scene;
  const LamMacroStep *step = &state->step;
  const PetscReal MPa = scene->scales.stress * 1e-6, mm = scene->scales.macro_length * 1e3;
  const PetscReal force = scene->scales.stress * scene->scales.macro_length * 1e-3;
  PetscReal seconds;
  const char *unit = LamTimeUnit(scene->process.duration, &seconds);

  if (study->history.count == 1) PrintBodyHeader(study, state, unit);
  printf("%10.6g %8.4g", (double)(state->time / seconds), (double)(state->temperature - 273.15));
  PrintNumber(8, state->turgor_min * MPa);
  PrintNumber(8, step->turgor_mean * MPa);
  PrintNumber(8, state->turgor_max * MPa);
  PrintNumber(7, state->water);
  PrintNumber(7, state->factor[LAM_CHANGING_LAMELLA]);
  PrintNumber(7, state->walls);
  PrintNumber(8, state->load);
  for (PetscInt s = 0; s < step->boundary_count; s++)
    for (int i = 0; i < 2; i++) printf(" %11.4e", (double)(step->reaction[s][i] * force));
  PrintNumber(8, step->debonded_fraction);
  printf("  %s", EventName(state->event));
  if (state->element >= 0)
    printf(" at (%.4g, %.4g) mm", (double)(state->place[0] * mm), (double)(state->place[1] * mm));
  putchar('\n');
  fflush(stdout);
}

PetscErrorCode LamBodyReport(void *ctx, const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamConsole *console = (const LamConsole *)ctx;

  PetscFunctionBeginUser;
  if (console->json)
    PetscCall(LamPrintJSON(BodyToJSON(study, state, peak_memory)));
  else
    PrintBodyRow(study, state);
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyReportEnd(const LamBodyStudy *study)
{
  const LamFE2Run *fe2 = &study->fe2;
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  PetscCall(LamBodyGetCounts(study->body, &counts));
  printf("%d steps of time, %d evaluations of the body, %lld queries, %lld solves, %.3g s; response %s\n",
         (int)counts.steps, (int)counts.questions, (long long)fe2->totals.queries, (long long)fe2->totals.solves,
         (double)(LamClock() - fe2->start), LamFE2ResponseNames[fe2->response]);
  if (fe2->out_path) printf("wrote %s\n", fe2->out_path);
  PetscFunctionReturn(0);
}
