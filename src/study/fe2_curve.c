/*
  Curves of a macroscale run. They are small: kept in memory and rewritten as a whole after each step.
*/
#include "fe2_curve.h"
#include "beside.h"
#include "fe2_fields.h"
#include <math.h>
#include <string.h>

#define NAME_ENTRY(symbol, name, unit) name,
#define UNIT_ENTRY(symbol, name, unit) unit,
static const char *const Names[] = {LAM_CURVE_COLUMNS(NAME_ENTRY)};
static const char *const Units[] = {LAM_CURVE_COLUMNS(UNIT_ENTRY)};

static void FillIndicators(const LamMacroFields *fields, PetscReal MPa, PetscReal value[])
{
  value[LAM_CURVE_OPENING] = LamFE2Mean(fields, LAM_POINT_OPENING);
  value[LAM_CURVE_OPEN] = LamFE2Mean(fields, LAM_POINT_OPEN);
  value[LAM_CURVE_UNLOADING] = LamFE2Largest(fields, LAM_POINT_UNLOADING);
  value[LAM_CURVE_WALL] = LamFE2Largest(fields, LAM_POINT_WALL) * MPa;
  value[LAM_CURVE_NORMAL] = LamFE2Largest(fields, LAM_POINT_NORMAL) * MPa;
  value[LAM_CURVE_SHEAR] = LamFE2Largest(fields, LAM_POINT_SHEAR) * MPa;
  value[LAM_CURVE_SEPARATED] = value[LAM_CURVE_RUPTURED] = NAN;
  value[LAM_CURVE_ERROR] = LamFE2Largest(fields, LAM_POINT_ERROR);
}

static void FillRow(const LamMacroStep *step, const LamMacroFields *fields, const LamScales *scales, LamCurveRow *row)
{
  const PetscReal MPa = scales->stress * 1e-6;
  PetscReal *value = row->value;

  value[LAM_CURVE_STEP] = (PetscReal)step->step;
  value[LAM_CURVE_LOAD_FACTOR] = step->load_factor;
  value[LAM_CURVE_TIME] = step->time;
  value[LAM_CURVE_WORK] = step->work * scales->stress * PetscSqr(scales->macro_length); /* J/m, which is N mm/mm */
  value[LAM_CURVE_TURGOR] = step->turgor_mean * MPa;
  value[LAM_CURVE_DEBONDED] = step->debonded_fraction;
  value[LAM_CURVE_GAP] = step->max_gap;
  value[LAM_CURVE_ELLIPTICITY] = step->ellipticity * MPa;
  value[LAM_CURVE_LOCALISED] = (PetscReal)step->localised_points;
  FillIndicators(fields, MPa, value);
  value[LAM_CURVE_NEWTON] = (PetscReal)step->newton_iterations;
  value[LAM_CURVE_CUTBACKS] = (PetscReal)step->cutbacks;
  value[LAM_CURVE_QUERIES] = (PetscReal)step->queries;
  value[LAM_CURVE_HITS] = (PetscReal)step->hits;
  value[LAM_CURVE_SOLVES] = (PetscReal)step->solves;
  value[LAM_CURVE_FAILURES] = (PetscReal)step->failures;
  value[LAM_CURVE_SECONDS] = step->seconds;
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (int i = 0; i < 2; i++) {
      row->displacement[s][i] = step->displacement[s][i] * scales->macro_length * 1e3;
      row->reaction[s][i] = step->reaction[s][i] * scales->stress * scales->macro_length * 1e-3;
    }
  }
}

PetscErrorCode LamCurveAdd(LamCurve *curve, const LamMacroStep *step, const LamMacroFields *fields,
                           const LamScales *scales)
{
  PetscFunctionBeginUser;
  if (curve->count == curve->capacity) {
    curve->capacity = PetscMax(16, 2 * curve->capacity);
    PetscCall(PetscRealloc((size_t)curve->capacity * sizeof(LamCurveRow), &curve->rows));
  }
  curve->side_count = step->boundary_count;
  for (PetscInt s = 0; s < step->boundary_count; s++)
    PetscCall(PetscStrncpy(curve->side[s], step->boundary[s], sizeof(curve->side[s])));
  FillRow(step, fields, scales, &curve->rows[curve->count++]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCurveDestroy(LamCurve *curve)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(curve->rows));
  *curve = (LamCurve){0};
  PetscFunctionReturn(0);
}

PetscBool LamCurveHas(const LamCurve *curve, LamCurveColumn column)
{
  return (PetscBool)(column != LAM_CURVE_TIME || (curve->count && isfinite(curve->rows[0].value[LAM_CURVE_TIME])));
}

PetscErrorCode LamCurveGetColumn(const LamCurve *curve, LamCurveColumn column, PetscReal **values)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(curve->count, values));
  for (PetscInt k = 0; k < curve->count; k++) (*values)[k] = curve->rows[k].value[column];
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteSides(const LamCurve *curve, LamRecordWriter writer, PetscBool reactions)
{
  const PetscInt dims[3] = {curve->count, curve->side_count, 2};
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(curve->count * curve->side_count * 2, &values));
  for (PetscInt k = 0; k < curve->count; k++) {
    const LamCurveRow *row = &curve->rows[k];
    PetscCall(PetscArraycpy(&values[k * curve->side_count * 2],
                            reactions ? &row->reaction[0][0] : &row->displacement[0][0], curve->side_count * 2));
  }
  PetscCall(LamRecordWriterReals(writer, reactions ? "/macro/curve/reaction" : "/macro/curve/displacement", 3, dims,
                                 values, reactions ? "N/mm" : "mm"));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCurveWrite(const LamCurve *curve, LamRecordWriter writer)
{
  PetscFunctionBeginUser;
  for (int c = LAM_CURVE_STEP + 1; c < LAM_CURVE_COLUMN_COUNT; c++) {
    PetscReal *values;
    char name[96];

    if (!LamCurveHas(curve, (LamCurveColumn)c)) continue;
    PetscCall(LamCurveGetColumn(curve, (LamCurveColumn)c, &values));
    PetscCall(PetscSNPrintf(name, sizeof(name), "/macro/curve/%s", Names[c]));
    PetscCall(LamRecordWriterReals(writer, name, 1, &curve->count, values, Units[c]));
    PetscCall(PetscFree(values));
  }
  PetscCall(WriteSides(curve, writer, PETSC_FALSE));
  PetscCall(WriteSides(curve, writer, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* "work (N mm/mm)"; columns of unit 1 have no unit in the header. */
static void PrintHeader(FILE *out, const LamCurve *curve)
{
  for (int c = 0; c < LAM_CURVE_COLUMN_COUNT; c++) {
    if (c == LAM_CURVE_WORK) { /* what a curve is drawn of comes first */
      for (PetscInt s = 0; s < curve->side_count; s++)
        fprintf(out, ",%s u1 (mm),%s u2 (mm),%s R1 (N/mm),%s R2 (N/mm)", curve->side[s], curve->side[s], curve->side[s],
                curve->side[s]);
    }
    if (!LamCurveHas(curve, (LamCurveColumn)c)) continue;
    fprintf(out, "%s%s", c ? "," : "", Names[c]);
    if (strcmp(Units[c], "1")) fprintf(out, " (%s)", Units[c]);
  }
  fputc('\n', out);
}

static void PrintNumber(FILE *out, PetscReal value)
{
  fputc(',', out);
  if (isfinite(value)) fprintf(out, "%.12g", (double)value);
}

static void PrintRow(FILE *out, const LamCurve *curve, const LamCurveRow *row)
{
  fprintf(out, "%.12g", (double)row->value[LAM_CURVE_STEP]);
  for (int c = LAM_CURVE_STEP + 1; c < LAM_CURVE_COLUMN_COUNT; c++) {
    for (PetscInt s = 0; s < curve->side_count && c == LAM_CURVE_WORK; s++) {
      for (int i = 0; i < 2; i++) PrintNumber(out, row->displacement[s][i]);
      for (int i = 0; i < 2; i++) PrintNumber(out, row->reaction[s][i]);
    }
    if (LamCurveHas(curve, (LamCurveColumn)c)) PrintNumber(out, row->value[c]);
  }
  fputc('\n', out);
}

PetscErrorCode LamCurveWriteCSV(const LamCurve *curve, const char hdf5[])
{
  LamBeside file;

  PetscFunctionBeginUser;
  PetscCall(LamBesideOpen(hdf5, ".csv", &file));
  PrintHeader(file.out, curve);
  for (PetscInt k = 0; k < curve->count; k++) PrintRow(file.out, curve, &curve->rows[k]);
  PetscCall(LamBesideClose(&file));
  PetscFunctionReturn(0);
}
