/* The message of the last error, kept instead of printed, also before PetscInitialize. */
#ifndef LAM_SUPPORT_ERROR_MESSAGE_H
#define LAM_SUPPORT_ERROR_MESSAGE_H

#include <petscsys.h>

extern char ErrorMessage[2048];

/* PetscPopErrorHandler ends it. */
PetscErrorCode KeepErrorMessages(void);

#endif
