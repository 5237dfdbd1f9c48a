/*
  Fields of a step in a result file: element means and largest values of the quantities stored at material points, and
  their ratios to the scene's strengths. Physical units.
*/
#ifndef LAM_FE2_FIELDS_H
#define LAM_FE2_FIELDS_H

#include <lamella/macro.h>
#include "xdmf.h"

/* A scalar field: a quantity of the material points, in its unit or as a ratio to a strength. */
typedef struct {
  LamPointField field;
  PetscBool largest; /* largest value of the element's points (ellipticity: smallest); else their mean */
  PetscBool over_strength;
  PetscReal factor; /* conversion to its unit; unused with over_strength */
  const char *unit; /* static */
} LamFE2Scalar;

enum { LAM_FE2_MAX_FIELDS = 4 + 2 * (LAM_POINT_FIELD_COUNT + 3) };

/*
  The fields for a scene: first u, F, P, cauchy (scalars[k].unit is NULL), then the scalars. Suffix _max: largest value
  (_min for ellipticity: smallest). Suffix _ratio: ratio to the strength, only if the scene gives that strength.
*/
typedef struct {
  PetscInt count;
  LamXDMFField fields[LAM_FE2_MAX_FIELDS];
  LamFE2Scalar scalars[LAM_FE2_MAX_FIELDS];
} LamFE2Fields;

void LamFE2FieldsChoose(const LamScene *scene, LamFE2Fields *fields);
/* The strength for a field, in C1 + C2; NaN: not given, or the field has none. */
PetscReal LamFE2Strength(const LamStrength *strength, LamPointField field);
/* Mean over the body, weighted by reference volume; NaN if it is NaN at any point. */
PetscReal LamFE2Mean(const LamMacroFields *fields, LamPointField field);
/* Largest value over all points; NaN if it is NaN at any point. */
PetscReal LamFE2Largest(const LamMacroFields *fields, LamPointField field);

#endif
