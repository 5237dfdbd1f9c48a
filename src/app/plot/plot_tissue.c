/*
  Cells in a picture: walls with a field, lumens, outlines, gaps and pressure, and periodic images in paler colours.
*/
#include "plot_tissue.h"
#include <math.h>
#include <string.h>

static const LamWallField Fields[] = {
    {"wall_stress", "largest principal Cauchy stress", "MPa"},
    {"fibre_stretch", "fibre stretch", NULL},
};

static const LamColour Lumen = {0.90, 0.945, 0.97}, Reference = {0.80, 0.15, 0.05};
static const PetscReal NeighbourFade = 0.55; /* fraction of white in the periodic images */
static const double WidestLamella = 1.3;     /* points */
static const double ThinnestWall = 1.5;      /* points in which the colours of a wall are still told apart */

const char *LamPlotRVEField(size_t i)
{
  return i < PETSC_STATIC_ARRAY_LENGTH(Fields) ? Fields[i].name : NULL;
}

PetscErrorCode LamWallFieldFind(const char name[], const LamWallField **field)
{
  PetscFunctionBeginUser;
  *field = &Fields[0];
  if (!name) PetscFunctionReturn(0);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Fields); i++) {
    if (strcmp(name, Fields[i].name)) continue;
    *field = &Fields[i];
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "--field %s: a file of RVE states has wall_stress and fibre_stretch",
          name);
}

/* ---- reading ---- */

PetscErrorCode LamTissueRead(const char path[], const char mesh[], const char fields[], const LamWallField *field,
                             PetscBool has_interface, const PetscReal F[9], LamTissue *t)
{
  PetscInt count;
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(t, sizeof *t));
  PetscCall(PetscArraycpy(t->F, F, 9));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s/nodes", mesh));
  PetscCall(LamPlotReadPoints(path, name, -1, &t->node_count, &t->nodes));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s/elements", mesh));
  PetscCall(LamPlotReadElements(path, name, t->node_count, &t->element_count, &t->elements));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s/period", mesh));
  PetscCall(LamPlotReadReals(path, name, 2, 2, &t->period));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s/cell_of", mesh));
  PetscCall(LamPlotReadInts(path, name, t->element_count, 1, &t->cell_of));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s/x", fields));
  PetscCall(LamPlotReadPoints(path, name, t->node_count, &count, &t->x));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s/%s", fields, field->name));
  PetscCall(LamPlotReadReals(path, name, t->node_count, 1, &t->values));
  PetscCall(LamOutlineCreate(t->element_count, t->elements, t->cell_of, &t->outline));
  t->has_interface = has_interface;
  if (has_interface) PetscCall(LamInterfaceRead(path, fields, &t->interface));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTissueDestroy(LamTissue *t)
{
  PetscFunctionBeginUser;
  PetscCall(LamOutlineDestroy(&t->outline));
  PetscCall(LamInterfaceDestroy(&t->interface));
  PetscCall(PetscFree(t->nodes));
  PetscCall(PetscFree(t->x));
  PetscCall(PetscFree(t->values));
  PetscCall(PetscFree(t->elements));
  PetscCall(PetscFree(t->cell_of));
  PetscCall(PetscFree(t->period));
  PetscFunctionReturn(0);
}

/* ---- drawing ---- */

PetscBool LamTissueIsPeriodic(const LamTissue *t)
{
  return (PetscBool)(t->period[0] != 0 || t->period[1] != 0);
}

void LamTissueCentreReference(const LamTissue *t, PetscReal shift[2])
{
  shift[0] = shift[1] = 0;
  for (PetscInt i = 0; i < t->node_count; i++)
    for (int k = 0; k < 2; k++) shift[k] += (t->x[2 * i + k] - t->nodes[2 * i + k]) / t->node_count;
}

/* Images x + F.S of the RVE that are visible in the view; the RVE itself comes last, so that it lies on top. */
static PetscErrorCode VisibleImages(const LamTissue *t, const LamView *view, PetscInt *count, LamImage **images)
{
  const PetscReal *F = t->F;
  const PetscInt reach = LamTissueIsPeriodic(t) ? 12 : 0;
  PetscReal box[4] = LAM_EMPTY_BOX;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  LamBoxExtend(box, t->node_count, t->x, NULL);
  PetscCall(PetscMalloc1((2 * reach + 1) * (2 * reach + 1), images));
  for (PetscInt i = -reach; i <= reach; i++) {
    for (PetscInt j = -reach; j <= reach; j++) {
      const PetscReal S[2] = {i * t->period[0] + j * t->period[2], i * t->period[1] + j * t->period[3]};
      const LamImage image = {{F[0] * S[0] + F[1] * S[1], F[3] * S[0] + F[4] * S[1]}, NeighbourFade};

      if ((i || j) && LamViewShows(view, box, image.shift)) (*images)[n++] = image;
    }
  }
  (*images)[n++] = (LamImage){{0, 0}, 0};
  *count = n;
  PetscFunctionReturn(0);
}

static PetscBool IsLumen(const LamTissue *t, PetscInt loop)
{
  return (PetscBool)(LamOutlineLoopArea(&t->outline, loop, t->nodes) < 0);
}

/* Path of the outer (or lumen) loops of one image, as far as they are visible. */
static void LoopsPath(LamCanvas canvas, const LamView *view, const LamTissue *t, PetscBool lumens,
                      const PetscReal shift[2])
{
  cairo_new_path(LamCanvasCairo(canvas));
  for (PetscInt k = 0; k < t->outline.loop_count; k++) {
    const PetscInt first = t->outline.loop_start[k], end = t->outline.loop_start[k + 1];
    PetscReal box[4] = LAM_EMPTY_BOX;

    if (IsLumen(t, k) != lumens) continue;
    for (PetscInt i = first; i < end; i++)
      LamBoxExtend(box, 1, &t->x[2 * t->outline.edges[t->outline.loop_edges[i]].start], NULL);
    if (LamViewShows(view, box, shift)) LamOutlineLoopPath(canvas, view, &t->outline, k, t->x, shift);
  }
}

/* Whether another cell's outer wall lies on this edge of the reference: then the edge is inside the RVE. */
static PetscBool HasPartner(const LamTissue *t, const LamEdge *edge)
{
  const PetscReal *m = &t->nodes[2 * edge->middle];

  for (PetscInt i = 0; i < t->outline.edge_count && t->outline.edges[i].boundary; i++) {
    const LamEdge *other = &t->outline.edges[i];
    const PetscReal *n = &t->nodes[2 * other->middle];

    if (other->group != edge->group && hypot(m[0] - n[0], m[1] - n[1]) < 1e-6) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Path of the undeformed outline of the RVE as a whole. */
static void ReferencePath(LamCanvas canvas, const LamView *view, const LamTissue *t, const PetscReal shift[2])
{
  const LamOutline *o = &t->outline;

  cairo_new_path(LamCanvasCairo(canvas));
  for (PetscInt k = 0; k < o->loop_count; k++) {
    PetscBool drawing = PETSC_FALSE;

    if (IsLumen(t, k)) continue;
    for (PetscInt i = o->loop_start[k]; i < o->loop_start[k + 1]; i++) {
      const LamEdge *edge = &o->edges[o->loop_edges[i]];
      const PetscBool inside = HasPartner(t, edge);

      if (!inside) LamOutlineEdgePath(canvas, view, edge, t->nodes, shift, drawing);
      drawing = (PetscBool)!inside;
    }
  }
}

static LamColour Fade(LamColour colour, PetscReal fade)
{
  return (LamColour){colour.r + fade * (1 - colour.r), colour.g + fade * (1 - colour.g),
                     colour.b + fade * (1 - colour.b)};
}

void LamStrokeUndeformed(LamCanvas canvas)
{
  LamCanvasStroke(canvas, Reference, 0.9, (const double[]){3.5, 2.0});
}

void LamUndeformedKey(LamCanvas canvas, double left, double right, double y, const char label[])
{
  const double sample = 19, gap = 4, room = right - left - 2 * gap - sample,
               width = PetscMin(room, LamCanvasTextWidth(canvas, LAM_TICK_SIZE, label));

  LamCanvasLine(canvas, right - width - gap - sample, y, right - width - gap, y);
  LamStrokeUndeformed(canvas);
  LamCanvasSetColour(canvas, LamDarkInk);
  LamCanvasTextFit(canvas, right, y, 1, 0, LAM_TICK_SIZE, room, label);
}

static PetscInt LoopCell(const LamTissue *t, PetscInt loop)
{
  return t->outline.edges[t->outline.loop_edges[t->outline.loop_start[loop]]].group;
}

/* Mean thickness of the wall inside an outer loop: its area over the length of the loop. */
static PetscReal WallThickness(const LamTissue *t, PetscInt loop)
{
  const LamOutline *o = &t->outline;
  PetscReal area = 0, length = 0;

  for (PetscInt k = 0; k < o->loop_count; k++)
    if (LoopCell(t, k) == LoopCell(t, loop)) area += LamOutlineLoopArea(o, k, t->x);
  for (PetscInt i = o->loop_start[loop]; i < o->loop_start[loop + 1]; i++) {
    const LamEdge *edge = &o->edges[o->loop_edges[i]];

    length += hypot(t->x[2 * edge->end] - t->x[2 * edge->start], t->x[2 * edge->end + 1] - t->x[2 * edge->start + 1]);
  }
  return area / PetscMax(length, 1e-30);
}

static PetscReal ElementMean(const LamTissue *t, PetscInt element)
{
  const PetscInt *nodes = &t->elements[9 * element];
  const int n = LamElementNodes(nodes);
  PetscReal sum = 0;

  for (int a = 0; a < n; a++) sum += t->values[nodes[a]];
  return sum / n;
}

/* Colours a wall as wide as the thinnest that is seen, inwards from its outer loop, by the means of its elements. */
static void WidenWall(LamCanvas canvas, const LamView *view, const LamTissue *t, PetscInt loop,
                      const LamColourRange *range, const LamImage *image)
{
  const LamOutline *o = &t->outline;
  cairo_t *cr = LamCanvasCairo(canvas);

  cairo_save(cr);
  cairo_new_path(cr);
  LamOutlineLoopPath(canvas, view, o, loop, t->x, image->shift);
  cairo_clip(cr);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND); /* no gaps at corners */
  for (PetscInt i = o->loop_start[loop]; i < o->loop_start[loop + 1]; i++) {
    const LamEdge *edge = &o->edges[o->loop_edges[i]];

    LamOutlineEdgePath(canvas, view, edge, t->x, image->shift, PETSC_FALSE);
    LamCanvasStroke(canvas, Fade(LamColourMap(LamColourShare(range, ElementMean(t, edge->element))), image->fade),
                    2 * ThinnestWall, NULL);
  }
  cairo_restore(cr);
}

/* The walls of one image that would be too thin to be seen. */
static void WidenWalls(LamCanvas canvas, const LamView *view, const LamTissue *t, const LamColourRange *range,
                       const LamImage *image)
{
  for (PetscInt k = 0; k < t->outline.loop_count; k++)
    if (!IsLumen(t, k) && WallThickness(t, k) * view->scale < ThinnestWall) WidenWall(canvas, view, t, k, range, image);
}

/* The thinnest wall, in points. */
static double LeastThickness(const LamTissue *t, const LamView *view)
{
  double least = PETSC_MAX_REAL;

  for (PetscInt k = 0; k < t->outline.loop_count; k++)
    if (!IsLumen(t, k)) least = PetscMin(least, WallThickness(t, k) * view->scale);
  return least;
}

PetscErrorCode LamTissueDraw(LamCanvas canvas, const LamView *view, const LamTissue *t, const LamColourRange *range,
                             const PetscReal reference[2])
{
  const LamField field = {t->element_count, t->x, t->elements, t->values, PETSC_FALSE};
  const double thickness = LeastThickness(t, view), widest = 0.25 * PetscMax(thickness, ThinnestWall);
  const double lamella = PetscMin(WidestLamella, 1.6 * widest);
  const PetscBool thin =
      (PetscBool)(thickness < ThinnestWall); /* lumens' outlines would be in the middle of the wall */
  LamImage *images;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  PetscCall(VisibleImages(t, view, &count, &images));
  LamCanvasClip(canvas, view->frame);
  for (PetscInt i = 0; i < count; i++) {
    LoopsPath(canvas, view, t, PETSC_TRUE, images[i].shift);
    LamCanvasFill(canvas, Fade(Lumen, images[i].fade));
  }
  PetscCall(LamFieldPaint(canvas, view, &field, range, count, images));
  for (PetscInt i = 0; i < count; i++) {
    const LamColour line = Fade(LamDarkInk, 0.8 * images[i].fade);

    if (thin) WidenWalls(canvas, view, t, range, &images[i]);
    LoopsPath(canvas, view, t, PETSC_TRUE, images[i].shift);
    if (!thin) LamCanvasStroke(canvas, line, PetscMin(0.4, 0.5 * widest), NULL);
    LoopsPath(canvas, view, t, PETSC_FALSE, images[i].shift);
    LamCanvasStroke(canvas, line, PetscMin(widest, images[i].fade > 0 ? 0.5 : 0.9), NULL);
  }
  if (reference) {
    ReferencePath(canvas, view, t, reference);
    LamStrokeUndeformed(canvas);
  }
  for (PetscInt i = 0; i < count && t->has_interface; i++) {
    LamInterfaceDrawPressure(canvas, view, &t->interface, images[i].shift, lamella);
    LamInterfaceDrawLamella(canvas, view, &t->interface, images[i].shift, lamella);
    LamInterfaceDrawGaps(canvas, view, &t->interface, images[i].shift);
  }
  cairo_restore(LamCanvasCairo(canvas));
  LamCanvasBox(canvas, view->frame);
  LamCanvasStroke(canvas, LamDarkInk, 0.6, NULL);
  PetscCall(PetscFree(images));
  PetscFunctionReturn(0);
}
