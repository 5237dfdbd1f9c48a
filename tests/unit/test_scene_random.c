/* Chance in scenes: the same everywhere, and of the distribution that is asked for. Seeds are fixed, so nothing here
   fails by chance; the bounds are four standard errors of 64 x 64 cells, where cells are correlated of the areas that
   one value stands for. */
#include "support/test.h"
#include <lamella/lattice.h>
#include <scene_keys.h>

enum { SIDE = 64, COUNT = SIDE * SIDE };
#define LENGTH 2.0 /* of correlation */

static const LamMicrostructure period = {.cells = {SIDE, SIDE}};
static const LamMicrostructure patch = {.is_patch = PETSC_TRUE, .cells = {SIDE, SIDE}};

static void Draw(const LamMicrostructure *micro, PetscReal correlation, PetscReal variation, PetscReal factors[])
{
  assert_int_equal(LamRandomFactors(micro, 11, correlation, 1, &variation, factors), 0);
}

/* Standard normal numbers behind factors. */
static void TakeLogarithms(PetscReal variation, PetscReal factors[])
{
  const double s2 = log1p(variation * variation);

  for (int c = 0; c < COUNT; c++) factors[c] = (log(factors[c]) + 0.5 * s2) / sqrt(s2);
}

/* From an independent program (splitmix64 starts with 0xE220A8397B1DCDAF for seed 0 there). */
TEST(factors_are_the_same_on_every_machine)
{
  const LamMicrostructure micro = {.cells = {2, 2}};
  const double expected[] = {1.284945, 0.906523, 0.981455, 0.874069, 0.398237, 2.369333, 1.023638, 0.70095};
  const PetscReal variation[2] = {0.2, 0.5};
  PetscReal factors[8];

  assert_int_equal(LamRandomFactors(&micro, 7, 0.0, 2, variation, factors), 0);
  for (int k = 0; k < 8; k++) assert_near(factors[k], expected[k], 1e-12);
}

TEST(factors_have_mean_one_and_the_variation_asked_for)
{
  const PetscReal variation = 0.3;
  static PetscReal factors[COUNT];
  double sum = 0, square = 0;

  Draw(&period, 0.0, variation, factors);
  for (int c = 0; c < COUNT; c++) {
    sum += factors[c];
    square += (factors[c] - 1) * (factors[c] - 1);
  }
  assert_near(sum / COUNT, 1.0, 4 * variation / SIDE);
  assert_near(sqrt(square / COUNT), variation, 4 * variation / SIDE);
}

/* Mean of z(c) z(c + step along lattice vector 0) in a period. */
static double Correlation(const PetscReal z[], int step)
{
  double sum = 0;

  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) sum += z[i * SIDE + j] * z[(i + step) % SIDE * SIDE + j];
  return sum / COUNT;
}

TEST(neighbours_are_correlated_as_far_as_asked_for)
{
  static PetscReal z[COUNT];
  const double bound = 4 * LENGTH * sqrt(PETSC_PI / 2) / SIDE;

  Draw(&period, LENGTH, 0.2, z);
  TakeLogarithms(0.2, z);
  for (int step = 0; step <= 4; step++) {
    assert_near(Correlation(z, step), exp(-step * step / (LENGTH * LENGTH)), bound);
  }
}

TEST(without_correlation_neighbours_are_independent)
{
  static PetscReal z[COUNT];

  Draw(&period, 0.0, 0.2, z);
  TakeLogarithms(0.2, z);
  assert_near(Correlation(z, 1), 0.0, 4.0 / SIDE);
}

/* At the edges of a patch, where part of the noise is missing, as inside. */
TEST(a_patch_has_unit_variance_everywhere)
{
  static PetscReal z[COUNT];
  double edge = 0, square = 0;

  Draw(&patch, LENGTH, 0.2, z);
  TakeLogarithms(0.2, z);
  for (int i = 0; i < SIDE; i++) edge += (z[i * SIDE] * z[i * SIDE] + z[i * SIDE + SIDE - 1] * z[i * SIDE + SIDE - 1]);
  for (int c = 0; c < COUNT; c++) square += z[c] * z[c];
  assert_near(edge / (2 * SIDE), 1.0, 4 * sqrt(2 * LENGTH * sqrt(PETSC_PI / 2) / (2 * SIDE)));
  assert_near(square / COUNT, 1.0, 4 * LENGTH * sqrt(PETSC_PI / 2) / SIDE);
}

/* Cells of a period that is much shorter than the correlation are the same. */
TEST(a_short_period_varies_as_a_whole)
{
  const LamMicrostructure micro = {.cells = {2, 2}};
  const PetscReal variation = 0.5;
  PetscReal factors[4];

  assert_int_equal(LamRandomFactors(&micro, 3, 10.0, 1, &variation, factors), 0);
  for (int c = 1; c < 4; c++) assert_near(factors[c], factors[0], 1e-5);
  assert_true(fabs(factors[0] - 1) > 1e-3);
}
