/*
  A responder that can be stopped between two solves.
*/
#ifndef LAM_INTERRUPTIBLE_H
#define LAM_INTERRUPTIBLE_H

#include <lamella/response.h>

/*
  Passes queries on to `solver` (borrowed; not collective) one by one. Once `stop` is true, the rest of a batch gets
  LAM_OUT_OF_REACH: a batch may take hours, and a signal must take effect at once.
*/
PetscErrorCode LamInterruptibleResponderCreate(LamResponder *solver, PetscBool (*stop)(void), LamResponder *responder);

#endif
