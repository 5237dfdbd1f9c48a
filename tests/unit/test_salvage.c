/* Of damaged files whose header HDF5 reads, the sound records are kept, and nothing else. */
#define _GNU_SOURCE /* memmem */
#include "support/test.h"
#include "merge_fixture.h"
#include <fcntl.h>
#include <sys/stat.h>

enum { COUNT = 200 }; /* more than three chunks */
static PetscInt64 keys[COUNT];
static char told[8192]; /* what the merges of a test have told */

static void Listen(void *ctx, const char words[])
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
  const LamMergeOptions options = {.salvage = PETSC_TRUE, .tell = Listen};
  const char *files[SHARDS] = {shard_path[0], shard_path[1], shard_path[2]};

  return LamDatabaseMerge(path, n, files, &options, &report);
}

/* Of the first shard: the whole file, with its size. The caller frees it. */
static unsigned char *Bytes(size_t *size)
{
  const int fd = open(shard_path[0], O_RDONLY);
  unsigned char *bytes;
  struct stat info;

  fstat(fd, &info);
  *size = (size_t)info.st_size;
  bytes = malloc(*size);
  assert_int_equal(read(fd, bytes, *size), *size);
  close(fd);
  return bytes;
}

static void Overwrite(size_t place, size_t n, const void *bytes)
{
  const int fd = open(shard_path[0], O_WRONLY);

  assert_int_equal(pwrite(fd, bytes, n, (off_t)place), n);
  close(fd);
}

/* Where these bytes begin. */
static size_t PlaceOfBytes(size_t n, const void *wanted)
{
  size_t size;
  unsigned char *bytes = Bytes(&size);
  const unsigned char *at = memmem(bytes, size, wanted, n);
  const size_t place = (size_t)(at - bytes);

  assert_non_null(at);
  free(bytes);
  return place;
}

static size_t PlaceOf(PetscInt64 key)
{
  return PlaceOfBytes(sizeof(key), &key);
}

static size_t PlaceOfText(const char text[])
{
  return PlaceOfBytes(strlen(text), text);
}

/* Each record of the result is one that was written. */
static void AssertAllSound(PetscInt wanted)
{
  const LamResponse *records;
  const PetscInt64 *found;
  LamDatabase db;
  PetscInt n;

  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  LamDatabaseGetRecords(db, &n, &records, &found);
  assert_int_equal(n, wanted);
  for (PetscInt i = 0; i < n; i++) {
    const LamResponse r = NodeResponse(found[i]);

    AssertSame(&records[i], &r);
  }
  LamDatabaseClose(&db);
}

MERGE_TEST(a_damaged_record_is_refused_and_by_salvage_left_out_and_named)
{
  WriteSound(0);
  Overwrite(PlaceOf(keys[70]) + 500, 8, "damaged.");
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "record 70"));
  AssertNothingLeft();
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 1);
  assert_int_equal(report.left_out, 1);
  if (!strstr(told, "record 70 is damaged")) fail_msg("told: %s", told);
}

MERGE_TEST(records_damaged_one_behind_the_other_are_counted)
{
  WriteSound(0);
  for (int i = 63; i < 67; i++) Overwrite(PlaceOf(keys[i]) + 500, 8, "damaged.");
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 4);
  assert_int_equal(report.left_out, 4);
}

MERGE_TEST(another_file_has_what_one_has_lost)
{
  WriteSound(0);
  Overwrite(PlaceOf(keys[5]) + 500, 8, "damaged.");
  WriteSound(1);
  assert_int_equal(SalvageShards(2), 0);
  AssertAllSound(COUNT);
}

/* HDF5's index of the chunks is gone, so are the records. */
MERGE_TEST(records_that_hdf5_cannot_read_are_left_out)
{
  WriteSound(0);
  Overwrite(PlaceOfText("TREE\1"), 4, "EERT");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "not one record is sound"));
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
  free(Bytes(&size));
  assert_int_equal(truncate(shard_path[0], (off_t)size / 2), 0);
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, shard_path[0]));
  assert_non_null(strstr(message, "cut short"));
  AssertNothingLeft();
}

MERGE_TEST(a_damaged_unit_is_told)
{
  static const char name[] = "stress_unit_Pa\0\0\x11";
  size_t size, place;
  unsigned char *bytes;

  WriteSound(0);
  place = PlaceOfBytes(sizeof(name) - 1, name) + 16 + 24 + 8 + 5;
  bytes = Bytes(&size);
  bytes[place] ^= 1;
  Overwrite(place, 1, bytes + place);
  free(bytes);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT);
  assert_non_null(strstr(told, "check them"));
}

MERGE_TEST(a_damaged_scene_costs_no_record)
{
  WriteSound(0);
  Overwrite(PlaceOfText("version: 1"), 7, "damaged");
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT);
}

static void SetCounter(PetscInt64 count)
{
  const hid_t file = H5Fopen(shard_path[0], H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "/records", H5P_DEFAULT);
  const hid_t attribute = H5Aopen(dataset, "committed", H5P_DEFAULT);

  H5Awrite(attribute, H5T_NATIVE_INT64, &count);
  H5Aclose(attribute);
  H5Dclose(dataset);
  H5Fclose(file);
}

MERGE_TEST(a_counter_that_cannot_be_is_not_believed)
{
  const PetscInt64 counts[] = {INT64_MIN, -1, INT64_MAX};

  for (int k = 0; k < 3; k++) {
    WriteSound(0);
    SetCounter(counts[k]);
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
  Overwrite(PlaceOfText("{\"wall_thickness\": 0.15"), 23, "{\"wall_thickness\": 0.16");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertNothingLeft();
}

MERGE_TEST(a_damaged_grid_is_not_believed)
{
  WriteSound(0);
  Overwrite(PlaceOfText("\"turgor\":0.2"), 12, "\"turgor\":0.3");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, LAM_GRID_NAME " is damaged"));
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
    assert_non_null(strstr(message, LAM_GRID_NAME " is missing"));
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
  Overwrite(PlaceOf(key) + 500, 8, "damaged.");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "not one record is sound"));
}
