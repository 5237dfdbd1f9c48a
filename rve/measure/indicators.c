/*
  Debonding indicators of a state: how far cells have separated, where, and which cells are still connected.

  Method. The slave side of every face is sampled along the segments of the overlap. Fractions of the interface refer
  to the reference length of the slave walls. A wall outside the overlap faces a junction void: it has no contact and
  does not count as a gap. A face without any overlap is entirely open. Mean tractions are Cauchy: the force over the
  current length of the whole face, tension positive. A lamella that is not broken closes a wall as contact does.
*/
#include "measure.h"
#include "mortar_impl.h"

#define SAMPLES 4        /* intervals of a segment */
#define WINDOW_SAMPLES 8 /* per edge, for the largest mean traction */

/* Sums over the faces of one family. */
typedef struct {
  PetscReal length;                /* reference length of the slave walls */
  PetscReal current_length, force; /* force: normal, tension > 0, per reference thickness */
  PetscReal closed, open;          /* reference lengths */
  PetscReal opening;               /* area between the walls */
  PetscReal gap;                   /* integral of the gap over the reference length */
} FamilySums;

typedef struct {
  FamilySums family[3];
  PetscReal max_gap, min_gap, max_penetration;
  PetscReal named_gap;    /* gap at the location reported for max_gap */
  PetscReal gap_at;       /* that location, in edges of its face */
  PetscReal gap_place[3]; /* that location as cell, face, fraction of the face */
  LamLargestMean traction, shear;
  LamLayerForces layer;
  PetscReal fabric[3], jumps[3];
} Sums;

/* Fraction of an interval with linear values a, b that lies above a threshold. */
static PetscReal ShareAbove(PetscReal a, PetscReal b, PetscReal threshold)
{
  const PetscReal high = PetscMax(a, b), low = PetscMin(a, b);

  if (low > threshold) return 1.0;
  return high <= threshold ? 0.0 : (high - threshold) / (high - low);
}

static void SampleSegment(const LamMortarChains *chains, PetscReal from, PetscReal to, PetscInt master,
                          FamilySums *family, Sums *sums)
{
  const PetscInt edge = (PetscInt)(0.5 * (from + to)); /* also at the segment's ends */
  const PetscReal ds = (to - from) / SAMPLES, J0 = chains->J0[edge];
  PetscReal last = 0.0;

  for (PetscInt k = 0; k <= SAMPLES; ++k) {
    const PetscReal s = PetscMin(from + ds * (PetscReal)k, (PetscReal)edge + 1.0 - 1e-12);
    PetscReal nearest[2], X[2], Xs[2];
    const PetscReal gap = LamMortarGap(chains, s, master, nearest);

    sums->max_gap = PetscMax(sums->max_gap, gap);
    if (LamExceeds(gap, sums->named_gap)) {
      sums->named_gap = gap;
      sums->gap_at = s;
    }
    /* the gap extends past the edge's ends, where it is a little smaller than the distance */
    if (gap < sums->min_gap)
      sums->min_gap = PetscMin(sums->min_gap, gap > 0.0 ? LamMortarDistance(chains, s, master) : gap);
    sums->max_penetration = PetscMax(sums->max_penetration, -gap);
    if (k > 0) {
      const PetscReal mean = 0.5 * (PetscMax(0.0, last) + PetscMax(0.0, gap));

      LamMortarSlavePoint(chains, s - 0.5 * ds, X, Xs);
      family->open += ShareAbove(last, gap, LAM_VISIBLE_GAP) * ds * J0;
      family->gap += mean * ds * J0;
      family->opening += mean * ds * PetscSqrtReal(LamDot(Xs, Xs));
    }
    last = gap;
  }
}

/* Force of contact over the part of [a, b] that lies in the overlap [lo, hi]: linear on a half-edge, so the midpoint
   rule is exact. */
static PetscReal ContactForce(const LamMortarChains *chains, const PetscReal lambda[], PetscReal a, PetscReal b,
                              PetscReal lo, PetscReal hi)
{
  const PetscReal from = PetscMax(a, lo), to = PetscMin(b, hi), s = 0.5 * (from + to);
  const PetscInt piece = (PetscInt)(2.0 * s);
  const PetscReal u = 2.0 * s - (PetscReal)piece;

  if (to <= from) return 0.0;
  return (to - from) * chains->J0[(PetscInt)s] * ((1.0 - u) * lambda[piece] + u * lambda[piece + 1]);
}

/* Normal force and current length along one face: running integrals at WINDOW_SAMPLES per edge. layer: forces of the
   lamella, or NULL. */
static void FaceForce(const LamMortarChains *chains, const PetscReal lambda[], PetscReal lo, PetscReal hi, PetscReal g,
                      PetscReal F33, const PetscReal layer[], PetscReal force[], PetscReal length[])
{
  const PetscReal h = 1.0 / WINDOW_SAMPLES;

  force[0] = length[0] = 0.0;
  for (PetscInt k = 0; k < chains->n * WINDOW_SAMPLES; ++k) {
    PetscReal ds = 0.0;

    for (PetscInt side = -1; side <= 1; side += 2) {
      PetscReal X[2], Xs[2];

      LamMortarSlavePoint(chains, h * ((PetscReal)k + 0.5 + 0.5 * (PetscReal)side / PetscSqrtReal(3.0)), X, Xs);
      ds += 0.5 * h * PetscSqrtReal(LamDot(Xs, Xs));
    }
    length[k + 1] = length[k] + ds;
    force[k + 1] =
        force[k] + g * ds - ContactForce(chains, lambda, h * (PetscReal)k, h * (PetscReal)(k + 1), lo, hi) / F33;
    if (layer) force[k + 1] += LamLayerForceBetween(layer, h * (PetscReal)k, h * (PetscReal)(k + 1)) / F33;
  }
}

/* Largest shear of the lamella along one face, in either direction; force: work space. */
static void TakeShear(LamRVE rve, const LamContactFace *face, PetscReal F33, const PetscReal layer[], PetscReal force[],
                      const PetscReal length[], LamLargestMean *shear)
{
  const PetscInt count = rve->mesh.along * WINDOW_SAMPLES;
  const PetscReal h = 1.0 / WINDOW_SAMPLES, thickness = LamMeshThinner(&rve->mesh, face->face);

  for (PetscInt sign = 1; sign >= -1; sign -= 2) {
    force[0] = 0.0;
    for (PetscInt k = 0; k < count; ++k)
      force[k + 1] =
          force[k] + (PetscReal)sign * LamLayerForceBetween(layer, h * (PetscReal)k, h * (PetscReal)(k + 1)) / F33;
    LamTakeLargestMean(&rve->mesh, thickness, face->face, count, force, length, shear);
  }
}

/* Adds weight n(x)n of the wall's normal at hat j. */
static void AddFabric(const LamMortarChains *chains, PetscInt j, PetscReal weight, PetscReal fabric[3])
{
  PetscReal X[2], Xs[2], m;

  LamMortarSlavePoint(chains, 0.5 * (PetscReal)j, X, Xs);
  m = LamDot(Xs, Xs);
  fabric[0] += weight * Xs[1] * Xs[1] / m; /* n = (Xs_2, -Xs_1)/|Xs| */
  fabric[1] += weight * Xs[0] * Xs[0] / m;
  fabric[2] -= weight * Xs[0] * Xs[1] / m;
}

/* Second moment of the jumps between coincident reference points of the two walls, where the walls have separated. x[2
   hats]: nodes of the slave, then of the master in opposite direction. */
static void AddJumps(const LamMortarChains *chains, PetscInt hats, const PetscReal x[][2], PetscReal jumps[3])
{
  static const PetscReal simpson[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};

  for (PetscInt e = 0; e < chains->n; ++e)
    for (PetscInt i = 0; i < 3; ++i) {
      const PetscInt at = 2 * e + i;
      const PetscReal w = simpson[i] * chains->J0[e];
      PetscReal jump[2], X[2], Xs[2];

      for (PetscInt d = 0; d < 2; ++d) jump[d] = x[2 * hats - 1 - at][d] - x[at][d];
      LamMortarSlavePoint(chains, PetscMin(0.5 * (PetscReal)at, (PetscReal)(e + 1) - 1e-12), X, Xs);
      /* the normal of the slave is (Xs_2, -Xs_1)/|Xs| */
      if ((jump[0] * Xs[1] - jump[1] * Xs[0]) <= LAM_VISIBLE_GAP * PetscSqrtReal(LamDot(Xs, Xs))) continue;
      jumps[0] += w * jump[0] * jump[0];
      jumps[1] += w * jump[1] * jump[1];
      jumps[2] += w * jump[0] * jump[1];
    }
}

/* Reference length of the wall about a hat that is closed. */
static PetscReal ClosedLength(const LamContact *contact, const PetscReal held[], PetscInt h)
{
  return PetscMax(contact->active[h] ? contact->weight[h] : 0.0, held ? held[h] : 0.0);
}

static PetscErrorCode AddFace(LamRVE rve, const LamLoad *load, PetscInt f, Sums *sums)
{
  LamContact *contact = rve->contact;
  const PetscInt count = rve->mesh.along * WINDOW_SAMPLES;
  const PetscReal *lambda = &contact->lambda[f * contact->hats];
  const LamContactFace *face = &contact->faces[f];
  const PetscReal thickness = LamMeshThinner(&rve->mesh, face->face);
  FamilySums *family = &sums->family[face->family];
  const LamMortarSegments *segments = &contact->segments;
  const PetscReal named_gap = sums->named_gap;
  const PetscInt points = LAM_EDGE_POINTS * rve->mesh.along;
  const LamMortarChains chains = LamContactChains(rve, load->F, rve->y, f);
  PetscReal *force, *length, J0 = 0.0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(count + 1, &force, count + 1, &length));
  for (PetscInt k = 0; k + 1 < segments->count; ++k)
    SampleSegment(&chains, segments->s[k], segments->s[k + 1], segments->master[k], family, sums);
  if (sums->named_gap > named_gap) {
    sums->gap_place[0] = (PetscReal)face->cell;
    sums->gap_place[1] = (PetscReal)LamMeshLocalFace(&rve->mesh, face->face);
    sums->gap_place[2] = LamMeshShare(&rve->mesh, face->face, sums->gap_at);
  }
  FaceForce(&chains, lambda, segments->count ? segments->s[0] : 0.0,
            segments->count ? segments->s[segments->count - 1] : 0.0, load->cohesion * face->cohesion, load->F[8],
            sums->layer.normal ? &sums->layer.normal[points * f] : NULL, force, length);
  for (PetscInt e = 0; e < chains.n; ++e) J0 += chains.J0[e];
  family->length += J0;
  family->current_length += length[count];
  family->force += force[count];
  if (segments->count == 0) family->open += J0;
  AddJumps(&chains, contact->hats, (const PetscReal(*)[2])contact->x, sums->jumps);
  LamTakeLargestMean(&rve->mesh, thickness, face->face, count, force, length, &sums->traction);
  if (sums->layer.shear) TakeShear(rve, face, load->F[8], &sums->layer.shear[points * f], force, length, &sums->shear);
  for (PetscInt j = 0; j < contact->hats; ++j) {
    const PetscReal closed = ClosedLength(contact, sums->layer.held, f * contact->hats + j);

    if (closed == 0.0) continue;
    family->closed += closed;
    AddFabric(&chains, j, closed, sums->fabric);
  }
  PetscCall(PetscFree2(force, length));
  PetscFunctionReturn(0);
}

static PetscBool FaceIsClosed(const LamContact *contact, const PetscReal held[], PetscInt f)
{
  for (PetscInt h = f * contact->hats; h < (f + 1) * contact->hats; ++h)
    if (ClosedLength(contact, held, h) > 0.0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Groups the cells that closed faces connect. group [cell]: the same number within a group; place [cell]: shift of the
   image that belongs to the same connected piece as the others of its group. Returns the number of groups. */
static PetscInt GroupCells(const LamContact *contact, const PetscReal held[], PetscInt cells, PetscInt group[],
                           PetscReal place[][2])
{
  PetscInt count = cells;

  for (PetscInt c = 0; c < cells; ++c) {
    group[c] = c;
    place[c][0] = place[c][1] = 0.0;
  }
  for (PetscInt f = 0; f < contact->face_count; ++f) {
    const LamContactFace *face = &contact->faces[f];
    const PetscInt a = face->cell, b = face->other, joined = group[b];
    PetscReal move[2];

    if (!FaceIsClosed(contact, held, f) || group[a] == joined) continue;
    for (PetscInt d = 0; d < 2; ++d) move[d] = place[a][d] + face->shift[d] - place[b][d];
    for (PetscInt c = 0; c < cells; ++c) {
      if (group[c] != joined) continue;
      group[c] = group[a];
      for (PetscInt d = 0; d < 2; ++d) place[c][d] += move[d];
    }
    --count;
  }
  return count;
}

/* Rank of the period vectors that a group of cells spans. A closed face between two cells of the group gives a cycle,
   i.e. a period vector. */
static PetscInt Rank(const LamContact *contact, const PetscReal held[], PetscInt number, const PetscInt group[],
                     const PetscReal place[][2])
{
  PetscReal first[2] = {0.0, 0.0};
  PetscInt rank = 0;

  for (PetscInt f = 0; f < contact->face_count && rank < 2; ++f) {
    const LamContactFace *face = &contact->faces[f];
    PetscReal v[2];

    if (!FaceIsClosed(contact, held, f) || group[face->cell] != number) continue;
    for (PetscInt d = 0; d < 2; ++d) v[d] = place[face->cell][d] + face->shift[d] - place[face->other][d];
    if (LamDot(v, v) < 1e-6 || (rank == 1 && PetscAbsReal(first[0] * v[1] - first[1] * v[0]) <= 1e-3)) continue;
    ++rank;
    for (PetscInt d = 0; d < 2; ++d) first[d] = v[d];
  }
  return rank;
}

static PetscBool IsHeld(const LamMesh *mesh, PetscInt cell)
{
  for (PetscInt k = mesh->tissue->first[cell]; k < mesh->tissue->first[cell + 1]; ++k)
    if (mesh->tissue->held[k]) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode CountClusters(LamRVE rve, const PetscReal held[], LamResponse *response)
{
  const LamContact *contact = rve->contact;
  const PetscInt cells = rve->mesh.cell_count;
  PetscInt *group;
  PetscReal(*place)[2];
  PetscBool *fixed; /* by a neighbour or a grip */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(cells, &group, cells, &place, cells, &fixed));
  response->cell_clusters = GroupCells(contact, held, cells, group, place);
  for (PetscInt c = 0; c < cells; ++c) fixed[c] = IsHeld(&rve->mesh, c);
  for (PetscInt f = 0; f < contact->face_count; ++f)
    if (FaceIsClosed(contact, held, f)) fixed[contact->faces[f].cell] = fixed[contact->faces[f].other] = PETSC_TRUE;
  response->percolating_directions = response->floating_cells = 0;
  for (PetscInt c = 0; c < cells; ++c) {
    response->floating_cells += !fixed[c];
    response->percolating_directions =
        PetscMax(response->percolating_directions, Rank(contact, held, c, group, (const PetscReal(*)[2])place));
  }
  if (rve->micro.is_patch) response->percolating_directions = LAM_UNKNOWN_COUNT; /* there is no period */
  PetscCall(PetscFree3(group, place, fixed));
  PetscFunctionReturn(0);
}

/* A narrow patch has no faces of one family, a single cell has none: NaN if there is no interface. */
static PetscReal ShareOf(PetscReal whole, PetscReal part)
{
  return whole > 0.0 ? PetscMax(0.0, part / whole) : NAN;
}

/* closed: length of the interface in contact. NaN without any overlap: no walls face each other. */
static PetscReal MinGap(PetscReal closed, const Sums *sums)
{
  if (sums->max_gap == -PETSC_MAX_REAL) return NAN;
  return closed > 0.0 ? 0.0 : PetscMax(0.0, sums->min_gap);
}

PetscErrorCode LamContactIndicators(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  Sums sums = {.max_gap = -PETSC_MAX_REAL,
               .named_gap = -PETSC_MAX_REAL,
               .min_gap = PETSC_MAX_REAL,
               .traction = LAM_NO_MEAN,
               .shear = LAM_NO_MEAN};
  PetscReal length = 0.0, closed = 0.0, open = 0.0, gap = 0.0;

  PetscFunctionBeginUser;
  PetscCall(LamLayerForcesCreate(rve, load, &sums.layer));
  for (PetscInt f = 0; f < rve->contact->face_count; ++f) PetscCall(AddFace(rve, load, f, &sums));
  for (PetscInt k = 0; k < 3; ++k) {
    const FamilySums *family = &sums.family[k];

    response->opening_by_face[k] = family->opening * load->F[8] / rve->mesh.V0;
    response->debonded_by_face[k] = ShareOf(family->length, family->length - family->closed);
    response->open_by_face[k] = ShareOf(family->length, family->open);
    response->mean_face_traction[k] = family->length > 0.0 ? family->force / family->current_length : NAN;
    length += family->length;
    closed += family->closed;
    open += family->open;
    gap += family->gap;
  }
  response->debonded_fraction = ShareOf(length, length - closed);
  response->open_fraction = ShareOf(length, open);
  response->mean_gap = ShareOf(length, gap);
  response->max_gap = sums.max_gap > -PETSC_MAX_REAL ? PetscMax(0.0, sums.max_gap) : NAN;
  response->min_gap = MinGap(closed, &sums);
  if (sums.max_gap > 0.0) PetscCall(PetscArraycpy(response->gap_place, sums.gap_place, 3));
  response->max_penetration = PetscMax(response->max_penetration, sums.max_penetration);
  response->max_traction = LamLargestMeanValue(&sums.traction);
  PetscCall(PetscArraycpy(response->normal_place, sums.traction.place, 3));
  response->max_lamella_shear = 0.0; /* there is no friction */
  if (rve->layer) {
    response->max_lamella_shear = LamLargestMeanValue(&sums.shear);
    PetscCall(PetscArraycpy(response->shear_place, sums.shear.place, 3));
  }
  for (PetscInt i = 0; i < 3; ++i) {
    response->fabric[i] = length > 0.0 ? sums.fabric[i] / length : NAN;
    response->opening_moment[i] = length > 0.0 ? sums.jumps[i] / length : NAN;
  }
  response->zero_modes = rve->zero_modes;
  PetscCall(CountClusters(rve, sums.layer.held, response));
  PetscCall(LamLayerForcesDestroy(&sums.layer));
  PetscFunctionReturn(0);
}

/* All faces are closed; the fabric is that of all faces, from their current chords. */
void LamBondedIndicators(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const LamMesh *mesh = &rve->mesh;
  PetscReal fabric[3] = {0.0, 0.0, 0.0};
  PetscInt edges = 0;

  for (PetscInt e = mesh->through - 1; e < mesh->element_count; e += mesh->through) {
    const PetscInt face = LamMeshFaceOfElement(mesh, e), at = e / mesh->through % mesh->along;
    PetscReal x[LAM_ELEMENT_NODES][2], chord[2];

    if (!LamTissueIsSlave(mesh->tissue, face) || at < mesh->flat[face][0] || at >= mesh->flat[face][1]) continue;
    LamGatherElement(rve, load->F, rve->y, e, x);
    for (PetscInt d = 0; d < 2; ++d) chord[d] = x[2][d] - x[1][d]; /* the ends of the outer edge */
    fabric[0] += chord[1] * chord[1] / LamDot(chord, chord);
    fabric[1] += chord[0] * chord[0] / LamDot(chord, chord);
    fabric[2] -= chord[0] * chord[1] / LamDot(chord, chord);
    ++edges;
  }
  for (PetscInt i = 0; i < 3; ++i) {
    response->fabric[i] = edges ? fabric[i] / (PetscReal)edges : 0.0;
    response->opening_moment[i] = 0.0;
  }
  response->debonded_fraction = response->open_fraction = response->max_gap = response->mean_gap = 0.0;
  response->max_penetration = 0.0;
  for (PetscInt k = 0; k < 3; ++k)
    response->debonded_by_face[k] = response->open_by_face[k] = response->opening_by_face[k] = 0.0;
  response->floating_cells = response->zero_modes = 0;
  response->cell_clusters = 1;
  response->percolating_directions = rve->micro.is_patch ? LAM_UNKNOWN_COUNT : 2;
}
