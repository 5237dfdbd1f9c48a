/*
  Opening the file of a build and its grid. Rank 0.
*/
#include "build_run.h"
#include <unistd.h>

static PetscErrorCode OpenWriter(LamBuild *b)
{
  const PetscBool exists = (PetscBool)!access(b->path, F_OK);

  PetscFunctionBeginUser;
  PetscCheck(b->resume || !exists, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give --resume to go on with it, or remove it", b->path);
  PetscCall(LamRecordWriterOpen(b->path, "database", LAM_WRITE_APPEND, b->scene, &b->writer));
  if (exists) PetscCall(LamDatabaseOpen(b->path, &b->file));
  PetscFunctionReturn(0);
}

/* Commits the grid's free-cell records that the file lacks. */
static PetscErrorCode CommitFreeCells(LamBuild *b, LamGrid grid)
{
  const LamResponse *records;
  const PetscInt64 *keys, *there;
  PetscInt n, n_there, missing = 0;

  PetscFunctionBeginUser;
  PetscCall(LamGridGetRecords(grid, &n, &keys, &records));
  PetscCall(LamRecordWriterGetKeys(b->writer, &n_there, &there));
  for (PetscInt i = 0; i < n; i++) {
    PetscInt k = 0;

    while (k < n_there && there[k] != keys[i]) k++;
    if (k < n_there) continue;
    PetscCall(LamBuildTake(b, keys[i], &records[i]));
    missing++;
  }
  PetscCall(LamRecordWriterCommit(b->writer, b->pending.n, b->pending.keys,
                                  b->pending.responses)); /* 0 records: only gives a new file its name */
  b->added = missing;
  b->pending.n = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode NewGrid(LamBuild *b, LamResponder solver, LamGrid *grid)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(b->scene, solver, grid));
  PetscCall(LamGridGetText(*grid, &text));
  PetscCall(LamRecordWriterText(b->writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscCall(CommitFreeCells(b, *grid));
  PetscFunctionReturn(0);
}

/* Number of free-cell records among the keys. */
static PetscInt CountFreeCells(PetscInt n, const PetscInt64 keys[])
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < n; i++) count += LamKeyIsFreeCell(keys[i]);
  return count;
}

static PetscErrorCode OldGrid(LamBuild *b, LamResponder solver, LamGrid *grid)
{
  const PetscInt64 *keys;
  PetscBool found;
  PetscInt n, wanted;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(b->path, LAM_GRID_NAME, &found, &text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no grid (%s): its records are of an older lamella, or of no build; give the new database another "
             "name",
             b->path, LAM_GRID_NAME);
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, grid));
  PetscCall(PetscFree(text));
  PetscCall(LamGridGetFreeKeys(*grid, &wanted, &keys));
  PetscCall(LamRecordWriterGetKeys(b->writer, &n, &keys));
  if (CountFreeCells(n, keys) >= wanted) PetscFunctionReturn(0);
  PetscCall(LamGridSolveRecords(*grid, &b->scene->micro, solver)); /* some were lost from a damaged file */
  PetscCall(CommitFreeCells(b, *grid));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildStart(LamBuild *b)
{
  LamResponder solver;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamRVEResponderCreate(b->rve, 0, &solver));
  PetscCall(OpenWriter(b));
  PetscCall(b->file ? OldGrid(b, solver, &grid) : NewGrid(b, solver, &grid));
  PetscCall(LamResponderDestroy(&solver));
  PetscCall(LamRoundsCreate(b->scene, &b->shard, b->file, &grid, &b->rounds));
  b->there = b->rounds.nodes - b->added;
  PetscFunctionReturn(0);
}
