/* What the table refuses, which nodes it asks for then, and that it survives records that are none of its own. */
#include "support/test.h"
#include "support/tissue.h"
#include <stdlib.h>
#include <string.h>
#include "support/analytic_table.h"

static const int in_plane[4] = {0, 1, 3, 4};

static PetscInt Needs(const AnalyticTable *t, const LamLoad *load, double accuracy, PetscInt64 keys[LAM_MAX_NEEDS])
{
  OWNED(LamTable, LamTableDestroy) table;
  PetscInt n;

  CHECK(LamDatabaseGetTable(t->database, &table));
  CHECK(LamTableNeeds(table, load, accuracy, NULL, &n, keys));
  return n;
}

/* Solves what is needed, round by round; the number of rounds. */
static int SolveNeeds(AnalyticTable *t, const LamLoad *load, double accuracy, int most)
{
  for (int round = 0; round < most; round++) {
    PetscInt64 keys[LAM_MAX_NEEDS];
    const PetscInt n = Needs(t, load, accuracy, keys);

    for (PetscInt k = 0; k < n; k++) {
      assert_false(HasKey(t, keys[k]));
      AddKey(t, keys[k]);
    }
    if (!n) return round;
  }
  return most;
}

/* Somewhere in the first root cell of the bonded grid, near all axes' middle or off it. */
static LamLoad Inside(const AnalyticTable *t)
{
  const double low = t->grid->contact ? -1.6 * LAM_ROOT : 0, u[3] = {low + 20, low + 11, low + 37};

  return LoadAt(t, u, 30, 0.3);
}

/* A record of a place with another end than the tissue's. */
static void AddMarked(AnalyticTable *t, const int i[3], int j, LamStatus status, PetscBool stable, PetscInt branch)
{
  const PetscInt64 key = KeyOf(t, i, j);
  LamResponse r = AnswerOf(t, key);

  r.status = status;
  r.stable = stable;
  r.branch = branch;
  CHECK(LamDatabaseAdd(t->database, 1, &key, &r));
}

/* ---- needs ---- */

TEST(an_empty_table_needs_the_corners_of_the_root_cell)
{
  for (int contact = 0; contact < 2; contact++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = AnalyticTableOpen((PetscBool)contact, 0.2);
    const double u[3] = {-20, -70, -140};
    const LamLoad load = LoadAt(&t, u, 30, 0);
    PetscInt64 keys[LAM_MAX_NEEDS];
    const LamResponse r = Ask(&t, &load);

    assert_int_equal(r.status, LAM_OUT_OF_REACH);
    assert_non_null(strstr(r.reason, "no nodes"));
    assert_int_equal(Needs(&t, &load, PETSC_INFINITY, keys), contact ? 16 : 8);
    assert_int_equal(SolveNeeds(&t, &load, PETSC_INFINITY, 2), 1);
    assert_int_equal(Ask(&t, &load).status, LAM_CONVERGED);
  }
}

/* On the diagonal the eight corners of a cell are four nodes. */
TABLE_TEST(alike_corners_are_needed_once, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const LamLoad load = Inside(t);
  PetscInt64 keys[LAM_MAX_NEEDS];

  assert_int_equal(Needs(t, &load, PETSC_INFINITY, keys), 4);
}

TEST(what_is_needed_makes_the_answer)
{
  for (int contact = 0; contact < 2; contact++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = AnalyticTableOpen((PetscBool)contact, 0.2);
    const LamLoad load = Inside(&t);
    const LamResponse exact = TissueAnswer(&t.tissue, &load);
    const double accuracy = contact ? 1e-3 : 1e-6;
    LamResponse r;

    assert_true(SolveNeeds(&t, &load, accuracy, 12) < 12);
    r = AskFor(&t, &load, accuracy);
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_true(r.error_estimate <= accuracy);
    assert_true(StressError(r.P, exact.P) < 2 * accuracy); /* of one response; test_table_estimate judges many */
  }
}

TABLE_TEST(an_answer_that_is_not_accurate_says_so, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  const LamLoad load = Inside(t);
  LamResponse r;

  SolveNeeds(t, &load, PETSC_INFINITY, 2);
  r = AskFor(t, &load, 1e-12);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_non_null(strstr(r.reason, "estimated error"));
}

/* Rounding puts about half of the rotations below the edge. */
TABLE_TEST(the_edge_of_the_box_is_part_of_it_in_any_rotation, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  static const int corner[3] = {0, 0, 0};
  static const double edge[3] = {0, 0, 20};

  AddBlock(t, 0, corner, 1, 1);
  for (int n = 0; n < 40; n++) {
    const LamLoad load = LoadAt(t, edge, 0, 0.17 * n);

    assert_int_equal(Ask(t, &load).status, LAM_CONVERGED);
  }
}

TABLE_TEST(beyond_the_suctions_no_node_helps, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  LamLoad load = Inside(t);
  PetscInt64 keys[LAM_MAX_NEEDS];
  LamResponse r;

  load.turgor += TISSUE_SUCTION;
  r = Ask(t, &load);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_non_null(strstr(r.reason, "turgor + cohesion"));
  assert_int_equal(Needs(t, &load, PETSC_INFINITY, keys), 0);
}

TABLE_TEST(far_out_no_node_helps, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const double u[3] = {LAM_GRID_REACH - 40, LAM_GRID_REACH - 40, LAM_GRID_REACH - 40};
  const LamLoad load = LoadAt(t, u, 0, 0);
  PetscInt64 keys[LAM_MAX_NEEDS];

  assert_int_equal(Ask(t, &load).status, LAM_OUT_OF_REACH);
  assert_int_equal(Needs(t, &load, PETSC_INFINITY, keys), 0);
}

/* ---- kinds of states ---- */

static void AssertRefusedWith(LamStatus status, PetscBool stable, PetscInt branch)
{
  OWNED(AnalyticTable, AnalyticTableClose) t = AnalyticTableOpen(PETSC_FALSE, 0.2);
  const LamLoad load = Inside(&t);
  const int corner[3] = {LAM_ROOT, LAM_ROOT, LAM_ROOT};
  PetscInt64 keys[LAM_MAX_NEEDS];
  LamResponse r;

  AddMarked(&t, corner, 0, status, stable, branch);
  SolveNeeds(&t, &load, PETSC_INFINITY, 1);
  r = Ask(&t, &load);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_non_null(strstr(r.reason, "one kind"));
  /* its children do without that corner */
  assert_true(Needs(&t, &load, PETSC_INFINITY, keys) > 0);
  SolveNeeds(&t, &load, PETSC_INFINITY, 4);
  r = Ask(&t, &load);
  assert_int_equal(r.status, LAM_CONVERGED);
}

TEST_IS(a_cell_with_an_unstable_corner_is_refused_its_children_are_not,
        AssertRefusedWith(LAM_UNSTABLE, PETSC_FALSE, 0));

TEST_IS(a_cell_with_a_corner_on_another_branch_is_refused_its_children_are_not,
        AssertRefusedWith(LAM_CONVERGED, PETSC_TRUE, 1));

TABLE_TEST(a_root_cell_with_a_failed_corner_cannot_be_helped, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const LamLoad load = Inside(t);
  PetscInt64 keys[LAM_MAX_NEEDS];

  AddFailed(t, (int[3]){LAM_ROOT, LAM_ROOT, LAM_ROOT}, 0);
  SolveNeeds(t, &load, PETSC_INFINITY, 2);
  assert_int_equal(Ask(t, &load).status, LAM_OUT_OF_REACH);
  assert_int_equal(Needs(t, &load, PETSC_INFINITY, keys), 0);
}

/* Cells that barely touch leave saddles of another kind. */
TABLE_TEST(another_branch_of_cells_that_barely_touch_is_none, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  const LamLoad load = Inside(t);
  PetscInt64 keys[LAM_MAX_NEEDS];
  const PetscInt n = Needs(t, &load, PETSC_INFINITY, keys);

  for (PetscInt k = 0; k < n; k++) {
    LamResponse r = AnswerOf(t, keys[k]);

    r.branch = (PetscInt)(k % 2);
    r.debonded_fraction = 0.8;
    CHECK(LamDatabaseAdd(t->database, 1, &keys[k], &r));
  }
  assert_int_equal(Ask(t, &load).status, LAM_CONVERGED);
}

/* A failed node of a finer level spoils the cells it is a corner of, and only these. */
TABLE_TEST(a_failed_finer_node_spoils_its_own_cells, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const int first[3] = {0, 0, 0}, half = LAM_ROOT / 2;
  const double by[3] = {50, 55, 40}, off[3] = {10, 5, 20};
  const LamLoad spoiled = LoadAt(t, by, 0, 0), spared = LoadAt(t, off, 0, 0);

  AddFailed(t, (int[3]){half, LAM_ROOT, LAM_ROOT}, 0);
  AddBlock(t, 1, first, 2, LAM_ROOT);
  assert_int_equal(Ask(t, &spoiled).status, LAM_OUT_OF_REACH);
  assert_int_equal(Ask(t, &spared).status, LAM_CONVERGED);
}

/* A change of branch in the middle: refined as far as the level allows, then left to the solver. */
TABLE_TEST(a_change_of_branch_is_refined_so_far_and_no_further, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const double u[3] = {30, 31, 33};
  const LamLoad load = LoadAt(t, u, 0, 0);
  PetscInt64 keys[LAM_MAX_NEEDS];
  int finest = 0, rounds = 0;

  for (PetscInt n = 1; n && rounds < 10; rounds++) {
    n = Needs(t, &load, PETSC_INFINITY, keys);
    for (PetscInt k = 0; k < n; k++) {
      const LamNodePlace place = LamNodePlaceOf(keys[k]);

      AddMarked(t, place.i, 0, LAM_CONVERGED, PETSC_TRUE, place.i[0] + place.i[1] + place.i[2] > 94);
      finest = PetscMax(finest, LamNodeLevel(&place));
    }
  }
  assert_int_equal(finest, 2);
  assert_int_equal(Ask(t, &load).status, LAM_OUT_OF_REACH);
}

/* ---- cells that touch no one ---- */

TABLE_TEST(floating_cells_need_no_node_and_are_exact, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  uint64_t seed = 1;

  for (int n = 0; n < 50; n++) {
    const double u[3] = {RandomReal(&seed, 0.1, 90), RandomReal(&seed, 0.1, 90), RandomReal(&seed, 0.1, 90)};
    LamLoad load = LoadAt(t, u, RandomReal(&seed, 0, LAM_ROOT * (double)t->grid->tau_cells), 0.3);
    PetscInt64 keys[LAM_MAX_NEEDS];
    LamResponse r, exact;

    load.turgor += 0.03;
    load.cohesion -= 0.03;
    r = AskFor(t, &load, 0);
    exact = TissueAnswer(&t->tissue, &load);
    assert_int_equal(r.status, LAM_CONVERGED);
    assert_int_equal(Needs(t, &load, 0, keys), 0);
    assert_near(r.energy, exact.energy, 1e-12);
    assert_near(r.energy_turgor, exact.energy_turgor, 1e-11);
    assert_near(r.energy_cohesion, exact.energy_cohesion, 1e-11);
    assert_near(r.energy_turgor2, exact.energy_turgor2, 1e-8);
    assert_near(r.energy_turgor_cohesion, exact.energy_turgor_cohesion, 1e-8);
    for (int a = 0; a < 4; a++) {
      assert_near(r.P[in_plane[a]], exact.P[in_plane[a]], 1e-13);
      for (int b = 0; b < 4; b++)
        assert_near(r.tangent[9 * in_plane[a] + in_plane[b]], exact.tangent[9 * in_plane[a] + in_plane[b]], 1e-13);
    }
  }
}

/* ---- damage ---- */

/* Keys of nodes with any bits, records of any state: as many as a file could hold. */
TEST(keys_of_places_that_are_none_are_left_out)
{
  for (int contact = 0; contact < 2; contact++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = AnalyticTableOpen((PetscBool)contact, 0.2);
    const LamLoad load = Inside(&t);
    LamResponse before, after, record;
    uint64_t seed = 2;

    SolveNeeds(&t, &load, PETSC_INFINITY, 2);
    before = Ask(&t, &load);
    record = TissueAnswer(&t.tissue, &load);
    for (int n = 0; n < 3000; n++) {
      const int wild = n % 3, reach = n % 2 ? LAM_GRID_REACH : 2 * LAM_ROOT;
      LamNodePlace place = {.j = wild == 0 ? 4095 - n % 60 : 0};
      PetscInt64 key;

      for (int k = 0; k < 3; k++) place.i[k] = (int)RandomReal(&seed, -reach, reach);
      if (wild == 1) place.i[0] = place.i[1] + 1 + n % 70;                                        /* not sorted */
      if (wild == 2) place.i[2] = n % 2 ? LAM_GRID_REACH - 1 - n % 50 : -LAM_GRID_REACH + n % 50; /* too far */
      if (place.i[0] >= LAM_GRID_REACH || place.i[0] == LAM_GRID_REACH - 1) continue;
      if (wild == 2 && n % 2 == 0) place.i[0] = -LAM_GRID_REACH;
      key = LamNodeKeyOf(&place);
      CHECK(LamDatabaseAdd(t.database, 1, &key, &record));
    }
    after = Ask(&t, &load);
    assert_int_equal(after.status, LAM_CONVERGED);
    assert_memory_equal(after.P, before.P, sizeof(after.P));
  }
}

TABLE_TEST(a_bonded_node_off_its_turgor_is_none, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const LamLoad load = Inside(t);
  const int corner[3] = {0, 0, 0};
  PetscInt64 keys[LAM_MAX_NEEDS];

  AddPlace(t, corner, 5);
  assert_int_equal(Needs(t, &load, PETSC_INFINITY, keys), 4);
}

TABLE_TEST(a_record_where_cells_touch_no_one_changes_nothing, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  const double u[3] = {-10, 10, 20};
  const LamLoad load = LoadAt(t, u, 30, 0);
  LamResponse before, after, wrong;

  SolveNeeds(t, &load, PETSC_INFINITY, 2);
  before = Ask(t, &load);
  assert_int_equal(before.status, LAM_CONVERGED);
  for (int j = 0; j <= LAM_ROOT; j += LAM_ROOT) {
    const PetscInt64 key = KeyOf(t, (int[3]){0, 0, 0}, j);

    wrong = AnswerOf(t, key);
    wrong.energy += 1;
    CHECK(LamDatabaseAdd(t->database, 1, &key, &wrong));
  }
  after = Ask(t, &load);
  assert_memory_equal(after.P, before.P, sizeof(after.P));
}

TEST(any_key_of_a_node_can_be_in_a_file)
{
  for (int kind = 0; kind < 4; kind++) {
    const AnalyticTissue tissue = {(PetscBool)(kind % 2), 0.2, PETSC_FALSE};
    LamScene scene = AnalyticScene(&tissue);
    uint64_t seed = 3;
    LamResponse record;
    LamLoad load;
    OWNED(AnalyticTable, AnalyticTableClose) t;

    if (kind == 2) scene.micro.cells[0] = 2; /* no symmetry */
    t = AnalyticTableOpenScene(tissue, scene);
    load = Inside(&t);
    record = TissueAnswer(&tissue, &load);
    for (int n = 0; n < 3000; n++) {
      const PetscInt64 key = LAM_NODE_KEY + (PetscInt64)RandomReal(&seed, 0, (double)((PetscInt64)1 << 54));

      assert_true(LamKeyIsNode(key));
      CHECK(LamDatabaseAdd(t.database, 1, &key, &record));
    }
    assert_int_equal(Ask(&t, &load).status, LAM_OUT_OF_REACH);
  }
}

TABLE_TEST(a_record_that_is_not_finite_is_as_good_as_failed, AnalyticTableOpen(PETSC_FALSE, 0.2))
{
  const LamLoad load = Inside(t);
  const PetscInt64 key = KeyOf(t, (int[3]){0, 0, 0}, 0);
  LamResponse r = AnswerOf(t, key);

  r.tangent[1] = NAN;
  CHECK(LamDatabaseAdd(t->database, 1, &key, &r));
  SolveNeeds(t, &load, PETSC_INFINITY, 2);
  assert_int_equal(Ask(t, &load).status, LAM_OUT_OF_REACH);
}
