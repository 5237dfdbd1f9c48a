/*
  Requests to end in order: a signal, a batch system's limit, a deadline. Studies look at LamStopRequested between
  states, solves before each factorisation; what is under way is given up, what is solved is committed.
*/
#ifndef LAM_STOP_H
#define LAM_STOP_H

#include <lamella/study.h>

int LamStopSignal(void); /* the last one requested; 0: none */
PetscBool LamStopRequested(void);
PetscBool LamStopInterrupt(void *ctx); /* the same, for LamRVESetInterrupt */
/* From that time of LamClock on LamStopRequested is true, without a signal; PETSC_INFINITY: never. For work that has a
   limited time on one rank. */
void LamStopSetDeadline(PetscReal clock);
/*
  Between the two, which are collective, a request on one rank of `comm` is one on all: a rank sends it when it calls
  LamStopRequested, and the others receive it when they do.
*/
PetscErrorCode LamStopShare(MPI_Comm comm);
PetscErrorCode LamStopShareEnd(void);

#endif
