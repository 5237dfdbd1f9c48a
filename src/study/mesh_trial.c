/*
  Trial of meshes.

  Method. Up to LOADS loads are solved on one cell: on a reference mesh that suits the accuracy, started from a coarser
  solution, and then on meshes of increasing cost, from F = I as they will be used. The error of a mesh is
  LamStressError against the reference, the largest over the loads; MARGIN covers the error of the reference itself and
  the loads between. Of tissue with a lamella those loads count at which it is hardly broken: beyond, states of
  different meshes may be on different branches.
*/
#include "mesh_choice.h"
#include "build.h"
#include "mechanical_test.h"
#include <lamella/rve.h>
#include <math.h>

#define LOADS 4    /* a chance solution at one of them decides nothing */
#define MARGIN 1.5 /* bench_accuracy: then 92 % of states keep an accuracy of 1 % */
#define TOLERANCE 1e-6
#define BROKEN 0.25 /* share of a lamella that is broken at most */
#define FINER 1.7   /* times as many elements on the reference: 28 x 6 against 36 x 8 */
#define PATH 2      /* in the list: mesh of the loads whose F is not given, and start of the reference */
#define UNKNOWN 6   /* in the list, where no trial load has a solution: 12 x 2 in contact, 16 x 1 */

typedef struct {
  PetscInt along, through;
} Mesh;

enum { REFERENCES = 3 };

typedef struct {
  PetscReal grading;           /* the least errors of random tissues: 0.7 to 0.98 and 0 to 0.9 were tried */
  Mesh references[REFERENCES]; /* for accuracies from 5 %, 0.5 %, and below */
  PetscInt count;
  Mesh meshes[16]; /* by increasing cost */
} List;

static const List Lists[] = {
    /* by whether the cells part */
    [PETSC_FALSE] = {0.9,
                     {{12, 2}, {20, 4}, {36, 8}},
                     16,
                     {{4, 1},
                      {6, 1},
                      {8, 1},
                      {10, 1},
                      {12, 1},
                      {8, 2},
                      {16, 1},
                      {12, 2},
                      {16, 2},
                      {12, 3},
                      {20, 2},
                      {12, 4},
                      {16, 4},
                      {20, 4},
                      {28, 4},
                      {28, 6}}},
    [PETSC_TRUE] = {0.6,
                    {{12, 2}, {20, 4}, {32, 6}},
                    11,
                    {{4, 1}, {6, 1}, {8, 1}, {6, 2}, {8, 2}, {10, 2}, {12, 2}, {16, 2}, {16, 3}, {20, 4}, {28, 4}}},
};

PetscBool LamListedMesh(LamInterfaceLawType interface, PetscInt k, LamMeshTrial *mesh)
{
  const List *list = &Lists[LamCellsPart(interface)];

  if (k >= list->count) return PETSC_FALSE;
  mesh->along = list->meshes[k].along;
  mesh->through = list->meshes[k].through;
  mesh->grading = list->grading;
  return PETSC_TRUE;
}

static PetscInt FirstReference(PetscReal accuracy)
{
  return accuracy >= 0.05 ? 0 : accuracy >= 0.005 ? 1 : 2;
}

/* Whether the reference tells the error of a mesh. */
static PetscBool IsMuchFiner(Mesh reference, Mesh mesh)
{
  return (PetscBool)((PetscReal)(reference.along * reference.through) >=
                     FINER * (PetscReal)(mesh.along * mesh.through));
}

/* ---- one cell on a mesh ---- */

typedef struct {
  LamRVE rve;
  LamRVEState state;
} Cell;

static PetscErrorCode CellCreate(const LamScene *scene, PetscInt cell, Mesh mesh, Cell *c)
{
  LamMicrostructure micro = scene->micro;

  PetscFunctionBeginUser;
  if (micro.cell) {
    micro.wall_thickness = micro.cell[cell].wall_thickness;
    micro.wall = micro.cell[cell].wall;
  }
  micro.cell = NULL;
  micro.tissue = NULL;
  micro.cells[0] = micro.cells[1] = 1;
  micro.is_patch = PETSC_FALSE;
  micro.along = mesh.along;
  micro.tearing = (LamTearing){0}; /* at loads that hardly break anything cuts are closed */
  micro.relaxation.terms = 0;      /* walls as they are at once */
  micro.through = mesh.through;
  micro.grading = Lists[LamCellsPart(micro.interface)].grading;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &c->rve));
  PetscCall(LamRVESetMicrostructure(c->rve, &micro));
  PetscCall(LamRVESetStrategy(c->rve, scene->strategy));
  PetscCall(LamRVESetTolerance(c->rve, TOLERANCE));
  PetscCall(LamRVESetWanted(c->rve, LAM_WANT_STRESS));
  PetscCall(LamRVESetOutOfPlane(c->rve, scene->out_of_plane));
  PetscCall(LamRVESetInterrupt(c->rve, LamStopInterrupt, NULL));
  PetscCall(LamRVESetUp(c->rve));
  PetscCall(LamRVEStateCreate(c->rve, &c->state));
  PetscFunctionReturn(0);
}

static PetscErrorCode CellDestroy(Cell *c)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&c->state));
  PetscCall(LamRVEDestroy(&c->rve));
  PetscFunctionReturn(0);
}

/* ---- trial loads ---- */

typedef struct {
  PetscInt n;
  LamLoad at[LOADS];
} Loads;

/* Whether the state can be compared between meshes. */
static PetscBool IsComparable(const LamResponse *response)
{
  return (PetscBool)(LamResponseHasFields(response) && !(response->broken_fraction > BROKEN));
}

/* Solves the scene's loads in their order, and keeps some of them, the last included, with the F found. */
static PetscErrorCode FollowLoads(const LamScene *scene, Cell *cell, Loads *loads)
{
  static const LamStressControl none = {0};
  LamScene copy = *scene;
  PetscReal F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const PetscBool all = (PetscBool)(scene->controls || scene->micro.interface == LAM_INTERFACE_LAMELLA);
  PetscInt n = scene->load_count, found = 0;
  LamLoad *load_of;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &copy.loads));
  PetscCall(PetscMalloc2(n, &copy.controls, n, &load_of));
  PetscCall(PetscArraycpy(copy.loads, scene->loads, n));
  for (PetscInt k = 0; k < n; k++) copy.controls[k] = scene->controls ? scene->controls[k] : none;
  for (PetscInt k = 0; k < n && !LamStopRequested(); k++) {
    const LamLoad load = LamLoadAfter(&copy.loads[k], &copy.controls[k], F);
    LamResponse response = {.status = LAM_CONVERGED, .load = load};

    if (all) PetscCall(LamRVESolveMixed(cell->rve, &load, &copy.controls[k], cell->state, &response));
    if (!IsComparable(&response)) break;
    PetscCall(PetscArraycpy(F, response.load.F, 9));
    if (scene->inflate && !k) LamLoadsFromInflated(&copy, F);
    load_of[found++] = response.load;
  }
  for (PetscInt k = 0; k < found; k++)
    if ((k + 1) * PetscMin(found, LOADS) >= (loads->n + 1) * found) loads->at[loads->n++] = load_of[k];
  PetscCall(PetscFree(copy.loads));
  PetscCall(PetscFree2(copy.controls, load_of));
  PetscFunctionReturn(0);
}

/* Strains of bodies are not known in advance: shear, tension, compression and both, of 5 to 20 %, from the tissue free
   of stress if it is inflated first. */
static PetscErrorCode UsualLoads(const LamScene *scene, Cell *cell, Loads *loads)
{
  static const PetscReal strains[LOADS][4] = {{1, 0.2, 0, 1}, {1.1, 0, 0, 0.95}, {1.03, 0, 0, 0.92}, {1.05, 0.1, 0, 1}};
  const LamStressControl unstressed = {.given = {PETSC_TRUE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_TRUE}};
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = scene->turgor, .cohesion = scene->cohesion};
  LamResponse inflated = {.load = load};

  PetscFunctionBeginUser;
  if ((scene->has_macro && scene->macro.inflate) || (scene->has_process && scene->process.inflate))
    PetscCall(LamRVESolveMixed(cell->rve, &load, &unstressed, cell->state, &inflated));
  for (PetscInt k = 0; k < LOADS; k++) {
    const PetscReal *U = strains[k], stretch[2] = {inflated.load.F[0], inflated.load.F[4]};

    if (isfinite(stretch[0] + stretch[1]))
      for (int i = 0; i < 4; i++) load.F[i < 2 ? i : i + 1] = U[i] * stretch[i % 2];
    loads->at[loads->n++] = load;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FindLoads(const LamScene *scene, Cell *cell, Loads *loads)
{
  PetscReal wedge;

  PetscFunctionBeginUser;
  loads->n = 0;
  PetscCall(LamSampleWedge(&scene->micro, &wedge));
  if (scene->has_sample)
    for (; loads->n < LOADS; loads->n++) LamSampleLoad(scene, wedge, loads->n, &loads->at[loads->n]);
  else if (scene->load_count)
    PetscCall(FollowLoads(scene, cell, loads));
  else
    PetscCall(UsualLoads(scene, cell, loads));
  PetscFunctionReturn(0);
}

/* ---- the trial of one cell ---- */

typedef struct {
  Loads loads; /* those with a solution on the reference mesh */
  PetscReal P[LOADS][9];
} Truth;

/* The reference solutions, each from that of the path's mesh. */
static PetscErrorCode FindTruth(const LamScene *scene, PetscInt number, Mesh mesh, const Loads *all, Cell *path,
                                Truth *truth)
{
  Cell reference;

  PetscFunctionBeginUser;
  LamActivitySet("trial of meshes: reference of %d x %d elements", (int)mesh.along, (int)mesh.through);
  PetscCall(CellCreate(scene, number, mesh, &reference));
  truth->loads.n = 0;
  for (PetscInt k = 0; k < all->n && !LamStopRequested(); k++) {
    LamResponse response;

    PetscCall(LamRVEStateReset(path->rve, path->state));
    PetscCall(LamRVESolve(path->rve, &all->at[k], path->state, &response));
    PetscCall(LamRVEStateReset(reference.rve, reference.state));
    if (LamResponseHasFields(&response))
      PetscCall(LamRVESolveFiner(path->rve, path->state, reference.rve, reference.state, &response));
    else
      PetscCall(LamRVESolve(reference.rve, &all->at[k], reference.state, &response));
    if (!IsComparable(&response)) continue;
    truth->loads.at[truth->loads.n] = all->at[k];
    PetscCall(PetscArraycpy(truth->P[truth->loads.n++], response.P, 9));
  }
  PetscCall(CellDestroy(&reference));
  PetscFunctionReturn(0);
}

/* Bodies, the tables that answer them, and maps of failure use stresses in the plane alone. */
static PetscReal Error(const LamScene *scene, const PetscReal P[9], const PetscReal P_ref[9])
{
  const LamStressScale scale = LamStressScaleOf(&scene->micro);

  return scene->has_sample || scene->has_macro || scene->has_map ? LamStressError(scale, P, P_ref)
                                                                 : LamWholeError(scale, P, P_ref);
}

/* Largest error over the loads; infinite if one has no solution. */
static PetscErrorCode ErrorOf(const LamScene *scene, PetscInt number, Mesh mesh, const Truth *truth, PetscReal *error)
{
  Cell cell;

  PetscFunctionBeginUser;
  LamActivitySet("trial of meshes: %d x %d elements", (int)mesh.along, (int)mesh.through);
  PetscCall(CellCreate(scene, number, mesh, &cell));
  *error = 0;
  for (PetscInt k = 0; k < truth->loads.n && isfinite(*error) && !LamStopRequested(); k++) {
    LamResponse response;

    PetscCall(LamRVEStateReset(cell.rve, cell.state));
    PetscCall(LamRVESolve(cell.rve, &truth->loads.at[k], cell.state, &response));
    *error = LamResponseHasFields(&response) ? PetscMax(*error, Error(scene, response.P, truth->P[k])) : INFINITY;
  }
  PetscCall(CellDestroy(&cell));
  PetscFunctionReturn(0);
}

/* From mesh *at of the list to the one that suffices; *error is its error. */
static PetscErrorCode Climb(const LamScene *scene, PetscInt cell, const Truth *truth, Mesh reference, PetscInt *at,
                            PetscReal *error)
{
  const List *list = &Lists[LamCellsPart(scene->micro.interface)];

  PetscFunctionBeginUser;
  for (;;) {
    PetscCall(ErrorOf(scene, cell, list->meshes[*at], truth, error));
    if (LamStopRequested()) break;
    if (MARGIN * *error <= scene->accuracy || *at == list->count - 1) break;
    if (!IsMuchFiner(reference, list->meshes[*at + 1])) break;
    (*at)++;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TryCell(const LamScene *scene, PetscInt cell, PetscInt *at, LamMeshTrial *trial)
{
  const List *list = &Lists[LamCellsPart(scene->micro.interface)];
  PetscReal error = PETSC_INFINITY;
  Truth truth = {.loads.n = 1};
  Cell path;
  Loads all;

  PetscFunctionBeginUser;
  LamActivitySet("trial of meshes: loads");
  PetscCall(CellCreate(scene, cell, list->meshes[PATH], &path));
  PetscCall(FindLoads(scene, &path, &all));
  for (PetscInt r = FirstReference(scene->accuracy); r < REFERENCES && truth.loads.n && !LamStopRequested(); r++) {
    PetscCall(FindTruth(scene, cell, list->references[r], &all, &path, &truth));
    if (truth.loads.n) PetscCall(Climb(scene, cell, &truth, list->references[r], at, &error));
    if (MARGIN * error <= scene->accuracy) break;
  }
  PetscCall(CellDestroy(&path));
  trial->loads += truth.loads.n;
  if (truth.loads.n)
    trial->error = isnan(trial->error) ? error : PetscMax(trial->error, error);
  else
    *at = PetscMax(*at, UNKNOWN);
  PetscFunctionReturn(0);
}

PetscErrorCode LamTryMeshes(const LamScene *scene, LamMeshTrial *trial)
{
  const LamMicrostructure *micro = &scene->micro;
  const List *list = &Lists[LamCellsPart(micro->interface)];
  const PetscInt count = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscInt thick = 0, thin = 0, mesh = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 1; k < count; k++) {
    if (micro->cell[k].wall_thickness > micro->cell[thick].wall_thickness) thick = k;
    if (micro->cell[k].wall_thickness < micro->cell[thin].wall_thickness) thin = k;
  }
  *trial = (LamMeshTrial){.tried = PETSC_TRUE, .error = NAN, .grading = list->grading};
  PetscCall(TryCell(scene, thick, &mesh, trial));
  if (thin != thick) PetscCall(TryCell(scene, thin, &mesh, trial));
  trial->stopped = LamStopRequested();
  if (trial->stopped) mesh = PetscMax(mesh, UNKNOWN);
  trial->along = list->meshes[mesh].along;
  trial->through = list->meshes[mesh].through;
  LamActivitySet("%s", "");
  PetscFunctionReturn(0);
}
