/*
  lamella verify: queries a database at random states and solves the states for which it has a response. The report:
  quantiles of errors, measured and estimated, and a verdict.
*/
#include "app.h"
#include "audit.h"
#include "clock.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/* An audit passes if at most this fraction of the responses exceeds the accuracy, and none exceeds FAR times it. */
#define SHARE_BEYOND 0.005
#define FAR 3

/* An estimate holds if the error is at most HOLD_FACTOR times as large, or below a share of the accuracy. */
#define HOLD_FACTOR 3
#define NEGLIGIBLE 0.1

static const PetscReal Shares[] = {0.5, 0.9, 0.95, 0.99, 1};
static const char *const ShareNames[] = {"median", "q90", "q95", "q99", "max"};
enum { SHARE_COUNT = PETSC_STATIC_ARRAY_LENGTH(Shares) };

/* A reported quantity: a member of LamAudited. */
typedef struct {
  const char *group, *name; /* in JSON */
  const char *words;
  size_t offset;
  PetscReal scale; /* for human-readable output: 100, percent */
} Figure;

static const Figure Figures[] = {
    {"measured", "P", "error of P, %", offsetof(LamAudited, error), 100},
    {"measured", "P33", "error of P33, %", offsetof(LamAudited, axial), 100},
    {"estimated", "P", "estimated, %", offsetof(LamAudited, estimate), 100},
    {"measured", "tangent", "error of the tangent, %", offsetof(LamAudited, tangent), 100},
    {"estimated", "tangent", "estimated, %", offsetof(LamAudited, tangent_estimate), 100},
    {"measured", "opening_fraction", "error of the opening, of V0", offsetof(LamAudited, opening), 1},
    {"measured", "lumen_fraction", "error of the lumens, of V0", offsetof(LamAudited, lumen), 1},
};
enum { FIGURE_COUNT = PETSC_STATIC_ARRAY_LENGTH(Figures) };

typedef struct {
  PetscReal quantiles[FIGURE_COUNT][SHARE_COUNT]; /* NaN: not known */
  PetscInt compared, beyond, far;
  PetscInt held, tangent_held; /* estimates that hold */
  PetscInt worst;              /* response with the largest error; -1: none */
  PetscReal query_seconds;     /* median */
  PetscBool holds;
} Summary;

/* ---- figures ---- */

/* Of the member at `offset`, over all responses in which it is known. */
static PetscErrorCode FindQuantiles(const LamAudit *a, size_t offset, PetscInt count, PetscReal quantiles[])
{
  PetscReal *values;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->answered, &values));
  for (PetscInt i = 0; i < a->answered; i++) {
    const PetscReal value = *(const PetscReal *)(const void *)((const char *)&a->results[i] + offset);

    if (a->results[i].compared && isfinite(value)) values[n++] = value;
  }
  PetscCall(PetscSortReal(n, values));
  for (PetscInt q = 0; q < count; q++)
    quantiles[q] = n ? values[PetscMin(n - 1, (PetscInt)(Shares[q] * (PetscReal)n))] : NAN;
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

static PetscBool Holds(const LamAudit *a, PetscReal estimate, PetscReal error)
{
  const PetscReal accuracy = isfinite(a->accuracy) ? a->accuracy : a->from->accuracy;

  return (PetscBool)(error <= HOLD_FACTOR * estimate || error <= NEGLIGIBLE * accuracy);
}

static PetscErrorCode Summarise(const LamAudit *a, Summary *s)
{
  PetscFunctionBeginUser;
  *s = (Summary){.worst = -1};
  for (int f = 0; f < FIGURE_COUNT; f++) PetscCall(FindQuantiles(a, Figures[f].offset, SHARE_COUNT, s->quantiles[f]));
  PetscCall(FindQuantiles(a, offsetof(LamAudited, query_seconds), 1, &s->query_seconds)); /* the median */
  for (PetscInt i = 0; i < a->answered; i++) {
    const LamAudited *result = &a->results[i];

    if (!result->compared) continue;
    s->compared++;
    s->beyond += !(result->error <= a->accuracy);
    s->far += !(result->error <= FAR * a->accuracy);
    if (s->worst < 0 || result->error > a->results[s->worst].error) s->worst = i;
    s->held += Holds(a, result->estimate, result->error);
    s->tangent_held += Holds(a, result->tangent_estimate, result->tangent);
  }
  s->holds = (PetscBool)(s->compared && (PetscReal)s->beyond <= SHARE_BEYOND * (PetscReal)s->compared && !s->far);
  PetscFunctionReturn(0);
}

static PetscReal Share(PetscInt part, PetscInt whole)
{
  return whole ? (PetscReal)part / (PetscReal)whole : NAN;
}

/* The error of P33 is measured where F33 varies. */
static PetscBool IsKnown(const Summary *s, int f)
{
  return (PetscBool)(Figures[f].offset != offsetof(LamAudited, axial) || isfinite(s->quantiles[f][0]));
}

/* ---- JSON output ---- */

static PetscBool HasF33(const LamAudit *a)
{
  return (PetscBool)(a->box.F33[1] > a->box.F33[0]);
}

static json_t *BoxToJSON(const LamAudit *a)
{
  const PetscReal MPa = 1e-6 * a->from->scales.stress;
  json_t *box = json_pack("{s:o, s:o, s:f, s:s}", "principal_log_strain", LamJSONReals(2, a->box.strain, 1), "turgor",
                          LamJSONReals(2, a->box.turgor, MPa), "cohesion", (double)(a->box.cohesion * MPa), "origin",
                          a->box.origin);

  if (HasF33(a)) json_object_set_new(box, "F33", LamJSONReals(2, a->box.F33, 1));
  return box;
}

static json_t *WorstToJSON(const LamAudit *a, PetscInt worst)
{
  const PetscReal MPa = 1e-6 * a->from->scales.stress;
  const LamLoad *load = &a->loads[worst];

  return json_pack("{s:o, s:f, s:f, s:o, s:o}", "F", LamJSONReals(9, load->F, 1), "turgor",
                   (double)(load->turgor * MPa), "cohesion", (double)(load->cohesion * MPa), "error",
                   LamJSONReal(a->results[worst].error), "error_estimate", LamJSONReal(a->results[worst].estimate));
}

/* The quantiles of the figures of a group. */
static json_t *GroupToJSON(const Summary *s, const char group[])
{
  json_t *o = json_object();

  for (int f = 0; f < FIGURE_COUNT; f++) {
    json_t *quantiles;

    if (strcmp(Figures[f].group, group) || !IsKnown(s, f)) continue;
    quantiles = json_object();
    for (int q = 0; q < SHARE_COUNT; q++)
      json_object_set_new(quantiles, ShareNames[q], LamJSONReal(s->quantiles[f][q]));
    json_object_set_new(o, Figures[f].name, quantiles);
  }
  return o;
}

static PetscErrorCode PrintObject(const LamVerification *v, const Summary *s, PetscReal seconds)
{
  const LamAudit *a = &v->audit;

  PetscFunctionBeginUser;
  PetscCall(LamPrintJSON(json_pack(
      "{s:s, s:o, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:O, s:O, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b}",
      "database", v->path, "accuracy", LamJSONReal(a->accuracy), "seed", (json_int_t)a->seed, "asked",
      (json_int_t)a->asked, "answered", (json_int_t)a->answered, "solved", (json_int_t)a->solved, "compared",
      (json_int_t)s->compared, "share_answered", LamJSONReal(Share(a->answered, a->asked)), "box", BoxToJSON(a),
      "refused", a->refused, "unsolved", a->unsolved, "measured", GroupToJSON(s, "measured"), "estimated",
      GroupToJSON(s, "estimated"), "share_beyond_accuracy", LamJSONReal(Share(s->beyond, s->compared)),
      "share_beyond_3_accuracy", LamJSONReal(Share(s->far, s->compared)), "share_estimate_holds",
      LamJSONReal(Share(s->held, s->compared)), "share_tangent_estimate_holds",
      LamJSONReal(Share(s->tangent_held, s->compared)), "worst", s->worst < 0 ? json_null() : WorstToJSON(a, s->worst),
      "query_seconds", LamJSONReal(s->query_seconds), "seconds", LamJSONReal(seconds), "holds", s->holds)));
  PetscFunctionReturn(0);
}

/* ---- human-readable output ---- */

static void PrintCounts(const json_t *counts)
{
  const char *key;
  json_t *count;

  json_object_foreach((json_t *)counts, key, count)
  {
    printf("  %8lld  %s\n", (long long)json_integer_value(count), key);
  }
}

static void PrintAccuracy(const LamAudit *a)
{
  if (isfinite(a->accuracy))
    printf("%-16s %.3g %%\n", "accuracy", (double)(100 * a->accuracy));
  else
    printf("%-16s any\n", "accuracy");
}

static void PrintQuestions(const LamAudit *a, PetscReal seconds, PetscMPIInt ranks)
{
  const PetscReal MPa = 1e-6 * a->from->scales.stress, *turgor = a->box.turgor;

  printf("%-16s principal logarithmic strains %.4g to %.4g, turgor %.4g to %.4g MPa", "states",
         (double)a->box.strain[0], (double)a->box.strain[1], (double)(turgor[0] * MPa), (double)(turgor[1] * MPa));
  if (HasF33(a)) printf(", F33 %.4g to %.4g", (double)a->box.F33[0], (double)a->box.F33[1]);
  if (LamCellsPart(a->from->micro.interface)) printf(", cohesion %.4g MPa", (double)(a->box.cohesion * MPa));
  printf("; %s\n", a->box.origin);
  printf("%-16s %" PetscInt_FMT ", seed %" PetscInt_FMT "\n", "asked", a->asked, a->seed);
  printf("%-16s %" PetscInt_FMT " (%.1f %%)\n", "answered", a->answered,
         a->asked ? (double)(100 * Share(a->answered, a->asked)) : 0);
  printf("%-16s %" PetscInt_FMT "\n", "refused", a->asked - a->answered);
  PrintCounts(a->refused);
  printf("%-16s %" PetscInt_FMT ", in %.3g s on %d rank%s\n", "solved afresh", a->solved, seconds, (int)ranks,
         ranks > 1 ? "s" : "");
  if (json_object_size(a->unsolved)) printf("without solution\n");
  PrintCounts(a->unsolved);
}

static void PrintFigures(const Summary *s)
{
  printf("\n%-30s %9s %9s %9s %9s %9s\n", "", "median", "90 %", "95 %", "99 %", "largest");
  for (int f = 0; f < FIGURE_COUNT; f++) {
    if (!IsKnown(s, f)) continue;
    printf("%-30s", Figures[f].words);
    for (int q = 0; q < SHARE_COUNT; q++) printf(" %9.3g", (double)(Figures[f].scale * s->quantiles[f][q]));
    putchar('\n');
  }
}

static void PrintEstimates(const Summary *s)
{
  printf(
      "%-16s hold for %.1f %% of the errors of P, %.1f %% of those of the tangent: at most %d times the estimate, or "
      "%g of the accuracy\n",
      "estimates", (double)(100 * Share(s->held, s->compared)), (double)(100 * Share(s->tangent_held, s->compared)),
      HOLD_FACTOR, NEGLIGIBLE);
}

static void PrintWorst(const LamAudit *a, PetscInt worst)
{
  const LamLoad *load = &a->loads[worst];
  const PetscReal MPa = 1e-6 * a->from->scales.stress, *F = load->F;

  printf("%-16s at F = %.6f %.6f %.6f %.6f, ", "largest error", (double)F[0], (double)F[1], (double)F[3], (double)F[4]);
  if (F[8] != 1) printf("F33 %.6f, ", (double)F[8]);
  printf("turgor %.6g MPa: %.3g %%, estimated %.3g %%\n", (double)(load->turgor * MPa),
         (double)(100 * a->results[worst].error), (double)(100 * a->results[worst].estimate));
}

static void PrintTable(const LamVerification *v, const Summary *s, PetscReal seconds)
{
  const LamAudit *a = &v->audit;

  printf("%-16s %s\n", "database", v->path);
  PrintAccuracy(a);
  PrintQuestions(a, seconds, v->ranks);
  if (!s->compared) {
    printf("%-16s nothing could be compared\n", "verdict");
    return;
  }
  PrintFigures(s);
  putchar('\n');
  PrintEstimates(s);
  PrintWorst(a, s->worst);
  printf("%-16s %s: %" PetscInt_FMT " of %" PetscInt_FMT
         " responses beyond the accuracy (%.2g %% may be), %" PetscInt_FMT " beyond %d times\n",
         "verdict", s->holds ? "holds" : "does not hold", s->beyond, s->compared, 100 * SHARE_BEYOND, s->far, FAR);
}

static PetscErrorCode PrintReport(const LamVerification *v, PetscBool json)
{
  const PetscReal seconds = LamClock() - v->start;
  Summary s;

  PetscFunctionBeginUser;
  PetscCall(Summarise(&v->audit, &s));
  if (json)
    PetscCall(PrintObject(v, &s, seconds));
  else
    PrintTable(v, &s, seconds);
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

PetscErrorCode LamCommandVerify(LamArgs *args, int *exit_status)
{
  LamVerification v = {.samples = 200, .seed = 1};
  LamConsole console = {.command = "verify"};
  PetscBool done;
  const LamOption options[] = {
      {0, "samples", LAM_OPTION_FROM_1, "N", "responses that are solved afresh; default 200", &v.samples},
      {0, "seed", LAM_OPTION_FROM_0, "S", "another one draws other states; default 1", &v.seed},
      {0, "accuracy", LAM_OPTION_ACCURACY, "ERROR",
       "relative error of P that is asked for, 0.01; inf: any; by default the scene's", &v.accuracy},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "verify DB.h5 [--samples N] [--seed S] [--accuracy ERROR] [--json] [--quiet]",
                            "Queries a database at random, solves the same states, and compares.", options, 1, &v.path,
                            &done, exit_status));
  if (done) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  v.reporter = LamConsoleReporter(&console);
  PetscCall(LamVerificationRun(&v));
  LamConsoleClear();
  if (!v.rank) PetscCall(PrintReport(&v, console.json));
  /* unsolved: a response has no solution to compare with, or there was no response */
  PetscCall(
      LamShareOutcome((PetscBool)(!v.rank && (json_object_size(v.audit.unsolved) || !v.audit.answered)), exit_status));
  PetscCall(LamVerificationDestroy(&v));
  PetscFunctionReturn(0);
}
