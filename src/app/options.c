/*
  Command line of a command: GNU conventions by getopt_long; the help is generated from the same table.
*/
#include "app.h"
#include "word_distance.h"
#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_OPTIONS = 24, HELP_COLUMN = 28, HELP_WIDTH = 96 };

const char *LamSuggest(const char word[], const char *const names[])
{
  const char *best = NULL;
  PetscInt least = (PetscInt)PetscMax(1, strlen(word) / 2) + 1;

  for (; *names; names++) {
    const PetscInt distance = LamWordDistance(word, *names);

    if (distance >= least) continue;
    least = distance;
    best = *names;
  }
  return best;
}

/* ---- help ---- */

/* Prints text wrapped from column HELP_COLUMN; the cursor is at `column`. */
static void PrintWrapped(int column, const char text[])
{
  if (column >= HELP_COLUMN) {
    putchar('\n');
    column = 0;
  }
  printf("%*s", HELP_COLUMN - column, "");
  column = HELP_COLUMN;
  while (*text) {
    const int length = (int)strcspn(text, " ");

    if (column > HELP_COLUMN && column + 1 + length > HELP_WIDTH) {
      printf("\n%*s", HELP_COLUMN, "");
      column = HELP_COLUMN;
    }
    column += printf("%s%.*s", column > HELP_COLUMN ? " " : "", length, text);
    text += length;
    text += strspn(text, " ");
  }
  putchar('\n');
}

static void PrintOption(char short_name, const char long_name[], const char argument[], const char help[])
{
  int column = short_name ? printf("  -%c, ", short_name) : printf("      ");

  column += printf("--%s", long_name);
  if (argument) column += printf("=%s", argument);
  PrintWrapped(column, help);
}

static void PrintHelp(const char usage[], const char summary[], const LamOption options[])
{
  printf("Usage: lamella %s\n%s\n\n", usage, summary);
  for (const LamOption *o = options; o->long_name; o++) PrintOption(o->short_name, o->long_name, o->argument, o->help);
  PrintOption('h', "help", NULL, "this text");
}

/* ---- parsing ---- */

/* Input of getopt_long; the value returned for a long option is its number in the table plus 256. */
typedef struct {
  char letters[3 * MOST_OPTIONS + 4];
  struct option names[MOST_OPTIONS + 2];
} Getopt;

static PetscErrorCode Translate(const LamOption options[], Getopt *g)
{
  char *letter = g->letters;
  int n = 0;

  PetscFunctionBeginUser;
  *letter++ = ':'; /* distinguishes a missing value from an unknown option */
  for (; options[n].long_name; n++) {
    const int takes = options[n].type == LAM_OPTION_TEXT ? required_argument : no_argument;

    PetscCheck(n < MOST_OPTIONS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "more than %d options", MOST_OPTIONS);
    g->names[n] = (struct option){options[n].long_name, takes, NULL, 256 + n};
    if (!options[n].short_name) continue;
    *letter++ = options[n].short_name;
    if (takes == required_argument) *letter++ = ':';
  }
  *letter++ = 'h';
  *letter = '\0';
  g->names[n] = (struct option){"help", no_argument, NULL, 'h'};
  g->names[n + 1] = (struct option){NULL, 0, NULL, 0};
  PetscFunctionReturn(0);
}

static void UsageHint(const char command[])
{
  if (LamAppIsRoot()) fprintf(stderr, "Try 'lamella %s --help'.\n", command);
}

/* Reports an option that is unknown or lacks its value. */
static void TellWrongOption(const LamArgs *args, int code, const Getopt *g)
{
  const char *command = args->argv[0], *text = args->argv[optind - 1], *names[MOST_OPTIONS + 2], *near;
  int n = 0;

  if (!LamAppIsRoot()) return;
  for (; g->names[n].name; n++) names[n] = g->names[n].name;
  names[n] = NULL;
  if (optopt && optopt < 256)
    fprintf(stderr, "lamella %s: option '-%c' %s\n", command, optopt, code == ':' ? "needs a value" : "is unknown");
  else if (optopt)
    fprintf(stderr, "lamella %s: option '%s' %s\n", command, text, code == ':' ? "needs a value" : "takes no value");
  else {
    near = LamSuggest(text + strspn(text, "-"), names);
    fprintf(stderr, "lamella %s: option '%s' is unknown or ambiguous", command, text);
    if (near) fprintf(stderr, "; did you mean '--%s'?", near);
    fputc('\n', stderr);
  }
}

static int IndexOf(const LamOption options[], int code)
{
  int n = 0;

  if (code >= 256) return code - 256;
  while (options[n].short_name != code) n++;
  return n;
}

/* PETSC_FALSE if the usage is wrong. */
static PetscBool ReadOptions(LamArgs *args, const LamOption options[], const Getopt *g, PetscBool *help)
{
  int code;

  optind = 0; /* GNU: restart scanning */
  opterr = 0;
  while ((code = getopt_long(args->argc, args->argv, g->letters, g->names, NULL)) != -1) {
    const LamOption *option;

    if (code == '?' || code == ':') {
      TellWrongOption(args, code, g);
      return PETSC_FALSE;
    }
    if (code == 'h') {
      *help = PETSC_TRUE;
      return PETSC_TRUE;
    }
    option = &options[IndexOf(options, code)];
    if (option->type == LAM_OPTION_FLAG) {
      *(PetscBool *)option->value = PETSC_TRUE;
    } else if (*optarg) {
      *(const char **)option->value = optarg;
    } else {
      if (LamAppIsRoot())
        fprintf(stderr, "lamella %s: option '--%s' needs a value\n", args->argv[0], option->long_name);
      return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

/* count < 0: at least -count. */
static PetscBool ReadPositional(const LamArgs *args, int count, const char *positional[])
{
  const int given = args->argc - optind;

  if (count < 0) count = PetscMax(-count, given);
  for (int i = 0; i < PetscMin(given, count); i++) positional[i] = args->argv[optind + i];
  if (given == count) return PETSC_TRUE;
  if (LamAppIsRoot()) {
    if (given < count)
      fprintf(stderr, "lamella %s: a file name is missing\n", args->argv[0]);
    else
      fprintf(stderr, "lamella %s: '%s' is one argument too many\n", args->argv[0], args->argv[optind + count]);
  }
  return PETSC_FALSE;
}

PetscErrorCode LamOptionsParse(LamArgs *args, const char usage[], const char summary[], const LamOption options[],
                               int positional_count, const char *positional[], PetscBool *done, int *exit_status)
{
  PetscBool help = PETSC_FALSE;
  Getopt g;

  PetscFunctionBeginUser;
  *done = PETSC_TRUE;
  PetscCall(Translate(options, &g));
  if (!ReadOptions(args, options, &g, &help)) {
    UsageHint(args->argv[0]);
    *exit_status = LAM_EXIT_USAGE;
  } else if (help) {
    if (LamAppIsRoot()) PrintHelp(usage, summary, options);
    *exit_status = LAM_EXIT_OK;
  } else if (!ReadPositional(args, positional_count, positional)) {
    UsageHint(args->argv[0]);
    *exit_status = LAM_EXIT_USAGE;
  } else {
    *done = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* ---- values ---- */

PetscBool LamUsageError(const char command[], const char option[], const char value[], const char problem[],
                        int *exit_status)
{
  if (LamAppIsRoot()) fprintf(stderr, "lamella %s: %s \"%s\": %s\n", command, option, value, problem);
  *exit_status = LAM_EXIT_USAGE;
  return PETSC_FALSE;
}

PetscBool LamAccuracyParse(const char command[], const char text[], PetscReal *accuracy, int *exit_status)
{
  char *end;

  if (!text) return PETSC_TRUE;
  *accuracy = strtod(text, &end);
  if (end != text && !*end && *accuracy > 0) return PETSC_TRUE;
  return LamUsageError(command, "--accuracy", text, "a relative error is wanted, such as 0.01, or inf for any",
                       exit_status);
}

PetscBool LamCountParse(const char command[], const char option[], const char text[], PetscInt least, PetscInt *count,
                        int *exit_status)
{
  char *end, wanted[64];
  long value;

  if (!text) return PETSC_TRUE;
  errno = 0;
  value = strtol(text, &end, 10);
  *count = (PetscInt)value;
  if (end != text && !*end && !errno && value >= least && value <= PETSC_MAX_INT) return PETSC_TRUE;
  snprintf(wanted, sizeof(wanted), "a whole number from %" PetscInt_FMT " on is wanted", least);
  return LamUsageError(command, option, text, wanted, exit_status);
}
