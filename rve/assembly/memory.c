#include "rve_impl.h"

PetscInt LamMemoryPairs(LamRVE rve)
{
  return rve->memory ? rve->mesh.element_count * (1 + rve->micro.relaxation.terms) : 0;
}

PetscErrorCode LamMemoryCreate(LamRVE rve)
{
  LamMemory *memory;

  PetscFunctionBeginUser;
  if (!LamWallsRelax(&rve->micro)) PetscFunctionReturn(0);
  PetscCall(PetscNew(&memory));
  rve->memory = memory;
  PetscCall(PetscMalloc1(rve->mesh.cell_count, &memory->wall));
  PetscCall(PetscMalloc1(rve->mesh.element_count, &memory->history));
  PetscCall(PetscMalloc1(LamMemoryPairs(rve), &memory->past));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMemoryDestroy(LamMemory **memory)
{
  PetscFunctionBeginUser;
  if (!*memory) PetscFunctionReturn(0);
  PetscCall(PetscFree((*memory)->wall));
  PetscCall(PetscFree((*memory)->history));
  PetscCall(PetscFree((*memory)->past));
  PetscCall(PetscFree(*memory));
  PetscFunctionReturn(0);
}

/* The unit of the past's stresses, in which they follow walls that change. */
static PetscReal UnitOf(LamRVE rve, PetscInt e)
{
  const LamWall *wall = LamCellWall(&rve->micro, rve->mesh.cell_of[e]);

  return wall->C1 + wall->C2;
}

void LamMemoryTake(LamRVE rve, const LamRVEState state, PetscReal duration)
{
  LamMemory *memory = rve->memory;

  if (!memory) return;
  memory->step = LamMemoryStepOf(&rve->micro.relaxation, duration);
  memory->ledger = state->ledger;
  memory->work = state->work;
  (void)PetscArraycpy(memory->past, state->past, state->pairs);
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) {
    LamWall *wall = &memory->wall[c];

    *wall = *LamCellWall(&rve->micro, c);
    LamWallScale(wall, memory->step.scale, 1.0);
    wall->bulk_modulus = LamCellWall(&rve->micro, c)->bulk_modulus;
  }
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e)
    LamMemoryHistory(&memory->step, &memory->past[e * (1 + memory->step.terms)], UnitOf(rve, e), memory->history[e]);
}

void LamMemoryKeep(LamRVE rve, const LamLoad *load, LamRVEState state)
{
  LamMemory *memory = rve->memory;
  LamMemoryLedger *ledger = &state->ledger;
  PetscReal elastic = 0.0;
  LamMemoryWork sum = {0};

  if (!memory) return;
  for (PetscInt e = 0; e < rve->mesh.element_count; ++e) {
    const PetscInt first = e * (1 + memory->step.terms);
    const PetscReal unit = UnitOf(rve, e);
    PetscReal u[LAM_ELEMENT_NODES][2];
    LamMemoryPair now;
    LamMemoryWork work;

    LamGatherDisplacements(rve, load->F, rve->y, e, u);
    elastic += LamElementElastic(&rve->geometry[e], LamLawOf(rve, e), LamCellWall(&rve->micro, rve->mesh.cell_of[e]),
                                 (const PetscReal(*)[2])u, load->F[8], unit, &now);
    LamMemoryAdvance(&memory->step, &rve->geometry[e], &memory->past[first], &now, unit, &state->past[first], &work);
    sum.retarded += work.retarded;
    sum.dissipated += work.dissipated;
    sum.history += work.history;
  }
  ledger->elastic = elastic / rve->mesh.V0;
  ledger->retarded = memory->ledger.retarded + sum.retarded / rve->mesh.V0;
  ledger->dissipated = memory->ledger.dissipated + sum.dissipated / rve->mesh.V0;
  ledger->step = (memory->step.scale * elastic + sum.history) / rve->mesh.V0;
  if (!rve->layer) state->work = memory->work;
}
