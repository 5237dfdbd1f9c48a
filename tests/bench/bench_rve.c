/* Time of one RVE state in a warm process against the refactorisations it needs; prints figures, asserts nothing. */
#include <stdio.h>
#include <petsctime.h>
#include <lamella/lamella.h>
#include "measure.h"
#include "solve.h"
#include "support/tissue.h"

#define REPEATS 41

typedef struct {
  double state, factor, solve, assemble, homogenise, traction;
} Times;

static PetscErrorCode TimeParts(LamRVE rve, const LamLoad *load, Times *median)
{
  double t[5][REPEATS];
  LamResponse response;
  PetscReal energy;
  PetscInt negative;
  PetscBool ok, valid;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < REPEATS; ++k) {
    PetscLogDouble a[6];

    PetscCall(PetscTime(&a[0]));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    PetscCall(PetscTime(&a[1]));
    PetscCall(LamLinearFactor(rve->linear, 0.0, &negative, &ok));
    PetscCall(PetscTime(&a[2]));
    PetscCall(LamLinearSolve(rve->linear, 1, rve->residual + 2, rve->step + 2));
    PetscCall(PetscTime(&a[3]));
    PetscCall(LamResponseInit(load, &response));
    PetscCall(LamHomogenise(rve, load, &response));
    PetscCall(PetscTime(&a[4]));
    PetscCall(LamFaceTractions(rve, load, &response));
    PetscCall(PetscTime(&a[5]));
    for (PetscInt i = 0; i < 5; ++i) t[i][k] = a[i + 1] - a[i];
  }
  median->assemble = Quantile(t[0], REPEATS, 0.5);
  median->factor = Quantile(t[1], REPEATS, 0.5);
  median->solve = Quantile(t[2], REPEATS, 0.5);
  median->homogenise = Quantile(t[3], REPEATS, 0.5);
  median->traction = Quantile(t[4], REPEATS, 0.5);
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscInt along, PetscInt through)
{
  LamMicrostructure micro = DefaultTissue();
  const LamLoad load = {.F = {1, 0.2, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.02 / 0.11};
  LamRVE rve;
  LamRVEState state;
  LamResponse response;
  double t[REPEATS];
  Times times = {0};

  PetscFunctionBeginUser;
  micro.along = along;
  micro.through = through;
  PetscCall(NewTissue(&micro, &rve, &state));
  for (PetscInt k = -2; k < REPEATS; ++k) {
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, &load, state, &response));
    if (k >= 0) t[k] = response.seconds;
  }
  times.state = Quantile(t, REPEATS, 0.5);
  PetscCall(TimeParts(rve, &load, &times));
  printf("%8d %8d %5d %8.2f %9.2f %7.2f %9.2f %11.2f %9.2f %12.2f\n", (int)(6 * along * through),
         (int)response.unknowns, (int)response.newton_iterations, 1e3 * times.state, 1e3 * times.factor,
         1e3 * times.solve, 1e3 * times.assemble, 1e3 * times.homogenise, 1e3 * times.traction,
         times.state / (response.newton_iterations * (times.factor + times.solve)));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  static const PetscInt mesh[][2] = {{6, 2}, {12, 4}, {20, 6}};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  printf("simple shear 0.2, turgor 0.02 MPa, from F = I, stress and tangent; medians of %d, ms\n", REPEATS);
  printf("elements unknowns   its    state    factor   solve  assemble  homogenise  traction  state/floor\n");
  for (size_t k = 0; k < sizeof(mesh) / sizeof(mesh[0]); ++k)
    if (Run(mesh[k][0], mesh[k][1])) return 1;
  printf("floor: iterations x (one factorisation + one solve) of the same matrix\n");
  return PetscFinalize() ? 1 : 0;
}
