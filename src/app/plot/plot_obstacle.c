/*
  What is rigid beside a body: plates, indenters, grips.
*/
#include "plot_fe2.h"
#include "names.h"
#include <math.h>

static const LamColour Rigid = {0.74, 0.74, 0.77};
static const double Thickness = 5; /* points, of plates and grips */
/* Share of the body's size that a plate takes beside it, and at most an indenter. */
static const PetscReal PlateShare = 0.05, IndenterShare = 0.25;

PetscErrorCode LamObstaclesRead(const char path[], PetscInt step, LamObstacles *o)
{
  PetscBool found, finite = PETSC_TRUE;
  PetscInt rank, dims[4];
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(LamObstaclesDestroy(o));
  PetscCall(PetscSNPrintf(name, sizeof name, "/macro/step/%" PetscInt_FMT "/obstacles", step));
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, &o->rows));
  if (!found) PetscFunctionReturn(0);
  for (PetscInt i = 0; rank == 2 && i < dims[0] * dims[1]; i++) finite = (PetscBool)(finite && isfinite(o->rows[i]));
  PetscCheck(rank == 2 && dims[1] == 5 && finite, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is damaged", path,
             name);
  o->count = dims[0];
  PetscFunctionReturn(0);
}

PetscErrorCode LamObstaclesDestroy(LamObstacles *o)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(o->rows));
  o->count = 0;
  PetscFunctionReturn(0);
}

void LamObstaclesExtend(const LamObstacles *o, PetscReal size, PetscReal box[4])
{
  const PetscReal middle[2] = {0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])};

  for (PetscInt k = 0; k < o->count; k++) {
    const PetscReal *x = &o->rows[5 * k], *n = x + 2, radius = x[4];
    const PetscReal height = (middle[0] - x[0]) * n[0] + (middle[1] - x[1]) * n[1];
    PetscReal point[2];

    for (int i = 0; i < 2; i++)
      point[i] = radius > 0 ? x[i] + n[i] * (radius - PetscMin(2 * radius, IndenterShare * size))
                            : middle[i] - n[i] * (height + PlateShare * size);
    LamBoxExtend(box, 1, point, NULL);
  }
}

/* A slab across the whole view, behind the plate's face. */
static void PlatePath(LamCanvas canvas, const LamView *view, const PetscReal row[5])
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double far = 4 * (view->frame.width + view->frame.height), n[2] = {row[2], -row[3]}; /* y is downwards */
  const LamRect f = view->frame;
  const double middle[2] = {f.x + 0.5 * f.width, f.y + 0.5 * f.height};
  double x[2], height;

  LamViewPoint(view, row[0], row[1], x);
  height = (middle[0] - x[0]) * n[0] + (middle[1] - x[1]) * n[1];
  for (int corner = 0; corner < 4; corner++) {
    const double along = corner == 0 || corner == 3 ? -far : far, behind = height + (corner / 2 ? Thickness : 0);

    cairo_line_to(cr, middle[0] - behind * n[0] - along * n[1], middle[1] - behind * n[1] + along * n[0]);
  }
  cairo_close_path(cr);
}

static void FillRigid(LamCanvas canvas)
{
  LamCanvasSetColour(canvas, Rigid);
  cairo_fill_preserve(LamCanvasCairo(canvas));
  LamCanvasStroke(canvas, LamDarkInk, 0.6, NULL);
}

void LamObstaclesDraw(LamCanvas canvas, const LamView *view, const LamObstacles *o)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  double centre[2];

  LamCanvasClip(canvas, view->frame);
  for (PetscInt k = 0; k < o->count; k++) {
    const PetscReal *row = &o->rows[5 * k];

    cairo_new_path(cr);
    LamViewPoint(view, row[0], row[1], centre);
    if (row[4] > 0)
      cairo_arc(cr, centre[0], centre[1], row[4] * view->scale, 0, 2 * M_PI);
    else
      PlatePath(canvas, view, row);
    FillRigid(canvas);
  }
  cairo_restore(cr);
}

PetscErrorCode LamGripsRead(const char path[], PetscInt node_count, PetscInt **gripped)
{
  PetscBool found;
  PetscInt rank, dims[4];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, "/macro/gripped", &found, &rank, dims, gripped));
  if (!found) *gripped = NULL; /* an older file */
  PetscCheck(!found || (rank == 1 && dims[0] == node_count), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /macro/gripped is damaged", path);
  PetscFunctionReturn(0);
}

static PetscBool IsGripped(const LamEdge *edge, const PetscInt gripped[])
{
  return (PetscBool)(gripped && edge->boundary && gripped[edge->start] && gripped[edge->middle] && gripped[edge->end]);
}

PetscBool LamGripsDraw(LamCanvas canvas, const LamView *view, const LamOutline *outline, const PetscReal x[],
                       const PetscInt gripped[])
{
  PetscBool has = PETSC_FALSE;

  for (int inner = 0; inner < 2; inner++) { /* the dark edge of the grey band */
    for (PetscInt i = 0; i < outline->edge_count; i++) {
      if (!IsGripped(&outline->edges[i], gripped)) continue;
      LamOutlineEdgePath(canvas, view, &outline->edges[i], x, NULL, PETSC_FALSE);
      has = PETSC_TRUE;
    }
    LamCanvasStroke(canvas, inner ? Rigid : LamDarkInk, inner ? 2 * Thickness - 1.2 : 2 * Thickness, NULL);
  }
  return has;
}

double LamObstaclesKey(LamCanvas canvas, double x, double y, const LamObstacles *o, PetscBool grips)
{
  PetscInt indenters = 0;
  char label[64] = "";

  for (PetscInt k = 0; k < o->count; k++) indenters += o->rows[5 * k + 4] > 0;
  if (indenters < o->count) LamNamesAppend(sizeof label, label, ", ", "plate");
  if (indenters) LamNamesAppend(sizeof label, label, ", ", "indenter");
  if (grips) LamNamesAppend(sizeof label, label, ", ", "grip");
  if (!*label) return 0;
  LamCanvasBox(canvas, (LamRect){x, y - 0.5 * Thickness, 2 * Thickness, Thickness});
  FillRigid(canvas);
  LamCanvasText(canvas, x + 2 * Thickness + 4, y, 0, 0, LAM_TICK_SIZE, label);
  return 2 * Thickness + 4 + LamCanvasTextWidth(canvas, LAM_TICK_SIZE, label);
}
