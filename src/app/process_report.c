/*
  Reports of a process at a material point: each output and event.
*/
#include "app.h"
#include "plot_time.h"
#include "process_report.h"
#include "clock.h"
#include <math.h>
#include <string.h>

static const char *EventName(const LamProcessState *state)
{
  return state->event == LAM_EVENT_COUNT ? "" : LamEventNames[state->event];
}

/* ---- JSON ---- */

static void SetRatios(json_t *o, const LamProcessState *state)
{
  char name[LAM_NAME_LENGTH];

  for (PetscInt k = 0; k < LAM_RATIO_COUNT; k++) {
    if (!isfinite(state->ratio[k])) continue;
    snprintf(name, sizeof(name), "%s_ratio", LamRatioNames[k]);
    json_object_set_new(o, name, LamJSONReal(state->ratio[k]));
  }
}

static json_t *FactorsToJSON(const LamProcessState *state, const LamProcessSpec *spec)
{
  json_t *o = json_object();

  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++)
    if (spec->kinetics[k].law != LAM_KINETIC_CONSTANT)
      json_object_set_new(o, LamChangingNames[k], LamJSONReal(state->factor[k]));
  return o;
}

static PetscErrorCode ReportJSON(const LamProcessStudy *study, const LamProcessState *state)
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
  json_object_set_new(o, "factors", FactorsToJSON(state, &study->scene->process));
  SetRatios(o, state);
  if (state->event != LAM_EVENT_COUNT) json_object_set_new(o, "event", json_string(EventName(state)));
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

/* ---- table ---- */

static void PrintHeader(const LamProcessStudy *study, const char unit[])
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

static void PrintNumber(int width, PetscReal number)
{
  if (isfinite(number))
    printf(" %*.4g", width, (double)number);
  else
    printf(" %*s", width, "-");
}

static PetscErrorCode PrintRow(const LamProcessStudy *study, const LamProcessState *state)
{
  const PetscReal MPa = study->scene->scales.stress * 1e-6;
  const PetscBool contact = (PetscBool)(study->scene->micro.interface == LAM_INTERFACE_CONTACT);
  const LamResponse *r = &state->response;
  PetscReal seconds;
  const char *unit = LamTimeUnit(study->scene->process.duration, &seconds);

  PetscFunctionBeginUser;
  if (study->history.count == 1) PrintHeader(study, unit);
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

PetscErrorCode LamProcessReport(void *ctx, const LamProcessStudy *study)
{
  const LamFE2Report *report = (const LamFE2Report *)ctx;
  const LamProcessState *state = &study->history.states[study->history.count - 1];

  PetscFunctionBeginUser;
  if (report->json)
    PetscCall(ReportJSON(study, state));
  else
    PetscCall(PrintRow(study, state));
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

PetscErrorCode LamProcessReportEnd(const LamFE2Report *report, const LamProcessStudy *study, LamProcessReason reason,
                                   const char message[])
{
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  if (!report->quiet) WarnOfIndicators(study);
  if (reason == LAM_PROCESS_ENDED) fprintf(stderr, "lamella process: %s: %s\n", study->scene->path, message);
  if (report->json) PetscFunctionReturn(0);
  PetscCall(LamProcessGetCounts(study->process, &counts));
  printf("%d steps of time, %d questions, %.3g s\n", (int)counts.steps, (int)counts.questions,
         (double)(LamClock() - study->start));
  if (study->out_path) printf("wrote %s\n", study->out_path);
  PetscFunctionReturn(0);
}
