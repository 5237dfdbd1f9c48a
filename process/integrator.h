/*
  An integration of one segment of time by IDA (SUNDIALS): what a material point and a body have in common.
*/
#ifndef LAM_INTEGRATOR_H
#define LAM_INTEGRATOR_H

#include "process_impl.h"
#include <ida/ida.h>
#include <sundials/sundials_version.h>

#if SUNDIALS_VERSION_MAJOR < 7
#define SUN_SUCCESS 0
#endif

#define LamCallSUN(call)                                                                                               \
  do {                                                                                                                 \
    const int lam_sun_flag_ = (call);                                                                                  \
    PetscCheck(lam_sun_flag_ >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "SUNDIALS: %s failed with %d", #call,               \
               lam_sun_flag_);                                                                                         \
  } while (0)

typedef struct {
  LamProcess process;
  PetscInt n;                          /* unknowns on this rank */
  PetscInt state[LAM_PROCESS_KINETIC]; /* positions of the kinetic states in y; -1: not an unknown */
  PetscInt event_count;
  LamEvent events[LAM_EVENT_COUNT];
  SUNContext context;
  void *ida;
  N_Vector y, yp, id; /* id: 1 for differential unknowns */
} LamIntegrator;

/* Begins with the kinetic states as unknowns, on rank 0; comm MPI_COMM_NULL: without MPI. The caller creates y. */
PetscErrorCode LamIntegratorCreate(LamProcess process, MPI_Comm comm, LamIntegrator *integrator);
/* Creates IDA for the segment, from y, yp and id at the tissue's time; `roots`: the event functions. Tolerances and
   solvers are set by the caller. ctx: user data of both. */
PetscErrorCode LamIntegratorStart(LamIntegrator *integrator, IDAResFn residual, IDARootFn roots, void *ctx);
/* After IDASolve. Marks the events that IDA has found; sets process->trouble if it has failed. */
PetscErrorCode LamIntegratorTake(LamIntegrator *integrator, int flag, PetscBool happened[LAM_EVENT_COUNT]);
void LamIntegratorDestroy(LamIntegrator *integrator);

#endif
