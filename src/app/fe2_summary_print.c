/*
  Human-readable summary of an FE2 run, from the JSON of its file.
*/
#include "app.h"
#include "fe2_summary.h"
#include <math.h>

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

/* Prints the first onset of a mode, or the reason if it was not evaluated (not in the object). */
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
  if (json_object_get(summary, "opening")) PrintMode(out, summary, "opening", ""); /* contact tissue only */
  PrintMode(out, summary, "separation", "the scene has no strength.lamella_normal or lamella_shear");
  PrintMode(out, summary, "rupture", "the scene has no strength.wall");
  if (loaded) PrintSlopes(out, "stiffness", json_object_get(summary, "stiffness"));
  if (modulus) PrintSlopes(out, "modulus", modulus);
  if (firmness)
    fprintf(out, "  %-18s %.4g N/mm at u %.4g mm, load factor %.4g\n", "largest force", Number(firmness, "reaction"),
            Number(firmness, "displacement"), Number(firmness, "load_factor"));
  fprintf(out, "  %-18s %.4g N mm/mm\n", "work", Number(summary, "work"));
}
