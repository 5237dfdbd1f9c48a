/* The law of the middle lamella at a point and on an edge, against quadrature, differences and closed forms that are
   written here once more. */
#include "support/test.h"
#include "support/random_reals.h"
#include "cohesive_edge.h"

#define LAWS 24
#define PANELS 400  /* of a quadrature over softening */
#define FARTHEST 38 /* in lengths over which an exponential envelope falls to 1/e: 1e-17 of it is left */

static LamCohesive laws[LAWS];
#define FOR_LAWS(law) for (const LamCohesive *law = laws; law < laws + LAWS; law++)
static const double modes[] = {-1.0, 0.0, 0.2, 0.6, 1.0};
#define FOR_MODES(B) for (const double *B = modes; B < modes + 5; B++)

typedef struct {
  double z[4], beta; /* jump and tangent */
} Jump;
#define JUMPS 200
static Jump jumps[JUMPS];
#define FOR_JUMPS(it) for (const Jump *it = jumps; it < jumps + JUMPS; it++)

/* Farther from the seam of pressed faces than differences reach. */
static void DrawJump(uint64_t *seed, Jump *jump)
{
  double *z = jump->z;

  jump->beta = RandomReal(seed, 0.0, 3.0);
  do
    for (int i = 0; i < 4; i++) z[i] = RandomReal(seed, -1.0, 1.0);
  while (hypot(z[2], z[3]) < 0.3 || fabs(z[2] * z[1] - z[3] * z[0]) < 0.02);
}

static int DrawAll(void **state)
{
  uint64_t seed = 11;

  for (int k = 0; k < LAWS; k++) {
    LamCohesive *law = &laws[k];

    law->softening = k % 2 ? LAM_SOFTENING_EXPONENTIAL : LAM_SOFTENING_BILINEAR;
    law->stiffness = exp(RandomReal(&seed, 1.0, 7.0));
    law->strength = exp(RandomReal(&seed, -4.0, 1.0));
    law->beta = RandomReal(&seed, 0.3, 3.0);
    law->mixing = RandomReal(&seed, 1.0, 3.0);
    for (int m = 0; m < 2; m++) /* in what is stored at the strength */
      law->energy[m] = 0.5 * law->strength * law->strength / law->stiffness * exp(RandomReal(&seed, 0.2, 5.0));
  }
  for (int k = 0; k < JUMPS; k++) DrawJump(&seed, &jumps[k]);
  return 0;
}

/* ---- the law, written once more ---- */

static double EnergyOf(const LamCohesive *law, double B)
{
  return law->energy[0] + (law->energy[1] - law->energy[0]) * pow(fmax(B, 0.0), law->mixing);
}

static double EndOf(const LamCohesive *law, double B)
{
  const double G = EnergyOf(law, B), s = law->strength;

  return law->softening == LAM_SOFTENING_BILINEAR ? 2.0 * G / s
                                                  : s / law->stiffness + FARTHEST * (G / s - 0.5 * s / law->stiffness);
}

static double TractionOf(const LamCohesive *law, double B, double delta)
{
  const double G = EnergyOf(law, B), s = law->strength, onset = s / law->stiffness;

  if (delta <= onset) return law->stiffness * delta;
  if (law->softening == LAM_SOFTENING_EXPONENTIAL) return s * exp(-(delta - onset) * s / (G - 0.5 * s * onset));
  return fmax(0.0, s * (1.0 - (delta - onset) / (2.0 * G / s - onset)));
}

/* Integral of a law's traction from a to b, both beyond delta_0 or both below. */
static double Work(const LamCohesive *law, double B, double a, double b)
{
  double sum = 0.0;

  for (int k = 0; k < PANELS; k++)
    for (int q = 0; q < LAM_EDGE_POINTS; q++)
      sum += LamEdgeWeight(q) * (b - a) / PANELS * TractionOf(law, B, a + (b - a) * (k + LamEdgePlace(q)) / PANELS);
  return sum;
}

static double WorkUpTo(const LamCohesive *law, double B, double delta)
{
  const double onset = law->strength / law->stiffness;

  return Work(law, B, 0.0, fmin(delta, onset)) + (delta > onset ? Work(law, B, onset, delta) : 0.0);
}

/* After an opening kappa. */
static double TractionAfter(const LamCohesive *law, double B, double kappa, double delta)
{
  if (delta >= kappa || kappa <= law->strength / law->stiffness) return TractionOf(law, B, delta);
  return TractionOf(law, B, kappa) * delta / kappa;
}

/* ---- the envelope ---- */

TEST(EnvelopeIsTheLaw)
{
  FOR_LAWS(law)
  FOR_MODES(B)
  {
    const LamEnvelope e = LamEnvelopeOf(law, *B);
    double slope;

    for (double x = 0.01; x < 1.2; x += 0.03)
      assert_near(LamEnvelopeTraction(&e, x * EndOf(law, *B), &slope), TractionOf(law, *B, x * EndOf(law, *B)),
                  1e-12 * law->strength);
  }
}

TEST(AreaOfTheEnvelopeIsTheEnergy)
{
  FOR_LAWS(law)
  FOR_MODES(B)
  {
    const LamEnvelope e = LamEnvelopeOf(law, *B);

    assert_near(WorkUpTo(law, *B, EndOf(law, *B)) / EnergyOf(law, *B), 1.0, 1e-12);
    assert_near(LamEnvelopeSpent(&e, EndOf(law, *B)) / EnergyOf(law, *B), 1.0, 1e-12);
  }
}

TEST(ReachInvertsIntegrity)
{
  FOR_LAWS(law)
  FOR_MODES(B)
  {
    const LamEnvelope e = LamEnvelopeOf(law, *B);

    for (double x = 0.005; x <= 1.0; x += 0.02) {
      const double kappa = e.onset + x * (EndOf(law, *B) - e.onset);

      assert_near(LamEnvelopeReach(&e, LamEnvelopeIntegrity(&e, kappa)) / kappa, 1.0, 1e-12);
    }
    assert_near(LamEnvelopeReach(&e, LamEnvelopeIntegrity(&e, 0.3 * e.onset)), e.onset, 0.0);
  }
}

TEST(DissipatedIsTheWorkLessWhatIsStored)
{
  FOR_LAWS(law)
  FOR_MODES(B)
  {
    const LamEnvelope e = LamEnvelopeOf(law, *B);

    for (double x = 0.003; x < 1.0; x += 0.02) {
      const double kappa = x * EndOf(law, *B), stored = 0.5 * TractionOf(law, *B, kappa) * kappa;

      assert_near(LamEnvelopeSpent(&e, kappa), WorkUpTo(law, *B, kappa) - stored, 1e-12 * EnergyOf(law, *B));
    }
  }
}

TEST(NothingHoldsWithoutStrengthOrEnergy)
{
  for (int k = 0; k < 2; k++) {
    LamCohesive law = laws[k];
    LamCohesiveStep step;
    LamEnvelope e;

    *(k ? &law.strength : &law.energy[0]) = 0.0;
    e = LamEnvelopeOf(&law, 0.0);
    LamCohesiveStepEvaluate(&e, LamEnvelopeReach(&e, 1.0), 0.25, &step);
    assert_true(step.phi == 0.0 && step.d == 0.0 && step.dd == 0.0);
  }
}

/* ---- differences: sixth-order central ---- */

static const double central[3] = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};

static LamCohesiveStep StepAt(const LamEnvelope *e, double kappa, double q)
{
  LamCohesiveStep step;

  LamCohesiveStepEvaluate(e, kappa, q, &step);
  return step;
}

static void CheckStep(const LamEnvelope *e, double kappa, double delta, double seam)
{
  const double q = delta * delta, h = 0.1 * fmin(1e-2 * q, fabs(q - seam * seam));
  const LamCohesiveStep step = StepAt(e, kappa, q);
  double d = 0.0, dd = 0.0;

  for (int k = 1; k <= 3; k++) {
    const LamCohesiveStep up = StepAt(e, kappa, q + k * h), down = StepAt(e, kappa, q - k * h);

    d += central[k - 1] * (up.phi - down.phi) / h;
    dd += central[k - 1] * (up.d - down.d) / h;
  }
  assert_near(step.d, d, 1e-9 * e->stiffness + 1e-12 * e->energy / h);
  assert_near(step.dd * q, dd * q, 1e-9 * e->stiffness);
}

/* Undamaged, softening, broken; below and above the largest opening before. */
TEST(StepIsAPotential)
{
  FOR_LAWS(law)
  FOR_MODES(B)
  {
    const LamEnvelope e = LamEnvelopeOf(law, *B);
    const double end = EndOf(law, *B), half = 0.5 * (e.onset + end);

    for (double x = 0.11; x < 1.0; x += 0.19) {
      CheckStep(&e, e.onset, x * e.onset, e.onset);
      CheckStep(&e, e.onset, e.onset + x * (end - e.onset), x < 0.5 ? e.onset : end);
      CheckStep(&e, half, x * half, half);
      CheckStep(&e, half, half + x * (end - half), x < 0.5 ? half : end);
      CheckStep(&e, end, end * (1.0 + x), end);
    }
  }
}

TEST(PotentialIsSmoothAtTheLargestOpening)
{
  FOR_LAWS(law)
  {
    const LamEnvelope e = LamEnvelopeOf(law, 0.3);

    for (double x = 0.05; x < 0.9; x += 0.1) {
      const double kappa = e.onset + x * (EndOf(law, 0.3) - e.onset), q = kappa * kappa;
      const LamCohesiveStep below = StepAt(&e, kappa, q * (1.0 - 1e-14)), above = StepAt(&e, kappa, q * (1.0 + 1e-14));

      assert_near(above.phi, below.phi, 1e-12 * e.energy);
      assert_near(above.d, below.d, 1e-12 * e.stiffness);
    }
  }
}

/* ---- the jump ---- */

static LamJump JumpAt(const double z[4], double beta)
{
  LamJump jump;

  LamJumpEvaluate(z, z + 2, beta, &jump);
  return jump;
}

TEST(OpeningHasNormalAndShearOfTheFrame)
{
  FOR_JUMPS(it)
  {
    const double *z = it->z, beta = it->beta, m = hypot(z[2], z[3]);
    const double normal = (z[1] * z[2] - z[0] * z[3]) / m, shear = (z[0] * z[2] + z[1] * z[3]) / m;
    const LamJump jump = JumpAt(z, beta);

    assert_near(jump.normal, normal, 1e-15);
    assert_near(jump.shear, shear, 1e-15);
    assert_near(jump.q, pow(fmax(normal, 0.0), 2) + pow(beta * shear, 2), 1e-14);
    assert_near(jump.r, pow(fmin(normal, 0.0), 2), 1e-14);
    assert_near(LamJumpMode(&jump, beta, -1.0), pow(beta * shear, 2) / jump.q, 1e-14);
  }
}

TEST(SomeJumpsAreOpenAndSomePressedTogether)
{
  int open = 0;

  FOR_JUMPS(it) open += JumpAt(it->z, it->beta).normal > 0.0;
  assert_in_range(open, JUMPS / 4, 3 * JUMPS / 4);
}

TEST(DerivativesOfTheJump)
{
  const double h = 1e-3;

  FOR_JUMPS(it)
  {
    const LamJump jump = JumpAt(it->z, it->beta);

    for (int i = 0; i < 4; i++) {
      double dq = 0.0, dr = 0.0, ddq[4] = {0.0}, ddr[4] = {0.0};

      for (int k = 1; k <= 3; k++)
        for (int side = -1; side <= 1; side += 2) {
          Jump moved = *it;
          LamJump there;

          moved.z[i] += side * k * h;
          there = JumpAt(moved.z, it->beta);
          dq += side * central[k - 1] * there.q / h;
          dr += side * central[k - 1] * there.r / h;
          for (int j = 0; j < 4; j++) ddq[j] += side * central[k - 1] * there.dq[j] / h;
          for (int j = 0; j < 4; j++) ddr[j] += side * central[k - 1] * there.dr[j] / h;
        }
      assert_near(jump.dq[i], dq, 1e-9);
      assert_near(jump.dr[i], dr, 1e-9);
      for (int j = 0; j < 4; j++) {
        assert_near(jump.ddq[i][j], ddq[j], 1e-8);
        assert_near(jump.ddr[i][j], ddr[j], 1e-8);
        assert_near(jump.ddq[i][j], jump.ddq[j][i], 1e-14);
        assert_near(jump.ddr[i][j], jump.ddr[j][i], 1e-14);
      }
    }
  }
}

/* Faces that have slid far without resistance and are just parting. */
TEST(SmallOpeningBesideALargeSlip)
{
  const double turn = 0.3, c = cos(turn), s = sin(turn);

  for (double normal = 1e-4; normal > 1e-12; normal *= 0.1) {
    const double z[4] = {c - normal * s, s + normal * c, c, s};
    const LamJump jump = JumpAt(z, 0.0);

    assert_true(jump.q >= 0.0);
    assert_near(sqrt(jump.q), normal, 1e-15);
    assert_near(hypot(jump.dq[0], jump.dq[1]), 2.0 * normal, 1e-14);
  }
}

/* ---- cycles of one point ---- */

typedef struct {
  LamBondHistory history;
  LamBond bond;
  LamJump jump;
  LamCohesiveStep step;
} Point;

/* The next state of a point: normal and shear components of the jump. */
static void Advance(Point *point, double normal, double shear)
{
  const double z[4] = {shear, normal, 1.0, 0.0};

  LamBondTake(&point->history, &point->bond);
  point->jump = JumpAt(z, point->bond.law.beta);
  LamCohesiveStepEvaluate(&point->bond.now, point->bond.kappa, point->jump.q, &point->step);
  point->history = LamBondKeep(&point->bond, &point->jump, &point->step);
}

/* Components of the unit vector of delta = 1 with mode B. */
static void Direction(const LamCohesive *law, double B, double *normal, double *shear)
{
  *normal = sqrt(1.0 - B);
  *shear = sqrt(B) / law->beta;
}

static Point Virgin(const LamCohesive *law, double B)
{
  Point point = {.history = LAM_UNDAMAGED, .bond.law = *law};
  double normal, shear;

  Direction(law, B, &normal, &shear);
  Advance(&point, 1e-3 * normal * law->strength / law->stiffness, 1e-3 * shear * law->strength / law->stiffness);
  return point;
}

/* Openings of growing amplitude, back to nothing and again, up to 1.3 of the end; some go back only half. */
static double CycleAt(int step, double end)
{
  const int cycle = step / 20;
  const double part = (step % 20) / 20.0, amplitude = end * pow(1.3, cycle - 19.0);

  return amplitude * (cycle % 3 ? 0.75 - 0.25 * cos(2.0 * M_PI * part) : 0.5 - 0.5 * cos(2.0 * M_PI * part));
}
#define CYCLE_STEPS (20 * 20)

TEST(CyclesOfGrowingAmplitude)
{
  FOR_LAWS(law)
  for (const double *B = modes + 1; B < modes + 5; B++) {
    Point point = Virgin(law, *B);
    double normal, shear, kappa = 0.0, spent = 0.0;

    Direction(law, *B, &normal, &shear);
    for (int step = 1; step < CYCLE_STEPS; step++) {
      const double delta = CycleAt(step, EndOf(law, *B));
      const double expected = TractionAfter(law, *B, kappa, delta);

      Advance(&point, delta * normal, delta * shear);
      spent += LamBondSpent(&point.bond, &point.step);
      kappa = fmax(kappa, delta);
      assert_near(2.0 * point.step.d * point.jump.normal, expected * normal, 1e-12 * law->strength);
      assert_near(2.0 * point.step.d * point.jump.shear * law->beta, expected * shear * law->beta,
                  1e-12 * law->strength);
      assert_near(spent, WorkUpTo(law, *B, kappa) - 0.5 * TractionOf(law, *B, kappa) * kappa,
                  1e-11 * EnergyOf(law, *B));
    }
  }
}

/* phi less what was stored before is the work of the traction, also where a step passes kappa. */
TEST(StepsDoTheWorkOfTheirTractions)
{
  FOR_LAWS(law)
  {
    Point point = Virgin(law, 0.0);
    double kappa = law->strength / law->stiffness, stored = 0.0;

    for (int step = 0; step < CYCLE_STEPS; step += 7) {
      const double delta = CycleAt(step, EndOf(law, 0.0));
      const double before = fmin(delta, kappa), secant = TractionOf(law, 0.0, kappa) / kappa;

      Advance(&point, delta, 0.0);
      assert_near(point.step.phi - stored,
                  0.5 * secant * before * before - stored + (delta > kappa ? Work(law, 0.0, kappa, delta) : 0.0),
                  1e-12 * law->energy[0]);
      kappa = fmax(kappa, delta);
      stored = 0.5 * TractionOf(law, 0.0, kappa) / kappa * delta * delta;
      assert_near(point.step.phi - LamBondSpent(&point.bond, &point.step), stored, 1e-12 * law->energy[0]);
    }
  }
}

/* ---- mixed modes ---- */

TEST(ProportionalPathSpendsTheEnergyOfItsMode)
{
  FOR_LAWS(law)
  for (const double *B = modes + 1; B < modes + 5; B++) {
    const double end = EndOf(law, *B);
    Point point = Virgin(law, *B);
    double normal, shear, spent = 0.0;

    Direction(law, *B, &normal, &shear);
    for (int k = 1; k <= 50; k++) {
      Advance(&point, 1.01 * end * k / 50 * normal, 1.01 * end * k / 50 * shear);
      spent += LamBondSpent(&point.bond, &point.step);
    }
    assert_near(spent / EnergyOf(law, *B), 1.0, 1e-12);
  }
}

/* (t_n/sigma)^2 + (t_t/(beta sigma))^2 is 1 at its largest. */
TEST(StrengthIsTheQuadraticCriterion)
{
  FOR_LAWS(law)
  for (const double *B = modes + 1; B < modes + 5; B++) {
    const double onset = law->strength / law->stiffness;
    Point point = Virgin(law, *B);
    double normal, shear, largest = 0.0;

    Direction(law, *B, &normal, &shear);
    for (int k = 1; k <= 40; k++) {
      double tn, tt;

      Advance(&point, onset * k / 20 * normal, onset * k / 20 * shear);
      tn = 2.0 * point.step.d * point.jump.normal;
      tt = 2.0 * point.step.d * law->beta * law->beta * point.jump.shear;
      largest = fmax(largest, pow(tn / law->strength, 2) + pow(tt / (law->beta * law->strength), 2));
    }
    assert_near(largest, 1.0, 1e-12);
  }
}

TEST(ShearOfClosedFacesIsPureMode)
{
  FOR_LAWS(law)
  {
    Point point = {.history = LAM_UNDAMAGED, .bond.law = *law};

    Advance(&point, -0.1, 0.3 * law->strength / law->stiffness);
    assert_near(point.history.mode, 1.0, 1e-15);
  }
}

TEST(OnlyUndamagedPointsResistCompression)
{
  FOR_LAWS(law)
  {
    const double onset = law->strength / law->stiffness;
    Point point = Virgin(law, 0.0);

    Advance(&point, 0.9 * onset, 0.0);
    Advance(&point, -onset, 0.0);
    assert_near(point.bond.pressing, law->stiffness, 0.0);
    Advance(&point, 1.1 * onset, 0.0);
    Advance(&point, -onset, 0.0);
    assert_near(point.bond.pressing, 0.0, 0.0);
  }
}

TEST(IntegrityOutlastsAChangeOfMode)
{
  FOR_LAWS(law)
  {
    const double kappa = 0.3 * fmin(EndOf(law, 0.0), EndOf(law, 1.0)) + 0.5 * law->strength / law->stiffness;
    Point point = Virgin(law, 0.0);
    double secant;

    Advance(&point, kappa, 0.0);
    secant = TractionAfter(law, 0.0, kappa, kappa) / kappa;
    for (int k = 0; k < 2; k++) {
      const double tiny = 1e-3 * law->strength / law->stiffness;

      Advance(&point, k ? 0.0 : tiny, k ? tiny : 0.0);
      Advance(&point, k ? 0.0 : tiny, k ? tiny : 0.0);
      assert_near(2.0 * point.step.d / secant, 1.0, 1e-12);
      assert_near(point.history.mode, k, 1e-15);
    }
  }
}

TEST_GROUP(.setup = DrawAll);
