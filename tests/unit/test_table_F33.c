/* Tables with the axis F33 on a known potential: exact at the nodes, derivatives of one potential between them. */
#include "support/test.h"
#include <stdlib.h>
#include <unistd.h>
#include "support/analytic_table.h"
#include "support/tissue.h"

static const int entries[5] = {0, 1, 3, 4, 8}; /* in the plane, and 33 */

static AnalyticTable Open(PetscBool contact)
{
  const AnalyticTissue tissue = {contact, 0.2, PETSC_TRUE};

  return AnalyticTableOpenScene(tissue, AnalyticScene(&tissue));
}

static AnalyticTable Rough(PetscBool contact, double failing)
{
  AnalyticTable t = Open(contact);

  AddRough(&t, 2, failing, &(uint64_t){1});
  return t;
}

static LamLoad RandomLoad(const AnalyticTable *t, uint64_t *seed)
{
  const double low = t->grid->contact ? -2 * LAM_ROOT : 0, high = t->grid->contact ? 0.4 * LAM_ROOT : 2 * LAM_ROOT;
  double u[3], v, w, angle;

  for (int k = 0; k < 3; k++) u[k] = RandomReal(seed, low, high);
  v = RandomReal(seed, 0, LAM_ROOT * (double)t->grid->tau_cells);
  w = RandomReal(seed, 0, (double)t->grid->z_cells);
  angle = RandomReal(seed, -3, 3);
  return LoadAtF33(t, u, v, w, angle);
}

/* ---- at nodes ---- */

static void AssertSame(const LamResponse *r, const LamResponse *exact)
{
  for (int i = 0; i < 5; i++) {
    const int a = entries[i];

    assert_near(r->P[a], exact->P[a], 1e-9);
    assert_near(r->P_turgor[a], exact->P_turgor[a], 1e-9);
    assert_near(r->P_cohesion[a], exact->P_cohesion[a], 1e-9);
    for (int j = 0; j < 4; j++) assert_near(r->tangent[9 * a + entries[j]], exact->tangent[9 * a + entries[j]], 1e-8);
    for (int j = 0; j < 4; j++) assert_near(r->tangent[9 * entries[j] + a], exact->tangent[9 * entries[j] + a], 1e-8);
  }
  assert_near(r->energy, exact->energy, 1e-10);
  assert_near(r->energy_turgor, exact->energy_turgor, 1e-9);
  assert_near(r->energy_cohesion, exact->energy_cohesion, 1e-9);
}

static void AssertNodes(PetscBool contact)
{
  OWNED(AnalyticTable, AnalyticTableClose) t = Rough(contact, 0);
  int answered = 0, asked = 0;
  const PetscInt64 *keys;
  PetscInt n;

  CHECK(LamDatabaseGetRecords(t.database, &n, NULL, &keys));
  for (PetscInt k = 0; k < n; k += contact ? 7 : 2) {
    const LamNodePlace place = LamNodePlaceOf(keys[k]);
    LamResponse r, exact;

    if (LamNodeIsFree(&place)) continue;
    exact = AnswerOf(&t, keys[k]);
    asked++;
    if (!Answers(&t, &exact.load, &r)) continue;
    answered++;
    AssertSame(&r, &exact);
  }
  assert_true(asked > 100 && answered > 0.5 * asked);
}

TEST_IS(bonded_nodes_answer_as_their_records, AssertNodes(PETSC_FALSE));
TEST_IS(contact_nodes_answer_as_their_records, AssertNodes(PETSC_TRUE));

/* A3333 is that of the record at the corners of the finest complete cell: off them it jumps, as d2Psi/dp2 does. */
TEST(at_corners_of_the_root_A3333_is_the_record_s)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Open((PetscBool)kind);
    const int first[3] = {-2 * LAM_ROOT, -2 * LAM_ROOT, -2 * LAM_ROOT};
    const PetscInt64 *keys;
    PetscInt n;

    AddBlock(&t, 0, first, 3, LAM_ROOT);
    CHECK(LamDatabaseGetRecords(t.database, &n, NULL, &keys));
    for (PetscInt k = 0; k < n; k++) {
      const LamNodePlace place = LamNodePlaceOf(keys[k]);
      LamResponse r, exact;

      if (place.i[0] <= first[0] || place.i[2] >= LAM_ROOT) continue; /* inside, whatever rounding does */
      exact = AnswerOf(&t, keys[k]);
      assert_true(Answers(&t, &exact.load, &r));
      assert_near(r.tangent[80], exact.tangent[80], 1e-9);
      assert_near(r.energy_turgor2, exact.energy_turgor2, 1e-9);
    }
  }
}

/* ---- between nodes ---- */

/* At nodes' strains and suctions the error is that of the interpolation along F33. */
TEST(between_knots_of_F33_the_answer_is_near)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Open((PetscBool)kind);
    const int corner = kind ? -2 * LAM_ROOT : 0, first[3] = {corner, corner, corner};
    uint64_t seed = 2;

    AddBlock(&t, 0, first, 3, LAM_ROOT);
    for (int n = 0; n < 60; n++) {
      const double u[3] = {corner + LAM_ROOT * (n % 2), corner + LAM_ROOT, corner + LAM_ROOT * (1 + n % 3 / 2)};
      const LamLoad load = LoadAtF33(&t, u, LAM_ROOT * (n % 4), RandomReal(&seed, 0, (double)t.grid->z_cells), 0.3);
      const LamResponse exact = TissueAnswer(&t.tissue, &load);
      LamResponse r;

      assert_true(Answers(&t, &load, &r));
      for (int i = 0; i < 5; i++) assert_near(r.P[entries[i]], exact.P[entries[i]], 2e-4);
      assert_near(r.tangent[80], exact.tangent[80], 5e-3);
    }
  }
}

/* Far from faces, across which the tangent jumps. */
static PetscBool IsInside(const AnalyticTable *t, const LamLoad *load)
{
  const PetscReal F[4] = {load->F[0], load->F[1], load->F[3], load->F[4]}, s = load->turgor + load->cohesion;
  const LamLatticeState at = LamLatticeStateOf(&t->grid->axes, F);
  const double w = (log(load->F[8]) - t->grid->z_min) / t->grid->z_step;
  PetscReal a[6] = {0}, v = 2, u[3];

  if (t->grid->contact) LamGridFreeStrain(t->grid, s, w, a);
  for (int k = 0; k < 3; k++) u[k] = (at.x[k] - a[0] - t->grid->origin) / t->grid->step * LAM_ROOT;
  if (t->grid->contact) v = LAM_ROOT * (LamGridTau(t->grid, s) - t->grid->tau_min) / t->grid->tau_step;
  for (int k = 0; k < 3; k++)
    if (fabs(remainder(u[k], 16)) < 0.05 || fabs(u[k] - u[(k + 1) % 3]) < 0.05) return PETSC_FALSE;
  return (PetscBool)(fabs(remainder(v, 4)) > 0.05 && fabs(remainder(w, 1)) > 1e-3);
}

typedef void (*Comparison)(const AnalyticTable *t, const LamLoad *load);

static void AtRandomStates(Comparison compare)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough((PetscBool)kind, 0.2);
    uint64_t seed = 5;
    int compared = 0;

    for (int n = 0; n < 300; n++) {
      const double step = RandomReal(&seed, -0.05, 0.05);
      LamLoad load = RandomLoad(&t, &seed);
      LamResponse r;

      load.turgor += step;
      if (kind) load.cohesion -= step;
      if (!IsInside(&t, &load) || !Answers(&t, &load, &r)) continue;
      compare(&t, &load);
      compared++;
    }
    assert_true(compared > 50);
  }
}

static void CompareStrains(const AnalyticTable *t, const LamLoad *load)
{
  const LamResponse r = Ask(t, load);

  for (int i = 0; i < 5; i++) {
    const int a = entries[i];
    LamResponse pair[2];

    AnswerPair(t, load, offsetof(LamLoad, F) + (size_t)a * sizeof(PetscReal), ANSWER_STEP, pair);
    assert_near(ANSWER_SLOPE(pair, energy), r.P[a], 1e-8);
    assert_near(ANSWER_SLOPE(pair, energy_turgor), r.P_turgor[a], 1e-6);
    assert_near(ANSWER_SLOPE(pair, energy_cohesion), r.P_cohesion[a], 1e-6);
    for (int j = 0; j < 5; j++) {
      const int b = entries[j];

      assert_near(ANSWER_SLOPE(pair, P[b]), r.tangent[9 * b + a], 1e-6);
      assert_near(r.tangent[9 * a + b], r.tangent[9 * b + a], 1e-11);
    }
  }
}

TEST_IS(stress_and_tangent_are_slopes_of_the_energy, AtRandomStates(CompareStrains));

static void ComparePressures(const AnalyticTable *t, const LamLoad *load)
{
  const LamResponse r = Ask(t, load);
  LamResponse pair[2];

  AnswerPair(t, load, offsetof(LamLoad, turgor), ANSWER_STEP, pair);
  assert_near(ANSWER_SLOPE(pair, energy), r.energy_turgor, 1e-8);
  assert_near(ANSWER_SLOPE(pair, energy_turgor), r.energy_turgor2, 1e-6);
  assert_near(ANSWER_SLOPE(pair, energy_cohesion), r.energy_turgor_cohesion, 1e-6);
  for (int i = 0; i < 5; i++) assert_near(ANSWER_SLOPE(pair, P[entries[i]]), r.P_turgor[entries[i]], 1e-6);
  if (!t->grid->contact) return;
  AnswerPair(t, load, offsetof(LamLoad, cohesion), ANSWER_STEP, pair);
  assert_near(ANSWER_SLOPE(pair, energy), r.energy_cohesion, 1e-8);
  assert_near(ANSWER_SLOPE(pair, energy_cohesion), r.energy_cohesion2, 1e-6);
  for (int i = 0; i < 5; i++) assert_near(ANSWER_SLOPE(pair, P[entries[i]]), r.P_cohesion[entries[i]], 1e-6);
}

TEST_IS(derivatives_in_turgor_and_cohesion_are_slopes, AtRandomStates(ComparePressures));

/* ---- continuity ---- */

enum { ON_FACE, ON_KNOT_OF_SUCTION, ON_KNOT_OF_F33, ON_CONTACT, PLACES };

static void AssertNoJump(PetscBool contact, int kind)
{
  static const double away[3] = {1, 0.31, -0.47}; /* across every face */
  OWNED(AnalyticTable, AnalyticTableClose) t = Rough(contact, 0);
  const double low = contact ? -2 * LAM_ROOT : 0;
  uint64_t seed = 9;
  int compared = 0;

  for (int n = 0; n < 150; n++) {
    double u[3], v = RandomReal(&seed, 0, LAM_ROOT * (double)t.grid->tau_cells);
    double w = RandomReal(&seed, 0.1, (double)t.grid->z_cells - 0.1);
    LamResponse side[2];

    for (int k = 0; k < 3; k++) u[k] = RandomReal(&seed, low + 1, low + 2 * LAM_ROOT - 1);
    if (kind == ON_FACE) u[n % 3] = low + 16 * (1 + floor(RandomReal(&seed, 0, 7)));
    if (kind == ON_KNOT_OF_SUCTION) v = 16 * (1 + floor(RandomReal(&seed, 0, 4 * (double)t.grid->tau_cells - 1)));
    if (kind == ON_KNOT_OF_F33) w = 1 + n % ((int)t.grid->z_cells - 1);
    for (int k = 0; k < 3 && kind == ON_CONTACT; k++) u[k] = k ? RandomReal(&seed, 0, 40) : 0;
    for (int s = 0; s < 2; s++) {
      const double step = 1e-8 * (s ? 1 : -1),
                   at[3] = {u[0] + step * away[0], u[1] + step * away[1], u[2] + step * away[2]};
      LamLoad load = LoadAtF33(&t, at, v + (kind == ON_KNOT_OF_SUCTION ? step : 0),
                               w + (kind == ON_KNOT_OF_F33 ? 1e-9 * (s ? 1 : -1) : 0), 0.1);

      load.turgor += 0.02;
      if (contact) load.cohesion -= 0.02;
      side[s] = Ask(&t, &load);
    }
    if (side[0].status != LAM_CONVERGED || side[1].status != LAM_CONVERGED) continue;
    compared++;
    assert_near(side[1].energy, side[0].energy, 1e-9);
    assert_near(side[1].energy_turgor, side[0].energy_turgor, 1e-8);
    assert_near(side[1].energy_cohesion, side[0].energy_cohesion, 1e-8);
    for (int i = 0; i < 5; i++) assert_near(side[1].P[entries[i]], side[0].P[entries[i]], 1e-8);
  }
  assert_true(compared > 15);
}

TEST_IS(bonded_stress_does_not_jump_at_faces, AssertNoJump(PETSC_FALSE, ON_FACE));
TEST_IS(bonded_stress_does_not_jump_at_knots_of_F33, AssertNoJump(PETSC_FALSE, ON_KNOT_OF_F33));
TEST_IS(contact_stress_does_not_jump_at_faces, AssertNoJump(PETSC_TRUE, ON_FACE));
TEST_IS(contact_stress_does_not_jump_at_knots_of_suction, AssertNoJump(PETSC_TRUE, ON_KNOT_OF_SUCTION));
TEST_IS(contact_stress_does_not_jump_at_knots_of_F33, AssertNoJump(PETSC_TRUE, ON_KNOT_OF_F33));
TEST_IS(stress_does_not_jump_where_cells_lose_touch, AssertNoJump(PETSC_TRUE, ON_CONTACT));

/* ---- range ---- */

static void AssertRefused(const AnalyticTable *t, double F33, const char reason[])
{
  const LamLoad load = {.F = {1.05, 0, 0, 0, 1.05, 0, 0, 0, F33}, .turgor = TISSUE_P0};
  const LamResponse r = Ask(t, &load);

  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_string_equal(r.reason, reason);
}

TEST(a_table_names_its_range_of_F33)
{
  OWNED(AnalyticTable, AnalyticTableClose) t = Rough(PETSC_FALSE, 0), plane = AnalyticTableOpen(PETSC_FALSE, 0.2);

  AssertRefused(&t, 1.3, "F33 is 1.3, the database covers 0.85 to 1.25: build one of a scene with a wider sample.F33");
  AssertRefused(&t, 0.8, "F33 is 0.8, the database covers 0.85 to 1.25: build one of a scene with a wider sample.F33");
  AssertRefused(&plane, 1.1,
                "F33 is 1.1, the database covers 1 alone (plane strain): build one of a scene with sample.F33");
}

/* The ends of the range belong to it, up to rounding. */
TEST(the_ends_of_the_range_answer)
{
  OWNED(AnalyticTable, AnalyticTableClose) t = Rough(PETSC_FALSE, 0);
  const LamLoad low = {.F = {1.05, 0, 0, 0, 1.05, 0, 0, 0, 0.85}, .turgor = TISSUE_P0},
                high = {.F = {1.05, 0, 0, 0, 1.05, 0, 0, 0, 1.25}, .turgor = TISSUE_P0};
  LamResponse r;

  assert_true(Answers(&t, &low, &r));
  assert_true(Answers(&t, &high, &r));
}

/* A query lacks the knots of F33 on both sides of it, and no others. */
TEST(a_query_needs_the_knots_around_its_F33)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Open((PetscBool)kind);
    const double at = kind ? -LAM_ROOT + 20 : 20, u[3] = {at, at + 5, at + 11};
    const LamLoad load = LoadAtF33(&t, u, 0.3 * LAM_ROOT, 1.4, 0.3);
    PetscInt64 keys[LAM_MAX_NEEDS];
    OWNED(LamTable, LamTableDestroy) table;
    PetscInt n;
    LamResponse r;

    CHECK(LamDatabaseGetTable(t.database, &table));
    CHECK(LamTableNeeds(table, &load, PETSC_INFINITY, NULL, &n, keys));
    assert_int_equal(n, kind ? 12 : 8); /* of 8 corners 4 are unlike, of which one floats in contact */
    for (PetscInt k = 0; k < n; k++) assert_in_range(LamNodePlaceOf(keys[k]).z, 2, 3);
    for (PetscInt k = 0; k < n; k++) AddKey(&t, keys[k]);
    assert_true(Answers(&t, &load, &r));
  }
}

/* ---- text ---- */

TEST(a_grid_s_text_keeps_the_range)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Open((PetscBool)kind);
    OWNED(LamGrid, LamGridDestroy) copy;
    char *text, *again;

    CHECK(LamGridGetText(t.grid, &text));
    CHECK(LamGridFromText("a.h5", &t.scene.micro, text, &copy));
    CHECK(LamGridGetText(copy, &again));
    assert_string_equal(text, again);
    assert_int_equal(copy->z_cells, t.grid->z_cells);
    for (PetscInt m = 0; m < LamFreeCellStates(&t.grid->free); m++)
      assert_true(copy->free_keys[m] == t.grid->free_keys[m]);
    CHECK(PetscFree(text));
    CHECK(PetscFree(again));
  }
}
