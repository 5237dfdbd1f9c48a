/* Newton iterations from F = I in one go under turgor; bench_newton prints the whole table. */
#include "support/rve_fixture.h"

#define TURGOR (0.02 / TISSUE_STRESS)

static void AssertIterations(LamMicrostructure micro, double shear, int most)
{
  static const int mesh[][2] = {{6, 2}, {12, 4}};

  for (int m = 0; m < 2; m++) {
    LamResponse r;

    micro.along = mesh[m][0];
    micro.through = mesh[m][1];
    r = SolveTissue(&micro, PlaneLoad(1, shear, 0, 1, TURGOR));
    assert_int_equal(r.status, LAM_CONVERGED);
    if (r.newton_iterations > most)
      fail_msg("t/a = %g, shear %g, %d elements a face: %d iterations, expected at most %d", micro.wall_thickness,
               shear, mesh[m][0], (int)r.newton_iterations, most);
  }
}

TEST(ShearUpToThirtyPercentTakesAtMostEight)
{
  static const double thickness[] = {0.05, 0.1, 0.15, 0.2, 0.3}, shear[] = {0.1, 0.2, 0.3};

  for (int t = 0; t < 5; t++)
    for (int s = 0; s < 3; s++) {
      LamMicrostructure micro = DefaultTissue();

      micro.wall_thickness = thickness[t];
      AssertIterations(micro, shear[s], 8);
    }
}

TEST(ShearOfFiftyPercentTakesAtMostTwelve)
{
  static const double thickness[] = {0.05, 0.1, 0.15, 0.2};

  for (int t = 0; t < 4; t++) {
    LamMicrostructure micro = DefaultTissue();

    micro.wall_thickness = thickness[t];
    AssertIterations(micro, 0.5, 12);
  }
}

/* Incompressibility costs no iterations: the pressure is an unknown of its own. */
TEST(BulkModulusDoesNotMatter)
{
  LamResponse r[2];

  for (int k = 0; k < 2; k++) {
    LamMicrostructure micro = DefaultTissue();

    micro.wall.bulk_modulus = k == 0 ? 1e3 : 1e6;
    r[k] = SolveTissue(&micro, PlaneLoad(1, 0.3, 0, 1, TURGOR));
  }
  /* the last step may be taken with the factor of the one before, or not */
  assert_in_range(r[1].newton_iterations, r[0].newton_iterations - 1, r[0].newton_iterations + 1);
}

/* Fibres a hundred times stiffer, at moderate shear: the fibre stress, too, is an unknown of its own. */
TEST(StiffFibresTakeAtMostEight)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall.C4 = 1e3 * micro.wall.C1;
  AssertIterations(micro, 0.1, 8);
}

/* A start at the solution needs no iteration. */
TEST(SolutionIsItsOwnStart)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1.02, 0.1, 0, 1, TURGOR);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamResponse first, again;

  assert_int_equal(LamRVESolve(rve, &load, point, &first), 0);
  assert_int_equal(LamRVESolve(rve, &load, point, &again), 0);
  assert_int_equal(again.newton_iterations, 0);
  assert_true(StressError(again.P, first.P) < 1e-12);
}

/* Rounding grows with the size of the RVE and with the slenderness of the elements; the tolerance must follow it. */
TEST(ManyCellsWithThinWallsConverge)
{
  LamMicrostructure micro = DefaultTissue();
  LamResponse r;

  micro.wall_thickness = 0.05;
  micro.cells[0] = micro.cells[1] = 4;
  micro.along = 4;
  r = SolveTissue(&micro, PlaneLoad(1, 0.1, 0, 1, TURGOR));
  assert_int_equal(r.status, LAM_CONVERGED);
  assert_in_range(r.newton_iterations, 1, 8);
}
