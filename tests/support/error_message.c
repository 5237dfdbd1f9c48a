#include "error_message.h"

char ErrorMessage[2048];

static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *text, void *ctx)
{
  if (type == PETSC_ERROR_INITIAL) snprintf(ErrorMessage, sizeof(ErrorMessage), "%s", text);
  return code;
}

PetscErrorCode KeepErrorMessages(void)
{
  ErrorMessage[0] = '\0';
  PetscErrorHandlingInitialized = PETSC_TRUE; /* before PetscInitialize PETSc calls no handler else */
  return PetscPushErrorHandler(Keep, NULL);
}
