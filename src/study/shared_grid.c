/*
  The grid of a new database on all ranks: rank 0 builds it, the others read the text that it would write to the file.
*/
#include "shared_grid.h"
#include "study.h"
#include <string.h>

/* Message from rank 0. */
typedef struct {
  PetscMPIInt code, stopped, length, n; /* error code of rank 0; ...; bytes of the text; records */
  char *text;
  PetscInt64 *keys;
  LamResponse *records;
} Made;

static PetscErrorCode MadeCreate(Made *made)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(made->length, &made->text));
  PetscCall(PetscMalloc1(made->n, &made->keys));
  PetscCall(PetscMalloc1(made->n, &made->records));
  PetscFunctionReturn(0);
}

static PetscErrorCode MadeDestroy(Made *made)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(made->text));
  PetscCall(PetscFree(made->keys));
  PetscCall(PetscFree(made->records));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeOnRoot(const LamScene *scene, LamResponder solver, Made *made)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamGrid grid;
  PetscInt n;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(scene, solver, &grid));
  made->stopped = LamStopRequested();
  if (made->stopped) {
    PetscCall(LamGridDestroy(&grid));
    PetscFunctionReturn(0);
  }
  PetscCall(LamGridGetText(grid, &text));
  PetscCall(LamGridGetRecords(grid, &n, &keys, &records));
  PetscCall(PetscMPIIntCast((PetscInt)strlen(text) + 1, &made->length));
  PetscCall(PetscMPIIntCast(n, &made->n));
  PetscCall(MadeCreate(made));
  PetscCall(PetscArraycpy(made->text, text, made->length));
  PetscCall(PetscArraycpy(made->keys, keys, n));
  PetscCall(PetscArraycpy(made->records, records, n));
  PetscCall(PetscFree(text));
  PetscCall(LamGridDestroy(&grid));
  PetscFunctionReturn(0);
}

/* Raises an error of rank 0, which has already reported it, on all ranks. */
static PetscErrorCode Share(MPI_Comm comm, PetscMPIInt rank, Made *made)
{
  PetscMPIInt head[4] = {made->code, made->stopped, made->length, made->n}, bytes;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(head, 4, MPI_INT, 0, comm));
  made->code = head[0];
  if (made->code) PetscFunctionReturn((PetscErrorCode)made->code);
  made->stopped = head[1];
  if (made->stopped) PetscFunctionReturn(0);
  made->length = head[2];
  made->n = head[3];
  if (rank) PetscCall(MadeCreate(made));
  PetscCall(PetscMPIIntCast((PetscInt)((size_t)made->n * sizeof(*made->records)), &bytes));
  PetscCallMPI(MPI_Bcast(made->text, made->length, MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(made->keys, made->n, MPIU_INT64, 0, comm));
  PetscCallMPI(MPI_Bcast(made->records, bytes, MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSharedGridMake(MPI_Comm comm, const LamScene *scene, LamResponder solver, LamDatabase database,
                                 char **text, PetscBool *complete)
{
  PetscMPIInt rank;
  LamGrid grid;
  Made made = {0};

  PetscFunctionBeginUser;
  *text = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) made.code = (PetscMPIInt)MakeOnRoot(scene, solver, &made);
  PetscCall(Share(comm, rank, &made));
  *complete = (PetscBool)!made.stopped;
  if (!*complete) PetscFunctionReturn(0);
  PetscCall(LamGridFromText(scene->path, &scene->micro, made.text, &grid));
  PetscCall(LamDatabaseSetGrid(database, &grid));
  PetscCall(LamDatabaseAdd(database, made.n, made.keys, made.records));
  if (!rank) PetscCall(PetscStrallocpy(made.text, text));
  PetscCall(MadeDestroy(&made));
  PetscFunctionReturn(0);
}
