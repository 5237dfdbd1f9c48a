/*
  The files of a macroscale run, on rank 0: its results, and the database to which a cache adds what it solves.
*/
#include "fe2_run.h"

static PetscErrorCode OpenDatabaseFile(LamFE2Tissue *tissue)
{
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterOpen(tissue->database_path, "database", LAM_WRITE_APPEND, &tissue->scene, &tissue->records));
  if (tissue->grid_text) PetscCall(LamRecordWriterText(tissue->records, LAM_GRID_NAME, tissue->grid_text));
  PetscCall(LamRecordWriterGetKeys(tissue->records, &n, &keys));
  tissue->next_key = LAM_CACHE_KEY;
  for (PetscInt k = 0; k < n; k++) tissue->next_key = PetscMax(tissue->next_key, keys[k] + 1);
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenFiles(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  if (run->out_path) PetscCall(LamFE2FileOpen(run->out_path, run->scene, &run->out));
  if (run->response != LAM_FE2_CACHE || !run->database_path) PetscFunctionReturn(0);
  for (PetscInt t = 0; t < run->tissues.count; t++) PetscCall(OpenDatabaseFile(&run->tissues.tissues[t]));
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
static PetscErrorCode RecordTissue(LamFE2Tissue *tissue)
{
  const LamResponse *records;
  const PetscInt64 *in_memory;
  PetscErrorCode ierr;
  PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  if (!tissue->records) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetAdded(tissue->database, tissue->recorded, &n, &records));
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetRecords(tissue->database, NULL, NULL, &in_memory));
  PetscCall(PetscMalloc1(n, &keys));
  for (PetscInt k = 0; k < n; k++) {
    keys[k] = in_memory[tissue->recorded + k];
    if (!LamKeyIsNode(keys[k])) keys[k] = tissue->next_key++;
  }
  ierr = LamRecordWriterCommit(tissue->records, n, keys, records);
  PetscCall(PetscFree(keys));
  PetscCall(ierr);
  tissue->recorded += n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2RecordStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < run->tissues.count; t++) PetscCall(RecordTissue(&run->tissues.tissues[t]));
  if (run->out) PetscCall(LamFE2FileAddStep(run->out, step, fields));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CloseFiles(LamFE2Run *run, const char status[])
{
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < run->tissues.count; t++) {
    LamFE2Tissue *tissue = &run->tissues.tissues[t];

    closed = RecordTissue(tissue); /* of a step that did not converge */
    if (!ierr) ierr = closed;
    if (tissue->records) closed = LamRecordWriterClose(&tissue->records);
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
