/*
  Builds a database over the sample box of a scene, then queries it: interpolation takes microseconds.

    example_database tests/scenes/tissue-block.yaml DB.h5
*/
#include <lamella/lamella.h>
#include <stdio.h>

static PetscErrorCode Run(const char scene[], const char path[])
{
  const LamBuildOptions options = {.resume = PETSC_TRUE};
  const double F[2][9] = {{1.05, 0.02, 0, 0, 1.03, 0, 0, 0, 1}, {3, 0, 0, 0, 3, 0, 0, 0, 1}};
  double P[2][9];
  LamMaterialInfo info[2];
  LamBuildResult result;
  LamMaterial material;

  PetscFunctionBeginUser;
  PetscCall(LamStudyBuild(scene, path, &options, &result));
  printf("%lld records, %.1f %% of the box\n", (long long)result.records, 100 * result.answered);
  PetscCall(LamMaterialCreateFromDatabase(path, &material));
  PetscCall(LamMaterialEvaluate(material, 2, NULL, F[0], NULL, NULL, P[0], NULL, info));
  PetscCall(LamMaterialDestroy(&material));
  for (int i = 0; i < 2; i++) {
    if (info[i].status)
      printf("F11 %.2f: no response: %s\n", F[i][0], info[i].reason);
    else
      printf("F11 %.2f: P11 %.4e Pa, estimated error %.2g %%\n", F[i][0], P[i][0], 100 * info[i].error_estimate);
  }
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
