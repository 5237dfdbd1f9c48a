/*
  Mesh and fields of an RVE in a result file, as docs/reference/files.md describes them.
*/
#ifndef LAM_RVE_FIELDS_H
#define LAM_RVE_FIELDS_H

#include <lamella/database.h>
#include <lamella/rve.h>
#include "xdmf.h"

/* Writes <group>/nodes, elements, cell_of, period; for contact tissue interface_faces. */
PetscErrorCode LamRVEWriteMesh(LamRecordWriter writer, const char group[], LamRVE rve);
/* Writes <group>/x, fibre_stretch, wall_stress of a solved state; for contact tissue interface/from, to, gap,
   pressure; of law `lamella` also what LamRVEGetLamella has. */
PetscErrorCode LamRVEWriteFields(LamRecordWriter writer, const char group[], LamRVE rve, LamRVEState state,
                                 const LamScales *scales);
/* Writes <group>/softest_mode of a state that is not stable at its F; *written: whether it is such a state. */
PetscErrorCode LamRVEWriteMode(LamRecordWriter writer, const char group[], LamRVE rve, LamRVEState state,
                               PetscBool *written);
/* Describes what the functions above have written of state `number` as /mesh and <group>: the tissue in its present
   shape. mode: with its softest mode. */
PetscErrorCode LamRVEDescribeFields(LamXDMF *xdmf, const char group[], LamRVE rve, PetscInt number, PetscBool mode);

#endif
