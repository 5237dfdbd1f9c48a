/*
  FE2 with a solve per question against FE2 through the cache, from nothing and again with what it left: solves, wall
  time, reactions. Prints figures, asserts nothing.

    bench_fe2_cache [SCENE]     default: tests/scenes/tissue-block.yaml, 576 material points; one minute
*/
#include <stdio.h>
#include <string.h>
#include <petsctime.h>
#include <lamella/lamella.h>

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

/* database NULL: a solve per question. */
static PetscErrorCode Run(const LamScene *scene, LamDatabase database, Figures *f)
{
  char message[LAM_MESSAGE_LENGTH];
  LamResponder solver, cache = {0};
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
      PetscCall(LamGridCreate(scene, &solver, &grid));
      PetscCall(LamDatabaseSetGrid(database, &grid));
    }
    PetscCall(LamCacheResponderCreate(PETSC_COMM_SELF, database, &solver, NULL, LAM_OUTSIDE_SOLVE, scene->accuracy,
                                      points, &cache));
  }
  PetscCall(LamMacroSetResponder(macro, database ? &cache : &solver));
  PetscCall(LamMacroSetMonitor(macro, Note, f));
  PetscCall(LamMacroSolve(macro, &reason, message));
  if (reason != LAM_MACRO_DONE) printf("not done: %s\n", message);
  PetscCall(LamMacroDestroy(&macro));
  if (database) PetscCall(cache.destroy(&cache.ctx));
  PetscCall(solver.destroy(&solver.ctx));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(PetscTime(&end));
  f->seconds = end - start;
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

static PetscErrorCode Compare(const char path[])
{
  Figures direct = {0}, cold = {0}, warm = {0};
  LamDatabase database;
  LamScene *scene;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(path, &scene));
  if (!scene->micro.along) scene->micro.along = 6; /* as the planner chooses for 1 % */
  if (!scene->micro.through) scene->micro.through = 2;
  printf("%s, accuracy %g; the last columns: reactions against direct, %% of their norm, step by step\n", path,
         (double)scene->accuracy);
  printf("%-14s %8s %8s %8s %8s %6s %5s %5s\n", "response", "seconds", "queries", "hits", "solves", "fail", "iter.",
         "cuts");
  PetscCall(LamDatabaseCreateEmpty(scene, &database));
  PetscCall(Run(scene, NULL, &direct));
  PrintFigures("direct", &direct, NULL);
  PetscCall(Run(scene, database, &cold));
  PrintFigures("cache, cold", &cold, &direct);
  PetscCall(Run(scene, database, &warm));
  PrintFigures("cache, warm", &warm, &direct);
  PetscCall(LamDatabaseClose(&database));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const char *path = argc > 1 ? argv[1] : LAMELLA_SOURCE_DIR "/tests/scenes/tissue-block.yaml";

  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  if (Compare(path)) return 1;
  return PetscFinalize();
}
