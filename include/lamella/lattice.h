/*
  Arrangement of the cells of a microstructure.

  Cells are centred on a hexagonal lattice with the vectors L_0 and L_1, two apothems long and 60 degrees apart;
  L_{k+1} is L_k rotated by 60 degrees, and the normal of face k of a cell is along L_k. Cell (i, j) of a period is
  cell = i cells[1] + j, at i L_0 + j L_1.

  A patch has cells[0] columns and cells[1] rows, cell = column cells[1] + row, rows counted along X2. Its rows are
  along the lattice direction nearest to X1, every second one offset by half a cell. If no lattice direction is within
  15 degrees of X1 (cells standing on an edge), columns are along X2 and every second column is offset.
*/
#ifndef LAMELLA_LATTICE_H
#define LAMELLA_LATTICE_H

#include <lamella/scene.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_FACES 6

/* Coordinates of a cell along L_0 and L_1. */
LAM_EXPORT void LamLatticeIndex(const LamMicrostructure *micro, PetscInt cell, PetscInt index[2]);
/*
  Returns the cell across a face. In a period it always exists; wraps [2]: its image is that many periods away. In a
  patch -1 if there is none; *held: whether the outer wall there follows F. Both outputs may be NULL.
*/
LAM_EXPORT PetscInt LamLatticeNeighbour(const LamMicrostructure *micro, PetscInt cell, PetscInt face, PetscInt wraps[2],
                                        PetscBool *held);
/* Whether a notch of a patch passes between two neighbours. */
LAM_EXPORT PetscBool LamLatticeIsCut(const LamMicrostructure *micro, PetscInt cell, PetscInt other);
/* Distance of two lattice points, given the difference of their coordinates, in neighbour distances (two apothems). */
LAM_EXPORT PetscReal LamLatticeDistance(PetscInt d0, PetscInt d1);

LAM_C_END

#endif
