/*
  Interfaces of contact tissue in a picture: gaps between facing walls, and the pressure where they touch.

  Gaps are strips between the two walls, coloured by their width; strips thinner than a line are drawn with a line's
  width, so that an open face never looks closed. The pressure is a ribbon along the face whose width is proportional to
  the pressure: widest at the largest value of the state, zero where the faces do not touch.
*/
#include "plot.h"
#include <math.h>
#include <stdio.h>

static const LamColour Pressure = {0.95, 0.53, 0.0};
static const double ThinnestGap = 1.1, WidestRibbon = 5; /* points */

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

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(interface, sizeof *interface));
  PetscCall(ReadSamples(path, group, "from", 2, interface, &interface->from));
  PetscCall(ReadSamples(path, group, "to", 2, interface, &interface->to));
  PetscCall(ReadSamples(path, group, "gap", 1, interface, &interface->gap));
  PetscCall(ReadSamples(path, group, "pressure", 1, interface, &interface->pressure));
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
  }
  cairo_restore(cr);
}

/* A point of the ribbon's edge at sample k of a face, on the page; side 1: to the left of the samples' direction,
   -1. */
static void RibbonEdge(const LamView *view, const LamInterface *interface, const PetscReal shift[2], PetscInt face,
                       PetscInt k, double side, double edge[2])
{
  const PetscInt first = face * interface->points, i = first + k;
  const PetscInt before = first + PetscMax(k - 1, 0), after = first + PetscMin(k + 1, interface->points - 1);
  const double width = side * 0.5 * WidestRibbon * interface->pressure[i] / interface->largest_pressure;
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
                       PetscInt face)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const PetscInt n = interface->points;

  cairo_new_path(cr);
  for (PetscInt k = 0; k < 2 * n; k++) {
    double point[2];

    RibbonEdge(view, interface, shift, face, k < n ? k : 2 * n - 1 - k, k < n ? 1 : -1, point);
    cairo_line_to(cr, point[0], point[1]);
  }
  cairo_close_path(cr);
}

void LamInterfaceDrawPressure(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                              const PetscReal shift[2])
{
  if (!(interface->largest_pressure > 0)) return;
  for (PetscInt face = 0; face < interface->faces; face++) {
    RibbonPath(canvas, view, interface, shift, face);
    LamCanvasFill(canvas, Pressure);
  }
}

void LamInterfaceDrawKey(LamCanvas canvas, double x, double y, const LamInterface *interface)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double length = 19;
  char number[32], text[160] = "no contact";

  if (interface->largest_pressure > 0) {
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + length, y - 0.5 * WidestRibbon);
    cairo_line_to(cr, x + length, y + 0.5 * WidestRibbon);
    cairo_close_path(cr);
    LamCanvasFill(canvas, Pressure);
    LamFormatNumber(interface->largest_pressure, number);
    snprintf(text, sizeof text, "contact pressure, up to %s MPa%s", number,
             interface->is_open ? "" : ";  no gap above 0.001 apothems");
    x += length + 4;
  }
  LamCanvasSetColour(canvas, LamInk);
  LamCanvasText(canvas, x, y, 0, 0, LAM_TICK_SIZE, text);
}
