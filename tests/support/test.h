/*
  Tests of a program, on cmocka: those that TEST defines run in the order of the file, without a list of them; main is
  in test.c.

    TEST(name) { ... }
    TEST_IS(name, statement);                             where one statement is all of it
    TEST_ON(name, type, object, enter, leave) { ... }     on a `type *object` that one statement makes and one unmakes
    TEST_WITH(name, enter, leave) { ... }                 its own set-up and tear-down, or NULL
    TEST_GROUP(.petsc = 1, .setup = s, .teardown = t);    once, where the program needs PETSc or has a set-up of all
    TEST_FIXTURE_NEEDS_PETSC;                             in a fixture: programs that use it need PETSc
*/
#ifndef LAM_SUPPORT_TEST_H
#define LAM_SUPPORT_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

typedef struct TestEntry {
  struct CMUnitTest test;
  struct TestEntry *next;
} TestEntry;

typedef struct {
  int petsc; /* PetscInitialize before the tests, PetscFinalize behind them */
  CMFixtureFunction setup, teardown;
} TestGroup;

void TestRegister(TestEntry *entry);
extern const TestGroup TestProgram;
extern int TestFixtureNeedsPetsc;

#define TEST_WITH(name, enter, leave)                                                                                  \
  static void name(void **state);                                                                                      \
  static __attribute__((constructor)) void name##_register(void)                                                       \
  {                                                                                                                    \
    static TestEntry entry = {{#name, name, enter, leave, NULL}, NULL};                                                \
                                                                                                                       \
    TestRegister(&entry);                                                                                              \
  }                                                                                                                    \
  static void name(void **state)
#define TEST(name) TEST_WITH(name, NULL, NULL)
#define TEST_IS(name, ...)                                                                                             \
  TEST(name)                                                                                                           \
  {                                                                                                                    \
    __VA_ARGS__;                                                                                                       \
  }                                                                                                                    \
  extern const TestGroup TestProgram /* takes the semicolon */
#define TEST_ON(name, type, object, enter, leave)                                                                      \
  static void name##_on(type *object);                                                                                 \
  TEST(name)                                                                                                           \
  {                                                                                                                    \
    type made, *object = &made;                                                                                        \
                                                                                                                       \
    enter;                                                                                                             \
    name##_on(object);                                                                                                 \
    leave;                                                                                                             \
  }                                                                                                                    \
  static void name##_on(type *object)
#define TEST_GROUP(...) const TestGroup TestProgram = {__VA_ARGS__}
#define TEST_FIXTURE_NEEDS_PETSC                                                                                       \
  static __attribute__((constructor)) void NeedPetsc(void)                                                             \
  {                                                                                                                    \
    TestFixtureNeedsPetsc = 1;                                                                                         \
  }                                                                                                                    \
  extern int TestFixtureNeedsPetsc /* takes the semicolon */

/* OWNED(Table, TableClose) t = ...: `TableClose(&t)` where the block ends. */
#define OWNED(type, leave) type __attribute__((cleanup(leave)))

#define CHECK(call) assert_int_equal((call), 0)

/* cmocka's assert_float_equal rounds to single precision. */
#define assert_near(value, expected, tolerance)                                                                        \
  do {                                                                                                                 \
    const double near_value_ = (value), near_expected_ = (expected), near_tolerance_ = (tolerance);                    \
                                                                                                                       \
    if (!(fabs(near_value_ - near_expected_) <= near_tolerance_))                                                      \
      fail_msg("%s is %.17g, expected %.17g: off by %.3g, more than %.3g", #value, near_value_, near_expected_,        \
               fabs(near_value_ - near_expected_), near_tolerance_);                                                   \
  } while (0)

#endif
