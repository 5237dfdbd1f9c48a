/* Everything a response holds is a derivative of its energy: finite differences of bonded tissue at random states
   (F33 != 1 among them), of contact inside one contact set, of patches, of cells that differ, and of the smooth law. */
#include "support/rve_fixture.h"
#include "support/uneven_cells.h"

#define SMOOTH_STATES 6
#define SMOOTH_STEP 2e-6 /* far below the width: the tangent has kinks where points come into reach */

enum { BONDED, CONTACT, PATCH, UNEVEN, SMOOTH, KINDS };
static const int counts[KINDS] = {RANDOM_STATES, CONTACT_STATES, PATCH_STATES, UNEVEN_STATES, SMOOTH_STATES};
/* Of tangent, couplings and volumes; of the differences' symmetry. */
static const double second[KINDS] = {1e-7, 1e-7, 1e-6, 1e-6, 1e-8}, symmetry[KINDS] = {1e-6, 1e-8, 1e-6, 1e-6, 1e-8};

typedef struct {
  int kind;
  ContactSweep sweep;
  ContactDerivativeError error;
} State;

enum { STATES = RANDOM_STATES + CONTACT_STATES + PATCH_STATES + UNEVEN_STATES + SMOOTH_STATES };
static State states[STATES];
#define FOR_STATES(s) for (const State *s = states; s < states + STATES; s++)

static void ListBonded(ContactState list[RANDOM_STATES])
{
  LamWall *stiffening = &list[0].micro.wall;

  for (int s = 0; s < RANDOM_STATES; s++) list[s] = RandomState(s);
  stiffening->law = LAM_WALL_FIBRE_EXPONENTIAL;
  stiffening->k1 = 0.5 * stiffening->C4;
  stiffening->k2 = 3.0;
  stiffening->dispersion = 0.1;
  stiffening->C4 = 0.0;
  list[RANDOM_STATES - 1].micro.wall.law = LAM_WALL_MOONEY_RIVLIN;
  list[RANDOM_STATES - 2].micro.cells[0] = 2;
}

/* Open faces, F33 != 1, a clearance, walls that do not face each other, cells that differ, a patch with free sides. */
static void ListSmooth(ContactState list[KINDS][CONTACT_STATES])
{
  ContactState *smooth = list[SMOOTH];

  smooth[0] = list[CONTACT][2];
  smooth[1] = list[CONTACT][3];
  smooth[2] = list[CONTACT][5];
  smooth[3] = list[CONTACT][0];
  smooth[3].load = ContactLoad(1, 1.2, 0, 1, 0.02, 0.002);
  smooth[4] = list[UNEVEN][1];
  smooth[5] = list[PATCH][4];
  for (int k = 0; k < SMOOTH_STATES; k++) {
    smooth[k].micro.sharpness = LAM_SHARPNESS_SMOOTH;
    smooth[k].step = SMOOTH_STEP;
  }
}

static int SweepAll(void **state)
{
  static LamCell cells[UNEVEN_CELLS];
  ContactState list[KINDS][CONTACT_STATES];
  State *s = states;

  ListBonded(list[BONDED]);
  ListContactStates(list[CONTACT]);
  ListPatchStates(list[PATCH]);
  ListUnevenStates(cells, list[UNEVEN]);
  ListSmooth(list);
  for (int kind = 0; kind < KINDS; kind++)
    for (int k = 0; k < counts[kind]; k++, s++) {
      s->kind = kind;
      if (SweepContact(&list[kind][k], &s->sweep)) return 1;
      s->error = DerivativeError(&s->sweep);
    }
  return 0;
}

TEST(StatesAreOfTheLawTheyTest)
{
  FOR_STATES(s)
  {
    if (s->kind != BONDED) assert_true((s->sweep.response.contact_width > 0.0) == (s->kind == SMOOTH));
  }
}

TEST(WallsThatDoNotFaceEachOtherBearForces)
{
  double largest = 0.0;

  FOR_STATES(s) if (s->kind == SMOOTH) largest = fmax(largest, s->sweep.response.third_fraction);
  assert_true(largest > 0.5);
}

TEST(StatesConvergeInsideOneContactSet)
{
  FOR_STATES(s)
  {
    assert_int_equal(s->sweep.response.status, LAM_CONVERGED);
    assert_int_equal(s->sweep.switches, 0);
  }
}

TEST(StressIsDerivativeOfEnergy)
{
  FOR_STATES(s) assert_near(s->error.stress, 0.0, 1e-8);
}

TEST(DerivativesInTurgorAndCohesionAreThoseOfTheEnergy)
{
  FOR_STATES(s)
  {
    assert_near(s->error.turgor, 0.0, 1e-8);
    assert_near(s->error.cohesion, 0.0, 1e-8);
  }
}

/* Where cells differ dPsi/dp weighs lumens with the turgor factors of their cells, dPsi/dg gaps: neither is a volume.
   The strength of the smooth law depends on both. */
TEST(LumenAndOpeningAreThemWhereCellsAreAlike)
{
  FOR_STATES(s)
  {
    if (s->kind == SMOOTH) continue;
    if (s->kind != UNEVEN) {
      assert_near(s->error.lumen, 0.0, 1e-8);
      assert_near(s->error.opening, 0.0, 1e-8);
    } else {
      assert_true(s->error.lumen > 1e-3);
      if (s->sweep.response.opening_fraction > 0.0) assert_true(s->error.opening > 1e-5);
    }
  }
}

TEST(TangentIsDerivativeOfStress)
{
  FOR_STATES(s) assert_near(s->error.tangent, 0.0, second[s->kind]);
}

TEST(DifferencesOfTheStressHaveMajorSymmetry)
{
  FOR_STATES(s) assert_near(s->error.symmetry, 0.0, symmetry[s->kind]);
}

TEST(TangentHasMajorSymmetry)
{
  FOR_STATES(s)
  for (int i = 0; i < 5; i++)
    for (int k = 0; k < 5; k++) {
      const int a = contact_components[i], b = contact_components[k];

      assert_near(s->sweep.response.tangent[9 * a + b], s->sweep.response.tangent[9 * b + a], 1e-10);
    }
}

/* And of the volumes. */
TEST(CouplingsAreDerivativesOfStress)
{
  FOR_STATES(s)
  {
    assert_near(s->error.turgor_coupling, 0.0, second[s->kind]);
    assert_near(s->error.cohesion_coupling, 0.0, second[s->kind]);
  }
}

TEST(SecondDerivativesInTurgorAndCohesionAreThoseOfVolumes)
{
  FOR_STATES(s) assert_near(s->error.volumes, 0.0, second[s->kind]);
}

/* The moments of the forces on the held walls, x = F X, balance: P F^T is symmetric. So do those of points that touch.
 */
TEST(MomentsOfTheBoundaryForcesBalance)
{
  FOR_STATES(s)
  {
    const double *P = s->sweep.response.P, *F = s->sweep.response.load.F;

    if (s->kind == PATCH || s->kind == SMOOTH) assert_near(P[0] * F[3] + P[1] * F[4], P[3] * F[0] + P[4] * F[1], 1e-9);
  }
}

/* What plane strain cannot know is not a number, never zero. */
TEST(OutOfPlaneShearTangentIsUnknown)
{
  static const int unknown[4] = {2, 5, 6, 7};
  const double *tangent = states[0].sweep.response.tangent;

  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 9; k++) assert_true(isnan(tangent[9 * unknown[i] + k]) && isnan(tangent[9 * k + unknown[i]]));
}

/* At F = I under turgor walls and fluid carry the same pressure: P = -p 1 up to the walls' compressibility p/kappa. */
TEST(PressureFillsTheTissueAsBulkModulusGrows)
{
  const double p = 0.02 / TISSUE_STRESS;
  double previous = 1.0;

  for (double kappa = 1e3; kappa < 2e6; kappa *= 10.0) {
    LamMicrostructure micro = DefaultTissue();
    LamResponse response;
    double error = 0.0;

    micro.wall.bulk_modulus = kappa;
    response = SolveTissue(&micro, PlaneLoad(1, 0, 0, 1, p));
    for (int i = 0; i < 9; i += 4) error = fmax(error, fabs(response.P[i] + p));
    assert_true(error < p * 100.0 * p / kappa);
    assert_true(error < 0.2 * previous);
    previous = error;
  }
}

TEST_GROUP(.petsc = 1, .setup = SweepAll);
