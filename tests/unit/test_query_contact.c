/* Answers from scattered records of contact tissue. */
#include "query_fixture.h"

static const PetscReal g = 0.2; /* cohesion of the records */

/* The exact response with a gap whose volume is linear in C, p and g: 0.05 + 0.2 (c0 - 1) - 0.03 p - 0.5 (g - 0.2). */
static LamResponse ExactContact(LamLoad load)
{
  const PetscReal dg = load.cohesion - g;
  LamResponse r = Exact(&load);
  PetscReal x[4], K[3][9], closed;

  Invariants(load.F, load.turgor, x);
  Slopes(load.F, K);
  closed = 0.05 + 0.2 * (x[0] - 1) - 0.03 * x[3]; /* the opening at cohesion 0.2 */
  r.energy += dg * closed - 0.25 * dg * dg;
  r.opening_fraction = r.energy_cohesion = closed - 0.5 * dg;
  r.energy_turgor -= 0.03 * dg;
  r.lumen_fraction = -r.energy_turgor;
  for (int i = 0; i < 9; i++) {
    r.P_cohesion[i] = 0.2 * K[0][i];
    r.P[i] += dg * r.P_cohesion[i];
  }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int l = 0; l < 2; l++) r.tangent[27 * i + 9 * j + 3 * i + l] += j == l ? 0.2 * dg : 0;
  r.energy_turgor_cohesion = -0.03;
  r.energy_cohesion2 = -0.5;
  r.max_gap = 0.01;
  r.cell_clusters = 1;
  for (int k = 0; k < 3; k++) r.fabric[k] = 0.1 * k;
  return r;
}

static LamLoad At(LamLoad load, PetscReal turgor, PetscReal cohesion)
{
  load.turgor = turgor;
  load.cohesion = cohesion;
  return load;
}

static void AddContact(LamDatabase db, LamLoad load)
{
  const LamResponse r = ExactContact(load);

  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &r), 0);
}

static LamDatabase MakeContact(LamLoad load)
{
  LamDatabase db = MakeOf(1, 1, LAM_INTERFACE_CONTACT);

  AddContact(db, load);
  return db;
}

/* Records of different turgor and cohesion around `probe` and suction 0.35. */
static LamDatabase MakeContacts(void)
{
  LamDatabase db = MakeContact(At(Load(1.08, 0.09, 0.02, 1.05, 0), 0.17, 0.2));

  AddContact(db, At(Load(1.05, 0.03, -0.02, 1.01, 0), 0.3, 0.06));
  AddContact(db, At(Load(1.03, 0.05, 0.03, 0.99, 0), 0.02, 0.31));
  return db;
}

static const LamLoad contact_probe = {.F = {1.06, 0.06, 0, 0.01, 1.02, 0, 0, 0, 1}, .turgor = 0.15, .cohesion = 0.2};

TEST(turgor_and_cohesion_derivatives_belong_to_the_answered_energy)
{
  const PetscReal h = 1e-4;

  for (int k = 0; k < 2; k++) {
    const PetscReal dp = k ? 0 : h, dg = k ? h : 0;
    OWNED(LamDatabase, LamDatabaseClose) db = MakeContacts();
    const LamResponse r = Ask(db, contact_probe);
    const LamResponse plus = Ask(db, At(probe, 0.15 + dp, g + dg)), minus = Ask(db, At(probe, 0.15 - dp, g - dg));

    assert_near((plus.energy - minus.energy) / (2 * h), k ? r.energy_cohesion : r.energy_turgor, 1e-7);
    assert_near((plus.energy_cohesion - minus.energy_cohesion) / (2 * h),
                k ? r.energy_cohesion2 : r.energy_turgor_cohesion, 1e-5);
    for (int i = 0; i < 9; i++)
      assert_near((plus.P[i] - minus.P[i]) / (2 * h), k ? r.P_cohesion[i] : r.P_turgor[i], 1e-6);
  }
}

/* Without terms of third order the models of the record and of its images agree. */
TEST(the_opening_follows_its_derivatives)
{
  OWNED(LamDatabase, LamDatabaseClose) db;
  LamResponse exact, r;

  cubic = 0;
  db = MakeContact(At(Load(1.05, 0.03, -0.02, 1.01, 0), 0.17, g));
  exact = ExactContact(contact_probe);
  r = Ask(db, contact_probe);
  cubic = 1;
  AssertClose(1, &r.opening_fraction, &exact.opening_fraction, 1e-14);
  AssertClose(9, r.P_cohesion, exact.P_cohesion, 1e-14);
  AssertClose(1, &r.energy_turgor_cohesion, &exact.energy_turgor_cohesion, 1e-14);
}

QUERY_TEST(gaps_are_known_in_the_state_of_a_record_alone, MakeContact(contact_probe))
{
  LamLoad near = contact_probe, turned = contact_probe;
  LamResponse r = Ask(db, contact_probe);

  assert_near(r.max_gap, 0.01, 1e-15);
  assert_near(r.fabric[2], 0.2, 1e-15);
  assert_int_equal(r.cell_clusters, 1);
  near.F[1] += 1e-3;
  r = Ask(db, near);
  assert_true(isnan(r.max_gap) && isnan(r.fabric[2]) && isnan(r.debonded_fraction) && isnan(r.max_traction));
  assert_int_equal(r.cell_clusters, LAM_UNKNOWN_COUNT);
  for (int j = 0; j < 3; j++) { /* turned by a right angle in space: the same gaps elsewhere */
    turned.F[j] = -probe.F[3 + j];
    turned.F[3 + j] = probe.F[j];
  }
  r = Ask(db, turned);
  assert_near(r.max_gap, 0.01, 1e-15);
  assert_true(isnan(r.fabric[2]));
}

/* Turgor for cohesion: the walls feel their sum. */
QUERY_TEST(the_distance_is_one_of_suction, MakeContact(contact_probe))
{
  LamLoad far = At(probe, 0.15, 0);

  assert_true(Ask(db, At(probe, 0.35, 0)).distance < 0.01);
  AssertStatus(db, far, LAM_OUT_OF_REACH);
}

QUERY_TEST(a_record_without_a_tangent_does_not_answer, MakeContact(At(Load(1.05, 0.03, -0.02, 1.01, 0), 0.17, g)))
{
  LamResponse floating = ExactContact(contact_probe);

  for (int i = 0; i < 81; i++) floating.tangent[i] = NAN;
  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &floating), 0);
  AssertStatus(db, contact_probe, LAM_OUT_OF_REACH);
}

/* P vanishes with the last contact, or nearly so: a kink, on one side of which all records agree. */
QUERY_TEST(cells_that_float_answer_their_own_state_alone, MakeContacts())
{
  LamResponse floating = ExactContact(contact_probe);
  LamLoad near = contact_probe;

  floating.floating_cells = 1;
  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &floating), 0);
  Ask(db, contact_probe);
  near.F[0] += 1e-3;
  AssertStatus(db, near, LAM_OUT_OF_REACH);
}

/* Between two meetings of walls the tangent may be anything, over strains of 1e-4. */
QUERY_TEST(a_state_whose_tangent_is_not_elliptic_answers_its_own_state_alone, MakeContacts())
{
  LamResponse kink = ExactContact(contact_probe), before, after;
  LamLoad near = contact_probe;

  near.F[0] += 1e-3;
  before = Ask(db, near);
  for (int i = 0; i < 81; i++) kink.tangent[i] *= -1;
  kink.ellipticity = -0.01;
  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &kink), 0);
  after = Ask(db, near);
  assert_memory_equal(after.P, before.P, sizeof(after.P));
  after = Ask(db, contact_probe);
  assert_true(before.tangent[0] > 0 && after.tangent[0] < 0);
}
