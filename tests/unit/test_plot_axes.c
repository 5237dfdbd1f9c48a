/* Ticks, numbers, axes and the load axis of the pictures. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "plot.h"

static const PetscReal Ranges[][2] = {{0, 1},        {-0.012, 0.0671}, {0.92, 1.085},
                                      {-3e-5, 8e-5}, {1e6, 7.3e6},     {-1, -0.98}};
static const size_t RangeCount = sizeof Ranges / sizeof Ranges[0];

static void ticks_lie_inside_the_limits(void **state)
{
  for (size_t i = 0; i < RangeCount; i++) {
    const PetscReal slack = 1e-6 * (Ranges[i][1] - Ranges[i][0]);
    const LamTicks t = LamTicksChoose(Ranges[i][0], Ranges[i][1], 6, PETSC_FALSE);

    assert_true(t.first >= Ranges[i][0] - slack);
    assert_true(t.first + (t.count - 1) * t.step <= Ranges[i][1] + slack);
  }
}

static void ticks_are_about_as_many_as_wanted(void **state)
{
  for (size_t i = 0; i < RangeCount; i++) {
    const LamTicks t = LamTicksChoose(Ranges[i][0], Ranges[i][1], 6, PETSC_FALSE);

    assert_in_range(t.count, 3, 10);
  }
}

static void tick_steps_are_1_2_or_5(void **state)
{
  for (size_t i = 0; i < RangeCount; i++) {
    const LamTicks t = LamTicksChoose(Ranges[i][0], Ranges[i][1], 6, PETSC_FALSE);
    const PetscReal digit = t.step / pow(10, floor(log10(t.step) + 1e-9));

    assert_true(fabs(digit - 1) < 1e-6 || fabs(digit - 2) < 1e-6 || fabs(digit - 5) < 1e-6);
  }
}

static void a_limit_that_is_a_tick_is_kept(void **state)
{
  const LamTicks t = LamTicksChoose(0, 0.3, 3, PETSC_FALSE);

  assert_int_equal(t.count, 4);
}

static void whole_axes_have_whole_ticks(void **state)
{
  const LamTicks t = LamTicksChoose(0.9, 3.1, 10, PETSC_TRUE);

  assert_true(t.step == 1);
}

static void tick_labels_have_the_decimals_they_need(void **state)
{
  const LamTicks t = LamTicksChoose(-0.05, 0.05, 4, PETSC_FALSE);
  char text[32];

  LamTicksFormat(&t, 0, text);
  assert_string_equal(text, "\u22120.04");
}

static void tiny_values_get_a_power_of_ten(void **state)
{
  const LamTicks t = LamTicksChoose(0, 8e-5, 4, PETSC_FALSE);
  const LamAxis axis = {.label = "P", .unit = "MPa", .ticks = t};
  char text[64];

  LamAxisLabel(&axis, sizeof text, text);
  assert_string_equal(text, "P (10^{\u22126} MPa)");
}

static void the_label_of_a_tiny_value_is_its_mantissa(void **state)
{
  const LamTicks t = LamTicksChoose(0, 8e-5, 4, PETSC_FALSE);
  char text[32];

  LamTicksFormat(&t, 1, text);
  assert_string_equal(text, "20");
}

static void ticks_of_logarithms_show_the_number(void **state)
{
  LamTicks t = LamTicksChoose(-2, 1, 6, PETSC_TRUE);
  char text[32];

  t.is_log = PETSC_TRUE;
  LamTicksFormat(&t, 0, text);
  assert_string_equal(text, "0.01");
}

static void a_constant_gets_an_axis_around_it(void **state)
{
  LamAxis axis = {.low = 0.2, .high = 0.2};

  LamAxisPad(&axis);
  assert_true(axis.low < 0.2 && axis.high > 0.2);
}

static void numbers_have_a_true_minus_sign(void **state)
{
  char text[32];

  LamFormatNumber(-0.0125, text);
  assert_string_equal(text, "\u22120.0125");
}

/* ---- load axis ---- */

static const LamScales Scales = {75e-6, 0.11e6, 0};

static void choose(PetscInt n, const LamResponse records[], LamLoadAxis *axis, PetscReal values[])
{
  const PetscInt64 keys[] = {1, 2, 3};

  assert_int_equal(LamLoadAxisChoose(n, records, keys, &Scales, axis, values), 0);
}

/* Three states at F = I. */
static void identity(LamResponse records[3])
{
  memset(records, 0, 3 * sizeof *records);
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 9; i += 4) records[k].load.F[i] = 1;
}

static void shear_is_drawn_over_its_component(void **state)
{
  LamResponse records[3];
  LamLoadAxis axis;
  PetscReal values[3];

  identity(records);
  for (int k = 0; k < 3; k++) records[k].load.F[1] = 0.1 * (k + 1);
  choose(3, records, &axis, values);
  assert_string_equal(axis.label, "$F$_{12}");
  assert_true(values[2] == records[2].load.F[1]);
}

static void a_proportional_path_is_drawn_over_its_norm(void **state)
{
  LamResponse records[3];
  LamLoadAxis axis;
  PetscReal values[3];

  identity(records);
  for (int k = 0; k < 3; k++) {
    records[k].load.F[0] = 1 + 0.03 * (k + 1);
    records[k].load.F[4] = 1 - 0.04 * (k + 1);
  }
  choose(3, records, &axis, values);
  assert_true(fabs(values[1] - 0.1) < 1e-12);
}

static void turgor_is_drawn_in_megapascal(void **state)
{
  LamResponse records[3];
  LamLoadAxis axis;
  PetscReal values[3];

  identity(records);
  for (int k = 0; k < 3; k++) records[k].load.turgor = 0.1 * k;
  choose(3, records, &axis, values);
  assert_string_equal(axis.label, "turgor $p$");
  assert_true(fabs(values[2] - 0.022) < 1e-12);
}

static void loading_and_unloading_is_drawn_over_the_state(void **state)
{
  LamResponse records[3];
  LamLoadAxis axis;
  PetscReal values[3];

  identity(records);
  records[1].load.F[1] = 0.1;
  choose(3, records, &axis, values);
  assert_string_equal(axis.label, "state");
  assert_true(values[2] == 3);
}

static void a_load_that_varies_in_two_ways_is_drawn_over_the_state(void **state)
{
  LamResponse records[3];
  LamLoadAxis axis;
  PetscReal values[3];

  identity(records);
  for (int k = 0; k < 3; k++) records[k].load.F[1] = records[k].load.turgor = 0.1 * k;
  choose(3, records, &axis, values);
  assert_string_equal(axis.label, "state");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ticks_lie_inside_the_limits),
      cmocka_unit_test(ticks_are_about_as_many_as_wanted),
      cmocka_unit_test(tick_steps_are_1_2_or_5),
      cmocka_unit_test(a_limit_that_is_a_tick_is_kept),
      cmocka_unit_test(whole_axes_have_whole_ticks),
      cmocka_unit_test(tick_labels_have_the_decimals_they_need),
      cmocka_unit_test(tiny_values_get_a_power_of_ten),
      cmocka_unit_test(the_label_of_a_tiny_value_is_its_mantissa),
      cmocka_unit_test(ticks_of_logarithms_show_the_number),
      cmocka_unit_test(a_constant_gets_an_axis_around_it),
      cmocka_unit_test(numbers_have_a_true_minus_sign),
      cmocka_unit_test(shear_is_drawn_over_its_component),
      cmocka_unit_test(a_proportional_path_is_drawn_over_its_norm),
      cmocka_unit_test(turgor_is_drawn_in_megapascal),
      cmocka_unit_test(loading_and_unloading_is_drawn_over_the_state),
      cmocka_unit_test(a_load_that_varies_in_two_ways_is_drawn_over_the_state),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
