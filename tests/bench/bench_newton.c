/* Newton iterations and factorisations of one solve from F = I, over walls, meshes, moduli, shears; prints figures. */
#include <stdio.h>
#include "support/tissue.h"

#define TURGOR (0.02 / TISSUE_STRESS)

static const double shears[] = {0.1, 0.2, 0.3, 0.5};
#define SHEARS (sizeof(shears) / sizeof(shears[0]))

/* One row: "iterations/factorisations" for each shear; a state that is not converged shows its status. */
static PetscErrorCode PrintRow(const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  for (size_t k = 0; k < SHEARS; k++) {
    const LamLoad load = PlaneLoad(1, shears[k], 0, 1, TURGOR);
    LamResponse response;

    PetscCall(SolveOnce(micro, &load, &response));
    if (response.status == LAM_CONVERGED)
      printf("  %4d/%-4d", (int)response.newton_iterations, (int)response.factorisations);
    else
      printf("  %9s", LamStatusNames[response.status]);
  }
  printf("\n");
  PetscFunctionReturn(0);
}

static void PrintHeader(const char what[])
{
  printf("\n%-26s", what);
  for (size_t k = 0; k < SHEARS; k++) printf("  shear %-3g", shears[k]);
  printf("\n");
}

static PetscErrorCode WallsAndMeshes(void)
{
  static const double thickness[] = {0.05, 0.1, 0.15, 0.2, 0.3};
  static const int mesh[][2] = {{6, 2}, {12, 4}};

  PetscFunctionBeginUser;
  PrintHeader("t/a    elements");
  for (size_t i = 0; i < sizeof(thickness) / sizeof(thickness[0]); i++)
    for (size_t m = 0; m < sizeof(mesh) / sizeof(mesh[0]); m++) {
      LamMicrostructure micro = DefaultTissue();

      micro.wall_thickness = thickness[i];
      micro.along = mesh[m][0];
      micro.through = mesh[m][1];
      printf("%-6g %-19d", thickness[i], 6 * mesh[m][0] * mesh[m][1]);
      PetscCall(PrintRow(&micro));
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode Moduli(void)
{
  static const double stiffness[] = {10, 100, 1e3, 1e4}, bulk[] = {1e3, 1e4, 1e5, 1e6};
  static const double thickness[] = {0.05, 0.15, 0.3};

  PetscFunctionBeginUser;
  PrintHeader("t/a    C4/C1   kappa/C1");
  for (size_t i = 0; i < sizeof(thickness) / sizeof(thickness[0]); i++)
    for (size_t f = 0; f < sizeof(stiffness) / sizeof(stiffness[0]); f++)
      for (size_t b = 0; b < sizeof(bulk) / sizeof(bulk[0]); b++) {
        LamMicrostructure micro = DefaultTissue();

        micro.wall_thickness = thickness[i];
        micro.wall.C4 = stiffness[f] * micro.wall.C1;
        micro.wall.bulk_modulus = bulk[b] * micro.wall.C1;
        printf("%-6g %-7g %-11g", thickness[i], stiffness[f], bulk[b]);
        PetscCall(PrintRow(&micro));
      }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  printf("iterations/factorisations from F = I in one go, turgor 0.02 MPa; rejected steps, substeps and the\n"
         "factorisation of the consistent tangent included\n");
  if (WallsAndMeshes() || Moduli()) return 1;
  return PetscFinalize() ? 1 : 0;
}
