/*
  Signals of faults, and those that request an orderly stop. Studies check LamStopRequested between states, solves
  before each factorisation. The current solve is abandoned; solved states are committed.
*/
#include "app.h"
#include <execinfo.h>
#include "clock.h"
#include <signal.h>
#include <string.h>
#include <unistd.h>

/* One stop request may deliver several signals, since a batch system and mpirun both forward them: those within
   BURST seconds count as one. The program ends at once after PATIENCE requests. */
#define PATIENCE 3
#define MOST_FRAMES 64 /* of the traceback of a fault */
#define BURST 0.5      /* s */

static volatile sig_atomic_t Count;
static volatile PetscReal LastSignal;
static void Request(int number)
{
  const PetscReal now = LamClock();
  const PetscBool again = (PetscBool)(Count && now - LastSignal < BURST);

  LamStopRequest(number);
  LastSignal = now;
  if (again || ++Count < PATIENCE) return;
  signal(number, SIG_DFL);
  raise(number);
}

/* Afterwards the signal has its default effect: it ends the program. */
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

void LamFaultsReport(void)
{
#ifndef __SANITIZE_ADDRESS__ /* AddressSanitizer reports more */
  void *frame;

  /* The first call loads libgcc, which allocates: in a handler that interrupts malloc it would wait forever. */
  (void)backtrace(&frame, 1);
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
  action.sa_flags = SA_RESTART; /* a write in progress is completed */
  sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(numbers); i++) {
    PetscCheck(!sigaction(numbers[i], &action, NULL), PETSC_COMM_SELF, PETSC_ERR_SYS, "signal %d cannot be caught",
               numbers[i]);
  }
  PetscFunctionReturn(0);
}

int LamStopExitStatus(void)
{
  const int number = LamStopSignal();

  return !number ? LAM_EXIT_OK : number == SIGINT ? LAM_EXIT_INTERRUPTED : LAM_EXIT_TERMINATED;
}
