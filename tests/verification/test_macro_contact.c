/*
  A rigid round indenter on a block against Hertz's line contact: half width a of the contact under the force F per
  thickness, a^2 = 4 F R / (pi E*), E* = E / (1 - nu^2).

  The pressure is half an ellipse: its second moment over x is F a^2 / 4. Nodal forces of quadratic elements keep second
  moments, so a is measured by them, much finer than the elements are.
*/
#include "support/macro_fixture.h"
#include "macro_impl.h"

static const PetscReal E_STAR = 3; /* of the synthetic material, mu = 1, lambda = 2: nu = 1/3, E = 8/3 */

/* Sum of nodal contact forces times x^power, x the distance from the axis; half of the body, one rank. */
static PetscReal Moment(LamMacro macro, PetscInt power)
{
  const PetscScalar *force, *u;
  PetscReal sum = 0;

  CHECK(VecGetArrayRead(macro->force_accepted, &force));
  CHECK(VecGetArrayRead(macro->u, &u));
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    const PetscReal x = macro->position[2 * (node->point - macro->mesh_start)] + PetscRealPart(u[node->local]);
    sum -= PetscRealPart(force[node->local + 1]) * PetscPowRealInt(x, power);
  }
  CHECK(VecRestoreArrayRead(macro->u, &u));
  CHECK(VecRestoreArrayRead(macro->force_accepted, &force));
  return sum;
}

/* a / R = 0.16 and a block 6 times as wide: the half width is 1.8 % below that of the half-space. */
MACRO_TEST(ContactWidthIsHertz)
{
  const PetscReal radius = 0.5;
  LamBoundary *indenter;

  FixtureScene(fixture, 40, 40, 1, 2);
  FixtureAdd(fixture, "left", LAM_BOUNDARY_SYMMETRY);
  FixtureBoundary(fixture, "bottom", 0, 0);
  indenter = FixtureAdd(fixture, "top", LAM_BOUNDARY_INDENTER);
  indenter->radius = radius;
  indenter->at[1] = 1;
  indenter->displacement[1] = -0.02;
  FixtureRun(fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  const PetscReal half = Moment(fixture->macro, 0), square = 4 * Moment(fixture->macro, 2) / half,
                  hertz = 4 * 2 * half * radius / (PETSC_PI * E_STAR);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "top")[1] + half) < 1e-8);
  assert_true(PetscAbsReal(square / hertz - 1) < 0.05);
}

/* A step reports the plate where its displacement has brought it, and the indenter above the node that it touches. */
MACRO_TEST(StepsTellWhereObstaclesAre)
{
  LamBoundary *plate, *indenter;

  FixtureScene(fixture, 4, 4, 1, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  plate = FixtureAdd(fixture, "right", LAM_BOUNDARY_PLATE);
  plate->displacement[0] = -0.05;
  indenter = FixtureAdd(fixture, "top", LAM_BOUNDARY_INDENTER);
  indenter->radius = 0.3;
  indenter->at[0] = 0.5;
  indenter->at[1] = 1;
  indenter->displacement[1] = -0.04;
  FixtureRun(fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  const LamMacroStep *step = &fixture->macro->step;
  const PetscReal expected[2][6] = {{0.95, 0, -1, 0, 0, 0}, {0.5, 1.26, 0, -1, 0.3, 0.3}};
  assert_int_equal(step->obstacle_count, 2);
  for (int i = 0; i < 12; i++) assert_near(step->obstacle[i / 6][i % 6], expected[i / 6][i % 6], 1e-12);
}

/* No node is in the indenter, none is pulled, and all that are pressed touch it. */
MACRO_TEST(ComplementarityHolds)
{
  LamBoundary *indenter;
  const PetscScalar *force, *u;
  PetscInt touching = 0;

  FixtureScene(fixture, 8, 4, 0.5, 5);
  FixtureBoundary(fixture, "bottom", 0, 0);
  indenter = FixtureAdd(fixture, "top", LAM_BOUNDARY_INDENTER);
  indenter->radius = 0.2;
  indenter->at[0] = 0.55;
  indenter->at[1] = 0.5;
  indenter->displacement[1] = -0.12;
  FixtureRun(fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  LamMacro macro = fixture->macro;
  CHECK(VecGetArrayRead(macro->force_accepted, &force));
  CHECK(VecGetArrayRead(macro->u, &u));
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    const LamTouch touch = LamMacroNearest(macro, node, u, NULL);
    const PetscReal f[2] = {PetscRealPart(force[node->local]), PetscRealPart(force[node->local + 1])},
                    lambda = f[0] * touch.normal[0] + f[1] * touch.normal[1],
                    aside = f[0] * touch.normal[1] - f[1] * touch.normal[0];
    assert_true(touch.gap > -1e-10);
    assert_true(lambda > -1e-8);
    assert_true(PetscAbsReal(aside) < 1e-8);
    assert_true(touch.gap < 1e-10 || lambda < 1e-8);
    if (touch.gap < 1e-10) touching++;
  }
  assert_true(touching >= 4);
  CHECK(VecRestoreArrayRead(macro->u, &u));
  CHECK(VecRestoreArrayRead(macro->force_accepted, &force));
}
