/*
  Interfaces of contact tissue in a picture: gaps between facing walls, the pressure where they touch, and the lamella.

  Gaps are strips between the two walls, coloured by their width; strips thinner than a line are drawn with a line's
  width, so that an open face never looks closed. The pressure is a ribbon along the face whose width is proportional to
  the pressure: widest at the largest value of the state, zero where the faces do not touch.

  The lamella is a line along the face, from black to white by the share of its energy that is spent: a white line
  between two outlines parts two cells. Where it still holds across a gap that is seen, threads cross the gap.
*/
#include "plot.h"
#include <math.h>
#include <stdio.h>

static const LamColour Pressure = {0.95, 0.53, 0.0};
static const double ThinnestGap = 1.1, WidestRibbon = 5; /* points */
static const double Casing = 0.3;                        /* of the lamella's line, on both sides: share of its width */
static const double Thread = 0.7, BetweenThreads = 2.6, ThinnestThread = 1.5; /* width, distance and length */
static const PetscReal Holds = 0.999; /* a lamella less broken than this is drawn across gaps */

/* Pink to dark magenta: brightness falls uniformly, and neither walls nor lines have these colours. */
LamColour LamGapColour(PetscReal share)
{
  static const PetscReal stops[3][3] = {{1.0, 0.76, 0.85}, {0.95, 0.30, 0.66}, {0.56, 0.0, 0.40}};
  const PetscReal s = 2 * PetscClipInterval(share, 0.0, 1.0);
  const int i = s < 1 ? 0 : 1;
  PetscReal rgb[3];

  for (int k = 0; k < 3; k++) rgb[k] = stops[i][k] + (s - i) * (stops[i + 1][k] - stops[i][k]);
  return (LamColour){rgb[0], rgb[1], rgb[2]};
}

/* Greys: the other colours of tissue are none. */
LamColour LamLamellaColour(PetscReal broken)
{
  const PetscReal s = PetscClipInterval(broken, 0.0, 1.0);

  return (LamColour){LamDarkInk.r + s * (1 - LamDarkInk.r), LamDarkInk.g + s * (1 - LamDarkInk.g),
                     LamDarkInk.b + s * (1 - LamDarkInk.b)};
}

/* ---- reading ---- */

/* Reads one array of samples; the first one read sets their number. */
static PetscErrorCode ReadSamples(const char path[], const char group[], const char name[], PetscInt columns,
                                  LamInterface *interface, PetscReal **values)
{
  char dataset[96];
  PetscBool found;
  PetscInt rank, dims[4] = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(dataset, sizeof dataset, "%s/interface/%s", group, name));
  PetscCall(LamFileReadReals(path, dataset, &found, &rank, dims, values));
  if (found && !interface->faces) {
    interface->faces = dims[0];
    interface->points = dims[1];
  }
  PetscCheck(found && rank == (columns > 1 ? 3 : 2) && dims[0] == interface->faces && dims[1] == interface->points &&
                 (columns == 1 || dims[2] == columns),
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is missing or damaged", path, dataset);
  PetscFunctionReturn(0);
}

PetscErrorCode LamInterfaceRead(const char path[], const char group[], LamInterface *interface)
{
  PetscReal widest = 0;
  char lamella[96];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(interface, sizeof *interface));
  PetscCall(ReadSamples(path, group, "from", 2, interface, &interface->from));
  PetscCall(ReadSamples(path, group, "to", 2, interface, &interface->to));
  PetscCall(ReadSamples(path, group, "gap", 1, interface, &interface->gap));
  PetscCall(ReadSamples(path, group, "pressure", 1, interface, &interface->pressure));
  PetscCall(PetscSNPrintf(lamella, sizeof lamella, "%s/interface/broken", group));
  PetscCall(LamPlotHas(path, lamella, &interface->has_lamella));
  if (interface->has_lamella) {
    PetscCall(ReadSamples(path, group, "across", 2, interface, &interface->across));
    PetscCall(ReadSamples(path, group, "broken", 1, interface, &interface->broken));
  }
  for (PetscInt i = 0; i < interface->faces * interface->points; i++) {
    if (interface->gap[i] > widest) widest = interface->gap[i];
    if (interface->pressure[i] > interface->largest_pressure) interface->largest_pressure = interface->pressure[i];
  }
  interface->is_open = (PetscBool)(widest > LAM_VISIBLE_GAP);
  interface->gaps = (LamColourRange){.low = 0, .high = PetscMax(widest, LAM_VISIBLE_GAP)};
  PetscFunctionReturn(0);
}

PetscErrorCode LamInterfaceDestroy(LamInterface *interface)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(interface->from));
  PetscCall(PetscFree(interface->to));
  PetscCall(PetscFree(interface->gap));
  PetscCall(PetscFree(interface->pressure));
  PetscCall(PetscFree(interface->across));
  PetscCall(PetscFree(interface->broken));
  PetscFunctionReturn(0);
}

/* ---- drawing ---- */

static void PagePoint(const LamView *view, const PetscReal x[2], const PetscReal shift[2], double point[2])
{
  LamViewPoint(view, x[0] + shift[0], x[1] + shift[1], point);
}

/* The strip between samples i and i + 1. */
static void DrawStrip(LamCanvas canvas, const LamView *view, const LamInterface *interface, const PetscReal shift[2],
                      PetscInt i)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const PetscReal gap = 0.5 * (interface->gap[i] + interface->gap[i + 1]);
  const PetscReal *corners[4] = {&interface->from[2 * i], &interface->from[2 * (i + 1)], &interface->to[2 * (i + 1)],
                                 &interface->to[2 * i]};

  cairo_new_path(cr);
  for (int k = 0; k < 4; k++) {
    double point[2];

    PagePoint(view, corners[k], shift, point);
    cairo_line_to(cr, point[0], point[1]);
  }
  cairo_close_path(cr);
  LamCanvasSetColour(canvas, LamGapColour(LamColourShare(&interface->gaps, gap)));
  cairo_fill_preserve(cr);
  cairo_stroke(cr);
}

/* Points on the page between the sides of the lamella at sample i; 0: it lies between walls that are not apart. */
static double Stretch(const LamView *view, const LamInterface *interface, const PetscReal shift[2], PetscInt i,
                      double from[2], double across[2])
{
  PagePoint(view, &interface->from[2 * i], shift, from);
  PagePoint(view, &interface->across[2 * i], shift, across);
  /* false also if a sample faces no wall */
  return interface->gap[i] <= LAM_VISIBLE_GAP ? 0 : hypot(across[0] - from[0], across[1] - from[1]);
}

/* Threads of the lamella across the gaps of a face, as far apart as they are told apart. */
static void DrawThreads(LamCanvas canvas, const LamView *view, const LamInterface *interface, const PetscReal shift[2],
                        PetscInt face)
{
  const PetscInt first = face * interface->points;
  double last[2] = {-PETSC_MAX_REAL, 0};

  for (PetscInt i = first; i < first + interface->points; i++) {
    double a[2], b[2];

    if (Stretch(view, interface, shift, i, a, b) < ThinnestThread || interface->broken[i] > Holds) continue;
    if (hypot(a[0] - last[0], a[1] - last[1]) < BetweenThreads) continue;
    LamCanvasLine(canvas, a[0], a[1], b[0], b[1]);
    LamCanvasStroke(canvas, LamLamellaColour(interface->broken[i]), Thread, NULL);
    last[0] = a[0];
    last[1] = a[1];
  }
}

void LamInterfaceDrawGaps(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                          const PetscReal shift[2])
{
  cairo_t *cr = LamCanvasCairo(canvas);

  cairo_save(cr);
  cairo_set_line_width(cr, ThinnestGap);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  for (PetscInt face = 0; face < interface->faces; face++) {
    for (PetscInt k = 0; k + 1 < interface->points; k++) {
      const PetscInt i = face * interface->points + k;

      /* false also if a sample faces no wall */
      if (interface->gap[i] + interface->gap[i + 1] > 2 * LAM_VISIBLE_GAP) DrawStrip(canvas, view, interface, shift, i);
    }
    if (interface->has_lamella) DrawThreads(canvas, view, interface, shift, face);
  }
  cairo_restore(cr);
}

/* The line between samples i and i + 1; nothing where the gap shows that it is broken, or threads are drawn. */
static void DrawPiece(LamCanvas canvas, const LamView *view, const LamInterface *interface, const PetscReal shift[2],
                      PetscInt i, double width, PetscBool casing)
{
  const PetscReal broken = 0.5 * (interface->broken[i] + interface->broken[i + 1]);
  double stretch = 0, ends[2][2], across[2];

  for (int k = 0; k < 2; k++) stretch = PetscMax(stretch, Stretch(view, interface, shift, i + k, ends[k], across));
  if (stretch >= ThinnestThread || (stretch > 0 && broken > Holds)) return;
  LamCanvasLine(canvas, ends[0][0], ends[0][1], ends[1][0], ends[1][1]);
  LamCanvasStroke(canvas, casing ? LamDarkInk : LamLamellaColour(broken), casing ? (1 + 2 * Casing) * width : width,
                  NULL);
}

void LamInterfaceDrawLamella(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                             const PetscReal shift[2], double width)
{
  cairo_t *cr = LamCanvasCairo(canvas);

  if (!interface->has_lamella) return;
  cairo_save(cr);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND); /* no gaps between pieces */
  for (PetscInt face = 0; face < interface->faces; face++) {
    for (int casing = 1; casing >= 0; casing--)
      for (PetscInt k = 0; k + 1 < interface->points; k++)
        DrawPiece(canvas, view, interface, shift, face * interface->points + k, width, (PetscBool)casing);
  }
  cairo_restore(cr);
}

/* A point of the ribbon's edge at sample k of a face, on the page; side 1: to the left of the samples' direction,
   -1. Ribbons are as much wider than zero as the lamella's line, which lies on them. */
static void RibbonEdge(const LamView *view, const LamInterface *interface, const PetscReal shift[2], PetscInt face,
                       PetscInt k, double side, double line, double edge[2])
{
  const PetscInt first = face * interface->points, i = first + k;
  const PetscInt before = first + PetscMax(k - 1, 0), after = first + PetscMin(k + 1, interface->points - 1);
  const double least = interface->pressure[i] > 0 ? line : 0;
  const double width = side * 0.5 * (least + WidestRibbon * interface->pressure[i] / interface->largest_pressure);
  double a[2], b[2], along[2], norm;

  PagePoint(view, &interface->from[2 * before], shift, a);
  PagePoint(view, &interface->from[2 * after], shift, b);
  for (int d = 0; d < 2; d++) along[d] = b[d] - a[d];
  norm = PetscMax(hypot(along[0], along[1]), 1e-30);
  PagePoint(view, &interface->from[2 * i], shift, edge);
  edge[0] += width * along[1] / norm; /* y points downwards */
  edge[1] -= width * along[0] / norm;
}

/* The ribbon of one face: along its left edge, and back along its right one. */
static void RibbonPath(LamCanvas canvas, const LamView *view, const LamInterface *interface, const PetscReal shift[2],
                       PetscInt face, double line)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const PetscInt n = interface->points;

  cairo_new_path(cr);
  for (PetscInt k = 0; k < 2 * n; k++) {
    double point[2];

    RibbonEdge(view, interface, shift, face, k < n ? k : 2 * n - 1 - k, k < n ? 1 : -1, line, point);
    cairo_line_to(cr, point[0], point[1]);
  }
  cairo_close_path(cr);
}

void LamInterfaceDrawPressure(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                              const PetscReal shift[2], double width)
{
  if (!(interface->largest_pressure > 0)) return;
  for (PetscInt face = 0; face < interface->faces; face++) {
    RibbonPath(canvas, view, interface, shift, face, interface->has_lamella ? (1 + 2 * Casing) * width : 0);
    LamCanvasFill(canvas, Pressure);
  }
}

/* "lamella: intact", a bar of its colours, "broken"; from x to the right, in the next row where it would pass `right`.
 */
static void DrawLamellaKey(LamCanvas canvas, double left, double x, double y, double right)
{
  static const char before[] = "lamella: intact", behind[] = "broken";
  const double length = 42, height = 3.6, gap = 4;
  const double start = LamCanvasTextWidth(canvas, LAM_TICK_SIZE, before) + gap,
               width = start + length + gap + LamCanvasTextWidth(canvas, LAM_TICK_SIZE, behind);
  const int steps = 64;

  if (x + width > right) {
    x = left;
    y += LAM_KEY_ROW;
  }
  LamCanvasSetColour(canvas, LamInk);
  LamCanvasText(canvas, x, y, 0, 0, LAM_TICK_SIZE, before);
  LamCanvasText(canvas, x + width, y, 1, 0, LAM_TICK_SIZE, behind);
  x += start;
  for (int i = 0; i < steps; i++) {
    LamCanvasBox(canvas, (LamRect){x + i * length / steps, y - 0.5 * height, (steps - i) * length / steps, height});
    LamCanvasFill(canvas, LamLamellaColour((i + 0.5) / steps));
  }
  LamCanvasBox(canvas, (LamRect){x, y - 0.5 * height, length, height});
  LamCanvasStroke(canvas, LamDarkInk, 0.4, NULL);
}

void LamInterfaceDrawKey(LamCanvas canvas, double left, double y, double right, const LamInterface *interface)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double length = 19;
  double x = left;
  char number[32], text[160] = "no contact";

  if (interface->largest_pressure > 0) {
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + length, y - 0.5 * WidestRibbon);
    cairo_line_to(cr, x + length, y + 0.5 * WidestRibbon);
    cairo_close_path(cr);
    LamCanvasFill(canvas, Pressure);
    LamFormatNumber(interface->largest_pressure, number);
    snprintf(text, sizeof text, "contact pressure, up to %s MPa%s", number,
             interface->is_open || interface->has_lamella ? "" : ";  no gap above 0.001 apothems");
    x += length + 4;
  }
  LamCanvasSetColour(canvas, LamInk);
  LamCanvasText(canvas, x, y, 0, 0, LAM_TICK_SIZE, text);
  if (interface->has_lamella)
    DrawLamellaKey(canvas, left, x + LamCanvasTextWidth(canvas, LAM_TICK_SIZE, text) + 12, y, right);
}
