/*
  The crack that runs from the notch of a patch.

  A face is broken once more than half of its energy of fracture is spent. The crack are the broken faces that hang
  together with the notch, through junctions that they share; its length is how far it has run beyond the notch, along
  X1.
*/
#include <lamella/lattice.h>
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

  for (PetscInt k = 0; k < 2; ++k)
    end = PetscMax(end, mesh->X[2 * LamMeshOuterNode(mesh, face->face, 2 * k * mesh->along)]);
  return end;
}

/* Adds the parted faces that share a junction with face f of the queue. */
static PetscInt AddNext(LamRVE rve, PetscInt f, PetscInt what[], PetscInt queue[], PetscInt count)
{
  const LamTissue tissue = rve->mesh.tissue;
  const LamContactFace *face = &rve->contact->faces[f];
  const PetscInt sides[2] = {face->face, face->partner};

  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt turn = 0; turn < 2; ++turn) {
      const PetscInt beside = turn ? LamTissuePrevious(tissue, sides[s]) : LamTissueNext(tissue, sides[s]);
      const PetscInt next = rve->contact->at[beside];

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
  PetscInt *what, *queue, count = 0, notch;
  PetscReal tip = -PETSC_INFINITY, end;

  PetscFunctionBeginUser;
  if (rve->micro.notch_columns == 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(faces, &sums.spent, faces, &sums.toughness));
  PetscCall(PetscMalloc2(faces, &what, faces, &queue));
  LamLayerVisitPoints(rve, load->F, rve->y, AddPoint, &sums);
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
    count = AddNext(rve, queue[k], what, queue, count);
  }
  response->crack_faces = count - notch;
  response->crack_length = end - tip;
  PetscCall(PetscFree2(sums.spent, sums.toughness));
  PetscCall(PetscFree2(what, queue));
  PetscFunctionReturn(0);
}
