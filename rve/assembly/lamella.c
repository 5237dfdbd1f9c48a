#include <lamella/lattice.h>
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

/* Places node k of an edge; image: NULL, or the shift of the image that it is of. */
static void PlaceNode(const LamMesh *mesh, PetscInt node, const PetscReal *image, PetscInt k, LamEdgeNodes *edge)
{
  edge->class[k] = mesh->node_class[node];
  for (PetscInt d = 0; d < 2; ++d) edge->shift[k][d] = mesh->shift[2 * node + d] + (image ? image[d] : 0.0);
}

static void SetWeights(LamLayer *layer, PetscInt edge)
{
  for (PetscInt q = 0; q < LAM_EDGE_POINTS; ++q)
    layer->weight[LAM_EDGE_POINTS * edge + q] = LamEdgeWeight(q) * layer->nodes[edge].length;
}

/* Edge e of a face: its nodes counter-clockwise around the slave. */
static void SetFaceEdge(const LamMesh *mesh, const LamContact *contact, PetscInt edge, LamLayer *layer)
{
  const LamContactFace *of = &contact->faces[edge / mesh->along];
  const PetscInt e = edge % mesh->along;
  LamEdgeNodes *nodes = &layer->nodes[edge];

  nodes->length = mesh->edge[of->face * mesh->along + e];
  for (PetscInt k = 0; k < 3; ++k) {
    const PetscInt ring[2] = {LamMeshRing(mesh, of->face, e, k),
                              LamMeshRing(mesh, of->partner, mesh->along - 1 - e, 2 - k)};

    PlaceNode(mesh, LamMeshNode(mesh, ring[0], mesh->radial_nodes - 1), NULL, k, nodes);
    PlaceNode(mesh, LamMeshNode(mesh, ring[1], mesh->radial_nodes - 1), of->shift, 3 + k, nodes);
  }
  SetWeights(layer, edge);
}

/* Edge m of a cut, from the lumen: the slave is the part before the cut, whose outside is to the right inwards. */
static void SetCutEdge(const LamMesh *mesh, PetscInt cut, PetscInt m, LamLayer *layer)
{
  const PetscInt edge = EdgeOf(layer->between) + cut * mesh->through + m;
  LamEdgeNodes *nodes = &layer->nodes[edge];
  PetscInt side[3][2];

  for (PetscInt k = 0; k < 3; ++k) {
    LamMeshCut(mesh, cut, 2 * m + 2 - k, side[k]);
    for (PetscInt s = 0; s < 2; ++s) PlaceNode(mesh, side[k][s], NULL, 3 * s + k, nodes);
  }
  nodes->length = PetscSqrtReal(PetscSqr(mesh->X[2 * side[0][0]] - mesh->X[2 * side[2][0]]) +
                                PetscSqr(mesh->X[2 * side[0][0] + 1] - mesh->X[2 * side[2][0] + 1]));
  SetWeights(layer, edge);
}

/* At the place s, in elements along the face. Across a notch nothing holds, nor on arcs, where air lies between. */
static LamCohesive LawOfFace(const LamMicrostructure *micro, const LamMesh *mesh, const LamContactFace *of, PetscReal s)
{
  const PetscReal face = mesh->length[of->face], at = face * LamMeshShare(mesh, of->face, s);
  const PetscInt *flat = mesh->flat[of->face], e = (PetscInt)s;
  PetscReal strength, energy;

  (void)LamLamellaFaceFactors(micro, of->cell, LamMeshLocalFace(mesh, of->face), &strength, &energy);
  if (LamLatticeIsCut(micro, of->cell, of->other) || e < flat[0] || e >= flat[1]) strength = energy = 0.0;
  return LawAt(&micro->lamella, strength, energy,
               (PetscBool)(PetscMin(at, face - at) < micro->lamella.junction_length));
}

static LamCohesive LawOfCut(const LamTearing *tearing)
{
  return (LamCohesive){.softening = LAM_SOFTENING_BILINEAR,
                       .stiffness = tearing->stiffness,
                       .strength = tearing->strength,
                       .beta = 1.0,
                       .energy = {tearing->energy, tearing->energy},
                       .mixing = 1.0};
}

void LamLayerSetLaws(const LamMicrostructure *micro, const LamMesh *mesh, const LamContact *contact, LamLayer *layer)
{
  layer->toughness[0] = layer->toughness[1] = 0.0;
  for (PetscInt p = 0; p < layer->count; ++p) {
    const PetscInt edge = EdgeOf(p);
    const PetscBool cut = (PetscBool)(p >= layer->between);
    LamBond *bond = &layer->bond[p];

    bond->law = cut ? LawOfCut(&micro->tearing)
                    : LawOfFace(micro, mesh, &contact->faces[edge / mesh->along],
                                (PetscReal)(edge % mesh->along) + LamEdgePlace(p % LAM_EDGE_POINTS));
    bond->closes = cut;
    layer->toughness[cut] += layer->weight[p] * LamEnvelopeOf(&bond->law, 0.0).energy / mesh->V0;
  }
}

PetscErrorCode LamLayerCreate(const LamMicrostructure *micro, const LamMesh *mesh, const LamContact *contact,
                              LamLayer **out)
{
  const PetscInt faces = contact->face_count * mesh->along, cuts = mesh->tissue->faces * mesh->cuts;
  const PetscInt edges = faces + cuts * mesh->through;
  LamLayer *layer;

  PetscFunctionBeginUser;
  PetscCheck(micro->lamella.stiffness > 0.0 && micro->lamella.strength > 0.0 && micro->lamella.energy > 0.0,
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "stiffness, strength and energy of the lamella must be positive, got %g, %g and %g",
             (double)micro->lamella.stiffness, (double)micro->lamella.strength, (double)micro->lamella.energy);
  PetscCheck(cuts == 0 || (micro->tearing.stiffness > 0.0 && micro->tearing.energy > 0.0), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "stiffness and energy of walls that tear must be positive, got %g and %g",
             (double)micro->tearing.stiffness, (double)micro->tearing.energy);
  PetscCall(PetscNew(&layer));
  layer->between = LAM_EDGE_POINTS * faces;
  layer->count = LAM_EDGE_POINTS * edges;
  PetscCall(PetscMalloc2(layer->count, &layer->weight, edges, &layer->first));
  PetscCall(PetscCalloc4(layer->count, &layer->bond, edges, &layer->nodes, cuts, &layer->torn,
                         cuts ? mesh->cell_count : 0, &layer->burst));
  for (PetscInt edge = 0; edge < faces; ++edge) SetFaceEdge(mesh, contact, edge, layer);
  for (PetscInt k = 0; k < cuts * mesh->through; ++k) SetCutEdge(mesh, k / mesh->through, k % mesh->through, layer);
  LamLayerSetLaws(micro, mesh, contact, layer);
  *out = layer;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLayerDestroy(LamLayer **layer)
{
  PetscFunctionBeginUser;
  if (!*layer) PetscFunctionReturn(0);
  PetscCall(PetscFree2((*layer)->weight, (*layer)->first));
  PetscCall(PetscFree4((*layer)->bond, (*layer)->nodes, (*layer)->torn, (*layer)->burst));
  PetscCall(PetscFree(*layer));
  PetscFunctionReturn(0);
}

void LamLayerSetMatrix(LamRVE rve)
{
  for (PetscInt edge = 0; edge < EdgeOf(rve->layer->count); ++edge) {
    const LamEdgeNodes *nodes = &rve->layer->nodes[edge];
    PetscInt pair = 0;

    for (PetscInt i = 0; i < LAM_EDGE_NODES; ++i)
      for (PetscInt j = i; j < LAM_EDGE_NODES; ++j, ++pair)
        rve->layer->first[edge][pair] = LamLinearBlock(rve->linear, nodes->class[i], nodes->class[j]);
  }
}

/* Displacements of an edge's nodes, without the cancellation of positions, and their reference positions. */
static void GatherEdge(LamRVE rve, const PetscReal F[9], const PetscReal y[], const LamEdgeNodes *nodes,
                       PetscReal u[LAM_EDGE_NODES][2], PetscReal X[LAM_EDGE_NODES][2])
{
  const PetscReal H[4] = {F[0] - 1.0, F[1], F[3], F[4] - 1.0};

  for (PetscInt k = 0; k < LAM_EDGE_NODES; ++k)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt at = 2 * nodes->class[k] + d;

      X[k][d] = rve->mesh.class_X[at] + nodes->shift[k][d];
      u[k][d] = (y[at] - rve->mesh.class_X[at]) + (H[2 * d] * nodes->shift[k][0] + H[2 * d + 1] * nodes->shift[k][1]);
    }
}

/* Whether an edge has nodes that move. */
static PetscBool IsInPart(LamRVE rve, PetscInt edge)
{
  const PetscInt faces = EdgeOf(rve->layer->between);
  const LamContactFace *face = &rve->contact->faces[edge / rve->mesh.along];

  if (!rve->part) return PETSC_TRUE;
  if (edge >= faces) return LamMoves(rve, LamMeshCellOfCut(&rve->mesh, (edge - faces) / rve->mesh.through));
  return (PetscBool)(LamMoves(rve, face->cell) || LamMoves(rve, face->other));
}

void LamLayerVisit(LamRVE rve, const PetscReal F[9], const PetscReal y[], LamEdgeVisitor visitor, void *ctx)
{
  const LamLayer *layer = rve->layer;

  for (PetscInt edge = 0; edge < EdgeOf(layer->count); ++edge) {
    const PetscInt first = LAM_EDGE_POINTS * edge;
    PetscReal u[LAM_EDGE_NODES][2], X[LAM_EDGE_NODES][2];
    LamEdgeBlock block = {.edge = edge, .nodes = &layer->nodes[edge]};

    if (!IsInPart(rve, edge)) continue;
    GatherEdge(rve, F, y, block.nodes, u, X);
    LamEdgeEvaluate((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, &layer->bond[first], block.nodes->length,
                    layer->secant, &block.sum);
    visitor(ctx, &block);
  }
}

void LamLayerVisitPoints(LamRVE rve, const PetscReal F[9], const PetscReal y[], LamBondVisitor visitor, void *ctx)
{
  const LamLayer *layer = rve->layer;
  const PetscInt faces = EdgeOf(layer->between);

  for (PetscInt edge = 0; edge < EdgeOf(layer->count); ++edge) {
    const PetscInt at = edge < faces ? edge % rve->mesh.along : (edge - faces) % rve->mesh.through;
    PetscReal u[LAM_EDGE_NODES][2], X[LAM_EDGE_NODES][2];

    if (!IsInPart(rve, edge)) continue;
    GatherEdge(rve, F, y, &layer->nodes[edge], u, X);
    for (PetscInt q = 0; q < LAM_EDGE_POINTS; ++q) {
      LamBondPoint point = {.point = LAM_EDGE_POINTS * edge + q,
                            .face = edge < faces ? edge / rve->mesh.along : -1,
                            .at = (PetscReal)at + LamEdgePlace(q)};

      LamEdgePointEvaluate((const PetscReal(*)[2])X, (const PetscReal(*)[2])u, q, &layer->bond[point.point],
                           &point.jump, &point.step);
      visitor(ctx, &point);
    }
  }
}

void LamLayerJump(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt edge, PetscReal s, LamJump *jump)
{
  PetscReal u[LAM_EDGE_NODES][2], X[LAM_EDGE_NODES][2];

  GatherEdge(rve, F, y, &rve->layer->nodes[edge], u, X);
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
  const PetscReal *along; /* change of F per share of a path */
  PetscReal sum, slope, *gradient, *by_cell;
} Spending;

/* Of D at kappa = delta: dD/dq = (T/delta - dT/ddelta)/4 = -q phi''. */
static void AddSpent(void *ctx, const LamBondPoint *point)
{
  Spending *s = (Spending *)ctx;
  const LamBond *bond = &s->rve->layer->bond[point->point];
  const PetscReal weight = s->rve->layer->weight[point->point], slope = -weight * point->step.dd * point->jump.q;
  const PetscReal spent = weight * LamBondSpent(bond, &point->step);
  const LamEdgeNodes *nodes = &s->rve->layer->nodes[EdgeOf(point->point)];
  PetscReal gradient[LAM_EDGE_DOFS];

  s->sum += spent;
  if (point->face >= 0) {
    s->by_cell[s->rve->contact->faces[point->face].cell] += spent;
    s->by_cell[s->rve->contact->faces[point->face].other] += spent;
  }
  if (!(slope > 0.0)) return;
  LamEdgeSpread(point->point % LAM_EDGE_POINTS, slope, point->jump.dq, gradient);
  for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) {
    const PetscReal *S = nodes->shift[i / 2], *along = &s->along[3 * (i % 2)];

    s->gradient[2 * nodes->class[i / 2] + i % 2] += gradient[i];
    s->slope += gradient[i] * (along[0] * S[0] + along[1] * S[1]);
  }
}

PetscReal LamLayerSpent(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal along[9],
                        PetscReal gradient[], PetscReal *slope, PetscReal by_cell[])
{
  Spending s = {.rve = rve, .along = along, .gradient = gradient, .by_cell = by_cell};

  for (PetscInt i = 0; i < rve->length; ++i) gradient[i] = 0.0;
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) by_cell[c] = 0.0;
  LamLayerVisitPoints(rve, load->F, y, AddSpent, &s);
  *slope = s.slope;
  return s.sum;
}

typedef struct {
  LamRVE rve;
  PetscReal energy, *residual;
} Assembly;

static void AddEdge(void *ctx, const LamEdgeBlock *block)
{
  Assembly *a = (Assembly *)ctx;
  LamLinear *linear = a->rve->linear;
  const PetscInt *first = a->rve->layer->first[block->edge], *class = block->nodes->class;

  a->energy += block->sum.energy;
  for (PetscInt i = 0; i < LAM_EDGE_DOFS; ++i) a->residual[2 * class[i / 2] + i % 2] += block->sum.f[i];
  for (PetscInt i = 0; i < LAM_EDGE_NODES; ++i)
    for (PetscInt j = i; j < LAM_EDGE_NODES; ++j, ++first) {
      const PetscInt one = class[i], other = class[j];
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
  for (PetscInt p = 0; p < layer->between; ++p) {
    const PetscReal at = (PetscReal)(p % points / LAM_EDGE_POINTS) + LamEdgePlace(p % LAM_EDGE_POINTS);
    const PetscInt before = (PetscInt)(2.0 * at);

    if (LamBondIsUndamaged(&layer->bond[p])) continue;
    contact->held[p / points * contact->hats + before] = PETSC_FALSE;
    contact->held[p / points * contact->hats + before + 1] = PETSC_FALSE;
  }
}

/* Which cuts are broken through. */
static void FindTorn(LamRVE rve)
{
  LamLayer *layer = rve->layer;
  const PetscInt through = LAM_EDGE_POINTS * rve->mesh.through, cuts = rve->mesh.tissue->faces * rve->mesh.cuts;

  for (PetscInt k = 0; k < cuts; ++k) {
    const LamBond *bond = &layer->bond[layer->between + k * through];

    layer->torn[k] = PETSC_TRUE;
    for (PetscInt q = 0; q < through; ++q)
      if (!LamBondIsBroken(&bond[q], bond[q].kappa)) layer->torn[k] = PETSC_FALSE;
  }
  if (cuts) LamWallsTearAt(&rve->smooth->walls, layer->torn);
}

/* Energy of a cell's fluid at rve->y less that of the same fluid without pressure; sealed water is compressible. */
static PetscReal FluidEnergy(LamRVE rve, const LamLoad *load, PetscInt cell)
{
  const PetscReal p0 = load->turgor * LamTurgorFactor(rve, cell);

  if (rve->seal.closed) return -0.5 * rve->seal.water[cell] * p0 * p0 / rve->seal.bulk_modulus;
  return -p0 * load->F[8] * rve->seal.area[cell];
}

static void Empty(LamRVE rve, const LamLoad *load, PetscInt cell)
{
  LamLayer *layer = rve->layer;

  LamLumenAreas(rve, rve->y, rve->seal.area);
  layer->work -= FluidEnergy(rve, load, cell) / rve->mesh.V0;
  layer->spilt -= FluidEnergy(rve, load, cell) / rve->mesh.V0;
  layer->juice += load->F[8] * rve->seal.area[cell] / rve->mesh.V0;
  layer->burst[cell] = PETSC_TRUE;
  if (rve->seal.closed) rve->y[rve->ndof + cell] = 0.0;
}

typedef struct {
  LamRVE rve;
  PetscBool *broken;     /* [cut] */
  LamBondHistory *after; /* [point of a cut] */
  PetscReal *spent;      /* likewise: in this step, per V0 */
} Tearing;

static void WatchCut(void *ctx, const LamBondPoint *point)
{
  const Tearing *t = (const Tearing *)ctx;
  const LamLayer *layer = t->rve->layer;
  const LamBond *bond = &layer->bond[point->point];
  const PetscInt k = point->point - layer->between;

  if (point->face >= 0) return;
  t->after[k] = LamBondKeep(bond, &point->jump, &point->step);
  t->spent[k] = layer->weight[point->point] * LamBondSpent(bond, &point->step) / t->rve->mesh.V0;
  if (!LamBondIsBroken(bond, point->step.kappa)) t->broken[k / (LAM_EDGE_POINTS * t->rve->mesh.through)] = PETSC_FALSE;
}

PetscErrorCode LamLayerBurst(LamRVE rve, const LamLoad *load, PetscBool *any)
{
  LamLayer *layer = rve->layer;
  const PetscInt cuts = rve->mesh.tissue->faces * rve->mesh.cuts, through = LAM_EDGE_POINTS * rve->mesh.through;
  Tearing t = {.rve = rve};

  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  if (!cuts) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(cuts, &t.broken, cuts * through, &t.after, cuts * through, &t.spent));
  for (PetscInt k = 0; k < cuts; ++k) t.broken[k] = PETSC_TRUE;
  LamLayerVisitPoints(rve, load->F, rve->y, WatchCut, &t);
  for (PetscInt k = 0; k < cuts; ++k) {
    if (!t.broken[k] || LamHasBurst(rve, LamMeshCellOfCut(&rve->mesh, k))) continue;
    *any = layer->torn[k] = PETSC_TRUE;
    for (PetscInt q = k * through; q < (k + 1) * through; ++q) {
      LamBondTake(&t.after[q], &layer->bond[layer->between + q]);
      layer->spent += t.spent[q];
    }
    Empty(rve, load, LamMeshCellOfCut(&rve->mesh, k));
  }
  if (*any) LamWallsTearAt(&rve->smooth->walls, layer->torn);
  PetscCall(PetscFree3(t.broken, t.after, t.spent));
  PetscFunctionReturn(0);
}

void LamLayerTake(LamRVE rve, const LamRVEState state)
{
  LamLayer *layer = rve->layer;

  if (!layer) return;
  layer->secant = PETSC_FALSE;
  layer->spent = state->spent;
  layer->released = state->released;
  layer->work = state->work;
  layer->juice = state->juice;
  layer->spilt = state->spilt;
  (void)PetscArraycpy(layer->burst, state->burst, state->cells);
  for (PetscInt p = 0; p < layer->count; ++p) LamBondTake(&state->history[p], &layer->bond[p]);
  FindHeldHats(rve);
  FindTorn(rve);
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
  state->juice = rve->layer->juice;
  state->spilt = rve->layer->spilt;
  (void)PetscArraycpy(state->burst, rve->layer->burst, state->cells);
  LamLayerVisitPoints(rve, load->F, rve->y, KeepBond, &keeping);
}
