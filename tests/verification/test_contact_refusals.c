/* What is no answer is refused with its reason, and what is one is not. */
#include "support/rve_fixture.h"
#include "support/contact_checks.h"
#include <string.h>

static LamResponse Solve(double clearance, LamLoad load)
{
  LamMicrostructure micro = ContactTissue(6, 2);

  micro.clearance = clearance;
  return SolveTissue(&micro, load);
}

/* Cells that are a clearance apart touch, undeformed, where F brings them that much nearer: walls then have turgor on
   both sides, and P = -p cof F. */
TEST(ClearanceIsTheDistanceOfCells)
{
  const double clearance = 0.1, near = 1 - 0.5 * clearance;
  const LamLoad load = ContactLoad(near, 0, 0, near, 0.02, 0);
  const LamResponse r = Solve(clearance, load);

  assert_int_equal(r.status, LAM_CONVERGED);
  assert_near(r.P[0], -load.turgor * near, 1e-3 * load.turgor);
  assert_near(r.P[4], -load.turgor * near, 1e-3 * load.turgor);
  assert_near(r.lumen_fraction, pow(near - ContactTissue(6, 2).wall_thickness, 2), 1e-4);
}

/* Soft cells of which one has more turgor than the others: the turgor at which no more states are found, as the bracket
   of a state at `turgor` tells. */
static void FindLargestTurgor(double turgor, double between[2])
{
  LamMicrostructure micro = ContactTissue(2, 1);
  LamCell cells[4];
  LamResponse r;

  micro.cells[0] = micro.cells[1] = 2;
  micro.wall = (LamWall){.law = micro.wall.law, .C1 = 0.9, .C2 = 0.1, .bulk_modulus = 1000.0};
  micro.wall_thickness = 0.2;
  for (int c = 0; c < 4; c++)
    cells[c] =
        (LamCell){.wall_thickness = micro.wall_thickness, .wall = micro.wall, .turgor = c ? 1.0 : 1.3, .cohesion = 1.0};
  micro.cell = cells;
  r = SolveTissue(&micro, PlaneLoad(1, 0, 0, 1, turgor));
  assert_false(LamResponseHasFields(&r));
  assert_int_equal(sscanf(strstr(r.reason, "between"), "between %lf and %lf of the way", &between[0], &between[1]), 2);
  between[0] *= turgor;
  between[1] *= turgor;
}

TEST(StatesEndAtTheSameTurgorHoweverFarItIsAsked)
{
  double small[2], large[2];

  FindLargestTurgor(1.0, small);
  FindLargestTurgor(3.0, large);
  assert_near(large[0], small[0], 0.02);
}

/* Suction can turn a cell inside out: its walls have passed through each other. */
TEST(CellInsideOutIsNoAnswer)
{
  const LamResponse r = Solve(0.0, ContactLoad(1.1, 0.1, 0, 1, -0.02, 0.001));

  assert_true(r.status != LAM_CONVERGED || r.lumen_fraction > 0.0);
}

/* Thick walls have no room for a compression: they are followed from rest to where their lumens shut. */
TEST(LostTissueHasItsBracket)
{
  LamMicrostructure micro = ContactTissue(4, 2);
  LamResponse r;

  micro.wall_thickness = 0.95;
  r = SolveTissue(&micro, ContactLoad(1, 0, 0, 0.6, 0.02, 0.001));
  assert_int_equal(r.status, LAM_NO_EQUILIBRIUM);
  assert_non_null(strstr(r.reason, "the walls have no room between"));
  assert_non_null(strstr(r.reason, " of the way"));
  assert_non_null(strstr(r.reason, "; from rest"));
}

TEST(CohesionMustBeANumberAndNotNegative)
{
  const double values[] = {-0.001, NAN, INFINITY};

  for (int k = 0; k < 3; k++) {
    const LamResponse r = Solve(0.0, ContactLoad(1, 0.1, 0, 1, 0.02, values[k]));

    assert_int_equal(r.status, LAM_INVALID_F);
    assert_non_null(strstr(r.reason, "cohesion"));
  }
}

/* A failed solve leaves the state as it was: the next answer does not depend on it. */
TEST(FailureLeavesTheState)
{
  LamMicrostructure micro = ContactTissue(6, 2);
  const LamLoad hopeless = ContactLoad(0.3, 0, 0, 0.3, 0, 0), load = ContactLoad(1, 0.1, 0, 1, 0.02, 0);
  const LamResponse fresh = SolveTissue(&micro, load);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse failed, after;

  assert_int_equal(LamRVESolve(rve, &hopeless, point, &failed), 0);
  assert_false(LamResponseHasFields(&failed));
  assert_int_equal(LamRVESolve(rve, &load, point, &after), 0);
  assert_int_equal(after.newton_iterations, fresh.newton_iterations);
  for (int i = 0; i < 9; i++) assert_near(after.P[i], fresh.P[i], 1e-12);
}
