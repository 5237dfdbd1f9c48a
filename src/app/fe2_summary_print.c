/*
  The summary of a macroscale run, as JSON for its file and as a few lines for a person.
*/
#include "app.h"
#include "fe2_summary.h"
#include <math.h>

/* ---- JSON ---- */

/* Linear between the rows around an onset. */
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

/* The first onset of a mode, "opening", "separation", "rupture": null where it is not reached, absent where it is not
   judged; and those of all criteria that are judged. */
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

/* ---- for a person ---- */

static double Number(const json_t *object, const char key[])
{
  const json_t *value = json_object_get(object, key);

  return json_is_number(value) ? json_number_value(value) : NAN;
}

/* " 0.0812", or "unknown". */
static void PrintNumber(FILE *out, const char words[], double value)
{
  if (isfinite(value))
    fprintf(out, "%s %.4g", words, value);
  else
    fprintf(out, "%s unknown", words);
}

static void PrintOnset(FILE *out, const json_t *onset)
{
  const json_t *place = json_object_get(onset, "place");

  fprintf(out, "%s %s load factor %.4g", json_string_value(json_object_get(onset, "criterion")),
          json_is_true(json_object_get(onset, "interpolated")) ? "at" : "found at", Number(onset, "load_factor"));
  if (isfinite(Number(onset, "displacement")))
    fprintf(out, ", u %.4g mm, R %.4g N/mm", Number(onset, "displacement"), Number(onset, "reaction"));
  fprintf(out, "; element %lld, point %lld at (%.4g, %.4g) mm\n",
          (long long)json_integer_value(json_object_get(onset, "element")),
          (long long)json_integer_value(json_object_get(onset, "point")), json_number_value(json_array_get(place, 0)),
          json_number_value(json_array_get(place, 1)));
}

static void PrintSlopes(FILE *out, const char name[], const json_t *slopes)
{
  fprintf(out, "  %-18s", name);
  PrintNumber(out, " initial", Number(slopes, "initial"));
  PrintNumber(out, ", final", Number(slopes, "final"));
  PrintNumber(out, ", secant", Number(slopes, "secant"));
  fputs(" MPa", out);
  if (isfinite(Number(slopes, "height")))
    fprintf(out, " (height %.4g mm over length %.4g mm)", Number(slopes, "height"), Number(slopes, "length"));
  fputc('\n', out);
}

/* The first onset of a mode. What is not judged (it is not in the object) has its reason said. */
static void PrintMode(FILE *out, const json_t *summary, const char mode[], const char unjudged[])
{
  const json_t *onset = json_object_get(summary, mode);

  fprintf(out, "  %-18s ", mode);
  if (!onset)
    fprintf(out, "not judged: %s\n", unjudged);
  else if (json_is_object(onset))
    PrintOnset(out, onset);
  else
    fprintf(out, "not reached\n");
}

void LamSummaryPrint(FILE *out, const json_t *summary)
{
  const json_t *loaded = json_object_get(summary, "loaded");
  const json_t *modulus = json_object_get(summary, "modulus"), *firmness = json_object_get(summary, "firmness");
  const json_t *direction = json_object_get(loaded, "direction");

  if (!json_object_size(summary)) return;
  fprintf(out, "summary\n");
  if (loaded)
    fprintf(out, "  %-18s %s, along (%.3g, %.3g)\n", "loaded side",
            json_string_value(json_object_get(loaded, "boundary")), json_number_value(json_array_get(direction, 0)),
            json_number_value(json_array_get(direction, 1)));
  if (json_object_get(summary, "opening")) PrintMode(out, summary, "opening", ""); /* of contact tissue alone */
  PrintMode(out, summary, "separation", "the scene has no strength.lamella_normal or lamella_shear");
  PrintMode(out, summary, "rupture", "the scene has no strength.wall");
  if (loaded) PrintSlopes(out, "stiffness", json_object_get(summary, "stiffness"));
  if (modulus) PrintSlopes(out, "modulus", modulus);
  if (firmness)
    fprintf(out, "  %-18s %.4g N/mm at u %.4g mm, load factor %.4g\n", "largest force", Number(firmness, "reaction"),
            Number(firmness, "displacement"), Number(firmness, "load_factor"));
  fprintf(out, "  %-18s %.4g N mm/mm\n", "work", Number(summary, "work"));
}
