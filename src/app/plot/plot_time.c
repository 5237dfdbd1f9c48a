/*
  Quantities against time, for pictures of processes: reading, charts, names of frames.
*/
#include "plot_time.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Ink = {0.12, 0.12, 0.16}, Event = {0.45, 0.45, 0.5}, Now = {0.75, 0.1, 0.1};

/* ---- reading ---- */

const char *LamTimeUnit(PetscReal duration, PetscReal *seconds)
{
  static const struct {
    const char *name;
    PetscReal seconds;
  } units[] = {{"day", 86400}, {"h", 3600}, {"min", 60}, {"s", 1}};
  size_t k = 0;

  while (k + 1 < PETSC_STATIC_ARRAY_LENGTH(units) && duration < 2 * units[k].seconds) k++;
  *seconds = units[k].seconds;
  return units[k].name;
}

PetscErrorCode LamTimeReadColumn(const LamTimeLine *line, const char name[], PetscReal **values)
{
  char path[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/process/%s", name));
  PetscCall(LamPlotReadReals(line->path, path, line->n, 1, values));
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

PetscErrorCode LamTimeReadGroup(const LamTimeLine *line, const char group[], PetscInt n, const char *const names[],
                                PetscBool (*shows)(PetscInt count, const PetscReal values[]), PetscInt *count,
                                PetscReal *values[], char (*labels)[LAM_NAME_LENGTH])
{
  char name[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt rank, dims[4];
    PetscBool found;

    PetscCall(PetscSNPrintf(name, sizeof(name), "/process/%s/%s", group, names[k]));
    PetscCall(LamFileReadReals(line->path, name, &found, &rank, dims, &values[*count]));
    if (!found) continue; /* a parameter that the wall law does not have */
    PetscCall(PetscFree(values[*count]));
    PetscCall(LamPlotReadReals(line->path, name, line->n, 1, &values[*count]));
    if (!shows(line->n, values[*count])) {
      PetscCall(PetscFree(values[*count]));
      continue;
    }
    PetscCall(PetscStrncpy(labels[*count], names[k], LAM_NAME_LENGTH));
    for (char *c = labels[*count]; *c; c++)
      if (*c == '_') *c = ' ';
    (*count)++;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadEvents(LamTimeLine *line)
{
  PetscInt rank, dims[4];
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(line->path, "/process/event", &found, &rank, dims, &line->event));
  PetscCheck(found && rank == 1 && dims[0] == line->n, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /process/event does not fit the rest of the file; it is damaged", line->path);
  PetscCall(LamFileReadText(line->path, "/process/events", &found, &line->event_names));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no /process/events to draw", line->path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeLineRead(const char path[], PetscInt n, LamTimeLine *line)
{
  PetscFunctionBeginUser;
  *line = (LamTimeLine){.path = path, .n = n};
  PetscCall(LamTimeReadColumn(line, "time", &line->time));
  PetscCall(ReadEvents(line));
  line->unit = LamTimeUnit(line->time[n - 1], &line->seconds);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTimeLineDestroy(LamTimeLine *line)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(line->time));
  PetscCall(PetscFree(line->event));
  PetscCall(PetscFree(line->event_names));
  PetscFunctionReturn(0);
}

void LamTimeEventName(const LamTimeLine *line, PetscInt state, size_t size, char name[])
{
  const char *at = line->event_names;

  name[0] = '\0';
  if (line->event[state] < 0) return;
  for (PetscInt k = 0; k < line->event[state] && *at; k++) at += strcspn(at, "\n") + (strchr(at, '\n') ? 1 : 0);
  snprintf(name, size, "%.*s", (int)PetscMin(strcspn(at, "\n"), size - 1), at);
  for (char *c = name; *c; c++)
    if (*c == '_') *c = ' ';
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

/* A line across the chart at a time. */
static void MarkTime(LamCanvas canvas, const LamAxes *axes, PetscReal time, LamColour colour, PetscBool dashed)
{
  const double x = LamAxesX(axes, time), dash[] = {1.2, 1.8};
  cairo_t *cr = LamCanvasCairo(canvas);

  LamCanvasSetColour(canvas, colour);
  cairo_set_dash(cr, dash, dashed ? 2 : 0, 0);
  cairo_set_line_width(cr, 0.8);
  cairo_move_to(cr, x, axes->frame.y + axes->frame.height);
  cairo_line_to(cr, x, axes->frame.y);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
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
    MarkTime(canvas, &chart->axes, line->time[k] / line->seconds, Event, PETSC_TRUE);
    LamTimeEventName(line, k, sizeof(name), name);
    if (names)
      LamCanvasText(canvas, LamAxesX(&chart->axes, line->time[k] / line->seconds) - 5, chart->axes.frame.y + 3, 1,
                    0.5 * PETSC_PI, LAM_TICK_SIZE, name);
  }
  if (now >= 0) MarkTime(canvas, &chart->axes, line->time[now] / line->seconds, Now, PETSC_FALSE);
  LamCanvasSetColour(canvas, Ink);
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

PetscErrorCode LamFrameName(const char path[], PetscInt number, size_t size, char name[])
{
  const char *dot = strrchr(path, '.');

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, size, "%.*s-%04d%s", (int)(dot - path), path, (int)number, dot));
  PetscFunctionReturn(0);
}
