/*
  Reactions of an FE2 run against the displacement of its loaded side.
*/
#include "plot_fe2.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Ink = {0.12, 0.12, 0.16}, Onset = {0.45, 0.45, 0.5};

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

void LamReactionsSideName(const LamReactions *p, PetscInt side, size_t size, char name[])
{
  const char *start = p->sides;
  size_t length;

  for (PetscInt i = 0;; i++) {
    while (*start == '\n') start++;
    length = strcspn(start, "\n");
    if (i == side) break;
    start += length;
  }
  snprintf(name, size, "%.*s", (int)PetscMin(length, size - 1), start);
}

/* Components of the loaded side's displacement along its direction; nothing if the summary names no loaded side. */
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
  for (PetscInt s = 0; s < p->side_count; s++) {
    LamReactionsSideName(p, s, sizeof side, side);
    if (strcmp(side, name)) continue;
    for (PetscInt k = 0; k < p->count; k++) {
      for (size_t i = 0; i < 2; i++) {
        const PetscReal value = u[(k * p->side_count + s) * 2 + (PetscInt)i];
        if (isfinite(value)) p->x[k] += json_number_value(json_array_get(direction, i)) * value;
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
  PetscCall(LamFileReadText(path, "/macro/boundaries", &found, &p->sides));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no /macro/boundaries to draw", path);
  for (const char *c = p->sides; *c; c++) p->side_count += *c != '\n' && (c[1] == '\n' || !c[1]);
  PetscCall(ReadCurve(path, "/macro/curve/load_factor", count, 1, &p->load));
  PetscCall(ReadCurve(path, "/macro/curve/reaction", count, 2 * p->side_count, &p->reaction));
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
  PetscCall(PetscFree(p->reaction));
  PetscCall(PetscFree(p->sides));
  json_decref(p->summary);
  PetscFunctionReturn(0);
}

/* ---- drawing ---- */

/* One colour per side; filled circles and full lines for component 1, hollow squares and dashes for component 2. */
static PetscErrorCode ReactionSeries(const LamReactions *p, PetscInt *count, LamSeries series[])
{
  PetscReal largest = 0;
  char name[32];

  PetscFunctionBeginUser;
  *count = 0;
  for (PetscInt i = 0; i < p->count * p->side_count * 2; i++) largest = PetscMax(largest, PetscAbsReal(p->reaction[i]));
  for (PetscInt side = 0; side < p->side_count; side++) {
    for (int c = 0; c < 2; c++) {
      LamSeries *s = &series[*count];
      PetscReal own = 0;

      PetscCall(LamSeriesCreate(p->count, s));
      for (PetscInt k = 0; k < p->count; k++) {
        s->x[k] = p->x ? p->x[k] : p->load[k];
        s->y[k] = p->reaction[(k * p->side_count + side) * 2 + c];
        own = PetscMax(own, PetscAbsReal(s->y[k]));
      }
      if (own <= 1e-6 * largest) { /* a roller's free component */
        PetscCall(LamSeriesDestroy(s));
        continue;
      }
      LamReactionsSideName(p, side, sizeof name, name);
      s->style = (LamStyle){LamColourOfLine(side), c ? LAM_MARKER_SQUARE : LAM_MARKER_CIRCLE, (PetscBool)c, PETSC_TRUE,
                            (PetscBool)c};
      snprintf(s->label, sizeof s->label, "%s $R$_{%d}", name, c + 1);
      (*count)++;
    }
  }
  PetscFunctionReturn(0);
}

/* A dashed line at the onset of separation or rupture, with its name along it, to the left or right. */
static void DrawOnset(LamCanvas canvas, const LamAxes *axes, const LamReactions *p, const char name[])
{
  const json_t *onset = json_object_get(p->summary, name);
  const json_t *value = json_object_get(onset, p->x ? "displacement" : "load_factor");
  const double dash[] = {1.2, 1.8};
  cairo_t *cr = LamCanvasCairo(canvas);
  double x;

  if (!json_is_number(value)) return;
  x = LamAxesX(axes, json_number_value(value));
  LamCanvasSetColour(canvas, Onset);
  cairo_set_dash(cr, dash, 2, 0);
  cairo_set_line_width(cr, 0.8);
  cairo_move_to(cr, x, axes->frame.y + axes->frame.height);
  cairo_line_to(cr, x, axes->frame.y);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
  LamCanvasText(canvas, x - 5, axes->frame.y + 3, 1, 0.5 * PETSC_PI, LAM_TICK_SIZE, name);
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
  DrawOnset(canvas, &axes, p, "separation");
  DrawOnset(canvas, &axes, p, "rupture");
  LamCanvasSetColour(canvas, Ink);
  for (PetscInt i = 0; i < count; i++) PetscCall(LamSeriesDestroy(&series[i]));
  PetscCall(PetscFree(series));
  PetscFunctionReturn(0);
}
