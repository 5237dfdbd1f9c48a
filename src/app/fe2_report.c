/*
  Reports of the steps of an FE2 run: JSON objects, or a table with totals.
*/
#include "app.h"
#include "fe2_report.h"
#include <stdio.h>
#include "clock.h"
#include <lamella/ellipticity.h>
#include <math.h>
#include <string.h>

/* Factors from nondimensional to the unit of forces, and MPa. */
static PetscReal ForceUnit(const LamFE2Run *run)
{
  return run->summary.curve.units.force;
}

static PetscReal MPa(const LamFE2Run *run)
{
  return run->scene->scales.stress * 1e-6;
}

static json_t *SidesToJSON(const LamFE2Run *run, const LamMacroStep *step, const PetscReal force[][2])
{
  json_t *sides = json_object();

  for (PetscInt s = 0; s < step->boundary_count; s++)
    json_object_set_new(sides, step->boundary[s], LamJSONReals(2, force[s], ForceUnit(run)));
  return sides;
}

/* What a certificate says, as members of an object. */
static void SetCertificate(const LamFE2Run *run, const LamMacroStep *step, const LamMacroCertificate *certificate,
                           json_t *object)
{
  if (!certificate->made) return;
  if (certificate->why[0]) json_object_set_new(object, "uncertified", json_string(certificate->why));
  if (certificate->why[0]) return;
  json_object_set_new(object, "certified", SidesToJSON(run, step, certificate->reaction));
  json_object_set_new(object, "certified_margin", SidesToJSON(run, step, certificate->margin));
  json_object_set_new(object, "certified_points", json_integer(certificate->points));
  json_object_set_new(object, "interpolated_points", json_integer(certificate->of));
}

static json_t *NumbersToJSON(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  const PetscReal mm = run->scene->scales.macro_length * 1e3;
  json_t *reaction = SidesToJSON(run, step, step->reaction);

  return json_pack(
      "{s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:o, s:o, "
      "s:I, s:o, s:o}",
      "step", (json_int_t)step->step, "load_factor", LamJSONReal(step->load_factor), "reaction", reaction, "work",
      LamJSONReal(step->work * run->summary.curve.units.energy), "debonded_fraction",
      LamJSONReal(step->debonded_fraction), "max_gap", LamJSONReal(step->max_gap), "turgor_mean",
      LamJSONReal(step->turgor_mean * MPa(run)), "newton_iterations", (json_int_t)step->newton_iterations, "cutbacks",
      (json_int_t)step->cutbacks, "queries", (json_int_t)step->queries, "hits", (json_int_t)step->hits, "solves",
      (json_int_t)step->solves, "failures", (json_int_t)step->failures, "seconds", LamJSONReal(step->seconds),
      "solve_seconds", LamJSONReal(step->solve_seconds), "peak_memory_mb", LamJSONReal(peak_memory), "residuals",
      LamJSONReals(step->residual_count, step->residuals, 1), "convergence_order", LamJSONReal(step->order),
      /* of the material point closest to localisation */
      "ellipticity", LamJSONReal(step->ellipticity * MPa(run)), "localised_points", (json_int_t)step->localised_points,
      "localisation_normal", LamJSONReals(2, step->localisation_normal, 1), "localisation_place",
      LamJSONReals(2, step->localisation_place, mm),
      /* sources of the responses, and the time outside of solves */
      "interpolated", (json_int_t)step->interpolated, "query_seconds", LamJSONReal(step->query_seconds),
      "other_seconds", LamJSONReal(PetscMax(0, step->seconds - step->query_seconds - step->solve_seconds)));
}

/* Of a lamella that breaks. */
static void SetLamella(const LamFE2Run *run, const LamMacroStep *step, json_t *object)
{
  const PetscReal energy = run->summary.curve.units.energy;

  if (isnan(step->broken_fraction)) return;
  json_object_set_new(object, "broken_fraction", LamJSONReal(step->broken_fraction));
  json_object_set_new(object, "stored", LamJSONReal(step->stored * energy));
  json_object_set_new(object, "dissipated", LamJSONReal(step->dissipated * energy));
  json_object_set_new(object, "released", LamJSONReal(step->released * energy));
  json_object_set_new(object, "tissue_work", LamJSONReal(step->tissue_work * energy));
  json_object_set_new(object, "mesh_dependent", json_boolean(step->mesh_dependent));
}

json_t *LamFE2StepToJSON(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  json_t *object = json_object(), *numbers = NumbersToJSON(run, step, peak_memory);

  SetCertificate(run, step, &step->certificate, object);
  if (step->peak.made) {
    json_t *peak = json_pack("{s:I, s:o}", "step", (json_int_t)step->peak.step, "load_factor",
                             LamJSONReal(step->peak.load_factor));
    SetCertificate(run, step, &step->peak, peak);
    json_object_set_new(object, "peak", peak);
  }
  SetLamella(run, step, numbers);
  json_object_update(object, numbers); /* last: of keys that are there twice, scripts that read lines take these */
  json_decref(numbers);
  return object;
}

/* If there are several. */
static void PrintTissues(const LamFE2Tissues *tissues)
{
  if (tissues->count == 1) return;
  printf("%-20s %10s %12s %12s %12s\n", "tissue", "points", "apothem um", "wall um", "C1+C2 MPa");
  for (PetscInt t = 0; t < tissues->count; t++) {
    const LamFE2Tissue *tissue = &tissues->tissues[t];
    const LamScales *scales = &tissue->scene.scales;

    printf("%-20s %10lld %12.4g %12.4g %12.4g\n", tissue->name[0] ? tissue->name : "rve",
           (long long)tissue->body_points, (double)(scales->length * 1e6),
           (double)(tissue->scene.micro.wall_thickness * scales->length * 1e6), (double)(scales->stress * 1e-6));
  }
}

const char *LamFE2ForceName(const LamFE2Run *run)
{
  return run->scene->macro.symmetry == LAM_AXISYMMETRIC ? "N" : "N per mm of thickness";
}

#define BALANCE 1e-9 /* of the largest reaction: equilibrium holds to this (macro/stepping.c), less is noise */

void LamFE2PrintSides(const LamFE2Run *run, const LamMacroStep *step, PetscBool names)
{
  PetscReal largest = 0;

  for (PetscInt s = 0; s < step->boundary_count; s++)
    for (int i = 0; i < 2; i++) largest = PetscMax(largest, fabs(step->reaction[s][i]));
  for (PetscInt s = 0; s < step->boundary_count; s++)
    for (int i = 0; i < 2; i++) {
      if (names)
        printf(" %9s.%c", step->boundary[s], "xy"[i]);
      else
        printf(" %11.4e", fabs(step->reaction[s][i]) < BALANCE * largest
                              ? 0.0
                              : (double)(LamWithoutNoise(step->reaction[s][i]) * ForceUnit(run)));
    }
}

static void PrintHeader(const LamFE2Run *run, const LamMacroStep *step)
{
  PrintTissues(&run->tissues);
  printf("Reactions in %s; solving: seconds of it in RVE solves; residuals relative to the forces of the elements.\n"
         "%4s %7s",
         LamFE2ForceName(run), "step", "load");
  LamFE2PrintSides(run, step, PETSC_TRUE);
  printf(" %5s %8s %8s %8s %8s %8s  %s\n", "iter.", "queries", "hits", "solves", "seconds", "solving", "residuals");
}

static void PrintForces(const LamFE2Run *run, const LamMacroStep *step, const char name[], const PetscReal force[][2])
{
  printf("%12s", name);
  for (PetscInt s = 0; s < step->boundary_count; s++)
    for (int i = 0; i < 2; i++) printf(" %11.4e", (double)(LamWithoutNoise(force[s][i]) * ForceUnit(run)));
}

/* Reactions corrected by direct solves, and their margins, below the row. */
static void PrintCertificate(const LamFE2Run *run, const LamMacroStep *step, const LamMacroCertificate *certificate)
{
  if (!certificate->made) return;
  if (certificate->why[0]) {
    printf("%12s  no: %s\n", "certified", certificate->why);
    return;
  }
  PrintForces(run, step, "certified", certificate->reaction);
  printf("  step %" PetscInt_FMT "\n", certificate->step);
  PrintForces(run, step, "+-", certificate->margin);
  printf("  with 99 %%, from %" PetscInt_FMT " of %" PetscInt_FMT " interpolated points\n", certificate->points,
         certificate->of);
}

static void PrintRow(const LamFE2Run *run, const LamMacroStep *step)
{
  printf("%4" PetscInt_FMT " %7.4f", step->step, (double)step->load_factor);
  LamFE2PrintSides(run, step, PETSC_FALSE);
  printf(" %5" PetscInt_FMT " %8lld %8lld %8lld %8.2f %8.2f ", step->newton_iterations, (long long)step->queries,
         (long long)step->hits, (long long)step->solves, (double)step->seconds, (double)step->solve_seconds);
  for (PetscInt k = 0; k < step->residual_count; k++) printf(" %.0e", (double)step->residuals[k]);
  putchar('\n');
  PrintCertificate(run, step, &step->certificate);
  PrintCertificate(run, step, &step->peak);
  fflush(stdout);
}

/* Once, in the first step in which ellipticity is lost. */
static void WarnOfLocalisation(LamConsole *console, const LamFE2Run *run, const LamMacroStep *step)
{
  const PetscReal mm = run->scene->scales.macro_length * 1e3;

  if (console->warned || !step->localised_points) return;
  console->warned = PETSC_TRUE;
  LamReportNote(
      &run->reporter,
      "%s: step %d: at %d material points the tissue has lost ellipticity, most at (%.4g, %.4g) mm "
      "in a band whose normal is at %.1f degrees: it localises, and results then depend on the mesh of the body",
      run->scene_path, (int)step->step, (int)step->localised_points, (double)(step->localisation_place[0] * mm),
      (double)(step->localisation_place[1] * mm), (double)LamBandAngle(step->localisation_normal));
}

PetscErrorCode LamFE2ReportStep(void *ctx, const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  LamConsole *console = (LamConsole *)ctx;

  PetscFunctionBeginUser;
  LamConsoleClear();
  if (console->json)
    PetscCall(LamPrintJSON(LamFE2StepToJSON(run, step, peak_memory)));
  else {
    if (run->totals.steps == run->resumed_steps) PrintHeader(run, step);
    PrintRow(run, step);
  }
  WarnOfLocalisation(console, run, step);
  PetscFunctionReturn(0);
}

/* ---- summary ---- */

static double Number(const json_t *object, const char key[])
{
  const json_t *value = json_object_get(object, key);

  return json_is_number(value) ? json_number_value(value) : NAN;
}

/* What the summary says, or of an older file the unit of those. */
static const char *Unit(const json_t *summary, const char key[], const char older[])
{
  const char *unit = json_string_value(json_object_get(summary, key));

  return unit ? unit : older;
}

/* " 0.0812", or "unknown". */
static void PrintNumber(const char words[], double value)
{
  if (isfinite(value))
    printf("%s %.4g", words, value);
  else
    printf("%s unknown", words);
}

static void PrintOnset(const json_t *onset, const char force[])
{
  const json_t *place = json_object_get(onset, "place");

  printf("%s %s load factor %.4g", json_string_value(json_object_get(onset, "criterion")),
         json_is_true(json_object_get(onset, "interpolated")) ? "at" : "found at", Number(onset, "load_factor"));
  if (isfinite(Number(onset, "displacement")))
    printf(", u %.4g mm, R %.4g %s", Number(onset, "displacement"), Number(onset, "reaction"), force);
  printf("; element %lld, point %lld at (%.4g, %.4g) mm\n",
         (long long)json_integer_value(json_object_get(onset, "element")),
         (long long)json_integer_value(json_object_get(onset, "point")), json_number_value(json_array_get(place, 0)),
         json_number_value(json_array_get(place, 1)));
}

static void PrintSlopes(const char name[], const json_t *slopes, const char unit[])
{
  const double area = Number(slopes, "area");

  printf("  %-18s", name);
  PrintNumber(" initial", Number(slopes, "initial"));
  PrintNumber(", final", Number(slopes, "final"));
  PrintNumber(", secant", Number(slopes, "secant"));
  printf(" %s", unit);
  if (isfinite(area))
    printf(" (height %.4g mm over area %.4g mm^2)", Number(slopes, "height"), area);
  else if (isfinite(Number(slopes, "height")))
    printf(" (height %.4g mm over length %.4g mm)", Number(slopes, "height"), Number(slopes, "length"));
  putchar('\n');
}

/* Prints the first onset of a mode, or the reason if it was not evaluated (not in the object). */
static void PrintMode(const json_t *summary, const char mode[], const char unjudged[])
{
  const json_t *onset = json_object_get(summary, mode);

  printf("  %-18s ", mode);
  if (!onset)
    printf("not judged: %s\n", unjudged);
  else if (json_is_object(onset))
    PrintOnset(onset, Unit(summary, "force_unit", "N/mm"));
  else
    printf("not reached\n");
}

/* What a lamella that breaks has taken up, and from where on results depend on the mesh. */
static void PrintLamella(const json_t *summary)
{
  const json_t *from = json_object_get(summary, "mesh_dependent");

  if (!json_object_get(summary, "broken_fraction")) return;
  printf("  %-18s %.4g of its fracture energy; stored %.4g, dissipated %.4g, released in jumps %.4g %s\n", "lamella",
         Number(summary, "broken_fraction"), Number(summary, "stored"), Number(summary, "dissipated"),
         Number(summary, "released"), Unit(summary, "energy_unit", "N mm/mm"));
  if (json_is_object(from))
    printf(
        "  %-18s from step %lld (load factor %.4g) on, where the tissue has lost ellipticity: what follows is not of "
        "the tissue alone, but of the mesh of the body, too\n",
        "mesh-dependent", (long long)json_integer_value(json_object_get(from, "step")), Number(from, "load_factor"));
}

void LamSummaryPrint(const json_t *summary)
{
  const char *force = Unit(summary, "force_unit", "N/mm");
  const json_t *loaded = json_object_get(summary, "loaded");
  const json_t *modulus = json_object_get(summary, "modulus"), *firmness = json_object_get(summary, "firmness");
  const json_t *direction = json_object_get(loaded, "direction");

  if (!json_object_size(summary)) return;
  printf("summary\n");
  if (loaded)
    printf("  %-18s %s, along (%.3g, %.3g)\n", "loaded side", json_string_value(json_object_get(loaded, "boundary")),
           json_number_value(json_array_get(direction, 0)), json_number_value(json_array_get(direction, 1)));
  if (json_object_get(summary, "opening")) PrintMode(summary, "opening", ""); /* contact tissue only */
  PrintMode(summary, "separation", "the scene has no strength.lamella_normal or lamella_shear");
  PrintMode(summary, "rupture", "the scene has no strength.wall");
  if (loaded) PrintSlopes("stiffness", json_object_get(summary, "stiffness"), strcmp(force, "N") ? "MPa" : "N/mm");
  if (modulus) PrintSlopes("modulus", modulus, "MPa");
  if (firmness)
    printf("  %-18s %.4g %s at u %.4g mm, load factor %.4g\n", "largest force", Number(firmness, "reaction"), force,
           Number(firmness, "displacement"), Number(firmness, "load_factor"));
  printf("  %-18s %.4g %s\n", "work", Number(summary, "work"), Unit(summary, "energy_unit", "N mm/mm"));
  PrintLamella(summary);
}

PetscErrorCode LamFE2ReportTest(const LamFE2Run *run, const LamConsole *console)
{
  LamTest test;

  PetscFunctionBeginUser;
  if (!console->test.readings) PetscFunctionReturn(0);
  PetscCall(LamSummaryTest(&run->summary, &test));
  PetscCall(LamTestPrint(&test, &console->test, console->json));
  PetscCall(LamTestDestroy(&test));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2ReportEnd(const LamFE2Run *run, const LamConsole *console)
{
  const LamFE2Totals *totals = &run->totals;
  json_t *summary;

  PetscFunctionBeginUser;
  if (!console->json) {
    summary = LamSummaryToJSON(&run->summary);
    LamSummaryPrint(summary);
    json_decref(summary);
  }
  PetscCall(LamFE2ReportTest(run, console));
  if (console->json) PetscFunctionReturn(0);
  printf("%" PetscInt_FMT " steps, %" PetscInt_FMT " Newton iterations, %lld queries, %lld hits, %lld solves, "
         "%lld failures, %.3g s, of these %.2g s for checkpoints; response %s\n",
         totals->steps, totals->newton_iterations, (long long)totals->queries, (long long)totals->hits,
         (long long)totals->solves, (long long)totals->failures, LamClock() - run->start, (double)run->save_seconds,
         LamFE2ResponseNames[run->response]);
  PetscFunctionReturn(0);
}
