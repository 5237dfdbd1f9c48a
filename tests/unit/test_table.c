/* Answers of the table from records of a known potential: exact at the nodes, derivatives of one potential between
 * them. */
#include "support/test.h"
#include "support/tissue.h"
#include <stdlib.h>
#include <unistd.h>
#include "support/analytic_table.h"

static const int in_plane[4] = {0, 1, 3, 4};

static AnalyticTable Rough(PetscBool contact, double orientation)
{
  AnalyticTable t = AnalyticTableOpen(contact, orientation);

  AddRough(&t, 2, 0, &(uint64_t){1});
  return t;
}

static LamLoad RandomLoad(const AnalyticTable *t, uint64_t *seed)
{
  const double low = t->grid->contact ? -2 * LAM_ROOT : 0, high = t->grid->contact ? 0.4 * LAM_ROOT : 2 * LAM_ROOT;
  double u[3], v, angle;

  for (int k = 0; k < 3; k++) u[k] = RandomReal(seed, low, high);
  v = RandomReal(seed, 0, LAM_ROOT * (double)t->grid->tau_cells);
  angle = RandomReal(seed, -3, 3);
  return LoadAt(t, u, v, angle);
}

/* Off the grid's turgor or cohesion at the same suction. */
static void StepInTurgor(const AnalyticTable *t, double step, LamLoad *load)
{
  load->turgor += step;
  if (t->grid->contact) load->cohesion -= step;
}

/* ---- at nodes ---- */

static void AssertSame(const LamResponse *r, const LamResponse *exact)
{
  for (int i = 0; i < 4; i++) {
    const int a = in_plane[i];

    assert_near(r->P[a], exact->P[a], 1e-9);
    assert_near(r->P_turgor[a], exact->P_turgor[a], 1e-9);
    assert_near(r->P_cohesion[a], exact->P_cohesion[a], 1e-9);
    for (int j = 0; j < 4; j++) assert_near(r->tangent[9 * a + in_plane[j]], exact->tangent[9 * a + in_plane[j]], 1e-8);
  }
  assert_near(r->energy, exact->energy, 1e-10);
  assert_near(r->energy_turgor, exact->energy_turgor, 1e-9);
  assert_near(r->energy_cohesion, exact->energy_cohesion, 1e-9);
}

static void AssertNodes(AnalyticTable *t)
{
  int answered = 0, asked = 0;
  const PetscInt64 *keys;
  PetscInt n;

  CHECK(LamDatabaseGetRecords(t->database, &n, NULL, &keys));
  for (PetscInt k = 0; k < n; k++) {
    const LamNodePlace place = LamNodePlaceOf(keys[k]);
    LamResponse r, exact;

    if (LamNodeIsFree(&place)) continue;
    exact = AnswerOf(t, keys[k]);
    asked++;
    if (!Answers(t, &exact.load, &r)) continue;
    answered++;
    AssertSame(&r, &exact);
  }
  assert_true(answered > 0.5 * asked);
  AnalyticTableClose(t);
}

TEST(bonded_nodes_answer_as_their_records)
{
  AnalyticTable t = Rough(PETSC_FALSE, 0);

  AssertNodes(&t);
}

TEST(contact_nodes_answer_as_their_records)
{
  AnalyticTable t = Rough(PETSC_TRUE, 0);

  AssertNodes(&t);
}

TEST(nodes_of_a_turned_cell_answer_as_their_records)
{
  AnalyticTable t = Rough(PETSC_TRUE, 17 * acos(-1) / 180);

  AssertNodes(&t);
}

/* Two cells a period along one lattice direction: the three are not alike. */
TEST(without_symmetry_nodes_answer_as_their_records)
{
  const AnalyticTissue tissue = {PETSC_FALSE, 0.1, PETSC_FALSE};
  LamScene scene = AnalyticScene(&tissue);
  AnalyticTable t;

  scene.micro.cells[0] = 2;
  t = AnalyticTableOpenScene(tissue, scene);
  assert_false(t.grid->symmetric);
  AddRough(&t, 2, 0, &(uint64_t){2});
  AssertNodes(&t);
}

/* Off the corners of the finest complete cell second derivatives along suction jump, and P33 is interpolated. */
TEST(at_corners_all_numbers_are_the_records)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = AnalyticTableOpen((PetscBool)kind, 0.1);
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
      assert_near(r.P[8], exact.P[8], 1e-12);
      assert_near(r.P_turgor[8], exact.P_turgor[8], 1e-12);
      assert_near(r.P_cohesion[8], exact.P_cohesion[8], 1e-12);
      assert_near(r.energy_turgor2, exact.energy_turgor2, 1e-9);
      assert_near(r.energy_cohesion2, exact.energy_cohesion2, 1e-9);
      assert_near(r.energy_turgor_cohesion, exact.energy_turgor_cohesion, 1e-9);
      for (int i = 0; i < 4; i++) {
        assert_near(r.tangent[72 + in_plane[i]], exact.tangent[72 + in_plane[i]], 1e-11);
        assert_true(r.tangent[72 + in_plane[i]] == r.tangent[9 * in_plane[i] + 8]);
      }
    }
  }
}

/* On demand one interval of suction is solved, and nothing beyond it. */
TABLE_TEST(finer_nodes_of_one_interval_bring_the_answer_nearer, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  const int corner = -2 * LAM_ROOT;
  const double u[3] = {corner + 20, corner + 11, corner + 37};
  const LamLoad load = LoadAt(t, u, 0.9 * LAM_ROOT, 0.3);
  const LamResponse exact = TissueAnswer(&t->tissue, &load);
  double before = 0;

  for (int level = 0; level <= 2; level++) {
    const int n = (1 << level) + 1, size = LAM_ROOT >> level;
    LamResponse r;

    for (int at = 0; at < n * n * n; at++)
      for (int j = 0; j <= LAM_ROOT; j += LAM_ROOT) {
        const int i[3] = {corner + size * (at % n), corner + size * (at / n % n), corner + size * (at / n / n)};

        AddPlace(t, i, j);
      }
    assert_true(Answers(t, &load, &r));
    if (level) assert_true(StressError(r.P, exact.P) < 0.7 * before);
    before = StressError(r.P, exact.P);
  }
}

/* Tissue of one turgor needs no nodes of another. */
TABLE_TEST(at_the_suction_of_its_states_a_cell_needs_no_others, AnalyticTableOpen(PETSC_TRUE, 0.2))
{
  const int corner = -2 * LAM_ROOT;
  const double u[3] = {corner + 20, corner + 11, corner + 37};
  const LamLoad load = LoadAt(t, u, LAM_ROOT, 0.3), beside = LoadAt(t, u, 0.9 * LAM_ROOT, 0.3);
  const LamResponse exact = TissueAnswer(&t->tissue, &load);
  LamResponse r;

  for (int at = 0; at < 8; at++) {
    const int i[3] = {corner + LAM_ROOT * (at & 1), corner + LAM_ROOT * (at >> 1 & 1), corner + LAM_ROOT * (at >> 2)};

    AddPlace(t, i, LAM_ROOT);
  }
  assert_true(Answers(t, &load, &r));
  assert_true(StressError(r.P, exact.P) < 0.02);
  assert_near(r.energy_turgor, exact.energy_turgor, 0.02);
  assert_false(Answers(t, &beside, &r));
}

/* The state to solve in a question's stead: not turned, in the order of the nodes, near one of them. */
TABLE_TEST(a_turned_question_has_the_same_answer, Rough(PETSC_TRUE, 0.2))
{
  uint64_t seed = 11;
  OWNED(LamTable, LamTableDestroy) table;
  PetscInt near = 0;

  CHECK(LamDatabaseGetTable(t->database, &table));
  for (int n = 0; n < 50; n++) {
    const LamLoad load = RandomLoad(t, &seed);
    const LamResponse one = TissueAnswer(&t->tissue, &load);
    LamLoad turned;
    PetscInt64 key;
    LamResponse other;

    CHECK(LamTableTurn(table, &load, &turned, &key));
    other = TissueAnswer(&t->tissue, &turned);
    assert_near(other.energy, one.energy, 1e-9);
    assert_true(turned.F[1] == turned.F[3]);
    near += key >= 0;
  }
  assert_true(near > 0);
}

/* Solves are symmetric to their mesh's accuracy alone: what swaps two strains must not swap what is solved. */
TABLE_TEST(strains_that_are_alike_keep_their_order, Rough(PETSC_TRUE, 0.2))
{
  OWNED(LamTable, LamTableDestroy) table;

  CHECK(LamDatabaseGetTable(t->database, &table));
  for (int k = 0; k < 6; k++) {
    const double e = (k % 2 ? -1 : 1) * 1e-5, f = (k / 2 - 1) * 1e-5;
    const LamLoad load = {
        .F = {1.03 + e, f, 0, f, 1.03 - e, 0, 0, 0, 1}, .turgor = t->scene.turgor, .cohesion = t->scene.cohesion};
    LamLoad turned;
    PetscInt64 key;

    CHECK(LamTableTurn(table, &load, &turned, &key));
    for (int i = 0; i < 4; i++) assert_near(turned.F[3 * (i / 2) + i % 2], load.F[3 * (i / 2) + i % 2], 1e-9);
  }
}

/* ---- images ---- */

/* F Q of a motion Q of the lattice: turned by 60 k degrees; or M F Q, mirrored at an axis of it and seen in a mirror M.
 */
static void Image(const AnalyticTable *t, int image, const PetscReal A[9], PetscReal AQ[9])
{
  const double pi = acos(-1), angle = image < 6 ? image * pi / 3 : 2 * (t->tissue.orientation + (image - 6) * pi / 6);
  const double c = cos(angle), s = sin(angle), m = image < 6 ? 1 : -1, Q[4] = {c, -m * s, s, m * c};

  for (int i = 0; i < 9; i++) AQ[i] = A[i];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) AQ[3 * i + j] = (i ? m : 1) * (A[3 * i] * Q[j] + A[3 * i + 1] * Q[2 + j]);
}

TEST(images_answer_alike)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough((PetscBool)kind, 0.3);
    uint64_t seed = 3;

    for (int n = 0; n < 20; n++) {
      LamLoad load = RandomLoad(&t, &seed), turned = load;
      LamResponse r, other;
      PetscReal P[9];

      if (!Answers(&t, &load, &r)) continue;
      for (int image = 1; image < 12; image++) {
        Image(&t, image, load.F, turned.F);
        assert_true(Answers(&t, &turned, &other));
        Image(&t, image, r.P, P);
        assert_near(other.energy, r.energy, 1e-12);
        for (int i = 0; i < 4; i++) assert_near(other.P[in_plane[i]], P[in_plane[i]], 1e-11);
      }
    }
  }
}

TABLE_TEST(stress_turns_with_the_frame, Rough(PETSC_FALSE, 0))
{
  const double u[3] = {30, 70, 90}, c = cos(0.7), s = sin(0.7);
  const LamLoad straight = LoadAt(t, u, 0, 0), turned = LoadAt(t, u, 0, 0.7);
  LamResponse r, other;

  assert_true(Answers(t, &straight, &r));
  assert_true(Answers(t, &turned, &other));
  for (int j = 0; j < 2; j++) {
    assert_near(other.P[j], c * r.P[j] - s * r.P[3 + j], 1e-13);
    assert_near(other.P[3 + j], s * r.P[j] + c * r.P[3 + j], 1e-13);
  }
}

/* A turned by an angle from both sides, as a material that does not know directions has it. */
static void TurnTangent(const PetscReal A[81], double angle, double turned[4][4])
{
  const double R[2][2] = {{cos(angle), -sin(angle)}, {sin(angle), cos(angle)}};

  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      turned[a][b] = 0;
      for (int k = 0; k < 4; k++)
        for (int l = 0; l < 4; l++)
          turned[a][b] +=
              R[a / 2][k / 2] * R[a % 2][k % 2] * R[b / 2][l / 2] * R[b % 2][l % 2] * A[9 * in_plane[k] + in_plane[l]];
    }
}

TEST(the_tangent_is_isotropic_without_isochoric_strain)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough((PetscBool)kind, 0.3);

    for (int n = 0; n < 30; n++) {
      const double at = (kind ? -2 * LAM_ROOT : 0) + 4.3 * n, u[3] = {at, at, at};
      LamLoad load = LoadAt(&t, u, 20 + 2 * n, 0);
      double turned[4][4];
      LamResponse r;

      StepInTurgor(&t, 0.02, &load);
      if (!Answers(&t, &load, &r)) continue;
      TurnTangent(r.tangent, 0.4 + 0.1 * n, turned);
      for (int a = 0; a < 16; a++)
        assert_near(r.tangent[9 * in_plane[a / 4] + in_plane[a % 4]], turned[a / 4][a % 4],
                    2e-13 * fmax(1, fabs(r.tangent[0])));
    }
  }
}

/* A solver's records are symmetric to its tolerance only. */
TABLE_TEST(records_that_are_a_little_asymmetric_make_a_symmetric_answer, AnalyticTableOpen(PETSC_FALSE, 0))
{
  const double u[3] = {20, 20, 20};
  const LamLoad load = LoadAt(t, u, 0, 0);
  uint64_t seed = 4;
  double turned[4][4];
  LamResponse r;

  for (int at = 0; at < 8; at++) {
    const int i[3] = {LAM_ROOT * (at & 1), LAM_ROOT * (at >> 1 & 1), LAM_ROOT * (at >> 2)};
    const PetscInt64 key = KeyOf(t, i, 0);

    r = AnswerOf(t, key);
    for (int k = 0; k < 9; k++) r.P[k] += RandomReal(&seed, -1e-6, 1e-6);
    for (int k = 0; k < 81; k++) r.tangent[k] += RandomReal(&seed, -1e-6, 1e-6);
    if (!HasKey(t, key)) CHECK(LamDatabaseAdd(t->database, 1, &key, &r));
  }
  assert_true(Answers(t, &load, &r));
  TurnTangent(r.tangent, 0.4, turned);
  for (int a = 0; a < 16; a++)
    assert_near(r.tangent[9 * in_plane[a / 4] + in_plane[a % 4]], turned[a / 4][a % 4], 1e-13);
}

/* ---- one potential ---- */

/* Far from faces, across which the tangent jumps. */
static PetscBool IsInside(const AnalyticTable *t, const LamLoad *load)
{
  const PetscReal F[4] = {load->F[0], load->F[1], load->F[3], load->F[4]}, s = load->turgor + load->cohesion;
  const LamLatticeState at = LamLatticeStateOf(&t->grid->axes, F);
  PetscReal a[3] = {0}, v = 2, u[3];

  if (t->grid->free.n) LamFreeCellStrain(&t->grid->free, s, a);
  for (int k = 0; k < 3; k++) u[k] = (at.x[k] - a[0] - t->grid->origin) / t->grid->step * LAM_ROOT;
  if (t->grid->contact) v = LAM_ROOT * (LamGridTau(t->grid, s) - t->grid->tau_min) / t->grid->tau_step;
  for (int k = 0; k < 3; k++)
    if (fabs(remainder(u[k], 16)) < 0.05 || fabs(u[k] - u[(k + 1) % 3]) < 0.05) return PETSC_FALSE;
  return (PetscBool)(fabs(remainder(v, 4)) > 0.05);
}

typedef void (*Comparison)(const AnalyticTable *t, const LamLoad *load);

static void AtRandomStates(Comparison compare)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough((PetscBool)kind, 0.2);
    uint64_t seed = 5;
    int compared = 0;

    for (int n = 0; n < 300; n++) {
      LamLoad load = RandomLoad(&t, &seed);
      LamResponse r;

      StepInTurgor(&t, RandomReal(&seed, -0.05, 0.05), &load);
      if (!IsInside(&t, &load) || !Answers(&t, &load, &r)) continue;
      compare(&t, &load);
      compared++;
    }
    assert_true(compared > 50);
  }
}

static void CompareStress(const AnalyticTable *t, const LamLoad *load)
{
  const LamResponse r = Ask(t, load);

  for (int i = 0; i < 4; i++) {
    LamResponse pair[2];

    AnswerPair(t, load, offsetof(LamLoad, F) + (size_t)in_plane[i] * sizeof(PetscReal), ANSWER_STEP, pair);
    assert_near(ANSWER_SLOPE(pair, energy), r.P[in_plane[i]], 1e-8);
  }
}

TEST_IS(stress_is_the_slope_of_the_energy, AtRandomStates(CompareStress));

static void CompareTangent(const AnalyticTable *t, const LamLoad *load)
{
  const LamResponse r = Ask(t, load);

  for (int i = 0; i < 4; i++) {
    LamResponse pair[2];

    AnswerPair(t, load, offsetof(LamLoad, F) + (size_t)in_plane[i] * sizeof(PetscReal), ANSWER_STEP, pair);
    for (int j = 0; j < 4; j++) {
      const PetscReal A = r.tangent[9 * in_plane[j] + in_plane[i]];

      assert_near(ANSWER_SLOPE(pair, P[in_plane[j]]), A, 1e-6);
      assert_near(r.tangent[9 * in_plane[i] + in_plane[j]], A, 1e-11);
    }
  }
}

TEST_IS(the_tangent_is_symmetric_and_the_slope_of_the_stress, AtRandomStates(CompareTangent));

static void CompareTurgor(const AnalyticTable *t, const LamLoad *load)
{
  const LamResponse r = Ask(t, load);
  LamResponse pair[2];

  AnswerPair(t, load, offsetof(LamLoad, turgor), ANSWER_STEP, pair);
  assert_near(ANSWER_SLOPE(pair, energy), r.energy_turgor, 1e-8);
  assert_near(ANSWER_SLOPE(pair, energy_turgor), r.energy_turgor2, 1e-6);
  assert_near(ANSWER_SLOPE(pair, energy_cohesion), r.energy_turgor_cohesion, 1e-6);
  for (int i = 0; i < 4; i++) assert_near(ANSWER_SLOPE(pair, P[in_plane[i]]), r.P_turgor[in_plane[i]], 1e-6);
}

TEST_IS(derivatives_in_turgor_are_slopes, AtRandomStates(CompareTurgor));

static void CompareCohesion(const AnalyticTable *t, const LamLoad *load)
{
  const LamResponse r = Ask(t, load);
  LamResponse pair[2];

  if (!t->grid->contact) return;
  AnswerPair(t, load, offsetof(LamLoad, cohesion), ANSWER_STEP, pair);
  assert_near(ANSWER_SLOPE(pair, energy), r.energy_cohesion, 1e-8);
  assert_near(ANSWER_SLOPE(pair, energy_cohesion), r.energy_cohesion2, 1e-6);
  assert_near(ANSWER_SLOPE(pair, energy_turgor), r.energy_turgor_cohesion, 1e-6);
  for (int i = 0; i < 4; i++) assert_near(ANSWER_SLOPE(pair, P[in_plane[i]]), r.P_cohesion[in_plane[i]], 1e-6);
}

TEST_IS(derivatives_in_cohesion_are_slopes, AtRandomStates(CompareCohesion));

/* ---- files ---- */

static void WriteTable(const AnalyticTable *t, const char path[])
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamRecordWriter writer;
  PetscInt n;
  char *text;

  CHECK(LamDatabaseGetRecords(t->database, &n, &records, &keys));
  CHECK(LamGridGetText(t->grid, &text));
  CHECK(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, &t->scene, &writer));
  CHECK(LamRecordWriterText(writer, LAM_GRID_NAME, text));
  CHECK(LamRecordWriterCommit(writer, n, keys, records));
  CHECK(LamRecordWriterClose(&writer));
  CHECK(PetscFree(text));
}

/* All numbers but the time it took, which is that of the first. */
static void AssertIdentical(const LamResponse *a, LamResponse *b)
{
  b->seconds = a->seconds;
  assert_memory_equal(a, b, sizeof(*a));
}

TEST(a_file_answers_bit_for_bit_as_memory)
{
  for (int kind = 0; kind < 2; kind++) {
    OWNED(AnalyticTable, AnalyticTableClose) t = Rough((PetscBool)kind, 0.1);
    OWNED(AnalyticTable, AnalyticTableClose) read = t;
    char path[] = "/tmp/lamella_test_table_XXXXXX";
    uint64_t seed = 6;

    close(mkstemp(path));
    WriteTable(&t, path);
    CHECK(LamDatabaseOpen(path, &read.database));
    unlink(path);
    for (int n = 0; n < 200; n++) {
      const LamLoad load = RandomLoad(&t, &seed);
      const LamResponse r = Ask(&t, &load);
      LamResponse other = Ask(&read, &load);

      AssertIdentical(&r, &other);
    }
  }
}
