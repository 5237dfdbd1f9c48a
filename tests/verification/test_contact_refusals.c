/* What is no answer is refused with its reason, and what is one is not. */
#include "rve_fixture.h"
#include "assert_near.h"
#include "figures_contact.h"
#include <string.h>

static LamResponse Solve(double clearance, LamLoad load)
{
  LamMicrostructure micro = ContactTissue(6, 2);

  micro.clearance = clearance;
  return SolveTissue(&micro, load);
}

/* Contact that begins at a distance: the drawn walls overlap by it, and that is no penetration. */
static void ClearanceIsNoPenetration(void **state)
{
  const LamResponse r = Solve(0.1, ContactLoad(1, 0, 0, 1, 0.02, 0.001));

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_near(r.max_penetration, 0.0, 1e-2);
}

/* Suction can turn a cell inside out: its walls have passed through each other. */
static void CellInsideOutIsNoAnswer(void **state)
{
  const LamResponse r = Solve(0.0, ContactLoad(1.1, 0.1, 0, 1, -0.02, 0.001));

  assert_true(r.status != LAM_CONVERGED || r.lumen_fraction > 0.0);
}

/* Thick walls have no room for a compression: they are followed from rest to where their lumens shut. */
static void LostTissueHasItsBracket(void **state)
{
  LamMicrostructure micro = ContactTissue(4, 2);
  LamResponse r;

  micro.wall_thickness = 0.95;
  r = SolveTissue(&micro, ContactLoad(1, 0, 0, 0.6, 0.02, 0.001));
  assert_int_equal(r.status, LAM_NO_EQUILIBRIUM);
  assert_non_null(strstr(r.reason, " of the way"));
  assert_non_null(strstr(r.reason, "; from rest"));
}

static void CohesionMustBeANumberAndNotNegative(void **state)
{
  const double values[] = {-0.001, NAN, INFINITY};

  for (int k = 0; k < 3; k++) {
    const LamResponse r = Solve(0.0, ContactLoad(1, 0.1, 0, 1, 0.02, values[k]));

    assert_int_equal(r.status, LAM_INVALID_F);
    assert_non_null(strstr(r.reason, "cohesion"));
  }
}

/* A failed solve leaves the state as it was, also its bonded part: the next answer does not depend on it. */
static void FailureLeavesTheState(void **state)
{
  LamMicrostructure micro = ContactTissue(6, 2);
  const LamLoad hopeless = ContactLoad(0.3, 0, 0, 0.3, 0, 0), load = ContactLoad(1, 0.1, 0, 1, 0.02, 0);
  LamResponse fresh, failed, after;
  LamRVEState point;
  LamRVE rve;

  fresh = SolveTissue(&micro, load);
  assert_int_equal(LamRVECreate(PETSC_COMM_SELF, &rve), 0);
  assert_int_equal(LamRVESetMicrostructure(rve, &micro), 0);
  assert_int_equal(LamRVESetUp(rve), 0);
  assert_int_equal(LamRVEStateCreate(rve, &point), 0);
  assert_int_equal(LamRVESolve(rve, &hopeless, point, &failed), 0);
  assert_false(LamResponseHasFields(&failed));
  assert_int_equal(LamRVESolve(rve, &load, point, &after), 0);
  assert_int_equal(after.newton_iterations, fresh.newton_iterations);
  for (int i = 0; i < 9; i++) assert_near(after.P[i], fresh.P[i], 1e-12);
  assert_int_equal(LamRVEStateDestroy(&point), 0);
  assert_int_equal(LamRVEDestroy(&rve), 0);
}

static int Run(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ClearanceIsNoPenetration), cmocka_unit_test(CellInsideOutIsNoAnswer),
      cmocka_unit_test(LostTissueHasItsBracket),  cmocka_unit_test(CohesionMustBeANumberAndNotNegative),
      cmocka_unit_test(FailureLeavesTheState),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv)
{
  return RunWithPetsc(argc, argv, Run);
}
