/*
  What a macroscale run tells of its steps: JSON objects, or a table with totals.
*/
#include "fe2_run.h"
#include <stdio.h>
#include <lamella/clock.h>

/* Factors from nondimensional to N per mm of thickness, and MPa. */
static PetscReal ForceUnit(const LamFE2Run *run)
{
  return run->scene->scales.stress * run->scene->scales.macro_length * 1e-3;
}

static PetscReal MPa(const LamFE2Run *run)
{
  return run->scene->scales.stress * 1e-6;
}

static PetscErrorCode PrintStepJSON(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  const LamScales *scales = &run->scene->scales;
  json_t *reaction = json_object(), *object;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < step->boundary_count; s++)
    json_object_set_new(reaction, step->boundary[s], LamJSONReals(2, step->reaction[s], ForceUnit(run)));
  object = json_pack("{s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o}", "step",
                     (json_int_t)step->step, "load_factor", LamJSONReal(step->load_factor), "reaction", reaction,
                     "work", LamJSONReal(step->work * scales->stress * PetscSqr(scales->macro_length)),
                     "debonded_fraction", LamJSONReal(step->debonded_fraction), "max_gap", LamJSONReal(step->max_gap),
                     "turgor_mean", LamJSONReal(step->turgor_mean * MPa(run)), "newton_iterations",
                     (json_int_t)step->newton_iterations, "cutbacks", (json_int_t)step->cutbacks, "queries",
                     (json_int_t)step->queries, "hits", (json_int_t)step->hits, "solves", (json_int_t)step->solves,
                     "failures", (json_int_t)step->failures, "seconds", LamJSONReal(step->seconds), "solve_seconds",
                     LamJSONReal(step->solve_seconds), "peak_memory_mb", LamJSONReal(peak_memory), "residuals",
                     LamJSONReals(step->residual_count, step->residuals, 1));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

static void PrintHeader(const LamFE2Run *run, const LamMacroStep *step)
{
  printf("Reactions in N per mm of thickness; solving: seconds of it in RVE solves; residuals relative to the forces "
         "of the elements.\n%4s %7s",
         "step", "load");
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (int i = 0; i < 2; i++) printf(" %*s.%c", 9, step->boundary[s], "xy"[i]);
  }
  printf(" %5s %8s %8s %8s %8s %8s  %s\n", "iter.", "queries", "hits", "solves", "seconds", "solving", "residuals");
}

static void PrintRow(const LamFE2Run *run, const LamMacroStep *step)
{
  printf("%4" PetscInt_FMT " %7.4f", step->step, (double)step->load_factor);
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    for (int i = 0; i < 2; i++) printf(" %11.4e", (double)(step->reaction[s][i] * ForceUnit(run)));
  }
  printf(" %5" PetscInt_FMT " %8lld %8lld %8lld %8.2f %8.2f ", step->newton_iterations, (long long)step->queries,
         (long long)step->hits, (long long)step->solves, (double)step->seconds, (double)step->solve_seconds);
  for (PetscInt k = 0; k < step->residual_count; k++) printf(" %.0e", (double)step->residuals[k]);
  putchar('\n');
  fflush(stdout);
}

PetscErrorCode LamFE2ReportStep(const LamFE2Run *run, const LamMacroStep *step, PetscReal peak_memory)
{
  PetscFunctionBeginUser;
  if (run->json)
    PetscCall(PrintStepJSON(run, step, peak_memory));
  else {
    if (run->totals.steps == run->resumed_steps) PrintHeader(run, step);
    PrintRow(run, step);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2ReportTotals(const LamFE2Run *run)
{
  const LamFE2Totals *totals = &run->totals;

  PetscFunctionBeginUser;
  printf("%" PetscInt_FMT " steps, %" PetscInt_FMT " Newton iterations, %lld queries, %lld hits, %lld solves, "
         "%lld failures, %.3g s; response %s\n",
         totals->steps, totals->newton_iterations, (long long)totals->queries, (long long)totals->hits,
         (long long)totals->solves, (long long)totals->failures, LamClock() - run->start,
         LamFE2ResponseNames[run->response]);
  PetscFunctionReturn(0);
}
