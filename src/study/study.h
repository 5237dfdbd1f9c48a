/*
  Functions shared by all studies: stop requests, reports, errors of rank 0.
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
/* Raises an error of rank 0 on all ranks; rank 0 has already reported it. Collective. */
PetscErrorCode LamShareError(MPI_Comm comm, PetscErrorCode ierr);
/* Largest memory of any rank, MB. Collective. */
PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes);

#endif
