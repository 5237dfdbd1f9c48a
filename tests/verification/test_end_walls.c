/* Cells that end walls close, against prisms: the sheets add their own stiffness, in closed form at small strain. */
#include "support/rve_fixture.h"

#define LENGTH 2.5 /* apothems */

static LamMicrostructure ClosedTissue(void)
{
  LamMicrostructure micro = DefaultTissue();

  micro.length = LENGTH;
  return micro;
}

/* With s = C1 + C2 a sheet without fibres has the stiffnesses 4 s, 2 s and s of 1111, 1122 and 1212; the mean of
   C4/4 (I4 - 1)^2 over all directions adds 3/4, 1/4 and 1/4 of C4. Its volume is 2 t/L. */
TEST(stiffness_of_end_walls_in_closed_form)
{
  const LamMicrostructure open = DefaultTissue(), closed = ClosedTissue();
  const LamLoad rest = PlaneLoad(1, 0, 0, 1, 0);
  const LamResponse prism = SolveTissue(&open, rest), cell = SolveTissue(&closed, rest);
  const double volume = 2 * open.wall_thickness / LENGTH, s = open.wall.C1 + open.wall.C2, C4 = open.wall.C4;

  assert_near(cell.tangent[0] - prism.tangent[0], volume * (4 * s + 0.75 * C4), 1e-10);
  assert_near(cell.tangent[4] - prism.tangent[4], volume * (2 * s + 0.25 * C4), 1e-10);
  assert_near(cell.tangent[10] - prism.tangent[10], volume * (s + 0.25 * C4), 1e-10);
  assert_near(cell.tangent[80], prism.tangent[80], 1e-12); /* they do not resist a stretch along the cells */
}

/* Under turgor the tissue free of stress: prescribed stress has the end walls, too, and they share the pressure. */
TEST(end_walls_share_the_turgor)
{
  const LamMicrostructure open = DefaultTissue(), closed = ClosedTissue();
  const LamMicrostructure *const tissue[] = {&open, &closed};
  const LamStressControl control = {.given = {1, 0, 0, 0, 1, 0, 0, 0, 0}, .share = 1};
  LamResponse found[2];

  for (int k = 0; k < 2; k++) {
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(tissue[k]);
    OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
    const LamLoad load = PlaneLoad(1, 0, 0, 1, 0.2);

    CHECK(LamRVESolveMixed(rve, &load, &control, at, &found[k]));
    assert_int_equal(found[k].status, LAM_CONVERGED);
    assert_near(found[k].P[0], 0, 1e-10);
  }
  assert_true(found[1].load.F[0] - 1 < 0.9 * (found[0].load.F[0] - 1));
}

/* Tissue that is turned has the stress that is turned. */
TEST(end_walls_are_objective)
{
  const LamMicrostructure closed = ClosedTissue();
  const double c = cos(0.7), s = sin(0.7), F[4] = {1.1, 0.2, -0.05, 0.95};
  const LamResponse r = SolveTissue(&closed, PlaneLoad(F[0], F[1], F[2], F[3], 0.1)),
                    q = SolveTissue(&closed, PlaneLoad(c * F[0] - s * F[2], c * F[1] - s * F[3], s * F[0] + c * F[2],
                                                       s * F[1] + c * F[3], 0.1));

  assert_near(q.energy, r.energy, 1e-10);
  for (int b = 0; b < 2; b++) {
    assert_near(q.P[b], c * r.P[b] - s * r.P[3 + b], 1e-9);
    assert_near(q.P[3 + b], s * r.P[b] + c * r.P[3 + b], 1e-9);
  }
}
