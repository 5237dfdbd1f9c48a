/* The smooth contact potential of all walls: strengths, forces and matrix against finite differences at positions where
   facing walls, walls that do not face each other and walls of a lumen touch. */
#include "support/rve_fixture.h"
#include "support/uneven_cells.h"

#define WIDTH 3e-3
#define STEP                                                                                                           \
  1e-7 /* of the differences: so small that hardly a point crosses the kinks of the tangent, at gap 0 and at the width \
        */

/* ---- strengths ---- */

#define STRENGTH_STEP 1e-4 /* over the least strength it is 5e-3: fourth-order errors of 1e-9 */

static LamTouchStrength StrengthAt(LamRVE rve, double turgor, double cohesion)
{
  const LamLoad load = {.turgor = turgor, .cohesion = cohesion};

  return LamTouchStrengthOf(rve, &load, 0, 1);
}

/* Of s and its two derivatives, in turgor or cohesion. */
static LamTouchStrength StrengthDifference(LamRVE rve, double turgor, double cohesion, int in_cohesion)
{
  static const double weight[2] = {8.0 / 12.0, -1.0 / 12.0};
  LamTouchStrength sum = {0};

  for (int k = 1; k <= 2; k++)
    for (int side = -1; side <= 1; side += 2) {
      const double moved = side * k * STRENGTH_STEP, w = side * weight[k - 1] / STRENGTH_STEP;
      const LamTouchStrength s =
          StrengthAt(rve, turgor + (in_cohesion ? 0.0 : moved), cohesion + (in_cohesion ? moved : 0.0));

      sum.s += w * s.s;
      sum.p += w * s.p;
      sum.g += w * s.g;
    }
  return sum;
}

/* Cells that differ in turgor and cohesion; suction weaker than the least strength, and turgor stronger. */
TEST(DerivativesOfTheStrength)
{
  static const double loads[3][2] = {{0.005, 0.01}, {0.2, 0.01}, {-0.03, 0.02}};
  static LamCell cells[UNEVEN_CELLS];
  const LamMicrostructure micro = UnevenTissue(PETSC_FALSE, LAM_INTERFACE_CONTACT, cells);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);

  for (int k = 0; k < 3; k++) {
    const LamTouchStrength s = StrengthAt(rve, loads[k][0], loads[k][1]);
    const LamTouchStrength by_p = StrengthDifference(rve, loads[k][0], loads[k][1], 0);
    const LamTouchStrength by_g = StrengthDifference(rve, loads[k][0], loads[k][1], 1);

    assert_near(s.p, by_p.s, 1e-9);
    assert_near(s.g, by_g.s, 1e-9);
    assert_near(s.pp, by_p.p, 1e-6);
    assert_near(s.pg, by_g.p, 1e-6);
    assert_near(s.gg, by_g.g, 1e-6);
  }
}

TEST(StrengthIsThePressureOfMeanTurgorAndSmallerCohesion)
{
  static LamCell cells[UNEVEN_CELLS]; /* turgor 1 and 1.4, cohesion 1 and 0.5 */
  const LamMicrostructure micro = UnevenTissue(PETSC_FALSE, LAM_INTERFACE_CONTACT, cells);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);

  assert_near(StrengthAt(rve, 0.3, 0.1).s, hypot(1.2 * 0.3 + 0.5 * 0.1, LAM_LEAST_STRENGTH), 1e-15);
  assert_near(StrengthAt(rve, 0.0, 0.0).s, LAM_LEAST_STRENGTH, 1e-15);
}

/* ---- forces and matrix ---- */

enum { FACING, THIRD, LUMEN, PATCH, STATES };

/* A tissue at positions where walls touch. */
typedef struct {
  LamRVE rve;
  LamLoad load;
  PetscReal energy, *y, *residual; /* [ndof] */
  LamTouchForces forces;
} Positions;
static Positions all[STATES];
#define FOR_STATES(at) for (Positions *at = all; at < all + STATES; at++)

static LamMicrostructure TissueOf(int state)
{
  LamMicrostructure micro = state == PATCH ? PatchTissue(2, 2, 30, LAM_INTERFACE_CONTACT) : ContactTissue(4, 1);

  micro.along = state == LUMEN ? 3 : 4; /* of three, spans that touch at the ends of a slit share a node */
  micro.through = 1;
  return micro;
}

/* Narrows the lumen of the cell to a slit. */
static void CloseLumen(Positions *at)
{
  const LamWalls *walls = &at->rve->smooth->walls;

  for (int i = 0; i < LamWallsNodes(walls, 0); i++)
    at->y[2 * at->rve->mesh.node_class[walls->node[LamWallsNodes(walls, 0) + i]]] *= 0.3 * WIDTH;
}

/* Cells hardly change their shape; their period is sheared. */
static int Place(Positions *at, int state)
{
  const LamMicrostructure micro = TissueOf(state);
  uint64_t seed = 3;
  int n;

  at->rve = NewRVE(&micro);
  n = at->rve->ndof;
  at->load = ContactLoad(0.999, state == THIRD ? 0.9 : 0.002, -0.001, 0.999, 0.02, 0.002);
  at->load.F[8] = 1.1;
  if (PetscCalloc2(n, &at->y, n, &at->residual)) return 1;
  for (int i = 0; i < n; i++) at->y[i] = at->rve->mesh.class_X[i] + RandomReal(&seed, -0.3 * WIDTH, 0.3 * WIDTH);
  if (state == LUMEN) CloseLumen(at);
  if (LamUseSmoothLaw(at->rve, WIDTH) || PetscArraycpy(at->rve->y, at->y, n)) return 1;
  if (LamSmoothPressures(at->rve, &at->load, &at->forces)) return 1;
  return LamSmoothAssemble(at->rve, &at->load, at->y, &at->energy, at->residual);
}

static int PlaceAll(void **state)
{
  for (int k = 0; k < STATES; k++)
    if (Place(&all[k], k)) return 1;
  return 0;
}

static int LeaveAll(void **state)
{
  FOR_STATES(at) if (PetscFree2(at->y, at->residual) || LamRVEDestroy(&at->rve)) return 1;
  return 0;
}

TEST(PositionsTouchWhatTheyAreMeantTo)
{
  FOR_STATES(at)
  {
    assert_true(at->forces.facing > 0.0);
    assert_true((at->forces.third > 0.0) == (at == &all[THIRD]));
    assert_true((at->forces.lumen > 0.0) == (at == &all[LUMEN]));
  }
}

TEST(EnergyAloneIsTheSame)
{
  FOR_STATES(at) assert_near(LamSmoothEnergy(at->rve, &at->load, at->y) / at->energy, 1.0, 1e-14);
}

/* A displacement of all nodes but those that are prescribed. */
static void RandomDirection(const Positions *at, uint64_t *seed, double v[])
{
  v[0] = v[1] = 0.0;
  for (int i = 2; i < at->rve->ndof; i++) v[i] = RandomReal(seed, -1.0, 1.0);
}

/* Differences along v of the energy, and of the residual [ndof]. */
static double Difference(const Positions *at, const double v[], double residual[])
{
  static const double weight[2] = {8.0 / 12.0, -1.0 / 12.0};
  const int n = at->rve->ndof;
  double sum = 0.0, *y, *r;

  CHECK(PetscMalloc2(n, &y, n, &r));
  memset(residual, 0, (size_t)n * sizeof(*residual));
  for (int k = 1; k <= 2; k++)
    for (int side = -1; side <= 1; side += 2) {
      const double w = side * weight[k - 1] / STEP;
      double energy = 0.0;

      for (int i = 0; i < n; i++) y[i] = at->y[i] + side * k * STEP * v[i];
      CHECK(LamSmoothAssemble(at->rve, &at->load, y, &energy, r));
      sum += w * energy;
      for (int i = 0; i < n; i++) residual[i] += w * r[i];
    }
  CHECK(PetscFree2(y, r));
  return sum;
}

/* Errors of the derivatives along a random direction, over their size. */
static void DirectionErrors(const Positions *at, uint64_t *seed, double *force, double *matrix)
{
  const int n = at->rve->ndof;
  double *v, *difference, *Kv, *r, energy = 0.0, slope = 0.0, largest = 0.0;

  CHECK(PetscMalloc4(n, &v, n, &difference, n, &Kv, n, &r));
  RandomDirection(at, seed, v);
  *force = Difference(at, v, difference);
  for (int i = 2; i < n; i++) slope += at->residual[i] * v[i];
  *force = fabs(*force - slope) / fabs(slope);
  CHECK(LamSmoothAssemble(at->rve, &at->load, at->y, &energy, r)); /* the differences have left another matrix */
  LamLinearMultiply(at->rve->linear, v + 2, Kv);
  *matrix = 0.0;
  for (int i = 2; i < n; i++) {
    *matrix = fmax(*matrix, fabs(Kv[i - 2] - difference[i]));
    largest = fmax(largest, fabs(difference[i]));
  }
  *matrix /= largest;
  CHECK(PetscFree4(v, difference, Kv, r));
}

TEST(ForcesAreDerivativesOfTheEnergy)
{
  uint64_t seed = 21;

  FOR_STATES(at)
  for (int k = 0; k < 5; k++) {
    double force, matrix;

    DirectionErrors(at, &seed, &force, &matrix);
    assert_near(force, 0.0, 1e-7);
  }
}

TEST(MatrixIsDerivativeOfTheForces)
{
  uint64_t seed = 22;

  FOR_STATES(at)
  for (int k = 0; k < 5; k++) {
    double force, matrix;

    DirectionErrors(at, &seed, &force, &matrix);
    assert_near(matrix, 0.0, 1e-7);
  }
}

TEST(ForcesWithinAPeriodSumToZero)
{
  for (const Positions *at = all + FACING; at <= all + LUMEN; at++)
    for (int d = 0; d < 2; d++) {
      double sum = 0.0, largest = 0.0;

      for (int i = d; i < at->rve->ndof; i += 2) {
        sum += at->residual[i];
        largest = fmax(largest, fabs(at->residual[i]));
      }
      assert_near(sum / largest, 0.0, 1e-12);
    }
}

/* ---- the matrix grows ---- */

TEST(WallsThatFaceEachOtherNeedNoOtherMatrix)
{
  assert_ptr_equal(all[FACING].rve->linear, &all[FACING].rve->systems[LAM_SYSTEM_BASE]);
}

TEST(OtherWallsThatMeetMakeTheMatrixGrow)
{
  for (const Positions *at = all + THIRD; at <= all + LUMEN; at++)
    assert_ptr_equal(at->rve->linear, &at->rve->systems[LAM_SYSTEM_GROWN]);
}

TEST(ResetForgetsTheWallsMet)
{
  Positions at = {0};

  assert_int_equal(Place(&at, THIRD), 0);
  CHECK(LamSmoothReset(at.rve));
  assert_ptr_equal(at.rve->linear, &at.rve->systems[LAM_SYSTEM_BASE]);
  assert_int_equal(at.rve->smooth->count, at.rve->smooth->base_count);
  CHECK(PetscFree2(at.y, at.residual));
  CHECK(LamRVEDestroy(&at.rve));
}

TEST_GROUP(.petsc = 1, .setup = PlaceAll, .teardown = LeaveAll);
