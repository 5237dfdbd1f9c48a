/*
  The grid of a new database on all ranks.
*/
#ifndef LAM_SHARED_GRID_H
#define LAM_SHARED_GRID_H

#include <lamella/database.h>

/*
  Gives a database without a grid the one for its scene: made on rank 0, whose `solver` (not collective) solves for it,
  the same on all ranks, with the records that came of it. *text: on rank 0 the layout, to be written to the database's
  file as LAM_GRID_NAME before the records; the caller frees it. NULL elsewhere. *complete is PETSC_FALSE where a stop
  was requested on rank 0: nothing is given then, for a grid is made from all its states or not at all. Collective.
*/
PetscErrorCode LamSharedGridMake(MPI_Comm comm, const LamScene *scene, LamResponder *solver, LamDatabase database,
                                 char **text, PetscBool *complete);

#endif
