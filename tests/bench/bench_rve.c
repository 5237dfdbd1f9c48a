/* Time of RVE states in a warm process, and of their parts; factorisations against PETSc's of the same matrix in the
   same run. Prints figures, asserts nothing. */
#include <stdio.h>
#include <petscmat.h>
#include <petsctime.h>
#include <lamella/lamella.h>
#include "measure.h"
#include "solve.h"
#include "support/tissue.h"

#define REPEATS 41
#define TURGOR (0.02 / TISSUE_STRESS)

static const PetscInt meshes[][2] = {{6, 2}, {12, 4}, {20, 6}};
#define MESHES (sizeof(meshes) / sizeof(meshes[0]))

typedef struct {
  double factor, petsc, solve, assemble, homogenise, traction;
} Times;

/* The matrix in approximate minimum degree order, with PETSc's Cholesky factorisation of its pattern. */
static PetscErrorCode CreatePetsc(LamRVE rve, Mat *ordered, Mat *factor)
{
  LamLinear *linear = rve->linear;
  MatFactorInfo info;
  Mat upper, full, permuted;
  IS order, same;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, linear->n, linear->n, linear->row, linear->column,
                                        linear->values, &upper));
  PetscCall(MatSetOption(upper, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatConvert(upper, MATSEQAIJ, MAT_INITIAL_MATRIX, &full));
  PetscCall(MatGetOrdering(full, "amd", &order, &same));
  PetscCall(MatPermute(full, order, order, &permuted));
  PetscCall(MatSetOption(permuted, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatConvert(permuted, MATSEQSBAIJ, MAT_INITIAL_MATRIX, ordered));
  PetscCall(ISDestroy(&order));
  PetscCall(ISDestroy(&same));
  PetscCall(MatGetOrdering(*ordered, MATORDERINGNATURAL, &order, &same));
  PetscCall(MatFactorInfoInitialize(&info));
  info.fill = 8.0;
  PetscCall(MatGetFactor(*ordered, MATSOLVERPETSC, MAT_FACTOR_CHOLESKY, factor));
  PetscCall(MatCholeskyFactorSymbolic(*factor, *ordered, order, &info));
  PetscCall(ISDestroy(&order));
  PetscCall(ISDestroy(&same));
  PetscCall(MatDestroy(&upper));
  PetscCall(MatDestroy(&full));
  PetscCall(MatDestroy(&permuted));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeParts(LamRVE rve, const LamLoad *load, Times *median)
{
  double t[6][REPEATS];
  LamResponse response;
  MatFactorInfo info;
  Mat ordered, factor;
  PetscReal energy;
  PetscInt negative;
  PetscBool ok, valid;

  PetscFunctionBeginUser;
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  PetscCall(CreatePetsc(rve, &ordered, &factor));
  PetscCall(MatFactorInfoInitialize(&info));
  for (PetscInt k = 0; k < REPEATS; ++k) {
    PetscLogDouble a[7];

    PetscCall(PetscTime(&a[0]));
    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
    PetscCall(PetscTime(&a[1]));
    PetscCall(LamLinearFactor(rve->linear, 0.0, &negative, &ok));
    PetscCall(PetscTime(&a[2]));
    PetscCall(MatCholeskyFactorNumeric(factor, ordered, &info));
    PetscCall(PetscTime(&a[3]));
    PetscCall(LamLinearSolve(rve->linear, 1, rve->residual + 2, rve->step + 2));
    PetscCall(PetscTime(&a[4]));
    PetscCall(LamResponseInit(load, &response));
    PetscCall(LamHomogenise(rve, load, &response));
    PetscCall(PetscTime(&a[5]));
    PetscCall(LamFaceTractions(rve, load, &response));
    PetscCall(PetscTime(&a[6]));
    for (PetscInt i = 0; i < 6; ++i) t[i][k] = 1e3 * (a[i + 1] - a[i]);
  }
  PetscCall(MatDestroy(&ordered));
  PetscCall(MatDestroy(&factor));
  median->assemble = Quantile(t[0], REPEATS, 0.5);
  median->factor = Quantile(t[1], REPEATS, 0.5);
  median->petsc = Quantile(t[2], REPEATS, 0.5);
  median->solve = Quantile(t[3], REPEATS, 0.5);
  median->homogenise = Quantile(t[4], REPEATS, 0.5);
  median->traction = Quantile(t[5], REPEATS, 0.5);
  PetscFunctionReturn(0);
}

/* Median time of a state, ms. */
static PetscErrorCode TimeState(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response, double *ms)
{
  double t[REPEATS];

  PetscFunctionBeginUser;
  for (PetscInt k = -2; k < REPEATS; ++k) {
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, load, state, response));
    if (k >= 0) t[k] = 1e3 * response->seconds;
  }
  *ms = Quantile(t, REPEATS, 0.5);
  PetscFunctionReturn(0);
}

static PetscErrorCode Parts(const PetscInt mesh[2])
{
  LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1, 0.2, 0, 1, TURGOR);
  LamRVE rve;
  LamRVEState state;
  LamResponse response;
  Times times = {0};
  double ms = 0.0;

  PetscFunctionBeginUser;
  micro.along = mesh[0];
  micro.through = mesh[1];
  PetscCall(NewTissue(&micro, &rve, &state));
  PetscCall(TimeState(rve, &load, state, &response, &ms));
  PetscCall(TimeParts(rve, &load, &times));
  printf("%8d %8d %5d %8.2f %9.3f %9.3f %7.3f %9.3f %11.3f %9.3f %14.2f\n", (int)(6 * mesh[0] * mesh[1]),
         (int)response.unknowns, (int)response.newton_iterations, ms, times.factor, times.petsc, times.solve,
         times.assemble, times.homogenise, times.traction,
         ms / (response.factorisations * times.factor + (response.newton_iterations + 1) * times.assemble));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

static PetscErrorCode States(PetscBool contact)
{
  static const double shears[] = {0.1, 0.2, 0.3};
  LamMicrostructure micro = DefaultTissue();
  LamRVE rve;
  LamRVEState state;

  PetscFunctionBeginUser;
  micro.interface = contact ? LAM_INTERFACE_CONTACT : LAM_INTERFACE_BONDED;
  PetscCall(NewTissue(&micro, &rve, &state));
  for (size_t k = 0; k < sizeof(shears) / sizeof(shears[0]); ++k) {
    const LamLoad load = PlaneLoad(1, shears[k], 0, 1, TURGOR);
    LamResponse response;
    double ms = 0.0;

    PetscCall(TimeState(rve, &load, state, &response, &ms));
    printf("%-8s %6g %12d %15d %9.2f\n", contact ? "contact" : "bonded", shears[k], (int)response.newton_iterations,
           (int)response.factorisations, ms);
  }
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  printf("simple shear 0.2, turgor 0.02 MPa, from F = I, bonded, stress and tangent; medians of %d, ms\n", REPEATS);
  printf("elements unknowns   its    state    factor  PETSc's   solve  assemble  homogenise  traction  state/parts\n");
  for (size_t k = 0; k < MESHES; ++k)
    if (Parts(meshes[k])) return 1;
  printf("PETSc's: its Cholesky factorisation of the same matrix; parts: all assemblies and factorisations\n\n");
  printf("72 elements, turgor 0.02 MPa, from F = I in one step\n");
  printf("interface  shear  iterations  factorisations        ms\n");
  if (States(PETSC_FALSE) || States(PETSC_TRUE)) return 1;
  return PetscFinalize() ? 1 : 0;
}
