/*
  Polygons, given by numbered vertices, to a tissue: which of their edges are faces of two cells.
*/
#ifndef LAM_POLYGONS_H
#define LAM_POLYGONS_H

#include <lamella/tissue.h>

typedef struct {
  const char *name; /* of the file, for messages; borrowed, as all below */
  PetscInt vertices, cells;
  PetscReal (*vertex)[2];
  PetscInt *first, *corner; /* [cells + 1], and the vertices of cell after cell, counter-clockwise */
  PetscReal period[2][2];   /* rows */
  PetscBool is_patch;
  LamPatchSides sides;
  const PetscReal *setback;   /* [vertex] */
  const PetscReal *share;     /* [face] thickness of its wall over that of its cell; NULL: 1 */
  const PetscInt *face_class; /* [face] 0 to 2; NULL: by direction */
  PetscReal orientation;      /* radian: of the directions of normals */
} LamPolygons;

/* Lengths of the tissue are divided by *apothem, that of a hexagon with the mean area of the polygons. Refuses polygons
   that are no tissue, naming file, cell and vertex. */
PetscErrorCode LamTissueFromPolygons(const LamPolygons *polygons, PetscReal *apothem, LamTissue *tissue);

#endif
