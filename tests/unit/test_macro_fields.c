/* Fields of the macroscale solver: what is kept of material points, their places and means. */
#include "support/macro_fixture.h"
#include "macro_impl.h"

/* Points stand for the area of the body, at places inside their elements. */
MACRO_TEST(PointsHaveTheirPlaces)
{
  PetscReal moments[3] = {0, 0, 0};

  FixtureScene(fixture, 4, 2, 0.5, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++) {
    const PetscReal *centre = &fields->nodes[2 * fields->elements[9 * e + 8]];
    for (PetscInt p = fields->first_point[e]; p < fields->first_point[e + 1]; p++) {
      const PetscReal *X = &fields->place[2 * p];
      for (int i = 0; i < 2; i++) assert_true(PetscAbsReal(X[i] - centre[i]) < 0.125);
      moments[0] += fields->volume[p];
      for (int i = 0; i < 2; i++) moments[1 + i] += fields->volume[p] * X[i];
    }
  }
  if (fields->element_count) { /* rank 0 */
    assert_int_equal(fields->point_count, 72);
    assert_near(moments[0], 0.5, 1e-14);
    assert_near(moments[1], 0.25, 1e-14);
    assert_near(moments[2], 0.125, 1e-14);
  }
}

/* A roller is no grip. */
MACRO_TEST(NodesOfClampedSidesAreGripped)
{
  FixtureScene(fixture, 4, 2, 0.5, 1);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureBoundary(fixture, "top", NAN, 0.1);
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt k = 0; k < fields->node_count; k++)
    assert_int_equal(fields->gripped[k], fields->nodes[2 * k + 1] < 1e-12);
}

/* The lumen fraction of the synthetic material is J: over the body it adds up to the present area of the body. */
MACRO_TEST(MeansAreByVolume)
{
  PetscReal area = 0, from_means = 0;

  FixtureShear(fixture, 3, 0.3, 1);
  FixtureRun(fixture, PETSC_COMM_WORLD, LAM_MACRO_DONE);
  const LamMacroFields *fields = FixtureFields(fixture);
  for (PetscInt e = 0; e < fields->element_count; e++) {
    const PetscInt at = LAM_POINT_FIELD_COUNT * e + LAM_POINT_LUMEN;
    PetscReal largest = 0, element = 0;
    for (PetscInt p = fields->first_point[e]; p < fields->first_point[e + 1]; p++) {
      const PetscReal *F = fields->load[p].F, J = fields->point[LAM_POINT_FIELD_COUNT * p + LAM_POINT_LUMEN];
      assert_near(J, F[0] * F[4] - F[1] * F[3], 1e-13);
      largest = PetscMax(largest, J);
      element += fields->volume[p];
      area += fields->volume[p] * J;
    }
    from_means += element * fields->mean[at];
    assert_near(fields->largest[at], largest, 1e-15);
  }
  assert_near(from_means, area, 1e-13);
}

/* As an interpolated response, whose tangent has this error over its size. */
static PetscReal tangent_error;

static PetscErrorCode RespondInterpolated(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                          LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(SyntheticRespond(ctx, n, loads, points, responses));
  for (PetscInt i = 0; i < n; i++) responses[i].tangent_error_estimate = tangent_error;
  PetscFunctionReturn(0);
}

/* At F = I and mu = -0.01, lambda = 2 the least value of n m A n m is mu, and A has a size of about 4. */
static PetscInt LocalisedPoints(PetscReal error)
{
  PetscInt points;
  FIXTURE fixture = {0};

  tangent_error = error;
  FixtureBiaxial(&fixture, 0, 0, 1);
  FixtureSetUp(&fixture, PETSC_COMM_WORLD);
  fixture.material->mu = -0.01;
  fixture.material->respond = RespondInterpolated;
  FixtureSolve(&fixture, LAM_MACRO_DONE);
  points = FixtureLast(&fixture)->localised_points;
  assert_near(FixtureLast(&fixture)->ellipticity, -0.01, 1e-12);
  return points;
}

TEST(LossOfEllipticityIsBeyondTheErrorOfTheTangent)
{
  assert_true(LocalisedPoints(NAN) > 0);
  assert_true(LocalisedPoints(0.002) == LocalisedPoints(NAN));
  assert_int_equal(LocalisedPoints(0.01), 0);
}

/* Faces are held closed by p + g; the family that is pressed least decides. Bonded tissue has no such measure. */
TEST(UnloadingIsOfTheLeastPressedFaces)
{
  const LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.3, .cohesion = 0.1};
  PetscReal field[LAM_POINT_FIELD_COUNT];
  LamResponse response;

  CHECK(LamResponseInit(&load, &response));
  for (int k = 0; k < 3; k++) response.mean_face_traction[k] = -0.3 + 0.1 * k; /* contact pressures 0.4, 0.3, 0.2 */
  response.min_gap = 0;
  LamMacroKeepFields(&response, field);
  assert_near(field[LAM_POINT_UNLOADING], 0.5, 1e-14);
  response.mean_face_traction[2] = 0.1;
  LamMacroKeepFields(&response, field);
  assert_near(field[LAM_POINT_UNLOADING], 1, 1e-14);
  response.min_gap = NAN;
  LamMacroKeepFields(&response, field);
  assert_true(isnan(field[LAM_POINT_UNLOADING]));
}
