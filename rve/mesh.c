#include "mesh.h"

/* Corner `k` of the unit hexagon (apothem 1): the start of face k, going counter-clockwise. */
static void HexagonCorner(PetscReal orientation, PetscInt k, PetscReal corner[2])
{
  const PetscReal angle = orientation + (60.0 * (PetscReal)(k % LAM_FACES) - 30.0) * PETSC_PI / 180.0;

  corner[0] = 2.0 / PetscSqrtReal(3.0) * PetscCosReal(angle);
  corner[1] = 2.0 / PetscSqrtReal(3.0) * PetscSinReal(angle);
}

static void LatticeVector(PetscReal orientation, PetscInt k, PetscReal L[2])
{
  const PetscReal angle = orientation + 60.0 * (PetscReal)k * PETSC_PI / 180.0;

  L[0] = 2.0 * PetscCosReal(angle);
  L[1] = 2.0 * PetscSinReal(angle);
}

static PetscInt NodeNumber(const LamMesh *mesh, PetscInt cell, PetscInt around, PetscInt radial)
{
  return (cell * mesh->ring_nodes + around % mesh->ring_nodes) * mesh->radial_nodes + radial;
}

static void PlaceNodes(const LamMicrostructure *micro, LamMesh *mesh)
{
  PetscReal L[2][2];

  for (PetscInt k = 0; k < 2; ++k) LatticeVector(micro->orientation, k, L[k]);
  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt d = 0; d < 2; ++d) mesh->period[k][d] = L[k][d] * (PetscReal)micro->cells[k];
  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell) {
    const PetscReal ci = (PetscReal)(cell / micro->cells[1]), cj = (PetscReal)(cell % micro->cells[1]);

    for (PetscInt around = 0; around < mesh->ring_nodes; ++around) {
      const PetscInt face = around / (2 * mesh->along);
      const PetscReal u = (PetscReal)(around % (2 * mesh->along)) / (PetscReal)(2 * mesh->along);
      PetscReal a[2], b[2];

      HexagonCorner(micro->orientation, face, a);
      HexagonCorner(micro->orientation, face + 1, b);
      for (PetscInt r = 0; r < mesh->radial_nodes; ++r) {
        const PetscReal apothem =
            1.0 - micro->wall_thickness * (1.0 - (PetscReal)r / (PetscReal)(mesh->radial_nodes - 1));
        PetscReal *X = &mesh->X[2 * NodeNumber(mesh, cell, around, r)];

        for (PetscInt d = 0; d < 2; ++d) X[d] = ci * L[0][d] + cj * L[1][d] + apothem * ((1.0 - u) * a[d] + u * b[d]);
      }
    }
  }
}

static void ConnectElements(LamMesh *mesh)
{
  /* (radial, around) offsets of the nine nodes: radial first makes the element counter-clockwise */
  static const PetscInt offset[LAM_ELEMENT_NODES][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0},
                                                        {2, 1}, {1, 2}, {0, 1}, {1, 1}};

  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell)
    for (PetscInt face = 0; face < LAM_FACES; ++face)
      for (PetscInt i = 0; i < mesh->along; ++i)
        for (PetscInt m = 0; m < mesh->through; ++m) {
          const PetscInt e = LamMeshElement(mesh, cell, face, i, m);

          mesh->cell_of[e] = cell;
          for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
            mesh->elements[LAM_ELEMENT_NODES * e + a] =
                NodeNumber(mesh, cell, 2 * (face * mesh->along + i) + offset[a][1], 2 * m + offset[a][0]);
        }
}

typedef struct {
  PetscReal key[2]; /* lattice coordinates modulo one period, rounded */
  PetscInt node;
} OuterNode;

static int CompareOuterNodes(const void *pa, const void *pb)
{
  const OuterNode *a = (const OuterNode *)pa, *b = (const OuterNode *)pb;

  for (PetscInt d = 0; d < 2; ++d)
    if (a->key[d] != b->key[d]) return a->key[d] < b->key[d] ? -1 : 1;
  return a->node < b->node ? -1 : (a->node > b->node);
}

/* Coordinate along the period vectors, modulo 1, on a grid that separates nodes and joins rounding. */
static PetscReal WrapCoordinate(PetscReal c)
{
  const PetscReal grid = 1048576.0;
  const PetscReal rounded = PetscFloorReal(c * grid + 0.5) / grid;
  const PetscReal wrapped = rounded - PetscFloorReal(rounded);

  return PetscFloorReal(wrapped * grid + 0.5) >= grid ? 0.0 : wrapped;
}

/* Coincident outer nodes, also across the period, get the same representative. */
static PetscErrorCode TieOuterNodes(LamMesh *mesh)
{
  const PetscReal(*p)[2] = (const PetscReal(*)[2])mesh->period;
  const PetscReal det = p[0][0] * p[1][1] - p[0][1] * p[1][0];
  const PetscInt outer_count = mesh->cell_count * mesh->ring_nodes;
  OuterNode *outer;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(outer_count, &outer));
  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell)
    for (PetscInt around = 0; around < mesh->ring_nodes; ++around) {
      const PetscInt node = LamMeshOuterNode(mesh, cell, around);
      const PetscReal *X = &mesh->X[2 * node];

      outer[n].node = node;
      /* the offset keeps faces, which lie at multiples of 1/2 or 1/3 of a period, away from the seam */
      outer[n].key[0] = WrapCoordinate((X[0] * p[1][1] - X[1] * p[1][0]) / det + 0.123456789);
      outer[n].key[1] = WrapCoordinate((X[1] * p[0][0] - X[0] * p[0][1]) / det + 0.123456789);
      ++n;
    }
  qsort(outer, (size_t)outer_count, sizeof(*outer), CompareOuterNodes);
  for (PetscInt i = 1; i < outer_count; ++i)
    if (outer[i].key[0] == outer[i - 1].key[0] && outer[i].key[1] == outer[i - 1].key[1])
      mesh->node_class[outer[i].node] = mesh->node_class[outer[i - 1].node];
  PetscCall(PetscFree(outer));
  PetscFunctionReturn(0);
}

/* Numbers the classes in node order and sets the shifts. */
static PetscErrorCode NumberClasses(LamMesh *mesh)
{
  PetscInt *number;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->node_count, &number));
  mesh->class_count = 0;
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    if (mesh->node_class[i] == i) number[i] = mesh->class_count++;
  PetscCall(PetscMalloc1(2 * mesh->class_count, &mesh->class_X));
  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    const PetscInt representative = mesh->node_class[i];

    for (PetscInt d = 0; d < 2; ++d) {
      mesh->shift[2 * i + d] = representative == i ? 0.0 : mesh->X[2 * i + d] - mesh->X[2 * representative + d];
      if (PetscAbsReal(mesh->shift[2 * i + d]) < 1e-9) mesh->shift[2 * i + d] = 0.0;
      mesh->class_X[2 * number[representative] + d] = mesh->X[2 * representative + d];
    }
  }
  for (PetscInt i = 0; i < mesh->node_count; ++i) mesh->node_class[i] = number[mesh->node_class[i]];
  PetscCall(PetscFree(number));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    mesh->has_shift[e] = PETSC_FALSE;
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a) {
      const PetscReal *S = &mesh->shift[2 * mesh->elements[LAM_ELEMENT_NODES * e + a]];

      if (S[0] != 0.0 || S[1] != 0.0) mesh->has_shift[e] = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshCreate(const LamMicrostructure *micro, LamMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCheck(micro->along > 0 && micro->through > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "elements along a face and through a wall must be chosen, got %d and %d", (int)micro->along,
             (int)micro->through);
  PetscCheck(micro->wall_thickness > 0.0 && micro->wall_thickness < 1.0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "wall thickness is %g apothems; it must lie between 0 and 1", (double)micro->wall_thickness);
  mesh->along = micro->along;
  mesh->through = micro->through;
  mesh->cell_count = micro->cells[0] * micro->cells[1];
  mesh->ring_nodes = 2 * LAM_FACES * micro->along;
  mesh->radial_nodes = 2 * micro->through + 1;
  mesh->node_count = mesh->cell_count * mesh->ring_nodes * mesh->radial_nodes;
  mesh->element_count = mesh->cell_count * LAM_FACES * micro->along * micro->through;
  mesh->V0 = 2.0 * PetscSqrtReal(3.0) * (PetscReal)mesh->cell_count;
  PetscCall(PetscMalloc1(2 * mesh->node_count, &mesh->X));
  PetscCall(PetscMalloc1(LAM_ELEMENT_NODES * mesh->element_count, &mesh->elements));
  PetscCall(PetscMalloc1(mesh->element_count, &mesh->cell_of));
  PetscCall(PetscMalloc1(mesh->node_count, &mesh->node_class));
  PetscCall(PetscMalloc1(2 * mesh->node_count, &mesh->shift));
  PetscCall(PetscMalloc1(mesh->element_count, &mesh->has_shift));
  PlaceNodes(micro, mesh);
  ConnectElements(mesh);
  for (PetscInt i = 0; i < mesh->node_count; ++i) mesh->node_class[i] = i; /* representative node, for now */
  if (micro->interface == LAM_INTERFACE_BONDED) PetscCall(TieOuterNodes(mesh));
  PetscCall(NumberClasses(mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshDestroy(LamMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(mesh->X));
  PetscCall(PetscFree(mesh->elements));
  PetscCall(PetscFree(mesh->cell_of));
  PetscCall(PetscFree(mesh->node_class));
  PetscCall(PetscFree(mesh->shift));
  PetscCall(PetscFree(mesh->has_shift));
  PetscCall(PetscFree(mesh->class_X));
  PetscFunctionReturn(0);
}

void LamMeshNeighbour(const LamMicrostructure *micro, const LamMesh *mesh, PetscInt cell, PetscInt face,
                      PetscInt *other, PetscReal shift[2])
{
  static const PetscInt step[3][2] = {{1, 0}, {0, 1}, {-1, 1}}; /* L_2 = L_1 - L_0 */
  const PetscInt at[2] = {cell / micro->cells[1], cell % micro->cells[1]};
  PetscInt index[2];

  shift[0] = shift[1] = 0.0;
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscInt n = micro->cells[k], to = at[k] + step[face][k];
    const PetscInt wraps = to < 0 ? -1 : to / n;

    index[k] = to - wraps * n;
    for (PetscInt d = 0; d < 2; ++d) shift[d] += (PetscReal)wraps * mesh->period[k][d];
  }
  *other = index[0] * micro->cells[1] + index[1];
}
