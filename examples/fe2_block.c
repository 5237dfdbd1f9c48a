/*
  FE2 simulation of a block of tissue under shear: the force at each step. Material points query a database; missing
  states are solved and added to it.

    example_fe2_block tests/scenes/tissue-block.yaml DB.h5
*/
#include <lamella/lamella.h>
#include <stdio.h>
#include <string.h>

static PetscErrorCode PrintStep(void *ctx, const LamScales *scales, const LamMacroStep *step)
{
  const PetscReal force = scales->stress * scales->macro_length; /* N per m of thickness */

  PetscFunctionBeginUser;
  (void)ctx;
  for (PetscInt b = 0; b < step->boundary_count; b++)
    if (!strcmp(step->boundary[b], "top"))
      printf("load %.2f: force on top %.4e N/m, %lld solves\n", (double)step->load_factor,
             (double)(step->reaction[b][0] * force), (long long)step->solves);
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(const char scene[], const char database[])
{
  const LamFE2Options options = {.response = LAM_FE2_CACHE, .database_path = database, .step = PrintStep};
  char message[LAM_MESSAGE_LENGTH];
  LamMacroReason reason;

  PetscFunctionBeginUser;
  PetscCall(LamStudyFE2(scene, &options, &reason, message));
  if (reason != LAM_MACRO_DONE) printf("not to the end: %s\n", message);
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode ierr;

  if (argc != 3) {
    fprintf(stderr, "usage: %s SCENE.yaml DB.h5, such as tests/scenes/tissue-block.yaml DB.h5\n", argv[0]);
    return 1;
  }
  if (LamErrorsKeep() || PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  ierr = Run(argv[1], argv[2]);
  if (ierr) fprintf(stderr, "%s\n", LamErrorMessage());
  return ierr || PetscFinalize() ? 1 : 0;
}
