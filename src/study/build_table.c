/*
  Filling the table of a response database.

  Method
    In rounds (build.h): rank 0 queries the table of the complete rounds at the states of the sample box. All ranks
    solve the nodes that it lacks, each from its parent (node_work.h), those of the older round first, so that the
    next one is selected while the younger one is being solved, and of a round the longest chain first. Nodes are
  committed in this order, so the file does not depend on the number of ranks (except times, and checksums, which cover
  them). An exception: an unsolved node delays the nodes after it for half a minute at most.
*/
#include "build_run.h"
#include "mesh_choice.h"
#include "rounding.h"
#include "turgor_stretch.h"
#include "clock.h"
#include <string.h>

/* ---- rounds ---- */

static PetscErrorCode RequestRound(LamBuild *b, const LamRound *round)
{
  PetscFunctionBeginUser;
  b->there += round->n - round->missing;
  for (PetscInt m = 0; m < round->missing; m++)
    PetscCall(LamNodeWorkRequest(b->work, round->keys[round->order[m]], round->turn, round->cost[m]));
  PetscFunctionReturn(0);
}

/* Closes complete rounds and opens the next. Nodes that arrive meanwhile may complete a round. */
static PetscErrorCode OpenRounds(LamBuild *b)
{
  PetscInt64 available;
  LamRound *round;

  PetscFunctionBeginUser;
  if (b->opening || LamStopRequested()) PetscFunctionReturn(0);
  b->opening = PETSC_TRUE;
  do {
    PetscCall(LamBuildTakeSolved(b, PETSC_TRUE));
    available = LamRoundsAvailable(&b->rounds);
    PetscCall(LamRoundsNext(&b->rounds, &round));
    if (round) PetscCall(RequestRound(b, round));
  } while (round || LamRoundsAvailable(&b->rounds) > available);
  b->opening = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* LamNodeCallbacks.arrived */
static PetscErrorCode Arrive(void *ctx, PetscInt64 key, const LamResponse *response)
{
  LamBuild *b = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamRoundsArrive(&b->rounds, key, response));
  PetscCall(OpenRounds(b));
  PetscCall(LamBuildCommitInTime(b));
  PetscCall(LamReportProgress(&b->reporter, LamRoundsAvailable(&b->rounds),
                              b->scene->sample.count ? b->rounds.most : LamRoundsRequested(&b->rounds),
                              LamBuildFailed(b)));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveRounds(LamBuild *b)
{
  PetscFunctionBeginUser;
  b->last_commit = b->last_taken = LamClock();
  LamActivitySet("nodes of the table");
  b->rounds.meanwhile = (LamMeanwhile){LamNodeWorkLook, b->work};
  PetscCall(OpenRounds(b));
  PetscCall(LamNodeWorkRun(b->work, LamBuildCommitAll));
  PetscCall(LamBuildCommitAll(b));
  PetscFunctionReturn(0);
}

/* Broadcasts the grid of rank 0 as text. All ranks construct it from this text, as a later run does. */
static PetscErrorCode ShareGrid(LamBuild *b)
{
  char *text = NULL;
  size_t length = 0;
  LamGrid grid;

  PetscFunctionBeginUser;
  if (!b->rank) {
    PetscCall(LamDatabaseGetGrid(b->rounds.table, &grid));
    PetscCall(LamGridGetText(grid, &text));
    length = strlen(text) + 1;
  }
  PetscCall(LamShareBytes(b->leaders, 0, &length, &text));
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, &b->grid));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

/* ---- ranks ---- */

/* On ranks that solve an RVE alone or lead a team that does; rank 0 writes the file. */
static PetscErrorCode RunLeader(LamBuild *b)
{
  const LamNodeCallbacks callbacks = {.ctx = b, .arrived = Arrive, .known = &b->rounds.known};
  const PetscBool root = (PetscBool)(b->rank == 0);
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRVECreate(b->team, b->scene, &b->rve));
  ierr = LamBuildStart(b);
  if (ierr) (void)LamRecordWriterClose(&b->writer);
  PetscCall(LamShareError(b->leaders, ierr));
  PetscCall(ShareGrid(b));
  PetscCall(LamNodeWorkCreate(b->leaders, b->rve, b->scene->micro.interface, b->grid, LAM_NODE_WORK_MEMORY, &callbacks,
                              &b->work));
  ierr = root ? SolveRounds(b) : LamNodeWorkServe(b->work);
  if (ierr)
    (void)LamRecordWriterClose(&b->writer);
  else
    ierr = LamRecordWriterClose(&b->writer);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/*
  The first rank of each team controls the solves; the others take part in its factorisations until it dismisses them.
  An error on one rank alone returns to main, which aborts the job.
*/
static PetscErrorCode RunAll(LamBuild *b)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (b->leaders == MPI_COMM_NULL) {
    PetscCall(LamRVEServe(b->team, LamStopInterrupt, NULL));
  } else {
    ierr = RunLeader(b);
    PetscCall(LamNodeWorkDestroy(&b->work));
    PetscCall(LamRVEDestroy(&b->rve)); /* its factors are distributed over the team */
    if (b->team_size > 1) PetscCall(LamRVEDismiss(b->team));
  }
  PetscCall(LamShareError(PETSC_COMM_WORLD, ierr));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateTeams(LamBuild *b)
{
  PetscMPIInt place;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &b->rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &b->size));
  PetscCallMPI(MPI_Comm_split(PETSC_COMM_WORLD, (int)(b->rank / b->team_size), b->rank, &b->team));
  PetscCallMPI(MPI_Comm_rank(b->team, &place));
  PetscCallMPI(MPI_Comm_split(PETSC_COMM_WORLD, place ? MPI_UNDEFINED : 0, b->rank, &b->leaders));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildPrepare(LamBuild *b, const char scene_path[])
{
  LamMeshTrial trial;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(scene_path, &b->scene));
  PetscCheck(b->scene->has_sample, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no block `sample`, which says what states to build from", scene_path);
  if (LamWallsRelax(&b->scene->micro) && LamIsFirst(PETSC_COMM_WORLD))
    LamReportNote(&b->reporter,
                  "%s: rve.wall.relaxation: a table is of the walls at once, from which `lamella process` approximates "
                  "those that relax",
                  scene_path);
  b->scene->micro.relaxation.terms = 0;
  PetscCall(LamRefuseHistory(scene_path, &b->scene->micro, "a table", ""));
  PetscCall(LamChooseMesh(b->scene, &trial));
  LamWarnOfMesh(PETSC_COMM_WORLD, &b->reporter, b->scene, &trial);
  if (LamIsFirst(PETSC_COMM_WORLD)) LamWarnOfTurgor(&b->reporter, b->scene);
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &b->reporter, &b->scene->micro, b->scene->accuracy));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildTable(LamBuild *b)
{
  PetscFunctionBeginUser;
  b->start = LamClock();
  PetscCall(CreateTeams(b));
  PetscCall(RunAll(b));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildDestroy(LamBuild *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(b->pending.keys));
  PetscCall(PetscFree(b->pending.responses));
  PetscCall(LamRoundsDestroy(&b->rounds));
  PetscCall(LamGridDestroy(&b->grid));
  PetscCallMPI(MPI_Comm_free(&b->team));
  if (b->leaders != MPI_COMM_NULL) PetscCallMPI(MPI_Comm_free(&b->leaders));
  PetscCall(LamSceneDestroy(&b->scene));
  PetscFunctionReturn(0);
}
