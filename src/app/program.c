/*
  The command line as a whole: finds the command, or lists all.
*/
#include "app.h"
#include <hdf5.h>
#include <string.h>
#include <sundials/sundials_version.h>

static PetscErrorCode CommandHelp(LamArgs *args, int *exit_status);

static const struct {
  const char *name, *summary;
  LamCommandFunction run;
  PetscBool solves; /* runs under mpirun; the others need no MPI */
} Commands[] = {
    {"check", "read and check a scene; print the plan and its predicted cost", LamCommandCheck, PETSC_TRUE},
    {"rve", "solve the RVE along the scene's load", LamCommandRVE, PETSC_TRUE},
    {"build", "fill a response database", LamCommandBuild, PETSC_TRUE},
    {"query", "one response, or many, from a database", LamCommandQuery, PETSC_FALSE},
    {"verify", "solve part of a database's responses afresh and compare", LamCommandVerify, PETSC_TRUE},
    {"fe2", "solve the scene's macroscale problem", LamCommandFE2, PETSC_TRUE},
    {"tradeoff", "measure error against time over the scene's knobs", LamCommandTradeoff, PETSC_TRUE},
    {"process", "follow tissue that changes in time", LamCommandProcess, PETSC_TRUE},
    {"map", "how tissue fails over two of its quantities", LamCommandMap, PETSC_TRUE},
    {"tear", "the traction-separation law of a layer of tissue", LamCommandTear, PETSC_TRUE},
    {"merge", "make one database of several", LamCommandMerge, PETSC_FALSE},
    {"tissue", "make irregular cells by their statistics", LamCommandTissue, PETSC_FALSE},
    {"calibrate", "find values of a scene's keys from what was measured", LamCommandCalibrate, PETSC_FALSE},
    {"sensitivity", "how figures of a scene's test depend on its uncertain keys", LamCommandSensitivity, PETSC_FALSE},
    {"validate", "published experiments against what Lamella finds", LamCommandValidate, PETSC_FALSE},
    {"plot", "draw what a file holds", LamCommandPlot, PETSC_FALSE},
    {"info", "what a file holds, who wrote it, with what", LamCommandInfo, PETSC_FALSE},
    {"completion", "completion of command lines, for bash and zsh", LamCommandCompletion, PETSC_FALSE},
    {"manual", "the manual page", LamCommandManual, PETSC_FALSE},
    {"help", "what a command does, and its options", CommandHelp, PETSC_FALSE},
};
enum { COMMAND_COUNT = PETSC_STATIC_ARRAY_LENGTH(Commands) };

/* ---- help and versions ---- */

static void PrintHelp(FILE *out)
{
  fprintf(out, "Usage: lamella " LAM_PROGRAM_USAGE "\n" LAM_PROGRAM_SUMMARY "\n\n");
  for (int i = 0; i < COMMAND_COUNT; i++) fprintf(out, "  %-11s %s\n", Commands[i].name, Commands[i].summary);
  fprintf(out, "\nlamella help COMMAND shows more, lamella --version the versions of the libraries.\n");
}

static PetscErrorCode PrintVersion(void)
{
  char petsc[256], sundials[64], mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  unsigned major, minor, release;
  int length;

  PetscFunctionBeginUser;
  PetscCall(PetscGetVersion(petsc, sizeof(petsc)));
  PetscCheck(H5get_libversion(&major, &minor, &release) >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "HDF5 has no version");
  PetscCheck(!SUNDIALSGetVersion(sundials, sizeof(sundials)), PETSC_COMM_SELF, PETSC_ERR_LIB,
             "SUNDIALS has no version");
  PetscCallMPI(MPI_Get_library_version(mpi, &length));
  mpi[strcspn(mpi, ",\n")] = '\0'; /* the rest is about who packaged it */
  petsc[strcspn(petsc, ",")] = '\0';
  printf("lamella %s\nPETSc %s\nHDF5 %u.%u.%u\nSUNDIALS %s\nMPI %s\n", LAMELLA_VERSION,
         petsc + strcspn(petsc, "0123456789"), major, minor, release, sundials, mpi);
  PetscFunctionReturn(0);
}

/* ---- the command line ---- */

static void ReportUnknown(const char word[])
{
  const char *commands[COMMAND_COUNT + 1] = {NULL}, *const options[] = {"--help", "--version", NULL}, *near;

  for (int i = 0; i < COMMAND_COUNT; i++) commands[i] = Commands[i].name;
  near = LamSuggest(word, word[0] == '-' ? options : commands);
  fprintf(stderr, "lamella: %s '%s' is unknown", word[0] == '-' ? "option" : "command", word);
  if (near) fprintf(stderr, "; did you mean '%s'?", near);
  fprintf(stderr, "\nTry 'lamella --help'.\n");
}

static PetscErrorCode RunCommand(LamArgs *args, int *status)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < COMMAND_COUNT; i++) {
    if (strcmp(args->argv[0], Commands[i].name)) continue;
    LamRuntimeExpectRanks(Commands[i].solves);
    PetscCall(Commands[i].run(args, status));
    PetscFunctionReturn(0);
  }
  ReportUnknown(args->argv[0]);
  *status = LAM_EXIT_USAGE;
  PetscFunctionReturn(0);
}

/* `help COMMAND` is `COMMAND --help`. */
static PetscErrorCode CommandHelp(LamArgs *args, int *exit_status)
{
  static char help[] = "--help";
  const LamOption none[] = {{0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  const char *command;
  PetscBool done;

  PetscFunctionBeginUser;
  if (args->argc == 1 && !args->visit) {
    PrintHelp(stdout);
    PetscFunctionReturn(0);
  }
  PetscCall(LamOptionsParse(args, "help [COMMAND]", "Shows what a command does, and its options; lists the commands.",
                            none, 1, &command, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  char *argv[] = {(char *)command, help, NULL};
  LamArgs asked = {.argc = 2, .argv = argv, .start = args->start};
  PetscCall(RunCommand(&asked, exit_status));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProgramVisit(LamUsageVisitor visit, void *ctx)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < COMMAND_COUNT; i++) {
    char *argv[] = {(char *)Commands[i].name, NULL};
    LamArgs args = {.argc = 1, .argv = argv, .visit = visit, .ctx = ctx};
    int status;

    PetscCall(Commands[i].run(&args, &status));
  }
  PetscFunctionReturn(0);
}

/* Whether the word is the option, short or long. */
static PetscBool Is(const char word[], const char short_name[], const char long_name[])
{
  return (PetscBool)(!strcmp(word, short_name) || !strcmp(word, long_name));
}

PetscErrorCode LamProgramRun(int argc, char *argv[], PetscErrorCode (*start)(LamArgs *args), int *status)
{
  static char *program_only[2]; /* PETSc stores the address */
  LamArgs args = {.argv = argv + 1, .petsc_argc = 1, .petsc_argv = program_only, .start = start};

  PetscFunctionBeginUser;
  program_only[0] = argv[0];
  while (1 + args.argc < argc && strcmp(args.argv[args.argc], "--")) args.argc++;
  if (1 + args.argc < argc) {
    args.petsc_argc = argc - 1 - args.argc;
    args.petsc_argv = args.argv + args.argc;
    args.petsc_argv[0] = argv[0];
  }
  if (!args.argc) {
    PrintHelp(stderr);
    *status = LAM_EXIT_USAGE;
  } else if (Is(args.argv[0], "-h", "--help")) {
    PrintHelp(stdout);
  } else if (Is(args.argv[0], "-V", "--version")) {
    PetscCall(PrintVersion());
  } else {
    PetscCall(RunCommand(&args, status));
  }
  PetscFunctionReturn(0);
}
