/*
  Curves of a macroscale run. They are small: kept in memory and rewritten as a whole after each step.
*/
#include "fe2_curve.h"
#include "beside.h"
#include "study.h"
#include <math.h>
#include <string.h>

#define NAME_ENTRY(symbol, name, unit, number) name,
#define UNIT_ENTRY(symbol, name, unit, number) unit,
#define VALUE_ENTRY(symbol, name, unit, number) .value[symbol] = (PetscReal)(number),
static const char *const Names[] = {LAM_CURVE_COLUMNS(NAME_ENTRY)};
static const char *const Units[] = {LAM_CURVE_COLUMNS(UNIT_ENTRY)};

#define SIDE(unit) "* R1 (" unit ")", "* R2 (" unit ")", "* R? certified (" unit ")", "* R? margin (" unit ")"
#define HEAD_ENTRY(symbol, name, unit, number) name, name " (*)",
static const char *const MoreColumns[] = {"* u1 (mm)", "* u2 (mm)", SIDE("N/mm"), SIDE("N"),
                                          LAM_CURVE_COLUMNS(HEAD_ENTRY) NULL};
const LamTextKind LamCurveTable = {.what = "a table of lamella fe2 or process",
                                   .ending = ".csv",
                                   .begins = "step,load_factor",
                                   .columns = MoreColumns,
                                   .ends = ",newton_iterations,cutbacks,queries,hits,solves,failures,seconds (s)"};

LamMacroUnits LamMacroUnitsOf(const LamScene *scene)
{
  const PetscReal length = scene->scales.macro_length, line = scene->scales.stress * length; /* N/m */

  if (scene->macro.symmetry == LAM_AXISYMMETRIC)
    return (LamMacroUnits){line * length, line * PetscSqr(length) * 1e3, "N", "N mm"};
  return (LamMacroUnits){line * 1e-3, line * length, "N/mm", "N mm/mm"};
}

static const char *UnitOf(const LamCurve *curve, int column)
{
  return strcmp(Units[column], LAM_ENERGY_UNIT) ? Units[column] : curve->units.energy_name;
}

/* Mean over the body, weighted by reference volume; NaN if it is NaN at any point. */
static PetscReal Mean(const LamMacroFields *fields, LamPointField field)
{
  PetscReal sum = 0, volume = 0;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    sum += fields->volume[p] * fields->point[p * LAM_POINT_FIELD_COUNT + field];
    volume += fields->volume[p];
  }
  return sum / volume;
}

/* Largest value over all points; NaN if it is NaN at any point. */
static PetscReal Largest(const LamMacroFields *fields, LamPointField field)
{
  PetscReal largest = -PETSC_INFINITY;

  for (PetscInt p = 0; p < fields->point_count; p++)
    largest = LamPointFieldWorse(field, largest, fields->point[p * LAM_POINT_FIELD_COUNT + field]);
  return largest;
}

/* To the last row of its step. */
static void AddCertificate(LamCurve *curve, const LamMacroCertificate *certificate)
{
  const PetscReal unit = curve->units.force;
  PetscInt k = curve->count - 1;

  if (!certificate->made) return;
  while (k >= 0 && curve->rows[k].value[LAM_CURVE_STEP] != (PetscReal)certificate->step) k--;
  for (PetscInt s = 0; s < curve->side_count && k >= 0; s++) {
    for (int i = 0; i < 2; i++) {
      curve->rows[k].certified[s][i] = certificate->reaction[s][i] * unit;
      curve->rows[k].margin[s][i] = certificate->margin[s][i] * unit;
      if (isfinite(certificate->reaction[s][i])) curve->has_certified = PETSC_TRUE;
    }
  }
}

PetscErrorCode LamCurveAdd(LamCurve *curve, const LamMacroStep *step, const LamMacroFields *fields,
                           const LamScales *scales)
{
  const PetscReal MPa = scales->stress * 1e-6, energy = curve->units.energy;
  LamCurveRow row = {LAM_CURVE_COLUMNS(VALUE_ENTRY)};

  PetscFunctionBeginUser;
  curve->side_count = step->boundary_count;
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    PetscCall(PetscStrncpy(curve->side[s], step->boundary[s], sizeof(curve->side[s])));
    for (int i = 0; i < 2; i++) {
      row.displacement[s][i] = step->displacement[s][i] * scales->macro_length * 1e3;
      row.reaction[s][i] = step->reaction[s][i] * curve->units.force;
      row.certified[s][i] = row.margin[s][i] = NAN;
    }
  }
  PetscCall(LamListGrow(curve->count, sizeof(row), &curve->capacity, &curve->rows));
  curve->rows[curve->count++] = row;
  AddCertificate(curve, &step->certificate);
  AddCertificate(curve, &step->peak);
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
  const LamCurveColumn known = column == LAM_CURVE_TIME                                           ? column
                               : column >= LAM_CURVE_STORED && column <= LAM_CURVE_MESH_DEPENDENT ? LAM_CURVE_BROKEN
                                                                                                  : LAM_CURVE_STEP;

  return (PetscBool)(known == LAM_CURVE_STEP || (curve->count && isfinite(curve->rows[0].value[known])));
}

PetscErrorCode LamCurveWrite(const LamCurve *curve, LamRecordWriter writer)
{
  const PetscInt dims[3] = {curve->count, curve->side_count, 2};
  const LamCurveRow *first = curve->rows;
  const char *force = curve->units.force_name;
  char name[96];

  PetscFunctionBeginUser;
  for (int c = LAM_CURVE_STEP + 1; c < LAM_CURVE_COLUMN_COUNT; c++) {
    if (!LamCurveHas(curve, (LamCurveColumn)c)) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "/macro/curve/%s", Names[c]));
    PetscCall(LamWriteRows(writer, name, 1, dims, &first->value[c], sizeof(*first), 1, UnitOf(curve, c)));
  }
  PetscCall(
      LamWriteRows(writer, "/macro/curve/displacement", 3, dims, first->displacement[0], sizeof(*first), 1, "mm"));
  PetscCall(LamWriteRows(writer, "/macro/curve/reaction", 3, dims, first->reaction[0], sizeof(*first), 1, force));
  if (!curve->has_certified) PetscFunctionReturn(0);
  PetscCall(LamWriteRows(writer, "/macro/curve/certified", 3, dims, first->certified[0], sizeof(*first), 1, force));
  PetscCall(LamWriteRows(writer, "/macro/curve/certified_margin", 3, dims, first->margin[0], sizeof(*first), 1, force));
  PetscFunctionReturn(0);
}

/* "work (N mm/mm)"; columns of unit 1 have no unit in the header. */
static void PrintHeader(FILE *out, const LamCurve *curve)
{
  const char *N = curve->units.force_name;

  for (int c = 0; c < LAM_CURVE_COLUMN_COUNT; c++) {
    if (c == LAM_CURVE_WORK) { /* what a curve is drawn of comes first */
      for (PetscInt s = 0; s < curve->side_count; s++)
        fprintf(out, ",%s u1 (mm),%s u2 (mm),%s R1 (%s),%s R2 (%s)", curve->side[s], curve->side[s], curve->side[s], N,
                curve->side[s], N);
      for (PetscInt s = 0; s < curve->side_count && curve->has_certified; s++)
        for (int i = 1; i <= 2; i++)
          fprintf(out, ",%s R%d certified (%s),%s R%d margin (%s)", curve->side[s], i, N, curve->side[s], i, N);
    }
    if (!LamCurveHas(curve, (LamCurveColumn)c)) continue;
    fprintf(out, "%s%s", c ? "," : "", Names[c]);
    if (strcmp(Units[c], "1")) fprintf(out, " (%s)", UnitOf(curve, c));
  }
  fputc('\n', out);
}

static void PrintRow(FILE *out, const LamCurve *curve, const LamCurveRow *row)
{
  fprintf(out, "%.12g", (double)row->value[LAM_CURVE_STEP]);
  for (int c = LAM_CURVE_STEP + 1; c < LAM_CURVE_COLUMN_COUNT; c++) {
    for (PetscInt s = 0; s < curve->side_count && c == LAM_CURVE_WORK; s++) {
      for (int i = 0; i < 2; i++) LamBesideNumber(out, row->displacement[s][i]);
      for (int i = 0; i < 2; i++) LamBesideNumber(out, row->reaction[s][i]);
    }
    for (PetscInt s = 0; s < curve->side_count && c == LAM_CURVE_WORK && curve->has_certified; s++)
      for (int i = 0; i < 2; i++) {
        LamBesideNumber(out, row->certified[s][i]);
        LamBesideNumber(out, row->margin[s][i]);
      }
    if (LamCurveHas(curve, (LamCurveColumn)c)) LamBesideNumber(out, row->value[c]);
  }
  fputc('\n', out);
}

PetscErrorCode LamCurveWriteCSV(const LamCurve *curve, const char hdf5[])
{
  LamBeside file;

  PetscFunctionBeginUser;
  PetscCall(LamBesideOpen(hdf5, &LamCurveTable, &file));
  PrintHeader(file.out, curve);
  for (PetscInt k = 0; k < curve->count; k++) PrintRow(file.out, curve, &curve->rows[k]);
  PetscCall(LamBesideClose(&file));
  PetscFunctionReturn(0);
}
