/*
  Command lines, and what `query -F -` reads: each is told to be wrong, or understood, and where a command then would
  solve it stops. Lines up to the first empty one are the arguments, the rest is standard input.

  A command that would start MPI ends there. Commands that read files find a scene and a database, db.h5, in the folder.
*/
#include "app.h"
#include "fuzz.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_ARGUMENTS = 32 };

/* In the place of LamRuntimeStart. */
static PetscErrorCode RefuseToStart(LamArgs *args)
{
  PetscFunctionBeginUser;
  (void)args;
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "the command line is understood");
}

/* Simple shear of bonded tissue, a state on either side of the queries that are most likely. */
static void MakeDatabase(void)
{
  LamScene *scene;
  LamResponse responses[3];
  LamRecordWriter writer = NULL;
  const PetscInt64 keys[3] = {0, 1, 2};
  PetscErrorCode ierr = LamSceneRead(LAMELLA_SOURCE_DIR "/tests/scenes/shear-bonded.yaml", &scene);

  for (int i = 0; !ierr && i < 3; i++) {
    const LamLoad load = {.F = {1, 0.1 * i, 0, 0, 1, 0, 0, 0, 1}, .turgor = scene->turgor};

    ierr = LamResponseInit(&load, &responses[i]);
    memset(responses[i].P, 0, sizeof(responses[i].P));
    memset(responses[i].tangent, 0, sizeof(responses[i].tangent));
    responses[i].energy = 0;
    responses[i].status = LAM_CONVERGED;
  }
  unlink("db.h5"); /* of an earlier run */
  if (!ierr) ierr = LamRecordWriterOpen("db.h5", "database", LAM_WRITE_CREATE, scene, &writer);
  if (!ierr) ierr = LamRecordWriterCommit(writer, 3, keys, responses);
  if (!ierr) ierr = LamRecordWriterClose(&writer);
  FuzzCheck(!ierr, "%s", FuzzMessage());
  FuzzWriteFile("scene.yaml", scene->text, strlen(scene->text));
  LamSceneDestroy(&scene);
}

/* ---- a run ---- */

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  FuzzStart(argc, argv);
  FuzzCountMemory();
  FuzzEnterFolder();
  MakeDatabase();
  FuzzLeaveFolder();
  FuzzMemoryKeep();
  FuzzSilence();
  return 0;
}

/* Whatever is written stays in the folder; of the paths only "1/4", which may be part of a build, is let through. */
static PetscBool MayBePath(const char word[])
{
  for (const char *slash = strchr(word, '/'); slash; slash = strchr(slash + 1, '/'))
    if (slash == word || !isdigit((unsigned char)slash[-1]) || !isdigit((unsigned char)slash[1])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Takes `text` apart; *rest is what follows the empty line. -1: no command line to be run here. */
static int Split(char text[], char *argv[MOST_ARGUMENTS + 2], const char **rest)
{
  static char program[] = "lamella";
  int argc = 1;

  argv[0] = program;
  while (*text && *text != '\n') {
    char *end = text + strcspn(text, "\n");

    if (argc > MOST_ARGUMENTS) return -1;
    argv[argc++] = text;
    text = end + (*end == '\n');
    *end = '\0';
    if (MayBePath(argv[argc - 1])) return -1;
  }
  *rest = text + (*text == '\n');
  argv[argc] = NULL;
  return argc;
}

static void Run(int argc, char *argv[], char input[], size_t size)
{
  int status = LAM_EXIT_OK;
  PetscErrorCode code;

  stdin = fmemopen(input, size, "r");
  FuzzCheck(stdin, "standard input cannot be made");
  FuzzEnterFolder();
  code = LamProgramRun(argc, argv, RefuseToStart, &status);
  FuzzLeaveFolder();
  fclose(stdin);
  FuzzCheck(!code || code == PETSC_ERR_USER_INPUT || code == PETSC_ERR_FILE_OPEN || code == PETSC_ERR_FILE_READ,
            "error %d: %s", code, FuzzMessage());
  FuzzCheck(!code || FuzzMessage()[0], "error %d without words", code);
  FuzzCheck(status >= LAM_EXIT_OK && status <= LAM_EXIT_IO, "exit status %d", status);
  FuzzCheck(code || !FuzzMemoryLeft(), "%zu bytes are left", FuzzMemoryLeft());
  FuzzMemoryFree();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char *text = malloc(size + 1), *argv[MOST_ARGUMENTS + 2];
  const char *rest;
  int argc;

  memcpy(text, data, size);
  text[size] = '\0';
  argc = Split(text, argv, &rest);
  if (argc > 0) Run(argc, argv, (char *)rest, size - (size_t)(rest - text));
  free(text);
  return 0;
}
