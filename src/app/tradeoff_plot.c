/*
  The work-precision diagram: error against core-seconds, both logarithmic, a panel for each kind of error.

  A line joins the settings of one method; settings without result are omitted. A point is labelled with its setting if
  there is room: the best settings first, then the planned one. Grey band at the bottom: errors of the size of the
  reference's.
*/
#include "app.h"
#include "plot.h"
#include <math.h>
#include <string.h>

static const LamColour Shade = {0.93, 0.93, 0.93}, Front = {0.78, 0.78, 0.78};

#define PANEL_HEIGHT 178.0
#define GAP 14.0
#define MARGIN 8.0
#define LABEL_SIZE 6.0
#define MARKER_SIZE 4.2
#define LEGEND_HEIGHT 34.0
#define NOTES_HEIGHT 70.0
enum { MOST_GROUPS = 24, MOST_BOXES = 512 };

/* ---- groups: one line each ---- */

typedef struct {
  LamKnob knob;
  PetscInt through;        /* of meshes */
  PetscReal grading;       /* likewise */
  LamFE2Response response; /* of a body */
} Group;

typedef struct {
  PetscInt n;
  Group group[MOST_GROUPS];
  LamSeries series[MOST_GROUPS]; /* style and label alone */
} Groups;

static PetscBool Belongs(const Group *g, const LamSetting *s)
{
  if (s->knob != g->knob) return PETSC_FALSE;
  if (s->knob == LAM_KNOB_MESH) return (PetscBool)(s->micro.through == g->through && s->micro.grading == g->grading);
  return (PetscBool)(s->knob != LAM_KNOB_MACRO || s->response == g->response);
}

static LamStyle StyleOf(const Group *g, PetscInt meshes)
{
  static const LamMarker markers[] = {LAM_MARKER_CIRCLE,   LAM_MARKER_DIAMOND,       LAM_MARKER_SQUARE,
                                      LAM_MARKER_TRIANGLE, LAM_MARKER_TRIANGLE_DOWN, LAM_MARKER_DIAMOND,
                                      LAM_MARKER_SQUARE};
  const PetscBool graded = (PetscBool)(g->grading > 0);
  LamStyle style = {LamColourOfLine(g->knob + 2), markers[g->knob], PETSC_FALSE, PETSC_TRUE, PETSC_FALSE};

  if (g->knob == LAM_KNOB_MESH)
    style = (LamStyle){LamColourOfLine(meshes % 3), LAM_MARKER_CIRCLE, graded, PETSC_TRUE, graded};
  if (g->knob == LAM_KNOB_DATABASE) style.colour = LamColourOfLine(6);
  if (g->knob == LAM_KNOB_MACRO) style.colour = LamColourOfLine(g->response == LAM_FE2_CACHE ? 5 : 6);
  return style;
}

static void NameGroup(const Group *g, char label[LAM_SERIES_LABEL])
{
  static const char *const names[] = {[LAM_KNOB_STRATEGY] = "strategy",
                                      [LAM_KNOB_SHARPNESS] = "law of contact",
                                      [LAM_KNOB_CELLS] = "cells per period",
                                      [LAM_KNOB_TOLERANCE] = "Newton tolerance",
                                      [LAM_KNOB_DATABASE] = "table"};

  if (g->knob == LAM_KNOB_MACRO) {
    snprintf(label, LAM_SERIES_LABEL, "body: %s", LamFE2ResponseNames[g->response]);
  } else if (g->knob == LAM_KNOB_MESH) {
    snprintf(label, LAM_SERIES_LABEL, "mesh, %" PetscInt_FMT " through", g->through);
    if (g->grading > 0)
      snprintf(label + strlen(label), LAM_SERIES_LABEL - strlen(label), ", graded %g", (double)g->grading);
  } else
    snprintf(label, LAM_SERIES_LABEL, "%s", names[g->knob]);
}

static void FindGroups(const LamTradeoff *t, Groups *groups)
{
  groups->n = 0;
  for (PetscInt i = 0; i < t->n; i++) {
    const LamSetting *s = &t->measured[i].setting;
    const Group g = {s->knob, s->micro.through, s->micro.grading, s->response};
    PetscInt k = 0;

    if (!t->measured[i].runs || (g.knob == LAM_KNOB_MACRO && g.response == LAM_FE2_DIRECT)) continue;
    while (k < groups->n && !Belongs(&groups->group[k], s)) k++;
    if (k < groups->n || k == MOST_GROUPS) continue;
    groups->group[k] = g;
    groups->series[k] = (LamSeries){.style = StyleOf(&g, k)};
    NameGroup(&g, groups->series[k].label);
    groups->n++;
  }
}

/* ---- one panel ---- */

/* A measurement that is drawn. */
typedef struct {
  const LamMeasurement *m;
  PetscInt group;
  PetscReal time, low, high, error; /* logarithms; low, high: fastest and slowest run */
  PetscBool optimal;
} Point;

typedef struct {
  const LamTradeoff *t;
  const Groups *groups;
  LamErrorKind kind;
  PetscReal scale; /* of the error */
  LamAxes axes;
  PetscInt n;
  Point *points; /* in the order of the groups; owned */
  PetscInt boxes;
  LamRect box[MOST_BOXES]; /* occupied by markers and labels */
} Panel;

/* The smallest error that is drawn; smaller ones are drawn on it. */
static PetscReal Floor(const Panel *p)
{
  PetscReal smallest = PETSC_INFINITY;

  for (PetscInt i = 0; i < p->t->n; i++) {
    const PetscReal e = p->t->measured[i].error[p->kind].largest;

    if (e > 0) smallest = PetscMin(smallest, e);
  }
  return p->scale * PetscMax(smallest, p->kind == LAM_ERROR_MACRO ? 0 : p->t->reference.error[p->kind]);
}

static PetscErrorCode FindPoints(Panel *p)
{
  const PetscReal floor = Floor(p);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->t->n, &p->points));
  for (PetscInt g = 0; g < p->groups->n; g++)
    for (PetscInt i = 0; i < p->t->n; i++) {
      const LamMeasurement *m = &p->t->measured[i];
      const LamMeasuredError *e = &m->error[p->kind];
      const Point point = {.m = m,
                           .group = g,
                           .time = PetscLog10Real(m->cpu_spread.median),
                           .low = PetscLog10Real(m->cpu_spread.low),
                           .high = PetscLog10Real(m->cpu_spread.high),
                           .error = PetscLog10Real(PetscMax(p->scale * e->largest, floor)),
                           .optimal = e->optimal};

      if (!Belongs(&p->groups->group[g], &m->setting) || !m->runs || !isfinite(e->largest)) continue;
      if (p->kind == LAM_ERROR_MACRO && m->setting.planned) continue; /* the reference of the others */
      if (isfinite(point.time) && isfinite(point.error)) p->points[p->n++] = point;
    }
  PetscFunctionReturn(0);
}

/* The direct response of a body, which has no error in its panel; NULL: there is none, or it is another panel. */
static const LamMeasurement *FindDirect(const Panel *p)
{
  for (PetscInt i = 0; i < p->t->n && p->kind == LAM_ERROR_MACRO; i++) {
    const LamMeasurement *m = &p->t->measured[i];

    if (m->setting.knob == LAM_KNOB_MACRO && m->setting.planned && m->runs) return m;
  }
  return NULL;
}

static void SetLimits(Panel *p)
{
  const LamMeasurement *direct = FindDirect(p);
  LamAxes *a = &p->axes;

  LamAxesEmpty(a);
  for (PetscInt i = 0; i < p->n; i++) {
    LamAxesExtend(a, p->points[i].low, p->points[i].error);
    LamAxesExtend(a, p->points[i].high, p->points[i].error);
  }
  if (direct) a->x.high = PetscMax(a->x.high, PetscLog10Real(direct->cpu_spread.high));
  LamAxisPadLog(&a->x);
  LamAxisPadLog(&a->y);
}

static void Take(Panel *p, LamRect box)
{
  if (p->boxes < MOST_BOXES) p->box[p->boxes++] = box;
}

static PetscBool IsFree(const Panel *p, LamRect r)
{
  const LamRect f = p->axes.frame;

  if (r.x < f.x || r.y < f.y || r.x + r.width > f.x + f.width || r.y + r.height > f.y + f.height) return PETSC_FALSE;
  for (PetscInt i = 0; i < p->boxes; i++) {
    const LamRect *b = &p->box[i];

    if (r.x < b->x + b->width && b->x < r.x + r.width && r.y < b->y + b->height && b->y < r.y + r.height)
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The band in which errors are not resolved. */
static void DrawBand(LamCanvas canvas, const Panel *p)
{
  const LamRect f = p->axes.frame;
  const PetscReal limit =
      p->kind == LAM_ERROR_MACRO ? NAN : PetscLog10Real(10 * p->scale * p->t->reference.error[p->kind]);
  double top;

  if (!(limit > p->axes.y.low)) return;
  top = LamAxesY(&p->axes, PetscMin(limit, p->axes.y.high));
  LamCanvasBox(canvas, (LamRect){f.x, top, f.width, f.y + f.height - top});
  LamCanvasFill(canvas, Shade);
}

/* Joins the best settings by steps: for each point above the steps a setting has no larger error in no more time. */
static void DrawFront(LamCanvas canvas, const Panel *p)
{
  PetscReal last[2] = {-PETSC_INFINITY, 0};

  for (PetscBool joined = PETSC_FALSE;; joined = PETSC_TRUE) { /* from fast to slow */
    const Point *next = NULL;

    for (PetscInt i = 0; i < p->n; i++) {
      const Point *point = &p->points[i];

      if (point->optimal && point->time > last[0] && (!next || point->time < next->time)) next = point;
    }
    if (!next) break;
    if (joined) LamAxesPath(canvas, &p->axes, next->time, last[1], PETSC_TRUE);
    LamAxesPath(canvas, &p->axes, next->time, next->error, joined);
    last[0] = next->time;
    last[1] = next->error;
  }
  LamCanvasStroke(canvas, Front, 3.5, NULL);
}

static void DrawLine(LamCanvas canvas, const Panel *p, PetscInt g)
{
  const LamStyle *style = &p->groups->series[g].style;
  PetscBool joined = PETSC_FALSE;

  for (PetscInt i = 0; i < p->n; i++) {
    if (p->points[i].group != g) continue;
    LamAxesPath(canvas, &p->axes, p->points[i].time, p->points[i].error, joined);
    joined = PETSC_TRUE;
  }
  LamCanvasStroke(canvas, style->colour, 0.7, style->dashed ? (const double[]){3.2, 1.8} : NULL);
}

/* The spread of its times, the marker, and a ring around the planned one. */
static void DrawPoint(LamCanvas canvas, Panel *p, const Point *point)
{
  const LamStyle *style = &p->groups->series[point->group].style;
  const LamSetting *setting = &point->m->setting;
  const double x = LamAxesX(&p->axes, point->time), y = LamAxesY(&p->axes, point->error), h = 0.5 * MARKER_SIZE;
  const double low = LamAxesX(&p->axes, point->low), high = LamAxesX(&p->axes, point->high);

  LamCanvasLine(canvas, low, y, high, y);
  LamCanvasStroke(canvas, style->colour, 0.5, NULL);
  LamCanvasMarker(canvas, x, y, MARKER_SIZE, style->marker, style->hollow);
  LamCanvasSetColour(canvas, LamInk);
  if (setting->planned && setting->knob == LAM_KNOB_MESH) /* other groups have it at the same position */
    LamCanvasMarker(canvas, x, y, MARKER_SIZE, LAM_MARKER_RING, PETSC_FALSE);
  Take(p, (LamRect){x - h, y - h, 2 * h, 2 * h});
  Take(p, (LamRect){low, y - 0.5, high - low, 1});
}

/* Labels a point in the first direction in which there is room. */
static void DrawLabel(LamCanvas canvas, Panel *p, const Point *point)
{
  static const double ways[][2] = {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}};
  const char *mark = point->m->setting.mark;
  const double width = LamCanvasTextWidth(canvas, LABEL_SIZE, mark), away = 0.5 * MARKER_SIZE + 1.5;
  const double x = LamAxesX(&p->axes, point->time), y = LamAxesY(&p->axes, point->error);

  for (size_t w = 0; w < PETSC_STATIC_ARRAY_LENGTH(ways); w++) {
    const double cx = x + ways[w][0] * (away + 0.5 * width), cy = y + ways[w][1] * (away + 0.4 * LABEL_SIZE);
    const LamRect r = {cx - 0.5 * width - 0.5, cy - 0.5 * LABEL_SIZE, width + 1, LABEL_SIZE};

    if (!IsFree(p, r)) continue;
    cairo_set_source_rgba(LamCanvasCairo(canvas), 1, 1, 1, 0.7); /* lines pass beneath */
    LamCanvasBox(canvas, r);
    cairo_fill(LamCanvasCairo(canvas));
    LamCanvasSetColour(canvas, p->groups->series[point->group].style.colour);
    LamCanvasText(canvas, cx, cy, 0.5, 0, LABEL_SIZE, mark);
    Take(p, r);
    return;
  }
}

/* Best ones first, then the planned one, then the others. */
static void DrawLabels(LamCanvas canvas, Panel *p)
{
  for (int priority = 0; priority < 3; priority++)
    for (PetscInt i = 0; i < p->n; i++) {
      const Point *point = &p->points[i];

      if (priority == (point->optimal ? 0 : point->m->setting.planned ? 1 : 2)) DrawLabel(canvas, p, point);
    }
}

/* Draws the time of the direct response. */
static void DrawDirect(LamCanvas canvas, Panel *p)
{
  const LamMeasurement *direct = FindDirect(p);
  const LamRect f = p->axes.frame;
  double x;

  if (!direct) return;
  x = LamAxesX(&p->axes, PetscLog10Real(direct->cpu_spread.median));
  LamCanvasLine(canvas, x, f.y, x, f.y + f.height);
  LamCanvasStroke(canvas, LamInk, 0.7, NULL);
  LamCanvasText(canvas, x - 0.8 * LABEL_SIZE, f.y + 4, 1, M_PI_2, LABEL_SIZE, "direct (the reference here)");
}

static void DrawPanel(LamCanvas canvas, LamRect outer, Panel *p)
{
  const LamRect *f = &p->axes.frame;

  LamAxesLayout(canvas, outer, &p->axes);
  DrawBand(canvas, p);
  LamAxesDraw(canvas, &p->axes);
  LamCanvasClip(canvas, (LamRect){f->x - 5, f->y - 5, f->width + 10, f->height + 10});
  DrawFront(canvas, p);
  for (PetscInt g = 0; g < p->groups->n; g++) DrawLine(canvas, p, g);
  for (PetscInt i = 0; i < p->n; i++) DrawPoint(canvas, p, &p->points[i]);
  DrawDirect(canvas, p);
  DrawLabels(canvas, p);
  cairo_restore(LamCanvasCairo(canvas));
}

/* ---- the page ---- */

static LamRect Cell(PetscInt k, double top)
{
  const double width = 0.5 * (LAM_PLOT_WIDTH - 2 * MARGIN - GAP);

  return (LamRect){MARGIN + (double)(k % 2) * (width + GAP), top + (double)(k / 2) * (PANEL_HEIGHT + GAP), width,
                   PANEL_HEIGHT};
}

static Panel PanelOf(const LamTradeoff *t, const Groups *groups, LamErrorKind kind)
{
  const PetscBool contact = LamCellsPart(t->scene->micro.interface);
  const char *const labels[] = {[LAM_ERROR_P] = "error of $P$",
                                [LAM_ERROR_TANGENT] = "error of the tangent",
                                [LAM_ERROR_OPENING] =
                                    contact ? "error of the opening fraction" : "error of the lumen fraction",
                                [LAM_ERROR_MACRO] = "error of reaction and work"};
  const PetscBool percent = (PetscBool)(kind != LAM_ERROR_OPENING);
  Panel p = {.t = t, .groups = groups, .kind = kind, .scale = percent ? 100 : 1};

  p.axes.x = (LamAxis){.label = "time", .unit = "core-s", .is_log = PETSC_TRUE};
  p.axes.y = (LamAxis){.label = labels[kind], .unit = percent ? "%" : NULL, .is_log = PETSC_TRUE};
  return p;
}

static void DrawNotes(LamCanvas canvas, LamRect outer)
{
  static const char *const notes[] = {
      "Beside a point: elements along a face, or its setting.",
      "Ring: as the scene and the planner say.",
      "Thick grey line: nothing measured has less error in less time.",
      "Grey area: below ten times the error of the reference,",
      "which is not ranked.",
      "Bars: fastest to slowest run. What failed is not there.",
  };

  LamCanvasSetColour(canvas, LamInk);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(notes); i++)
    LamCanvasText(canvas, outer.x, outer.y + 1.6 * LAM_TICK_SIZE * ((double)i + 0.5), 0, 0, LAM_TICK_SIZE, notes[i]);
}

/* The notes are in the cell left free by three panels or one; else below. */
static PetscErrorCode DrawPage(const char path[], const Groups *groups, PetscInt n, Panel panels[])
{
  const PetscInt rows = PetscMax((n + 1) / 2, 1);
  const double top = MARGIN + LEGEND_HEIGHT, bottom = top + (double)rows * (PANEL_HEIGHT + GAP);
  LamRect notes = n % 2 ? Cell(n, top) : (LamRect){MARGIN, bottom, LAM_PLOT_WIDTH, NOTES_HEIGHT};
  LamCanvas canvas;

  PetscFunctionBeginUser;
  if (n % 2) notes.x += 30;
  PetscCall(LamCanvasCreate(path, LAM_PLOT_WIDTH, n % 2 ? bottom : bottom + NOTES_HEIGHT, &canvas));
  LamLegend(canvas, (LamRect){MARGIN, MARGIN, LAM_PLOT_WIDTH - 2 * MARGIN, LEGEND_HEIGHT}, LAM_TICK_SIZE, groups->n,
            groups->series, PETSC_TRUE);
  for (PetscInt k = 0; k < n; k++) DrawPanel(canvas, Cell(k, top), &panels[k]);
  DrawNotes(canvas, notes);
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTradeoffPlot(const LamTradeoff *t, const char path[])
{
  PetscInt n = 0;
  Groups groups;
  Panel panels[LAM_ERROR_KIND_COUNT];

  PetscFunctionBeginUser;
  FindGroups(t, &groups);
  for (int k = 0; k < LAM_ERROR_KIND_COUNT; k++) {
    Panel *p = &panels[n];

    *p = PanelOf(t, &groups, (LamErrorKind)k);
    PetscCall(FindPoints(p));
    SetLimits(p);
    if (p->n)
      n++;
    else
      PetscCall(PetscFree(p->points));
  }
  PetscCall(DrawPage(path, &groups, n, panels));
  for (PetscInt k = 0; k < n; k++) PetscCall(PetscFree(panels[k].points));
  PetscFunctionReturn(0);
}
