/*
  Response fields stored for output; fields of the last converged state, gathered on rank 0 in the numbering of the
  undistributed mesh.
*/
#include <math.h>
#include "macro_impl.h"

const char *const LamPointFieldNames[] = {LAM_POINT_FIELDS(LAM_NAME_ENTRY) NULL};

PetscBool LamPointFieldIsStress(LamPointField field)
{
  return (PetscBool)(field == LAM_POINT_TURGOR || field == LAM_POINT_WALL || field == LAM_POINT_NORMAL ||
                     field == LAM_POINT_SHEAR || field == LAM_POINT_ELLIPTICITY);
}

PetscReal LamPointFieldWorse(LamPointField field, PetscReal a, PetscReal b)
{
  if (isnan(a) || isnan(b)) return NAN;
  return field == LAM_POINT_ELLIPTICITY ? PetscMin(a, b) : PetscMax(a, b);
}

/* Turgor of the lumens; with sealed cells the pressure reached. */
static PetscReal Turgor(const LamResponse *r)
{
  return isfinite(r->turgor_mean) ? r->turgor_mean : r->load.turgor;
}

/* A face transmits t = g - (contact pressure), and is pressed together only by p + g (docs/theory/homogenisation.md,
   Effective-stress principle). */
static PetscReal FaceUnloading(const LamResponse *r)
{
  const PetscReal pressing = Turgor(r) + r->load.cohesion;
  PetscReal least = PETSC_INFINITY;

  if (!(pressing > 0) || isnan(r->min_gap)) return NAN;
  for (int k = 0; k < 3; k++) {
    const PetscReal pressure = r->load.cohesion - r->mean_face_traction[k];
    least = isnan(pressure) ? least : PetscMin(least, pressure); /* NaN: a patch without faces of this family */
  }
  return PetscIsInfReal(least) ? NAN : 1 - least / pressing;
}

void LamMacroKeepFields(const LamResponse *response, PetscReal field[LAM_POINT_FIELD_COUNT])
{
  const PetscBool interpolated = (PetscBool)(response->source == LAM_SOURCE_DATABASE);

  field[LAM_POINT_TURGOR] = Turgor(response);
  field[LAM_POINT_LUMEN] = response->lumen_fraction;
  field[LAM_POINT_OPENING] = response->opening_fraction;
  field[LAM_POINT_DEBONDED] = response->debonded_fraction;
  field[LAM_POINT_OPEN] = response->open_fraction;
  field[LAM_POINT_GAP] = response->max_gap;
  field[LAM_POINT_UNLOADING] = FaceUnloading(response);
  field[LAM_POINT_WALL] = response->max_wall_tension;
  field[LAM_POINT_NORMAL] = response->max_traction;
  field[LAM_POINT_SHEAR] = response->max_lamella_shear;
  field[LAM_POINT_ELLIPTICITY] = NAN; /* computed only for converged states (localisation.c) */
  field[LAM_POINT_ERROR] = interpolated ? response->error_estimate : 0;
  field[LAM_POINT_INTERPOLATED] = interpolated;
  field[LAM_POINT_DOUBTFUL] = !response->indicators_trusted;
}

/* Data sent by a rank per node, element and material point. */
typedef struct {
  PetscInt number;
  PetscReal X[2], u[2];
} NodeRecord;

typedef struct {
  PetscInt number, points;
  PetscInt nodes[LAM_FIELD_NODES];
  PetscReal F[9], P[9], cauchy[9], mean[LAM_POINT_FIELD_COUNT], largest[LAM_POINT_FIELD_COUNT];
} ElementRecord;

typedef struct {
  PetscInt element, index; /* number of its element, and its index there */
  LamLoad load;
  PetscReal P[9], field[LAM_POINT_FIELD_COUNT], place[2], position[2], volume;
} PointRecord;

/* Gathers n items of `size` bytes from each rank on rank 0; `all` is NULL on other ranks. The caller frees it. */
static PetscErrorCode GatherItems(MPI_Comm comm, size_t size, PetscInt n, const void *items, PetscInt *total,
                                  void **all)
{
  PetscMPIInt rank, ranks, bytes, *counts = NULL, *starts = NULL;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(PetscMPIIntCast((PetscInt)(n * size), &bytes));
  if (rank == 0) PetscCall(PetscMalloc2(ranks, &counts, ranks + 1, &starts));
  PetscCallMPI(MPI_Gather(&bytes, 1, MPI_INT, counts, 1, MPI_INT, 0, comm));
  *all = NULL;
  *total = 0;
  if (rank == 0) {
    starts[0] = 0;
    for (PetscMPIInt r = 0; r < ranks; r++) starts[r + 1] = starts[r] + counts[r];
    *total = (PetscInt)(starts[ranks] / size);
    PetscCall(PetscMalloc(starts[ranks], all));
  }
  PetscCallMPI(MPI_Gatherv(items, bytes, MPI_BYTE, *all, counts, starts, MPI_BYTE, 0, comm));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(0);
}

static PetscErrorCode CollectNodes(LamMacro macro, PetscInt *n, NodeRecord **nodes)
{
  const PetscScalar *u;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(macro->mesh_end - macro->mesh_start, nodes));
  PetscCall(VecGetArrayRead(macro->u, &u));
  *n = 0;
  for (PetscInt p = 0; p < macro->mesh_end - macro->mesh_start; p++) {
    NodeRecord *node = &(*nodes)[*n];
    PetscInt local;
    PetscCall(LamMacroOwnedIndex(macro, macro->mesh_start + p, &local));
    if (local < 0) continue;
    node->number = macro->node_number[p];
    for (int i = 0; i < 2; i++) {
      node->X[i] = macro->position[2 * p + i];
      node->u[i] = PetscRealPart(u[local + i]);
    }
    (*n)++;
  }
  PetscCall(VecRestoreArrayRead(macro->u, &u));
  PetscFunctionReturn(0);
}

/* Nodes in VTK's order: corners, mid-edges, centre; a closure lists centre, edges, corners. A triangle's centre is
   omitted. */
static PetscErrorCode ElementNodes(LamMacro macro, PetscInt e, PetscInt nodes[LAM_FIELD_NODES])
{
  PetscInt size, *closure = NULL, corners, next[3];

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetTransitiveClosure(macro->dm, macro->mesh_start + e, PETSC_TRUE, &size, &closure));
  corners = (size - 1) / 2;
  next[0] = 0, next[1] = corners, next[2] = 2 * corners; /* of vertices, edges, centre */
  for (int a = 0; a < LAM_FIELD_NODES; a++) nodes[a] = -1;
  for (PetscInt k = 0; k < size; k++) {
    const PetscInt node = macro->node_number[closure[2 * k] - macro->mesh_start];
    PetscInt depth;
    PetscCall(DMPlexGetPointDepth(macro->dm, closure[2 * k], &depth));
    if (node >= 0 && (depth < 2 || corners > 3)) nodes[next[depth]++] = node;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(macro->dm, macro->mesh_start + e, PETSC_TRUE, &size, &closure));
  PetscFunctionReturn(0);
}

static PetscReal Determinant(const PetscReal F[9])
{
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/* Mean of the Cauchy stress P F^T / J over the current volume J w; it differs from that of the means of P and F. */
static void MeanCauchy(PetscInt n, const LamMaterialPoint points[], const PetscReal weight[], PetscReal cauchy[9])
{
  PetscReal volume = 0;

  if (!points[0].known) return; /* nothing has been solved yet */
  for (PetscInt q = 0; q < n; q++) volume += weight[q] * Determinant(points[q].load.F);
  for (PetscInt q = 0; q < n; q++) {
    const PetscReal *P = points[q].P, *F = points[q].load.F;
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        for (int k = 0; k < 3; k++) cauchy[3 * i + j] += weight[q] / volume * P[3 * i + k] * F[3 * j + k];
      }
    }
  }
}

static void ElementMeans(PetscInt n, const LamMaterialPoint points[], const PetscReal weight[], ElementRecord *record)
{
  PetscReal area = 0;

  for (PetscInt q = 0; q < n; q++) area += weight[q];
  for (int k = 0; k < LAM_POINT_FIELD_COUNT; k++) record->largest[k] = points[0].field[k];
  for (PetscInt q = 0; q < n; q++) {
    const LamMaterialPoint *point = &points[q];
    const PetscReal share = weight[q] / area;
    for (int k = 0; k < 9; k++) {
      record->F[k] += share * point->load.F[k];
      record->P[k] += share * point->P[k];
    }
    for (int k = 0; k < LAM_POINT_FIELD_COUNT; k++) {
      record->mean[k] += share * point->field[k];
      record->largest[k] = LamPointFieldWorse((LamPointField)k, record->largest[k], point->field[k]);
    }
  }
}

static PetscErrorCode CollectElements(LamMacro macro, PetscInt *n, ElementRecord **elements)
{
  PetscFunctionBeginUser;
  *n = macro->element_count;
  PetscCall(PetscCalloc1(*n, elements));
  for (PetscInt e = 0; e < *n; e++) {
    const LamMacroElement *element = &macro->elements[e];
    const LamMaterialPoint *points = &macro->accepted[element->first];
    const PetscReal *weight = &macro->weight[element->first];
    ElementRecord *record = &(*elements)[e];
    record->number = element->number;
    record->points = element->kind->points;
    PetscCall(ElementNodes(macro, e, record->nodes));
    ElementMeans(record->points, points, weight, record);
    MeanCauchy(record->points, points, weight, record->cauchy);
  }
  PetscFunctionReturn(0);
}

/* Point q of an element, at displacements ue[nodes][dim] of its nodes: x = X + sum_a N_a u_a. */
static void FillPoint(LamMacro macro, const LamMacroElement *element, PetscInt q, const PetscScalar ue[],
                      PointRecord *record)
{
  const PetscInt p = element->first + q, nodes = element->kind->nodes;
  const LamMaterialPoint *point = &macro->accepted[p];

  record->element = element->number;
  record->index = q;
  record->load = point->load;
  record->volume = macro->weight[p];
  for (int k = 0; k < 9; k++) record->P[k] = point->P[k];
  for (int k = 0; k < LAM_POINT_FIELD_COUNT; k++) record->field[k] = point->field[k];
  for (int i = 0; i < 2; i++) {
    record->place[i] = record->position[i] = macro->place[macro->dim * p + i];
    for (PetscInt a = 0; a < nodes; a++)
      record->position[i] += element->kind->value[q * nodes + a] * PetscRealPart(ue[macro->dim * a + i]);
  }
}

static PetscErrorCode CollectPoints(LamMacro macro, PetscInt *n, PointRecord **points)
{
  PetscSection section;
  Vec local;

  PetscFunctionBeginUser;
  *n = macro->point_count;
  PetscCall(PetscMalloc1(*n, points));
  PetscCall(DMGetLocalSection(macro->dm, &section));
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(DMGlobalToLocal(macro->dm, macro->u, INSERT_VALUES, local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar *ue = NULL;
    PetscCall(DMPlexVecGetClosure(macro->dm, section, local, macro->mesh_start + e, NULL, &ue));
    for (PetscInt q = 0; q < element->kind->points; q++)
      FillPoint(macro, element, q, ue, &(*points)[element->first + q]);
    PetscCall(DMPlexVecRestoreClosure(macro->dm, section, local, macro->mesh_start + e, NULL, &ue));
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscFunctionReturn(0);
}

static PetscErrorCode GetNodes(LamMacro macro, LamMacroFields *fields)
{
  NodeRecord *own, *all;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(CollectNodes(macro, &n, &own));
  PetscCall(GatherItems(macro->comm, sizeof(NodeRecord), n, own, &fields->node_count, (void **)&all));
  PetscCall(PetscFree(own));
  if (!all) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(2 * fields->node_count, &fields->nodes));
  PetscCall(PetscMalloc1(2 * fields->node_count, &fields->u));
  for (PetscInt k = 0; k < fields->node_count; k++) {
    PetscCall(PetscArraycpy(&fields->nodes[2 * all[k].number], all[k].X, 2));
    PetscCall(PetscArraycpy(&fields->u[2 * all[k].number], all[k].u, 2));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepElements(const ElementRecord elements[], LamMacroFields *fields)
{
  const PetscInt count = fields->element_count, n = LAM_POINT_FIELD_COUNT;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(LAM_FIELD_NODES * count, &fields->elements));
  PetscCall(PetscMalloc1(9 * count, &fields->F));
  PetscCall(PetscMalloc1(9 * count, &fields->P));
  PetscCall(PetscMalloc1(9 * count, &fields->cauchy));
  PetscCall(PetscMalloc1(n * count, &fields->mean));
  PetscCall(PetscMalloc1(n * count, &fields->largest));
  PetscCall(PetscCalloc1(count + 1, &fields->first_point));
  for (PetscInt k = 0; k < count; k++) {
    const ElementRecord *element = &elements[k];
    PetscCall(PetscArraycpy(&fields->elements[LAM_FIELD_NODES * element->number], element->nodes, LAM_FIELD_NODES));
    PetscCall(PetscArraycpy(&fields->F[9 * element->number], element->F, 9));
    PetscCall(PetscArraycpy(&fields->P[9 * element->number], element->P, 9));
    PetscCall(PetscArraycpy(&fields->cauchy[9 * element->number], element->cauchy, 9));
    PetscCall(PetscArraycpy(&fields->mean[n * element->number], element->mean, n));
    PetscCall(PetscArraycpy(&fields->largest[n * element->number], element->largest, n));
    fields->first_point[element->number + 1] = element->points;
  }
  for (PetscInt e = 0; e < count; e++) fields->first_point[e + 1] += fields->first_point[e];
  PetscFunctionReturn(0);
}

static PetscErrorCode GetElements(LamMacro macro, LamMacroFields *fields)
{
  ElementRecord *own, *all;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(CollectElements(macro, &n, &own));
  PetscCall(GatherItems(macro->comm, sizeof(ElementRecord), n, own, &fields->element_count, (void **)&all));
  PetscCall(PetscFree(own));
  if (all) PetscCall(KeepElements(all, fields));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Call after GetElements. */
static PetscErrorCode GetPoints(LamMacro macro, LamMacroFields *fields)
{
  PointRecord *own, *all;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(CollectPoints(macro, &n, &own));
  PetscCall(GatherItems(macro->comm, sizeof(PointRecord), n, own, &fields->point_count, (void **)&all));
  PetscCall(PetscFree(own));
  if (!all) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(LAM_POINT_FIELD_COUNT * fields->point_count, &fields->point));
  PetscCall(PetscMalloc1(fields->point_count, &fields->load));
  PetscCall(PetscMalloc1(9 * fields->point_count, &fields->point_P));
  PetscCall(PetscMalloc1(2 * fields->point_count, &fields->place));
  PetscCall(PetscMalloc1(2 * fields->point_count, &fields->position));
  PetscCall(PetscMalloc1(fields->point_count, &fields->volume));
  for (PetscInt k = 0; k < fields->point_count; k++) {
    const PetscInt p = fields->first_point[all[k].element] + all[k].index;
    PetscCall(PetscArraycpy(&fields->point[LAM_POINT_FIELD_COUNT * p], all[k].field, LAM_POINT_FIELD_COUNT));
    fields->load[p] = all[k].load;
    PetscCall(PetscArraycpy(&fields->point_P[9 * p], all[k].P, 9));
    PetscCall(PetscArraycpy(&fields->place[2 * p], all[k].place, 2));
    PetscCall(PetscArraycpy(&fields->position[2 * p], all[k].position, 2));
    fields->volume[p] = all[k].volume;
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetFields(LamMacro macro, LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(fields, sizeof(*fields)));
  PetscCall(GetNodes(macro, fields));
  PetscCall(GetElements(macro, fields));
  PetscCall(GetPoints(macro, fields));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFieldsDestroy(LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(fields->nodes));
  PetscCall(PetscFree(fields->u));
  PetscCall(PetscFree(fields->elements));
  PetscCall(PetscFree(fields->F));
  PetscCall(PetscFree(fields->P));
  PetscCall(PetscFree(fields->cauchy));
  PetscCall(PetscFree(fields->mean));
  PetscCall(PetscFree(fields->largest));
  PetscCall(PetscFree(fields->first_point));
  PetscCall(PetscFree(fields->point));
  PetscCall(PetscFree(fields->load));
  PetscCall(PetscFree(fields->point_P));
  PetscCall(PetscFree(fields->place));
  PetscCall(PetscFree(fields->position));
  PetscCall(PetscFree(fields->volume));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFindPoint(LamMacro macro, PetscInt element, PetscInt index, PetscInt *point)
{
  PetscFunctionBeginUser;
  *point = -1;
  for (PetscInt e = 0; e < macro->element_count; e++) {
    if (macro->elements[e].number == element) *point = macro->elements[e].first + index;
  }
  PetscFunctionReturn(0);
}
