/*
  OUT.h5.ckpt: the checkpoint from which a killed or stopped macroscale run resumes.

  Method. The file is rewritten after a complete step, when results and database have the step, and is renamed to its
  final name when it is on the disk. It is written after every step, or less often where that would take more than
  LARGEST_SHARE of the time. So a kill leaves a checkpoint of a complete step, and results with at least this step;
  later steps are overwritten. The database may have grown since: the checkpoint lists the records that the run had
  used, in their order. Other records are treated as not solved; when one would be solved, it is read from the file.
*/
#include "fe2_run.h"
#include <stdio.h>
#include <string.h>
#include "clock.h"
#include <unistd.h>

static const PetscReal LARGEST_SHARE = 0.02; /* of the run time spent on checkpoints */

static PetscErrorCode CheckpointPath(const LamFE2Run *run, char path[PETSC_MAX_PATH_LEN])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s.ckpt", run->out_path));
  PetscFunctionReturn(0);
}

/* ---- identity of the run ---- */

static size_t LineLength(const char text[])
{
  return strcspn(text, "\n");
}

/* PETSC_ERR_USER_INPUT, with the first line that differs, unless the texts are equal; `before` is the file's text. */
static PetscErrorCode CompareScenes(const char path[], const char before[], const char now[])
{
  int line = 1;

  PetscFunctionBeginUser;
  if (!strcmp(before, now)) PetscFunctionReturn(0);
  for (;; line++) {
    const size_t a = LineLength(before), b = LineLength(now);
    if (a != b || strncmp(before, now, a) || !before[a] || !now[b]) break;
    before += a + 1;
    now += b + 1;
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
          "%s: belongs to another scene; line %d was \"%.*s\" and is \"%.*s\"; restore it, or leave out --resume", path,
          line, (int)LineLength(before), before, (int)LineLength(now), now);
}

/* Writes scene and type of response, or reads them and raises an error if they differ from this run's. */
static PetscErrorCode ArchiveIdentity(LamFE2Run *run, LamArchive archive, const char path[])
{
  PetscInt length = LamIsFirst(run->comm) ? (PetscInt)strlen(run->scene->text) + 1 : 0;
  char *text = run->scene->text;
  PetscErrorCode ierr = 0;
  int response = run->response;

  PetscFunctionBeginUser;
  PetscCall(LamArchiveList(archive, "scene", 1, &length, (void **)&text));
  PetscCall(LamArchiveShared(archive, "response", sizeof(response), &response));
  if (!LamArchiveIsReading(archive)) PetscFunctionReturn(0);
  if (LamIsFirst(run->comm)) {
    ierr = CompareScenes(path, text, run->scene->text);
    PetscCall(PetscFree(text));
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
  PetscBool has_status, has_scene;
  char *status = NULL, *scene = NULL;

  PetscFunctionBeginUser;
  *finished = PETSC_FALSE;
  if (access(run->out_path, F_OK)) PetscFunctionReturn(0);
  PetscCall(LamFileReadText(run->out_path, "/macro/status", &has_status, &status));
  PetscCall(LamFileReadText(run->out_path, "/scene", &has_scene, &scene));
  if (has_status && has_scene && !strcmp(status, "done")) {
    PetscCall(CompareScenes(run->out_path, scene, run->scene->text));
    *finished = PETSC_TRUE;
    LamReportNote(&run->reporter, "%s: has all steps; there is nothing left to do", run->out_path);
  }
  PetscCall(PetscFree(status));
  PetscCall(PetscFree(scene));
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

static PetscErrorCode SaveNow(LamFE2Run *run)
{
  const PetscReal start = LamClock();
  char path[PETSC_MAX_PATH_LEN];
  PetscErrorCode ierr;
  LamArchive archive;

  PetscFunctionBeginUser;
  PetscCall(CheckpointPath(run, path));
  PetscCall(LamArchiveCreate(run->comm, path, &archive));
  ierr = Write(run, archive);
  PetscCall(LamArchiveClose(&archive, (PetscBool)!ierr));
  PetscCall(ierr);
  run->saved = LamClock();
  run->save_seconds = run->saved - start;
  run->all_save_seconds += run->save_seconds;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointSave(LamFE2Run *run, PetscBool ends)
{
  PetscBool due = (PetscBool)(ends || LARGEST_SHARE * (LamClock() - run->saved) >= run->save_seconds);

  PetscFunctionBeginUser;
  if (!run->out_path || !CanGoOn(run)) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(&due, 1, MPIU_BOOL, 0, run->comm));
  if (due) PetscCall(SaveNow(run));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CheckpointStart(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  if (!run->archive && !CanGoOn(run)) PetscCall(LamFE2CheckpointRemove(run)); /* of an earlier run */
  if (!run->archive) {
    PetscCall(LamFE2CheckpointSave(run, PETSC_TRUE));
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
