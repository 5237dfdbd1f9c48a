/*
  Picture of a file of RVE states: the deformed tissue at one state, and the stress-load curves of all.
*/
#include "plot.h"
#include <math.h>
#include <string.h>

typedef struct {
  const char *name, *label, *unit; /* name: of the dataset and of --field */
} RVEFieldRow;
static const RVEFieldRow RVEFields[] = {
    {"wall_stress", "largest principal Cauchy stress", "MPa"},
    {"fibre_stretch", "fibre stretch", NULL},
};

static const LamColour WallLine = {0.12, 0.12, 0.16}, Lumen = {0.90, 0.945, 0.97}, Reference = {0.80, 0.15, 0.05};
static const PetscReal NeighbourFade = 0.55; /* share of white in the periodic images */

typedef struct {
  LamDatabase database; /* owned; lends records and keys */
  PetscInt record_count;
  const LamResponse *records;
  const PetscInt64 *keys;
  LamMicrostructure micro;
  LamScales scales;
  PetscInt index; /* of the state drawn, into records */
  const RVEFieldRow *field;
  PetscInt node_count, element_count;
  PetscReal *nodes, *x, *values; /* [node][2], [node][2], [node]; owned */
  PetscInt *elements, *cell_of;  /* owned */
  PetscReal *period;             /* [2][2], rows, reference; owned */
  LamOutline outline;            /* loops per cell: walls outside, lumens inside */
  PetscBool has_interface;       /* contact tissue */
  LamInterface interface;
} RVEPicture;

static PetscErrorCode FindField(const LamPlotRequest *request, const RVEFieldRow **field)
{
  PetscFunctionBeginUser;
  *field = &RVEFields[0];
  if (!request->field) PetscFunctionReturn(0);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(RVEFields); i++) {
    if (strcmp(request->field, RVEFields[i].name)) continue;
    *field = &RVEFields[i];
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "--field %s: a file of RVE states has wall_stress and fibre_stretch",
          request->field);
}

static PetscErrorCode FieldName(const RVEPicture *p, const char member[], size_t size, char name[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, size, "/fields/%" PetscInt64_FMT "/%s", p->keys[p->index], member));
  PetscFunctionReturn(0);
}

/* The asked state, or the last one that has an answer. */
static PetscErrorCode FindState(const LamPlotRequest *request, RVEPicture *p)
{
  PetscInt i = p->record_count - 1;

  PetscFunctionBeginUser;
  PetscCheck(p->record_count > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no states", request->input);
  if (request->state < 0) {
    while (i >= 0 && !LamResponseHasFields(&p->records[i])) i--;
    PetscCheck(i >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: no state has an answer to draw; the first is %s: %s",
               request->input, LamStatusNames[p->records[0].status], p->records[0].reason);
  } else {
    while (i >= 0 && p->keys[i] != request->state) i--;
    PetscCheck(i >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "--state %" PetscInt_FMT ": %s holds states %" PetscInt64_FMT " to %" PetscInt64_FMT, request->state,
               request->input, p->keys[0], p->keys[p->record_count - 1]);
    PetscCheck(LamResponseHasFields(&p->records[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "--state %" PetscInt_FMT ": has no fields to draw; it is %s: %s", request->state,
               LamStatusNames[p->records[i].status], p->records[i].reason);
  }
  p->index = i;
  PetscFunctionReturn(0);
}

static PetscErrorCode LoadRVE(const LamPlotRequest *request, RVEPicture *p)
{
  const char *path = request->input, *hash;
  PetscBool found;
  PetscInt rank, dims[4], count;
  char name[96];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(p, sizeof *p));
  PetscCall(FindField(request, &p->field));
  PetscCall(LamDatabaseOpen(path, &p->database));
  PetscCall(LamDatabaseGetRecords(p->database, &p->record_count, &p->records, &p->keys));
  PetscCall(LamDatabaseGetMicrostructure(p->database, &p->micro, &p->scales, &hash));
  PetscCall(FindState(request, p));
  PetscCall(LamPlotReadPoints(path, "/mesh/nodes", -1, &p->node_count, &p->nodes));
  PetscCall(LamPlotReadElements(path, "/mesh/elements", p->node_count, &p->element_count, &p->elements));
  PetscCall(LamPlotReadReals(path, "/mesh/period", 2, 2, &p->period));
  PetscCall(LamFileReadInts(path, "/mesh/cell_of", &found, &rank, dims, &p->cell_of));
  PetscCheck(found && rank == 1 && dims[0] == p->element_count, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /mesh/cell_of is missing or damaged", path);
  PetscCall(FieldName(p, "x", sizeof name, name));
  PetscCall(LamPlotReadPoints(path, name, p->node_count, &count, &p->x));
  PetscCall(FieldName(p, p->field->name, sizeof name, name));
  PetscCall(LamPlotReadReals(path, name, p->node_count, 1, &p->values));
  PetscCall(LamOutlineCreate(p->element_count, p->elements, p->cell_of, &p->outline));
  p->has_interface = (PetscBool)(p->micro.interface == LAM_INTERFACE_CONTACT);
  if (p->has_interface) PetscCall(LamInterfaceRead(path, p->keys[p->index], &p->interface));
  PetscFunctionReturn(0);
}

static PetscErrorCode UnloadRVE(RVEPicture *p)
{
  PetscFunctionBeginUser;
  PetscCall(LamOutlineDestroy(&p->outline));
  PetscCall(LamInterfaceDestroy(&p->interface));
  PetscCall(PetscFree(p->nodes));
  PetscCall(PetscFree(p->x));
  PetscCall(PetscFree(p->values));
  PetscCall(PetscFree(p->elements));
  PetscCall(PetscFree(p->cell_of));
  PetscCall(PetscFree(p->period));
  PetscCall(LamDatabaseClose(&p->database));
  PetscFunctionReturn(0);
}

/* A patch has no period. */
static PetscBool IsPeriodic(const RVEPicture *p)
{
  return (PetscBool)(p->period[0] != 0 || p->period[1] != 0);
}

/* Moves the reference so that both centroids coincide: a translation has no meaning in a periodic tissue. */
static void CentreReference(const RVEPicture *p, PetscReal shift[2])
{
  shift[0] = shift[1] = 0;
  for (PetscInt i = 0; i < p->node_count; i++)
    for (int k = 0; k < 2; k++) shift[k] += (p->x[2 * i + k] - p->nodes[2 * i + k]) / p->node_count;
}

/* Images x + F.S of the RVE that show in the view; the RVE itself comes last, so that it lies on top. */
static PetscErrorCode VisibleImages(const RVEPicture *p, const LamView *view, PetscInt *count, LamImage **images)
{
  const PetscReal *F = p->records[p->index].load.F, none[2] = {0, 0};
  const PetscInt reach = IsPeriodic(p) ? 12 : 0;
  PetscReal box[4];
  PetscInt n = 0;

  PetscFunctionBeginUser;
  LamBoxEmpty(box);
  LamBoxExtend(box, p->node_count, p->x, none);
  PetscCall(PetscMalloc1((2 * reach + 1) * (2 * reach + 1), images));
  for (PetscInt i = -reach; i <= reach; i++) {
    for (PetscInt j = -reach; j <= reach; j++) {
      const PetscReal S[2] = {i * p->period[0] + j * p->period[2], i * p->period[1] + j * p->period[3]};
      const LamImage image = {{F[0] * S[0] + F[1] * S[1], F[3] * S[0] + F[4] * S[1]}, NeighbourFade};

      if ((i || j) && LamViewShows(view, box, image.shift)) (*images)[n++] = image;
    }
  }
  (*images)[n++] = (LamImage){{0, 0}, 0};
  *count = n;
  PetscFunctionReturn(0);
}

/* Path of the outer (or lumen) loops of one image, as far as they show. */
static void LoopsPath(LamCanvas canvas, const LamView *view, const RVEPicture *p, PetscBool lumens,
                      const PetscReal shift[2])
{
  cairo_new_path(LamCanvasCairo(canvas));
  for (PetscInt k = 0; k < p->outline.loop_count; k++) {
    const PetscInt first = p->outline.loop_start[k], end = p->outline.loop_start[k + 1];
    const PetscReal none[2] = {0, 0};
    PetscReal box[4];

    if ((LamOutlineLoopArea(&p->outline, k, p->nodes) < 0) != lumens) continue;
    LamBoxEmpty(box);
    for (PetscInt i = first; i < end; i++)
      LamBoxExtend(box, 1, &p->x[2 * p->outline.edges[p->outline.loop_edges[i]].start], none);
    if (LamViewShows(view, box, shift)) LamOutlineLoopPath(canvas, view, &p->outline, k, p->x, shift);
  }
}

/* Whether another cell's outer wall lies on this edge of the reference: then the edge is inside the RVE. */
static PetscBool HasPartner(const RVEPicture *p, const LamEdge *edge)
{
  const PetscReal *m = &p->nodes[2 * edge->middle];

  for (PetscInt i = 0; i < p->outline.edge_count && p->outline.edges[i].boundary; i++) {
    const LamEdge *other = &p->outline.edges[i];
    const PetscReal *n = &p->nodes[2 * other->middle];

    if (other->group != edge->group && hypot(m[0] - n[0], m[1] - n[1]) < 1e-6) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Path of the undeformed outline of the RVE as a whole. */
static void ReferencePath(LamCanvas canvas, const LamView *view, const RVEPicture *p, const PetscReal shift[2])
{
  const LamOutline *o = &p->outline;

  cairo_new_path(LamCanvasCairo(canvas));
  for (PetscInt k = 0; k < o->loop_count; k++) {
    PetscBool drawing = PETSC_FALSE;

    if (LamOutlineLoopArea(o, k, p->nodes) < 0) continue;
    for (PetscInt i = o->loop_start[k]; i < o->loop_start[k + 1]; i++) {
      const LamEdge *edge = &o->edges[o->loop_edges[i]];
      const PetscBool inside = HasPartner(p, edge);

      if (!inside) LamOutlineEdgePath(canvas, view, edge, p->nodes, shift, drawing);
      drawing = (PetscBool)!inside;
    }
  }
}

static LamColour Fade(LamColour colour, PetscReal fade)
{
  return (LamColour){colour.r + fade * (1 - colour.r), colour.g + fade * (1 - colour.g),
                     colour.b + fade * (1 - colour.b)};
}

static void StrokeReference(LamCanvas canvas, double width)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const double dash[] = {3.5, 2.0};

  LamCanvasSetColour(canvas, Reference);
  cairo_set_dash(cr, dash, 2, 0);
  cairo_set_line_width(cr, width);
  cairo_stroke(cr);
  cairo_set_dash(cr, NULL, 0, 0);
}

/* Lumens, walls with their field, outlines; everything inside the frame of the view. */
static PetscErrorCode DrawTissue(LamCanvas canvas, const LamView *view, const RVEPicture *p,
                                 const LamColourRange *range, const PetscReal reference[2])
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const LamField field = {p->element_count, p->x, p->elements, p->values, PETSC_FALSE};
  const LamRect f = view->frame;
  LamImage *images;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  PetscCall(VisibleImages(p, view, &count, &images));
  cairo_save(cr);
  cairo_rectangle(cr, f.x, f.y, f.width, f.height);
  cairo_clip(cr);
  for (PetscInt i = 0; i < count; i++) {
    LoopsPath(canvas, view, p, PETSC_TRUE, images[i].shift);
    LamCanvasSetColour(canvas, Fade(Lumen, images[i].fade));
    cairo_fill(cr);
  }
  PetscCall(LamFieldPaint(canvas, view, &field, range, count, images));
  for (PetscInt i = 0; i < count; i++) {
    LamCanvasSetColour(canvas, Fade(WallLine, 0.8 * images[i].fade));
    LoopsPath(canvas, view, p, PETSC_TRUE, images[i].shift);
    cairo_set_line_width(cr, 0.4);
    cairo_stroke(cr);
    LoopsPath(canvas, view, p, PETSC_FALSE, images[i].shift);
    cairo_set_line_width(cr, images[i].fade > 0 ? 0.5 : 0.9);
    cairo_stroke(cr);
  }
  ReferencePath(canvas, view, p, reference);
  StrokeReference(canvas, 0.9);
  for (PetscInt i = 0; i < count && p->has_interface; i++) {
    LamInterfaceDrawPressure(canvas, view, &p->interface, images[i].shift);
    LamInterfaceDrawGaps(canvas, view, &p->interface, images[i].shift);
  }
  cairo_restore(cr);
  LamCanvasSetColour(canvas, WallLine);
  cairo_set_line_width(cr, 0.6);
  cairo_rectangle(cr, f.x, f.y, f.width, f.height);
  cairo_stroke(cr);
  PetscCall(PetscFree(images));
  PetscFunctionReturn(0);
}

/* "State 5:  F = [1, 0.3; 0, 1],  p = 0.02 MPa" */
static PetscErrorCode Title(const RVEPicture *p, size_t size, char title[])
{
  const LamResponse *response = &p->records[p->index];
  const PetscReal *F = response->load.F;
  const PetscBool plane = (PetscBool)(F[2] == 0 && F[5] == 0 && F[6] == 0 && F[7] == 0 && F[8] == 1);
  const int n = plane ? 2 : 3;
  char number[32], item[96];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(title, size, "State %" PetscInt64_FMT ":  $F$ = [", p->keys[p->index]));
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      LamFormatNumber(F[3 * i + j], number);
      PetscCall(PetscSNPrintf(item, sizeof item, "%s%s", j ? ", " : i ? "; " : "", number));
      PetscCall(PetscStrlcat(title, item, size));
    }
  }
  LamFormatNumber(response->load.turgor * p->scales.stress * 1e-6, number);
  PetscCall(PetscSNPrintf(item, sizeof item, "],  turgor $p$ = %s MPa", number));
  PetscCall(PetscStrlcat(title, item, size));
  if (p->micro.interface != LAM_INTERFACE_BONDED) {
    LamFormatNumber(response->load.cohesion * p->scales.stress * 1e-6, number);
    PetscCall(PetscSNPrintf(item, sizeof item, ",  cohesion $g$ = %s MPa", number));
    PetscCall(PetscStrlcat(title, item, size));
  }
  if (response->status == LAM_UNSTABLE) PetscCall(PetscStrlcat(title, "  (unstable)", size));
  PetscFunctionReturn(0);
}

static const double KeyRow = 10;

/* Scale bar, and what the dashed line, the paler cells and the ribbons are; as far as `right`. */
static void DrawKey(LamCanvas canvas, const LamView *view, double right, const RVEPicture *p)
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const LamRect f = view->frame;
  const double y = f.y + f.height + 11;
  const char *reference = IsPeriodic(p) ? "undeformed;  paler: periodic images" : "undeformed";
  const double width = LamCanvasTextWidth(canvas, LAM_TICK_SIZE, reference);

  LamScaleBar(canvas, view, f.x, y, 0.18 * f.width, 1e-6 / p->scales.length, "µm");
  cairo_move_to(cr, right - width - 23, y);
  cairo_rel_line_to(cr, 19, 0);
  StrokeReference(canvas, 0.9);
  LamCanvasSetColour(canvas, WallLine);
  LamCanvasText(canvas, right, y, 1, 0, LAM_TICK_SIZE, reference);
  if (p->has_interface) LamInterfaceDrawKey(canvas, f.x, y + KeyRow, &p->interface);
}

static PetscErrorCode DrawPanel(LamCanvas canvas, LamRect outer, const RVEPicture *p)
{
  /* apothems: the nearest neighbours show; at contact less of them, for the sake of the gaps */
  const PetscReal none[2] = {0, 0}, margin = p->has_interface ? 0.5 : 1.1;
  const double right = outer.x + outer.width;
  PetscReal reference[2], box[4];
  LamColourRange range;
  LamView view;

  PetscFunctionBeginUser;
  PetscCall(LamColourRangeFind(p->node_count, p->values, &range));
  outer.width -= LamColourBarWidth(canvas, &range);
  if (p->has_interface) outer.height -= KeyRow;
  if (p->interface.is_open) outer.width -= LamColourBarWidth(canvas, &p->interface.gaps);
  CentreReference(p, reference);
  LamBoxEmpty(box);
  LamBoxExtend(box, p->node_count, p->x, none);
  LamBoxExtend(box, p->node_count, p->nodes, reference);
  for (int k = 0; k < 2; k++) {
    box[k] -= margin;
    box[2 + k] += margin;
  }
  LamViewFit(outer, box, &view);
  PetscCall(DrawTissue(canvas, &view, p, &range, reference));
  LamColourBar(canvas, outer, &range, LamColourMap, p->field->label, p->field->unit);
  DrawKey(canvas, &view, p->interface.is_open ? right : outer.x + outer.width, p);
  if (!p->interface.is_open) PetscFunctionReturn(0);
  outer.width += LamColourBarWidth(canvas, &range);
  LamColourBar(canvas, outer, &p->interface.gaps, LamGapColour, "gap", "apothems");
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotRVE(const LamPlotRequest *request)
{
  const LamRect left = {9, 25.2, 282, LAM_PLOT_HEIGHT - 51},
                right = {308, 21, LAM_PLOT_WIDTH - 316, LAM_PLOT_HEIGHT - 24};
  RVEPicture picture;
  LamCanvas canvas;
  char title[512];

  PetscFunctionBeginUser;
  PetscCall(LoadRVE(request, &picture));
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_PLOT_HEIGHT, &canvas));
  PetscCall(Title(&picture, sizeof title, title));
  LamCanvasSetColour(canvas, WallLine);
  LamCanvasText(canvas, left.x, 12, 0, 0, LAM_TEXT_SIZE + 0.75, title);
  PetscCall(DrawPanel(canvas, left, &picture));
  PetscCall(LamStressChart(canvas, right, picture.record_count, picture.records, picture.keys, &picture.scales));
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(UnloadRVE(&picture));
  PetscFunctionReturn(0);
}
