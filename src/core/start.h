/*
  PETSc and MPI for callers that may be one rank of a host's job: whatever this rank starts, it starts alone.
*/
#ifndef LAM_START_H
#define LAM_START_H

#include <petscsys.h>

/*
  Starts PETSc where the process has not, on MPI_COMM_SELF, and MPI before it where it has not. Nothing waits for other
  ranks. A host that starts PETSc afterwards finds it started: PETSC_COMM_WORLD is MPI_COMM_WORLD where the host has
  started MPI. MPI that is started here, in a job of several ranks, has a world of one: there PETSC_COMM_WORLD is
  MPI_COMM_NULL, so that a host that takes this world for its own gets an error.
*/
PetscErrorCode LamStartAlone(void);

/* What LamStartAlone has started in a job of several ranks. */
typedef enum { LAM_ALONE_NOTHING, LAM_ALONE_PETSC, LAM_ALONE_MPI } LamAlone;
LamAlone LamStartedAlone(void);

#endif
