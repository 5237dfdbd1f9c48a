/*
  A map of how tissue fails as a function of two of its quantities.

  Method

  Paths (map.h) are independent and are distributed over all ranks. Every COMMIT_SECONDS the results received are
  committed: first the table of failure modes, overwritten in place, then the records, whose keys mark the points that
  are complete. A file whose run was killed between the two contains table entries without records; these are ignored,
  and their points are solved again on resuming.
*/
#include "rounding.h"
#include "turgor_stretch.h"
#include "dispatch.h"
#include "map.h"
#include "mesh_choice.h"
#include "clock.h"
#include <string.h>
#include <unistd.h>

#define COMMIT_SECONDS 0.5

/* Message from a rank: the points of a path, unless it was stopped before its end. */
typedef struct {
  PetscBool complete;
  LamMapPoint points[];
} PathResult;

/* ---- commits ---- */

static PetscErrorCode Commit(LamMap *m)
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
  if (m->old + m->solved == m->waiting_count) PetscCall(LamMapAxesWrite(m->writer, m->scene)); /* first commit */
  PetscCall(LamMapTableWrite(m->writer, &m->table));
  PetscCall(LamRecordWriterCommit(m->writer, m->waiting_count, keys, responses));
  PetscCall(PetscFree2(keys, responses));
  for (PetscInt i = 0; i < m->waiting_count && m->point; i++) PetscCall(m->point(m->reporter.ctx, m, &m->waiting[i]));
  m->waiting_count = 0;
  PetscFunctionReturn(0);
}

PetscInt LamMapCountMode(const LamMap *m, PetscInt mode)
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < LamMapPointCount(m->scene); i++) count += m->table.mode[i] == mode;
  return count;
}

/* LamDispatchJob.worked */
static PetscErrorCode Arrive(void *ctx, PetscInt64 index, const void *result)
{
  const PathResult *path = result;
  LamMap *m = ctx;

  PetscFunctionBeginUser;
  (void)index;
  if (!path->complete) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(m->waiting + m->waiting_count, path->points, m->cuts));
  m->waiting_count += m->cuts;
  m->solved += m->cuts;
  if (LamClock() - m->last_commit >= COMMIT_SECONDS) PetscCall(Commit(m));
  PetscCall(LamReportProgress(&m->reporter, m->old + m->solved, LamMapPointCount(m->scene),
                              LamMapCountMode(m, LAM_FAILURE_UNKNOWN)));
  PetscFunctionReturn(0);
}

/* Follows path number `index` of the todo list. */
static PetscErrorCode Follow(void *ctx, PetscInt64 index, const void *input, size_t input_size, void *result,
                             size_t *size)
{
  const LamMap *m = ctx;
  PathResult *path = result;

  PetscFunctionBeginUser;
  PetscCall(LamMapFollow(m->scene, m->todo[index], LamDispatchInterrupt, m->dispatch, path->points, &path->complete));
  PetscFunctionReturn(0);
}

/* ---- resuming ---- */

/* The points of a path are committed together, so the first one represents all. */
static PetscErrorCode FindTodo(LamMap *m)
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
  PetscCall(LamMapTableCreate(m->scene, m->old ? m->path : NULL, known, &m->table));
  for (PetscInt p = 0; p < m->paths; p++)
    if (!known[LamMapPointNumber(m->scene, p, 0)]) m->todo[m->todo_count++] = p;
  PetscCall(PetscFree(known));
  PetscFunctionReturn(0);
}

/* ---- ranks ---- */

/* The file describes the tissue of the scene, on the mesh chosen by the planner. */
static PetscErrorCode OpenWriter(LamMap *m)
{
  const PetscBool goes_on = (PetscBool)(m->resume && !access(m->path, F_OK));
  LamScene described = *m->scene;

  PetscFunctionBeginUser;
  if (!m->resume) PetscCall(LamTargetCheck(m->path, "map", m->overwrite, m->scene));
  PetscCall(LamChooseMesh(&described, NULL));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &m->reporter, &described.micro, m->scene->accuracy));
  LamWarnOfTurgor(&m->reporter, m->scene);
  PetscCall(PetscMalloc1(LamMapPointCount(m->scene), &m->waiting));
  PetscCall(LamRecordWriterOpen(m->path, "map", m->resume ? LAM_WRITE_APPEND : LamTargetMode(m->overwrite), &described,
                                &m->writer));
  if (goes_on) PetscCall(LamCheckSameSceneFile(m->path, m->scene));
  PetscCall(FindTodo(m));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunRoot(LamMap *m)
{
  PetscFunctionBeginUser;
  LamActivitySet("points of the map");
  PetscCall(LamReportProgress(&m->reporter, m->old, LamMapPointCount(m->scene), 0));
  PetscCall(LamDispatchAdd(m->dispatch, 0, m->todo_count, 0, 1));
  PetscCall(LamDispatchRun(m->dispatch, NULL, NULL, NULL));
  PetscCall(Commit(m));
  PetscFunctionReturn(0);
}

/* Rank 0 owns the file. A worker that fails cannot notify rank 0, which waits for its result, so it aborts the job. */
static PetscErrorCode RunAll(LamMap *m)
{
  const PetscBool root = (PetscBool)(m->rank == 0);
  PetscErrorCode ierr = root ? OpenWriter(m) : 0, closed = 0;

  PetscFunctionBeginUser;
  if (ierr) (void)LamRecordWriterClose(&m->writer);
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr));
  PetscCallMPI(MPI_Bcast(m->todo, (PetscMPIInt)m->paths, MPIU_INT, 0, PETSC_COMM_WORLD));
  if (root) {
    ierr = RunRoot(m);
    closed = LamRecordWriterClose(&m->writer); /* also after an error */
  } else {
    PetscCall(LamDispatchServe(m->dispatch));
  }
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr ? ierr : closed));
  PetscFunctionReturn(0);
}

/* One mesh for all paths, unless their walls differ. */
static PetscErrorCode ChooseMesh(LamMap *m)
{
  LamScene described = *m->scene;
  LamMeshTrial trial;

  PetscFunctionBeginUser;
  PetscCall(LamChooseMesh(&described, &trial));
  LamWarnOfMesh(PETSC_COMM_WORLD, &m->reporter, m->scene, &trial);
  if (!LamMapVariesWalls(m->scene)) m->scene->micro = described.micro;
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(LamMap *m)
{
  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(m->scene_path, &m->scene));
  PetscCheck(m->scene->has_map, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `map`, which says what quantities to vary", m->scene_path);
  PetscCall(ChooseMesh(m));
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

PetscErrorCode LamMapRun(LamMap *m)
{
  PetscFunctionBeginUser;
  PetscCall(Prepare(m));
  PetscCall(RunAll(m));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMapDestroy(LamMap *m)
{
  PetscFunctionBeginUser;
  if (m->rank == 0) PetscCall(LamMapTableDestroy(&m->table));
  PetscCall(PetscFree(m->waiting));
  PetscCall(PetscFree(m->todo));
  PetscCall(LamDispatchDestroy(&m->dispatch));
  PetscCall(LamSceneDestroy(&m->scene));
  PetscFunctionReturn(0);
}
