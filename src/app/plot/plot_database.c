/*
  Picture of a response database: its records in strain space, and their responses.

  Coordinates: with principal logarithmic strains e1 >= e2 of the plane, m = (e1 + e2)/2 = half ln J and r = (e1 -
  e2)/2, the size of the isochoric strain.
*/
#include "plot_slice.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const LamColour Failure = {0.80, 0.15, 0.05};

typedef struct {
  PetscInt n, failed, outside; /* number of records, of those not converged, of those without a finite strain */
  PetscReal (*shape)[2];       /* m, r; owned */
  PetscReal (*principal)[2];   /* e1 >= e2; owned */
  PetscReal *value;            /* NaN: not converged; owned */
  LamColourRange range;
} DatabasePicture;

static PetscErrorCode LoadDatabase(const LamPlotRequest *request, LamDatabase database, PetscBool turgor,
                                   DatabasePicture *p)
{
  LamPlotRecords of;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(p, sizeof *p));
  PetscCall(LamPlotGetRecords(database, &of));
  PetscCheck(of.n > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no records to draw", request->input);
  p->n = of.n;
  PetscCall(PetscMalloc1(p->n, &p->shape));
  PetscCall(PetscMalloc1(p->n, &p->principal));
  PetscCall(PetscMalloc1(p->n, &p->value));
  for (PetscInt i = 0; i < p->n; i++) {
    const LamResponse *record = &of.records[i];
    PetscReal angle, *e = p->principal[i];

    LamPrincipalStrains(record->load.F, e, &angle);
    p->shape[i][0] = 0.5 * (e[0] + e[1]);
    p->shape[i][1] = 0.5 * (e[0] - e[1]);
    p->value[i] = (turgor ? record->load.turgor : LamStressNorm(record->P)) * of.scales.stress * 1e-6;
    if (!LamResponseHasFields(record)) {
      p->value[i] = NAN;
      p->failed++;
    }
    if (!isfinite(e[0]) || !isfinite(e[1])) p->outside++;
  }
  PetscCall(LamColourRangeFind(p->n, p->value, &p->range));
  PetscFunctionReturn(0);
}

/* In the order of the records, failures last, so that none is hidden. */
static void DrawMarkers(LamCanvas canvas, const LamAxes *axes, const DatabasePicture *p, PetscReal (*const at)[2])
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double size = p->n > 3000 ? 1.6 : p->n > 300 ? 2.6 : 4;

  for (int failures = 0; failures < 2; failures++) {
    for (PetscInt i = 0; i < p->n; i++) {
      const double x = LamAxesX(axes, at[i][0]), y = LamAxesY(axes, at[i][1]);
      const PetscBool failed = PetscIsNanReal(p->value[i]);

      if ((int)failed != failures || !isfinite(x) || !isfinite(y)) continue;
      if (failed) {
        LamCanvasSetColour(canvas, Failure);
        LamCanvasMarker(canvas, x, y, size, LAM_MARKER_CROSS, PETSC_FALSE);
      } else {
        cairo_arc(cr, x, y, 0.5 * size, 0, 2 * M_PI);
        LamCanvasFill(canvas, LamColourMap(LamColourShare(&p->range, p->value[i])));
      }
    }
  }
}

static PetscErrorCode DrawScatter(LamCanvas canvas, LamRect outer, const DatabasePicture *p, PetscReal (*const at)[2],
                                  LamAxes *axes)
{
  const PetscBool many = (PetscBool)(p->n > 1500);

  PetscFunctionBeginUser;
  LamAxesEmpty(axes);
  for (PetscInt i = 0; i < p->n; i++) LamAxesExtend(axes, at[i][0], at[i][1]);
  LamAxisPad(&axes->x);
  LamAxisPad(&axes->y);
  LamAxesLayout(canvas, outer, axes);
  LamAxesDraw(canvas, axes);
  if (many) PetscCall(LamCanvasBeginImage(canvas, axes->frame));
  DrawMarkers(canvas, axes, p, at);
  if (many) LamCanvasEndImage(canvas);
  PetscFunctionReturn(0);
}

static void Title(const DatabasePicture *p, size_t size, char title[])
{
  size_t n = (size_t)snprintf(title, size, "%" PetscInt_FMT " record%s", p->n, p->n == 1 ? "" : "s");

  if (p->failed)
    n += (size_t)snprintf(title + n, size - n, ",  %" PetscInt_FMT " without an answer (crosses)", p->failed);
  if (p->outside) snprintf(title + n, size - n, ",  %" PetscInt_FMT " without a strain (not drawn)", p->outside);
}

static const char *const Fields[] = {"stress", "turgor"};

const char *LamPlotDatabaseField(size_t i)
{
  return i < PETSC_STATIC_ARRAY_LENGTH(Fields) ? Fields[i] : NULL;
}

/* The records as points. */
static PetscErrorCode PlotRecords(const LamPlotRequest *request, LamDatabase database)
{
  LamAxes shape = {.x = {.label = "mean strain $m$ = ½ ln $J$"}, .y = {.label = "isochoric strain $r$"}};
  LamAxes principal = {.x = {.label = "larger principal log. strain $e$_{1}"},
                       .y = {.label = "smaller principal log. strain $e$_{2}"}};
  DatabasePicture picture;
  LamCanvas canvas;
  LamRect rect;
  const PetscBool turgor = (PetscBool)(request->field && !strcmp(request->field, Fields[1]));
  char title[256];
  double width;

  PetscFunctionBeginUser;
  PetscCheck(turgor || !request->field || !strcmp(request->field, Fields[0]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--field %s: a database has stress and turgor", request->field);
  PetscCall(LoadDatabase(request, database, turgor, &picture));
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_PLOT_HEIGHT, &canvas));
  Title(&picture, sizeof title, title);
  LamCanvasTitle(canvas, 9, 12, title);
  width = 0.5 * (LAM_PLOT_WIDTH - 18 - 10 - LamColourBarWidth(canvas, &picture.range));
  rect = (LamRect){9, 21, width, LAM_PLOT_HEIGHT - 27};
  PetscCall(DrawScatter(canvas, rect, &picture, picture.shape, &shape));
  rect.x += width + 10;
  PetscCall(DrawScatter(canvas, rect, &picture, picture.principal, &principal));
  LamColourBar(canvas, principal.frame, &picture.range, LamColourMap, turgor ? "turgor $p$" : "‖$P$‖", "MPa");
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(PetscFree(picture.shape));
  PetscCall(PetscFree(picture.principal));
  PetscCall(PetscFree(picture.value));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotDatabase(const LamPlotRequest *request)
{
  LamDatabase database;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCheck(request->state == LAM_PLOT_PEAK, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--state: a database is drawn as a whole");
  PetscCall(LamDatabaseOpen(request->input, &database));
  PetscCall(LamDatabaseGetGrid(database, &grid));
  if (grid && !request->field)
    PetscCall(LamPlotTable(request, database));
  else {
    PetscCall(LamSliceRefuse(request));
    PetscCall(PlotRecords(request, database));
  }
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}
