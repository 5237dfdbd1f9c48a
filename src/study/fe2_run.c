/*
  Lifecycle of an FE2 run.
*/
#include "fe2_run.h"
#include "clock.h"

PetscErrorCode LamFE2Prepare(LamFE2Run *run, PetscBool *finished)
{
  PetscFunctionBeginUser;
  *finished = PETSC_FALSE;
  run->start = LamClock();
  if (!run->scene) PetscCall(LamSceneRead(run->scene_path, &run->scene));
  PetscCall(LamMacroCreate(run->comm, &run->macro));
  PetscCall(LamMacroSetScene(run->macro, run->scene));
  PetscCall(LamMacroSetUp(run->macro));
  if (run->resume) PetscCall(LamFE2CheckpointFind(run, finished));
  if (!*finished) PetscCall(LamFE2PrepareResponse(run));
  PetscCall(LamSummaryCreate(run->scene, &run->summary));
  PetscFunctionReturn(0);
}

/* Rank 0: writes and reports the step. */
static PetscErrorCode EndStep(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields,
                              PetscReal peak_memory)
{
  const PetscInt total = run->scene->macro.steps + (run->scene->macro.inflate ? 1 : 0);

  PetscFunctionBeginUser;
  if (fields->point_count) {
    PetscCall(LamSummaryAdd(&run->summary, step, fields));
    LamSummaryFind(&run->summary);
  }
  PetscCall(LamFE2RecordStep(run, step, fields));
  if (run->step) PetscCall(run->step(run->reporter.ctx, run, step, peak_memory));
  PetscCall(LamReportProgress(&run->reporter, run->totals.steps + 1, total, 0));
  PetscFunctionReturn(0);
}

static void Count(const LamMacroStep *step, LamFE2Totals *totals)
{
  totals->steps++;
  totals->newton_iterations += step->newton_iterations;
  totals->queries += step->queries;
  totals->hits += step->hits;
  totals->solves += step->solves;
  totals->failures += step->failures;
}

/* LamMacroMonitor */
static PetscErrorCode StepDone(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  LamFE2Run *run = (LamFE2Run *)ctx;
  LamMacroFields fields = {0};
  PetscErrorCode ierr = 0;
  PetscReal peak_memory;

  PetscFunctionBeginUser;
  PetscCall(LamPeakMemory(run->comm, &peak_memory));
  if (run->out_path || run->all_fields) PetscCall(LamMacroGetFields(macro, &fields));
  if (LamIsFirst(run->comm)) ierr = EndStep(run, step, &fields, peak_memory);
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCall(LamShareError(run->comm, ierr));
  Count(step, &run->totals);
  *stop = LamStopRequested(); /* on any rank: a signal may reach only one */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 1, MPIU_BOOL, MPI_LOR, run->comm));
  if (step->complete) PetscCall(LamFE2CheckpointSave(run, *stop));
  PetscFunctionReturn(0);
}

/* LamMacroCutback */
static PetscErrorCode CutBack(LamMacro macro, const char why[], void *ctx)
{
  const LamFE2Run *run = (const LamFE2Run *)ctx;

  PetscFunctionBeginUser;
  (void)macro;
  if (LamIsFirst(run->comm)) LamReportWarning(&run->reporter, "%s: cut back: %s", run->scene_path, why);
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAndClose(LamFE2Run *run, LamMacroReason *reason, char message[])
{
  char status[LAM_MESSAGE_LENGTH + 32] = "done";
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(LamMacroSetMonitor(run->macro, StepDone, run));
  PetscCall(LamMacroSetCutback(run->macro, CutBack, run));
  PetscCall(LamMacroSolve(run->macro, reason, message));
  if (*reason != LAM_MACRO_STOPPED) ierr = LamFE2Zoom(run);
  PetscCall(LamShareError(run->comm, ierr));
  if (*reason == LAM_MACRO_STOPPED) PetscCall(PetscStrncpy(status, "stopped", sizeof(status)));
  if (*reason == LAM_MACRO_NOT_CONVERGED)
    PetscCall(PetscSNPrintf(status, sizeof(status), "not converged: %s", message));
  if (LamIsFirst(run->comm)) ierr = LamFE2CloseFiles(run, status);
  PetscCall(LamShareError(run->comm, ierr));
  if (*reason == LAM_MACRO_DONE) PetscCall(LamFE2CheckpointRemove(run));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamFE2Run *run, LamMacroReason *reason, char message[])
{
  PetscFunctionBeginUser;
  *reason = LAM_MACRO_STOPPED;
  PetscCall(LamFE2Connect(run));
  if (run->stopped) PetscFunctionReturn(0);
  PetscCall(LamFE2OpenFiles(run));
  PetscCall(LamFE2CheckpointStart(run));
  PetscCall(SolveAndClose(run, reason, message));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Solve(LamFE2Run *run, LamMacroReason *reason, char message[])
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = Solve(run, reason, message);
  if (ierr) PetscCall(LamFE2CloseAfterError(run));
  PetscFunctionReturn(ierr);
}

PetscErrorCode LamFE2Destroy(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroDestroy(&run->macro));
  PetscCall(LamArchiveClose(&run->archive, PETSC_FALSE));
  PetscCall(LamFE2Disconnect(run));
  PetscCall(LamSummaryDestroy(&run->summary));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}
