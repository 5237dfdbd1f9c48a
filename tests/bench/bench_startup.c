/*
  What the program does before and beside its work: start and memory of `lamella rve` without database, macroscale body
  and time, against a program that has none of them and solves the same states. Prints figures.

  The variants take turns; wall and processor time and the largest memory that a process had, medians. Those that are
  not the program are this one, started anew with the name of what it is to do.
*/
#include <hdf5.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <fcntl.h>
#include "clock.h"
#include "measure.h"
#include "support/tissue.h"

#define ROUNDS 21
#define SCENE LAMELLA_SOURCE_DIR "/tests/scenes/shear-bonded.yaml"
#define DATABASE "startup.h5"

typedef struct {
  const char *name, *argv[6]; /* no argv: what this program does under that name */
  double wall[ROUNDS], processor[ROUNDS], memory[ROUNDS];
} Variant;

static Variant Variants[] = {
    {.name = "nothing: libraries are loaded"},
    {.name = "HDF5 begins"},
    {.name = "PETSc and MPI begin and end"},
    {.name = "three states without scene and database"},
    {.name = "lamella check SCENE", .argv = {LAMELLA_PROGRAM, "check", SCENE}},
    {.name = "lamella rve SCENE", .argv = {LAMELLA_PROGRAM, "rve", SCENE}},
    {.name = "lamella rve SCENE -o OUT.h5", .argv = {LAMELLA_PROGRAM, "rve", SCENE, "-o", DATABASE}},
};
enum { NOTHING, HDF5, PETSC, STATES, VARIANTS = sizeof(Variants) / sizeof(Variants[0]) };

/* The states of the scene. */
static PetscErrorCode SolveStates(void)
{
  const LamMicrostructure micro = DefaultTissue();
  LamRVE rve;
  LamRVEState state;

  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &micro));
  PetscCall(LamRVESetWanted(rve, LAM_WANT_STRESS));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVEStateCreate(rve, &state));
  for (int k = 0; k < 3; k++) {
    const LamLoad load = PlaneLoad(1, 0.1 + 0.2 * k, 0, 1, 0.02 / TISSUE_STRESS);
    LamResponse response;

    PetscCall(LamRVESolve(rve, &load, state, &response));
  }
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

static int DoWhatIsNamed(int which, int argc, char **argv)
{
  if (which == HDF5) return H5dont_atexit() < 0 || H5open() < 0;
  if (which == NOTHING) return 0;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (which == STATES && SolveStates()) return 1;
  return PetscFinalize() ? 1 : 0;
}

static void Start(const Variant *variant, const char self[])
{
  const char *const again[] = {self, variant->name, NULL};

  dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0); /* as the program does for itself */
  setenv("OMPI_MCA_pml", "ob1", 0);
  execv(variant->argv[0] ? variant->argv[0] : self, (char *const *)(variant->argv[0] ? variant->argv : again));
  _exit(127);
}

/* One run; not 0 where it failed. */
static int Run(Variant *variant, const char self[], int round)
{
  const double begin = LamClock();
  struct rusage usage;
  pid_t child;
  int status;

  unlink(DATABASE);
  child = fork();
  if (child == 0) Start(variant, self);
  if (child < 0 || wait4(child, &status, 0, &usage) < 0 || !WIFEXITED(status) || WEXITSTATUS(status)) {
    fprintf(stderr, "%s: failed\n", variant->name);
    return 1;
  }
  variant->wall[round] = 1e3 * (LamClock() - begin);
  variant->processor[round] = 1e3 * (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                              1e-3 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  variant->memory[round] = 1e-3 * (double)usage.ru_maxrss;
  return 0;
}

static void Print(Variant *v)
{
  const double low = Quantile(v->wall, ROUNDS, 0.25), high = Quantile(v->wall, ROUNDS, 0.75);

  printf("%-42s %8.0f %6.0f to %4.0f %10.0f %10.1f\n", v->name, Quantile(v->wall, ROUNDS, 0.5), low, high,
         Quantile(v->processor, ROUNDS, 0.5), Quantile(v->memory, ROUNDS, 0.5));
}

int main(int argc, char **argv)
{
  for (int k = 0; k < VARIANTS && argc > 1; k++)
    if (!strcmp(argv[1], Variants[k].name)) return DoWhatIsNamed(k, 1, argv);
  for (int round = 0; round < ROUNDS; round++)
    for (int k = 0; k < VARIANTS; k++)
      if (Run(&Variants[k], argv[0], round)) return 1;
  unlink(DATABASE);
  printf("medians of %d; wall time with quartiles, ms; processor, ms; memory, MB\n", ROUNDS);
  printf("%-42s %8s %14s %10s %10s\n", "", "wall", "quartiles", "processor", "memory");
  for (int k = 0; k < VARIANTS; k++) Print(&Variants[k]);
  return 0;
}
