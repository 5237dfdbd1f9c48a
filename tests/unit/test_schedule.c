/*
  Which piece of work is given to whom.
*/
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <petscsys.h>
#include <bench/dispatch_simulation.h>
#include <random_reals.h>

#define CHECK(call) assert_int_equal((call), 0)
#define ANSWER 1e-3
enum { MOST = 64 };

static LamSchedule Schedule(PetscInt children, const PetscInt capacity[])
{
  LamSchedule schedule;

  CHECK(LamScheduleCreate(children, capacity, ANSWER, &schedule));
  return schedule;
}

/* How many the child is given; they are in pieces[]. */
static PetscInt Take(LamSchedule schedule, PetscInt child, PetscReal now, PetscInt most, PetscInt64 pieces[])
{
  PetscInt n;

  CHECK(LamScheduleTake(schedule, child, now, most, &n, pieces));
  return n;
}

static PetscBool Done(LamSchedule schedule, PetscInt child, PetscReal now, PetscInt64 piece)
{
  PetscBool first;

  CHECK(LamScheduleDone(schedule, child, now, piece, &first));
  return first;
}

static void test_longest_first(void **state)
{
  const PetscInt capacity[] = {1};
  LamSchedule s = Schedule(1, capacity);
  PetscInt64 piece;

  CHECK(LamScheduleAdd(s, 0, 1, 1));
  CHECK(LamScheduleAdd(s, 1, 1, 4));
  CHECK(LamScheduleAdd(s, 2, 1, 2));
  for (int k = 0; k < 3; k++) {
    static const PetscInt64 expected[] = {1, 2, 0};

    assert_int_equal(Take(s, 0, k, 1, &piece), 1);
    assert_int_equal(piece, expected[k]);
    assert_true(Done(s, 0, k + 1, piece));
  }
  CHECK(LamScheduleDestroy(&s));
}

/* A piece ahead where much waits, none where others will have nothing. */
static void test_fewer_ahead_at_the_end(void **state)
{
  const PetscInt capacity[] = {1, 1, 1};
  PetscInt64 pieces[MOST];

  for (PetscInt64 count = 3; count <= 300; count *= 100) {
    LamSchedule s = Schedule(3, capacity);

    CHECK(LamScheduleAdd(s, 0, count, 1));
    assert_int_equal(Take(s, 0, 0, MOST, pieces), count == 3 ? 1 : 2);
    CHECK(LamScheduleDestroy(&s));
  }
}

/* A child that hands out has pieces for all below it, and some on the way; all together no more than there are. */
static void test_capacity(void **state)
{
  const PetscInt capacity[] = {10, 10};
  LamSchedule s = Schedule(2, capacity);
  PetscInt64 pieces[MOST];

  CHECK(LamScheduleAdd(s, 0, 1000, 1));
  assert_in_range(Take(s, 0, 0, MOST, pieces), 20, 40);
  CHECK(LamScheduleDestroy(&s));
  s = Schedule(2, capacity);
  CHECK(LamScheduleAdd(s, 0, 20, 1));
  assert_int_equal(Take(s, 0, 0, MOST, pieces), 10);
  assert_int_equal(Take(s, 1, 0, MOST, pieces), 10);
  CHECK(LamScheduleDestroy(&s));
}

/* Two ranks, the second one ten times slower, after some work; at *now they have nothing. */
static LamSchedule OneSlow(PetscReal *now)
{
  const PetscInt capacity[] = {1, 1};
  LamSchedule s = Schedule(2, capacity);
  PetscInt64 piece;

  *now = 0;
  for (int k = 0; k < 40; k++) {
    PetscInt64 slow;

    CHECK(LamScheduleAdd(s, 11 * k, 11, 1));
    assert_int_equal(Take(s, 1, *now, 1, &slow), 1);
    for (int i = 0; i < 10; i++) {
      assert_int_equal(Take(s, 0, *now, 1, &piece), 1);
      assert_true(Done(s, 0, *now += 1, piece));
    }
    assert_true(Done(s, 1, *now, slow));
  }
  return s;
}

static void test_slow_rank_gets_the_shortest(void **state)
{
  PetscReal now;
  LamSchedule s = OneSlow(&now);
  PetscInt64 piece;

  CHECK(LamScheduleAdd(s, 1000, 1, 8));
  CHECK(LamScheduleAdd(s, 1001, 1, 1));
  assert_int_equal(Take(s, 1, now, 1, &piece), 1);
  assert_int_equal(piece, 1001);
  CHECK(LamScheduleDestroy(&s));
}

static void test_second_copy_of_a_slow_ranks_last_piece(void **state)
{
  PetscReal now;
  LamSchedule s = OneSlow(&now);
  PetscInt64 slow, piece;

  CHECK(LamScheduleAdd(s, 1000, 20, 1));
  assert_int_equal(Take(s, 1, now, 1, &slow), 1);
  for (int k = 0; k < 19; k++) {
    assert_int_equal(Take(s, 0, now, 1, &piece), 1);
    assert_true(Done(s, 0, now, piece));
  }
  assert_int_equal(Take(s, 0, now, MOST, &piece), 1);
  assert_int_equal(piece, slow);
  assert_int_equal(LamScheduleOut(s), 2);
  assert_true(Done(s, 0, now + 1, piece));
  assert_false(Done(s, 1, now + 10, slow));
  assert_int_equal(LamScheduleOut(s), 0);
  CHECK(LamScheduleDestroy(&s));
}

/* The first of two pieces takes for ever; the rank that has nothing to do gets the second one, and not the first. */
static void test_second_copy_of_what_waits_behind_a_long_piece(void **state)
{
  const PetscInt capacity[] = {1, 1};
  LamSchedule s = Schedule(2, capacity);
  PetscInt64 first[2], piece;

  CHECK(LamScheduleAdd(s, 0, 4, 1));
  assert_int_equal(Take(s, 0, 0, MOST, first), 2);
  for (int k = 0; k < 2; k++) {
    assert_int_equal(Take(s, 1, k, 1, &piece), 1);
    assert_true(Done(s, 1, k + 1, piece));
  }
  assert_int_equal(LamScheduleWaiting(s), 0);
  assert_int_equal(Take(s, 1, 2, MOST, &piece), 1);
  assert_int_equal(piece, first[1]);
  assert_true(Done(s, 1, 3, piece));
  assert_int_equal(Take(s, 1, 3, MOST, &piece), 0);
  assert_true(Done(s, 0, 50, first[0]));
  assert_false(Done(s, 0, 51, first[1]));
  CHECK(LamScheduleDestroy(&s));
}

/* ---- random events ---- */

enum { CHILDREN = 9, PIECES = 100000, HOLDS = 4096 };

typedef struct {
  PetscInt n[CHILDREN];
  PetscInt64 holds[CHILDREN][HOLDS];
  char *given, *done; /* [PIECES] */
  uint64_t seed, log; /* log: of all decisions */
} Play;

static void Ask(Play *p, LamSchedule s, PetscInt child, PetscReal now)
{
  PetscInt64 pieces[MOST];
  const PetscInt n = Take(s, child, now, 1 + (PetscInt)RandomReal(&p->seed, 0, MOST - 1), pieces);

  assert_true(p->n[child] + n <= HOLDS);
  for (PetscInt i = 0; i < n; i++) {
    p->holds[child][p->n[child]++] = pieces[i];
    assert_true(++p->given[pieces[i]] <= 2);
    assert_false(p->done[pieces[i]]); /* what is done is not given again */
    p->log = MixBits(p->log ^ (uint64_t)(pieces[i] * CHILDREN + child));
  }
}

static void Answer(Play *p, LamSchedule s, PetscInt child, PetscReal now)
{
  PetscInt64 piece;
  PetscInt i;

  if (!p->n[child]) return;
  i = (PetscInt)RandomReal(&p->seed, 0, PetscMin(p->n[child], 3));
  piece = p->holds[child][i];
  for (p->n[child]--; i < p->n[child]; i++) p->holds[child][i] = p->holds[child][i + 1];
  if (Done(s, child, now, piece)) {
    assert_false(p->done[piece]);
    p->done[piece] = 1;
  } else {
    assert_true(p->done[piece]);
  }
}

/* Children of different capacity, one that hardly ever answers, pieces that come in ranges; until all is done. */
static void Run(Play *p)
{
  const PetscInt capacity[CHILDREN] = {1, 1, 1, 1, 3, 7, 20, 50, 1};
  LamSchedule s = Schedule(CHILDREN, capacity);
  PetscInt64 added = 0, done = 0;
  PetscReal now = 0;

  p->seed = 7;
  p->given = calloc(PIECES, 1);
  p->done = calloc(PIECES, 1);
  while (added < PIECES || LamScheduleWaiting(s) || LamScheduleOut(s)) {
    const PetscInt child = (PetscInt)RandomReal(&p->seed, 0, CHILDREN);

    now += RandomReal(&p->seed, 0, 1e-2);
    if (added < PIECES && RandomReal(&p->seed, 0, 1) < 0.01) {
      const PetscInt64 some = (PetscInt64)RandomReal(&p->seed, 1, 500), n = PetscMin(PIECES - added, some);

      CHECK(LamScheduleAdd(s, added, n, exp(RandomReal(&p->seed, -3, 3))));
      added += n;
    }
    if (child != CHILDREN - 1 || RandomReal(&p->seed, 0, 1) < 0.02) Answer(p, s, child, now);
    Ask(p, s, child, now);
  }
  for (PetscInt64 i = 0; i < PIECES; i++) done += p->done[i];
  assert_int_equal(done, PIECES);
  free(p->given);
  free(p->done);
  CHECK(LamScheduleDestroy(&s));
}

static void test_no_piece_is_lost_or_done_twice(void **state)
{
  static Play play;

  Run(&play);
}

static void test_same_events_same_decisions(void **state)
{
  static Play one, other;

  Run(&one);
  Run(&other);
  assert_true(one.log && one.log == other.log);
}

/* ---- whole runs, simulated, where messages cost nothing ---- */

static const Costs nothing = {.bandwidth = 1e300, .bundle_bytes = 1, .answer = 1e-9, .answer_root = 1e-9};

static Outcome Simulate(const Case *c, WorkTable *table)
{
  Outcome outcome;

  table->factorisation = 1e-9; /* messages are answered at once */
  CHECK(SimulateJobs(c, &nothing, table, NULL, &outcome));
  assert_int_equal(outcome.records, c->samples);
  DestroyWorkTable(table);
  return outcome;
}

static void test_equal_pieces_end_together(void **state)
{
  static const PetscInt ranks[] = {1, 2, 3, 8, 100, 300};

  for (int k = 0; k < 6; k++) {
    const Case c = {
        .ranks = ranks[k], .group = 128, .samples = 1000, .scale = 1, .jobs = 1, .machine = 1, .open_rounds = 1};
    const PetscInt on_busiest = k == 5 ? 4 : (1000 + ranks[k] - 1) / ranks[k]; /* rank 0 of 300 does not work */
    WorkTable table;

    CHECK(EqualWorkTable(0.02, &table));
    assert_true(fabs(Simulate(&c, &table).seconds - 0.02 * on_busiest) < 1e-6);
  }
}

/* Graham's bound against what no schedule can beat, with exact predictions. */
static void test_longest_first_ends_within_four_thirds(void **state)
{
  for (uint64_t seed = 1; seed <= 20; seed++) {
    const Case c = {
        .ranks = 7, .group = 128, .samples = 70, .scale = 1, .jobs = 1, .machine = 1, .open_rounds = 1, .seed = seed};
    float figures[WORK_CLASSES][2];
    Outcome outcome;
    WorkTable table;

    for (int i = 0; i < WORK_CLASSES; i++) figures[i][0] = figures[i][1] = (float)(1 << i % 8);
    CHECK(FiguresWorkTable(WORK_CLASSES, figures, 1, &table));
    outcome = Simulate(&c, &table);
    assert_true(outcome.seconds <= 4.0 / 3.0 * PetscMax(0.128, outcome.busy * outcome.seconds));
  }
}

static void test_a_slow_rank_holds_nobody_up(void **state)
{
  const Case c = {.ranks = 100,
                  .group = 128,
                  .samples = 20000,
                  .scale = 1,
                  .jobs = 1,
                  .open_rounds = 1,
                  .machine = 1,
                  .seed = 3,
                  .speeds = SPEED_SLOW};
  WorkTable table;

  CHECK(EqualWorkTable(0.02, &table));
  assert_true(Simulate(&c, &table).seconds < 1.03 * 20000 * 0.02 / 99);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_longest_first),
      cmocka_unit_test(test_fewer_ahead_at_the_end),
      cmocka_unit_test(test_capacity),
      cmocka_unit_test(test_slow_rank_gets_the_shortest),
      cmocka_unit_test(test_second_copy_of_a_slow_ranks_last_piece),
      cmocka_unit_test(test_second_copy_of_what_waits_behind_a_long_piece),
      cmocka_unit_test(test_no_piece_is_lost_or_done_twice),
      cmocka_unit_test(test_same_events_same_decisions),
      cmocka_unit_test(test_equal_pieces_end_together),
      cmocka_unit_test(test_longest_first_ends_within_four_thirds),
      cmocka_unit_test(test_a_slow_rank_holds_nobody_up),
  };

  cmocka_set_message_output(CM_OUTPUT_STDOUT);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
