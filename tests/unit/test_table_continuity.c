/* What does not jump in the table's answers, whatever nodes there are, and the work of closed cycles. */
#include "support/test.h"
#include <stdlib.h>
#include "support/strain_cycle.h"

static const int in_plane[4] = {0, 1, 3, 4};

enum { NODE_SETS = 4, POINTS = 150 };

static AnalyticTable Rough(PetscBool contact, double failing, uint64_t seed)
{
  AnalyticTable t = AnalyticTableOpen(contact, 0.2);

  AddRough(&t, 2, failing, &seed);
  return t;
}

/* A place on a face: one coordinate a multiple of the finest nodes' distance, or two alike, or a knot of suction. */
enum { ON_FACE, ON_SYMMETRY, ON_KNOT, PLACES };

static void RandomPlace(const AnalyticTable *t, int kind, uint64_t *seed, double u[3], double *v)
{
  const double low = t->grid->contact ? -2 * LAM_ROOT : 0;
  const int k = (int)RandomReal(seed, 0, 3);

  for (int l = 0; l < 3; l++) u[l] = RandomReal(seed, low + 1, low + 2 * LAM_ROOT + (t->grid->contact ? 20 : -1));
  *v = RandomReal(seed, 0, LAM_ROOT * (double)t->grid->tau_cells);
  if (kind == ON_FACE) u[k] = low + 16 * (1 + floor(RandomReal(seed, 0, t->grid->contact ? 8 : 7)));
  if (kind == ON_SYMMETRY) u[k] = u[(k + 1) % 3];
  if (kind == ON_KNOT) *v = 16 * (1 + floor(RandomReal(seed, 0, 4 * (double)t->grid->tau_cells - 1)));
}

/* The answers a tiny step to either side of the place; PETSC_FALSE where there are none. */
static PetscBool Sides(const AnalyticTable *t, int kind, const double u[3], double v, LamResponse side[2])
{
  static const double away[3] = {1, 0.31, -0.47}; /* across every face */

  for (int s = 0; s < 2; s++) {
    const double step = 1e-8 * (s ? 1 : -1),
                 at[3] = {u[0] + step * away[0], u[1] + step * away[1], u[2] + step * away[2]};
    LamLoad load = LoadAt(t, at, kind == ON_KNOT ? v + step : v, 0.1);

    load.turgor += 0.02;
    if (t->grid->contact) load.cohesion -= 0.02;
    side[s] = Ask(t, &load);
    if (side[s].status != LAM_CONVERGED) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void AssertNoJump(PetscBool contact, int kind)
{
  for (uint64_t set = 1; set <= NODE_SETS; set++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough(contact, set % 2 ? 0 : 0.1, set);
    uint64_t seed = 100 + set;
    int compared = 0;

    for (int n = 0; n < POINTS; n++) {
      LamResponse side[2];
      double u[3], v;

      RandomPlace(&t, kind, &seed, u, &v);
      if (!Sides(&t, kind, u, v, side)) continue;
      compared++;
      assert_near(side[1].energy, side[0].energy, 1e-9);
      assert_near(side[1].energy_turgor, side[0].energy_turgor, 1e-8);
      assert_near(side[1].energy_cohesion, side[0].energy_cohesion, 1e-8);
      for (int i = 0; i < 4; i++) assert_near(side[1].P[in_plane[i]], side[0].P[in_plane[i]], 1e-8);
    }
    assert_true(compared > POINTS / 10);
  }
}

TEST_IS(bonded_stress_does_not_jump_at_faces, AssertNoJump(PETSC_FALSE, ON_FACE));
TEST_IS(bonded_stress_does_not_jump_at_planes_of_symmetry, AssertNoJump(PETSC_FALSE, ON_SYMMETRY));

/* Among them those where cells lose touch. */
TEST_IS(contact_stress_does_not_jump_at_faces, AssertNoJump(PETSC_TRUE, ON_FACE));
TEST_IS(contact_stress_does_not_jump_at_planes_of_symmetry, AssertNoJump(PETSC_TRUE, ON_SYMMETRY));

/* Many of which belong to some of the columns only. */
TEST_IS(contact_stress_does_not_jump_at_knots_of_suction, AssertNoJump(PETSC_TRUE, ON_KNOT));

TABLE_TEST(stress_does_not_jump_where_cells_lose_touch, Rough(PETSC_TRUE, 0, 5))
{
  uint64_t seed = 5;

  for (int n = 0; n < POINTS; n++) {
    double u[3] = {0, RandomReal(&seed, 0, 40), RandomReal(&seed, 0, 40)};
    const double v = RandomReal(&seed, 0, LAM_ROOT * (double)t->grid->tau_cells);
    LamResponse side[2];

    assert_true(Sides(t, ON_FACE, u, v, side));
    assert_near(side[1].energy, side[0].energy, 1e-10);
    assert_near(side[1].energy_turgor, side[0].energy_turgor, 1e-9);
    for (int i = 0; i < 4; i++) assert_near(side[1].P[in_plane[i]], side[0].P[in_plane[i]], 1e-9);
  }
}

static double TangentJump(const LamResponse side[2])
{
  double jump = 0, size = 0;

  for (int a = 0; a < 16; a++) {
    const int at = 9 * in_plane[a / 4] + in_plane[a % 4];

    jump = fmax(jump, fabs(side[1].tangent[at] - side[0].tangent[at]));
    size = fmax(size, fabs(side[0].tangent[at]));
  }
  return jump / size;
}

/* Nodes everywhere: what is left is the error of the interpolation. */
TABLE_TEST(the_tangent_jumps_little, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const int first[3] = {0, 0, 0};
  uint64_t seed = 6;

  AddBlock(t, 1, first, 4, LAM_ROOT);
  for (int n = 0; n < POINTS; n++) {
    LamResponse side[2];
    double u[3], v;

    RandomPlace(t, ON_FACE, &seed, u, &v);
    assert_true(Sides(t, ON_FACE, u, v, side));
    assert_true(TangentJump(side) < 2e-3);
  }
}

/* ---- work ---- */

static void AssertNoWork(PetscBool contact)
{
  for (uint64_t set = 1; set <= NODE_SETS; set++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough(contact, 0, set);
    uint64_t seed = 200 + set;
    LamLoad corners[5];

    CycleCorners(&t, 5, &seed, corners);
    assert_near(CycleWork(&t, 5, corners), 0, 1e-8);
  }
}

TEST_IS(closed_cycles_of_bonded_tissue_cost_no_work, AssertNoWork(PETSC_FALSE));
TEST_IS(closed_cycles_of_tissue_in_contact_cost_no_work, AssertNoWork(PETSC_TRUE));
