/* The gap k X2 - (3 k / 4) X2^(4/3) between two walls side by side, fibres along X2, as Section 3 of Mihai, Safar &
   Wyatt has it, against equilibrium and the contact conditions (docs/results/paper.md): the left wall in generalised
   shear with sigma12 = a X2, the right one in simple shear k, touching at X2 = 0. a is chosen so that both shears are k
   at X2 = 1. */
#ifndef LAM_SUPPORT_GAP_BETWEEN_WALLS_H
#define LAM_SUPPORT_GAP_BETWEEN_WALLS_H

#include "strip.h"

#define GAP_PSI 1.57079632679489662
typedef struct {
  double ratio;  /* (C1 + C2) / (C4 k^2): 0 where the power 4/3 is the solution of the cubic */
  double gap;    /* at X2 = 1, over k; the paper's: 1/4 */
  double shear;  /* shear traction on both faces at X2 = 1, which has to be 0 */
  double spread; /* normal traction on the left face at X2 = 0 less that at X2 = 1, which has to be 0 */
  double scale;  /* sigma12 at X2 = 1 */
} Gap;

Gap ComputeGap(const LamWall *wall, double k);

#define FACE_ELEMENTS 16
#define FACE_NODES (2 * FACE_ELEMENTS + 1)
/*
  Square walls with the shears of the gap, moved at the ends and on their outer sides, whose inner faces are free: no
  traction, g = 0. Gaps along X1 at equal current heights, over k. Where all are positive the walls do not meet, and
  this is what unilateral contact gives.
*/
typedef struct {
  double computed[FACE_NODES];
  double sheared[FACE_NODES]; /* of the generalised shears, not free of tractions */
  double power[FACE_NODES];   /* X2 - (3/4) X2^(4/3) */
} FreeFaces;

/* The right wall, whose free face is on its left, is solved turned by 180 degrees, which changes no shear. */
PetscErrorCode ComputeFreeFaces(const LamWall *wall, double k, FreeFaces *faces);

#endif
