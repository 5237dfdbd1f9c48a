/*
  The files of a macroscale run, on rank 0: its results, and the database to which a cache adds what it solves.
*/
#include "fe2_run.h"

static PetscErrorCode OpenFiles(LamFE2Run *run)
{
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  if (run->out_path) PetscCall(LamFE2FileOpen(run->out_path, run->scene, &run->out));
  if (run->response != LAM_FE2_CACHE || !run->database_path) PetscFunctionReturn(0);
  PetscCall(LamRecordWriterOpen(run->database_path, "database", LAM_WRITE_APPEND, run->scene, &run->records));
  if (run->grid_text) PetscCall(LamRecordWriterText(run->records, LAM_GRID_NAME, run->grid_text));
  PetscCall(LamRecordWriterGetKeys(run->records, &n, &keys));
  run->next_key = LAM_CACHE_KEY;
  for (PetscInt k = 0; k < n; k++) run->next_key = PetscMax(run->next_key, keys[k] + 1);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2OpenFiles(LamFE2Run *run)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(run->comm)); /* all ranks have read the database: rank 0 may write to it */
  if (LamAppIsRoot()) ierr = OpenFiles(run);
  PetscCall(LamFE2ShareError(run->comm, ierr));
  PetscFunctionReturn(0);
}

/* Appends what the cache has solved since the last step, so that a later run finds it. */
static PetscErrorCode RecordSolved(LamFE2Run *run)
{
  const LamResponse *records;
  const PetscInt64 *in_memory;
  PetscErrorCode ierr;
  PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetAdded(run->database, run->recorded, &n, &records));
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetRecords(run->database, NULL, NULL, &in_memory));
  PetscCall(PetscMalloc1(n, &keys));
  for (PetscInt k = 0; k < n; k++) {
    keys[k] = in_memory[run->recorded + k];
    if (!LamKeyIsNode(keys[k])) keys[k] = run->next_key++;
  }
  ierr = LamRecordWriterCommit(run->records, n, keys, records);
  PetscCall(PetscFree(keys));
  PetscCall(ierr);
  run->recorded += n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2RecordStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  if (run->records) PetscCall(RecordSolved(run));
  if (run->out) PetscCall(LamFE2FileAddStep(run->out, step, fields));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CloseFiles(LamFE2Run *run, const char status[])
{
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  if (run->records) {
    ierr = RecordSolved(run); /* of a step that did not converge */
    closed = LamRecordWriterClose(&run->records);
    if (!ierr) ierr = closed;
  }
  closed = LamFE2FileClose(&run->out, status);
  if (!ierr) ierr = closed;
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CloseAfterError(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  if (!LamAppIsRoot()) PetscFunctionReturn(0);
  PetscCall(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  (void)LamFE2CloseFiles(run, NULL);
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(0);
}
