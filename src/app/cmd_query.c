/*
  lamella query: responses from a database. Never solves, needs no MPI.
*/
#include "app.h"
#include "query_source.h"
#include <lamella/ellipticity.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  const char *deformation, *turgor, *cohesion;
  PetscBool tangent;
  LamConsole console;
  LamQuerySource from;
  PetscReal accuracy; /* 0: the scene's */
  LamLoad defaults;   /* turgor and cohesion of queries that do not give them */
  PetscInt answered, refused;
} Query;

static PetscReal Accuracy(const Query *q)
{
  return q->accuracy > 0 ? q->accuracy : q->from.accuracy;
}

static PetscErrorCode Respond(Query *q, const LamLoad *load)
{
  const PetscInt state = q->answered + q->refused + 1;
  LamResponse response;
  json_t *object;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseQuery(q->from.database, load, Accuracy(q), &response));
  if (LamResponseHasFields(&response)) LamResponseFindBand(&response);
  if (response.status == LAM_CONVERGED)
    q->answered++;
  else
    q->refused++;
  if (!q->console.json) {
    PetscCall(LamPrintResponseRow(&response, &q->from.scales, q->from.micro.interface, state));
    PetscFunctionReturn(0);
  }
  PetscCall(LamResponseToJSON(&response, &q->from.scales, state, q->tangent, &object));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

/* Responds to one line of standard input; skips empty lines and those that begin with #. */
static PetscErrorCode QueryLine(Query *q, PetscInt number, char line[])
{
  char problem[LAM_PROBLEM_LENGTH];
  LamLoad load = q->defaults;
  const char *text = line + strspn(line, " \t\r\n");

  PetscFunctionBeginUser;
  if (!*text || *text == '#') PetscFunctionReturn(0);
  PetscCheck(LamQueryParse(text, &q->from.scales, &load, problem), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "standard input, line %" PetscInt_FMT ": %s", number, problem);
  PetscCall(Respond(q, &load));
  PetscFunctionReturn(0);
}

static PetscErrorCode QueryInput(Query *q)
{
  /* rows that appear on the terminal are the progress */
  const LamReporter reporter = isatty(STDOUT_FILENO) ? (LamReporter){0} : LamConsoleReporter(&q->console);
  PetscErrorCode ierr = 0;
  size_t capacity = 0;
  char *line = NULL;

  PetscFunctionBeginUser;
  LamActivitySet("lines");
  for (PetscInt number = 1; !ierr && getline(&line, &capacity, stdin) >= 0; number++) {
    ierr = QueryLine(q, number, line);
    if (!ierr) ierr = LamReportProgress(&reporter, q->answered + q->refused, 0, 0);
  }
  LamConsoleClear();
  free(line);
  PetscCall(ierr);
  PetscCheck(!ferror(stdin), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "standard input: %s", strerror(errno));
  PetscFunctionReturn(0);
}

/* ---- command-line values: errors there are usage errors ---- */

static PetscBool ReadStress(const Query *q, const char option[], const char text[], PetscReal *stress, int *exit_status)
{
  PetscReal pascal;

  if (!text) return PETSC_TRUE;
  if (LamQuantityParse(text, LAM_DIMENSION_STRESS, &pascal))
    return LamUsageError("query", exit_status, "%s \"%s\": a stress with its unit is wanted, such as \"0.02 MPa\"",
                         option, text);
  *stress = pascal / q->from.scales.stress;
  return PETSC_TRUE;
}

/* *load: the query, unless queries come from standard input. */
static PetscBool ReadValues(Query *q, LamLoad *load, int *exit_status)
{
  char problem[LAM_PROBLEM_LENGTH];

  q->defaults = (LamLoad){.turgor = q->from.turgor, .cohesion = q->from.cohesion};
  if (!ReadStress(q, "-p", q->turgor, &q->defaults.turgor, exit_status)) return PETSC_FALSE;
  if (!ReadStress(q, "-g", q->cohesion, &q->defaults.cohesion, exit_status)) return PETSC_FALSE;
  *load = q->defaults;
  if (!strcmp(q->deformation, "-") || LamQueryParse(q->deformation, &q->from.scales, load, problem)) return PETSC_TRUE;
  return LamUsageError("query", exit_status, "-F \"%s\": %s", q->deformation, problem);
}

/* ---- human-readable output ---- */

/* Prints values that the query did not give and that were taken from the file. */
static void PrintDefaults(const Query *q)
{
  const PetscReal MPa = 1e-6 * q->from.scales.stress;

  printf("accuracy %.3g %%%s", (double)(100 * Accuracy(q)), q->accuracy > 0 ? "" : ", the scene's");
  if (!q->turgor)
    printf("; turgor where not given %.4g MPa, %s", (double)(q->defaults.turgor * MPa), q->from.turgor_origin);
  if (!q->cohesion && LamCellsPart(q->from.micro.interface))
    printf("; cohesion %.4g MPa, %s", (double)(q->defaults.cohesion * MPa), q->from.cohesion_origin);
  putchar('\n');
}

static PetscErrorCode Run(Query *q, int *exit_status)
{
  LamLoad load;

  PetscFunctionBeginUser;
  if (!ReadValues(q, &load, exit_status)) PetscFunctionReturn(0);
  if (!q->console.json) PetscCall(LamPrintResponseHeader(q->from.micro.interface, LAM_SOURCE_DATABASE));
  if (strcmp(q->deformation, "-"))
    PetscCall(Respond(q, &load));
  else
    PetscCall(QueryInput(q));
  if (!q->console.json) PrintDefaults(q);
  *exit_status = q->refused ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandQuery(LamArgs *args, int *exit_status)
{
  Query q = {.console = {.command = "query"}};
  PetscBool done;
  const char *path;
  const LamOption options[] = {
      {'F', "deformation", LAM_OPTION_TEXT, "\"F11 F12 F21 F22\"",
       "4 or 9 numbers, row-major, and behind them, if wanted, turgor and cohesion with their units; -: lines of "
       "standard input",
       &q.deformation},
      {'p', "turgor", LAM_OPTION_TEXT, "PRESSURE",
       "turgor of questions that do not say it, \"0.02 MPa\"; else that of the scene, or of all records", &q.turgor},
      {'g', "cohesion", LAM_OPTION_TEXT, "STRESS", "cohesion of contact tissue, likewise, \"0.001 MPa\"", &q.cohesion},
      {0, "accuracy", LAM_OPTION_ACCURACY, "ERROR",
       "relative error of P that a response may have by its estimate, 0.01; inf: any; by default the scene's",
       &q.accuracy},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per response on stdout", &q.console.json},
      {0, "tangent", LAM_OPTION_FLAG, NULL, "the 81 numbers of the tangent too (with --json)", &q.tangent},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &q.console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "query DB.h5 -F \"1 0.1 0 1\" [-p \"0.02 MPa\"] [-g \"0.001 MPa\"] [--accuracy ERROR] "
                            "[--json] [--tangent] [--quiet]",
                            "Responds from a database; never solves.", options, 1, &path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (!q.deformation &&
      !LamUsageError("query", exit_status,
                     "the deformation gradient is missing; give -F \"1 0.1 0 1\", or -F - for lines of standard input"))
    PetscFunctionReturn(0);
  PetscCall(LamQuerySourceOpen(path, &q.from));
  PetscCall(Run(&q, exit_status));
  PetscCall(LamQuerySourceClose(&q.from));
  PetscFunctionReturn(0);
}
