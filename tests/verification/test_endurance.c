/* Many states of every kind in one process, failures among them, leave nothing behind. */
#include "support/rve_fixture.h"
#include "support/endurance.h"

#define ROUND 60 /* states between two looks at the memory: six failures of each of the cheap kinds in all */
#define ROUNDS 5
#define SLACK 4096 /* bytes: of the library of C */

static void Solve(Endurance *e, PetscInt from, PetscInt to)
{
  LamResponse r;

  for (PetscInt k = from; k < to; k++)
    if (k % 10 == 8)
      assert_int_equal(EnduranceFail(e, EnduranceFailureOf(k, 1000), k, &r), 0);
    else
      assert_int_equal(EnduranceSolve(e, EnduranceKindOf(k, 30), k, &r), 0);
}

/* All that fails only after many iterations. */
static void FailDearly(Endurance *e)
{
  LamResponse r;

  for (int f = FAILURE_COLLAPSE; f < FAILURE_COUNT; f++)
    assert_int_equal(EnduranceFail(e, (EnduranceFailure)f, 0, &r), 0);
}

static void MemoryDoesNotGrow(void **state)
{
  OWNED(Endurance, EnduranceDestroy) e;
  size_t before;

  assert_int_equal(EnduranceCreate(&e), 0);
  FailDearly(&e);
  Solve(&e, 0, 2 * ROUND);
  before = MemoryInUse();
  for (int k = 2; k < 2 + ROUNDS; k++) Solve(&e, k * ROUND, (k + 1) * ROUND);
  FailDearly(&e);
  assert_int_equal(e.unexpected, 0);
  assert_in_range(MemoryInUse(), 0, before + SLACK);
}

/* What is created and destroyed leaves nothing. */
static void TissuesAreFreed(void **state)
{
  size_t before = 0;

  for (int k = 0; k < 6; k++) {
    Endurance e;

    assert_int_equal(EnduranceCreate(&e), 0);
    Solve(&e, 0, 10);
    assert_int_equal(EnduranceDestroy(&e), 0);
    if (k == 1) before = MemoryInUse();
  }
  assert_in_range(MemoryInUse(), 0, before + SLACK);
}

static int Run(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(MemoryDoesNotGrow), cmocka_unit_test(TissuesAreFreed)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What free() keeps for its own thread counts as in use; so it must keep nothing, which it is told before it starts. */
int main(int argc, char **argv)
{
  int failed;

  if (!getenv("GLIBC_TUNABLES")) {
    setenv("GLIBC_TUNABLES", "glibc.malloc.tcache_count=0", 1);
    execv("/proc/self/exe", argv);
  }
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = Run();
  return PetscFinalize() || failed;
}
