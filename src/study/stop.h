/*
  Requests for an orderly stop: a signal, a batch system's limit, a deadline. Studies check LamStopRequested between
  states, solves before each factorisation. The current solve is abandoned; solved states are committed.
*/
#ifndef LAM_STOP_H
#define LAM_STOP_H

#include <lamella/study.h>

int LamStopSignal(void); /* the last one received; 0: none */
PetscBool LamStopRequested(void);
PetscBool LamStopInterrupt(void *ctx); /* LamStopRequested, for LamRVESetInterrupt */
/* `watch` is called whenever somebody looks for a request: a sign of life, for the terminal. NULL: none. */
void LamStopSetWatch(void (*watch)(void));
/* From this LamClock time on LamStopRequested is true, without a signal; PETSC_INFINITY: never. For work with a time
   limit on one rank. */
void LamStopSetDeadline(PetscReal clock);
/* The same for processor time of this process, s. */
void LamStopSetProcessorLimit(PetscReal seconds);
/*
  Between these two collective calls, a request on one rank of `comm` applies to all: a rank sends it when it calls
  LamStopRequested, and the others receive it when they do.
*/
PetscErrorCode LamStopShare(MPI_Comm comm);
PetscErrorCode LamStopShareEnd(void);

#endif
