/*
  Forces of a run: obstacles that never touch; why a body whose lamella breaks has no next state, and what helps.

  Newton's method alone cannot tell a body without equilibrium near by from a step that is too long: both end in
  iterations that do not converge. What is told is what the body has come to, and the ways on that there are.
*/
#include "fe2_run.h"
#include <math.h>
#include <string.h>

static const PetscReal TORN = 1e-3; /* of the largest force: what is left is that of threads, chosen */

static const PetscReal NO_FORCE = 1e-12; /* stress * length: what rounding leaves of forces that are 0 */

void LamFE2NoteForce(LamFE2Totals *totals, const LamMacroSpec *spec, const LamMacroStep *step)
{
  totals->force = 0;
  for (PetscInt s = 0; s < step->boundary_count; s++)
    totals->force = PetscMax(totals->force, hypot(step->reaction[s][0], step->reaction[s][1]));
  totals->largest_force = PetscMax(totals->largest_force, totals->force);
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const PetscInt s = LamMacroSideNumber(step, &spec->boundary[b]);

    if (s >= 0 && hypot(step->reaction[s][0], step->reaction[s][1]) > NO_FORCE) totals->pressed |= 1u << b;
  }
}

void LamFE2WarnOfObstacles(const LamFE2Run *run)
{
  const LamMacroSpec *spec = &run->scene->macro;

  if (!LamIsFirst(run->comm) || run->resumed || !run->totals.steps) return;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    char place[LAM_PLACE_TEXT];

    if ((boundary->kind != LAM_BOUNDARY_PLATE && boundary->kind != LAM_BOUNDARY_INDENTER) ||
        run->totals.pressed >> b & 1)
      continue;
    LamReportWarning(&run->reporter,
                     "%s: macro.boundary: on: %s: the %s has not touched the body in any step, and its forces are 0; "
                     "write a displacement along its normal into the body",
                     LamScenePlaceText(run->scene, &boundary->place, place), boundary->on,
                     LamBoundaryKindNames[boundary->kind]);
  }
}

/* Whether forces are prescribed, which nothing balances past the largest one. */
static PetscBool IsForced(const LamMacroSpec *spec)
{
  PetscBool forced = PETSC_FALSE;

  for (PetscInt b = 0; b < spec->boundary_count; b++)
    if (spec->boundary[b].kind == LAM_BOUNDARY_TRACTION || spec->boundary[b].kind == LAM_BOUNDARY_PRESSURE)
      forced = PETSC_TRUE;
  return (PetscBool)(forced && !spec->control.on[0]);
}

PetscErrorCode LamFE2ExplainTear(LamFE2Run *run)
{
  const LamFE2Totals *totals = &run->totals;
  const size_t length = strlen(run->message), room = sizeof(run->message) - length;
  char *end = run->message + length;

  PetscFunctionBeginUser;
  if (!(run->broken > 0)) PetscFunctionReturn(0);
  if (totals->force < TORN * totals->largest_force)
    PetscCall(PetscSNPrintf(end, room,
                            "; the body is torn: its forces are down to %.1g of the largest, and what the lamella no "
                            "longer holds floats. There is nothing left to be solved: end the loads here",
                            (double)(totals->force / totals->largest_force)));
  else if (IsForced(&run->scene->macro))
    PetscCall(PetscSNPrintf(end, room,
                            "; %.2g of the lamella is broken, and the body may not bear a larger load: write "
                            "macro.control, or prescribe displacements, to follow it past the largest one",
                            (double)run->broken));
  else
    PetscCall(
        PetscSNPrintf(end, room,
                      "; %.2g of the lamella is broken, and where a body softens there may be no equilibrium next "
                      "to the last one (snap-back). Shorter steps (macro.steps) help where one broke too much; a "
                      "shorter body, or one held nearer to where it tears, stores less that the tear must take "
                      "up; a block of cells (lamella rve, rve.patch) is followed across jumps",
                      (double)run->broken));
  PetscFunctionReturn(0);
}
