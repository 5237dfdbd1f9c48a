/* Cells that end walls close, against prisms: the sheets add their own stiffness, in closed form at small strain. */
#include "support/rve_fixture.h"
#include "end_walls.h"

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

/* ---- fibres ---- */

static const double shapes[][4] = {
    {1.1, 0.0, 0.0, 0.9}, {1.2, 0.1, -0.05, 0.7}, {1.3, 0.2, 0.1, 0.77}, {0.96, 0.3, 0.0, 0.95}};

static LamEndWalls EndWalls(const LamMicrostructure *micro, const double F[4])
{
  const PetscReal full[9] = {F[0], F[1], 0, F[2], F[3], 0, 0, 0, 1};
  LamEndWalls ends;

  CHECK(LamEndWallsEvaluate(micro, full, &ends));
  return ends;
}

/* Energy of fibres alone, per volume of the sheets. */
static double FibreEnergy(const LamMicrostructure *micro, const double F[4])
{
  LamMicrostructure bare = *micro;

  bare.wall.law = LAM_WALL_MOONEY_RIVLIN;
  return (EndWalls(micro, F).W - EndWalls(&bare, F).W) / (2 * micro->wall_thickness / LENGTH);
}

/* C11, C22, C12 */
static void StretchOf(const double F[4], double c[3])
{
  c[0] = F[0] * F[0] + F[2] * F[2];
  c[1] = F[1] * F[1] + F[3] * F[3];
  c[2] = F[0] * F[1] + F[2] * F[3];
}

/* E = m + r cos(phi), phi twice the angle to the axis of the largest stretch: fibres bear for phi < psi = acos(-m/r),
   and the mean of C4/4 E^2 over all of them is C4/(4 pi) (m^2 psi + 2 m r sin(psi) + r^2 (psi/2 + sin(2 psi)/4)). */
TEST(fibres_that_bear_tension_alone_in_closed_form)
{
  LamMicrostructure micro = ClosedTissue();

  micro.wall.fibres = LAM_FIBRES_TENSION;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(shapes); k++) {
    double c[3], m, r, psi, mean;

    StretchOf(shapes[k], c);
    m = 0.5 * (c[0] + c[1]) - 1;
    r = hypot(0.5 * (c[0] - c[1]), c[2]);
    assert_true(fabs(m) < r); /* some bear, others do not */
    psi = acos(-m / r);
    mean = (m * m * psi + 2 * m * r * sin(psi) + r * r * (0.5 * psi + 0.25 * sin(2 * psi))) / PETSC_PI;
    assert_near(FibreEnergy(&micro, shapes[k]), 0.25 * micro.wall.C4 * mean, 1e-10 * micro.wall.C4 * mean);
  }
}

/* Against the sum over 20,000 angles, of a function that is smooth and periodic. */
TEST(steep_exponential_fibres)
{
  LamMicrostructure micro = ClosedTissue();

  micro.wall.law = LAM_WALL_FIBRE_EXPONENTIAL;
  micro.wall.k1 = 1;
  micro.wall.k2 = 200;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(shapes); k++) {
    double c[3], mean = 0;

    StretchOf(shapes[k], c);
    for (int j = 0; j < 20000; j++) {
      const double x = cos(PETSC_PI * j / 20000), y = sin(PETSC_PI * j / 20000);
      const double E = x * x * c[0] + y * y * c[1] + 2 * x * y * c[2] - 1;

      mean += 0.5 * micro.wall.k1 / micro.wall.k2 * expm1(micro.wall.k2 * E * E) / 20000;
    }
    assert_near(FibreEnergy(&micro, shapes[k]), mean, 1e-9 * mean);
  }
}

static void CheckDerivatives(const LamMicrostructure *micro)
{
  static const int in_plane[4] = {0, 1, 3, 4};
  const double h = 1e-5;

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(shapes); k++) {
    const LamEndWalls at = EndWalls(micro, shapes[k]);

    for (int q = 0; q < 4; q++) {
      double F[4] = {shapes[k][0], shapes[k][1], shapes[k][2], shapes[k][3]};
      LamEndWalls above, below;

      F[q] += h;
      above = EndWalls(micro, F);
      F[q] -= 2 * h;
      below = EndWalls(micro, F);
      assert_near((above.W - below.W) / (2 * h), at.P[in_plane[q]], 1e-7);
      for (int r = 0; r < 4; r++)
        assert_near((above.P[in_plane[r]] - below.P[in_plane[r]]) / (2 * h), at.A[in_plane[r]][in_plane[q]], 1e-6);
    }
  }
}

TEST(stress_and_tangent_of_fibres_that_bear_tension_alone)
{
  LamMicrostructure micro = ClosedTissue();

  micro.wall.fibres = LAM_FIBRES_TENSION;
  CheckDerivatives(&micro);
  micro.wall.dispersion = 0.1;
  CheckDerivatives(&micro);
}
