/* Kinetic laws: rates at a temperature, and their derivatives. */
#include "support/test.h"
#include <lamella/kinetics.h>

#define ZERO_CELSIUS 273.15

static LamKinetics Law(LamKineticLaw law)
{
  const LamRate rate = {.rate = 0.3, .activation = 60e3, .reference = 293.15, .half_activity = 293.15};

  return (LamKinetics){.law = law, .rate = rate, .second = rate, .plateau = 0.2, .share = 0.7, .enzyme = 0.1};
}

/* Lee 2017 gives 0.161 /min at 100 degC with 138 kJ/mol; at 90 degC that is by hand 0.0473. */
TEST(a_rate_follows_arrhenius)
{
  const LamRate rate = {.rate = 0.161, .activation = 138e3, .reference = ZERO_CELSIUS + 100};
  const PetscReal T = ZERO_CELSIUS + 90;

  assert_near(LamRateAt(&rate, T), 0.161 * exp(-138e3 / 8.31446261815324 * (1 / T - 1 / rate.reference)), 1e-15);
  assert_near(LamRateAt(&rate, T), 0.0473, 0.0001);
}

TEST(a_deactivated_rate_is_given_at_its_reference_and_falls_beyond)
{
  const LamRate rate = {.rate = 0.5,
                        .activation = 60e3,
                        .deactivation = 300e3,
                        .reference = ZERO_CELSIUS + 20,
                        .half_activity = ZERO_CELSIUS + 35};

  assert_near(LamRateAt(&rate, rate.reference), 0.5, 1e-15);
  assert_true(LamRateAt(&rate, ZERO_CELSIUS + 30) > 0.5);
  assert_true(LamRateAt(&rate, ZERO_CELSIUS + 50) < LamRateAt(&rate, ZERO_CELSIUS + 35));
}

TEST(half_of_the_enzyme_is_active_at_its_temperature)
{
  LamRate rate = {.rate = 0.5,
                  .activation = 0,
                  .deactivation = 300e3,
                  .reference = ZERO_CELSIUS - 50,
                  .half_activity = ZERO_CELSIUS + 35};

  assert_near(LamRateAt(&rate, rate.half_activity), 0.25, 1e-9);
}

TEST(rates_stay_finite_at_any_temperature)
{
  const LamRate rate = {.rate = 0.5,
                        .activation = 60e3,
                        .deactivation = 900e3,
                        .reference = ZERO_CELSIUS + 20,
                        .half_activity = ZERO_CELSIUS + 35};

  assert_true(isfinite(LamRateAt(&rate, 10)));
  assert_true(isfinite(LamRateAt(&rate, 2000)));
}

TEST(every_factor_begins_at_1)
{
  PetscReal time[2] = {0, 10}, factor[2] = {1, 0.5};

  for (int law = 0; law < LAM_KINETIC_LAW_COUNT; law++) {
    LamKinetics kinetics = Law((LamKineticLaw)law);
    PetscReal x[2] = {0}, slope[2];

    kinetics.count = 2;
    kinetics.time = time;
    kinetics.factor = factor;
    LamKineticsStart(&kinetics, x);
    assert_near(LamKineticsFactor(&kinetics, 0, x, slope), 1, 1e-15);
  }
}

/* At random states, by central differences. */
TEST(derivatives_of_rates_are_consistent)
{
  const PetscReal T = 300, x[2] = {0.63, 0.41}, h = 1e-6;

  for (int law = 0; law < LAM_KINETIC_LAW_COUNT; law++) {
    const LamKinetics kinetics = Law((LamKineticLaw)law);
    PetscReal J[2][2], unused[2][2], rate[2];

    LamKineticsRates(&kinetics, T, x, rate, J);
    for (PetscInt j = 0; j < LamKineticsStates(&kinetics); j++) {
      PetscReal more[2] = {x[0], x[1]}, less[2] = {x[0], x[1]}, up[2] = {0}, down[2] = {0};

      more[j] += h;
      less[j] -= h;
      LamKineticsRates(&kinetics, T, more, up, unused);
      LamKineticsRates(&kinetics, T, less, down, unused);
      for (PetscInt i = 0; i < LamKineticsStates(&kinetics); i++)
        assert_near(J[i][j], (up[i] - down[i]) / (2 * h), 1e-9);
    }
  }
}

TEST(a_table_is_straight_between_its_points_and_constant_beyond)
{
  PetscReal time[3] = {0, 10, 30}, factor[3] = {1, 0.5, 0.7}, slope[2];
  const LamKinetics table = {.law = LAM_KINETIC_TABLE, .count = 3, .time = time, .factor = factor};

  assert_near(LamKineticsFactor(&table, 5, NULL, slope), 0.75, 1e-15);
  assert_near(LamKineticsFactor(&table, 10, NULL, slope), 0.5, 1e-15);
  assert_near(LamKineticsFactor(&table, 20, NULL, slope), 0.6, 1e-15);
  assert_near(LamKineticsFactor(&table, 99, NULL, slope), 0.7, 1e-15);
}
