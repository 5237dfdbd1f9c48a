/*
  Axes with round ticks, curves with markers, legends.
*/
#include "plot.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Faint = {0.87, 0.87, 0.87};
static const double TickLength = 2.5, Gap = 3.0, Dash[2] = {3.2, 1.8}, MarkDash[2] = {1.2, 1.8};

LamTicks LamTicksChoose(PetscReal low, PetscReal high, PetscInt wanted, PetscBool whole)
{
  LamTicks ticks = {.first = low, .step = high - low, .count = 1};
  const PetscReal raw = (high - low) / PetscMax(wanted, 1);
  const PetscReal largest = PetscMax(PetscAbsReal(low), PetscAbsReal(high));
  PetscReal power, share;

  if (!(raw > 1e-290) || PetscIsInfOrNanReal(raw)) return ticks; /* powers of ten would underflow */
  power = PetscPowReal(10, PetscFloorReal(PetscLog10Real(raw)));
  share = raw / power;
  ticks.step = power * (share < 1.5 ? 1 : share < 3 ? 2 : share < 7 ? 5 : 10);
  if (whole) ticks.step = PetscMax(ticks.step, 1);
  /* Rounding must not remove a tick at the limit itself. */
  ticks.first = ticks.step * PetscCeilReal(low / ticks.step - 1e-9);
  ticks.count = 1 + (PetscInt)PetscFloorReal((high - ticks.first) / ticks.step + 1e-9);
  if (!whole && (largest < 2e-3 || largest >= 1e4))
    ticks.exponent = 3 * (PetscInt)PetscFloorReal(PetscLog10Real(largest) / 3 + 1e-9);
  ticks.decimals =
      PetscMax(0, -(PetscInt)PetscFloorReal(PetscLog10Real(ticks.step * PetscPowReal(10, -ticks.exponent)) + 1e-9));
  return ticks;
}

void LamTicksFormat(const LamTicks *ticks, PetscInt i, char text[32])
{
  PetscReal value = (ticks->first + i * ticks->step) * PetscPowReal(10, -ticks->exponent);

  if (ticks->is_log) {
    if (value > -3.5 && value < 4.5)
      snprintf(text, 32, "%g", (double)PetscPowReal(10, value));
    else
      snprintf(text, 32, "10^{%s%g}", value < 0 ? "\u2212" : "", (double)PetscAbsReal(value));
    return;
  }
  if (PetscAbsReal(value) < 1e-6 * ticks->step * PetscPowReal(10, -ticks->exponent)) value = 0;
  snprintf(text, 32, "%s%.*f", value < 0 ? "\u2212" : "", (int)ticks->decimals, (double)PetscAbsReal(value));
}

void LamAxisPad(LamAxis *axis)
{
  PetscReal range;

  if (!(axis->low <= axis->high)) axis->low = 0, axis->high = 1; /* no finite point */
  range = axis->high - axis->low;
  if (range <= 1e-9 * PetscMax(PetscAbsReal(axis->low), PetscAbsReal(axis->high)) || range < 1e-300) {
    const PetscReal half = axis->whole || axis->low == 0 ? 1 : 0.5 * PetscAbsReal(axis->low);

    axis->low -= half;
    axis->high += half;
    return;
  }
  axis->low -= 0.06 * range;
  axis->high += 0.06 * range;
}

void LamAxisPadLog(LamAxis *axis)
{
  if (!(axis->low <= axis->high)) axis->low = axis->high = 0; /* no finite point */
  axis->low = PetscFloorReal(axis->low - 0.04);
  axis->high = PetscMax(axis->low + 1, PetscCeilReal(axis->high + 0.04));
}

void LamAxisLabel(const LamAxis *axis, size_t size, char text[])
{
  char power[32] = "";

  if (axis->ticks.exponent)
    snprintf(power, sizeof power, "10^{%s%d}", axis->ticks.exponent < 0 ? "\u2212" : "",
             abs((int)axis->ticks.exponent));
  if (axis->unit)
    snprintf(text, size, "%s (%s%s%s)", axis->label, power, *power ? " " : "", axis->unit);
  else if (*power)
    snprintf(text, size, "%s (%s)", axis->label, power);
  else
    snprintf(text, size, "%s", axis->label);
}

double LamTicksWidth(LamCanvas canvas, const LamTicks *ticks)
{
  double widest = 0;
  char text[32];

  for (PetscInt i = 0; i < ticks->count; i++) {
    LamTicksFormat(ticks, i, text);
    widest = PetscMax(widest, LamCanvasTextWidth(canvas, LAM_TICK_SIZE, text));
  }
  return widest;
}

static LamTicks ChooseTicks(const LamAxis *axis, PetscInt wanted)
{
  LamTicks ticks = LamTicksChoose(axis->low, axis->high, wanted, (PetscBool)(axis->whole || axis->is_log));

  ticks.is_log = axis->is_log;
  return ticks;
}

void LamAxesLayout(LamCanvas canvas, LamRect outer, LamAxes *axes)
{
  const double below = TickLength + Gap + LAM_TICK_SIZE + Gap + LAM_TEXT_SIZE;
  double left, right;
  PetscInt wanted;

  axes->frame.y = outer.y + 0.5 * LAM_TICK_SIZE;
  axes->frame.height = outer.height - 0.5 * LAM_TICK_SIZE - below;
  axes->y.ticks = ChooseTicks(&axes->y, (PetscInt)PetscMax(2, axes->frame.height / 26));
  left = LAM_TEXT_SIZE + Gap + 1 + LamTicksWidth(canvas, &axes->y.ticks) + Gap + TickLength;
  wanted = (PetscInt)PetscMax(2, (outer.width - left) / 28);
  do { /* labels need a gap of half a label between them */
    axes->x.ticks = ChooseTicks(&axes->x, wanted);
    right = 0.5 * LamTicksWidth(canvas, &axes->x.ticks);
  } while (--wanted > 1 && 3.0 * right * axes->x.ticks.count > outer.width - left - right);
  axes->frame.x = outer.x + left;
  axes->frame.width = outer.width - left - right;
}

double LamAxesX(const LamAxes *axes, PetscReal x)
{
  return axes->frame.x + axes->frame.width * (x - axes->x.low) / (axes->x.high - axes->x.low);
}

double LamAxesY(const LamAxes *axes, PetscReal y)
{
  return axes->frame.y + axes->frame.height * (1 - (y - axes->y.low) / (axes->y.high - axes->y.low));
}

void LamAxesPath(LamCanvas canvas, const LamAxes *axes, PetscReal x, PetscReal y, PetscBool joined)
{
  (joined ? cairo_line_to : cairo_move_to)(LamCanvasCairo(canvas), LamAxesX(axes, x), LamAxesY(axes, y));
}

void LamAxesMark(LamCanvas canvas, const LamAxes *axes, PetscReal x, LamColour colour, PetscBool dashed,
                 const char text[])
{
  const double at = LamAxesX(axes, x), top = axes->frame.y;

  LamCanvasLine(canvas, at, top + axes->frame.height, at, top);
  LamCanvasStroke(canvas, colour, 0.8, dashed ? MarkDash : NULL);
  for (int k = 0; k < 6 && text; k++) { /* left and right of the line, at the top, in the middle, at the bottom */
    const double align = 1 - 0.5 * (k / 2), y = top + 3 + 0.5 * (k / 2) * (axes->frame.height - 6);
    const double side = k % 2 ? at + 5 : at - 5;

    if (side < axes->frame.x + 4 || side > axes->frame.x + axes->frame.width - 4) continue;
    if (LamCanvasTextFree(canvas, side, y, align, M_PI_2, LAM_TICK_SIZE, text)) return;
  }
}

void LamAxesEmpty(LamAxes *axes)
{
  axes->x.low = axes->y.low = PETSC_INFINITY;
  axes->x.high = axes->y.high = -PETSC_INFINITY;
}

void LamAxesExtend(LamAxes *axes, PetscReal x, PetscReal y)
{
  if (!isfinite(x) || !isfinite(y)) return;
  axes->x.low = PetscMin(axes->x.low, x);
  axes->x.high = PetscMax(axes->x.high, x);
  axes->y.low = PetscMin(axes->y.low, y);
  axes->y.high = PetscMax(axes->y.high, y);
}

/* Ticks and labels of the x axis (horizontal) or the y axis, and light grid lines across the frame. */
static void DrawTicks(LamCanvas canvas, const LamAxes *axes, PetscBool horizontal)
{
  const LamRect f = axes->frame;
  const double bottom = f.y + f.height;
  const LamTicks *ticks = horizontal ? &axes->x.ticks : &axes->y.ticks;

  for (PetscInt i = 0; i < ticks->count; i++) {
    const PetscReal value = ticks->first + i * ticks->step;
    const PetscBool zero = (PetscBool)(!ticks->is_log && PetscAbsReal(value) < 1e-9 * ticks->step); /* is emphasised */
    const double at = horizontal ? LamAxesX(axes, value) : LamAxesY(axes, value);
    char text[32];

    if (horizontal)
      LamCanvasLine(canvas, at, f.y, at, bottom);
    else
      LamCanvasLine(canvas, f.x, at, f.x + f.width, at);
    LamCanvasStroke(canvas, Faint, zero ? 1.0 : 0.4, NULL);
    if (horizontal)
      LamCanvasLine(canvas, at, bottom, at, bottom + TickLength);
    else
      LamCanvasLine(canvas, f.x - TickLength, at, f.x, at);
    LamCanvasStroke(canvas, LamInk, 0.6, NULL);
    LamTicksFormat(ticks, i, text);
    if (horizontal)
      LamCanvasText(canvas, at, bottom + TickLength + Gap + 0.4 * LAM_TICK_SIZE, 0.5, 0, LAM_TICK_SIZE, text);
    else
      LamCanvasText(canvas, f.x - TickLength - Gap, at, 1, 0, LAM_TICK_SIZE, text);
  }
}

/* Short ticks at 2, 3, ..., 9 times each power of ten, if ticks are at powers of ten. */
static void DrawMinorTicks(LamCanvas canvas, const LamAxes *axes, PetscBool horizontal)
{
  const LamAxis *axis = horizontal ? &axes->x : &axes->y;
  const double left = axes->frame.x, bottom = axes->frame.y + axes->frame.height;

  if (!axis->is_log || axis->ticks.step != 1) return;
  for (PetscReal power = PetscFloorReal(axis->low); power < axis->high; power++)
    for (int digit = 2; digit < 10; digit++) {
      const PetscReal value = power + PetscLog10Real(digit);
      const double at = horizontal ? LamAxesX(axes, value) : LamAxesY(axes, value);

      if (value < axis->low || value > axis->high) continue;
      if (horizontal)
        LamCanvasLine(canvas, at, bottom, at, bottom + 0.5 * TickLength);
      else
        LamCanvasLine(canvas, left - 0.5 * TickLength, at, left, at);
    }
  LamCanvasStroke(canvas, LamInk, 0.4, NULL);
}

void LamAxesFrame(LamCanvas canvas, const LamAxes *axes)
{
  LamCanvasBox(canvas, axes->frame);
  LamCanvasStroke(canvas, LamInk, 0.6, NULL);
}

void LamAxesDraw(LamCanvas canvas, const LamAxes *axes)
{
  const LamRect f = axes->frame;
  char label[128];

  for (int y = 0; y < 2; y++) DrawTicks(canvas, axes, (PetscBool)!y);
  for (int y = 0; y < 2; y++) DrawMinorTicks(canvas, axes, (PetscBool)!y);
  LamAxesFrame(canvas, axes);
  LamAxisLabel(&axes->x, sizeof label, label);
  LamCanvasTextFit(canvas, f.x + 0.5 * f.width,
                   f.y + f.height + TickLength + Gap + LAM_TICK_SIZE + Gap + 0.4 * LAM_TEXT_SIZE, 0.5, 0, LAM_TEXT_SIZE,
                   f.width, label);
  LamAxisLabel(&axes->y, sizeof label, label);
  LamCanvasTextFit(canvas,
                   f.x - TickLength - Gap - LamTicksWidth(canvas, &axes->y.ticks) - Gap - 1 - 0.5 * LAM_TEXT_SIZE,
                   f.y + 0.5 * f.height, 0.5, M_PI_2, LAM_TEXT_SIZE, f.height, label);
}

PetscErrorCode LamSeriesCreate(PetscInt n, LamSeries *series)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(series, sizeof *series));
  series->n = n;
  PetscCall(PetscCalloc2(n, &series->x, n, &series->y));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSeriesDestroy(LamSeries *series)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(series->x, series->y));
  PetscFunctionReturn(0);
}

void LamSeriesExtend(const LamSeries *series, LamAxes *axes)
{
  for (PetscInt i = 0; i < series->n; i++) LamAxesExtend(axes, series->x[i], series->y[i]);
}

static PetscBool Finite(const LamSeries *series, PetscInt i)
{
  return (PetscBool)(isfinite(series->x[i]) && isfinite(series->y[i]));
}

void LamSeriesDraw(LamCanvas canvas, const LamAxes *axes, const LamSeries *series)
{
  const LamStyle *style = &series->style;
  const PetscInt stride = style->line && series->n > 40 ? (series->n + 19) / 20 : 1;
  const double size = series->n > 300 ? 2.4 : 3.8;

  for (PetscInt i = 0; i < series->n && style->line; i++)
    if (Finite(series, i))
      LamAxesPath(canvas, axes, series->x[i], series->y[i], (PetscBool)(i && Finite(series, i - 1)));
  LamCanvasStroke(canvas, style->colour, 1.0, style->dashed ? Dash : NULL);
  if (style->marker == LAM_MARKER_COUNT) return; /* line only */
  for (PetscInt i = 0; i < series->n; i++) {
    if (!Finite(series, i) || (i % stride && i != series->n - 1)) continue;
    LamCanvasMarker(canvas, LamAxesX(axes, series->x[i]), LamAxesY(axes, series->y[i]), size, style->marker,
                    style->hollow);
  }
}

LamPen LamPenStart(LamRect outer, double row, double space)
{
  return (LamPen){outer.x, outer.x + outer.width, row, space, outer.x, outer.y + 0.5 * row, LAM_TICK_SIZE};
}

void LamPenEntry(LamCanvas canvas, LamPen *pen, double sample, const char label[], PetscBool draw, double at[2])
{
  const double room = pen->right - pen->left - sample - Gap;
  const double width = sample + Gap + PetscMin(room, LamCanvasTextWidth(canvas, pen->size, label));

  if (pen->x > pen->left && pen->x + width > pen->right) {
    pen->x = pen->left;
    pen->y += pen->row;
  }
  at[0] = pen->x;
  at[1] = pen->y;
  LamCanvasSetColour(canvas, LamInk);
  if (draw) LamCanvasTextFit(canvas, pen->x + sample + Gap, pen->y, 0, 0, pen->size, room, label);
  pen->x += width + pen->space;
}

double LamLegend(LamCanvas canvas, LamRect outer, double size, PetscInt n, const LamSeries series[], PetscBool draw)
{
  LamPen pen = LamPenStart(outer, 1.5 * size, 7);
  double at[2];

  pen.size = size;
  for (PetscInt i = 0; i < n; i++) {
    const LamStyle *style = &series[i].style;
    const double sample = style->line ? 14 : 6;

    if (!series[i].label[0]) continue;
    LamPenEntry(canvas, &pen, sample, series[i].label, draw, at);
    if (!draw) continue;
    if (style->line) LamCanvasLine(canvas, at[0], at[1], at[0] + sample, at[1]);
    LamCanvasStroke(canvas, style->colour, 1.0, style->dashed ? Dash : NULL);
    if (style->marker != LAM_MARKER_COUNT)
      LamCanvasMarker(canvas, at[0] + 0.5 * sample, at[1], 3.8, style->marker, style->hollow);
  }
  return pen.x > outer.x ? pen.y + 0.5 * pen.row - outer.y : 0;
}

void LamChart(LamCanvas canvas, LamRect outer, LamAxes *axes, PetscInt n, const LamSeries series[])
{
  LamRect place = outer;
  double legend, size = LAM_TICK_SIZE;

  LamAxesEmpty(axes);
  for (PetscInt i = 0; i < n; i++) LamSeriesExtend(&series[i], axes);
  LamAxisPad(&axes->x);
  LamAxisPad(&axes->y);
  LamAxesLayout(canvas, outer, axes); /* the legend is as wide as the frame */
  place.x = axes->frame.x;
  place.width = axes->frame.width;
  /* many sides with long names: smaller text, down to 3 points, leaves most of the height to the curves */
  while (size > 3 && LamLegend(canvas, place, size, n, series, PETSC_FALSE) > 0.3 * outer.height) size *= 0.9;
  legend = LamLegend(canvas, place, size, n, series, PETSC_FALSE) + Gap;
  LamAxesLayout(canvas, (LamRect){outer.x, outer.y + legend, outer.width, outer.height - legend}, axes);
  LamLegend(canvas, place, size, n, series, PETSC_TRUE);
  LamAxesDraw(canvas, axes);
  for (PetscInt i = 0; i < n; i++) LamSeriesDraw(canvas, axes, &series[i]);
}
