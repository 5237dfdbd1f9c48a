/*
  Several states of a file beside each other, in one window and with common colours.
*/
#include "plot.h"

/* Points. Keys: two rows of legend. UsualBar: of a colour bar, by which the height of the page is found before there is
   a page on which its text can be measured. */
static const double Margin = 9, Gap = 8, Title = 13, Keys = 26, UsualBar = 42;

void LamFrameDraw(LamCanvas canvas, LamRect outer, const LamFrame *frame, LamView *view)
{
  const double width = LamColourBarWidth(canvas, &frame->range);

  outer.width -= width + (frame->is_open ? LamColourBarWidth(canvas, &frame->gaps) : 0);
  LamViewFit(outer, frame->box, view);
  LamColourBar(canvas, outer, &frame->range, LamColourMap, frame->label, frame->unit);
  outer.width += width;
  if (frame->is_open) LamColourBar(canvas, outer, &frame->gaps, LamGapColour, "gap", "apothems");
}

PetscInt LamStripChoose(PetscInt n, PetscInt peak, PetscInt chosen[LAM_STRIP_PANELS])
{
  const PetscInt count = PetscMin(n, LAM_STRIP_PANELS);
  PetscInt nearest = 1;

  for (PetscInt i = 0; i < count; i++) {
    chosen[i] = count > 1 ? (2 * i * (n - 1) + count - 1) / (2 * (count - 1)) : 0; /* rounded */
    if (i && i < count - 1 && PetscAbsInt(chosen[i] - peak) < PetscAbsInt(chosen[nearest] - peak)) nearest = i;
  }
  if (peak > 0 && peak < n - 1) chosen[nearest] = peak;
  return count;
}

/* Panels in rows of `columns`. */
typedef struct {
  PetscInt columns, rows;
  double width, height;
} Layout;

static double PanelWidth(const Layout *at, double bars)
{
  return (LAM_PLOT_WIDTH - 2 * Margin - bars - (double)(at->columns - 1) * Gap) / (double)at->columns;
}

static Layout Arrange(const LamStrip *strip)
{
  const PetscReal *box = strip->frame.box, shape = (box[3] - box[1]) / (box[2] - box[0]);
  Layout at = {.columns = strip->count <= LAM_STRIP_PANELS / 2 ? strip->count : (strip->count + 1) / 2};

  if (shape < 0.5) at.columns = PetscMin(2, strip->count); /* so that the colour bar's label has room */
  at.rows = (strip->count + at.columns - 1) / at.columns;
  at.width = PanelWidth(&at, strip->frame.is_open ? 2 * UsualBar : UsualBar);
  /* a slender body keeps room for titles and ticks, a single panel makes no tall page */
  at.height = PetscMin(LAM_PLOT_HEIGHT, at.width * PetscClipInterval(shape, 0.5, 1.5));
  return at;
}

static PetscErrorCode DrawPanels(LamCanvas canvas, const Layout *at, const LamStrip *strip, LamView *view)
{
  char title[256];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < strip->count; k++) {
    const LamRect panel = {Margin + (double)(k % at->columns) * (at->width + Gap),
                           Margin + Title + (double)(k / at->columns) * (at->height + Title + Gap), at->width,
                           at->height};

    LamViewFit(panel, strip->frame.box, view);
    PetscCall(strip->draw(canvas, view, strip->ctx, k, sizeof(title), title));
    LamCanvasSetColour(canvas, LamDarkInk);
    LamCanvasTextFit(canvas, panel.x, panel.y - 0.5 * Title, 0, 0, LAM_TICK_SIZE, panel.width, title);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamStripDraw(const char output[], const LamStrip *strip)
{
  Layout at = Arrange(strip);
  const double height = (double)at.rows * (at.height + Title + Gap) - Title - Gap;
  const LamRect all = {Margin, Margin + Title, LAM_PLOT_WIDTH - 2 * Margin, height};
  LamCanvas canvas;
  LamView view, whole;

  PetscFunctionBeginUser;
  PetscCall(LamCanvasCreate(output, LAM_PLOT_WIDTH, all.y + height + Keys, &canvas));
  LamFrameDraw(canvas, all, &strip->frame, &whole);
  at.width = PanelWidth(&at, all.width - whole.frame.width);
  PetscCall(DrawPanels(canvas, &at, strip, &view));
  view.frame = whole.frame; /* of the legend, at the scale of the panels */
  strip->key(canvas, &view, strip->ctx);
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}
