/*
  FE2 against a direct patch of n x n cells between grips (fe2_patch.h): curves of stress and opening as n
  grows, and of FE2 as its mesh gets finer; prints figures, asserts nothing.

    bench_fe2_patch [--full] [--table TABLE]
      --full   also blocks of 16 x 16 cells, and finer meshes of FE2 (6 minutes of processor time);
               without it one minute
      --table  writes the curves, which fe2_patch_figure.py draws
*/
#include "options.h"
#include "support/fe2_patch.h"

#define STEPS SCALES_STEPS_MAX
#define BLOCKS 4
#define MESHES 3 /* finer ones have points that fail at the corners of sheared boxes, where F is singular */
static const int blocks[BLOCKS] = {2, 4, 8, 16};
static const int meshes[MESHES] = {2, 4, 8};

/* All curves of one case; what was not solved has no steps. */
typedef struct {
  const ScalesCase *scales_case;
  int block_count, mesh_count;
  ScalesCurve block[BLOCKS], body[MESHES];
  ScalesCurve limit; /* FE2 that the differences are from */
} Study;

static void PrintCurve(const char name[], const ScalesCurve *curve, const ScalesCurve *limit)
{
  const int last = curve->steps - 1;

  if (last < STEPS - 1) {
    printf("  %-34s ended after step %d of %d; %.1f s\n", name, curve->steps, STEPS, curve->seconds);
    return;
  }
  printf("  %-34s %11.4e %10.3e %9.4f", name, curve->stress[last], curve->opening[last], curve->debonded[last]);
  if (limit->steps == STEPS) printf(" %9.4f", ScalesDifference(STEPS, curve->stress, limit->stress));
  if (limit->steps == STEPS && limit->opening[STEPS - 1] > 1e-9)
    printf(" %9.4f", ScalesDifference(STEPS, curve->opening, limit->opening));
  else
    printf(" %9s", "");
  printf(" %9.1f\n", curve->seconds);
  fflush(stdout);
}

/* What the blocks tend to. */
static PetscErrorCode SolveLimit(PetscBool full, Study *study)
{
  const ScalesCase *c = study->scales_case;

  PetscFunctionBeginUser;
  if (c->sides == LAM_SIDES_AFFINE) {
    PetscCall(ScalesSolveLimit(c, 0, STEPS, &study->limit));
    PetscFunctionReturn(0);
  }
  study->mesh_count = full ? MESHES : MESHES - 1;
  for (int k = 0; k < study->mesh_count; k++) PetscCall(ScalesSolveBody(c, meshes[k], STEPS, &study->body[k]));
  study->limit = ScalesBodyLimit(&study->body[study->mesh_count - 2], &study->body[study->mesh_count - 1]);
  if (study->body[study->mesh_count - 2].steps < STEPS) study->limit.steps = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintLimit(const Study *study)
{
  const ScalesCase *c = study->scales_case;
  ScalesCurve cell;
  char name[64];

  PetscFunctionBeginUser;
  if (c->sides == LAM_SIDES_AFFINE) {
    PetscCall(ScalesSolveCells(c, 1, PETSC_FALSE, STEPS, &cell));
    PrintCurve("FE2 (one point), period 2 x 2", &study->limit, &study->limit);
    PrintCurve("FE2 (one point), one cell", &cell, &study->limit);
  }
  for (int k = 0; k < study->mesh_count; k++) {
    snprintf(name, sizeof(name), "FE2, %d x %d elements", meshes[k], meshes[k]);
    PrintCurve(name, &study->body[k], &study->limit);
  }
  if (study->mesh_count) PrintCurve("FE2, extrapolated to fine meshes", &study->limit, &study->limit);
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveAndPrint(PetscBool full, Study *study)
{
  const ScalesCase *c = study->scales_case;
  char name[64];

  PetscFunctionBeginUser;
  printf("\n%s: F%s to %g, turgor %g, cohesion %g MPa\n  %-34s %11s %10s %9s %9s %9s %9s\n", c->name,
         c->shear != 0 ? "12" : "22", c->shear != 0 ? c->shear : 1 + c->stretch, c->turgor, c->cohesion, "",
         c->shear != 0 ? "P12 (MPa)" : "P22 (MPa)", "opening", "debonded", "of stress", "of open.", "seconds");
  PetscCall(SolveLimit(full, study));
  PetscCall(PrintLimit(study));
  for (int k = 0; k < (full ? BLOCKS : BLOCKS - 1) && blocks[k] <= c->largest; k++) {
    study->block_count = k + 1;
    PetscCall(ScalesSolveCells(c, blocks[k], PETSC_TRUE, STEPS, &study->block[k]));
    snprintf(name, sizeof(name), "%d x %d cells", blocks[k], blocks[k]);
    PrintCurve(name, &study->block[k], &study->limit);
    if (k > 0 && study->block[k - 1].steps == STEPS && study->block[k].steps == STEPS) {
      ScalesCurve extrapolated = ScalesExtrapolated(&study->block[k - 1], &study->block[k]);

      snprintf(name, sizeof(name), "  extrapolated in 1/n from %d and %d", blocks[k - 1], blocks[k]);
      PrintCurve(name, &extrapolated, &study->limit);
    }
  }
  PetscFunctionReturn(0);
}

/* ---- the curves as a table ---- */

static void WriteCurve(FILE *out, const ScalesCase *c, const char name[], const ScalesCurve *curve)
{
  for (int s = 0; s < curve->steps; s++) {
    const double share = (s + 1.0) / STEPS, load = c->shear != 0 ? share * c->shear : 1 + share * c->stretch;

    fprintf(out, "%s\t%s\t%d\t%.9g\t%.9g\t%.9g\n", c->name, name, c->shear != 0 ? 12 : 22, load, curve->stress[s],
            curve->opening[s]);
  }
}

static PetscErrorCode WriteCurves(const char path[], const Study studies[])
{
  FILE *out = fopen(path, "w");
  char name[16];

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", path);
  fprintf(out, "case\tcurve\tcomponent\tload\tstress\topening\n");
  for (int i = 0; i < SCALES_CASES; i++) {
    for (int k = 0; k < studies[i].block_count; k++) {
      snprintf(name, sizeof(name), "%d", blocks[k]);
      WriteCurve(out, studies[i].scales_case, name, &studies[i].block[k]);
    }
    WriteCurve(out, studies[i].scales_case, "FE2", &studies[i].limit);
  }
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s", path);
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscBool full, const char table[])
{
  Study studies[SCALES_CASES] = {{0}};

  PetscFunctionBeginUser;
  printf(
      "stress, opening (gaps over the volume) and debonded share at the end of %d steps; differences: largest along\n"
      "the curve, over the largest value of FE2's, of stress and of opening\n",
      STEPS);
  for (int i = 0; i < SCALES_CASES; i++) {
    studies[i].scales_case = &scales_cases[i];
    PetscCall(SolveAndPrint(full, &studies[i]));
  }
  if (table) PetscCall(WriteCurves(table, studies));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char table[PETSC_MAX_PATH_LEN];
  PetscBool writes;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (PetscOptionsGetString(NULL, NULL, "--table", table, sizeof(table), &writes)) return 1;
  if (Run(HasOption("--full"), writes ? table : NULL)) return 1;
  return EndBench();
}
