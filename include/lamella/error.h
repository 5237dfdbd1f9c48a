/*
  The last error as text.

  Functions of the library return a PetscErrorCode; PETSc's default handlers also print a trace. A program that needs
  only the message, to show it or to raise it in its own language, calls LamErrorsKeep once.
*/
#ifndef LAMELLA_ERROR_H
#define LAMELLA_ERROR_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* From this call on errors are stored per thread instead of printed. May be called before PetscInitialize. */
LAM_EXPORT PetscErrorCode LamErrorsKeep(void);
/* The last error of this thread: code (0: no error so far), message, and call trace, one call per line. Valid until
   the next error. */
LAM_EXPORT PetscErrorCode LamErrorCode(void);
LAM_EXPORT const char *LamErrorMessage(void);
LAM_EXPORT const char *LamErrorTrace(void);

LAM_C_END

#endif
