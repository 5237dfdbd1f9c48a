/*
  lamella query: answers from a database. Never solves, needs no MPI.
*/
#include "app.h"
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *deformation, *turgor, *cohesion, *radius_text;
  PetscBool json, tangent;
  LamDatabase database;
  LamScales scales;
  LamInterfaceLawType interface;
  PetscReal default_turgor, default_cohesion, radius, accuracy;
  PetscInt answered, refused;
} Query;

static PetscBool IsGap(char c)
{
  return (PetscBool)(isspace((unsigned char)c) || c == ',');
}

/* 4 numbers (plane strain) or 9, row-major, separated by blanks or commas. Tells what is wrong in `problem`. */
static PetscBool ParseDeformation(const char text[], PetscReal F[9], char problem[128])
{
  PetscReal numbers[9];
  int n = 0;

  for (const char *at = text;;) {
    char *end;

    while (IsGap(*at)) at++;
    if (!*at) break;
    if (n == 9) {
      PetscSNPrintf(problem, 128, "more than 9 numbers");
      return PETSC_FALSE;
    }
    numbers[n] = strtod(at, &end);
    if (end == at || (*end && !IsGap(*end))) {
      PetscSNPrintf(problem, 128, "\"%.20s\" is no number", at);
      return PETSC_FALSE;
    }
    n++;
    at = end;
  }
  if (n != 4 && n != 9) {
    PetscSNPrintf(problem, 128, "%d number%s", n, n == 1 ? "" : "s");
    return PETSC_FALSE;
  }
  for (int i = 0; i < 9; i++) F[i] = n == 9 ? numbers[i] : i == 8;
  for (int i = 0; n == 4 && i < 4; i++) F[3 * (i / 2) + i % 2] = numbers[i];
  return PETSC_TRUE;
}

static PetscErrorCode Answer(Query *q, const LamLoad *load)
{
  const PetscInt state = q->answered + q->refused + 1;
  LamResponse response;
  json_t *object;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseQuery(q->database, load, q->radius, &response));
  if (response.status == LAM_CONVERGED)
    q->answered++;
  else
    q->refused++;
  if (!q->json) {
    PetscCall(LamPrintResponseRow(&response, &q->scales, q->interface, state));
    PetscFunctionReturn(0);
  }
  PetscCall(LamResponseToJSON(&response, &q->scales, state, q->tangent, &object));
  PetscCall(LamPrintJSON(object));
  PetscFunctionReturn(0);
}

/* Takes what stands behind the last semicolon of a line off; NULL: there is none. */
static char *CutLast(char line[])
{
  char *semicolon = strrchr(line, ';');

  if (!semicolon) return NULL;
  *semicolon = '\0';
  return semicolon + 1;
}

/* A stress with its unit, as "0.02 MPa". */
static PetscErrorCode ReadPressure(const Query *q, const char text[], PetscReal *pressure)
{
  PetscReal pascal;

  PetscFunctionBeginUser;
  PetscCall(LamQuantityParse(text, LAM_DIMENSION_STRESS, &pascal));
  *pressure = pascal / q->scales.stress;
  PetscFunctionReturn(0);
}

/* One line of stdin: numbers, and behind semicolons a turgor and a cohesion. Empty lines are passed over. */
static PetscErrorCode AnswerLine(Query *q, PetscInt number, char line[])
{
  LamLoad load = {.turgor = q->default_turgor, .cohesion = q->default_cohesion};
  char *first, *second, problem[128];

  PetscFunctionBeginUser;
  line[strcspn(line, "\r\n")] = '\0';
  if (line[strspn(line, " \t")] == '\0') PetscFunctionReturn(0);
  second = CutLast(line);
  first = CutLast(line);
  if (first) PetscCall(ReadPressure(q, second, &load.cohesion));
  if (second) PetscCall(ReadPressure(q, first ? first : second, &load.turgor));
  PetscCheck(ParseDeformation(line, load.F, problem), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "standard input, line %" PetscInt_FMT
             ": %s; 4 or 9 numbers are wanted, such as 1 0.1 0 1 ; 0.02 MPa, and for contact tissue "
             "a second ; with a cohesion",
             number, problem);
  PetscCall(Answer(q, &load));
  PetscFunctionReturn(0);
}

static PetscErrorCode AnswerInput(Query *q)
{
  PetscErrorCode ierr = 0;
  size_t capacity = 0;
  char *line = NULL;

  PetscFunctionBeginUser;
  for (PetscInt number = 1; !ierr && getline(&line, &capacity, stdin) >= 0; number++)
    ierr = AnswerLine(q, number, line);
  free(line);
  PetscCall(ierr);
  PetscCheck(!ferror(stdin), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "standard input: %s", strerror(errno));
  PetscFunctionReturn(0);
}

/* ---- the command line's values: mistakes there are mistakes of usage ---- */

static PetscBool UsageError(const char option[], const char value[], const char problem[], int *exit_status)
{
  fprintf(stderr, "lamella query: %s \"%s\": %s\n", option, value, problem);
  *exit_status = LAM_EXIT_USAGE;
  return PETSC_FALSE;
}

static PetscBool ReadValues(Query *q, LamLoad *load, int *exit_status)
{
  char problem[128], wanted[200], *end;

  if (!q->deformation) {
    fprintf(stderr, "lamella query: the deformation gradient is missing; give -F \"1 0.1 0 1\", or -F - for lines of "
                    "standard input\n");
    *exit_status = LAM_EXIT_USAGE;
    return PETSC_FALSE;
  }
  if (strcmp(q->deformation, "-") && !ParseDeformation(q->deformation, load->F, problem)) {
    snprintf(wanted, sizeof(wanted), "%s; 4 or 9 numbers are wanted, such as \"1 0.1 0 1\"", problem);
    return UsageError("-F", q->deformation, wanted, exit_status);
  }
  if (q->turgor && ReadPressure(q, q->turgor, &q->default_turgor))
    return UsageError("-p", q->turgor, "a pressure with its unit is wanted, such as \"0.02 MPa\"", exit_status);
  if (q->cohesion && ReadPressure(q, q->cohesion, &q->default_cohesion))
    return UsageError("-g", q->cohesion, "a stress with its unit is wanted, such as \"0.001 MPa\"", exit_status);
  load->turgor = q->default_turgor;
  load->cohesion = q->default_cohesion;
  q->radius = q->accuracy;
  if (q->radius_text) {
    q->radius = strtod(q->radius_text, &end);
    if (end == q->radius_text || *end || !(q->radius >= 0))
      return UsageError("--radius", q->radius_text, "a strain is wanted, such as 0.04", exit_status);
  }
  return PETSC_TRUE;
}

/* The cohesion of all records, 0 where they differ. */
static PetscErrorCode CommonCohesion(LamDatabase database, PetscReal *cohesion)
{
  const LamResponse *records;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(database, &n, &records, NULL));
  *cohesion = n ? records[0].load.cohesion : 0;
  for (PetscInt i = 1; i < n; i++)
    if (records[i].load.cohesion != records[0].load.cohesion) *cohesion = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(Query *q, const char path[])
{
  LamMicrostructure micro;
  char kind[LAM_NAME_LENGTH];
  const char *text;
  json_t *info;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadKind(path, kind));
  PetscCheck(!strcmp(kind, "database") || !strcmp(kind, "rve"), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\"; a response database is wanted, as lamella build writes it", path, kind);
  PetscCall(LamDatabaseOpen(path, &q->database));
  PetscCall(LamDatabaseGetMicrostructure(q->database, &micro, &q->scales, NULL));
  PetscCheck(!micro.is_patch, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds states of a patch between grips, a body whose answer is its own and no material point's; query "
             "a file of periodic cells (rve.cells), or solve the patch with lamella rve",
             path);
  q->interface = micro.interface;
  PetscCall(CommonCohesion(q->database, &q->default_cohesion));
  PetscCall(LamDatabaseGetInfo(q->database, &text));
  info = json_loads(text, 0, NULL);
  q->accuracy = json_number_value(json_object_get(info, "accuracy"));
  json_decref(info);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandQuery(LamArgs *args, int *exit_status)
{
  Query q = {0};
  LamLoad load = {0};
  PetscBool done;
  const char *path;
  const LamOption options[] = {
      {'F', "deformation", LAM_OPTION_TEXT, "\"F11 F12 F21 F22\"",
       "4 or 9 numbers, row-major; -: lines of standard input", &q.deformation},
      {'p', "turgor", LAM_OPTION_TEXT, "PRESSURE", "turgor with its unit, \"0.02 MPa\"; 0 where not given", &q.turgor},
      {'g', "cohesion", LAM_OPTION_TEXT, "STRESS",
       "cohesion of contact tissue with its unit, \"0.001 MPa\"; where not given that of the records, 0 if they differ",
       &q.cohesion},
      {0, "radius", LAM_OPTION_TEXT, "STRAIN", "how far a record is trusted; by default after the file's accuracy",
       &q.radius_text},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per answer on stdout", &q.json},
      {0, "tangent", LAM_OPTION_FLAG, NULL, "the 81 numbers of the tangent too (with --json)", &q.tangent},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args,
                            "query DB.h5 -F \"1 0.1 0 1\" [-p \"0.02 MPa\"] [-g \"0.001 MPa\"] [--json] [--tangent]",
                            "Answers from a response database; never solves.", options, 1, &path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  PetscCall(Open(&q, path));
  if (ReadValues(&q, &load, exit_status)) {
    if (!q.json) PetscCall(LamPrintResponseHeader(q.interface));
    if (strcmp(q.deformation, "-"))
      PetscCall(Answer(&q, &load));
    else
      PetscCall(AnswerInput(&q));
    *exit_status = q.refused ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
  }
  PetscCall(LamDatabaseClose(&q.database));
  PetscFunctionReturn(0);
}
