/* Of damaged files whose header HDF5 reads, the sound records are kept, and nothing else. */
#define _GNU_SOURCE /* memmem */
#include "merge_fixture.h"

enum { COUNT = 200 }; /* more than three chunks */
static PetscInt64 keys[COUNT];
static char told[8192]; /* what the merges of a test have told */

static void Listen(void *ctx, PetscBool warning, const char words[])
{
  const size_t length = strlen(told);

  snprintf(told + length, sizeof(told) - length, "%s\n", words);
}

static void WriteSound(int shard)
{
  for (int i = 0; i < COUNT; i++) keys[i] = Node(i);
  WriteShard(shard, COUNT, keys);
  told[0] = '\0';
}

static PetscErrorCode SalvageShards(PetscInt n)
{
  const LamMergeOptions options = {.salvage = PETSC_TRUE, .reporter.message = Listen};
  const char *files[SHARDS] = {shard_path[0], shard_path[1], shard_path[2]};

  return LamDatabaseMerge(path, n, files, &options, &report);
}

/* Damages the first shard's record of this key. */
static void DamageKey(PetscInt64 key)
{
  Overwrite(shard_path[0], PlaceOf(shard_path[0], sizeof(key), &key) + 500, 8, "damaged.");
}

static void ReplaceText(const char text[], const char by[])
{
  Overwrite(shard_path[0], PlaceOf(shard_path[0], strlen(text), text), strlen(by), by);
}

/* Each record of the result is one that was written. */
static void AssertAllSound(PetscInt wanted)
{
  const LamResponse *records;
  const PetscInt64 *found;
  PetscInt n;

  records = OpenRecords(&n, &found);
  assert_int_equal(n, wanted);
  for (PetscInt i = 0; i < n; i++) {
    const LamResponse r = NodeResponse(found[i]);

    AssertSame(&records[i], &r);
  }
}

MERGE_TEST(a_damaged_record_is_refused_and_by_salvage_left_out_and_named)
{
  WriteSound(0);
  DamageKey(keys[70]);
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  AssertMessage("record 70");
  AssertNothingLeft();
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 1);
  assert_int_equal(report.left_out, 1);
  if (!strstr(told, "record 70 is damaged")) fail_msg("told: %s", told);
}

MERGE_TEST(records_damaged_one_behind_the_other_are_counted)
{
  WriteSound(0);
  for (int i = 63; i < 67; i++) DamageKey(keys[i]);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 4);
  assert_int_equal(report.left_out, 4);
}

MERGE_TEST(another_file_has_what_one_has_lost)
{
  WriteSound(0);
  DamageKey(keys[5]);
  WriteSound(1);
  assert_int_equal(SalvageShards(2), 0);
  AssertAllSound(COUNT);
}

/* HDF5's index of the chunks is gone, so are the records. */
MERGE_TEST(records_that_hdf5_cannot_read_are_left_out)
{
  WriteSound(0);
  ReplaceText("TREE\1", "EERT");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertMessage("not one record is sound");
  AssertNothingLeft();
  WriteShard(1, 2, keys);
  assert_int_equal(SalvageShards(2), 0);
  AssertAllSound(2);
  assert_int_equal(report.left_out, COUNT);
  assert_non_null(strstr(told, "HDF5 cannot read it"));
}

MERGE_TEST(a_file_that_is_cut_is_refused_by_name)
{
  size_t size;

  WriteSound(0);
  free(Bytes(shard_path[0], &size));
  assert_int_equal(truncate(shard_path[0], (off_t)size / 2), 0);
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertMessage(shard_path[0]);
  AssertMessage("cut short");
  AssertNothingLeft();
}

MERGE_TEST(a_damaged_unit_is_told)
{
  static const char name[] = "stress_unit_Pa\0\0\x11";
  size_t size, place;
  unsigned char *bytes;

  WriteSound(0);
  place = PlaceOf(shard_path[0], sizeof(name) - 1, name) + 16 + 24 + 8 + 5;
  bytes = Bytes(shard_path[0], &size);
  bytes[place] ^= 1;
  Overwrite(shard_path[0], place, 1, bytes + place);
  free(bytes);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT);
  assert_non_null(strstr(told, "check them"));
}

MERGE_TEST(a_damaged_scene_costs_no_record)
{
  WriteSound(0);
  ReplaceText("version: 1", "damaged");
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT);
}

MERGE_TEST(a_counter_that_cannot_be_is_not_believed)
{
  const PetscInt64 counts[] = {INT64_MIN, -1, INT64_MAX};

  for (int k = 0; k < 3; k++) {
    WriteSound(0);
    SetNumber(shard_path[0], "/records", "committed", H5T_NATIVE_INT64, &counts[k]);
    assert_int_equal(SalvageShards(1), 0);
    AssertAllSound(COUNT);
    assert_int_equal(report.left_out, 0);
    assert_non_null(strstr(told, "commit counter is damaged"));
    unlink(path);
    unlink(shard_path[0]);
  }
}

MERGE_TEST(a_changed_description_is_not_believed)
{
  WriteSound(0);
  ReplaceText("{\"wall_thickness\": 0.15", "{\"wall_thickness\": 0.16");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertNothingLeft();
}

MERGE_TEST(a_damaged_grid_is_not_believed)
{
  WriteSound(0);
  ReplaceText("\"turgor\":0.2", "\"turgor\":0.3");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertMessage(LAM_GRID_NAME " is damaged");
  AssertNothingLeft();
}

MERGE_TEST(nodes_without_a_grid_are_refused)
{
  hid_t file;

  WriteSound(0);
  file = H5Fopen(shard_path[0], H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, LAM_GRID_NAME, H5P_DEFAULT);
  H5Fclose(file);
  for (int salvage = 0; salvage < 2; salvage++) {
    assert_int_equal(TryShards(1, 0, (PetscBool)salvage), PETSC_ERR_USER_INPUT);
    AssertMessage(LAM_GRID_NAME " is missing");
    AssertNothingLeft();
  }
}

MERGE_TEST(a_damaged_record_of_an_earlier_type_is_left_out)
{
  const PetscInt64 key = Node(1);
  LamResponse wanted = NodeResponse(key);

  WriteShard(0, 1, &key);
  RemoveMember(0, "min_gap", &key, &wanted);
  told[0] = '\0';
  assert_int_equal(SalvageShards(1), 0);
  wanted.min_gap = NAN;
  AssertRecord(0, key, &wanted);
  unlink(path);
  DamageKey(key);
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertMessage("not one record is sound");
}
