/*
  Cells at several states of a file, for films and strips.
*/
#include "plot_tissue.h"

PetscErrorCode LamCellsFind(const char path[], const LamPlotRecords *of, const char field[], PetscInt state,
                            LamCells *cells)
{
  char name[LAM_NAME_LENGTH];
  PetscBool has;

  PetscFunctionBeginUser;
  *cells = (LamCells){.path = path, .of = of};
  PetscCall(LamWallFieldFind(field, &cells->field));
  PetscCall(PetscMalloc1(of->n, &cells->states));
  for (PetscInt k = 0; k < of->n; k++) {
    if (state >= 0 && of->keys[k] != state) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "/fields/%" PetscInt64_FMT "/x", of->keys[k]));
    PetscCall(LamPlotHas(path, name, &has));
    if (has) cells->states[cells->count++] = k;
  }
  if (state == LAM_PLOT_LAST && cells->count) {
    cells->states[0] = cells->states[cells->count - 1];
    cells->count = 1;
  }
  PetscFunctionReturn(0);
}

void LamCellsChoose(LamCells *cells, PetscInt peak)
{
  PetscInt chosen[LAM_STRIP_PANELS], k = 0;

  while (k < cells->count - 1 && cells->states[k] < peak) k++;
  cells->count = LamStripChoose(cells->count, k, chosen);
  for (k = 0; k < cells->count; k++) cells->states[k] = cells->states[chosen[k]]; /* chosen[k] >= k */
}

PetscErrorCode LamCellsRead(const LamCells *cells, PetscInt k, LamTissue *tissue)
{
  const LamPlotRecords *of = cells->of;
  const PetscInt state = cells->states[k];
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "/fields/%" PetscInt64_FMT, of->keys[state]));
  PetscCall(LamTissueRead(cells->path, "/mesh", name, cells->field, LamCellsPart(of->micro.interface),
                          of->records[state].load.F, tissue));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCellsShare(LamCells *cells)
{
  LamFrame *frame = &cells->frame;
  PetscReal *ends;
  LamColourRange range;
  LamTissue tissue;

  PetscFunctionBeginUser;
  *frame = (LamFrame){.box = LAM_EMPTY_BOX, .label = cells->field->label, .unit = cells->field->unit};
  PetscCall(PetscMalloc1(2 * cells->count, &ends));
  for (PetscInt k = 0; k < cells->count; k++) {
    PetscCall(LamCellsRead(cells, k, &tissue));
    PetscCall(LamColourRangeFind(tissue.node_count, tissue.values, &range));
    ends[2 * k] = range.low;
    ends[2 * k + 1] = range.high;
    frame->is_open = (PetscBool)(frame->is_open || tissue.interface.is_open);
    frame->gaps.high = PetscMax(frame->gaps.high, tissue.interface.gaps.high);
    cells->has_lamella = tissue.interface.has_lamella;
    cells->pressure = PetscMax(cells->pressure, tissue.interface.largest_pressure);
    cells->is_periodic = LamTissueIsPeriodic(&tissue);
    LamBoxExtend(frame->box, tissue.node_count, tissue.x, NULL);
    PetscCall(LamTissueDestroy(&tissue));
  }
  PetscCall(LamColourRangeFind(2 * cells->count, ends, &frame->range));
  PetscCall(PetscFree(ends));
  LamBoxWiden(frame->box, LamCellsPart(cells->of->micro.interface) ? LAM_CONTACT_MARGIN : LAM_MARGIN);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCellsDraw(LamCanvas canvas, const LamView *view, const LamCells *cells, PetscInt k)
{
  LamTissue tissue;

  PetscFunctionBeginUser;
  PetscCall(LamCellsRead(cells, k, &tissue));
  tissue.interface.gaps = cells->frame.gaps;
  tissue.interface.largest_pressure = cells->pressure;
  PetscCall(LamTissueDraw(canvas, view, &tissue, &cells->frame.range, NULL));
  PetscCall(LamTissueDestroy(&tissue));
  PetscFunctionReturn(0);
}

void LamCellsKey(LamCanvas canvas, const LamView *view, const LamCells *cells)
{
  const LamInterface interface = {
      .largest_pressure = cells->pressure, .is_open = cells->frame.is_open, .has_lamella = cells->has_lamella};
  const double x = view->frame.x, y = view->frame.y + view->frame.height + 11;

  LamScaleBar(canvas, view, x, y, LAM_SCALE_BAR, 1e-6 / cells->of->scales.length, "µm");
  if (cells->is_periodic)
    LamCanvasText(canvas, x + view->frame.width, y, 1, 0, LAM_TICK_SIZE, "paler: periodic images");
  if (LamCellsPart(cells->of->micro.interface))
    LamInterfaceDrawKey(canvas, x, y + LAM_KEY_ROW, x + view->frame.width, &interface);
}

PetscErrorCode LamCellsDestroy(LamCells *cells)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(cells->states));
  PetscFunctionReturn(0);
}
