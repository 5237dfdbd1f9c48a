/*
  lamella map: how tissue fails as a function of two of its quantities.
*/
#include "app.h"
#include "map.h"
#include "clock.h"
#include <string.h>

/* ---- points ---- */

static PetscReal ValueOf(const LamMap *m, LamMapDirection d, PetscInt64 number)
{
  const LamMapAxis *axis = &m->scene->map[d];
  const PetscInt nx = m->scene->map[LAM_MAP_X].points;
  PetscReal scale;

  (void)LamMapQuantityUnit(axis->quantity, &m->scene->scales, &scale);
  return scale * LamMapAxisValue(axis, (PetscInt)(d == LAM_MAP_X ? number % nx : number / nx));
}

static json_t *FailureToJSON(const LamMapPoint *point)
{
  json_t *o = json_object();

  json_object_set_new(o, "mode", json_string(LamFailureModeNames[point->mode]));
  if (point->reason[0]) json_object_set_new(o, "reason", json_string(point->reason));
  if (point->criterion == LAM_CRITERION_COUNT) return o;
  json_object_set_new(o, "criterion", json_string(LamCriterionNames[point->criterion]));
  json_object_set_new(o, "load_factor", LamJSONReal(point->load_factor));
  json_object_set_new(o, "place", LamPlaceToJSON(point->place));
  return o;
}

static PetscErrorCode PrintPoint(void *ctx, const LamMap *m, const LamMapPoint *point)
{
  json_t *o;

  PetscFunctionBeginUser;
  (void)ctx;
  PetscCall(LamResponseToJSON(&point->response, &m->scene->scales, -1, PETSC_FALSE, &o));
  json_object_set_new(o, "point", json_integer((json_int_t)point->number));
  json_object_set_new(o, "x", LamJSONReal(ValueOf(m, LAM_MAP_X, point->number)));
  json_object_set_new(o, "y", LamJSONReal(ValueOf(m, LAM_MAP_Y, point->number)));
  json_object_set_new(o, "failure", FailureToJSON(point));
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

/* ---- the end ---- */

/* The map in letters, y upwards as in the picture. */
static void PrintLetters(const LamMap *m)
{
  static const char letters[] = {'.', 'S', 'R', 'B', 'T', '?'};
  const LamMapAxis *axes = m->scene->map;
  const char *units[LAM_MAP_AXIS_COUNT];
  PetscReal scale;

  for (int a = 0; a < LAM_MAP_AXIS_COUNT; a++)
    units[a] = LamMapQuantityUnit(axes[a].quantity, &m->scene->scales, &scale);
  printf("%s, %s\n", LamMapQuantityNames[axes[LAM_MAP_Y].quantity], units[LAM_MAP_Y]);
  for (PetscInt y = axes[LAM_MAP_Y].points - 1; y >= 0; y--) {
    const PetscInt64 row = (PetscInt64)y * axes[LAM_MAP_X].points;

    printf("%10.4g  ", (double)ValueOf(m, LAM_MAP_Y, row));
    for (PetscInt x = 0; x < axes[LAM_MAP_X].points; x++) {
      const PetscInt mode = m->table.mode[row + x];

      printf(" %c", mode < 0 ? ' ' : letters[mode]);
    }
    putchar('\n');
  }
  printf("%10s   %s from %.4g to %.4g %s\n", "", LamMapQuantityNames[axes[LAM_MAP_X].quantity],
         (double)ValueOf(m, LAM_MAP_X, 0), (double)ValueOf(m, LAM_MAP_X, axes[LAM_MAP_X].points - 1),
         strcmp(units[LAM_MAP_X], "1") ? units[LAM_MAP_X] : "");
  for (PetscInt mode = 0; mode < LAM_FAILURE_MODE_COUNT; mode++)
    if (LamMapCountMode(m, mode))
      printf("  %c %-12s %" PetscInt_FMT "\n", letters[mode], LamFailureModeNames[mode], LamMapCountMode(m, mode));
}

static void PrintSummary(const LamMap *m)
{
  PrintLetters(m);
  printf("%" PetscInt_FMT " of %" PetscInt_FMT " points (%" PetscInt_FMT " new), %.3g s on %d rank%s\n",
         m->old + m->solved, LamMapPointCount(m->scene), m->solved, LamClock() - m->start, (int)m->ranks,
         m->ranks > 1 ? "s" : "");
  if (m->old + m->solved) printf("wrote %s\n", m->path);
}

/* ---- the command ---- */

PetscErrorCode LamCommandMap(LamArgs *args, int *exit_status)
{
  LamMap m = {0};
  LamConsole console = {.command = "map"};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "the map, for plot and info", &m.path},
      LAM_OVERWRITE_OPTION(m.overwrite),
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on with OUT.h5 where it is there", &m.resume},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per point on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "map SCENE -o OUT.h5 [--resume] [--overwrite] [--json] [--quiet]",
                            "Finds how tissue fails over two of the scene's quantities.", options, 1, &m.scene_path,
                            &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!m.path && !LamUsageError("map", exit_status, "the output is missing; give -o OUT.h5")) PetscFunctionReturn(0);
  if (!LamOutputIsHDF5("map", m.path, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  m.reporter = LamConsoleReporter(&console);
  if (console.json) m.point = PrintPoint;
  PetscCall(LamMapRun(&m));
  LamConsoleClear();
  if (!m.rank && !console.json) PrintSummary(&m);
  LamTellStopped(&console, m.path, PETSC_TRUE);
  PetscCall(LamShareOutcome((PetscBool)(!m.rank && LamMapCountMode(&m, LAM_FAILURE_UNKNOWN)), exit_status));
  PetscCall(LamMapDestroy(&m));
  PetscFunctionReturn(0);
}
