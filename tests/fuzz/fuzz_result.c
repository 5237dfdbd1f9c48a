/* Files of `rve`, `fe2` and `map` that someone has changed, as `info` reads them: described, or refused in words. */
#include "app.h"
#include "hdf5_edits.h"
#include <string.h>
#include <unistd.h>

#define FILE_NAME "result.h5"

/* ---- a run ---- */

static PetscErrorCode Command(LamCommandFunction command, int argc, const char *const words[])
{
  char *argv[8] = {NULL};
  LamArgs args = {.argc = argc, .argv = argv};
  int status = LAM_EXIT_OK;

  PetscFunctionBeginUser;
  for (int i = 0; i < argc; i++) argv[i] = (char *)words[i]; /* getopt orders them */
  PetscCall(command(&args, &status));
  FuzzCheck(status == LAM_EXIT_OK || status == LAM_EXIT_INPUT, "exit status %d", status);
  PetscFunctionReturn(0);
}

static PetscErrorCode Answer(int question)
{
  static const char *const options[] = {NULL, "--json", "--check"};
  const char *option = options[question % 3];

  PetscFunctionBeginUser;
  PetscCall(Command(LamCommandInfo, option ? 3 : 2, (const char *const[]){"info", FILE_NAME, option}));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(const uint8_t *data, size_t size)
{
  PetscErrorCode code;
  int file, question;

  FuzzEnterFolder();
  question = EditsMakeFile(data, size, FILE_NAME, &file);
  code = Answer(question);
  EditsReleaseFile();
  FuzzLeaveFolder();
  return code;
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  static const char *const names[] = {"rve", "contact", "fe2", "map"};

  FuzzStart(argc, argv);
  FuzzCountMemory();
  EditsLoadFiles(PETSC_STATIC_ARRAY_LENGTH(names), names);
  FuzzSilence();
  FuzzCheck(!Run((const uint8_t *)"", 0), "a sound file is not read: %s", FuzzMessage());
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const hsize_t open = EditsCountOpen();
  const PetscErrorCode code = Run(data, size);

  FuzzCheck(!code || (code == PETSC_ERR_USER_INPUT && FuzzMessage()[0]), "error %d: %s", code, FuzzMessage());
  FuzzCheck(code || !FuzzMemoryLeft(), "%zu bytes are left", FuzzMemoryLeft());
  FuzzCheck(EditsCountOpen() == open, "%d objects of HDF5 are left", (int)(EditsCountOpen() - open));
  FuzzMemoryFree();
  EditsEndInput();
  return 0;
}
