/*
  One attempt to find contact equilibrium at one load, from the current initial guess.

  Method. Newton with full steps, or descent. A converged state with a negative eigenvalue on its active set is a
  saddle; it is left along its unstable mode, and kept if no other equilibrium is found. States are rejected if cells
  overlap by more than the mesh error, or if a lumen has collapsed or is inverted: the model has no contact between the
  walls that meet there.
*/
#include "contact_path.h"

#define MAX_BRANCH_SWITCHES 4
#define KICK 0.01         /* apothems: perturbation along an unstable mode */
#define EDGE_SHARE 0.2    /* penetration attributed to the mesh, in edge lengths, ... */
#define WALL_SHARE 0.25   /* ... or in wall thicknesses, ... */
#define DEEPEST_WALL 0.05 /* ... but the latter at most this, apothems; ... */
#define HALF_WALL 0.5     /* ... accepted up to this share of the wall thickness */
#define OF_MESH 0.5       /* share of the depth to be found across from each other; less: walls have slid past */

static PetscReal LargestDifference(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, PetscAbsReal(a[i] - b[i]));
  return largest;
}

/* Perturbs along the softest mode of the current factorisation and solves; *left: another equilibrium was found. */
static PetscErrorCode Kick(LamRVE rve, const LamLoad *load, LamRVEState saddle, PetscReal mode[], PetscBool *left)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(LamSoftestMode(rve, &rve->lowest_eigenvalue, mode));
  if (rve->monitor)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "  saddle: lowest eigenvalue %.3e; leaving it\n",
                           (double)rve->lowest_eigenvalue));
  LamAddMode(rve, KICK / LamLargestEntry(rve->linear.positions, mode), mode, rve->y);
  PetscCall(LamContactNewton(rve, load, NULL, LAM_NEAR_REACH, &outcome));
  *left = (PetscBool)(outcome == LAM_NEWTON_CONVERGED && LargestDifference(rve->ndof, rve->y, saddle->y) > 0.1 * KICK);
  PetscFunctionReturn(0);
}

/* Leaves saddles; returns the last one if its mode leads to no other equilibrium. */
static PetscErrorCode LeaveSaddles(LamRVE rve, const LamLoad *load, LamContactOutcome *out)
{
  LamRVEState saddle;
  PetscReal *mode;

  PetscFunctionBeginUser;
  PetscCall(LamFactorConsistent(rve, load, &out->negative, &out->converged));
  if (!out->converged || out->negative <= 0) PetscFunctionReturn(0);
  PetscCall(LamRVEStateCreate(rve, &saddle));
  PetscCall(PetscMalloc1(rve->linear.n, &mode));
  for (PetscInt k = 0; k < MAX_BRANCH_SWITCHES && out->converged && out->negative > 0; ++k) {
    PetscBool left = PETSC_FALSE;

    LamKeepState(rve, load, 0, saddle);
    PetscCall(Kick(rve, load, saddle, mode, &left));
    if (!left) PetscCall(LamTakeState(rve, saddle));
    PetscCall(LamFactorConsistent(rve, load, &out->negative, &out->converged));
    if (!left) break;
    ++out->branch;
  }
  PetscCall(PetscFree(mode));
  PetscCall(LamRVEStateDestroy(&saddle));
  PetscFunctionReturn(0);
}

static PetscErrorCode Refuse(LamRVE rve, const LamLoad *load, LamContactOutcome *out)
{
  const PetscReal edge = LamLongestEdge(&rve->mesh);
  const PetscReal mesh = PetscMax(EDGE_SHARE * edge, PetscMin(DEEPEST_WALL, WALL_SHARE * rve->thinnest));
  const PetscReal shallow = PetscMin(mesh, HALF_WALL * rve->thinnest);
  PetscReal closed = 0.0;
  PetscBool facing;

  PetscFunctionBeginUser;
  PetscCall(LamFindCollapsedLumen(rve, rve->y, &out->cell[0]));
  if (out->cell[0] >= 0) {
    out->refusal = LAM_LUMEN_COLLAPSED;
  } else {
    PetscCall(LamFindOverlap(rve, load->F, rve->y, &out->depth, out->cell, &facing));
    if (out->depth <= shallow) PetscFunctionReturn(0);
    if (facing) PetscCall(LamFacingDepth(rve, load->F, rve->y, &closed));
    if (!facing)
      out->refusal = LAM_CELLS_OVERLAP;
    else if (closed < OF_MESH * out->depth)
      out->refusal = LAM_WALLS_PASSED;
    else if (out->depth <= mesh)
      out->coarse = PETSC_TRUE;
    else
      out->refusal = LAM_WALLS_OVERLAP;
  }
  if (out->refusal != LAM_NOT_REFUSED) out->converged = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode Judge(LamRVE rve, const LamLoad *load, LamNewtonOutcome outcome, PetscInt escapes,
                            LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  out->converged = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
  if (rve->work.escapes > escapes) ++out->branch;
  if (out->converged) PetscCall(LeaveSaddles(rve, load, out));
  if (out->converged) PetscCall(Refuse(rve, load, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactTry(LamRVE rve, const LamLoad *load, PetscReal reach, LamContactOutcome *out)
{
  const PetscInt escapes = rve->work.escapes;
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(LamContactNewton(rve, load, NULL, reach, &outcome));
  PetscCall(Judge(rve, load, outcome, escapes, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactTryFrom(LamRVE rve, LamRVEState from, const LamLoad *load, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  LamContactStartNear(rve, from, load);
  PetscCall(LamContactTry(rve, load, LAM_NEAR_REACH, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactTryMixed(LamRVE rve, LamBorder *border, PetscReal reach, LamContactOutcome *out)
{
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  *out = LAM_NO_OUTCOME;
  PetscCall(LamContactNewton(rve, &border->load, border, reach, &outcome));
  if (outcome != LAM_NEWTON_CONVERGED) PetscFunctionReturn(0);
  PetscCall(LamFactorConsistent(rve, &border->load, &out->negative, &out->converged));
  if (LamContactIsStable(out)) PetscCall(Refuse(rve, &border->load, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactDescendFrom(LamRVE rve, LamRVEState from, const LamLoad *load, LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  LamContactStartNear(rve, from, load);
  PetscCall(LamContactDescend(rve, load, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactDescend(LamRVE rve, const LamLoad *load, LamContactOutcome *out)
{
  const PetscInt escapes = rve->work.escapes;
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(LamContactNewtonSafe(rve, load, &outcome));
  PetscCall(Judge(rve, load, outcome, escapes, out));
  PetscFunctionReturn(0);
}
