/*
  Zoom into the microstructure: the RVE at chosen material points of the last converged state, written to the results.

  The RVE is that of the point's tissue; if several are blended, that of the largest weight. With direct response, and
  where the point holds a model, it starts from the point's stored state, else from the reference, as the cache's solves
  do. `difference` in the file is the LamStressError between the stress used by the run and the one found: the error of
  an interpolated or blended response, or a sign of another branch.

  In the file, k = 1, 2, ... (docs/reference/files.md): /zoom/<k>/mesh and /zoom/<k>/fields as written by `rve -o`;
  /zoom/place, position, F, turgor, cohesion, P, difference, apothem with a row for each; /zoom/points is written last.
*/
#include <math.h>
#include <stdio.h>
#include "fe2_run.h"
#include "rve_fields.h"

/* A chosen point; the same on all ranks. Lengths in macro lengths, stress in C1 + C2 of the scene. */
typedef struct {
  PetscInt point[2]; /* number of the element; index of the point in it */
  LamLoad load;
  PetscReal P[9], place[2], position[2]; /* stress in the run; reference and deformed position */
  PetscInt tissue;
  PetscReal angle; /* orientation of its cells relative to the scene's, radian */

  /* rank 0: what is found there */
  PetscReal F[9]; /* in the axes of the cells, as needed to plot periodic images */
  PetscReal found[9], difference, apothem;
} Zoom;

/* ---- choice of points; rank 0 ---- */

static PetscInt Nearest(const LamMacroFields *fields, const PetscReal place[2])
{
  PetscReal least = PETSC_INFINITY;
  PetscInt nearest = 0;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    const PetscReal distance = hypot(fields->place[2 * p] - place[0], fields->place[2 * p + 1] - place[1]);
    if (distance >= least) continue;
    least = distance;
    nearest = p;
  }
  return nearest;
}

/* The point nearest to the centre of the undeformed body's bounding box. */
static PetscInt Middle(const LamMacroFields *fields)
{
  PetscReal low[2] = {PETSC_INFINITY, PETSC_INFINITY}, high[2] = {-PETSC_INFINITY, -PETSC_INFINITY};

  for (PetscInt k = 0; k < 2 * fields->node_count; k++) {
    low[k % 2] = PetscMin(low[k % 2], fields->nodes[k]);
    high[k % 2] = PetscMax(high[k % 2], fields->nodes[k]);
  }
  return Nearest(fields, (const PetscReal[2]){0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])});
}

static PetscInt MostEndangered(const LamSummary *summary, const LamMacroFields *fields)
{
  PetscReal most = 0;
  PetscInt which = -1;

  for (PetscInt p = 0; p < fields->point_count; p++) {
    const PetscReal danger = LamSummaryDanger(summary, &fields->point[p * LAM_POINT_FIELD_COUNT]);
    if (isnan(danger) || (which >= 0 && danger <= most + 1e-6 * PetscAbsReal(most)))
      continue; /* the first of equal ones */
    most = danger;
    which = p;
  }
  return PetscMax(which, 0);
}

static PetscErrorCode Choose(const LamFE2Run *run, const LamMacroFields *fields, PetscInt *count, Zoom zooms[])
{
  const LamMacroSpec *spec = &run->scene->macro;
  PetscInt points[LAM_MAX_ZOOMS];

  PetscFunctionBeginUser;
  *count = spec->zoom_count ? spec->zoom_count : 2;
  points[0] = MostEndangered(&run->summary, fields);
  points[1] = Middle(fields);
  if (!spec->zoom_count && points[0] == points[1]) *count = 1;
  for (PetscInt k = 0; k < spec->zoom_count; k++) points[k] = Nearest(fields, spec->zoom[k]);
  for (PetscInt k = 0; k < *count; k++) {
    const PetscInt p = points[k];
    Zoom *zoom = &zooms[k];
    while (fields->first_point[zoom->point[0] + 1] <= p) zoom->point[0]++;
    zoom->point[1] = p - fields->first_point[zoom->point[0]];
    zoom->load = fields->load[p];
    zoom->load.turgor = fields->point[p * LAM_POINT_FIELD_COUNT + LAM_POINT_TURGOR]; /* computed if cells are sealed */
    PetscCall(PetscArraycpy(zoom->P, &fields->point_P[9 * p], 9));
    PetscCall(PetscArraycpy(zoom->place, &fields->place[2 * p], 2));
    PetscCall(PetscArraycpy(zoom->position, &fields->position[2 * p], 2));
  }
  PetscFunctionReturn(0);
}

/* ---- tissue and state of a point ---- */

/* Broadcasts tissue and angle of the point. *bytes: its packed state, with direct response; else NULL. The caller frees
   it. Collective. */
static PetscErrorCode Fetch(LamFE2Run *run, Zoom *zoom, char **bytes)
{
  const LamFE2Tissues *tissues = &run->tissues;
  PetscMPIInt rank, owner;
  PetscInt point, number; /* number: of the point in its tissue */
  LamResponder direct;
  size_t length = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(run->comm, &rank));
  PetscCall(LamMacroFindPoint(run->macro, zoom->point[0], zoom->point[1], &point));
  number = point;
  owner = point >= 0 ? rank : -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MAX, run->comm));
  if (rank == owner && tissues->point) {
    const LamHeterogeneousPoint *of = &tissues->point[point];
    PetscInt largest = 0;
    for (PetscInt k = 1; k < of->count; k++) largest = of->term[k].weight > of->term[largest].weight ? k : largest;
    zoom->tissue = of->term[largest].knot;
    zoom->angle = of->angle;
    number = LamHeterogeneousPointCount(point, tissues->point, zoom->tissue);
  }
  PetscCallMPI(MPI_Bcast(&zoom->tissue, 1, MPIU_INT, owner, run->comm));
  PetscCallMPI(MPI_Bcast(&zoom->angle, 1, MPIU_REAL, owner, run->comm));
  *bytes = NULL;
  if (run->response != LAM_FE2_DIRECT && !LamFE2HoldsModels(run, &tissues->tissues[zoom->tissue]))
    PetscFunctionReturn(0);
  direct = tissues->tissues[zoom->tissue].direct;
  PetscCall(LamResponderGetStateSize(direct, &length));
  PetscCall(PetscMalloc1(length, bytes));
  if (rank == owner) PetscCall(LamResponderSave(direct, number, *bytes));
  PetscCallMPI(MPI_Bcast(*bytes, (PetscMPIInt)length, MPI_BYTE, owner, run->comm));
  PetscFunctionReturn(0);
}

/* The load in the axes and units of the tissue: F Q, Q the rotation by the point's angle. */
static LamLoad OwnLoad(const Zoom *zoom, PetscReal stress)
{
  const PetscReal c = cos(zoom->angle), s = sin(zoom->angle), *F = zoom->load.F;
  LamLoad own = zoom->load;

  own.duration = 0; /* an instant after the state that the point has accepted */
  own.turgor /= stress;
  own.cohesion /= stress;
  for (int i = 0; i < 3; i++) {
    own.F[3 * i] = c * F[3 * i] + s * F[3 * i + 1];
    own.F[3 * i + 1] = c * F[3 * i + 1] - s * F[3 * i];
  }
  return own;
}

/* Inverse of OwnLoad for the stress: P Q^T, in the units of the body. */
static void BodyStress(const PetscReal own[9], PetscReal angle, PetscReal stress, PetscReal P[9])
{
  const PetscReal c = cos(angle), s = sin(angle);

  for (int i = 0; i < 3; i++) {
    P[3 * i] = stress * (c * own[3 * i] - s * own[3 * i + 1]);
    P[3 * i + 1] = stress * (s * own[3 * i] + c * own[3 * i + 1]);
    P[3 * i + 2] = stress * own[3 * i + 2];
  }
}

/* ---- the file; rank 0 ---- */

/* Writes the cells as number `number`. */
static PetscErrorCode WriteCells(LamFE2Run *run, const Zoom *zoom, PetscInt number, LamRVE rve, LamRVEState state)
{
  LamScales scales = run->tissues.tissues[zoom->tissue].scene.scales;
  LamRecordWriter writer = LamFE2FileWriter(run->out);
  char group[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(group, sizeof(group), "/zoom/%" PetscInt_FMT "/mesh", number));
  PetscCall(LamRVEWriteMesh(writer, group, rve));
  PetscCall(PetscSNPrintf(group, sizeof(group), "/zoom/%" PetscInt_FMT "/fields", number));
  scales.stress *= run->walls;
  PetscCall(LamRVEWriteFields(writer, group, rve, state, &scales));
  PetscFunctionReturn(0);
}

/* Adds the zoom to those found, in place: they are the first ones of the list. For sealed cells the load has the turgor
   that they have reached. */
static PetscErrorCode Solve(LamFE2Run *run, const Zoom *zoom, LamRVE rve, const char bytes[], LamRVEState state,
                            PetscInt *count, Zoom found[])
{
  const PetscReal mm = run->scene->scales.macro_length * 1e3,
                  stress = run->walls * run->tissues.tissues[zoom->tissue].stress;
  const LamLoad load = OwnLoad(zoom, stress);
  LamResponse response;
  Zoom own = *zoom;

  PetscFunctionBeginUser;
  if (bytes) PetscCall(LamRVEStateUnpack(bytes, state));
  PetscCall(LamRVESolve(rve, &load, state, &response));
  if (!LamResponseHasFields(&response)) {
    LamReportNote(&run->reporter, "no zoom at (%.4g, %.4g) mm: %s: %s", (double)(zoom->place[0] * mm),
                  (double)(zoom->place[1] * mm), LamStatusNames[response.status], response.reason);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArraycpy(own.F, load.F, 9));
  BodyStress(response.P, zoom->angle, stress, own.found);
  own.difference = LamStressError(LamFE2StressScale(&run->tissues.tissues[zoom->tissue]), zoom->P, own.found);
  own.apothem = run->tissues.tissues[zoom->tissue].scene.scales.length * 1e6;
  found[(*count)++] = own;
  PetscCall(WriteCells(run, zoom, *count, rve, state));
  PetscFunctionReturn(0);
}

static PetscErrorCode ZoomOne(LamFE2Run *run, const Zoom *zoom, const char bytes[], PetscInt *count, Zoom found[])
{
  const LamScene *scene = &run->tissues.tissues[zoom->tissue].scene;
  LamRVEState state;
  LamRVE rve;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRVECreate(PETSC_COMM_SELF, scene, &rve));
  PetscCall(LamRVESetInterrupt(rve, LamStopInterrupt, NULL));
  if (run->walls_differ) PetscCall(LamFE2ChangeRVE(rve, &scene->micro, &run->factors));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(Solve(run, zoom, rve, bytes, state, count, found));
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteRows(LamFE2Run *run, PetscInt n, const Zoom found[])
{
  const PetscReal mm = run->scene->scales.macro_length * 1e3, MPa = run->scene->scales.stress * 1e-6;
  const PetscInt pairs[2] = {n, 2}, tensors[3] = {n, 3, 3};
  const struct {
    const char *name, *unit;
    PetscInt rank;
    const PetscInt *dims;
    const PetscReal *first;
    PetscReal factor;
  } arrays[] = {{"/zoom/place", "mm", 2, pairs, found->place, mm},
                {"/zoom/position", "mm", 2, pairs, found->position, mm},
                {"/zoom/F", "1", 3, tensors, found->F, 1},
                {"/zoom/P", "MPa", 3, tensors, found->found, MPa},
                {"/zoom/turgor", "MPa", 1, &n, &found->load.turgor, MPa},
                {"/zoom/cohesion", "MPa", 1, &n, &found->load.cohesion, MPa},
                {"/zoom/difference", "1", 1, &n, &found->difference, 1},
                {"/zoom/apothem", "um", 1, &n, &found->apothem, 1}};
  PetscInt points[LAM_MAX_ZOOMS][2];

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(arrays); k++)
    PetscCall(LamWriteRows(LamFE2FileWriter(run->out), arrays[k].name, arrays[k].rank, arrays[k].dims, arrays[k].first,
                           sizeof(*found), arrays[k].factor, arrays[k].unit));
  for (PetscInt k = 0; k < n; k++) PetscCall(PetscArraycpy(points[k], found[k].point, 2));
  PetscCall(LamRecordWriterInts(LamFE2FileWriter(run->out), "/zoom/points", 2, pairs, points[0]));
  PetscFunctionReturn(0);
}

/* Solves and writes the zooms on rank 0, in one commit. Collective. */
static PetscErrorCode ZoomAll(LamFE2Run *run, PetscInt count, Zoom zooms[])
{
  const PetscBool first = LamIsFirst(run->comm);
  PetscErrorCode ierr = 0;
  PetscInt found = 0;

  PetscFunctionBeginUser;
  if (first) ierr = LamRecordWriterBegin(LamFE2FileWriter(run->out));
  for (PetscInt k = 0; k < count; k++) {
    char *bytes;

    PetscCall(Fetch(run, &zooms[k], &bytes));
    if (first && !ierr) ierr = ZoomOne(run, &zooms[k], bytes, &found, zooms);
    PetscCall(PetscFree(bytes));
  }
  if (first && !ierr) ierr = WriteRows(run, found, zooms);
  if (first && !ierr) ierr = LamRecordWriterCommit(LamFE2FileWriter(run->out), 0, NULL, NULL);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Zoom(LamFE2Run *run)
{
  Zoom zooms[LAM_MAX_ZOOMS] = {0};
  LamMacroFields fields;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  if (!run->out_path) PetscFunctionReturn(0);
  if (LamWallsRelax(&run->scene->micro) && run->response != LAM_FE2_DIRECT) {
    if (LamIsFirst(run->comm))
      LamReportNote(&run->reporter, "no zoom: a database does not know the cells of walls that relax");
    PetscFunctionReturn(0);
  }
  PetscCall(LamMacroGetFields(run->macro, &fields));
  if (LamIsFirst(run->comm) && run->totals.steps) PetscCall(Choose(run, &fields, &count, zooms));
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCallMPI(MPI_Bcast(&count, 1, MPIU_INT, 0, run->comm));
  PetscCallMPI(MPI_Bcast(zooms, sizeof(zooms), MPI_BYTE, 0, run->comm));
  if (count) PetscCall(ZoomAll(run, count, zooms));
  PetscFunctionReturn(0);
}
