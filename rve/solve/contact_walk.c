/*
  Continuation of contact states along a straight load path.

  Method. Each solution, moved affinely, is the initial guess of the next. A failed step is halved; after a success the
  next step is longer. If the smallest step fails without a known reason, the tissue may snap: descent searches for the
  stable state beyond, from which continuation resumes. The end of the path is bracketed by the last stable state and
  the next one, in which walls meet without contact in the model, facing walls have slid past each other, a lumen is
  closed, or nothing stable is found. In the last case the bracket is halved until the states at its edge give the
  reason: an eigenvalue crosses zero, or jumps below it. If the whole bracket can be traversed in smaller steps,
  continuation resumes with these. If walls kink on the path, no mesh resolves its end.
*/
#include "contact_path.h"

#define FIRST_STEP 0.25
#define MIN_STEP (1.0 / 512.0)
#define GROWTH 2.0
#define MAX_SNAPS 4
#define CROSSING_MARGIN 4.0 /* bracket widths by which states are extrapolated to find why a path ends */
#define STAGES 4            /* after the first, in which a bracket without a known reason is halved ... */
#define HALVINGS 4          /* ... this many times each */
#define JUMP 2.0 /* ratio of overlap depths of successive states above which walls have slid past each other */

/* Load path with its last two stable states. */
typedef struct {
  const LamLoad *start, *load;
  LamLoad next; /* of the last step tried */
  LamRVEState at, earlier;
  PetscReal reached, before; /* path parameters of at and earlier */
  PetscReal failed;          /* path parameter of the next state that is not stable */
  PetscReal depth;           /* overlap of walls at `at`, apothems */
  PetscReal step, least;     /* next step, smallest step */
  PetscInt snaps, branch;
  LamKinking kinking;
} Way;

static PetscErrorCode LowestEigenvalue(LamRVE rve, LamRVEState solution, PetscReal *eigenvalue)
{
  PetscInt negative;
  PetscReal *mode;
  PetscBool ok;

  PetscFunctionBeginUser;
  *eigenvalue = NAN;
  PetscCall(LamTakeState(rve, solution));
  PetscCall(LamFactorConsistent(rve, &solution->load, &negative, &ok));
  if (!ok) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(rve->linear->n, &mode));
  PetscCall(LamSoftestMode(rve, eigenvalue, mode));
  PetscCall(PetscFree(mode));
  PetscFunctionReturn(0);
}

/*
  Whether the last stable state is unstable without the contact about to open, in which case an eigenvalue jumps below
  zero. Contact is about to open if its multiplier, extrapolated from the last two states, vanishes.
*/
static PetscErrorCode FindLoosening(LamRVE rve, const Way *way, LamContactOutcome *out)
{
  const PetscReal ahead = CROSSING_MARGIN * (way->failed - way->reached) / (way->reached - way->before);
  LamContact *contact = rve->contact;
  PetscInt count = 0, negative;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LamTakeState(rve, way->at));
  for (PetscInt h = 0; h < contact->count; ++h) {
    const PetscReal now = way->at->lambda[h];

    if (!contact->active[h] || now + ahead * (now - way->earlier->lambda[h]) > 0.0) continue;
    contact->active[h] = PETSC_FALSE;
    contact->lambda[h] = 0.0;
    ++count;
  }
  if (count == 0) PetscFunctionReturn(0);
  PetscCall(LamFactorConsistent(rve, &way->at->load, &negative, &ok));
  if (ok && negative > 0) out->refusal = LAM_LOOSENING;
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  %d hats about to open: %d negative eigenvalues without\n",
                           (int)count, (int)negative));
  PetscFunctionReturn(0);
}

/*
  Whether the stable states end where an eigenvalue crosses zero. Near a limit load it falls as the square root of the
  remaining load, so its square, extrapolated linearly from the last two states, vanishes in the bracket or soon
  after it.
*/
static PetscErrorCode FindCrossing(LamRVE rve, const Way *way, LamContactOutcome *out)
{
  PetscReal before, fall;

  PetscFunctionBeginUser;
  if (way->reached <= way->before || rve->work.stopped) PetscFunctionReturn(0);
  PetscCall(LowestEigenvalue(rve, way->earlier, &before));
  PetscCall(LowestEigenvalue(rve, way->at, &out->eigenvalue));
  fall = PetscSqr(before) - PetscSqr(out->eigenvalue);
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  eigenvalue %g at %g, %g at %g\n", (double)before,
                           (double)way->before, (double)out->eigenvalue, (double)way->reached));
  if (fall > 0.0 &&
      PetscSqr(out->eigenvalue) * (way->reached - way->before) <= CROSSING_MARGIN * (way->failed - way->reached) * fall)
    out->refusal = LAM_CROSSING;
  else
    PetscCall(FindLoosening(rve, way, out));
  PetscFunctionReturn(0);
}

/* Makes the state just found, at path parameter t, the last stable one. */
static PetscErrorCode Advance(LamRVE rve, PetscReal t, Way *way)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(way->at, way->earlier));
  LamKeepState(rve, &way->next, 0, way->at);
  way->before = way->reached;
  way->reached = t;
  PetscFunctionReturn(0);
}

/*
  Whether the state extrapolated from the last two, CROSSING_MARGIN brackets ahead, has a negative eigenvalue although
  theirs are positive. The stiffness jumps if an end of a face's overlap passes a node or a hat is merged.
*/
static PetscErrorCode FindJump(LamRVE rve, const Way *way, LamContactOutcome *out)
{
  const PetscReal ahead = CROSSING_MARGIN * (way->failed - way->reached) / (way->reached - way->before);
  const LamLoad load = LamLoadBetween(&way->earlier->load, &way->at->load, 1.0 + ahead);
  LamContact *contact = rve->contact;
  PetscInt negative;
  PetscBool ok;

  PetscFunctionBeginUser;
  if (way->reached <= way->before || rve->work.stopped) PetscFunctionReturn(0);
  PetscCall(LamTakeState(rve, way->at));
  for (PetscInt i = 0; i < rve->length; ++i) rve->y[i] += ahead * (way->at->y[i] - way->earlier->y[i]);
  for (PetscInt h = 0; h < contact->count; ++h)
    contact->lambda[h] += ahead * (way->at->lambda[h] - way->earlier->lambda[h]);
  PetscCall(LamContactEvaluate(rve, &load, rve->y, PETSC_TRUE));
  (void)LamContactFindActive(contact, 0.0);
  PetscCall(LamFactorConsistent(rve, &load, &negative, &ok));
  if (ok && negative > 0) out->refusal = LAM_JUMP;
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  ahead, at %.10g: %d negative eigenvalues\n",
                           (double)(way->reached + ahead * (way->reached - way->before)), (int)negative));
  PetscFunctionReturn(0);
}

/* Solves at path parameter t, starting from the last stable state. */
static PetscErrorCode TryAt(LamRVE rve, Way *way, PetscReal t, PetscReal reach, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  way->next = t >= 1.0 ? *way->load : LamLoadBetween(way->start, way->load, t);
  PetscCall(LamContactTryFrom(rve, way->at, &way->next, reach, out));
  PetscFunctionReturn(0);
}

/* Halves the bracket up to HALVINGS times, until the reason for the path's end is known. */
static PetscErrorCode Halve(LamRVE rve, Way *way, LamContactOutcome *out, PetscBool *advanced)
{
  PetscFunctionBeginUser;
  *advanced = PETSC_FALSE;
  for (PetscInt k = 0; k < HALVINGS && out->refusal == LAM_NOT_REFUSED && LamMayIterate(rve); ++k) {
    const PetscReal t = 0.5 * (way->reached + way->failed);
    LamContactOutcome tried;

    PetscCall(TryAt(rve, way, t, LAM_NEAR_REACH, &tried));
    if (!LamContactIsStable(&tried)) {
      out->refusal = tried.refusal;
      out->depth = tried.depth;
      PetscCall(PetscArraycpy(out->cell, tried.cell, 2));
      way->failed = t;
    } else if (*advanced) {
      LamKeepState(rve, &way->next, 0, way->at);
      way->reached = t;
    } else {
      PetscCall(Advance(rve, t, way));
      *advanced = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(0);
}

/* Whether the end of the bracket is reached in one step from its start: previous steps were then too long. */
static PetscErrorCode CrossBracket(LamRVE rve, Way *way, PetscBool *crossed)
{
  const PetscReal t = way->failed, left = way->failed - way->reached;
  LamContactOutcome tried;

  PetscFunctionBeginUser;
  *crossed = PETSC_FALSE;
  if (!LamMayIterate(rve)) PetscFunctionReturn(0);
  PetscCall(TryAt(rve, way, t, LAM_NEAR_REACH, &tried));
  *crossed = LamContactIsStable(&tried);
  if (!*crossed) PetscFunctionReturn(0);
  PetscCall(Advance(rve, t, way));
  way->depth = tried.depth;
  way->step = GROWTH * left;
  way->least = left;
  PetscFunctionReturn(0);
}

/*
  Halves the bracket of a path that ends without a known reason, until the states at its edge give it: an eigenvalue may
  fall steeply only close to the end. The states compared are those at the start and the end of a stage.
*/
static PetscErrorCode Refine(LamRVE rve, Way *way, LamContactOutcome *out, PetscBool *crossed)
{
  PetscBool advanced = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt stage = 0; stage <= STAGES && advanced; ++stage) {
    const PetscReal failed = way->failed;

    PetscCall(FindCrossing(rve, way, out));
    if (out->refusal != LAM_NOT_REFUSED) break;
    PetscCall(Halve(rve, way, out, &advanced));
    if (out->refusal == LAM_NOT_REFUSED && way->failed == failed) PetscCall(CrossBracket(rve, way, crossed));
    if (*crossed) PetscFunctionReturn(0);
  }
  if (out->refusal == LAM_NOT_REFUSED) PetscCall(FindJump(rve, way, out));
  out->between[0] = way->reached;
  out->between[1] = way->failed;
  PetscFunctionReturn(0);
}

/* Determines the reason and the bracket of the path's end, or *goes_on: the bracket has been crossed. A solution at a
   load other than the prescribed one is no outcome. */
static PetscErrorCode End(LamRVE rve, Way *way, LamContactOutcome *out, PetscBool *goes_on)
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
    PetscCall(Refine(rve, way, out, goes_on));
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "  walk: %.10g to %.10g, refusal %d, negative %d, converged %d, depth %.2g after %.2g%s\n",
                           (double)way->reached, (double)way->failed, (int)out->refusal, (int)out->negative,
                           (int)out->converged, (double)out->depth, (double)way->depth, *goes_on ? ", goes on" : ""));
  PetscFunctionReturn(0);
}

/* Continuation until the load is reached or the smallest step fails. */
static PetscErrorCode Go(LamRVE rve, Way *way, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  while (way->reached < 1.0 && LamMayIterate(rve)) {
    const PetscReal least = LamIsKinking(&way->kinking) ? LAM_KINKED_SUBSTEP : way->least;
    const PetscReal t = PetscMin(1.0, way->reached + PetscMax(way->step, least));
    const PetscBool last = (PetscBool)(way->step < least);

    if (last && (out->refusal != LAM_NOT_REFUSED || way->snaps++ >= MAX_SNAPS)) break;
    PetscCall(TryAt(rve, way, t, last ? LAM_DESCENT : LAM_NEAR_REACH, out));
    if (LamContactIsStable(out)) {
      PetscCall(Advance(rve, t, way));
      LamWatchKinks(rve, &way->next, way->at->y, t, &way->kinking);
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

PetscErrorCode LamContactWalk(LamRVE rve, LamRVEState at, const LamLoad *load, LamContactOutcome *out)
{
  const LamLoad start = at->load;
  Way way = {.start = &start,
             .load = load,
             .at = at,
             .failed = 1.0,
             .step = FIRST_STEP,
             .least = MIN_STEP,
             .kinking = LAM_NO_KINKING};
  PetscBool goes_on = PETSC_TRUE;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  PetscCall(LamRVEStateCreate(rve, &way.earlier));
  LamWatchKinks(rve, &start, at->y, 0.0, &way.kinking);
  while (goes_on) {
    goes_on = PETSC_FALSE;
    PetscCall(Go(rve, &way, out));
    if (way.reached < 1.0) PetscCall(End(rve, &way, out, &goes_on));
  }
  out->branch = way.branch;
  out->kinking = way.kinking;
  PetscCall(LamRVEStateDestroy(&way.earlier));
  PetscFunctionReturn(0);
}
