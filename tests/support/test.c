/* main of the tests' programs. */
#include "test.h"
#include <petscsys.h>
#include <stdlib.h>

static TestEntry *First, **Last = &First;

int TestFixtureNeedsPetsc;
__attribute__((weak)) const TestGroup TestProgram = {0};

void TestRegister(TestEntry *entry)
{
  *Last = entry;
  Last = &entry->next;
}

static int RunAll(const char name[])
{
  struct CMUnitTest *tests;
  size_t n = 0;
  int failed;

  for (const TestEntry *t = First; t; t = t->next) n++;
  tests = malloc((n + 1) * sizeof(*tests));
  n = 0;
  for (const TestEntry *t = First; t; t = t->next) tests[n++] = t->test;
  cmocka_set_message_output(CM_OUTPUT_STDOUT);
  failed = n ? _cmocka_run_group_tests(name, tests, n, TestProgram.setup, TestProgram.teardown) : 1;
  free(tests);
  return failed;
}

int main(int argc, char **argv)
{
  const int petsc = TestProgram.petsc || TestFixtureNeedsPetsc;
  int failed;

  if (petsc && PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = RunAll(argv[0]);
  if (petsc && PetscFinalize()) return 1;
  return failed;
}
