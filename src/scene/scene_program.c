/*
  The load program of the macroscale body: steps, ramps and cycles of the load parameter, histories over it, control.
*/
#include "scene_keys.h"
#include <string.h>

enum { MAX_STEPS = 1000000 };

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

static PetscErrorCode BuildLegs(const LamDocument *document, const LamNode *list, LamMacroSpec *spec)
{
  const LamNode *repeat_node;
  LamValue repeat, to, steps;
  PetscReal from = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.repeat", &repeat_node, &repeat));
  if (list->count > LAM_MAX_LEGS)
    PetscCall(LamSceneFailName(document, list, "has %d ramps; at most %d are allowed", (int)list->count, LAM_MAX_LEGS));
  for (const LamNode *item = list->first; item; item = item->next) {
    PetscCall(LamSceneGet(item, "macro.program[].to", NULL, &to));
    PetscCall(LamSceneGet(item, "macro.program[].steps", NULL, &steps));
    if (to.number[0] == from)
      PetscCall(LamSceneFail(document, LamNodeFindPath(item, "to"),
                             "is where the parameter is already; write another one, or leave the ramp out"));
    from = to.number[0];
    spec->legs[spec->leg_count++] = (LamLeg){to.number[0], (PetscInt)steps.number[0]};
    spec->steps += (PetscInt)steps.number[0];
  }
  if (repeat.number[0] * spec->steps > MAX_STEPS)
    PetscCall(LamSceneFailName(document, repeat_node ? repeat_node : list, "gives %g steps; at most %d are allowed",
                               (double)(repeat.number[0] * spec->steps), (int)MAX_STEPS));
  spec->steps *= (PetscInt)repeat.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildControl(const LamDocument *document, LamScene *scene)
{
  LamMacroSpec *spec = &scene->macro;
  LamLoadControl *control = &spec->control;
  const LamNode *block, *on, *node;
  LamValue value;
  PetscInt side, tractions = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.control", &block, &value));
  if (!block) PetscFunctionReturn(0);
  PetscCall(LamSceneGet(document->root, "macro.control.on", &on, &value));
  PetscCall(LamSceneCheckSide(document, on, spec, &side));
  PetscCall(PetscStrncpy(control->on, on->text, sizeof(control->on)));
  PetscCall(LamSceneGet(document->root, "macro.control.displacement", &node, &value));
  if (value.is_free[0] == value.is_free[1])
    PetscCall(LamSceneFail(document, node, "gives %s; give one and write free for the other, such as [free, -1 mm]",
                           value.is_free[0] ? "no component" : "both components"));
  control->component = value.is_free[0] ? 1 : 0;
  PetscCall(LamSceneScale(document, node, value.number[control->component], scene->scales.macro_length,
                          &control->displacement));
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscBool loads = boundary->traction[0] != 0 || boundary->traction[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
    if (loads) tractions++;
    if (loads && boundary->history.count)
      PetscCall(LamSceneFailName(document, block,
                                 "finds the factor of the tractions, but that on %s has a history; leave one of them "
                                 "out",
                                 boundary->on));
    if (boundary->kind == LAM_BOUNDARY_DISPLACEMENT && boundary->given[control->component] &&
        !strcmp(boundary->on, control->on))
      PetscCall(LamSceneFail(document, on, "its displacement along X%d is prescribed in macro.boundary; leave it free",
                             (int)control->component + 1));
  }
  if (!tractions)
    PetscCall(LamSceneFailName(document, block,
                               "finds the factor of the tractions, but there is none in "
                               "macro.boundary; give a traction or pressure, or leave control out"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildProgram(const LamDocument *document, LamScene *scene)
{
  const LamNode *steps_node, *list, *repeat;
  LamValue steps, unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.steps", &steps_node, &steps));
  PetscCall(LamSceneGet(document->root, "macro.program", &list, &unused));
  PetscCall(LamSceneGet(document->root, "macro.repeat", &repeat, &unused));
  if (list && steps_node)
    PetscCall(LamSceneFailName(document, steps_node,
                               "stands beside program, whose parts have their own steps; leave "
                               "one of them out"));
  if (repeat && !list)
    PetscCall(LamSceneFailName(document, repeat,
                               "repeats a program, but there is none; write one, such as program: "
                               "[{to: 1, steps: 10}, {to: 0, steps: 10}]"));
  if (list)
    PetscCall(BuildLegs(document, list, &scene->macro));
  else
    scene->macro.steps = steps_node ? (PetscInt)steps.number[0] : 10;
  PetscCall(BuildControl(document, scene));
  PetscFunctionReturn(0);
}
