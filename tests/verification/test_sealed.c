/* Sealed lumens: each keeps its water, all that a response holds is a derivative of one energy, and limits are those of
   prescribed turgor and of a full cell. */
#include "support/rve_fixture.h"
#include "support/sealed_cells.h"

static SealedState states[SEALED_STATES];
static SealedFigures figures[SEALED_STATES];

static int SolveAll(void **state)
{
  static LamCell cells[SEALED_CELLS];

  ListSealedStates(cells, states);
  for (int k = 0; k < SEALED_STATES; k++)
    if (SweepSealed(&states[k], &figures[k]) || figures[k].sweep.response.status != LAM_CONVERGED) return 1;
  return 0;
}

static SealedTissue Sealed(const LamMicrostructure *micro, const LamLoad *load, double bulk_modulus)
{
  SealedTissue s;

  assert_int_equal(SealedCreate(micro, load, bulk_modulus, &s), 0);
  return s;
}

static LamResponse SolveSealed(SealedTissue *s, const LamLoad *load)
{
  LamResponse response;

  assert_int_equal(SealedSolve(s, load, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  return response;
}

static LamResponse Solve(const LamMicrostructure *micro, const LamLoad *load, double bulk_modulus)
{
  OWNED(SealedTissue, SealedDestroy) s = Sealed(micro, load, bulk_modulus);

  return SolveSealed(&s, load);
}

TEST(LumensFollowTheirPressures)
{
  for (int k = 0; k < SEALED_STATES; k++) assert_near(figures[k].law_error, 0.0, 1e-13);
}

TEST(EverythingIsADerivativeOfTheEnergy)
{
  for (int k = 0; k < SEALED_STATES; k++) {
    const ContactDerivativeError e = DerivativeError(&figures[k].sweep);

    assert_int_equal(figures[k].sweep.switches, 0);
    assert_near(e.stress, 0.0, 1e-9);
    assert_near(e.turgor, 0.0, 1e-9); /* by p0 at fixed water */
    assert_near(e.cohesion, 0.0, 1e-9);
    assert_near(e.tangent, 0.0, 1e-6);
    assert_near(e.symmetry, 0.0, 1e-6);
    assert_near(e.turgor_coupling, 0.0, 1e-6);
    assert_near(e.cohesion_coupling, 0.0, 1e-6);
    assert_near(e.volumes, 0.0, 1e-9);
  }
}

/* Cells that are not alike reach pressures of their own; alike they have one. */
TEST(PressuresDifferOnlyWhereCellsDo)
{
  for (int k = 0; k < SEALED_STATES; k++) {
    const double spread = figures[k].sweep.response.turgor_spread;

    if (states[k].micro.cell)
      assert_true(spread > 0.01);
    else
      assert_near(spread, 0.0, 1e-12);
  }
}

/* The state is that of the pressure reached, and A_sealed = Psi_FF + Psi_Fp (x) Psi_pF / (v_w / K_w - Psi_pp) of it. */
TEST(TangentFollowsFromThatAtThePressureReached)
{
  for (int k = 0; k < 5; k++) { /* one cell each */
    const LamResponse *sealed = &figures[k].sweep.response;
    LamLoad load = states[k].load;
    OWNED(SealedTissue, SealedDestroy) s = Sealed(&states[k].micro, &load, states[k].bulk_modulus);
    const double compliance = s.water[0] / s.bulk_modulus;

    assert_int_equal(LamRVEUnseal(s.rve), 0);
    load.turgor = sealed->turgor_mean;
    const LamResponse open = SolveSealed(&s, &load);

    for (int i = 0; i < 5; i++)
      for (int j = 0; j < 5; j++) {
        const int a = contact_components[i], b = contact_components[j];

        assert_near(open.P[a], sealed->P[a], 1e-10);
        assert_near(open.tangent[9 * a + b] + open.P_turgor[a] * open.P_turgor[b] / (compliance - open.energy_turgor2),
                    sealed->tangent[9 * a + b], 1e-9 * TangentScale(sealed));
      }
  }
}

TEST(HardWaterKeepsTheLumen)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1, 0.3, 0, 1, 0.2);
  double lumen[2];

  for (int k = 0; k < 2; k++)
    lumen[k] =
        Solve(&micro, k ? &load : &(LamLoad){.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.2}, 1e12).lumen_fraction;
  assert_near(lumen[1], lumen[0], 1e-12);
}

TEST(SoftWaterKeepsThePressure)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1.1, 0.2, 0, 1.05, 0.2);
  const LamResponse soft = Solve(&micro, &load, 1e-10), prescribed = SolveTissue(&micro, load);

  assert_near(soft.turgor_mean, 0.2, 1e-10);
  for (int i = 0; i < 9; i++) assert_near(soft.P[i], prescribed.P[i], 1e-8);
}

/*
  Walls and water stand in the same pressure and are stiff against their shape: under dilatation the volumes of both add
  up, so that 1/K = v_w / K_w + w / kappa, w = 1 - (1 - t)^2 the share of the walls (docs/theory/walls.md, Sealed
  lumens). What the shape of the walls adds is of the order of C1 + C2.
*/
TEST(BulkModulusIsThatOfWaterAndWallsInSeries)
{
  for (double factor = 1.0; factor < 200.0; factor *= 10.0) {
    LamMicrostructure micro = DefaultTissue();
    const LamLoad load = PlaneLoad(1, 0, 0, 1, 0.2);
    double bulk_modulus, lumen = (1.0 - micro.wall_thickness) * (1.0 - micro.wall_thickness);
    LamResponse r;

    micro.wall.bulk_modulus = 1000.0 * factor;
    bulk_modulus = 1.0 / (lumen / (SEALED_WATER * factor) + (1.0 - lumen) / micro.wall.bulk_modulus);
    r = Solve(&micro, &load, SEALED_WATER * factor);
    assert_near(r.tangent[4] / bulk_modulus, 1.0, 2e-3 / factor);
    assert_near(r.tangent[8] / bulk_modulus, 1.0, 2e-3 / factor);
  }
}

TEST(OneCellIsFourCells)
{
  for (int contact = 0; contact < 2; contact++) {
    LamMicrostructure micro = contact ? ContactTissue(6, 2) : DefaultTissue();
    const LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.02, contact ? 0.002 : 0);
    const LamResponse one = Solve(&micro, &load, SEALED_WATER);
    LamResponse four;

    micro.cells[0] = micro.cells[1] = 2;
    four = Solve(&micro, &load, SEALED_WATER);
    for (int i = 0; i < 9; i++) assert_near(four.P[i], one.P[i], 1e-8);
    assert_near(four.turgor_mean, one.turgor_mean, 1e-8);
    assert_near(four.tangent[10], one.tangent[10], 1e-8 * TangentScale(&one));
  }
}

TEST(StressTurnsWithTheTissue)
{
  const LamMicrostructure micro = DefaultTissue();
  const double c = cos(0.7), s = sin(0.7);
  const LamResponse before =
      Solve(&micro, &(LamLoad){.F = {1.02, 0.1, 0, 0, 0.98, 0, 0, 0, 1}, .turgor = 0.2}, SEALED_WATER);
  const double *F = before.load.F, *P = before.P;
  LamLoad load = PlaneLoad(c * F[0], c * F[1] - s * F[4], s * F[0], s * F[1] + c * F[4], 0.2);
  const LamResponse after = Solve(&micro, &load, SEALED_WATER);

  for (int j = 0; j < 2; j++) {
    assert_near(after.P[j], c * P[j] - s * P[3 + j], 1e-9);
    assert_near(after.P[3 + j], s * P[j] + c * P[3 + j], 1e-9);
  }
}

/* Without a state before, from the stress-free reference. */
TEST(AnswerDoesNotNeedTheStateThatWasSealed)
{
  for (int contact = 0; contact < 2; contact++) {
    const LamMicrostructure micro = contact ? ContactTissue(6, 2) : DefaultTissue();
    const LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.02, contact ? 0.002 : 0);
    OWNED(SealedTissue, SealedDestroy) s = Sealed(&micro, &load, SEALED_WATER);
    const LamResponse near = SolveSealed(&s, &load), far = SolveFromReference(s.rve, load);

    assert_int_equal(far.status, LAM_CONVERGED);
    for (int i = 0; i < 9; i++) assert_near(far.P[i], near.P[i], 1e-9);
  }
}

/* Bonded tissue that is pulled apart pulls at its water; in contact it opens instead, as its cohesion lets it. */
TEST(WaterIsPulled)
{
  const LamLoad load = ContactLoad(1.001, 0, 0, 1, 0.02, 0.002), bonded_load = PlaneLoad(1.001, 0, 0, 1, load.turgor);
  const LamMicrostructure bonded = DefaultTissue(), contact = ContactTissue(6, 2);

  assert_true(Solve(&bonded, &bonded_load, SEALED_WATER).turgor_mean < -2.0);
  assert_near(Solve(&contact, &load, SEALED_WATER).turgor_mean, -load.cohesion, 0.01 * load.cohesion);
}

/* Newton takes no more steps than with prescribed turgor. */
TEST(NewtonIsAsFastAsWithPrescribedTurgor)
{
  for (double shear = 0.1; shear < 0.55; shear += 0.1) {
    const LamMicrostructure micro = DefaultTissue();
    const LamLoad load = PlaneLoad(1, shear, 0, 1, 0.02 / TISSUE_STRESS);

    assert_true(Solve(&micro, &load, SEALED_WATER).newton_iterations <= 6);
  }
}

/* One negative eigenvalue for each pressure, which a stable state does not count. */
TEST(EachPressureHasItsNegativeEigenvalue)
{
  LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1, 0.1, 0, 1, 0.2);
  PetscInt negative;
  PetscBool ok;

  micro.cells[0] = 2;
  OWNED(SealedTissue, SealedDestroy) s = Sealed(&micro, &load, SEALED_WATER);
  const LamResponse response = SolveSealed(&s, &load);

  assert_true(response.stable);
  assert_int_equal(response.negative_eigenvalues, 0);
  assert_int_equal(LamLinearFactor(s.rve->linear, 0.0, &negative, &ok), 0);
  assert_int_equal(negative, 2);
}

static LamResponse SolveFree(SealedTissue *s, LamLoad load)
{
  const LamStressControl control = {.given = {[0] = PETSC_TRUE, [4] = PETSC_TRUE}};
  LamResponse response;

  assert_int_equal(LamRVEStateCopy(s->start, s->state), 0);
  assert_int_equal(LamRVESolveMixed(s->rve, &load, &control, s->state, &response), 0);
  return response;
}

/* Under prescribed stress: the state of its F, and the stress is reached. */
TEST(StressMayBePrescribed)
{
  for (int contact = 0; contact < 2; contact++) {
    const LamMicrostructure micro = contact ? ContactTissue(6, 2) : DefaultTissue();
    const LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.02, contact ? 0.02 : 0);
    OWNED(SealedTissue, SealedDestroy) s = Sealed(&micro, &load, SEALED_WATER);
    const LamResponse mixed = SolveFree(&s, load), plain = SolveSealed(&s, &mixed.load);

    assert_int_equal(mixed.status, LAM_CONVERGED);
    assert_near(mixed.P[0], 0.0, 1e-9);
    assert_near(mixed.P[4], 0.0, 1e-9);
    for (int i = 0; i < 9; i++) assert_near(mixed.P[i], plain.P[i], 1e-8);
  }
}

/* Free cells without fibres have no equilibrium beyond a turgor that is prescribed; sealed ones cannot blow up. */
TEST(SealedTissueHasNoLimitTurgor)
{
  const LamLoad load = PlaneLoad(1, 0, 0, 1, 0.05 / TISSUE_STRESS);
  LamMicrostructure micro = DefaultTissue();

  micro.wall.law = LAM_WALL_MOONEY_RIVLIN;
  OWNED(SealedTissue, SealedDestroy) s = Sealed(&micro, &load, SEALED_WATER);
  const LamResponse sealed = SolveFree(&s, load);

  assert_int_equal(sealed.status, LAM_CONVERGED);
  assert_true(sealed.turgor_mean < 0.1 * load.turgor);
  assert_int_equal(LamRVEUnseal(s.rve), 0);
  assert_int_equal(SolveFree(&s, load).status, LAM_NO_EQUILIBRIUM);
}

/* An RVE that could be sealed and is not is like any other. */
TEST(UnsealedIsPrescribed)
{
  const LamMicrostructure micro = ContactTissue(6, 2);
  const LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.02, 0.002);
  const LamResponse plain = SolveTissue(&micro, load);
  OWNED(SealedTissue, SealedDestroy) s = Sealed(&micro, &load, SEALED_WATER);

  assert_int_equal(LamRVEUnseal(s.rve), 0);
  const LamResponse unsealed = SolveFromReference(s.rve, load);

  for (int i = 0; i < 9; i++) assert_near(unsealed.P[i], plain.P[i], 1e-10);
  assert_true(unsealed.turgor_mean == load.turgor && unsealed.turgor_spread == 0.0);
}

TEST_GROUP(.petsc = 1, .setup = SolveAll);
