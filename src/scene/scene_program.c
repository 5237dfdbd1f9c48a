/*
  The load program of the macroscale body: load parameter of a step, histories as functions of it.
*/
#include <lamella/scene.h>

PetscReal LamHistoryFactor(const LamHistory *history, PetscReal parameter)
{
  PetscInt k = 0;

  if (!history->count) return parameter;
  while (k < history->count && history->parameter[k] < parameter) k++;
  if (k == 0) return history->factor[0];
  if (k == history->count) return history->factor[k - 1];
  const PetscReal from = history->parameter[k - 1], share = (parameter - from) / (history->parameter[k] - from);
  return (1 - share) * history->factor[k - 1] + share * history->factor[k];
}

PetscBool LamHistoriesAgree(const LamHistory *one, const LamHistory *other)
{
  const LamHistory *both[] = {one, other};

  if (!one->count != !other->count) return PETSC_FALSE;
  for (int h = 0; h < 2; h++) {
    for (PetscInt k = 0; k < both[h]->count; k++) {
      const PetscReal at = both[h]->parameter[k];
      if (LamHistoryFactor(one, at) != LamHistoryFactor(other, at)) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

PetscReal LamMacroParameter(const LamMacroSpec *spec, PetscInt step)
{
  PetscReal from = 0;

  if (!spec->leg_count) return (PetscReal)step / spec->steps;
  for (PetscInt leg = 0;; leg = (leg + 1) % spec->leg_count) {
    const LamLeg *now = &spec->legs[leg];
    if (step <= now->steps) return step == now->steps ? now->to : from + step * (now->to - from) / now->steps;
    step -= now->steps;
    from = now->to;
  }
}
