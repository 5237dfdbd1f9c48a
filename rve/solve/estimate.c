/*
  The error of P of a mesh, from half as many elements.

  Method. The same load is solved on a mesh with half the elements along the faces and through the walls, whose matrix
  is a quarter of the size or less. The error of the finer mesh is a share of the difference of the two stresses; the
  shares are measured (docs/results/performance.md, "The error of a mesh"). What the residual leaves is added. Where
  walls have kinked (kinked_fraction, where it was asked for) neither mesh knows how a finer one wrinkles, and more is
  taken (docs/results/verification.md, "Localisation and kinks"). Where elements are much longer than walls are thick,
  which bend near junctions over about a thickness, deeper than the lumen is wide or than the layers that strong fibres
  make, or few for the strain, errors fall with the first power of their size only, and up to the whole difference is
  taken; where they are longer or deeper still, both meshes miss the same, and nothing is known
  (docs/results/extremes.md, "Worth of the error estimate"). Bonded tissue starts from the coarse mesh's own state
  before: positions of the finer mesh would be a worse start, since what they leave of the volumes is as stiff as water.
  Contact tissue starts from the finer mesh's positions and contact pressures, which say where it touches; nodes of the
  coarse mesh are among its nodes.
*/
#include "solve.h"

#define GRADED_SHARE 0.08 /* bonded tissue, graded mesh of 6 elements along a face; more with more */
#define GRADED_POWER 0.8
#define UNIFORM_SHARE 0.2     /* the same of uniform meshes, and of one element through the wall, on both meshes */
#define KINKED_FACTOR 4.0     /* bonded tissue, where walls kink: finer meshes wrinkle more, coarse ones alike */
#define CONTACT_SHARE 0.4     /* contact jumps from node to node: a finer mesh gains less */
#define CONTACT_SCATTER 0.006 /* by which it scatters, over the number of elements along a face */
#define LONG 4.0              /* edges in wall thicknesses, ... */
#define DEEP 1.0              /* elements through the wall in half-widths of the lumen, ... */
#define STRONG 10.0           /* and in the depths of layers that strong fibres make, t sqrt((C1 + C2)/C4): ... */
#define STRAINED 30.0 /* elements along a face for a logarithmic strain of 1: fewer do not follow walls that buckle */
#define UNKNOWN 6.0   /* errors fall slowly above; above these times as much nothing is known of them */

struct LamRVEEstimate_s {
  LamRVE rve;        /* borrowed */
  LamRVE coarse;     /* owned; NULL where the mesh cannot be halved */
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
  PetscCall(LamRVECreate(rve->comm, &(*estimate)->coarse));
  PetscCall(LamRVESetMicrostructure((*estimate)->coarse, &micro));
  PetscCall(LamRVESetStrategy((*estimate)->coarse, rve->strategy));
  PetscCall(LamRVESetTolerance((*estimate)->coarse, PetscMax(rve->tolerance, 1e-6)));
  PetscCall(LamRVESetWanted((*estimate)->coarse, LAM_WANT_STRESS));
  PetscCall(LamRVESetInterrupt((*estimate)->coarse, rve->interrupt, rve->interrupt_ctx));
  PetscCall(LamRVESetUp((*estimate)->coarse));
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

/* Positions of the nodes that both meshes have. */
static void RestrictPositions(LamRVE fine, LamRVEState from, LamRVE coarse, LamRVEState to)
{
  const LamMesh *f = &fine->mesh, *c = &coarse->mesh;
  const PetscInt step = f->through / c->through;

  for (PetscInt i = 0; i < c->cell_count * c->ring_nodes; ++i)
    for (PetscInt r = 0; r < c->radial_nodes; ++r) {
      const PetscInt node = i * c->radial_nodes + r, same = 2 * i * f->radial_nodes + r * step;
      const PetscReal *S = &c->shift[2 * node], *F = from->load.F;
      PetscReal x[2];

      LamNodePosition(fine, F, from->y, same, x);
      for (PetscInt d = 0; d < 2; ++d)
        to->y[2 * c->node_class[node] + d] = x[d] - F[3 * d] * S[0] - F[3 * d + 1] * S[1];
    }
}

/* Contact pressures of the hats that both have, and the junction status that is nearest. */
static void RestrictContact(LamRVE fine, LamRVEState from, LamRVE coarse, LamRVEState to)
{
  const PetscInt hats = coarse->contact->hats;

  for (PetscInt f = 0; f < to->faces; ++f) {
    for (PetscInt j = 0; j < hats; ++j) to->lambda[f * hats + j] = from->lambda[f * fine->contact->hats + 2 * j];
    to->hats[f][0] = (from->hats[f][0] + 1) / 2;
    to->hats[f][1] = from->hats[f][1] / 2;
  }
}

static PetscErrorCode StartContact(LamRVEEstimate e, LamRVEState state)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(e->coarse, e->state));
  RestrictPositions(e->rve, state, e->coarse, e->state);
  RestrictContact(e->rve, state, e->coarse, e->state);
  e->state->load = state->load;
  e->state->solved = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscReal SmoothShare(const LamMicrostructure *micro)
{
  return micro->grading > 0.0 && micro->through > 1
             ? GRADED_SHARE * PetscPowReal((PetscReal)micro->along / 6.0, GRADED_POWER)
             : UNIFORM_SHARE;
}

/* Largest logarithmic principal strain of the in-plane part of F, by size. */
static PetscReal LargestStrain(const PetscReal F[9])
{
  const PetscReal det = F[0] * F[4] - F[1] * F[3];
  const PetscReal half = 0.5 * (F[0] * F[0] + F[1] * F[1] + F[3] * F[3] + F[4] * F[4]);
  const PetscReal square = half + PetscSqrtReal(PetscMax(0.0, half * half - det * det)); /* of the larger stretch */

  return 0.5 * PetscMax(PetscLogReal(square), -PetscLogReal(det * det / square));
}

/* How far the mesh is from where errors fall fast: above 1 they fall slowly, above UNKNOWN nothing is known. */
static PetscReal Coarseness(LamRVE rve, const PetscReal F[9])
{
  const LamMicrostructure *micro = &rve->micro;
  const PetscReal through = (PetscReal)micro->through;
  PetscReal coarseness = PetscMax(LamLongestEdge(&rve->mesh) / (LONG * rve->thinnest),
                                  STRAINED * LargestStrain(F) / (PetscReal)micro->along);

  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;
    const PetscReal thickness = LamWallThickness(micro, c);

    coarseness = PetscMax(coarseness, thickness / (through * (rve->mesh.apothem - thickness)) / DEEP);
    coarseness =
        PetscMax(coarseness, PetscSqrtReal(LamWallFibreModulus(wall) / (wall->C1 + wall->C2)) / (through * STRONG));
  }
  return coarseness;
}

/* Of the difference of two meshes that is left to the finer one's error; NaN: unknown. */
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
