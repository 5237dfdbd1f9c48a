/*
  The error of P of a mesh, from half as many elements.

  Method. The same load is solved on a mesh with half the elements along the faces and through the walls, whose matrix
  is a quarter of the size or less. The error of the finer mesh is a share of the difference of the two stresses; the
  shares are measured (docs/performance.md, "The error of a mesh"). What the residual leaves is added. Where walls have
  kinked (kinked_fraction, where it was asked for) neither mesh knows how a finer one wrinkles, and more is taken
  (docs/verification.md, "Localisation and kinks"). Bonded tissue starts from the coarse mesh's own state before:
  positions of the finer mesh would be a worse start, since what they leave of the volumes is as stiff as water. Contact
  tissue starts from the finer mesh's positions and contact pressures, which say where it touches; nodes of the coarse
  mesh are among its nodes.
*/
#include "rve_impl.h"

#define GRADED_SHARE 0.08 /* bonded tissue, graded mesh of 6 elements along a face; more with more */
#define GRADED_POWER 0.8
#define UNIFORM_SHARE 0.14
#define FLAT_SHARE 0.2    /* of one element through the wall, which the coarser mesh has, too */
#define KINKED_FACTOR 4.0 /* bonded tissue, where walls kink: finer meshes wrinkle more, coarse ones alike */
#define CONTACT_SHARE 0.4 /* contact jumps from node to node: a finer mesh gains less */

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
  if (micro->through == 1) return FLAT_SHARE;
  return micro->grading > 0.0 ? GRADED_SHARE * PetscPowReal((PetscReal)micro->along / 6.0, GRADED_POWER)
                              : UNIFORM_SHARE;
}

static PetscReal Share(const LamMicrostructure *micro, const LamResponse *response)
{
  if (micro->interface == LAM_INTERFACE_CONTACT) return CONTACT_SHARE;
  return SmoothShare(micro) * (response->kinked_fraction > LAM_KINKED_SHARE ? KINKED_FACTOR : 1.0);
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
  response->error_estimate = Share(&e->rve->micro, response) * LamStressError(coarse.P, response->P) +
                             e->rve->tolerance / (PetscSqrtReal(size) + LAM_STRESS_FLOOR);
  PetscFunctionReturn(0);
}
