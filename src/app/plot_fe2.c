/*
  Picture of an FE2 run: the deformed body at one load step with a field, and the reactions of its sides.
*/
#include "plot.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef enum { MEASURE_COMPONENT, MEASURE_VON_MISES, MEASURE_MEAN, MEASURE_DETERMINANT } Measure;
typedef struct {
  const char *name, *label, *unit, *dataset;
  PetscInt columns; /* of the dataset */
  Measure measure;
  PetscInt component;
} FE2FieldRow;
static const FE2FieldRow FE2Fields[] = {
    {"von_mises", "von Mises Cauchy stress", "MPa", "cauchy", 9, MEASURE_VON_MISES, 0},
    {"mean_stress", "mean Cauchy stress", "MPa", "cauchy", 9, MEASURE_MEAN, 0},
    {"cauchy_11", "Cauchy stress $σ$_{11}", "MPa", "cauchy", 9, MEASURE_COMPONENT, 0},
    {"cauchy_12", "Cauchy stress $σ$_{12}", "MPa", "cauchy", 9, MEASURE_COMPONENT, 1},
    {"cauchy_22", "Cauchy stress $σ$_{22}", "MPa", "cauchy", 9, MEASURE_COMPONENT, 4},
    {"P_11", "nominal stress $P$_{11}", "MPa", "P", 9, MEASURE_COMPONENT, 0},
    {"P_12", "nominal stress $P$_{12}", "MPa", "P", 9, MEASURE_COMPONENT, 1},
    {"P_21", "nominal stress $P$_{21}", "MPa", "P", 9, MEASURE_COMPONENT, 3},
    {"P_22", "nominal stress $P$_{22}", "MPa", "P", 9, MEASURE_COMPONENT, 4},
    {"J", "volume ratio $J$", NULL, "F", 9, MEASURE_DETERMINANT, 0},
    {"lumen_fraction", "lumen fraction", NULL, "indicator", 4, MEASURE_COMPONENT, 0},
    {"opening_fraction", "opening fraction", NULL, "indicator", 4, MEASURE_COMPONENT, 1},
    {"debonded_fraction", "debonded fraction", NULL, "indicator", 4, MEASURE_COMPONENT, 2},
    {"turgor", "turgor $p$", "MPa", "indicator", 4, MEASURE_COMPONENT, 3},
};

static const LamColour Ink = {0.12, 0.12, 0.16}, Reference = {0.80, 0.15, 0.05};

typedef struct {
  const FE2FieldRow *field;
  PetscInt step_count, *steps; /* numbers of the complete steps; owned */
  PetscInt row, step;          /* the one drawn: its place in `steps`, its number */
  PetscInt node_count, element_count;
  PetscReal *nodes, *x; /* [node][2], mm: reference and current; owned */
  PetscReal *values;    /* [element]; owned */
  PetscInt *elements;   /* owned */
  PetscReal *load;      /* [step]; owned */
  PetscReal *reaction;  /* [step][side][2], N/mm; owned */
  PetscInt side_count;
  char *sides; /* names, one per line; owned */
  LamOutline outline;
} FE2Picture;

static PetscErrorCode FindField(const LamPlotRequest *request, const FE2FieldRow **field)
{
  char names[512] = "";

  PetscFunctionBeginUser;
  *field = &FE2Fields[0];
  if (!request->field) PetscFunctionReturn(0);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(FE2Fields); i++) {
    if (!strcmp(request->field, FE2Fields[i].name)) {
      *field = &FE2Fields[i];
      PetscFunctionReturn(0);
    }
    PetscCall(PetscStrlcat(names, i ? ", " : "", sizeof names));
    PetscCall(PetscStrlcat(names, FE2Fields[i].name, sizeof names));
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "--field %s: an fe2 file has %s", request->field, names);
}

/* One number per element from the columns of its row. */
static PetscReal Evaluate(const FE2FieldRow *field, const PetscReal t[])
{
  switch (field->measure) {
  case MEASURE_VON_MISES: {
    const PetscReal mean = (t[0] + t[4] + t[8]) / 3;
    const PetscReal shear = t[1] * t[3] + t[2] * t[6] + t[5] * t[7]; /* symmetric up to rounding */

    return PetscSqrtReal(
        PetscMax(0, 1.5 * (PetscSqr(t[0] - mean) + PetscSqr(t[4] - mean) + PetscSqr(t[8] - mean) + 2 * shear)));
  }
  case MEASURE_MEAN:
    return (t[0] + t[4] + t[8]) / 3;
  case MEASURE_DETERMINANT:
    return t[0] * (t[4] * t[8] - t[5] * t[7]) - t[1] * (t[3] * t[8] - t[5] * t[6]) + t[2] * (t[3] * t[7] - t[4] * t[6]);
  default:
    return t[field->component];
  }
}

/* The last complete step, or the asked one. */
static PetscErrorCode FindStep(const LamPlotRequest *request, FE2Picture *p)
{
  const char *path = request->input;
  PetscBool found;
  PetscInt rank, dims[4];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, "/macro/steps", &found, &rank, dims, &p->steps));
  PetscCheck(found && rank == 1 && dims[0] > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no complete load step to draw", path);
  p->step_count = dims[0];
  p->row = dims[0] - 1;
  while (request->state >= 0 && p->row >= 0 && p->steps[p->row] != request->state) p->row--;
  PetscCheck(p->row >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--state %" PetscInt_FMT ": %s holds steps %" PetscInt_FMT " to %" PetscInt_FMT, request->state, path,
             p->steps[0], p->steps[p->step_count - 1]);
  p->step = p->steps[p->row];
  PetscFunctionReturn(0);
}

/* A quantity per step; a run that was stopped may have written a row more than complete steps. */
static PetscErrorCode ReadCurve(const char path[], const char name[], PetscInt steps, PetscInt columns,
                                PetscReal **values)
{
  PetscBool found;
  PetscInt rank, dims[4], size = 1;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, values));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no %s to draw", path, name);
  for (PetscInt i = 1; i < rank; i++) size *= dims[i];
  PetscCheck(rank > 0 && dims[0] >= steps && size == columns, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is damaged: it does not hold %" PetscInt_FMT " numbers for each of %" PetscInt_FMT " steps", path,
             name, columns, steps);
  PetscFunctionReturn(0);
}

static PetscErrorCode LoadCurves(const char path[], FE2Picture *p)
{
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(path, "/macro/boundaries", &found, &p->sides));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no /macro/boundaries to draw", path);
  for (const char *c = p->sides; *c; c++) p->side_count += *c != '\n' && (c[1] == '\n' || !c[1]);
  PetscCall(ReadCurve(path, "/macro/curve/load_factor", p->step_count, 1, &p->load));
  PetscCall(ReadCurve(path, "/macro/curve/reaction", p->step_count, 2 * p->side_count, &p->reaction));
  PetscFunctionReturn(0);
}

static PetscErrorCode LoadFE2(const LamPlotRequest *request, FE2Picture *p)
{
  const char *path = request->input;
  PetscReal *u, *rows;
  PetscInt count;
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(p, sizeof *p));
  PetscCall(FindField(request, &p->field));
  PetscCall(FindStep(request, p));
  PetscCall(LamPlotReadPoints(path, "/macro/nodes", -1, &p->node_count, &p->nodes));
  PetscCall(LamPlotReadElements(path, "/macro/elements", p->node_count, &p->element_count, &p->elements));
  PetscCall(PetscSNPrintf(name, sizeof name, "/macro/step/%" PetscInt_FMT "/u", p->step));
  PetscCall(LamPlotReadPoints(path, name, p->node_count, &count, &u));
  PetscCall(PetscMalloc1(2 * count, &p->x));
  for (PetscInt i = 0; i < 2 * count; i++) p->x[i] = p->nodes[i] + u[i];
  PetscCall(PetscFree(u));
  PetscCall(PetscSNPrintf(name, sizeof name, "/macro/step/%" PetscInt_FMT "/%s", p->step, p->field->dataset));
  PetscCall(LamPlotReadReals(path, name, p->element_count, p->field->columns, &rows));
  PetscCall(PetscMalloc1(p->element_count, &p->values));
  for (PetscInt e = 0; e < p->element_count; e++) p->values[e] = Evaluate(p->field, &rows[e * p->field->columns]);
  PetscCall(PetscFree(rows));
  PetscCall(LoadCurves(path, p));
  PetscCall(LamOutlineCreate(p->element_count, p->elements, NULL, &p->outline));
  PetscFunctionReturn(0);
}

static PetscErrorCode UnloadFE2(FE2Picture *p)
{
  PetscFunctionBeginUser;
  PetscCall(LamOutlineDestroy(&p->outline));
  PetscCall(PetscFree(p->steps));
  PetscCall(PetscFree(p->nodes));
  PetscCall(PetscFree(p->x));
  PetscCall(PetscFree(p->values));
  PetscCall(PetscFree(p->elements));
  PetscCall(PetscFree(p->load));
  PetscCall(PetscFree(p->reaction));
  PetscCall(PetscFree(p->sides));
  PetscFunctionReturn(0);
}

static void StrokeReference(LamCanvas canvas)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double dash[] = {3.5, 2.0};

  LamCanvasSetColour(canvas, Reference);
  cairo_set_dash(cr, dash, 2, 0);
  cairo_set_line_width(cr, 0.9);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
}

static PetscErrorCode DrawBody(LamCanvas canvas, const LamView *view, const FE2Picture *p, const LamColourRange *range)
{
  const PetscReal none[2] = {0, 0};
  const LamImage image = {{0, 0}, 0};
  const LamField field = {p->element_count, p->x, p->elements, p->values, PETSC_TRUE};
  const double per_element = sqrt(view->frame.width * view->frame.height / p->element_count); /* points */
  cairo_t *cr = LamCanvasCairo(canvas);

  PetscFunctionBeginUser;
  PetscCall(LamFieldPaint(canvas, view, &field, range, 1, &image));
  LamCanvasSetColour(canvas, Ink);
  if (per_element > 4) { /* lines of a finer mesh would hide the field */
    LamOutlineInnerPath(canvas, view, &p->outline, p->x);
    cairo_set_line_width(cr, 0.3);
    cairo_stroke(cr);
  }
  for (PetscInt k = 0; k < p->outline.loop_count; k++) LamOutlineLoopPath(canvas, view, &p->outline, k, p->x, none);
  cairo_set_line_width(cr, 0.9);
  cairo_stroke(cr);
  for (PetscInt k = 0; k < p->outline.loop_count; k++) LamOutlineLoopPath(canvas, view, &p->outline, k, p->nodes, none);
  StrokeReference(canvas);
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawPanel(LamCanvas canvas, LamRect outer, const FE2Picture *p)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const PetscReal none[2] = {0, 0};
  const char *reference = "undeformed";
  double y, width;
  PetscReal box[4];
  LamColourRange range;
  LamView view;

  PetscFunctionBeginUser;
  PetscCall(LamColourRangeFind(p->element_count, p->values, &range));
  outer.width -= LamColourBarWidth(canvas, &range);
  LamBoxEmpty(box);
  LamBoxExtend(box, p->node_count, p->x, none);
  LamBoxExtend(box, p->node_count, p->nodes, none);
  LamViewFit(outer, box, &view);
  PetscCall(DrawBody(canvas, &view, p, &range));
  LamColourBar(canvas, outer, &range, LamColourMap, p->field->label, p->field->unit);
  y = outer.y + outer.height + 11;
  LamScaleBar(canvas, &view, outer.x, y, 0.18 * outer.width, 1, "mm");
  width = LamCanvasTextWidth(canvas, LAM_TICK_SIZE, reference);
  cairo_move_to(cr, outer.x + outer.width - width - 23, y);
  cairo_rel_line_to(cr, 19, 0);
  StrokeReference(canvas);
  LamCanvasSetColour(canvas, Ink);
  LamCanvasText(canvas, outer.x + outer.width, y, 1, 0, LAM_TICK_SIZE, reference);
  PetscFunctionReturn(0);
}

/* Name of side `side`, from the list of names. */
static void SideName(const FE2Picture *p, PetscInt side, size_t size, char name[])
{
  const char *start = p->sides;
  size_t length;

  for (PetscInt i = 0;; i++) {
    while (*start == '\n') start++;
    length = strcspn(start, "\n");
    if (i == side) break;
    start += length;
  }
  snprintf(name, size, "%.*s", (int)PetscMin(length, size - 1), start);
}

/* One colour per side; filled circles and full lines for component 1, hollow squares and dashes for component 2. */
static PetscErrorCode ReactionSeries(const FE2Picture *p, PetscInt *count, LamSeries series[])
{
  PetscReal largest = 0;
  char name[32];

  PetscFunctionBeginUser;
  *count = 0;
  for (PetscInt i = 0; i < p->step_count * p->side_count * 2; i++)
    largest = PetscMax(largest, PetscAbsReal(p->reaction[i]));
  for (PetscInt side = 0; side < p->side_count; side++) {
    for (int c = 0; c < 2; c++) {
      LamSeries *s = &series[*count];
      PetscReal own = 0;

      PetscCall(LamSeriesCreate(p->step_count, s));
      for (PetscInt k = 0; k < p->step_count; k++) {
        s->x[k] = p->load[k];
        s->y[k] = p->reaction[(k * p->side_count + side) * 2 + c];
        own = PetscMax(own, PetscAbsReal(s->y[k]));
      }
      if (own <= 1e-6 * largest) { /* a roller's free component */
        PetscCall(LamSeriesDestroy(s));
        continue;
      }
      SideName(p, side, sizeof name, name);
      s->style = (LamStyle){LamColourOfLine(side), c ? LAM_MARKER_SQUARE : LAM_MARKER_CIRCLE, (PetscBool)c, PETSC_TRUE,
                            (PetscBool)c};
      snprintf(s->label, sizeof s->label, "%s $R$_{%d}", name, c + 1);
      (*count)++;
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawReactions(LamCanvas canvas, LamRect outer, const FE2Picture *p)
{
  LamSeries *series;
  LamAxes axes = {.x = {.label = "load factor"}, .y = {.label = "reaction per thickness $R$", .unit = "N/mm"}};
  PetscInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * p->side_count + 1, &series));
  PetscCall(ReactionSeries(p, &count, series));
  LamChart(canvas, outer, &axes, count, series);
  for (PetscInt i = 0; i < count; i++) PetscCall(LamSeriesDestroy(&series[i]));
  PetscCall(PetscFree(series));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotFE2(const LamPlotRequest *request)
{
  const LamRect left = {9, 25.2, 282, LAM_PLOT_HEIGHT - 51},
                right = {308, 21, LAM_PLOT_WIDTH - 316, LAM_PLOT_HEIGHT - 24};
  FE2Picture picture;
  LamCanvas canvas;
  char title[128], factor[32];

  PetscFunctionBeginUser;
  PetscCall(LoadFE2(request, &picture));
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_PLOT_HEIGHT, &canvas));
  LamFormatNumber(picture.load[picture.row], factor);
  PetscCall(PetscSNPrintf(title, sizeof title, "Step %" PetscInt_FMT "%s:  load factor %s,  element means",
                          picture.step, picture.step ? "" : " (inflated)", factor));
  LamCanvasSetColour(canvas, Ink);
  LamCanvasText(canvas, left.x, 12, 0, 0, LAM_TEXT_SIZE + 0.75, title);
  PetscCall(DrawPanel(canvas, left, &picture));
  PetscCall(DrawReactions(canvas, right, &picture));
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(UnloadFE2(&picture));
  PetscFunctionReturn(0);
}
