/*
  Runtime of every command: streams, signals, MPI, PETSc; errors, reported once at the end.

  Errors. The library returns PETSc error codes. The handler below stores the message and the traceback of the first
  one. Nothing is printed before the error has reached main, where it is reported once: user errors and input/output
  failures with their own message, anything else as a program fault with its traceback.

  Under MPI the ranks agree at the end: an error common to all is reported by the lowest rank that has the message. A
  rank that alone has an error waits briefly for the others, then reports it and aborts the job.
*/
#define _GNU_SOURCE /* RTLD_DEFAULT */
#include "app.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "clock.h"
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

/* How long a rank waits for the others to end, s: with its own error, and with one shared from another rank. */
#define OWN_ERROR_PATIENCE 3.0
#define SHARED_ERROR_PATIENCE 60.0

static PetscBool ExpectRanks;
static MPI_Comm EndComm = MPI_COMM_NULL; /* for the agreement at the end */

/* ---- errors ---- */

static int StatusOf(PetscErrorCode code)
{
  switch (code) {
  case PETSC_ERR_USER_INPUT:
    return LAM_EXIT_INPUT;
  case PETSC_ERR_FILE_OPEN:
  case PETSC_ERR_FILE_READ:
  case PETSC_ERR_FILE_WRITE:
  case PETSC_ERR_FILE_UNEXPECTED:
    return LAM_EXIT_IO;
  default:
    return LAM_EXIT_FAULT;
  }
}

void LamRuntimeReport(PetscErrorCode code, int *status)
{
  const char *general = NULL;

  *status = StatusOf(code);
  fflush(stdout);
  if (*status != LAM_EXIT_FAULT) {
    fprintf(stderr, "lamella: %s\n", LamErrorMessage());
    return;
  }
  if (code == PETSC_ERR_MEM) {
    fprintf(stderr, "lamella: out of memory (%s); lamella check shows what a scene needs\n", LamErrorMessage());
    return;
  }
  (void)PetscErrorMessage(code, &general, NULL);
  fprintf(stderr, "lamella: %s%s%s\n%sThis is a fault of Lamella, please report it.\n", general ? general : "",
          general && LamErrorMessage()[0] ? ": " : "", LamErrorMessage(), LamErrorTrace());
}

#ifdef __SANITIZE_ADDRESS__
/* Called by the leak checker at exit: an error returns without cleaning up, so its memory is left to the system.
   Hidden, the checker would not find it. */
__attribute__((visibility("default"))) int __lsan_is_turned_off(void)
{
  return LamErrorCode() != 0;
}
#endif

/* ---- MPI: start, agreement, end ---- */

static PetscBool MPIRuns(void)
{
  int initialized = 0, finalized = 0;

  MPI_Initialized(&initialized);
  MPI_Finalized(&finalized);
  return (PetscBool)(initialized && !finalized);
}

void LamRuntimeExpectRanks(PetscBool expect)
{
  ExpectRanks = expect;
}

PetscBool LamAppIsRoot(void)
{
  int rank = 0;

  if (MPIRuns()) {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  } else if (ExpectRanks) { /* a usage error under mpirun is reported once, too */
    const char *launched = getenv("OMPI_COMM_WORLD_RANK");

    rank = launched ? atoi(launched) : 0;
  }
  return (PetscBool)(rank == 0);
}

/*
  Without a launcher there are no other ranks. Open MPI then need not start a daemon or search for networks, which takes
  longer than many solves.
*/
static void ExpectNoRanks(void)
{
  if (getenv("OMPI_COMM_WORLD_SIZE") || getenv("PMIX_RANK") || getenv("PMI_RANK")) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "false", 0); /* processes remove each other's as they end */
  setenv("OMPI_MCA_pml", "ob1", 0);
}

PetscErrorCode LamRuntimeStart(LamArgs *args)
{
  PetscFunctionBeginUser;
  ExpectNoRanks();
  setenv("HWLOC_HIDE_ERRORS", "2", 0); /* without /sys (containers) MPI's hwloc prints errors on every start */
  PetscCall(PetscOptionsSetValue(NULL, "-no_signal_handler", "true")); /* SIGTERM is handled by signals.c */
  PetscCall(PetscInitialize(&args->petsc_argc, &args->petsc_argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_dup(MPI_COMM_WORLD, &EndComm));
  PetscCall(LamSignalsInstall());
  PetscCall(LamStopShare(MPI_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* Whether all ranks have arrived here within `patience` seconds (negative: no limit). */
static PetscBool AwaitOthers(MPI_Request *request, double patience)
{
  const struct timespec pause = {0, 1000000}; /* idle ranks yield the processor to the others */
  const double start = LamClock();
  int done = 0;

  while (MPI_Test(request, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && !done) {
    if (patience >= 0 && LamClock() - start > patience) return PETSC_FALSE;
    nanosleep(&pause, NULL);
  }
  return (PetscBool)done;
}

/* All ranks exit with the same status, the largest; errors are reported by the lowest rank that has the message. */
static void AgreeAtEnd(PetscErrorCode code, int *status)
{
  const PetscBool own = (PetscBool)(code && code == LamErrorCode());
  int rank, size, mine[2], all[2];
  MPI_Request request;

  MPI_Comm_rank(EndComm, &rank);
  MPI_Comm_size(EndComm, &size);
  mine[0] = *status;
  mine[1] = own ? size - rank : 0;
  MPI_Iallreduce(mine, all, 2, MPI_INT, MPI_MAX, EndComm, &request);
  if (!AwaitOthers(&request, own ? OWN_ERROR_PATIENCE : code ? SHARED_ERROR_PATIENCE : -1)) {
    if (own) LamRuntimeReport(code, status);
    fprintf(stderr, "lamella: rank %d ends the job\n", rank);
    MPI_Abort(EndComm, *status);
  }
  if (own && all[1] == mine[1]) LamRuntimeReport(code, status);
  *status = all[0];
  (void)LamStopShareEnd();
  MPI_Comm_free(&EndComm);
}

/* A misspelt option after `--` would otherwise be ignored silently. */
static PetscErrorCode WarnOfUnusedOptions(void)
{
  PetscInt n;
  char **names, **values;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n && LamAppIsRoot(); i++)
    fprintf(stderr, "lamella: PETSc option -%s was not used\n", names[i]);
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

void LamRuntimeEnd(PetscErrorCode code, int *status)
{
  LamConsoleClear();
  if (code) *status = StatusOf(code);
  if (EndComm != MPI_COMM_NULL)
    AgreeAtEnd(code, status);
  else if (code)
    LamRuntimeReport(code, status);
  if (PetscInitializeCalled && !code) (void)WarnOfUnusedOptions();
  if (PetscInitializeCalled && PetscFinalize()) *status = PetscMax(*status, LAM_EXIT_FAULT);
  if (!fflush(stdout) && !ferror(stdout)) return;
  if (*status != LAM_EXIT_IO) fprintf(stderr, "lamella: standard output: %s\n", strerror(errno));
  *status = LAM_EXIT_IO;
}

/*
  The matrices of an RVE are too small for threads, which cost more than they save and compete with the ranks. The
  libraries read OMP_NUM_THREADS and OPENBLAS_NUM_THREADS when they are loaded, before main. So their number of threads
  is set by their functions, if they have any, unless the user has set the variable.
*/
static void UseOneThread(void)
{
  const char *const libraries[][2] = {{"OMP_NUM_THREADS", "omp_set_num_threads"},
                                      {"OPENBLAS_NUM_THREADS", "openblas_set_num_threads"}};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(libraries); i++) {
    void (*set)(int);

    *(void **)&set = dlsym(RTLD_DEFAULT, libraries[i][1]);
    if (set && !getenv(libraries[i][0])) set(1);
  }
}

/* Otherwise a file could get the descriptor of a stream that the caller has closed, and receive printed output. */
static void FillStreams(void)
{
  int fd;

  do fd = open("/dev/null", O_RDONLY); /* printing to it fails, and the failure is reported */
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0) close(fd);
}

PetscErrorCode LamRuntimeBegin(void)
{
  FillStreams();
  UseOneThread();
  LamFaultsReport();
  /* HDF5 crashes in its cleanup after a file that could not be written. The cleanup would run at exit, and in
     MPI_Finalize if MPI is running when HDF5 is initialised. */
  H5dont_atexit();
  H5open();
  signal(SIGPIPE, SIG_IGN); /* a closed pipe is reported as a write error */
  signal(SIGXFSZ, SIG_IGN); /* so is a file that exceeds the size limit */
  return LamErrorsKeep();
}
