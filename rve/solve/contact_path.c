/*
  Contact equilibrium at a new load, starting from a known state.

  Method. Initial guesses are tried in this order until one leads to a stable equilibrium:
    (i)   near state: the previous contact state with its multipliers, rotated and moved affinely; in one step or, if
          that fails, in substeps, which stay on the branch while it exists;
    (ii)  the strategy's initial guess: two_step solves the bonded tissue at the load and releases it, the tractions of
          bonding being the initial multipliers; one_step starts from the affine state;
    (iii) continuation in cohesion: contact with a larger cohesion is easy to find; the cohesion is then lowered to the
          prescribed one, each solution being the initial guess of the next;
    (iv)  continuation from rest: the undeformed (rotated) tissue under the load's turgor and cohesion, with added
          cohesion first if needed, then F in substeps (contact_walk.c);
    (v)   substeps in load from a previous contact state that is not near;
    (vi)  two_step, if one_step has failed.
  If a continuation fails without a known reason, descent from its last solution follows. A saddle is returned only if
  no stable state is found.

  Mihai, Safar & Wyatt, J. Eng. Math. (successive deformation decomposition) for (ii); docs/theory/homogenisation.md,
  Effective-stress principle, for (iii).
*/
#include "contact_path.h"
#include <string.h>

#define NEAR 0.04          /* largest change of F, turgor (C1 + C2) and cohesion (C1 + C2) that counts as near */
#define TIGHT 0.5          /* added cohesion in (iii) and (iv), C1 + C2 */
#define SLACK 1e-3         /* first share of turgor and cohesion if the full load fails at rest, ... */
#define LEAST_SLACK 1e-7   /* ... the smallest share tried, ... */
#define SLACK_FACTOR 10.0  /* ... and the factor between shares */
#define LOOSE 1e-3         /* of TIGHT: an added cohesion below this is removed at once */
#define LEAST_EASE 0.85    /* largest factor; beyond it, descent */
#define EASE 0.25          /* first factor on the added cohesion; its square root after a failure */
#define BORNE 0.5          /* turgor, C1 + C2, up to which the affine state is a good initial guess */
#define MUCH_TURGOR 1.5    /* turgor, C1 + C2, above which continuation goes from unstretched tissue instead */
#define START_BUDGET 800   /* iterations until (iv) begins; the rest is reserved for it, as it finds why a path ends */
#define RELEASE_REACH 0.1  /* apothems: a larger step ends a release, and a smaller share is tried */
#define LEAST_RELEASE 0.06 /* smallest share released in one step; below it, descent */

/* Step one of two_step: solves the bonded tissue at `load` from a copy of `state`. *ok: an equilibrium was found. */
static PetscErrorCode SolveBonded(LamRVE rve, const LamLoad *load, LamRVEState state, PetscBool *ok)
{
  LamResponse response;

  PetscFunctionBeginUser;
  rve->bonded->budget = rve->budget;
  PetscCall(LamRVEStateCopy(state, rve->bonded_state));
  PetscCall(LamRVESolve(rve->bonded, load, rve->bonded_state, &response));
  LamAddWork(rve, &response);
  *ok = LamResponseHasFields(&response);
  PetscFunctionReturn(0);
}

/* One release step to rve->contact->share; share 0 is equilibrium at the load. */
static PetscErrorCode ReleaseTo(LamRVE rve, const LamLoad *load, LamContactOutcome *out, PetscBool *reached)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  if (rve->contact->share == 0.0) {
    PetscCall(LamContactTry(rve, load, RELEASE_REACH, out));
    *reached = out->converged;
  } else {
    PetscCall(LamContactNewton(rve, load, NULL, RELEASE_REACH, &outcome));
    *reached = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
  }
  PetscFunctionReturn(0);
}

/*
  Step two of two_step: releases the interface. The bonding forces that contact does not carry are removed at once if
  the step is short, otherwise in shares, so that each Newton iteration starts near its solution and takes full steps.
  If small shares fail too, descent follows.
*/
static PetscErrorCode Release(LamRVE rve, const LamLoad *load, LamRVEState at, LamContactOutcome *out)
{
  PetscReal share = 1.0, step = 1.0;
  PetscBool ok;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  PetscCall(LamContactStartBonded(rve, load, &ok));
  if (!ok) PetscFunctionReturn(0);
  LamKeepState(rve, load, 0, at);
  while (share > 0.0 && LamMayIterate(rve)) {
    const PetscInt iterations = rve->work.iterations;
    PetscBool reached = PETSC_FALSE;

    rve->contact->share = PetscMax(0.0, share - step);
    PetscCall(ReleaseTo(rve, load, out, &reached));
    if (reached) {
      share = rve->contact->share;
      LamKeepState(rve, load, 0, at);
      step *= 2.0;
      continue;
    }
    /* stopped at its first step: scale the release by the length of that step */
    step *= rve->work.iterations == iterations
                ? PetscMax(0.1, PetscMin(0.5, 0.6 * RELEASE_REACH / rve->contact->largest_step))
                : 0.5;
    LamContactStartNear(rve, at, load);
    if (step < LEAST_RELEASE) break;
  }
  rve->contact->share = 0.0;
  if (share > 0.0) PetscCall(LamContactTry(rve, load, LAM_DESCENT, out));
  PetscFunctionReturn(0);
}

/* Continuation from a solution to `load`; if it fails without a known reason, descent. */
static PetscErrorCode Substeps(LamRVE rve, LamRVEState at, const LamLoad *load, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  PetscCall(LamContactWalk(rve, at, load, out));
  if (!LamContactIsStable(out) && out->refusal == LAM_NOT_REFUSED)
    PetscCall(LamContactTryFrom(rve, at, load, LAM_DESCENT, out));
  PetscFunctionReturn(0);
}

/* Continuation in cohesion, from a stable solution with a larger one down to `load`; otherwise no outcome. */
static PetscErrorCode Loosen(LamRVE rve, const LamLoad *load, LamRVEState at, LamContactOutcome *out)
{
  PetscReal added = at->load.cohesion - load->cohesion, factor = EASE;
  LamLoad next = *load;

  PetscFunctionBeginUser;
  if (!LamContactIsStable(out)) {
    *out = LAM_NO_OUTCOME;
    PetscFunctionReturn(0);
  }
  while (added > 0.0 && LamMayIterate(rve) && factor <= LEAST_EASE) {
    const PetscReal less = added * factor < LOOSE * TIGHT ? 0.0 : added * factor;

    next.cohesion = load->cohesion + less;
    PetscCall(LamContactTryFrom(rve, at, &next, LAM_NEAR_REACH, out));
    if (LamContactIsStable(out)) {
      LamKeepState(rve, &next, 0, at);
      added = less;
    } else {
      factor = PetscSqrtReal(factor);
    }
  }
  if (added > 0.0) PetscCall(LamContactTryFrom(rve, at, load, LAM_DESCENT, out));
  PetscFunctionReturn(0);
}

/* Solves from the affine state; `at` := the result. */
static PetscErrorCode TryFar(LamRVE rve, const LamLoad *load, LamRVEState at, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  LamContactStartAffine(rve, load);
  PetscCall(LamContactTry(rve, load, LAM_FAR, out));
  LamKeepState(rve, load, 0, at);
  PetscFunctionReturn(0);
}

/* (iii): solves with an added cohesion at the prescribed F, from the bonded or affine state, then lowers it. */
static PetscErrorCode TightThenLoose(LamRVE rve, const LamLoad *load, PetscBool has_bonded, LamRVEState at,
                                     LamContactOutcome *out)
{
  LamLoad tight = *load;

  PetscFunctionBeginUser;
  tight.cohesion = load->cohesion + TIGHT;
  if (has_bonded)
    PetscCall(Release(rve, &tight, at, out));
  else
    PetscCall(TryFar(rve, &tight, at, out));
  LamKeepState(rve, &tight, 0, at);
  PetscCall(Loosen(rve, load, at, out));
  PetscFunctionReturn(0);
}

/* The load with only the rotation of F, scaled so that undeformed cells with a clearance touch. */
static LamLoad Unstretched(LamRVE rve, const LamLoad *load)
{
  const PetscReal angle = LamRotationAngle(load->F), near = rve->micro.is_patch ? 1.0 : rve->mesh.apothem;
  LamLoad start = *load;

  start.F[0] = start.F[4] = near * PetscCosReal(angle);
  start.F[3] = near * PetscSinReal(angle);
  start.F[1] = -start.F[3];
  start.F[8] = 1.0;
  return start;
}

/* The load with turgor and cohesion multiplied by `share`. */
static LamLoad Slack(const LamLoad *load, PetscReal share)
{
  LamLoad slack = *load;

  slack.turgor *= share;
  slack.cohesion *= share;
  return slack;
}

/*
  Continuation of undeformed tissue in turgor and cohesion, from the largest share of them that can be solved. If cells
  differ, thin walls carry almost no load until they bulge and are taut.
*/
static PetscErrorCode WalkInTurgor(LamRVE rve, const LamLoad *rest, LamRVEState at, LamContactOutcome *out)
{
  PetscReal share = SLACK * SLACK_FACTOR;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  while (!LamContactIsStable(out) && share > LEAST_SLACK && LamMayIterate(rve)) {
    LamLoad slack;

    share /= SLACK_FACTOR;
    slack = Slack(rest, share);
    PetscCall(TryFar(rve, &slack, at, out));
  }
  if (!LamContactIsStable(out)) *out = LAM_NO_OUTCOME;
  while (LamContactIsStable(out) && share < 1.0) {
    const PetscReal next = PetscMin(1.0, SLACK_FACTOR * share);
    const LamLoad load = next < 1.0 ? Slack(rest, next) : *rest;

    PetscCall(LamContactWalk(rve, at, &load, out));
    for (PetscInt k = 0; k < 2; ++k) out->between[k] = share + (next - share) * out->between[k];
    share = next;
  }
  if (!LamContactIsStable(out)) out->converged = PETSC_FALSE;
  out->way = LAM_WAY_OF_TURGOR;
  PetscFunctionReturn(0);
}

/*
  (iv): continuation to the prescribed F from the undeformed (rotated) tissue under the load's turgor and cohesion. If
  that state is not found, it is solved with an added cohesion first; if that fails too, turgor and cohesion rise in
  steps.
*/
static PetscErrorCode WalkFromRest(LamRVE rve, const LamLoad *load, LamRVEState at, LamContactOutcome *out)
{
  const LamLoad rest = Unstretched(rve, load);

  PetscFunctionBeginUser;
  PetscCall(TryFar(rve, &rest, at, out));
  if (!LamContactIsStable(out)) PetscCall(TightThenLoose(rve, &rest, PETSC_FALSE, at, out));
  if (!LamContactIsStable(out)) {
    PetscCall(WalkInTurgor(rve, &rest, at, out));
    if (!LamContactIsStable(out)) PetscFunctionReturn(0);
  }
  PetscCall(LamContactWalk(rve, at, load, out));
  out->way = LAM_WAY_FROM_REST;
  PetscFunctionReturn(0);
}

PetscBool LamContactIsNear(const LamLoad *from, const LamLoad *load)
{
  PetscReal largest =
      PetscMax(PetscAbsReal(from->turgor - load->turgor), PetscAbsReal(from->cohesion - load->cohesion));

  for (PetscInt i = 0; i < 9; ++i) largest = PetscMax(largest, PetscAbsReal(from->F[i] - load->F[i]));
  return (PetscBool)(largest <= NEAR);
}

/*
  Solves from the affine state. Its unstressed walls carry little turgor once they are sheared. A turgor above BORNE is
  therefore raised by continuation from BORNE; above MUCH_TURGOR, continuation starts from unstretched tissue.
*/
static PetscErrorCode TryAffine(LamRVE rve, const LamLoad *load, LamRVEState at, LamContactOutcome *out)
{
  const PetscBool bears = (PetscBool)(load->turgor <= BORNE);
  LamLoad start = load->turgor <= MUCH_TURGOR ? *load : Unstretched(rve, load);

  PetscFunctionBeginUser;
  if (load->turgor <= MUCH_TURGOR) start.turgor = PetscMin(load->turgor, BORNE);
  PetscCall(TryFar(rve, &start, at, out));
  if (bears) PetscFunctionReturn(0);
  if (!LamContactIsStable(out)) {
    *out = LAM_NO_OUTCOME; /* this outcome is of another load */
    PetscFunctionReturn(0);
  }
  PetscCall(Substeps(rve, at, load, out));
  PetscFunctionReturn(0);
}

/* (ii): the strategy's initial guess. */
static PetscErrorCode TryStrategy(LamRVE rve, LamStrategy strategy, const LamLoad *load, LamRVEState state,
                                  PetscBool *has_bonded, LamRVEState at, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  if (strategy == LAM_TWO_STEP) PetscCall(SolveBonded(rve, load, state->bonded, has_bonded));
  if (*has_bonded)
    PetscCall(Release(rve, load, at, out));
  else
    PetscCall(TryAffine(rve, load, at, out));
  PetscFunctionReturn(0);
}

/* Whether an outcome is a property of the tissue: its reason is bracketed by two states of a path. Other rejections may
   be due to the path. */
static PetscBool IsCertain(const LamContactOutcome *out)
{
  return (PetscBool)(out->between[1] > out->between[0] &&
                     (out->refusal >= LAM_CELLS_OVERLAP || LamIsKinking(&out->kinking)));
}

/* Kept from attempts without a stable state: the first saddle, the last rejection (or the first certain one). */
typedef struct {
  LamContactOutcome saddle, refused;
  LamRVEState at;
  PetscReal eigenvalue; /* of the saddle */
} SecondBest;

static void Remember(LamRVE rve, const LamLoad *load, const LamContactOutcome *out, SecondBest *best)
{
  if (!IsCertain(&best->refused) && (IsCertain(out) || out->refusal != LAM_NOT_REFUSED)) best->refused = *out;
  if (best->saddle.converged || !out->converged || out->negative <= 0) return;
  LamKeepState(rve, load, 0, best->at);
  best->saddle = *out;
  best->eigenvalue = rve->lowest_eigenvalue;
}

static PetscErrorCode GiveSecondBest(LamRVE rve, const LamLoad *load, const SecondBest *best, LamContactOutcome *out)
{
  PetscInt negative;

  PetscFunctionBeginUser;
  *out = best->refused;
  if (!best->saddle.converged) PetscFunctionReturn(0);
  *out = best->saddle;
  PetscCall(LamTakeState(rve, best->at));
  PetscCall(LamFactorConsistent(rve, load, &negative, &out->converged));
  rve->lowest_eigenvalue = best->eigenvalue;
  PetscFunctionReturn(0);
}

static PetscErrorCode TryAll(LamRVE rve, const LamLoad *load, LamRVEState state, LamRVEState before,
                             LamContactOutcome *out)
{
  const PetscBool near = (PetscBool)(state->solved && LamContactIsNear(&before->load, load));
  PetscBool has_bonded = PETSC_FALSE;
  LamRVEState at;
  SecondBest best = {.refused = LAM_NO_OUTCOME, .eigenvalue = NAN};

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &at));
  PetscCall(LamRVEStateCreate(rve, &best.at));
  *out = LAM_NO_OUTCOME;
  for (PetscInt k = near ? 0 : 1; k < 7 && !LamContactIsStable(out) && !rve->work.stopped; ++k) {
    Remember(rve, load, out, &best);
    if (k > 3 && !state->solved && IsCertain(&best.refused)) break; /* the path from rest has a certain end */
    *out = LAM_NO_OUTCOME;
    rve->budget = k < 3 ? START_BUDGET : LAM_ITERATION_BUDGET;
    if (k == 0) {
      PetscCall(LamContactTryFrom(rve, before, load, LAM_NEAR_REACH, out));
      if (!LamContactIsStable(out)) PetscCall(Substeps(rve, before, load, out));
    }
    if (k == 1) PetscCall(TryStrategy(rve, rve->strategy, load, state, &has_bonded, at, out));
    if (k == 2) PetscCall(TightThenLoose(rve, load, has_bonded, at, out));
    if (k == 3) PetscCall(WalkFromRest(rve, load, at, out));
    if (k == 4 && state->solved && !near) PetscCall(Substeps(rve, before, load, out));
    if (k == 5 && rve->strategy == LAM_ONE_STEP)
      PetscCall(TryStrategy(rve, LAM_TWO_STEP, load, state, &has_bonded, at, out));
    if (k == 6 && rve->strategy == LAM_ONE_STEP) PetscCall(TightThenLoose(rve, load, has_bonded, at, out));
    LamContactSettle(out);
  }
  rve->budget = LAM_ITERATION_BUDGET;
  if (!LamContactIsStable(out)) {
    Remember(rve, load, out, &best);
    PetscCall(GiveSecondBest(rve, load, &best, out));
  }
  if (out->converged && has_bonded) PetscCall(LamRVEStateCopy(rve->bonded_state, state->bonded));
  PetscCall(LamRVEStateDestroy(&at));
  PetscCall(LamRVEStateDestroy(&best.at));
  PetscFunctionReturn(0);
}

/* Names the path that a bracket belongs to. */
static const char *WayText(const LamContactOutcome *out)
{
  if (!(out->between[1] > out->between[0]) || out->converged) return "";
  if (out->way == LAM_WAY_FROM_REST) return "; from rest";
  if (out->way == LAM_WAY_OF_TURGOR) return "; turgor at rest";
  return "";
}

/* What happens at the end of a path, with the two cells and the depth, and why that is the end. */
static const struct {
  const char *what, *why;
} refusals[] = {
    [LAM_WALLS_OVERLAP] = {"facing walls of cells %d and %d lie %.3g apothems in each other",
                           "the mesh along the faces is too coarse"},
    [LAM_CELLS_OVERLAP] = {"a wall of cell %d meets one of cell %d that it does not face",
                           "cells that change their neighbours are not modelled"},
    [LAM_WALLS_PASSED] = {"facing walls of cells %d and %d slide past each other",
                          "cells that change their neighbours are not modelled"},
    [LAM_SADDLE] = {"stable states end", "beyond, only a saddle was found, with %d negative eigenvalues"},
    [LAM_CROSSING] = {"stable states end", "their lowest eigenvalue, %.3g (C1+C2) before, crosses zero there"},
    [LAM_LOOSENING] = {"stable states end", "as walls open there, an eigenvalue jumps below zero"},
    [LAM_JUMP] = {"stable states end", "the end of a contact passes a node there, and an eigenvalue jumps below zero"},
};

PetscErrorCode LamContactRefuse(LamRVE rve, const LamContactOutcome *out, LamResponse *response)
{
  const LamStatus status = IsCertain(out) ? LAM_NO_EQUILIBRIUM : LAM_NOT_CONVERGED;
  char place[80], what[96], why[96];
  size_t used;

  PetscFunctionBeginUser;
  if (out->converged) {
    PetscCall(LamRefuseSaddle(rve, out->negative, response));
  } else if (out->refusal == LAM_LUMEN_COLLAPSED) {
    PetscCall(LamRefuseCollapse(out->cell[0], out->between, status, response));
  } else if (out->refusal != LAM_NOT_REFUSED) {
    const char *format = refusals[out->refusal].why;

    LamBracketText(out->between, place, sizeof(place));
    (void)snprintf(what, sizeof(what), refusals[out->refusal].what, (int)out->cell[0], (int)out->cell[1],
                   (double)out->depth);
    if (out->refusal == LAM_CROSSING)
      (void)snprintf(why, sizeof(why), format, (double)out->eigenvalue);
    else
      (void)snprintf(why, sizeof(why), format, (int)out->negative);
    PetscCall(LamRefuse(response, status, "%s%s: %s", what, place, why));
  } else if (LamIsKinking(&out->kinking)) {
    PetscCall(LamRefuseKinks(&out->kinking, out->between[0], status, response));
  } else {
    PetscCall(LamRefuse(response, status,
                        "no contact equilibrium found from any start, after %d iterations: give states in between",
                        (int)rve->work.iterations));
  }
  used = strlen(response->reason);
  PetscCall(PetscSNPrintf(response->reason + used, sizeof(response->reason) - used, "%s", WayText(out)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  LamRVEState before;
  LamContactOutcome out;

  PetscFunctionBeginUser;
  PetscCall(LamTurnedState(rve, state, load, &before));
  PetscCall(TryAll(rve, load, state, before, &out));
  PetscCall(LamRVEStateDestroy(&before));
  response->branch = state->branch + out.branch;
  response->negative_eigenvalues = PetscMax(0, out.negative);
  response->status = LAM_CONVERGED;
  response->max_penetration = out.converged ? PetscMax(0.0, out.depth) : NAN;
  if (!LamContactIsStable(&out)) PetscCall(LamContactRefuse(rve, &out, response));
  PetscFunctionReturn(0);
}
