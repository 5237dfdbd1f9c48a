/*
  Independent queries of rank 0 that all ranks of a communicator answer, each a share of them from the reference state.
*/
#ifndef LAM_SPREAD_H
#define LAM_SPREAD_H

#include "study.h"

/* On rank 0: a responder whose queries all ranks answer with `solver` (borrowed; each rank's own). Destroying it ends
   the service of the others. */
PetscErrorCode LamSpreadCreate(MPI_Comm comm, LamResponder solver, LamResponder *spread);
/* On the others: answers queries until rank 0 ends that. */
PetscErrorCode LamSpreadServe(MPI_Comm comm, LamResponder solver);

#endif
