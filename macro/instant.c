/*
  The body at an instant, for time integration (body.h): equilibrium under given conditions from a given guess, and
  responses at any state.
*/
#include <math.h>
#include "transport_impl.h"

PetscErrorCode LamMacroGetVolumes(LamMacro macro, PetscReal volume[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(volume, macro->weight, macro->point_count));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetSizes(LamMacro macro, LamMacroSizes *sizes)
{
  PetscFunctionBeginUser;
  *sizes = (LamMacroSizes){.points = macro->point_count, .elements = macro->element_count};
  PetscCall(VecGetLocalSize(macro->u, &sizes->displacements));
  sizes->modes = macro->seal ? macro->seal->modes : 0;
  if (macro->flow) PetscCall(VecGetLocalSize(macro->flow->psi, &sizes->potentials));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetElement(LamMacro macro, PetscInt point, PetscInt *local, PetscInt *number, PetscInt *index)
{
  PetscFunctionBeginUser;
  *local = macro->point_element[point];
  *number = macro->elements[*local].number;
  *index = point - macro->elements[*local].first;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroStart(LamMacro macro, PetscBool *ok, char message[LAM_MESSAGE_LENGTH])
{
  PetscReal reached, start;

  PetscFunctionBeginUser;
  PetscCheck(macro->responder, macro->comm, PETSC_ERR_ORDER, "call LamMacroSetResponder() first");
  message[0] = '\0';
  macro->extrapolates = PETSC_FALSE; /* guesses are provided by the caller */
  macro->thorough = PETSC_FALSE;
  PetscCall(LamMacroStartStep(macro, &start));
  PetscCall(LamMacroBringUpTurgor(macro, &reached, ok));
  if (*ok && macro->scene->macro.inflate) PetscCall(LamMacroHoldBoundaries(macro));
  if (!*ok)
    PetscCall(
        PetscSNPrintf(message, LAM_MESSAGE_LENGTH, "turgor: reached %.4g of 1: %s", (double)reached, macro->trouble));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetState(LamMacro macro, PetscReal u[], PetscReal pressures[], PetscReal potentials[])
{
  const PetscScalar *values;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(macro->trial, &n));
  PetscCall(VecGetArrayRead(macro->trial, &values));
  PetscCall(PetscArraycpy(u, values, n));
  PetscCall(VecRestoreArrayRead(macro->trial, &values));
  if (macro->seal) PetscCall(PetscArraycpy(pressures, macro->seal->change, macro->seal->modes * macro->element_count));
  PetscCall(LamMacroFlowGet(macro, potentials));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBalance(LamMacro macro, const LamMacroInstant *instant, const PetscReal u[],
                               const PetscReal pressures[], const PetscReal potentials[], PetscBool *ok)
{
  PetscScalar *values;
  PetscInt n;

  PetscFunctionBeginUser;
  macro->turgor = instant->turgor;
  macro->lamella = instant->lamella;
  macro->walls = instant->walls;
  macro->time = instant->time;
  macro->duration = macro->relaxes ? PetscMax(0, instant->time - macro->accepted_time) : 0;
  PetscCall(LamMacroSetLoadFactor(macro, instant->load));
  PetscCall(VecGetLocalSize(macro->trial, &n));
  PetscCall(VecGetArray(macro->trial, &values));
  PetscCall(PetscArraycpy(values, u, n));
  PetscCall(VecRestoreArray(macro->trial, &values));
  if (macro->seal) {
    PetscCall(PetscArraycpy(macro->seal->change, pressures, macro->seal->modes * macro->element_count));
    PetscCall(VecCopy(macro->trial, macro->seal->u)); /* the pressures belong to it */
  }
  PetscCall(LamMacroFlowStart(macro, instant, potentials));
  macro->prediction = 0;
  macro->thorough = PETSC_TRUE; /* otherwise slow changes in time would not move the body at all */
  PetscCall(LamMacroIterate(macro, ok));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroForget(LamMacro macro)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < macro->point_count; p++) macro->now[p].walls = macro->accepted[p].walls = NAN;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetPoint(LamMacro macro, PetscInt point, LamMacroPoint *p)
{
  const LamMaterialPoint *now = &macro->now[point];

  PetscFunctionBeginUser;
  *p = (LamMacroPoint){.load = &macro->loads[point], .field = now->field, .percolating = now->percolating};
  p->potential = macro->flow ? &macro->flow->at[macro->flow->spec.count * point] : NULL;
  p->lumen = macro->seal ? macro->seal->now[point].lumen : NAN;
  for (int i = 0; i < 2; i++) p->place[i] = macro->place[macro->dim * point + i];
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroStopped(LamMacro macro, PetscBool *stopped)
{
  PetscFunctionBeginUser;
  *stopped = macro->stopped;
  PetscFunctionReturn(0);
}

const char *LamMacroTrouble(LamMacro macro)
{
  return macro->trouble;
}

PetscErrorCode LamMacroDescribe(LamMacro macro, PetscInt number, PetscReal time, PetscReal start, LamMacroStep *step)
{
  PetscReal now;

  PetscFunctionBeginUser;
  macro->step.complete = PETSC_TRUE;
  macro->step.time = time;
  PetscCall(LamMacroFinishStep(macro, number, macro->parameter, start));
  *step = macro->step;
  PetscCall(LamMacroStartStep(macro, &now));
  PetscFunctionReturn(0);
}
