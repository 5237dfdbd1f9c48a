/* SUNDIALS calls shared by the integration of a point and of a body. */
#ifndef LAM_SUNDIALS_CALL_H
#define LAM_SUNDIALS_CALL_H

#include <petscsys.h>
#include <lamella/process.h>
#include <ida/ida.h>
#include <sundials/sundials_version.h>

#define LamCallSUN(call)                                                                                               \
  do {                                                                                                                 \
    const int lam_sun_flag_ = (call);                                                                                  \
    PetscCheck(lam_sun_flag_ >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "SUNDIALS: %s failed with %d", #call,               \
               lam_sun_flag_);                                                                                         \
  } while (0)

/* SUNDIALS 6 and 7: context of a communicator; integrator without messages of its own, since the process reports
   failures. */
#if SUNDIALS_VERSION_MAJOR < 7
#define SUN_SUCCESS 0

static inline int LamContextCreate(MPI_Comm comm, SUNContext *context)
{
  return SUNContext_Create(comm == MPI_COMM_NULL ? NULL : &comm, context);
}

static inline void LamSilence(int code, const char *module, const char *function, char *message, void *ctx) {}

static inline int LamIntegratorSilence(void *ida, SUNContext context)
{
  return IDASetErrHandlerFn(ida, LamSilence, NULL);
}
#else
static inline int LamContextCreate(MPI_Comm comm, SUNContext *context)
{
  return SUNContext_Create(comm, context);
}

static inline int LamIntegratorSilence(void *ida, SUNContext context)
{
  return SUNContext_ClearErrHandlers(context);
}
#endif

/* Sets the events as IDA's root functions, which rise through 0. */
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

/* Marks the events that IDA has found. */
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
