/*
  Mesh of the RVE: hexagonal rings of nine-node quadrilaterals, and the classes of coupled nodes.

  Method. A ring fills the space between the hexagons of apothem 1 - t and 1 (lengths in apothems). Each of its six
  faces has `along` x `through` elements with straight radial mitres at the corners. Element i spans the fractions
  e(i / along) to e((i + 1) / along) of the face's length,
    e(s) = s - grading sin(2 pi s) / (2 pi),
  so grading > 0 makes elements smaller at the corners, where stresses are singular. Face k has the outward normal at
  orientation + 60 deg k; lattice vector L_k = 2 n_k. Cell (i, j) is centred at i L_0 + j L_1.

  With contact every cell has its own nodes: each node is a class without shift. Bonded cells share unknowns: coincident
  outer nodes form one class, also across the period. A node is then an image of its class's position y with a shift S:
  x_node = y_class + F S,  S = X_node - X_class.

  A patch is a finite block of cells between grips (lattice.h). Outer walls that follow F (those in the grips; with
  affine sides all outer walls without a neighbour) belong to class 0, the origin: x_node = F X_node. F thus enters a
  patch through shifts, as it does a period, and P is the mean of the boundary forces.

  Walls that tear (LamTearing) can be cut at both ends and in the middle of each face. A cut runs along the nodes
  through the wall, which are there twice: the ring consists of LAM_CUTS parts, one after another, with nodes of their
  own. Cut k lies between parts k - 1 and k. Bonded cells are whole: both nodes are in one class.

  Class 0 is prescribed, y = F X. This removes translations; in a patch it prescribes the boundary.
*/
#ifndef LAM_RVE_MESH_H
#define LAM_RVE_MESH_H

#include <petscsys.h>
#include <lamella/lattice.h>

#define LAM_ELEMENT_NODES 9
#define LAM_CUTS (2 * LAM_FACES) /* places of cuts in the ring of a cell */

typedef struct {
  PetscInt along, through, cell_count;
  PetscInt cuts;         /* of a ring: LAM_CUTS, or 0 */
  PetscInt ring_nodes;   /* nodes around one ring: 12 along + cuts */
  PetscInt radial_nodes; /* nodes through the wall: 2 through + 1 */
  PetscInt node_count, element_count, class_count;
  PetscReal *ends;        /* [along + 1] element ends along a face, as fractions of its length, 0 to 1 */
  PetscReal *X;           /* [node][2] reference positions */
  PetscInt *elements;     /* [element][9]: corners counter-clockwise from the inner edge, mid-edges, centre */
  PetscInt *cell_of;      /* [element] */
  PetscInt *node_class;   /* [node] */
  PetscReal *shift;       /* [node][2] S */
  PetscBool *has_shift;   /* [element] whether one of its nodes has a shift */
  PetscReal *class_X;     /* [class][2] */
  PetscInt *neighbour;    /* [cell][6] cell across each face; -1: none */
  PetscReal *image;       /* [cell][6][2] shift of the neighbour's image */
  PetscBool *held;        /* [cell][6] outer walls that follow F */
  PetscReal apothem;      /* of a cell's outer walls */
  PetscReal period[2][2]; /* rows; zero for a patch */
  PetscReal V0;           /* reference area of the RVE, cells and lumens */
} LamMesh;

PetscErrorCode LamMeshCreate(const LamMicrostructure *micro, LamMesh *mesh);
PetscErrorCode LamMeshDestroy(LamMesh *mesh);
/* Reference centre of a cell, from opposite nodes of its outer loop. */
void LamMeshCentre(const LamMesh *mesh, PetscInt cell, PetscReal centre[2]);
/* Returns the cell across a face, or -1 if there is none; image: [2] shift of that cell's image. */
static inline PetscInt LamMeshNeighbour(const LamMesh *mesh, PetscInt cell, PetscInt face, const PetscReal **image)
{
  *image = &mesh->image[2 * (LAM_FACES * cell + face)];
  return mesh->neighbour[LAM_FACES * cell + face];
}

static inline PetscReal LamFaceLength(const LamMesh *mesh)
{
  return 2.0 / PetscSqrtReal(3.0) * mesh->apothem;
}
/* Lengths of the outer element edges at a corner and in the middle of a face. */
static inline PetscReal LamShortestEdge(const LamMesh *mesh)
{
  return LamFaceLength(mesh) * (mesh->ends[1] - mesh->ends[0]);
}
static inline PetscReal LamLongestEdge(const LamMesh *mesh)
{
  const PetscInt e = (mesh->along - 1) / 2;

  return LamFaceLength(mesh) * (mesh->ends[e + 1] - mesh->ends[e]);
}
/* LamMeshShare: fraction of a face's length at a point given in elements from the face's start (0 to along).
   LamMeshPlace is the inverse. */
static inline PetscReal LamMeshShare(const LamMesh *mesh, PetscReal at)
{
  const PetscInt e = PetscMax(0, PetscMin((PetscInt)at, mesh->along - 1));

  return mesh->ends[e] + (at - (PetscReal)e) * (mesh->ends[e + 1] - mesh->ends[e]);
}
static inline PetscReal LamMeshPlace(const LamMesh *mesh, PetscReal share)
{
  PetscInt e = 0;

  while (e < mesh->along - 1 && share >= mesh->ends[e + 1]) ++e;
  return (PetscReal)e + (share - mesh->ends[e]) / (mesh->ends[e + 1] - mesh->ends[e]);
}

/* Element numbers: e = ((cell*6 + face)*along + i)*through + m, m = 0 at the lumen. */
static inline PetscInt LamMeshElement(const LamMesh *mesh, PetscInt cell, PetscInt face, PetscInt i, PetscInt m)
{
  return ((cell * LAM_FACES + face) * mesh->along + i) * mesh->through + m;
}
/* Node k = 0, 1, 2 of an element column, 0 to 6 along - 1 counter-clockwise, as a number around the ring. */
static inline PetscInt LamMeshRing(const LamMesh *mesh, PetscInt column, PetscInt k)
{
  const PetscInt at = 2 * column + k;

  return mesh->cuts ? at + column / (mesh->along / 2) : at % mesh->ring_nodes;
}
static inline PetscInt LamMeshNode(const LamMesh *mesh, PetscInt cell, PetscInt ring, PetscInt radial)
{
  return (cell * mesh->ring_nodes + ring) * mesh->radial_nodes + radial;
}
/* Node i = 0 to 2 along of a face of the outer loop of a cell, counter-clockwise; in the middle of a face that can be
   cut, that of the second half. */
static inline PetscInt LamMeshOuterNode(const LamMesh *mesh, PetscInt cell, PetscInt face, PetscInt i)
{
  const PetscInt e = PetscMin(i / 2, mesh->along - 1);

  return LamMeshNode(mesh, cell, LamMeshRing(mesh, face * mesh->along + e, i - 2 * e), mesh->radial_nodes - 1);
}
/* Nodes on both sides of a cut, numbered over all cells: the end of the part before it, the start of that behind it. */
static inline void LamMeshCut(const LamMesh *mesh, PetscInt cut, PetscInt radial, PetscInt side[2])
{
  const PetscInt cell = cut / LAM_CUTS, start = cut % LAM_CUTS * (mesh->along + 1);

  side[0] = LamMeshNode(mesh, cell, (start + mesh->ring_nodes - 1) % mesh->ring_nodes, radial);
  side[1] = LamMeshNode(mesh, cell, start, radial);
}
/* Position of an image of a class: x = y_class + F S. */
static inline void LamImagePosition(const PetscReal F[9], const PetscReal y[], PetscInt class, const PetscReal S[2],
                                    PetscReal x[2])
{
  x[0] = y[2 * class] + F[0] * S[0] + F[1] * S[1];
  x[1] = y[2 * class + 1] + F[3] * S[0] + F[4] * S[1];
}
/* Number of an unknown position; negative: prescribed. */
static inline PetscInt LamUnknown(PetscInt class, PetscInt component)
{
  return 2 * (class - 1) + component;
}
static inline PetscInt LamMeshFaceOfElement(const LamMesh *mesh, PetscInt e)
{
  return (e / (mesh->along * mesh->through)) % LAM_FACES;
}
static inline PetscBool LamMeshElementIsInner(const LamMesh *mesh, PetscInt e)
{
  return (PetscBool)(e % mesh->through == 0);
}
static inline PetscBool LamMeshElementIsOuter(const LamMesh *mesh, PetscInt e)
{
  return (PetscBool)(e % mesh->through == mesh->through - 1);
}

#endif
