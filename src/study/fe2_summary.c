/*
  Onsets, stiffness and firmness of a macroscale run.
*/
#include "fe2_summary.h"
#include "separation.h"
#include <math.h>
#include <string.h>

static const char *const CriterionNames[] = {LAM_SUMMARY_CRITERIA(LAM_NAME_ENTRY)};
static const char *const ModeNames[] = {LAM_SUMMARY_MODES(LAM_NAME_ENTRY)};

static LamSummaryMode ModeOf(LamSummaryCriterion criterion)
{
  if (criterion == LAM_SUMMARY_GAP) return LAM_SUMMARY_OPENING;
  return criterion == LAM_SUMMARY_WALL ? LAM_SUMMARY_RUPTURE : LAM_SUMMARY_SEPARATION;
}

/* Whether any criterion of the mode is evaluated: it applies to this tissue, and its strength is given if needed. */
static PetscBool IsJudged(const LamSummary *summary, LamSummaryMode mode)
{
  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++)
    if (summary->onset[c].judged && ModeOf((LamSummaryCriterion)c) == mode) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool HasLaw(const LamScene *scene, LamInterfaceLawType law)
{
  PetscBool has = (PetscBool)(scene->micro.interface == law);

  for (PetscInt r = 0; r < scene->region_count; r++)
    if (scene->regions[r].micro.interface == law) has = PETSC_TRUE;
  return has;
}

PetscErrorCode LamSummaryCreate(const LamScene *scene, LamSummary *summary)
{
  const PetscBool contact = HasLaw(scene, LAM_INTERFACE_CONTACT);
  const LamStrength *strength = &scene->strength;

  PetscFunctionBeginUser;
  *summary =
      (LamSummary){.scene = scene, .strength = *strength, .side = -1, .firmest = -1, .F0 = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  summary->curve.units = LamMacroUnitsOf(scene);
  summary->onset[LAM_SUMMARY_NORMAL].judged = (PetscBool)isfinite(strength->lamella_normal);
  summary->onset[LAM_SUMMARY_SHEAR].judged = (PetscBool)isfinite(strength->lamella_shear);
  summary->onset[LAM_SUMMARY_UNLOADED].judged = contact;
  summary->onset[LAM_SUMMARY_BROKEN].judged = HasLaw(scene, LAM_INTERFACE_LAMELLA);
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
  const PetscBool has_lamella = (PetscBool)!isnan(field[LAM_POINT_BROKEN]);

  switch (criterion) {
  case LAM_SUMMARY_NORMAL:
    return field[LAM_POINT_NORMAL] / strength->lamella_normal;
  case LAM_SUMMARY_SHEAR:
    return field[LAM_POINT_SHEAR] / strength->lamella_shear;
  case LAM_SUMMARY_BROKEN:
    return field[LAM_POINT_BROKEN_FACE] / LAM_BROKEN;
  case LAM_SUMMARY_UNLOADED:
    if (has_lamella) return 0; /* it holds faces that nothing presses */
    if (isnan(field[LAM_POINT_UNLOADING])) return GapMeasure(field) >= 1 ? PETSC_INFINITY : 0; /* nothing closes them */
    return field[LAM_POINT_UNLOADING] / (1 - LAM_TRACTION_REACHED);
  case LAM_SUMMARY_GAP:
    return has_lamella ? 0 : GapMeasure(field); /* it opens before it breaks */
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
  *onset = (LamSummaryOnset){.judged = PETSC_TRUE,
                             .reached = PETSC_TRUE,
                             .row = summary->curve.count - 1,
                             .share = share,
                             .element = element,
                             .point = p - fields->first_point[element],
                             .place = {fields->place[2 * p] * mm, fields->place[2 * p + 1] * mm}};
}

/*
  Finds the point that reaches the criterion first in the interval before this step; of several at the same load, the
  one with the largest measure at the step. Differences of the size of rounding errors are ignored, so that among points
  that are equal by symmetry the first is reported, for any number of ranks. measures: [point][criterion] at the step.
*/
static void Seek(const LamSummary *summary, const LamMacroFields *fields, const PetscReal measures[],
                 LamSummaryCriterion criterion, LamSummaryOnset *onset)
{
  const PetscReal rounding = 1e-6;
  PetscReal first = 2, largest = 0;
  PetscInt which = -1;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    const PetscInt at = p * LAM_SUMMARY_CRITERION_COUNT + criterion;
    const PetscReal now = measures[at], share = Crossing(criterion, summary->before ? summary->before[at] : NAN, now);
    if (share > 1 || share > first + rounding || (share > first - rounding && !(now > largest * (1 + rounding))))
      continue;
    first = share;
    largest = now;
    which = p;
  }
  if (which >= 0) Keep(summary, fields, which, first, onset);
}

/* Volume fraction of the points at which any criterion of the mode is reached; NaN: none is evaluated. */
static PetscReal ReachedShare(const LamSummary *summary, const LamMacroFields *fields, const PetscReal measures[],
                              LamSummaryMode mode)
{
  PetscReal volume = 0, reached = 0;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    PetscBool any = PETSC_FALSE;

    for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++)
      if (ModeOf((LamSummaryCriterion)c) == mode && measures[p * LAM_SUMMARY_CRITERION_COUNT + c] >= 1)
        any = PETSC_TRUE;
    volume += fields->volume[p];
    if (any) reached += fields->volume[p];
  }
  return IsJudged(summary, mode) ? reached / volume : NAN;
}

static PetscErrorCode AddOnsets(LamSummary *summary, const LamMacroFields *fields)
{
  const PetscInt n = LAM_SUMMARY_CRITERION_COUNT;
  PetscReal *measures, *row = summary->curve.rows[summary->curve.count - 1].value;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fields->point_count * n, &measures));
  for (PetscInt k = 0; k < fields->point_count * n; k++)
    measures[k] = summary->onset[k % n].judged
                      ? Measure(summary, (LamSummaryCriterion)(k % n), &fields->point[k / n * LAM_POINT_FIELD_COUNT])
                      : NAN;
  row[LAM_CURVE_SEPARATED] = ReachedShare(summary, fields, measures, LAM_SUMMARY_SEPARATION);
  row[LAM_CURVE_RUPTURED] = ReachedShare(summary, fields, measures, LAM_SUMMARY_RUPTURE);
  for (int c = 0; c < n; c++)
    if (summary->onset[c].judged && !summary->onset[c].reached)
      Seek(summary, fields, measures, (LamSummaryCriterion)c, &summary->onset[c]);
  PetscCall(PetscFree(summary->before));
  summary->before = measures;
  summary->before_count = fields->point_count * n;
  PetscFunctionReturn(0);
}

const LamSummaryOnset *LamSummaryFirst(const LamSummary *summary, LamSummaryMode mode, LamSummaryCriterion *criterion)
{
  const LamSummaryOnset *first = NULL;

  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++) {
    const LamSummaryOnset *onset = &summary->onset[c];
    if (!onset->reached || ModeOf((LamSummaryCriterion)c) != mode) continue;
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

/* Displacement (mm) or reaction of the loaded side along its direction, at a row. */
static PetscReal Displacement(const LamSummary *summary, PetscInt row)
{
  return Along(summary, summary->curve.rows[row].displacement[summary->side]);
}

static PetscReal Reaction(const LamSummary *summary, PetscInt row)
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
    u[i] = Displacement(summary, rows[i]);
    R[i] = Reaction(summary, rows[i]);
    known++;
  }
  if (known < 2 || u[1] == u[0]) return NAN;
  const PetscReal chord = (R[1] - R[0]) / (u[1] - u[0]);
  if (known < 3 || (u[2] - u[1]) * (u[1] - u[0]) <= 0) return chord;
  const PetscReal next = (R[2] - R[1]) / (u[2] - u[1]);
  return chord + (next - chord) / (u[2] - u[0]) * (u[0] - u[1]);
}

/* Sets height and length, or area, if the loaded side is an edge of a box. */
static void MeasureBox(LamSummary *summary)
{
  static const char *const upright[] = {"left", "right"}, *const level[] = {"bottom", "top"};
  const PetscReal *box = summary->scene->macro.box, mm = summary->scene->scales.macro_length * 1e3;
  const char *name = summary->curve.side[summary->side];

  if (summary->scene->macro.source != LAM_MESH_BOX) return;
  for (int k = 0; k < 2; k++) {
    const PetscBool is_level = (PetscBool)!strcmp(name, level[k]);
    if (!is_level && strcmp(name, upright[k])) continue;
    summary->is_level = is_level;
    summary->height = box[is_level ? 1 : 0] * mm;
    summary->length = box[is_level ? 0 : 1] * mm;
    if (summary->scene->macro.symmetry != LAM_AXISYMMETRIC) continue;
    summary->length *= PETSC_PI * box[0] * mm * (is_level ? 1 : 2); /* of the end, or the mantle, of the cylinder */
  }
}

/* Finds the loaded side, stiffness and firmness. */
static void FindStiffness(LamSummary *summary)
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
    if (Reaction(summary, k) <= force) continue;
    force = Reaction(summary, k);
    summary->firmest = k;
  }
}

/* The diagonal, from which strain counts. */
static void TakeInflated(LamSummary *summary, const LamMacroFields *fields)
{
  PetscReal volume = 0, sum[9] = {0};

  for (PetscInt p = 0; p < fields->point_count; p++) {
    volume += fields->volume[p];
    for (int i = 0; i < 9; i += 4) sum[i] += fields->volume[p] * fields->load[p].F[i];
  }
  for (int i = 0; i < 9; i++) summary->F0[i] = sum[i] / volume;
}

PetscErrorCode LamSummaryAdd(LamSummary *summary, const LamMacroStep *step, const LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  if (!summary->curve.count && summary->scene->macro.inflate) TakeInflated(summary, fields);
  PetscCall(LamCurveAdd(&summary->curve, step, fields, &summary->scene->scales));
  PetscCall(AddOnsets(summary, fields));
  FindStiffness(summary);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSummaryArchive(LamSummary *summary, LamArchive archive)
{
  LamCurve *curve = &summary->curve;

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "sides", sizeof(curve->side_count), &curve->side_count));
  PetscCall(LamArchiveShared(archive, "side names", sizeof(curve->side), curve->side));
  PetscCall(LamArchiveShared(archive, "inflated tissue", sizeof(summary->F0), summary->F0));
  PetscCall(LamArchiveShared(archive, "onsets", sizeof(summary->onset), summary->onset));
  PetscCall(LamArchiveList(archive, "curves", sizeof(LamCurveRow), &curve->count, (void **)&curve->rows));
  PetscCall(LamArchiveList(archive, "measures", sizeof(PetscReal), &summary->before_count, (void **)&summary->before));
  curve->capacity = curve->count;
  FindStiffness(summary);
  PetscFunctionReturn(0);
}

/* ---- the mechanical test ---- */

PetscErrorCode LamSummaryTest(const LamSummary *summary, LamTest *test)
{
  const LamMacroSpec *spec = &summary->scene->macro;
  PetscReal height = 1, length = 1;
  PetscInt k = 0;

  PetscFunctionBeginUser;
  *test = (LamTest){.scene = summary->scene,
                    .component = 4,
                    .lateral = -1,
                    .is_force = PETSC_TRUE,
                    .unit = 1,
                    .volume = 1,
                    .inflated = spec->inflate,
                    .area = spec->area};
  if (summary->side < 0) PetscFunctionReturn(0);
  test->side = summary->curve.side[summary->side];
  if (isfinite(summary->height)) {
    test->is_force = PETSC_FALSE;
    test->component = summary->is_level ? 4 : 0; /* the normal of the side */
    LamTestSetInflated(test, summary->F0);
    height = summary->height * test->length;
    length = summary->length / test->area_factor;
  }
  while (k + 1 < summary->curve.count && Displacement(summary, k + 1) == 0) k++;
  if (Displacement(summary, k) != 0 && summary->scene->turgor == 0)
    PetscCall(LamTestAddPoint(test, (LamTestPoint){.modulus = NAN, .poisson = NAN, .lateral = NAN}));
  for (; k < summary->curve.count; k++)
    PetscCall(LamTestAddPoint(test, (LamTestPoint){.state = (PetscInt)summary->curve.rows[k].value[LAM_CURVE_STEP],
                                                   .strain = Displacement(summary, k) / height,
                                                   .stress = Reaction(summary, k) / length,
                                                   .modulus = k ? NAN : summary->stiffness.initial * height / length,
                                                   .poisson = NAN,
                                                   .lateral = NAN}));
  PetscFunctionReturn(0);
}

/* ---- JSON ---- */

/* Linear interpolation between the rows around an onset. */
static PetscReal At(PetscReal before, PetscReal now, PetscReal share)
{
  return share < 1 ? before + share * (now - before) : now;
}

static json_t *OnsetToJSON(const LamSummary *summary, LamSummaryCriterion criterion, const LamSummaryOnset *onset)
{
  const PetscInt row = onset->row, before = PetscMax(0, row - 1);
  const PetscReal share = onset->share, *now = summary->curve.rows[row].value,
                  *last = summary->curve.rows[before].value;
  json_t *o = json_pack("{s:s, s:I, s:b, s:o}", "criterion", CriterionNames[criterion], "step",
                        (json_int_t)now[LAM_CURVE_STEP], "interpolated", share < 1, "load_factor",
                        LamJSONReal(At(last[LAM_CURVE_LOAD_FACTOR], now[LAM_CURVE_LOAD_FACTOR], share)));

  if (summary->side >= 0) {
    json_object_set_new(o, "displacement",
                        LamJSONReal(At(Displacement(summary, before), Displacement(summary, row), share)));
    json_object_set_new(o, "reaction", LamJSONReal(At(Reaction(summary, before), Reaction(summary, row), share)));
  }
  json_object_set_new(o, "element", json_integer(onset->element));
  json_object_set_new(o, "point", json_integer(onset->point));
  json_object_set_new(o, "place", LamJSONReals(2, onset->place, 1));
  return o;
}

/* Sets the first onset of each mode ("opening", "separation", "rupture"): null if not reached, absent if not evaluated;
   and the onsets of all evaluated criteria. */
static void SetOnsets(json_t *o, const LamSummary *summary)
{
  json_t *criteria = json_object();

  for (int m = 0; m < LAM_SUMMARY_MODE_COUNT; m++) {
    LamSummaryCriterion criterion = LAM_SUMMARY_CRITERION_COUNT;
    const LamSummaryOnset *first = LamSummaryFirst(summary, (LamSummaryMode)m, &criterion);

    if (IsJudged(summary, (LamSummaryMode)m))
      json_object_set_new(o, ModeNames[m], first ? OnsetToJSON(summary, criterion, first) : json_null());
  }
  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++) {
    const LamSummaryOnset *onset = &summary->onset[c];

    if (!onset->judged) continue;
    json_object_set_new(criteria, CriterionNames[c],
                        onset->reached ? OnsetToJSON(summary, (LamSummaryCriterion)c, onset) : json_null());
  }
  json_object_set_new(o, "criteria", criteria);
}

static json_t *SlopesToJSON(const LamSummaryStiffness *s, PetscReal factor)
{
  return json_pack("{s:o, s:o, s:o}", "initial", LamJSONReal(s->initial * factor), "final",
                   LamJSONReal(s->final * factor), "secant", LamJSONReal(s->secant * factor));
}

static void SetTest(json_t *o, const LamSummary *summary)
{
  LamTest test;

  if (!LamSummaryTest(summary, &test) && test.count > 1) json_object_set_new(o, "test", LamTestToJSON(&test, 0, NULL));
  (void)LamTestDestroy(&test);
}

static void SetLoadedSide(json_t *o, const LamSummary *summary)
{
  const PetscReal factor = summary->height / summary->length;
  const PetscInt k = summary->firmest;

  json_object_set_new(o, "loaded",
                      json_pack("{s:s, s:o}", "boundary", summary->curve.side[summary->side], "direction",
                                LamJSONReals(2, summary->direction, 1)));
  SetTest(o, summary);
  json_object_set_new(o, "stiffness", SlopesToJSON(&summary->stiffness, 1));
  if (isfinite(factor)) {
    const PetscBool around = (PetscBool)(summary->scene->macro.symmetry == LAM_AXISYMMETRIC);
    json_t *modulus = SlopesToJSON(&summary->stiffness, factor);
    json_object_set_new(modulus, "height", LamJSONReal(summary->height));
    json_object_set_new(modulus, around ? "area" : "length", LamJSONReal(summary->length));
    json_object_set_new(o, "modulus", modulus);
  }
  if (k < 0) return;
  json_object_set_new(o, "firmness",
                      json_pack("{s:o, s:o, s:o}", "reaction", LamJSONReal(Reaction(summary, k)), "displacement",
                                LamJSONReal(Displacement(summary, k)), "load_factor",
                                LamJSONReal(summary->curve.rows[k].value[LAM_CURVE_LOAD_FACTOR])));
}

/* Of a lamella that breaks: at the last step its damage and energies, and the step from which on the curve depends on
   the mesh of the body; null: none does. */
static void SetLamella(json_t *o, const LamSummary *summary)
{
  static const struct {
    const char *name;
    LamCurveColumn column;
  } members[] = {{"broken_fraction", LAM_CURVE_BROKEN},
                 {"stored", LAM_CURVE_STORED},
                 {"dissipated", LAM_CURVE_DISSIPATED},
                 {"released", LAM_CURVE_RELEASED},
                 {"tissue_work", LAM_CURVE_TISSUE_WORK}};
  const LamCurve *curve = &summary->curve;
  json_t *from = json_null();

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(members); k++)
    json_object_set_new(o, members[k].name, LamJSONReal(curve->rows[curve->count - 1].value[members[k].column]));
  for (PetscInt k = 0; k < curve->count && json_is_null(from); k++) {
    const PetscReal *row = curve->rows[k].value;

    if (row[LAM_CURVE_MESH_DEPENDENT] != 0)
      from = json_pack("{s:I, s:o}", "step", (json_int_t)row[LAM_CURVE_STEP], "load_factor",
                       LamJSONReal(row[LAM_CURVE_LOAD_FACTOR]));
  }
  json_object_set_new(o, "mesh_dependent", from);
}

json_t *LamSummaryToJSON(const LamSummary *summary)
{
  json_t *o = json_object();

  if (!summary->curve.count) return o;
  SetOnsets(o, summary);
  json_object_set_new(o, "force_unit", json_string(summary->curve.units.force_name));
  json_object_set_new(o, "energy_unit", json_string(summary->curve.units.energy_name));
  json_object_set_new(o, "work", LamJSONReal(summary->curve.rows[summary->curve.count - 1].value[LAM_CURVE_WORK]));
  if (LamCurveHas(&summary->curve, LAM_CURVE_BROKEN)) SetLamella(o, summary);
  if (summary->side >= 0) SetLoadedSide(o, summary);
  return o;
}
