/*
  Error estimate of P from a mesh with half as many elements.

  Method. The same load is solved on a mesh with half the elements along the faces and through the walls, whose matrix
  is a quarter of the size or less. The estimate is a share of the difference of the two stresses, with measured shares
  (docs/results/performance.md, "The error of a mesh"), plus the effect of the residual tolerance.

  The share is larger if walls have kinked (kinked_fraction, if requested), as neither mesh resolves the finer wrinkles
  (docs/results/verification.md, "Localisation and kinks"). Errors decrease only with the first power of the element
  size if elements are much longer than the wall thickness, over which walls bend near junctions; deeper than the lumen
  is wide or than the boundary layers of strong fibres; or too few for the strain. The share then grows, up to 1. If
  elements are longer or deeper still, both meshes miss the same features, and the estimate is unknown
  (docs/results/extremes.md, "Worth of the error estimate").

  Bonded tissue starts from the previous state of the coarse mesh. Positions of the finer mesh are a worse initial
  guess, as restricting them leaves volume errors, which are stiff. Contact tissue starts from the positions and contact
  pressures of the finer mesh, which give the contact zones; the nodes of the coarse mesh are among its nodes.
*/
#include "solve.h"

#define GRADED_SHARE 0.08     /* bonded tissue, graded mesh with 6 elements along a face; ... */
#define GRADED_POWER 0.8      /* ... grows with this power of their number */
#define UNIFORM_SHARE 0.2     /* bonded tissue, uniform mesh or one element through the wall (on both meshes) */
#define KINKED_FACTOR 4.0     /* bonded tissue with kinked walls, which wrinkle more on still finer meshes */
#define CONTACT_SHARE 0.4     /* contact tissue: contact advances node by node, so a finer mesh gains less */
#define CONTACT_SCATTER 0.006 /* scatter of contact tissue, divided by the number of elements along a face */
#define LONG 4.0              /* coarseness is 1 at this edge length in wall thicknesses, ... */
#define DEEP 1.0              /* ... element depth in half-widths of the lumen, ... */
#define STRONG 10.0           /* ... in depths of the boundary layers of strong fibres, t sqrt((C1 + C2)/C4), ... */
#define STRAINED 30.0 /* ... or with this many elements along a face per unit logarithmic strain (buckled walls) */
#define UNKNOWN 6.0   /* coarseness above which the error is unknown */

struct LamRVEEstimate_s {
  LamRVE rve;        /* borrowed */
  LamRVE coarse;     /* owned; NULL if the mesh cannot be halved */
  LamRVEState state; /* on `coarse`; owned */
};

PetscErrorCode LamRVEEstimateCreate(LamRVE rve, LamRVEEstimate *estimate)
{
  LamMicrostructure micro = rve->micro;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(estimate));
  (*estimate)->rve = rve;
  if (micro.along % 2 || rve->seal.allowed) PetscFunctionReturn(0);
  micro.along /= 2;
  micro.through = micro.through % 2 ? 1 : micro.through / 2;
  PetscCall(LamRVECreateLike(rve, &micro, LAM_WANT_STRESS, &(*estimate)->coarse));
  PetscCall(LamRVESetTolerance((*estimate)->coarse, PetscMax(rve->tolerance, 1e-6)));
  PetscCall(LamRVESetMonitor((*estimate)->coarse, PETSC_FALSE));
  PetscCall(LamRVEStateCreate((*estimate)->coarse, &(*estimate)->state));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEEstimateDestroy(LamRVEEstimate *estimate)
{
  PetscFunctionBeginUser;
  if (!*estimate) PetscFunctionReturn(0);
  PetscCall(LamRVEStateDestroy(&(*estimate)->state));
  PetscCall(LamRVEDestroy(&(*estimate)->coarse));
  PetscCall(PetscFree(*estimate));
  PetscFunctionReturn(0);
}

/* Initial guess of contact tissue: positions of the nodes common to both meshes, contact pressures of the common hats,
   and the nearest junction status. */
static PetscErrorCode StartContact(LamRVEEstimate e, LamRVEState from)
{
  const LamMesh *f = &e->rve->mesh, *c = &e->coarse->mesh;
  const PetscInt step = f->through / c->through, hats = e->coarse->contact->hats;
  LamRVEState to = e->state;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(e->coarse, to));
  for (PetscInt i = 0; i < c->cell_count * c->ring_nodes; ++i)
    for (PetscInt r = 0; r < c->radial_nodes; ++r) {
      PetscReal x[2];

      LamNodePosition(e->rve, from->load.F, from->y, 2 * i * f->radial_nodes + r * step, x);
      LamPlaceNode(e->coarse, from->load.F, i * c->radial_nodes + r, x, to->y);
    }
  for (PetscInt k = 0; k < to->faces; ++k) {
    for (PetscInt j = 0; j < hats; ++j) to->lambda[k * hats + j] = from->lambda[k * e->rve->contact->hats + 2 * j];
    to->hats[k][0] = (from->hats[k][0] + 1) / 2;
    to->hats[k][1] = from->hats[k][1] / 2;
  }
  to->load = from->load;
  to->solved = PETSC_TRUE;
  to->width = from->width;
  PetscFunctionReturn(0);
}

static PetscReal SmoothShare(const LamMicrostructure *micro)
{
  return micro->grading > 0.0 && micro->through > 1
             ? GRADED_SHARE * PetscPowReal((PetscReal)micro->along / 6.0, GRADED_POWER)
             : UNIFORM_SHARE;
}

/* Largest absolute value of the logarithmic principal strains of the in-plane part of F. */
static PetscReal LargestStrain(const PetscReal F[9])
{
  const PetscReal det = F[0] * F[4] - F[1] * F[3];
  const PetscReal half = 0.5 * (F[0] * F[0] + F[1] * F[1] + F[3] * F[3] + F[4] * F[4]);
  const PetscReal square = half + PetscSqrtReal(PetscMax(0.0, half * half - det * det)); /* of the larger stretch */

  return 0.5 * PetscMax(PetscLogReal(square), -PetscLogReal(det * det / square));
}

/* Coarseness of the mesh for the load. Above 1 errors decrease slowly; above UNKNOWN they are unknown. */
static PetscReal Coarseness(LamRVE rve, const PetscReal F[9])
{
  const LamMicrostructure *micro = &rve->micro;
  const PetscReal through = (PetscReal)micro->through;
  PetscReal coarseness = PetscMax(LamLongestEdge(&rve->mesh) / (LONG * rve->thinnest),
                                  STRAINED * LargestStrain(F) / (PetscReal)micro->along);

  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) {
    const LamWall *wall = LamCellWall(micro, c);
    const PetscReal thickness = LamWallThickness(micro, c);

    coarseness = PetscMax(coarseness, thickness / (through * (rve->mesh.apothem - thickness)) / DEEP);
    coarseness =
        PetscMax(coarseness, PetscSqrtReal(LamWallFibreModulus(wall) / (wall->C1 + wall->C2)) / (through * STRONG));
  }
  return coarseness;
}

/* Error of the finer mesh over the difference of the two meshes; NaN: unknown. */
static PetscReal Share(LamRVE rve, const LamResponse *response)
{
  const PetscReal coarseness = Coarseness(rve, response->load.F);
  PetscReal share = rve->contact ? CONTACT_SHARE : SmoothShare(&rve->micro);

  if (coarseness > UNKNOWN) return NAN;
  if (!rve->contact && response->kinked_fraction > LAM_KINKED_SHARE) share *= KINKED_FACTOR;
  return coarseness > 1.0 ? PetscMax(share, PetscMin(1.0, share * PetscSqr(coarseness))) : share;
}

PetscErrorCode LamRVEEstimateError(LamRVEEstimate e, LamRVEState state, LamResponse *response)
{
  PetscReal size = 0.0;
  LamResponse coarse;

  PetscFunctionBeginUser;
  response->error_estimate = NAN;
  if (!e->coarse || !LamResponseHasFields(response)) PetscFunctionReturn(0);
  if (e->coarse->contact) PetscCall(StartContact(e, state));
  PetscCall(LamRVESolve(e->coarse, &state->load, e->state, &coarse));
  response->seconds += coarse.seconds;
  if (coarse.status != LAM_CONVERGED) {
    PetscCall(LamRVEStateReset(e->coarse, e->state));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < 9; ++i) size += PetscSqr(response->P[i]);
  response->error_estimate = Share(e->rve, response) * LamStressError(coarse.P, response->P) +
                             e->rve->tolerance / (PetscSqrtReal(size) + LAM_STRESS_FLOOR) +
                             (e->rve->contact ? CONTACT_SCATTER / (PetscReal)e->rve->micro.along : 0.0);
  PetscFunctionReturn(0);
}
