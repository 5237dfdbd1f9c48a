/* A patch with a notch that is torn under control of what its lamella dissipates: its curve has snap-back, which load
   control cannot follow. */
#include "support/rve_fixture.h"
#include "support/lamella_tissue.h"

#define STATES 60
#define TURGOR 0.09
#define END 1.2   /* F22 */
#define SHARE 0.05 /* of the way there, in a step at most */
#define FACES 0.25 /* in a step, about */

/* Four rows of four cells under a little turgor, cut to the middle. */
static LamMicrostructure NotchedPatch(void)
{
  LamMicrostructure micro = LamellaTissue(8.0);

  micro.is_patch = PETSC_TRUE;
  micro.cells[0] = micro.cells[1] = 4;
  micro.sides = LAM_SIDES_FREE;
  micro.notch_row = micro.notch_columns = 2;
  micro.lamella.strength = micro.lamella.shear_strength = 0.18;
  micro.lamella.energy = micro.lamella.shear_energy = 0.024;
  micro.lamella.stiffness = 2000.0;
  micro.sharpness = LAM_SHARPNESS_SMOOTH;
  return micro;
}

typedef struct {
  Specimen specimen;
  LamResponse states[STATES];
  int count;
} Torn;

/* All states of the ramp; one solve for all tests. */
static const Torn *Tear(void)
{
  static Torn torn;
  const LamMicrostructure micro = NotchedPatch();
  LamDissipationPath path = {
      .from = PlaneLoad(1, 0, 0, 1, TURGOR), .to = PlaneLoad(1, 0, 0, END, TURGOR), .most = SHARE, .faces = FACES};
  LamDissipationPoint point = {0};
  Specimen *s = &torn.specimen;

  if (torn.count) return &torn;
  CHECK(SpecimenCreate(&micro, s));
  CHECK(LamRVESolve(s->rve, &path.from, s->state, &torn.states[0]));
  assert_int_equal(torn.states[0].status, LAM_CONVERGED);
  for (torn.count = 1; torn.count < STATES && point.share < 1; torn.count++) {
    LamResponse *r = &torn.states[torn.count];

    CHECK(LamRVESolveDissipating(s->rve, &path, &point, s->state, r));
    if (r->status != LAM_CONVERGED) fail_msg("state %d: %s", torn.count, r->reason);
  }
  CHECK(SpecimenDestroy(s));
  return &torn;
}

static double F22(const LamResponse *r)
{
  return r->load.F[4];
}

TEST(ThePatchIsTornApart)
{
  const Torn *torn = Tear();
  double highest = 0.0;

  for (int k = 0; k < torn->count; k++) highest = fmax(highest, torn->states[k].P[4]);
  assert_true(torn->states[torn->count - 1].P[4] < 0.25 * highest);
}

TEST(FGoesBackBehindTheLimit)
{
  const Torn *torn = Tear();
  int back = 0;

  for (int k = 1; k < torn->count; k++) back += F22(&torn->states[k]) < F22(&torn->states[k - 1]) - 1e-4;
  assert_true(back >= 2);
}

TEST(WhereFGoesBackTheLamellaBreaks)
{
  const Torn *torn = Tear();

  for (int k = 1; k < torn->count; k++)
    if (F22(&torn->states[k]) < F22(&torn->states[k - 1]))
      assert_true(torn->states[k].dissipated > torn->states[k - 1].dissipated);
}

/* There is no jump: the trapezoidal rule misses what the curvature of the branch is. */
TEST(WorkIsWhatIsStoredAndDissipated)
{
  const Torn *torn = Tear();
  const LamResponse *first = &torn->states[0], *last = &torn->states[torn->count - 1];
  const double spent = last->dissipated - first->dissipated;

  assert_near(last->work - first->work - (last->stored - first->stored), spent, 0.03 * spent);
}

/* Two faces of a row's zigzag for each column: an apothem each along X1. */
TEST(TheCrackGrowsByFaces)
{
  const Torn *torn = Tear();
  const LamResponse *first = &torn->states[0], *last = &torn->states[torn->count - 1];

  assert_int_equal(first->crack_faces, 0);
  assert_near(first->crack_length, 0.0, 0.0);
  assert_true(last->crack_faces >= 3);
  assert_near(last->crack_length, last->crack_faces, 1e-12);
}

/* Until the peak the states are those that the prescribed F finds, too. */
TEST(LoadControlFindsTheSameStatesBeforeTheLimit)
{
  const Torn *torn = Tear();
  const LamMicrostructure micro = NotchedPatch();
  Specimen s;
  int peak = 0;

  while (peak + 1 < torn->count && torn->states[peak + 1].P[4] > torn->states[peak].P[4]) ++peak;
  assert_true(peak >= 3);
  CHECK(SpecimenCreate(&micro, &s));
  for (int k = 0; k <= peak; k++) {
    LamResponse r;

    CHECK(LamRVESolve(s.rve, &torn->states[k].load, s.state, &r));
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_near(r.P[4], torn->states[k].P[4], 1e-3 * fabs(r.P[4]));
  }
  CHECK(SpecimenDestroy(&s));
}

TEST_GROUP(.petsc = 1);
