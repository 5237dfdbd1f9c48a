/*
  Text files beside an HDF5 file of results: the same name with another ending.
*/
#ifndef LAM_BESIDE_H
#define LAM_BESIDE_H

#include <petscsys.h>
#include <stdio.h>

typedef struct {
  FILE *out;
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
} LamBeside;

/* `ending` (".csv") replaces .h5 or .hdf5. What is written to `out` is seen under its name once it is closed, whole.
   PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE. */
PetscErrorCode LamBesideOpen(const char hdf5[], const char ending[], LamBeside *file);
PetscErrorCode LamBesideClose(LamBeside *file);

#endif
