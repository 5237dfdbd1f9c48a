/*
  Picture of a map: left the failure modes, right a number of each point.

  Each point is a cell of the picture, whose edges are half-way to its neighbours.
*/
#include "plot_map.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Empty = {0.93, 0.93, 0.93};

/* Colours of Okabe and Ito, some of them lighter. */
static const struct {
  const char *label;
  LamColour colour;
} Modes[LAM_FAILURE_MODE_COUNT] = {
    [LAM_FAILURE_NONE] = {"no failure", {0.80, 0.90, 0.78}},
    [LAM_FAILURE_SEPARATION] = {"cells separate", {0.34, 0.71, 0.91}},
    [LAM_FAILURE_RUPTURE] = {"walls rupture", {0.84, 0.37, 0.00}},
    [LAM_FAILURE_BUCKLING] = {"walls buckle", {0.80, 0.60, 0.78}},
    [LAM_FAILURE_TURGOR_LOSS] = {"turgor is lost", {0.96, 0.87, 0.45}},
    [LAM_FAILURE_UNKNOWN] = {"not known", {1, 1, 1}},
};

static LamAxes AxesOf(const LamMapPicture *p)
{
  const char *x_unit = p->x.is_log || !strcmp(p->x.unit, "1") ? NULL : p->x.unit;
  const char *y_unit = p->y.is_log || !strcmp(p->y.unit, "1") ? NULL : p->y.unit;

  return (LamAxes){.x = {p->x.edge[0], p->x.edge[p->x.n], p->x.label, x_unit, PETSC_FALSE, {0}},
                   .y = {p->y.edge[0], p->y.edge[p->y.n], p->y.label, y_unit, PETSC_FALSE, {0}}};
}

/* Fills a cell of the picture; neighbours overlap slightly, so that no seam shows. */
static void FillCell(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p, PetscInt i, LamColour colour)
{
  const PetscInt x = i % p->x.n, y = i / p->x.n;
  const double left = LamAxesX(axes, p->x.edge[x]), right = LamAxesX(axes, p->x.edge[x + 1]);
  const double bottom = LamAxesY(axes, p->y.edge[y]), top = LamAxesY(axes, p->y.edge[y + 1]), hair = 0.15;

  LamCanvasBox(canvas, (LamRect){left, top - hair, right - left + hair, bottom - top + hair});
  LamCanvasFill(canvas, colour);
}

/* A thin cross, for points that did not converge. */
static void CrossCell(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p, PetscInt i)
{
  const double x = LamAxesX(axes, p->x.at[i % p->x.n]), y = LamAxesY(axes, p->y.at[i / p->x.n]), h = 1.8;

  LamCanvasLine(canvas, x - h, y - h, x + h, y + h);
  LamCanvasLine(canvas, x - h, y + h, x + h, y - h);
  LamCanvasStroke(canvas, LamInk, 0.7, NULL);
}

static void DrawModes(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p)
{
  for (PetscInt i = 0; i < p->n; i++) {
    FillCell(canvas, axes, p, i, p->mode[i] < 0 ? Empty : Modes[p->mode[i]].colour);
    if (p->mode[i] == LAM_FAILURE_UNKNOWN) CrossCell(canvas, axes, p, i);
  }
}

static void DrawField(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p)
{
  for (PetscInt i = 0; i < p->n; i++)
    FillCell(canvas, axes, p, i, isnan(p->value[i]) ? Empty : LamColourMap(LamColourShare(&p->range, p->value[i])));
}

/* ---- the onset, at higher resolution than the cells ---- */

/* Where a row or column of points along the load fails, in the axis' own quantity; NaN: nowhere. */
static PetscReal OnsetAlong(const LamMapPicture *p, const LamMapSide *side, PetscInt last)
{
  const PetscReal onset = !strcmp(side->quantity, "shear") ? p->shear[last] : p->load_factor[last];

  if (isnan(p->load_factor[last])) return NAN;
  return side->is_log ? log10(onset) : onset;
}

static PetscBool IsOfLoad(const LamMapSide *side)
{
  return (PetscBool)(!strcmp(side->quantity, "shear") || !strcmp(side->quantity, "load_factor"));
}

/* For an axis that is a load quantity: the load at which each path fails. */
static void DrawOnset(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p)
{
  const PetscBool x_is_load = IsOfLoad(&p->x);
  const LamMapSide *load = x_is_load ? &p->x : &p->y, *other = x_is_load ? &p->y : &p->x;
  PetscBool drawing = PETSC_FALSE;

  for (PetscInt k = 0; k < other->n; k++) {
    const PetscInt last = x_is_load ? k * p->x.n + p->x.n - 1 : (p->y.n - 1) * p->x.n + k;
    const PetscReal onset = OnsetAlong(p, load, last), at = other->at[k];
    const PetscBool known = (PetscBool)(onset >= load->edge[0]);

    if (known) LamAxesPath(canvas, axes, x_is_load ? onset : at, x_is_load ? at : onset, drawing);
    drawing = known;
  }
  LamCanvasStroke(canvas, LamInk, 1.0, NULL);
}

/* ---- contours ---- */

/* Position of `level` between two points; false: not between them. */
static PetscBool Crossing(const LamMapPicture *p, PetscInt a, PetscInt b, PetscReal level, PetscReal at[2])
{
  const PetscReal va = p->load_factor[a], vb = p->load_factor[b];
  PetscReal share;

  if (isnan(va) || isnan(vb) || (va < level) == (vb < level)) return PETSC_FALSE;
  share = (level - va) / (vb - va);
  at[0] = (1 - share) * p->x.at[a % p->x.n] + share * p->x.at[b % p->x.n];
  at[1] = (1 - share) * p->y.at[a / p->x.n] + share * p->y.at[b / p->x.n];
  return PETSC_TRUE;
}

/* The segment of a contour between four points of the same mode; between modes the load factor may jump. */
static PetscBool ContourPiece(const LamMapPicture *p, PetscInt x, PetscInt y, PetscReal level, PetscReal piece[2][2])
{
  const PetscInt a = y * p->x.n + x, b = a + 1, c = b + p->x.n, d = a + p->x.n;
  const PetscInt sides[4][2] = {{a, b}, {b, c}, {c, d}, {d, a}};
  int found = 0;

  if (p->mode[a] != p->mode[b] || p->mode[a] != p->mode[c] || p->mode[a] != p->mode[d]) return PETSC_FALSE;
  for (int s = 0; s < 4 && found < 2; s++) found += Crossing(p, sides[s][0], sides[s][1], level, piece[found]);
  return (PetscBool)(found == 2);
}

/* A contour with one label where there is room for it: at the segment nearest to the diagonal. */
static void DrawContour(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p, PetscReal level,
                        const char text[])
{
  const LamRect f = axes->frame;
  double best = INFINITY, at[2] = {0, 0};

  for (PetscInt y = 0; y + 1 < p->y.n; y++)
    for (PetscInt x = 0; x + 1 < p->x.n; x++) {
      PetscReal piece[2][2];
      double middle[2], far;

      if (!ContourPiece(p, x, y, level, piece)) continue;
      for (int end = 0; end < 2; end++) LamAxesPath(canvas, axes, piece[end][0], piece[end][1], (PetscBool)end);
      middle[0] = LamAxesX(axes, 0.5 * (piece[0][0] + piece[1][0]));
      middle[1] = LamAxesY(axes, 0.5 * (piece[0][1] + piece[1][1]));
      far = fabs((middle[0] - f.x) / f.width - (f.y + f.height - middle[1]) / f.height);
      if (far >= best) continue;
      best = far;
      memcpy(at, middle, sizeof at);
    }
  LamCanvasStroke(canvas, LamInk, 0.7, NULL);
  if (isfinite(best)) LamCanvasTextFree(canvas, at[0] + 2, at[1] - 4, 0, 0, LAM_TICK_SIZE - 1, text);
}

static PetscErrorCode DrawContours(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *p)
{
  LamColourRange range;
  LamTicks ticks;

  PetscFunctionBeginUser;
  PetscCall(LamColourRangeFind(p->n, p->load_factor, &range));
  ticks = LamTicksChoose(range.low, range.high, 6, PETSC_FALSE);
  for (PetscInt i = 0; i < ticks.count; i++) {
    char text[32];

    LamTicksFormat(&ticks, i, text);
    DrawContour(canvas, axes, p, ticks.first + (PetscReal)i * ticks.step, text);
  }
  PetscFunctionReturn(0);
}

/* ---- the page ---- */

/* The sample of an entry of the legend: a box of a mode's colour, or a line (colour NULL). */
static void DrawSample(LamCanvas canvas, const double at[2], const LamColour *colour)
{
  const double box = LAM_TICK_SIZE;

  if (colour) {
    LamCanvasBox(canvas, (LamRect){at[0], at[1] - 0.5 * box, box, box});
    LamCanvasSetColour(canvas, *colour);
    cairo_fill_preserve(LamCanvasCairo(canvas));
  } else
    LamCanvasLine(canvas, at[0], at[1], at[0] + box, at[1]);
  LamCanvasStroke(canvas, LamInk, colour ? 0.4 : 1.0, NULL);
}

static PetscBool Occurs(const LamMapPicture *p, PetscInt mode)
{
  for (PetscInt i = 0; i < p->n; i++)
    if (p->mode[i] == mode) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Legend of the modes that occur and of the lines. Returns the height used. */
static double DrawLegend(LamCanvas canvas, LamRect outer, const LamMapPicture *p)
{
  LamPen pen;
  double at[2];

  outer.width -= 9; /* as after each entry */
  pen = LamPenStart(outer, 1.6 * LAM_TICK_SIZE, 9);
  for (PetscInt k = 0; k < LAM_FAILURE_MODE_COUNT; k++) {
    if (!Occurs(p, k)) continue;
    LamPenEntry(canvas, &pen, LAM_TICK_SIZE, Modes[k].label, PETSC_TRUE, at);
    DrawSample(canvas, at, &Modes[k].colour);
  }
  LamPenEntry(canvas, &pen, LAM_TICK_SIZE, IsOfLoad(&p->x) || IsOfLoad(&p->y) ? "onset" : "load factor", PETSC_TRUE,
              at);
  DrawSample(canvas, at, NULL);
  if (p->has_path) {
    LamPenEntry(canvas, &pen, LAM_TICK_SIZE, "path of the tissue", PETSC_TRUE, at);
    LamCanvasLine(canvas, at[0], at[1], at[0] + LAM_TICK_SIZE, at[1]);
    LamCanvasStroke(canvas, LamPathColour, 1.3, NULL);
  }
  return pen.y + 0.5 * pen.row - outer.y;
}

static const char *FieldLabel(const char field[])
{
  static const struct {
    const char *field, *label;
  } labels[] = {{"load_factor", "load factor at failure"},
                {"open_fraction", "open share of the interface"},
                {"debonded_fraction", "debonded share of the interface"},
                {"max_gap", "largest gap / apothem"},
                {"max_traction", "largest lamella traction"},
                {"max_wall_tension", "largest wall tension"},
                {"ellipticity", "ellipticity of the tangent"},
                {"kinked_fraction", "kinked share of the walls"}};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(labels); i++)
    if (!strcmp(field, labels[i].field)) return labels[i].label;
  return field;
}

PetscErrorCode LamMapDrawModes(LamCanvas canvas, LamRect outer, const LamMapPicture *p, LamAxes *axes)
{
  const double legend = DrawLegend(canvas, outer, p) + 4;

  PetscFunctionBeginUser;
  outer.y += legend;
  outer.height -= legend;
  *axes = AxesOf(p);
  LamAxesLayout(canvas, outer, axes);
  LamAxesDraw(canvas, axes);
  DrawModes(canvas, axes, p);
  if (IsOfLoad(&p->x) || IsOfLoad(&p->y))
    DrawOnset(canvas, axes, p);
  else
    PetscCall(DrawContours(canvas, axes, p));
  LamAxesFrame(canvas, axes);
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawPage(LamCanvas canvas, const LamMapPicture *p)
{
  const double bar = LamColourBarWidth(canvas, &p->range), width = 0.5 * (LAM_PLOT_WIDTH - 18 - 14 - bar), top = 6;
  const LamRect left = {9, top, width, LAM_PLOT_HEIGHT - top - 6};
  LamRect right = left;
  LamAxes axes;

  PetscFunctionBeginUser;
  PetscCall(LamMapDrawModes(canvas, left, p, &axes));
  right.x += width + 14;
  right.height -= axes.frame.y - left.y - 0.5 * LAM_TICK_SIZE;
  right.y = axes.frame.y - 0.5 * LAM_TICK_SIZE;
  LamAxesLayout(canvas, right, &axes);
  LamAxesDraw(canvas, &axes);
  DrawField(canvas, &axes, p);
  LamAxesFrame(canvas, &axes);
  LamColourBar(canvas, axes.frame, &p->range, LamColourMap, FieldLabel(p->field), p->unit);
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotMap(const LamPlotRequest *request)
{
  LamMapPicture picture;
  LamCanvas canvas;

  PetscFunctionBeginUser;
  PetscCheck(request->state == LAM_PLOT_PEAK, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--state: a map is drawn as a whole");
  PetscCall(LamMapPictureRead(request, &picture));
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_PLOT_HEIGHT, &canvas));
  PetscCall(DrawPage(canvas, &picture));
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(LamMapPictureDestroy(&picture));
  PetscFunctionReturn(0);
}
