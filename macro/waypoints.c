/*
  The direct response of a material point that a sample has drawn.

  Cells that come apart have several stable states at the same F, and the one of the run is the one that its path led
  to. So F of all points is kept at a few complete steps, evenly spread over the run, and a drawn point is led there
  from the reference state: to the inflated body, along these waypoints and to the state in question.
*/
#include "macro_impl.h"

PetscErrorCode LamMacroWaypointsDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_MACRO_WAYPOINTS; k++) PetscCall(PetscFree(macro->waypoints.loads[k]));
  PetscFunctionReturn(0);
}

/* Keeps every second one. */
static void Thin(LamMacroWaypoints *waypoints)
{
  for (PetscInt k = 0; k < LAM_MACRO_WAYPOINTS / 2; k++) {
    LamLoad *other = waypoints->loads[k];
    waypoints->loads[k] = waypoints->loads[2 * k + 1];
    waypoints->loads[2 * k + 1] = other;
    waypoints->step[k] = waypoints->step[2 * k + 1];
  }
  waypoints->count = LAM_MACRO_WAYPOINTS / 2;
  waypoints->stride *= 2;
}

PetscErrorCode LamMacroAddWaypoint(LamMacro macro, PetscInt step)
{
  LamMacroWaypoints *waypoints = &macro->waypoints;

  PetscFunctionBeginUser;
  if (!macro->follows) PetscFunctionReturn(0);
  if (waypoints->count == LAM_MACRO_WAYPOINTS) Thin(waypoints);
  waypoints->stride = PetscMax(waypoints->stride, 1);
  if (step % waypoints->stride) PetscFunctionReturn(0);
  const PetscInt k = waypoints->count++;
  if (!waypoints->loads[k]) PetscCall(PetscMalloc1(macro->point_count, &waypoints->loads[k]));
  for (PetscInt p = 0; p < macro->point_count; p++) waypoints->loads[k][p] = macro->now[p].load;
  waypoints->step[k] = step;
  PetscFunctionReturn(0);
}

PetscInt LamMacroCountWaypoints(LamMacro macro, PetscInt step)
{
  PetscInt count = 0;

  while (count < macro->waypoints.count && macro->waypoints.step[count] < step) count++;
  return count;
}

/* Where the response has fields its state becomes the start of the next. */
static PetscErrorCode AskAt(LamMacro macro, PetscInt p, const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponderRespond(macro->reference, 1, load, &p, response));
  if (LamResponseHasFields(response)) PetscCall(LamResponderAccept(macro->reference));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroLead(LamMacro macro, PetscInt p, PetscInt step, const LamLoad *load, LamResponse *inflated,
                            LamResponse *response)
{
  const PetscInt count = LamMacroCountWaypoints(macro, step);
  const LamMaterialPoint *before = macro->loaded ? macro->inflated.points : NULL;

  PetscFunctionBeginUser;
  PetscCall(LamResponderReject(macro->reference));
  if (before && (inflated || macro->follows)) {
    PetscCall(AskAt(macro, p, &before[p].load, response));
    if (inflated) *inflated = *response;
  }
  for (PetscInt k = 0; k < count; k++) PetscCall(AskAt(macro, p, &macro->waypoints.loads[k][p], response));
  PetscCall(AskAt(macro, p, load, response));
  PetscFunctionReturn(0);
}
