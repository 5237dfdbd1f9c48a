/*
  lamella completion: scripts by which bash and zsh complete command lines, made from the tables of options.

  What completes a value follows from the word that stands for it in the help: OUT.h5 a file *.h5, SCENE a file *.yaml,
  DIR a folder, "bash|zsh" one of these words; the words of others are in the table below.
*/
#include "app.h"
#include "tear.h"
#include <ctype.h>
#include <string.h>
#include "names.h"

enum { WORDS = 4096 }; /* bytes for the names of all fields of pictures: three times what they take */

typedef struct {
  PetscBool files, folders, list; /* list: several of the words, between commas */
  char words[WORDS];              /* between blanks; of files their endings */
} Values;

/* ---- what completes a value ---- */

/* Adds a word unless it is there. */
static void AddWord(void *words, const char word[])
{
  char text[WORDS], wanted[LAM_NAME_LENGTH + 2];

  snprintf(text, sizeof(text), " %s ", (char *)words);
  snprintf(wanted, sizeof(wanted), " %s ", word);
  if (!strstr(text, wanted)) LamNamesAppend(WORDS, words, " ", word);
}

static void AddNames(char words[], int count, const char *const names[])
{
  for (int i = 0; i < count; i++) AddWord(words, names[i]);
}

static void AddCommand(void *words, const LamUsage *usage)
{
  AddWord(words, usage->command);
}

/* The parts of a text between bars; of each what follows its last dot. */
static void AddParts(char words[], const char text[])
{
  char part[LAM_NAME_LENGTH];

  for (const char *at = text; *at; at += strspn(at, "|")) {
    const int length = (int)strcspn(at, "|");
    const char *dot;

    snprintf(part, sizeof(part), "%.*s", length, at);
    dot = strrchr(part, '.');
    AddWord(words, dot ? dot + 1 : part);
    at += length;
  }
}

/* argument: the word of the help; NULL: none */
static PetscErrorCode FindValues(const char argument[], Values *v)
{
  const char *dot = argument ? strchr(argument, '.') : NULL;

  PetscFunctionBeginUser;
  *v = (Values){.files = PETSC_FALSE};
  if (!argument) PetscFunctionReturn(0);
  v->list = (PetscBool)(strstr(argument, ",...") != NULL);
  v->folders = (PetscBool)!strcmp(argument, "DIR");
  v->files = (PetscBool)(!strcmp(argument, "SCENE") || (dot && isalpha((unsigned char)dot[1])));
  if (!strcmp(argument, "SCENE")) {
    AddWord(v->words, "yaml");
  } else if (v->files || (strchr(argument, '|') && islower((unsigned char)argument[0]))) {
    AddParts(v->words, argument);
  } else if (!strcmp(argument, "TYPE")) {
    AddNames(v->words, LAM_FE2_DATABASE + 1, LamFE2ResponseNames);
  } else if (!strcmp(argument, "FAMILY,...")) {
    AddNames(v->words, LAM_KNOB_COUNT, LamKnobNames);
  } else if (!strcmp(argument, "MODE,...")) {
    AddNames(v->words, LAM_TEAR_MODE_COUNT, LamTearModeNames);
  } else if (!strcmp(argument, "NAME")) {
    LamPlotVisitFields(AddWord, v->words);
  } else if (!strcmp(argument, "COMMAND")) {
    PetscCall(LamProgramVisit(AddCommand, v->words));
  }
  PetscFunctionReturn(0);
}

/* The word for the first file in the usage: SCENE of "rve SCENE [-o OUT.h5]"; all others of the command are alike.
   Empty: there is none. */
static void FirstPositional(const LamUsage *usage, char word[LAM_NAME_LENGTH])
{
  const char *at = usage->usage + strcspn(usage->usage, " ");

  at += strspn(at, " [");
  snprintf(word, LAM_NAME_LENGTH, "%.*s", *at == '-' ? 0 : (int)strcspn(at, " ]"), at);
}

/* ---- bash ---- */

static const char BashHead[] =
    "# Completion of lamella for bash, made by \"lamella completion bash\".\n"
    "_lamella() {\n"
    "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' i\n"
    "  local options='' files='' folders='' words='' list=''\n"
    "  COMPREPLY=()\n"
    "  for ((i = 1; i < COMP_CWORD; i++)); do [ \"${COMP_WORDS[i]}\" != -- ] || return; done\n"
    "  [ \"$word\" != = ] || word=''\n"
    "  [ \"$before\" != = ] || before=${COMP_WORDS[COMP_CWORD - 2]}\n"
    "  [ \"$COMP_CWORD\" = 1 ] || command=${COMP_WORDS[1]}\n"
    "  case $command in\n";

static const char BashTail[] =
    "  esac\n"
    "  case $word in -*) [ -z \"$options\" ] || words=$options files='' folders='' list='' ;; esac\n"
    "  if [ -n \"$files$folders\" ]; then\n"
    "    compopt -o filenames 2>/dev/null\n"
    "    mapfile -t COMPREPLY < <(for i in $files; do compgen -f -X \"!*.$i\" -- \"$word\"; done\n"
    "                             compgen -d -- \"$word\")\n"
    "  elif [ -n \"$words\" ]; then\n"
    "    i=${word##*,}\n"
    "    [ -n \"$list\" ] && list=${word%\"$i\"} || i=$word\n"
    "    mapfile -t COMPREPLY < <(compgen -P \"$list\" -W \"$words\" -- \"$i\")\n"
    "  fi\n"
    "}\n"
    "complete -F _lamella lamella\n";

static void PrintBashValues(const Values *v)
{
  printf(" files='%s' words='%s' folders='%s' list='%s'", v->files ? v->words : "", v->files ? "" : v->words,
         v->folders ? "/" : "", v->list ? "," : "");
}

/* The options that take a value: what completes it. */
static PetscErrorCode PrintBashOption(const LamOption *o)
{
  Values v;

  PetscFunctionBeginUser;
  if (o->type == LAM_OPTION_FLAG) PetscFunctionReturn(0);
  PetscCall(FindValues(o->argument, &v));
  printf("    ");
  if (o->short_name) printf("-%c | ", o->short_name);
  printf("--%s) options=''", o->long_name);
  PrintBashValues(&v);
  printf(" ;;\n");
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintBashCommand(const LamUsage *usage)
{
  char word[LAM_NAME_LENGTH];
  Values v;

  PetscFunctionBeginUser;
  FirstPositional(usage, word);
  PetscCall(FindValues(word, &v));
  printf("  %s)\n    options='", usage->command);
  for (const LamOption *o = usage->options; o->long_name; o++) {
    if (o->short_name) printf("-%c ", o->short_name);
    printf("--%s ", o->long_name);
  }
  printf("-h --help'");
  PrintBashValues(&v);
  printf("\n    case $before in\n");
  for (const LamOption *o = usage->options; o->long_name; o++) PetscCall(PrintBashOption(o));
  printf("    esac\n    ;;\n");
  PetscFunctionReturn(0);
}

/* ---- zsh ---- */

static const char ZshHead[] = "#compdef lamella\n"
                              "# Completion of lamella for zsh, made by \"lamella completion zsh\".\n"
                              "_lamella() {\n"
                              "  (( ${words[(i)--]} < CURRENT )) && return\n"
                              "  if (( CURRENT == 2 )); then\n"
                              "    local -a commands=(\n";

static const char ZshMiddle[] = "    )\n"
                                "    _describe command commands\n"
                                "    _arguments '(- *)'{-h,--help}'[this text]' '(- *)'{-V,--version}'[versions]'\n"
                                "    return\n"
                                "  fi\n"
                                "  shift words\n"
                                "  (( CURRENT-- ))\n"
                                "  case $words[1] in\n";

static const char ZshTail[] = "  esac\n"
                              "}\n"
                              "if [ \"$funcstack[1]\" = _lamella ]; then _lamella; else compdef _lamella lamella; fi\n";

/* Text within '...', where the characters in `special` need a backslash. */
static void PrintQuoted(const char text[], const char special[])
{
  for (; *text; text++) {
    if (*text == '\'')
      printf("'\\''");
    else
      printf("%s%c", strchr(special, *text) ? "\\" : "", *text);
  }
}

static PetscErrorCode PrintZshValues(const char argument[])
{
  Values v;

  PetscFunctionBeginUser;
  PetscCall(FindValues(argument, &v));
  putchar(':');
  PrintQuoted(argument, ":\\");
  putchar(':');
  if (v.files) {
    printf("_files -g \"*.(|"); /* with a bar, as (h5) alone would be a glob qualifier */
    for (const char *c = v.words; *c; c++) putchar(*c == ' ' ? '|' : *c);
    printf(")\"");
  } else if (v.folders) {
    printf("_files -/");
  } else if (v.list) {
    printf("%s%s", v.words[0] ? "_values -s , word " : "", v.words);
  } else if (v.words[0]) {
    printf("(%s)", v.words);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintZshOption(const LamOption *o)
{
  const PetscBool takes = (PetscBool)(o->type != LAM_OPTION_FLAG);

  PetscFunctionBeginUser;
  printf(" \\\n      ");
  if (o->short_name)
    printf("'(-%c --%s)'{-%c%s,--%s%s}'", o->short_name, o->long_name, o->short_name, takes ? "+" : "", o->long_name,
           takes ? "=" : "");
  else
    printf("'--%s%s", o->long_name, takes ? "=" : "");
  putchar('[');
  PrintQuoted(o->help, "[]\\");
  putchar(']');
  if (takes) PetscCall(PrintZshValues(o->argument));
  putchar('\'');
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintZshCommand(const LamUsage *usage)
{
  char word[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  printf("  %s)\n    _arguments", usage->command);
  for (const LamOption *o = usage->options; o->long_name; o++) PetscCall(PrintZshOption(o));
  printf(" \\\n      '(- *)'{-h,--help}'[this text]'");
  FirstPositional(usage, word);
  if (word[0]) {
    printf(" \\\n      '*");
    PetscCall(PrintZshValues(word));
    putchar('\'');
  }
  printf("\n    ;;\n");
  PetscFunctionReturn(0);
}

static void PrintZshSummary(void *ctx, const LamUsage *usage)
{
  (void)ctx;
  printf("      '%s:", usage->command);
  PrintQuoted(usage->summary, "\\");
  printf("'\n");
}

/* ---- the command ---- */

typedef struct {
  PetscErrorCode (*print)(const LamUsage *usage);
  PetscErrorCode ierr; /* the first error of a print */
} Printer;

static void PrintUsage(void *ctx, const LamUsage *usage)
{
  Printer *printer = (Printer *)ctx;

  if (!printer->ierr) printer->ierr = printer->print(usage);
}

static PetscErrorCode PrintScript(PetscBool zsh)
{
  Printer printer = {zsh ? PrintZshCommand : PrintBashCommand, 0};
  char commands[WORDS] = "";

  PetscFunctionBeginUser;
  printf("%s", zsh ? ZshHead : BashHead);
  if (zsh) {
    PetscCall(LamProgramVisit(PrintZshSummary, NULL));
    printf("%s", ZshMiddle);
  } else {
    PetscCall(LamProgramVisit(AddCommand, commands));
    printf("  '') words='%s' options='-h --help -V --version' ;;\n", commands);
  }
  PetscCall(LamProgramVisit(PrintUsage, &printer));
  PetscCall(printer.ierr);
  printf("%s", zsh ? ZshTail : BashTail);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandCompletion(LamArgs *args, int *exit_status)
{
  const LamOption none[] = {{0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  const char *shell;
  PetscBool done, zsh;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "completion bash|zsh",
                            "Prints the script by which a shell completes the command lines of lamella.", none, 1,
                            &shell, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  zsh = (PetscBool)!strcmp(shell, "zsh");
  if (!zsh && strcmp(shell, "bash") &&
      !LamUsageError("completion", exit_status, "there is none for '%s'; give bash or zsh", shell))
    PetscFunctionReturn(0);
  PetscCall(PrintScript(zsh));
  PetscFunctionReturn(0);
}
