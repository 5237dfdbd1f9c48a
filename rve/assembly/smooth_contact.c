/*
  The smooth contact potential: sums over pairs of spans, couplings of the matrix, and what the two laws share.

  Method. Walls that face each other are coupled in the matrix from the start. If other walls meet, or facing ones slide
  further, the pattern grows by the pairs of nodes met, with a margin; each solve starts again from the first pattern,
  so that its result depends on load and state alone.
*/
#include "part.h"

#define SLIDING 6 /* nodes by which facing walls may slide before the pattern grows */
#define MARGIN 2  /* nodes around walls that meet */

/* ---- the sums ---- */

typedef struct {
  LamRVE rve;
  const LamLoad *load;
  LamTouchWanted wanted;
  LamTouchBlock block;
  PetscBool open; /* block holds a sum that has not been passed on */
  LamTouchBlockVisitor visitor;
  void *ctx;
} Sum;

LamTouchStrength LamTouchStrengthOf(LamRVE rve, const LamLoad *load, PetscInt a, PetscInt b)
{
  const PetscReal p = 0.5 * (LamTurgorFactor(rve, a) + LamTurgorFactor(rve, b));
  const PetscReal g = LamFaceCohesion(&rve->micro, a, b), press = p * load->turgor + g * load->cohesion;
  const PetscReal s = PetscSqrtReal(press * press + LAM_LEAST_STRENGTH * LAM_LEAST_STRENGTH);
  const PetscReal second = LAM_LEAST_STRENGTH * LAM_LEAST_STRENGTH / (s * s * s);

  return (LamTouchStrength){
      .s = s, .p = p * press / s, .g = g * press / s, .pp = p * p * second, .pg = p * g * second, .gg = g * g * second};
}

void LamTouchLawOf(LamRVE rve, PetscReal gap, LamTouchLaw *law)
{
  const PetscReal width = rve->smooth->width;

  if (!rve->layer) {
    LamTouchLawEvaluate(gap, width, law);
    return;
  }
  LamTouchLawEvaluate(gap + width, width, law);
  law->phi_width += law->d;
  law->d_width += law->dd;
}

static void OpenBlock(Sum *sum, const LamTouching *touch)
{
  const LamRVE rve = sum->rve;
  const LamWalls *walls = &rve->smooth->walls;
  LamTouchBlock *block = &sum->block;

  block->loop = touch->loop;
  block->span = touch->span;
  block->other = touch->other;
  block->at = touch->at;
  block->lumen = LamTouchIsLumen(touch);
  block->strength = LamTouchStrengthOf(rve, sum->load, touch->loop / 2, touch->other / 2);
  block->energy = block->energy_width = 0.0;
  sum->open = PETSC_TRUE;
  if (sum->wanted == LAM_TOUCH_ENERGY) return;
  block->facing = LamTouchIsFacing(walls, touch);
  (void)PetscArrayzero(block->f, LAM_BLOCK_DOFS);
  (void)PetscArrayzero(block->f_width, LAM_BLOCK_DOFS);
  (void)PetscMemzero(block->K, sizeof(block->K));
  for (PetscInt k = 0; k < LAM_BLOCK_NODES; ++k) {
    const PetscBool own = (PetscBool)(k < LAM_SPAN_NODES);
    const PetscInt node =
        LamWallsNode(walls, own ? touch->loop : touch->other, own ? touch->span : touch->at, k % LAM_SPAN_NODES);

    block->class[k] = rve->mesh.node_class[node];
    for (PetscInt d = 0; d < 2; ++d) block->shift[k][d] = rve->mesh.shift[2 * node + d] + (own ? 0.0 : touch->shift[d]);
  }
}

static void CloseBlock(Sum *sum)
{
  LamTouchBlock *block = &sum->block;

  if (!sum->open) return;
  sum->open = PETSC_FALSE;
  for (PetscInt i = LAM_BLOCK_DOFS / 2; i < LAM_BLOCK_DOFS && sum->wanted == LAM_TOUCH_WIDTH; ++i)
    for (PetscInt j = 0; j < LAM_BLOCK_DOFS / 2; ++j) block->K[i][j] = block->K[j][i];
  sum->visitor(sum->ctx, block);
}

/* Dependence of a touching point and of the closest point on the nodes of the block. */
static void WeighNodes(const LamWalls *walls, const LamTouching *touch, LamTouchWeights *weights)
{
  const PetscReal(*share)[LAM_SPAN_NODES] = LamWallsSpan(walls, touch->other, touch->at)->share;
  const PetscReal *point = LamWallsSpan(walls, touch->loop, touch->span)->point[touch->point];
  LamSplineWeights spline;

  LamSplineWeightsAt(touch->gap.t, &spline);
  for (PetscInt i = 0; i < LAM_SPAN_NODES; ++i) {
    PetscReal N = 0.0, dN = 0.0;

    for (PetscInt a = 0; a < LAM_SPAN; ++a) {
      N += spline.N[a] * share[a][i];
      dN += spline.dN[a] * share[a][i];
    }
    weights->N[i] = point[i];
    weights->dN[i] = 0.0;
    weights->N[LAM_SPAN_NODES + i] = -N;
    weights->dN[LAM_SPAN_NODES + i] = dN;
  }
}

static void AddTouch(void *ctx, const LamTouching *touch)
{
  Sum *sum = (Sum *)ctx;
  LamTouchBlock *block = &sum->block;
  const PetscReal half = 0.5 * touch->weight;
  LamTouchWeights weights;
  LamTouchLaw law;

  if (sum->open && (block->loop != touch->loop || block->span != touch->span || block->other != touch->other ||
                    block->at != touch->at))
    CloseBlock(sum);
  if (!sum->open) OpenBlock(sum, touch);
  LamTouchLawOf(sum->rve, touch->gap.gap, &law);
  block->energy += half * law.phi;
  if (sum->wanted == LAM_TOUCH_ENERGY) return;
  WeighNodes(&sum->rve->smooth->walls, touch, &weights);
  LamTouchAddVariation(&touch->gap, &weights, half * law.d, half * law.dd, block->f, block->K);
  if (sum->wanted != LAM_TOUCH_WIDTH) return;
  block->energy_width += half * law.phi_width;
  LamTouchAddVariation(&touch->gap, &weights, half * law.d_width, 0.0, block->f_width, NULL);
}

void LamSmoothVisit(LamRVE rve, const LamLoad *load, const PetscReal y[], LamTouchWanted wanted,
                    LamTouchBlockVisitor visitor, void *ctx)
{
  Sum sum = {.rve = rve, .load = load, .wanted = wanted, .visitor = visitor, .ctx = ctx};

  LamWallsPlace(&rve->smooth->walls, load->F, y);
  LamWallsVisit(&rve->smooth->walls, rve->smooth->width, AddTouch, &sum);
  CloseBlock(&sum);
}

static void AddEnergy(void *ctx, const LamTouchBlock *block)
{
  *(PetscReal *)ctx += block->strength.s * block->energy;
}

PetscReal LamSmoothEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  PetscReal energy = 0.0;

  LamSmoothVisit(rve, load, y, LAM_TOUCH_ENERGY, AddEnergy, &energy);
  return load->F[8] * energy;
}

/* ---- the matrix ---- */

static PetscErrorCode Couple(LamSmooth *smooth, PetscInt a, PetscInt b)
{
  PetscFunctionBeginUser;
  if (smooth->count == smooth->room) {
    const PetscInt room = PetscMax(1024, 2 * smooth->room);
    PetscInt(*more)[2];

    PetscCall(PetscMalloc1(room, &more));
    PetscCall(PetscArraycpy(more, smooth->pairs, smooth->count));
    PetscCall(PetscFree(smooth->pairs));
    smooth->pairs = more;
    smooth->room = room;
  }
  smooth->pairs[smooth->count][0] = a;
  smooth->pairs[smooth->count++][1] = b;
  PetscFunctionReturn(0);
}

/* Couples node i of one loop with the nodes of another one from j - reach to j + reach. */
static PetscErrorCode AddNear(LamRVE rve, PetscInt loop, PetscInt i, PetscInt other, PetscInt j, PetscInt reach)
{
  LamSmooth *smooth = rve->smooth;
  const LamWalls *walls = &smooth->walls;
  const PetscInt *class = rve->mesh.node_class;

  PetscFunctionBeginUser;
  for (PetscInt k = j - reach; k <= j + reach; ++k)
    PetscCall(Couple(smooth, class[LamWallsNodeAt(walls, loop, i)], class[LamWallsNodeAt(walls, other, k)]));
  PetscFunctionReturn(0);
}

/* Couplings along each wall (its contour is wider than its elements) and of facing walls. */
static PetscErrorCode AddFacing(LamRVE rve)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt per_face = mesh->face_nodes, beyond = LAM_SPAN_NODES / 2; /* of spans at corners */
  const PetscInt last =
      per_face - (mesh->cuts ? 1 : 0); /* node of a face; in a ring that is whole it begins the next */

  PetscFunctionBeginUser;
  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell)
    for (PetscInt i = 0; i < LamMeshRingNodes(mesh, cell); ++i)
      PetscCall(AddNear(rve, 2 * cell, i, 2 * cell, i, LAM_SPAN_NODES - 1));
  for (PetscInt f = 0; f < rve->contact->face_count; ++f) {
    const LamContactFace *face = &rve->contact->faces[f];
    const PetscInt here = per_face * LamMeshLocalFace(mesh, face->face);
    const PetscInt there = per_face * LamMeshLocalFace(mesh, face->partner) + last;

    for (PetscInt i = -beyond; i <= last + beyond; ++i)
      PetscCall(AddNear(rve, 2 * face->cell, here + i, 2 * face->other, there - i, SLIDING));
  }
  PetscFunctionReturn(0);
}

/* Couplings of both sides of the cuts. */
static PetscErrorCode AddCuts(LamRVE rve)
{
  const LamMesh *mesh = &rve->mesh;

  PetscFunctionBeginUser;
  for (PetscInt cut = 0; cut < mesh->tissue->faces * mesh->cuts; ++cut)
    for (PetscInt k = 0; k < 9 * mesh->through; ++k) {
      const PetscInt m = k / 9;
      PetscInt one[2], other[2];

      LamMeshCut(mesh, cut, 2 * m + k % 3, one);
      LamMeshCut(mesh, cut, 2 * m + k / 3 % 3, other);
      PetscCall(Couple(rve->smooth, mesh->node_class[one[0]], mesh->node_class[other[1]]));
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateSystem(LamRVE rve, LamLinear *linear)
{
  const LamCouplings couplings = {.pair_count = rve->smooth->count, .pairs = (const PetscInt(*)[2])rve->smooth->pairs};

  PetscFunctionBeginUser;
  PetscCall(LamLinearCreate(&rve->mesh, &couplings, rve->seal.allowed ? rve->mesh.cell_count : 0, linear));
  PetscFunctionReturn(0);
}

static void ForgetEntries(const LamSmooth *smooth)
{
  for (PetscInt k = 0; k < LAM_KEPT * smooth->walls.first[smooth->walls.loops]; ++k) smooth->entries[k].block[0] = -1;
}

/* Makes a system the one in use. */
static void Use(LamRVE rve, PetscInt system)
{
  if (rve->smooth->entries) ForgetEntries(rve->smooth);
  rve->linear = &rve->systems[system];
  LamGapAreaSetMatrix(rve->linear, &rve->contact->gaps);
  if (rve->layer) LamLayerSetMatrix(rve);
  LamForgetTangent(rve);
}

PetscErrorCode LamSmoothCreate(LamRVE rve)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&rve->smooth));
  PetscCall(LamWallsCreate(&rve->micro, &rve->mesh, &rve->smooth->walls));
  PetscCall(AddFacing(rve));
  PetscCall(AddCuts(rve));
  rve->smooth->base_count = rve->smooth->count;
  PetscCall(CreateSystem(rve, &rve->systems[LAM_SYSTEM_BASE]));
  rve->smooth->width = LAM_USUAL_WIDTH;
  Use(rve, LAM_SYSTEM_BASE);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSmoothDestroy(LamSmooth **smooth)
{
  PetscFunctionBeginUser;
  if (!*smooth) PetscFunctionReturn(0);
  PetscCall(LamWallsDestroy(&(*smooth)->walls));
  PetscCall(PetscFree((*smooth)->pairs));
  PetscCall(PetscFree((*smooth)->entries));
  PetscCall(PetscFree(*smooth));
  PetscFunctionReturn(0);
}

PetscErrorCode LamUseSmoothLaw(LamRVE rve, PetscReal width)
{
  PetscFunctionBeginUser;
  rve->contact->exact = PETSC_FALSE;
  rve->smooth->width = width;
  LamWallsRound(&rve->smooth->walls, width);
  Use(rve, rve->systems[LAM_SYSTEM_GROWN].row ? LAM_SYSTEM_GROWN : LAM_SYSTEM_BASE);
  PetscFunctionReturn(0);
}

PetscErrorCode LamUseExactLaw(LamRVE rve)
{
  LamLinear *linear = &rve->systems[LAM_SYSTEM_EXACT];
  const LamContact *contact = rve->contact;

  PetscFunctionBeginUser;
  if (!linear->row) {
    const LamCouplings couplings = {.count = contact->face_count,
                                    .size = contact->chain,
                                    .multipliers = contact->hats,
                                    .classes = contact->classes};

    PetscCall(LamLinearCreate(&rve->mesh, &couplings, rve->seal.allowed ? rve->mesh.cell_count : 0, linear));
    PetscCall(LamContactSetMatrix(linear, rve->contact));
  }
  rve->contact->exact = PETSC_TRUE;
  LamWallsRound(&rve->smooth->walls, 0.0);
  Use(rve, LAM_SYSTEM_EXACT);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSmoothReset(LamRVE rve)
{
  PetscFunctionBeginUser;
  PetscCall(LamLinearDestroy(&rve->systems[LAM_SYSTEM_GROWN]));
  rve->smooth->count = rve->smooth->base_count;
  PetscCall(LamUseSmoothLaw(rve, LAM_USUAL_WIDTH));
  PetscFunctionReturn(0);
}

static PetscErrorCode Grow(LamRVE rve)
{
  LamLinear *grown = &rve->systems[LAM_SYSTEM_GROWN];

  PetscFunctionBeginUser;
  PetscCall(LamLinearDestroy(grown));
  PetscCall(CreateSystem(rve, grown));
  Use(rve, LAM_SYSTEM_GROWN);
  PetscFunctionReturn(0);
}

typedef struct {
  LamRVE rve;
  PetscReal F33, energy, *residual;
  PetscBool missing; /* a pair of the last blocks is not in the pattern */
  PetscErrorCode error;
} Assembly;

/* Entries of all pairs of nodes of a block; NULL: not all are in the pattern. */
static const PetscInt *FindEntries(LamRVE rve, const LamTouchBlock *block)
{
  const LamSmooth *smooth = rve->smooth;
  const PetscInt span = smooth->walls.first[block->loop] + block->span;
  const PetscInt name[4] = {block->loop, block->span, block->other, block->at};
  LamBlockEntries *entries = &smooth->entries[LAM_KEPT * span + block->at % LAM_KEPT];
  PetscInt pair = 0;

  if (memcmp(entries->block, name, sizeof(name)) == 0) return entries->first;
  entries->block[0] = -1;
  for (PetscInt i = 0; i < LAM_BLOCK_NODES; ++i)
    for (PetscInt j = i; j < LAM_BLOCK_NODES; ++j, ++pair) {
      const PetscInt a = block->class[i], b = block->class[j];

      entries->first[pair] = LamLinearBlock(rve->linear, a, b);
      if (a != 0 && b != 0 && entries->first[pair] < 0) return NULL;
    }
  (void)PetscArraycpy(entries->block, name, 4);
  return entries->first;
}

/* Adds the 2 x 2 entries of nodes i and j of a block to the values; first: that of their classes. */
static void ScatterPair(LamLinear *linear, const LamTouchBlock *block, PetscInt i, PetscInt j, PetscInt first,
                        PetscReal factor)
{
  const PetscInt a = block->class[i], b = block->class[j];
  PetscInt entry[2][2];

  if (first < 0) return;
  LamLinearEntries(linear, a, b, first, entry);
  for (PetscInt d = 0; d < 2; ++d)
    for (PetscInt e = a == b ? d : 0; e < 2; ++e) {
      PetscReal value = block->K[2 * i + d][2 * j + e];

      if (a == b && i != j) value += block->K[2 * i + e][2 * j + d];
      linear->values[entry[d][e]] += factor * value;
    }
}

static PetscErrorCode Record(LamRVE rve, const LamTouchBlock *block)
{
  const LamSpanNodes *of = rve->smooth->walls.of;
  const PetscInt here = of[block->span].first, there = of[block->at].first, middle = LAM_SPAN_NODES / 2;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < LAM_SPAN_NODES; ++i) {
    PetscCall(AddNear(rve, block->loop, here + i, block->other, there + middle, MARGIN + middle));
    PetscCall(AddNear(rve, block->loop, here + i, block->loop, here + i, LAM_SPAN_NODES - 1));
    PetscCall(AddNear(rve, block->other, there + i, block->other, there + i, LAM_SPAN_NODES - 1));
  }
  PetscFunctionReturn(0);
}

static void AddBlock(void *ctx, const LamTouchBlock *block)
{
  Assembly *a = (Assembly *)ctx;
  const PetscReal factor = a->F33 * block->strength.s;
  const PetscInt *first = FindEntries(a->rve, block);

  a->energy += factor * block->energy;
  for (PetscInt i = 0; i < LAM_BLOCK_DOFS; ++i) a->residual[2 * block->class[i / 2] + i % 2] += factor * block->f[i];
  for (PetscInt i = 0; i < LAM_BLOCK_NODES && first; ++i)
    for (PetscInt j = i; j < LAM_BLOCK_NODES; ++j) ScatterPair(a->rve->linear, block, i, j, *first++, factor);
  if (first) return;
  a->missing = PETSC_TRUE;
  if (!a->error) a->error = Record(a->rve, block);
}

PetscErrorCode LamSmoothAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscReal residual[])
{
  Assembly a = {.rve = rve, .F33 = load->F[8], .residual = residual};
  LamSmooth *smooth = rve->smooth;

  PetscFunctionBeginUser;
  if (!smooth->entries) {
    PetscCall(PetscMalloc1(LAM_KEPT * smooth->walls.first[smooth->walls.loops], &smooth->entries));
    ForgetEntries(smooth);
  }
  do {
    PetscCall(LamPartClear(rve, residual));
    a.energy = 0.0;
    a.missing = PETSC_FALSE;
    LamSmoothVisit(rve, load, y, LAM_TOUCH_TANGENT, AddBlock, &a);
    PetscCall(a.error);
    if (a.missing) PetscCall(Grow(rve));
  } while (a.missing);
  *energy += a.energy;
  PetscFunctionReturn(0);
}
