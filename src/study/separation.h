/*
  Separation criterion for contact tissue, evaluated on two meshes.

  The tissue counts as separated if on both meshes
    gap            the largest gap between facing walls exceeds LAM_VISIBLE_GAP, or no wall faces its partner any more;
                   or
    face_traction  the mean traction of a face family reaches the cohesion g, within 1e-3 of p + g, the pressure on the
                   faces, and less than half of it is in contact: contact no longer carries load there. Only for
                   p + g > 0: without that pressure faces that just touch carry nothing either.
                   If cells differ, faces with a cohesion above g carry more while they are in contact.
  Two meshes are used because one alone opens at its junctions by as much as its element length.
*/
#ifndef LAM_SEPARATION_H
#define LAM_SEPARATION_H

#include <lamella/response.h>
#include <math.h>

/* Tolerance within which a mean face traction counts as reaching the cohesion, as a fraction of p + g. */
#define LAM_TRACTION_REACHED 1e-3

#define LAM_SEPARATIONS(X)                                                                                             \
  X(LAM_SEPARATION_UNKNOWN, "unknown") /* one mesh did not converge */                                                 \
  X(LAM_SEPARATION_NONE, "none")                                                                                       \
  X(LAM_SEPARATION_GAP, "gap")                                                                                         \
  X(LAM_SEPARATION_TRACTION, "face_traction")
typedef enum { LAM_SEPARATIONS(LAM_ENUM_ENTRY) LAM_SEPARATION_COUNT } LamSeparation;
extern const char *const LamSeparationNames[];

/* max_gap is unknown if no wall faces its partner, and for a single cell between grips, which has none. */
static inline PetscBool LamGapIsVisible(const LamResponse *r)
{
  return (PetscBool)(isnan(r->max_gap) ? r->debonded_fraction > 0 : r->max_gap > LAM_VISIBLE_GAP);
}

/* Whether a face family no longer carries load by contact. */
static inline PetscBool LamTractionIsReached(const LamResponse *r)
{
  const PetscReal g = r->load.cohesion, pressing = r->load.turgor + g;

  for (PetscInt k = 0; k < 3 && pressing > 0; k++)
    if (r->mean_face_traction[k] >= g - LAM_TRACTION_REACHED * pressing && r->debonded_by_face[k] > 0.5)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The criterion that both meshes fulfil; if both are fulfilled, the gap is returned. */
static inline LamSeparation LamSeparationOf(const LamResponse responses[2])
{
  const LamResponse *a = &responses[0], *b = &responses[1];

  if (!LamResponseHasFields(a) || !LamResponseHasFields(b)) return LAM_SEPARATION_UNKNOWN;
  if (LamGapIsVisible(a) && LamGapIsVisible(b)) return LAM_SEPARATION_GAP;
  if (LamTractionIsReached(a) && LamTractionIsReached(b)) return LAM_SEPARATION_TRACTION;
  return LAM_SEPARATION_NONE;
}

#endif
