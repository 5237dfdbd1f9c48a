/* Files of `rve`, `fe2` and `map` that someone has changed, as `info` and `plot` read them: described, drawn, or
   refused in words. */
#include "app.h"
#include "hdf5_edits.h"
#include "plot.h"
#include <string.h>
#include <unistd.h>

#define FILE_NAME "result.h5"
#define PICTURE_NAME "picture.png"

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

/* Of each kind of file some: what is drawn of it decides what is read. */
static const char *Field(int file, int question)
{
  static const char *const walls[] = {"wall_stress", "fibre_stretch"};
  static const char *const bodies[] = {"von_mises", "J", "wall_tension_ratio_max", "turgor", "P_12", "max_gap"};
  static const char *const maps[] = {"load_factor", "max_wall_tension", "energy", "newton_iterations"};

  if (file < 2) return walls[question % 2];
  return file == 2 ? bodies[question % 6] : maps[question % 4];
}

static PetscErrorCode Answer(int file, int question)
{
  PetscFunctionBeginUser;
  if (question < 32)
    PetscCall(Command(LamCommandInfo, 2, (const char *const[]){"info", FILE_NAME}));
  else if (question < 40)
    PetscCall(Command(LamCommandInfo, 3, (const char *const[]){"info", FILE_NAME, "--json"}));
  else if (question < 48)
    PetscCall(Command(LamCommandInfo, 3, (const char *const[]){"info", FILE_NAME, "--check"}));
  else if (question < 96)
    PetscCall(Command(LamCommandPlot, 4, (const char *const[]){"plot", FILE_NAME, "-o", PICTURE_NAME}));
  else
    PetscCall(Command(LamCommandPlot, 6,
                      (const char *const[]){"plot", FILE_NAME, "-o", PICTURE_NAME, "--field", Field(file, question)}));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(const uint8_t *data, size_t size)
{
  PetscErrorCode code;
  int file, question;

  FuzzEnterFolder();
  question = EditsMakeFile(data, size, FILE_NAME, &file);
  code = Answer(file, question);
  EditsReleaseFile();
  FuzzLeaveFolder();
  return code;
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  static const char *const names[] = {"rve", "contact", "fe2", "map"};

  FuzzStart(argc, argv);
  LamPlotDPI = LamPlotVectorDPI = 2; /* it draws often */
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
