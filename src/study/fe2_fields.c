/*
  Selection of the fields in a result file of a macroscale run.
*/
#include "fe2_fields.h"
#include <math.h>
#include <stdio.h>

PetscReal LamFE2Strength(const LamStrength *strength, LamPointField field)
{
  switch (field) {
  case LAM_POINT_WALL:
    return strength->wall;
  case LAM_POINT_NORMAL:
    return strength->lamella_normal;
  case LAM_POINT_SHEAR:
    return strength->lamella_shear;
  default:
    return NAN;
  }
}

/* Whether a field also has its largest (ellipticity: smallest) value in an element. The others hardly vary within an
   element. */
static PetscBool HasLargest(LamPointField field)
{
  return (PetscBool)(field != LAM_POINT_TURGOR && field != LAM_POINT_LUMEN && field != LAM_POINT_INTERPOLATED &&
                     field != LAM_POINT_DOUBTFUL);
}

static void Add(LamFE2Fields *f, const char name[], const char ending[], PetscInt columns, LamFE2Scalar scalar)
{
  LamXDMFField *field = &f->fields[f->count];

  snprintf(field->name, sizeof(field->name), "%s%s", name, ending);
  field->columns = columns;
  field->on_nodes = (PetscBool)(columns == 3);
  f->scalars[f->count++] = scalar;
}

static void AddScalar(LamFE2Fields *f, LamPointField field, const char ending[2][16], PetscBool over_strength,
                      PetscReal factor, const char unit[])
{
  for (int largest = 0; largest < (HasLargest(field) ? 2 : 1); largest++)
    Add(f, LamPointFieldNames[field], largest && field == LAM_POINT_ELLIPTICITY ? "_min" : ending[largest], 1,
        (LamFE2Scalar){field, (PetscBool)largest, over_strength, factor, unit});
}

void LamFE2FieldsChoose(const LamScene *scene, LamFE2Fields *fields)
{
  static const char plain[2][16] = {"", "_max"}, ratio[2][16] = {"_ratio", "_ratio_max"};
  const LamFE2Scalar none = {LAM_POINT_FIELD_COUNT, PETSC_FALSE, PETSC_FALSE, 1, NULL};
  const PetscReal MPa = scene->scales.stress * 1e-6;

  fields->count = 0;
  Add(fields, "u", "", 3, none);
  Add(fields, "F", "", 9, none);
  Add(fields, "P", "", 9, none);
  Add(fields, "cauchy", "", 9, none);
  for (int k = 0; k < LAM_POINT_FIELD_COUNT; k++) {
    const LamPointField field = (LamPointField)k;
    const PetscReal strength = LamFE2Strength(&scene->strength, field);
    const PetscBool stress = LamPointFieldIsStress(field);
    AddScalar(fields, field, plain, PETSC_FALSE, stress ? MPa : 1,
              stress                   ? "MPa"
              : field == LAM_POINT_GAP ? "apothem"
                                       : "1");
    if (isfinite(strength)) AddScalar(fields, field, ratio, PETSC_TRUE, 1, "1");
  }
}

PetscReal LamFE2Mean(const LamMacroFields *fields, LamPointField field)
{
  PetscReal sum = 0, volume = 0;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    sum += fields->volume[p] * fields->point[p * LAM_POINT_FIELD_COUNT + field];
    volume += fields->volume[p];
  }
  return sum / volume;
}

PetscReal LamFE2Largest(const LamMacroFields *fields, LamPointField field)
{
  PetscReal largest = -PETSC_INFINITY;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    const PetscReal value = fields->point[p * LAM_POINT_FIELD_COUNT + field];
    if (isnan(value)) return NAN;
    largest = PetscMax(largest, value);
  }
  return largest;
}
