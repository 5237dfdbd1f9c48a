/*
  Fields of the last converged state, gathered on rank 0 in the numbering of the undistributed mesh.
*/
#include "macro_impl.h"

/* What a rank sends of a node and of an element. */
typedef struct {
  PetscInt number;
  PetscReal X[2], u[2];
} NodeRecord;

typedef struct {
  PetscInt number;
  PetscInt nodes[LAM_FIELD_NODES];
  PetscReal F[9], P[9], cauchy[9], indicator[4];
} ElementRecord;

/* Gathers n items of `size` bytes from each rank on rank 0; `all` is NULL elsewhere. The caller frees it. */
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

/* Nodes in VTK's order: corners, mid-edges, centre; a closure lists centre, edges, corners. A triangle's is left out.
 */
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

/* Mean of the Cauchy stress P F^T / J over the present volume J w: of the means of P and F it would be another. */
static void MeanCauchy(PetscInt n, const LamMaterialPoint points[], const PetscReal weight[], PetscReal cauchy[9])
{
  PetscReal volume = 0;

  if (!points[0].known) return; /* nothing has been solved */
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

static void ElementMeans(LamMacro macro, const LamMacroElement *element, ElementRecord *record)
{
  PetscReal area = 0;

  for (PetscInt q = 0; q < element->kind->points; q++) area += macro->weight[element->first + q];
  for (PetscInt q = 0; q < element->kind->points; q++) {
    const LamMaterialPoint *point = &macro->accepted[element->first + q];
    const PetscReal share = macro->weight[element->first + q] / area;
    const PetscReal indicator[4] = {point->lumen_fraction, point->opening_fraction, point->debonded_fraction,
                                    point->load.turgor};
    for (int k = 0; k < 9; k++) {
      record->F[k] += share * point->load.F[k];
      record->P[k] += share * point->P[k];
    }
    for (int k = 0; k < 4; k++) record->indicator[k] += share * indicator[k];
  }
}

static PetscErrorCode CollectElements(LamMacro macro, PetscInt *n, ElementRecord **elements)
{
  PetscFunctionBeginUser;
  *n = macro->element_count;
  PetscCall(PetscCalloc1(*n, elements));
  for (PetscInt e = 0; e < *n; e++) {
    const LamMacroElement *element = &macro->elements[e];
    (*elements)[e].number = element->number;
    PetscCall(ElementNodes(macro, e, (*elements)[e].nodes));
    ElementMeans(macro, element, &(*elements)[e]);
    MeanCauchy(element->kind->points, &macro->accepted[element->first], &macro->weight[element->first],
               (*elements)[e].cauchy);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Allocate(LamMacroFields *fields)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * fields->node_count, &fields->nodes));
  PetscCall(PetscMalloc1(2 * fields->node_count, &fields->u));
  PetscCall(PetscMalloc1(LAM_FIELD_NODES * fields->element_count, &fields->elements));
  PetscCall(PetscMalloc1(9 * fields->element_count, &fields->F));
  PetscCall(PetscMalloc1(9 * fields->element_count, &fields->P));
  PetscCall(PetscMalloc1(9 * fields->element_count, &fields->cauchy));
  PetscCall(PetscMalloc1(4 * fields->element_count, &fields->indicator));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetFields(LamMacro macro, LamMacroFields *fields)
{
  NodeRecord *nodes, *all_nodes;
  ElementRecord *elements, *all_elements;
  PetscInt node_count = 0, element_count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(fields, sizeof(*fields)));
  PetscCall(CollectNodes(macro, &node_count, &nodes));
  PetscCall(CollectElements(macro, &element_count, &elements));
  PetscCall(GatherItems(macro->comm, sizeof(NodeRecord), node_count, nodes, &fields->node_count, (void **)&all_nodes));
  PetscCall(GatherItems(macro->comm, sizeof(ElementRecord), element_count, elements, &fields->element_count,
                        (void **)&all_elements));
  PetscCall(PetscFree(nodes));
  PetscCall(PetscFree(elements));
  if (!all_nodes) PetscFunctionReturn(0);
  PetscCall(Allocate(fields));
  for (PetscInt k = 0; k < fields->node_count; k++) {
    const NodeRecord *node = &all_nodes[k];
    PetscCall(PetscArraycpy(&fields->nodes[2 * node->number], node->X, 2));
    PetscCall(PetscArraycpy(&fields->u[2 * node->number], node->u, 2));
  }
  for (PetscInt k = 0; k < fields->element_count; k++) {
    const ElementRecord *element = &all_elements[k];
    PetscCall(PetscArraycpy(&fields->elements[LAM_FIELD_NODES * element->number], element->nodes, LAM_FIELD_NODES));
    PetscCall(PetscArraycpy(&fields->F[9 * element->number], element->F, 9));
    PetscCall(PetscArraycpy(&fields->P[9 * element->number], element->P, 9));
    PetscCall(PetscArraycpy(&fields->cauchy[9 * element->number], element->cauchy, 9));
    PetscCall(PetscArraycpy(&fields->indicator[4 * element->number], element->indicator, 4));
  }
  PetscCall(PetscFree(all_nodes));
  PetscCall(PetscFree(all_elements));
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
  PetscCall(PetscFree(fields->indicator));
  PetscFunctionReturn(0);
}
