/* Tissue whose lamella breaks for good: tangent, ledger of energies, limits and history. */
#include "support/lamella_tissue.h"
#include "support/random_lamella.h"
#include "support/rve_fixture.h"
#include "support/step_tangent.h"
#include "solve.h"

static const int components[5] = {0, 1, 3, 4, 8};

/* ---- tangent ---- */

static void FollowAndCheck(LamSoftening softening, double shear_energy, double turgor)
{
  LamMicrostructure micro = LamellaTissue(0.2);
  double work = 0;
  LamLoad load;
  Specimen s;

  micro.lamella.softening = softening;
  micro.lamella.shear_energy *= shear_energy;
  micro.sharpness = LAM_SHARPNESS_SMOOTH; /* one law of contact in all states */
  micro.contact_width = LAM_USUAL_WIDTH;
  CHECK(SpecimenCreate(&micro, &s));
  load = PlaneLoad(1.003, 0.002, 0, 1.006, turgor);
  CHECK(SpecimenFollow(&s, &load, 1, &work));
  load = PlaneLoad(1.004, 0.002, 0, 1.007, turgor); /* undamaged */
  CheckStepTangent(&s, &load);
  load = PlaneLoad(1.03, 0.015, 0, 1.06, turgor); /* on the softening branch */
  CHECK(SpecimenFollow(&s, &load, 5, &work));
  assert_true(s.response.dissipated > 1e-4);
  load = PlaneLoad(1.0307, 0.0153, 0, 1.0615, turgor);
  CheckStepTangent(&s, &load);
  load = PlaneLoad(1.02, 0.01, 0.01, 1.05, turgor); /* unloading */
  CheckStepTangent(&s, &load);
  CHECK(SpecimenDestroy(&s));
}

TEST_IS(TangentIsThatOfTheStepBilinear, FollowAndCheck(LAM_SOFTENING_BILINEAR, 1.0, 0.0));
TEST_IS(TangentIsThatOfTheStepUnderTurgor, FollowAndCheck(LAM_SOFTENING_BILINEAR, 1.0, 0.05));
TEST_IS(TangentIsThatOfTheStepExponentialInMixedMode, FollowAndCheck(LAM_SOFTENING_EXPONENTIAL, 3.0, 0.0));

/* ---- energies ---- */

/* Imbalance of the ledger over a cycle, in n steps each way. */
static double Imbalance(double range, LamLoad far, int n, double *turnover)
{
  const LamMicrostructure micro = LamellaTissue(range);
  const LamLoad rest = PlaneLoad(1, 0, 0, 1, 0);
  double work = 0, start, imbalance;
  Specimen s;

  CHECK(SpecimenCreate(&micro, &s));
  start = s.response.stored;
  CHECK(SpecimenFollow(&s, &far, n, &work));
  CHECK(SpecimenFollow(&s, &rest, n, &work));
  assert_true(s.response.dissipated > 1e-4);
  imbalance = s.response.work - (s.response.stored - start) - s.response.dissipated - s.response.released;
  *turnover = s.response.dissipated;
  CHECK(SpecimenDestroy(&s));
  return fabs(imbalance);
}

TEST(LedgerClosesToSecondOrderInTheStep)
{
  double turnover;
  const LamLoad far = PlaneLoad(1.06, 0.1, 0, 1.1, 0);
  const double coarse = Imbalance(0.2, far, 10, &turnover), fine = Imbalance(0.2, far, 40, &turnover);

  assert_true(fine < coarse / 8.0);
  assert_true(fine < 1e-3 * turnover);
}

/* Half the cell's lamella breaks at once on the way. */
TEST(LedgerClosesAcrossAJump)
{
  double turnover;
  const LamLoad far = PlaneLoad(1, 0.4, 0, 1.1, 0);
  const double coarse = Imbalance(0.2, far, 40, &turnover), fine = Imbalance(0.2, far, 160, &turnover);

  assert_true(fine < coarse / 8.0);
  assert_true(fine < 1e-3 * turnover);
}

/* Pressed tissue whose cells snap to one side when the lamella has let go, out of reach of the exact law of contact. */
TEST(LedgerClosesAcrossAJumpToTheOtherLawOfContact)
{
  const RandomLamella sample = DrawLamella(1, 33, 3.0);
  LamResponse before;
  double work = 0.0;
  Specimen s;

  CHECK(SpecimenCreate(&sample.micro, &s));
  for (int k = 0; k <= 20; k++) {
    const LamLoad load = LamellaProgramLoad(&sample, 0.03 * k);

    before = s.response;
    CHECK(SpecimenFollow(&s, &load, 1, &work));
  }
  assert_true(before.contact_width == 0.0 && s.response.contact_width > 0.0);
  assert_true(s.response.jumped);
  assert_near(s.response.work, s.response.stored + s.response.dissipated + s.response.released,
              0.1 * s.response.released);
  CHECK(SpecimenDestroy(&s));
}

TEST(EnergyOfATornCellIsWorkAndLoss)
{
  const LamMicrostructure micro = LamellaTissue(0.05);
  const double faces = micro.lamella.energy; /* three of length 2/sqrt(3), over V0 = 2 sqrt(3) */
  const LamLoad far = PlaneLoad(1.4, 0, 0, 1.4, 0);
  double work = 0;
  Specimen s;

  CHECK(SpecimenCreate(&micro, &s));
  CHECK(SpecimenFollow(&s, &far, 40, &work));
  assert_near(s.response.broken_fraction, 1.0, 1e-12);
  assert_near(s.response.dissipated, faces, 1e-12);
  assert_near(s.response.P[0], 0.0, 1e-9);
  assert_near(s.response.stored, 0.0, 1e-9);
  assert_true(s.response.released > 0.0);
  assert_near(s.response.work, s.response.dissipated + s.response.released, 0.03 * work);
  assert_near(s.response.work, work, 0.03 * work);
  CHECK(SpecimenDestroy(&s));
}

/* ---- limits ---- */

static LamResponse SolveAfter(LamMicrostructure micro, LamLoad load)
{
  micro.along = 6;
  micro.through = 2;
  return SolveTissue(&micro, load);
}

TEST(StiffLamellaTendsToBondedTissue)
{
  const LamLoad load = PlaneLoad(1.05, 0.1, 0, 1.0, 0.1);
  LamMicrostructure micro = LamellaTissue(1e6);
  double error[2];
  LamResponse bonded;

  micro.interface = LAM_INTERFACE_BONDED;
  bonded = SolveAfter(micro, load);
  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella.strength = micro.lamella.shear_strength = 100.0;
  for (int k = 0; k < 2; k++) {
    LamResponse r;

    micro.lamella.stiffness = (k ? 30.0 : 3.0) * LamLamellaDefaultStiffness(&micro);
    r = SolveAfter(micro, load);
    assert_int_equal(r.status, LAM_CONVERGED);
    error[k] = StressError(r.P, bonded.P);
  }
  assert_true(error[0] < 1e-3);
  assert_true(error[1] < 0.12 * error[0]);
}

/* Frobenius norm of the change of the tangent in the plane over that of the first. */
static double TangentChange(const LamResponse *from, const LamResponse *to)
{
  double change = 0, whole = 0;

  for (int k = 0; k < 4; k++)
    for (int l = 0; l < 4; l++) {
      const int at = 9 * components[k] + components[l];

      change += pow(to->tangent[at] - from->tangent[at], 2);
      whole += pow(from->tangent[at], 2);
    }
  return sqrt(change / whole);
}

/* The formula of the price, at thin and thick walls with and without fibres. */
TEST(StiffnessCostsWhatCheckSays)
{
  for (int k = 0; k < 4; k++) {
    const LamLoad rest = PlaneLoad(1, 0, 0, 1, 0);
    LamMicrostructure micro = LamellaTissue(1e6);
    LamResponse bonded, r;

    micro.along = 12; /* the forces that part walls pass near the corners */
    micro.through = 2;
    micro.grading = 0.6;
    micro.wall_thickness = k % 2 ? 0.25 : 0.06;
    micro.wall.C4 = k / 2 ? 9.0 : 0.0;
    micro.lamella.strength = micro.lamella.shear_strength = 100.0;
    micro.interface = LAM_INTERFACE_BONDED;
    bonded = SolveTissue(&micro, rest);
    micro.interface = LAM_INTERFACE_LAMELLA;
    r = SolveTissue(&micro, rest);
    assert_near(TangentChange(&bonded, &r) / LamLamellaCompliance(&micro), 1.0, 0.15);
  }
}

/* The paper's cohesion g acts at any gap, on the current area and in the voids of junctions; a lamella of strength g
   without end acts on the reference area of faces. They agree where faces open without slip, by little. */
TEST(EndlessLamellaTendsToCohesion)
{
  LamLoad load = PlaneLoad(1.0005, 0, 0, 1.0005, 0);
  LamMicrostructure micro = LamellaTissue(1.0);
  LamResponse contact;

  micro.wall_thickness = 0.4; /* cells that hardly bulge */
  micro.wall.C4 = 0.0;
  micro.interface = LAM_INTERFACE_CONTACT;
  load.cohesion = 1e-4;
  contact = SolveAfter(micro, load);
  assert_int_equal(contact.status, LAM_CONVERGED);
  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella.strength = micro.lamella.shear_strength = load.cohesion;
  micro.lamella.energy = micro.lamella.shear_energy = 1e3;
  load.cohesion = 0.0;
  for (double k = 10.0; k < 2e3; k *= 10.0) {
    LamResponse r;

    micro.lamella.stiffness = k;
    r = SolveAfter(micro, load);
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_near(r.P[0], contact.P[0], 1e-3 * contact.P[0]);
    assert_near(r.P[4], contact.P[4], 1e-3 * contact.P[4]);
  }
}

TEST(BrokenLamellaIsContactWithoutCohesion)
{
  const LamLoad load = PlaneLoad(0.98, 0.15, 0, 1.0, 0.1);
  LamMicrostructure micro = LamellaTissue(1.0);
  LamResponse contact, broken;

  micro.interface = LAM_INTERFACE_CONTACT;
  contact = SolveAfter(micro, load);
  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella.face_strength[0] = micro.lamella.face_strength[1] = micro.lamella.face_strength[2] = 0.0;
  broken = SolveAfter(micro, load);
  assert_int_equal(broken.status, LAM_CONVERGED);
  assert_true(StressError(broken.P, contact.P) < 1e-3);
  assert_true(isnan(broken.broken_fraction));
}

/* ---- history ---- */

TEST(FailedAndRejectedStatesLeaveNoDamage)
{
  const LamMicrostructure micro = LamellaTissue(0.2);
  const LamLoad near = PlaneLoad(1.02, 0, 0, 1.02, 0), far = PlaneLoad(1.2, 0, 0, 1.2, 0);
  const PetscInt points[1] = {0};
  LamResponder responder;
  LamResponse straight, after;
  LamRVE rve = NewRVE(&micro);

  CHECK(LamRVEResponderCreate(rve, 1, &responder));
  CHECK(LamResponderRespond(responder, 1, &near, points, &straight));
  CHECK(LamResponderRespond(responder, 1, &far, points, &after));
  assert_true(after.broken_fraction > 0.5);
  CHECK(LamResponderRespond(responder, 1, &near, points, &after));
  assert_near(after.P[0], straight.P[0], 1e-9);
  assert_near(after.dissipated, straight.dissipated, 1e-12);
  CHECK(LamResponderRespond(responder, 1, &far, points, &after));
  CHECK(LamResponderAccept(responder));
  CHECK(LamResponderRespond(responder, 1, &near, points, &after));
  assert_true(after.broken_fraction > 0.5);
  assert_true(fabs(after.P[0]) < 0.5 * straight.P[0]);
  CHECK(LamResponderDestroy(&responder));
  CHECK(LamRVEDestroy(&rve));
}

TEST(PackedHistoryGoesOnBitForBit)
{
  const LamMicrostructure micro = LamellaTissue(0.2);
  const LamLoad first = PlaneLoad(1.05, 0.02, 0, 1.1, 0), second = PlaneLoad(1.06, 0.05, 0, 1.12, 0);
  LamRVE rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) a = NewState(rve);
  OWNED(LamRVEState, LamRVEStateDestroy) b = NewState(rve);
  LamResponse ra, rb;

  CHECK(LamRVESolve(rve, &first, a, &ra));
  CopyPacked(a, b);
  CHECK(LamRVESolve(rve, &second, a, &ra));
  CHECK(LamRVESolve(rve, &second, b, &rb));
  assert_true(ra.dissipated > 0.0);
  assert_memory_equal(ra.P, rb.P, sizeof(ra.P));
  assert_memory_equal(&ra.dissipated, &rb.dissipated, sizeof(ra.dissipated));
  CHECK(LamRVEDestroy(&rve));
}

/* A second loading follows the first unloading, below what the virgin tissue bears. */
TEST(SecondLoadingRemembers)
{
  const LamMicrostructure micro = LamellaTissue(0.5);
  const LamLoad far = PlaneLoad(1.1, 0, 0, 1.1, 0), half = PlaneLoad(1.05, 0, 0, 1.05, 0),
                rest = PlaneLoad(1, 0, 0, 1, 0);
  double work = 0, virgin, unloading, spent;
  Specimen s;

  CHECK(SpecimenCreate(&micro, &s));
  CHECK(SpecimenFollow(&s, &half, 5, &work));
  virgin = s.response.P[0];
  CHECK(SpecimenFollow(&s, &far, 5, &work));
  spent = s.response.dissipated;
  CHECK(SpecimenFollow(&s, &half, 5, &work));
  unloading = s.response.P[0];
  CHECK(SpecimenFollow(&s, &rest, 5, &work));
  CHECK(SpecimenFollow(&s, &half, 5, &work));
  assert_true(unloading < 0.9 * virgin);
  assert_near(s.response.P[0], unloading, 1e-8);
  assert_near(s.response.dissipated, spent, 1e-12);
  CHECK(SpecimenDestroy(&s));
}

TEST_GROUP(.petsc = 1);
