#include "buckling.h"

PetscErrorCode SolveSymmetric(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  const LamLoad reference = PlaneLoad(1, 0, 0, 1, 0);

  PetscFunctionBeginUser;
  (void)LamSetConsistentStresses(rve, &reference, rve->mesh.class_X);
  for (PetscInt i = 0; i < rve->ndof; i++) {
    const PetscReal *X = &rve->mesh.class_X[i - i % 2], *row = &load->F[3 * (i % 2)];

    rve->y[i] = row[0] * X[0] + row[1] * X[1];
  }
  for (PetscInt it = 0; it < 20; it++) {
    PetscReal energy;
    PetscInt negative;

    PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, ok));
    if (!*ok || LamResidualNorm(rve, rve->residual) <= LamNewtonTolerance(rve)) PetscFunctionReturn(0);
    PetscCall(LamRVEFactor(rve, 0.0, &negative, ok));
    PetscCall(LamLinearSolve(rve->linear, 1, rve->residual + 2, rve->step + 2));
    rve->step[0] = rve->step[1] = 0.0;
    for (PetscInt i = 2; i < rve->ndof; i++) rve->step[i] = -rve->step[i];
    LamUpdateStresses(rve, load, rve->y, rve->step, LamBorderStep(NULL), 1.0);
    for (PetscInt i = 0; i < rve->ndof; i++) rve->y[i] += rve->step[i];
  }
  *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode SymmetricSolution(LamRVE rve, double e, double turgor, double *energy, PetscInt *negative)
{
  const LamLoad load = PlaneLoad(1.0 - e, 0, 0, 1.0 - e, turgor);
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(SolveSymmetric(rve, &load, &ok));
  if (ok) PetscCall(LamFactorConsistent(rve, &load, negative, &ok));
  if (!ok) {
    *negative = -1;
    PetscFunctionReturn(0);
  }
  PetscCall(LamAssembleEnergy(rve, &load, rve->y, energy, &ok));
  *energy /= rve->mesh.V0;
  PetscFunctionReturn(0);
}

PetscErrorCode BucklingOnset(LamRVE rve, double turgor, double width, double *low, double *high)
{
  PetscFunctionBeginUser;
  while (*high - *low > width) {
    const double middle = 0.5 * (*low + *high);
    double energy;
    PetscInt negative;

    PetscCall(SymmetricSolution(rve, middle, turgor, &energy, &negative));
    PetscCheck(negative >= 0, PETSC_COMM_SELF, PETSC_ERR_CONV_FAILED, "no symmetric solution at %g", middle);
    if (negative == 0)
      *low = middle;
    else
      *high = middle;
  }
  PetscFunctionReturn(0);
}
