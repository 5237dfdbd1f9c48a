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

static void FindNeighbours(const LamMicrostructure *micro, LamMesh *mesh)
{
  for (PetscInt k = 0; k < LAM_FACES * mesh->cell_count; ++k) {
    PetscInt wraps[2];

    mesh->neighbour[k] = LamLatticeNeighbour(micro, k / LAM_FACES, k % LAM_FACES, wraps, &mesh->held[k]);
    for (PetscInt d = 0; d < 2; ++d)
      mesh->image[2 * k + d] = (PetscReal)wraps[0] * mesh->period[0][d] + (PetscReal)wraps[1] * mesh->period[1][d];
  }
}

#define ORIGIN -1 /* representative of nodes prescribed at F X */

static void PlaceEnds(PetscReal grading, LamMesh *mesh)
{
  for (PetscInt i = 0; i <= mesh->along; ++i) {
    const PetscReal s = (PetscReal)i / (PetscReal)mesh->along;

    mesh->ends[i] = s - grading * PetscSinReal(2.0 * PETSC_PI * s) / (2.0 * PETSC_PI);
  }
  mesh->ends[mesh->along] = 1.0;
}

static void PlaceNodes(const LamMicrostructure *micro, LamMesh *mesh)
{
  PetscReal L[2][2];

  for (PetscInt k = 0; k < 2; ++k) LatticeVector(micro->orientation, k, L[k]);
  for (PetscInt k = 0; k < 2 && !micro->is_patch; ++k)
    for (PetscInt d = 0; d < 2; ++d) mesh->period[k][d] = L[k][d] * (PetscReal)micro->cells[k];
  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell) {
    const PetscReal thickness = LamWallThickness(micro, cell);
    PetscInt index[2];

    LamLatticeIndex(micro, cell, index);

    for (PetscInt i = 0; i < 3 * LAM_FACES * mesh->along; ++i) {
      const PetscInt column = i / 3, face = column / mesh->along;
      const PetscReal u = LamMeshShare(mesh, (PetscReal)(column % mesh->along) + 0.5 * (PetscReal)(i % 3));
      PetscReal a[2], b[2];

      HexagonCorner(micro->orientation, face, a);
      HexagonCorner(micro->orientation, face + 1, b);
      for (PetscInt r = 0; r < mesh->radial_nodes; ++r) {
        const PetscReal apothem =
            mesh->apothem - thickness * (1.0 - (PetscReal)r / (PetscReal)(mesh->radial_nodes - 1));
        PetscReal *X = &mesh->X[2 * LamMeshNode(mesh, cell, LamMeshRing(mesh, column, i % 3), r)];

        for (PetscInt d = 0; d < 2; ++d)
          X[d] =
              (PetscReal)index[0] * L[0][d] + (PetscReal)index[1] * L[1][d] + apothem * ((1.0 - u) * a[d] + u * b[d]);
      }
    }
  }
}

static void ConnectElements(LamMesh *mesh)
{
  /* (radial, around) offsets of the nine nodes; radial first makes the element counter-clockwise */
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
                LamMeshNode(mesh, cell, LamMeshRing(mesh, face * mesh->along + i, offset[a][1]), 2 * m + offset[a][0]);
        }
}

/* Representative of a node: the root of its class. */
static PetscInt FirstOf(const PetscInt tied[], PetscInt node)
{
  while (tied[node] != node) node = tied[node];
  return node;
}

/* Puts two nodes into one class. The representative is the lowest node number. */
static void Tie(LamMesh *mesh, PetscInt one, PetscInt other)
{
  const PetscInt a = FirstOf(mesh->node_class, one), b = FirstOf(mesh->node_class, other);

  mesh->node_class[PetscMax(a, b)] = PetscMin(a, b);
}

static void TieCuts(LamMesh *mesh)
{
  for (PetscInt k = 0; k < mesh->cell_count * mesh->cuts; ++k)
    for (PetscInt r = 0; r < mesh->radial_nodes; ++r) {
      PetscInt side[2];

      LamMeshCut(mesh, k, r, side);
      Tie(mesh, side[0], side[1]);
    }
}

/* Ties coincident nodes of facing walls, also across the period. */
static void TieOuterNodes(LamMesh *mesh)
{
  const PetscInt last = 2 * mesh->along;

  for (PetscInt cell = 0; cell < mesh->cell_count; ++cell)
    for (PetscInt face = 0; face < LAM_FACES; ++face) {
      const PetscReal *image;
      const PetscInt other = LamMeshNeighbour(mesh, cell, face, &image);

      for (PetscInt i = 0; other >= 0 && i <= last; ++i)
        Tie(mesh, LamMeshOuterNode(mesh, cell, face, i),
            LamMeshOuterNode(mesh, other, (face + LAM_FACES / 2) % LAM_FACES, last - i));
    }
  for (PetscInt i = 0; i < mesh->node_count; ++i) mesh->node_class[i] = FirstOf(mesh->node_class, i);
}

/* Assigns the nodes of outer walls that follow F to the origin. */
static void HoldNodes(LamMesh *mesh)
{
  for (PetscInt k = 0; k < LAM_FACES * mesh->cell_count; ++k)
    for (PetscInt i = 0; mesh->held[k] && i < 3 * mesh->along; ++i) {
      const PetscInt ring = LamMeshRing(mesh, k % LAM_FACES * mesh->along + i / 3, i % 3);

      mesh->node_class[LamMeshNode(mesh, k / LAM_FACES, ring, mesh->radial_nodes - 1)] = ORIGIN;
    }
}

/* Numbers the classes in node order, after the origin if there is one, and sets the shifts. */
static PetscErrorCode NumberClasses(PetscBool has_origin, LamMesh *mesh)
{
  PetscInt *number;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->node_count, &number));
  mesh->class_count = has_origin ? 1 : 0;
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    if (mesh->node_class[i] == i) number[i] = mesh->class_count++;
  PetscCall(PetscCalloc1(2 * mesh->class_count, &mesh->class_X));
  for (PetscInt i = 0; i < mesh->node_count; ++i) {
    const PetscInt representative = mesh->node_class[i];

    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal X = representative == ORIGIN ? 0.0 : mesh->X[2 * representative + d];

      mesh->shift[2 * i + d] = representative == i ? 0.0 : mesh->X[2 * i + d] - X;
      if (PetscAbsReal(mesh->shift[2 * i + d]) < 1e-9) mesh->shift[2 * i + d] = 0.0;
      if (representative != ORIGIN) mesh->class_X[2 * number[representative] + d] = X;
    }
  }
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    mesh->node_class[i] = mesh->node_class[i] == ORIGIN ? 0 : number[mesh->node_class[i]];
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

static PetscErrorCode CheckMicrostructure(const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  PetscCheck(micro->along > 0 && micro->through > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "elements along a face and through a wall must be chosen, got %d and %d", (int)micro->along,
             (int)micro->through);
  PetscCheck(!LamWallsTear(micro) || micro->along % 2 == 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "walls that tear are cut in the middle of faces, too: elements along a face must be even, got %d",
             (int)micro->along);
  PetscCheck(micro->grading >= 0.0 && micro->grading < 1.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "grading of the mesh is %g; it must lie between 0 and 1", (double)micro->grading);
  PetscCheck(micro->cells[0] > 0 && micro->cells[1] > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a block of %d x %d cells is empty", (int)micro->cells[0], (int)micro->cells[1]);
  for (PetscInt cell = 0; cell < micro->cells[0] * micro->cells[1]; ++cell) {
    const PetscReal t = LamWallThickness(micro, cell), outer = LamOuterApothem(micro);

    PetscCheck(t > 0.0 && t < outer, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "wall thickness is %g apothems; it must lie between 0 and %g", (double)t, (double)outer);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshCreate(const LamMicrostructure *micro, LamMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCall(CheckMicrostructure(micro));
  mesh->along = micro->along;
  mesh->through = micro->through;
  mesh->cell_count = micro->cells[0] * micro->cells[1];
  mesh->cuts = LamWallsTear(micro) ? LAM_CUTS : 0;
  mesh->ring_nodes = 2 * LAM_FACES * micro->along + mesh->cuts;
  mesh->radial_nodes = 2 * micro->through + 1;
  mesh->node_count = mesh->cell_count * mesh->ring_nodes * mesh->radial_nodes;
  mesh->element_count = mesh->cell_count * LAM_FACES * micro->along * micro->through;
  mesh->apothem = LamOuterApothem(micro);
  mesh->V0 = 2.0 * PetscSqrtReal(3.0) * (PetscReal)mesh->cell_count;
  PetscCall(PetscMalloc7(mesh->along + 1, &mesh->ends, 2 * mesh->node_count, &mesh->X,
                         LAM_ELEMENT_NODES * mesh->element_count, &mesh->elements, mesh->element_count, &mesh->cell_of,
                         mesh->node_count, &mesh->node_class, 2 * mesh->node_count, &mesh->shift, mesh->element_count,
                         &mesh->has_shift));
  PetscCall(PetscCalloc3(LAM_FACES * mesh->cell_count, &mesh->neighbour, 2 * LAM_FACES * mesh->cell_count, &mesh->image,
                         LAM_FACES * mesh->cell_count, &mesh->held));
  PlaceEnds(micro->grading, mesh);
  PlaceNodes(micro, mesh);
  FindNeighbours(micro, mesh);
  ConnectElements(mesh);
  for (PetscInt i = 0; i < mesh->node_count; ++i)
    mesh->node_class[i] = i; /* the representative node until NumberClasses */
  if (micro->interface == LAM_INTERFACE_BONDED) {
    TieCuts(mesh);
    TieOuterNodes(mesh);
  }
  HoldNodes(mesh);
  PetscCall(NumberClasses(micro->is_patch, mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeshDestroy(LamMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(
      PetscFree7(mesh->ends, mesh->X, mesh->elements, mesh->cell_of, mesh->node_class, mesh->shift, mesh->has_shift));
  PetscCall(PetscFree(mesh->class_X));
  PetscCall(PetscFree3(mesh->neighbour, mesh->image, mesh->held));
  PetscFunctionReturn(0);
}

void LamMeshCentre(const LamMesh *mesh, PetscInt cell, PetscReal centre[2])
{
  const PetscInt a = LamMeshOuterNode(mesh, cell, 0, 0), b = LamMeshOuterNode(mesh, cell, LAM_FACES / 2, 0);

  for (PetscInt d = 0; d < 2; ++d) centre[d] = 0.5 * (mesh->X[2 * a + d] + mesh->X[2 * b + d]);
}
