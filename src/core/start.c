/*
  MPI_Init is collective over the ranks that a launcher has started, which it finds by environment variables. Without
  these MPI starts for this process alone ("singleton"). They are put back afterwards: the host may read its rank there.
*/
#define _GNU_SOURCE /* environ */
#include "start.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* By which Open MPI (mpirun, prun), MPICH (mpiexec) and SLURM (srun) describe a job, or set up their own parts. */
static const char *const OfLauncher[] = {"OMPI_", "PMIX_", "PMI_", "ORTE_", "PRTE_", "SLURM_"};
/* Where there are no other ranks: no daemon, no search for networks, and no session directories, of which processes
   remove each other's as they end. */
static const char *const OfSingleton[][2] = {
    {"OMPI_MCA_ess_singleton_isolated", "1"}, {"OMPI_MCA_orte_create_session_dirs", "false"}, {"OMPI_MCA_pml", "ob1"}};

static LamAlone Alone = LAM_ALONE_NOTHING;

LamAlone LamStartedAlone(void)
{
  return Alone;
}

static PetscBool IsOfLauncher(const char variable[])
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(OfLauncher) && strchr(variable, '='); i++)
    if (!strncmp(variable, OfLauncher[i], strlen(OfLauncher[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether a launcher has started this process as one of several ranks, or does not say how many there are. */
static PetscBool IsOneOfSeveral(void)
{
  static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};

  if (!getenv("OMPI_COMM_WORLD_RANK") && !getenv("PMIX_RANK") && !getenv("PMI_RANK")) return PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(sizes); i++)
    if (getenv(sizes[i])) return (PetscBool)(atoi(getenv(sizes[i])) != 1);
  return PETSC_TRUE;
}

/* Takes the launcher's variables out of the environment. taken: names, each with its value behind the name's end; NULL
   behind the last. */
static PetscErrorCode TakeVariables(char ***taken)
{
  size_t count = 0, n = 0;

  PetscFunctionBeginUser;
  while (environ[count]) count++;
  PetscCall(PetscCalloc1(count + 1, taken));
  for (size_t i = 0; i < count; i++)
    if (IsOfLauncher(environ[i])) PetscCall(PetscStrallocpy(environ[i], &(*taken)[n++]));
  for (size_t i = 0; i < n; i++) {
    *strchr((*taken)[i], '=') = '\0';
    unsetenv((*taken)[i]);
  }
  PetscFunctionReturn(0);
}

/* put: whether they go into the environment again. */
static PetscErrorCode FreeVariables(char **taken, PetscBool put)
{
  PetscFunctionBeginUser;
  for (size_t i = 0; taken[i]; i++) {
    if (put) setenv(taken[i], taken[i] + strlen(taken[i]) + 1, 1);
    PetscCall(PetscFree(taken[i]));
  }
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(0);
}

static PetscErrorCode StartMPI(void)
{
  char **taken, **set;
  int provided;

  PetscFunctionBeginUser;
  PetscCall(TakeVariables(&taken));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(OfSingleton); i++) setenv(OfSingleton[i][0], OfSingleton[i][1], 1);
  PetscCallMPI(MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided)); /* a host's threads take turns */
  PetscCall(TakeVariables(&set));                                              /* those that MPI has set */
  PetscCall(FreeVariables(set, PETSC_FALSE));
  PetscCall(FreeVariables(taken, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode LamStartAlone(void)
{
  int running;
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  if (PetscInitializeCalled) PetscFunctionReturn(0);
  setenv("HWLOC_HIDE_ERRORS", "2", 0);                                 /* without /sys (containers) it prints errors */
  PetscCall(PetscOptionsSetValue(NULL, "-no_signal_handler", "true")); /* signals are the program's */
  PetscCallMPI(MPI_Initialized(&running));
  if (running) {
    PetscCallMPI(MPI_Comm_size(MPI_COMM_WORLD, &ranks));
    if (ranks > 1) Alone = LAM_ALONE_PETSC;
  } else {
    if (IsOneOfSeveral()) Alone = LAM_ALONE_MPI;
    PetscCall(StartMPI());
  }
  PETSC_COMM_WORLD = MPI_COMM_SELF;
  PetscCall(PetscInitializeNoArguments());
  PETSC_COMM_WORLD = Alone == LAM_ALONE_MPI ? MPI_COMM_NULL : MPI_COMM_WORLD;
  PetscFunctionReturn(0);
}
