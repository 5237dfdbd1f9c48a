/* Walls that tear: closed cuts, tangent, energies, bursts, and what a state keeps of them. */
#include "support/lamella_tissue.h"
#include "support/rve_fixture.h"
#include "support/sealed_cells.h"
#include "support/step_tangent.h"

/* A lamella that holds, and walls that tear at 1 (C1 + C2) over `range` apothems. */
static LamMicrostructure TearingTissue(double range)
{
  LamMicrostructure micro = LamellaTissue(0.2);

  micro.lamella.strength = micro.lamella.shear_strength = 20.0;
  micro.lamella.energy = micro.lamella.shear_energy = 200.0;
  micro.lamella.stiffness = LamLamellaDefaultStiffness(&micro);
  micro.tearing = (LamTearing){.strength = 1.0, .energy = 0.5 * range};
  micro.tearing.stiffness = LamTearingDefaultStiffness(&micro);
  micro.sharpness = LAM_SHARPNESS_SMOOTH;
  micro.contact_width = LAM_USUAL_WIDTH;
  return micro;
}

/* ---- cuts ---- */

/* A wall in bending and tension, with cuts and without. */
TEST(ClosedCutsCostWhatCheckSays)
{
  const LamLoad load = PlaneLoad(1.02, 0.01, 0, 1.0, 0);
  LamMicrostructure micro = TearingTissue(0.1);
  LamResponse whole, cut;

  micro.tearing.stiffness *= 0.1; /* 0.8 % */
  cut = SolveTissue(&micro, load);
  micro.tearing = (LamTearing){0};
  whole = SolveTissue(&micro, load);
  assert_int_equal(cut.status, LAM_CONVERGED);
  assert_true(StressError(cut.P, whole.P) < 0.008);
  assert_true(StressError(cut.P, whole.P) > 0.004);
  assert_near(cut.lumen_fraction, whole.lumen_fraction, 1e-3);
}

TEST(TangentIsThatOfTheStepWhileWallsTear)
{
  const LamMicrostructure micro = TearingTissue(0.1);
  LamLoad load = PlaneLoad(1, 0, 0, 1.07, 0.1);
  double work = 0;
  Specimen s;

  CHECK(SpecimenCreate(&micro, &s));
  CHECK(SpecimenFollow(&s, &load, 5, &work));
  load = PlaneLoad(1.0005, 0.0002, 0, 1.071, 0.1);
  CheckStepTangent(&s, &load);
  assert_true(s.response.dissipated_walls > 1e-5);
  load = PlaneLoad(0.9995, -0.0002, 0, 1.069, 0.1); /* unloading */
  CheckStepTangent(&s, &load);
  CHECK(SpecimenDestroy(&s));
}

/* ---- energies ---- */

/* Imbalance over what is dissipated when tissue has been torn across in n steps; fills the specimen. */
static double TearAcross(const LamMicrostructure *micro, double turgor, int n, Specimen *s)
{
  const LamLoad rest = PlaneLoad(1, 0, 0, 1, turgor), far = PlaneLoad(1, 0, 0, 1.2, turgor);
  double work = 0;

  CHECK(SpecimenCreate(micro, s));
  CHECK(SpecimenFollow(s, &rest, 2, &work));
  CHECK(SpecimenFollow(s, &far, n, &work));
  return fabs(s->response.work - s->response.stored - s->response.dissipated - s->response.released) /
         s->response.dissipated;
}

/* A straight crack cuts each of the two walls of one face; cuts beside it spend some more. */
TEST(TornTissueHasSpentTheEnergyOfItsCuts)
{
  const LamMicrostructure micro = TearingTissue(0.05);
  const double middle = 2 * micro.wall_thickness, mitre = 2.0 / sqrt(3.0) * middle;
  double imbalance[2], spent;
  Specimen s;

  imbalance[0] = TearAcross(&micro, 0.0, 10, &s);
  CHECK(SpecimenDestroy(&s));
  imbalance[1] = TearAcross(&micro, 0.0, 40, &s);
  assert_true(imbalance[1] < 0.003);
  assert_true(imbalance[1] < imbalance[0] / 4.0);
  assert_near(s.response.P[4], 0.0, 1e-9);
  assert_near(s.response.broken_fraction, 0.0, 1e-12);
  assert_near(s.response.dissipated, s.response.dissipated_walls, 1e-15);
  spent = s.response.dissipated * 2.0 * sqrt(3.0) / micro.tearing.energy;
  assert_true(spent > middle && spent < 1.15 * mitre);
  CHECK(SpecimenDestroy(&s));
}

TEST(BurstTakesTheTurgorAndClosesTheLedger)
{
  const LamMicrostructure micro = TearingTissue(0.05);
  Specimen s;

  assert_true(TearAcross(&micro, 0.1, 40, &s) < 0.005);
  assert_near(s.response.burst_fraction, 1.0, 1e-12);
  assert_near(s.response.turgor_mean, 0.0, 1e-15);
  assert_true(s.response.juice > 0.73 && s.response.juice < 0.9); /* the lumen at rest has 0.7316 */
  assert_near(s.response.stored, 0.0, 1e-9);
  assert_true(s.response.released > 0.0);
  CHECK(SpecimenDestroy(&s));
}

/* Of two cells under turgor the one with the thinner wall bursts first; the other keeps its turgor. */
TEST(ABurstCellLeavesItsNeighboursTheirTurgor)
{
  const LamLoad rest = PlaneLoad(1, 0, 0, 1, 0.1), far = PlaneLoad(1, 0, 0, 1.5, 0.1);
  LamMicrostructure micro = TearingTissue(0.2);
  LamCell cells[2];
  double work = 0;
  Specimen s;

  micro.cells[0] = 2;
  micro.cell = cells;
  for (int k = 0; k < 2; k++)
    cells[k] = (LamCell){.wall_thickness = micro.wall_thickness,
                         .wall = micro.wall,
                         .turgor = 1.0,
                         .cohesion = 1.0,
                         .lamella_strength = 1.0,
                         .lamella_energy = 1.0};
  cells[1].wall_thickness *= 0.7;
  CHECK(SpecimenCreate(&micro, &s));
  CHECK(SpecimenFollow(&s, &rest, 2, &work));
  for (int k = 1; k <= 50 && s.response.burst_fraction == 0.0; k++) {
    const LamLoad load = LamLoadBetween(&rest, &far, k / 50.0);

    CHECK(SpecimenFollow(&s, &load, 1, &work));
  }
  assert_near(s.response.burst_fraction, 0.5, 1e-12);
  assert_near(s.response.turgor_mean, 0.05, 1e-12);
  assert_near(s.response.turgor_spread, 0.1, 1e-12);
  CHECK(SpecimenDestroy(&s));
}

TEST(ASealedCellThatBurstsLosesItsWater)
{
  const LamMicrostructure micro = TearingTissue(0.05);
  const LamLoad start = PlaneLoad(1, 0, 0, 1, 0.1);
  LamResponse r;
  SealedTissue s;

  CHECK(SealedCreate(&micro, &start, SEALED_WATER, &s));
  for (int k = 1; k <= 40; k++) {
    const LamLoad load = PlaneLoad(1.0, 0, 0, 1.0 + 0.005 * k, 0.1);

    CHECK(LamRVESolve(s.rve, &load, s.state, &r));
    assert_int_equal(r.status, LAM_CONVERGED);
  }
  assert_near(r.burst_fraction, 1.0, 1e-12);
  assert_near(r.turgor_mean, 0.0, 1e-12);
  assert_near(r.juice, s.water[0], 0.01 * s.water[0]); /* water is hardly compressible */
  CHECK(SealedDestroy(&s));
}

/* ---- history ---- */

TEST(PackedBurstGoesOnBitForBit)
{
  const LamMicrostructure micro = TearingTissue(0.05);
  const LamLoad next = PlaneLoad(1, 0.05, 0, 1.15, 0.1);
  LamResponse ra, rb;
  LamRVEState copy;
  Specimen s;

  (void)TearAcross(&micro, 0.1, 20, &s);
  CHECK(LamRVEStateCreate(s.rve, &copy));
  CopyPacked(s.state, copy);
  CHECK(LamRVESolve(s.rve, &next, s.state, &ra));
  CHECK(LamRVESolve(s.rve, &next, copy, &rb));
  assert_near(rb.burst_fraction, 1.0, 1e-12);
  assert_memory_equal(ra.P, rb.P, sizeof(ra.P));
  assert_memory_equal(&ra.juice, &rb.juice, sizeof(ra.juice));
  CHECK(LamRVEStateDestroy(&copy));
  CHECK(SpecimenDestroy(&s));
}

TEST(ACellThatBurstInARejectedStateIsWhole)
{
  const LamMicrostructure micro = TearingTissue(0.05);
  const LamLoad near = PlaneLoad(1, 0, 0, 1.02, 0.1), far = PlaneLoad(1, 0, 0, 1.2, 0.1);
  const PetscInt points[1] = {0};
  LamResponder responder;
  LamResponse straight, after;
  LamRVE rve = NewRVE(&micro);

  CHECK(LamRVEResponderCreate(rve, 1, &responder));
  CHECK(LamResponderRespond(responder, 1, &near, points, &straight));
  CHECK(LamResponderAccept(responder));
  CHECK(LamResponderRespond(responder, 1, &far, points, &after));
  assert_near(after.burst_fraction, 1.0, 1e-12);
  CHECK(LamResponderRespond(responder, 1, &near, points, &after));
  assert_near(after.burst_fraction, 0.0, 1e-12);
  assert_near(after.P[4], straight.P[4], 1e-9);
  CHECK(LamResponderDestroy(&responder));
  CHECK(LamRVEDestroy(&rve));
}

TEST_GROUP(.petsc = 1);
