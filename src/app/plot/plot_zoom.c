/*
  Zooms into the microstructure: the cells at selected points of the body, beside it, all at the same scale.
*/
#include "plot_fe2.h"
#include <math.h>
#include <stdio.h>

static const double Gap = 9, Marker = 3.2; /* points */

/* ---- reading ---- */

/* Sets scales common to all zooms: one colour range for stress, one for gaps, one width of pressure. */
static PetscErrorCode ShareScales(LamZooms *z)
{
  PetscReal *values, widest = 0, pressure = 0;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < z->count; k++) n += z->tissue[k].node_count;
  PetscCall(PetscMalloc1(n, &values));
  n = 0;
  for (PetscInt k = 0; k < z->count; k++) {
    const LamInterface *interface = &z->tissue[k].interface;
    PetscCall(PetscArraycpy(&values[n], z->tissue[k].values, z->tissue[k].node_count));
    n += z->tissue[k].node_count;
    if (!z->tissue[k].has_interface) continue;
    z->has_interface = PETSC_TRUE;
    if (interface->is_open) z->is_open = PETSC_TRUE;
    widest = PetscMax(widest, interface->gaps.high);
    pressure = PetscMax(pressure, interface->largest_pressure);
  }
  PetscCall(LamColourRangeFind(n, values, &z->stress));
  PetscCall(PetscFree(values));
  z->gaps = (LamColourRange){.low = 0, .high = widest};
  for (PetscInt k = 0; k < z->count; k++) {
    z->tissue[k].interface.gaps = z->gaps;
    z->tissue[k].interface.largest_pressure = pressure;
    z->tissue[k].interface.is_open = z->is_open;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadOne(const char path[], const LamWallField *field, PetscInt k, const PetscReal F[9],
                              LamTissue *tissue)
{
  char mesh[64], fields[64], samples[96];
  PetscBool has_interface;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(mesh, sizeof mesh, "/zoom/%" PetscInt_FMT "/mesh", k));
  PetscCall(PetscSNPrintf(fields, sizeof fields, "/zoom/%" PetscInt_FMT "/fields", k));
  PetscCall(PetscSNPrintf(samples, sizeof samples, "%s/interface/from", fields));
  PetscCall(LamPlotHas(path, samples, &has_interface));
  PetscCall(LamTissueRead(path, mesh, fields, field, has_interface, F, tissue));
  PetscFunctionReturn(0);
}

PetscErrorCode LamZoomsRead(const char path[], LamZooms *z)
{
  PetscBool found;
  PetscInt rank, dims[4] = {0}, *points, count;
  const LamWallField *field;
  PetscReal *F;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, "/zoom/points", &found, &rank, dims, &points));
  PetscCall(PetscFree(points));
  if (!found) PetscFunctionReturn(0);
  PetscCheck(rank == 2 && dims[0] > 0 && dims[0] <= LAM_PLOT_MAX_ZOOMS, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /zoom/points is damaged", path);
  z->count = dims[0];
  PetscCall(LamPlotReadReals(path, "/zoom/apothem", z->count, 1, &z->apothem));
  PetscCall(LamWallFieldFind(NULL, &field));
  PetscCall(LamPlotReadPoints(path, "/zoom/place", z->count, &count, &z->place));
  PetscCall(LamPlotReadPoints(path, "/zoom/position", z->count, &count, &z->position));
  PetscCall(LamPlotReadReals(path, "/zoom/F", z->count, 9, &F));
  for (PetscInt k = 0; k < z->count; k++) PetscCall(ReadOne(path, field, k + 1, &F[9 * k], &z->tissue[k]));
  PetscCall(PetscFree(F));
  PetscCall(ShareScales(z));
  PetscFunctionReturn(0);
}

PetscErrorCode LamZoomsDestroy(LamZooms *z)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < z->count; k++) PetscCall(LamTissueDestroy(&z->tissue[k]));
  PetscCall(PetscFree(z->place));
  PetscCall(PetscFree(z->apothem));
  PetscCall(PetscFree(z->position));
  PetscFunctionReturn(0);
}

/* ---- drawing ---- */

/* Half the side of a square, um, that contains every RVE and a part of its neighbours. */
static PetscReal WindowSize(const LamZooms *z)
{
  const PetscReal margin = z->has_interface ? 0.5 : 0.8;
  PetscReal half = 0;

  for (PetscInt k = 0; k < z->count; k++) {
    PetscReal box[4] = LAM_EMPTY_BOX;

    LamBoxExtend(box, z->tissue[k].node_count, z->tissue[k].x, NULL);
    half = PetscMax(half, z->apothem[k] * (0.5 * PetscMax(box[2] - box[0], box[3] - box[1]) + margin));
  }
  return half;
}

/* The view of zoom k: its RVE in the middle of the frame. */
static void ZoomView(const LamZooms *z, PetscInt k, LamRect frame, PetscReal half, LamView *view)
{
  PetscReal box[4] = LAM_EMPTY_BOX, window[4];

  LamBoxExtend(box, z->tissue[k].node_count, z->tissue[k].x, NULL);
  for (int i = 0; i < 2; i++) {
    const PetscReal middle = 0.5 * (box[i] + box[2 + i]);
    window[i] = middle - half / z->apothem[k];
    window[2 + i] = middle + half / z->apothem[k];
  }
  LamViewFit(frame, window, view);
}

/* Draws lines from the point in the body to the near corners of the frame. */
static void DrawLines(LamCanvas canvas, const LamView *body, const PetscReal x[2], LamRect frame)
{
  double point[2];

  LamViewPoint(body, x[0], x[1], point);
  for (int white = 1; white >= 0; white--) { /* white below, so that the lines are visible on dark colours */
    for (int end = 0; end < 2; end++) LamCanvasLine(canvas, point[0], point[1], frame.x, frame.y + end * frame.height);
    LamCanvasStroke(canvas, white ? LamWhite : LamDarkInk, white ? 1.3 : 0.5, NULL);
  }
}

static void DrawMarker(LamCanvas canvas, const LamView *body, const PetscReal x[2])
{
  cairo_t *cr = LamCanvasCairo(canvas);
  double point[2];

  LamViewPoint(body, x[0], x[1], point);
  cairo_rectangle(cr, point[0] - 0.5 * Marker, point[1] - 0.5 * Marker, Marker, Marker);
  LamCanvasSetColour(canvas, LamWhite);
  cairo_fill_preserve(cr);
  LamCanvasStroke(canvas, LamDarkInk, 0.9, NULL);
}

/* Prints the position of the cells in the undeformed body, in the frame's upper left corner. */
static void DrawLabel(LamCanvas canvas, LamRect frame, const PetscReal place[2])
{
  char text[64];

  snprintf(text, sizeof text, "$X$ = (%.3g, %.3g) mm", (double)place[0], (double)place[1]);
  LamCanvasBox(canvas,
               (LamRect){frame.x + 0.3, frame.y + 0.3, LamCanvasTextWidth(canvas, LAM_TICK_SIZE, text) + 6, 10});
  LamCanvasFill(canvas, LamWhite);
  LamCanvasSetColour(canvas, LamDarkInk);
  LamCanvasText(canvas, frame.x + 3, frame.y + 5.3, 0, 0, LAM_TICK_SIZE, text);
}

/* Sorts from the highest point down, so that lines to the frames do not cross. */
static void Sort(const LamZooms *z, PetscInt order[LAM_PLOT_MAX_ZOOMS])
{
  for (PetscInt k = 0; k < z->count; k++) {
    PetscInt i = k;

    for (; i > 0 && z->position[2 * order[i - 1] + 1] < z->position[2 * k + 1]; i--) order[i] = order[i - 1];
    order[i] = k;
  }
}

PetscErrorCode LamZoomsDraw(LamCanvas canvas, LamRect outer, const LamView *body, const LamZooms *z)
{
  const PetscReal half = WindowSize(z);
  LamRect all = outer;
  PetscInt order[LAM_PLOT_MAX_ZOOMS];
  LamView view = {0};

  PetscFunctionBeginUser;
  Sort(z, order);
  all.width -= LamColourBarWidth(canvas, &z->stress) + (z->is_open ? LamColourBarWidth(canvas, &z->gaps) : 0);
  const double height = (all.height - (double)(z->count - 1) * Gap) / (double)z->count;
  for (PetscInt i = 0; i < z->count; i++) {
    const LamRect frame = {all.x, all.y + (double)i * (height + Gap), all.width, height};
    const PetscInt k = order[i];
    DrawLines(canvas, body, &z->position[2 * k], frame);
    ZoomView(z, k, frame, half, &view);
    PetscCall(LamTissueDraw(canvas, &view, &z->tissue[k], &z->stress, NULL));
    DrawLabel(canvas, frame, &z->place[2 * k]);
  }
  for (PetscInt k = 0; k < z->count; k++) DrawMarker(canvas, body, &z->position[2 * k]);
  LamColourBar(canvas, all, &z->stress, LamColourMap, "largest principal Cauchy stress of walls", "MPa");
  LamScaleBar(canvas, &view, all.x, all.y + all.height + 11, LAM_SCALE_BAR, 1 / z->apothem[order[z->count - 1]], "µm");
  if (z->has_interface)
    LamInterfaceDrawKey(canvas, all.x, all.y + all.height + 11 + LAM_KEY_ROW, outer.x + outer.width,
                        &z->tissue[0].interface);
  if (!z->is_open) PetscFunctionReturn(0);
  all.width += LamColourBarWidth(canvas, &z->stress);
  LamColourBar(canvas, all, &z->gaps, LamGapColour, "gap", "apothems");
  PetscFunctionReturn(0);
}
