/*
  One attempt to find contact equilibrium at one load, from the current initial guess.

  Method. Newton with full steps, or descent. A converged state with a negative eigenvalue on its active set is a
  saddle; it is left along its unstable mode, and kept if no other equilibrium is found. States are rejected if cells
  overlap by more than the mesh error, or if a lumen has collapsed or is inverted: the model has no contact between the
  walls that meet there.
*/
#include "contact_path.h"

#define EDGE_SHARE 0.2    /* penetration attributed to the mesh, in edge lengths, ... */
#define WALL_SHARE 0.25   /* ... or in wall thicknesses, ... */
#define DEEPEST_WALL 0.05 /* ... but the latter at most this, apothems; ... */
#define HALF_WALL 0.5     /* ... accepted up to this share of the wall thickness */
#define OF_MESH 0.5       /* share of the depth to be found across from each other; less: walls have slid past */

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

PetscErrorCode LamContactTry(LamRVE rve, const LamLoad *load, PetscReal reach, LamContactOutcome *out)
{
  const PetscInt escapes = rve->work.escapes;
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  PetscCall(reach == LAM_DESCENT ? LamContactNewtonSafe(rve, load, &outcome)
                                 : LamContactNewton(rve, load, NULL, reach, &outcome));
  *out = LAM_NO_OUTCOME;
  out->converged = (PetscBool)(outcome == LAM_NEWTON_CONVERGED);
  if (rve->work.escapes > escapes) ++out->branch;
  if (out->converged) PetscCall(LamLeaveSaddles(rve, load, &out->branch, &out->negative, &out->converged));
  if (out->converged) PetscCall(Refuse(rve, load, out));
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactTryFrom(LamRVE rve, LamRVEState from, const LamLoad *load, PetscReal reach,
                                 LamContactOutcome *out)
{
  PetscFunctionBeginUser;
  LamContactStartNear(rve, from, load);
  PetscCall(LamContactTry(rve, load, reach, out));
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
