/*
  Text files beside an HDF5 result file: the same name with another extension.
*/
#ifndef LAM_BESIDE_H
#define LAM_BESIDE_H

#include "target.h"
#include <stdio.h>

typedef struct {
  FILE *out;
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
} LamBeside;

/* Text written to `out` appears under the final name when the file is closed, in place of what stands there
   (LamTargetCheckText). Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE. */
PetscErrorCode LamBesideOpen(const char hdf5[], const LamTextKind *kind, LamBeside *file);
PetscErrorCode LamBesideClose(LamBeside *file);
/* A comma and a number of a table; nothing behind the comma if it is not known. */
void LamBesideNumber(FILE *out, PetscReal value);

#endif
