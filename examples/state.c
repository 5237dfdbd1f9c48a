/*
  One state and its tangent: cells in contact under simple shear, compared with a finite difference of the stress.

    example_state tests/scenes/shear-contact.yaml
*/
#include <lamella/lamella.h>
#include <stdio.h>

enum { F12 = 1, SHEAR = 9 * F12 + F12 }; /* indices of F12, P12 and dP12/dF12 */

static PetscErrorCode Run(const char scene[])
{
  const double h = 1e-6, F[3][9] = {{1, 0.05, 0, 0, 1, 0, 0, 0, 1},
                                    {1, 0.05 - h, 0, 0, 1, 0, 0, 0, 1},
                                    {1, 0.05 + h, 0, 0, 1, 0, 0, 0, 1}};
  double P[3][9], tangent[3][81];
  LamMaterialInfo info[3];
  LamMaterial material;

  PetscFunctionBeginUser;
  PetscCall(LamMaterialCreateFromScene(scene, 0, &material));
  PetscCall(LamMaterialEvaluate(material, 3, NULL, F[0], NULL, NULL, P[0], tangent[0], info));
  PetscCall(LamMaterialDestroy(&material));
  if (info[0].status) {
    printf("no state: %s\n", info[0].reason);
    PetscFunctionReturn(0);
  }
  printf("P12 %.4e Pa, without contact %.3f of the interface\n", P[0][F12], info[0].debonded_fraction);
  printf("dP12/dF12 %.6e Pa, by differences %.6e Pa\n", tangent[0][SHEAR], (P[2][F12] - P[1][F12]) / (2 * h));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode ierr;

  if (argc != 2) {
    fprintf(stderr, "usage: %s SCENE.yaml, such as tests/scenes/shear-contact.yaml\n", argv[0]);
    return 1;
  }
  if (LamErrorsKeep()) return 1; /* and no PetscInitialize: the material starts PETSc, for this rank alone */
  ierr = Run(argv[1]);
  if (ierr) fprintf(stderr, "%s\n", LamErrorMessage());
  return ierr ? 1 : 0;
}
