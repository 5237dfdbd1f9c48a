/*
  Gmsh files (format 2.2) of quadrilaterals on a grid that is mapped somewhere, for tests of the macroscale solver.
*/
#ifndef LAM_GMSH_FIXTURE_H
#define LAM_GMSH_FIXTURE_H

#include <petscsys.h>
#include <stdio.h>

typedef void (*GmshMap)(PetscReal s, PetscReal t, PetscReal X[2]); /* of the unit square */

/* Sides of the square are the physical curves bottom, right, top, left; all elements are the physical surface body. */
static inline void GmshWrite(const char path[], PetscInt nx, PetscInt ny, GmshMap map)
{
  static const char *const names[] = {"bottom", "right", "top", "left"};
  FILE *file = fopen(path, "w");
  PetscInt element = 1;

  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n");
  for (int k = 0; k < 4; k++) fprintf(file, "1 %d \"%s\"\n", k + 1, names[k]);
  fprintf(file, "2 5 \"body\"\n$EndPhysicalNames\n$Nodes\n%d\n", (int)((nx + 1) * (ny + 1)));
  for (PetscInt j = 0; j <= ny; j++) {
    for (PetscInt i = 0; i <= nx; i++) {
      PetscReal X[2];
      map((PetscReal)i / nx, (PetscReal)j / ny, X);
      fprintf(file, "%d %.17g %.17g 0\n", (int)(j * (nx + 1) + i + 1), (double)X[0], (double)X[1]);
    }
  }
  fprintf(file, "$EndNodes\n$Elements\n%d\n", (int)(nx * ny + 2 * (nx + ny)));
#define GMSH_NODE(i, j) ((int)((j) * (nx + 1) + (i) + 1))
  for (PetscInt i = 0; i < nx; i++) {
    fprintf(file, "%d 1 2 1 1 %d %d\n", (int)element++, GMSH_NODE(i, 0), GMSH_NODE(i + 1, 0));
    fprintf(file, "%d 1 2 3 3 %d %d\n", (int)element++, GMSH_NODE(i, ny), GMSH_NODE(i + 1, ny));
  }
  for (PetscInt j = 0; j < ny; j++) {
    fprintf(file, "%d 1 2 2 2 %d %d\n", (int)element++, GMSH_NODE(nx, j), GMSH_NODE(nx, j + 1));
    fprintf(file, "%d 1 2 4 4 %d %d\n", (int)element++, GMSH_NODE(0, j), GMSH_NODE(0, j + 1));
  }
  for (PetscInt j = 0; j < ny; j++) {
    for (PetscInt i = 0; i < nx; i++)
      fprintf(file, "%d 3 2 5 5 %d %d %d %d\n", (int)element++, GMSH_NODE(i, j), GMSH_NODE(i + 1, j),
              GMSH_NODE(i + 1, j + 1), GMSH_NODE(i, j + 1));
  }
#undef GMSH_NODE
  fprintf(file, "$EndElements\n");
  fclose(file);
}

#endif
