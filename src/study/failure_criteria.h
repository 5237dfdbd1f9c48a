/*
  When a criterion of failure is reached, from the responses of one load on both meshes.
*/
#ifndef LAM_FAILURE_CRITERIA_H
#define LAM_FAILURE_CRITERIA_H

#include "failure.h"
#include <math.h>

/* Walls count as taut from a mean tension of this share of the turgor on. Turgor alone gives them more than p where the
   tissue is free; where it is held at F = I it gives them some p^2/kappa, by their compressibility. */
#define LAM_TAUT 0.1

/* Whether a criterion can be judged: it belongs to this interface, and its strength is known where it needs one. */
static inline PetscBool LamCriterionIsJudged(LamCriterion criterion, LamInterfaceLawType interface,
                                             const LamStrength *strength)
{
  const PetscBool contact = (PetscBool)(interface == LAM_INTERFACE_CONTACT);

  switch (criterion) {
  case LAM_CRITERION_LAMELLA_NORMAL:
    return (PetscBool)(!contact && isfinite(strength->lamella_normal));
  case LAM_CRITERION_LAMELLA_SHEAR:
    return (PetscBool)(!contact && isfinite(strength->lamella_shear));
  case LAM_CRITERION_CONTACT:
    return contact;
  case LAM_CRITERION_WALL:
    return (PetscBool)isfinite(strength->wall);
  default:
    return PETSC_TRUE;
  }
}

/* Both meshes, or the one twice. */
static inline PetscBool LamHaveFields(const LamResponse responses[2])
{
  return (PetscBool)(LamResponseHasFields(&responses[0]) && LamResponseHasFields(&responses[1]));
}

/* What the lumens bear, which sealed ones find themselves; that of the load where the response does not say. */
static inline PetscReal LamTurgorReached(const LamResponse *r)
{
  return isfinite(r->turgor_mean) ? r->turgor_mean : r->load.turgor;
}

static inline PetscBool LamIsTurgid(const LamResponse *r)
{
  return (PetscBool)(LamTurgorReached(r) > 0);
}

/* Over all walls: of each face family every cell has the same share. */
static inline PetscReal LamMeanTension(const LamResponse *r)
{
  return (r->mean_wall_tension[0] + r->mean_wall_tension[1] + r->mean_wall_tension[2]) / 3;
}

static inline PetscBool LamIsTaut(const LamResponse *r)
{
  return (PetscBool)(LamIsTurgid(r) && LamMeanTension(r) > LAM_TAUT * LamTurgorReached(r));
}

/*
  How far a judged criterion is exceeded at responses with fields: >= 0 where it is reached. Continuous along a load but
  for contact and stability, which are -1 or 1. `before` are responses of a load at which it is not reached; what turgor
  has once held counts by failure->turgid and taut.
*/
static inline PetscReal LamCriterionExcess(LamCriterion criterion, const LamFailure *failure,
                                           const LamResponse before[2], const LamResponse responses[2])
{
  const LamResponse *r = &responses[0];
  const LamStrength *strength = failure->program.strength;
  const LamSeparation separation = LamSeparationOf(responses);
  PetscReal excess = -1;

  switch (criterion) {
  case LAM_CRITERION_LAMELLA_NORMAL:
    return r->max_traction / strength->lamella_normal - 1;
  case LAM_CRITERION_LAMELLA_SHEAR:
    return r->max_lamella_shear / strength->lamella_shear - 1;
  case LAM_CRITERION_WALL:
    return r->max_wall_tension / strength->wall - 1;
  case LAM_CRITERION_CONTACT:
    return separation == LAM_SEPARATION_GAP || separation == LAM_SEPARATION_TRACTION ? 1 : -1;
  case LAM_CRITERION_STABILITY:
    return r->status == LAM_UNSTABLE || r->branch > before[0].branch ? 1 : -1;
  case LAM_CRITERION_TURGOR:
    if (failure->turgid) excess = -LamTurgorReached(r);
    if (failure->taut) excess = PetscMax(excess, -LamMeanTension(r));
    return excess;
  default:
    return excess;
  }
}

#endif
