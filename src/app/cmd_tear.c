/*
  lamella tear: the traction-separation law of a layer of tissue, against turgor.
*/
#include "app.h"
#include "beside.h"
#include "clock.h"
#include "quantity_text.h"
#include "tear.h"
#include <math.h>
#include <string.h>

enum { MOST_TURGORS = 32, STEPS = 40 };

#define IMBALANCE 0.02 /* of the energies of a curve, over what is spent: more is worth a word */

typedef struct {
  LamConsole console; /* the reporter's ctx; first */
  const char *scene_path, *out_path, *turgor_text, *modes, *separation_text;
  PetscReal turgor[MOST_TURGORS], start;
  LamBeside csv; /* with -o */
  PetscBool overwrite;
  LamTear tear;
} Command;

/* ---- the table ---- */

/* Factors to the units of the table. */
typedef struct {
  PetscReal um, MPa, energy; /* energy: to J/m^2 */
} Units;

static Units UnitsOf(const LamTear *tear)
{
  const LamScales *scales = &tear->scene->scales;

  return (Units){scales->length * 1e6, scales->stress * 1e-6, scales->stress * scales->length};
}

/* Numbers of a point p of a curve: name, unit, value. */
#define COLUMNS(X)                                                                                                     \
  X("separation", " (um)", p->separation *units.um)                                                                    \
  X("traction", " (MPa)", p->traction *units.MPa)                                                                      \
  X("crack_separation", " (um)", p->crack *units.um)                                                                   \
  X("dilation", " (um)", p->dilation *units.um)                                                                        \
  X("work", " (J/m^2)", p->work *units.energy)                                                                         \
  X("stored", " (J/m^2)", p->stored *units.energy)                                                                     \
  X("dissipated", " (J/m^2)", p->dissipated *units.energy)                                                             \
  X("released", " (J/m^2)", p->released *units.energy)                                                                 \
  X("broken_fraction", "", p->broken)                                                                                  \
  X("dissipated_walls", " (J/m^2)", p->walls *units.energy)                                                            \
  X("burst_fraction", "", p->burst)                                                                                    \
  X("F11", "", p->F[0][0])                                                                                             \
  X("F12", "", p->F[0][1])                                                                                             \
  X("F22", "", p->F[1][1])

#define NAME_ENTRY(name, unit, value) name unit,
static const char *const Columns[] = {COLUMNS(NAME_ENTRY) NULL};
static const LamTextKind Table = {.what = "a table of lamella tear",
                                  .ending = "",
                                  .begins = "mode,turgor (MPa),separation (um),traction (MPa)",
                                  .columns = Columns,
                                  .ends = ",jumped"};

static PetscErrorCode OpenTable(Command *command)
{
  PetscFunctionBeginUser;
  if (!command->out_path) PetscFunctionReturn(0);
  PetscCall(LamBesideOpen(command->out_path, &Table, &command->csv));
#define PRINT_NAME(name, unit, value) fputs("," name unit, command->csv.out);
  fputs("mode,turgor (MPa)", command->csv.out);
  COLUMNS(PRINT_NAME)
  fputs(",jumped\n", command->csv.out);
  PetscFunctionReturn(0);
}

static void AddToTable(const Command *command, const LamTearCurve *curve)
{
  const Units units = UnitsOf(&command->tear);
  FILE *out = command->csv.out;

  for (const LamTearPoint *p = curve->points; out && p < curve->points + curve->count; p++) {
    fputs(LamTearModeNames[curve->mode], out);
    LamBesideNumber(out, curve->turgor * units.MPa);
#define PRINT_VALUE(name, unit, value) LamBesideNumber(out, value);
    COLUMNS(PRINT_VALUE)
    fprintf(out, ",%d\n", p->jumped);
  }
}

/* ---- on the terminal ---- */

static void PrintPoints(const LamTearCurve *curve, Units units)
{
  printf("%10s %10s %10s %10s %10s %10s %10s %10s %7s\n", "separation", "traction", "of crack", "dilation", "work",
         "stored", "dissipated", "released", "broken");
  printf("%10s %10s %10s %10s %10s %10s %10s %10s\n", "um", "MPa", "um", "um", "J/m^2", "J/m^2", "J/m^2", "J/m^2");
  for (const LamTearPoint *p = curve->points; p < curve->points + curve->count; p++) {
    LamPrintColumn(10, 4, 'f', p->separation * units.um);
    LamPrintColumn(11, 3, 'e', LamWithoutNoise(p->traction) * units.MPa);
    LamPrintColumn(11, 4, 'f', LamWithoutNoise(p->crack) * units.um);
    LamPrintColumn(11, 4, 'f', p->dilation * units.um);
    LamPrintColumn(11, 3, 'e', p->work * units.energy);
    LamPrintColumn(11, 3, 'e', p->stored * units.energy);
    LamPrintColumn(11, 3, 'e', p->dissipated * units.energy);
    LamPrintColumn(11, 3, 'e', p->released * units.energy);
    LamPrintColumn(8, 4, 'f', p->broken);
    printf("%s\n", p->jumped ? "  jumped" : "");
  }
}

static const char *const EndWords[] = {
    [LAM_TEAR_APART] = "comes apart",
    [LAM_TEAR_SEPARATION] = "still holds",
    [LAM_TEAR_TORN] = "is torn by its turgor alone",
    [LAM_TEAR_UNSOLVED] = "was not followed to its end",
    [LAM_TEAR_STOPPED] = "was stopped",
};

static void PrintReadings(const LamTearCurve *curve, Units units)
{
  const LamTearReadings r = LamTearRead(curve);
  const LamTearPoint *last = curve->points + curve->count - 1;

  printf("  strength %.4g MPa at %.4g um; stiffness at the start %.4g MPa/mm\n", (double)(r.strength * units.MPa),
         (double)(r.at * units.um), (double)(1e3 * curve->stiffness * units.MPa / units.um));
  printf("  energy %.4g J/m^2", (double)(r.energy * units.energy));
  if (isfinite(r.share)) printf(", %.3g %% of it released in jumps", (double)(100 * r.share));
  printf("; work of the traction %.4g J/m^2\n", (double)(last->work * units.energy));
  if (fabs(r.imbalance) > IMBALANCE * r.energy)
    printf("  warning: the energies are %.2g %% of that from the work: a jump was not seen, or steps are too long; give "
           "more --steps\n",
           (double)(100 * r.imbalance / r.energy));
  if (last->burst > 0 || last->walls > 0)
    printf("  walls have spent %.4g J/m^2 of it; %.3g %% of the cells have burst\n",
           (double)(last->walls * units.energy), (double)(100 * last->burst));
  printf("  energy of the lamella in a straight crack %.4g J/m^2\n", (double)(curve->straight * units.energy));
}

static void PrintCurve(const LamTear *tear, const LamTearCurve *curve)
{
  const Units units = UnitsOf(tear);

  printf("%s under a turgor of %.4g MPa", LamTearModeNames[curve->mode], (double)(curve->turgor * units.MPa));
  if (isfinite(curve->F0[0]))
    printf(", from the tissue free of stress (stretches %.4f and %.4f), per area of it", (double)curve->F0[0],
           (double)curve->F0[1]);
  putchar('\n');
  if (curve->count) PrintPoints(curve, units);
  printf("  the layer %s", EndWords[curve->end]);
  if (curve->reason[0]) printf(": %s", curve->reason);
  putchar('\n');
  if (curve->count > 1 && curve->end != LAM_TEAR_TORN) PrintReadings(curve, units);
}

/* ---- JSON ---- */

static PetscErrorCode PrintObjects(const LamTear *tear, const LamTearCurve *curve)
{
  const Units units = UnitsOf(tear);

  PetscFunctionBeginUser;
  for (const LamTearPoint *p = curve->points; p < curve->points + curve->count; p++) {
    json_t *o = json_pack("{s:s, s:o}", "mode", LamTearModeNames[curve->mode], "turgor",
                          LamJSONReal(curve->turgor * units.MPa));

#define SET_MEMBER(name, unit, value) json_object_set_new(o, name, LamJSONReal(value));
    COLUMNS(SET_MEMBER)
    json_object_set_new(o, "jumped", json_boolean(p->jumped));
    PetscCall(LamPrintJSON(o));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintCurveObject(const LamTear *tear, const LamTearCurve *curve)
{
  const LamTearReadings r = LamTearRead(curve);
  const PetscReal work = curve->count ? curve->points[curve->count - 1].work : NAN;
  const Units units = UnitsOf(tear);
  json_t *o = json_pack("{s:s, s:o, s:s, s:I, s:o}", "mode", LamTearModeNames[curve->mode], "turgor",
                        LamJSONReal(curve->turgor * units.MPa), "end", LamTearEndNames[curve->end], "states",
                        (json_int_t)r.states, "stretches", LamJSONReals(2, curve->F0, 1));

  PetscFunctionBeginUser;
  if (curve->reason[0]) json_object_set_new(o, "reason", json_string(curve->reason));
  json_object_update_new(
      o, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "strength", LamJSONReal(r.strength * units.MPa),
                   "separation_at_peak", LamJSONReal(r.at * units.um), "stiffness",
                   LamJSONReal(1e3 * curve->stiffness * units.MPa / units.um), "energy",
                   LamJSONReal(r.energy * units.energy), "released_share", LamJSONReal(r.share), "work",
                   LamJSONReal(work * units.energy), "imbalance", LamJSONReal(r.imbalance * units.energy), "law_energy",
                   LamJSONReal(r.law * units.energy), "straight_crack_energy",
                   LamJSONReal(curve->straight * units.energy)));
  PetscCall(LamPrintJSON(json_pack("{s:o}", "curve", o)));
  PetscFunctionReturn(0);
}

/* `curve` of a LamTear; ctx: a Command. */
static PetscErrorCode Report(void *ctx, const LamTear *tear, const LamTearCurve *curve)
{
  const Command *command = (const Command *)ctx;

  PetscFunctionBeginUser;
  AddToTable(command, curve);
  LamConsoleClear();
  if (command->console.json) {
    PetscCall(PrintObjects(tear, curve));
    PetscCall(PrintCurveObject(tear, curve));
  } else {
    PrintCurve(tear, curve);
  }
  PetscFunctionReturn(0);
}

/* ---- the command line ---- */

static PetscBool ReadModes(Command *command, int *exit_status)
{
  char text[64], *rest = text;

  for (int k = 0; k < LAM_TEAR_MODE_COUNT; k++) command->tear.mode[k] = (PetscBool)!command->modes;
  snprintf(text, sizeof(text), "%s", command->modes ? command->modes : "");
  for (char *word = strsep(&rest, ","); command->modes && word; word = strsep(&rest, ",")) {
    int k = 0;

    while (k < LAM_TEAR_MODE_COUNT && strcmp(word, LamTearModeNames[k])) k++;
    if (k == LAM_TEAR_MODE_COUNT)
      return LamUsageError("tear", exit_status, "--modes \"%s\": there are opening, shear", word);
    command->tear.mode[k] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool CheckOutput(const Command *command, int *exit_status)
{
  const char *dot = command->out_path ? strrchr(command->out_path, '.') : NULL;

  if (!command->out_path || (dot && !strcmp(dot, ".csv"))) return PETSC_TRUE;
  return LamUsageError("tear", exit_status, "-o %s: a table is written; give a name that ends in .csv",
                       command->out_path);
}

/* A quantity of an option, from 0 on or above it. */
static PetscErrorCode ReadQuantity(const char option[], const char text[], LamDimension dimension, PetscBool positive,
                                   PetscReal *si, PetscBool *right, int *exit_status)
{
  char reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(LamQuantityRead(text, dimension, si, reason));
  if (!reason[0] && (*si < 0 || (positive && *si == 0)))
    snprintf(reason, sizeof(reason), positive ? "must be above 0" : "must not be negative");
  *right = (PetscBool)!reason[0];
  if (!*right)
    (void)LamUsageError("tear", exit_status, "%s \"%s\": %s; write a %s such as %s", option, text, reason,
                        LamDimensionNames[dimension], LamDimensionExamples[dimension]);
  PetscFunctionReturn(0);
}

/* Whether a text is a number without a unit. */
static PetscBool IsBare(const char text[])
{
  const char *end = text + strspn(text, " \t");

  (void)LamNumberScan(end, &end);
  return (PetscBool)(end[strspn(end, " \t")] == '\0');
}

/* "0, 0.1, 0.3 MPa": a number without a unit has that of the last one. */
static PetscErrorCode ReadTurgors(Command *command, PetscBool *right, int *exit_status)
{
  const char *text = command->turgor_text, *last = text ? strrchr(text, ',') : NULL, *unit;
  LamTear *tear = &command->tear;

  PetscFunctionBeginUser;
  if (!text) PetscFunctionReturn(0);
  last = last ? last + 1 : text;
  last += strspn(last, " \t");
  (void)LamNumberScan(last, &unit);
  if (LamListMayBeDecimal(text))
    *right =
        LamUsageError("tear", exit_status,
                      "--turgor \"%s\": one turgor with a decimal comma, or two? write the decimal sign as a point, "
                      "and a blank behind a comma between two",
                      text);
  else if (unit == last) /* its own message */
    PetscCall(ReadQuantity("--turgor", last, LAM_DIMENSION_STRESS, PETSC_FALSE, command->turgor, right, exit_status));
  for (; text && *right; text = strchr(text, ',') ? strchr(text, ',') + 1 : NULL) {
    char item[2 * LAM_NAME_LENGTH];

    if (tear->turgor_count == MOST_TURGORS) {
      *right = LamUsageError("tear", exit_status, "--turgor: %d at most", MOST_TURGORS);
      break;
    }
    snprintf(item, sizeof(item), "%.*s", (int)strcspn(text, ","), text);
    if (IsBare(item)) PetscCall(PetscStrlcat(item, unit, sizeof(item)));
    PetscCall(ReadQuantity("--turgor", item, LAM_DIMENSION_STRESS, PETSC_FALSE, &command->turgor[tear->turgor_count++],
                           right, exit_status));
  }
  tear->turgor = command->turgor;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadValues(Command *command, PetscBool *right, int *exit_status)
{
  PetscFunctionBeginUser;
  *right = (PetscBool)(ReadModes(command, exit_status) && CheckOutput(command, exit_status));
  if (*right) PetscCall(ReadTurgors(command, right, exit_status));
  if (*right && command->separation_text)
    PetscCall(ReadQuantity("--separation", command->separation_text, LAM_DIMENSION_LENGTH, PETSC_TRUE,
                           &command->tear.separation, right, exit_status));
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

static int ExitStatus(const LamTear *tear)
{
  if (LamStopRequested()) return LamStopExitStatus();
  return tear->unsolved ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
}

static PetscErrorCode RunOnRoot(Command *command, int *exit_status)
{
  LamTear *tear = &command->tear;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  tear->reporter = LamConsoleReporter(&command->console);
  tear->curve = Report;
  command->start = LamClock();
  PetscCall(LamSceneRead(command->scene_path, &tear->scene));
  if (command->out_path) PetscCall(LamTargetCheckText(command->out_path, &Table, command->overwrite, tear->scene));
  PetscCall(LamTearPrepare(tear));
  PetscCall(OpenTable(command));
  ierr = LamTearRun(tear);
  if (command->csv.out) {
    const PetscErrorCode written = LamBesideClose(&command->csv);

    if (!ierr) ierr = written;
  }
  PetscCall(ierr);
  LamConsoleClear();
  if (!command->console.json) {
    printf("%d curves, %.3g s\n", (int)tear->curves, (double)(LamClock() - command->start));
    if (command->out_path) printf("wrote %s\n", command->out_path);
  }
  LamTellStopped(&command->console, command->out_path, PETSC_FALSE);
  *exit_status = ExitStatus(tear);
  PetscCall(LamTearDestroy(tear));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandTear(LamArgs *args, int *exit_status)
{
  Command command = {.console.command = "tear", .tear.steps = STEPS};
  PetscBool done, right;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.csv", "the table of all curves", &command.out_path},
      LAM_OVERWRITE_OPTION(command.overwrite),
      {0, "turgor", LAM_OPTION_TEXT, "PRESSURE,...", "turgors, such as 0,0.1,0.3 MPa; default: the scene's",
       &command.turgor_text},
      {0, "modes", LAM_OPTION_TEXT, "MODE,...", "opening, shear or both, which is the default", &command.modes},
      {0, "separation", LAM_OPTION_TEXT, "LENGTH",
       "the largest, such as 50 um; default: until nothing holds, in shear at most half a cell",
       &command.separation_text},
      {0, "steps", LAM_OPTION_FROM_2, "N", "equal steps to there; default 40", &command.tear.steps},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per state and per curve on stdout", &command.console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &command.console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "tear SCENE [-o OUT.csv] [--turgor PRESSURE,...] [--modes MODE,...] [--separation LENGTH]\n"
                            "            [--steps N] [--overwrite] [--json] [--quiet]",
                            "Tears a layer of tissue: traction against separation, as a cohesive law.", options, 1,
                            &command.scene_path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  PetscCall(ReadValues(&command, &right, exit_status));
  if (!right) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  if (LamAppIsRoot()) {
    const PetscErrorCode ierr = RunOnRoot(&command, exit_status);

    PetscCall(LamRVEDismiss(PETSC_COMM_WORLD));
    PetscCall(ierr);
  } else {
    PetscCall(LamRVEServe(PETSC_COMM_WORLD, LamStopInterrupt, NULL));
  }
  PetscFunctionReturn(0);
}
