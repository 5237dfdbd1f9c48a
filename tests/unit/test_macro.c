/* Claims about the macroscale solver, with a material of known answers. Runs on any number of ranks. */
#include "support/macro_fixture.h"
#include "macro_impl.h"

static PetscInt SideNumber(const LamMacroStep *step, const char name[])
{
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    if (!strcmp(step->boundary[s], name)) return s;
  }
  return -1;
}

/* Each residual is at most a constant times the square of the one before, down to rounding. */
MACRO_TEST(NewtonIsQuadratic)
{
  FixtureShear(fixture, 3, 0.3, 1);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroStep *step = FixtureLast(fixture);
  assert_true(step->residual_count >= 4);
  for (PetscInt k = 1; k + 1 < step->residual_count; k++)
    assert_true(step->residuals[k + 1] < 2 * PetscSqr(step->residuals[k]) + 1e-14);
}

MACRO_TEST(InflationIsFreeOfStress)
{
  FixtureShear(fixture, 2, 0.1, 1);
  FixtureInflate(fixture);
  fixture->stop_after = 0;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_STOPPED);
  assert_int_equal(FixtureLast(fixture)->step, 0);
  assert_true(PetscAbsReal(FixtureLast(fixture)->turgor_mean - 0.4) < 1e-14);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++) {
    for (PetscInt k = 0; k < 8; k++) assert_true(PetscAbsReal(fields->P[9 * e + k]) < 1e-11);
    assert_true(fields->F[9 * e] > 1.05); /* it has grown */
  }
}

/* A body that swells freely keeps its directions, and its corner; its state is guessed from one point's. */
MACRO_TEST(InflatedBodyDoesNotTurn)
{
  FixtureScene(fixture, 3, 2, 0.6, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureInflate(fixture);
  fixture->stop_after = 0;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_STOPPED);
  assert_true(FixtureLast(fixture)->newton_iterations <= 1);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt n = 0; n < fields->node_count; n++) {
    for (int i = 0; i < 2; i++)
      assert_true(PetscAbsReal(fields->u[2 * n + i] - (fields->F[0] - 1) * fields->nodes[2 * n + i]) < 1e-9);
  }
}

/* After inflation the sides count from where they are: without displacement nothing happens. */
MACRO_TEST(DisplacementsCountFromInflated)
{
  FixtureShear(fixture, 2, 0, 1);
  FixtureInflate(fixture);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_int_equal(fixture->step_count, 2);
  assert_true(PetscAbsReal(FixtureLast(fixture)->reaction[0][1]) < 1e-9);
}

/* Without `inflate` the turgor presses against the held sides: they pull the body together. */
MACRO_TEST(TurgorPressesOnHeldSides)
{
  FixtureBiaxial(fixture, 0, 0, 1);
  fixture->scene.turgor = 0.4;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroStep *step = FixtureLast(fixture);
  assert_int_equal(fixture->step_count, 1);
  assert_int_equal(step->step, 1);
  assert_true(PetscAbsReal(step->reaction[SideNumber(step, "top")][1] + 0.4) < 1e-12);
}

MACRO_TEST(ReactionsBalance)
{
  FixtureScene(fixture, 2, 3, 1, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureBoundary(fixture, "left", 0, NAN);
  FixtureBoundary(fixture, "top", NAN, 0.2);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroStep *step = FixtureLast(fixture);
  for (PetscInt i = 0; i < 2; i++) {
    PetscReal sum = 0;
    for (PetscInt s = 0; s < step->boundary_count; s++) sum += step->reaction[s][i];
    assert_true(PetscAbsReal(sum) < 1e-9);
  }
  assert_true(step->reaction[SideNumber(step, "top")][1] > 0.1);
}

/* A step that the material cannot follow is cut, and the end is the same as without that limit. */
TEST(CutbackReachesTheSameEnd)
{
  FIXTURE cut, whole;

  FixtureShear(&cut, 2, 0.4, 1);
  FixtureSetUp(&cut, PETSC_COMM_WORLD);
  cut.material->largest_step = 0.25;
  FixtureSolve(&cut, LAM_MACRO_DONE);
  FixtureShear(&whole, 2, 0.4, 1);
  FixtureRun(&whole, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_int_equal(cut.reason, LAM_MACRO_DONE);
  assert_true(FixtureLast(&cut)->cutbacks > 0);
  assert_int_equal(FixtureLast(&whole)->cutbacks, 0);
  assert_true(cut.material->rejects >= FixtureLast(&cut)->cutbacks); /* predictions that fail are rejected, too */
  assert_true(PetscAbsReal(FixtureLast(&cut)->reaction[1][0] - FixtureLast(&whole)->reaction[1][0]) < 1e-9);
}

/* An increment that would change a point's deformation by more than 0.75 is cut before the material is asked. */
MACRO_TEST(StrayIterationsAreNotAskedFor)
{
  FixtureBiaxial(fixture, 1.2, 0, 1);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->material->largest_step = 0.75;
  FixtureSolve(fixture, LAM_MACRO_DONE);
  assert_true(FixtureLast(fixture)->cutbacks > 0);
  assert_int_equal(FixtureLast(fixture)->failures, 0);
}

/* Where the material has no answer any more, the run ends, keeps its steps and names a point that failed. */
MACRO_TEST(FailureNamesThePoint)
{
  FixtureBiaxial(fixture, 0.5, 0, 5);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->material->largest_strain = 0.25;
  FixtureSolve(fixture, LAM_MACRO_NOT_CONVERGED);
  assert_non_null(strstr(fixture->message, "step 3"));
  assert_non_null(strstr(fixture->message, "in element "));
  assert_non_null(strstr(fixture->message, "turgor 0 MPa"));
  assert_non_null(strstr(fixture->message, "not_converged: too far"));
}

/* The increments of a step that fails later are reported, as a step that came part of its way. */
MACRO_TEST(PartOfAStepIsReported)
{
  FixtureBiaxial(fixture, 0.5, 0, 5);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->material->largest_strain = 0.23;
  FixtureSolve(fixture, LAM_MACRO_NOT_CONVERGED);
  assert_int_equal(fixture->step_count, 3);
  const LamMacroStep *step = FixtureLast(fixture);
  assert_int_equal(step->step, 3);
  assert_true(step->load_factor > 0.45 && step->load_factor <= 0.46);
  assert_true(step->work > fixture->steps[1].work);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++)
    assert_true(PetscAbsReal(fields->F[9 * e] - 1 - 0.5 * step->load_factor) < 1e-9);
}

/* A step of which nothing converged is not reported. */
MACRO_TEST(NothingReachedIsNotReported)
{
  FixtureBiaxial(fixture, 0.5, 0, 2);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->material->largest_strain = 1e-6;
  FixtureSolve(fixture, LAM_MACRO_NOT_CONVERGED);
  assert_int_equal(fixture->step_count, 0);
}

/* The longest reason that a solver can give is told whole, and the point behind it. */
MACRO_TEST(ReasonIsNotCutOff)
{
  char reason[sizeof(((LamResponse *)NULL)->reason)];

  memset(reason, 'x', sizeof(reason) - 1);
  reason[sizeof(reason) - 1] = '\0';
  FixtureBiaxial(fixture, 0.5, 0, 1000);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->material->largest_strain = 1e-6;
  fixture->material->reason = reason;
  FixtureSolve(fixture, LAM_MACRO_NOT_CONVERGED);
  assert_non_null(strstr(fixture->message, reason));
  assert_non_null(strstr(fixture->message, "turgor 0 MPa"));
}

static const PetscInt *Batches; /* so many have been answered */
static PetscInt MostBatches;

static PetscBool CountedStop(void)
{
  return (PetscBool)(*Batches >= MostBatches);
}

/* A stop ends the run in the middle of a load step, on the word of one rank, at the last converged increment. */
TEST(StopEndsWithinAStep)
{
  PetscMPIInt rank;
  PetscInt calls;
  Fixture fixture;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  FixtureShear(&fixture, 2, 0.4, 2);
  FixtureRun(&fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  calls = fixture.material->calls;
  FixtureDestroy(&fixture);
  FixtureShear(&fixture, 2, 0.4, 2);
  FixtureSetUp(&fixture, PETSC_COMM_WORLD);
  Batches = &fixture.material->calls;
  MostBatches = rank == 0 ? calls - 1 : 2 * calls;
  CHECK(LamMacroSetStop(fixture.macro, CountedStop));
  FixtureSolve(&fixture, LAM_MACRO_STOPPED);
  assert_int_equal(fixture.step_count, 1);
  assert_int_equal(fixture.material->calls, calls - 1);
  assert_int_equal(fixture.material->rejects, 1);
  FixtureDestroy(&fixture);
}

/* An element's Cauchy stress is the mean over its present volume: times that, it adds up to the virial sum P F^T. */
MACRO_TEST(CauchyIsTheMeanOverThePresentVolume)
{
  PetscReal error = 0, of_means = 0;
  OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;

  FixtureShear(fixture, 2, 0.6, 2);
  FixtureRun(fixture, PETSC_COMM_SELF, LAM_MACRO_DONE);
  LamMacro macro = fixture->macro;
  CHECK(LamMacroGetFields(macro, &fields));
  for (PetscInt e = 0; e < fields.element_count; e++) {
    const PetscReal *F = &fields.F[9 * e], *P = &fields.P[9 * e], *cauchy = NULL;
    PetscReal virial[2][2] = {{0}}, volume = 0, G[9];
    for (PetscInt q = 9 * e; q < 9 * e + 9; q++) {
      const LamMaterialPoint *point = &macro->accepted[q];
      volume += macro->weight[q] * SyntheticInverseTranspose(point->load.F, G);
      for (int ij = 0; ij < 4; ij++) {
        for (int k = 0; k < 3; k++)
          virial[ij / 2][ij % 2] += macro->weight[q] * point->P[3 * (ij / 2) + k] * point->load.F[3 * (ij % 2) + k];
      }
    }
    cauchy = &fields.cauchy[9 * macro->elements[e].number];
    for (int ij = 0; ij < 4; ij++)
      error = PetscMax(error, PetscAbsReal(cauchy[3 * (ij / 2) + ij % 2] - virial[ij / 2][ij % 2] / volume));
    of_means = PetscMax(
        of_means, PetscAbsReal(fields.cauchy[9 * e] - (P[0] * F[0] + P[1] * F[1]) / SyntheticInverseTranspose(F, G)));
  }
  assert_true(error < 1e-13);
  assert_true(of_means > 1e-4); /* the stress of the means is another one */
}

/* The last converged state serves the next step's first iteration: the material is asked once per iteration. */
MACRO_TEST(NothingIsAskedTwice)
{
  PetscInt iterations = 0;

  FixtureShear(fixture, 2, 0.2, 2);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  for (PetscInt k = 0; k < fixture->step_count; k++) iterations += fixture->steps[k].newton_iterations;
  assert_int_equal(fixture->material->calls, 1 + iterations);
}

/* Points, and their numbers, are summed over the ranks. */
MACRO_TEST(CountsAreOfAllRanks)
{
  FixtureShear(fixture, 2, 0.1, 1);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  assert_int_equal(FixtureLast(fixture)->queries, 36 * fixture->material->calls);
}

MACRO_TEST(MonitorStopsTheRun)
{
  FixtureShear(fixture, 2, 0.2, 4);
  fixture->stop_after = 2;
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_STOPPED);
  assert_int_equal(fixture->step_count, 2);
}

/* Reactions, work and fields are those of one rank. */
TEST(RanksDoNotMatter)
{
  FIXTURE one, all;
  LamMacroFields fields_one, fields_all;

  FixtureShear(&one, 4, 0.3, 2);
  FixtureRun(&one, PETSC_COMM_SELF, LAM_MACRO_DONE);
  FixtureShear(&all, 4, 0.3, 2);
  FixtureRun(&all, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroStep *a = FixtureLast(&one), *b = FixtureLast(&all);
  assert_true(PetscAbsReal(a->reaction[1][0] - b->reaction[1][0]) < 1e-11);
  assert_true(PetscAbsReal(a->work - b->work) < 1e-11);
  CHECK(LamMacroGetFields(one.macro, &fields_one));
  CHECK(LamMacroGetFields(all.macro, &fields_all));
  for (PetscInt k = 0; k < 2 * fields_all.node_count; k++) {
    assert_true(fields_one.nodes[k] == fields_all.nodes[k]);
    assert_true(PetscAbsReal(fields_one.u[k] - fields_all.u[k]) < 1e-11);
  }
  for (PetscInt k = 0; k < 9 * fields_all.element_count; k++) {
    assert_int_equal(fields_one.elements[k], fields_all.elements[k]);
    assert_true(PetscAbsReal(fields_one.P[k] - fields_all.P[k]) < 1e-11);
  }
  CHECK(LamMacroFieldsDestroy(&fields_one));
  CHECK(LamMacroFieldsDestroy(&fields_all));
}

/* Elements are listed as VTK wants them: corners counter-clockwise, mid-edges, centre. */
MACRO_TEST(ElementsAreInOrder)
{
  FixtureScene(fixture, 3, 2, 0.5, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureSetUp(fixture, PETSC_COMM_SELF);
  const LamMacroFields *fields = FixtureFields(fixture);
  assert_int_equal(fields->element_count, 6);
  assert_int_equal(fields->node_count, 35);
  for (PetscInt e = 0; e < fields->element_count; e++) {
    const PetscInt *element = &fields->elements[9 * e];
    const PetscReal *X[9];
    for (int a = 0; a < 9; a++) X[a] = &fields->nodes[2 * element[a]];
    for (int i = 0; i < 2; i++) {
      for (int a = 0; a < 4; a++) assert_true(PetscAbsReal(X[4 + a][i] - 0.5 * (X[a][i] + X[(a + 1) % 4][i])) < 1e-14);
      assert_true(PetscAbsReal(X[8][i] - 0.5 * (X[0][i] + X[2][i])) < 1e-14);
    }
    PetscReal twice_area = (X[1][0] - X[0][0]) * (X[3][1] - X[0][1]) - (X[1][1] - X[0][1]) * (X[3][0] - X[0][0]);
    assert_true(PetscAbsReal(twice_area - 1. / 12) < 1e-14);
  }
}

MACRO_TEST(ContradictingSidesAreRefused)
{
  FixtureShear(fixture, 2, 0.1, 1);
  FixtureBoundary(fixture, "left", 0, NAN);
  FixtureRefused(fixture);
}

MACRO_TEST(LooseBodyIsRefused)
{
  FixtureScene(fixture, 2, 2, 1, 1);
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureBoundary(fixture, "top", NAN, 0.1);
  FixtureRefused(fixture);
}
