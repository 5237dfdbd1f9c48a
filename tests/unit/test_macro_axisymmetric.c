/* Claims about axisymmetric bodies, with a material of known answers. Runs on any number of ranks. */
#include "support/gmsh_writer.h"
#include "support/macro_tangent.h"
#include "macro_impl.h"

/* A cylinder of radius 1 about the axis. */
static void Cylinder(Fixture *fixture, PetscInt nx, PetscInt ny, PetscReal height, PetscInt steps)
{
  FixtureScene(fixture, nx, ny, height, steps);
  fixture->scene.macro.symmetry = LAM_AXISYMMETRIC;
}

static LamResponse Exact(PetscReal around, PetscReal along, PetscReal turgor)
{
  const LamLoad load = {.F = {around, 0, 0, 0, along, 0, 0, 0, around}, .turgor = turgor};
  const Synthetic material = {.mu = 1, .lambda = 2, .phi = 1}; /* as SyntheticCreate */
  LamResponse exact;

  CHECK(LamResponseInit(&load, &exact));
  SyntheticEvaluate(&material, &load, &exact);
  return exact;
}

/* ---- the element: residual and tangent ---- */

static void AddLoads(Fixture *fixture)
{
  LamBoundary *boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION);

  boundary->traction[0] = 0.2;
  boundary->traction[1] = -0.3;
  boundary->follower = PETSC_TRUE;
  boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION);
  boundary->traction[0] = 0.1;
  boundary->traction[1] = 0.2;
  FixtureIndenter(fixture, 0.4, 0, 1, 0, -0.3);
  FixtureBoundary(fixture, "bottom", NAN, 0);
}

MACRO_TEST(TangentIsDerivativeOfResidual)
{
  Cylinder(fixture, 3, 3, 1, 1);
  AddLoads(fixture);
  fixture->scene.turgor = 0.3;
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->macro->turgor = 1;
  CheckTangent(fixture, 0.02);
}

MACRO_TEST(TangentOfTriangles)
{
  Cylinder(fixture, 3, 3, 1, 1);
  fixture->scene.macro.source = LAM_MESH_GMSH;
  GmshWrite(fixture->scene.macro.gmsh, 3, 3, GMSH_TRIANGLES, GmshDistorted);
  AddLoads(fixture);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  remove(fixture->scene.macro.gmsh);
  CheckTangent(fixture, 0.02);
}

/* With the factor of the tractions and the height of a grip as unknowns. */
MACRO_TEST(TangentWithBorders)
{
  LamBoundary *boundary;

  Cylinder(fixture, 3, 2, 1, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  boundary = FixtureAdd(fixture, "top", LAM_BOUNDARY_GRIP);
  boundary->given[0] = PETSC_TRUE;
  boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_PRESSURE);
  boundary->follower = PETSC_TRUE;
  boundary->traction[1] = -0.7;
  strcpy(fixture->scene.macro.control.on, "right");
  fixture->scene.macro.control.displacement = -0.1;
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  assert_int_equal(fixture->macro->border_count, 2);
  CheckTangent(fixture, 0.02);
}

/* ---- homogeneous bodies ---- */

/* Water that cells keep: of volume J0 at `turgor`; infinite bulk modulus: turgor is prescribed. */
typedef struct {
  PetscReal turgor, J0, bulk_modulus;
} Water;

/* The state of a cylinder of this stretch along the axis, free of traction on its mantle: by bisection. */
static LamResponse FreeCylinder(PetscReal along, const Water *water)
{
  PetscReal low = 0.5, high = 2, turgor = 0;
  LamResponse exact = {0};

  for (int it = 0; it < 100; it++) {
    const PetscReal around = 0.5 * (low + high);
    if (water) turgor = water->turgor + water->bulk_modulus * (1 - along * around * around / water->J0);
    exact = Exact(around, along, turgor);
    if (exact.P[0] > 0)
      high = around;
    else
      low = around;
  }
  return exact;
}

/* Compressed without friction it stays a cylinder; the force is stress times the area of the circle. */
static void Compress(Fixture *fixture)
{
  const PetscReal along = 0.7, area = PETSC_PI;

  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureBoundary(fixture, "top", NAN, (along - 1) * 1.5);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  FixtureSolve(fixture, LAM_MACRO_DONE);
  const LamResponse exact = FreeCylinder(along, NULL);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < 9 * fields->element_count; k++) {
    assert_near(fields->F[k], exact.load.F[k % 9], 1e-8);
    assert_near(fields->P[k], exact.P[k % 9], 1e-8);
  }
  assert_near(FixtureReaction(fixture, "top")[1], area * exact.P[4], 1e-8);
  assert_near(FixtureReaction(fixture, "bottom")[1], -area * exact.P[4], 1e-8);
  assert_near(FixtureReaction(fixture, "top")[0], 0, 1e-12);
  assert_near(FixtureLast(fixture)->work, area * 1.5 * exact.energy, 2e-3);
}

MACRO_TEST(CylinderStaysOne)
{
  Cylinder(fixture, 3, 4, 1.5, 8);
  Compress(fixture);
}

/* u_r is that of the exact body at each node: uneven triangles hold a linear field, too. */
static void GmshTall(double X[2])
{
  GmshDistorted(X);
  X[1] *= 1.5;
}

MACRO_TEST(CylinderOfTrianglesStaysOne)
{
  Cylinder(fixture, 3, 4, 1.5, 8);
  fixture->scene.macro.source = LAM_MESH_GMSH;
  GmshWrite(fixture->scene.macro.gmsh, 4, 4, GMSH_TRIANGLES, GmshTall);
  Compress(fixture);
  remove(fixture->scene.macro.gmsh);
}

/* A sphere under pressure is everywhere under it. */
MACRO_TEST(SphereUnderPressure)
{
  const PetscReal p = 0.4;
  LamBoundary *boundary;

  FixtureQuarterDisc(fixture, 2, 2);
  fixture->scene.macro.symmetry = LAM_AXISYMMETRIC;
  boundary = FixtureAdd(fixture, "rim", LAM_BOUNDARY_PRESSURE);
  boundary->traction[1] = -p;
  boundary->follower = PETSC_TRUE;
  FixtureLegs(fixture, 2, (LamLeg[]){{0.999, 1}, {1, 1}});
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->macro->extrapolates = PETSC_FALSE;
  FixtureSolve(fixture, LAM_MACRO_DONE);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < 9 * fields->element_count; k++) assert_near(fields->cauchy[k], k % 9 % 4 ? 0 : -p, 1e-9);
  PetscReal volume = 0;
  for (PetscInt q = 0; q < fields->point_count; q++) volume += fields->volume[q];
  if (fields->point_count) assert_near(volume, 2 * PETSC_PI / 3, 5e-3);
}

/* Inflated by its turgor a free cylinder of this material is free of stress. */
MACRO_TEST(InflationFreesOfStress)
{
  Cylinder(fixture, 3, 3, 1.5, 1);
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureInflate(fixture);
  fixture->stop_after = 0;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_STOPPED);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < 9 * fields->element_count; k++) assert_near(fields->P[k], 0, 1e-9);
}

/* Sealed cells: a cylinder, compressed without friction, keeps its water as one material point does. */
MACRO_TEST(SealedCylinderStaysOne)
{
  Water water = {.turgor = 0.3, .bulk_modulus = 100};
  PetscReal inflated = 1;

  for (int it = 0; it < 60; it++) inflated -= 0.1 * Exact(inflated, inflated, water.turgor).P[0];
  water.J0 = inflated * inflated * inflated;
  const LamResponse exact = FreeCylinder(0.9 * inflated, &water);
  Cylinder(fixture, 3, 2, 1, 2);
  FixtureSeal(fixture, water.turgor, water.bulk_modulus);
  fixture->scene.macro.inflate = PETSC_TRUE;
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureBoundary(fixture, "top", NAN, -0.1 * inflated);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < 9 * fields->element_count; k++) assert_near(fields->F[k], exact.load.F[k % 9], 1e-8);
  assert_near(FixtureLast(fixture)->turgor_mean, exact.load.turgor, 1e-7);
  assert_near(FixtureReaction(fixture, "top")[1], PETSC_PI * exact.P[4], 1e-7);
}

/* ---- the axis, and what cannot be ---- */

MACRO_TEST(AxisStays)
{
  Cylinder(fixture, 3, 3, 1, 2);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureBoundary(fixture, "top", NAN, -0.2);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt n = 0; n < fields->node_count; n++)
    if (fields->nodes[2 * n] == 0) assert_near(fields->u[2 * n], 0, 1e-14);
}

MACRO_TEST(AxisCannotMove)
{
  Cylinder(fixture, 2, 2, 1, 1);
  FixtureBoundary(fixture, "bottom", 0.1, 0);
  FixtureRefused(fixture);
}

MACRO_TEST(BodyBeyondTheAxisIsRefused)
{
  FixtureScene(fixture, 2, 2, 1, 1);
  FixtureDisc(fixture, LAM_DISC_HALF, 2, 2);
  fixture->scene.macro.symmetry = LAM_AXISYMMETRIC;
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureRefused(fixture);
}

MACRO_TEST(BodyMustBeHeldAlongTheAxis)
{
  Cylinder(fixture, 2, 2, 1, 1);
  FixtureBoundary(fixture, "right", 0.1, NAN);
  FixtureRefused(fixture);
}

/* The right half of a disc has the places of the half, turned. */
MACRO_TEST(RightHalfIsTheHalfTurned)
{
  PetscReal sum[2] = {0, 0};

  FixtureScene(fixture, 3, 2, 1, 1);
  FixtureDisc(fixture, LAM_DISC_RIGHT, 3, 2);
  fixture->scene.macro.symmetry = LAM_AXISYMMETRIC;
  FixtureBoundary(fixture, "rim", NAN, 0);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt q = 0; q < fields->point_count; q++) {
    assert_true(fields->place[2 * q] > 0);
    sum[0] += fields->volume[q];
    sum[1] += fields->volume[q] * fields->place[2 * q + 1];
  }
  if (!fields->point_count) return;
  assert_near(sum[0], 4 * PETSC_PI / 3, 1e-3);
  assert_near(sum[1], 0, 1e-12);
}
