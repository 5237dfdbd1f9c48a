/*
  A contact state at one load.

  Method. From a near solution of the exact law, its own iteration is tried first (sharpen.c). Otherwise, or if that
  fails, the smooth law finds a state: its energy is minimised (minimise.c) from the state before, moved affinely, or
  from the initial guess of the strategy, loosely and at a wide width. The exact law then follows from there if it
  applies: hardly any force between walls that do not face each other. If it fails, the smooth law is solved at the
  usual width, and the exact law is tried again. It is taken if it is a minimum of no higher energy; otherwise the
  smooth state is the answer.

  A lamella gives way in kinks, which the iteration of the exact law does not pass without a search along its steps: the
  state is that of the smooth law at its usual width, before the exact law is tried. Nor does it start elsewhere than at
  the state before, to which its history belongs.
*/
#include "contact_find.h"

#define NEAR 0.04               /* largest change of F, turgor (C1 + C2) and cohesion (C1 + C2) that counts as near */
#define NEAR_EXACT 0.2          /* the same for the iteration of the exact law, ... */
#define LEAST_WALK (1.0 / 16.0) /* ... and the least step of a path of its states */
#define LOOSE 0.03              /* tolerance of states from which the exact law is tried */
#define OTHERS 0.02             /* largest share of the contact force that the exact law may leave out */
#define EDGE_SHARE 0.2          /* penetration of the exact law attributed to the mesh, in edge lengths, ... */
#define WALL_SHARE 0.5          /* ... and in wall thicknesses */
#define ROUNDING 1e-9           /* of the energy, C1 + C2 */
#define GIVES_WAY 0.02 /* apothems by which walls of the smooth law, rounded at corners, may lie in each other */

static PetscBool IsWithin(const LamLoad *from, const LamLoad *load, PetscReal reach)
{
  PetscReal largest =
      PetscMax(PetscAbsReal(from->turgor - load->turgor), PetscAbsReal(from->cohesion - load->cohesion));

  for (PetscInt i = 0; i < 9; ++i) largest = PetscMax(largest, PetscAbsReal(from->F[i] - load->F[i]));
  return (PetscBool)(largest <= reach);
}

static const LamLoad *LoadOf(const LamLoad *load, const LamBorder *border)
{
  return border ? &border->load : load;
}

/* Whether walls lie deeper in each other than the mesh explains. */
static PetscBool IsDeep(LamRVE rve, const LamLoad *load)
{
  const LamDepths depths = LamFindDepths(rve, load);
  const PetscReal most = PetscMin(EDGE_SHARE * rve->mesh.longest, WALL_SHARE * rve->mesh.thinnest);

  return (PetscBool)(PetscMax(depths.facing, depths.other) > most);
}

/* Whether the state of the exact law in rve->y is acceptable: a minimum, of no higher energy than `most`, in which no
   walls have passed through each other. */
static PetscErrorCode Accept(LamRVE rve, const LamLoad *load, PetscReal most, LamContactOutcome *out)
{
  PetscReal energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, load, &out->negative, &out->found));
  if (!LamContactIsStable(out)) PetscFunctionReturn(0);
  PetscCall(LamAssembleEnergy(rve, load, rve->y, &energy, &valid));
  PetscCall(LamFindCollapsedLumen(rve, rve->y, &out->shut));
  if (!(energy <= most + ROUNDING * rve->mesh.V0) || out->shut >= 0 || IsDeep(rve, load)) out->found = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The exact law from a near solution of it. */
static PetscErrorCode TryNear(LamRVE rve, const LamLoad *load, LamBorder *border, LamRVEState before,
                              LamContactOutcome *out)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(LamUseExactLaw(rve));
  LamContactStartNear(rve, before, LoadOf(load, border));
  PetscCall(LamSharpen(rve, LoadOf(load, border), border, LAM_NEAR_REACH, &outcome));
  if (outcome == LAM_NEWTON_CONVERGED) PetscCall(Accept(rve, LoadOf(load, border), PETSC_INFINITY, out));
  PetscFunctionReturn(0);
}

/* The exact law on a straight path of loads from a solution of it, in steps that are halved on failure. */
static PetscErrorCode WalkExact(LamRVE rve, const LamLoad *load, LamRVEState before, LamContactOutcome *out)
{
  LamRVEState at;
  PetscReal reached = 0.0, step = 0.5;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &at));
  PetscCall(LamRVEStateCopy(before, at));
  *out = LAM_NO_OUTCOME;
  while (reached < 1.0 && step >= LEAST_WALK && LamMayIterate(rve)) {
    const PetscReal t = PetscMin(1.0, reached + step);
    const LamLoad next = t >= 1.0 ? *load : LamLoadBetween(&before->load, load, t);

    *out = LAM_NO_OUTCOME;
    PetscCall(TryNear(rve, &next, NULL, at, out));
    if (LamContactIsStable(out)) {
      LamKeepState(rve, &next, 0, at);
      reached = t;
    } else {
      step *= 0.5;
    }
  }
  if (reached < 1.0) *out = LAM_NO_OUTCOME;
  PetscCall(LamRVEStateDestroy(&at));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactSearch(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal width,
                                PetscReal tolerance, LamContactOutcome *out)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  PetscCall(LamUseSmoothLaw(rve, width));
  PetscCall(LamMinimise(rve, LoadOf(load, border), border, tolerance, &outcome));
  PetscCall(LamFindCollapsedLumen(rve, rve->y, &out->shut));
  out->found = (PetscBool)(outcome == LAM_NEWTON_CONVERGED && out->shut < 0);
  PetscFunctionReturn(0);
}

/* From the smooth state in rve->y, copied to `smooth`, to the exact law; if it fails, rve->y is that state again. */
static PetscErrorCode TryExact(LamRVE rve, const LamLoad *load, LamBorder *border, LamRVEState smooth,
                               LamContactOutcome *out)
{
  const LamContactOutcome before = *out;
  LamTouchForces forces;
  LamNewtonOutcome outcome = LAM_NEWTON_STALLED;
  PetscReal energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  out->found = PETSC_FALSE;
  PetscCall(LamSmoothPressures(rve, LoadOf(load, border), &forces));
  LamKeepState(rve, LoadOf(load, border), 0, smooth);
  PetscCall(LamAssembleEnergy(rve, LoadOf(load, border), rve->y, &energy, &valid));
  if (forces.third + forces.lumen <= OTHERS * (forces.facing + forces.third + forces.lumen)) {
    PetscCall(LamUseExactLaw(rve));
    PetscCall(LamSharpen(rve, LoadOf(load, border), border, 0.0, &outcome));
    if (outcome == LAM_NEWTON_CONVERGED)
      PetscCall(Accept(rve, LoadOf(load, border), border ? PETSC_INFINITY : energy + GIVES_WAY * forces.facing, out));
  }
  if (rve->monitor)
    PetscCall(PetscFPrintf(
        PETSC_COMM_SELF, PETSC_STDERR,
        "  contact: width %g, share of other walls %.3g; exact law: %s, negative %d, shut %d, found %d\n",
        (double)smooth->width, (double)((forces.third + forces.lumen) / (forces.facing + forces.third + forces.lumen)),
        outcome == LAM_NEWTON_CONVERGED ? "converged" : "stalled", (int)out->negative, (int)out->shut,
        (int)out->found));
  if (LamContactIsStable(out)) PetscFunctionReturn(0);
  *out = before;
  PetscCall(LamUseSmoothLaw(rve, smooth->width));
  PetscCall(PetscArraycpy(rve->y, smooth->y, rve->length));
  if (border) border->load = smooth->load;
  (void)LamSetConsistentStresses(rve, &smooth->load, rve->y);
  PetscFunctionReturn(0);
}

/* The smooth law at a width, to the tolerance of the solve; stable. */
static PetscErrorCode Settle(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal width,
                             LamContactOutcome *out)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(LamUseSmoothLaw(rve, width));
  PetscCall(LamMinimise(rve, LoadOf(load, border), border, LamNewtonTolerance(rve), &outcome));
  out->found = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
  if (!out->found) PetscFunctionReturn(0);
  if (border)
    PetscCall(LamFactorConsistent(rve, &border->load, &out->negative, &out->found));
  else
    PetscCall(LamLeaveSaddles(rve, load, &out->branch, &out->negative, &out->found));
  if (out->found) PetscCall(LamFindCollapsedLumen(rve, rve->y, &out->shut));
  if (out->shut >= 0) out->found = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactFinish(LamRVE rve, const LamLoad *load, LamBorder *border, LamContactOutcome *out)
{
  const PetscReal asked = rve->micro.contact_width;
  const PetscBool smooth = (PetscBool)(rve->micro.sharpness == LAM_SHARPNESS_SMOOTH);
  LamRVEState at;

  PetscFunctionBeginUser;
  if (smooth) {
    PetscCall(Settle(rve, load, border, asked > 0.0 ? asked : LAM_USUAL_WIDTH, out));
    PetscFunctionReturn(0);
  }
  PetscCall(LamRVEStateCreate(rve, &at));
  if (!rve->layer) PetscCall(TryExact(rve, load, border, at, out));
  if (!LamIsExact(rve)) {
    PetscCall(Settle(rve, load, border, LAM_USUAL_WIDTH, out));
    if (out->found) PetscCall(TryExact(rve, load, border, at, out));
    if (out->found && !LamIsExact(rve)) /* residual, energy and perhaps the factor are still those of the exact law */
      PetscCall(LamFactorConsistent(rve, LoadOf(load, border), &out->negative, &out->found));
  }
  PetscCall(LamRVEStateDestroy(&at));
  PetscFunctionReturn(0);
}

/* Whether the state before is one of the exact law, which is wanted again. */
static PetscBool WantsExact(LamRVE rve, const LamRVEState before)
{
  return (PetscBool)(before->solved && before->width == 0.0 && rve->micro.sharpness != LAM_SHARPNESS_SMOOTH);
}

/* From a smooth state in rve->y, where the state before is one of the exact law: whether that continues to here. */
static PetscErrorCode KeepExact(LamRVE rve, const LamLoad *load, LamRVEState before, LamContactOutcome *out)
{
  const LamContactOutcome found = *out;
  LamRVEState smooth;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &smooth));
  LamKeepState(rve, load, 0, smooth);
  PetscCall(WalkExact(rve, load, before, out));
  if (!LamContactIsStable(out)) {
    PetscCall(LamTakeState(rve, smooth));
    *out = found;
    PetscCall(LamFactorConsistent(rve, load, &out->negative, &out->found));
  }
  PetscCall(LamRVEStateDestroy(&smooth));
  PetscFunctionReturn(0);
}

/* The strategy's initial guess. */
static PetscErrorCode Start(LamRVE rve, const LamLoad *load, LamStrategy strategy, PetscBool *ok)
{
  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  if (strategy == LAM_TWO_STEP)
    PetscCall(LamContactStartBonded(rve, load, ok));
  else
    LamContactStartAffine(rve, load);
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactFind(LamRVE rve, const LamLoad *load, LamBorder *border, LamRVEState before,
                              LamContactOutcome *out)
{
  const LamLoad guess = *LoadOf(load, border);
  const PetscBool near = (PetscBool)(before->solved && before->width > 0.0 && IsWithin(&before->load, &guess, NEAR));
  const PetscInt starts = rve->layer && before->solved ? 1 : 2;
  PetscBool ok;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  if (WantsExact(rve, before) && IsWithin(&before->load, &guess, border ? NEAR : NEAR_EXACT)) {
    PetscCall(TryNear(rve, load, border, before, out));
    if (LamContactIsStable(out)) PetscFunctionReturn(0);
  }
  if (rve->near_only) PetscFunctionReturn(0);
  for (PetscInt k = before->solved ? 0 : 1; k < starts && !out->found && !rve->work.stopped; ++k) {
    const PetscReal width = rve->layer ? LAM_USUAL_WIDTH : k == 0 && near ? before->width : LAM_SEARCH_WIDTH;

    if (border) border->load = guess;
    LamLayerTake(rve, before); /* an attempt before may have torn walls */
    ok = PETSC_TRUE;
    if (k == 0)
      LamContactStartNear(rve, before, &guess);
    else
      PetscCall(Start(rve, &guess, rve->strategy, &ok));
    if (ok) PetscCall(LamContactSearch(rve, load, border, width, LOOSE, out));
  }
  if (out->found) PetscCall(LamContactFinish(rve, load, border, out));
  if (out->found && !border && !LamIsExact(rve) && WantsExact(rve, before) && !rve->layer)
    PetscCall(KeepExact(rve, load, before, out));
  PetscFunctionReturn(0);
}
