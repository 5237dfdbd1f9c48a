/*
  lamella tradeoff: error against time for every parameter of a scene that trades one for the other.
*/
#include "app.h"
#include "beside.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- human-readable output ---- */

/* "12 x 4, graded 0.6" */
static const char *MeshWords(const LamMicrostructure *micro, char text[64])
{
  snprintf(text, 64, "%" PetscInt_FMT " x %" PetscInt_FMT, micro->along, micro->through);
  if (micro->grading > 0) snprintf(text + strlen(text), 64 - strlen(text), ", graded %g", (double)micro->grading);
  return text;
}

static const char *OpeningName(const LamTradeoff *t)
{
  return LamCellsPart(t->scene->micro.interface) ? "opening" : "lumen";
}

static PetscBool ComparesStates(const LamTradeoff *t)
{
  for (PetscInt i = 0; i < t->n; i++)
    if (t->measured[i].setting.knob != LAM_KNOB_MACRO) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void PrintUnused(const LamTradeoff *t)
{
  for (PetscInt s = 0; s < t->states.n; s++) {
    const PetscReal difference = t->reference.difference[s];

    if (t->reference.used[s]) continue;
    printf("%-10s state %" PetscInt_FMT " is not compared: ", "", s + 1);
    if (isfinite(difference))
      printf("the two finest meshes differ by %.2g %%, more than a tenth of the accuracy\n",
             (double)(100 * difference));
    else
      printf("on the finest meshes it has no response, or takes too long\n");
  }
}

static void PrintReference(const LamTradeoff *t)
{
  const LamReference *r = &t->reference;
  char text[64];

  if (!ComparesStates(t)) return;
  if (!r->used_count) {
    printf("%-10s none: two finer meshes did not get done within the budget, or have no common response\n",
           "reference");
    return;
  }
  printf("%-10s %s elements, %.3g core-s; ", "reference", MeshWords(&r->micro, text), (double)r->cpu);
  printf("differs from %s by %.2g %% in P, %.2g %% in the tangent, %.2g in the %s fraction\n",
         MeshWords(&r->other, text), (double)(100 * r->error[LAM_ERROR_P]), (double)(100 * r->error[LAM_ERROR_TANGENT]),
         (double)r->error[LAM_ERROR_OPENING], OpeningName(t));
  PrintUnused(t);
}

static void PrintError(const LamMeasuredError *error, PetscReal scale)
{
  if (isnan(error->largest))
    printf("  %10s", "");
  else
    printf(" %c%10.3g", error->resolved ? ' ' : '~', (double)(scale * error->largest));
}

static void PrintRow(const LamTradeoff *t, const LamMeasurement *m)
{
  const PetscBool body = (PetscBool)(m->setting.knob == LAM_KNOB_MACRO);
  PetscBool optimal = m->error[body ? LAM_ERROR_MACRO : LAM_ERROR_P].optimal;

  printf("%c%c %-9s %-20s", optimal ? '*' : ' ', m->setting.planned ? '>' : ' ', LamKnobNames[m->setting.knob],
         m->setting.label);
  if (!m->runs) {
    printf(" %s\n", m->reason[0] ? m->reason : "not measured");
    return;
  }
  printf(" %8.3g %8.3g %8.3g %2" PetscInt_FMT, (double)m->cpu_spread.median, (double)m->cpu_spread.low,
         (double)m->cpu_spread.high, m->runs);
  if (body) {
    if (m->setting.planned)
      printf("  %10s", "reference");
    else
      PrintError(&m->error[LAM_ERROR_MACRO], 100);
  } else {
    PrintError(&m->error[LAM_ERROR_P], 100);
    PrintError(&m->error[LAM_ERROR_TANGENT], 100);
    PrintError(&m->error[LAM_ERROR_OPENING], 1);
    if (!isnan(m->from_plan)) printf("  %9.2g", (double)(100 * m->from_plan));
  }
  if (m->nodes) printf("  %" PetscInt_FMT " nodes", m->nodes);
  putchar('\n');
}

static void PrintHeader(const LamTradeoff *t, LamKnob knob)
{
  printf("\n   %-9s %-20s %8s %8s %8s %2s", "family", "setting", "core-s", "min", "max", "n");
  if (knob == LAM_KNOB_MACRO)
    printf("  %10s\n", "macro, %");
  else
    printf("  %10s  %10s  %10s  %9s\n", "P, %", "tangent, %", OpeningName(t), "of plan,%");
}

static void PrintTable(const LamTradeoff *t)
{
  LamKnob last = LAM_KNOB_COUNT;
  char text[64];

  printf("%-10s %s: %" PetscInt_FMT " states (%s), planned mesh %s\n", "scene", t->scene->path, t->states.n,
         t->states.origin, MeshWords(&t->scene->micro, text));
  if (t->states.dropped)
    printf("%-10s %" PetscInt_FMT " states of the load have no response on the planned mesh and are left out\n", "",
           t->states.dropped);
  PrintReference(t);
  for (PetscInt i = 0; i < t->n; i++) {
    const LamKnob knob = t->measured[i].setting.knob;

    if (last == LAM_KNOB_COUNT || (knob == LAM_KNOB_MACRO) != (last == LAM_KNOB_MACRO)) PrintHeader(t, knob);
    last = knob;
    PrintRow(t, &t->measured[i]);
  }
  printf("\n* nothing measured has less error in less time; > as planned; ~ below ten times the reference's own error: "
         "not ranked\n");
  for (int k = 0; k < LAM_KNOB_COUNT; k++)
    if (t->why[k] && strcmp(t->why[k], "not asked for")) printf("%-10s left out: %s\n", LamKnobNames[k], t->why[k]);
  printf("%.3g s%s\n", (double)t->seconds, t->stopped ? ", stopped by a signal" : "");
}

/* ---- JSON output ---- */

static json_t *Spread(const LamSpread *spread)
{
  return json_pack("{s:o, s:o, s:o}", "median", LamJSONReal(spread->median), "min", LamJSONReal(spread->low), "max",
                   LamJSONReal(spread->high));
}

static json_t *Errors(const LamMeasurement *m)
{
  json_t *o = json_object();

  for (int k = 0; k < LAM_ERROR_KIND_COUNT; k++) {
    const LamMeasuredError *e = &m->error[k];

    if (isnan(e->largest)) continue;
    json_object_set_new(o, LamErrorNames[k],
                        json_pack("{s:o, s:o, s:b, s:b}", "max", LamJSONReal(e->largest), "mean", LamJSONReal(e->mean),
                                  "resolved", e->resolved, "optimal", e->optimal));
  }
  return o;
}

static json_t *Mesh(const LamMicrostructure *micro)
{
  return json_pack("{s:I, s:I, s:o}", "along", (json_int_t)micro->along, "through", (json_int_t)micro->through,
                   "grading", LamJSONReal(micro->grading));
}

static json_t *Setting(const LamMeasurement *m)
{
  const LamSetting *s = &m->setting;
  json_t *o = json_pack("{s:s, s:s, s:s, s:b, s:o, s:[I,I], s:s, s:o}", "family", LamKnobNames[s->knob], "setting",
                        s->label, "mark", s->mark, "planned", s->planned, "mesh", Mesh(&s->micro), "cells",
                        (json_int_t)s->micro.cells[0], (json_int_t)s->micro.cells[1], "strategy",
                        LamStrategyNames[s->strategy], "tolerance", LamJSONReal(s->tolerance));

  if (s->accuracy > 0) json_object_set_new(o, "accuracy", LamJSONReal(s->accuracy));
  if (s->knob == LAM_KNOB_MACRO) json_object_set_new(o, "response", json_string(LamFE2ResponseNames[s->response]));
  return o;
}

/* A setting and its measurements. */
static json_t *Measured(const LamMeasurement *m)
{
  json_t *o = Setting(m);

  json_object_set_new(o, "runs", json_integer(m->runs));
  if (!m->runs) {
    json_object_set_new(o, "reason", json_string(m->reason[0] ? m->reason : "not measured"));
    return o;
  }
  json_object_set_new(o, "core_seconds", Spread(&m->cpu_spread));
  json_object_set_new(o, "wall_seconds", Spread(&m->wall_spread));
  if (m->setting.knob != LAM_KNOB_MACRO)
    json_object_set_new(o, "seconds_per_state", LamJSONReal(LamSpreadOf(m->runs, m->state_cpu).median));
  if (m->unknowns) json_object_set_new(o, "unknowns", json_integer(m->unknowns));
  if (m->nodes) json_object_set_new(o, "nodes", json_integer(m->nodes));
  json_object_set_new(o, "error", Errors(m));
  json_object_set_new(o, "difference_from_plan", LamJSONReal(m->from_plan));
  return o;
}

static PetscErrorCode PrintObjects(const LamTradeoff *t)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) PetscCall(LamPrintJSON(Measured(&t->measured[i])));
  PetscFunctionReturn(0);
}

/* ---- files ---- */

static json_t *States(const LamTradeoff *t)
{
  const PetscReal MPa = t->scene->scales.stress * 1e-6;
  json_t *list = json_array();

  for (PetscInt s = 0; s < t->states.n; s++) {
    const LamLoad *load = &t->states.loads[s];

    json_array_append_new(list, json_pack("{s:o, s:o, s:o, s:o, s:b}", "F", LamJSONReals(9, load->F, 1), "turgor",
                                          LamJSONReal(load->turgor * MPa), "cohesion",
                                          LamJSONReal(load->cohesion * MPa), "reference_difference",
                                          LamJSONReal(t->reference.difference ? t->reference.difference[s] : NAN),
                                          "used", t->reference.used && t->reference.used[s]));
  }
  return list;
}

static json_t *Reference(const LamTradeoff *t)
{
  const LamReference *r = &t->reference;
  json_t *error;

  if (!r->used_count) return json_null();
  error = json_object();
  for (int k = 0; k < LAM_ERROR_MACRO; k++) json_object_set_new(error, LamErrorNames[k], LamJSONReal(r->error[k]));
  return json_pack("{s:o, s:o, s:o, s:o, s:I}", "mesh", Mesh(&r->micro), "told_from", Mesh(&r->other), "error", error,
                   "core_seconds", LamJSONReal(r->cpu), "states_used", (json_int_t)r->used_count);
}

/* The files of the folder. Those of version 0.1 have no member `lamella_...`. */
static const LamTextKind Data = {.what = "what lamella tradeoff has measured",
                                 .ending = "/tradeoff.json",
                                 .begins = "{\n \"lamella_tradeoff\": *",
                                 .before = "{\n \"version\": *,\n \"scene\": *,\n \"tissue\": *,\n \"volume\": *"},
                         Model = {.what = "a model of lamella tradeoff",
                                  .ending = "/model.json",
                                  .begins = "{\n \"lamella_model\": *",
                                  .before = "{\n \"format\": 1,\n \"version\": *,\n \"tissue\": *,\n \"states\": *"};

/* Writes a file of the folder atomically; takes ownership. */
static PetscErrorCode WriteJSON(const char directory[], const LamTextKind *kind, json_t *object)
{
  LamBeside file;
  int failed;

  PetscFunctionBeginUser;
  PetscCall(LamBesideOpen(directory, kind, &file));
  failed = json_dumpf(object, file.out, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
  json_decref(object);
  fputc('\n', file.out);
  PetscCall(LamBesideClose(&file));
  PetscCheck(!failed, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s%s: cannot be written", directory, kind->ending);
  PetscFunctionReturn(0);
}

static json_t *LeftOut(const LamTradeoff *t)
{
  json_t *o = json_object();

  for (int k = 0; k < LAM_KNOB_COUNT; k++)
    if (t->why[k]) json_object_set_new(o, LamKnobNames[k], json_string(t->why[k]));
  return o;
}

static PetscErrorCode WriteData(const LamTradeoff *t, const char directory[], const char hash[])
{
  json_t *settings = json_array();

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) json_array_append_new(settings, Measured(&t->measured[i]));
  PetscCall(WriteJSON(directory, &Data,
                      json_pack("{s:I, s:s, s:s, s:s, s:s, s:o, s:I, s:o, s:b, s:s, s:o, s:o, s:o, s:o}",
                                "lamella_tradeoff", (json_int_t)1, "version", LAMELLA_VERSION, "scene", t->scene->path,
                                "tissue", hash, "volume", OpeningName(t), "budget", LamJSONReal(t->budget), "repeats",
                                (json_int_t)t->repeats, "seconds", LamJSONReal(t->seconds), "stopped", t->stopped,
                                "origin", t->states.origin, "states", States(t), "reference", Reference(t), "left_out",
                                LeftOut(t), "settings", settings)));
  PetscFunctionReturn(0);
}

/* Data for a planner: errors of P of the meshes measured. */
static PetscErrorCode WriteModel(const LamTradeoff *t, const char directory[], const char hash[])
{
  json_t *meshes = json_array();

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) {
    const LamMeasurement *m = &t->measured[i];
    json_t *mesh;

    if (m->setting.knob != LAM_KNOB_MESH || !m->runs || isnan(m->error[LAM_ERROR_P].largest)) continue;
    mesh = Mesh(&m->setting.micro);
    json_object_set_new(mesh, "error_P_max", LamJSONReal(m->error[LAM_ERROR_P].largest));
    json_object_set_new(mesh, "resolved", json_boolean(m->error[LAM_ERROR_P].resolved));
    json_object_set_new(mesh, "seconds_per_state", LamJSONReal(LamSpreadOf(m->runs, m->state_cpu).median));
    json_array_append_new(meshes, mesh);
  }
  PetscCall(WriteJSON(directory, &Model,
                      json_pack("{s:I, s:I, s:s, s:s, s:o, s:o, s:o}", "lamella_model", (json_int_t)1, "format",
                                (json_int_t)1, "version", LAMELLA_VERSION, "tissue", hash, "states", States(t),
                                "reference", Reference(t), "meshes", meshes)));
  PetscFunctionReturn(0);
}

/* Draws DIR/tradeoff.json; where that fails its numbers are there. */
static PetscErrorCode DrawFiles(const char directory[], int *exit_status)
{
  char json[PETSC_MAX_PATH_LEN], png[PETSC_MAX_PATH_LEN], svg[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(json, sizeof(json), "%s/tradeoff.json", directory));
  PetscCall(PetscSNPrintf(png, sizeof(png), "%s/tradeoff.png", directory));
  PetscCall(PetscSNPrintf(svg, sizeof(svg), "%s/tradeoff.svg", directory));
  PetscCall(LamPythonRun(
      &LamPythonPlot, json_pack("{s:s, s:[s,s], s:b}", "input", json, "outputs", png, svg, "silent", 1), exit_status));
  if (*exit_status) fprintf(stderr, "lamella tradeoff: %s has the numbers; lamella plot draws it again\n", json);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFiles(const LamTradeoff *t, const char directory[], int *exit_status)
{
  char hash[LAM_HASH_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureHashTissue(&t->scene->micro, hash));
  PetscCall(WriteData(t, directory, hash));
  PetscCall(WriteModel(t, directory, hash));
  PetscCall(DrawFiles(directory, exit_status));
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

typedef struct {
  const char *directory, *budget_text, *only;
  PetscBool overwrite;
  LamTradeoff tradeoff;
  LamConsole console;
} Command;

/* Creates the output folder if needed, before anything is measured. */
static PetscErrorCode CheckDirectory(const Command *run)
{
  struct stat status;
  LamScene *scene;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  if (!run->directory) PetscFunctionReturn(0);
  PetscCall(LamSceneRead(run->tradeoff.scene_path, &scene));
  PetscCheck((!mkdir(run->directory, 0777) || errno == EEXIST) && !stat(run->directory, &status), PETSC_COMM_SELF,
             PETSC_ERR_FILE_OPEN, "%s: %s", run->directory, strerror(errno));
  PetscCheck(S_ISDIR(status.st_mode), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: is no folder", run->directory);
  PetscCheck(!access(run->directory, W_OK | X_OK), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", run->directory,
             strerror(errno));
  ierr = LamTargetCheckText(run->directory, &Data, run->overwrite, scene);
  if (!ierr) ierr = LamTargetCheckText(run->directory, &Model, run->overwrite, scene);
  PetscCall(LamSceneDestroy(&scene));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* 3 if the planned setting has no result, or nothing to compare with. */
static int ExitStatus(const LamTradeoff *t)
{
  if (t->stopped) return LamStopExitStatus();
  return LamTradeoffIsSolved(t) ? LAM_EXIT_OK : LAM_EXIT_UNSOLVED;
}

static PetscErrorCode Solve(Command *run, int *exit_status)
{
  LamTradeoff *t = &run->tradeoff;

  PetscFunctionBeginUser;
  t->reporter = LamConsoleReporter(&run->console);
  PetscCall(CheckDirectory(run));
  LamActivitySet("settings measured");
  PetscCall(LamTradeoffRun(t));
  LamConsoleClear();
  if (run->console.json)
    PetscCall(PrintObjects(t));
  else
    PrintTable(t);
  if (run->directory) PetscCall(WriteFiles(t, run->directory, exit_status));
  if (!*exit_status) *exit_status = ExitStatus(t);
  PetscCall(LamTradeoffDestroy(t));
  PetscFunctionReturn(0);
}

/* ---- the command line ---- */

static PetscBool ReadFamilies(Command *run, int *exit_status)
{
  char text[256], *rest = text;

  for (int k = 0; k < LAM_KNOB_COUNT; k++) run->tradeoff.chosen[k] = (PetscBool)!run->only;
  snprintf(text, sizeof(text), "%s", run->only ? run->only : "");
  for (char *word = strsep(&rest, ","); run->only && word; word = strsep(&rest, ",")) {
    int k = 0;

    while (k < LAM_KNOB_COUNT && strcmp(word, LamKnobNames[k])) k++;
    if (k == LAM_KNOB_COUNT)
      return LamUsageError("tradeoff", exit_status,
                           "--only \"%s\": there are mesh, strategy, sharpness, cells, tolerance, database, macro",
                           word);
    run->tradeoff.chosen[k] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool ReadValues(Command *run, int *exit_status)
{
  char *end;

  if (run->tradeoff.repeats > LAM_MOST_REPEATS)
    return LamUsageError("tradeoff", exit_status, "--repeats \"%" PetscInt_FMT "\": %d at most", run->tradeoff.repeats,
                         LAM_MOST_REPEATS);
  if (run->budget_text) {
    run->tradeoff.budget = strtod(run->budget_text, &end);
    if (end == run->budget_text || *end || !(run->tradeoff.budget > 0) || PetscIsInfReal(run->tradeoff.budget))
      return LamUsageError("tradeoff", exit_status, "--budget \"%s\": a number of seconds is wanted, such as 120",
                           run->budget_text);
  }
  return ReadFamilies(run, exit_status);
}

/* Other ranks would share the processor and distort the times. */
static PetscBool IsSerial(int *exit_status)
{
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return (PetscBool)(size == 1 ||
                     LamUsageError("tradeoff", exit_status,
                                   "measures the time of one core; run it without mpirun, or on one rank"));
}

PetscErrorCode LamCommandTradeoff(LamArgs *args, int *exit_status)
{
  Command run = {.tradeoff = {.repeats = 3, .budget = 120}, .console.command = "tradeoff"};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "DIR",
       "folder for tradeoff.json, tradeoff.png and .svg (the diagram) and model.json; made where it is missing",
       &run.directory},
      LAM_OVERWRITE_OPTION(run.overwrite),
      {0, "budget", LAM_OPTION_TEXT, "SECONDS", "how long it may measure, in all; default 120", &run.budget_text},
      {0, "repeats", LAM_OPTION_FROM_1, "N", "how often each setting is measured; default 3", &run.tradeoff.repeats},
      {0, "only", LAM_OPTION_TEXT, "FAMILY,...", "of mesh, strategy, sharpness, cells, tolerance, database, macro",
       &run.only},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per setting on stdout", &run.console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(
      LamOptionsParse(args,
                      "tradeoff SCENE [-o DIR] [--overwrite] [--budget SECONDS] [--repeats N] [--only FAMILY,...]\n"
                      "                [--json] [--quiet]",
                      "Measures error against time over the knobs of a scene that trade them.", options, 1,
                      &run.tradeoff.scene_path, &done, exit_status));
  if (done || !ReadValues(&run, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  if (IsSerial(exit_status)) PetscCall(Solve(&run, exit_status));
  PetscFunctionReturn(0);
}
