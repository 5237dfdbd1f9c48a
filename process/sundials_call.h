/* What the integrations of a point and of a body share in calling SUNDIALS. */
#ifndef LAM_SUNDIALS_CALL_H
#define LAM_SUNDIALS_CALL_H

#include <petscsys.h>
#include <lamella/process.h>
#include <ida/ida.h>

#define LamCallSUN(call)                                                                                               \
  do {                                                                                                                 \
    const int lam_sun_flag_ = (call);                                                                                  \
    PetscCheck(lam_sun_flag_ >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "SUNDIALS: %s failed with %d", #call,               \
               lam_sun_flag_);                                                                                         \
  } while (0)

/* IDAErrHandlerFn: what went wrong is told by the process. */
static inline void LamSilence(int code, const char *module, const char *function, char *message, void *ctx) {}

/* IDA looks for these events: numbers that rise through 0. */
static inline PetscErrorCode LamFindRoots(void *ida, PetscInt count, IDARootFn roots)
{
  int rising[LAM_EVENT_COUNT];

  PetscFunctionBeginUser;
  if (!count) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < count; k++) rising[k] = 1;
  LamCallSUN(IDARootInit(ida, (int)count, roots));
  LamCallSUN(IDASetRootDirection(ida, rising));
  LamCallSUN(IDASetNoInactiveRootWarn(ida));
  PetscFunctionReturn(0);
}

/* Which of them it has found. */
static inline PetscErrorCode LamRootsFound(void *ida, PetscInt count, const LamEvent events[],
                                           PetscBool happened[LAM_EVENT_COUNT])
{
  int found[LAM_EVENT_COUNT];

  PetscFunctionBeginUser;
  LamCallSUN(IDAGetRootInfo(ida, found));
  for (PetscInt k = 0; k < count; k++)
    if (found[k]) happened[events[k]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

#endif
