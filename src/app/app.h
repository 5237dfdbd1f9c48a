/*
  The program `lamella`: what its commands share. The only part that depends on the RVE solver, the database and the
  macroscale solver at once.
*/
#ifndef LAM_APP_H
#define LAM_APP_H

#include "failure.h"
#include "mechanical_test.h"
#include "plan.h"
#include "study.h"
#include "tradeoff.h"

/* Exit statuses, and what the manual says of them. */
#define LAM_EXITS(X)                                                                                                   \
  X(LAM_EXIT_OK, 0, "all solved")                                                                                      \
  X(LAM_EXIT_USAGE, 1, "wrong usage")                                                                                  \
  X(LAM_EXIT_INPUT, 2, "the scene or an input file is wrong; the message names file, line, column, key and value")     \
  X(LAM_EXIT_UNSOLVED, 3,                                                                                              \
    "some states did not converge, are outside a database, or could not be verified; a fit misses its data; the "      \
    "others are written, the failed ones with their reason")                                                           \
  X(LAM_EXIT_IO, 4,                                                                                                    \
    "input or output failed: a file that is missing, locked or cannot be written, a full disk, a closed pipe")         \
  X(LAM_EXIT_FAULT, 70, "an internal error, with its trace, or no memory left")                                        \
  X(LAM_EXIT_INTERRUPTED, 130, "stopped by SIGINT")                                                                    \
  X(LAM_EXIT_TERMINATED, 143, "stopped by SIGTERM or SIGUSR1")
#define LAM_EXIT_ENTRY(name, status, meaning) name = status,
enum { LAM_EXITS(LAM_EXIT_ENTRY) };

/* What a command says of itself, for shells and the manual. */
typedef struct LamUsage_s LamUsage;
typedef void (*LamUsageVisitor)(void *ctx, const LamUsage *usage);

/* The command line of one command: argv[0] is the command's name; arguments after `--` are passed to PETSc. */
typedef struct LamArgs_s {
  int argc;
  char **argv;
  int petsc_argc; /* petsc_argv[0] is the program's name */
  char **petsc_argv;
  /* Starts MPI and PETSc. A command that solves calls it after parsing its command line. */
  PetscErrorCode (*start)(struct LamArgs_s *args);
  LamUsageVisitor visit; /* not NULL: the command shows its usage to it, and does nothing else */
  void *ctx;             /* of `visit` */
} LamArgs;

/* A command: returns an error of the library, or sets the exit status. */
typedef PetscErrorCode (*LamCommandFunction)(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandCheck(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandRVE(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandBuild(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandQuery(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandVerify(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandFE2(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandTradeoff(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandMap(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandProcess(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandTear(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandMerge(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandTissue(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandCalibrate(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandSensitivity(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandValidate(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandPlot(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandInfo(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandCompletion(LamArgs *args, int *exit_status);
PetscErrorCode LamCommandManual(LamArgs *args, int *exit_status);

/* ---- program.c ---- */
#define LAM_PROGRAM_USAGE "COMMAND [ARGUMENTS] [-- PETSC-OPTIONS]"
#define LAM_PROGRAM_SUMMARY "effective stress, tangent and debonding of fruit and plant tissue from its cell walls"
/* Finds the command and runs it. argv[0] is the program's name; arguments after `--` are for PETSc alone.
   `start`: of LamArgs. */
PetscErrorCode LamProgramRun(int argc, char *argv[], PetscErrorCode (*start)(LamArgs *args), int *exit_status);
/* The usage of each command, in the order of the help. */
PetscErrorCode LamProgramVisit(LamUsageVisitor visit, void *ctx);

/* ---- runtime.c ---- */
/* Call first: sets up streams, signals and the handler that stores the message of an error. */
PetscErrorCode LamRuntimeBegin(void);
/* Reports the error `code` on stderr; *status is its exit status. */
void LamRuntimeReport(PetscErrorCode code, int *status);
/* Call last: reports the error `code`, once among all ranks; *status is the exit status. */
void LamRuntimeEnd(PetscErrorCode code, int *status);
/* Whether the command may run under mpirun; before it starts MPI. The launcher provides the ranks. */
void LamRuntimeExpectRanks(PetscBool expect);
/* `start` of LamArgs; LamRuntimeEnd finalises. */
PetscErrorCode LamRuntimeStart(LamArgs *args);
PetscBool LamAppIsRoot(void); /* rank 0, or no MPI */
/* The name closest to a misspelt one, NULL if none is close; names end with NULL. */
const char *LamSuggest(const char word[], const char *const names[]);
/* True if the only comma of a list of numbers may be a decimal one, as in "0,3": between digits, and no point anywhere.
 */
PetscBool LamListMayBeDecimal(const char text[]);

/* ---- options.c: GNU-style options from a table ---- */
typedef enum {
  LAM_OPTION_FLAG,     /* PetscBool */
  LAM_OPTION_TEXT,     /* const char *, borrowed */
  LAM_OPTION_ACCURACY, /* PetscReal above 0, or inf */
  LAM_OPTION_STATE,    /* PetscInt from 0 on, or LAM_STATE_LAST for "last" */
  LAM_OPTION_FROM_0,   /* PetscInt; this one and the next two: the least that is allowed */
  LAM_OPTION_FROM_1,
  LAM_OPTION_FROM_2
} LamOptionType;
enum { LAM_STATE_PEAK = -1, LAM_STATE_LAST = -2 };
typedef struct {
  char short_name; /* 0: none */
  const char *long_name;
  LamOptionType type;
  const char *argument; /* shown in the help: "OUT.h5" */
  const char *help;
  void *value; /* unchanged where the option is not given */
} LamOption;
struct LamUsage_s {
  const char *command;
  const char *usage;   /* the line after "Usage: lamella ", or several */
  const char *summary; /* a sentence */
  const LamOption *options;
};
/*
  Parses options (table ends with long_name NULL) and positional arguments. Their number must be exactly
  `positional_count`, or at least -positional_count if that is negative: `positional` then has room for args->argc of
  them. `usage` and `summary` as in LamUsage. *done is set if --help was printed, the usage was wrong (*exit_status
  differs) or args->visit has been called: the command then returns at once.
*/
PetscErrorCode LamOptionsParse(LamArgs *args, const char usage[], const char summary[], const LamOption options[],
                               int positional_count, const char *positional[], PetscBool *done, int *exit_status);
#define LAM_OVERWRITE_OPTION(overwrite)                                                                                \
  {                                                                                                                    \
    0, "overwrite", LAM_OPTION_FLAG, NULL, "replace files that Lamella did not write, too; never an input",            \
        &(overwrite)                                                                                                   \
  }
/* Whether -o is a name for an HDF5 file (NULL: not given). */
PetscBool LamOutputIsHDF5(const char command[], const char path[], int *exit_status);
/* Prints, on rank 0, what is wrong with the command line: "lamella COMMAND: ..."; returns PETSC_FALSE. */
PetscBool LamUsageError(const char command[], int *exit_status, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);

#define LAM_MOST_STRAINS 16
/* What --readings and --at ask for. */
typedef struct {
  PetscBool readings;
  const char *at; /* text of the strains; NULL: none */
  PetscInt count;
  PetscReal strain[LAM_MOST_STRAINS];
} LamTestOptions;

/* ---- console.c: messages of a study, and a line of its progress on stderr if it is a terminal ---- */
typedef struct {
  const char *command; /* "build" */
  PetscBool json, quiet;
  PetscBool warned; /* of localisation, once */
  LamTestOptions test;
} LamConsole;
LamReporter LamConsoleReporter(LamConsole *console); /* borrows it */
void LamConsoleClear(void);                          /* removes the line; call it before anything is printed */
/* After a signal, on rank 0: what is in the file of -o or -d (NULL: none), and how to go on. resumes: with --resume. */
void LamTellStopped(const LamConsole *console, const char path[], PetscBool resumes);
/* Exit status after a stop request, or `unsolved` or not; that of rank 0 on all ranks, as mpirun reports the largest.
 */
PetscErrorCode LamShareOutcome(PetscBool unsolved, int *exit_status);

/* ---- output.c ---- */
/* The JSON object of a solved state, in physical units. state < 0: no "state" member. The caller owns it. */
PetscErrorCode LamResponseToJSON(const LamResponse *response, const LamScales *scales, PetscInt state,
                                 PetscBool tangent, json_t **object);
PetscErrorCode LamPrintJSON(json_t *object); /* one line on stdout, rank 0; takes ownership */
/* Human-readable table of states on stdout, with additional columns for contact tissue and for database responses. */
PetscErrorCode LamPrintResponseHeader(LamInterfaceLawType interface, LamSource source);
PetscErrorCode LamPrintResponseRow(const LamResponse *response, const LamScales *scales, LamInterfaceLawType interface,
                                   PetscInt state);

/* A stress in C1 + C2, a force in (C1 + C2) times the macro length, or a share; 0 if it is rounding noise. */
PetscReal LamWithoutNoise(PetscReal value);
/* A number in a column of a table, with the notation 'e', 'f' or 'g' of printf; "-" if not known. */
void LamPrintColumn(int width, int decimals, char notation, PetscReal value);

/* ---- failure_print.c ---- */
/* Prints one line: stresses of walls and lamella in a state, relative to their strengths if these are given. */
void LamFailurePrintState(const LamResponse *response, const LamStrength *strength, const LamScales *scales);
/* {"cell": 0, "face": 0, "along": 0.06}; null if there is no place. */
json_t *LamPlaceToJSON(const PetscReal place[3]);
/* Prints one JSON object {"failure": {...}} or a few human-readable lines on stdout. */
PetscErrorCode LamFailurePrint(const LamFailure *failure, const LamScales *scales, PetscBool json);
/* Prints one JSON object {"onset": {...}} or a few human-readable lines on stdout. */
PetscErrorCode LamOnsetPrint(const LamOnset *onset, const LamScales *scales, PetscBool json);

/* ---- test_print.c ---- */
#define LAM_TEST_OPTIONS(options, when)                                                                                \
  {0, "readings", LAM_OPTION_FLAG, NULL, "modulus, peak and energy, read off the curve" when, &(options).readings},    \
  {                                                                                                                    \
    0, "at", LAM_OPTION_TEXT, "STRAIN,...", "moduli at these strains of the curve, too (includes --readings)",         \
        &(options).at                                                                                                  \
  }
/* Reads what --at says; PETSC_FALSE: it is something else, as LamUsageError has said. */
PetscBool LamTestReadOptions(const char command[], LamTestOptions *options, int *exit_status);
/* {"F": [...], "P": [...]}, as LamTestMeasures gives them. */
json_t *LamFromInflatedToJSON(const PetscReal F[9], const PetscReal P[9], const LamScales *scales);
/* What is read off the curve of a mechanical test, and its moduli at strains; in JSON one object, none without a curve.
 */
PetscErrorCode LamTestPrint(const LamTest *test, const LamTestOptions *options, PetscBool json);

/* ---- cmd_plot.c ---- */
/* The names that `plot --field` knows, by kind of file: some occur in several. */
void LamPlotVisitFields(void (*visit)(void *ctx, const char name[]), void *ctx);

/* ---- python.c ---- */
/* A part of the package in python/. */
typedef struct {
  const char *module;  /* "lamella.plot.__main__", whose function main takes the request */
  const char *need;    /* "pictures need": how messages about what is missing begin */
  const char *package; /* of Python, besides NumPy */
} LamPython;
extern const LamPython LamPythonPlot, LamPythonTissue, LamPythonCalibrate, LamPythonSensitivity, LamPythonRealisations,
    LamPythonUncertainty, LamPythonValidate;
/* Has it do what the request asks for, a JSON object. Takes ownership of the request. *exit_status is that of the
   Python process, which has said what is wrong. PETSC_ERR_FILE_OPEN: there is no Python. */
PetscErrorCode LamPythonRun(const LamPython *run, json_t *request, int *exit_status);
/* Whether a study that runs the command many times, each in a process of its own, may begin; otherwise says why not.
   study: its option; unused: the name of an option that is given and does not go with it, or NULL. */
PetscBool LamPythonStudyFits(const char command[], const char study[], const char unused[], int *exit_status);

/* ---- fe2_report.c ---- */
/* Human-readable summary of an FE2 run, from the JSON object that its file holds. */
void LamSummaryPrint(const json_t *summary);

/* ---- signals.c: SIGINT, SIGTERM, SIGUSR1 request the study to commit and stop (stop.h) ---- */
PetscErrorCode LamSignalsInstall(void);
void LamFaultsReport(void);  /* SIGSEGV and SIGBUS print a message before they end the program */
int LamStopExitStatus(void); /* after a signal; else LAM_EXIT_OK */

#endif
