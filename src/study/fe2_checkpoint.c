/*
  OUT.h5.ckpt: the checkpoint from which a killed or stopped macroscale run resumes.

  Method. The file is rewritten after every complete step, when results and database have the step, and is renamed to
  its final name when it is on the disk. So a kill leaves a checkpoint of the last complete step of the results, or,
  between their writing and its renaming, of the one before. The database may have grown since: the checkpoint lists the
  records that the run had used, in their order. Other records are treated as not solved; when one would be solved, it
  is read from the file.
*/
#include "fe2_run.h"
#include <stdio.h>
#include <string.h>
#include "clock.h"
#include <unistd.h>

static PetscErrorCode CheckpointPath(const LamFE2Run *run, char path[PETSC_MAX_PATH_LEN])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s.ckpt", run->out_path));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointCheckTarget(const LamFE2Run *run)
{
  static const LamTextKind checkpoint = {.what = "a checkpoint", .ending = "", .begins = "\x89HDF*"};
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(CheckpointPath(run, path));
  PetscCall(LamTargetCheckText(path, &checkpoint, run->overwrite, run->scene));
  PetscFunctionReturn(0);
}

/* ---- identity of the run ---- */

/* A text of rank 0; reading: *text is that of the file, which the caller frees. */
static PetscErrorCode ArchiveText(LamFE2Run *run, LamArchive archive, const char name[], char **text)
{
  PetscInt length = LamIsFirst(run->comm) ? (PetscInt)strlen(*text) + 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(LamArchiveList(archive, name, 1, &length, (void **)text));
  PetscFunctionReturn(0);
}

/* Writes scene, contents of its files and type of response, or reads them and raises an error if they differ from this
   run's. */
static PetscErrorCode ArchiveIdentity(LamFE2Run *run, LamArchive archive, const char path[])
{
  const PetscBool reading = LamArchiveIsReading(archive);
  char *text = run->scene->text, *files, *now;
  PetscErrorCode ierr = 0;
  int response = run->response;

  PetscFunctionBeginUser;
  PetscCall(LamSceneDescribeFiles(run->scene, &now));
  files = now;
  PetscCall(ArchiveText(run, archive, "scene", &text));
  PetscCall(ArchiveText(run, archive, "scene files", &files));
  PetscCall(LamArchiveShared(archive, "response", sizeof(response), &response));
  PetscCall(PetscFree(now));
  if (!reading) PetscFunctionReturn(0);
  if (LamIsFirst(run->comm)) {
    ierr = LamCheckSameScene(path, text, files, run->scene);
    PetscCall(PetscFree(text));
    PetscCall(PetscFree(files));
  }
  PetscCall(LamShareError(run->comm, ierr));
  PetscCheck(response == (int)run->response, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: goes on with --response %s; this run has %s", path, LamFE2ResponseNames[response],
             LamFE2ResponseNames[run->response]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointRows(LamFE2Run *run, LamArchive archive, LamFE2Tissue *tissue)
{
  char name[2 * LAM_NAME_LENGTH];
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "records known first %s", tissue->name));
  PetscCall(LamArchiveShared(archive, name, sizeof(tissue->known.first), &tissue->known.first));
  PetscCall(PetscSNPrintf(name, sizeof(name), "records known %s", tissue->name));
  PetscCall(LamArchiveList(archive, name, sizeof(PetscInt), &tissue->row_count, (void **)&tissue->rows));
  if (!LamArchiveIsReading(archive)) PetscFunctionReturn(0);
  PetscCall(PetscMPIIntCast(tissue->row_count, &count));
  PetscCallMPI(MPI_Bcast(&count, 1, MPI_INT, 0, run->comm));
  if (!LamIsFirst(run->comm)) PetscCall(PetscMalloc1(count, &tissue->rows));
  tissue->row_count = tissue->row_capacity = count;
  PetscCallMPI(MPI_Bcast(tissue->rows, count, MPIU_INT, 0, run->comm));
  PetscFunctionReturn(0);
}

/* ---- finding ---- */

/* Rank 0: whether the results are complete. An error if they are of another scene. */
static PetscErrorCode IsFinished(const LamFE2Run *run, PetscBool *finished)
{
  PetscBool has_status;
  char *status = NULL;

  PetscFunctionBeginUser;
  *finished = PETSC_FALSE;
  if (access(run->out_path, F_OK)) PetscFunctionReturn(0);
  PetscCall(LamFileReadText(run->out_path, "/macro/status", &has_status, &status));
  *finished = (PetscBool)(has_status && !strcmp(status, "done"));
  PetscCall(PetscFree(status));
  if (!*finished) PetscFunctionReturn(0);
  PetscCall(LamCheckSameSceneFile(run->out_path, run->scene));
  LamReportNote(&run->reporter, "%s: has all steps; there is nothing left to do", run->out_path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointFind(LamFE2Run *run, PetscBool *finished)
{
  char path[PETSC_MAX_PATH_LEN];
  PetscErrorCode ierr = 0;
  int exists;

  PetscFunctionBeginUser;
  PetscCall(CheckpointPath(run, path));
  exists = !access(path, F_OK);
  PetscCallMPI(MPI_Bcast(&exists, 1, MPI_INT, 0, run->comm));
  if (!exists) {
    if (LamIsFirst(run->comm)) ierr = IsFinished(run, finished);
    PetscCall(LamShareError(run->comm, ierr));
    PetscCallMPI(MPI_Bcast(finished, 1, MPIU_BOOL, 0, run->comm));
    PetscFunctionReturn(0);
  }
  PetscCall(LamArchiveOpen(run->comm, path, &run->archive));
  PetscCall(ArchiveIdentity(run, run->archive, path));
  PetscCall(LamArchiveShared(run->archive, "totals", sizeof(run->totals), &run->totals));
  run->resumed_steps = run->totals.steps;
  run->resumed = (PetscBool)(run->resumed_steps > 0);
  PetscFunctionReturn(0);
}

/* ---- saving, resuming ---- */

/* The data that exist once a step is complete. */
static PetscErrorCode ArchiveSteps(LamFE2Run *run, LamArchive archive)
{
  PetscFunctionBeginUser;
  if (!run->totals.steps) PetscFunctionReturn(0);
  PetscCall(LamFE2FileArchive(run->out, archive));
  PetscCall(LamSummaryArchive(&run->summary, archive));
  PetscCall(LamMacroArchive(run->macro, archive));
  PetscFunctionReturn(0);
}

static PetscErrorCode Write(LamFE2Run *run, LamArchive archive)
{
  PetscFunctionBeginUser;
  PetscCall(ArchiveIdentity(run, archive, NULL));
  for (PetscInt t = 0; t < run->tissues.count && run->response != LAM_FE2_DIRECT; t++)
    if (!LamFE2HoldsModels(run, &run->tissues.tissues[t]))
      PetscCall(LamFE2CheckpointRows(run, archive, &run->tissues.tissues[t]));
  PetscCall(LamArchiveShared(archive, "totals", sizeof(run->totals), &run->totals));
  PetscCall(ArchiveSteps(run, archive));
  PetscFunctionReturn(0);
}

/* A cache without a file does not keep its records, so a run with it cannot be resumed; states and models of points are
   in the checkpoint. */
static PetscBool CanGoOn(const LamFE2Run *run)
{
  return (PetscBool)(run->response == LAM_FE2_DIRECT || run->database_path || LamFE2AllHoldModels(run));
}

PetscErrorCode LamFE2CheckpointSave(LamFE2Run *run)
{
  const PetscReal start = LamClock();
  char path[PETSC_MAX_PATH_LEN];
  PetscErrorCode ierr;
  LamArchive archive;

  PetscFunctionBeginUser;
  if (!run->out_path || !CanGoOn(run)) PetscFunctionReturn(0);
  PetscCall(CheckpointPath(run, path));
  PetscCall(LamArchiveCreate(run->comm, path, &archive));
  ierr = Write(run, archive);
  PetscCall(LamArchiveClose(&archive, (PetscBool)!ierr));
  PetscCall(ierr);
  run->save_seconds += LamClock() - start;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointStart(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  if (!run->archive && !CanGoOn(run)) PetscCall(LamFE2CheckpointRemove(run)); /* of an earlier run */
  if (!run->archive) {
    PetscCall(LamFE2CheckpointSave(run));
    PetscFunctionReturn(0);
  }
  PetscCall(ArchiveSteps(run, run->archive));
  PetscCall(LamArchiveClose(&run->archive, PETSC_FALSE));
  if (LamIsFirst(run->comm))
    LamReportNote(&run->reporter, "%s: goes on behind %" PetscInt_FMT " complete steps", run->out_path,
                  run->resumed_steps);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointRemove(LamFE2Run *run)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!run->out_path || !LamIsFirst(run->comm)) PetscFunctionReturn(0);
  PetscCall(CheckpointPath(run, path));
  unlink(path);
  PetscFunctionReturn(0);
}
