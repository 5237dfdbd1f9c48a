/*
  Contact equilibrium at a new load, starting from a known state.

  Method. The state is sought at the load itself (contact_find.c). If that fails, a path of loads is followed with the
  smooth law, each state starting from the one before, in steps that are halved on failure: from the state before, then
  from the undeformed tissue. A path that ends tells why: the walls have no room, a lumen is turned inside out, or walls
  kink, which no mesh resolves. With a lamella each state on the path is solved to the end, and its history is kept.
*/
#include "contact_find.h"

#define FIRST_STEP 0.25
#define LEAST_STEP (1.0 / 256.0)
#define GROWTH 2.0
#define TOLERANCE 1e-3 /* of states on the path: looser ones leave their branch before it ends */

typedef struct {
  PetscReal between[2]; /* path parameters of the last state and of the failure after it */
  PetscInt shut;        /* cell whose lumen the failure has turned inside out; -1: none */
  LamKinking kinking;
  PetscBool from_rest;
  LamLoad end; /* of that failure; of the path if there was none */
} Way;

/* Follows the loads from that of `at` to `load`; on return *at is the last state. */
static PetscErrorCode Walk(LamRVE rve, LamRVEState at, const LamLoad *load, Way *way, LamContactOutcome *out)
{
  const LamLoad start = at->load;
  PetscReal step = FIRST_STEP;

  PetscFunctionBeginUser;
  way->between[0] = 0.0;
  way->between[1] = 1.0;
  way->end = *load;
  way->shut = -1;
  way->kinking = LAM_NO_KINKING;
  LamWatchKinks(rve, &start, at->y, 0.0, &way->kinking);
  while (way->between[0] < 1.0 && LamMayIterate(rve)) {
    const PetscReal least = LamIsKinking(&way->kinking) ? LAM_KINKED_SUBSTEP : LEAST_STEP;
    const PetscReal t = PetscMin(1.0, way->between[0] + step);
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(&start, load, t);

    if (step < least) break;
    if (rve->layer) {
      PetscCall(LamContactFind(rve, &next, NULL, at, out));
    } else {
      LamContactStartNear(rve, at, &next);
      PetscCall(LamContactSearch(rve, &next, NULL, LAM_SEARCH_WIDTH, TOLERANCE, out));
    }
    if (rve->layer ? LamContactIsStable(out) : out->found) {
      LamKeepState(rve, &next, at->branch, at);
      if (t < 1.0) LamLayerTake(rve, at);
      LamWatchKinks(rve, &next, at->y, t, &way->kinking);
      way->between[0] = t;
      step *= GROWTH;
    } else {
      way->between[1] = t;
      way->shut = out->shut;
      way->end = next;
      step *= 0.5;
    }
  }
  if (way->between[0] < 1.0) out->found = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* From the undeformed tissue, rotated with F, without turgor and cohesion: the one state that is known. */
static PetscErrorCode WalkFromRest(LamRVE rve, LamRVEState at, const LamLoad *load, Way *way, LamContactOutcome *out)
{
  const PetscReal angle = LamRotationAngle(load->F);

  PetscFunctionBeginUser;
  way->from_rest = PETSC_TRUE;
  PetscCall(LamRVEStateReset(rve, at));
  LamRotatePositions(rve->ndof, at->y, at->load.F, angle);
  PetscCall(Walk(rve, at, load, way, out));
  PetscFunctionReturn(0);
}

/* Volume of the walls over V0. */
static PetscReal WallFraction(LamRVE rve)
{
  PetscReal volume = 0.0;

  for (PetscInt e = 0; e < rve->mesh.element_count; ++e)
    for (PetscInt g = 0; g < LAM_GAUSS; ++g) volume += rve->geometry[e].weight[g];
  return volume / rve->mesh.V0;
}

/* Status and reason where no stable state was found. */
static PetscErrorCode Refuse(LamRVE rve, const Way *way, const LamContactOutcome *out, LamResponse *response)
{
  const LamStatus status = way->between[1] > way->between[0] ? LAM_NO_EQUILIBRIUM : LAM_NOT_CONVERGED;
  const PetscReal *F = way->end.F, room = F[8] * (F[0] * F[4] - F[1] * F[3]), walls = WallFraction(rve);
  char place[80];
  size_t used;

  PetscFunctionBeginUser;
  if (out->found) {
    PetscCall(LamRefuseSaddle(rve, out->negative, response));
    PetscFunctionReturn(0);
  }
  LamBracketText(way->between, place, sizeof(place));
  if (room < walls && status == LAM_NO_EQUILIBRIUM) {
    PetscCall(LamRefuse(response, status, "the walls have no room%s: they take %.4g of V0, and F leaves %.4g", place,
                        (double)walls, (double)room));
  } else if (way->shut >= 0) {
    PetscCall(LamRefuse(response, status, "the lumen of cell %d collapses%s: its walls are pressed through each other",
                        (int)way->shut, place));
  } else if (LamIsKinking(&way->kinking)) {
    PetscCall(LamRefuseKinks(&way->kinking, way->between[0], status, response));
  } else {
    PetscCall(LamRefuse(response, LAM_NOT_CONVERGED,
                        "no contact equilibrium found%s, after %d iterations: give states in between", place,
                        (int)rve->work.iterations));
  }
  used = strlen(response->reason);
  if (way->from_rest && way->between[1] > way->between[0])
    PetscCall(PetscSNPrintf(response->reason + used, sizeof(response->reason) - used, "; from rest"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  LamRVEState before, at;
  LamContactOutcome out;
  Way way = {.shut = -1, .kinking = LAM_NO_KINKING};
  const PetscInt most = rve->layer && state->solved ? 1 : 2; /* a history does not begin again */

  PetscFunctionBeginUser;
  PetscCall(LamTurnedState(rve, state, load, &before));
  PetscCall(LamRVEStateCreate(rve, &at));
  PetscCall(LamRVEStateCopy(before, at));
  PetscCall(LamContactFind(rve, load, NULL, before, &out));
  for (PetscInt k = before->solved ? 0 : 1; k < most && !rve->near_only && !out.found && !rve->work.stopped; ++k) {
    PetscCall(k == 0 ? Walk(rve, at, load, &way, &out) : WalkFromRest(rve, at, load, &way, &out));
    if (out.found && !rve->layer) PetscCall(LamContactFinish(rve, load, NULL, &out));
  }
  PetscCall(LamRVEStateDestroy(&before));
  PetscCall(LamRVEStateDestroy(&at));
  response->branch = state->branch + out.branch;
  response->negative_eigenvalues = PetscMax(0, out.negative);
  response->status = LAM_CONVERGED;
  if (!LamContactIsStable(&out)) PetscCall(Refuse(rve, &way, &out, response));
  PetscFunctionReturn(0);
}
