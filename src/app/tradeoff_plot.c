/*
  The work-precision diagram: error against core-seconds, both logarithmic, a panel for each kind of error.

  A line joins the settings of one method; settings without result are omitted. A point is labelled with its setting if
  there is room: the best settings first, then the planned one. Grey band at the bottom: errors of the size of the
  reference's.
*/
#include "tradeoff_report.h"
#include "plot.h"
#include <math.h>
#include <string.h>

static const LamColour Ink = {0.15, 0.15, 0.15}, Shade = {0.93, 0.93, 0.93}, Front = {0.78, 0.78, 0.78};

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
                                      LAM_MARKER_TRIANGLE, LAM_MARKER_TRIANGLE_DOWN, LAM_MARKER_DIAMOND};
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

typedef struct {
  const LamTradeoff *t;
  const Groups *groups;
  LamErrorKind kind;
  PetscReal scale, floor; /* of the error; errors below the floor are drawn on it */
  LamAxes axes;
  PetscInt boxes;
  LamRect box[MOST_BOXES]; /* occupied by markers and labels */
} Panel;

/* Position of a measurement, in logarithms; PETSC_FALSE: not drawn. */
static PetscBool Place(const Panel *p, const LamMeasurement *m, PetscReal at[2])
{
  const LamMeasuredError *e = &m->error[p->kind];

  if (!m->runs || !isfinite(e->largest) || (p->kind == LAM_ERROR_MACRO && m->setting.planned)) return PETSC_FALSE;
  at[0] = PetscLog10Real(m->cpu_spread.median);
  at[1] = PetscLog10Real(PetscMax(p->scale * e->largest, p->floor));
  return (PetscBool)(isfinite(at[0]) && isfinite(at[1]));
}

static void SetFloor(Panel *p)
{
  PetscReal smallest = PETSC_INFINITY;

  for (PetscInt i = 0; i < p->t->n; i++) {
    const PetscReal e = p->t->measured[i].error[p->kind].largest;

    if (e > 0) smallest = PetscMin(smallest, e);
  }
  p->floor = p->scale * PetscMax(smallest, p->kind == LAM_ERROR_MACRO ? 0 : p->t->reference.error[p->kind]);
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

/* Whether the panel has any point. */
static PetscBool SetLimits(Panel *p)
{
  const LamMeasurement *direct = FindDirect(p);
  LamAxes *a = &p->axes;
  PetscReal at[2];

  SetFloor(p);
  a->x.low = a->y.low = PETSC_INFINITY;
  a->x.high = a->y.high = -PETSC_INFINITY;
  for (PetscInt i = 0; i < p->t->n; i++) {
    const LamMeasurement *m = &p->t->measured[i];

    if (!Place(p, m, at)) continue;
    a->x.low = PetscMin(a->x.low, PetscLog10Real(m->cpu_spread.low));
    a->x.high = PetscMax(a->x.high, PetscLog10Real(m->cpu_spread.high));
    a->y.low = PetscMin(a->y.low, at[1]);
    a->y.high = PetscMax(a->y.high, at[1]);
  }
  if (!(a->x.low <= a->x.high)) return PETSC_FALSE;
  if (direct) a->x.high = PetscMax(a->x.high, PetscLog10Real(direct->cpu_spread.high));
  LamAxisPadLog(&a->x);
  LamAxisPadLog(&a->y);
  return PETSC_TRUE;
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
  LamCanvasSetColour(canvas, Shade);
  cairo_rectangle(LamCanvasCairo(canvas), f.x, top, f.width, f.y + f.height - top);
  cairo_fill(LamCanvasCairo(canvas));
}

/* Joins the best settings by steps: for each point above the steps a setting has no larger error in no more time. */
static void DrawFront(LamCanvas canvas, const Panel *p)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  PetscReal at[2], last[2] = {-PETSC_INFINITY, 0};
  PetscBool drawing = PETSC_FALSE;

  LamCanvasSetColour(canvas, Front);
  cairo_set_line_width(cr, 3.5);
  for (;;) { /* from fast to slow */
    const LamMeasurement *next = NULL;
    PetscReal found[2] = {PETSC_INFINITY, 0};

    for (PetscInt i = 0; i < p->t->n; i++) {
      const LamMeasurement *m = &p->t->measured[i];

      if (!m->error[p->kind].optimal || !Place(p, m, at) || at[0] <= last[0] || at[0] >= found[0]) continue;
      next = m;
      found[0] = at[0];
      found[1] = at[1];
    }
    if (!next) break;
    if (drawing) {
      cairo_line_to(cr, LamAxesX(&p->axes, found[0]), LamAxesY(&p->axes, last[1]));
      cairo_line_to(cr, LamAxesX(&p->axes, found[0]), LamAxesY(&p->axes, found[1]));
    } else
      cairo_move_to(cr, LamAxesX(&p->axes, found[0]), LamAxesY(&p->axes, found[1]));
    drawing = PETSC_TRUE;
    last[0] = found[0];
    last[1] = found[1];
  }
  cairo_stroke(cr);
}

static void DrawLine(LamCanvas canvas, const Panel *p, PetscInt g)
{
  const double dash[] = {3.2, 1.8};
  cairo_t *cr = LamCanvasCairo(canvas);
  const LamStyle *style = &p->groups->series[g].style;
  PetscReal at[2];

  LamCanvasSetColour(canvas, style->colour);
  cairo_set_line_width(cr, 0.7);
  cairo_set_dash(cr, dash, style->dashed ? 2 : 0, 0);
  for (PetscInt i = 0; i < p->t->n; i++)
    if (Belongs(&p->groups->group[g], &p->t->measured[i].setting) && Place(p, &p->t->measured[i], at))
      cairo_line_to(cr, LamAxesX(&p->axes, at[0]), LamAxesY(&p->axes, at[1]));
  cairo_stroke(cr);
  cairo_set_dash(cr, dash, 0, 0);
}

/* The spread of its times, the marker, and a ring around the planned one. */
static void DrawPoint(LamCanvas canvas, Panel *p, const LamStyle *style, const LamMeasurement *m, const PetscReal at[2])
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double x = LamAxesX(&p->axes, at[0]), y = LamAxesY(&p->axes, at[1]), h = 0.5 * MARKER_SIZE;
  const double low = LamAxesX(&p->axes, PetscLog10Real(m->cpu_spread.low));
  const double high = LamAxesX(&p->axes, PetscLog10Real(m->cpu_spread.high));

  LamCanvasSetColour(canvas, style->colour);
  cairo_set_line_width(cr, 0.5);
  cairo_move_to(cr, low, y);
  cairo_line_to(cr, high, y);
  cairo_stroke(cr);
  LamCanvasMarker(canvas, x, y, MARKER_SIZE, style->marker, style->hollow);
  if (m->setting.planned && m->setting.knob == LAM_KNOB_MESH) { /* other groups have it at the same position */
    LamCanvasSetColour(canvas, Ink);
    LamCanvasMarker(canvas, x, y, MARKER_SIZE, LAM_MARKER_RING, PETSC_FALSE);
  }
  Take(p, (LamRect){x - h, y - h, 2 * h, 2 * h});
  Take(p, (LamRect){low, y - 0.5, high - low, 1});
}

static void DrawGroup(LamCanvas canvas, Panel *p, PetscInt g)
{
  PetscReal at[2];

  for (PetscInt i = 0; i < p->t->n; i++) {
    const LamMeasurement *m = &p->t->measured[i];

    if (Belongs(&p->groups->group[g], &m->setting) && Place(p, m, at))
      DrawPoint(canvas, p, &p->groups->series[g].style, m, at);
  }
}

/* Labels a point in the first direction in which there is room. */
static void DrawLabel(LamCanvas canvas, Panel *p, LamColour colour, const LamMeasurement *m, const PetscReal at[2])
{
  static const double ways[][2] = {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}};
  const double width = LamCanvasTextWidth(canvas, LABEL_SIZE, m->setting.mark), away = 0.5 * MARKER_SIZE + 1.5;
  const double x = LamAxesX(&p->axes, at[0]), y = LamAxesY(&p->axes, at[1]);

  for (size_t w = 0; w < PETSC_STATIC_ARRAY_LENGTH(ways); w++) {
    const double cx = x + ways[w][0] * (away + 0.5 * width), cy = y + ways[w][1] * (away + 0.4 * LABEL_SIZE);
    const LamRect r = {cx - 0.5 * width - 0.5, cy - 0.5 * LABEL_SIZE, width + 1, LABEL_SIZE};

    if (!IsFree(p, r)) continue;
    cairo_set_source_rgba(LamCanvasCairo(canvas), 1, 1, 1, 0.7); /* lines pass beneath */
    cairo_rectangle(LamCanvasCairo(canvas), r.x, r.y, r.width, r.height);
    cairo_fill(LamCanvasCairo(canvas));
    LamCanvasSetColour(canvas, colour);
    LamCanvasText(canvas, cx, cy, 0.5, 0, LABEL_SIZE, m->setting.mark);
    Take(p, r);
    return;
  }
}

/* Order of labelling: 0 best, 1 planned, 2 the others. */
static int Priority(const Panel *p, const LamMeasurement *m)
{
  return m->error[p->kind].optimal ? 0 : m->setting.planned ? 1 : 2;
}

static void DrawLabels(LamCanvas canvas, Panel *p)
{
  PetscReal at[2];

  for (int priority = 0; priority < 3; priority++)
    for (PetscInt g = 0; g < p->groups->n; g++)
      for (PetscInt i = 0; i < p->t->n; i++) {
        const LamMeasurement *m = &p->t->measured[i];

        if (!Belongs(&p->groups->group[g], &m->setting) || Priority(p, m) != priority || !Place(p, m, at)) continue;
        DrawLabel(canvas, p, p->groups->series[g].style.colour, m, at);
      }
}

/* Draws the time of the direct response. */
static void DrawDirect(LamCanvas canvas, Panel *p)
{
  const LamMeasurement *direct = FindDirect(p);
  cairo_t *cr = LamCanvasCairo(canvas);
  const LamRect f = p->axes.frame;
  double x;

  if (!direct) return;
  x = LamAxesX(&p->axes, PetscLog10Real(direct->cpu_spread.median));
  LamCanvasSetColour(canvas, Ink);
  cairo_set_line_width(cr, 0.7);
  cairo_move_to(cr, x, f.y);
  cairo_line_to(cr, x, f.y + f.height);
  cairo_stroke(cr);
  LamCanvasText(canvas, x - 0.8 * LABEL_SIZE, f.y + 4, 1, M_PI_2, LABEL_SIZE, "direct (the reference here)");
}

static void DrawPanel(LamCanvas canvas, LamRect outer, Panel *p)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const LamRect *f = &p->axes.frame;

  LamAxesLayout(canvas, outer, &p->axes);
  DrawBand(canvas, p);
  LamAxesDraw(canvas, &p->axes);
  cairo_save(cr);
  cairo_rectangle(cr, f->x - 5, f->y - 5, f->width + 10, f->height + 10);
  cairo_clip(cr);
  DrawFront(canvas, p);
  for (PetscInt g = 0; g < p->groups->n; g++) DrawLine(canvas, p, g);
  for (PetscInt g = 0; g < p->groups->n; g++) DrawGroup(canvas, p, g);
  DrawDirect(canvas, p);
  DrawLabels(canvas, p);
  cairo_restore(cr);
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
  const PetscBool contact = (PetscBool)(t->scene->micro.interface == LAM_INTERFACE_CONTACT);
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

  LamCanvasSetColour(canvas, Ink);
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
  LamLegend(canvas, (LamRect){MARGIN, MARGIN, LAM_PLOT_WIDTH - 2 * MARGIN, LEGEND_HEIGHT}, groups->n, groups->series,
            PETSC_TRUE);
  for (PetscInt k = 0; k < n; k++) DrawPanel(canvas, Cell(k, top), &panels[k]);
  DrawNotes(canvas, notes);
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTradeoffPlot(const LamTradeoff *t, const char path[])
{
  PetscInt n = 0;
  Groups *groups;
  Panel *panels;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&groups));
  PetscCall(PetscMalloc1(LAM_ERROR_KIND_COUNT, &panels));
  FindGroups(t, groups);
  for (int k = 0; k < LAM_ERROR_KIND_COUNT; k++) {
    panels[n] = PanelOf(t, groups, (LamErrorKind)k);
    n += SetLimits(&panels[n]);
  }
  PetscCall(DrawPage(path, groups, n, panels));
  PetscCall(PetscFree(panels));
  PetscCall(PetscFree(groups));
  PetscFunctionReturn(0);
}
