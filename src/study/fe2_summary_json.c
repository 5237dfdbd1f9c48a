/*
  The summary of an FE2 run as JSON, for its file.
*/
#include "fe2_summary.h"
#include <math.h>

/* Linear interpolation between the rows around an onset. */
static PetscReal At(PetscReal before, PetscReal now, PetscReal share)
{
  return share < 1 ? before + share * (now - before) : now;
}

static json_t *OnsetToJSON(const LamSummary *summary, LamSummaryCriterion criterion, const LamSummaryOnset *onset)
{
  const LamCurveRow *rows = summary->curve.rows;
  const PetscInt row = onset->row, before = PetscMax(0, row - 1);
  const PetscReal share = onset->share, *now = rows[row].value, *last = rows[before].value;
  json_t *o = json_object();

  json_object_set_new(o, "criterion", json_string(LamSummaryCriterionNames[criterion]));
  json_object_set_new(o, "step", json_integer((json_int_t)now[LAM_CURVE_STEP]));
  json_object_set_new(o, "interpolated", json_boolean(share < 1));
  json_object_set_new(o, "load_factor",
                      LamJSONReal(At(last[LAM_CURVE_LOAD_FACTOR], now[LAM_CURVE_LOAD_FACTOR], share)));
  if (summary->side >= 0) {
    json_object_set_new(
        o, "displacement",
        LamJSONReal(At(LamSummaryDisplacement(summary, before), LamSummaryDisplacement(summary, row), share)));
    json_object_set_new(o, "reaction",
                        LamJSONReal(At(LamSummaryReaction(summary, before), LamSummaryReaction(summary, row), share)));
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

    if (LamSummaryIsJudged(summary, (LamSummaryMode)m))
      json_object_set_new(o, LamSummaryModeNames[m], first ? OnsetToJSON(summary, criterion, first) : json_null());
  }
  for (int c = 0; c < LAM_SUMMARY_CRITERION_COUNT; c++) {
    const LamSummaryOnset *onset = &summary->onset[c];

    if (!onset->judged) continue;
    json_object_set_new(criteria, LamSummaryCriterionNames[c],
                        onset->reached ? OnsetToJSON(summary, (LamSummaryCriterion)c, onset) : json_null());
  }
  json_object_set_new(o, "criteria", criteria);
}

static json_t *SlopesToJSON(const LamSummaryStiffness *s, PetscReal factor)
{
  return json_pack("{s:o, s:o, s:o}", "initial", LamJSONReal(s->initial * factor), "final",
                   LamJSONReal(s->final * factor), "secant", LamJSONReal(s->secant * factor));
}

static void SetLoadedSide(json_t *o, const LamSummary *summary)
{
  const PetscReal factor = summary->height / summary->length;
  const PetscInt k = summary->firmest;

  json_object_set_new(o, "loaded",
                      json_pack("{s:s, s:o}", "boundary", summary->curve.side[summary->side], "direction",
                                LamJSONReals(2, summary->direction, 1)));
  json_object_set_new(o, "stiffness", SlopesToJSON(&summary->stiffness, 1));
  if (isfinite(factor)) {
    json_t *modulus = SlopesToJSON(&summary->stiffness, factor);
    json_object_set_new(modulus, "height", LamJSONReal(summary->height));
    json_object_set_new(modulus, "length", LamJSONReal(summary->length));
    json_object_set_new(o, "modulus", modulus);
  }
  if (k < 0) return;
  json_object_set_new(o, "firmness",
                      json_pack("{s:o, s:o, s:o}", "reaction", LamJSONReal(LamSummaryReaction(summary, k)),
                                "displacement", LamJSONReal(LamSummaryDisplacement(summary, k)), "load_factor",
                                LamJSONReal(summary->curve.rows[k].value[LAM_CURVE_LOAD_FACTOR])));
}

json_t *LamSummaryToJSON(const LamSummary *summary)
{
  json_t *o = json_object();

  if (!summary->curve.count) return o;
  SetOnsets(o, summary);
  json_object_set_new(o, "work", LamJSONReal(summary->curve.rows[summary->curve.count - 1].value[LAM_CURVE_WORK]));
  if (summary->side >= 0) SetLoadedSide(o, summary);
  return o;
}
