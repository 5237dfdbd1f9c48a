/*
  The program, with many commands one after the other in one process, for scripts that try many short ones
  (common.sh: served). Reads an argument a line and runs the command at an empty line; its output is in served.out and
  served.err of the folder, its exit status is the answer.
*/
#include "app.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_ARGUMENTS = 32, LONGEST_ARGUMENT = 1024 };

/* In the place of LamRuntimeStart: MPI and PETSc start with the first command that needs them, and stay. */
static PetscErrorCode StartOnce(LamArgs *args)
{
  PetscFunctionBeginUser;
  if (!PetscInitializeCalled) PetscCall(LamRuntimeStart(args));
  PetscFunctionReturn(0);
}

/* A stream goes to a file until Restore. The descriptor that it had. */
static int Redirect(FILE *stream, const char path[])
{
  const int kept = dup(fileno(stream)), file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);

  if (kept < 0 || file < 0 || dup2(file, fileno(stream)) < 0) abort();
  close(file);
  return kept;
}

static void Restore(FILE *stream, int kept)
{
  fflush(stream);
  dup2(kept, fileno(stream));
  close(kept);
}

static int Run(int argc, char *argv[])
{
  const int out = Redirect(stdout, "served.out"), err = Redirect(stderr, "served.err");
  int status = LAM_EXIT_OK;
  const PetscErrorCode code = LamProgramRun(argc, argv, StartOnce, &status);

  if (code) LamRuntimeReport(code, &status);
  Restore(stdout, out);
  Restore(stderr, err);
  return status;
}

int main(void)
{
  static char words[MOST_ARGUMENTS][LONGEST_ARGUMENT], program[] = "lamella";
  char *argv[MOST_ARGUMENTS + 2] = {program};
  int argc = 1, status = LAM_EXIT_OK;
  PetscErrorCode code = LamRuntimeBegin();

  while (!code && argc <= MOST_ARGUMENTS && fgets(words[argc - 1], LONGEST_ARGUMENT, stdin)) {
    char *word = words[argc - 1];

    word[strcspn(word, "\n")] = '\0';
    if (*word) {
      argv[argc++] = word;
      continue;
    }
    argv[argc] = NULL;
    printf("%d\n", Run(argc, argv));
    fflush(stdout);
    argc = 1;
  }
  LamRuntimeEnd(code, &status);
  return status;
}
