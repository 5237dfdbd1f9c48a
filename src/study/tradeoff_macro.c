/*
  One run of a setting by the macroscale problem of the scene: as `lamella fe2`, without its files.
*/
#include "tradeoff.h"
#include <math.h>

/* A LamMacroMonitor: stores the last step. */
static PetscErrorCode KeepStep(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  LamMacroOutcome *outcome = ctx;

  PetscFunctionBeginUser;
  (void)macro;
  outcome->boundaries = step->boundary_count;
  outcome->work = step->work;
  PetscCall(PetscArraycpy(outcome->reaction[0], step->reaction[0], 2 * step->boundary_count));
  *stop = LamStopRequested();
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroCreate(run->comm, &run->macro));
  PetscCall(LamMacroSetScene(run->macro, run->scene));
  PetscCall(LamMacroSetUp(run->macro));
  PetscCall(LamFE2PrepareResponse(run));
  PetscCall(LamFE2Connect(run));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamFE2Run *run, LamMeasurement *m)
{
  char message[LAM_MESSAGE_LENGTH] = "";
  LamMacroReason reason = LAM_MACRO_STOPPED;

  PetscFunctionBeginUser;
  PetscCall(LamMacroSetMonitor(run->macro, KeepStep, &m->outcome));
  if (!run->stopped) PetscCall(LamMacroSolve(run->macro, &reason, message));
  if (reason == LAM_MACRO_STOPPED)
    PetscCall(PetscStrncpy(m->reason, "stopped: the time was over", sizeof(m->reason)));
  else if (reason == LAM_MACRO_NOT_CONVERGED)
    PetscCall(PetscSNPrintf(m->reason, sizeof(m->reason), "%.180s", message));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasureMacro(const LamScene *scene, const char table[], LamMeasurement *m)
{
  LamStopwatch start = LamStopwatchRead();
  LamScene own = *scene;
  LamFE2Run run = {.scene_path = scene->path,
                   .scene = &own,
                   .comm = PETSC_COMM_WORLD,
                   .response = m->setting.response,
                   .database_path = m->setting.response == LAM_FE2_DATABASE ? table : NULL};

  PetscFunctionBeginUser;
  own.micro = m->setting.micro;
  if (m->setting.accuracy > 0) own.response.accuracy = m->setting.accuracy;
  m->reason[0] = '\0';
  PetscCall(Prepare(&run));
  PetscCall(Solve(&run, m));
  start.cpu -= m->build_cpu;
  start.wall -= m->build_wall;
  if (!m->reason[0]) LamMeasurementAddRun(m, start, NAN);
  PetscCall(LamMacroDestroy(&run.macro));
  PetscCall(LamFE2Disconnect(&run));
  PetscFunctionReturn(0);
}
