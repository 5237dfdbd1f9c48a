/*
  Onsets, stiffness and firmness of a macroscale run.
*/
#include "fe2_summary.h"
#include "fe2_fields.h"
#include "separation.h"
#include <math.h>
#include <string.h>

const char *const LamSummaryCriterionNames[] = {LAM_SUMMARY_CRITERIA(LAM_NAME_ENTRY)};

const char *const LamSummaryModeNames[] = {LAM_SUMMARY_MODES(LAM_NAME_ENTRY)};

LamSummaryMode LamSummaryModeOf(LamSummaryCriterion criterion)
{
  if (criterion == LAM_SUMMARY_GAP) return LAM_SUMMARY_OPENING;
  return criterion == LAM_SUMMARY_WALL ? LAM_SUMMARY_RUPTURE : LAM_SUMMARY_SEPARATION;
}

PetscBool LamSummaryIsJudged(const LamSummary *summary, LamSummaryMode mode)
{
  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++)
    if (summary->onset[c].judged && LamSummaryModeOf((LamSummaryCriterion)c) == mode) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode LamSummaryCreate(const LamScene *scene, LamSummary *summary)
{
  PetscBool contact = (PetscBool)(scene->micro.interface == LAM_INTERFACE_CONTACT);
  const LamStrength *strength = &scene->strength;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < scene->region_count; r++)
    if (scene->regions[r].micro.interface == LAM_INTERFACE_CONTACT) contact = PETSC_TRUE;
  *summary = (LamSummary){.scene = scene, .strength = *strength, .side = -1, .firmest = -1};
  summary->onset[LAM_SUMMARY_NORMAL].judged = (PetscBool)isfinite(strength->lamella_normal);
  summary->onset[LAM_SUMMARY_SHEAR].judged = (PetscBool)isfinite(strength->lamella_shear);
  summary->onset[LAM_SUMMARY_UNLOADED].judged = contact;
  summary->onset[LAM_SUMMARY_GAP].judged = contact;
  summary->onset[LAM_SUMMARY_WALL].judged = (PetscBool)isfinite(strength->wall);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSummaryDestroy(LamSummary *summary)
{
  PetscFunctionBeginUser;
  PetscCall(LamCurveDestroy(&summary->curve));
  PetscCall(PetscFree(summary->before));
  PetscFunctionReturn(0);
}

/* ---- onsets ---- */

/* If no wall faces its partner any more, the gap has no value but exists: infinity. */
static PetscReal GapMeasure(const PetscReal field[])
{
  const PetscBool faces_none = (PetscBool)(isnan(field[LAM_POINT_GAP]) && field[LAM_POINT_DEBONDED] > 0);

  return faces_none ? PETSC_INFINITY : field[LAM_POINT_GAP] / LAM_VISIBLE_GAP;
}

/* Measure of a criterion: >= 1 if it is reached; NaN: not known. */
static PetscReal Measure(const LamSummary *summary, LamSummaryCriterion criterion, const PetscReal field[])
{
  const LamStrength *strength = &summary->strength;

  switch (criterion) {
  case LAM_SUMMARY_NORMAL:
    return field[LAM_POINT_NORMAL] / strength->lamella_normal;
  case LAM_SUMMARY_SHEAR:
    return field[LAM_POINT_SHEAR] / strength->lamella_shear;
  case LAM_SUMMARY_UNLOADED:
    if (isnan(field[LAM_POINT_UNLOADING])) return GapMeasure(field) >= 1 ? PETSC_INFINITY : 0; /* nothing closes them */
    return field[LAM_POINT_UNLOADING] / (1 - LAM_TRACTION_REACHED);
  case LAM_SUMMARY_GAP:
    return GapMeasure(field);
  case LAM_SUMMARY_WALL:
    return field[LAM_POINT_WALL] / strength->wall;
  default:
    return NAN;
  }
}

PetscReal LamSummaryDanger(const LamSummary *summary, const PetscReal field[])
{
  PetscReal largest = -PETSC_INFINITY;

  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++) {
    if (!summary->onset[c].judged || c == LAM_SUMMARY_GAP) continue;
    const PetscReal measure = Measure(summary, (LamSummaryCriterion)c, field);
    if (measure > largest) largest = measure; /* false for NaN */
  }
  return PetscIsInfReal(largest) && largest < 0 ? field[LAM_POINT_WALL] : largest;
}

/* Fraction of the interval between two steps at which a measure reaches 1; 2: it does not. */
static PetscReal Crossing(LamSummaryCriterion criterion, PetscReal before, PetscReal now)
{
  if (!(now >= 1)) return 2;
  if (criterion == LAM_SUMMARY_GAP || !isfinite(before) || !isfinite(now)) return 1;
  return before < 1 ? (1 - before) / (now - before) : 0;
}

static void Keep(const LamSummary *summary, const LamMacroFields *fields, PetscInt p, PetscReal share,
                 LamSummaryOnset *onset)
{
  const PetscReal mm = summary->scene->scales.macro_length * 1e3;
  PetscInt element = 0;

  while (fields->first_point[element + 1] <= p) element++;
  onset->reached = PETSC_TRUE;
  onset->row = summary->curve.count - 1;
  onset->share = share;
  onset->element = element;
  onset->point = p - fields->first_point[element];
  for (int i = 0; i < 2; i++) onset->place[i] = fields->place[2 * p + i] * mm;
}

/*
  Finds the point that reaches the criterion first in the interval before this step; of several at the same load, the
  one with the largest measure at the step. Differences of the size of rounding errors are ignored, so that among points
  that are equal by symmetry the first is reported, for any number of ranks.
*/
static void Seek(const LamSummary *summary, const LamMacroFields *fields, LamSummaryCriterion criterion,
                 LamSummaryOnset *onset)
{
  const PetscReal rounding = 1e-6;
  PetscReal first = 2, largest = 0;
  PetscInt which = -1;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    const PetscReal now = Measure(summary, criterion, &fields->point[p * LAM_POINT_FIELD_COUNT]);
    const PetscReal share = Crossing(criterion, summary->before[p * LAM_SUMMARY_CRITERION_COUNT + criterion], now);
    if (share > 1 || share > first + rounding || (share > first - rounding && !(now > largest * (1 + rounding))))
      continue;
    first = share;
    largest = now;
    which = p;
  }
  if (which >= 0) Keep(summary, fields, which, first, onset);
}

/* Volume fraction of the points at which any criterion of the mode is reached; NaN: none is evaluated. */
static PetscReal ReachedShare(const LamSummary *summary, const LamMacroFields *fields, LamSummaryMode mode)
{
  PetscReal volume = 0, reached = 0;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    PetscBool any = PETSC_FALSE;

    for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++) {
      if (!summary->onset[c].judged || LamSummaryModeOf((LamSummaryCriterion)c) != mode) continue;
      if (Measure(summary, (LamSummaryCriterion)c, &fields->point[p * LAM_POINT_FIELD_COUNT]) >= 1) any = PETSC_TRUE;
    }
    volume += fields->volume[p];
    if (any) reached += fields->volume[p];
  }
  return LamSummaryIsJudged(summary, mode) ? reached / volume : NAN;
}

PetscErrorCode LamSummaryAdd(LamSummary *summary, const LamMacroStep *step, const LamMacroFields *fields)
{
  const PetscInt n = LAM_SUMMARY_CRITERION_COUNT;
  PetscReal *row;

  PetscFunctionBeginUser;
  PetscCall(LamCurveAdd(&summary->curve, step, fields, &summary->scene->scales));
  row = summary->curve.rows[summary->curve.count - 1].value;
  row[LAM_CURVE_SEPARATED] = ReachedShare(summary, fields, LAM_SUMMARY_SEPARATION);
  row[LAM_CURVE_RUPTURED] = ReachedShare(summary, fields, LAM_SUMMARY_RUPTURE);
  if (!summary->before) {
    summary->before_count = fields->point_count * n;
    PetscCall(PetscMalloc1(summary->before_count, &summary->before));
    for (PetscInt k = 0; k < summary->before_count; k++) summary->before[k] = NAN;
  }
  for (int c = 0; c < n; c++) {
    LamSummaryOnset *onset = &summary->onset[c];
    if (!onset->judged || onset->reached) continue;
    Seek(summary, fields, (LamSummaryCriterion)c, onset);
    for (PetscInt p = 0; p < fields->point_count; p++)
      summary->before[p * n + c] = Measure(summary, (LamSummaryCriterion)c, &fields->point[p * LAM_POINT_FIELD_COUNT]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSummaryArchive(LamSummary *summary, LamArchive archive)
{
  LamCurve *curve = &summary->curve;

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "sides", sizeof(curve->side_count), &curve->side_count));
  PetscCall(LamArchiveShared(archive, "side names", sizeof(curve->side), curve->side));
  PetscCall(LamArchiveShared(archive, "onsets", sizeof(summary->onset), summary->onset));
  PetscCall(LamArchiveList(archive, "curves", sizeof(LamCurveRow), &curve->count, (void **)&curve->rows));
  PetscCall(LamArchiveList(archive, "measures", sizeof(PetscReal), &summary->before_count, (void **)&summary->before));
  curve->capacity = curve->count;
  LamSummaryFind(summary);
  PetscFunctionReturn(0);
}

const LamSummaryOnset *LamSummaryFirst(const LamSummary *summary, LamSummaryMode mode, LamSummaryCriterion *criterion)
{
  const LamSummaryOnset *first = NULL;

  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++) {
    const LamSummaryOnset *onset = &summary->onset[c];
    if (!onset->reached || LamSummaryModeOf((LamSummaryCriterion)c) != mode) continue;
    if (first && onset->row + onset->share >= first->row + first->share) continue;
    first = onset;
    *criterion = (LamSummaryCriterion)c;
  }
  return first;
}

/* ---- the loaded side ---- */

/* Component along the direction of loading; NaN (free) counts as 0. */
static PetscReal Along(const LamSummary *summary, const PetscReal vector[2])
{
  PetscReal sum = 0;

  for (int i = 0; i < 2; i++) sum += isfinite(vector[i]) ? summary->direction[i] * vector[i] : 0;
  return sum;
}

PetscReal LamSummaryDisplacement(const LamSummary *summary, PetscInt row)
{
  return Along(summary, summary->curve.rows[row].displacement[summary->side]);
}

PetscReal LamSummaryReaction(const LamSummary *summary, PetscInt row)
{
  return Along(summary, summary->curve.rows[row].reaction[summary->side]);
}

static PetscReal Length(const PetscReal vector[2])
{
  return hypot(isfinite(vector[0]) ? vector[0] : 0, isfinite(vector[1]) ? vector[1] : 0);
}

/* Sets the loaded side and its direction; returns the row of its largest displacement, -1: none. */
static PetscInt FindLoadedSide(LamSummary *summary)
{
  const LamCurve *curve = &summary->curve;
  PetscReal furthest = 0;
  PetscInt row = -1;

  summary->side = -1;
  for (PetscInt k = 0; k < curve->count; k++) {
    for (PetscInt s = 0; s < curve->side_count; s++) {
      const PetscReal *u = curve->rows[k].displacement[s], length = Length(u);
      if (length <= furthest * (1 + 1e-12)) continue;
      furthest = length;
      summary->side = s;
      row = k;
      for (int i = 0; i < 2; i++) summary->direction[i] = isfinite(u[i]) ? u[i] / length : 0;
    }
  }
  return row;
}

/* Slope at row a of the parabola through rows a, b, c; of the line through a and b if the motion reverses, or there is
   no row c. */
static PetscReal Tangent(const LamSummary *summary, PetscInt a, PetscInt b, PetscInt c)
{
  const PetscInt rows[3] = {a, b, c}, count = summary->curve.count;
  PetscReal u[3], R[3];
  PetscInt known = 0;

  for (int i = 0; i < 3; i++) {
    if (rows[i] < 0 || rows[i] >= count) break;
    u[i] = LamSummaryDisplacement(summary, rows[i]);
    R[i] = LamSummaryReaction(summary, rows[i]);
    known++;
  }
  if (known < 2 || u[1] == u[0]) return NAN;
  const PetscReal chord = (R[1] - R[0]) / (u[1] - u[0]);
  if (known < 3 || (u[2] - u[1]) * (u[1] - u[0]) <= 0) return chord;
  const PetscReal next = (R[2] - R[1]) / (u[2] - u[1]);
  return chord + (next - chord) / (u[2] - u[0]) * (u[0] - u[1]);
}

/* Sets height and length if the loaded side is an edge of a box. */
static void MeasureBox(LamSummary *summary)
{
  static const char *const upright[] = {"left", "right"}, *const level[] = {"bottom", "top"};
  const PetscReal *box = summary->scene->macro.box, mm = summary->scene->scales.macro_length * 1e3;
  const char *name = summary->curve.side[summary->side];

  if (summary->scene->macro.source != LAM_MESH_BOX) return;
  for (int k = 0; k < 2; k++) {
    const PetscBool is_level = (PetscBool)!strcmp(name, level[k]);
    if (!is_level && strcmp(name, upright[k])) continue;
    summary->height = box[is_level ? 1 : 0] * mm;
    summary->length = box[is_level ? 0 : 1] * mm;
  }
}

void LamSummaryFind(LamSummary *summary)
{
  const PetscInt furthest = FindLoadedSide(summary), last = summary->curve.count - 1;
  PetscReal force = 0;

  summary->stiffness = (LamSummaryStiffness){NAN, NAN, NAN};
  summary->height = summary->length = NAN;
  summary->firmest = -1;
  if (summary->side < 0) return;
  MeasureBox(summary);
  summary->stiffness.initial = Tangent(summary, 0, 1, 2);
  summary->stiffness.final = Tangent(summary, last, last - 1, last - 2);
  summary->stiffness.secant = Tangent(summary, 0, furthest, -1);
  for (PetscInt k = 0; k <= last; k++) {
    if (LamSummaryReaction(summary, k) <= force) continue;
    force = LamSummaryReaction(summary, k);
    summary->firmest = k;
  }
}
