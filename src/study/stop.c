/*
  Stop requests.
*/
#include "stop.h"
#include "clock.h"
#include <signal.h>

static volatile sig_atomic_t StopSignal;
static PetscReal Deadline = PETSC_INFINITY; /* in LamClock time */
static PetscReal ProcessorLimit = PETSC_INFINITY;
static void (*Watch)(void);

#define NEIGHBOURS 16 /* degree of the tree along which requests are sent */

static struct {
  MPI_Comm comm; /* used for nothing else; MPI_COMM_NULL: no sharing with other ranks */
  PetscMPIInt neighbour[NEIGHBOURS + 1];
  PetscInt n, heard; /* number of neighbours, and of those that have sent a request */
  int number;        /* signal that this rank has sent them; 0: none yet */
} Team = {.comm = MPI_COMM_NULL};

void LamStopRequest(int number)
{
  StopSignal = number;
}

int LamStopSignal(void)
{
  return StopSignal;
}

/* ---- sharing between ranks ---- */

PetscErrorCode LamStopShare(MPI_Comm comm)
{
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_dup(comm, &Team.comm));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (rank) Team.neighbour[Team.n++] = (rank - 1) / NEIGHBOURS;
  for (PetscMPIInt k = 1; k <= NEIGHBOURS && NEIGHBOURS * rank + k < size; k++)
    Team.neighbour[Team.n++] = NEIGHBOURS * rank + k;
  PetscFunctionReturn(0);
}

/* Sends without blocking. */
static PetscErrorCode Send(int number)
{
  PetscFunctionBeginUser;
  Team.number = number;
  for (PetscInt k = 0; k < Team.n; k++) {
    MPI_Request request;

    PetscCallMPI(MPI_Isend(&Team.number, 1, MPI_INT, Team.neighbour[k], 0, Team.comm, &request));
    PetscCallMPI(MPI_Request_free(&request));
  }
  PetscFunctionReturn(0);
}

/* Receives requests of other ranks, and forwards the first one received. */
static PetscErrorCode Exchange(void)
{
  int number, waiting;

  PetscFunctionBeginUser;
  if (!StopSignal) {
    PetscCallMPI(MPI_Iprobe(MPI_ANY_SOURCE, 0, Team.comm, &waiting, MPI_STATUS_IGNORE));
    if (!waiting) PetscFunctionReturn(0);
    PetscCallMPI(MPI_Recv(&number, 1, MPI_INT, MPI_ANY_SOURCE, 0, Team.comm, MPI_STATUS_IGNORE));
    Team.heard++;
    StopSignal = number;
  }
  PetscCall(Send(StopSignal));
  PetscFunctionReturn(0);
}

/* If one rank has sent, all do, so each rank knows how many messages to expect. */
PetscErrorCode LamStopShareEnd(void)
{
  int sent = Team.number, number;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sent, 1, MPI_INT, MPI_MAX, Team.comm));
  if (sent && !Team.number) PetscCall(Send(sent));
  for (; sent && Team.heard < Team.n; Team.heard++)
    PetscCallMPI(MPI_Recv(&number, 1, MPI_INT, MPI_ANY_SOURCE, 0, Team.comm, MPI_STATUS_IGNORE));
  PetscCallMPI(MPI_Comm_free(&Team.comm));
  PetscFunctionReturn(0);
}

/* ---- queries ---- */

void LamStopSetDeadline(PetscReal clock)
{
  Deadline = clock;
}

void LamStopSetWatch(void (*watch)(void))
{
  Watch = watch;
}

void LamStopSetProcessorLimit(PetscReal seconds)
{
  ProcessorLimit = seconds;
}

static PetscBool IsOver(void)
{
  if (Deadline < PETSC_INFINITY && LamClock() > Deadline) return PETSC_TRUE;
  return (PetscBool)(ProcessorLimit < PETSC_INFINITY && LamProcessorClock() > ProcessorLimit);
}

PetscBool LamStopRequested(void)
{
  if (Watch) Watch();
  if (Team.n && !Team.number && Team.comm != MPI_COMM_NULL) PetscCallAbort(PETSC_COMM_SELF, Exchange());
  return (PetscBool)(StopSignal != 0 || IsOver());
}

PetscBool LamStopInterrupt(void *ctx)
{
  (void)ctx;
  return LamStopRequested();
}
