/* Numbers that vary with the position: expressions, tables, and what is wrong with them. */
#include "support/test.h"
#include <lamella/place_field.h>
#include <stdio.h>
#include <unistd.h>
#include "unit/test_scene_message.h"

#define NAME "scene.yaml:7: macro.fields.turgor"

static LamPlaceField Expression(const char text[])
{
  char reason[LAM_PLACE_FIELD_REASON];
  LamPlaceField field;

  assert_int_equal(LamPlaceFieldFromExpression(NAME, text, &field, reason), 0);
  assert_string_equal(reason, "");
  return field;
}

/* Writes the text to a file and reads it as a table. */
static LamPlaceField Table(const char text[], char reason[LAM_PLACE_FIELD_REASON])
{
  char path[] = "place_field_XXXXXX.csv";
  const int file = mkstemps(path, 4);
  LamPlaceField field;

  assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
  close(file);
  assert_int_equal(LamPlaceFieldFromTable(NAME, path, &field, reason), 0);
  unlink(path);
  return field;
}

static PetscReal At(LamPlaceField field, PetscReal x, PetscReal y)
{
  const PetscReal X[2] = {x, y};
  PetscReal value;

  assert_int_equal(LamPlaceFieldEvaluate(field, X, &value), 0);
  return value;
}

TEST(expressions_are_of_x_and_y)
{
  OWNED(LamPlaceField, LamPlaceFieldDestroy) field = Expression("30 * x / 10 + sqrt(y) * cos(pi)");

  assert_near(At(field, 2, 9), 3, 1e-14);
  assert_near(At(field, 0, 4), -2, 1e-14);
}

TEST(comparisons_are_one_or_zero)
{
  OWNED(LamPlaceField, LamPlaceFieldDestroy) field = Expression("y > 9 && x <= 1");

  assert_near(At(field, 1, 9.5), 1, 0);
  assert_near(At(field, 1.5, 9.5), 0, 0);
}

TEST(what_is_no_expression_is_refused)
{
  static const char *const bad[] = {"", "3 +", "z", "x y", "sin(x", "x, y", "\"x\""};

  for (size_t i = 0; i < sizeof(bad) / sizeof(*bad); i++) {
    char reason[LAM_PLACE_FIELD_REASON];
    LamPlaceField field;

    assert_int_equal(LamPlaceFieldFromExpression(NAME, bad[i], &field, reason), 0);
    if (field || !reason[0]) fail_msg("\"%s\" was taken", bad[i]);
  }
}

TEST(a_place_without_value_is_named)
{
  static const char *const bad[] = {"1 / x", "sqrt(-1 - y)", "ln(x)"};
  const PetscReal X[2] = {0, 2.5};

  for (size_t i = 0; i < sizeof(bad) / sizeof(*bad); i++) {
    OWNED(LamPlaceField, LamPlaceFieldDestroy) field = Expression(bad[i]);
    PetscErrorCode error;
    PetscReal value;

    CATCH(LamPlaceFieldEvaluate(field, X, &value), error);
    assert_int_equal(error, PETSC_ERR_USER_INPUT);
    assert_non_null(strstr(scene_message, NAME ": "));
    assert_non_null(strstr(scene_message, "x = 0 mm, y = 2.5 mm"));
  }
}

TEST(tables_are_bilinear_between_their_rows)
{
  char reason[LAM_PLACE_FIELD_REASON];
  OWNED(LamPlaceField, LamPlaceFieldDestroy)
  field = Table("x_mm,y_mm,MPa\n10, 0, 3\n0,0,1\n0,4,2\r\n4,0,1\n\n10,4,8\n4,4,6\n", reason);

  assert_string_equal(reason, "");
  assert_near(At(field, 0, 0), 1, 1e-14);
  assert_near(At(field, 10, 4), 8, 1e-14);
  assert_near(At(field, 2, 2), 0.25 * (1 + 1 + 2 + 6), 1e-14);
  assert_near(At(field, 7, 1), 0.75 * 2 + 0.25 * 7, 1e-14);
}

TEST(a_place_outside_the_table_is_named)
{
  char reason[LAM_PLACE_FIELD_REASON];
  OWNED(LamPlaceField, LamPlaceFieldDestroy) field = Table("x,y,v\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n", reason);
  const PetscReal X[2] = {0.5, 1.25};
  PetscErrorCode error;
  PetscReal value;

  CATCH(LamPlaceFieldEvaluate(field, X, &value), error);
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(scene_message, ".csv: has no value at x = 0.5 mm, y = 1.25 mm: y is from 0 to 1 mm"));
}

TEST(tables_that_are_no_grids_are_refused)
{
  static const struct {
    const char *text, *fragment;
  } bad[] = {
      {"", "0 rows"},
      {"x,y,v\n0,0,1\n0,1,1\n1,0,1\n", "3 rows for 2 x and 2 y"},
      {"x,y,v\n0,0,1\n0,1,1\n1,0,1\n1,0,1\n", "x = 1, y = 0 twice"},
      {"x,y,v\n0,0,1\n0,1\n1,0,1\n1,1,1\n", "line 3 is not three numbers"},
      {"x,y,v\n0,0,1\n0,1,nan\n1,0,1\n1,1,1\n", "line 3 is not three numbers"},
      {"x,y,v\n0,0,1\n0,1,1,4\n1,0,1\n1,1,1\n", "line 3 is not three numbers"},
  };

  for (size_t i = 0; i < sizeof(bad) / sizeof(*bad); i++) {
    char reason[LAM_PLACE_FIELD_REASON];

    assert_null(Table(bad[i].text, reason));
    if (!strstr(reason, bad[i].fragment)) fail_msg("\"%s\" lacks \"%s\"", reason, bad[i].fragment);
  }
}
