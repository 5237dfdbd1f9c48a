/*
  What a long task reports while it runs.
*/
#ifndef LAMELLA_REPORTER_H
#define LAMELLA_REPORTER_H

#include <petscsys.h>

/* Receives reports of a running task, in parallel on rank 0. The reporter and its members may be NULL. */
typedef struct {
  void *ctx; /* of both; borrowed */
  /* A message for the user. warning: results may be unreliable; otherwise it is a note. */
  void (*message)(void *ctx, PetscBool warning, const char text[]);
  /* failed: included in done; total 0: not known yet. */
  PetscErrorCode (*progress)(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed);
} LamReporter;

#endif
