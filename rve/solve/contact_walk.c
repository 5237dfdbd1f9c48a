/*
  How far contact states go on along a straight way of loads.

  Method. Each solution, moved affinely, starts the next; a step that fails is halved, one that succeeds is followed by
  a longer one. Where the smallest step still fails without a reason, the tissue may snap: descent looks for the stable
  state beyond, from which the way goes on. What ends it is then bracketed by the last stable state and the next, in
  which walls meet that contact does not know or pass each other, a lumen is shut, or nothing stable is found. Of the
  latter the bracket is halved until the states next to it tell: an eigenvalue crosses zero, or jumps below it; where
  all of the bracket can be gone in smaller steps, the way goes on with these. Where walls kink on the way, no mesh
  resolves its end.
*/
#include "contact_path.h"

#define FIRST_STEP 0.25
#define MIN_STEP (1.0 / 512.0)
#define GROWTH 2.0
#define MAX_SNAPS 4
#define CROSSING_MARGIN 4.0 /* widths of the bracket within which an eigenvalue vanishes that ends the way */
#define STAGES 4            /* after the first one, in which a bracket that tells nothing is halved, */
#define HALVINGS 4          /* so often each */
#define JUMP 2.0 /* of the depth to which walls lie in each other, between neighbouring states: they have passed */

/* Beyond the last step by descent. */
static PetscErrorCode Snap(LamRVE rve, const LamContactSolution *at, const LamLoad *next, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  PetscCall(LamContactStartNear(rve, at, next));
  PetscCall(LamContactDescend(rve, next, out));
  PetscFunctionReturn(0);
}

/* The last two stable states of a way. */
typedef struct {
  LamContactSolution *at, earlier;
  PetscReal reached, before; /* their shares of the way */
  PetscReal failed;          /* of the next that is not stable */
  PetscReal depth;           /* to which walls lie in each other at the first */
  PetscReal step, least;     /* the next one, and the smallest */
  PetscInt snaps, branch;
  LamKinking kinking;
} Way;

static PetscErrorCode LowestEigenvalue(LamRVE rve, const LamContactSolution *solution, PetscReal *eigenvalue)
{
  PetscInt negative;
  PetscReal *mode;
  PetscBool ok;

  PetscFunctionBeginUser;
  *eigenvalue = NAN;
  PetscCall(LamContactRestore(rve, solution));
  PetscCall(LamFactorConsistent(rve, &solution->load, &negative, &ok));
  if (!ok) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(rve->linear.n, &mode));
  PetscCall(LamSoftestMode(rve, eigenvalue, mode));
  PetscCall(PetscFree(mode));
  PetscFunctionReturn(0);
}

/*
  Whether the last stable state would be none without the contact that is about to open, its multipliers drawn through
  the last two states: an eigenvalue then jumps below zero.
*/
static PetscErrorCode FindLoosening(LamRVE rve, const Way *way, PetscBool *found)
{
  const PetscReal ahead = CROSSING_MARGIN * (way->failed - way->reached) / (way->reached - way->before);
  LamContact *contact = rve->contact;
  PetscInt count = 0, negative;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LamContactRestore(rve, way->at));
  for (PetscInt h = 0; h < contact->count; ++h) {
    const PetscReal now = way->at->lambda[h];

    if (!contact->active[h] || now + ahead * (now - way->earlier.lambda[h]) > 0.0) continue;
    contact->active[h] = PETSC_FALSE;
    contact->lambda[h] = 0.0;
    ++count;
  }
  *found = PETSC_FALSE;
  if (count == 0) PetscFunctionReturn(0);
  PetscCall(LamFactorConsistent(rve, &way->at->load, &negative, &ok));
  *found = (PetscBool)(ok && negative > 0);
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  %d hats about to open: %d negative eigenvalues without\n",
                           (int)count, (int)negative));
  PetscFunctionReturn(0);
}

/*
  Whether the stable states end where an eigenvalue crosses zero: near a limit load it falls as the square root of what
  is left of the load, so its square, drawn through the last two states, vanishes in the bracket or close behind it.
*/
static PetscErrorCode FindCrossing(LamRVE rve, const Way *way, LamContactOutcome *out)
{
  PetscReal before, fall;
  PetscBool opens = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (way->reached <= way->before || rve->work.stopped) PetscFunctionReturn(0);
  PetscCall(LowestEigenvalue(rve, &way->earlier, &before));
  PetscCall(LowestEigenvalue(rve, way->at, &out->eigenvalue));
  fall = PetscSqr(before) - PetscSqr(out->eigenvalue);
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  eigenvalue %g at %g, %g at %g\n", (double)before,
                           (double)way->before, (double)out->eigenvalue, (double)way->reached));
  if (fall > 0.0 &&
      PetscSqr(out->eigenvalue) * (way->reached - way->before) <= CROSSING_MARGIN * (way->failed - way->reached) * fall)
    out->refusal = LAM_CROSSING;
  if (out->refusal == LAM_CROSSING) PetscFunctionReturn(0);
  PetscCall(FindLoosening(rve, way, &opens));
  if (opens) out->refusal = LAM_LOOSENING;
  PetscFunctionReturn(0);
}

/* The state just found, a share t of the way, is its last one. */
static PetscErrorCode Advance(LamRVE rve, const LamLoad *load, PetscReal t, Way *way)
{
  const LamContactSolution at = *way->at;

  PetscFunctionBeginUser;
  *way->at = way->earlier;
  way->earlier = at;
  PetscCall(LamContactSave(rve, load, way->at));
  way->before = way->reached;
  way->reached = t;
  PetscFunctionReturn(0);
}

/*
  Whether the state that the last two point to, a few brackets ahead, has a negative eigenvalue, while theirs are
  positive: where an end of a face's overlap passes a node, or a hat is merged, the stiffness jumps.
*/
static PetscErrorCode FindJump(LamRVE rve, const Way *way, PetscBool *found)
{
  const PetscReal ahead = CROSSING_MARGIN * (way->failed - way->reached) / (way->reached - way->before);
  const LamLoad load = LamLoadBetween(&way->earlier.load, &way->at->load, 1.0 + ahead);
  LamContact *contact = rve->contact;
  PetscInt negative;
  PetscBool ok;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (way->reached <= way->before || rve->work.stopped) PetscFunctionReturn(0);
  PetscCall(LamContactRestore(rve, way->at));
  for (PetscInt i = 0; i < rve->length; ++i) rve->y[i] += ahead * (way->at->y[i] - way->earlier.y[i]);
  for (PetscInt h = 0; h < contact->count; ++h)
    contact->lambda[h] += ahead * (way->at->lambda[h] - way->earlier.lambda[h]);
  PetscCall(LamContactEvaluate(rve, &load, rve->y, PETSC_TRUE));
  (void)LamContactFindActive(contact, 0.0);
  PetscCall(LamFactorConsistent(rve, &load, &negative, &ok));
  *found = (PetscBool)(ok && negative > 0);
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  ahead, at %.10g: %d negative eigenvalues\n",
                           (double)(way->reached + ahead * (way->reached - way->before)), (int)negative));
  PetscFunctionReturn(0);
}

/* The state a share t of the way, from the last one; *out is what became of it. */
static PetscErrorCode TryAt(LamRVE rve, const LamLoad *start, const LamLoad *load, PetscReal t, const Way *way,
                            LamLoad *next, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  *next = t >= 1.0 ? *load : LamLoadBetween(start, load, t);
  PetscCall(LamContactStartNear(rve, way->at, next));
  PetscCall(LamContactTry(rve, next, LAM_NEAR_REACH, out));
  PetscFunctionReturn(0);
}

/* Halves the bracket a few times, until what ends the way is known. */
static PetscErrorCode Halve(LamRVE rve, const LamLoad *start, const LamLoad *load, Way *way, LamContactOutcome *out,
                            PetscBool *advanced)
{
  PetscFunctionBeginUser;
  *advanced = PETSC_FALSE;
  for (PetscInt k = 0; k < HALVINGS && out->refusal == LAM_NOT_REFUSED && LamMayIterate(rve); ++k) {
    const PetscReal t = 0.5 * (way->reached + way->failed);
    LamContactOutcome tried;
    LamLoad next;

    PetscCall(TryAt(rve, start, load, t, way, &next, &tried));
    if (!LamContactIsStable(&tried)) {
      out->refusal = tried.refusal;
      out->depth = tried.depth;
      PetscCall(PetscArraycpy(out->cell, tried.cell, 2));
      way->failed = t;
    } else if (*advanced) {
      PetscCall(LamContactSave(rve, &next, way->at));
      way->reached = t;
    } else {
      PetscCall(Advance(rve, &next, t, way));
      *advanced = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(0);
}

/* Whether the end of the bracket is reached from what is left of it: the steps were too long. */
static PetscErrorCode CrossBracket(LamRVE rve, const LamLoad *start, const LamLoad *load, Way *way, PetscBool *crossed)
{
  const PetscReal t = way->failed, left = way->failed - way->reached;
  LamContactOutcome tried;
  LamLoad next;

  PetscFunctionBeginUser;
  *crossed = PETSC_FALSE;
  if (!LamMayIterate(rve)) PetscFunctionReturn(0);
  PetscCall(TryAt(rve, start, load, t, way, &next, &tried));
  *crossed = LamContactIsStable(&tried);
  if (!*crossed) PetscFunctionReturn(0);
  PetscCall(Advance(rve, &next, t, way));
  way->depth = tried.depth;
  way->step = GROWTH * left;
  way->least = left;
  PetscFunctionReturn(0);
}

/*
  Halves the bracket of a way that ends in nothing known, until the states next to it tell: an eigenvalue that falls
  steeply does so close to its end. The states compared are those from which a stage starts and in which it ends.
*/
static PetscErrorCode Refine(LamRVE rve, const LamLoad *start, const LamLoad *load, Way *way, LamContactOutcome *out,
                             PetscBool *crossed)
{
  PetscBool advanced = PETSC_TRUE, jumps = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt stage = 0; stage <= STAGES && advanced; ++stage) {
    const PetscReal failed = way->failed;

    PetscCall(FindCrossing(rve, way, out));
    if (out->refusal != LAM_NOT_REFUSED) break;
    PetscCall(Halve(rve, start, load, way, out, &advanced));
    if (out->refusal == LAM_NOT_REFUSED && way->failed == failed)
      PetscCall(CrossBracket(rve, start, load, way, crossed));
    if (*crossed) PetscFunctionReturn(0);
  }
  if (out->refusal == LAM_NOT_REFUSED) PetscCall(FindJump(rve, way, &jumps));
  if (jumps) out->refusal = LAM_JUMP;
  out->between[0] = way->reached;
  out->between[1] = way->failed;
  PetscFunctionReturn(0);
}

/* What has ended the way, with its bracket; or it has crossed it and goes on. A solution at another load than the one
   asked for is no outcome. */
static PetscErrorCode End(LamRVE rve, const LamLoad *start, const LamLoad *load, Way *way, LamContactOutcome *out,
                          PetscBool *goes_on)
{
  const PetscBool out_of_work = (PetscBool)!LamMayIterate(rve), stable = LamContactIsStable(out);

  PetscFunctionBeginUser;
  out->between[0] = way->reached;
  out->between[1] = way->failed;
  if (out->refusal == LAM_WALLS_OVERLAP && out->depth > JUMP * way->depth) out->refusal = LAM_WALLS_PASSED;
  if (out->converged && (stable || way->failed < 1.0)) {
    if (!stable) out->refusal = LAM_SADDLE;
    out->converged = PETSC_FALSE;
  }
  if (!out->converged && out->refusal == LAM_NOT_REFUSED && !out_of_work && !LamIsKinking(&way->kinking))
    PetscCall(Refine(rve, start, load, way, out, goes_on));
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "  walk: %.10g to %.10g, refusal %d, negative %d, converged %d, depth %.2g after %.2g%s\n",
                           (double)way->reached, (double)way->failed, (int)out->refusal, (int)out->negative,
                           (int)out->converged, (double)out->depth, (double)way->depth, *goes_on ? ", goes on" : ""));
  PetscFunctionReturn(0);
}

/* As far as steps of the smallest length lead. */
static PetscErrorCode Go(LamRVE rve, const LamLoad *start, const LamLoad *load, Way *way, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  while (way->reached < 1.0 && LamMayIterate(rve)) {
    const PetscReal least = LamIsKinking(&way->kinking) ? LAM_KINKED_SUBSTEP : way->least;
    const PetscReal t = PetscMin(1.0, way->reached + PetscMax(way->step, least));
    const PetscBool last = (PetscBool)(way->step < least);
    LamLoad next = t >= 1.0 ? *load : LamLoadBetween(start, load, t);

    if (last) {
      if (out->refusal != LAM_NOT_REFUSED || way->snaps++ >= MAX_SNAPS) break;
      PetscCall(Snap(rve, way->at, &next, out));
    } else {
      PetscCall(TryAt(rve, start, load, t, way, &next, out));
    }
    if (LamContactIsStable(out)) {
      PetscCall(Advance(rve, &next, t, way));
      LamWatchKinks(rve, &next, way->at->y, t, &way->kinking);
      way->branch += out->branch + last;
      way->depth = out->depth;
      way->step = last ? 4.0 * least : GROWTH * way->step;
    } else {
      way->failed = t;
      if (last) break;
      way->step *= 0.5;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactWalk(LamRVE rve, LamContactSolution *at, const LamLoad *load, LamContactOutcome *out)
{
  const LamLoad start = at->load;
  Way way = {.at = at, .failed = 1.0, .step = FIRST_STEP, .least = MIN_STEP, .kinking = LAM_NO_KINKING};
  PetscBool goes_on = PETSC_TRUE;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  PetscCall(LamContactSolutionCreate(rve, &way.earlier));
  LamWatchKinks(rve, &start, at->y, 0.0, &way.kinking);
  while (goes_on) {
    goes_on = PETSC_FALSE;
    PetscCall(Go(rve, &start, load, &way, out));
    if (way.reached < 1.0) PetscCall(End(rve, &start, load, &way, out, &goes_on));
  }
  out->branch = way.branch;
  out->kinking = way.kinking;
  PetscCall(LamContactSolutionDestroy(&way.earlier));
  PetscFunctionReturn(0);
}
