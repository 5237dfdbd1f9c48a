/*
  Whether cells have come apart, judged on two meshes. For contact tissue.

  The tissue counts as separated where on both meshes
    gap            the largest gap between facing walls exceeds LAM_VISIBLE_GAP, or no wall faces its partner any more;
                   or
    face_traction  the mean traction of a face family reaches the cohesion g, within 1e-3 of p + g, which presses the
                   faces together, and less than half of it is in contact: contact carries nothing there any more. Only
                   with p + g > 0: where nothing presses them together, faces that just touch carry nothing, either.
                   Where cells differ, faces of more cohesion than g bear more while they are in contact.
  Two meshes, because one alone opens at its junctions by as much as its elements are long.
*/
#ifndef LAM_SEPARATION_H
#define LAM_SEPARATION_H

#include <lamella/response.h>
#include <math.h>

/* How near to the cohesion a mean face traction reaches it, as a share of p + g. */
#define LAM_TRACTION_REACHED 1e-3

#define LAM_SEPARATIONS(X)                                                                                             \
  X(LAM_SEPARATION_UNKNOWN, "unknown") /* a mesh has no answer */                                                      \
  X(LAM_SEPARATION_NONE, "none")                                                                                       \
  X(LAM_SEPARATION_GAP, "gap")                                                                                         \
  X(LAM_SEPARATION_TRACTION, "face_traction")
typedef enum { LAM_SEPARATIONS(LAM_ENUM_ENTRY) LAM_SEPARATION_COUNT } LamSeparation;
extern const char *const LamSeparationNames[];

/* max_gap is not known where no wall faces its partner, nor is it of a single cell between grips, which has none. */
static inline PetscBool LamGapIsVisible(const LamResponse *r)
{
  return (PetscBool)(isnan(r->max_gap) ? r->debonded_fraction > 0 : r->max_gap > LAM_VISIBLE_GAP);
}

/* Whether a face family carries no contact any more. */
static inline PetscBool LamTractionIsReached(const LamResponse *r)
{
  const PetscReal g = r->load.cohesion, pressing = r->load.turgor + g;

  for (PetscInt k = 0; k < 3 && pressing > 0; k++)
    if (r->mean_face_traction[k] >= g - LAM_TRACTION_REACHED * pressing && r->debonded_by_face[k] > 0.5)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Which criterion both meshes fulfil; of both the gap is named. */
static inline LamSeparation LamSeparationOf(const LamResponse responses[2])
{
  const LamResponse *a = &responses[0], *b = &responses[1];

  if (!LamResponseHasFields(a) || !LamResponseHasFields(b)) return LAM_SEPARATION_UNKNOWN;
  if (LamGapIsVisible(a) && LamGapIsVisible(b)) return LAM_SEPARATION_GAP;
  if (LamTractionIsReached(a) && LamTractionIsReached(b)) return LAM_SEPARATION_TRACTION;
  return LAM_SEPARATION_NONE;
}

#endif
