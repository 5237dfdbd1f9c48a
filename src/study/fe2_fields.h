/*
  Fields of a step as a result file names them: what the material points keep, means and largest values, and what of
  the scene's strengths they reach. Physical units.
*/
#ifndef LAM_FE2_FIELDS_H
#define LAM_FE2_FIELDS_H

#include <lamella/macro.h>
#include "xdmf.h"

/* A scalar field: a number that points keep, over its unit or over a strength. */
typedef struct {
  LamPointField field;
  PetscBool largest; /* of the element's points; else their mean */
  PetscBool over_strength;
  PetscReal factor; /* to its unit; not of what is over a strength */
  const char *unit; /* static */
} LamFE2Scalar;

enum { LAM_FE2_MAX_FIELDS = 4 + 2 * (LAM_POINT_FIELD_COUNT + 3) };

/*
  Of a scene: u, F, P, cauchy come first (scalars[k].unit is NULL), then the scalars. A name ends in _max where it is
  the largest value, and in _ratio where it is over the strength, which are there only where the scene gives that.
*/
typedef struct {
  PetscInt count;
  LamXDMFField fields[LAM_FE2_MAX_FIELDS];
  LamFE2Scalar scalars[LAM_FE2_MAX_FIELDS];
} LamFE2Fields;

void LamFE2FieldsChoose(const LamScene *scene, LamFE2Fields *fields);
/* The strength that a field is measured by, in C1 + C2; NaN: none is given, or it has none. */
PetscReal LamFE2Strength(const LamStrength *strength, LamPointField field);
/* Mean over the body, by reference volume; NaN where a point does not know it. */
PetscReal LamFE2Mean(const LamMacroFields *fields, LamPointField field);
/* Largest of all points, likewise. */
PetscReal LamFE2Largest(const LamMacroFields *fields, LamPointField field);

#endif
