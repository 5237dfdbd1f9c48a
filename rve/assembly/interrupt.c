/*
  Interrupting a solve.

  Method. The interrupt callback is called before each factorisation. Once it returns true, all further factorisations
  of the solve are refused and iterations end, so every algorithm under way fails. The response then reports the
  interrupt instead of that failure, and no alternative is tried.
*/
#include "rve_impl.h"
#include <stdarg.h>

PetscErrorCode LamRVESetInterrupt(LamRVE rve, PetscBool (*interrupt)(void *ctx), void *ctx)
{
  PetscFunctionBeginUser;
  rve->interrupt = interrupt;
  rve->interrupt_ctx = ctx;
  if (rve->bonded) PetscCall(LamRVESetInterrupt(rve->bonded, interrupt, ctx));
  PetscFunctionReturn(0);
}

/* Whether the solve is stopped before a factorisation; counts the factorisation if it is not. */
static PetscBool IsStopped(LamRVE rve)
{
  LamWork *work = &rve->work;

  if (!work->stopped && rve->interrupt) work->stopped = rve->interrupt(rve->interrupt_ctx);
  if (!work->stopped) ++work->factorisations;
  return work->stopped;
}

/* Creates the factor of the system in use at its first factorisation; a large RVE has no other one at the same time. */
static PetscErrorCode Prepare(LamRVE rve)
{
  PetscFunctionBeginUser;
  if (rve->linear->factor) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < LAM_SYSTEMS && rve->mesh.element_count >= LAM_LARGE; ++k)
    PetscCall(LamFactorDestroy(&rve->systems[k].factor));
  PetscCall(LamLinearCreateMatrix(rve->comm, rve->linear));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEFactor(LamRVE rve, PetscReal shift, PetscInt *negative, PetscBool *ok)
{
  PetscFunctionBeginUser;
  *negative = 0;
  *ok = PETSC_FALSE;
  if (IsStopped(rve)) PetscFunctionReturn(0);
  PetscCall(Prepare(rve));
  PetscCall(LamLinearFactor(rve->linear, shift, negative, ok));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEFactorExpected(LamRVE rve, PetscReal shift, PetscBool *ok)
{
  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  if (IsStopped(rve)) PetscFunctionReturn(0);
  PetscCall(Prepare(rve));
  PetscCall(LamLinearFactorExpected(rve->linear, shift, LamExpectedNegative(rve), ok));
  PetscFunctionReturn(0);
}

void LamAddWork(LamRVE rve, const LamResponse *part)
{
  rve->work.iterations += part->newton_iterations;
  rve->work.factorisations += part->factorisations;
  if (LamWasStopped(part)) rve->work.stopped = PETSC_TRUE;
}

PetscErrorCode LamRefuse(LamResponse *response, LamStatus status, const char format[], ...)
{
  va_list arguments;
  size_t length;

  PetscFunctionBeginUser;
  response->status = status;
  va_start(arguments, format);
  PetscCall(PetscVSNPrintf(response->reason, sizeof(response->reason), format, &length, arguments));
  va_end(arguments);
  PetscFunctionReturn(0);
}

PetscErrorCode LamGiveUp(LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRefuse(response, LAM_OUT_OF_REACH, "stopped before it was solved"));
  PetscFunctionReturn(0);
}
