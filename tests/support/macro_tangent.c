#include "macro_tangent.h"
#include "macro_impl.h"

void CheckTangent(Fixture *fixture, PetscReal size)
{
  const PetscReal h = 1e-6;
  PetscReal step[LAM_MAX_BOUNDARIES] = {0}, equation[LAM_MAX_BOUNDARIES] = {0}, error, norm;
  PetscRandom random;
  Vec *work, u, direction, product, plus, minus;
  LamMacro macro = fixture->macro;

  CHECK(LamMacroSetLoadFactor(macro, 1));
  CHECK(VecDuplicateVecs(macro->u, 5, &work));
  u = work[0], direction = work[1], product = work[2], plus = work[3], minus = work[4];
  CHECK(PetscRandomCreate(PETSC_COMM_WORLD, &random));
  CHECK(PetscRandomSetInterval(random, -size, size));
  CHECK(VecSetRandom(u, random));
  CHECK(VecSetRandom(direction, random));
  for (PetscInt b = 0; b < macro->border_count; b++) {
    macro->borders[b].now = 0.02 + 0.01 * b;
    step[b] = 0.3 * (b + 1) * size;
  }
  macro->fresh = PETSC_TRUE; /* each residual decides anew which nodes slip */
  CHECK(SNESComputeFunction(macro->snes, u, plus));
  CHECK(SNESComputeJacobian(macro->snes, u, macro->tangent, macro->tangent));
  CHECK(MatMult(macro->tangent, direction, product));
  for (PetscInt b = 0; b < macro->border_count; b++) {
    CHECK(VecAXPY(product, step[b], macro->borders[b].column));
    CHECK(VecDot(macro->borders[b].row, direction, &equation[b]));
    for (PetscInt l = 0; l < macro->border_count; l++) {
      PetscReal D = 0;
      if (macro->borders[b].entry >= 0 && macro->borders[l].entry < 0)
        CHECK(VecDot(macro->borders[b].weight, macro->external, &D));
      equation[b] -= D * step[l];
    }
  }
  for (int side = 1; side >= -1; side -= 2) {
    CHECK(VecAXPY(u, side == 1 ? h : -2 * h, direction));
    for (PetscInt b = 0; b < macro->border_count; b++) macro->borders[b].now += (side == 1 ? h : -2 * h) * step[b];
    macro->fresh = PETSC_TRUE;
    CHECK(SNESComputeFunction(macro->snes, u, side == 1 ? plus : minus));
    for (PetscInt b = 0; b < macro->border_count; b++) equation[b] -= side * macro->borders[b].equation / (2 * h);
  }
  CHECK(VecAXPY(plus, -1, minus));
  CHECK(VecAXPY(product, -1 / (2 * h), plus));
  CHECK(VecNorm(product, NORM_2, &error));
  CHECK(VecNorm(plus, NORM_2, &norm));
  assert_true(error < 1e-8 * norm / (2 * h));
  for (PetscInt b = 0; b < macro->border_count; b++) assert_true(PetscAbsReal(equation[b]) < 1e-8 * norm / (2 * h));
  CHECK(PetscRandomDestroy(&random));
  CHECK(VecDestroyVecs(5, &work));
}
