/* Sealed cells: errors of the derivatives, pressures along simple loads, cost against prescribed turgor. Prints
 * figures. */
#include <stdio.h>
#include "support/sealed_cells.h"

static PetscErrorCode PrintDerivatives(void)
{
  LamCell cells[SEALED_CELLS];
  SealedState states[SEALED_STATES];

  PetscFunctionBeginUser;
  ListSealedStates(cells, states);
  printf("%-28s %9s %9s %8s %8s %8s %8s %8s\n", "state", "p", "spread", "law", "P", "tangent", "symmetry", "dP/dp0");
  for (int k = 0; k < SEALED_STATES; k++) {
    ContactDerivativeError e;
    SealedFigures f;

    PetscCall(SweepSealed(&states[k], &f));
    e = DerivativeError(&f.sweep);
    printf("%-28s %9.4f %9.4f %8.1e %8.1e %8.1e %8.1e %8.1e\n", states[k].name, f.sweep.response.turgor_mean,
           f.sweep.response.turgor_spread, f.law_error, e.stress, e.tangent, e.symmetry, e.turgor_coupling);
  }
  PetscFunctionReturn(0);
}

/* Sealed, and at the turgor that it reaches; the fastest of some solves. */
static PetscErrorCode PrintCost(const char name[], const LamMicrostructure *micro, const LamLoad *load)
{
  double fastest[2] = {PETSC_INFINITY, PETSC_INFINITY};
  LamResponse sealed, open;
  SealedTissue s;

  PetscFunctionBeginUser;
  PetscCall(SealedCreate(micro, load, SEALED_WATER, &s));
  for (int k = 0; k < 5; k++) {
    LamLoad reached = *load;

    PetscCall(LamRVESeal(s.rve, SEALED_WATER, s.water));
    PetscCall(SealedSolve(&s, load, &sealed));
    fastest[0] = PetscMin(fastest[0], sealed.seconds);
    PetscCall(LamRVEUnseal(s.rve));
    reached.turgor = sealed.turgor_mean;
    PetscCall(SealedSolve(&s, &reached, &open));
    fastest[1] = PetscMin(fastest[1], open.seconds);
  }
  printf("%-34s %8.4f %6d %6d %8.2f %6d %6d %8.2f\n", name, (double)(sealed.turgor_mean * TISSUE_STRESS),
         (int)sealed.newton_iterations, (int)sealed.factorisations, 1e3 * fastest[0], (int)open.newton_iterations,
         (int)open.factorisations, 1e3 * fastest[1]);
  PetscCall(SealedDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintCosts(void)
{
  static const struct {
    const char *name;
    double F[4];
    PetscInt cells;
    PetscBool contact;
  } cases[] = {{"bonded, shear 0.1", {1, 0.1, 0, 1}, 1, PETSC_FALSE},
               {"bonded, shear 0.3", {1, 0.3, 0, 1}, 1, PETSC_FALSE},
               {"bonded, stretch 1.3, det F = 1", {1.3, 0, 0, 1 / 1.3}, 1, PETSC_FALSE},
               {"bonded, stretch 1.001", {1.001, 0, 0, 1}, 1, PETSC_FALSE},
               {"bonded, shear 0.1, 2 x 2 cells", {1, 0.1, 0, 1}, 2, PETSC_FALSE},
               {"contact, shear 0.1", {1, 0.1, 0, 1}, 1, PETSC_TRUE},
               {"contact, stretch 1.1, det F = 1", {1.1, 0, 0, 1 / 1.1}, 1, PETSC_TRUE},
               {"contact, stretch 1.02", {1.02, 0, 0, 1}, 1, PETSC_TRUE},
               {"contact, shear 0.1, 2 x 2 cells", {1, 0.1, 0, 1}, 2, PETSC_TRUE}};

  PetscFunctionBeginUser;
  printf("\n%-34s %8s %22s %22s\n", "sealed at 0.02 MPa", "p", "sealed", "p prescribed");
  printf("%-34s %8s %6s %6s %8s %6s %6s %8s\n", "", "MPa", "iter.", "fact.", "ms", "iter.", "fact.", "ms");
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    const double *F = cases[k].F;
    LamMicrostructure micro = cases[k].contact ? ContactTissue(6, 2) : DefaultTissue();
    const LamLoad load = ContactLoad(F[0], F[1], F[2], F[3], 0.02, cases[k].contact ? 0.005 : 0);

    micro.cells[0] = micro.cells[1] = cases[k].cells;
    PetscCall(PrintCost(cases[k].name, &micro, &load));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscErrorCode ierr = PetscInitialize(&argc, &argv, NULL, NULL);

  if (ierr) return 1;
  PetscCall(PrintDerivatives());
  PetscCall(PrintCosts());
  return PetscFinalize();
}
