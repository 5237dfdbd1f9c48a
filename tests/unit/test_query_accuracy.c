/* Answers from scattered records: how good they are, and when there is none. */
#include "query_fixture.h"
#include "support/tissue.h"

static void AssertRefused(LamDatabase db, LamLoad load, PetscReal accuracy)
{
  LamResponse r;

  assert_int_equal(LamDatabaseQuery(db, &load, accuracy, &r), 0);
  assert_int_equal(r.status, LAM_OUT_OF_REACH);
  assert_true(isnan(r.energy) && isnan(r.P[0]) && strlen(r.reason) > 0);
}

/* Without terms of third order nothing is left out, however far the records: the fluid term is exact. */
QUERY_TEST(a_quadratic_potential_is_answered_exactly, Make(1, 1))
{
  LamResponse exact, r;

  cubic = 0;
  AddExact(db, Load(1.08, 0.09, 0.02, 1.05, 0.3));
  AddExact(db, Load(1.03, 0.05, 0.03, 0.99, 0));
  exact = Exact(&probe);
  r = Ask(db, probe);
  cubic = 1;
  AssertClose(9, r.P, exact.P, 1e-13);
  AssertClose(81, r.tangent, exact.tangent, 1e-12);
}

static PetscReal StressErrorAt(PetscReal step)
{
  OWNED(LamDatabase, LamDatabaseClose) db = Make(1, 1);
  const LamLoad near = Load(1.1 + step, 0.1 - step, step, 1 + 0.5 * step, 0.3 + step);
  LamResponse exact = Exact(&near), r;

  AddExact(db, Load(1.1, 0.1, 0, 1, 0.3));
  r = Ask(db, near);
  return StressError(r.P, exact.P);
}

TEST(the_stress_error_falls_with_the_square_of_the_distance)
{
  const PetscReal ratio = StressErrorAt(0.02) / StressErrorAt(0.01);

  assert_true(ratio > 3.5 && ratio < 4.5);
}

QUERY_TEST(what_is_too_far_is_out_of_reach, MakeFilled())
{
  LamLoad load = Load(1.5, 0, 0, 1.5, 0.1);
  LamResponse r;

  r = AssertStatus(db, load, LAM_OUT_OF_REACH);
  assert_true(r.distance > 0.04 && isnan(r.energy) && strlen(r.reason) > 0);
}

QUERY_TEST(an_inverted_state_is_invalid, MakeFilled())
{
  const LamLoad bad[2] = {Load(-1, 0, 0, 1, 0), Load(NAN, 0, 0, 1, 0)};

  for (int i = 0; i < 2; i++) {
    AssertStatus(db, bad[i], LAM_INVALID_F);
  }
}

QUERY_TEST(a_stretch_of_the_thickness_is_out_of_reach, MakeFilled())
{
  LamLoad load = probe;

  load.F[8] = 1.01;
  AssertStatus(db, load, LAM_OUT_OF_REACH);
}

QUERY_TEST(unstable_and_failed_records_do_not_answer, Make(1, 1))
{
  LamResponse records[2] = {Exact(&probe), Exact(&probe)};

  records[0].status = LAM_NOT_CONVERGED;
  records[1].stable = PETSC_FALSE;
  assert_int_equal(LamDatabaseAdd(db, 2, NULL, records), 0);
  AssertStatus(db, probe, LAM_OUT_OF_REACH);
}

QUERY_TEST(another_branch_answers_its_own_state_alone, Make(1, 1))
{
  LamResponse record = Exact(&probe), r;
  LamLoad near = probe;

  record.branch = 1;
  assert_int_equal(LamDatabaseAdd(db, 1, NULL, &record), 0);
  r = Ask(db, probe);
  assert_int_equal(r.branch, 1);
  AssertClose(9, r.P, record.P, 1e-13);
  near.F[0] += 1e-3;
  AssertRefused(db, near, PETSC_INFINITY);
}

/* What lies behind a state of another branch, or one that failed, is not answered from this side of it. */
TEST(a_record_of_another_branch_or_that_failed_forbids_a_blend)
{
  for (int failed = 0; failed < 2; failed++) {
    OWNED(LamDatabase, LamDatabaseClose) db = MakeFilled();
    LamLoad beside = probe;
    LamResponse record;

    beside.F[0] += 0.005;
    record = Exact(&beside);
    record.branch = !failed;
    if (failed) record.status = LAM_NOT_CONVERGED;
    Ask(db, probe);
    assert_int_equal(LamDatabaseAdd(db, 1, NULL, &record), 0);
    AssertRefused(db, probe, PETSC_INFINITY);
  }
}

QUERY_TEST(an_answer_is_given_where_its_estimate_is_within_the_accuracy, MakeFilled())
{
  const PetscReal estimate = Ask(db, probe).error_estimate;
  LamResponse r;

  assert_true(estimate > 0);
  AssertRefused(db, probe, 0.99 * estimate);
  assert_int_equal(LamDatabaseQuery(db, &probe, 1.01 * estimate, &r), 0);
  assert_int_equal(r.status, LAM_CONVERGED);
}

/* One model has no spread; its distance speaks for it. */
QUERY_TEST(the_error_of_a_record_alone_is_estimated_by_its_distance, Make(1, 1))
{
  LamResponse r, exact = Exact(&probe);

  AddExact(db, Load(1.05, 0.03, -0.02, 1.01, 0.1));
  r = Ask(db, probe);
  assert_true(r.error_estimate > StressError(r.P, exact.P));
}
