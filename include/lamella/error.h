/*
  The last error in words.

  Functions of the library return a PetscErrorCode; PETSc's own handlers print a trace as well. A program that wants the
  words only, to show them or to raise them in its own language, calls LamErrorsKeep once.
*/
#ifndef LAMELLA_ERROR_H
#define LAMELLA_ERROR_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* From here on errors are kept, per thread, in place of being printed; also before PetscInitialize. */
LAM_EXPORT PetscErrorCode LamErrorsKeep(void);
/* Of this thread's last error: its code (0: none yet), what was wrong, and the calls that it came through, a line each.
   Valid until the next error. */
LAM_EXPORT PetscErrorCode LamErrorCode(void);
LAM_EXPORT const char *LamErrorMessage(void);
LAM_EXPORT const char *LamErrorTrace(void);

LAM_C_END

#endif
