/*
  XDMF beside the HDF5 file of a macroscale run, so that ParaView and meshio read it.
*/
#ifndef LAM_XDMF_H
#define LAM_XDMF_H

#include <petscsys.h>

/*
  Writes (or replaces) the XDMF file that describes the load steps of `hdf5`: the same name with the ending .xdmf, and a
  reference to the file by its name alone, so that both can be moved together. steps[k] is the number in the dataset
  names "/macro/step/<number>/...", times[k] the load factor. PETSC_ERR_FILE_WRITE where it cannot be written.
*/
PetscErrorCode LamXDMFWrite(const char hdf5[], PetscInt node_count, PetscInt element_count, PetscInt step_count,
                            const PetscInt steps[], const PetscReal times[]);

#endif
