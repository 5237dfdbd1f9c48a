/*
  Picture of a table: slices through the plane of two principal logarithmic strains with fixed axes.

  Four panels: the potential, the stress, the estimated error with the nodes that lie in the slice, and the gaps or
  lumens. Where the table has no response, all panels show the reason.
*/
#include "plot_slice.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#define FRAME 152.0 /* edge of a panel */
#define HEADER 54.0 /* height of title and legend */
#define BELOW 36.0  /* of a panel: tick labels, label and spacing */
#define GLYPH 19.0  /* radius of the cell in the header */
#define NODE_SIZE 5.0
enum { MOST_LEVELS = 8 }; /* of nodes */

static const LamColour Failure = {0.80, 0.15, 0.05};

/* Appearance of points without a good response; hatched rising, falling or both. */
typedef struct {
  const char *label;
  PetscBool filled;
  LamColour fill, line;
  PetscBool rising, falling;
  double spacing; /* of the lines */
} Look;
static const Look Looks[LAM_SLICE_VERDICT_COUNT] = {
    [LAM_SLICE_FLOATING] = {"cells touch no one", PETSC_FALSE, {0}, {0.15, 0.15, 0.15}, PETSC_FALSE, PETSC_TRUE, 7},
    [LAM_SLICE_INACCURATE] =
        {"estimated error above", PETSC_FALSE, {0}, {0.15, 0.15, 0.15}, PETSC_TRUE, PETSC_FALSE, 4.5},
    [LAM_SLICE_KINK] =
        {"change of branch or failed node", PETSC_TRUE, {0.7, 0.7, 0.7}, {1, 1, 1}, PETSC_TRUE, PETSC_TRUE, 4.5},
    [LAM_SLICE_NOTHING] = {"no nodes around", PETSC_TRUE, {0.92, 0.92, 0.92}, {1, 1, 1}, PETSC_FALSE, PETSC_FALSE, 0},
};

/* ---- one panel ---- */

static uint32_t Pixel(LamColour c)
{
  return 0xff000000u | (uint32_t)lround(255 * c.r) << 16 | (uint32_t)lround(255 * c.g) << 8 |
         (uint32_t)lround(255 * c.b);
}

/* One pixel of a small image for each sample, scaled to the frame. */
static PetscErrorCode PaintSamples(LamCanvas canvas, LamRect frame, const LamSlice *s, const PetscReal values[],
                                   const LamColourRange *range)
{
  const int n = LAM_SLICE_SAMPLES;
  cairo_t *cr = LamCanvasCairo(canvas);
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, n, n);
  uint32_t *pixels;
  int stride;

  PetscFunctionBeginUser;
  PetscCheck(!cairo_surface_status(surface), PETSC_COMM_SELF, PETSC_ERR_LIB, "cairo: %s",
             cairo_status_to_string(cairo_surface_status(surface)));
  cairo_surface_flush(surface);
  pixels = (uint32_t *)(void *)cairo_image_surface_get_data(surface);
  stride = cairo_image_surface_get_stride(surface) / (int)sizeof *pixels;
  for (int i = 0; i < n * n; i++) {
    const Look *look = &Looks[s->verdict[i]];
    const PetscBool blank = (PetscBool)(look->filled || isnan(values[i])); /* an indicator may be unknown */

    pixels[(n - 1 - i / n) * stride + i % n] =
        Pixel(blank ? look->filled ? look->fill : LamWhite : LamColourMap(LamColourShare(range, values[i])));
  }
  cairo_surface_mark_dirty(surface);
  cairo_save(cr);
  cairo_translate(cr, frame.x, frame.y);
  cairo_scale(cr, frame.width / n, frame.height / n);
  cairo_set_source_surface(cr, surface, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
  cairo_paint(cr);
  cairo_restore(cr);
  cairo_surface_destroy(surface);
  PetscFunctionReturn(0);
}

/* Draws lines inside the clip of the canvas; a light line below each dark one makes it visible on any colour. */
static void Hatch(LamCanvas canvas, LamRect r, const Look *look)
{
  const double bottom = r.y + r.height;

  if (!look->rising && !look->falling) return;
  for (int pass = look->filled; pass < 2; pass++) {
    for (double x = r.x - r.height; x < r.x + r.width; x += look->spacing) {
      if (look->rising) LamCanvasLine(canvas, x, bottom, x + r.height, r.y);
      if (look->falling) LamCanvasLine(canvas, x, r.y, x + r.height, bottom);
    }
    LamCanvasStroke(canvas, pass ? look->line : LamWhite, look->filled ? 0.6 : pass ? 0.4 : 0.9, NULL);
  }
}

/* Hatches the samples of a verdict; rows overlap slightly, so that no seam shows. */
static void HatchSamples(LamCanvas canvas, LamRect frame, const LamSlice *s, LamSliceVerdict verdict)
{
  const double edge = frame.width / LAM_SLICE_SAMPLES, hair = 0.1;
  cairo_t *cr = LamCanvasCairo(canvas);

  if (!s->count[verdict] || !(Looks[verdict].rising || Looks[verdict].falling)) return;
  cairo_save(cr);
  for (PetscInt row = 0; row < LAM_SLICE_SAMPLES; row++)
    for (PetscInt i = 0, end; i < LAM_SLICE_SAMPLES; i = end + 1) {
      const LamSliceVerdict *samples = &s->verdict[row * LAM_SLICE_SAMPLES];

      for (end = i; end < LAM_SLICE_SAMPLES && samples[end] == verdict;) end++;
      cairo_rectangle(cr, frame.x + edge * (double)i, frame.y + frame.height - edge * (double)(row + 1) - hair,
                      edge * (double)(end - i), edge + hair);
    }
  cairo_clip(cr);
  Hatch(canvas, frame, &Looks[verdict]);
  cairo_restore(cr);
}

static double NodeSize(PetscInt level)
{
  return NODE_SIZE * PetscPowReal(0.75, (PetscReal)level);
}

static void DrawNode(LamCanvas canvas, double x, double y, LamSliceNodeKind kind, PetscInt level)
{
  static const LamMarker markers[LAM_SLICE_NODE_KINDS] = {LAM_MARKER_CIRCLE, LAM_MARKER_DIAMOND, LAM_MARKER_CROSS};

  LamCanvasSetColour(canvas, kind == LAM_SLICE_SOUND ? LamInk : Failure);
  LamCanvasMarker(canvas, x, y, NodeSize(level), markers[kind], PETSC_TRUE);
}

/* Coarse ones first, as they are larger. */
static PetscErrorCode DrawNodes(LamCanvas canvas, const LamAxes *axes, const LamSlice *s)
{
  const PetscBool many = (PetscBool)(s->node_count > 1500);

  PetscFunctionBeginUser;
  if (many) PetscCall(LamCanvasBeginImage(canvas, axes->frame));
  for (PetscInt level = 0; level < MOST_LEVELS; level++)
    for (PetscInt i = 0; i < s->node_count; i++) {
      const LamSliceNode *node = &s->nodes[i];

      if (node->level != level) continue;
      DrawNode(canvas, LamAxesX(axes, node->at[0]), LamAxesY(axes, node->at[1]), node->kind, level);
    }
  if (many) LamCanvasEndImage(canvas);
  PetscFunctionReturn(0);
}

static void DashedBox(LamCanvas canvas, LamRect box)
{
  LamCanvasBox(canvas, box);
  LamCanvasStroke(canvas, LamWhite, 1.2, NULL);
  LamCanvasBox(canvas, box);
  LamCanvasStroke(canvas, LamInk, 0.7, (const double[]){3.2, 1.8});
}

static void DrawBox(LamCanvas canvas, const LamAxes *axes, const LamSlice *s)
{
  const double left = LamAxesX(axes, s->box[0]), top = LamAxesY(axes, s->box[1]);

  if (!isnan(s->box[0]))
    DashedBox(canvas, (LamRect){left, top, LamAxesX(axes, s->box[1]) - left, LamAxesY(axes, s->box[0]) - top});
}

typedef struct {
  const LamSlice *slice;
  LamColourRange range[LAM_SLICE_PANEL_COUNT];
  double bar;                 /* width of the widest colour bar */
  char first[96], second[96]; /* labels of the axes */
} Page;

static PetscErrorCode DrawPanel(LamCanvas canvas, LamRect outer, const Page *page, LamSlicePanel panel)
{
  const LamSlice *s = page->slice;
  const PetscBool contact = LamCellsPart(s->interface);
  const struct {
    const char *label, *unit;
  } names[LAM_SLICE_PANEL_COUNT] = {{contact ? "potential $Φ$" : "energy of the walls $Φ$", "MPa"},
                                    {"stress ‖$P$‖", "MPa"},
                                    {"estimated error of $P$", "%"},
                                    {contact ? "gaps" : "lumens", "% of $V$_{0}"}};
  LamAxes axes = {.x = {.low = s->low, .high = s->high, .label = page->first},
                  .y = {.low = s->low, .high = s->high, .label = page->second}};

  PetscFunctionBeginUser;
  outer.width -= page->bar;
  LamAxesLayout(canvas, outer, &axes);
  axes.frame.width = axes.frame.height = PetscMin(axes.frame.width, axes.frame.height);
  LamAxesDraw(canvas, &axes);
  LamCanvasClip(canvas, axes.frame);
  PetscCall(PaintSamples(canvas, axes.frame, s, s->value[panel], &page->range[panel]));
  for (int v = 0; v < LAM_SLICE_VERDICT_COUNT; v++) HatchSamples(canvas, axes.frame, s, (LamSliceVerdict)v);
  DrawBox(canvas, &axes, s);
  if (panel == LAM_SLICE_ERROR) PetscCall(DrawNodes(canvas, &axes, s));
  cairo_restore(LamCanvasCairo(canvas));
  LamAxesFrame(canvas, &axes);
  LamColourBar(canvas, axes.frame, &page->range[panel], LamColourMap, names[panel].label, names[panel].unit);
  PetscFunctionReturn(0);
}

/* ---- header ---- */

static void LegendOfVerdict(LamCanvas canvas, LamPen *pen, const LamSlice *s, LamSliceVerdict verdict)
{
  const Look *look = &Looks[verdict];
  char label[64], number[32];
  LamRect sample;
  double at[2];

  if (!look->label || !s->count[verdict]) return;
  LamFormatNumber(100 * s->accuracy, number);
  if (verdict == LAM_SLICE_INACCURATE)
    snprintf(label, sizeof label, "%s %s %%", look->label, number);
  else
    snprintf(label, sizeof label, "%s", look->label);
  LamPenEntry(canvas, pen, 14, label, PETSC_TRUE, at);
  sample = (LamRect){at[0], at[1] - 3.5, 14, 7};
  LamCanvasClip(canvas, sample);
  LamCanvasSetColour(canvas, look->filled ? look->fill : LamColourMap(0.6));
  cairo_paint(LamCanvasCairo(canvas));
  Hatch(canvas, sample, look);
  cairo_restore(LamCanvasCairo(canvas));
  LamCanvasBox(canvas, sample);
  LamCanvasStroke(canvas, LamInk, 0.4, NULL);
}

/* Finds on which levels the slice has nodes of a kind. Returns the number of such levels. */
static PetscInt FindLevels(const LamSlice *s, LamSliceNodeKind kind, PetscBool occurs[MOST_LEVELS])
{
  PetscInt found = 0;

  for (PetscInt level = 0; level < MOST_LEVELS; level++) {
    occurs[level] = PETSC_FALSE;
    for (PetscInt i = 0; i < s->node_count && !occurs[level]; i++)
      occurs[level] = (PetscBool)(s->nodes[i].kind == kind && s->nodes[i].level == level);
    found += occurs[level];
  }
  return found;
}

static void LegendOfNodes(LamCanvas canvas, LamPen *pen, const LamSlice *s, LamSliceNodeKind kind)
{
  static const char *const labels[LAM_SLICE_NODE_KINDS] = {"node", "node on another branch", "node without an answer"};
  const PetscBool elsewhere =
      (PetscBool)(LamCellsPart(s->interface) &&
                  fabs(s->turgor + s->cohesion - s->node_suction) > 1e-9 * fabs(s->node_suction));
  PetscBool occurs[MOST_LEVELS];
  const PetscInt found = FindLevels(s, kind, occurs);
  char label[128], number[32], where[64] = "";
  double at[2], sample = 0;

  if (!found) return;
  for (PetscInt level = 0; level < MOST_LEVELS; level++)
    if (occurs[level]) sample += NodeSize(level) + 2;
  LamFormatNumber(s->node_suction, number);
  if (elsewhere) snprintf(where, sizeof where, " at %s MPa", number);
  snprintf(label, sizeof label, "%s%s%s", labels[kind], where, found > 1 ? ", coarse to fine" : "");
  LamPenEntry(canvas, pen, sample, label, PETSC_TRUE, at);
  for (PetscInt level = 0; level < MOST_LEVELS; level++) {
    if (!occurs[level]) continue;
    DrawNode(canvas, at[0] + 0.5 * NodeSize(level), at[1], kind, level);
    at[0] += NodeSize(level) + 2;
  }
}

static void DrawLegend(LamCanvas canvas, const LamSlice *s, LamPen pen)
{
  double at[2];

  for (int v = 0; v < LAM_SLICE_VERDICT_COUNT; v++) LegendOfVerdict(canvas, &pen, s, (LamSliceVerdict)v);
  for (int k = 0; k < LAM_SLICE_NODE_KINDS; k++) LegendOfNodes(canvas, &pen, s, (LamSliceNodeKind)k);
  if (isnan(s->box[0])) return;
  LamPenEntry(canvas, &pen, 14, "box of the scene's sample", PETSC_TRUE, at);
  DashedBox(canvas, (LamRect){at[0], at[1] - 3.5, 14, 7});
}

static void Arrow(LamCanvas canvas, double x, double y, double angle, double length, const char label[])
{
  const double c = cos(angle), n = -sin(angle), head = 3.2; /* the page's y points down */

  LamCanvasLine(canvas, x - length * c, y - length * n, x + length * c, y + length * n);
  for (int side = -1; side < 2; side += 2)
    LamCanvasLine(canvas, x + length * c, y + length * n, x + (length - head) * c - 0.5 * side * head * n,
                  y + (length - head) * n + 0.5 * side * head * c);
  LamCanvasStroke(canvas, LamInk, 0.9, NULL);
  LamCanvasText(canvas, x + (length + 5.5) * c, y + (length + 5.5) * n, 0.5, 0, LAM_TICK_SIZE, label);
}

/* A cell and the two principal axes. */
static void DrawGlyph(LamCanvas canvas, double x, double y, const LamSlice *s)
{
  const double radius = GLYPH * 0.8;
  cairo_t *cr = LamCanvasCairo(canvas);

  cairo_new_path(cr);
  for (int k = 0; k < 6; k++) {
    const double angle = s->orientation + M_PI / 6 + k * M_PI / 3;

    cairo_line_to(cr, x + radius * cos(angle), y - radius * sin(angle));
  }
  cairo_close_path(cr);
  LamCanvasSetColour(canvas, (LamColour){0.80, 0.90, 0.78});
  cairo_fill_preserve(cr);
  LamCanvasStroke(canvas, (LamColour){0.45, 0.55, 0.43}, 1.6, NULL);
  Arrow(canvas, x, y, s->orientation + s->angle, GLYPH, "1");
  Arrow(canvas, x, y, s->orientation + s->angle + M_PI_2, GLYPH, "2");
}

static void DrawHeader(LamCanvas canvas, const LamSlice *s)
{
  const PetscBool contact = LamCellsPart(s->interface);
  char title[256], load[32];

  LamFormatNumber(contact ? s->turgor + s->cohesion : s->turgor, load);
  snprintf(title, sizeof title, "Table of %" PetscInt_FMT " node%s: slice at %s %s MPa", s->table_nodes,
           s->table_nodes == 1 ? "" : "s", contact ? "suction" : "turgor", load);
  LamCanvasSetColour(canvas, LamInk);
  LamCanvasText(canvas, 9, 12, 0, 0, LAM_TEXT_SIZE + 0.75, title);
  DrawLegend(canvas, s, (LamPen){9, LAM_PLOT_WIDTH - 3.4 * GLYPH, 1.6 * LAM_TICK_SIZE, 9, 9, 27, LAM_TICK_SIZE});
  DrawGlyph(canvas, LAM_PLOT_WIDTH - 1.6 * GLYPH, 0.5 * HEADER + 2, s);
}

/* ---- the page ---- */

/* Two decades below the accuracy and one above it, so that pictures of tables are comparable. */
static LamColourRange ErrorRange(const LamSlice *s)
{
  const PetscReal limit = log10(100 * s->accuracy);
  LamColourRange range = {.low = limit - 2, .high = limit + 1, .is_log = PETSC_TRUE};

  for (PetscInt i = 0; i < LAM_SLICE_SAMPLES * LAM_SLICE_SAMPLES; i++) {
    if (s->value[LAM_SLICE_ERROR][i] < range.low) range.clipped[0] = PETSC_TRUE;
    if (s->value[LAM_SLICE_ERROR][i] > range.high) range.clipped[1] = PETSC_TRUE;
  }
  return range;
}

static PetscErrorCode PreparePage(LamCanvas canvas, const LamSlice *s, Page *page)
{
  char angle[32], across[32];

  PetscFunctionBeginUser;
  *page = (Page){.slice = s};
  for (int k = 0; k < LAM_SLICE_PANEL_COUNT; k++) {
    PetscCall(LamColourRangeFind(LAM_SLICE_SAMPLES * LAM_SLICE_SAMPLES, s->value[k], &page->range[k]));
    if (k == LAM_SLICE_ERROR) page->range[k] = ErrorRange(s);
    page->bar = PetscMax(page->bar, LamColourBarWidth(canvas, &page->range[k]));
  }
  LamFormatRatio(s->angle * 180 / PETSC_PI, angle);
  LamFormatRatio(s->angle * 180 / PETSC_PI + 90, across);
  snprintf(page->first, sizeof page->first, "log. strain $e$_{1}, %s° to face normal", angle);
  snprintf(page->second, sizeof page->second, "log. strain $e$_{2}, %s° to face normal", across);
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotTable(const LamPlotRequest *request, LamDatabase database)
{
  const double width = 0.5 * (LAM_PLOT_WIDTH - 18), height = FRAME + BELOW;
  LamCanvas canvas;
  LamSlice slice;
  Page page;

  PetscFunctionBeginUser;
  PetscCall(LamSliceRead(request, database, &slice));
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, HEADER + 2 * height, &canvas));
  PetscCall(PreparePage(canvas, &slice, &page));
  DrawHeader(canvas, &slice);
  for (int k = 0; k < LAM_SLICE_PANEL_COUNT; k++) {
    const LamRect outer = {9 + width * (k % 2), HEADER + height * (int)(k / 2), width, height - 6};

    PetscCall(DrawPanel(canvas, outer, &page, (LamSlicePanel)k));
  }
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(LamSliceDestroy(&slice));
  PetscFunctionReturn(0);
}
