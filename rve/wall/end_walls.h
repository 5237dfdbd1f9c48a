/*
  End walls: cells of a length along X3 are closed by walls across it, as sheets that follow F.

  Each cell of the length L has two, as thick as its other walls, so that a volume has 2 t/L of them. They are in plane
  stress: their thickness follows from the constant volume of the wall, W(C11, C22, C12) with C33 = 1/(C11 C22 - C12^2).
  Fibres lie in the sheet in all directions alike: their mean is converged to rounding, with `fibres: tension` too.
*/
#ifndef LAM_RVE_END_WALLS_H
#define LAM_RVE_END_WALLS_H

#include <petscsys.h>
#include <lamella/scene.h>

/* Per volume of the tissue, C1 + C2; dW/dF, row by row, and its derivative. F: in a frame whose third axis is that of
   the cells in the reference. Components with a second index 3 are 0. */
typedef struct {
  PetscReal W, P[9], A[9][9];
} LamEndWalls;

/* Zero where cells have no end walls. */
PetscErrorCode LamEndWallsEvaluate(const LamMicrostructure *micro, const PetscReal F[9], LamEndWalls *out);

#endif
