/* Contact patch test: two blocks with non-matching distorted meshes, pressed together, deform as one homogeneous body.
 */
#include "support/rve_fixture.h"
#include "support/contact_blocks.h"

static PatchError error;

static int Solve(void **state)
{
  return ComputePatch(&error) ? 1 : 0;
}

TEST_IS(DeformationIsHomogeneous, assert_near(error.gradient, 0.0, 1e-10));
TEST_IS(StressIsUniform, assert_near(error.stress, 0.0, 1e-10));

TEST(MultipliersAreTheUniformPressure)
{
  assert_true(error.pressure > 0.1);
  assert_near(error.multiplier, 0.0, 1e-10);
}

TEST_GROUP(.petsc = 1, .setup = Solve);
