/*
  Picture of a file of RVE states: the deformed tissue at one state, and the stress-load curves of all.
*/
#include "plot_tissue.h"
#include <stdio.h>

typedef struct {
  LamDatabase database; /* owned */
  LamPlotRecords of;    /* the states */
  PetscInt index, peak; /* of the state drawn, of the peak of the stress, -1: none */
  const LamWallField *field;
  LamTissue tissue;
  LamScene *scene; /* that the file was made of; NULL: unknown; owned */
  LamTest test;
} RVEPicture;

/* The requested state, or the last one where there is no peak. */
static PetscErrorCode FindState(const LamPlotRequest *request, RVEPicture *p)
{
  PetscInt i = p->of.n - 1;

  PetscFunctionBeginUser;
  PetscCheck(p->of.n > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no states", request->input);
  p->peak = LamStressPeak(p->of.n, p->of.records);
  if (request->state < 0) {
    while (i >= 0 && !LamResponseHasFields(&p->of.records[i])) i--;
    PetscCheck(i >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: no state has a response to draw; the first is %s: %s", request->input,
               LamStatusNames[p->of.records[0].status], p->of.records[0].reason);
    if (request->state == LAM_PLOT_PEAK && p->peak >= 0) i = p->peak;
  } else {
    while (i >= 0 && p->of.keys[i] != request->state) i--;
    PetscCheck(i >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "--state %" PetscInt_FMT ": %s holds states %" PetscInt64_FMT " to %" PetscInt64_FMT, request->state,
               request->input, p->of.keys[0], p->of.keys[p->of.n - 1]);
    PetscCheck(LamResponseHasFields(&p->of.records[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "--state %" PetscInt_FMT ": has no fields to draw; it is %s: %s", request->state,
               LamStatusNames[p->of.records[i].status], p->of.records[i].reason);
  }
  p->index = i;
  PetscFunctionReturn(0);
}

static PetscErrorCode LoadRVE(const LamPlotRequest *request, RVEPicture *p)
{
  const char *path = request->input;
  char fields[64];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(p, sizeof *p));
  PetscCall(LamWallFieldFind(request->field, &p->field));
  PetscCall(LamDatabaseOpen(path, &p->database));
  PetscCall(LamPlotGetRecords(p->database, &p->of));
  PetscCall(FindState(request, p));
  PetscCall(PetscSNPrintf(fields, sizeof fields, "/fields/%" PetscInt64_FMT, p->of.keys[p->index]));
  PetscCall(LamTissueRead(path, "/mesh", fields, p->field, LamCellsPart(p->of.micro.interface),
                          p->of.records[p->index].load.F, &p->tissue));
  PetscFunctionReturn(0);
}

/* The curve of the states. */
static PetscErrorCode FollowTest(RVEPicture *p)
{
  const LamScene *scene = p->scene;

  PetscFunctionBeginUser;
  LamTestCreate(scene, &p->test);
  for (PetscInt k = 0; k < p->of.n; k++) {
    const PetscInt64 number = p->of.keys[k];

    if (number < 1 || number > scene->load_count) continue;
    PetscCall(LamTestAdd(&p->test, (PetscInt)number, &p->of.records[k],
                         scene->controls ? &scene->controls[number - 1] : NULL));
  }
  PetscFunctionReturn(0);
}

/* A scene that cannot be read any more, such as one whose files are gone, leaves the picture without marks. */
static PetscErrorCode ReadTest(const char path[], RVEPicture *p)
{
  PetscErrorCode ierr;
  PetscBool found;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(path, "/scene", &found, &text));
  if (!found) PetscFunctionReturn(0);
  PetscCall(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  ierr = LamSceneReadText(path, text, &p->scene);
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscFree(text));
  if (!ierr) PetscCall(FollowTest(p));
  PetscFunctionReturn(0);
}

/* "State 5, peak:  F = [1, 0.3; 0, 1],  p = 0.02 MPa" */
static void Title(const RVEPicture *p, size_t size, char title[])
{
  const LamResponse *response = &p->of.records[p->index];
  const PetscReal *F = response->load.F, MPa = p->of.scales.stress * 1e-6;
  const PetscBool plane = (PetscBool)(F[2] == 0 && F[5] == 0 && F[6] == 0 && F[7] == 0 && F[8] == 1);
  const int n = plane ? 2 : 3;
  size_t at = (size_t)snprintf(title, size, "State %" PetscInt64_FMT "%s:  $F$ = [", p->of.keys[p->index],
                               p->index == p->peak ? ", peak" : "");
  char number[32];

  for (int k = 0; k < n * n; k++) {
    LamFormatRatio(F[3 * (k / n) + k % n], number);
    at += (size_t)snprintf(title + at, size - at, "%s%s", k % n ? ", " : k ? "; " : "", number);
  }
  LamFormatNumber(response->load.turgor * MPa, number);
  at += (size_t)snprintf(title + at, size - at, "],  turgor $p$ = %s MPa", number);
  LamFormatNumber(response->load.cohesion * MPa, number);
  if (p->of.micro.interface == LAM_INTERFACE_CONTACT || response->load.cohesion > 0)
    at += (size_t)snprintf(title + at, size - at, ",  cohesion $g$ = %s MPa", number);
  if (response->status == LAM_UNSTABLE) snprintf(title + at, size - at, "  (unstable)");
}

/* Scale bar, and legend of the dashed line, the paler cells and the ribbons; as far as `right`. */
static void DrawKey(LamCanvas canvas, const LamView *view, double right, const RVEPicture *p)
{
  const LamRect f = view->frame;
  const double y = f.y + f.height + 11;

  const double bar = LamScaleBar(canvas, view, f.x, y, LAM_SCALE_BAR, 1e-6 / p->of.scales.length, "µm");

  LamUndeformedKey(canvas, f.x + bar, right, y,
                   LamTissueIsPeriodic(&p->tissue) ? "undeformed;  paler: periodic images" : "undeformed");
  if (p->tissue.has_interface) LamInterfaceDrawKey(canvas, f.x, y + LAM_KEY_ROW, right, &p->tissue.interface);
}

static PetscErrorCode DrawPanel(LamCanvas canvas, LamRect outer, const RVEPicture *p)
{
  const LamTissue *tissue = &p->tissue;
  LamFrame frame = {.box = LAM_EMPTY_BOX,
                    .gaps = tissue->interface.gaps,
                    .is_open = tissue->interface.is_open,
                    .label = p->field->label,
                    .unit = p->field->unit};
  PetscReal reference[2];
  LamView view;

  PetscFunctionBeginUser;
  PetscCall(LamColourRangeFind(tissue->node_count, tissue->values, &frame.range));
  if (tissue->has_interface) outer.height -= LAM_KEY_ROW;
  LamTissueCentreReference(tissue, reference);
  LamBoxExtend(frame.box, tissue->node_count, tissue->x, NULL);
  LamBoxExtend(frame.box, tissue->node_count, tissue->nodes, reference);
  LamBoxWiden(frame.box, tissue->has_interface ? LAM_CONTACT_MARGIN : LAM_MARGIN);
  LamFrameDraw(canvas, outer, &frame, &view);
  PetscCall(LamTissueDraw(canvas, &view, tissue, &frame.range, reference));
  DrawKey(canvas, &view, outer.x + (frame.is_open ? outer.width : view.frame.width), p);
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawPage(const char output[], RVEPicture *p)
{
  const LamRect left = {9, 25.2, 282, LAM_PLOT_HEIGHT - 51},
                right = {308, 21, LAM_PLOT_WIDTH - 316, LAM_PLOT_HEIGHT - 24};
  LamCanvas canvas;
  char title[512];

  PetscFunctionBeginUser;
  PetscCall(LamCanvasCreate(output, LAM_PLOT_WIDTH, LAM_PLOT_HEIGHT, &canvas));
  Title(p, sizeof title, title);
  LamCanvasTitle(canvas, left.x, 12, title);
  PetscCall(DrawPanel(canvas, left, p));
  PetscCall(LamStressChart(canvas, right, p->of.n, p->of.records, p->of.keys, &p->of.scales, &p->test));
  PetscCall(LamCanvasFinish(&canvas));
  PetscFunctionReturn(0);
}

/* ---- strips ---- */

typedef struct {
  LamCells cells;
  PetscInt peak;
  LamLoadAxis axis;
  PetscReal *load; /* [state]; owned */
} Strip;

/* "State 3, peak:  F12 = 0.1"; as LamStrip.draw and key, ctx: a Strip. */
static PetscErrorCode DrawState(LamCanvas canvas, const LamView *view, void *ctx, PetscInt k, size_t size, char title[])
{
  const Strip *s = (const Strip *)ctx;
  const PetscInt state = s->cells.states[k];
  size_t at = (size_t)snprintf(title, size, "State %" PetscInt64_FMT "%s", s->cells.of->keys[state],
                               state == s->peak ? ", peak" : "");
  char number[32];

  PetscFunctionBeginUser;
  LamFormatRatio(s->load[state], number);
  if (!s->axis.whole)
    snprintf(title + at, size - at, ":  %s = %s%s%s", s->axis.label, number, s->axis.unit ? " " : "",
             s->axis.unit ? s->axis.unit : "");
  PetscCall(LamCellsDraw(canvas, view, &s->cells, k));
  PetscFunctionReturn(0);
}

static void DrawStripKey(LamCanvas canvas, const LamView *view, void *ctx)
{
  LamCellsKey(canvas, view, &((const Strip *)ctx)->cells);
}

static PetscErrorCode DrawStrip(const LamPlotRequest *request, RVEPicture *p)
{
  const LamPlotRecords *of = &p->of;
  Strip s = {.peak = p->peak};

  PetscFunctionBeginUser;
  PetscCall(LamCellsFind(request->input, of, request->field, LAM_PLOT_PEAK, &s.cells));
  LamCellsChoose(&s.cells, p->peak);
  PetscCall(LamCellsShare(&s.cells));
  PetscCall(PetscMalloc1(of->n, &s.load));
  PetscCall(LamLoadAxisChoose(of->n, of->records, of->keys, &of->scales, &s.axis, s.load));
  PetscCall(LamStripDraw(request->output, &(LamStrip){s.cells.count, s.cells.frame, DrawState, DrawStripKey, &s}));
  PetscCall(PetscFree(s.load));
  PetscCall(LamCellsDestroy(&s.cells));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPlotRVE(const LamPlotRequest *request)
{
  RVEPicture picture;

  PetscFunctionBeginUser;
  PetscCall(LoadRVE(request, &picture));
  PetscCall(ReadTest(request->input, &picture));
  if (request->strip)
    PetscCall(DrawStrip(request, &picture));
  else
    PetscCall(DrawPage(request->output, &picture));
  PetscCall(LamTestDestroy(&picture.test));
  PetscCall(LamSceneDestroy(&picture.scene));
  PetscCall(LamTissueDestroy(&picture.tissue));
  PetscCall(LamDatabaseClose(&picture.database));
  PetscFunctionReturn(0);
}
