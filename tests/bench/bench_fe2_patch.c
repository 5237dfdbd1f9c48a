/*
  FE2 against a direct patch of n x n cells between grips (fe2_patch.h): curves of stress and opening as n
  grows, and of FE2 as its mesh gets finer; prints figures, asserts nothing.

    bench_fe2_patch [--full] [--plot FIGURE]
      --full   also blocks of 16 x 16 cells, and finer meshes of FE2 (6 minutes of processor time); without it one
  minute
      --plot   draws the curves: .png, .svg or .pdf
*/
#include "options.h"
#include "support/fe2_patch.h"
#include "plot.h"

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

/* ---- the picture ---- */
static const double *ValuesOf(const ScalesCurve *curve, PetscBool opening)
{
  return opening ? curve->opening : curve->stress;
}

/* Curves of blocks over the load, and FE2 on top of them. */
static PetscErrorCode DrawCurves(LamCanvas canvas, LamRect outer, const Study *study, PetscBool opening)
{
  const ScalesCase *c = study->scales_case;
  const int n = study->block_count;
  LamAxes axes = {.x = {.label = c->shear != 0 ? "shear $F$_{12}" : "stretch $F$_{22}"},
                  .y = {.label = opening         ? "opening, share of volume"
                                 : c->shear != 0 ? "nominal stress $P$_{12}"
                                                 : "nominal stress $P$_{22}",
                        .unit = opening ? NULL : "MPa"}};
  LamSeries series[BLOCKS + 1];

  PetscFunctionBeginUser;
  for (int k = 0; k <= n; k++) {
    const ScalesCurve *curve = k < n ? &study->block[k] : &study->limit;

    PetscCall(LamSeriesCreate(curve->steps, &series[k]));
    for (int s = 0; s < curve->steps; s++) {
      series[k].x[s] = c->shear != 0 ? (s + 1.0) / STEPS * c->shear : 1 + (s + 1.0) / STEPS * c->stretch;
      series[k].y[s] = ValuesOf(curve, opening)[s];
    }
    series[k].style = k < n ? (LamStyle){LamColourOfLine(k), (LamMarker)k, PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}
                            : (LamStyle){{0, 0, 0}, LAM_MARKER_CIRCLE, PETSC_FALSE, PETSC_TRUE, PETSC_FALSE};
    if (k < n)
      snprintf(series[k].label, LAM_SERIES_LABEL, "%d \u00d7 %d", blocks[k], blocks[k]);
    else
      snprintf(series[k].label, LAM_SERIES_LABEL, "FE²");
  }
  LamChart(canvas, outer, &axes, n + 1, series);
  for (int k = 0; k <= n; k++) PetscCall(LamSeriesDestroy(&series[k]));
  PetscFunctionReturn(0);
}

/* Differences of the blocks from FE2, both axes logarithmic. */
static PetscErrorCode DrawDifferences(LamCanvas canvas, LamRect outer, const Study studies[], PetscBool opening)
{
  LamAxes axes = {.x = {.label = "log_{2} of cells in a row $n$", .whole = PETSC_TRUE},
                  .y = {.label = opening ? "log_{10} of difference of opening" : "log_{10} of difference of stress"}};
  LamSeries series[SCALES_CASES];
  PetscInt count = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < SCALES_CASES; i++) {
    const Study *study = &studies[i];
    LamSeries *s = &series[count];

    if (study->limit.steps < STEPS || (opening && study->scales_case->interface == LAM_INTERFACE_BONDED)) continue;
    PetscCall(LamSeriesCreate(study->block_count, s));
    for (int k = 0; k < study->block_count; k++) {
      s->x[k] = log2(blocks[k]);
      s->y[k] =
          study->block[k].steps < STEPS
              ? NAN
              : log10(ScalesDifference(STEPS, ValuesOf(&study->block[k], opening), ValuesOf(&study->limit, opening)));
    }
    s->style = (LamStyle){LamColourOfLine(i / 3), (LamMarker)(i % 3), (PetscBool)(i % 3 == 1), PETSC_TRUE,
                          (PetscBool)(i % 3 == 2)};
    snprintf(s->label, LAM_SERIES_LABEL, "%s", study->scales_case->name);
    count++;
  }
  LamChart(canvas, outer, &axes, count, series);
  for (PetscInt k = 0; k < count; k++) PetscCall(LamSeriesDestroy(&series[k]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Draw(const char path[], const Study studies[])
{
  const double width = 0.5 * LAM_PLOT_WIDTH, height = 190;
  const struct {
    int study;
    PetscBool opening;
  } curves[4] = {{SCALES_BONDED_FREE_SHEARED, PETSC_FALSE},
                 {SCALES_CONTACT_FREE_PULLED, PETSC_FALSE},
                 {SCALES_CONTACT_FREE_SHEARED, PETSC_TRUE},
                 {SCALES_CONTACT_AFFINE_PRESSED, PETSC_FALSE}};
  LamCanvas canvas;

  PetscFunctionBeginUser;
  PetscCall(LamCanvasCreate(path, LAM_PLOT_WIDTH, 3 * height + 60, &canvas));
  for (int k = 0; k < 4; k++) {
    const LamRect outer = {9 + k % 2 * width, 18 + k / 2 * (height + 10), width - 18, height - 18};

    LamCanvasSetColour(canvas, (LamColour){0, 0, 0});
    LamCanvasText(canvas, outer.x + 0.5 * outer.width, outer.y - 8, 0.5, 0, LAM_TEXT_SIZE,
                  scales_cases[curves[k].study].name);
    PetscCall(DrawCurves(canvas, outer, &studies[curves[k].study], curves[k].opening));
  }
  for (int k = 0; k < 2; k++) {
    const LamRect outer = {9 + k * width, 2 * height + 30, width - 18, height + 24};

    PetscCall(DrawDifferences(canvas, outer, studies, (PetscBool)k));
  }
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscBool full, const char figure[])
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
  if (figure) PetscCall(Draw(figure, studies));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char figure[PETSC_MAX_PATH_LEN];
  PetscBool plots;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (PetscOptionsGetString(NULL, NULL, "--plot", figure, sizeof(figure), &plots)) return 1;
  if ((plots && LamCanvasCheckPath(figure)) || Run(HasOption("--full"), plots ? figure : NULL)) return 1;
  return EndBench();
}
