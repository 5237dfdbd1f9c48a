/*
  Evaluation of the failure criteria from the responses to one load on both meshes.
*/
#ifndef LAM_FAILURE_CRITERIA_H
#define LAM_FAILURE_CRITERIA_H

#include "failure.h"
#include <math.h>

/* Walls are taut if their mean tension exceeds this fraction of the turgor p. In free tissue turgor alone causes a
   tension above p; in tissue held at F = I about p^2/kappa, because walls are compressible. */
#define LAM_TAUT 0.1

/* Whether a criterion is evaluated: it applies to this interface, and its strength is given where it needs one. */
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

/* Whether the responses on both meshes have fields. */
static inline PetscBool LamHaveFields(const LamResponse responses[2])
{
  return (PetscBool)(LamResponseHasFields(&responses[0]) && LamResponseHasFields(&responses[1]));
}

/* Turgor of the lumens, which is computed if they are sealed; that of the load if the response has none. */
static inline PetscReal LamTurgorReached(const LamResponse *r)
{
  return isfinite(r->turgor_mean) ? r->turgor_mean : r->load.turgor;
}

static inline PetscBool LamIsTurgid(const LamResponse *r)
{
  return (PetscBool)(LamTurgorReached(r) > 0);
}

/* Mean over all walls. The three face families have equal weight. */
static inline PetscReal LamMeanTension(const LamResponse *r)
{
  return (r->mean_wall_tension[0] + r->mean_wall_tension[1] + r->mean_wall_tension[2]) / 3;
}

static inline PetscBool LamIsTaut(const LamResponse *r)
{
  return (PetscBool)(LamIsTurgid(r) && LamMeanTension(r) > LAM_TAUT * LamTurgorReached(r));
}

/*
  Excess of an evaluated criterion at responses with fields; >= 0 if it is reached. Continuous along a load path, except
  contact and stability, which are -1 or 1. `before`: responses at a load where the criterion is not reached. Loss of
  turgor or tension counts only if failure->turgid or failure->taut is set.
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
