/* The planner's model of rounding errors, and when it speaks. */
#include "support/rve_fixture.h"
#include <string.h>
#include "rounding.h"

TEST(DefaultTissueHasDigitsToSpare)
{
  const LamMicrostructure micro = DefaultTissue();
  char text[256];

  assert_true(LamTangentRounding(&micro) < 1e-9);
  assert_int_equal(LamDigitsWarning(&micro, 1e-8, text, sizeof(text)), 0);
  assert_string_equal(text, "");
}

/* Twice as stiff, or half as thick, costs twice as much; the worst of uneven cells counts. */
TEST(RoundingGrowsWithStiffnessAndSlenderness)
{
  LamMicrostructure stiff = DefaultTissue(), thin = DefaultTissue(), uneven = DefaultTissue();
  const PetscReal usual = LamTangentRounding(&uneven);
  LamCell cells[2];

  stiff.wall.bulk_modulus *= 2;
  thin.wall_thickness /= 2;
  assert_true(fabs(LamTangentRounding(&stiff) / usual - 2) < 1e-12);
  assert_true(fabs(LamTangentRounding(&thin) / usual - 2) < 1e-12);
  cells[0] = cells[1] = (LamCell){.wall_thickness = 0.15, .wall = uneven.wall};
  cells[1].wall = stiff.wall;
  uneven.cells[0] = 2;
  uneven.cell = cells;
  assert_true(LamTangentRounding(&uneven) > 2 * usual);
}

/* The bulk modulus that it names is one at which it is silent. */
TEST(WarningNamesWhatWouldDo)
{
  LamMicrostructure micro = DefaultTissue();
  const PetscReal limit = micro.wall.bulk_modulus * 0.01 / LamTangentRounding(&micro);
  char text[256];
  double named;

  micro.wall.bulk_modulus = 0.99 * limit;
  assert_int_equal(LamDigitsWarning(&micro, 0.01, text, sizeof(text)), 0);
  assert_string_equal(text, "");
  micro.wall.bulk_modulus = 100 * limit;
  assert_int_equal(LamDigitsWarning(&micro, 0.01, text, sizeof(text)), 0);
  assert_non_null(strstr(text, "about 0 digits"));
  assert_int_equal(sscanf(strstr(text, "below "), "below %lf", &named), 1);
  assert_true(fabs(named / limit - 1) < 0.5); /* one digit */
}
