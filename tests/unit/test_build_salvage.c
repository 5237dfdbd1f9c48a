/* A damaged database is made anew of what is sound, and kept. */
#include "merge_fixture.h"
#include "build_salvage.h"
#include <sys/stat.h>

enum { COUNT = 100 };
static char damaged_path[192];

static int EnterBuild(void **state)
{
  const int status = EnterMerge(state);

  snprintf(damaged_path, sizeof(damaged_path), "%s.damaged", path);
  return status;
}

static int LeaveBuild(void **state)
{
  unlink(damaged_path);
  return LeaveMerge(state);
}

/* Nodes 0 .. COUNT - 1 in `path`. */
static void WriteDatabase(void)
{
  PetscInt64 keys[COUNT];

  for (int i = 0; i < COUNT; i++) keys[i] = Node(i);
  WriteShard(0, COUNT, keys);
  assert_int_equal(rename(shard_path[0], path), 0);
}

static PetscErrorCode Salvage(const LamScene *scene)
{
  LamGrid grid = ShardGrid(scene);
  const PetscErrorCode ierr = LamBuildSalvage(scene, grid, path, NULL, &report);

  LamGridDestroy(&grid);
  return ierr;
}

/* Without HDF5's tables, and the header that tells of what tissue it is. */
static void DestroyFront(void)
{
  char *zeros;
  FILE *file;
  long place;
  PetscInt64 key = 0;

  file = fopen(path, "r+");
  for (place = 0; key != Node(0); place++) {
    fseek(file, place, SEEK_SET);
    if (fread(&key, sizeof(key), 1, file) != 1) fail_msg("the first node is not there");
  }
  zeros = calloc((size_t)place, 1);
  fseek(file, 0, SEEK_SET);
  fwrite(zeros, 1, (size_t)place - 1, file);
  fclose(file);
  free(zeros);
}

static void a_database_without_a_header_is_made_anew_for_the_scene(void **state)
{
  const LamScene scene = ShardScene();

  WriteDatabase();
  DestroyFront();
  assert_int_equal(Salvage(&scene), 0);
  assert_int_equal(report.records, COUNT);
  assert_int_equal(CountRecords(), COUNT);
  assert_int_equal(access(damaged_path, F_OK), 0);
}

/* A run before this one was killed when the new file was not there yet. */
static void a_second_name_of_the_same_file_is_no_hindrance(void **state)
{
  const LamScene scene = ShardScene();

  WriteDatabase();
  assert_int_equal(link(path, damaged_path), 0);
  assert_int_equal(Salvage(&scene), 0);
  assert_int_equal(CountRecords(), COUNT);
}

static void another_damaged_file_is_not_replaced(void **state)
{
  const LamScene scene = ShardScene();

  WriteDatabase();
  fclose(fopen(damaged_path, "w"));
  assert_int_equal(Salvage(&scene), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "rename it"));
  assert_int_equal(CountRecords(), COUNT);
}

static void other_tissue_is_refused_and_stays(void **state)
{
  LamScene scene = ShardScene();

  WriteDatabase();
  scene.micro.wall_thickness = 0.2;
  assert_int_equal(Salvage(&scene), PETSC_ERR_USER_INPUT);
  assert_int_equal(CountRecords(), COUNT);
  assert_int_equal(access(damaged_path, F_OK), -1);
}

/* The scene's box may have changed since: nodes keep the loads that they have. */
static void the_grid_is_that_of_the_file(void **state)
{
  LamScene scene = ShardScene();

  WriteDatabase();
  scene.turgor = 0.3;
  assert_int_equal(Salvage(&scene), 0);
  assert_int_equal(CountRecords(), COUNT);
}

#define BUILD_TEST(name) cmocka_unit_test_setup_teardown(name, EnterBuild, LeaveBuild)

int main(void)
{
  const struct CMUnitTest tests[] = {
      BUILD_TEST(a_database_without_a_header_is_made_anew_for_the_scene),
      BUILD_TEST(a_second_name_of_the_same_file_is_no_hindrance),
      BUILD_TEST(another_damaged_file_is_not_replaced),
      BUILD_TEST(other_tissue_is_refused_and_stays),
      BUILD_TEST(the_grid_is_that_of_the_file),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
