/*
  XDMF 3 beside an HDF5 file: a temporal collection of grids of quadratic elements, readable by ParaView and meshio.

    LamXDMFOpen(path, "load steps", &xdmf);
    for each step { LamXDMFBegin(&xdmf, ...); LamXDMFField(&xdmf, ...) for each field; LamXDMFEnd(&xdmf); }
    LamXDMFClose(&xdmf);

  Every grid names topology and geometry itself: readers differ in their support of references between grids.
  Reference: https://www.xdmf.org/index.php/XDMF_Model_and_Format
*/
#ifndef LAM_XDMF_H
#define LAM_XDMF_H

#include "beside.h"

typedef struct {
  LamBeside file;   /* file.out NULL: not open */
  const char *hdf5; /* borrowed */
} LamXDMF;

/* A dataset of the HDF5 file: [rows], or with columns > 1 [rows][columns]. */
typedef struct {
  const char *path;
  PetscInt rows, columns;
} LamXDMFData;

extern const LamTextKind LamXDMFText;
/* Writes OUT.xdmf beside OUT.h5; it appears when it is closed. It names the HDF5 file without its folder, so that both
   can be moved together. */
PetscErrorCode LamXDMFOpen(const char hdf5[], const char collection[], LamXDMF *xdmf);
PetscErrorCode LamXDMFClose(LamXDMF *xdmf);
/* The grid "name number". topology: of XDMF, "Quadrilateral_9"; elements: the nodes of each; nodes: positions in the
   plane. */
void LamXDMFBegin(LamXDMF *xdmf, const char name[], PetscInt number, PetscReal time, const char topology[],
                  PetscInt element_count, LamXDMFData elements, LamXDMFData nodes);
/* number: "Float" or "Int" */
void LamXDMFField(LamXDMF *xdmf, const char name[], PetscBool on_nodes, const char number[], LamXDMFData values);
void LamXDMFEnd(LamXDMF *xdmf);

#endif
