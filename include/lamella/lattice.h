/*
  How the cells of a microstructure lie side by side.

  Cells stand on the points of a hexagonal lattice with the vectors L_0 and L_1, two apothems long and 60 degrees apart;
  L_{k+1} is L_k turned by 60 degrees, and face k of a cell looks along L_k. Cell (i, j) of a period is
  cell = i cells[1] + j and stands at i L_0 + j L_1.

  A patch has cells[0] columns and cells[1] rows, cell = column cells[1] + row, rows counted along X2. Its rows run
  along the lattice direction nearest to X1, every second one offset by half a cell; where no lattice direction is
  nearer to X1 than 15 degrees (cells that stand on an edge), columns run along X2 and every second one of them is
  offset.
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
  The cell across a face. In a period there always is one; wraps [2]: its image lies that many periods away. In a patch
  -1 where there is none; *held tells whether the outer wall there follows F. Both outputs may be NULL.
*/
LAM_EXPORT PetscInt LamLatticeNeighbour(const LamMicrostructure *micro, PetscInt cell, PetscInt face, PetscInt wraps[2],
                                        PetscBool *held);
/* Between two lattice points, given the difference of their coordinates; in distances of neighbours (two apothems). */
LAM_EXPORT PetscReal LamLatticeDistance(PetscInt d0, PetscInt d1);

LAM_C_END

#endif
