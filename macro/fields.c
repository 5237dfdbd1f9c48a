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
                     field == LAM_POINT_SHEAR || field == LAM_POINT_ELLIPTICITY || field == LAM_POINT_POTENTIAL ||
                     field == LAM_POINT_APOPLAST);
}

PetscBool LamPointFieldIsEnergy(LamPointField field)
{
  return (PetscBool)(field == LAM_POINT_STORED || field == LAM_POINT_DISSIPATED || field == LAM_POINT_RELEASED ||
                     field == LAM_POINT_WORK);
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

/* The largest of the known ones: a patch may lack a face family. */
static PetscReal MostBroken(const LamResponse *r)
{
  PetscReal most = NAN;

  for (int k = 0; k < 3; k++)
    if (!(r->broken_by_face[k] <= most) && !isnan(r->broken_by_face[k])) most = r->broken_by_face[k];
  return most;
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
  field[LAM_POINT_POTENTIAL] = field[LAM_POINT_APOPLAST] = NAN; /* of converged states (transport.c) */
  field[LAM_POINT_BROKEN] = response->broken_fraction;
  field[LAM_POINT_BROKEN_FACE] = MostBroken(response);
  field[LAM_POINT_STORED] = response->stored;
  field[LAM_POINT_DISSIPATED] = response->dissipated;
  field[LAM_POINT_RELEASED] = response->released;
  field[LAM_POINT_WORK] = response->work;
}

/* ---- the arrays of LamMacroFields ---- */

typedef enum { NODE, ELEMENT, POINT, KINDS } Kind;

typedef struct {
  void **array; /* one item per node, element or material point */
  Kind kind;
  size_t size; /* of an item, bytes */
} Member;

enum { MEMBERS = 15, FIELDS = LAM_POINT_FIELD_COUNT };

/* All but first_point. */
static void ListMembers(LamMacroFields *f, Member members[MEMBERS])
{
  const size_t real = sizeof(PetscReal);
  const Member list[MEMBERS] = {
      {(void **)&f->nodes, NODE, 2 * real},
      {(void **)&f->u, NODE, 2 * real},
      {(void **)&f->gripped, NODE, sizeof(PetscInt)},
      {(void **)&f->elements, ELEMENT, LAM_FIELD_NODES * sizeof(PetscInt)},
      {(void **)&f->F, ELEMENT, 9 * real},
      {(void **)&f->P, ELEMENT, 9 * real},
      {(void **)&f->cauchy, ELEMENT, 9 * real},
      {(void **)&f->mean, ELEMENT, FIELDS * real},
      {(void **)&f->largest, ELEMENT, FIELDS * real},
      {(void **)&f->point, POINT, FIELDS * real},
      {(void **)&f->load, POINT, sizeof(LamLoad)},
      {(void **)&f->point_P, POINT, 9 * real},
      {(void **)&f->place, POINT, 2 * real},
      {(void **)&f->position, POINT, 2 * real},
      {(void **)&f->volume, POINT, real},
  };

  memcpy(members, list, sizeof(list));
}

static PetscErrorCode FieldsCreate(const PetscInt n[KINDS], LamMacroFields *fields)
{
  Member members[MEMBERS];

  PetscFunctionBeginUser;
  *fields = (LamMacroFields){.node_count = n[NODE], .element_count = n[ELEMENT], .point_count = n[POINT]};
  ListMembers(fields, members);
  for (int k = 0; k < MEMBERS; k++)
    PetscCall(PetscCalloc((size_t)n[members[k].kind] * members[k].size, members[k].array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFieldsDestroy(LamMacroFields *fields)
{
  Member members[MEMBERS];

  PetscFunctionBeginUser;
  ListMembers(fields, members);
  for (int k = 0; k < MEMBERS; k++) PetscCall(PetscFree(*members[k].array));
  PetscCall(PetscFree(fields->first_point));
  PetscFunctionReturn(0);
}

/* Sends this rank's n items of a kind to rank 0; to[n]: their place there. */
static PetscErrorCode GatherKind(LamMacro macro, Kind kind, PetscInt n, PetscSFNode *to, LamMacroFields *own,
                                 PetscInt total, LamMacroFields *all)
{
  Member from[MEMBERS], into[MEMBERS];
  MPI_Datatype item;
  PetscSF sf;

  PetscFunctionBeginUser;
  ListMembers(own, from);
  ListMembers(all, into);
  PetscCall(PetscSFCreate(macro->comm, &sf));
  PetscCall(PetscSFSetGraph(sf, total, n, NULL, PETSC_COPY_VALUES, to, PETSC_USE_POINTER));
  for (int k = 0; k < MEMBERS; k++) {
    if (from[k].kind != kind) continue;
    PetscCallMPI(MPI_Type_contiguous((int)from[k].size, MPI_BYTE, &item));
    PetscCallMPI(MPI_Type_commit(&item));
    PetscCall(PetscSFReduceBegin(sf, item, *from[k].array, *into[k].array, MPI_REPLACE));
    PetscCall(PetscSFReduceEnd(sf, item, *from[k].array, *into[k].array, MPI_REPLACE));
    PetscCallMPI(MPI_Type_free(&item));
  }
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(0);
}

/* ---- the fields of one rank ---- */

static PetscInt IsGripped(LamMacro macro, PetscInt point)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscBool held =
        (PetscBool)(boundary->kind == LAM_BOUNDARY_DISPLACEMENT && boundary->given[0] && boundary->given[1]);
    if ((held || boundary->kind == LAM_BOUNDARY_GRIP) && LamMacroIsOn(macro, point, boundary->on)) return 1;
  }
  return 0;
}

static PetscErrorCode CollectNodes(LamMacro macro, LamMacroFields *own, PetscSFNode to[])
{
  const PetscScalar *u;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(macro->u, &u));
  for (PetscInt k = 0; k < macro->node_count; k++) {
    const LamMacroNode *node = &macro->nodes[k];
    to[k].index = node->number;
    own->gripped[k] = IsGripped(macro, node->point);
    for (int i = 0; i < 2; i++) {
      own->nodes[2 * k + i] = node->X[i];
      own->u[2 * k + i] = PetscRealPart(u[node->local + i]);
    }
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

/* Means over the n points of element e, and their most critical values. */
static void ElementMeans(PetscInt n, const LamMaterialPoint points[], const PetscReal weight[], PetscInt e,
                         LamMacroFields *own)
{
  PetscReal *mean = &own->mean[FIELDS * e], *largest = &own->largest[FIELDS * e], area = 0;

  for (PetscInt q = 0; q < n; q++) area += weight[q];
  for (int k = 0; k < FIELDS; k++) largest[k] = points[0].field[k];
  for (PetscInt q = 0; q < n; q++) {
    const PetscReal share = weight[q] / area;
    for (int k = 0; k < 9; k++) {
      own->F[9 * e + k] += share * points[q].load.F[k];
      own->P[9 * e + k] += share * points[q].P[k];
    }
    for (int k = 0; k < FIELDS; k++) {
      mean[k] += share * points[q].field[k];
      largest[k] = LamPointFieldWorse((LamPointField)k, largest[k], points[q].field[k]);
    }
  }
}

static PetscErrorCode CollectElements(LamMacro macro, LamMacroFields *own, PetscSFNode to[])
{
  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    const LamMaterialPoint *points = &macro->accepted[element->first];
    const PetscReal *weight = &macro->weight[element->first];
    to[e].index = element->number;
    PetscCall(ElementNodes(macro, e, &own->elements[LAM_FIELD_NODES * e]));
    ElementMeans(element->kind->points, points, weight, e, own);
    MeanCauchy(element->kind->points, points, weight, &own->cauchy[9 * e]);
  }
  PetscFunctionReturn(0);
}

/* Point q of an element, at displacements ue[nodes][dim] of its nodes: x = X + sum_a N_a u_a. */
static void FillPoint(LamMacro macro, const LamMacroElement *element, PetscInt q, const PetscScalar ue[],
                      LamMacroFields *own)
{
  const PetscInt p = element->first + q, nodes = element->kind->nodes;
  const LamMaterialPoint *point = &macro->accepted[p];

  own->load[p] = point->load;
  own->volume[p] = macro->weight[p];
  memcpy(&own->point_P[9 * p], point->P, sizeof(point->P));
  memcpy(&own->point[FIELDS * p], point->field, sizeof(point->field));
  for (int i = 0; i < 2; i++) {
    PetscReal *x = &own->position[2 * p + i];
    *x = own->place[2 * p + i] = macro->place[macro->dim * p + i];
    for (PetscInt a = 0; a < nodes; a++)
      *x += element->kind->value[q * nodes + a] * PetscRealPart(ue[macro->dim * a + i]);
  }
}

static PetscErrorCode CollectPoints(LamMacro macro, const PetscInt first_point[], LamMacroFields *own, PetscSFNode to[])
{
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(DMGlobalToLocal(macro->dm, macro->u, INSERT_VALUES, local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar *ue = NULL;
    PetscCall(DMPlexVecGetClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &ue));
    for (PetscInt q = 0; q < element->kind->points; q++) {
      FillPoint(macro, element, q, ue, own);
      to[element->first + q].index = first_point[element->number] + q;
    }
    PetscCall(DMPlexVecRestoreClosure(macro->dm, NULL, local, macro->mesh_start + e, NULL, &ue));
  }
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscFunctionReturn(0);
}

/* ---- gathering ---- */

/* first_point of `elements` elements, on all ranks. */
static PetscErrorCode CountPoints(LamMacro macro, PetscInt elements, PetscInt **first_point)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(elements + 1, first_point));
  for (PetscInt e = 0; e < macro->element_count; e++)
    (*first_point)[macro->elements[e].number + 1] = macro->elements[e].kind->points;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, *first_point, elements + 1, MPIU_INT, MPI_SUM, macro->comm));
  for (PetscInt e = 0; e < elements; e++) (*first_point)[e + 1] += (*first_point)[e];
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetFields(LamMacro macro, LamMacroFields *fields)
{
  const PetscInt n[KINDS] = {macro->node_count, macro->element_count, macro->point_count};
  PetscInt total[KINDS], *first_point;
  PetscSFNode *to[KINDS]; /* rank 0, and the item's number */
  LamMacroFields own;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(macro->comm, &rank));
  PetscCall(FieldsCreate(n, &own));
  PetscCall(PetscCalloc3(n[NODE], &to[NODE], n[ELEMENT], &to[ELEMENT], n[POINT], &to[POINT]));
  PetscCall(CollectNodes(macro, &own, to[NODE]));
  PetscCallMPI(MPI_Allreduce(n, total, KINDS, MPIU_INT, MPI_SUM, macro->comm));
  PetscCall(CountPoints(macro, total[ELEMENT], &first_point));
  PetscCall(CollectElements(macro, &own, to[ELEMENT]));
  PetscCall(CollectPoints(macro, first_point, &own, to[POINT]));
  if (rank) PetscCall(PetscArrayzero(total, KINDS));
  PetscCall(FieldsCreate(total, fields));
  for (Kind kind = NODE; kind < KINDS; kind++)
    PetscCall(GatherKind(macro, kind, n[kind], to[kind], &own, total[kind], fields));
  if (rank == 0)
    fields->first_point = first_point;
  else
    PetscCall(PetscFree(first_point));
  PetscCall(PetscFree3(to[NODE], to[ELEMENT], to[POINT]));
  PetscCall(LamMacroFieldsDestroy(&own));
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
