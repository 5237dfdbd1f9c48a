/*
  The last error of each thread.
*/
#include <lamella/error.h>
#include <stdio.h>
#include <string.h>

static _Thread_local struct {
  PetscErrorCode code;
  char message[2048], trace[2048];
} Error;

/* A PETSc error handler. */
static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *message, void *ctx)
{
  size_t length;

  (void)comm;
  (void)ctx;
  if (type == PETSC_ERROR_INITIAL) {
    /* if malloc fails PETSc 3.18 passes the caller's line as the code, and the caller's name as the message */
    if (!strcmp(function, "PetscMallocAlign")) code = PETSC_ERR_MEM;
    Error.code = code;
    Error.trace[0] = '\0';
    snprintf(Error.message, sizeof(Error.message), "%s", message ? message : "");
  }
  length = strlen(Error.trace);
  snprintf(Error.trace + length, sizeof(Error.trace) - length, "  %s, %s:%d\n", function, file, line);
  return code;
}

PetscErrorCode LamErrorsKeep(void)
{
  PetscErrorHandlingInitialized = PETSC_TRUE; /* otherwise PETSc calls no handler before PetscInitialize */
  return PetscPushErrorHandler(Keep, NULL);
}

PetscErrorCode LamErrorCode(void)
{
  return Error.code;
}

const char *LamErrorMessage(void)
{
  return Error.message;
}

const char *LamErrorTrace(void)
{
  return Error.trace;
}
