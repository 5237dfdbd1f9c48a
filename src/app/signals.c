/*
  Signals that tell of a fault, and those that ask for an orderly end. Commands look at LamStopRequested between states,
  solves before each factorisation; what is under way is given up, what is solved is committed.
*/
#include "app.h"
#include <execinfo.h>
#include <lamella/clock.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

/* Several may arrive for one wish to stop, as a batch system and mpirun both pass them on: those of a burst are one.
   Whoever goes on wishing gets his way. */
#define PATIENCE 3
#define MOST_FRAMES 64 /* of the trace of a fault */
#define BURST 0.5      /* s */

static volatile sig_atomic_t StopSignal, Count;
static volatile PetscReal LastSignal;
static PetscReal Deadline = PETSC_INFINITY; /* on the clock */

#define NEIGHBOURS 16 /* below a rank, in the tree by which ranks tell each other */

static struct {
  MPI_Comm comm; /* used for nothing else; MPI_COMM_NULL: the rank is alone */
  PetscMPIInt neighbour[NEIGHBOURS + 1];
  PetscInt n, heard; /* neighbours, and how many of them have told this rank */
  int number;        /* the signal that it has told them; 0: none yet */
} Team = {.comm = MPI_COMM_NULL};

static void Request(int number)
{
  const PetscReal now = LamClock();
  const PetscBool again = (PetscBool)(Count && now - LastSignal < BURST);

  StopSignal = number;
  LastSignal = now;
  if (again || ++Count < PATIENCE) return;
  signal(number, SIG_DFL);
  raise(number);
}

/* Then the signal does what it does without: it ends the program. */
static void Fault(int number)
{
  static const char words[] =
      "lamella: a fault of memory, in Lamella or in a library that it uses; what was committed is in the file. Where a "
      "file was being read it may be damaged in a way that HDF5 does not stand: take a copy of it that is sound. Else "
      "please report it:\n";

  void *frames[MOST_FRAMES];

  if (write(STDERR_FILENO, words, sizeof(words) - 1) < 0) _exit(LAM_EXIT_FAULT);
  backtrace_symbols_fd(frames, backtrace(frames, MOST_FRAMES), STDERR_FILENO);
  signal(number, SIG_DFL);
  raise(number);
}

void LamFaultsTell(void)
{
#ifndef __SANITIZE_ADDRESS__ /* which tells more */
  signal(SIGSEGV, Fault);
  signal(SIGBUS, Fault);
#endif
}

PetscErrorCode LamSignalsInstall(void)
{
  const int numbers[] = {SIGINT, SIGTERM, SIGUSR1};
  struct sigaction action;

  PetscFunctionBeginUser;
  memset(&action, 0, sizeof(action));
  action.sa_handler = Request;
  action.sa_flags = SA_RESTART; /* a write under way is finished */
  sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(numbers); i++) {
    PetscCheck(!sigaction(numbers[i], &action, NULL), PETSC_COMM_SELF, PETSC_ERR_SYS, "signal %d cannot be caught",
               numbers[i]);
  }
  PetscFunctionReturn(0);
}

void LamStopRequest(void)
{
  if (!StopSignal) StopSignal = SIGTERM;
}

/* ---- ranks that tell each other ---- */

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

/* Nobody waits for it. */
static PetscErrorCode Tell(int number)
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

/* Learns of a signal of another rank, and tells the one that has come, once. */
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
  PetscCall(Tell(StopSignal));
  PetscFunctionReturn(0);
}

/* Where one has told, all do, so that each knows how many messages are to come. */
PetscErrorCode LamStopShareEnd(void)
{
  int told = Team.number, number;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &told, 1, MPI_INT, MPI_MAX, Team.comm));
  if (told && !Team.number) PetscCall(Tell(told));
  for (; told && Team.heard < Team.n; Team.heard++)
    PetscCallMPI(MPI_Recv(&number, 1, MPI_INT, MPI_ANY_SOURCE, 0, Team.comm, MPI_STATUS_IGNORE));
  PetscCallMPI(MPI_Comm_free(&Team.comm));
  PetscFunctionReturn(0);
}

/* ---- asking ---- */

void LamStopSetDeadline(PetscReal clock)
{
  Deadline = clock;
}

PetscBool LamStopRequested(void)
{
  if (Team.n && !Team.number && Team.comm != MPI_COMM_NULL) PetscCallAbort(PETSC_COMM_SELF, Exchange());
  return (PetscBool)(StopSignal != 0 || (Deadline < PETSC_INFINITY && LamClock() > Deadline));
}

PetscBool LamStopInterrupt(void *ctx)
{
  (void)ctx;
  return LamStopRequested();
}

int LamStopExitStatus(void)
{
  if (!StopSignal) return 0;
  return 128 + (StopSignal == SIGINT ? SIGINT : SIGTERM);
}
