/*
  A tissue file: cells as polygons, written by `lamella tissue`, `python3 -m lamella.cells` or by hand (JSON;
  docs/reference/tissue.md).
*/
#ifndef LAM_TISSUE_FILE_H
#define LAM_TISSUE_FILE_H

#include <lamella/tissue.h>

typedef struct {
  LamTissue tissue; /* owned */
  PetscBool is_patch;
  PetscReal apothem;    /* m: of a hexagon with the mean area of a cell */
  PetscReal *thickness; /* [cell] of walls, m, the mean over the faces of a cell; NULL: the file gives none; owned */
  PetscInt *class;      /* [cell] 0: the scene's own cell; NULL: all; owned */
} LamTissueFile;

/* orientation: radian, from which the directions of faces count. Refuses a file that is none, or no tissue. */
PetscErrorCode LamTissueFileRead(const char path[], LamPatchSides sides, PetscReal orientation, LamTissueFile *file);
PetscErrorCode LamTissueFileDestroy(LamTissueFile *file);

#endif
