/*
  lamella process: tissue that changes in time, at one material point, or of a body.

  The history of a point is sequential: rank 0 computes it, further ranks wait.
*/
#include "app.h"
#include "clock.h"
#include "fe2_report.h"
#include "process_run.h"
#include "quantity_text.h"
#include "uncertainty.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

/* ---- reports: each output and event ---- */

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

/* ---- reports of a material point ---- */

static json_t *FromInflated(const LamProcessStudy *study, const LamProcessState *state)
{
  PetscReal F[9], P[9];

  LamProcessMeasures(study->scene, state, F, P);
  return LamFromInflatedToJSON(F, P, &study->scene->scales);
}

static PetscErrorCode PrintPointObject(const LamProcessStudy *study, const LamProcessState *state)
{
  const LamScales *scales = &study->scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o;

  PetscFunctionBeginUser;
  PetscCall(LamResponseToJSON(&state->response, scales, study->history.count, PETSC_FALSE, &o));
  json_object_update_new(
      o, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "time", LamJSONReal(state->time), "temperature",
                   LamJSONReal(state->temperature), "from_inflated", FromInflated(study, state), "water",
                   LamJSONReal(state->water), "osmotic_pressure", LamJSONReal(state->osmotic * MPa), "outside",
                   LamJSONReal(state->outside * MPa), "firmness", LamJSONReal(state->firmness * MPa), "walls",
                   LamJSONReal(state->walls), "factors", FactorsToJSON(&study->scene->process, state->factor)));
  AddRatios(o, state->ratio, state->event);
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

static void PrintPointHeader(const LamProcessStudy *study, const char unit[])
{
  const PetscBool contact = LamCellsPart(study->scene->micro.interface);

  printf("%10s %8s %9s %9s %9s %9s %9s %9s %9s", "time", "temp.", "turgor", "osmotic", "lamella", "walls", "firmness",
         "F11", "F22");
  printf(contact ? " %9s %8s" : " %9s %9s", contact ? "opening" : "traction", contact ? "debonded" : "tension");
  printf("  %s\n", "event");
  printf("%10s %8s %9s %9s %9s %9s %9s %9s %9s", unit, "degC", "MPa", "MPa", "share", "share", "MPa", "", "");
  printf(contact ? " %9s %8s" : " %9s %9s", contact ? "of V0" : "MPa", contact ? "share" : "MPa");
  printf("\n");
}

static void PrintPointRow(const LamProcessStudy *study, const LamProcessState *state)
{
  const PetscReal MPa = study->scene->scales.stress * 1e-6;
  const PetscBool contact = LamCellsPart(study->scene->micro.interface);
  const LamResponse *r = &state->response;
  PetscReal seconds;
  const char *unit = LamTimeUnit(study->scene->process.duration, &seconds);

  if (study->history.count == 1) PrintPointHeader(study, unit);
  printf("%10.5g %8.4g", (double)(state->time / seconds), (double)(state->temperature - 273.15));
  LamPrintColumn(9, 4, 'g', LamWithoutNoise(state->turgor) * MPa);
  LamPrintColumn(9, 4, 'g', LamWithoutNoise(state->osmotic) * MPa);
  LamPrintColumn(9, 4, 'g', state->factor[LAM_CHANGING_LAMELLA]);
  LamPrintColumn(9, 4, 'g', state->walls);
  LamPrintColumn(9, 4, 'g', LamWithoutNoise(state->firmness) * MPa);
  LamPrintColumn(9, 4, 'g', state->F[0]);
  LamPrintColumn(9, 4, 'g', state->F[4]);
  LamPrintColumn(9, 4, 'g', LamWithoutNoise(contact ? r->opening_fraction : r->max_traction) * (contact ? 1 : MPa));
  LamPrintColumn(contact ? 8 : 9, 4, 'g',
                 LamWithoutNoise(contact ? r->debonded_fraction : r->max_wall_tension) * (contact ? 1 : MPa));
  printf("  %s\n", EventName(state->event));
}

static PetscErrorCode ReportPoint(void *ctx, const LamProcessStudy *study)
{
  const LamConsole *console = (const LamConsole *)ctx;
  const LamProcessState *state = &study->history.states[study->history.count - 1];

  PetscFunctionBeginUser;
  if (console->json)
    PetscCall(PrintPointObject(study, state));
  else
    PrintPointRow(study, state);
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
        "%d; --response %s solves there\n",
        (int)doubtful, LamWallsRelax(&study->scene->micro) ? "direct" : "cache");
}

static PetscErrorCode ReportPointTest(const LamProcessStudy *study, const LamConsole *console)
{
  LamTest test;

  PetscFunctionBeginUser;
  if (!console->test.readings) PetscFunctionReturn(0);
  PetscCall(LamTestOfProcess(study->scene, study->history.count, study->history.states, &test));
  PetscCall(LamTestPrint(&test, &console->test, console->json));
  PetscCall(LamTestDestroy(&test));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportPointEnd(void *ctx, const LamProcessStudy *study)
{
  LamConsole *console = (LamConsole *)ctx;
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  LamConsoleClear();
  if (study->response.stopped) PetscFunctionReturn(0);
  if (!console->quiet) WarnOfIndicators(study);
  if (study->reason == LAM_PROCESS_ENDED)
    fprintf(stderr, "lamella process: %s: %s\n", study->scene->path, study->message);
  PetscCall(ReportPointTest(study, console));
  if (console->json) PetscFunctionReturn(0);
  PetscCall(LamProcessGetCounts(study->process, &counts));
  printf("%d steps of time, %d questions, %.3g s\n", (int)counts.steps, (int)counts.questions,
         (double)(LamClock() - study->start));
  if (study->out_path) printf("wrote %s\n", study->out_path);
  PetscFunctionReturn(0);
}

/* ---- reports of a body ---- */

static json_t *BodyToJSON(const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamScales *scales = &study->fe2.scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o = LamFE2StepToJSON(&study->fe2, &state->step, peak_memory);

  json_object_update_new(
      o, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "time", LamJSONReal(state->time), "temperature",
                   LamJSONReal(state->temperature), "outside", LamJSONReal(state->outside * MPa), "walls",
                   LamJSONReal(state->walls), "factors", FactorsToJSON(&study->fe2.scene->process, state->factor),
                   "water", LamJSONReal(state->water), "turgor_min", LamJSONReal(state->turgor_min * MPa), "turgor_max",
                   LamJSONReal(state->turgor_max * MPa), "plasmolysed", LamJSONReal(state->plasmolysed)));
  if (isfinite(state->inflow))
    json_object_update_new(o, json_pack("{s:o, s:o}", "inflow", LamJSONReal(state->inflow), "water_balance",
                                        LamJSONReal(state->water_balance)));
  AddRatios(o, state->ratio, state->event);
  if (state->event == LAM_EVENT_COUNT) return o;
  json_object_update_new(o, json_pack("{s:I, s:I, s:o}", "element", (json_int_t)state->element, "point",
                                      (json_int_t)state->point, "place",
                                      LamJSONReals(2, state->place, scales->macro_length * 1e3)));
  return o;
}

static void PrintBodyHeader(const LamBodyStudy *study, const LamBodyState *state, const char unit[])
{
  const LamMacroStep *step = &state->step;

  printf("Turgor: least, mean and largest; reactions in %s.\n", LamFE2ForceName(&study->fe2));
  printf("%10s %8s %8s %8s %8s %7s %7s %7s %8s", "time", "temp.", "turgor", "turgor", "turgor", "water", "lamella",
         "walls", "load");
  LamFE2PrintSides(&study->fe2, step, PETSC_TRUE);
  printf(" %8s  event\n", "debonded");
  printf("%10s %8s %8s %8s %8s %7s %7s %7s\n", unit, "degC", "MPa", "MPa", "MPa", "share", "share", "share");
}

static void PrintBodyRow(const LamBodyStudy *study, const LamBodyState *state)
{
  const LamScene *scene = study->fe2.scene;
  const LamMacroStep *step = &state->step;
  const PetscReal MPa = scene->scales.stress * 1e-6, mm = scene->scales.macro_length * 1e3;
  PetscReal seconds;
  const char *unit = LamTimeUnit(scene->process.duration, &seconds);

  if (study->history.count == 1) PrintBodyHeader(study, state, unit);
  printf("%10.6g %8.4g", (double)(state->time / seconds), (double)(state->temperature - 273.15));
  LamPrintColumn(8, 4, 'g', LamWithoutNoise(state->turgor_min) * MPa);
  LamPrintColumn(8, 4, 'g', LamWithoutNoise(step->turgor_mean) * MPa);
  LamPrintColumn(8, 4, 'g', LamWithoutNoise(state->turgor_max) * MPa);
  LamPrintColumn(7, 4, 'g', state->water);
  LamPrintColumn(7, 4, 'g', state->factor[LAM_CHANGING_LAMELLA]);
  LamPrintColumn(7, 4, 'g', state->walls);
  LamPrintColumn(8, 4, 'g', state->load);
  LamFE2PrintSides(&study->fe2, step, PETSC_FALSE);
  LamPrintColumn(8, 4, 'g', LamWithoutNoise(step->debonded_fraction));
  printf("  %s", EventName(state->event));
  if (state->element >= 0)
    printf(" at (%.4g, %.4g) mm", (double)(state->place[0] * mm), (double)(state->place[1] * mm));
  putchar('\n');
  fflush(stdout);
}

static PetscErrorCode ReportBody(void *ctx, const LamBodyStudy *study, const LamBodyState *state, PetscReal peak_memory)
{
  const LamConsole *console = (const LamConsole *)ctx;

  PetscFunctionBeginUser;
  if (console->json)
    PetscCall(LamPrintJSON(BodyToJSON(study, state, peak_memory)));
  else
    PrintBodyRow(study, state);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportBodyEnd(const LamBodyStudy *study, const LamConsole *console)
{
  const LamFE2Run *fe2 = &study->fe2;
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  PetscCall(LamFE2ReportTest(fe2, console));
  if (console->json) PetscFunctionReturn(0);
  PetscCall(LamBodyGetCounts(study->body, &counts));
  printf("%d steps of time, %d evaluations of the body, %lld queries, %lld solves, %.3g s; response %s\n",
         (int)counts.steps, (int)counts.questions, (long long)fe2->totals.queries, (long long)fe2->totals.solves,
         (double)(LamClock() - fe2->start), LamFE2ResponseNames[fe2->response]);
  if (fe2->out_path) printf("wrote %s\n", fe2->out_path);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static int StatusOf(LamProcessReason reason)
{
  return reason == LAM_PROCESS_STOPPED ? LamStopExitStatus()
         : reason == LAM_PROCESS_ENDED ? LAM_EXIT_UNSOLVED
                                       : LAM_EXIT_OK;
}

static PetscErrorCode RunPoint(const LamFE2Run *run, PetscInt frames, LamConsole *console, int *exit_status)
{
  LamProcessStudy study = {.response = *run,
                           .out_path = run->out_path,
                           .frames = frames,
                           .scene = run->scene,
                           .state = ReportPoint,
                           .done = ReportPointEnd};

  PetscFunctionBeginUser;
  PetscCall(LamProcessStudyRun(&study));
  *exit_status = StatusOf(study.reason);
  PetscCall(LamSceneDestroy(&study.response.scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveBody(LamBodyStudy *study, LamConsole *console, int *exit_status)
{
  LamFE2Run *fe2 = &study->fe2;

  PetscFunctionBeginUser;
  PetscCall(LamBodyStudyPrepare(study));
  if (!LamFE2CheckTissuePaths("process", fe2, exit_status)) PetscFunctionReturn(0);
  PetscCall(LamBodyStudySolve(study));
  LamConsoleClear();
  *exit_status = StatusOf(study->reason);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, exit_status, 1, MPI_INT, MPI_MAX, fe2->comm));
  if (!LamAppIsRoot() || fe2->stopped) PetscFunctionReturn(0);
  PetscCall(ReportBodyEnd(study, console));
  if (study->reason == LAM_PROCESS_ENDED) fprintf(stderr, "lamella process: %s: %s\n", fe2->scene_path, study->message);
  PetscFunctionReturn(0);
}

static PetscErrorCode RunBody(const LamFE2Run *run, PetscInt frames, LamConsole *console, int *exit_status)
{
  LamBodyStudy study = {.fe2 = *run, .state = ReportBody};

  PetscFunctionBeginUser;
  if (!frames ||
      LamUsageError("process", exit_status, "--frames: keeps cells of one material point; of a body `macro.zoom` does"))
    PetscCall(SolveBody(&study, console, exit_status));
  PetscCall(LamBodyStudyDestroy(&study));
  PetscFunctionReturn(0);
}

/* Whether --uncertainty, if it is given, fits with the other options; otherwise says what does not. */
static PetscBool UncertaintyFits(const LamUncertainty *uncertainty, const LamFE2Run *run, const char response[],
                                 PetscInt frames, const LamTestOptions *test, int *exit_status)
{
  if (!uncertainty->count && uncertainty->processes)
    return LamUsageError("process", exit_status, "--processes is of --uncertainty N, which is missing");
  return (PetscBool)(!uncertainty->count || LamPythonStudyFits("process", "uncertainty",
                                                               run->database_path ? "database"
                                                               : response         ? "response"
                                                               : frames           ? "frames"
                                                               : test->readings   ? "readings"
                                                               : test->at         ? "at"
                                                                                  : NULL,
                                                               exit_status));
}

PetscErrorCode LamCommandProcess(LamArgs *args, int *exit_status)
{
  LamUncertainty uncertainty = {.command = "process"};
  LamFE2Run run = LAM_FE2_RUN;
  LamConsole console = {.command = "process"};
  const char *response = NULL;
  PetscInt frames = 0;
  PetscBool done;
  const LamOption options[] = {
      {'d', "database", LAM_OPTION_TEXT, "DB.h5", "response database; a cache adds to it what it solves",
       &run.database_path},
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5",
       "states in time, for plot and info, with OUT.csv beside it; of a body also OUT.xdmf", &run.out_path},
      LAM_OVERWRITE_OPTION(run.overwrite),
      {0, "response", LAM_OPTION_TEXT, "TYPE",
       "direct: solve an RVE for each state (default); cache: query, solve what is missing (default with -d); "
       "database: query only",
       &response},
      {0, "frames", LAM_OPTION_FROM_2, "N",
       "at a material point: keep the cells at N states evenly spread, for a film (default: at events, start and end)",
       &frames},
      LAM_TEST_OPTIONS(console.test, " of what the program drives"),
      LAM_UNCERTAINTY_OPTION(uncertainty),
      {0, "processes", LAM_OPTION_FROM_1, "N", "samples at a time (default: as many as processors)",
       &uncertainty.processes},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per output and event on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(
      LamOptionsParse(args,
                      "process SCENE [-d DB.h5] [-o OUT.h5] [--response TYPE] [--frames N] [--readings]\n        "
                      "       [--at STRAIN,...] [--overwrite] [--json] [--quiet]\n"
                      "       lamella process SCENE --uncertainty N [--processes N] [-o FOLDER] [--overwrite]\n        "
                      "       [--json] [--quiet]",
                      "Follows tissue that changes in time.", options, 1, &run.scene_path, &done, exit_status));
  if (done || !UncertaintyFits(&uncertainty, &run, response, frames, &console.test, exit_status))
    PetscFunctionReturn(0);
  if (uncertainty.count) {
    PetscCall(LamUncertaintyRun(&uncertainty, run.scene_path, run.out_path, run.overwrite, console.json, console.quiet,
                                exit_status));
    PetscFunctionReturn(0);
  }
  if (!LamFE2ChooseResponse("process", response, &run, exit_status) ||
      !LamFE2CheckPaths("process", &run, exit_status) || !LamTestReadOptions("process", &console.test, exit_status))
    PetscFunctionReturn(0);
  run.all_fields = console.test.readings; /* of a body: the summary has the curve */
  PetscCall(args->start(args));
  run.comm = PETSC_COMM_WORLD;
  run.reporter = LamConsoleReporter(&console);
  run.step_ctx = &console;
  PetscCall(LamSceneRead(run.scene_path, &run.scene));
  if (LamAppIsRoot()) LamReportScene(&run.reporter, run.scene);
  if (run.scene->has_macro && run.scene->has_process)
    PetscCall(RunBody(&run, frames, &console, exit_status));
  else
    PetscCall(RunPoint(&run, frames, &console, exit_status));
  LamTellStopped(&console, run.out_path, PETSC_FALSE);
  PetscFunctionReturn(0);
}
