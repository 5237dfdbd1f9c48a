/*
  lamella manual: the manual page, made from the tables of options.

  Format: the macros of man(7).
*/
#include "app.h"
#include <string.h>

/* A character; those that mean something to roff are escaped. */
static void PrintCharacter(char c, PetscBool begins_line)
{
  if (begins_line && strchr(".'", c)) printf("\\&");
  if (c == '\\')
    printf("\\e");
  else if (c == '-')
    printf("\\-"); /* else a hyphen, which a reader cannot copy into a command */
  else
    putchar(c);
}

/* Text from the beginning of a line; blanks at the beginnings of its lines are dropped. */
static void PrintText(const char text[])
{
  for (const char *c = text; *c; c++) {
    const PetscBool begins = (PetscBool)(c == text || c[-1] == '\n');

    if (begins) c += strspn(c, " ");
    PrintCharacter(*c, begins);
  }
  putchar('\n');
}

static void PrintWord(const char font[], const char text[])
{
  printf("\\f%s", font);
  for (; *text; text++) PrintCharacter(*text, PETSC_FALSE);
  printf("\\fR");
}

static void PrintOption(char short_name, const char long_name[], const char argument[], const char help[])
{
  printf(".TP\n");
  if (short_name) printf("\\fB\\-%c\\fR, ", short_name);
  printf("\\fB\\-\\-\\fR");
  PrintWord("B", long_name);
  if (argument) putchar('=');
  if (argument) PrintWord("I", argument);
  putchar('\n');
  PrintText(help);
}

static void PrintCommand(void *ctx, const LamUsage *usage)
{
  (void)ctx;
  printf(".SS %s\n.nf\n.B lamella \\\n", usage->command);
  PrintText(usage->usage);
  printf(".fi\n.PP\n");
  PrintText(usage->summary);
  for (const LamOption *o = usage->options; o->long_name; o++)
    PrintOption(o->short_name, o->long_name, o->argument, o->help);
}

static void PrintStatuses(void)
{
#define STATUS(name, status, meaning) {status, meaning},
  static const struct {
    int status;
    const char *meaning;
  } statuses[] = {LAM_EXITS(STATUS)};

  printf(".SH EXIT STATUS\n");
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(statuses); i++) {
    printf(".TP\n.B %d\n", statuses[i].status);
    PrintText(statuses[i].meaning);
  }
}

PetscErrorCode LamCommandManual(LamArgs *args, int *exit_status)
{
  const LamOption none[] = {{0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "manual", "Prints the manual page: lamella manual | man -l -", none, 0, NULL, &done,
                            exit_status));
  if (done) PetscFunctionReturn(0);
  printf(".TH LAMELLA 1 \"\" \"lamella " LAMELLA_VERSION "\" \"User Commands\"\n.SH NAME\nlamella \\- ");
  PrintText(LAM_PROGRAM_SUMMARY);
  printf(".SH SYNOPSIS\n.B lamella\n");
  PrintText(LAM_PROGRAM_USAGE);
  printf(".SH DESCRIPTION\n");
  PrintText("Options may stand before or after file names, and a long name may be shortened where it stays unique. "
            "What follows -- goes to PETSc.");
  printf(".PP\nThe documents are in share/doc/lamella of the installation: docs/tutorial.md and docs/reference.\n");
  PrintOption('h', "help", NULL, "of lamella and of each command: what it does, and its options");
  PrintOption('V', "version", NULL, "the versions of lamella and of the libraries");
  printf(".SH COMMANDS\n");
  PetscCall(LamProgramVisit(PrintCommand, NULL));
  PrintStatuses();
  PetscFunctionReturn(0);
}
