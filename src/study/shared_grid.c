/*
  The grid of a new database on all ranks: rank 0 builds it, the others read the text that it would write to the file.
*/
#include "shared_grid.h"
#include "study.h"
#include <string.h>

/* On rank 0. *text stays NULL if a stop was requested. The keys and records are borrowed from the grid. */
static PetscErrorCode Make(const LamScene *scene, LamResponder solver, LamGrid *grid, char **text, PetscInt *n,
                           const PetscInt64 **keys, const LamResponse **records)
{
  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(scene, solver, grid));
  if (LamStopRequested()) PetscFunctionReturn(0);
  PetscCall(LamGridGetText(*grid, text));
  PetscCall(LamGridGetRecords(*grid, n, keys, records));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSharedGridMake(MPI_Comm comm, const LamScene *scene, LamResponder solver, LamDatabase database,
                                 char **text, PetscBool *complete)
{
  const PetscBool root = LamIsFirst(comm);
  size_t length, key_bytes, record_bytes;
  LamResponse *records = NULL;
  PetscInt64 *keys = NULL;
  LamGrid made = NULL, grid;
  PetscInt n = 0;
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  *text = NULL;
  if (root) ierr = Make(scene, solver, &made, text, &n, (const PetscInt64 **)&keys, (const LamResponse **)&records);
  length = *text ? strlen(*text) + 1 : 0;
  key_bytes = (size_t)n * sizeof(*keys);
  record_bytes = (size_t)n * sizeof(*records);
  PetscCall(LamShareBytes(comm, ierr, &length, text));
  PetscCall(LamShareBytes(comm, 0, &key_bytes, &keys));
  PetscCall(LamShareBytes(comm, 0, &record_bytes, &records));
  *complete = (PetscBool)(length > 0);
  if (*complete) {
    PetscCall(LamGridFromText(scene->path, &scene->micro, *text, &grid));
    PetscCall(LamDatabaseSetGrid(database, &grid));
    PetscCall(LamDatabaseAdd(database, (PetscInt)(key_bytes / sizeof(*keys)), keys, records));
  }
  PetscCall(LamGridDestroy(&made));
  if (root) PetscFunctionReturn(0);
  PetscCall(PetscFree(*text));
  PetscCall(PetscFree(keys));
  PetscCall(PetscFree(records));
  PetscFunctionReturn(0);
}
