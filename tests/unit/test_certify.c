/* Claims about reactions that are corrected by a second responder, with a material of known answers. On one rank:
   errors go by the numbers of points. */
#include "support/macro_fixture.h"
#include "macro_impl.h"
#include "sample.h"
#include <unistd.h>

/* ---- a responder that interpolates badly, and the right one ---- */

typedef struct {
  Fixture run, direct;    /* the body with the bad responder, and with the right one */
  LamResponder reference; /* the right one, for certificates */
  Synthetic *right;
} Pair;

static PetscReal Size = 1e-5; /* of the errors */

/* A number in [-1, 1] that depends on a point alone. */
static PetscReal Noise(PetscInt point, PetscInt which)
{
  return 2 * LamSampleRandom(which, point) - 1;
}

/* Errors of stress that differ from point to point, with estimates that are within a factor of four right. */
static PetscErrorCode RespondBadly(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                   LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(SyntheticRespond(ctx, n, loads, points, responses));
  ((Synthetic *)ctx)->counters.interpolated += n;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal size = Size * pow(4, Noise(points[i], 1));

    if (responses[i].status != LAM_CONVERGED) continue;
    responses[i].source = LAM_SOURCE_DATABASE;
    responses[i].error_estimate = size * pow(4, Noise(points[i], 2));
    for (int k = 0; k < 9; k++) responses[i].P[k] += size * Noise(points[i], 3 + k);
  }
  PetscFunctionReturn(0);
}

static void PairDestroy(Pair *pair)
{
  FixtureDestroy(&pair->run);
  FixtureDestroy(&pair->direct);
  CHECK(LamResponderDestroy(&pair->reference));
}

/* Sets up pair->run, whose scene is made, with certificates. */
static void SetUp(Pair *pair, LamCertify which)
{
  PetscInt points;

  FixtureSetUp(&pair->run, PETSC_COMM_WORLD);
  pair->run.material->respond = RespondBadly;
  CHECK(LamMacroGetPointCount(pair->run.macro, &points));
  CHECK(SyntheticCreate(points, &pair->reference, &pair->right));
  CHECK(LamMacroSetReference(pair->run.macro, pair->reference, which, PETSC_FALSE));
}

static void Run(Pair *pair, LamCertify which)
{
  pair->direct.scene = pair->run.scene;
  pair->direct.stop_after = -1;
  SetUp(pair, which);
  FixtureSolve(&pair->run, LAM_MACRO_DONE);
  FixtureRun(&pair->direct, PETSC_COMM_WORLD, LAM_MACRO_DONE);
}

static void PairBegin(Pair *pair)
{
  memset(pair, 0, sizeof(*pair));
  Size = 1e-5;
}

#define PAIR_TEST(name) TEST_ON(name, Pair, pair, PairBegin(pair), PairDestroy(pair))

/* The corrected reactions of a step are those of the direct run but for `share` of what was corrected most. */
static void CheckCorrected(const Pair *pair, PetscInt k, const LamMacroCertificate *certificate, PetscReal share)
{
  const LamMacroStep *run = &pair->run.steps[k], *direct = &pair->direct.steps[k];
  PetscReal corrected = 0;

  assert_true(certificate->made);
  assert_string_equal(certificate->why, "");
  for (PetscInt s = 0; s < run->boundary_count; s++)
    for (int i = 0; i < 2; i++)
      corrected = PetscMax(corrected, PetscAbsReal(run->reaction[s][i] - direct->reaction[s][i]));
  assert_true(corrected > 0.01 * Size);
  for (PetscInt s = 0; s < run->boundary_count; s++)
    for (int i = 0; i < 2; i++)
      assert_true(PetscAbsReal(certificate->reaction[s][i] - direct->reaction[s][i]) <= share * corrected + 1e-11);
}

static void CheckLast(Pair *pair)
{
  Run(pair, LAM_CERTIFY_ALL);
  CheckCorrected(pair, pair->run.step_count - 1, &FixtureLast(&pair->run)->certificate, 2e-3);
}

/* But for rounding, where several ranks solve. */
static void CheckSame(const PetscReal a[LAM_MAX_BOUNDARIES][2], const PetscReal b[LAM_MAX_BOUNDARIES][2])
{
  for (int k = 0; k < 4; k++) assert_near(a[k / 2][k % 2], b[k / 2][k % 2], 1e-11);
}

/* ---- all points: the formula, whose error is of second order ---- */

PAIR_TEST(ShearIsCorrected)
{
  FixtureShear(&pair->run, 3, 0.3, 1);
  CheckLast(pair);
}

/* Displacements are prescribed from an inflated body, which is in error, too. */
PAIR_TEST(InflatedBodyIsCorrected)
{
  FixtureShear(&pair->run, 3, 0.3, 2);
  FixtureInflate(&pair->run);
  CheckLast(pair);
}

PAIR_TEST(SidesOfSymmetryAreCorrected)
{
  FixtureScene(&pair->run, 3, 2, 0.7, 2);
  FixtureSymmetry(&pair->run);
  FixtureBoundary(&pair->run, "right", 0.1, NAN);
  FixtureBoundary(&pair->run, "top", NAN, 0.2);
  FixtureInflate(&pair->run);
  CheckLast(pair);
}

/* A follower makes the tangent unsymmetric. */
PAIR_TEST(HeldSideBesideFollowerIsCorrected)
{
  FixtureScene(&pair->run, 3, 2, 1, 1);
  FixtureBoundary(&pair->run, "bottom", 0, 0);
  LamBoundary *right = FixtureAdd(&pair->run, "right", LAM_BOUNDARY_TRACTION);
  right->follower = PETSC_TRUE;
  right->traction[0] = 0.03;
  right->traction[1] = -0.05;
  Run(pair, LAM_CERTIFY_ALL);
  LamMacroCertificate *certificate = &pair->run.steps[pair->run.step_count - 1].certificate;
  assert_true(isnan(certificate->reaction[1][0])); /* that of the follower itself is not */
  for (int i = 0; i < 2; i++) certificate->reaction[1][i] = pair->direct.steps[0].reaction[1][i];
  CheckCorrected(pair, 0, certificate, 2e-3);
}

/* The force of a round obstacle turns as nodes slide along it. */
PAIR_TEST(IndenterIsCorrected)
{
  FixtureScene(&pair->run, 4, 3, 1, 3);
  FixtureBoundary(&pair->run, "bottom", 0, 0);
  FixtureIndenter(&pair->run, 0.6, 0.45, 1, 0.02, -0.15);
  CheckLast(pair);
}

/* A node may be at an obstacle and in a plane of symmetry. */
PAIR_TEST(PlateIsCorrected)
{
  FixtureQuarterDisc(&pair->run, 2, 2);
  LamBoundary *plate = FixtureAdd(&pair->run, "rim", LAM_BOUNDARY_PLATE);
  plate->displacement[1] = -0.15;
  plate->normal[1] = -1;
  CheckLast(pair);
}

/* The stress around the axis counts, too; with a round probe, and nodes on the axis. */
PAIR_TEST(AxisymmetricBodyIsCorrected)
{
  FixtureScene(&pair->run, 4, 3, 1, 3);
  pair->run.scene.macro.symmetry = LAM_AXISYMMETRIC;
  FixtureBoundary(&pair->run, "bottom", 0, 0);
  FixtureIndenter(&pair->run, 0.6, 0, 1, 0, -0.15);
  CheckLast(pair);
}

PAIR_TEST(InflatedAxisymmetricBodyIsCorrected)
{
  FixtureScene(&pair->run, 3, 3, 1, 2);
  pair->run.scene.macro.symmetry = LAM_AXISYMMETRIC;
  FixtureBoundary(&pair->run, "bottom", 0, 0);
  FixtureBoundary(&pair->run, "top", 0, -0.15);
  FixtureInflate(&pair->run);
  CheckLast(pair);
}

/* ---- the end of a run ---- */

/* The state of the largest force is corrected beside the last one. */
PAIR_TEST(PeakIsCorrected)
{
  const LamLeg legs[] = {{.to = 1, .steps = 2}, {.to = 0.2, .steps = 2}};

  FixtureShear(&pair->run, 2, 0.3, 4);
  FixtureLegs(&pair->run, 2, legs);
  Run(pair, LAM_CERTIFY_SHARE);
  assert_int_equal(pair->run.step_count, 4);
  assert_int_equal(FixtureLast(&pair->run)->peak.step, 2);
  CheckCorrected(pair, 3, &FixtureLast(&pair->run)->certificate, 3);
  CheckCorrected(pair, 1, &FixtureLast(&pair->run)->peak, 3);
  assert_false(pair->run.steps[1].certificate.made);
}

/* A certificate does not change what follows. */
PAIR_TEST(RunIsAsWithout)
{
  OWNED(Pair, PairDestroy) without;

  PairBegin(&without);
  FixtureShear(&pair->run, 2, 0.3, 3);
  FixtureShear(&without.run, 2, 0.3, 3);
  Run(pair, LAM_CERTIFY_ALL);
  Run(&without, LAM_CERTIFY_NONE);
  for (PetscInt k = 0; k < 3; k++) CheckSame(pair->run.steps[k].reaction, without.run.steps[k].reaction);
}

static PetscBool Stop(void)
{
  return PETSC_TRUE;
}

/* A stop while points are solved is the reason. */
PAIR_TEST(StopIsTold)
{
  LamMacroCertificate certificate = {.made = PETSC_TRUE};

  FixtureShear(&pair->run, 2, 0.3, 1);
  Run(pair, LAM_CERTIFY_SHARE);
  CHECK(LamMacroSetStop(pair->run.macro, Stop));
  pair->right->largest_strain = 0;
  CHECK(LamMacroCorrect(pair->run.macro, 24, 0, &certificate));
  assert_non_null(strstr(certificate.why, "stopped"));
}

PAIR_TEST(PointWithoutAnswerIsTold)
{
  FixtureShear(&pair->run, 2, 0.3, 1);
  SetUp(pair, LAM_CERTIFY_SHARE);
  pair->right->largest_strain = 0;
  FixtureSolve(&pair->run, LAM_MACRO_DONE);
  assert_non_null(strstr(FixtureLast(&pair->run)->certificate.why, "too far"));
  assert_true(isnan(FixtureLast(&pair->run)->certificate.reaction[0][0]));
}

/* Bodies that cannot be certified say so, and refuse it where it is asked for. */
PAIR_TEST(SealedBodySaysWhy)
{
  FixtureShear(&pair->run, 2, 0.1, 1);
  FixtureSeal(&pair->run, 0.1, 100);
  SetUp(pair, LAM_CERTIFY_SHARE);
  FixtureSolve(&pair->run, LAM_MACRO_DONE);
  assert_non_null(strstr(FixtureLast(&pair->run)->certificate.why, "sealed"));
  CHECK(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  assert_int_equal(LamMacroSetReference(pair->run.macro, pair->reference, LAM_CERTIFY_ALL, PETSC_FALSE),
                   PETSC_ERR_USER_INPUT);
  CHECK(PetscPopErrorHandler());
}

/* ---- checkpoints ---- */

static const char Path[] = "certify.tmp.ckpt";

static PetscErrorCode SaveMonitor(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  LamArchive archive;

  PetscFunctionBeginUser;
  PetscCall(FixtureMonitor(macro, step, stop, ctx));
  PetscCall(LamArchiveCreate(PETSC_COMM_WORLD, Path, &archive));
  PetscCall(LamMacroArchive(macro, archive));
  PetscCall(LamArchiveClose(&archive, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* Four steps from an inflated body, the largest force at the second; with branches, whose points are led along. */
static void SetUpProgram(Pair *pair)
{
  const LamLeg legs[] = {{.to = 1, .steps = 2}, {.to = 0.2, .steps = 2}};

  FixtureShear(&pair->run, 3, 0.3, 4);
  FixtureInflate(&pair->run);
  FixtureLegs(&pair->run, 2, legs);
  SetUp(pair, LAM_CERTIFY_SHARE);
  CHECK(LamMacroSetReference(pair->run.macro, pair->reference, LAM_CERTIFY_SHARE, PETSC_TRUE));
}

/* Certificates of both states are those of a run that was not interrupted. */
PAIR_TEST(ResumedRunHasTheSameCertificate)
{
  OWNED(Pair, PairDestroy) other;
  LamArchive archive;

  PairBegin(&other);
  SetUpProgram(pair);
  FixtureSolve(&pair->run, LAM_MACRO_DONE);
  SetUpProgram(&other);
  other.run.stop_after = 3;
  CHECK(LamMacroSetMonitor(other.run.macro, SaveMonitor, &other.run));
  FixtureSolve(&other.run, LAM_MACRO_STOPPED);
  PairDestroy(&other);
  PairBegin(&other);
  SetUpProgram(&other);
  CHECK(LamArchiveOpen(PETSC_COMM_WORLD, Path, &archive));
  CHECK(LamMacroArchive(other.run.macro, archive));
  CHECK(LamArchiveClose(&archive, PETSC_FALSE));
  unlink(Path);
  FixtureSolve(&other.run, LAM_MACRO_DONE);
  const LamMacroStep *one = FixtureLast(&pair->run), *two = FixtureLast(&other.run);
  assert_string_equal(one->certificate.why, "");
  assert_int_equal(one->peak.step, 2);
  CheckSame(one->certificate.reaction, two->certificate.reaction);
  CheckSame(one->peak.reaction, two->peak.reaction);
  CheckSame(one->peak.margin, two->peak.margin);
}

/* ---- the sample ---- */

/* Of 300 samples at most 1 % have an interval that does not hold the sum over all points. */
static void CheckIntervals(Pair *pair, PetscInt wanted)
{
  LamMacroCertificate truth = {.made = PETSC_TRUE}, certificate;
  PetscInt missed = 0, judged = 0;

  CHECK(LamMacroCorrect(pair->run.macro, PETSC_MAX_INT, 0, &truth));
  assert_int_equal(truth.points, truth.of);
  for (PetscInt seed = 0; seed < 300; seed++) {
    certificate = (LamMacroCertificate){.made = PETSC_TRUE};
    CHECK(LamMacroCorrect(pair->run.macro, wanted, seed, &certificate));
    assert_true(certificate.points <= wanted && certificate.points < certificate.of);
    for (int i = 0; i < 2; i++, judged++)
      missed += PetscAbsReal(certificate.reaction[1][i] - truth.reaction[1][i]) > certificate.margin[1][i];
  }
  assert_true(missed <= judged / 100);
}

PAIR_TEST(IntervalHolds)
{
  Size = 1e-3;
  FixtureShear(&pair->run, 4, 0.3, 1);
  Run(pair, LAM_CERTIFY_SHARE);
  CheckIntervals(pair, 12);
  CheckIntervals(pair, 48);
}

/* Also where the inflated body is not uniform and is sampled. */
PAIR_TEST(IntervalHoldsOfUnevenInflatedBody)
{
  Size = 1e-3;
  FixtureShear(&pair->run, 4, 0.3, 1);
  FixtureInflate(&pair->run);
  SetUp(pair, LAM_CERTIFY_SHARE);
  FixtureSolve(&pair->run, LAM_MACRO_DONE);
  assert_false(pair->run.macro->inflated.uniform);
  CheckIntervals(pair, 48);
}

/* Where the value is proportional to the size any sample gives the sum. */
TEST(ProportionalValuesAreExact)
{
  PetscReal size[50], value[50], share[50], sum, margin, total = 0;
  PetscInt draws[50], drawn;

  for (PetscInt i = 0; i < 50; i++) {
    size[i] = 1 + i % 7 + (i == 9 ? 100 : 0);
    value[i] = -3 * size[i];
    total += value[i];
  }
  CHECK(LamSampleDraw(50, size, 10, 3, draws, share, &drawn));
  assert_int_equal(draws[9], -1); /* for certain */
  LamSampleSum(50, draws, share, drawn, value, &sum, &margin);
  assert_true(PetscAbsReal(sum - total) < 1e-11 * PetscAbsReal(total));
  assert_true(margin < 1e-11 * PetscAbsReal(total));
}

/* Over many samples the mean estimate is the sum. */
TEST(EstimateHasNoBias)
{
  PetscReal size[50], value[50], share[50], sum, margin, total = 0, mean = 0;
  PetscInt draws[50], drawn;

  for (PetscInt i = 0; i < 50; i++) {
    size[i] = 1 + i % 7;
    value[i] = (i % 11) - 4;
    total += value[i];
  }
  for (PetscInt k = 0; k < 20000; k++) {
    CHECK(LamSampleDraw(50, size, 10, k, draws, share, &drawn));
    assert_int_equal(drawn, 10);
    LamSampleSum(50, draws, share, drawn, value, &sum, &margin);
    mean += sum / 20000;
  }
  assert_true(PetscAbsReal(mean - total) < 0.03 * PetscAbsReal(total));
}

/* Tables of Student's t. */
TEST(StudentIsThatOfTables)
{
  assert_true(PetscAbsReal(LamSampleStudent(3) - 5.8409) < 1e-3);
  assert_true(PetscAbsReal(LamSampleStudent(4) - 4.6041) < 0.05);
  assert_true(PetscAbsReal(LamSampleStudent(11) - 3.1058) < 2e-3);
  assert_true(PetscAbsReal(LamSampleStudent(23) - 2.8073) < 1e-3);
  assert_true(PetscAbsReal(LamSampleStudent(100000) - 2.5758) < 1e-3);
}
