/*
  The files of a macroscale run, on rank 0: its results, and the database files to which caches add records.
*/
#include "fe2_run.h"
#include "xdmf.h"

/* Selects those of n new records of the database that its file lacks, with their keys there; *count of them. */
static PetscErrorCode ChooseNew(LamFE2Tissue *tissue, PetscInt n, const PetscInt64 in_memory[],
                                const LamResponse records[], PetscInt *count, PetscInt64 keys[], LamResponse chosen[])
{
  const PetscInt64 *in_file;
  PetscInt row;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterGetKeys(tissue->records, &row, &in_file));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt known = LamKnownRecordsFind(&tissue->known, in_memory[k], &records[k].load);
    PetscCall(LamListGrow(tissue->row_count, sizeof(PetscInt), &tissue->row_capacity, &tissue->rows));
    tissue->rows[tissue->row_count++] = known >= 0 ? known : row++;
    if (known >= 0) continue;
    keys[*count] = LamKeyIsNode(in_memory[k]) ? in_memory[k] : tissue->next_key++;
    chosen[(*count)++] = records[k];
  }
  PetscFunctionReturn(0);
}

/* Appends the records that the cache has solved since the last call, for later runs. */
PetscErrorCode LamFE2RecordTissue(LamFE2Tissue *tissue)
{
  const LamResponse *records;
  const PetscInt64 *in_memory;
  LamResponse *chosen;
  PetscErrorCode ierr;
  PetscInt64 *keys;
  PetscInt n, count = 0;

  PetscFunctionBeginUser;
  if (!tissue->records) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetAdded(tissue->database, tissue->recorded, &n, &records));
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetRecords(tissue->database, NULL, NULL, &in_memory));
  PetscCall(PetscMalloc2(n, &keys, n, &chosen));
  PetscCall(ChooseNew(tissue, n, in_memory + tissue->recorded, records, &count, keys, chosen));
  ierr = LamRecordWriterCommit(tissue->records, count, keys, chosen);
  PetscCall(PetscFree2(keys, chosen));
  PetscCall(ierr);
  tissue->recorded += n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2OpenTissueFile(LamFE2Tissue *tissue)
{
  const PetscInt64 *keys;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterOpen(tissue->database_path, "database", LAM_WRITE_APPEND, &tissue->scene, &tissue->records));
  if (tissue->grid_text) PetscCall(LamRecordWriterText(tissue->records, LAM_GRID_NAME, tissue->grid_text));
  PetscCall(LamRecordWriterGetKeys(tissue->records, &n, &keys));
  tissue->next_key = LAM_CACHE_KEY;
  for (PetscInt k = 0; k < n; k++) tissue->next_key = PetscMax(tissue->next_key, keys[k] + 1);
  PetscCall(LamFE2RecordTissue(tissue)); /* records of the free cells of a new grid */
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CloseTissueFile(LamFE2Tissue *tissue)
{
  PetscErrorCode ierr, closed;

  PetscFunctionBeginUser;
  ierr = LamFE2RecordTissue(tissue); /* also those of a step that did not converge */
  closed = LamRecordWriterClose(&tissue->records);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckTargets(const LamFE2Run *run, PetscBool checkpoint)
{
  PetscFunctionBeginUser;
  if (!run->out_path) PetscFunctionReturn(0);
  PetscCall(LamTargetCheck(run->out_path, "fe2", run->overwrite, run->scene));
  PetscCall(LamTargetCheckText(run->out_path, &LamCurveTable, run->overwrite, run->scene));
  PetscCall(LamTargetCheckText(run->out_path, &LamXDMFText, run->overwrite, run->scene));
  if (checkpoint) PetscCall(LamFE2CheckpointCheckTarget(run));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckTargets(const LamFE2Run *run, PetscBool checkpoint)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (LamIsFirst(run->comm)) ierr = CheckTargets(run, checkpoint);
  PetscCall(LamShareError(run->comm, ierr));
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenFiles(LamFE2Run *run)
{
  const LamWriteMode mode = run->resumed ? LAM_WRITE_APPEND : LamTargetMode(run->overwrite);

  PetscFunctionBeginUser;
  if (run->out_path) PetscCall(LamFE2FileOpen(run->out_path, mode, run->scene, &run->out));
  if (run->response != LAM_FE2_CACHE || !run->database_path) PetscFunctionReturn(0);
  for (PetscInt t = 0; t < run->tissues.count; t++)
    if (run->tissues.tissues[t].database) PetscCall(LamFE2OpenTissueFile(&run->tissues.tissues[t]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2OpenFiles(LamFE2Run *run)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(run->comm)); /* all ranks have read the database: rank 0 may write to it */
  if (LamIsFirst(run->comm)) ierr = OpenFiles(run);
  PetscCall(LamShareError(run->comm, ierr));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2RecordStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  if (fields->point_count) PetscCall(LamSummaryAdd(&run->summary, step, fields));
  for (PetscInt t = 0; t < run->tissues.count; t++) PetscCall(LamFE2RecordTissue(&run->tissues.tissues[t]));
  if (run->out) PetscCall(LamFE2FileAddStep(run->out, step, fields, &run->summary));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CloseFiles(LamFE2Run *run, const char status[])
{
  PetscErrorCode ierr = 0, closed;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < run->tissues.count; t++) {
    closed = LamFE2CloseTissueFile(&run->tissues.tissues[t]);
    if (!ierr) ierr = closed;
  }
  closed = LamFE2FileClose(&run->out, status);
  PetscCall(ierr ? ierr : closed);
  PetscFunctionReturn(0);
}
