/* Claims about the loads of the macroscale solver, with a material of known answers. Runs on any number of ranks. */
#include "support/macro_tangent.h"
#include "macro_impl.h"

static void Set(PetscReal vector[2], PetscReal x, PetscReal y)
{
  vector[0] = x;
  vector[1] = y;
}

/* P of the material at F = diag(a, b, 1). */
static void Exact(const Fixture *fixture, PetscReal a, PetscReal b, LamResponse *exact)
{
  const LamLoad load = {.F = {a, 0, 0, 0, b, 0, 0, 0, 1}};

  CHECK(LamResponseInit(&load, exact));
  SyntheticEvaluate(fixture->material, &load, exact);
}

/* Largest difference of F from that of element 0, and F there. */
static PetscReal Spread(const Fixture *fixture, PetscReal F[9])
{
  PetscReal spread = 0;
  OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;

  CHECK(LamMacroGetFields(fixture->macro, &fields));
  for (PetscInt k = 0; k < 9 * fields.element_count; k++)
    spread = PetscMax(spread, PetscAbsReal(fields.F[k] - fields.F[k % 9]));
  if (fields.element_count) CHECK(PetscArraycpy(F, fields.F, 9));
  MPI_Bcast(F, 9, MPIU_REAL, 0, PETSC_COMM_WORLD);
  MPI_Bcast(&spread, 1, MPIU_REAL, 0, PETSC_COMM_WORLD);
  return spread;
}

/* Prescribed components included. */
MACRO_TEST(TangentUnderTurgor)
{
  FixtureShear(fixture, 2, 0.1, 1);
  fixture->scene.turgor = 0.3;
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->macro->turgor = 1; /* all of it */
  CheckTangent(fixture, 0.03);
}

MACRO_TEST(TangentWithAllLoads)
{
  LamBoundary *boundary;

  FixtureScene(fixture, 3, 3, 1, 1);
  FixtureAdd(fixture, "left", LAM_BOUNDARY_SYMMETRY);
  boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION);
  Set(boundary->traction, 0.2, -0.3);
  boundary->follower = PETSC_TRUE;
  Set(FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION)->traction, 0.1, 0.2);
  FixtureIndenter(fixture, 0.4, 0.5, 1, 0.01, -0.3);
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  CheckTangent(fixture, 0.03);
  assert_true(fixture->macro->row_count > 0);
}

/* With the factor of the tractions as an unknown, a grip that moves freely sideways, and a plate. */
MACRO_TEST(TangentWithBorders)
{
  LamBoundary *boundary;

  FixtureScene(fixture, 3, 3, 1, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  boundary = FixtureAdd(fixture, "top", LAM_BOUNDARY_GRIP);
  boundary->given[1] = PETSC_TRUE;
  boundary->displacement[1] = 0.1;
  boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_PRESSURE);
  boundary->follower = PETSC_TRUE;
  boundary->traction[1] = -0.7;
  Set(FixtureAdd(fixture, "top", LAM_BOUNDARY_TRACTION)->traction, 0.4, 0);
  Set(FixtureAdd(fixture, "left", LAM_BOUNDARY_PLATE)->displacement, 0.02, 0);
  strcpy(fixture->scene.macro.control.on, "right");
  fixture->scene.macro.control.displacement = 0.1;
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  assert_int_equal(fixture->macro->border_count, 2);
  CheckTangent(fixture, 0.03);
}

/* Dead tractions on two sides: P is the traction everywhere, exactly. */
MACRO_TEST(DeadTractionIsUniform)
{
  FixtureScene(fixture, 3, 2, 0.6, 4);
  FixtureLegs(fixture, 2,
              (LamLeg[]){{0.9999, 3}, {1, 1}}); /* so short that Newton's last iteration ends far below its tolerance */
  FixtureSymmetry(fixture);
  Set(FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION)->traction, 0.5, 0);
  Set(FixtureAdd(fixture, "top", LAM_BOUNDARY_TRACTION)->traction, 0, -0.3);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->macro->extrapolates = PETSC_FALSE;
  FixtureSolve(fixture, LAM_MACRO_DONE);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++) {
    assert_true(PetscAbsReal(fields->P[9 * e] - 0.5) < 1e-11);
    assert_true(PetscAbsReal(fields->P[9 * e + 4] + 0.3) < 1e-11);
    assert_true(PetscAbsReal(fields->P[9 * e + 1]) + PetscAbsReal(fields->P[9 * e + 3]) < 1e-11);
  }
  assert_true(PetscAbsReal(FixtureReaction(fixture, "left")[0] + 0.3) < 1e-10);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "right")[0] - 0.3) < 1e-12);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "bottom")[1] - 0.3) < 1e-10);
}

/* A pressure on a disc's rim: the Cauchy stress is -p everywhere, in the same F. */
MACRO_TEST(PressureOnADiscIsUniform)
{
  const PetscReal p = 0.4;
  PetscReal F[9];
  LamBoundary *boundary;

  FixtureQuarterDisc(fixture, 2, 2);
  boundary = FixtureAdd(fixture, "rim", LAM_BOUNDARY_PRESSURE);
  boundary->traction[1] = -p;
  boundary->follower = PETSC_TRUE;
  FixtureLegs(fixture, 2, (LamLeg[]){{0.999, 1}, {1, 1}}); /* as above */
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->macro->extrapolates = PETSC_FALSE;
  FixtureSolve(fixture, LAM_MACRO_DONE);
  assert_true(Spread(fixture, F) < 1e-10);
  assert_true(F[0] < 0.99);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++) {
    assert_true(PetscAbsReal(fields->cauchy[9 * e] + p) < 1e-10);
    assert_true(PetscAbsReal(fields->cauchy[9 * e + 4] + p) < 1e-10);
    assert_true(PetscAbsReal(fields->cauchy[9 * e + 1]) < 1e-10);
  }
}

/* Put x = F X on the whole body. */
static void Deform(LamMacro macro, const PetscReal F[4])
{
  PetscScalar *u;

  CHECK(VecGetArray(macro->u, &u));
  for (PetscInt k = 0; k < macro->node_count; k++) {
    const PetscReal *X = macro->nodes[k].X;
    const PetscInt local = macro->nodes[k].local;
    for (int i = 0; i < 2; i++) u[local + i] = F[2 * i] * X[0] + F[2 * i + 1] * X[1] - X[i];
  }
  CHECK(VecRestoreArray(macro->u, &u));
}

/* The right side of a square becomes F e2: tangent F e2, outward normal that turned by -90 degrees, per present length.
 */
MACRO_TEST(FollowerTractionTurns)
{
  const PetscReal F[4] = {1.1, -0.8, 0.3, 0.7}, t[2] = {0.3, -0.2};
  PetscReal sum[2];
  LamBoundary *boundary;

  FixtureShear(fixture, 2, 0, 1);
  boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION);
  Set(boundary->traction, t[0], t[1]);
  boundary->follower = PETSC_TRUE;
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  CHECK(LamMacroSetLoadFactor(fixture->macro, 1));
  Deform(fixture->macro, F);
  CHECK(LamMacroTractionSum(fixture->macro, 2, fixture->macro->u, sum));
  assert_true(PetscAbsReal(sum[0] - (t[0] * F[1] + t[1] * F[3])) < 1e-14);
  assert_true(PetscAbsReal(sum[1] - (t[0] * F[3] - t[1] * F[1])) < 1e-14);
}

/* A plate on a whole side moves it as rollers do. */
MACRO_TEST(PlateIsRollers)
{
  PetscReal F[9];
  LamResponse exact;

  FixtureScene(fixture, 3, 2, 0.6, 2);
  FixtureSymmetry(fixture);
  FixtureBoundary(fixture, "right", 0.05, NAN);
  Set(FixtureAdd(fixture, "top", LAM_BOUNDARY_PLATE)->displacement, 0, -0.12);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_true(Spread(fixture, F) < 1e-11);
  assert_true(PetscAbsReal(F[0] - 1.05) + PetscAbsReal(F[4] - 0.8) < 1e-11);
  Exact(fixture, 1.05, 0.8, &exact);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "top")[1] - exact.P[4]) < 1e-10);
  assert_true(FixtureReaction(fixture, "top")[0] == 0);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "right")[0] - 0.6 * exact.P[0]) < 1e-10);
}

/* A quarter disc under a plate: the force is that of the mirrored problem, and the contact grows from a point. */
TEST(DiscUnderAPlateIsSymmetric)
{
  PetscReal force[2];

  for (int mirrored = 0; mirrored < 2; mirrored++) {
    FIXTURE fixture;
    LamBoundary *plate;
    FixtureQuarterDisc(&fixture, 3, 4);
    plate = FixtureAdd(&fixture, "rim", LAM_BOUNDARY_PLATE);
    plate->displacement[1 - mirrored] = -0.3;
    plate->normal[1 - mirrored] = -1;
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    assert_true(fixture.macro->violation < 1e-10);
    force[mirrored] = FixtureReaction(&fixture, "rim")[1 - mirrored];
    for (PetscInt k = 1; k < 4; k++)
      assert_true(PetscAbsReal(fixture.steps[k].reaction[2][1 - mirrored]) >
                  PetscAbsReal(fixture.steps[k - 1].reaction[2][1 - mirrored]));
    const char *held = mirrored ? "left" : "bottom";
    assert_true(PetscAbsReal(FixtureReaction(&fixture, held)[1 - mirrored] + force[mirrored]) < 1e-8);
  }
  assert_true(force[0] < -0.1);
  assert_true(PetscAbsReal(force[0] - force[1]) < 1e-8);
}

/* An indenter that goes back leaves the body free of stress. */
MACRO_TEST(UnloadingLeaves)
{
  PetscReal F[9];

  FixtureScene(fixture, 4, 4, 1, 6);
  FixtureLegs(fixture, 2, (LamLeg[]){{1, 4}, {-0.5, 2}});
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureIndenter(fixture, 0.3, 0.5, 1, 0, -0.15);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_int_equal(fixture->step_count, 6);
  assert_true(fixture->steps[3].reaction[1][1] < -0.05);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "top")[1]) < 1e-8);
  assert_true(Spread(fixture, F) < 1e-8);
}

/* Soft tissue under a plate that goes back in one step follows it as far as it was pressed, and no farther. */
MACRO_TEST(OneStepBackIsEnough)
{
  LamBoundary *plate;

  FixtureQuarterDisc(fixture, 3, 4);
  FixtureLegs(fixture, 3, (LamLeg[]){{1, 2}, {0.5, 1}, {-1, 1}});
  plate = FixtureAdd(fixture, "rim", LAM_BOUNDARY_PLATE);
  Set(plate->displacement, 0, -0.2);
  Set(plate->normal, 0, -1);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->material->mu = 0.02;
  fixture->material->lambda = 0.04;
  FixtureSolve(fixture, LAM_MACRO_DONE);
  for (PetscInt k = 0; k < 3; k++) assert_int_equal(fixture->steps[k].cutbacks, 0);
  assert_true(PetscAbsReal(fixture->steps[2].reaction[2][1] - fixture->steps[0].reaction[2][1]) < 1e-8);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "rim")[1]) < 1e-9);
}

/* A grip that may move sideways bears no force there, and none of its nodes moves otherwise. */
MACRO_TEST(FreeGripBearsNoForce)
{
  LamBoundary *grip;

  FixtureScene(fixture, 3, 3, 1, 2);
  FixtureBoundary(fixture, "bottom", 0, 0);
  Set(FixtureAdd(fixture, "right", LAM_BOUNDARY_TRACTION)->traction, 0, 0.2);
  grip = FixtureAdd(fixture, "top", LAM_BOUNDARY_GRIP);
  grip->given[0] = PETSC_TRUE;
  grip->displacement[0] = 0.3;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "top")[1]) < 1e-9);
  assert_true(FixtureReaction(fixture, "top")[0] > 0.1);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "right")[1] - 0.2) < 1e-12);
  const LamMacroFields *fields = FixtureFields(fixture);
  PetscReal up = NAN;
  for (PetscInt k = 0; k < fields->node_count; k++) {
    if (fields->nodes[2 * k + 1] != 1) continue;
    if (isnan(up)) up = fields->u[2 * k + 1];
    assert_true(PetscAbsReal(fields->u[2 * k] - 0.3) < 1e-12);
    assert_true(PetscAbsReal(fields->u[2 * k + 1] - up) < 1e-12);
  }
}

/* Histories: first pressed, then sheared; the same end as both at once. */
TEST(HistoriesGoOneAfterTheOther)
{
  PetscReal force[2][2];

  for (int history = 0; history < 2; history++) {
    FIXTURE fixture;
    FixtureShear(&fixture, 2, 0.2, 4);
    fixture.scene.macro.boundary_count = 1;
    FixtureBoundary(&fixture, "top", 0.2, NAN);
    FixtureBoundary(&fixture, "top", NAN, -0.1);
    if (history) {
      FixtureLegs(&fixture, 1, (LamLeg[]){{2, 4}});
      fixture.scene.macro.boundary[1].history = (LamHistory){2, {1, 2}, {0, 1}};
      fixture.scene.macro.boundary[2].history = (LamHistory){2, {0, 1}, {0, 1}};
    }
    FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
    if (history) assert_true(PetscAbsReal(fixture.steps[1].reaction[1][0]) < 1e-9); /* not sheared yet */
    for (int i = 0; i < 2; i++) force[history][i] = FixtureReaction(&fixture, "top")[i];
  }
  for (int i = 0; i < 2; i++) assert_true(PetscAbsReal(force[0][i] - force[1][i]) < 1e-8);
}

/* There and back again, twice: no force is left, and the work of an elastic body is none. */
MACRO_TEST(CyclesReturn)
{
  FixtureShear(fixture, 3, 0.3, 16);
  FixtureLegs(fixture, 2, (LamLeg[]){{1, 4}, {0, 4}});
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_int_equal(fixture->step_count, 16);
  assert_true(fixture->steps[3].work > 0.01);
  assert_true(PetscAbsReal(fixture->steps[11].load_factor - 1) < 1e-14);
  assert_true(PetscAbsReal(FixtureReaction(fixture, "top")[0]) < 1e-8);
  assert_true(PetscAbsReal(FixtureLast(fixture)->work) < 1e-9);
}

static PetscInt Iterations(Fixture *fixture)
{
  PetscInt iterations = 0;

  FixtureSolve(fixture, LAM_MACRO_DONE);
  for (PetscInt k = 0; k < fixture->step_count; k++) iterations += fixture->steps[k].newton_iterations;
  return iterations;
}

/* Predictions end at the same state, with fewer iterations. */
TEST(PredictionsSaveIterations)
{
  PetscInt iterations[2];
  PetscReal force[2];

  for (int predict = 0; predict < 2; predict++) {
    FIXTURE fixture;
    FixtureShear(&fixture, 3, 0.5, 20);
    FixtureSetUp(&fixture, PETSC_COMM_WORLD);
    fixture.macro->extrapolates = predict ? PETSC_TRUE : PETSC_FALSE;
    iterations[predict] = Iterations(&fixture);
    force[predict] = FixtureReaction(&fixture, "top")[0];
  }
  assert_true(PetscAbsReal(force[0] - force[1]) < 1e-9);
  assert_true(iterations[1] < 0.8 * iterations[0]);
}

/* An indenter that nodes touch one after the other takes Newton's method few iterations. */
MACRO_TEST(IndentationIsFast)
{
  FixtureScene(fixture, 8, 4, 0.5, 10);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureIndenter(fixture, 0.3, 0.5, 0.5, 0, -0.1);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  assert_true(Iterations(fixture) <= 40);
  for (PetscInt k = 0; k < 10; k++) assert_int_equal(fixture->steps[k].cutbacks, 0);
}

/* Symmetry is held during inflation: its sides stay, and the body is free of stress. */
MACRO_TEST(InflationKeepsSymmetry)
{
  FixtureQuarterDisc(fixture, 2, 1);
  FixtureInflate(fixture);
  fixture->stop_after = 0;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_STOPPED);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++)
    for (PetscInt k = 0; k < 8; k++) assert_true(PetscAbsReal(fields->P[9 * e + k]) < 1e-11);
  for (PetscInt n = 0; n < fields->node_count; n++)
    for (PetscInt i = 0; i < 2; i++)
      assert_true(fields->nodes[2 * n + i] != 0 || PetscAbsReal(fields->u[2 * n + i]) < 1e-14);
}

/* Obstacles hold no body. */
MACRO_TEST(ObstaclesDoNotHold)
{
  FixtureScene(fixture, 2, 2, 1, 1);
  FixtureBoundary(fixture, "left", 0, NAN);
  Set(FixtureAdd(fixture, "bottom", LAM_BOUNDARY_PLATE)->displacement, 0, 0);
  FixtureRefused(fixture);
}
