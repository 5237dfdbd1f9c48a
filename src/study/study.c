/*
  Functions shared by all studies.
*/
#include "study.h"
#include <stdarg.h>
#include <stdio.h>
#include <sys/resource.h>

const char *const LamFE2ResponseNames[] = {"direct", "cache", "database"};

enum { MOST_CHARACTERS = 1024 };

static void Report(const LamReporter *reporter, PetscBool warning, const char format[], va_list values)
{
  char text[MOST_CHARACTERS];

  if (!reporter || !reporter->message) return;
  vsnprintf(text, sizeof(text), format, values);
  reporter->message(reporter->ctx, warning, text);
}

void LamReportNote(const LamReporter *reporter, const char format[], ...)
{
  va_list values;

  va_start(values, format);
  Report(reporter, PETSC_FALSE, format, values);
  va_end(values);
}

void LamReportWarning(const LamReporter *reporter, const char format[], ...)
{
  va_list values;

  va_start(values, format);
  Report(reporter, PETSC_TRUE, format, values);
  va_end(values);
}

PetscErrorCode LamReportProgress(const LamReporter *reporter, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  PetscFunctionBeginUser;
  if (reporter && reporter->progress) PetscCall(reporter->progress(reporter->ctx, done, total, failed));
  PetscFunctionReturn(0);
}

PetscBool LamIsFirst(MPI_Comm comm)
{
  PetscMPIInt rank = 0;

  MPI_Comm_rank(comm, &rank);
  return (PetscBool)(rank == 0);
}

PetscErrorCode LamShareError(MPI_Comm comm, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, comm));
  /* no SETERRQ: the message was stored where the error was raised */
  PetscFunctionReturn((PetscErrorCode)code);
}

PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes)
{
  struct rusage usage;

  PetscFunctionBeginUser;
  getrusage(RUSAGE_SELF, &usage);
  *megabytes = (PetscReal)usage.ru_maxrss / 1024; /* Linux reports kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, megabytes, 1, MPIU_REAL, MPIU_MAX, comm));
  PetscFunctionReturn(0);
}
