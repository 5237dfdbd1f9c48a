/*
  An integration by IDA: its creation, and its results.
*/
#include "integrator.h"

/* SUNDIALS 6 and 7: context of a communicator; integrator without messages of its own, since the process reports
   failures. */
#if SUNDIALS_VERSION_MAJOR < 7
static int CreateContext(MPI_Comm comm, SUNContext *context)
{
  return SUNContext_Create(comm == MPI_COMM_NULL ? NULL : &comm, context);
}

static void Ignore(int code, const char *module, const char *function, char *message, void *ctx) {}

static int Silence(void *ida, SUNContext context)
{
  return IDASetErrHandlerFn(ida, Ignore, NULL);
}
#else
static int CreateContext(MPI_Comm comm, SUNContext *context)
{
  return SUNContext_Create(comm, context);
}

static int Silence(void *ida, SUNContext context)
{
  return SUNContext_ClearErrHandlers(context);
}
#endif

PetscErrorCode LamIntegratorCreate(LamProcess process, MPI_Comm comm, LamIntegrator *in)
{
  PetscMPIInt rank = 0;

  PetscFunctionBeginUser;
  if (comm != MPI_COMM_NULL) PetscCallMPI(MPI_Comm_rank(comm, &rank));
  *in = (LamIntegrator){.process = process};
  for (PetscInt k = 0; k < LAM_PROCESS_KINETIC; k++) {
    const LamKinetics *law = &process->spec->kinetics[k / LAM_KINETIC_STATES];

    in->state[k] = !rank && k % LAM_KINETIC_STATES < LamKineticsStates(law) ? in->n++ : -1;
  }
  LamCallSUN(CreateContext(comm, &in->context));
  PetscFunctionReturn(0);
}

/* Events are functions that rise through 0. */
static PetscErrorCode FindRoots(LamIntegrator *in, IDARootFn roots)
{
  int rising[LAM_EVENT_COUNT];

  PetscFunctionBeginUser;
  if (!in->event_count) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < in->event_count; k++) rising[k] = 1;
  LamCallSUN(IDARootInit(in->ida, (int)in->event_count, roots));
  LamCallSUN(IDASetRootDirection(in->ida, rising));
  LamCallSUN(IDASetNoInactiveRootWarn(in->ida));
  PetscFunctionReturn(0);
}

PetscErrorCode LamIntegratorStart(LamIntegrator *in, IDAResFn residual, IDARootFn roots, void *ctx)
{
  PetscFunctionBeginUser;
  in->process->counts.restarts++;
  in->ida = IDACreate(in->context);
  PetscCheck(in->ida, PETSC_COMM_SELF, PETSC_ERR_MEM, "SUNDIALS: no memory for an integrator");
  LamCallSUN(Silence(in->ida, in->context));
  LamCallSUN(IDAInit(in->ida, residual, in->process->tissue.time, in->y, in->yp));
  LamCallSUN(IDASetUserData(in->ida, ctx));
  LamCallSUN(IDASetId(in->ida, in->id));
  LamCallSUN(IDASetStopTime(in->ida, in->process->segment.end));
  PetscCall(FindRoots(in, roots));
  PetscFunctionReturn(0);
}

PetscErrorCode LamIntegratorTake(LamIntegrator *in, int flag, PetscBool happened[LAM_EVENT_COUNT])
{
  int found[LAM_EVENT_COUNT];
  char *trouble = in->process->trouble;
  const size_t size = sizeof(in->process->trouble);

  PetscFunctionBeginUser;
  if (flag == IDA_ROOT_RETURN) {
    LamCallSUN(IDAGetRootInfo(in->ida, found));
    for (PetscInt k = 0; k < in->event_count; k++)
      if (found[k]) happened[in->events[k]] = PETSC_TRUE;
  }
  if (flag >= 0 || in->process->stopped) PetscFunctionReturn(0);
  if (flag == IDA_ERR_FAIL)
    PetscCall(PetscStrncpy(trouble, "the error of a step of time cannot be brought below the tolerance", size));
  else if (flag == IDA_LSETUP_FAIL || flag == IDA_LSOLVE_FAIL)
    PetscCall(PetscStrncpy(trouble, "the equations of a step of time are singular", size));
  else if (!trouble[0])
    PetscCall(PetscSNPrintf(trouble, size, "no step of time converges (IDA: %d)", flag));
  PetscFunctionReturn(0);
}

void LamIntegratorDestroy(LamIntegrator *in)
{
  if (in->ida) IDAFree(&in->ida);
  if (in->id) N_VDestroy(in->id);
  if (in->yp) N_VDestroy(in->yp);
  if (in->y) N_VDestroy(in->y);
  if (in->context) SUNContext_Free(&in->context);
}
