/*
  Mesh of the RVE: rings of nine-node quadrilaterals along the walls of cells, and the classes of coupled nodes.

  Method. A ring fills the space between the outer and the inner contour of a cell (outline.h, lengths in apothems).
  Each face has `along` x `through` elements; those at its ends meet the next face at the mitre of the corner. Element i
  spans the fractions ends[i] to ends[i + 1] of the face. With e(s) = s - grading sin(2 pi s) / (2 pi) they are
  e(i / along), so grading > 0 makes elements smaller at the corners, where stresses are singular. If air rounds the
  corner, some of the elements lie on the arc and the others on the flat part of the face. Facing walls have the same
  elements.

  With contact every cell has its own nodes: each node is a class without shift. Bonded cells share unknowns: coincident
  outer nodes form one class, also across the period. A node is then an image of its class's position y with a shift S:
  x_node = y_class + F S,  S = X_node - X_class.

  A patch is a finite block of cells between grips. Outer walls that follow F (those in the grips; with affine sides all
  outer walls without a neighbour) belong to class 0, the origin: x_node = F X_node. F thus enters a patch through
  shifts, as it does a period, and P is the mean of the boundary forces.

  Walls that tear (LamTearing) can be cut at both ends and in the middle of each face. A cut runs along the nodes
  through the wall, which are there twice: the ring consists of two parts for each face, one after another, with nodes
  of their own. Cut k of all lies between part k and the one before it in its ring. Bonded cells are whole: both nodes
  are in one class.

  Class 0 is prescribed, y = F X. This removes translations; in a patch it prescribes the boundary.
*/
#ifndef LAM_RVE_MESH_H
#define LAM_RVE_MESH_H

#include <petscsys.h>
#include <lamella/tissue.h>

#define LAM_ELEMENT_NODES 9
#define LAM_FACE_CUTS 2 /* places of cuts on a face: its start and its middle */

typedef struct {
  LamTissue tissue; /* owned: cells, faces, and which face lies on which */
  PetscInt along, through, cell_count;
  PetscInt cuts;       /* LAM_FACE_CUTS for each face, or 0 */
  PetscInt face_nodes; /* nodes along a face, the end left to the next one: 2 along, or with cuts LAM_FACE_CUTS more */
  PetscInt radial_nodes; /* nodes through the wall: 2 through + 1 */
  PetscInt node_count, element_count, class_count;
  PetscReal *ends;             /* [face][along + 1] element ends along a face, as fractions of its length, 0 to 1 */
  PetscInt (*flat)[2];         /* [face] elements on the face itself: first, and behind the last; others are on arcs */
  PetscReal *length;           /* [face] from corner to corner of the outer walls */
  PetscReal *thickness;        /* [face] of its wall */
  PetscReal *edge;             /* [face][along] lengths of the outer edges */
  PetscReal *X;                /* [node][2] reference positions */
  PetscInt *elements;          /* [element][9]: corners counter-clockwise from the inner edge, mid-edges, centre */
  PetscInt *cell_of;           /* [element] */
  PetscInt *node_class;        /* [node] */
  PetscReal *shift;            /* [node][2] S */
  PetscBool *has_shift;        /* [element] whether one of its nodes has a shift */
  PetscReal *class_X;          /* [class][2] */
  PetscReal *image;            /* [face][2] shift of the partner's image */
  PetscReal apothem;           /* of the outer walls of a hexagon */
  PetscReal mean_length;       /* of faces with a partner */
  PetscReal shortest, longest; /* outer edges */
  PetscReal thinnest;          /* wall */
  PetscReal size;              /* longest extent of the RVE, apothems */
  PetscReal period[2][2];      /* rows; zero for a patch */
  PetscReal V0;                /* reference area of the RVE, cells, lumens and air between them */
} LamMesh;

PetscErrorCode LamMeshCreate(const LamMicrostructure *micro, LamMesh *mesh);
PetscErrorCode LamMeshDestroy(LamMesh *mesh);
/* The cells around the junction where a face starts, by their faces that start there, counter-clockwise. */
#define LAM_MOST_AROUND 16 /* (src/core/polygons.c refuses more) */
typedef struct {
  PetscInt count, at; /* of the faces; and which of them was asked for */
  PetscBool closed;   /* no air is between them */
  PetscInt face[LAM_MOST_AROUND];
  PetscReal image[LAM_MOST_AROUND][2]; /* shift of their cells' images, from that of the face asked for */
} LamJunction;
LamJunction LamMeshJunction(const LamMesh *mesh, PetscInt face);

static inline PetscInt LamMeshFaceCount(const LamMesh *mesh, PetscInt cell)
{
  return mesh->tissue->first[cell + 1] - mesh->tissue->first[cell];
}
/* Number of a face within its cell, as responses give it. */
static inline PetscInt LamMeshLocalFace(const LamMesh *mesh, PetscInt face)
{
  return face - mesh->tissue->first[mesh->tissue->cell[face]];
}
/* The cell across a face, or -1 if there is none. */
static inline PetscInt LamMeshNeighbour(const LamMesh *mesh, PetscInt face)
{
  const PetscInt partner = mesh->tissue->partner[face];

  return partner < 0 ? -1 : mesh->tissue->cell[partner];
}
/* Thickness of the thinner of the walls that lie on each other at a face. */
static inline PetscReal LamMeshThinner(const LamMesh *mesh, PetscInt face)
{
  const PetscInt partner = mesh->tissue->partner[face];

  return partner < 0 ? mesh->thickness[face] : PetscMin(mesh->thickness[face], mesh->thickness[partner]);
}
/* LamMeshShare: fraction of a face's length at a point given in elements from the face's start (0 to along).
   LamMeshPlace is the inverse. */
static inline PetscReal LamMeshShare(const LamMesh *mesh, PetscInt face, PetscReal at)
{
  const PetscInt e = PetscMax(0, PetscMin((PetscInt)at, mesh->along - 1));
  const PetscReal *ends = &mesh->ends[face * (mesh->along + 1)];

  return ends[e] + (at - (PetscReal)e) * (ends[e + 1] - ends[e]);
}
static inline PetscReal LamMeshPlace(const LamMesh *mesh, PetscInt face, PetscReal share)
{
  const PetscReal *ends = &mesh->ends[face * (mesh->along + 1)];
  PetscInt e = 0;

  while (e < mesh->along - 1 && share >= ends[e + 1]) ++e;
  return (PetscReal)e + (share - ends[e]) / (ends[e + 1] - ends[e]);
}

/* Element i along a face, m from the lumen: e = (face along + i) through + m. */
static inline PetscInt LamMeshElement(const LamMesh *mesh, PetscInt face, PetscInt i, PetscInt m)
{
  return (face * mesh->along + i) * mesh->through + m;
}
/* Nodes around the rings of all cells are numbered one after another, and with each those through the wall. */
static inline PetscInt LamMeshNode(const LamMesh *mesh, PetscInt ring, PetscInt radial)
{
  return ring * mesh->radial_nodes + radial;
}
/* The first ring node of a cell; of the cell behind the last one: their number. */
static inline PetscInt LamMeshFirstRing(const LamMesh *mesh, PetscInt cell)
{
  return mesh->tissue->first[cell] * mesh->face_nodes;
}
static inline PetscInt LamMeshRingNodes(const LamMesh *mesh, PetscInt cell)
{
  return LamMeshFaceCount(mesh, cell) * mesh->face_nodes;
}
static inline PetscInt LamMeshCellOfRing(const LamMesh *mesh, PetscInt ring)
{
  return mesh->tissue->cell[ring / mesh->face_nodes];
}
static inline PetscInt LamMeshCellOfNode(const LamMesh *mesh, PetscInt node)
{
  return LamMeshCellOfRing(mesh, node / mesh->radial_nodes);
}
/* Ring node k = 0, 1, 2 of element i along a face. */
static inline PetscInt LamMeshRing(const LamMesh *mesh, PetscInt face, PetscInt i, PetscInt k)
{
  const PetscInt at = 2 * i + k;

  if (mesh->cuts) return face * mesh->face_nodes + at + i / (mesh->along / 2);
  return at < mesh->face_nodes ? face * mesh->face_nodes + at
                               : LamTissueNext(mesh->tissue, face) * mesh->face_nodes + at - mesh->face_nodes;
}
/* Node i = 0 to 2 along of a face of the outer loop of a cell, counter-clockwise; in the middle of a face that can be
   cut, that of the second half. */
static inline PetscInt LamMeshOuterNode(const LamMesh *mesh, PetscInt face, PetscInt i)
{
  const PetscInt e = PetscMin(i / 2, mesh->along - 1);

  return LamMeshNode(mesh, LamMeshRing(mesh, face, e, i - 2 * e), mesh->radial_nodes - 1);
}
/* Nodes on both sides of cut k of all: the end of the part before it, the start of that behind it. */
static inline void LamMeshCut(const LamMesh *mesh, PetscInt cut, PetscInt radial, PetscInt side[2])
{
  const PetscInt face = cut / LAM_FACE_CUTS, half = cut % LAM_FACE_CUTS;
  const PetscInt before = half ? face : LamTissuePrevious(mesh->tissue, face);
  const PetscInt part = mesh->along + 1; /* nodes along half a face */

  side[0] = LamMeshNode(mesh, before * mesh->face_nodes + (half ? part : 2 * part) - 1, radial);
  side[1] = LamMeshNode(mesh, face * mesh->face_nodes + half * part, radial);
}
static inline PetscInt LamMeshCellOfCut(const LamMesh *mesh, PetscInt cut)
{
  return mesh->tissue->cell[cut / LAM_FACE_CUTS];
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
  return e / (mesh->along * mesh->through);
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
