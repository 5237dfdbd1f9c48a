/* Load control past limit points: a clamped shallow arch under dead load snaps through. */
#include "support/gmsh_writer.h"
#include "support/macro_fixture.h"
#include "macro_impl.h"
#include <unistd.h>

static const PetscReal OPENING = 0.35, THICKNESS = 0.015, LOAD = 0.01;
static char Path[PETSC_MAX_PATH_LEN];

/* Half an arch of radius 1 about (0, -1): s = 0 is its middle, s = 1 its end. */
static void Arch(double X[2])
{
  const double radius = 1 + THICKNESS * (X[1] - 0.5), angle = OPENING * X[0];

  X[0] = radius * sin(angle);
  X[1] = radius * cos(angle) - 1;
}

static void ArchScene(Fixture *fixture, PetscInt steps)
{
  FixtureScene(fixture, 1, 1, 1, steps);
  fixture->scene.macro.source = LAM_MESH_GMSH;
  strcpy(fixture->scene.macro.gmsh, Path);
  FixtureBoundary(fixture, "right", 0, 0);
  FixtureAdd(fixture, "left", LAM_BOUNDARY_SYMMETRY);
  FixtureAdd(fixture, "top", LAM_BOUNDARY_TRACTION)->traction[1] = -LOAD;
}

/* Displacement of the middle of the arch. */
static PetscReal Sag(const Fixture *fixture)
{
  OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;
  PetscReal sag = 0;

  CHECK(LamMacroGetFields(fixture->macro, &fields));
  for (PetscInt n = 0; n < fields.node_count; n++) {
    if (PetscAbsReal(fields.nodes[2 * n]) < 1e-12 && PetscAbsReal(fields.nodes[2 * n + 1]) < 1e-12)
      sag = fields.u[2 * n + 1];
  }
  return sag;
}

/* The load rises to 4.9e-5, falls to 1.3e-5 beyond the limit point, and rises again on the other side. */
MACRO_TEST(TheForceFallsAndTheRunGoesOn)
{
  const PetscInt steps = 30;
  PetscInt falls = 0, rises = 0;

  ArchScene(fixture, steps);
  strcpy(fixture->scene.macro.control.on, "left");
  fixture->scene.macro.control.component = 1;
  fixture->scene.macro.control.displacement = -0.15;
  FixtureRun(fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  for (PetscInt k = 0; k < fixture->step_count; k++) {
    const PetscReal now = -fixture->steps[k].reaction[2][1], before = k ? -fixture->steps[k - 1].reaction[2][1] : 0;
    if (now < before) falls++;
    if (falls && now > before) rises++;
  }
  assert_int_equal(fixture->reason, LAM_MACRO_DONE);
  assert_true(falls >= 3 && rises >= 3);
  assert_int_equal(FixtureLast(fixture)->cutbacks, 0);
}

/* Before the limit, the load that control finds gives the same state where it is prescribed. */
TEST(ControlAndLoadAgree)
{
  PetscReal factor, sag;
  Fixture fixture;

  ArchScene(&fixture, 4);
  strcpy(fixture.scene.macro.control.on, "left");
  fixture.scene.macro.control.component = 1;
  fixture.scene.macro.control.displacement = -0.01;
  FixtureRun(&fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  factor = fixture.macro->borders[0].now;
  sag = Sag(&fixture);
  FixtureDestroy(&fixture);
  ArchScene(&fixture, 4);
  fixture.scene.macro.boundary[2].traction[1] *= factor;
  FixtureRun(&fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  assert_true(PetscAbsReal(Sag(&fixture) - sag) < 1e-8);
  FixtureDestroy(&fixture);
}

static int WriteArch(void **state)
{
  GmshWrite(Path, 12, 1, GMSH_QUADRILATERALS, Arch);
  return 0;
}

static int RemoveArch(void **state)
{
  return remove(Path);
}

TEST_GROUP(.petsc = 1, .setup = WriteArch, .teardown = RemoveArch);
