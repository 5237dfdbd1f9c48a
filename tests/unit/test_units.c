/* Quantities with units. */
#include "support/test.h"
#include "test_scene_message.h"

static void AssertSI(const char text[], LamDimension dimension, PetscReal expected)
{
  PetscReal si = NAN;

  assert_int_equal(LamQuantityParse(text, dimension, &si), 0);
  if (!(fabs(si - expected) <= 1e-14 * fabs(expected))) fail_msg("%s is %.17g, not %.17g", text, si, expected);
}

static void AssertRefused(const char text[], LamDimension dimension, const char fragment[])
{
  PetscReal si;
  PetscErrorCode error;

  CATCH(LamQuantityParse(text, dimension, &si), error);
  if (error != PETSC_ERR_USER_INPUT) fail_msg("%s: error %d", text, error);
  if (!strstr(scene_message, fragment)) fail_msg("%s: \"%s\" lacks \"%s\"", text, scene_message, fragment);
}

TEST(lengths_become_metres)
{
  AssertSI("75 um", LAM_DIMENSION_LENGTH, 75e-6);
  AssertSI("11.25um", LAM_DIMENSION_LENGTH, 11.25e-6);
  AssertSI("75 \xc2\xb5m", LAM_DIMENSION_LENGTH, 75e-6); /* micro sign */
  AssertSI("  -1e1 mm ", LAM_DIMENSION_LENGTH, -0.01);
  AssertSI("2 inches", LAM_DIMENSION_LENGTH, 0.0508);
}

TEST(stresses_become_pascals)
{
  AssertSI("0.02 MPa", LAM_DIMENSION_STRESS, 0.02e6);
  AssertSI("+2 bar", LAM_DIMENSION_STRESS, 2e5);
  AssertSI(".5 N/mm2", LAM_DIMENSION_STRESS, 0.5e6);
  AssertSI("3.kPa", LAM_DIMENSION_STRESS, 3e3);
  AssertSI("0 MPa", LAM_DIMENSION_STRESS, 0.0);
}

TEST(angles_become_radians)
{
  AssertSI("30 deg", LAM_DIMENSION_ANGLE, PETSC_PI / 6);
  AssertSI("180 degrees", LAM_DIMENSION_ANGLE, PETSC_PI);
  AssertSI("0.5 rad", LAM_DIMENSION_ANGLE, 0.5);
}

TEST(times_become_seconds)
{
  AssertSI("2 h", LAM_DIMENSION_TIME, 7200);
  AssertSI("14 day", LAM_DIMENSION_TIME, 14 * 86400.0);
  AssertSI("1 week", LAM_DIMENSION_TIME, 7 * 86400.0);
}

TEST(temperatures_become_kelvins)
{
  AssertSI("20 degC", LAM_DIMENSION_TEMPERATURE, 293.15);
  AssertSI("-18 celsius", LAM_DIMENSION_TEMPERATURE, 255.15);
  AssertSI("68 degF", LAM_DIMENSION_TEMPERATURE, 293.15);
  AssertSI("300 K", LAM_DIMENSION_TEMPERATURE, 300);
}

TEST(rates_may_be_written_by_their_time)
{
  AssertSI("0.161 /min", LAM_DIMENSION_RATE, 0.161 / 60);
  AssertSI("2 1/day", LAM_DIMENSION_RATE, 2 / 86400.0);
  AssertSI("3 s-1", LAM_DIMENSION_RATE, 3);
  AssertSI("5 Hz", LAM_DIMENSION_RATE, 5);
}

TEST(energies_and_permeabilities_are_converted)
{
  AssertSI("138 kJ/mol", LAM_DIMENSION_MOLAR_ENERGY, 138e3);
  AssertSI("1e-7 m/s/MPa", LAM_DIMENSION_PERMEABILITY, 1e-13);
  AssertSI("2 um s-1 bar-1", LAM_DIMENSION_PERMEABILITY, 2e-11);
  AssertSI("1e-10 m^2/s/MPa", LAM_DIMENSION_CONDUCTIVITY, 1e-16);
}

TEST(energies_per_area_and_stresses_per_length_are_converted)
{
  AssertSI("1.5 J/m^2", LAM_DIMENSION_AREAL_ENERGY, 1.5);
  AssertSI("20 mJ/m2", LAM_DIMENSION_AREAL_ENERGY, 0.02);
  AssertSI("0.001 N/mm", LAM_DIMENSION_AREAL_ENERGY, 1);
  AssertSI("2 MPa um", LAM_DIMENSION_AREAL_ENERGY, 2);
  AssertSI("1e3 MPa/mm", LAM_DIMENSION_STIFFNESS, 1e12);
  AssertSI("2 N/mm^3", LAM_DIMENSION_STIFFNESS, 2e9);
}

TEST(energies_per_area_are_no_stresses)
{
  AssertRefused("1 J/m^3", LAM_DIMENSION_AREAL_ENERGY, "is not a unit of energy per area");
  AssertRefused("1 j/m^2", LAM_DIMENSION_AREAL_ENERGY, "did you mean J/m^2?");
  AssertRefused("1 MPa", LAM_DIMENSION_STIFFNESS, "write a stress per length with its unit, such as 1000 MPa/mm");
}

TEST(an_offset_belongs_to_temperatures_alone)
{
  AssertRefused("1 kJ/degC", LAM_DIMENSION_MOLAR_ENERGY, "is not a unit of molar energy");
  AssertRefused("20 degC", LAM_DIMENSION_LENGTH, "is not a unit of length");
  AssertRefused("5 /m", LAM_DIMENSION_RATE, "is not a unit of time");
  AssertRefused("5 //s", LAM_DIMENSION_RATE, "unknown");
}

TEST(missing_and_unknown_units_are_refused)
{
  AssertRefused("0.02", LAM_DIMENSION_STRESS, "has no unit; write a stress with its unit, such as 0.1 MPa");
  AssertRefused("0.02 MPx", LAM_DIMENSION_STRESS, "unknown");
  AssertRefused("2 3 MPa", LAM_DIMENSION_STRESS, "unknown");
  AssertRefused("MPa", LAM_DIMENSION_STRESS, "is not a number with a unit");
  AssertRefused("", LAM_DIMENSION_STRESS, "is not a number with a unit");
  AssertRefused("- 1 MPa", LAM_DIMENSION_STRESS, "is not a number with a unit");
}

TEST(other_dimensions_are_refused)
{
  AssertRefused("1 mm", LAM_DIMENSION_STRESS, "is not a unit of stress");
  AssertRefused("1 MPa", LAM_DIMENSION_LENGTH, "is not a unit of length");
  AssertRefused("1 N", LAM_DIMENSION_STRESS, "is not a unit of stress");
}

TEST(a_zero_in_a_unit_is_refused)
{
  AssertRefused("1 a.0MPa", LAM_DIMENSION_STRESS, "the unit \"a.0MPa\" is unknown");
  AssertRefused("1 MPa/0 m", LAM_DIMENSION_STRESS, "the unit \"MPa/0 m\" is unknown");
}

/* udunits2 itself converts all of these */
TEST(lookalike_units_are_refused)
{
  AssertRefused("1 m-1", LAM_DIMENSION_LENGTH, "is not a unit of length");
  AssertRefused("1 percent", LAM_DIMENSION_ANGLE, "is not a unit of angle");
  AssertRefused("1 sr", LAM_DIMENSION_ANGLE, "is not a unit of angle");
  AssertRefused("1 MPa @ 5", LAM_DIMENSION_STRESS, "is not a unit of stress");
  AssertRefused("1 lg(re 1 MPa)", LAM_DIMENSION_STRESS, "is not a unit of stress");
}

TEST(non_finite_numbers_are_refused)
{
  AssertRefused("nan MPa", LAM_DIMENSION_STRESS, "is not a finite number");
  AssertRefused(".inf", LAM_DIMENSION_STRESS, "is not a finite number");
  AssertRefused("-Infinity MPa", LAM_DIMENSION_STRESS, "is not a finite number");
  AssertRefused("1e999 MPa", LAM_DIMENSION_STRESS, "is too large");
  AssertRefused("1e305 MPa", LAM_DIMENSION_STRESS, "is too large");
}

TEST(hexadecimal_numbers_are_refused)
{
  AssertRefused("0x10 MPa", LAM_DIMENSION_STRESS, "unknown");
  AssertRefused("0x10", LAM_DIMENSION_STRESS, "unknown");
}

TEST_IS(the_message_shows_the_text, AssertRefused("7 furlongs%n%s", LAM_DIMENSION_STRESS, "7 furlongs%n%s: "));
