/*
  The grid of a new database on all ranks.
*/
#ifndef LAM_SHARED_GRID_H
#define LAM_SHARED_GRID_H

#include <lamella/database.h>

/*
  Gives a database without a grid the one for its scene. Rank 0 builds it with `solver` (not collective); all ranks get
  the same grid and the records solved for it. *text: on rank 0 the layout, to be written to the database's file as
  LAM_GRID_NAME before the records; the caller frees it. NULL elsewhere. *complete is PETSC_FALSE if a stop was
  requested on rank 0: then no grid is set, since it is built from all of its states or not at all. Collective.
*/
PetscErrorCode LamSharedGridMake(MPI_Comm comm, const LamScene *scene, LamResponder solver, LamDatabase database,
                                 char **text, PetscBool *complete);

#endif
