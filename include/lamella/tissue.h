/*
  Cells of any shape: which faces they have, where, and which face lies on which.

  A cell is a polygon. Its faces follow each other counter-clockwise; face k runs from its own corner to that of the
  next face. The faces of all cells are numbered one after another, so a face belongs to one cell, and its partner is
  the same face seen from the other side. Lengths are in apothems: a hexagon of that apothem has the mean area of a
  cell, the air at its corners included.
*/
#ifndef LAMELLA_TISSUE_H
#define LAMELLA_TISSUE_H

#include <lamella/scene.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_DIRECTIONS 6 /* of normals: those of a hexagon */

struct LamTissue_s {
  PetscInt cells, faces;
  PetscInt *first;        /* [cells + 1] first face of a cell */
  PetscInt *cell;         /* [face] */
  PetscReal (*corner)[2]; /* [face] where it starts */
  PetscInt *partner;      /* [face] -1: air, or the outside of a patch */
  PetscInt (*wraps)[2];   /* [face] the partner's cell lies that many periods away */
  PetscInt *direction;    /* [face] the hexagon's normal nearest to its own, of a partner the opposite one */
  PetscBool *held;        /* [face] of a patch: an outer wall that follows F */
  PetscReal *share;       /* [face] thickness of its wall over that of its cell */
  PetscReal *setback;     /* [face] distance from its corner at which walls leave the face: air at the junction */
  PetscReal period[2][2]; /* rows; zero for a patch */
  PetscReal area;         /* of a period; of a patch that inside its outline */
};

/* The tissue of a microstructure: of its own polygons, or its hexagons (lattice.h). */
LAM_EXPORT PetscErrorCode LamTissueCreate(const LamMicrostructure *micro, LamTissue *tissue);
LAM_EXPORT PetscErrorCode LamTissueDestroy(LamTissue *tissue);
/* Allocates all arrays, zero; partners are -1 and shares 1. */
LAM_EXPORT PetscErrorCode LamTissueAllocate(PetscInt cells, PetscInt faces, LamTissue *tissue);
LAM_EXPORT PetscErrorCode LamTissueCopy(LamTissue from, LamTissue *to);
/* Whether two tissues are the same, face by face, to a tolerance in apothems. Both NULL: yes. */
LAM_EXPORT PetscBool LamTissuesAgree(LamTissue a, LamTissue b, PetscReal tolerance);

/* Mean of the corners of a cell. */
LAM_EXPORT void LamTissueCentre(LamTissue tissue, PetscInt cell, PetscReal centre[2]);
/* Area of a cell, without the air at its corners. */
LAM_EXPORT PetscReal LamTissueCellArea(LamTissue tissue, PetscInt cell);
/* Perimeter of the line at a distance inside a cell, with arcs where air rounds its corners. */
LAM_EXPORT PetscReal LamTissueInnerPerimeter(LamTissue tissue, PetscInt cell, PetscReal distance);
/* Without the whole tissue: faces of a cell, the cell across its face k (-1: none) and the direction of that face. */
LAM_EXPORT PetscInt LamCellFaces(const LamMicrostructure *micro, PetscInt cell);
LAM_EXPORT PetscInt LamCellAcross(const LamMicrostructure *micro, PetscInt cell, PetscInt k);
LAM_EXPORT PetscInt LamCellDirection(const LamMicrostructure *micro, PetscInt cell, PetscInt k);

/*
  Whether lumens under the load's turgor (contact: and gaps under its cohesion) fill all that the walls leave. Then
  turgor acts through -p J alone, but for the walls' compression (docs/theory/homogenisation.md, Effective-stress
  principle). Not so with air at junctions or in place of cells, or where the turgor or cohesion of cells differs from
  the load's.
*/
LAM_EXPORT PetscErrorCode LamFluidFills(const LamMicrostructure *micro, PetscBool *fills);

/*
  The motions that map a periodic tissue, with all that its cells have, onto itself, within 1e-9 apothems: has[0][k],
  rotations by 60 k degrees; has[1][k], a mirror at the line along face normal 0, and then that rotation. A patch has
  the identity alone.
*/
typedef struct {
  PetscBool has[2][LAM_DIRECTIONS];
} LamSymmetry;
LAM_EXPORT PetscErrorCode LamMicrostructureSymmetry(const LamMicrostructure *micro, LamSymmetry *symmetry);
/* Half a turn does not change a strain: whether the motion (turn < 3) is one of strains, and whether all six are. */
LAM_EXPORT PetscBool LamSymmetryOfStrain(const LamSymmetry *symmetry, PetscBool mirror, PetscInt turn);
LAM_EXPORT PetscBool LamSymmetryIsHexagonal(const LamSymmetry *symmetry);

/* The face behind and before a face of the same cell. */
static inline PetscInt LamTissueNext(LamTissue tissue, PetscInt face)
{
  return face + 1 < tissue->first[tissue->cell[face] + 1] ? face + 1 : tissue->first[tissue->cell[face]];
}
static inline PetscInt LamTissuePrevious(LamTissue tissue, PetscInt face)
{
  return face > tissue->first[tissue->cell[face]] ? face - 1 : tissue->first[tissue->cell[face] + 1] - 1;
}
/* Of a face and its partner, one is the slave of contact; a face without partner is none. */
static inline PetscBool LamTissueIsSlave(LamTissue tissue, PetscInt face)
{
  return (PetscBool)(tissue->partner[face] >= 0 && tissue->direction[face] < LAM_DIRECTIONS / 2);
}

LAM_C_END

#endif
