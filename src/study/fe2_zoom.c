/*
  Zoom into the microstructure: the RVE at chosen material points of the last converged state, written to the results.

  The RVE is that of the point's tissue; if several are blended, that of the largest weight. With direct response and
  one tissue it starts from the point's stored state, else from the reference, as the cache's solves do. `difference` in
  the file is the LamStressError between the stress used by the run and the one found: the error of an interpolated or
  blended response, or a sign of another branch.

  In the file, k = 1, 2, ... (docs/reference/files.md): /zoom/<k>/mesh and /zoom/<k>/fields as written by `rve -o`;
  /zoom/place, position, F, turgor, cohesion, P, difference, apothem with a row for each; /zoom/points is written last.
*/
#include <math.h>
#include <stdio.h>
#include "fe2_run.h"
#include "rve_fields.h"

/* A chosen point; the same on all ranks. */
typedef struct {
  PetscInt element, index; /* number of the element; index of the point in it */
  LamLoad load;
  PetscReal P[9], place[2], position[2]; /* stress in the run; reference and deformed position, macro lengths */
  PetscInt tissue;
  PetscReal angle; /* orientation of its cells relative to the scene's, radian */
} Zoom;

/* Results of the zooms, a row for each. */
typedef struct {
  PetscInt count;
  PetscInt point[LAM_MAX_ZOOMS][2];
  PetscReal place[LAM_MAX_ZOOMS][2], position[LAM_MAX_ZOOMS][2], F[LAM_MAX_ZOOMS][9], P[LAM_MAX_ZOOMS][9];
  PetscReal turgor[LAM_MAX_ZOOMS], cohesion[LAM_MAX_ZOOMS], difference[LAM_MAX_ZOOMS], apothem[LAM_MAX_ZOOMS];
} Found;

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

static void Choose(const LamFE2Run *run, const LamMacroFields *fields, PetscInt *count, Zoom zooms[LAM_MAX_ZOOMS])
{
  const LamMacroSpec *spec = &run->scene->macro;
  PetscInt points[LAM_MAX_ZOOMS];

  *count = spec->zoom_count ? spec->zoom_count : 2;
  points[0] = MostEndangered(&run->summary, fields);
  points[1] = Middle(fields);
  if (!spec->zoom_count && points[0] == points[1]) *count = 1;
  for (PetscInt k = 0; k < spec->zoom_count; k++) points[k] = Nearest(fields, spec->zoom[k]);
  for (PetscInt k = 0; k < *count; k++) {
    const PetscInt p = points[k];
    Zoom *zoom = &zooms[k];
    while (fields->first_point[zoom->element + 1] <= p) zoom->element++;
    zoom->index = p - fields->first_point[zoom->element];
    zoom->load = fields->load[p];
    zoom->load.turgor = fields->point[p * LAM_POINT_FIELD_COUNT + LAM_POINT_TURGOR]; /* computed if cells are sealed */
    for (int i = 0; i < 9; i++) zoom->P[i] = fields->point_P[9 * p + i];
    for (int i = 0; i < 2; i++) {
      zoom->place[i] = fields->place[2 * p + i];
      zoom->position[i] = fields->position[2 * p + i];
    }
  }
}

/* ---- tissue and state of a point ---- */

/* Broadcasts tissue and angle of the point. *bytes: its packed state, with direct response and one tissue; else NULL.
   The caller frees it. Collective. */
static PetscErrorCode Fetch(LamFE2Run *run, Zoom *zoom, char **bytes)
{
  const LamFE2Tissues *tissues = &run->tissues;
  const LamResponder *direct = &tissues->tissues[0].direct;
  PetscMPIInt rank, owner;
  PetscInt point;
  size_t length = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(run->comm, &rank));
  PetscCall(LamMacroFindPoint(run->macro, zoom->element, zoom->index, &point));
  owner = point >= 0 ? rank : -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MAX, run->comm));
  if (rank == owner && tissues->point) {
    const LamHeterogeneousPoint *of = &tissues->point[point];
    PetscInt largest = 0;
    for (PetscInt k = 1; k < of->count; k++) largest = of->term[k].weight > of->term[largest].weight ? k : largest;
    zoom->tissue = of->term[largest].knot;
    zoom->angle = of->angle;
  }
  PetscCallMPI(MPI_Bcast(&zoom->tissue, 1, MPIU_INT, owner, run->comm));
  PetscCallMPI(MPI_Bcast(&zoom->angle, 1, MPIU_REAL, owner, run->comm));
  *bytes = NULL;
  if (!tissues->plain || run->response != LAM_FE2_DIRECT) PetscFunctionReturn(0);
  PetscCall(direct->state_size(direct->ctx, &length));
  PetscCall(PetscMalloc1(length, bytes));
  if (rank == owner) PetscCall(direct->save(direct->ctx, point, *bytes));
  PetscCallMPI(MPI_Bcast(*bytes, (PetscMPIInt)length, MPI_BYTE, owner, run->comm));
  PetscFunctionReturn(0);
}

/* The load in the axes and units of the tissue: F Q, Q the rotation by the point's angle. */
static LamLoad OwnLoad(const Zoom *zoom, PetscReal stress)
{
  const PetscReal c = cos(zoom->angle), s = sin(zoom->angle), *F = zoom->load.F;
  LamLoad own = zoom->load;

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

/* `load`: in the axes of the cells, as needed to plot periodic images. */
static PetscErrorCode Keep(LamFE2Run *run, const Zoom *zoom, const LamLoad *load, const PetscReal P[9], LamRVE rve,
                           LamRVEState state, Found *found)
{
  const PetscReal mm = run->scene->scales.macro_length * 1e3, MPa = run->scene->scales.stress * 1e-6;
  LamScales scales = run->tissues.tissues[zoom->tissue].scene.scales;
  LamRecordWriter writer = LamFE2FileWriter(run->out);
  const PetscInt k = found->count++;
  char group[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  found->point[k][0] = zoom->element;
  found->point[k][1] = zoom->index;
  for (int i = 0; i < 2; i++) {
    found->place[k][i] = zoom->place[i] * mm;
    found->position[k][i] = zoom->position[i] * mm;
  }
  for (int i = 0; i < 9; i++) {
    found->F[k][i] = load->F[i];
    found->P[k][i] = P[i] * MPa;
  }
  found->turgor[k] = zoom->load.turgor * MPa;
  found->cohesion[k] = zoom->load.cohesion * MPa;
  found->difference[k] = LamStressError(zoom->P, P);
  found->apothem[k] = scales.length * 1e6;
  PetscCall(PetscSNPrintf(group, sizeof(group), "/zoom/%" PetscInt_FMT "/mesh", k + 1));
  PetscCall(LamRVEWriteMesh(writer, group, rve));
  PetscCall(PetscSNPrintf(group, sizeof(group), "/zoom/%" PetscInt_FMT "/fields", k + 1));
  scales.stress *= run->walls;
  PetscCall(LamRVEWriteFields(writer, group, rve, state, &scales));
  PetscFunctionReturn(0);
}

/* For sealed cells the load has the turgor that they have reached. */
static PetscErrorCode Solve(LamFE2Run *run, const Zoom *zoom, LamRVE rve, const char bytes[], LamRVEState state,
                            Found *found)
{
  const PetscReal mm = run->scene->scales.macro_length * 1e3,
                  stress = run->walls * run->tissues.tissues[zoom->tissue].stress;
  const LamLoad load = OwnLoad(zoom, stress);
  LamResponse response;
  PetscReal P[9];

  PetscFunctionBeginUser;
  if (bytes) PetscCall(LamRVEStateUnpack(bytes, state));
  PetscCall(LamRVESolve(rve, &load, state, &response));
  if (LamResponseHasFields(&response)) {
    BodyStress(response.P, zoom->angle, stress, P);
    PetscCall(Keep(run, zoom, &load, P, rve, state, found));
  } else {
    LamReportNote(&run->reporter, "no zoom at (%.4g, %.4g) mm: %s: %s", (double)(zoom->place[0] * mm),
                  (double)(zoom->place[1] * mm), LamStatusNames[response.status], response.reason);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ZoomOne(LamFE2Run *run, const Zoom *zoom, const char bytes[], Found *found)
{
  const LamScene *scene = &run->tissues.tissues[zoom->tissue].scene;
  LamRVEState state;
  LamRVE rve;

  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &scene->micro));
  PetscCall(LamRVESetStrategy(rve, scene->strategy));
  PetscCall(LamRVESetTolerance(rve, scene->tolerance));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVESetInterrupt(rve, LamStopInterrupt, NULL));
  if (run->walls_differ) PetscCall(LamFE2ChangeWalls(rve, &scene->micro, run->wall_ratio));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(Solve(run, zoom, rve, bytes, state, found));
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteRows(LamFE2Run *run, const Found *found)
{
  const PetscInt n = found->count, pairs[2] = {n, 2}, tensors[3] = {n, 3, 3};
  LamRecordWriter writer = LamFE2FileWriter(run->out);

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamRecordWriterReals(writer, "/zoom/place", 2, pairs, &found->place[0][0], "mm"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/position", 2, pairs, &found->position[0][0], "mm"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/F", 3, tensors, &found->F[0][0], "1"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/P", 3, tensors, &found->P[0][0], "MPa"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/turgor", 1, &n, found->turgor, "MPa"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/cohesion", 1, &n, found->cohesion, "MPa"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/difference", 1, &n, found->difference, "1"));
  PetscCall(LamRecordWriterReals(writer, "/zoom/apothem", 1, &n, found->apothem, "um"));
  PetscCall(LamRecordWriterInts(writer, "/zoom/points", 2, pairs, &found->point[0][0]));
  PetscFunctionReturn(0);
}

/* Solves and writes the zooms on rank 0, in one commit. Collective. */
static PetscErrorCode ZoomAll(LamFE2Run *run, PetscInt count, Zoom zooms[])
{
  PetscErrorCode ierr = 0;
  Found found = {0};

  PetscFunctionBeginUser;
  if (LamIsFirst(run->comm)) ierr = LamRecordWriterBegin(LamFE2FileWriter(run->out));
  for (PetscInt k = 0; k < count; k++) {
    char *bytes;

    PetscCall(Fetch(run, &zooms[k], &bytes));
    if (LamIsFirst(run->comm) && !ierr) ierr = ZoomOne(run, &zooms[k], bytes, &found);
    PetscCall(PetscFree(bytes));
  }
  if (LamIsFirst(run->comm) && !ierr) ierr = WriteRows(run, &found);
  if (LamIsFirst(run->comm) && !ierr) ierr = LamRecordWriterCommit(LamFE2FileWriter(run->out), 0, NULL, NULL);
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
  PetscCall(LamMacroGetFields(run->macro, &fields));
  if (LamIsFirst(run->comm) && run->totals.steps) Choose(run, &fields, &count, zooms);
  PetscCall(LamMacroFieldsDestroy(&fields));
  PetscCallMPI(MPI_Bcast(&count, 1, MPIU_INT, 0, run->comm));
  PetscCallMPI(MPI_Bcast(zooms, sizeof(zooms), MPI_BYTE, 0, run->comm));
  if (count) PetscCall(ZoomAll(run, count, zooms));
  PetscFunctionReturn(0);
}
