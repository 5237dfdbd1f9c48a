/*
  The crack that runs from the notch of a patch.

  A face is broken once more than half of its energy of fracture is spent. The crack are the broken faces that hang
  together with the notch, through junctions that they share; its length is how far it has run beyond the notch, along
  X1.
*/
#include "measure.h"

#define BROKEN 0.5

enum { WHOLE, CUT, PARTED, REACHED }; /* what is known of a face; REACHED: also from the notch */

typedef struct {
  LamRVE rve;
  PetscReal *spent, *toughness; /* [face] */
} Faces;

static void AddPoint(void *ctx, const LamBondPoint *point)
{
  Faces *faces = (Faces *)ctx;
  const PetscReal weight = faces->rve->layer->weight[point->point];
  const LamEnvelope *envelope = &faces->rve->layer->bond[point->point].now;

  if (point->face < 0) return;
  faces->spent[point->face] += weight * LamEnvelopeSpent(envelope, point->step.kappa);
  faces->toughness[point->face] += weight * envelope->energy;
}

/* Largest X1 of a face at rest. */
static PetscReal EndOf(LamRVE rve, PetscInt f)
{
  const LamMesh *mesh = &rve->mesh;
  const LamContactFace *face = &rve->contact->faces[f];
  PetscReal end = -PETSC_INFINITY;

  for (PetscInt k = 0; k < 2; ++k) {
    const PetscInt ring = LamMeshRing(mesh, face->face * mesh->along + k * (mesh->along - 1), 2 * k);

    end = PetscMax(end, mesh->X[2 * LamMeshNode(mesh, face->cell, ring, mesh->radial_nodes - 1)]);
  }
  return end;
}

/* Faces of cells: at [cell][face] which of the contact faces it is, -1 for none. */
static void FindFaces(LamRVE rve, PetscInt at[])
{
  const LamContact *contact = rve->contact;

  for (PetscInt i = 0; i < rve->mesh.cell_count * LAM_FACES; ++i) at[i] = -1;
  for (PetscInt f = 0; f < contact->face_count; ++f) {
    const LamContactFace *face = &contact->faces[f];

    at[face->cell * LAM_FACES + face->face] = f;
    at[face->other * LAM_FACES + face->face + LAM_FACES / 2] = f;
  }
}

/* Adds the parted faces that share a junction with face f of the queue. */
static PetscInt AddNext(LamRVE rve, const PetscInt at[], PetscInt f, PetscInt what[], PetscInt queue[], PetscInt count)
{
  const LamContactFace *face = &rve->contact->faces[f];
  const PetscInt sides[2][2] = {{face->cell, face->face}, {face->other, face->face + LAM_FACES / 2}};

  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt turn = 1; turn < LAM_FACES; turn += LAM_FACES - 2) {
      const PetscInt next = at[sides[s][0] * LAM_FACES + (sides[s][1] + turn) % LAM_FACES];

      if (next < 0 || what[next] != PARTED) continue;
      what[next] = REACHED;
      queue[count++] = next;
    }
  return count;
}

PetscErrorCode LamCrackMeasure(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const PetscInt faces = rve->contact->face_count;
  Faces sums = {.rve = rve};
  PetscInt *at, *what, *queue, count = 0, notch;
  PetscReal tip = -PETSC_INFINITY, end;

  PetscFunctionBeginUser;
  if (rve->micro.notch_columns == 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(faces, &sums.spent, faces, &sums.toughness));
  PetscCall(PetscMalloc3(rve->mesh.cell_count * LAM_FACES, &at, faces, &what, faces, &queue));
  LamLayerVisitPoints(rve, load->F, rve->y, AddPoint, &sums);
  FindFaces(rve, at);
  for (PetscInt f = 0; f < faces; ++f) {
    const LamContactFace *face = &rve->contact->faces[f];
    const PetscBool cut = LamLatticeIsCut(&rve->micro, face->cell, face->other);

    what[f] = cut ? CUT : sums.spent[f] > BROKEN * sums.toughness[f] ? PARTED : WHOLE;
    if (!cut) continue;
    queue[count++] = f;
    tip = PetscMax(tip, EndOf(rve, f));
  }
  notch = count;
  end = tip;
  for (PetscInt k = 0; k < count; ++k) {
    end = PetscMax(end, EndOf(rve, queue[k]));
    count = AddNext(rve, at, queue[k], what, queue, count);
  }
  response->crack_faces = count - notch;
  response->crack_length = end - tip;
  PetscCall(PetscFree2(sums.spent, sums.toughness));
  PetscCall(PetscFree3(at, what, queue));
  PetscFunctionReturn(0);
}
