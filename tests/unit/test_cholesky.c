/* Small definite systems without pivots, and what is not definite. */
#include "support/rve_fixture.h"
#include "cholesky.h"

#define N 5

/* Tridiagonal with 2 + shift on the diagonal and -1 beside it. */
static PetscInt row[N + 1] = {0, 2, 4, 6, 8, 9}, column[9] = {0, 1, 1, 2, 2, 3, 3, 4, 4};

static void SetValues(double diagonal, double values[9])
{
  for (int k = 0; k < 9; k++) values[k] = k % 2 ? -1 : diagonal;
}

TEST(SolvesADefiniteSystem)
{
  const double x[2 * N] = {1, -2, 3, 0.5, 4, 0, 1, 0, -1, 2};
  double values[9], b[2 * N], found[2 * N];
  PetscBool definite;
  OWNED(LamCholesky, LamCholeskyDestroy) c;

  SetValues(2.5, values);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < N; i++)
      b[k * N + i] = 2.5 * x[k * N + i] - (i > 0 ? x[k * N + i - 1] : 0) - (i < N - 1 ? x[k * N + i + 1] : 0);
  assert_int_equal(LamCholeskyCreate(N, row, column, values, &c), 0);
  assert_int_equal(LamCholeskyNumeric(c, &definite), 0);
  assert_true(definite);
  assert_int_equal(LamCholeskySolve(c, 2, b, found), 0);
  for (int i = 0; i < 2 * N; i++) assert_near(found[i], x[i], 1e-14);
}

/* The values change in place: an indefinite and a singular matrix are told, and a definite one after them is solved. */
TEST(TellsWhatIsNotDefinite)
{
  static const double diagonal[4] = {1.0, 0.0, -3.0, 2.5};
  double values[9] = {0};
  PetscBool definite;
  OWNED(LamCholesky, LamCholeskyDestroy) c;

  assert_int_equal(LamCholeskyCreate(N, row, column, values, &c), 0);
  for (int k = 0; k < 4; k++) {
    SetValues(diagonal[k], values);
    assert_int_equal(LamCholeskyNumeric(c, &definite), 0);
    assert_int_equal(definite, k == 3);
  }
}

TEST_GROUP(.petsc = 1);
