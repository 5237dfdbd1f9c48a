/*
  Reports of a body whose tissue changes in time.
*/
#include "app.h"
#include "plot_time.h"
#include "process_report.h"
#include "clock.h"
#include <math.h>
#include <string.h>

static const char *EventName(const LamBodyState *state)
{
  return state->event == LAM_EVENT_COUNT ? "" : LamEventNames[state->event];
}

static json_t *FactorsToJSON(const LamBodyState *state, const LamProcessSpec *spec)
{
  json_t *o = json_object();

  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++)
    if (spec->kinetics[k].law != LAM_KINETIC_CONSTANT)
      json_object_set_new(o, LamChangingNames[k], LamJSONReal(state->factor[k]));
  return o;
}

static json_t *ToJSON(const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamScales *scales = &study->fe2.scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o = LamFE2StepToJSON(&study->fe2, &state->step, peak_memory);
  char name[LAM_NAME_LENGTH];

  json_object_set_new(o, "time", LamJSONReal(state->time));
  json_object_set_new(o, "temperature", LamJSONReal(state->temperature));
  json_object_set_new(o, "outside", LamJSONReal(state->outside * MPa));
  json_object_set_new(o, "walls", LamJSONReal(state->walls));
  json_object_set_new(o, "factors", FactorsToJSON(state, &study->fe2.scene->process));
  json_object_set_new(o, "water", LamJSONReal(state->water));
  json_object_set_new(o, "turgor_min", LamJSONReal(state->turgor_min * MPa));
  json_object_set_new(o, "turgor_max", LamJSONReal(state->turgor_max * MPa));
  json_object_set_new(o, "plasmolysed", LamJSONReal(state->plasmolysed));
  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    if (!isfinite(state->ratio[k])) continue;
    snprintf(name, sizeof(name), "%s_ratio", LamRatioNames[k]);
    json_object_set_new(o, name, LamJSONReal(state->ratio[k]));
  }
  if (state->event == LAM_EVENT_COUNT) return o;
  json_object_set_new(o, "event", json_string(EventName(state)));
  json_object_set_new(o, "element", json_integer((json_int_t)state->element));
  json_object_set_new(o, "point", json_integer((json_int_t)state->point));
  json_object_set_new(o, "place", LamJSONReals(2, state->place, scales->macro_length * 1e3));
  return o;
}

static void PrintHeader(const LamBodyStudy *study, const LamBodyState *state, const char unit[])
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

static void PrintNumber(int width, PetscReal number)
{
  if (isfinite(number))
    printf(" %*.4g", width, (double)number);
  else
    printf(" %*s", width, "-");
}

static void PrintRow(const LamBodyStudy *study, const LamBodyState *state)
{
  const LamScene *scene = study->fe2.scene;
  const LamMacroStep *step = &state->step;
  const PetscReal MPa = scene->scales.stress * 1e-6, mm = scene->scales.macro_length * 1e3;
  const PetscReal force = scene->scales.stress * scene->scales.macro_length * 1e-3;
  PetscReal seconds;
  const char *unit = LamTimeUnit(scene->process.duration, &seconds);

  if (study->history.count == 1) PrintHeader(study, state, unit);
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
  printf("  %s", EventName(state));
  if (state->element >= 0)
    printf(" at (%.4g, %.4g) mm", (double)(state->place[0] * mm), (double)(state->place[1] * mm));
  putchar('\n');
  fflush(stdout);
}

PetscErrorCode LamBodyReport(void *ctx, const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamFE2Report *report = (const LamFE2Report *)ctx;

  PetscFunctionBeginUser;
  if (report->json)
    PetscCall(LamPrintJSON(ToJSON(study, state, peak_memory)));
  else
    PrintRow(study, state);
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
