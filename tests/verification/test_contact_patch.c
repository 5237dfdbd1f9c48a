/* Contact patch test: two blocks with non-matching distorted meshes, pressed together, deform as one homogeneous body.
 */
#include "rve_fixture.h"
#include "assert_near.h"
#include "figures_contact_blocks.h"

static PatchError error;

static int Solve(void **state)
{
  return ComputePatch(&error) ? 1 : 0;
}

static void DeformationIsHomogeneous(void **state)
{
  assert_near(error.gradient, 0.0, 1e-10);
}

static void StressIsUniform(void **state)
{
  assert_near(error.stress, 0.0, 1e-10);
}

static void MultipliersAreTheUniformPressure(void **state)
{
  assert_true(error.pressure > 0.1);
  assert_near(error.multiplier, 0.0, 1e-10);
}

static int Run(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(DeformationIsHomogeneous),
      cmocka_unit_test(StressIsUniform),
      cmocka_unit_test(MultipliersAreTheUniformPressure),
  };

  return cmocka_run_group_tests(tests, Solve, NULL);
}

int main(int argc, char **argv)
{
  return RunWithPetsc(argc, argv, Run);
}
