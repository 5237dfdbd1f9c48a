/*
  Mixed control: for each component either F or P is given.
*/
#include "scene_keys.h"

static const char *const names[9] = {"11", "12", "13", "21", "22", "23", "31", "32", "33"};

/* The node of a component; the tensor's node if the tensor is 2x2 and does not contain it. */
static const LamNode *Item(const LamNode *tensor, PetscInt i)
{
  const LamNode *row = tensor->first, *item;

  if (i / 3 >= tensor->count || i % 3 >= tensor->count) return tensor;
  for (PetscInt k = 0; k < i / 3; k++) row = row->next;
  item = row->first;
  for (PetscInt k = 0; k < i % 3; k++) item = item->next;
  return item;
}

static PetscErrorCode CheckComponent(const LamNode *F_node, const LamNode *P_node, PetscInt i, PetscBool F_given,
                                     PetscBool P_given)
{
  const PetscBool shear33 = (PetscBool)(i == 2 || i == 5 || i == 6 || i == 7);

  PetscFunctionBeginUser;
  LamSceneCheck(!shear33 || (F_given && !P_given), Item(F_given ? P_node : F_node, i),
                "this version of Lamella does not have out-of-plane shear yet; write 0 for F%s and x for P%s", names[i],
                names[i]);
  LamSceneCheck(!F_given || !P_given, Item(P_node, i), "F%s is given, too; write x here, or free there", names[i]);
  LamSceneCheck(F_given || P_given, Item(F_node, i), "P%s is not given%s; write it into P, such as P: %s", names[i],
                P_node ? " either" : "", i == 8 ? "[[x, x, x], [x, x, x], [x, x, 0 MPa]]" : "[[0 MPa, x], [x, 0 MPa]]");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadControl(const LamNode *F_node, const LamNode *P_node, PetscReal scale,
                                   LamStressControl *control)
{
  PetscFunctionBeginUser;
  *control = (LamStressControl){.share = 1.0};
  for (PetscInt i = 0; i < 9; i++) {
    control->given[i] = (PetscBool)(P_node && !P_node->value.is_free[i]);
    PetscCall(CheckComponent(F_node, P_node, i, (PetscBool)!F_node->value.is_free[i], control->given[i]));
    if (control->given[i]) PetscCall(LamSceneScale(Item(P_node, i), P_node->value.number[i], scale, &control->P[i]));
  }
  LamSceneCheck(!control->given[1] || !control->given[3], Item(F_node, 3),
                "F12 is free, too: the tissue can rotate; write a number for one of them, such as 0");
  PetscFunctionReturn(0);
}

void LamSceneRampControl(const LamStressControl *from, const LamStressControl *to, PetscInt step, PetscInt steps,
                         LamStressControl *control)
{
  const PetscReal s = (PetscReal)step / (PetscReal)steps;

  *control = *to;
  control->share = 1.0 / (PetscReal)(steps - step + 1);
  for (PetscInt i = 0; i < 9; i++) {
    if (to->given[i] && step < steps) control->P[i] = s * to->P[i] + (from->given[i] ? (1.0 - s) * from->P[i] : 0.0);
    control->follows[i] = (PetscBool)(from->given[i] && !to->given[i] && step < steps);
  }
}

LamLoad LamLoadAfter(const LamLoad *load, const LamStressControl *control, const PetscReal before[9])
{
  LamLoad after = *load;

  for (PetscInt i = 0; i < 9 && control; i++) {
    if (control->given[i]) after.F[i] = before[i];
    if (control->follows[i]) after.F[i] = (1.0 - control->share) * before[i] + control->share * load->F[i];
  }
  return after;
}
