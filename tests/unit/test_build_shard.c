/* Parts of a sample box: each state is in one of them, they are of like size, and they are boxes. */
#include "support/test.h"
#include <stdio.h>
#include <stdlib.h>
#include "build.h"
#include "support/tissue.h"

enum { ASKED = 4096 };

static LamScene Scene(void)
{
  LamScene scene = {0};

  scene.micro = (LamMicrostructure){.cells = {1, 1}};
  scene.sample =
      (LamSample){.stretch_min = -0.02, .stretch_max = 0.25, .turgor_min = 0, .turgor_max = 0.05 / TISSUE_STRESS};
  return scene;
}

TEST(every_state_is_in_one_part_of_like_size)
{
  const LamScene scene = Scene();
  const int counts[] = {1, 2, 3, 7, 100};

  for (size_t c = 0; c < sizeof(counts) / sizeof(counts[0]); c++) {
    int *owner = calloc(ASKED, sizeof(*owner));

    for (PetscInt index = 1; index <= counts[c]; index++) {
      const LamShard shard = {index, counts[c]};
      PetscInt n, *states;

      assert_int_equal(LamShardStates(&scene, &shard, ASKED, &n, &states), 0);
      assert_in_range(n, ASKED / counts[c] - 8, ASKED / counts[c] + 8);
      for (PetscInt i = 0; i < n; i++) {
        assert_int_equal(owner[states[i]]++, 0);
        assert_true(!i || states[i] > states[i - 1]);
      }
      PetscFree(states);
    }
    for (int i = 0; i < ASKED; i++) assert_int_equal(owner[i], 1);
    free(owner);
  }
}

/* The parts share nodes along their sides only: together they spread little more than the box does. */
TEST(a_part_is_a_small_box)
{
  const LamScene scene = Scene();
  const LamShard shard = {3, 16};
  PetscInt n, *states;
  PetscReal low = PETSC_INFINITY, high = PETSC_NINFINITY;

  assert_int_equal(LamShardStates(&scene, &shard, ASKED, &n, &states), 0);
  for (PetscInt i = 0; i < n; i++) {
    LamLoad load;

    LamSampleLoad(&scene, PETSC_PI / 6, states[i], &load);
    low = PetscMin(low, load.F[0]);
    high = PetscMax(high, load.F[0]);
  }
  assert_true(high - low < 0.6 * (exp(0.25) - exp(-0.02)));
  PetscFree(states);
}

TEST(words_that_say_no_part_are_refused)
{
  const char *const words[] = {"", "1", "0/4", "5/4", "-1/4", "1/0", "1/4x", "a/b", "1/4/2"};
  LamShard shard;

  for (size_t i = 0; i < sizeof(words) / sizeof(words[0]); i++) {
    assert_false(LamShardParse(words[i], &shard));
  }
  assert_true(LamShardParse("4/4", &shard));
  assert_int_equal(shard.index, 4);
  assert_int_equal(shard.count, 4);
}

static int Silence(void **state)
{
  return !freopen("/dev/null", "w", stderr);
}

TEST_GROUP(.setup = Silence);
