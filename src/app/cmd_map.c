/*
  lamella map: how tissue fails over two of its quantities.

  Method
    Paths (map.h) do not depend on each other and are handed out to all ranks. What has come in is committed every
    COMMIT_SECONDS: first the table of verdicts, which is written over in place, then the records, whose keys say which
    points are there. A file that was killed between the two holds verdicts without records; they are not believed, and
    --resume solves these points anew.
*/
#include "app.h"
#include "rounding.h"
#include "dispatch.h"
#include "failure_print.h"
#include "map.h"
#include <lamella/clock.h>
#include <string.h>
#include <unistd.h>

#define COMMIT_SECONDS 0.5

/* What a rank sends: the points of a path, unless it was stopped before the end. */
typedef struct {
  PetscBool complete;
  LamMapPoint points[];
} PathResult;

typedef struct {
  const char *scene_path, *path;
  PetscBool json, quiet, resume;
  LamScene *scene;
  PetscInt paths, cuts;
  LamDispatch dispatch;
  PetscMPIInt rank, ranks;
  PetscInt *todo; /* paths that the file lacks; owned, all ranks */
  PetscInt todo_count;

  /* on rank 0 */
  LamRecordWriter writer;
  LamMapTable table;
  LamMapPoint *waiting; /* [paths cuts], of them `waiting_count` not committed yet; owned */
  PetscInt waiting_count, solved, old;
  LamProgress progress;
  PetscReal start, last_commit;
} Map;

/* ---- what is told of a point ---- */

static PetscReal ValueOf(const Map *m, LamMapDirection d, PetscInt64 number)
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

static PetscErrorCode TellPoint(const Map *m, const LamMapPoint *point)
{
  json_t *o;

  PetscFunctionBeginUser;
  PetscCall(LamResponseToJSON(&point->response, &m->scene->scales, -1, PETSC_FALSE, &o));
  json_object_set_new(o, "point", json_integer((json_int_t)point->number));
  json_object_set_new(o, "x", LamJSONReal(ValueOf(m, LAM_MAP_X, point->number)));
  json_object_set_new(o, "y", LamJSONReal(ValueOf(m, LAM_MAP_Y, point->number)));
  json_object_set_new(o, "failure", FailureToJSON(point));
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

/* ---- commits ---- */

static PetscErrorCode Commit(Map *m)
{
  LamResponse *responses;
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  m->last_commit = LamClock();
  if (!m->waiting_count) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(m->waiting_count, &keys, m->waiting_count, &responses));
  for (PetscInt i = 0; i < m->waiting_count; i++) {
    keys[i] = m->waiting[i].number;
    responses[i] = m->waiting[i].response;
    LamMapTableSet(&m->table, &m->waiting[i]);
  }
  if (m->old + m->solved == m->waiting_count) PetscCall(LamMapAxesWrite(m->writer, m->scene)); /* the first commit */
  PetscCall(LamMapTableWrite(m->writer, &m->table));
  PetscCall(LamRecordWriterCommit(m->writer, m->waiting_count, keys, responses));
  PetscCall(PetscFree2(keys, responses));
  for (PetscInt i = 0; i < m->waiting_count && m->json; i++) PetscCall(TellPoint(m, &m->waiting[i]));
  m->waiting_count = 0;
  PetscFunctionReturn(0);
}

static PetscInt CountMode(const Map *m, PetscInt mode)
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < LamMapPointCount(m->scene); i++) count += m->table.mode[i] == mode;
  return count;
}

/* LamDispatchJob.worked */
static PetscErrorCode Arrive(void *ctx, PetscInt64 index, const void *result)
{
  const PathResult *path = result;
  Map *m = ctx;

  PetscFunctionBeginUser;
  (void)index;
  if (!path->complete) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(m->waiting + m->waiting_count, path->points, m->cuts));
  m->waiting_count += m->cuts;
  m->solved += m->cuts;
  if (LamClock() - m->last_commit >= COMMIT_SECONDS) PetscCall(Commit(m));
  PetscCall(LamProgressUpdate(&m->progress, m->old + m->solved, CountMode(m, LAM_FAILURE_UNKNOWN)));
  PetscFunctionReturn(0);
}

/* Follows the path number `index` of those to do. */
static PetscErrorCode Follow(void *ctx, PetscInt64 index, const void *input, size_t input_size, void *result,
                             size_t *size)
{
  const Map *m = ctx;
  PathResult *path = result;

  PetscFunctionBeginUser;
  PetscCall(LamMapFollow(m->scene, m->todo[index], LamDispatchInterrupt, m->dispatch, path->points, &path->complete));
  PetscFunctionReturn(0);
}

/* ---- going on with a file ---- */

/* Another scene would give another map. */
static PetscErrorCode CheckScene(const Map *m)
{
  PetscBool found, same;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(m->path, "/scene", &found, &text));
  same = (PetscBool)(found && !strcmp(text, m->scene->text));
  PetscCall(PetscFree(text));
  PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was begun with another scene than %s; --resume needs the same, to the letter", m->path,
             m->scene_path);
  PetscFunctionReturn(0);
}

/* The points of a path are committed together: the first stands for all. */
static PetscErrorCode FindTodo(Map *m)
{
  const PetscInt64 *keys;
  PetscBool *known;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(LamMapPointCount(m->scene), &known));
  PetscCall(LamRecordWriterGetKeys(m->writer, &m->old, &keys));
  for (PetscInt i = 0; i < m->old; i++) {
    PetscCheck(keys[i] >= 0 && keys[i] < LamMapPointCount(m->scene), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: record %" PetscInt_FMT " is of no point of the map; the file is damaged, begin it anew", m->path,
               i);
    known[keys[i]] = PETSC_TRUE;
  }
  if (m->old) PetscCall(LamMapTableRead(m->path, known, &m->table));
  for (PetscInt p = 0; p < m->paths; p++)
    if (!known[LamMapPointNumber(m->scene, p, 0)]) m->todo[m->todo_count++] = p;
  PetscCall(PetscFree(known));
  PetscFunctionReturn(0);
}

/* ---- the end ---- */

/* The map in letters, y upwards as in the picture. */
static void PrintLetters(const Map *m)
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
    if (CountMode(m, mode))
      printf("  %c %-12s %" PetscInt_FMT "\n", letters[mode], LamFailureModeNames[mode], CountMode(m, mode));
}

static PetscErrorCode Summary(const Map *m)
{
  PetscFunctionBeginUser;
  if (m->json) PetscFunctionReturn(0);
  PrintLetters(m);
  printf("%" PetscInt_FMT " of %" PetscInt_FMT " points (%" PetscInt_FMT " new), %.3g s on %d rank%s\n",
         m->old + m->solved, LamMapPointCount(m->scene), m->solved, LamClock() - m->start, (int)m->ranks,
         m->ranks > 1 ? "s" : "");
  if (m->old + m->solved) printf("wrote %s\n", m->path);
  PetscFunctionReturn(0);
}

/* Rank 0's outcome is everyone's: mpirun reports the largest. */
static PetscErrorCode ExitStatus(Map *m, int *exit_status)
{
  int status = LAM_EXIT_OK;

  PetscFunctionBeginUser;
  if (m->rank == 0 && CountMode(m, LAM_FAILURE_UNKNOWN)) status = LAM_EXIT_UNSOLVED;
  if (LamStopRequested()) status = LamStopExitStatus();
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  *exit_status = status;
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* The file describes the tissue of the scene, with the mesh that the planner gives it. */
static PetscErrorCode OpenWriter(Map *m)
{
  const PetscBool goes_on = (PetscBool)(m->resume && !access(m->path, F_OK));
  LamScene described = *m->scene;
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(LamPlanMake(m->scene, &plan));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &LamConsole, &plan.micro, m->scene->accuracy));
  described.micro = plan.micro;
  PetscCall(LamMapTableCreate(m->scene, &m->table));
  PetscCall(PetscMalloc1(LamMapPointCount(m->scene), &m->waiting));
  PetscCall(
      LamRecordWriterOpen(m->path, "map", m->resume ? LAM_WRITE_APPEND : LAM_WRITE_CREATE, &described, &m->writer));
  if (goes_on) PetscCall(CheckScene(m));
  PetscCall(FindTodo(m));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(Map *m)
{
  PetscBool complete;

  PetscFunctionBeginUser;
  PetscCall(LamProgressStart(&m->progress, LamMapPointCount(m->scene), m->quiet));
  PetscCall(LamDispatchAdd(m->dispatch, 0, m->todo_count, 1));
  PetscCall(LamDispatchRun(m->dispatch, NULL, NULL, &complete));
  PetscCall(Commit(m));
  PetscCall(LamProgressEnd(&m->progress));
  PetscFunctionReturn(0);
}

/* Closes the file, whatever has happened. */
static PetscErrorCode CloseAfter(Map *m, PetscErrorCode ierr)
{
  const PetscErrorCode closed = LamRecordWriterClose(&m->writer);

  PetscFunctionBeginUser;
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}

/* Rank 0 keeps the file. A worker that fails cannot tell rank 0, which waits for its result: it ends the job. */
static PetscErrorCode RunAll(Map *m)
{
  const PetscBool root = (PetscBool)(m->rank == 0);
  PetscErrorCode ierr = root ? OpenWriter(m) : 0;

  PetscFunctionBeginUser;
  if (ierr) (void)LamRecordWriterClose(&m->writer);
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr));
  PetscCallMPI(MPI_Bcast(m->todo, (PetscMPIInt)m->paths, MPIU_INT, 0, PETSC_COMM_WORLD));
  if (root) {
    ierr = CloseAfter(m, RunRoot(m));
  } else {
    PetscCall(LamDispatchServe(m->dispatch));
  }
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr));
  if (root) PetscCall(Summary(m));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(Map *m)
{
  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(m->scene_path, &m->scene));
  PetscCheck(m->scene->has_map, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `map`, which says what quantities to vary", m->scene_path);
  m->paths = LamMapPathCount(m->scene);
  m->cuts = LamMapCutCount(m->scene);
  PetscCall(PetscCalloc1(m->paths, &m->todo));
  m->start = LamClock();
  m->last_commit = m->start;
  PetscCall(
      LamDispatchCreate(PETSC_COMM_WORLD,
                        &(LamDispatchJob){m, .result_size = sizeof(PathResult) + (size_t)m->cuts * sizeof(LamMapPoint),
                                          .work = Follow, .worked = Arrive},
                        &m->dispatch));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &m->rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &m->ranks));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Map *m)
{
  PetscFunctionBeginUser;
  if (m->rank == 0) PetscCall(LamMapTableDestroy(&m->table));
  PetscCall(PetscFree(m->waiting));
  PetscCall(PetscFree(m->todo));
  PetscCall(LamDispatchDestroy(&m->dispatch));
  PetscCall(LamSceneDestroy(&m->scene));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandMap(LamArgs *args, int *exit_status)
{
  Map m = {0};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "OUT.h5", "the map, for plot and info", &m.path},
      {0, "resume", LAM_OPTION_FLAG, NULL, "go on with OUT.h5 where it is there", &m.resume},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per point on stdout", &m.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &m.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "map SCENE -o OUT.h5 [--resume] [--json] [--quiet]",
                            "Tells how tissue fails over two of the scene's quantities.", options, 1, &m.scene_path,
                            &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!m.path) {
    fprintf(stderr, "lamella map: the output is missing; give -o OUT.h5\n");
    *exit_status = LAM_EXIT_USAGE;
    PetscFunctionReturn(0);
  }
  PetscCall(args->start(args));
  PetscCall(Prepare(&m));
  PetscCall(RunAll(&m));
  PetscCall(ExitStatus(&m, exit_status));
  PetscCall(Destroy(&m));
  PetscFunctionReturn(0);
}
