/*
  How far contact states go on along a straight way of loads.

  Method. Each solution, moved affinely, starts the next; a step that fails is halved, one that succeeds is followed by
  a longer one. Where the smallest step still fails without a reason, the tissue may snap: descent looks for the stable
  state beyond, from which the way goes on. What ends it is then bracketed by the last stable state and the next, in
  which walls meet that contact does not know, a lumen is shut, or no stable state is found.
*/
#include "contact_path.h"

#define FIRST_STEP 0.25
#define MIN_STEP (1.0 / 512.0)
#define GROWTH 2.0
#define MAX_SNAPS 4

/* Beyond the last step by descent. */
static PetscErrorCode Snap(LamRVE rve, const LamContactSolution *at, const LamLoad *next, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  PetscCall(LamContactStartNear(rve, at, next));
  PetscCall(LamContactDescend(rve, next, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactWalk(LamRVE rve, LamContactSolution *at, const LamLoad *load, LamContactOutcome *out)
{
  const LamLoad start = at->load;
  PetscReal reached = 0.0, failed = 1.0, step = FIRST_STEP;
  PetscInt snaps = 0, branch = 0;

  PetscFunctionBeginUser;
  *out = (LamContactOutcome){0};
  while (reached < 1.0 && LamMayIterate(rve)) {
    const PetscBool last = (PetscBool)(step < MIN_STEP);
    const PetscReal t = PetscMin(1.0, reached + PetscMax(step, MIN_STEP));
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(&start, load, t);

    if (last) {
      if (out->refusal != LAM_NOT_REFUSED || snaps++ == MAX_SNAPS) break;
      PetscCall(Snap(rve, at, &next, out));
    } else {
      PetscCall(LamContactStartNear(rve, at, &next));
      PetscCall(LamContactTry(rve, &next, LAM_NEAR_REACH, out));
    }
    if (LamContactIsStable(out)) {
      PetscCall(LamContactSave(rve, &next, at));
      branch += out->branch + last;
      reached = t;
      step = last ? 4.0 * MIN_STEP : GROWTH * step;
    } else {
      failed = t;
      if (last) break;
      step *= 0.5;
    }
  }
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "  walk: %g to %g, refusal %d, negative %d, converged %d, snaps %d\n", (double)reached,
                           (double)failed, (int)out->refusal, (int)out->negative, (int)out->converged, (int)snaps));
  out->branch = branch;
  out->between[0] = reached;
  out->between[1] = failed;
  PetscFunctionReturn(0);
}
