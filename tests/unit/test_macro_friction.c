/* Claims about obstacles with friction and about indenters with a shaft, with a material of known answers. Runs on any
   number of ranks. */
#include "support/macro_tangent.h"
#include "macro_impl.h"

static LamBoundary *AddPlate(Fixture *fixture, const char on[], PetscReal ux, PetscReal uy, PetscReal friction)
{
  LamBoundary *plate = FixtureAdd(fixture, on, LAM_BOUNDARY_PLATE);

  plate->displacement[0] = ux;
  plate->displacement[1] = uy;
  plate->friction = friction;
  return plate;
}

/* Nodes of the last rows that stick, and that slip. */
static void Count(LamMacro macro, PetscInt count[2])
{
  count[0] = count[1] = 0;
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const LamObstacleNode *node = &macro->obstacle_nodes[k];
    for (PetscInt r = 0; r < macro->row_count && node->active; r++) {
      const LamNodeRows *rows = &macro->rows[r];
      PetscInt prescribed = 0;
      if (rows->local != node->local) continue;
      for (PetscInt i = 0; i < 2; i++) prescribed += rows->combine[2 * i] == 0 && rows->combine[2 * i + 1] == 0;
      count[prescribed == 2 ? 0 : 1]++;
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
}

/* Of nodes that stick and of others that slip, at a plate and at a round indenter. */
TEST(TangentWithFriction)
{
  PetscInt all[2] = {0, 0};

  for (int k = 0; k < 4; k++) {
    const PetscReal friction = k % 2 ? 5 : 0.05;
    FIXTURE fixture;
    PetscInt count[2];
    FixtureScene(&fixture, 4, 3, 1, 1);
    fixture.scene.macro.symmetry = k / 2 ? LAM_AXISYMMETRIC : LAM_PLANE_STRAIN;
    FixtureBoundary(&fixture, "bottom", 0, 0);
    FixtureIndenter(&fixture, 0.7, 0, 1, 0, -0.3);
    fixture.scene.macro.boundary[1].friction = friction;
    AddPlate(&fixture, "right", -0.08, 0.02, friction);
    FixtureSetUp(&fixture, PETSC_COMM_WORLD);
    CheckTangent(&fixture, 0.01);
    Count(fixture.macro, count);
    for (int i = 0; i < 2; i++) all[i] += count[i];
  }
  assert_true(all[0] > 4 && all[1] > 4);
}

/* What sticks on a plate moves as a side that is prescribed. */
TEST(StuckIsPrescribed)
{
  for (int around = 0; around < 2; around++) {
    PetscReal force[2][2];
    for (int stuck = 0; stuck < 2; stuck++) {
      FIXTURE fixture;
      FixtureScene(&fixture, 4, 4, 1, 4);
      fixture.scene.macro.symmetry = around ? LAM_AXISYMMETRIC : LAM_PLANE_STRAIN;
      FixtureBoundary(&fixture, "bottom", 0, 0);
      if (stuck)
        AddPlate(&fixture, "top", around ? 0 : 0.01, -0.3, PETSC_INFINITY);
      else
        FixtureBoundary(&fixture, "top", around ? 0 : 0.01, -0.3);
      FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
      for (int i = 0; i < 2; i++) force[stuck][i] = FixtureReaction(&fixture, "top")[i];
      assert_int_equal(FixtureLast(&fixture)->cutbacks, 0);
    }
    for (int i = 0; i < 2; i++) assert_near(force[0][i], force[1][i], 1e-7);
  }
}

/* A plate that presses a block and then moves along it drags it up to the coefficient times its force. */
MACRO_TEST(SlidingIsCoulomb)
{
  const PetscReal friction = 0.2;
  LamBoundary *plate;
  PetscInt count[2];

  FixtureScene(fixture, 5, 4, 1, 8);
  FixtureBoundary(fixture, "bottom", 0, 0);
  plate = AddPlate(fixture, "top", 0.4, -0.1, friction);
  plate->normal[0] = 0.0;
  plate->normal[1] = -1;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  Count(fixture->macro, count);
  assert_int_equal(count[0], 0);
  assert_true(count[1] > 8);
  const PetscReal *force = FixtureReaction(fixture, "top");
  assert_near(force[0], -friction * force[1], 1e-8);
  assert_true(force[1] < -0.1);
}

/* Coulomb's law at each node of a cylinder between plates, whose middle sticks and whose rim slips outwards. */
MACRO_TEST(CoulombHoldsAtEachNode)
{
  const PetscReal friction = 0.15;
  const PetscScalar *force, *u;
  PetscInt count[2];

  FixtureScene(fixture, 8, 4, 0.5, 3);
  fixture->scene.macro.symmetry = LAM_AXISYMMETRIC;
  FixtureAdd(fixture, "bottom", LAM_BOUNDARY_SYMMETRY);
  AddPlate(fixture, "top", 0, -0.12, friction);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  Count(fixture->macro, count);
  assert_true(count[0] > 2 && count[1] > 2);
  LamMacro macro = fixture->macro;
  CHECK(VecGetArrayRead(macro->force_accepted, &force));
  CHECK(VecGetArrayRead(macro->u, &u));
  for (PetscInt k = 0; k < macro->obstacle_node_count; k++) {
    const PetscInt at = macro->obstacle_nodes[k].local;
    const PetscReal pressed = -PetscRealPart(force[at + 1]), along = PetscRealPart(force[at]);
    if (macro->obstacle_nodes[k].constraint >= 0) continue; /* on the axis */
    assert_true(PetscAbsReal(along) <= friction * pressed + 1e-9);
    assert_true(PetscRealPart(u[at]) >= -1e-9 && along <= 1e-9);
    if (PetscAbsReal(along) < 0.99 * friction * pressed) assert_near(u[at], 0, 0.02);
  }
  CHECK(VecRestoreArrayRead(macro->u, &u));
  CHECK(VecRestoreArrayRead(macro->force_accepted, &force));
  for (PetscInt k = 0; k < fixture->step_count; k++) assert_int_equal(fixture->steps[k].cutbacks, 0);
}

/* Also of sealed cells, where the forces of nodes err much before the iteration is near, without cutbacks. */
MACRO_TEST(SealedCylinderRubs)
{
  PetscInt count[2];

  FixtureScene(fixture, 5, 4, 0.8, 4);
  fixture->scene.macro.symmetry = LAM_AXISYMMETRIC;
  FixtureSeal(fixture, 0.1, 2e3);
  FixtureAdd(fixture, "bottom", LAM_BOUNDARY_SYMMETRY);
  AddPlate(fixture, "top", 0, -0.2, 0.2);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  Count(fixture->macro, count);
  assert_true(count[1] > 3);
  const PetscReal *force = FixtureReaction(fixture, "top");
  assert_true(force[0] < 0 && force[0] > 0.2 * force[1] - 1e-8);
  for (PetscInt k = 0; k < fixture->step_count; k++) assert_int_equal(fixture->steps[k].cutbacks, 0);
}

/* The force of a compressed cylinder lies between those without friction and stuck, and rises with the coefficient. */
TEST(FrictionStiffens)
{
  const PetscReal friction[] = {0, 0.1, 0.3, PETSC_INFINITY};
  PetscReal last = 0;

  for (int k = 0; k < 4; k++) {
    FIXTURE fixture;
    FixtureScene(&fixture, 6, 4, 0.5, 3);
    fixture.scene.macro.symmetry = LAM_AXISYMMETRIC;
    FixtureAdd(&fixture, "bottom", LAM_BOUNDARY_SYMMETRY);
    AddPlate(&fixture, "top", 0, -0.15, friction[k]);
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    assert_true(FixtureReaction(&fixture, "top")[1] < last - 1e-3);
    last = FixtureReaction(&fixture, "top")[1];
  }
}

/* ---- indenters with a shaft ---- */

/* Gap, normal and curvature against differences, and the distance from the cylinder by hand. */
MACRO_TEST(ShaftHasItsDistance)
{
  const PetscReal h = 1e-6, edge = 0.1;
  LamBoundary *punch;
  LamObstacleNode *node = NULL;
  PetscScalar *u;

  FixtureScene(fixture, 4, 4, 1, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureIndenter(fixture, 0.3, 0.5, 1, 0, -0.1);
  punch = &fixture->scene.macro.boundary[1];
  punch->shaft = PETSC_TRUE;
  punch->edge = edge;
  FixtureSetUp(fixture, PETSC_COMM_SELF);
  node = &fixture->macro->obstacle_nodes[0];
  const PetscReal *X = &fixture->macro->position[2 * (node->point - fixture->macro->mesh_start)];
  CHECK(PetscCalloc1(node->local + 2, &u));
  const PetscReal places[][3] = {{0.6, 0.97, 0.03},                             /* before the end */
                                 {0.9, 1.4, 0.1},                               /* beside the shaft */
                                 {0.8, 0.9, sqrt(0.1 * 0.1 + 0.2 * 0.2) - 0.1}, /* beyond the edge, at (0.7, 1.1) */
                                 {0.1, 0.9, sqrt(0.2 * 0.2 + 0.2 * 0.2) - 0.1},
                                 {0.55, 1.13, -0.13}, /* in it, nearer to the end */
                                 {0.68, 1.3, -0.12}}; /* and nearer to the shaft */
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(places); k++) {
    LamTouch touch[5];
    for (int d = 0; d < 5; d++) { /* at the place, and moved along X1 and X2 */
      for (int i = 0; i < 2; i++)
        u[node->local + i] = places[k][i] - X[i] + (d && (d - 1) / 2 == i ? (d % 2 ? h : -h) : 0);
      touch[d] = LamMacroNearest(fixture->macro, node, u, NULL);
    }
    assert_near(touch[0].gap, places[k][2], 1e-12);
    for (int i = 0; i < 2; i++) {
      const PetscReal *n = touch[0].normal, t[2] = {-n[1], n[0]};
      assert_near((touch[1 + 2 * i].gap - touch[2 + 2 * i].gap) / (2 * h), n[i], 1e-9);
      for (int j = 0; j < 2; j++)
        assert_near((touch[1 + 2 * i].normal[j] - touch[2 + 2 * i].normal[j]) / (2 * h),
                    touch[0].curvature * t[j] * t[i], 1e-8);
    }
  }
  CHECK(PetscFree(u));
}

/* A punch wider than the body is a plate. */
TEST(WidePunchIsAPlate)
{
  PetscReal force[2];

  for (int punch = 0; punch < 2; punch++) {
    FIXTURE fixture;
    FixtureScene(&fixture, 4, 3, 1, 2);
    fixture.scene.macro.symmetry = LAM_AXISYMMETRIC;
    FixtureBoundary(&fixture, "bottom", 0, 0);
    if (punch) {
      FixtureIndenter(&fixture, 2, 0, 1, 0, -0.2);
      fixture.scene.macro.boundary[1].shaft = PETSC_TRUE;
    } else
      AddPlate(&fixture, "top", 0, -0.2, 0);
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    force[punch] = FixtureReaction(&fixture, "top")[1];
  }
  assert_near(force[0], force[1], 1e-8);
}

/* A cylinder whose end is a hemisphere is a sphere while it is not in deeper than its radius. */
TEST(HemisphereIsASphere)
{
  PetscReal force[2];

  for (int shaft = 0; shaft < 2; shaft++) {
    FIXTURE fixture;
    FixtureScene(&fixture, 6, 4, 1, 2);
    fixture.scene.macro.symmetry = LAM_AXISYMMETRIC;
    FixtureBoundary(&fixture, "bottom", 0, 0);
    FixtureIndenter(&fixture, 0.4, 0, 1, 0, -0.1);
    fixture.scene.macro.boundary[1].shaft = shaft ? PETSC_TRUE : PETSC_FALSE;
    fixture.scene.macro.boundary[1].edge = 0.4;
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    force[shaft] = FixtureReaction(&fixture, "top")[1];
  }
  assert_near(force[0], force[1], 1e-9);
}
