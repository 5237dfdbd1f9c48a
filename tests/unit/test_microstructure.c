/* The canonical description of a microstructure and its hash. */
#include "record_fixture.h"

static void rounding_of_units_does_not_change_the_hash(void **state)
{
  LamScene scene = Scene();
  char hash[2][LAM_HASH_LENGTH], *json[2];

  for (int i = 0; i < 2; i++) {
    assert_int_equal(LamMicrostructureDescribe(&scene.micro, &json[i], hash[i]), 0);
    scene.micro.wall.C4 *= 1 + 4e-16;
    scene.micro.orientation = 1e-17;
  }
  assert_string_equal(json[0], json[1]);
  assert_string_equal(hash[0], hash[1]);
  for (int i = 0; i < 2; i++) PetscFree(json[i]);
}

static void another_thickness_changes_the_hash(void **state)
{
  LamScene scene = Scene();
  char hash[2][LAM_HASH_LENGTH], *json;

  for (int i = 0; i < 2; i++) {
    assert_int_equal(LamMicrostructureDescribe(&scene.micro, &json, hash[i]), 0);
    scene.micro.wall_thickness += 1e-9;
    PetscFree(json);
  }
  assert_string_not_equal(hash[0], hash[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      TEST(rounding_of_units_does_not_change_the_hash),
      TEST(another_thickness_changes_the_hash),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
