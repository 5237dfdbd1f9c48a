/*
  Opening the file of a build and its grid. Rank 0; the others help to solve the records of free cells.
*/
#include "build_run.h"
#include "spread.h"
#include <unistd.h>

/* *exists: the file is there; its records are `known`. */
static PetscErrorCode OpenWriter(LamBuild *b, PetscBool *exists, LamKnownRecords *known)
{
  LamResponse *records;
  LamDatabase file;
  PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  *exists = (PetscBool)!access(b->path, F_OK);
  PetscCheck(b->resume || !*exists, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give --resume to go on with it, or remove it", b->path);
  PetscCall(LamRecordWriterOpen(b->path, "database", LAM_WRITE_APPEND, b->scene, &b->writer));
  if (!*exists) PetscFunctionReturn(0);
  PetscCall(LamDatabaseOpenFirst(b->path, 0, &file, &n, &keys, &records));
  PetscCall(LamDatabaseClose(&file));
  PetscCall(LamKnownRecordsSet(known, 0, n, keys, records));
  PetscFunctionReturn(0);
}

/* Commits the grid's free-cell records that are not in `known`, the records of the file. */
static PetscErrorCode CommitFreeCells(LamBuild *b, const LamKnownRecords *known, LamGrid grid)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamGridGetRecords(grid, &n, &keys, &records));
  for (PetscInt i = 0; i < n; i++)
    if (!LamKnownRecordsGet(known, keys[i], NULL)) PetscCall(LamBuildTake(b, keys[i], &records[i]));
  PetscCall(LamRecordWriterCommit(b->writer, b->pending.n, b->pending.keys,
                                  b->pending.responses)); /* 0 records: only gives a new file its name */
  b->added = b->pending.n;
  b->pending.n = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode NewGrid(LamBuild *b, const LamKnownRecords *none, LamResponder solver, LamGrid *grid)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(b->scene, solver, grid));
  PetscCall(LamGridGetText(*grid, &text));
  PetscCall(LamRecordWriterText(b->writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscCall(CommitFreeCells(b, none, *grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode OldGrid(LamBuild *b, const LamKnownRecords *known, LamResponder solver, LamGrid *grid)
{
  const PetscInt64 *keys;
  PetscBool found, lost = PETSC_FALSE;
  PetscInt n;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(b->path, LAM_GRID_NAME, &found, &text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has no grid (%s): its records are of an older lamella, or of no build; give the new database another "
             "name",
             b->path, LAM_GRID_NAME);
  PetscCall(LamGridFromText(b->path, &b->scene->micro, text, grid));
  PetscCall(PetscFree(text));
  PetscCall(LamGridGetFreeKeys(*grid, &n, &keys));
  for (PetscInt i = 0; i < n; i++)
    if (!LamKnownRecordsGet(known, keys[i], NULL)) lost = PETSC_TRUE; /* from a damaged file */
  if (!lost) PetscFunctionReturn(0);
  PetscCall(LamGridSolveRecords(*grid, &b->scene->micro, solver));
  PetscCall(CommitFreeCells(b, known, *grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(LamBuild *b, LamResponder solver)
{
  LamKnownRecords known = {0};
  PetscBool exists;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(OpenWriter(b, &exists, &known));
  PetscCall(exists ? OldGrid(b, &known, solver, &grid) : NewGrid(b, &known, solver, &grid));
  PetscCall(LamRoundsCreate(b->scene, &b->shard, &known, &grid, &b->rounds));
  b->there = b->rounds.nodes - b->added;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildStart(LamBuild *b)
{
  LamResponder solver, spread;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamRVEResponderCreate(b->rve, 0, &solver));
  if (b->rank) {
    ierr = LamSpreadServe(b->leaders, solver);
  } else {
    PetscCall(LamSpreadCreate(b->leaders, solver, &spread));
    ierr = Open(b, spread);
    PetscCall(LamResponderDestroy(&spread));
  }
  PetscCall(LamResponderDestroy(&solver));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
