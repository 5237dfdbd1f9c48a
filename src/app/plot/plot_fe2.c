/*
  Picture of an FE2 run: the deformed body at one load step with a field, and the reactions of its sides; for a process
  its time histories, and films.
*/
#include "plot_fe2.h"
#include "names.h"
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
/* A dataset of one number per element, by its name. */
#define SCALAR(name, label, unit)                                                                                      \
  {                                                                                                                    \
    name, label, unit, name, 1, MEASURE_COMPONENT, 0                                                                   \
  }
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
    {"lumen_fraction", "lumen fraction", NULL, "lumen_fraction", 1, MEASURE_COMPONENT, 0},
    {"opening_fraction", "opening fraction", NULL, "opening_fraction", 1, MEASURE_COMPONENT, 0},
    {"debonded_fraction", "debonded fraction", NULL, "debonded_fraction", 1, MEASURE_COMPONENT, 0},
    {"turgor", "turgor $p$", "MPa", "turgor", 1, MEASURE_COMPONENT, 0},
    SCALAR("open_fraction", "open fraction", NULL),
    SCALAR("max_gap", "largest gap, mean over points", "apothems"),
    SCALAR("max_gap_max", "largest gap", "apothems"),
    SCALAR("face_unloading_max", "unloading of faces, largest", NULL),
    SCALAR("wall_tension", "wall tension", "MPa"),
    SCALAR("wall_tension_max", "wall tension, largest", "MPa"),
    SCALAR("lamella_normal", "normal traction of the lamella", "MPa"),
    SCALAR("lamella_normal_max", "normal traction of the lamella, largest", "MPa"),
    SCALAR("lamella_shear", "shear traction of the lamella", "MPa"),
    SCALAR("lamella_shear_max", "shear traction of the lamella, largest", "MPa"),
    SCALAR("ellipticity_min", "ellipticity of the tangent, smallest", "MPa"),
    SCALAR("wall_tension_ratio_max", "wall tension over strength, largest", NULL),
    SCALAR("lamella_normal_ratio_max", "normal traction over strength, largest", NULL),
    SCALAR("lamella_shear_ratio_max", "shear traction over strength, largest", NULL),
    SCALAR("broken_fraction", "broken share of the lamella", NULL),
    SCALAR("broken_fraction_max", "broken share of the lamella, largest", NULL),
    SCALAR("broken_face_max", "broken share of a face family, largest", NULL),
    SCALAR("stored", "energy stored", "kJ/m^3"),
    SCALAR("dissipated", "energy dissipated", "kJ/m^3"),
    SCALAR("released", "energy released in jumps", "kJ/m^3"),
    SCALAR("error_estimate", "estimated error of the stress", NULL),
    SCALAR("interpolated", "share of interpolated responses", NULL),
};

const char *LamPlotFE2Field(size_t i)
{
  return i < PETSC_STATIC_ARRAY_LENGTH(FE2Fields) ? FE2Fields[i].name : NULL;
}

static const double ZoomHeight = 236, CurveHeight = 150; /* of a page with zooms */

typedef struct {
  const FE2FieldRow *field;
  PetscInt step_count, *steps; /* numbers of the complete steps; owned */
  PetscInt row, step;          /* the step drawn: its index in `steps`, its number */
  PetscInt peak;               /* row */
  PetscInt node_count, element_count;
  PetscReal *nodes, *x; /* [node][2], mm: reference and current; owned */
  PetscReal *values;    /* [element]; owned */
  PetscInt *elements;   /* owned */
  LamOutline outline;
  LamReactions reactions;
  LamObstacles obstacles;
  PetscInt *gripped;  /* owned */
  PetscBool has_grip; /* one is drawn */
  LamZooms zooms;     /* of the last step */
  LamTimeLine times;  /* of a process; else it has no states */
} FE2Picture;

static PetscErrorCode FindField(const LamPlotRequest *request, const FE2FieldRow **field)
{
  char names[1024] = "";

  PetscFunctionBeginUser;
  *field = &FE2Fields[0];
  if (!request->field) PetscFunctionReturn(0);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(FE2Fields); i++) {
    if (!strcmp(request->field, FE2Fields[i].name)) {
      *field = &FE2Fields[i];
      PetscFunctionReturn(0);
    }
    LamNamesAppend(sizeof(names), names, ", ", FE2Fields[i].name);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "--field %s: an fe2 file has %s", request->field, names);
}

/* Evaluates a field for one element from the columns of its row. */
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

static PetscErrorCode ReadSteps(const char path[], FE2Picture *p)
{
  PetscBool found;
  PetscInt rank, dims[4];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, "/macro/steps", &found, &rank, dims, &p->steps));
  PetscCheck(found && rank == 1 && dims[0] > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no complete load step to draw", path);
  p->step_count = dims[0];
  PetscCall(LamReactionsRead(path, p->step_count, &p->reactions));
  p->peak = LamReactionsPeak(&p->reactions);
  PetscFunctionReturn(0);
}

static PetscErrorCode FindStep(const LamPlotRequest *request, FE2Picture *p)
{
  PetscFunctionBeginUser;
  p->row = request->state == LAM_PLOT_PEAK ? p->peak : p->step_count - 1;
  while (request->state >= 0 && p->row >= 0 && p->steps[p->row] != request->state) p->row--;
  PetscCheck(p->row >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--state %" PetscInt_FMT ": %s holds steps %" PetscInt_FMT " to %" PetscInt_FMT, request->state,
             request->input, p->steps[0], p->steps[p->step_count - 1]);
  PetscFunctionReturn(0);
}

/* Reads deformation and field of the step in a row. */
static PetscErrorCode LoadStep(const char path[], PetscInt row, FE2Picture *p)
{
  PetscReal *u, *rows;
  PetscInt count;
  char name[96];

  PetscFunctionBeginUser;
  p->row = row;
  p->step = p->steps[row];
  PetscCall(PetscFree(p->x));
  PetscCall(PetscFree(p->values));
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
  PetscCall(LamObstaclesRead(path, p->step, &p->obstacles));
  PetscFunctionReturn(0);
}

static PetscErrorCode LoadFE2(const LamPlotRequest *request, FE2Picture *p)
{
  const char *path = request->input;
  PetscBool is_process;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(p, sizeof *p));
  PetscCall(FindField(request, &p->field));
  PetscCall(ReadSteps(path, p));
  PetscCall(FindStep(request, p));
  PetscCall(LamPlotReadPoints(path, "/macro/nodes", -1, &p->node_count, &p->nodes));
  PetscCall(LamPlotReadElements(path, "/macro/elements", p->node_count, &p->element_count, &p->elements));
  PetscCall(LoadStep(path, p->row, p));
  PetscCall(LamGripsRead(path, p->node_count, &p->gripped));
  PetscCall(LamPlotHas(path, "/process/time", &is_process));
  if (is_process) PetscCall(LamTimeLineRead(path, p->step_count, &p->times));
  if (p->row == p->step_count - 1) PetscCall(LamZoomsRead(path, &p->zooms));
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
  PetscCall(LamReactionsDestroy(&p->reactions));
  PetscCall(LamObstaclesDestroy(&p->obstacles));
  PetscCall(PetscFree(p->gripped));
  PetscCall(LamZoomsDestroy(&p->zooms));
  PetscCall(LamTimeLineDestroy(&p->times));
  PetscFunctionReturn(0);
}

/* Extends a box by the body, as it is and undeformed, and by obstacles. */
static void ExtendBox(const FE2Picture *p, PetscReal box[4])
{
  PetscReal size[4] = LAM_EMPTY_BOX;

  LamBoxExtend(size, p->node_count, p->nodes, NULL);
  LamBoxExtend(box, 2, size, NULL); /* its corners */
  LamBoxExtend(box, p->node_count, p->x, NULL);
  LamObstaclesExtend(&p->obstacles, PetscMax(size[2] - size[0], size[3] - size[1]), box);
}

static PetscErrorCode DrawBody(LamCanvas canvas, const LamView *view, FE2Picture *p, const LamColourRange *range)
{
  const LamImage image = {{0, 0}, 0};
  const LamField field = {p->element_count, p->x, p->elements, p->values, PETSC_TRUE};
  const double per_element = sqrt(view->frame.width * view->frame.height / p->element_count); /* points */

  PetscFunctionBeginUser;
  LamObstaclesDraw(canvas, view, &p->obstacles);
  if (p->row) p->has_grip = LamGripsDraw(canvas, view, &p->outline, p->x, p->gripped); /* inflated without them */
  PetscCall(LamFieldPaint(canvas, view, &field, range, 1, &image));
  /* grid lines of a finer mesh would hide the field */
  if (per_element > 4) LamOutlineInnerPath(canvas, view, &p->outline, p->x);
  LamCanvasStroke(canvas, LamDarkInk, 0.3, NULL);
  for (PetscInt k = 0; k < p->outline.loop_count; k++) LamOutlineLoopPath(canvas, view, &p->outline, k, p->x, NULL);
  LamCanvasStroke(canvas, LamDarkInk, 0.9, NULL);
  for (PetscInt k = 0; k < p->outline.loop_count; k++) LamOutlineLoopPath(canvas, view, &p->outline, k, p->nodes, NULL);
  LamStrokeUndeformed(canvas);
  PetscFunctionReturn(0);
}

/* Scale bar and legend, below the view. */
static void DrawKey(LamCanvas canvas, const LamView *view, const FE2Picture *p)
{
  const LamRect f = view->frame;
  const double y = f.y + f.height + 11;
  double x = f.x;

  x += LamScaleBar(canvas, view, x, y, LAM_SCALE_BAR, 1, "mm") + 10;
  x += LamObstaclesKey(canvas, x, y, &p->obstacles, p->has_grip);
  LamUndeformedKey(canvas, x, f.x + f.width, y, "undeformed");
}

/* Draws the body with its colour bar and legend inside `outer`; *view is its view. With zooms the bar is on the
   left, so that it does not cross the lines to them. */
static PetscErrorCode DrawPanel(LamCanvas canvas, LamRect outer, FE2Picture *p, LamView *view)
{
  double bar_width;
  PetscReal box[4] = LAM_EMPTY_BOX;
  LamRect bar;
  LamColourRange range;

  PetscFunctionBeginUser;
  PetscCall(LamColourRangeFind(p->element_count, p->values, &range));
  bar_width = LamColourBarWidth(canvas, &range);
  outer.width -= bar_width;
  bar = outer;
  if (p->zooms.count) {
    bar.width = 0;
    bar.x -= 6;
    outer.x += bar_width + 6; /* room for a grip at the left */
    outer.width -= 6;
  }
  ExtendBox(p, box);
  LamViewFit(outer, box, view);
  PetscCall(DrawBody(canvas, view, p, &range));
  LamColourBar(canvas, bar, &range, LamColourMap, p->field->label, p->field->unit);
  DrawKey(canvas, view, p);
  PetscFunctionReturn(0);
}

/* "Step 3, peak:  load factor 1". */
static void Title(const FE2Picture *p, size_t size, char title[])
{
  const char *peak = p->row == p->peak ? ", peak" : "";
  char factor[32];

  LamFormatRatio(p->reactions.load[p->row], factor);
  if (p->times.n)
    LamTimeTitle(&p->times, p->row, size, title);
  else
    snprintf(title, size, "Step %" PetscInt_FMT "%s%s:  load factor %s", p->step, p->step ? "" : ", inflated", peak,
             factor);
}

static void DrawTitle(LamCanvas canvas, double x, const FE2Picture *p)
{
  char title[256];

  Title(p, sizeof title, title);
  if (p->times.n)
    LamTimeTitleDraw(canvas, x, 12, &p->times, p->row);
  else
    LamCanvasTitle(canvas, x, 12, title);
}

/* ---- time histories ---- */

static PetscErrorCode MakeForces(const LamTimeLine *line, const LamReactions *reactions, LamTimeChart *chart)
{
  char label[LAM_SERIES_LABEL];
  PetscReal *values;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "reaction $R$", .unit = "N/mm"}};
  PetscCall(PetscMalloc1(line->n, &values));
  for (PetscInt c = 0; c < 2 * reactions->side_count; c++)
    if (LamReactionsGet(reactions, c, values, label)) PetscCall(LamTimeChartAdd(chart, line, values, label));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeTurgor(LamTimeLine *line, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "turgor $p$", .unit = "MPa"}};
  PetscCall(LamTimeChartAddColumn(chart, line, "turgor_min", "least"));
  PetscCall(LamTimeChartAddColumn(chart, line, "turgor_mean", "mean"));
  PetscCall(LamTimeChartAddColumn(chart, line, "turgor_max", "largest"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeShares(LamTimeLine *line, LamTimeChart *chart)
{
  const PetscReal *water;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the start"}};
  PetscCall(LamTimeChartAddGroup(chart, line, "factor", LAM_CHANGING_COUNT, LamChangingNames, LamTimeVaries));
  PetscCall(LamTimeColumn(line, "water", PETSC_FALSE, &water));
  if (LamTimeIsKnown(line->n, water)) PetscCall(LamTimeChartAdd(chart, line, water, "water"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeDamage(LamTimeLine *line, LamTimeChart *chart)
{
  const PetscReal *plasmolysed;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "stress over strength"}};
  PetscCall(LamTimeChartAddGroup(chart, line, "ratio", LAM_RATIO_COUNT, LamRatioNames, LamTimeIsKnown));
  if (!chart->n) {
    chart->axes.y.label = "share";
    PetscCall(LamTimeChartAddColumn(chart, line, "debonded_fraction", "debonded"));
  }
  PetscCall(LamTimeColumn(line, "plasmolysed", PETSC_FALSE, &plasmolysed));
  if (LamTimeIsKnown(line->n, plasmolysed) && LamTimeVaries(line->n, plasmolysed))
    PetscCall(LamTimeChartAdd(chart, line, plasmolysed, "without turgor"));
  PetscFunctionReturn(0);
}

/* Four charts, with a mark at the step drawn. */
static PetscErrorCode DrawTimes(LamCanvas canvas, LamRect outer, FE2Picture *p)
{
  LamTimeChart charts[4];

  PetscFunctionBeginUser;
  PetscCall(MakeForces(&p->times, &p->reactions, &charts[0]));
  PetscCall(MakeTurgor(&p->times, &charts[1]));
  PetscCall(MakeShares(&p->times, &charts[2]));
  PetscCall(MakeDamage(&p->times, &charts[3]));
  PetscCall(LamTimeChartsDraw(canvas, outer, &p->times, charts, p->row));
  PetscFunctionReturn(0);
}

/* ---- the page ---- */

/* Body and reactions side by side; with zooms the body and the zooms, and the reactions below. */
static PetscErrorCode DrawFE2(const char output[], FE2Picture *p)
{
  const double row = LAM_PLOT_HEIGHT - 51;
  LamRect left = {9, 25.2, 282, row}, right = {308, 21, LAM_PLOT_WIDTH - 316, LAM_PLOT_HEIGHT - 24};
  LamRect zooms = {318, 25.2, LAM_PLOT_WIDTH - 326, row};
  double height = LAM_PLOT_HEIGHT;
  LamCanvas canvas;
  LamView view;

  PetscFunctionBeginUser;
  if (p->zooms.count) {
    left.height = zooms.height = ZoomHeight;
    right = (LamRect){9, 25.2 + ZoomHeight + 34 + (p->zooms.tissue[0].interface.has_lamella ? LAM_KEY_ROW : 0),
                      LAM_PLOT_WIDTH - 17, CurveHeight};
    height = right.y + right.height + 4;
  }
  PetscCall(LamCanvasCreate(output, LAM_PLOT_WIDTH, height, &canvas));
  DrawTitle(canvas, left.x, p);
  PetscCall(DrawPanel(canvas, left, p, &view));
  if (p->zooms.count) PetscCall(LamZoomsDraw(canvas, zooms, &view, &p->zooms));
  if (p->times.n)
    PetscCall(DrawTimes(canvas, right, p));
  else
    PetscCall(LamReactionsDraw(canvas, right, &p->reactions));
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

/* ---- several steps ---- */

typedef struct {
  const char *path;
  FE2Picture *picture;
  PetscInt count, *rows; /* of the steps */
  LamFrame frame;
} Film;

/* The same window and colours for all. */
static PetscErrorCode FindFrame(Film *film)
{
  FE2Picture *p = film->picture;
  PetscReal *values;

  PetscFunctionBeginUser;
  film->frame = (LamFrame){.box = LAM_EMPTY_BOX, .label = p->field->label, .unit = p->field->unit};
  PetscCall(PetscMalloc1(film->count * p->element_count, &values));
  for (PetscInt k = 0; k < film->count; k++) {
    PetscCall(LoadStep(film->path, film->rows[k], p));
    ExtendBox(p, film->frame.box);
    PetscCall(PetscArraycpy(&values[k * p->element_count], p->values, p->element_count));
  }
  PetscCall(LamColourRangeFind(film->count * p->element_count, values, &film->frame.range));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* A LamFrameFunction; ctx: a Film. */
static PetscErrorCode DrawMoment(LamCanvas canvas, void *ctx, PetscInt k)
{
  const Film *film = (const Film *)ctx;
  FE2Picture *p = film->picture;
  LamView view;

  PetscFunctionBeginUser;
  PetscCall(LoadStep(film->path, film->rows[k], p));
  LamFrameBegin(canvas, &p->times, p->row, &film->frame, &view);
  PetscCall(DrawBody(canvas, &view, p, &film->frame.range));
  DrawKey(canvas, &view, p);
  PetscCall(DrawTimes(canvas, LamFrameCharts(), p));
  PetscFunctionReturn(0);
}

/* As LamStrip.draw and key; ctx: a Film. */
static PetscErrorCode DrawStep(LamCanvas canvas, const LamView *view, void *ctx, PetscInt k, size_t size, char title[])
{
  const Film *film = (const Film *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LoadStep(film->path, film->rows[k], film->picture));
  Title(film->picture, size, title);
  PetscCall(DrawBody(canvas, view, film->picture, &film->frame.range));
  PetscFunctionReturn(0);
}

static void DrawStripKey(LamCanvas canvas, const LamView *view, void *ctx)
{
  DrawKey(canvas, view, ((const Film *)ctx)->picture);
}

static PetscErrorCode DrawSeveral(const LamPlotRequest *request, FE2Picture *p)
{
  Film film = {.path = request->input, .picture = p, .count = request->film ? p->step_count : 1};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(p->step_count, LAM_STRIP_PANELS), &film.rows));
  film.rows[0] = p->row;
  for (PetscInt k = 0; k < film.count && request->film; k++) film.rows[k] = k;
  if (request->strip) film.count = LamStripChoose(p->step_count, p->peak, film.rows);
  PetscCall(FindFrame(&film));
  if (request->strip)
    PetscCall(LamStripDraw(request->output, &(LamStrip){film.count, film.frame, DrawStep, DrawStripKey, &film}));
  else
    PetscCall(LamFilmDraw(request, film.count, DrawMoment, &film));
  PetscCall(PetscFree(film.rows));
  PetscFunctionReturn(0);
}

static PetscErrorCode Draw(const LamPlotRequest *request, FE2Picture *p)
{
  PetscFunctionBeginUser;
  PetscCheck(p->times.n || !request->film, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of load steps; --film draws files of process, --strip their steps", request->input);
  if (request->strip || (p->times.n && (!p->zooms.count || request->film || request->state >= 0)))
    PetscCall(DrawSeveral(request, p));
  else
    PetscCall(DrawFE2(request->output, p));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotFE2(const LamPlotRequest *request)
{
  FE2Picture picture;
  PetscErrorCode ierr = LoadFE2(request, &picture);

  PetscFunctionBeginUser;
  if (!ierr) ierr = Draw(request, &picture);
  PetscCall(UnloadFE2(&picture));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
