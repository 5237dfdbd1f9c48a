/*
  Pictures of a process: quantities against time, the same beside the cells of a state, films of these, and the path of
  the tissue on a map of its failure.
*/
#include "plot_process.h"
#include "plot_map.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Ink = {0.12, 0.12, 0.16}, Now = {0.75, 0.1, 0.1};

/* ---- the four charts ---- */

/* Adds a member of the records. */
static PetscErrorCode AddMember(LamTimeChart *chart, const LamProcessPicture *p, size_t offset, PetscReal factor,
                                const char label[])
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->n, &values));
  for (PetscInt k = 0; k < p->n; k++)
    values[k] = factor * *(const PetscReal *)(const void *)((const char *)&p->records[k] + offset);
  PetscCall(LamTimeChartAdd(chart, &p->line, values, label));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeFirmness(const LamProcessPicture *p, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "firmness $E$", .unit = "MPa"}};
  PetscCall(LamTimeChartAdd(chart, &p->line, p->firmness, ""));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakePressures(const LamProcessPicture *p, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "pressure", .unit = "MPa"}};
  PetscCall(LamTimeChartAdd(chart, &p->line, p->turgor, "turgor"));
  if (isfinite(p->osmotic[0])) PetscCall(LamTimeChartAdd(chart, &p->line, p->osmotic, "osmotic, in cells"));
  if (isfinite(p->osmotic[0])) PetscCall(LamTimeChartAdd(chart, &p->line, p->outside, "outside"));
  if (p->micro.interface == LAM_INTERFACE_CONTACT) PetscCall(LamTimeChartAdd(chart, &p->line, p->cohesion, "cohesion"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeFactors(const LamProcessPicture *p, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the start"}};
  for (PetscInt k = 0; k < p->factor_count; k++)
    PetscCall(LamTimeChartAdd(chart, &p->line, p->factor[k], p->factor_name[k]));
  if (!p->factor_count)
    PetscCall(AddMember(chart, p, offsetof(LamResponse, lumen_fraction), 1 / p->records[0].lumen_fraction, "lumen"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeSeparation(const LamProcessPicture *p, LamTimeChart *chart)
{
  const PetscBool contact = (PetscBool)(p->micro.interface == LAM_INTERFACE_CONTACT);
  const PetscReal MPa = p->scales.stress * 1e-6;
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the interface"}};
  if (contact) {
    PetscCall(AddMember(chart, p, offsetof(LamResponse, debonded_fraction), 1, "debonded"));
    PetscCall(AddMember(chart, p, offsetof(LamResponse, open_fraction), 1, "open"));
  } else if (p->ratio_count) {
    chart->axes.y.label = "stress over strength";
    for (PetscInt k = 0; k < p->ratio_count; k++)
      PetscCall(LamTimeChartAdd(chart, &p->line, p->ratio[k], p->ratio_name[k]));
  } else {
    chart->axes.y = (LamAxis){.label = "stress", .unit = "MPa"};
    PetscCall(AddMember(chart, p, offsetof(LamResponse, max_traction), MPa, "lamella traction"));
    PetscCall(AddMember(chart, p, offsetof(LamResponse, max_wall_tension), MPa, "wall tension"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessDraw(LamCanvas canvas, LamRect outer, const LamProcessPicture *p, PetscInt now)
{
  LamTimeChart charts[4];

  PetscFunctionBeginUser;
  PetscCall(MakeFirmness(p, &charts[0]));
  PetscCall(MakePressures(p, &charts[1]));
  PetscCall(MakeFactors(p, &charts[2]));
  PetscCall(MakeSeparation(p, &charts[3]));
  PetscCall(LamTimeChartsDraw(canvas, outer, &p->line, charts, now));
  PetscFunctionReturn(0);
}

/* ---- pages ---- */

static PetscErrorCode PlotCharts(const LamPlotRequest *request, const LamProcessPicture *p)
{
  const LamRect outer = {9, 9, LAM_PLOT_WIDTH - 18, LAM_TIME_HEIGHT - 15};
  LamCanvas canvas;

  PetscFunctionBeginUser;
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_TIME_HEIGHT, &canvas));
  PetscCall(LamProcessDraw(canvas, outer, p, -1));
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

/* ---- films ---- */

/* Shared by all frames: the window, and the colour range. */
typedef struct {
  const LamWallField *field;
  PetscReal box[4];
  LamColourRange range;
  PetscInt count, *states; /* states whose cells are in the file; owned */
} Film;

static PetscErrorCode HasCells(const LamProcessPicture *p, PetscInt state, PetscBool *has)
{
  PetscInt rank, dims[4];
  char name[LAM_NAME_LENGTH];
  PetscReal *x = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "/fields/%" PetscInt_FMT "/x", state));
  PetscCall(LamFileReadReals(p->path, name, has, &rank, dims, &x));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadCells(const LamProcessPicture *p, const Film *film, PetscInt state, LamTissue *tissue)
{
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "/fields/%" PetscInt_FMT, state));
  PetscCall(LamTissueRead(p->path, "/mesh", name, film->field, (PetscBool)(p->micro.interface == LAM_INTERFACE_CONTACT),
                          p->records[state].load.F, tissue));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindStates(const LamPlotRequest *request, const LamProcessPicture *p, Film *film)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->n, &film->states));
  for (PetscInt k = 0; k < p->n; k++) {
    PetscBool has;

    if (request->state >= 0 && k != request->state) continue;
    PetscCall(HasCells(p, k, &has));
    if (has) film->states[film->count++] = k;
  }
  PetscCheck(film->count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no cells%s to draw; lamella process with --frames N keeps them", p->path,
             request->state >= 0 ? " of this state" : "");
  PetscFunctionReturn(0);
}

/* One colour scale and one window for all frames. */
static PetscErrorCode FindRange(const LamProcessPicture *p, Film *film)
{
  const PetscReal none[2] = {0, 0}, margin = 1.1;
  PetscReal *ends;
  LamTissue tissue;

  PetscFunctionBeginUser;
  LamBoxEmpty(film->box);
  PetscCall(PetscMalloc1(2 * film->count, &ends));
  for (PetscInt k = 0; k < film->count; k++) {
    LamColourRange range;

    PetscCall(ReadCells(p, film, film->states[k], &tissue));
    PetscCall(LamColourRangeFind(tissue.node_count, tissue.values, &range));
    ends[2 * k] = range.low;
    ends[2 * k + 1] = range.high;
    LamBoxExtend(film->box, tissue.node_count, tissue.x, none);
    PetscCall(LamTissueDestroy(&tissue));
  }
  PetscCall(LamColourRangeFind(2 * film->count, ends, &film->range));
  PetscCall(PetscFree(ends));
  for (int k = 0; k < 2; k++) {
    film->box[k] -= margin;
    film->box[2 + k] += margin;
  }
  PetscFunctionReturn(0);
}

#define CELLS_WIDTH 210.0

static PetscErrorCode DrawFrame(LamCanvas canvas, const LamProcessPicture *p, const Film *film, PetscInt state)
{
  const LamRect charts = {CELLS_WIDTH + 30, 18, LAM_PLOT_WIDTH - CELLS_WIDTH - 39, LAM_TIME_HEIGHT - 24};
  LamRect cells = {9, 30, CELLS_WIDTH - LamColourBarWidth(canvas, &film->range), LAM_TIME_HEIGHT - 60};
  char title[256], event[LAM_NAME_LENGTH], number[32];
  LamTissue tissue;
  LamView view;

  PetscFunctionBeginUser;
  LamFormatNumber(p->line.time[state] / p->line.seconds, number);
  LamTimeEventName(&p->line, state, sizeof(event), event);
  PetscCall(PetscSNPrintf(title, sizeof(title), "%s %s%s%s", number, p->line.unit, event[0] ? ": " : "", event));
  LamCanvasSetColour(canvas, Ink);
  LamCanvasText(canvas, cells.x, 14, 0, 0, LAM_TEXT_SIZE + 0.75, title);
  PetscCall(ReadCells(p, film, state, &tissue));
  LamViewFit(cells, film->box, &view);
  PetscCall(LamTissueDraw(canvas, &view, &tissue, &film->range, NULL));
  LamColourBar(canvas, cells, &film->range, LamColourMap, film->field->label, film->field->unit);
  LamScaleBar(canvas, &view, cells.x, cells.y + cells.height + 11, 0.25 * cells.width, 1e-6 / p->scales.length, "µm");
  if (tissue.has_interface) LamInterfaceDrawKey(canvas, cells.x, cells.y + cells.height + 21, &tissue.interface);
  PetscCall(LamTissueDestroy(&tissue));
  PetscCall(LamProcessDraw(canvas, charts, p, state));
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawFilm(const LamPlotRequest *request, const LamProcessPicture *p, const Film *film)
{
  const PetscBool pages = LamCanvasHasPages(request->output), single = (PetscBool)(film->count == 1);
  char name[PETSC_MAX_PATH_LEN];
  LamCanvas canvas = NULL;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < film->count; k++) {
    PetscCall(PetscStrncpy(name, request->output, sizeof(name)));
    if (!pages && !single) PetscCall(LamFrameName(request->output, k + 1, sizeof(name), name));
    if (!canvas)
      PetscCall(LamCanvasCreate(name, LAM_PLOT_WIDTH, LAM_TIME_HEIGHT, &canvas));
    else
      LamCanvasNextPage(canvas);
    PetscCall(DrawFrame(canvas, p, film, film->states[k]));
    if (!pages) PetscCall(LamCanvasFinish(&canvas));
  }
  if (canvas) PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlotFilm(const LamPlotRequest *request, const LamProcessPicture *p)
{
  Film film = {0};

  PetscFunctionBeginUser;
  PetscCall(LamWallFieldFind(request->field, &film.field));
  PetscCall(FindStates(request, p, &film));
  PetscCall(FindRange(p, &film));
  PetscCall(DrawFilm(request, p, &film));
  PetscCall(PetscFree(film.states));
  PetscFunctionReturn(0);
}

/* ---- the path on a map ---- */

/* The quantity of a process for an axis of the map; NULL: it has none. The map is for the initial walls: when all
   wall moduli have become s times the initial ones, tissue fails as the initial tissue does at p / s and g / s. */
static const PetscReal *AlongSide(const LamProcessPicture *p, const LamMapSide *side)
{
  if (!strcmp(side->quantity, "turgor")) return p->turgor;
  return !strcmp(side->quantity, "cohesion") ? p->cohesion : NULL;
}

/* Position of state k on an axis. */
static double OnSide(const LamProcessPicture *p, const LamMapSide *side, PetscInt k)
{
  const PetscReal value = AlongSide(p, side)[k] / p->walls[k];

  return side->is_log ? log10(value) : value;
}

static void DrawWay(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *map, const LamProcessPicture *p)
{
  const LamRect f = axes->frame;
  cairo_t *cr = LamCanvasCairo(canvas);
  char name[LAM_NAME_LENGTH];

  cairo_save(cr);
  cairo_rectangle(cr, f.x, f.y, f.width, f.height);
  cairo_clip(cr);
  LamCanvasSetColour(canvas, Now);
  cairo_set_line_width(cr, 1.3);
  for (PetscInt k = 0; k < p->n; k++)
    (k ? cairo_line_to : cairo_move_to)(cr, LamAxesX(axes, OnSide(p, &map->x, k)),
                                        LamAxesY(axes, OnSide(p, &map->y, k)));
  cairo_stroke(cr);
  for (PetscInt k = 0; k < p->n; k++) {
    const double at[2] = {LamAxesX(axes, OnSide(p, &map->x, k)), LamAxesY(axes, OnSide(p, &map->y, k))};
    const PetscBool ends = (PetscBool)(k == 0 || k == p->n - 1);

    LamTimeEventName(&p->line, k, sizeof(name), name);
    if (!ends && !name[0]) continue;
    LamCanvasSetColour(canvas, Now);
    LamCanvasMarker(canvas, at[0], at[1], 4.2, name[0] ? LAM_MARKER_DIAMOND : LAM_MARKER_CIRCLE, (PetscBool)(k > 0));
    LamCanvasSetColour(canvas, Ink);
    LamCanvasText(canvas, at[0] + 5, at[1] - 5, 0, 0, LAM_TICK_SIZE, name[0] ? name : k ? "end" : "start");
  }
  cairo_restore(cr);
}

static PetscErrorCode PlotWay(const LamPlotRequest *request, const LamProcessPicture *p)
{
  const LamPlotRequest of_map = {.input = request->map, .state = -1};
  const double width = 0.55 * LAM_PLOT_WIDTH;
  LamMapPicture map;
  LamCanvas canvas;
  LamAxes axes;

  PetscFunctionBeginUser;
  PetscCall(LamMapPictureRead(&of_map, &map));
  PetscCheck(AlongSide(p, &map.x) && AlongSide(p, &map.y) && strcmp(map.x.quantity, map.y.quantity), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "--map %s: is of %s and %s; the way of a process is drawn over turgor and cohesion",
             request->map, map.x.quantity, map.y.quantity);
  PetscCall(LamCanvasCreate(request->output, width, LAM_PLOT_HEIGHT, &canvas));
  PetscCall(LamMapDrawModes(canvas, (LamRect){9, 6, width - 18, LAM_PLOT_HEIGHT - 12}, &map, &axes));
  DrawWay(canvas, &axes, &map, p);
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(LamMapPictureDestroy(&map));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotProcess(const LamPlotRequest *request)
{
  LamProcessPicture picture;

  PetscFunctionBeginUser;
  PetscCall(LamProcessPictureRead(request->input, &picture));
  if (request->map)
    PetscCall(PlotWay(request, &picture));
  else if (request->film || request->state >= 0)
    PetscCall(PlotFilm(request, &picture));
  else
    PetscCall(PlotCharts(request, &picture));
  PetscCall(LamProcessPictureDestroy(&picture));
  PetscFunctionReturn(0);
}
