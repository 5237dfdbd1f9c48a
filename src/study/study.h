/*
  What all studies share: requests to stop, reports, errors of rank 0.
*/
#ifndef LAM_STUDY_H
#define LAM_STUDY_H

#include <lamella/lamella.h>
#include "json.h"
#include "stop.h"

/* What a study reports while it runs, on rank 0. It, or its members, may be NULL. */
typedef struct {
  void *ctx; /* of both; borrowed */
  /* A sentence for a person. A warning says that results may not be what they seem; else it is a note. */
  void (*message)(void *ctx, PetscBool warning, const char text[]);
  /* `failed` of those done; total 0: not known yet. */
  PetscErrorCode (*progress)(void *ctx, PetscInt64 done, PetscInt64 total, PetscInt64 failed);
} LamReporter;

void LamReportNote(const LamReporter *reporter, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
void LamReportWarning(const LamReporter *reporter, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PetscErrorCode LamReportProgress(const LamReporter *reporter, PetscInt64 done, PetscInt64 total, PetscInt64 failed);

PetscBool LamIsFirst(MPI_Comm comm); /* rank 0 */
/* Makes an error of rank 0 everyone's; it has been raised where it arose. Collective. */
PetscErrorCode LamShareError(MPI_Comm comm, PetscErrorCode ierr);
/* Largest memory of a rank, MB. Collective. */
PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes);

#endif
