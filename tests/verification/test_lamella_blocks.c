/* The law of the lamella between bodies of wall, against closed forms: two blocks in series, and strips that are peeled
   apart (support/peeling.h; meshes and numbers of points: bench_peel). */
#include "support/rve_fixture.h"
#include "support/peeling.h"

/* ---- two blocks in series ---- */

#define SIDE 2         /* elements */
#define STRENGTH 0.3   /* the blocks are then stretched by 8 % */
#define ENERGY 0.15    /* a range of 1, so long that they do not snap */
#define STIFFNESS 6.0  /* of the lamella */
#define PUSHED 50.0    /* of pressed faces */
#define SIMPSONS 1000  /* parts of a quadrature */
#define INCREMENT 0.01 /* of the elongation */
static const double turns[] = {0.35, 0.0, 0.55, 0.1, -0.05, 0.9, 0.0, 1.4}; /* of the elongation */

/* First Piola-Kirchhoff stress of the plain law at principal stretches a and b, and 1: along b. */
static double Stress(const LamWall *wall, double a, double b)
{
  const double J = a * b, I1 = a * a + b * b + 1.0, I2 = a * a * b * b + a * a + b * b;

  return wall->C1 / pow(J, 2.0 / 3.0) * (b - I1 / (3.0 * b)) +
         wall->C2 / pow(J, 4.0 / 3.0) * (b * (a * a + 1.0) - 2.0 * I2 / (3.0 * b)) +
         0.5 * wall->bulk_modulus * (J - 1.0 / J) * a;
}

/* Of a block with free sides that is stretched by b. */
static double BlockStress(const LamWall *wall, double b)
{
  double low = 0.5, high = 2.0;

  for (int k = 0; k < 60; k++) {
    const double a = 0.5 * (low + high);

    *(Stress(wall, b, a) > 0.0 ? &high : &low) = a;
  }
  return Stress(wall, low, b);
}

/* The lamella's law after an opening kappa; faces push each other. */
static double Traction(LamSoftening softening, double kappa, double delta)
{
  const double onset = STRENGTH / STIFFNESS, range = 2.0 * ENERGY / STRENGTH, at = fmax(fmax(kappa, delta), onset);
  const double T = softening == LAM_SOFTENING_EXPONENTIAL ? STRENGTH * exp((onset - at) / (0.5 * (range - onset)))
                                                          : STRENGTH * fmax(0.0, (range - at) / (range - onset));

  return delta < 0.0 ? PUSHED * delta : T * delta / at;
}

static double Spent(LamSoftening softening, double kappa)
{
  const double onset = STRENGTH / STIFFNESS, range = 2.0 * ENERGY / STRENGTH;
  const double end = softening == LAM_SOFTENING_EXPONENTIAL ? kappa : fmin(kappa, range);
  double sum = 0.5 * STIFFNESS * pow(fmin(kappa, onset), 2);

  for (int k = 0; k < SIMPSONS && kappa > onset; k++) {
    const double h = (end - onset) / SIMPSONS, at = onset + k * h;

    sum += h / 6.0 *
           (Traction(softening, 0.0, at) + 4.0 * Traction(softening, 0.0, at + 0.5 * h) +
            Traction(softening, 0.0, at + h));
  }
  return sum - 0.5 * kappa * Traction(softening, 0.0, kappa);
}

/* Opening at which blocks and lamella bear the same, at an elongation of all. */
static double SeriesOpening(const LamWall *wall, LamSoftening softening, double kappa, double elongation)
{
  double low = -0.5, high = 2.0;

  for (int k = 0; k < 60; k++) {
    const double delta = 0.5 * (low + high);

    *(Traction(softening, kappa, delta) > BlockStress(wall, 1.0 + 0.5 * (elongation - delta)) ? &high : &low) = delta;
  }
  return low;
}

static void Place(void *ctx, PetscInt i, PetscInt j, PetscReal X[2])
{
  X[0] = i / (2.0 * SIDE);
  X[1] = j / (2.0 * SIDE) + *(const double *)ctx;
}

/* Two blocks of height 1, one on the other, on rollers; pulled by a traction at the top. */
static void CreateSeries(LamSoftening softening, Blocks *b, Torn *torn)
{
  const PetscInt row = 2 * SIDE + 1;
  PetscInt first[2];
  TornRule rule;

  CHECK(BlocksCreate(2 * row * row, 2 * SIDE * SIDE, 1, 1, b));
  for (int k = 0; k < 2; k++) {
    double bottom = k;

    CHECK(BlocksAddGrid(b, SIDE, SIDE, Place, &bottom, &first[k]));
  }
  for (PetscInt a = 0; a < b->node_count; a++) {
    b->held[a][0] = (PetscBool)(b->X[a][0] == 0.0);
    b->held[a][1] = (PetscBool)(b->X[a][1] == 0.0);
  }
  TornGauss(LAM_EDGE_POINTS, &rule);
  CHECK(TornCreate(b, SIDE, &rule, torn));
  torn->law = (LamCohesive){softening, STIFFNESS, STRENGTH, 1.0, {ENERGY, ENERGY}, 1.0};
  torn->contact = PUSHED;
  for (PetscInt e = 0; e < SIDE; e++) {
    torn->length[e] = 1.0 / SIDE;
    for (PetscInt k = 0; k < 3; k++) {
      torn->edge[e][k] = first[1] + 2 * e + k;
      torn->edge[e][3 + k] = first[1] - row + 2 * e + k;
      torn->load[b->node_count - row + 2 * e + k][1] += (k == 1 ? 4.0 : 1.0) / (6.0 * SIDE);
    }
  }
}

/* Errors of forces, over the strength, and of the dissipated energy and the ledger, over the energy. */
typedef struct {
  double force, spent, ledger;
} SeriesErrors;
static SeriesErrors series[LAM_SOFTENING_COUNT];

static void PullSeries(LamSoftening softening, SeriesErrors *errors)
{
  double kappa = 0.0, spent = 0.0, work = 0.0;
  TornStep step = {0};
  Blocks b;
  Torn torn;

  CreateSeries(softening, &b, &torn);
  for (size_t turn = 0; turn < sizeof(turns) / sizeof(turns[0]); turn++) {
    const double from = step.target;
    const int steps = (int)ceil(fabs(turns[turn] - from) / INCREMENT - 1e-9);

    for (int k = 1; k <= steps; k++) {
      const double elongation = from + (turns[turn] - from) * k / steps;
      const double delta = SeriesOpening(&b.wall, softening, kappa, elongation);

      CHECK(TornPull(&torn, elongation, &step));
      errors->force = fmax(errors->force, fabs(step.lambda - Traction(softening, kappa, delta)) / STRENGTH);
      kappa = fmax(kappa, delta);
      spent += step.spent;
      work += step.work;
      errors->ledger = fmax(errors->ledger, fabs(work - spent - step.walls - step.stored) / ENERGY);
    }
    errors->spent = fmax(errors->spent, fabs(spent - Spent(softening, kappa)) / ENERGY);
  }
  CHECK(TornDestroy(&torn));
  CHECK(BlocksDestroy(&b));
}

/* ---- peeling ---- */

static PeelResult opening[2], sliding, cantilever; /* opening: elements of 1/2 and 1/3 of the process zone */

static int Solve(void **state)
{
  PeelSetup setup = PeelDefault(PEEL_OPENING);

  for (int k = 0; k < LAM_SOFTENING_COUNT; k++) PullSeries((LamSoftening)k, &series[k]);
  for (int k = 0; k < 2; k++) {
    setup.element = 1.0 / (2 + k);
    if (Peel(&setup, &opening[k])) return 1;
  }
  setup = PeelDefault(PEEL_SLIDING);
  if (Peel(&setup, &sliding)) return 1;
  setup = PeelDefault(PEEL_CANTILEVER);
  return Peel(&setup, &cantilever) ? 1 : 0;
}

TEST(BlocksInSeriesFollowTheClosedForm)
{
  for (int k = 0; k < LAM_SOFTENING_COUNT; k++) assert_near(series[k].force, 0.0, 1e-10);
}

TEST(BlocksInSeriesDissipateWhatTheLawSays)
{
  for (int k = 0; k < LAM_SOFTENING_COUNT; k++) assert_near(series[k].spent, 0.0, 1e-10);
}

/* The work is that of the trapezoidal rule: an error of the second order in the step. */
TEST(LedgerOfTheBlocksCloses)
{
  for (int k = 0; k < LAM_SOFTENING_COUNT; k++) assert_near(series[k].ledger, 0.0, 1e-3);
}

TEST_IS(OpeningNeedsTheEnergyOfTheLaw, assert_near(opening[1].applied, 1.0, 0.01));
TEST_IS(OpeningSpendsTheEnergyPerLength, assert_near(opening[1].by_length, 1.0, 0.01));
TEST_IS(SlidingNeedsTheEnergyOfTheLaw, assert_near(sliding.applied, 1.0, 0.01));
TEST_IS(SlidingSpendsTheEnergyPerLength, assert_near(sliding.by_length, 1.0, 0.01));
TEST_IS(CantileverNeedsTheEnergyOfTheLaw, assert_near(cantilever.applied, 1.0, 0.01));
TEST_IS(CantileverSpendsTheEnergyPerLength, assert_near(cantilever.by_length, 1.0, 0.01));

TEST(RippleIsSmallWhereTheZoneIsResolved)
{
  assert_near(opening[1].ripple, 0.0, 0.02);
  assert_near(sliding.ripple, 0.0, 0.02);
  assert_near(cantilever.ripple, 0.0, 0.02);
}

/* Of order three or better. */
TEST(EnergyConvergesWithTheMesh)
{
  assert_true(fabs(opening[1].applied - 1.0) < fabs(opening[0].applied - 1.0) / pow(1.5, 3.0));
  assert_true(opening[1].ripple < opening[0].ripple);
}

TEST_IS(SlidingFacesAreNotPressedIntoEachOther, assert_near(sliding.pressed, 0.0, 1e-3));

TEST_GROUP(.petsc = 1, .setup = Solve);
