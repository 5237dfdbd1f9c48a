/* Digits that rounding leaves of P, energy, lumen and tangent where walls are stiff, thin or thick, loads small and
   meshes large; prints figures, asserts nothing. Errors are relative, against the same discrete problem with 113 bits
   (64 in the larger meshes). "large" adds a mesh of 1e5 elements, which takes minutes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/digits.h"

#define LOADS 3

static const LamWanted wanted = LAM_WANT_STRESS | LAM_WANT_DERIVATIVES;

/* C1 + C2 = 1; ratios to C1. */
static LamMicrostructure Tissue(PetscReal kappa, PetscReal thickness, PetscReal fibres)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall_thickness = thickness;
  micro.wall.C4 = fibres * micro.wall.C1;
  micro.wall.bulk_modulus = kappa * micro.wall.C1;
  return micro;
}

/* Shear 0.1, shear 0.3, biaxial stretch; under turgor. */
static LamLoad Load(int k, PetscBool contact)
{
  const PetscReal p = 0.02 / TISSUE_STRESS;
  LamLoad load = k == 2 ? PlaneLoad(1.1, 0, 0, 1.05, p) : PlaneLoad(1, k ? 0.3 : 0.1, 0, 1, p);

  if (contact) load.cohesion = 0.005 / TISSUE_STRESS;
  return load;
}

/* One tissue at the three loads; the worst of what is not P. */
static PetscErrorCode Row(const char name[], const LamMicrostructure *micro, PetscInt steps, Extended extended)
{
  Digits d[LOADS], worst = {0};

  PetscFunctionBeginUser;
  printf("%-30s", name);
  for (int k = 0; k < LOADS; ++k) {
    const LamLoad load = Load(k, (PetscBool)(micro->interface == LAM_INTERFACE_CONTACT));

    PetscCall(DigitsMeasure(micro, &load, steps * (k == 1 ? 3 : 1), wanted, extended, &d[k]));
    if (d[k].status != LAM_CONVERGED) {
      printf("        -");
      continue;
    }
    printf("  %7.1e", d[k].P);
    worst.energy = PetscMax(worst.energy, d[k].energy);
    worst.lumen = PetscMax(worst.lumen, d[k].lumen);
    worst.opening = PetscMax(worst.opening, d[k].opening);
    worst.tangent = PetscMax(worst.tangent, d[k].tangent);
    worst.residual = PetscMax(worst.residual, d[k].residual / d[k].tolerance);
    worst.left = PetscMax(worst.left, d[k].left / d[k].residual);
  }
  printf("  %7.1e  %7.1e  %7.1e  %7.1e  %8.2f  %7.1e\n", worst.energy, worst.lumen, worst.opening, worst.tangent,
         worst.residual, worst.left);
  fflush(stdout);
  PetscFunctionReturn(0);
}

/* residual: of the double-precision positions over the tolerance; left: what the extended iteration leaves of it */
static void Header(const char title[], const char first[])
{
  printf("\n%s\n%-30s  %7s  %7s  %7s  %7s  %7s  %7s  %7s  %8s  %7s\n", title, first, "P, 0.1", "P, 0.3", "P, biax",
         "energy", "lumen", "opening", "tangent", "residual", "left");
}

static PetscErrorCode Sweep(const char first[], int parameter, int n, const PetscReal values[], PetscBool contact)
{
  char name[80];

  PetscFunctionBeginUser;
  Header(contact ? "contact, one cell, turgor 0.02 MPa, cohesion 0.005 MPa" : "bonded, one cell, turgor 0.02 MPa",
         first);
  for (int k = 0; k < n; ++k) {
    PetscReal v[3] = {1000, 0.15, 10};
    LamMicrostructure micro;

    v[parameter] = values[k];
    micro = Tissue(v[0], v[1], v[2]);
    if (contact) micro.interface = LAM_INTERFACE_CONTACT;
    snprintf(name, sizeof(name), "%g", (double)values[k]);
    PetscCall(Row(name, &micro, v[1] > 0.4 || v[2] > 500 ? 5 : 1, ExtendedQuad));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Sweeps(PetscBool contact)
{
  static const PetscReal kappa[] = {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}, fibres[] = {0, 1, 10, 1e2, 1e3, 1e4, 1e5};
  static const PetscReal thickness[] = {0.005, 0.01, 0.02, 0.05, 0.15, 0.3, 0.5, 0.8, 0.95};

  PetscFunctionBeginUser;
  PetscCall(Sweep("kappa/C1", 0, 7, kappa, contact));
  PetscCall(Sweep("t/a", 1, 9, thickness, contact));
  PetscCall(Sweep("C4/C1", 2, 7, fibres, contact));
  PetscFunctionReturn(0);
}

static PetscErrorCode Pairs(void)
{
  static const PetscReal pairs[][3] = {{1e7, 0.005, 10},  {1e7, 0.95, 10},  {1e7, 0.15, 0},    {1e7, 0.15, 1e5},
                                       {1e3, 0.005, 1e5}, {1e3, 0.95, 1e5}, {1e7, 0.005, 1e5}, {1e7, 0.95, 1e5}};
  char name[80];

  PetscFunctionBeginUser;
  Header("bonded, one cell: worst pairs", "kappa/C1, t/a, C4/C1");
  for (size_t k = 0; k < sizeof(pairs) / sizeof(pairs[0]); ++k) {
    const LamMicrostructure micro = Tissue(pairs[k][0], pairs[k][1], pairs[k][2]);

    snprintf(name, sizeof(name), "%g, %g, %g", (double)pairs[k][0], (double)pairs[k][1], (double)pairs[k][2]);
    PetscCall(Row(name, &micro, 5, ExtendedQuad));
  }
  PetscFunctionReturn(0);
}

/* Of the tangent, which positions of the converged state alone decide: worst of the loads, each reached in steps. */
static PetscErrorCode Tangents(void)
{
  static const PetscReal kappa[] = {1e2, 1e3, 1e4, 1e5, 1e6, 1e7},
                         thickness[] = {0.005, 0.01, 0.02, 0.05, 0.15, 0.3, 0.95};
  static const PetscReal fibres[] = {0, 10};

  PetscFunctionBeginUser;
  for (int f = 0; f < 2; ++f) {
    printf("\nerror of the tangent, bonded, turgor 0.02 MPa, C4/C1 = %g: t/a in columns\nkappa/C1", (double)fibres[f]);
    for (int t = 0; t < 7; ++t) printf(" %8g", (double)thickness[t]);
    for (int k = 0; k < 6; ++k) {
      printf("\n%-8g", (double)kappa[k]);
      for (int t = 0; t < 7; ++t) {
        const LamMicrostructure micro = Tissue(kappa[k], thickness[t], fibres[f]);
        PetscReal worst = 0;

        for (int l = 0; l < LOADS; ++l) {
          const LamLoad load = Load(l, PETSC_FALSE);
          Digits d;

          PetscCall(DigitsMeasure(&micro, &load, 1, wanted, ExtendedLong, &d));
          if (d.status == LAM_CONVERGED) worst = PetscMax(worst, d.tangent);
        }
        printf(" %8.1e", (double)worst);
        fflush(stdout);
      }
    }
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Sizes(PetscBool large)
{
  static const PetscInt mesh[][4] = {{1, 1, 1, 1}, {6, 2, 1, 1}, {20, 6, 1, 1}, {40, 40, 1, 1},
                                     {6, 2, 2, 2}, {6, 2, 4, 4}, {6, 2, 8, 8},  {130, 130, 1, 1}};
  char name[80];

  PetscFunctionBeginUser;
  for (int stiff = 0; stiff < 2; ++stiff) {
    Header(stiff ? "bonded, kappa/C1 = 1e6" : "bonded, kappa/C1 = 1e3", "elements of a wall, cells");
    for (size_t k = 0; k < sizeof(mesh) / sizeof(mesh[0]) - (large && !stiff ? 0 : 1); ++k) {
      LamMicrostructure micro = Tissue(stiff ? 1e6 : 1e3, 0.15, 10);

      micro.along = mesh[k][0];
      micro.through = mesh[k][1];
      micro.cells[0] = mesh[k][2];
      micro.cells[1] = mesh[k][3];
      snprintf(name, sizeof(name), "%d x %d, %d x %d cells", (int)mesh[k][0], (int)mesh[k][1], (int)mesh[k][2],
               (int)mesh[k][3]);
      PetscCall(Row(name, &micro, 1, ExtendedLong));
    }
  }
  PetscFunctionReturn(0);
}

/* From F = I: shear and dilatation by strains down to 1e-12. */
static PetscErrorCode Small(PetscReal turgor, PetscReal kappa)
{
  static const PetscReal strain[] = {1e-3, 1e-6, 1e-9, 1e-12};
  const LamMicrostructure micro = Tissue(kappa, 0.15, 10);

  PetscFunctionBeginUser;
  printf("\nsmall strains from F = I, kappa/C1 = %g, turgor %g\n%-10s %8s %8s %8s %8s %8s\n", (double)kappa,
         (double)turgor, "strain", "P shear", "P dilat", "|P| shear", "energy", "tangent");
  for (int s = 0; s < 4; ++s) {
    const LamLoad shear = PlaneLoad(1, strain[s], 0, 1, turgor);
    const LamLoad dilatation = PlaneLoad(1 + strain[s], 0, 0, 1 + strain[s], turgor);
    Digits d[2];

    PetscCall(DigitsMeasure(&micro, &shear, 1, wanted, ExtendedQuad, &d[0]));
    PetscCall(DigitsMeasure(&micro, &dilatation, 1, wanted, ExtendedQuad, &d[1]));
    printf("%-10g %8.1e %8.1e %8.1e %8.1e %8.1e\n", (double)strain[s], d[0].P, d[1].P, d[0].size,
           PetscMax(d[0].energy, d[1].energy), PetscMax(d[0].tangent, d[1].tangent));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscBool large)
{
  PetscFunctionBeginUser;
  PetscCall(Sweeps(PETSC_FALSE));
  PetscCall(Pairs());
  PetscCall(Tangents());
  PetscCall(Sweeps(PETSC_TRUE));
  PetscCall(Small(0, 1e3));
  PetscCall(Small(0, 1e6));
  PetscCall(Small(0.02 / TISSUE_STRESS, 1e3));
  PetscCall(Sizes(large));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const PetscBool large = (PetscBool)(argc > 1 && !strcmp(argv[1], "large"));

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (argc > 1 && !strcmp(argv[1], "tangents")) return Tangents() || PetscFinalize();
  if (Run(large)) return 1;
  return PetscFinalize() ? 1 : 0;
}
