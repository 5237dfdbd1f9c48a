/* Bodies that are no boxes, for tests: a grid over the unit square, mapped, as a Gmsh file with sides as a box has. */
#ifndef LAM_SUPPORT_GMSH_WRITER_H
#define LAM_SUPPORT_GMSH_WRITER_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <petscsys.h>

typedef enum {
  GMSH_QUADRILATERALS,
  GMSH_TRIANGLES,
  GMSH_CURVED, /* quadrilaterals whose nine nodes are mapped; from here on second-order elements */
  GMSH_CURVED_TRIANGLES,
  GMSH_CURVED_MIXED /* quadrilaterals of nine and eight nodes and triangles */
} GmshElements;

/* From (xi, eta) in the unit square, which X holds, to the place. */
typedef void (*GmshMap)(double X[2]);

/* The unit square with an uneven grid. */
void GmshDistorted(double X[2]);
/* Cook's membrane: 48 long, 44 high at the left, 16 at the right (Cook, J. Struct. Div. ASCE 100 (1974) 1851). */
void GmshCook(double X[2]);
/* Writes it to a file of its own, whose name it puts into path[PETSC_MAX_PATH_LEN]; the caller removes it. */
void GmshWrite(char path[], int nx, int ny, GmshElements elements, GmshMap map);

#endif
