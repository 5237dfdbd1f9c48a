/*
  Error estimate of P from a finer mesh.

  Method. The same load is solved on a mesh with half as many elements again along the faces and through the walls, from
  the interpolated solution, so that both are on the same branch. The difference of the two stresses times EXCESS is the
  error of the coarser mesh, plus the effect of the residual tolerance. A coarser mesh would be cheaper and tells
  little: what it misses is no measure of what this one misses (docs/results/performance.md, "The error of a mesh").
  With a lamella or walls with memory, whose states depend on those before, the finer mesh follows the same loads with a
  history of its own.
*/
#include "clock.h"
#include "measure.h"
#include "solve.h"

/* Error over the difference of the meshes: 1.8 where errors fall with the square of the element size, 1.5 and 1 where
   they fall with its first power or scatter; median of random states (bench_accuracy). */
#define EXCESS 1.35

#define KINKED 4.0 /* times as much in bonded tissue with kinked walls, which wrinkle more on still finer meshes */

struct LamRVEEstimate_s {
  LamRVE rve;        /* borrowed */
  LamRVE finer;      /* owned; NULL for sealed cells */
  LamRVEState state; /* on `finer`; owned */
};

PetscErrorCode LamRVEEstimateCreate(LamRVE rve, LamRVEEstimate *estimate)
{
  LamMicrostructure micro = rve->micro;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(estimate));
  (*estimate)->rve = rve;
  if (rve->seal.allowed) PetscFunctionReturn(0);
  micro.along += (micro.along + 1) / 2;
  if (LamWallsTear(&micro)) micro.along += micro.along % 2;
  micro.through += (micro.through + 1) / 2;
  PetscCall(LamRVECreateLike(rve, &micro, LAM_WANT_STRESS, &(*estimate)->finer));
  PetscCall(LamRVESetTolerance((*estimate)->finer, PetscMax(rve->tolerance, 1e-6)));
  PetscCall(LamRVESetMonitor((*estimate)->finer, PETSC_FALSE));
  PetscCall(LamRVEStateCreate((*estimate)->finer, &(*estimate)->state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEEstimateDestroy(LamRVEEstimate *estimate)
{
  PetscFunctionBeginUser;
  if (!*estimate) PetscFunctionReturn(0);
  PetscCall(LamRVEStateDestroy(&(*estimate)->state));
  PetscCall(LamRVEDestroy(&(*estimate)->finer));
  PetscCall(PetscFree(*estimate));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESolveFiner(LamRVE rve, LamRVEState from, LamRVE finer, LamRVEState state, LamResponse *response)
{
  const LamLoad load = from->load;

  PetscFunctionBeginUser;
  PetscCall(LamTakeState(rve, from));
  (void)LamSetConsistentStresses(rve, &load, rve->y);
  PetscCall(LamRVEStateReset(finer, state));
  PetscCall(LamBeginResponse(finer, &load, state, response));
  PetscCall(LamProlong(rve, from, finer, state));
  if (state->solved)
    PetscCall(LamRVESolve(finer, rve->antiplane ? &from->given : &load, state, response));
  else
    PetscCall(LamRefuse(response, LAM_NOT_CONVERGED, "the finer mesh has no state near that of the coarser one"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEEstimateError(LamRVEEstimate e, LamRVEState state, LamResponse *response)
{
  const LamStressScale scale = LamStressScaleOf(&e->rve->micro);
  const PetscReal begin = LamClock();
  PetscReal excess = EXCESS;
  LamResponse finer;

  PetscFunctionBeginUser;
  response->error_estimate = NAN;
  if (!e->finer || !LamResponseHasFields(response)) PetscFunctionReturn(0);
  if (e->rve->layer || e->rve->memory)
    PetscCall(LamRVESolve(e->finer, &response->load, e->state, &finer));
  else
    PetscCall(LamRVESolveFiner(e->rve, state, e->finer, e->state, &finer));
  response->seconds += LamClock() - begin;
  if (!LamResponseHasFields(&finer)) PetscFunctionReturn(0);
  if (!e->rve->contact && response->kinked_fraction > LAM_KINKED_SHARE) excess *= KINKED;
  response->error_estimate =
      excess * LamWholeError(scale, response->P, finer.P) + LamStressErrorOfSize(scale, e->rve->tolerance, response->P);
  PetscFunctionReturn(0);
}
