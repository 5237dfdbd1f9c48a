/*
  The colour scale of a picture: colour map, limits, colour bar.
*/
#include "plot.h"
#include <math.h>

LamColour LamColourMap(PetscReal share)
{
  /* Matplotlib's viridis (S. van der Walt, N. Smith; CC0) as M. Zucker's polynomials of degree 6
     (shadertoy.com/view/WlfXRN; CC0), within 0.01 of the table. */
  static const PetscReal c[7][3] = {
      {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
      {0.1050930431085774, 1.404613529898575, 1.384590162594685},
      {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
      {-4.634230498983486, -5.799100973351585, -19.33244095627987},
      {6.228269936347081, 14.17993336680509, 56.69055260068105},
      {4.776384997670288, -13.74514537774601, -65.35303263337234},
      {-5.435455855934631, 4.645852612178535, 26.3124352495832},
  };
  const PetscReal s = PetscClipInterval(share, 0.0, 1.0);
  PetscReal rgb[3];

  for (int k = 0; k < 3; k++) {
    rgb[k] = c[6][k];
    for (int i = 5; i >= 0; i--) rgb[k] = rgb[k] * s + c[i][k];
    rgb[k] = PetscClipInterval(rgb[k], 0.0, 1.0);
  }
  return (LamColour){rgb[0], rgb[1], rgb[2]};
}

PetscReal LamColourShare(const LamColourRange *range, PetscReal value)
{
  return (value - range->low) / (range->high - range->low);
}

PetscErrorCode LamColourRangeFind(PetscInt n, const PetscReal values[], LamColourRange *range)
{
  PetscReal *sorted, low, high, width;
  PetscInt m = 0;

  PetscFunctionBeginUser;
  *range = (LamColourRange){.low = 0, .high = 1};
  PetscCall(PetscMalloc1(n, &sorted));
  for (PetscInt i = 0; i < n; i++)
    if (!PetscIsInfOrNanReal(values[i])) sorted[m++] = values[i];
  if (m) {
    PetscCall(PetscSortReal(m, sorted));
    low = sorted[(PetscInt)(0.01 * (m - 1))];
    high = sorted[(PetscInt)ceil(0.99 * (m - 1))];
    width = high - low;
    range->clipped[0] = (PetscBool)(sorted[0] < low - 0.15 * width && width > 0);
    range->clipped[1] = (PetscBool)(sorted[m - 1] > high + 0.15 * width && width > 0);
    range->low = range->clipped[0] ? low : sorted[0];
    range->high = range->clipped[1] ? high : sorted[m - 1];
  }
  PetscCall(PetscFree(sorted));
  width = PetscMax(PetscAbsReal(range->low), PetscAbsReal(range->high));
  if (range->high - range->low <= 1e-6 * width || width == 0) { /* constant, up to rounding */
    range->low -= width > 0 ? 0.05 * width : 1;
    range->high += width > 0 ? 0.05 * width : 1;
  }
  PetscFunctionReturn(0);
}

/* The bar is a separate axis beside the picture. */
static LamAxes BarAxes(LamRect frame, const LamColourRange *range, const char label[], const char unit[])
{
  LamAxes axes = {.frame = frame,
                  .x = {.low = 0, .high = 1},
                  .y = {range->low, range->high, label, unit, PETSC_FALSE, {0}, PETSC_FALSE}};

  axes.y.ticks = LamTicksChoose(range->low, range->high, (PetscInt)PetscMax(2, frame.height / 24), range->is_log);
  axes.y.ticks.is_log = range->is_log;
  return axes;
}

static const double BarGap = 6, BarThickness = 7, TickLength = 2.5, TextGap = 2.5, Arrow = 7;

double LamColourBarWidth(LamCanvas canvas, const LamColourRange *range)
{
  const LamRect tall = {0, 0, 1, 200}; /* a bar of usual height; shorter ones have fewer labels, not longer ones */
  const LamAxes axes = BarAxes(tall, range, "", NULL);

  return BarGap + BarThickness + TickLength + TextGap + LamTicksWidth(canvas, &axes.y.ticks) + TextGap +
         1.1 * LAM_TEXT_SIZE;
}

/* Draws the colours, with a pointed end if values lie beyond the limit. */
static void DrawBar(LamCanvas canvas, LamRect bar, const LamColourRange *range, LamColour (*map)(PetscReal share))
{
  cairo_t *cr = LamCanvasCairo(canvas);
  cairo_pattern_t *colours = cairo_pattern_create_linear(0, bar.y + bar.height, 0, bar.y);
  const double right = bar.x + bar.width, middle = bar.x + 0.5 * bar.width, bottom = bar.y + bar.height;

  for (int i = 0; i <= 32; i++) {
    const LamColour c = map(i / 32.0);

    cairo_pattern_add_color_stop_rgb(colours, i / 32.0, c.r, c.g, c.b);
  }
  cairo_move_to(cr, bar.x, bar.y);
  if (range->clipped[1]) cairo_line_to(cr, middle, bar.y - Arrow);
  cairo_line_to(cr, right, bar.y);
  cairo_line_to(cr, right, bottom);
  if (range->clipped[0]) cairo_line_to(cr, middle, bottom + Arrow);
  cairo_line_to(cr, bar.x, bottom);
  cairo_close_path(cr);
  cairo_set_source(cr, colours);
  cairo_fill_preserve(cr);
  cairo_pattern_destroy(colours);
  LamCanvasStroke(canvas, LamInk, 0.5, NULL);
}

void LamColourBar(LamCanvas canvas, LamRect frame, const LamColourRange *range, LamColour (*map)(PetscReal share),
                  const char label[], const char unit[])
{
  const LamRect bar = {frame.x + frame.width + BarGap, frame.y + (range->clipped[1] ? Arrow : 0), BarThickness,
                       frame.height - (range->clipped[0] ? Arrow : 0) - (range->clipped[1] ? Arrow : 0)};
  const LamAxes axes = BarAxes(bar, range, label, unit);
  const double right = bar.x + bar.width;
  char text[128];

  DrawBar(canvas, bar, range, map);
  for (PetscInt i = 0; i < axes.y.ticks.count; i++) {
    const double y = LamAxesY(&axes, axes.y.ticks.first + i * axes.y.ticks.step);

    LamCanvasLine(canvas, right, y, right + TickLength, y);
    LamCanvasStroke(canvas, LamInk, 0.5, NULL);
    LamTicksFormat(&axes.y.ticks, i, text);
    LamCanvasText(canvas, right + TickLength + TextGap, y, 0, 0, LAM_TICK_SIZE, text);
  }
  LamAxisLabel(&axes.y, sizeof text, text);
  LamCanvasTextFit(canvas,
                   right + TickLength + 2 * TextGap + LamTicksWidth(canvas, &axes.y.ticks) + 0.55 * LAM_TEXT_SIZE,
                   frame.y + 0.5 * frame.height, 0.5, M_PI_2, LAM_TEXT_SIZE, frame.height, text);
}
