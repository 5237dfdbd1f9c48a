/*
  FE2 with a solve per question against FE2 through the cache, from nothing and again with what it left: solves, wall
  time, reactions. Prints figures, asserts nothing.

    bench_fe2_cache [SCENE]     default: tests/scenes/tissue-block.yaml, 576 material points; one minute
    bench_fe2_cache SCENE N     of N material points taken at random the questions are solved, too, each from the last
                                state of its point, and the time of all is told from theirs: for bodies that a solve
                                per question would take hours for
*/
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <petsctime.h>
#include <lamella/lamella.h>
#include "app.h"
#include "support/random_reals.h"
#include "support/tissue.h"

enum { MAX_STEPS = 64 };

typedef struct {
  PetscInt steps;
  PetscReal reaction[MAX_STEPS][LAM_MAX_BOUNDARIES][2];
  PetscInt boundary_count;
  PetscInt64 queries, hits, solves, failures;
  PetscInt iterations, cutbacks;
  PetscLogDouble seconds;
} Figures;

/* LamMacroMonitor */
static PetscErrorCode Note(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  Figures *f = (Figures *)ctx;

  PetscFunctionBeginUser;
  *stop = (PetscBool)(f->steps == MAX_STEPS - 1);
  memcpy(f->reaction[f->steps++], step->reaction, sizeof(step->reaction));
  f->boundary_count = step->boundary_count;
  f->queries += step->queries;
  f->hits += step->hits;
  f->solves += step->solves;
  f->failures += step->failures;
  f->iterations += step->newton_iterations;
  f->cutbacks += step->cutbacks;
  PetscFunctionReturn(0);
}

/* ---- a share of the questions, solved as well ---- */

typedef struct {
  LamResponder cache, direct;
  PetscInt count, *number; /* [points] of the sample, -1: not in it */
  PetscInt64 asked, all;
  PetscReal seconds, worst, square;
} Sample;

static PetscErrorCode SampleRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                    LamResponse responses[])
{
  Sample *s = (Sample *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderRespond(s->cache, n, loads, points, responses));
  s->all += n;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt number = points[i] < 0 ? -1 : s->number[points[i]];
    PetscLogDouble start, end;
    LamResponse exact;

    if (number < 0) continue;
    PetscCall(PetscTime(&start));
    PetscCall(LamResponderRespond(s->direct, 1, &loads[i], &number, &exact));
    PetscCall(PetscTime(&end));
    s->asked++;
    s->seconds += end - start;
    if (!LamResponseHasFields(&exact) || !LamResponseHasFields(&responses[i])) continue;
    s->worst = PetscMax(s->worst, StressError(responses[i].P, exact.P));
    s->square += PetscSqr(StressError(responses[i].P, exact.P));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SampleAccept(void *ctx)
{
  Sample *s = (Sample *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderAccept(s->cache));
  PetscCall(LamResponderAccept(s->direct));
  PetscFunctionReturn(0);
}

static PetscErrorCode SampleReject(void *ctx)
{
  Sample *s = (Sample *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderReject(s->cache));
  PetscCall(LamResponderReject(s->direct));
  PetscFunctionReturn(0);
}

static PetscErrorCode SampleCreate(LamRVE rve, LamResponder cache, PetscInt points, PetscInt count, Sample *s)
{
  uint64_t seed = 7;

  PetscFunctionBeginUser;
  *s = (Sample){.cache = cache, .count = PetscMin(count, points)};
  PetscCall(PetscMalloc1(points, &s->number));
  for (PetscInt p = 0; p < points; p++) s->number[p] = -1;
  for (PetscInt k = 0; k < s->count;) {
    const PetscInt p = (PetscInt)RandomReal(&seed, 0, (double)points);

    if (s->number[p] < 0) s->number[p] = k++;
  }
  PetscCall(LamRVEResponderCreate(rve, s->count, &s->direct));
  PetscFunctionReturn(0);
}

static void PrintSample(const Sample *s, PetscReal cache_seconds)
{
  const double each = (double)s->seconds / (double)s->asked;

  printf(
      "  %lld of %lld questions solved: %.4g s each, %.5g s for all, %.4g times the cache's; P %.2g in the mean (root "
      "of squares), %.2g at most\n",
      (long long)s->asked, (long long)s->all, each, each * (double)s->all,
      each * (double)s->all / (double)cache_seconds, (double)PetscSqrtReal(s->square / (PetscReal)s->asked),
      (double)s->worst);
}

/* ---- runs ---- */

/* database NULL: a solve per question. sampled: of so many points the questions are solved as well. */
static PetscErrorCode Run(const LamScene *scene, LamDatabase database, PetscInt sampled, Figures *f)
{
  char message[LAM_MESSAGE_LENGTH];
  const LamResponderFunctions functions = {.respond = SampleRespond, .accept = SampleAccept, .reject = SampleReject};
  LamResponder solver, cache = NULL, both = NULL;
  Sample sample = {0};
  LamResponderCounters counters;
  LamMacroReason reason;
  LamMacro macro;
  PetscLogDouble start, end;
  PetscInt points;
  LamGrid grid;
  LamRVE rve;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(LamMacroCreate(PETSC_COMM_SELF, &macro));
  PetscCall(LamMacroSetScene(macro, scene));
  PetscCall(LamMacroSetUp(macro));
  PetscCall(LamMacroGetPointCount(macro, &points));
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &scene->micro));
  PetscCall(LamRVESetStrategy(rve, scene->strategy));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVEResponderCreate(rve, database ? 0 : points, &solver));
  if (database) {
    PetscCall(LamDatabaseGetGrid(database, &grid));
    if (!grid) {
      PetscCall(LamGridCreate(scene, solver, &grid));
      PetscCall(LamDatabaseSetGrid(database, &grid));
    }
    PetscCall(LamCacheResponderCreate(PETSC_COMM_SELF, database, solver, NULL, LAM_OUTSIDE_SOLVE, scene->accuracy,
                                      points, &cache));
  }
  if (sampled) {
    PetscCall(SampleCreate(rve, cache, points, sampled, &sample));
    PetscCall(LamResponderCreate(&functions, &sample, NULL, &both));
  }
  PetscCall(LamMacroSetResponder(macro, sampled ? both : database ? cache : solver));
  PetscCall(LamMacroSetMonitor(macro, Note, f));
  PetscCall(LamMacroSolve(macro, &reason, message));
  if (reason != LAM_MACRO_DONE) printf("not done: %s\n", message);
  PetscCall(LamMacroDestroy(&macro));
  if (sampled) {
    counters = LamResponderGetCounters(cache);
    PetscCall(LamResponderDestroy(&sample.direct));
    PetscCall(PetscFree(sample.number));
  }
  PetscCall(LamResponderDestroy(&both));
  PetscCall(LamResponderDestroy(&cache));
  PetscCall(LamResponderDestroy(&solver));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(PetscTime(&end));
  f->seconds = end - start - sample.seconds;
  if (sampled) {
    f->hits = counters.hits;
    f->solves = counters.solves;
    f->queries = counters.queries;
    PrintSample(&sample, f->seconds);
  }
  PetscFunctionReturn(0);
}

static PetscReal Norm(const Figures *f, PetscInt step, const Figures *less)
{
  PetscReal sum = 0;

  for (PetscInt b = 0; b < f->boundary_count; b++)
    for (int i = 0; i < 2; i++) sum += PetscSqr(f->reaction[step][b][i] - (less ? less->reaction[step][b][i] : 0));
  return PetscSqrtReal(sum);
}

static void PrintFigures(const char name[], const Figures *f, const Figures *direct)
{
  printf("%-14s %8.2f %8lld %8lld %8lld %6lld %5d %5d ", name, f->seconds, (long long)f->queries, (long long)f->hits,
         (long long)f->solves, (long long)f->failures, (int)f->iterations, (int)f->cutbacks);
  /* in a body that inflates freely there are none */
  for (PetscInt s = 0; direct && s < PetscMin(f->steps, direct->steps); s++)
    if (Norm(direct, s, NULL) > 1e-6) printf(" %.2f", 100 * (double)(Norm(f, s, direct) / Norm(direct, s, NULL)));
  printf("\n");
  fflush(stdout);
}

static PetscErrorCode Compare(const char path[], PetscInt sampled)
{
  Figures direct = {0}, cold = {0}, warm = {0};
  LamDatabase database;
  LamScene *scene;
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(path, &scene));
  PetscCall(LamPlanMake(scene, &plan));
  scene->micro = plan.micro;
  printf("%s, accuracy %g; the last columns: reactions against direct, %% of their norm, step by step\n", path,
         (double)scene->accuracy);
  printf("%-14s %8s %8s %8s %8s %6s %5s %5s\n", "response", "seconds", "queries", "hits", "solves", "fail", "iter.",
         "cuts");
  PetscCall(LamDatabaseCreateEmpty(scene, &database));
  if (!sampled) {
    PetscCall(Run(scene, NULL, 0, &direct));
    PrintFigures("direct", &direct, NULL);
  }
  PetscCall(Run(scene, database, sampled, &cold));
  PrintFigures("cache, cold", &cold, sampled ? NULL : &direct);
  PetscCall(Run(scene, database, sampled, &warm));
  PrintFigures("cache, warm", &warm, sampled ? &cold : &direct);
  PetscCall(LamDatabaseClose(&database));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const char *path = argc > 1 ? argv[1] : LAMELLA_SOURCE_DIR "/tests/scenes/tissue-block.yaml";

  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  if (Compare(path, argc > 2 ? atoi(argv[2]) : 0)) return 1;
  return PetscFinalize();
}
