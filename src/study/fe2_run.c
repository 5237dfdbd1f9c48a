/*
  Lifecycle of an FE2 run.
*/
#include "fe2_run.h"
#include "clock.h"
#include "turgor_stretch.h"

PetscErrorCode LamFE2Prepare(LamFE2Run *run, PetscBool *finished)
{
  PetscFunctionBeginUser;
  *finished = PETSC_FALSE;
  run->start = LamClock();
  if (!run->scene) PetscCall(LamSceneRead(run->scene_path, &run->scene));
  PetscCall(LamFE2CheckTargets(run, PETSC_TRUE));
  PetscCheck(run->response == LAM_FE2_DIRECT || !LamWallsTear(&run->scene->micro), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT,
             "%s: strength.wall_fracture_energy: models of material points do not know cells that burst; choose "
             "--response direct, or leave it out",
             run->scene->path);
  PetscCheck(!LamWallsRelax(&run->scene->micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.relaxation: the steps of `lamella fe2` take no time, on which walls with memory depend; "
             "choose `lamella process`",
             run->scene->path);
  if (LamIsFirst(run->comm)) LamWarnOfTurgor(&run->reporter, run->scene);
  PetscCall(LamMacroCreate(run->comm, &run->macro));
  PetscCall(LamMacroSetScene(run->macro, run->scene));
  PetscCall(LamMacroSetUp(run->macro));
  if (run->resume) PetscCall(LamFE2CheckpointFind(run, finished));
  if (!*finished) PetscCall(LamFE2PrepareResponse(run));
  PetscCall(LamSummaryCreate(run->scene, &run->summary));
  PetscFunctionReturn(0);
}

/* Rank 0: writes and reports the step. */
static PetscErrorCode Report(LamFE2Run *run, const LamMacroStep *step, const LamMacroFields *fields,
                             PetscReal peak_memory, PetscInt64 done, PetscInt64 total)
{
  PetscFunctionBeginUser;
  PetscCall(LamFE2RecordStep(run, step, fields));
  if (run->step) PetscCall(run->step(run->step_ctx, run, step, peak_memory));
  PetscCall(LamReportProgress(&run->reporter, done, total, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2EndStep(LamFE2Run *run, const LamMacroStep *step, PetscInt64 done, PetscInt64 total)
{
  LamFE2Totals *totals = &run->totals;
  LamMacroFields fields = {0};
  PetscErrorCode ierr = 0;
  PetscReal peak_memory;

  PetscFunctionBeginUser;
  PetscCall(LamPeakMemory(run->comm, &peak_memory));
  if (run->out_path || run->all_fields) PetscCall(LamMacroGetFields(run->macro, &fields));
  if (LamIsFirst(run->comm)) ierr = Report(run, step, &fields, peak_memory, done, total);
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCall(LamShareError(run->comm, ierr));
  LamFE2NoteForce(totals, &run->scene->macro, step);
  run->broken = step->broken_fraction;
  totals->steps++;
  totals->newton_iterations += step->newton_iterations;
  totals->queries += step->queries;
  totals->hits += step->hits;
  totals->solves += step->solves;
  totals->failures += step->failures;
  PetscFunctionReturn(0);
}

/* LamMacroMonitor */
static PetscErrorCode StepDone(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  LamFE2Run *run = (LamFE2Run *)ctx;
  const LamMacroSpec *spec = &run->scene->macro;

  PetscFunctionBeginUser;
  PetscCall(LamFE2EndStep(run, step, run->totals.steps + 1, spec->steps + (spec->inflate ? 1 : 0)));
  *stop = LamStopRequested(); /* on any rank: a signal may reach only one */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 1, MPIU_BOOL, MPI_LOR, run->comm));
  if (step->complete) PetscCall(LamFE2CheckpointSave(run));
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

static PetscErrorCode Follow(LamFE2Run *run, LamFE2Follow follow, void *ctx)
{
  char status[LAM_MESSAGE_LENGTH + 32];
  PetscBool stopped = PETSC_FALSE;
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(LamFE2Connect(run));
  if (run->stopped) PetscFunctionReturn(0);
  if (run->certify != LAM_CERTIFY_NONE) PetscCall(LamFE2Certify(run));
  PetscCall(LamFE2OpenFiles(run));
  PetscCall(follow(ctx, &stopped, sizeof(status), status));
  if (!stopped) LamFE2WarnOfObstacles(run);
  if (!stopped) ierr = LamFE2Zoom(run);
  PetscCall(LamShareError(run->comm, ierr));
  if (LamIsFirst(run->comm)) ierr = LamFE2CloseFiles(run, stopped ? "stopped" : status);
  PetscCall(LamShareError(run->comm, ierr));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2FollowInFiles(LamFE2Run *run, LamFE2Follow follow, void *ctx)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = Follow(run, follow, ctx);
  if (ierr && LamIsFirst(run->comm)) { /* what records it can; further errors are ignored */
    PetscCall(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
    (void)LamFE2CloseFiles(run, NULL);
    PetscCall(PetscPopErrorHandler());
  }
  PetscFunctionReturn(ierr);
}

/* LamFE2Follow */
static PetscErrorCode SolveSteps(void *ctx, PetscBool *stopped, size_t size, char status[])
{
  LamFE2Run *run = (LamFE2Run *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamFE2CheckpointStart(run));
  LamActivitySet("load steps");
  if (LamIsFirst(run->comm))
    PetscCall(LamReportProgress(&run->reporter, run->totals.steps,
                                run->scene->macro.steps + (run->scene->macro.inflate ? 1 : 0), 0));
  PetscCall(LamMacroSetMonitor(run->macro, StepDone, run));
  PetscCall(LamMacroSetCutback(run->macro, CutBack, run));
  PetscCall(LamMacroSolve(run->macro, &run->reason, run->message));
  *stopped = (PetscBool)(run->reason == LAM_MACRO_STOPPED);
  if (run->reason == LAM_MACRO_NOT_CONVERGED) PetscCall(LamFE2ExplainTear(run));
  if (run->reason == LAM_MACRO_DONE)
    PetscCall(PetscStrncpy(status, "done", size));
  else
    PetscCall(PetscSNPrintf(status, size, "not converged: %s", run->message));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Solve(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  run->reason = LAM_MACRO_STOPPED;
  PetscCall(LamFE2FollowInFiles(run, SolveSteps, run));
  if (run->reason == LAM_MACRO_DONE) PetscCall(LamFE2CheckpointRemove(run));
  PetscFunctionReturn(0);
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
