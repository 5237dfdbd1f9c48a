/* Factorisation without pivoting, against dense eigenvalues and residuals at random patterns. */
#include <petscsys.h>
#include <petscblaslapack.h>
#include "support/random_reals.h"
#include "support/rve_fixture.h"
#include "ldl.h"

#define N 41 /* odd: the last block has one unknown */
#define POSITIONS 32
#define LAST (N - POSITIONS)

typedef struct {
  PetscInt row[N + 1], column[N * N];
  double values[N * N], dense[N][N];
  LamLDL ldl;
} System;

/* A random pattern with a third of the entries of the positions, and all of the first `coupled`, with which the
   unknowns after them are coupled; these have `last` on the diagonal. */
static void SystemEnter(System *s, uint64_t *seed, double diagonal, PetscInt coupled, double last)
{
  PetscInt at = 0;

  memset(s, 0, sizeof(*s));
  for (PetscInt i = 0; i < N; ++i) {
    s->row[i] = at;
    for (PetscInt j = i; j < N; ++j) {
      double v = RandomReal(seed, -1, 1);

      if (j == i) v = i < POSITIONS ? diagonal + v : last;
      if (j < POSITIONS && j > i && (i >= coupled || j >= coupled) && RandomReal(seed, 0, 1) > 0.3) continue;
      if (j >= POSITIONS && j > i && i >= coupled) continue;
      s->column[at] = j;
      s->values[at++] = s->dense[i][j] = s->dense[j][i] = v;
    }
  }
  s->row[N] = at;
  assert_int_equal(LamLDLCreate(N, POSITIONS, s->row, s->column, s->values, &s->ldl), 0);
}

static void SystemLeave(System *s)
{
  assert_int_equal(LamLDLDestroy(&s->ldl), 0);
}

static PetscInt NegativeEigenvalues(const System *s)
{
  static double a[N][N], w[N], work[N * N];
  PetscBLASInt n = N, size = N * N, info;
  PetscInt negative = 0;

  memcpy(a, s->dense, sizeof(a));
  LAPACKsyev_("N", "L", &n, &a[0][0], &n, w, work, &size, &info);
  assert_int_equal(info, 0);
  for (PetscInt i = 0; i < N; ++i) negative += w[i] < 0;
  return negative;
}

/* Largest residual over the largest entry of the solution, of random right-hand sides, four of which fit into one
 * register.
 */
static double Residual(System *s, uint64_t *seed)
{
  static double b[5][N], x[5][N];
  double largest = 0;

  for (PetscInt k = 0; k < 5; ++k)
    for (PetscInt i = 0; i < N; ++i) b[k][i] = RandomReal(seed, -1, 1);
  assert_int_equal(LamLDLSolve(s->ldl, 5, &b[0][0], &x[0][0]), 0);
  for (PetscInt k = 0; k < 5; ++k)
    for (PetscInt i = 0; i < N; ++i) {
      double rest = b[k][i], size = 1;

      for (PetscInt j = 0; j < N; ++j) {
        rest -= s->dense[i][j] * x[k][j];
        size = fmax(size, fabs(x[k][j]));
      }
      largest = fmax(largest, fabs(rest) / size);
    }
  return largest;
}

static void CheckRandom(double diagonal, PetscInt coupled, double last, PetscInt least)
{
  uint64_t seed = 7;
  PetscInt sure = 0;

  for (PetscInt k = 0; k < 50; ++k) {
    System s;
    PetscInt negative;
    PetscBool ok, unsure;

    SystemEnter(&s, &seed, diagonal, coupled, last);
    assert_int_equal(LamLDLNumeric(s.ldl, N, &negative, &ok, &unsure), 0);
    if (ok) {
      ++sure;
      assert_int_equal(negative, NegativeEigenvalues(&s));
      assert_true(Residual(&s, &seed) < 1e-9);
    }
    SystemLeave(&s);
  }
  assert_true(sure >= least);
}

TEST(SolvesDefiniteSystems)
{
  CheckRandom(12, 0, 1, 50);
}

TEST(CountsNegativeEigenvaluesOfIndefiniteSystems)
{
  CheckRandom(0.5, 0, -1, 45);
}

TEST(SolvesConstrainedSystems)
{
  CheckRandom(12, POSITIONS, 0, 50);
}

/* Positions that only constraints hold have no pivots of their own. */
TEST(SolvesWhereConstraintsHoldWhatIsSoft)
{
  uint64_t seed = 3;
  System s;
  PetscInt negative;
  PetscBool ok, unsure;

  SystemEnter(&s, &seed, 12, LAST, 0);
  for (PetscInt i = 0; i < LAST; ++i)
    for (PetscInt j = i; j < POSITIONS; ++j) {
      s.dense[i][j] = s.dense[j][i] = i == j ? 1e-12 : 0;
      for (PetscInt k = s.row[i]; k < s.row[i + 1]; ++k)
        if (s.column[k] == j) s.values[k] = s.dense[i][j];
    }
  assert_int_equal(LamLDLNumeric(s.ldl, N, &negative, &ok, &unsure), 0);
  assert_true(ok);
  assert_int_equal(negative, LAST);
  assert_true(Residual(&s, &seed) < 1e-11);
  SystemLeave(&s);
}

TEST(StopsAtMoreNegativeEigenvaluesThanWanted)
{
  uint64_t seed = 1;
  System s;
  PetscInt negative;
  PetscBool ok, unsure;

  SystemEnter(&s, &seed, -12, 0, 1);
  assert_int_equal(LamLDLNumeric(s.ldl, 3, &negative, &ok, &unsure), 0);
  assert_false(ok);
  assert_false(unsure);
  assert_in_range(negative, 4, 5);
  SystemLeave(&s);
}

/* A system of two positions and others has no factor; whether because of rounding. */
static void AssertRefused(PetscInt n, const PetscInt row[], const PetscInt column[], const double values[],
                          PetscBool rounding)
{
  PetscInt negative;
  LamLDL ldl;
  PetscBool ok, unsure;

  assert_int_equal(LamLDLCreate(n, 2, row, column, values, &ldl), 0);
  assert_int_equal(LamLDLNumeric(ldl, n, &negative, &ok, &unsure), 0);
  assert_false(ok);
  assert_int_equal(unsure, rounding);
  assert_int_equal(LamLDLDestroy(&ldl), 0);
}

/* A pivot block [1e-9, 0; 0, 1e-9] beside entries of 1 leaves no digits of what follows. */
TEST(TellsWhereRoundingSpoilsTheFactor)
{
  const PetscInt row[5] = {0, 3, 6, 7, 8}, column[8] = {0, 2, 3, 1, 2, 3, 2, 3};

  AssertRefused(4, row, column, (const double[8]){1e-9, 1, 0.5, 1e-9, 0.25, 1, 1e-3, 1e-3}, PETSC_TRUE);
}

TEST(TellsASingularSystem)
{
  const PetscInt row[4] = {0, 2, 3, 4}, column[4] = {0, 1, 1, 2};

  AssertRefused(3, row, column, (const double[4]){1, 1, 1, 1}, PETSC_FALSE);
}

TEST_GROUP(.petsc = 1);
