#include "rve_impl.h"

static PetscInt EdgeOf(PetscInt point)
{
  return point / LAM_EDGE_POINTS;
}

static LamCohesive LawAt(const LamLamella *lamella, PetscReal strength, PetscReal energy, PetscBool junction)
{
  strength *= junction ? lamella->junction_strength : 1.0;
  energy *= junction ? lamella->junction_energy : 1.0;
  return (LamCohesive){.softening = lamella->softening,
                       .stiffness = lamella->stiffness,
                       .strength = strength * lamella->strength,
                       .beta = lamella->shear_strength / lamella->strength,
                       .energy = {energy * lamella->energy, energy * lamella->shear_energy},
                       .mixing = lamella->mixing};
}

PetscErrorCode LamLayerCreate(const LamMicrostructure *micro, const LamMesh *mesh, const LamContact *contact,
                              LamLayer **out)
{
  const PetscReal face = LamFaceLength(mesh);
  LamLayer *layer;

  PetscFunctionBeginUser;
  PetscCheck(micro->lamella.stiffness > 0.0 && micro->lamella.strength > 0.0 && micro->lamella.energy > 0.0,
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "stiffness, strength and energy of the lamella must be positive, got %g, %g and %g",
             (double)micro->lamella.stiffness, (double)micro->lamella.strength, (double)micro->lamella.energy);
  PetscCall(PetscNew(&layer));
  layer->count = contact->face_count * mesh->along * LAM_EDGE_POINTS;
  PetscCall(
      PetscMalloc3(layer->count, &layer->weight, layer->count, &layer->bond, EdgeOf(layer->count), &layer->first));
  for (PetscInt p = 0; p < layer->count; ++p) {
    const PetscInt e = EdgeOf(p) % mesh->along;
    const LamContactFace *of = &contact->faces[EdgeOf(p) / mesh->along];
    const PetscReal at = face * LamMeshShare(mesh, (PetscReal)e + LamEdgePlace(p % LAM_EDGE_POINTS));
    PetscReal strength, energy;

    (void)LamLamellaFaceFactors(micro, of->cell, of->face, &strength, &energy);
    if (LamLatticeIsCut(micro, of->cell, of->other)) strength = energy = 0.0;
    layer->bond[p].law =
        LawAt(&micro->lamella, strength, energy, (PetscBool)(PetscMin(at, face - at) < micro->lamella.junction_length));
    layer->weight[p] = LamEdgeWeight(p % LAM_EDGE_POINTS) * contact->J0[e];
    layer->toughness += layer->weight[p] * LamEnvelopeOf(&layer->bond[p].law, 0.0).energy / mesh->V0;
  }
  *out = layer;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLayerDestroy(LamLayer **layer)
{
  PetscFunctionBeginUser;
  if (!*layer) PetscFunctionReturn(0);
  PetscCall(PetscFree3((*layer)->weight, (*layer)->bond, (*layer)->first));
  PetscCall(PetscFree(*layer));
  PetscFunctionReturn(0);
}

/* Place in its face's chains of node k of an edge. */
static PetscInt ChainPlace(const LamContact *contact, PetscInt e, PetscInt k)
{
  return k < 3 ? 2 * e + k : contact->chain - 1 - (2 * e + k - 3);
}

static void SetBlock(LamRVE rve, PetscInt edge, LamEdgeBlock *block)
{
  const LamContact *contact = rve->contact;
  const PetscInt f = edge / rve->mesh.along;

  block->edge = edge;
  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k) {
    const PetscInt at = f * contact->chain + ChainPlace(contact, edge % rve->mesh.along, k);

    block->class[k] = contact->classes[at];
    for (PetscInt d = 0; d < 2; ++d) block->shift[k][d] = contact->shift[2 * at + d];
  }
}

void LamLayerSetMatrix(LamRVE rve)
{
  for (PetscInt edge = 0; edge < EdgeOf(rve->layer->count); ++edge) {
    PetscInt pair = 0;
    LamEdgeBlock block;

    SetBlock(rve, edge, &block);
    for (PetscInt i = 0; i < LAM_EDGE_NODES; ++i)
      for (PetscInt j = i; j < LAM_EDGE_NODES; ++j, ++pair)
        rve->layer->first[edge][pair] = LamLinearBlock(rve->linear, block.class[i], block.class[j]);
  }
}

/* Displacements of an edge's nodes, without the cancellation of positions, and their reference positions. */
static void GatherEdge(LamRVE rve, const PetscReal F[9], const PetscReal y[], const LamEdgeBlock *block,
                       PetscReal u[LAM_EDGE_NODES][2], PetscReal X[LAM_EDGE_NODES][2])
{
  const PetscReal H[4] = {F[0] - 1.0, F[1], F[3], F[4] - 1.0};

  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt at = 2 * block->class[k] + d;

      X[k][d] = rve->mesh.class_X[at] + block->shift[k][d];
      u[k][d] = (y[at] - rve->mesh.class_X[at]) + (H[2 * d] * block->shift[k][0] + H[2 * d + 1] * block->shift[k][1]);
    }
}

void LamLayerVisit(LamRVE rve, const PetscReal F[9], const PetscReal y[], LamEdgeVisitor visitor, void *ctx)
{
  const LamLayer *layer = rve->layer;

  for (PetscInt edge = 0; edge < EdgeOf(layer->count); ++edge) {
    const PetscInt first = LAM_EDGE_POINTS * edge;
    PetscReal u[LAM_EDGE_NODES][2], X[LAM_EDGE_NODES][2];
    LamEdgeBlock block;

    SetBlock(rve, edge, &block);
    GatherEdge(rve, F, y, &block, u, X);
    LamEdgeEvaluate((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, &layer->bond[first],
                    rve->contact->J0[edge % rve->mesh.along], layer->secant, &block.sum);
    visitor(ctx, &block);
  }
}

void LamLayerVisitPoints(LamRVE rve, const PetscReal F[9], const PetscReal y[], LamBondVisitor visitor, void *ctx)
{
  const LamLayer *layer = rve->layer;

  for (PetscInt edge = 0; edge < EdgeOf(layer->count); ++edge) {
    PetscReal u[LAM_EDGE_NODES][2], X[LAM_EDGE_NODES][2];
    LamEdgeBlock block;

    SetBlock(rve, edge, &block);
    GatherEdge(rve, F, y, &block, u, X);
    for (PetscInt q = 0; q < LAM_EDGE_POINTS; ++q) {
      LamBondPoint point = {.point = LAM_EDGE_POINTS * edge + q,
                            .face = edge / rve->mesh.along,
                            .at = (PetscReal)(edge % rve->mesh.along) + LamEdgePlace(q)};

      LamEdgePointEvaluate((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, q, &layer->bond[point.point],
                           &point.jump, &point.step);
      visitor(ctx, &point);
    }
  }
}

void LamLayerJump(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt edge, PetscReal s, LamJump *jump)
{
  PetscReal u[LAM_EDGE_NODES][2], X[LAM_EDGE_NODES][2];
  LamEdgeBlock block;

  SetBlock(rve, edge, &block);
  GatherEdge(rve, F, y, &block, u, X);
  LamEdgeJump((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, s, rve->layer->bond[LAM_EDGE_POINTS * edge].law.beta,
              jump);
}

typedef struct {
  const LamLayer *layer;
  PetscReal sum;
} Energy;

static void AddEnergy(void *ctx, const LamBondPoint *point)
{
  Energy *energy = (Energy *)ctx;
  const LamLayer *layer = energy->layer;

  energy->sum +=
      layer->weight[point->point] * (point->step.phi + 0.5 * layer->bond[point->point].pressing * point->jump.r);
}

PetscReal LamLayerEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  Energy energy = {rve->layer, 0.0};

  LamLayerVisitPoints(rve, load->F, y, AddEnergy, &energy);
  return energy.sum;
}

typedef struct {
  LamRVE rve;
  PetscReal energy, *residual;
} Assembly;

static void AddEdge(void *ctx, const LamEdgeBlock *block)
{
  Assembly *a = (Assembly *)ctx;
  LamLinear *linear = a->rve->linear;
  const PetscInt *first = a->rve->layer->first[block->edge];

  a->energy += block->sum.energy;
  for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) a->residual[2 * block->class[i / 2] + i % 2] += block->sum.f[i];
  for (PetscInt i = 0; i < LAM_EDGE_NODES; ++i)
    for (PetscInt j = i; j < LAM_EDGE_NODES; ++j, ++first) {
      const PetscInt one = block->class[i], other = block->class[j];
      PetscInt entry[2][2];

      if (*first < 0) continue;
      LamLinearEntries(linear, one, other, *first, entry);
      for (PetscInt d = 0; d < 2; ++d)
        for (PetscInt e = i == j ? d : 0; e < 2; ++e) linear->values[entry[d][e]] += block->sum.K[2 * i + d][2 * j + e];
    }
}

void LamLayerAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy, PetscReal residual[])
{
  Assembly a = {.rve = rve, .residual = residual};

  LamLayerVisit(rve, load->F, y, AddEdge, &a);
  *energy += a.energy;
}

/* ---- history ---- */

/* Sets which hats an undamaged lamella holds: those with no other point in reach, half an edge. */
static void FindHeldHats(LamRVE rve)
{
  const LamLayer *layer = rve->layer;
  LamContact *contact = rve->contact;
  const PetscInt points = LAM_EDGE_POINTS * rve->mesh.along;

  for (PetscInt h = 0; h < contact->count; ++h) contact->held[h] = PETSC_TRUE;
  for (PetscInt p = 0; p < layer->count; ++p) {
    const PetscReal at = (PetscReal)(p % points / LAM_EDGE_POINTS) + LamEdgePlace(p % LAM_EDGE_POINTS);
    const PetscInt before = (PetscInt)(2.0 * at);

    if (LamBondIsUndamaged(&layer->bond[p])) continue;
    contact->held[p / points * contact->hats + before] = PETSC_FALSE;
    contact->held[p / points * contact->hats + before + 1] = PETSC_FALSE;
  }
}

void LamLayerTake(LamRVE rve, const LamRVEState state)
{
  LamLayer *layer = rve->layer;

  if (!layer) return;
  layer->secant = PETSC_FALSE;
  layer->spent = state->spent;
  layer->released = state->released;
  layer->work = state->work;
  for (PetscInt p = 0; p < layer->count; ++p) LamBondTake(&state->history[p], &layer->bond[p]);
  FindHeldHats(rve);
}

typedef struct {
  const LamLayer *layer;
  LamRVEState state;
  PetscReal V0;
} Keeping;

static void KeepBond(void *ctx, const LamBondPoint *point)
{
  const Keeping *k = (const Keeping *)ctx;
  const LamBond *bond = &k->layer->bond[point->point];

  k->state->history[point->point] = LamBondKeep(bond, &point->jump, &point->step);
  k->state->spent += k->layer->weight[point->point] * LamBondSpent(bond, &point->step) / k->V0;
}

void LamLayerKeep(LamRVE rve, const LamLoad *load, LamRVEState state)
{
  Keeping keeping = {rve->layer, state, rve->mesh.V0};

  if (!rve->layer) return;
  state->spent = rve->layer->spent;
  state->released = rve->layer->released;
  state->work = rve->layer->work;
  LamLayerVisitPoints(rve, load->F, rve->y, KeepBond, &keeping);
}
