/* Ticks, numbers, axes and the load axis of the pictures. */
#include "support/test.h"
#include <string.h>
#include "plot.h"

static const PetscReal Ranges[][2] = {{0, 1},        {-0.012, 0.0671}, {0.92, 1.085},
                                      {-3e-5, 8e-5}, {1e6, 7.3e6},     {-1, -0.98}};
static const size_t RangeCount = sizeof Ranges / sizeof Ranges[0];

TEST(ticks_lie_inside_the_limits)
{
  for (size_t i = 0; i < RangeCount; i++) {
    const PetscReal slack = 1e-6 * (Ranges[i][1] - Ranges[i][0]);
    const LamTicks t = LamTicksChoose(Ranges[i][0], Ranges[i][1], 6, PETSC_FALSE);

    assert_true(t.first >= Ranges[i][0] - slack);
    assert_true(t.first + (t.count - 1) * t.step <= Ranges[i][1] + slack);
  }
}

TEST(ticks_are_about_as_many_as_wanted)
{
  for (size_t i = 0; i < RangeCount; i++) {
    const LamTicks t = LamTicksChoose(Ranges[i][0], Ranges[i][1], 6, PETSC_FALSE);

    assert_in_range(t.count, 3, 10);
  }
}

TEST(tick_steps_are_1_2_or_5)
{
  for (size_t i = 0; i < RangeCount; i++) {
    const LamTicks t = LamTicksChoose(Ranges[i][0], Ranges[i][1], 6, PETSC_FALSE);
    const PetscReal digit = t.step / pow(10, floor(log10(t.step) + 1e-9));

    assert_true(fabs(digit - 1) < 1e-6 || fabs(digit - 2) < 1e-6 || fabs(digit - 5) < 1e-6);
  }
}

TEST_IS(a_limit_that_is_a_tick_is_kept, assert_int_equal(LamTicksChoose(0, 0.3, 3, PETSC_FALSE).count, 4));
TEST_IS(whole_axes_have_whole_ticks, assert_true(LamTicksChoose(0.9, 3.1, 10, PETSC_TRUE).step == 1));

static void assert_label(LamTicks ticks, int number, const char label[])
{
  char text[32];

  LamTicksFormat(&ticks, number, text);
  assert_string_equal(text, label);
}

TEST_IS(tick_labels_have_the_decimals_they_need,
        assert_label(LamTicksChoose(-0.05, 0.05, 4, PETSC_FALSE), 0, "\u22120.04"));
TEST_IS(the_label_of_a_tiny_value_is_its_mantissa, assert_label(LamTicksChoose(0, 8e-5, 4, PETSC_FALSE), 1, "20"));

TEST(tiny_values_get_a_power_of_ten)
{
  const LamTicks t = LamTicksChoose(0, 8e-5, 4, PETSC_FALSE);
  const LamAxis axis = {.label = "P", .unit = "MPa", .ticks = t};
  char text[64];

  LamAxisLabel(&axis, sizeof text, text);
  assert_string_equal(text, "P (10^{\u22126} MPa)");
}

TEST(ticks_of_logarithms_show_the_number)
{
  LamTicks t = LamTicksChoose(-2, 1, 6, PETSC_TRUE);

  t.is_log = PETSC_TRUE;
  assert_label(t, 0, "0.01");
}

TEST(a_constant_gets_an_axis_around_it)
{
  LamAxis a = {.low = 0.2, .high = 0.2};

  LamAxisPad(&a);
  assert_true(a.low < 0.2 && a.high > 0.2);
}

TEST(numbers_have_a_true_minus_sign)
{
  char text[32];

  LamFormatNumber(-0.0125, text);
  assert_string_equal(text, "\u22120.0125");
}

/* ---- load axis ---- */

static const LamScales Scales = {75e-6, 0.11e6, 0};

static LamResponse records[3];
static LamLoadAxis axis;
static PetscReal values[3];

static void choose(void)
{
  const PetscInt64 keys[] = {1, 2, 3};

  assert_int_equal(LamLoadAxisChoose(3, records, keys, &Scales, &axis, values), 0);
}

/* Three states at F = I. */
static void identity(void)
{
  memset(records, 0, sizeof records);
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 9; i += 4) records[k].load.F[i] = 1;
}

TEST(shear_is_drawn_over_its_component)
{
  identity();
  for (int k = 0; k < 3; k++) records[k].load.F[1] = 0.1 * (k + 1);
  choose();
  assert_string_equal(axis.label, "$F$_{12}");
  assert_true(values[2] == records[2].load.F[1]);
}

TEST(a_proportional_path_is_drawn_over_its_norm)
{
  identity();
  for (int k = 0; k < 3; k++) {
    records[k].load.F[0] = 1 + 0.03 * (k + 1);
    records[k].load.F[4] = 1 - 0.04 * (k + 1);
  }
  choose();
  assert_true(fabs(values[1] - 0.1) < 1e-12);
}

TEST(turgor_is_drawn_in_megapascal)
{
  identity();
  for (int k = 0; k < 3; k++) records[k].load.turgor = 0.1 * k;
  choose();
  assert_string_equal(axis.label, "turgor $p$");
  assert_true(fabs(values[2] - 0.022) < 1e-12);
}

TEST(loading_and_unloading_is_drawn_over_the_state)
{
  identity();
  records[1].load.F[1] = 0.1;
  choose();
  assert_string_equal(axis.label, "state");
  assert_true(values[2] == 3);
}

TEST(a_load_that_varies_in_two_ways_is_drawn_over_the_state)
{
  identity();
  for (int k = 0; k < 3; k++) records[k].load.F[1] = records[k].load.turgor = 0.1 * k;
  choose();
  assert_string_equal(axis.label, "state");
}
