/*
  What all studies share: requests to stop, reports, errors of rank 0.
*/
#ifndef LAM_STUDY_H
#define LAM_STUDY_H

#include <lamella/lamella.h>
#include <lamella/study.h>
#include "json.h"
#include "stop.h"

void LamReportNote(const LamReporter *reporter, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
void LamReportWarning(const LamReporter *reporter, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PetscErrorCode LamReportProgress(const LamReporter *reporter, PetscInt64 done, PetscInt64 total, PetscInt64 failed);

PetscBool LamIsFirst(MPI_Comm comm); /* rank 0 */
/* Makes an error of rank 0 everyone's; it has been raised where it arose. Collective. */
PetscErrorCode LamShareError(MPI_Comm comm, PetscErrorCode ierr);
/* Largest memory of a rank, MB. Collective. */
PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes);

#endif
