#include "macro_fixture.h"

TEST_FIXTURE_NEEDS_PETSC;

PetscErrorCode FixtureMonitor(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  Fixture *fixture = (Fixture *)ctx;

  PetscFunctionBeginUser;
  fixture->steps[fixture->step_count++] = *step;
  *stop = fixture->stop_after == step->step ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

void FixtureScene(Fixture *fixture, PetscInt nx, PetscInt ny, PetscReal height, PetscInt steps)
{
  memset(fixture, 0, sizeof(*fixture));
  fixture->stop_after = -1;
  fixture->scene.scales = (LamScales){.length = 75e-6, .stress = 0.11e6, .macro_length = 0.01};
  fixture->scene.accuracy = 0.01;
  fixture->scene.has_macro = PETSC_TRUE;
  fixture->scene.macro = (LamMacroSpec){.box = {1, height}, .elements = {nx, ny}, .steps = steps};
}

void FixtureSeal(Fixture *fixture, PetscReal turgor, PetscReal bulk_modulus)
{
  fixture->scene.turgor = turgor;
  fixture->scene.sealed = PETSC_TRUE;
  fixture->scene.water_bulk_modulus = bulk_modulus;
}

void FixtureBoundary(Fixture *fixture, const char on[], PetscReal ux, PetscReal uy)
{
  LamMacroSpec *spec = &fixture->scene.macro;
  LamBoundary *boundary = &spec->boundary[spec->boundary_count++];

  strcpy(boundary->on, on);
  boundary->given[0] = (PetscBool)!isnan(ux);
  boundary->given[1] = (PetscBool)!isnan(uy);
  boundary->displacement[0] = isnan(ux) ? 0 : ux;
  boundary->displacement[1] = isnan(uy) ? 0 : uy;
}

LamBoundary *FixtureAdd(Fixture *fixture, const char on[], LamBoundaryKind kind)
{
  LamMacroSpec *spec = &fixture->scene.macro;
  LamBoundary *boundary = &spec->boundary[spec->boundary_count++];

  *boundary = (LamBoundary){.kind = kind};
  strcpy(boundary->on, on);
  return boundary;
}

void FixtureSymmetry(Fixture *fixture)
{
  FixtureAdd(fixture, "left", LAM_BOUNDARY_SYMMETRY);
  FixtureAdd(fixture, "bottom", LAM_BOUNDARY_SYMMETRY);
}

void FixtureIndenter(Fixture *fixture, PetscReal radius, PetscReal x, PetscReal y, PetscReal ux, PetscReal uy)
{
  LamBoundary *boundary = FixtureAdd(fixture, "top", LAM_BOUNDARY_INDENTER);

  boundary->radius = radius;
  boundary->at[0] = x;
  boundary->at[1] = y;
  boundary->displacement[0] = ux;
  boundary->displacement[1] = uy;
}

void FixtureInflate(Fixture *fixture)
{
  fixture->scene.turgor = 0.4;
  fixture->scene.macro.inflate = PETSC_TRUE;
}

void FixtureLegs(Fixture *fixture, PetscInt n, const LamLeg legs[])
{
  fixture->scene.macro.leg_count = n;
  memcpy(fixture->scene.macro.legs, legs, (size_t)n * sizeof(*legs));
}

void FixtureDisc(Fixture *fixture, LamDiscPart part, PetscInt along, PetscInt across)
{
  fixture->scene.macro.source = LAM_MESH_DISC;
  fixture->scene.macro.disc = part;
  fixture->scene.macro.elements[0] = along;
  fixture->scene.macro.elements[1] = across;
}

void FixtureQuarterDisc(Fixture *fixture, PetscInt n, PetscInt steps)
{
  FixtureScene(fixture, n, n, 1, steps);
  FixtureDisc(fixture, LAM_DISC_QUARTER, n, n);
  FixtureSymmetry(fixture);
}

const PetscReal *FixtureReaction(const Fixture *fixture, const char name[])
{
  const LamMacroStep *step = &fixture->steps[fixture->step_count - 1];

  for (PetscInt s = 0; s < step->boundary_count; s++) {
    if (!strcmp(step->boundary[s], name)) return step->reaction[s];
  }
  fail_msg("no side %s", name);
  return NULL;
}

void FixtureSetUp(Fixture *fixture, MPI_Comm comm)
{
  PetscInt points;

  CHECK(LamMacroCreate(comm, &fixture->macro));
  CHECK(LamMacroSetScene(fixture->macro, &fixture->scene));
  CHECK(LamMacroSetUp(fixture->macro));
  CHECK(LamMacroGetPointCount(fixture->macro, &points));
  CHECK(SyntheticCreate(points, &fixture->responder, &fixture->material));
  CHECK(LamMacroSetResponder(fixture->macro, fixture->responder));
  CHECK(LamMacroSetMonitor(fixture->macro, FixtureMonitor, fixture));
}

void FixtureRefused(Fixture *fixture)
{
  CHECK(LamMacroCreate(PETSC_COMM_WORLD, &fixture->macro));
  CHECK(LamMacroSetScene(fixture->macro, &fixture->scene));
  CHECK(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  assert_int_equal(LamMacroSetUp(fixture->macro), PETSC_ERR_USER_INPUT);
  CHECK(PetscPopErrorHandler());
}

void FixtureSolve(Fixture *fixture, LamMacroReason reason)
{
  CHECK(LamMacroSolve(fixture->macro, &fixture->reason, fixture->message));
  assert_int_equal(fixture->reason, reason);
}

void FixtureRun(Fixture *fixture, MPI_Comm comm, LamMacroReason reason)
{
  FixtureSetUp(fixture, comm);
  FixtureSolve(fixture, reason);
}

const LamMacroFields *FixtureFields(Fixture *fixture)
{
  CHECK(LamMacroGetFields(fixture->macro, &fixture->fields));
  return &fixture->fields;
}

const LamMacroStep *FixtureLast(const Fixture *fixture)
{
  assert_true(fixture->step_count > 0);
  return &fixture->steps[fixture->step_count - 1];
}

void FixtureDestroy(Fixture *fixture)
{
  CHECK(LamMacroFieldsDestroy(&fixture->fields));
  CHECK(LamMacroDestroy(&fixture->macro));
  if (fixture->material) CHECK(LamResponderDestroy(&fixture->responder));
}

void FixtureShear(Fixture *fixture, PetscInt elements, PetscReal shear, PetscInt steps)
{
  FixtureScene(fixture, elements, elements, 1, steps);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureBoundary(fixture, "top", shear, 0);
}

void FixtureRollers(Fixture *fixture, PetscReal ux, PetscReal uy)
{
  FixtureBoundary(fixture, "left", 0, NAN);
  FixtureBoundary(fixture, "right", ux, NAN);
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureBoundary(fixture, "top", NAN, uy);
}

void FixtureBiaxial(Fixture *fixture, PetscReal ux, PetscReal uy, PetscInt steps)
{
  const PetscReal height = 0.6;

  FixtureScene(fixture, 3, 2, height, steps);
  FixtureRollers(fixture, ux, uy * height);
}
