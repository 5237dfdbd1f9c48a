/* What is read off the curve of a mechanical test, on curves whose readings are known. */
#include "support/test.h"
#include "mechanical_test.h"

TEST_GROUP(.petsc = 1);

#define STATES 21
#define PEAK 0.08

typedef struct {
  PetscReal (*stress)(PetscReal strain), (*slope)(PetscReal strain);
} Curve;

/* s exp(-s/PEAK): its maximum is at PEAK. */
static PetscReal Softening(PetscReal s)
{
  return s * exp(-s / PEAK);
}
static PetscReal SofteningSlope(PetscReal s)
{
  return (1 - s / PEAK) * exp(-s / PEAK);
}
/* Falls between pi/60 and pi/30, and then rises higher. */
static PetscReal Yielding(PetscReal s)
{
  return s + 0.05 * sin(40 * s);
}
static PetscReal YieldingSlope(PetscReal s)
{
  return 1 + 2 * cos(40 * s);
}
static PetscReal Line(PetscReal s)
{
  return 3 * s;
}
static PetscReal LineSlope(PetscReal s)
{
  return 3 + 0 * s;
}

/* F11 goes to 1 + end in equal steps, and back if asked. */
static void Program(PetscReal end, PetscBool back, LamScene *scene, LamLoad loads[2 * STATES])
{
  const PetscInt count = back ? 2 * STATES - 1 : STATES;

  *scene = (LamScene){.scales = {.length = 1, .stress = 1e6}, .load_count = count, .loads = loads};
  for (PetscInt k = 0; k < count; k++) {
    const PetscReal share = (PetscReal)(k < STATES ? k : 2 * (STATES - 1) - k) / (STATES - 1);

    loads[k] = (LamLoad){.F = {1 + share * end, 0, 0, 0, 1, 0, 0, 0, 1}};
  }
}

static void Follow(const Curve *curve, const LamScene *scene, LamTest *test)
{
  LamTestCreate(scene, test);
  for (PetscInt k = 0; k < scene->load_count; k++) {
    LamResponse r;

    CHECK(LamResponseInit(&scene->loads[k], &r));
    r.status = LAM_CONVERGED;
    r.P[0] = curve->stress(r.load.F[0] - 1);
    r.tangent[0] = curve->slope(r.load.F[0] - 1);
    CHECK(LamTestAdd(test, k + 1, &r, NULL));
  }
}

static LamTestReadings Read(const Curve *curve, PetscReal end, PetscBool back)
{
  LamLoad loads[2 * STATES];
  LamTestReadings readings;
  LamScene scene;
  LamTest test;

  Program(end, back, &scene, loads);
  Follow(curve, &scene, &test);
  LamTestRead(&test, &readings);
  CHECK(LamTestDestroy(&test));
  return readings;
}

static const Curve softening = {Softening, SofteningSlope}, yielding = {Yielding, YieldingSlope},
                   line = {Line, LineSlope};

TEST(PeakIsFoundBetweenStates)
{
  const LamTestReadings r = Read(&softening, 0.21, PETSC_FALSE);

  assert_true(r.passed);
  assert_near(r.peak.strain, PEAK, 1e-4);
  assert_near(r.peak.stress, Softening(PEAK), 1e-6);
}

TEST(EnergyToThePeak)
{
  const LamTestReadings r = Read(&softening, 0.21, PETSC_FALSE);

  assert_near(r.energy_to_peak, PEAK * PEAK * (1 - 2 * exp(-1)), 1e-6);
}

TEST(ACompressedSpecimenHasItsPeakToo)
{
  static const Curve compressed = {Line, LineSlope};
  const LamTestReadings r = Read(&compressed, -0.2, PETSC_FALSE);

  assert_near(r.peak.stress, -0.6, 1e-12);
  assert_near(r.energy_to_peak, 0.06, 1e-12);
}

TEST(ACurveThatRisesHasNoPeakYet)
{
  const LamTestReadings r = Read(&line, 0.2, PETSC_FALSE);

  assert_false(r.passed);
  assert_near(r.peak.strain, 0.2, 1e-12);
  assert_true(isnan(r.bioyield.strain));
}

TEST(BioyieldIsTheFirstMaximumThatIsExceeded)
{
  const LamTestReadings r = Read(&yielding, 0.18, PETSC_FALSE);

  assert_near(r.bioyield.strain, PETSC_PI / 60, 1e-4);
  assert_near(r.bioyield.stress, Yielding(PETSC_PI / 60), 1e-5);
  assert_true(r.peak.strain > r.bioyield.strain);
}

TEST_IS(ModulusOfTheFirstState, assert_near(Read(&softening, 0.2, PETSC_FALSE).modulus, 1, 1e-12));

TEST(AnElasticCurveReturnsItsWork)
{
  const LamTestReadings r = Read(&softening, 0.2, PETSC_TRUE);

  assert_near(r.work, r.returned, 1e-14);
  assert_true(r.work > 0);
}

TEST(ModuliAtAStrain)
{
  LamLoad loads[2 * STATES];
  PetscReal stress, secant, tangent;
  LamScene scene;
  LamTest test;

  Program(0.2, PETSC_FALSE, &scene, loads);
  Follow(&softening, &scene, &test);
  assert_true(LamTestAt(&test, 0.033, &stress, &secant, &tangent));
  assert_near(stress, Softening(0.033), 1e-6);
  assert_near(secant, Softening(0.033) / 0.033, 1e-5);
  assert_near(tangent, SofteningSlope(0.033), 1e-3);
  assert_false(LamTestAt(&test, 0.3, &stress, &secant, &tangent));
  CHECK(LamTestDestroy(&test));
}

/* Over a jump the curve is a straight line, whose fall is a maximum at the state before it. */
TEST(AJumpEndsThePeak)
{
  LamScene scene;
  LamLoad loads[2 * STATES];
  LamTestReadings r;
  LamTest test;

  Program(0.2, PETSC_FALSE, &scene, loads);
  Follow(&line, &scene, &test);
  for (PetscInt k = 10; k < test.count; k++) test.points[k].stress *= 0.2;
  test.points[10].jumped = PETSC_TRUE;
  LamTestRead(&test, &r);
  assert_true(r.passed);
  assert_near(r.peak.strain, 0.09, 1e-12);
  CHECK(LamTestDestroy(&test));
}

/* Points whose slopes are not known, as those of bodies: 0, 3 and 1 over 0, 1 and 3. */
static LamTestReadings ReadLines(void)
{
  LamTest test = {.unit = 1, .volume = 1};
  LamTestReadings r;

  for (int k = 0; k < 3; k++)
    CHECK(LamTestAddPoint(&test, (LamTestPoint){.strain = (PetscReal[]){0, 1, 3}[k],
                                                .stress = (PetscReal[]){0, 3, 1}[k],
                                                .lateral = (PetscReal[]){1, 0.7, 0.7}[k],
                                                .modulus = NAN,
                                                .poisson = NAN}));
  LamTestRead(&test, &r);
  CHECK(LamTestDestroy(&test));
  return r;
}
TEST_IS(LinesJoinPointsWithoutSlopes, assert_near(ReadLines().work, 5.5, 1e-14));
TEST_IS(ThePeakOfLinesIsAPoint, assert_true(ReadLines().passed &&ReadLines().peak.strain == 1));
TEST_IS(ModulusOfTheFirstLine, assert_near(ReadLines().modulus, 3, 1e-14));
TEST_IS(PoissonsRatioOfTheFirstLine, assert_near(ReadLines().poisson, 0.3, 1e-14));

/* A process that is free, pulled and released. */
TEST(TheCurveOfAProcessBeginsWhereItDrives)
{
  LamProcessLeg legs[] = {{.duration = 5, .F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .control.given = {PETSC_TRUE}},
                          {.duration = 5, .F = {1.1, 0, 0, 0, 1, 0, 0, 0, 1}},
                          {.duration = 5, .F = {1, 0, 0, 0, 1, 0, 0, 0, 1}}};
  LamScene scene = {.process = {.leg_count = 3, .legs = legs}};
  LamProcessState states[4];
  LamTest test;

  for (int k = 0; k < 4; k++) {
    states[k] = (LamProcessState){.time = 5 * k, .F = {1 + 0.1 * (k == 2), 0, 0, 0, 1, 0, 0, 0, 1}};
    CHECK(LamResponseInit(&(LamLoad){.F = {1 + 0.1 * (k == 2), 0, 0, 0, 1, 0, 0, 0, 1}}, &states[k].response));
    states[k].response.status = LAM_CONVERGED;
  }
  CHECK(LamTestOfProcess(&scene, 4, states, &test));
  assert_int_equal(test.component, 0);
  assert_int_equal(test.count, 3);
  assert_int_equal(test.points[0].state, 1);
  CHECK(LamTestDestroy(&test));
}

/* Of P where no F is prescribed that changes. */
TEST(AStressThatIsDrivenIsFound)
{
  LamLoad loads[2] = {{.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}}, {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}}};
  LamStressControl controls[2] = {{.given = {[4] = PETSC_TRUE}, .P = {[4] = 0.1}},
                                  {.given = {[4] = PETSC_TRUE}, .P = {[4] = 0.2}}};
  const LamScene scene = {.load_count = 2, .loads = loads, .controls = controls};
  LamTest test;

  LamTestCreate(&scene, &test);
  assert_int_equal(test.component, 4);
}
