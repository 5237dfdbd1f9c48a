/*
  Clocks for durations, independent of changes to the time of day.
*/
#ifndef LAM_CLOCK_H
#define LAM_CLOCK_H

#include <petscsys.h>
#include <time.h>

/* Seconds since an arbitrary time before the program start. */
static inline PetscReal LamClock(void)
{
  struct timespec now;

  clock_gettime(CLOCK_MONOTONIC, &now);
  return (PetscReal)now.tv_sec + 1e-9 * (PetscReal)now.tv_nsec;
}

/* Processor time of this process since its start, s; of all its threads. */
static inline PetscReal LamProcessorClock(void)
{
  struct timespec now;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (PetscReal)now.tv_sec + 1e-9 * (PetscReal)now.tv_nsec;
}

#endif
