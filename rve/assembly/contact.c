#include "rve_impl.h"

#define OVERHANG 0.4      /* half-edges by which a hat's centre may lie outside the overlap */
#define HYSTERESIS 0.2    /* of the junction status, in half-edges */
#define LEAST_WEIGHT 1e-3 /* fraction of a full hat; hats of smaller weight have no multiplier */

static PetscInt CountFaces(const LamMesh *mesh)
{
  PetscInt count = 0;

  for (PetscInt k = 0; k < mesh->tissue->faces; ++k) count += LamTissueIsSlave(mesh->tissue, k);
  return count;
}

/* Whether the outer walls of both cells that meet a face at its start, or at the start of its partner, are prescribed.
 */
static PetscBool IsHeldAtStart(LamTissue tissue, PetscInt face)
{
  return (PetscBool)(tissue->held[LamTissuePrevious(tissue, face)] &&
                     tissue->held[LamTissueNext(tissue, tissue->partner[face])]);
}

static LamContactFace NewFace(const LamMicrostructure *micro, const LamMesh *mesh, PetscInt face, PetscInt hats)
{
  const LamTissue tissue = mesh->tissue;
  const PetscInt partner = tissue->partner[face], cell = tissue->cell[face], other = tissue->cell[partner];
  const PetscInt low = IsHeldAtStart(tissue, face) ? 1 : 0;
  const PetscInt high = hats - 1 - (IsHeldAtStart(tissue, partner) ? 1 : 0);

  return (LamContactFace){.face = face,
                          .partner = partner,
                          .cell = cell,
                          .other = other,
                          .family = tissue->direction[face],
                          .shift = {mesh->image[2 * face], mesh->image[2 * face + 1]},
                          .cohesion = LamFaceCohesion(micro, cell, other),
                          .J0 = &mesh->edge[face * mesh->along],
                          .low = low,
                          .high = high,
                          .first = low,
                          .last = high};
}

static void PlaceFaces(const LamMicrostructure *micro, const LamMesh *mesh, LamContact *contact)
{
  PetscInt f = 0;

  for (PetscInt face = 0; face < mesh->tissue->faces; ++face) contact->at[face] = -1;
  for (PetscInt face = 0; face < mesh->tissue->faces; ++face) {
    const PetscInt partner = mesh->tissue->partner[face];

    if (!LamTissueIsSlave(mesh->tissue, face)) continue;
    contact->faces[f] = NewFace(micro, mesh, face, contact->hats);
    contact->at[face] = contact->at[partner] = f;
    for (PetscInt i = 0; i < contact->chain; ++i) {
      const PetscBool slave = (PetscBool)(i < contact->hats);
      const PetscInt node =
          slave ? LamMeshOuterNode(mesh, face, i) : LamMeshOuterNode(mesh, partner, i - contact->hats);

      contact->classes[f * contact->chain + i] = mesh->node_class[node];
      for (PetscInt d = 0; d < 2; ++d)
        contact->shift[2 * (f * contact->chain + i) + d] =
            mesh->shift[2 * node + d] + (slave ? 0.0 : contact->faces[f].shift[d]);
    }
    ++f;
  }
}

PetscErrorCode LamContactCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamContact **out)
{
  const PetscInt along = mesh->along;
  LamContact *contact;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&contact));
  contact->face_count = CountFaces(mesh);
  contact->hats = 2 * along + 1;
  contact->chain = 2 * contact->hats;
  contact->dofs = LamMortarDofs(along, along);
  contact->count = contact->face_count * contact->hats;
  PetscCheck((PetscReal)contact->face_count * contact->dofs * contact->dofs < PETSC_MAX_INT, PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "%d cells with %d elements along a face are too many for one RVE",
             (int)mesh->cell_count, (int)along);
  PetscCall(PetscMalloc5(contact->face_count, &contact->faces, contact->face_count * contact->chain, &contact->classes,
                         2 * contact->face_count * contact->chain, &contact->shift, mesh->tissue->faces, &contact->at,
                         contact->chain, &contact->x));
  PetscCall(PetscCalloc5(contact->count, &contact->lambda, contact->count, &contact->gap, contact->count,
                         &contact->weight, contact->count, &contact->active, contact->count, &contact->held));
  PetscCall(PetscCalloc2(contact->count * contact->dofs, &contact->rows,
                         contact->face_count * contact->dofs * contact->dofs, &contact->hessian));
  PlaceFaces(micro, mesh, contact);
  PetscCall(LamGapAreaCreate(micro, mesh, &contact->gaps));
  PetscCall(LamMortarSegmentsCreate(along, along, &contact->segments));
  PetscCall(LamMortarResultCreate(along, along, &contact->result));
  *out = contact;
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactSetMatrix(const LamLinear *linear, LamContact *contact)
{
  const PetscInt dofs = contact->dofs, pairs = dofs * (dofs + 1) / 2;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(contact->face_count * pairs, &contact->position, contact->count * dofs, &contact->coupling));
  for (PetscInt f = 0, entry = 0; f < contact->face_count; ++f) {
    const PetscInt *classes = &contact->classes[f * contact->chain];

    for (PetscInt i = 0; i < dofs; ++i)
      for (PetscInt j = i; j < dofs; ++j)
        contact->position[entry++] =
            LamLinearEntry(linear, LamUnknown(classes[i / 2], i % 2), LamUnknown(classes[j / 2], j % 2));
    for (PetscInt h = f * contact->hats; h < (f + 1) * contact->hats; ++h)
      for (PetscInt i = 0; i < dofs; ++i)
        contact->coupling[h * dofs + i] =
            LamLinearEntry(linear, LamUnknown(classes[i / 2], i % 2), linear->positions + h);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamContactDestroy(LamContact **contact)
{
  PetscFunctionBeginUser;
  if (!*contact) PetscFunctionReturn(0);
  PetscCall(LamMortarSegmentsDestroy(&(*contact)->segments));
  PetscCall(LamMortarResultDestroy(&(*contact)->result));
  PetscCall(LamGapAreaDestroy(&(*contact)->gaps));
  PetscCall(PetscFree5((*contact)->faces, (*contact)->classes, (*contact)->shift, (*contact)->at, (*contact)->x));
  PetscCall(PetscFree5((*contact)->lambda, (*contact)->gap, (*contact)->weight, (*contact)->active, (*contact)->held));
  PetscCall(PetscFree2((*contact)->rows, (*contact)->hessian));
  PetscCall(PetscFree2((*contact)->position, (*contact)->coupling));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(0);
}

/* Sets contact->x to the positions of both chains of a face. */
static void GatherChains(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt f)
{
  const LamContact *contact = rve->contact;

  for (PetscInt i = 0, k = f * contact->chain; i < contact->chain; ++i, ++k)
    LamImagePosition(F, y, contact->classes[k], &contact->shift[2 * k], contact->x[i]);
}

LamMortarChains LamContactChains(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt f)
{
  LamContact *contact = rve->contact;
  const LamMortarChains chains = {rve->mesh.along, rve->mesh.along, (const PetscReal(*)[2])contact->x,
                                  (const PetscReal(*)[2])(contact->x + contact->hats), contact->faces[f].J0};

  GatherChains(rve, F, y, f);
  LamMortarFindSegments(&chains, &contact->segments);
  return chains;
}

/* Returns `old` while `exact` is within (low, high], widened by HYSTERESIS on both sides; else `fresh`. */
static PetscInt WithHysteresis(PetscInt old, PetscReal low, PetscReal high, PetscReal exact, PetscInt fresh)
{
  return exact > low - HYSTERESIS && exact <= high + HYSTERESIS ? old : fresh;
}

/*
  Finds the hats with multipliers of their own: those whose centre lies inside the overlap, or outside by at most
  OVERHANG. The ends of the overlap are measured in half-edges. Hysteresis keeps the status along a path of states, and
  the iteration from alternating. If both walls are prescribed at a corner, the gap there is not an unknown, so the
  corner hat has no multiplier of its own.
*/
static void Junction(const LamContact *contact, const LamContactFace *face, PetscInt *first, PetscInt *last)
{
  const LamMortarSegments *segments = &contact->segments;
  const PetscInt count = segments->count, hats = contact->hats;
  PetscReal lo, hi;

  if (count == 0) {
    *first = hats;
    *last = -1;
    return;
  }
  lo = 2.0 * segments->s[0] - OVERHANG;
  hi = 2.0 * segments->s[count - 1] + OVERHANG;
  *first = WithHysteresis(*first, (PetscReal)*first - 1.0, (PetscReal)*first, lo, (PetscInt)PetscCeilReal(lo));
  *last = WithHysteresis(*last, -(PetscReal)*last - 1.0, -(PetscReal)*last, -hi, (PetscInt)PetscFloorReal(hi));
  *first = PetscMax(*first, face->low);
  *last = PetscMin(*last, face->high);
}

/* Sets the multipliers of merged hats to that of the hat they are merged into. */
static void SpreadMultipliers(const LamContactFace *face, PetscInt hats, PetscReal lambda[])
{
  for (PetscInt j = 0; j < hats; ++j)
    lambda[j] = face->first > face->last ? 0.0 : lambda[PetscMax(face->first, PetscMin(face->last, j))];
}

/* Stores weights, gaps and rows, those of merged hats added to the hat they are merged into. */
static void MergeHats(LamContact *contact, PetscInt f)
{
  const LamContactFace *face = &contact->faces[f];
  const PetscInt dofs = contact->dofs, base = f * contact->hats;
  const LamMortarResult *result = &contact->result;

  PetscArrayzero(&contact->weight[base], contact->hats);
  PetscArrayzero(&contact->gap[base], contact->hats);
  PetscArrayzero(&contact->rows[base * dofs], contact->hats * dofs);
  if (face->first > face->last) return;
  for (PetscInt j = 0; j < contact->hats; ++j) {
    const PetscInt to = base + PetscMax(face->first, PetscMin(face->last, j));

    contact->weight[to] += result->weight[j];
    contact->gap[to] += result->gap[j];
    for (PetscInt i = 0; i < dofs; ++i) contact->rows[to * dofs + i] += result->dgap[j * dofs + i];
  }
}

PetscInt LamContactMerge(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  PetscInt changes = 0;

  for (PetscInt f = 0; f < rve->contact->face_count; ++f) {
    LamContactFace *face = &rve->contact->faces[f];
    PetscInt first = face->first, last = face->last;

    (void)LamContactChains(rve, load->F, y, f);
    Junction(rve->contact, face, &first, &last);
    changes += first != face->first || last != face->last;
    face->first = first;
    face->last = last;
  }
  return changes;
}

PetscErrorCode LamContactEvaluate(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  LamContact *contact = rve->contact;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < contact->face_count; ++f) {
    const LamMortarChains chains = LamContactChains(rve, load->F, y, f);
    LamContactFace *face = &contact->faces[f];
    PetscReal *lambda = &contact->lambda[f * contact->hats];

    SpreadMultipliers(face, contact->hats, lambda);
    LamMortarEvaluate(&chains, &contact->segments, lambda, LAM_MORTAR_POINTS, &contact->result);
    PetscCall(PetscArraycpy(&contact->hessian[f * contact->dofs * contact->dofs], contact->result.hessian,
                            contact->dofs * contact->dofs));
    MergeHats(contact, f);
  }
  for (PetscInt h = 0; h < contact->count; ++h)
    contact->gap[h] = contact->weight[h] > 0.0 ? contact->gap[h] / contact->weight[h] : 0.0;
  PetscFunctionReturn(0);
}

PetscBool LamContactCarries(const LamContact *contact, PetscInt h)
{
  const LamContactFace *face = &contact->faces[h / contact->hats];
  const PetscInt j = h % contact->hats;
  const PetscReal half = 0.5 * face->J0[PetscMin(j, contact->hats - 2) / 2];

  return (PetscBool)(!contact->held[h] && j >= face->first && j <= face->last &&
                     contact->weight[h] > LEAST_WEIGHT * half);
}

PetscInt LamContactFindActive(LamContact *contact)
{
  PetscInt changes = 0;

  for (PetscInt h = 0; h < contact->count; ++h) {
    const PetscBool active =
        (PetscBool)(LamContactCarries(contact, h) && contact->lambda[h] - LAM_CONTACT_SCALE * contact->gap[h] > 0.0);

    changes += active != contact->active[h];
    contact->active[h] = active;
  }
  return changes;
}

PetscReal LamContactComplementarity(const LamContact *contact)
{
  PetscReal largest = 0.0;

  for (PetscInt h = 0; h < contact->count; ++h)
    if (LamContactCarries(contact, h)) {
      const PetscReal r = PetscMin(contact->lambda[h], LAM_CONTACT_SCALE * contact->gap[h]);

      largest = PetscMax(largest, PetscAbsReal(r));
    }
  return largest;
}

PetscInt LamContactCountActive(const LamContact *contact)
{
  PetscInt count = 0;

  for (PetscInt h = 0; h < contact->count; ++h) count += contact->active[h];
  return count;
}

void LamContactAddForce(LamRVE rve, PetscReal residual[])
{
  const LamContact *contact = rve->contact;

  for (PetscInt h = 0; h < contact->count; ++h) {
    const PetscInt f = h / contact->hats, j = h % contact->hats;
    const PetscReal *row = &contact->rows[h * contact->dofs];

    if (j < contact->faces[f].first || j > contact->faces[f].last || contact->lambda[h] == 0.0) continue;
    for (PetscInt i = 0; i < contact->dofs; ++i)
      residual[2 * contact->classes[f * contact->chain + i / 2] + i % 2] -= contact->lambda[h] * row[i];
  }
}

void LamContactAddCurvature(LamRVE rve)
{
  const LamContact *contact = rve->contact;
  const PetscInt dofs = contact->dofs;
  PetscReal *values = rve->linear->values;

  for (PetscInt f = 0; f < contact->face_count; ++f) {
    const PetscInt *position = &contact->position[f * (dofs * (dofs + 1) / 2)];
    const PetscReal *hessian = &contact->hessian[f * dofs * dofs];

    for (PetscInt i = 0, pair = 0; i < dofs; ++i)
      for (PetscInt j = i; j < dofs; ++j, ++pair)
        if (position[pair] >= 0) values[position[pair]] -= hessian[i * dofs + j];
  }
}

void LamContactSetRows(LamRVE rve)
{
  const LamContact *contact = rve->contact;
  const PetscInt dofs = contact->dofs;
  PetscReal *values = rve->linear->values;

  for (PetscInt h = 0; h < contact->count; ++h) {
    const PetscInt *coupling = &contact->coupling[h * dofs];
    const PetscReal *row = &contact->rows[h * dofs];

    values[rve->linear->row[rve->linear->positions + h]] = contact->active[h] ? 0.0 : 1.0;
    for (PetscInt i = 0; i < dofs; ++i)
      if (coupling[i] >= 0) values[coupling[i]] = contact->active[h] ? -row[i] : 0.0;
  }
}

void LamTakeJunctions(LamRVE rve, LamRVEState state)
{
  for (PetscInt f = 0; f < state->faces; ++f) {
    rve->contact->faces[f].first = state->hats[f][0];
    rve->contact->faces[f].last = state->hats[f][1];
  }
}
