/* Digits that rounding leaves of P, energy, lumen and tangent where walls are stiff, thin or thick and loads small, and
   how the size of the mesh and of the period enters; prints figures, asserts nothing. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "digits.h"

/* C1 + C2 = 1; ratios to C1. */
static LamMicrostructure Tissue(PetscReal kappa, PetscReal thickness, PetscReal fibres)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall_thickness = thickness;
  micro.wall.C4 = fibres * micro.wall.C1;
  micro.wall.bulk_modulus = kappa * micro.wall.C1;
  return micro;
}

static LamLoad Shear(PetscReal shear)
{
  return PlaneLoad(1, shear, 0, 1, 0.02 / TISSUE_STRESS);
}

static Extended extended = ExtendedQuad;

static PetscErrorCode Row(const char name[], const LamMicrostructure *micro, const LamLoad *load, PetscInt steps)
{
  Digits d;

  PetscFunctionBeginUser;
  PetscCall(DigitsMeasure(micro, load, steps, LAM_WANT_STRESS | LAM_WANT_DERIVATIVES, extended, &d));
  printf("%-34s", name);
  if (d.status != LAM_CONVERGED)
    printf(" %s\n", LamStatusNames[d.status]);
  else
    printf(" %8.1e %8.1e %8.1e %8.1e  %8.1e %8.1e %8.1e  %2d %8.1e\n", d.P, d.energy, d.lumen, d.tangent, d.size,
           d.residual, d.tolerance, d.iterations, d.left);
  fflush(stdout);
  PetscFunctionReturn(0);
}

static void Header(const char title[])
{
  printf("\n%s\n%-34s %8s %8s %8s %8s  %8s %8s %8s  %s\n", title, "", "P", "energy", "lumen", "tangent", "|P|",
         "residual", "allowed", "extended: its, left");
}

static PetscErrorCode Moduli(void)
{
  static const PetscReal kappa[] = {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}, fibres[] = {0, 1, 10, 1e2, 1e3, 1e4, 1e5};
  static const PetscReal thickness[] = {0.005, 0.01, 0.02, 0.05, 0.15, 0.3, 0.5, 0.8, 0.95};
  char name[80];

  PetscFunctionBeginUser;
  for (int shear = 1; shear <= 3; shear += 2) {
    const LamLoad load = Shear(0.1 * shear);

    snprintf(name, sizeof(name), "bonded, shear 0.%d, turgor 0.02 MPa: kappa/C1", shear);
    Header(name);
    for (int k = 0; k < 7; ++k) {
      const LamMicrostructure micro = Tissue(kappa[k], 0.15, 10);

      snprintf(name, sizeof(name), "kappa/C1 %.0e", (double)kappa[k]);
      PetscCall(Row(name, &micro, &load, 1));
    }
    Header("t/a");
    for (int k = 0; k < 9; ++k) {
      const LamMicrostructure micro = Tissue(1000, thickness[k], 10);

      snprintf(name, sizeof(name), "t/a %.3f", (double)thickness[k]);
      PetscCall(Row(name, &micro, &load, thickness[k] > 0.4 ? 5 : 1));
    }
    Header("C4/C1");
    for (int k = 0; k < 7; ++k) {
      const LamMicrostructure micro = Tissue(1000, 0.15, fibres[k]);

      snprintf(name, sizeof(name), "C4/C1 %.0e", (double)fibres[k]);
      PetscCall(Row(name, &micro, &load, fibres[k] > 500 ? 4 * shear : 1));
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Small(void)
{
  static const PetscReal strain[] = {1e-3, 1e-6, 1e-9, 1e-12};
  static const PetscReal kappa[] = {1e3, 1e6};
  char name[80];

  PetscFunctionBeginUser;
  for (int turgid = 0; turgid < 2; ++turgid) {
    Header(turgid ? "small shear under turgor" : "small shear, dry");
    for (int k = 0; k < 2; ++k)
      for (int s = 0; s < 4; ++s) {
        const LamMicrostructure micro = Tissue(kappa[k], 0.15, 10);
        const LamLoad load = PlaneLoad(1, strain[s], 0, 1, turgid ? 0.02 / TISSUE_STRESS : 0);

        snprintf(name, sizeof(name), "kappa/C1 %.0e, shear %.0e", (double)kappa[k], (double)strain[s]);
        PetscCall(Row(name, &micro, &load, 1));
      }
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (argc > 1 && !strcmp(argv[1], "long")) extended = ExtendedLong;
  if (Moduli() || Small()) return 1;
  return PetscFinalize() ? 1 : 0;
}
