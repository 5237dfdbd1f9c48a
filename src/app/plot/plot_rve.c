/*
  Picture of a file of RVE states: the deformed tissue at one state, and the stress-load curves of all.
*/
#include "plot_tissue.h"
#include <stdio.h>

typedef struct {
  LamDatabase database; /* owned */
  LamPlotRecords of;    /* the states */
  PetscInt index;       /* of the state drawn */
  const LamWallField *field;
  LamTissue tissue;
  LamScene *scene; /* that the file was made of; NULL: unknown; owned */
  LamTest test;
} RVEPicture;

/* The requested state, or the last converged one. */
static PetscErrorCode FindState(const LamPlotRequest *request, RVEPicture *p)
{
  PetscInt i = p->of.n - 1;

  PetscFunctionBeginUser;
  PetscCheck(p->of.n > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no states", request->input);
  if (request->state < 0) {
    while (i >= 0 && !LamResponseHasFields(&p->of.records[i])) i--;
    PetscCheck(i >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: no state has a response to draw; the first is %s: %s", request->input,
               LamStatusNames[p->of.records[0].status], p->of.records[0].reason);
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
  PetscCall(LamTissueRead(path, "/mesh", fields, p->field, (PetscBool)(p->of.micro.interface == LAM_INTERFACE_CONTACT),
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

/* "State 5:  F = [1, 0.3; 0, 1],  p = 0.02 MPa" */
static void Title(const RVEPicture *p, size_t size, char title[])
{
  const LamResponse *response = &p->of.records[p->index];
  const PetscReal *F = response->load.F, MPa = p->of.scales.stress * 1e-6;
  const PetscBool plane = (PetscBool)(F[2] == 0 && F[5] == 0 && F[6] == 0 && F[7] == 0 && F[8] == 1);
  const int n = plane ? 2 : 3;
  size_t at = (size_t)snprintf(title, size, "State %" PetscInt64_FMT ":  $F$ = [", p->of.keys[p->index]);
  char number[32];

  for (int k = 0; k < n * n; k++) {
    LamFormatRatio(F[3 * (k / n) + k % n], number);
    at += (size_t)snprintf(title + at, size - at, "%s%s", k % n ? ", " : k ? "; " : "", number);
  }
  LamFormatNumber(response->load.turgor * MPa, number);
  at += (size_t)snprintf(title + at, size - at, "],  turgor $p$ = %s MPa", number);
  LamFormatNumber(response->load.cohesion * MPa, number);
  if (p->of.micro.interface != LAM_INTERFACE_BONDED)
    at += (size_t)snprintf(title + at, size - at, ",  cohesion $g$ = %s MPa", number);
  if (response->status == LAM_UNSTABLE) snprintf(title + at, size - at, "  (unstable)");
}

static const double KeyRow = 10;

/* Scale bar, and legend of the dashed line, the paler cells and the ribbons; as far as `right`. */
static void DrawKey(LamCanvas canvas, const LamView *view, double right, const RVEPicture *p)
{
  const LamRect f = view->frame;
  const double y = f.y + f.height + 11;

  LamScaleBar(canvas, view, f.x, y, 0.18 * f.width, 1e-6 / p->of.scales.length, "µm");
  LamUndeformedKey(canvas, right, y,
                   LamTissueIsPeriodic(&p->tissue) ? "undeformed;  paler: periodic images" : "undeformed");
  if (p->tissue.has_interface) LamInterfaceDrawKey(canvas, f.x, y + KeyRow, &p->tissue.interface);
}

static PetscErrorCode DrawPanel(LamCanvas canvas, LamRect outer, const RVEPicture *p)
{
  /* apothems: the nearest neighbours are visible; for contact tissue a smaller part of them, to show the gaps larger */
  const PetscReal margin = p->tissue.has_interface ? 0.5 : 1.1;
  const double right = outer.x + outer.width;
  PetscReal reference[2], box[4] = LAM_EMPTY_BOX;
  LamColourRange range;
  LamView view;

  PetscFunctionBeginUser;
  PetscCall(LamColourRangeFind(p->tissue.node_count, p->tissue.values, &range));
  outer.width -= LamColourBarWidth(canvas, &range);
  if (p->tissue.has_interface) outer.height -= KeyRow;
  if (p->tissue.interface.is_open) outer.width -= LamColourBarWidth(canvas, &p->tissue.interface.gaps);
  LamTissueCentreReference(&p->tissue, reference);
  LamBoxExtend(box, p->tissue.node_count, p->tissue.x, NULL);
  LamBoxExtend(box, p->tissue.node_count, p->tissue.nodes, reference);
  LamBoxWiden(box, margin);
  LamViewFit(outer, box, &view);
  PetscCall(LamTissueDraw(canvas, &view, &p->tissue, &range, reference));
  LamColourBar(canvas, outer, &range, LamColourMap, p->field->label, p->field->unit);
  DrawKey(canvas, &view, p->tissue.interface.is_open ? right : outer.x + outer.width, p);
  if (!p->tissue.interface.is_open) PetscFunctionReturn(0);
  outer.width += LamColourBarWidth(canvas, &range);
  LamColourBar(canvas, outer, &p->tissue.interface.gaps, LamGapColour, "gap", "apothems");
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
  PetscCall(ReadTest(request->input, &picture));
  PetscCall(LamCanvasCreate(request->output, LAM_PLOT_WIDTH, LAM_PLOT_HEIGHT, &canvas));
  Title(&picture, sizeof title, title);
  LamCanvasTitle(canvas, left.x, 12, title);
  PetscCall(DrawPanel(canvas, left, &picture));
  PetscCall(LamStressChart(canvas, right, picture.of.n, picture.of.records, picture.of.keys, &picture.of.scales,
                           &picture.test));
  PetscCall(LamCanvasFinish(&canvas));
  PetscCall(LamTestDestroy(&picture.test));
  PetscCall(LamSceneDestroy(&picture.scene));
  PetscCall(LamTissueDestroy(&picture.tissue));
  PetscCall(LamDatabaseClose(&picture.database));
  PetscFunctionReturn(0);
}
