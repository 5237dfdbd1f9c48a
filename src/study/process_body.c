/*
  lamella process with a block `macro`: a body whose tissue changes in time. Responses, files and pictures are those of
  `fe2` (fe2_run.h); a state that is told is a step there.
*/
#include "plot_time.h"
#include "process_run.h"
#include <lamella/clock.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  LamFE2Run fe2;
  LamBody body;
  LamBodyHistory history; /* rank 0 */
} Run;

/* ---- what is told; rank 0 ---- */

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

static json_t *ToJSON(const Run *run, const LamBodyState *state, PetscReal peak_memory)
{
  const LamScales *scales = &run->fe2.scene->scales;
  const PetscReal MPa = scales->stress * 1e-6;
  json_t *o = LamFE2StepToJSON(&run->fe2, &state->step, peak_memory);
  char name[LAM_NAME_LENGTH];

  json_object_set_new(o, "time", LamJSONReal(state->time));
  json_object_set_new(o, "temperature", LamJSONReal(state->temperature));
  json_object_set_new(o, "outside", LamJSONReal(state->outside * MPa));
  json_object_set_new(o, "walls", LamJSONReal(state->walls));
  json_object_set_new(o, "factors", FactorsToJSON(state, &run->fe2.scene->process));
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

static void PrintHeader(const Run *run, const LamBodyState *state, const char unit[])
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

static void PrintRow(const Run *run, const LamBodyState *state)
{
  const LamScene *scene = run->fe2.scene;
  const LamMacroStep *step = &state->step;
  const PetscReal MPa = scene->scales.stress * 1e-6, mm = scene->scales.macro_length * 1e3;
  const PetscReal force = scene->scales.stress * scene->scales.macro_length * 1e-3;
  PetscReal seconds;
  const char *unit = LamTimeUnit(scene->process.duration, &seconds);

  if (run->history.count == 1) PrintHeader(run, state, unit);
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

static PetscErrorCode Report(Run *run, const LamBodyState *state, PetscReal peak_memory)
{
  PetscFunctionBeginUser;
  if (run->fe2.json)
    PetscCall(LamPrintJSON(ToJSON(run, state, peak_memory)));
  else
    PrintRow(run, state);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportEnd(const Run *run)
{
  LamProcessCounts counts;

  PetscFunctionBeginUser;
  PetscCall(LamBodyGetCounts(run->body, &counts));
  if (run->fe2.json) PetscFunctionReturn(0);
  printf("%d steps of time, %d evaluations of the body, %lld queries, %lld solves, %.3g s; response %s\n",
         (int)counts.steps, (int)counts.questions, (long long)run->fe2.totals.queries,
         (long long)run->fe2.totals.solves, (double)(LamClock() - run->fe2.start),
         LamFE2ResponseNames[run->fe2.response]);
  if (run->fe2.out_path) printf("wrote %s\n", run->fe2.out_path);
  PetscFunctionReturn(0);
}

/* In the C1 + C2 of the start, as what is compared with it. */
static LamStrength StrengthNow(const LamScene *scene, const LamBodyState *state)
{
  LamStrength strength = scene->strength;

  strength.lamella_normal *= state->factor[LAM_CHANGING_LAMELLA];
  strength.lamella_shear *= state->factor[LAM_CHANGING_LAMELLA];
  strength.wall *= state->factor[LAM_CHANGING_WALL_STRENGTH];
  return strength;
}

/* Rank 0: files, the row or object of the state. */
static PetscErrorCode Record(Run *run, const LamBodyState *state, const LamMacroFields *fields, PetscReal peak_memory)
{
  LamFE2Run *fe2 = &run->fe2;

  PetscFunctionBeginUser;
  PetscCall(LamBodyHistoryAdd(&run->history, state));
  if (fields->point_count) {
    fe2->summary.strength = StrengthNow(fe2->scene, state);
    PetscCall(LamSummaryAdd(&fe2->summary, &state->step, fields));
    LamSummaryFind(&fe2->summary);
  }
  PetscCall(LamFE2RecordStep(fe2, &state->step, fields));
  PetscCall(Report(run, state, peak_memory));
  PetscCall(LamProgressUpdate(&fe2->progress, (PetscInt64)(1000 * state->time / fe2->scene->process.duration), 0));
  PetscFunctionReturn(0);
}

/* LamBodyMonitor */
static PetscErrorCode Told(const LamBodyState *state, void *ctx)
{
  Run *run = (Run *)ctx;
  LamMacroFields fields = {0};
  PetscErrorCode ierr = 0;
  PetscReal peak_memory;

  PetscFunctionBeginUser;
  PetscCall(LamPeakMemory(run->fe2.comm, &peak_memory));
  if (run->fe2.out_path) PetscCall(LamMacroGetFields(run->fe2.macro, &fields));
  run->fe2.totals.queries += state->step.queries;
  run->fe2.totals.solves += state->step.solves;
  run->fe2.totals.steps++;
  run->fe2.walls = state->walls;
  if (LamAppIsRoot()) ierr = Record(run, state, &fields, peak_memory);
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCall(LamFE2ShareError(run->fe2.comm, ierr));
  PetscFunctionReturn(0);
}

/* ---- its life ---- */

/* Area of the membranes at each point, in regions of other cells another one. Collective. */
static PetscErrorCode SetMembranes(Run *run)
{
  const LamFE2Tissues *tissues = &run->fe2.tissues;
  const LamScene *scene = run->fe2.scene;
  PetscReal *membrane;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(tissues->points, &membrane));
  for (PetscInt p = 0; p < tissues->points; p++) {
    if (!tissues->point) membrane[p] = LamMembraneArea(&scene->micro);
    for (PetscInt k = 0; tissues->point && k < tissues->point[p].count; k++) {
      const LamBlendTerm *term = &tissues->point[p].term[k];
      const LamScene *own = &tissues->tissues[term->knot].scene;

      membrane[p] += term->weight * LamMembraneArea(&own->micro) * scene->scales.length / own->scales.length;
    }
  }
  PetscCall(LamBodySetMembranes(run->body, membrane));
  PetscCall(PetscFree(membrane));
  PetscFunctionReturn(0);
}

/* Moduli of all tissues; set of LamBodySetWalls. */
static PetscErrorCode ChangeWalls(void *ctx, const PetscReal factor[3])
{
  Run *run = (Run *)ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(run->fe2.wall_ratio, factor, 3));
  for (PetscInt t = 0; t < run->fe2.tissues.count; t++)
    PetscCall(LamProcessChangeWalls(&run->fe2.tissues.tissues[t], factor));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(Run *run)
{
  LamFE2Run *fe2 = &run->fe2;

  PetscFunctionBeginUser;
  fe2->start = LamClock();
  PetscCall(LamMacroCreate(fe2->comm, &fe2->macro));
  PetscCall(LamMacroSetScene(fe2->macro, fe2->scene));
  PetscCall(LamBodyCreate(fe2->scene, fe2->macro, &run->body));
  PetscCall(LamMacroSetUp(fe2->macro));
  PetscCall(LamFE2PrepareResponse(fe2));
  PetscCall(SetMembranes(run));
  PetscCall(LamBodySetMonitor(run->body, Told, run));
  if (fe2->response == LAM_FE2_DIRECT) PetscCall(LamBodySetWalls(run->body, ChangeWalls, run));
  PetscCall(LamSummaryCreate(fe2->scene, &fe2->summary));
  run->history.scene = fe2->scene;
  PetscFunctionReturn(0);
}

static PetscErrorCode Close(Run *run, LamProcessReason reason, const char message[])
{
  LamFE2Run *fe2 = &run->fe2;
  const char *status = reason == LAM_PROCESS_DONE ? "done" : reason == LAM_PROCESS_STOPPED ? "stopped" : message;

  PetscFunctionBeginUser;
  PetscCall(LamFE2CloseFiles(fe2, status));
  PetscCall(ReportEnd(run));
  if (reason == LAM_PROCESS_ENDED) fprintf(stderr, "lamella process: %s: %s\n", fe2->scene_path, message);
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(Run *run, int *exit_status)
{
  LamFE2Run *fe2 = &run->fe2;
  char message[LAM_PROCESS_MESSAGE];
  LamProcessReason reason;
  PetscErrorCode ierr = 0;
  int signal_status;

  PetscFunctionBeginUser;
  if (LamAppIsRoot() && fe2->out) LamFE2FileSetBeside(fe2->out, LamBodyHistoryWrite, &run->history);
  PetscCall(LamProgressStart(&fe2->progress, 1000, (PetscBool)(fe2->quiet || (!fe2->json && isatty(STDOUT_FILENO)))));
  PetscCall(LamBodyRun(run->body, &reason, message));
  PetscCall(LamProgressEnd(&fe2->progress));
  if (reason != LAM_PROCESS_STOPPED) ierr = LamFE2Zoom(fe2);
  PetscCall(LamFE2ShareError(fe2->comm, ierr));
  signal_status = reason == LAM_PROCESS_STOPPED ? LamStopExitStatus() : LAM_EXIT_OK;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &signal_status, 1, MPI_INT, MPI_MAX, fe2->comm));
  *exit_status = reason == LAM_PROCESS_ENDED ? LAM_EXIT_UNSOLVED : signal_status;
  if (LamAppIsRoot()) ierr = Close(run, reason, message);
  PetscCall(LamFE2ShareError(fe2->comm, ierr));
  PetscFunctionReturn(0);
}

/* Boundaries move with the load parameter alone, which stays 0 where no part of the program says otherwise. */
static void WarnOfNoLoad(const LamFE2Run *fe2)
{
  const LamProcessSpec *spec = &fe2->scene->process;
  const LamMacroSpec *macro = &fe2->scene->macro;
  PetscBool loads = PETSC_FALSE, moves = PETSC_FALSE;

  for (PetscInt k = 0; k < spec->leg_count; k++) loads = (PetscBool)(loads || spec->legs[k].load != 0);
  for (PetscInt b = 0; b < macro->boundary_count; b++) {
    const LamBoundary *boundary = &macro->boundary[b];

    moves = (PetscBool)(moves || boundary->displacement[0] != 0 || boundary->displacement[1] != 0 ||
                        boundary->traction[0] != 0 || boundary->traction[1] != 0);
  }
  if (LamAppIsRoot() && moves && !loads && !fe2->quiet)
    fprintf(stderr,
            "lamella process: %s: the load parameter stays 0, so what macro.boundary moves or presses does nothing; "
            "process.program says when it does: [{for: 10 s, load: 1}]\n",
            fe2->scene_path);
}

static PetscErrorCode Solve(Run *run, int *exit_status)
{
  LamFE2Run *fe2 = &run->fe2;

  PetscFunctionBeginUser;
  PetscCall(Prepare(run));
  if (!LamFE2CheckTissuePaths("process", fe2)) {
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  PetscCall(LamFE2Connect(fe2));
  if (fe2->stopped) {
    *exit_status = LamStopExitStatus();
    PetscFunctionReturn(0);
  }
  WarnOfNoLoad(fe2);
  PetscCall(LamFE2OpenFiles(fe2));
  PetscCall(Follow(run, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessBody(LamProcessRunState *command, int *exit_status)
{
  Run run = {.fe2 = command->response};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  run.fe2.comm = PETSC_COMM_WORLD;
  run.fe2.out_path = command->out_path;
  run.fe2.json = command->json;
  run.fe2.quiet = command->quiet;
  command->scene = NULL; /* belongs to the run */
  if (command->frames_text) {
    if (LamAppIsRoot())
      fprintf(stderr, "lamella process: --frames: keeps cells of one material point; of a body `macro.zoom` does\n");
    *exit_status = LAM_EXIT_USAGE;
  } else if (!LamFE2CheckPaths("process", &run.fe2)) {
    *exit_status = LAM_EXIT_USAGE;
  } else {
    ierr = Solve(&run, exit_status);
    if (ierr) PetscCall(LamFE2CloseAfterError(&run.fe2));
    PetscCall(ierr);
  }
  PetscCall(LamBodyDestroy(&run.body));
  PetscCall(PetscFree(run.history.states));
  PetscCall(LamFE2Destroy(&run.fe2));
  PetscFunctionReturn(0);
}
