/*
  Pictures of a process: quantities against time, the same beside the cells of a state, films of these, and the path of
  the tissue on a map of its failure.
*/
#include "plot_map.h"
#include "plot_time.h"
#include "plot_tissue.h"
#include <lamella/process.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  const char *path;     /* borrowed */
  LamDatabase database; /* owned */
  LamPlotRecords of;    /* the states */
  LamTimeLine line;
} Process;

static PetscErrorCode Read(const char path[], Process *p)
{
  PetscFunctionBeginUser;
  p->path = path;
  PetscCall(LamDatabaseOpen(path, &p->database));
  PetscCall(LamPlotGetRecords(p->database, &p->of));
  PetscCheck(p->of.n > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no states", path);
  PetscCall(LamTimeLineRead(path, p->of.n, &p->line));
  PetscFunctionReturn(0);
}

static PetscBool IsContact(const Process *p)
{
  return LamCellsPart(p->of.micro.interface);
}

/* ---- the four charts ---- */

/* Adds a member of the records. */
static PetscErrorCode AddMember(LamTimeChart *chart, const Process *p, size_t offset, PetscReal factor,
                                const char label[])
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->of.n, &values));
  for (PetscInt k = 0; k < p->of.n; k++)
    values[k] = factor * *(const PetscReal *)(const void *)((const char *)&p->of.records[k] + offset);
  PetscCall(LamTimeChartAdd(chart, &p->line, values, label));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakePressures(Process *p, LamTimeChart *chart)
{
  const PetscReal *osmotic;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "pressure", .unit = "MPa"}};
  PetscCall(LamTimeChartAddColumn(chart, &p->line, "turgor", "turgor"));
  PetscCall(LamTimeColumn(&p->line, "osmotic_pressure", PETSC_FALSE, &osmotic));
  if (LamTimeIsKnown(p->of.n, osmotic)) {
    PetscCall(LamTimeChartAdd(chart, &p->line, osmotic, "osmotic, in cells"));
    PetscCall(LamTimeChartAddColumn(chart, &p->line, "outside", "outside"));
  }
  if (IsContact(p)) PetscCall(LamTimeChartAddColumn(chart, &p->line, "cohesion", "cohesion"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeFactors(Process *p, LamTimeChart *chart)
{
  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the start"}};
  PetscCall(LamTimeChartAddGroup(chart, &p->line, "factor", LAM_CHANGING_COUNT, LamChangingNames, LamTimeVaries));
  if (!chart->n)
    PetscCall(AddMember(chart, p, offsetof(LamResponse, lumen_fraction), 1 / p->of.records[0].lumen_fraction, "lumen"));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeSeparation(Process *p, LamTimeChart *chart)
{
  const PetscReal MPa = p->of.scales.stress * 1e-6;

  PetscFunctionBeginUser;
  *chart = (LamTimeChart){.axes.y = {.label = "share of the interface"}};
  if (IsContact(p)) {
    PetscCall(AddMember(chart, p, offsetof(LamResponse, debonded_fraction), 1, "debonded"));
    PetscCall(AddMember(chart, p, offsetof(LamResponse, open_fraction), 1, "open"));
    PetscFunctionReturn(0);
  }
  chart->axes.y.label = "stress over strength";
  PetscCall(LamTimeChartAddGroup(chart, &p->line, "ratio", LAM_RATIO_COUNT, LamRatioNames, LamTimeIsKnown));
  if (chart->n) PetscFunctionReturn(0);
  chart->axes.y = (LamAxis){.label = "stress", .unit = "MPa"};
  PetscCall(AddMember(chart, p, offsetof(LamResponse, max_traction), MPa, "lamella traction"));
  PetscCall(AddMember(chart, p, offsetof(LamResponse, max_wall_tension), MPa, "wall tension"));
  PetscFunctionReturn(0);
}

/* Firmness, pressures, changing quantities and separation against time; `now` >= 0: a state to mark. */
static PetscErrorCode DrawCharts(LamCanvas canvas, LamRect outer, Process *p, PetscInt now)
{
  LamTimeChart charts[4] = {{.axes.y = {.label = "firmness $E$", .unit = "MPa"}}};

  PetscFunctionBeginUser;
  PetscCall(LamTimeChartAddColumn(&charts[0], &p->line, "firmness", ""));
  PetscCall(MakePressures(p, &charts[1]));
  PetscCall(MakeFactors(p, &charts[2]));
  PetscCall(MakeSeparation(p, &charts[3]));
  PetscCall(LamTimeChartsDraw(canvas, outer, &p->line, charts, now));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlotCharts(const LamPlotRequest *request, Process *p)
{
  LamCanvas canvas;

  PetscFunctionBeginUser;
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_TIME_HEIGHT, &canvas));
  PetscCall(DrawCharts(canvas, (LamRect){9, 9, LAM_PLOT_WIDTH - 18, LAM_TIME_HEIGHT - 15}, p, -1));
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

/* ---- films and strips ---- */

typedef struct {
  Process *process;
  LamCells cells;
} Film;

/* A LamFrameFunction; ctx: a Film. */
static PetscErrorCode DrawFrame(LamCanvas canvas, void *ctx, PetscInt k)
{
  const Film *film = (const Film *)ctx;
  const PetscInt state = film->cells.states[k];
  LamView view;

  PetscFunctionBeginUser;
  LamFrameBegin(canvas, &film->process->line, state, &film->cells.frame, &view);
  PetscCall(LamCellsDraw(canvas, &view, &film->cells, k));
  LamCellsKey(canvas, &view, &film->cells);
  PetscCall(DrawCharts(canvas, LamFrameCharts(), film->process, state));
  PetscFunctionReturn(0);
}

/* As LamStrip.draw and key; ctx: a Film. */
static PetscErrorCode DrawMoment(LamCanvas canvas, const LamView *view, void *ctx, PetscInt k, size_t size,
                                 char title[])
{
  const Film *film = (const Film *)ctx;

  PetscFunctionBeginUser;
  LamTimeTitle(&film->process->line, film->cells.states[k], size, title);
  PetscCall(LamCellsDraw(canvas, view, &film->cells, k));
  PetscFunctionReturn(0);
}

static void DrawKey(LamCanvas canvas, const LamView *view, void *ctx)
{
  LamCellsKey(canvas, view, &((const Film *)ctx)->cells);
}

static PetscErrorCode PlotFilm(const LamPlotRequest *request, Process *p)
{
  Film film = {.process = p};
  LamCells *cells = &film.cells;

  PetscFunctionBeginUser;
  PetscCall(LamCellsFind(p->path, &p->of, request->field, request->state, cells));
  PetscCheck(cells->count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no cells%s to draw; lamella process with --frames N keeps them", p->path,
             request->state >= 0 ? " of this state" : "");
  if (request->strip) LamCellsChoose(cells, p->of.n - 1);
  PetscCall(LamCellsShare(cells));
  if (request->strip)
    PetscCall(LamStripDraw(request->output, &(LamStrip){cells->count, cells->frame, DrawMoment, DrawKey, &film}));
  else
    PetscCall(LamFilmDraw(request, cells->count, DrawFrame, &film));
  PetscCall(LamCellsDestroy(cells));
  PetscFunctionReturn(0);
}

/* ---- the path on a map ---- */

/*
  Positions of the states on an axis of the map. The map is for the initial walls: when all wall moduli have become s
  times the initial ones, tissue fails as the initial tissue does at p / s and g / s.
*/
static PetscErrorCode FindPositions(Process *p, const LamMapSide *side, PetscReal **at)
{
  const PetscReal *values, *walls;

  PetscFunctionBeginUser;
  PetscCall(LamTimeColumn(&p->line, side->quantity, PETSC_FALSE, &values));
  PetscCall(LamTimeColumn(&p->line, "walls", PETSC_FALSE, &walls));
  PetscCall(PetscMalloc1(p->of.n, at));
  for (PetscInt k = 0; k < p->of.n; k++) (*at)[k] = side->is_log ? log10(values[k] / walls[k]) : values[k] / walls[k];
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawPath(LamCanvas canvas, const LamAxes *axes, const LamMapPicture *map, Process *p)
{
  PetscReal *x, *y;
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(FindPositions(p, &map->x, &x));
  PetscCall(FindPositions(p, &map->y, &y));
  LamCanvasClip(canvas, axes->frame);
  for (PetscInt k = 0; k < p->of.n; k++) LamAxesPath(canvas, axes, x[k], y[k], (PetscBool)(k > 0));
  LamCanvasStroke(canvas, LamPathColour, 1.3, NULL);
  for (PetscInt k = 0; k < p->of.n; k++) {
    const double at[2] = {LamAxesX(axes, x[k]), LamAxesY(axes, y[k])};

    LamTimeEventName(&p->line, k, sizeof(name), name);
    if (k > 0 && k < p->of.n - 1 && !name[0]) continue;
    LamCanvasSetColour(canvas, LamPathColour);
    LamCanvasMarker(canvas, at[0], at[1], 4.2, name[0] ? LAM_MARKER_DIAMOND : LAM_MARKER_CIRCLE, (PetscBool)(k > 0));
    LamCanvasSetColour(canvas, LamDarkInk);
    for (int side = 0; side < 4; side++)
      if (LamCanvasTextFree(canvas, at[0] + (side % 2 ? -5 : 5), at[1] + (side / 2 ? 6 : -5), side % 2, 0,
                            LAM_TICK_SIZE,
                            name[0] ? name
                            : k     ? "end"
                                    : "start"))
        break;
  }
  cairo_restore(LamCanvasCairo(canvas));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(y));
  PetscFunctionReturn(0);
}

/* Whether a process has the quantity of this axis. */
static PetscBool IsPressure(const LamMapSide *side)
{
  return (PetscBool)(!strcmp(side->quantity, "turgor") || !strcmp(side->quantity, "cohesion"));
}

static PetscErrorCode PlotPath(const LamPlotRequest *request, Process *p)
{
  const LamPlotRequest of_map = {.input = request->map, .state = LAM_PLOT_PEAK};
  const double width = 0.55 * LAM_PLOT_WIDTH;
  LamMapPicture map;
  LamCanvas canvas;
  LamAxes axes;

  PetscFunctionBeginUser;
  PetscCall(LamMapPictureRead(&of_map, &map));
  map.has_path = PETSC_TRUE;
  PetscCheck(IsPressure(&map.x) && IsPressure(&map.y) && strcmp(map.x.quantity, map.y.quantity), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "--map %s: is of %s and %s; the way of a process is drawn over turgor and cohesion",
             request->map, map.x.quantity, map.y.quantity);
  PetscCall(LamCanvasCreate(request->output, width, LAM_PLOT_HEIGHT, &canvas));
  PetscCall(LamMapDrawModes(canvas, (LamRect){9, 6, width - 18, LAM_PLOT_HEIGHT - 12}, &map, &axes));
  PetscCall(DrawPath(canvas, &axes, &map, p));
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(LamMapPictureDestroy(&map));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotProcess(const LamPlotRequest *request)
{
  Process p;

  PetscFunctionBeginUser;
  PetscCall(Read(request->input, &p));
  if (request->map)
    PetscCall(PlotPath(request, &p));
  else if (request->film || request->strip || request->state != LAM_PLOT_PEAK)
    PetscCall(PlotFilm(request, &p));
  else
    PetscCall(PlotCharts(request, &p));
  PetscCall(LamTimeLineDestroy(&p.line));
  PetscCall(LamDatabaseClose(&p.database));
  PetscFunctionReturn(0);
}
