/*
  XDMF beside the HDF5 file of a macroscale run, readable by ParaView and meshio.
*/
#ifndef LAM_XDMF_H
#define LAM_XDMF_H

#include <lamella/macro.h>

/* A field of every step: the dataset "/macro/step/<number>/<name>". */
typedef struct {
  char name[LAM_NAME_LENGTH];
  PetscInt columns;   /* 1: scalar, 3: vector, 9: tensor */
  PetscBool on_nodes; /* else on elements */
} LamXDMFField;

/* Layout of /macro/elements. */
typedef enum {
  LAM_XDMF_QUADRILATERALS, /* [element][9] */
  LAM_XDMF_TRIANGLES,      /* [element][6] */
  LAM_XDMF_MIXED /* [element][9], -1 after a triangle's nodes; XDMF reads /macro/topology: for each element its type
                    (LAM_XDMF_TRIANGLE_6, LAM_XDMF_QUADRILATERAL_9) and its nodes */
} LamXDMFTopology;
enum { LAM_XDMF_QUADRILATERAL_9 = 0x23, LAM_XDMF_TRIANGLE_6 = 0x24 };

typedef struct {
  PetscInt node_count, element_count;
  LamXDMFTopology topology;
  PetscInt topology_length; /* of /macro/topology */
  PetscInt field_count;
  const LamXDMFField *fields; /* borrowed */
  PetscInt step_count;
  const PetscInt *steps;  /* step numbers; borrowed */
  const PetscReal *times; /* borrowed */
} LamXDMF;

/*
  Writes (or replaces) the XDMF file that describes the load steps of `hdf5`: same name with the ending .xdmf. It refers
  to `hdf5` by file name without folder, so that both can be moved together. PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE
  if it cannot be written.
*/
PetscErrorCode LamXDMFWrite(const char hdf5[], const LamXDMF *xdmf);

#endif
