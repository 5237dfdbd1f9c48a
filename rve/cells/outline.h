/*
  Shape of the walls of one cell: an outer and an inner contour along its polygon.

  Method. The wall of face k lies between its outer line, the face moved inwards by half of the clearance, and its inner
  line, its thickness t further in. Contours follow these lines and meet on the mitre of each corner.

  Where air fills a junction, walls leave a face at the distance d from its corner, by the arc that is tangent to both
  faces: of radius d / tan(theta/2) at a corner that turns by theta. The inner contour has an arc with the same centre,
  or, where the wall is thicker than the arc, one of LEAST times its radius. Straight and reflex corners have no arc.

  A face that is shorter than its wall is thick would have no inner line left: its wall is made thicker until the inner
  line has LEAST of the length that it has in a round cell. This rounds the lumen at the short face.
*/
#ifndef LAM_RVE_OUTLINE_H
#define LAM_RVE_OUTLINE_H

#include <lamella/tissue.h>

/* One contour at a corner. */
typedef struct {
  PetscReal X[2];    /* where its lines meet */
  PetscReal setback; /* of the arc's ends, from X; 0: no arc */
  PetscReal centre[2], radius;
} LamOutlineCorner;

typedef struct {
  PetscInt count;                  /* faces of the cell */
  PetscReal (*along)[2], *angle;   /* [face] direction, and angle of the outward normal */
  PetscReal *turn;                 /* [face] by which the contour turns at its start */
  PetscReal *length, *thickness;   /* [face] of the outer line; of the wall */
  PetscReal *setback;              /* [face] distance from its start at which walls leave it and the face before */
  LamOutlineCorner *outer, *inner; /* [face] at its start */
} LamOutline;

/* Cell `cell` of the tissue with walls of the given thickness; refuses walls that do not fit into it. */
PetscErrorCode LamOutlineCreate(LamTissue tissue, PetscInt cell, PetscReal thickness, PetscReal clearance,
                                LamOutline *outline);
PetscErrorCode LamOutlineDestroy(LamOutline *outline);
/* The part of face k, from 0 to 1 along it, on which its wall lies. */
void LamOutlineFlat(const LamOutline *outline, PetscInt k, PetscReal flat[2]);
/* Point of face k: s from 0 to 1 along the face, r from 0 at the inner contour to 1 at the outer one. */
void LamOutlinePoint(const LamOutline *outline, PetscInt k, PetscReal s, PetscReal r, PetscReal X[2]);

#endif
