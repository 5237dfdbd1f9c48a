/*
  Signals that ask for an orderly end. Commands look at LamStopRequested between states, commit and stop.
*/
#include "app.h"
#include <signal.h>
#include <string.h>

/* Several may arrive for one wish to stop: a batch system and mpirun both pass them on. */
#define PATIENCE 3

static volatile sig_atomic_t StopSignal, Count;

static void Request(int number)
{
  StopSignal = number;
  if (++Count < PATIENCE) return;
  signal(number, SIG_DFL);
  raise(number);
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

PetscBool LamStopRequested(void)
{
  return (PetscBool)(StopSignal != 0);
}

int LamStopExitStatus(void)
{
  if (!StopSignal) return 0;
  return 128 + (StopSignal == SIGINT ? SIGINT : SIGTERM);
}
