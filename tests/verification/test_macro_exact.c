/* The macroscale solver against exact results: homogeneous deformation, and the balance of work and energy. */
#include "support/macro_fixture.h"

/* Between rollers F = diag(1 + ux, 1 + uy) everywhere, P is the material's there, and reactions are stress times length
   of the side. */
MACRO_TEST(HomogeneousDeformationIsExact)
{
  const LamLoad load = {.F = {1.2, 0, 0, 0, 0.9, 0, 0, 0, 1}, .turgor = 0.1};
  LamResponse exact;

  FixtureBiaxial(fixture, 0.2, -0.1, 2);
  fixture->scene.turgor = load.turgor;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  CHECK(LamResponseInit(&load, &exact));
  SyntheticEvaluate(fixture->material, &load, &exact);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < 9 * fields->element_count; k++) {
    assert_true(PetscAbsReal(fields->F[k] - load.F[k % 9]) < 1e-12);
    assert_true(PetscAbsReal(fields->P[k] - exact.P[k % 9]) < 1e-12);
  }
  const LamMacroStep *step = FixtureLast(fixture); /* sides: left, right, bottom, top */
  assert_true(PetscAbsReal(step->reaction[0][0] + 0.6 * exact.P[0]) < 1e-11);
  assert_true(PetscAbsReal(step->reaction[1][0] - 0.6 * exact.P[0]) < 1e-11);
  assert_true(PetscAbsReal(step->reaction[2][1] + exact.P[4]) < 1e-11);
  assert_true(PetscAbsReal(step->reaction[3][1] - exact.P[4]) < 1e-11);
  assert_true(step->reaction[3][0] == 0); /* rollers carry nothing sideways */
}

/* Error of the work against the stored energy, after `steps` steps. */
static PetscReal WorkError(PetscInt steps)
{
  const LamLoad load = {.F = {1.3, 0, 0, 0, 1.1, 0, 0, 0, 1}};
  FIXTURE fixture;
  LamResponse exact;
  PetscReal work;

  FixtureBiaxial(&fixture, 0.3, 0.1, steps);
  FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  CHECK(LamResponseInit(&load, &exact));
  SyntheticEvaluate(fixture.material, &load, &exact);
  work = FixtureLast(&fixture)->work;
  return PetscAbsReal(work - 0.6 * exact.energy);
}

/* The work of the sides becomes stored energy; the trapezoidal rule's error falls with the square of the step. */
TEST(WorkBecomesEnergy)
{
  PetscReal coarse = WorkError(2), fine = WorkError(8);

  assert_true(fine < 2e-4);
  assert_true(PetscAbsReal(coarse / fine - 16) < 1);
}

/* A clamped block in shear: quadratic elements, the reaction converges as the mesh is refined. */
TEST(ShearConverges)
{
  PetscReal force[3];

  for (int k = 0; k < 3; k++) {
    FIXTURE fixture;
    FixtureShear(&fixture, 2 << k, 0.2, 1);
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    force[k] = FixtureLast(&fixture)->reaction[1][0];
  }
  assert_true(force[0] > force[1] && force[1] > force[2]); /* stiffer on coarse meshes */
  assert_true((force[1] - force[2]) < 0.6 * (force[0] - force[1]));
  assert_true((force[1] - force[2]) < 0.01 * force[2]);
}
