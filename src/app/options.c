/*
  Command line of a command: GNU conventions by getopt_long; the help is generated from the same table.
*/
#include "app.h"
#include "word_distance.h"
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <stdarg.h>
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

/* ---- values ---- */

PetscBool LamUsageError(const char command[], int *exit_status, const char format[], ...)
{
  va_list list;

  *exit_status = LAM_EXIT_USAGE;
  if (!LamAppIsRoot()) return PETSC_FALSE;
  fprintf(stderr, "lamella %s: ", command);
  va_start(list, format);
  vfprintf(stderr, format, list);
  va_end(list);
  fputc('\n', stderr);
  return PETSC_FALSE;
}

PetscBool LamOutputIsHDF5(const char command[], const char path[], int *exit_status)
{
  static const char *const others[] = {".csv", ".xdmf", ".json", ".yaml", ".yml", ".msh", ".png", ".svg", ".pdf"};
  const char *dot = path ? strrchr(path, '.') : NULL;

  for (size_t i = 0; dot && i < PETSC_STATIC_ARRAY_LENGTH(others); i++)
    if (!strcmp(dot, others[i]))
      return LamUsageError(command, exit_status, "-o %s: an HDF5 file is written there; name it %.*s.h5", path,
                           (int)(dot - path), path);
  return PETSC_TRUE;
}

static PetscBool ReadValue(const char command[], const LamOption *option, const char text[], int *exit_status)
{
  const int least = PetscMax(0, (int)option->type - LAM_OPTION_FROM_0);
  char *end;
  long count;

  switch (option->type) {
  case LAM_OPTION_FLAG:
    *(PetscBool *)option->value = PETSC_TRUE;
    return PETSC_TRUE;
  case LAM_OPTION_TEXT:
    *(const char **)option->value = text;
    return PETSC_TRUE;
  case LAM_OPTION_ACCURACY:
    *(PetscReal *)option->value = strtod(text, &end);
    if (!*end && *(PetscReal *)option->value > 0) return PETSC_TRUE;
    return LamUsageError(command, exit_status, "--%s \"%s\": a relative error is wanted, such as 0.01, or inf for any",
                         option->long_name, text);
  case LAM_OPTION_STATE:
    *(PetscInt *)option->value = LAM_STATE_LAST;
    if (!strcmp(text, "last")) return PETSC_TRUE; /* fallthrough */
  default:
    errno = 0;
    count = strtol(text, &end, 10);
    *(PetscInt *)option->value = (PetscInt)count;
    if (!*end && !errno && count >= least && count <= PETSC_MAX_INT) return PETSC_TRUE;
    return LamUsageError(command, exit_status, "--%s \"%s\": a whole number from %d on is wanted", option->long_name,
                         text, least);
  }
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
    const int takes = options[n].type == LAM_OPTION_FLAG ? no_argument : required_argument;

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

PetscBool LamListMayBeDecimal(const char text[])
{
  const char *comma = strchr(text, ',');

  return (PetscBool)(comma && isdigit((unsigned char)comma[1]) && !strchr(comma + 1, ',') && !strchr(text, '.'));
}

/* Reports an option that is unknown or lacks its value. */
static PetscBool ReportWrongOption(const LamArgs *args, int code, const Getopt *g, int *exit_status)
{
  const char *command = args->argv[0], *text = args->argv[optind - 1], *names[MOST_OPTIONS + 2], *near;
  const PetscBool lacks = (PetscBool)(code == ':');
  int n = 0;

  if (optopt && optopt < 256)
    return LamUsageError(command, exit_status, "option '-%c' %s", optopt, lacks ? "needs a value" : "is unknown");
  if (optopt)
    return LamUsageError(command, exit_status, "option '%s' %s", text, lacks ? "needs a value" : "takes no value");
  for (; g->names[n].name; n++) names[n] = g->names[n].name;
  names[n] = NULL;
  if (!strncmp(text, "--uncertainty", 13) || !strncmp(text, "--realisations", 14))
    return LamUsageError(command, exit_status, "option '%s' is of lamella rve%s; lamella %s does not take it", text,
                         text[2] == 'u' ? " and lamella process" : "", command);
  near = LamSuggest(text + strspn(text, "-"), names);
  return LamUsageError(command, exit_status, "option '%s' is unknown or ambiguous%s%s%s", text,
                       near ? "; did you mean '--" : "", near ? near : "", near ? "'?" : "");
}

static int IndexOf(const LamOption options[], int code)
{
  int n = 0;

  if (code >= 256) return code - 256;
  while (options[n].short_name != code) n++;
  return n;
}

/* PETSC_FALSE if the usage is wrong. */
static PetscBool ReadOptions(LamArgs *args, const LamOption options[], const Getopt *g, PetscBool *help,
                             int *exit_status)
{
  int code;

  optind = 0; /* GNU: restart scanning */
  opterr = 0;
  while ((code = getopt_long(args->argc, args->argv, g->letters, g->names, NULL)) != -1) {
    const LamOption *option;

    if (code == '?' || code == ':') return ReportWrongOption(args, code, g, exit_status);
    if (code == 'h') {
      *help = PETSC_TRUE;
      return PETSC_TRUE;
    }
    option = &options[IndexOf(options, code)];
    if (option->type != LAM_OPTION_FLAG && !*optarg)
      return LamUsageError(args->argv[0], exit_status, "option '--%s' needs a value", option->long_name);
    if (!ReadValue(args->argv[0], option, optarg, exit_status)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* count < 0: at least -count. */
static PetscBool ReadPositional(const LamArgs *args, int count, const char *positional[], int *exit_status)
{
  const int given = args->argc - optind;

  if (count < 0) count = PetscMax(-count, given);
  for (int i = 0; i < PetscMin(given, count); i++) positional[i] = args->argv[optind + i];
  if (given == count) return PETSC_TRUE;
  if (given < count) return LamUsageError(args->argv[0], exit_status, "a file name is missing");
  return LamUsageError(args->argv[0], exit_status, "'%s' is one argument too many", args->argv[optind + count]);
}

PetscErrorCode LamOptionsParse(LamArgs *args, const char usage[], const char summary[], const LamOption options[],
                               int positional_count, const char *positional[], PetscBool *done, int *exit_status)
{
  PetscBool help = PETSC_FALSE, right;
  Getopt g;

  PetscFunctionBeginUser;
  if (args->visit) args->visit(args->ctx, &(const LamUsage){args->argv[0], usage, summary, options});
  *done = (PetscBool)(args->visit != NULL);
  if (*done) PetscFunctionReturn(0);
  PetscCall(Translate(options, &g));
  right = ReadOptions(args, options, &g, &help, exit_status);
  if (right && !help) right = ReadPositional(args, positional_count, positional, exit_status);
  if (!right && LamAppIsRoot()) fprintf(stderr, "Try 'lamella %s --help'.\n", args->argv[0]);
  if (right && help && LamAppIsRoot()) PrintHelp(usage, summary, options);
  *done = (PetscBool)(!right || help);
  PetscFunctionReturn(0);
}
