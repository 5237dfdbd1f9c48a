/*
  Quantities against time, for pictures of processes: reading, charts, frames of films.
*/
#include "plot_time.h"
#include "quantity_text.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Event = {0.45, 0.45, 0.5}, Now = {0.75, 0.1, 0.1};
static const double PictureWidth = 210; /* of a frame, with its colour bar */

/* ---- reading ---- */

PetscErrorCode LamTimeColumn(LamTimeLine *line, const char name[], PetscBool optional, const PetscReal **values)
{
  char path[LAM_NAME_LENGTH];
  PetscInt k = 0;
  PetscBool has = PETSC_TRUE;

  PetscFunctionBeginUser;
  while (k < line->column_count && strcmp(line->column[k].name, name)) k++;
  if (k == line->column_count) {
    PetscCheck(k < LAM_TIME_COLUMNS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "more than %d columns", LAM_TIME_COLUMNS);
    PetscCall(PetscStrncpy(line->column[k].name, name, LAM_NAME_LENGTH));
    PetscCall(PetscSNPrintf(path, sizeof(path), "/process/%s", name));
    if (optional) PetscCall(LamPlotHas(line->path, path, &has));
    if (has) PetscCall(LamPlotReadReals(line->path, path, line->n, 1, &line->column[k].values));
    line->column_count++;
  }
  *values = line->column[k].values;
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeLineRead(const char path[], PetscInt n, LamTimeLine *line)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(line, sizeof(*line)));
  line->path = path;
  line->n = n;
  PetscCall(LamTimeColumn(line, "time", PETSC_FALSE, &line->time));
  PetscCall(LamPlotReadInts(path, "/process/event", n, 1, &line->event));
  PetscCall(LamPlotReadText(path, "/process/events", &line->event_names));
  line->unit = LamTimeUnit(line->time[n - 1], &line->seconds);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeLineDestroy(LamTimeLine *line)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < line->column_count; k++) PetscCall(PetscFree(line->column[k].values));
  PetscCall(PetscFree(line->event));
  PetscCall(PetscFree(line->event_names));
  PetscFunctionReturn(0);
}

PetscBool LamTimeVaries(PetscInt n, const PetscReal values[])
{
  for (PetscInt k = 1; k < n; k++)
    if (values[k] != values[0]) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool LamTimeIsKnown(PetscInt n, const PetscReal values[])
{
  return (PetscBool)(n > 0 && isfinite(values[0]));
}

static void ReplaceUnderscores(char text[])
{
  for (char *c = text; *c; c++)
    if (*c == '_') *c = ' ';
}

void LamTimeEventName(const LamTimeLine *line, PetscInt state, size_t size, char name[])
{
  const char *at = line->event_names;

  name[0] = '\0';
  if (line->event[state] < 0) return;
  for (PetscInt k = 0; k < line->event[state] && *at; k++) at += strcspn(at, "\n") + (strchr(at, '\n') ? 1 : 0);
  snprintf(name, size, "%.*s", (int)PetscMin(strcspn(at, "\n"), size - 1), at);
  ReplaceUnderscores(name);
}

void LamTimeTitle(const LamTimeLine *line, PetscInt state, size_t size, char title[])
{
  char event[LAM_NAME_LENGTH], number[32];

  LamFormatNumber(line->time[state] / line->seconds, number);
  LamTimeEventName(line, state, sizeof(event), event);
  snprintf(title, size, "%s %s%s%s", number, line->unit, event[0] ? ": " : "", event);
}

void LamTimeTitleDraw(LamCanvas canvas, double x, double y, const LamTimeLine *line, PetscInt state)
{
  char title[256], text[300];

  LamTimeTitle(line, state, sizeof title, title);
  snprintf(text, sizeof text, "%s  (red line in the charts)", title);
  LamCanvasTitle(canvas, x, y, text);
}

/* ---- charts ---- */

PetscErrorCode LamTimeChartAdd(LamTimeChart *chart, const LamTimeLine *line, const PetscReal values[],
                               const char label[])
{
  LamSeries *s = &chart->series[chart->n];

  PetscFunctionBeginUser;
  if (chart->n == LAM_TIME_SERIES) PetscFunctionReturn(0);
  PetscCall(LamSeriesCreate(line->n, s));
  for (PetscInt k = 0; k < line->n; k++) {
    s->x[k] = line->time[k] / line->seconds;
    s->y[k] = values[k];
  }
  s->style =
      (LamStyle){LamColourOfLine(chart->n), LAM_MARKER_COUNT, PETSC_FALSE, PETSC_TRUE, (PetscBool)(chart->n > 2)};
  snprintf(s->label, sizeof(s->label), "%s", label);
  chart->n++;
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeChartAddColumn(LamTimeChart *chart, LamTimeLine *line, const char name[], const char label[])
{
  const PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(LamTimeColumn(line, name, PETSC_FALSE, &values));
  PetscCall(LamTimeChartAdd(chart, line, values, label));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeChartAddGroup(LamTimeChart *chart, LamTimeLine *line, const char group[], PetscInt n,
                                    const char *const names[],
                                    PetscBool (*shows)(PetscInt count, const PetscReal values[]))
{
  const PetscReal *values;
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", group, names[k]));
    PetscCall(LamTimeColumn(line, name, PETSC_TRUE, &values)); /* a wall law has only some of the parameters */
    PetscCall(PetscStrncpy(name, names[k], sizeof(name)));
    ReplaceUnderscores(name);
    if (values && shows(line->n, values)) PetscCall(LamTimeChartAdd(chart, line, values, name));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Draw(LamCanvas canvas, LamRect outer, const LamTimeLine *line, LamTimeChart *chart,
                           PetscBool names, PetscInt now)
{
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  chart->axes.x = (LamAxis){.label = "time", .unit = line->unit};
  LamChart(canvas, outer, &chart->axes, chart->n, chart->series);
  for (PetscInt k = 0; k < line->n; k++) {
    if (line->event[k] < 0) continue;
    LamTimeEventName(line, k, sizeof(name), name);
    LamAxesMark(canvas, &chart->axes, line->time[k] / line->seconds, Event, PETSC_TRUE, names ? name : NULL);
  }
  if (now >= 0) LamAxesMark(canvas, &chart->axes, line->time[now] / line->seconds, Now, PETSC_FALSE, NULL);
  for (PetscInt k = 0; k < chart->n; k++) PetscCall(LamSeriesDestroy(&chart->series[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeChartsDraw(LamCanvas canvas, LamRect outer, const LamTimeLine *line, LamTimeChart charts[4],
                                 PetscInt now)
{
  const int columns = outer.width > 3 * outer.height ? 4 : 2, rows = 4 / columns;
  const double gap = 12, width = (outer.width - (columns - 1) * gap) / columns,
               height = (outer.height - (rows - 1) * gap) / rows;

  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) {
    const LamRect at = {outer.x + k % columns * (width + gap), outer.y + k / columns * (height + gap), width, height};

    PetscCall(Draw(canvas, at, line, &charts[k], (PetscBool)(k == 0), now));
  }
  PetscFunctionReturn(0);
}

/* ---- frames ---- */

LamRect LamFrameCharts(void)
{
  return (LamRect){PictureWidth + 30, 18, LAM_PLOT_WIDTH - PictureWidth - 39, LAM_TIME_HEIGHT - 24};
}

void LamFrameBegin(LamCanvas canvas, const LamTimeLine *line, PetscInt state, const LamFrame *frame, LamView *view)
{
  const LamRect picture = {9, 30, PictureWidth, LAM_TIME_HEIGHT - 60};

  LamTimeTitleDraw(canvas, picture.x, 14, line, state);
  LamFrameDraw(canvas, picture, frame, view);
}

PetscErrorCode LamFilmDraw(const LamPlotRequest *request, PetscInt count, LamFrameFunction draw, void *ctx)
{
  const LamReporter *reporter = &request->reporter;
  const char *path = request->output;
  const PetscBool pages = LamCanvasHasPages(path);
  const char *dot = strrchr(path, '.');
  char name[PETSC_MAX_PATH_LEN];
  LamCanvas canvas = NULL;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; k++) {
    PetscCall(PetscStrncpy(name, path, sizeof(name)));
    if (!pages && count > 1)
      PetscCall(PetscSNPrintf(name, sizeof(name), "%.*s-%04d%s", (int)(dot - path), path, (int)(k + 1), dot));
    if (canvas)
      LamCanvasNextPage(canvas);
    else
      PetscCall(LamCanvasCreate(name, LAM_PLOT_WIDTH, LAM_TIME_HEIGHT, &canvas));
    PetscCall(draw(canvas, ctx, k));
    if (!pages || k == count - 1) PetscCall(LamCanvasFinish(&canvas));
    if (reporter->progress) PetscCall(reporter->progress(reporter->ctx, k + 1, count, 0));
  }
  PetscFunctionReturn(0);
}
