/*
  Reactions of an FE2 run against the displacement of its loaded side.
*/
#include "plot_fe2.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Onset = {0.45, 0.45, 0.5};

/* ---- reading ---- */

/* Reads a quantity per step; a run that was stopped may have written one row more than complete steps. */
static PetscErrorCode ReadCurve(const char path[], const char name[], PetscInt steps, PetscInt columns,
                                PetscReal **values)
{
  PetscBool found;
  PetscInt rank, dims[4], size = 1;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, values));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no %s to draw", path, name);
  for (PetscInt i = 1; i < rank; i++) size *= dims[i];
  PetscCheck(rank > 0 && dims[0] >= steps && size == columns, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is damaged: it does not hold %" PetscInt_FMT " numbers for each of %" PetscInt_FMT " steps", path,
             name, columns, steps);
  PetscFunctionReturn(0);
}

/* Certified reactions and their margins, if there are any. */
static PetscErrorCode ReadCertified(const char path[], LamReactions *p)
{
  PetscInt rank, dims[4];
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadReals(path, "/macro/curve/certified_margin", &has, &rank, dims, &p->margin));
  if (!has) PetscFunctionReturn(0);
  PetscCall(PetscFree(p->margin)); /* read again with a check of its size */
  PetscCall(ReadCurve(path, "/macro/curve/certified", p->count, 2 * p->side_count, &p->certified));
  PetscCall(ReadCurve(path, "/macro/curve/certified_margin", p->count, 2 * p->side_count, &p->margin));
  PetscFunctionReturn(0);
}

/* Gets the name of a side. */
static void SideName(const LamReactions *p, PetscInt side, size_t size, char name[])
{
  const char *start = p->sides + strspn(p->sides, "\n");

  for (; side; side--) {
    start += strcspn(start, "\n");
    start += strspn(start, "\n");
  }
  snprintf(name, size, "%.*s", (int)PetscMin(strcspn(start, "\n"), size - 1), start);
}

/* Components of the loaded side's displacement and reaction along its direction; nothing if the summary names no loaded
 * side. */
static PetscErrorCode ReadDisplacement(const char path[], LamReactions *p)
{
  const json_t *loaded = json_object_get(p->summary, "loaded"), *direction = json_object_get(loaded, "direction");
  const char *name = json_string_value(json_object_get(loaded, "boundary"));
  PetscReal *u;
  char side[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  if (!name) PetscFunctionReturn(0);
  PetscCall(ReadCurve(path, "/macro/curve/displacement", p->count, 2 * p->side_count, &u));
  PetscCall(PetscCalloc1(p->count, &p->x));
  PetscCall(PetscCalloc1(p->count, &p->pull));
  for (PetscInt s = 0; s < p->side_count; s++) {
    SideName(p, s, sizeof side, side);
    if (strcmp(side, name)) continue;
    for (PetscInt k = 0; k < p->count; k++) {
      for (size_t i = 0; i < 2; i++) {
        const PetscInt column = (k * p->side_count + s) * 2 + (PetscInt)i;
        const PetscReal along = json_number_value(json_array_get(direction, i));
        if (isfinite(u[column])) p->x[k] += along * u[column];
        p->pull[k] += along * p->reaction[column];
      }
    }
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

PetscErrorCode LamReactionsRead(const char path[], PetscInt count, LamReactions *p)
{
  PetscBool found;
  char *summary;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(p, sizeof *p));
  p->count = count;
  PetscCall(LamPlotReadText(path, "/macro/boundaries", &p->sides));
  for (const char *c = p->sides; *c; c++) p->side_count += *c != '\n' && (c[1] == '\n' || !c[1]);
  PetscCall(ReadCurve(path, "/macro/curve/load_factor", count, 1, &p->load));
  PetscCall(ReadCurve(path, "/macro/curve/reaction", count, 2 * p->side_count, &p->reaction));
  PetscCall(ReadCertified(path, p));
  PetscCall(LamFileReadText(path, "/macro/summary", &found, &summary));
  if (found) p->summary = json_loads(summary, 0, NULL);
  PetscCall(PetscFree(summary));
  PetscCall(ReadDisplacement(path, p));
  PetscFunctionReturn(0);
}

PetscErrorCode LamReactionsDestroy(LamReactions *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->load));
  PetscCall(PetscFree(p->x));
  PetscCall(PetscFree(p->pull));
  PetscCall(PetscFree(p->reaction));
  PetscCall(PetscFree(p->certified));
  PetscCall(PetscFree(p->margin));
  PetscCall(PetscFree(p->sides));
  json_decref(p->summary);
  PetscFunctionReturn(0);
}

/* ---- drawing ---- */

PetscBool LamReactionsGet(const LamReactions *p, PetscInt column, PetscReal values[], char label[LAM_SERIES_LABEL])
{
  const PetscInt columns = 2 * p->side_count;
  PetscReal largest = 0, own = 0;
  char side[LAM_NAME_LENGTH];

  for (PetscInt i = 0; i < p->count * columns; i++) largest = PetscMax(largest, PetscAbsReal(p->reaction[i]));
  for (PetscInt k = 0; k < p->count; k++) {
    values[k] = p->reaction[k * columns + column];
    own = PetscMax(own, PetscAbsReal(values[k]));
  }
  SideName(p, column / 2, sizeof side, side);
  snprintf(label, LAM_SERIES_LABEL, "%.40s $R$_{%d}", side, (int)(column % 2 + 1));
  return (PetscBool) !(own < 1e-6 * largest);
}

PetscInt LamReactionsPeak(const LamReactions *p)
{
  const PetscReal *size = p->pull ? p->pull : p->load;
  PetscInt peak = 0;

  for (PetscInt k = 1; k < p->count; k++)
    if (!(PetscAbsReal(size[k]) < PetscAbsReal(size[peak]))) peak = k; /* of equal ones the last */
  return peak;
}

/* One colour per side; filled circles and full lines for component 1, hollow squares and dashes for component 2. */
static PetscErrorCode ReactionSeries(const LamReactions *p, PetscInt *count, LamSeries series[])
{
  PetscFunctionBeginUser;
  *count = 0;
  for (PetscInt i = 0; i < 2 * p->side_count; i++) {
    LamSeries *s = &series[*count];
    const PetscBool second = (PetscBool)(i % 2);

    PetscCall(LamSeriesCreate(p->count, s));
    PetscCall(PetscArraycpy(s->x, p->x ? p->x : p->load, p->count));
    s->style =
        (LamStyle){LamColourOfLine(i / 2), second ? LAM_MARKER_SQUARE : LAM_MARKER_CIRCLE, second, PETSC_TRUE, second};
    if (LamReactionsGet(p, i, s->y, s->label))
      (*count)++;
    else
      PetscCall(LamSeriesDestroy(s));
  }
  PetscFunctionReturn(0);
}

/* The intervals of certified reactions of a component, with caps. */
static void DrawIntervals(LamCanvas canvas, const LamAxes *axes, const LamReactions *p, PetscInt column)
{
  const double cap = 3;
  cairo_t *cr = LamCanvasCairo(canvas);

  for (PetscInt k = 0; k < p->count; k++) {
    const PetscReal value = p->certified[k * 2 * p->side_count + column],
                    margin = p->margin[k * 2 * p->side_count + column];
    const double x = LamAxesX(axes, p->x ? p->x[k] : p->load[k]);

    if (!isfinite(value) || !isfinite(margin)) continue;
    cairo_move_to(cr, x, LamAxesY(axes, value - margin));
    cairo_line_to(cr, x, LamAxesY(axes, value + margin));
    for (int end = -1; end <= 1; end += 2) {
      cairo_move_to(cr, x - cap, LamAxesY(axes, value + end * margin));
      cairo_line_to(cr, x + cap, LamAxesY(axes, value + end * margin));
    }
  }
  LamCanvasStroke(canvas, LamDarkInk, 0.9, NULL);
}

/* Of all components that are drawn. */
static PetscErrorCode DrawCertified(LamCanvas canvas, const LamAxes *axes, const LamReactions *p)
{
  char label[LAM_SERIES_LABEL];
  PetscReal *values;

  PetscFunctionBeginUser;
  if (!p->certified) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(p->count, &values));
  for (PetscInt c = 0; c < 2 * p->side_count; c++)
    if (LamReactionsGet(p, c, values, label)) DrawIntervals(canvas, axes, p, c);
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* A line at the onset of separation or rupture, with its name. */
static void DrawOnset(LamCanvas canvas, const LamAxes *axes, const LamReactions *p, const char name[])
{
  const json_t *onset = json_object_get(p->summary, name);
  const json_t *value = json_object_get(onset, p->x ? "displacement" : "load_factor");

  if (json_is_number(value)) LamAxesMark(canvas, axes, json_number_value(value), Onset, PETSC_TRUE, name);
}

/* A line where results begin to depend on the mesh of the body. */
static void DrawMeshDependent(LamCanvas canvas, const LamAxes *axes, const LamReactions *p)
{
  const json_t *load = json_object_get(json_object_get(p->summary, "mesh_dependent"), "load_factor");

  for (PetscInt k = 0; k < p->count && json_is_number(load); k++) {
    if (PetscAbsReal(p->load[k] - json_number_value(load)) > 1e-9) continue;
    LamAxesMark(canvas, axes, p->x ? p->x[k] : p->load[k], Onset, PETSC_TRUE, "mesh-dependent");
    return;
  }
}

PetscErrorCode LamReactionsDraw(LamCanvas canvas, LamRect outer, const LamReactions *p)
{
  const char *side = json_string_value(json_object_get(json_object_get(p->summary, "loaded"), "boundary"));
  LamAxes axes = {.x = {.label = "load factor"}, .y = {.label = "reaction per thickness $R$", .unit = "N/mm"}};
  char label[LAM_NAME_LENGTH + 32];
  LamSeries *series;
  PetscInt count;

  PetscFunctionBeginUser;
  if (p->x) {
    PetscCall(PetscSNPrintf(label, sizeof label, "displacement $u$ of %s", side));
    axes.x = (LamAxis){.label = label, .unit = "mm"};
  }
  PetscCall(PetscMalloc1(2 * p->side_count + 1, &series));
  PetscCall(ReactionSeries(p, &count, series));
  LamChart(canvas, outer, &axes, count, series);
  PetscCall(DrawCertified(canvas, &axes, p));
  DrawOnset(canvas, &axes, p, "separation");
  DrawOnset(canvas, &axes, p, "rupture");
  DrawMeshDependent(canvas, &axes, p);
  for (PetscInt i = 0; i < count; i++) PetscCall(LamSeriesDestroy(&series[i]));
  PetscCall(PetscFree(series));
  PetscFunctionReturn(0);
}
