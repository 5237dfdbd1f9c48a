/* What is sound in damaged files is found, and nothing else. */
#define _GNU_SOURCE /* memmem */
#include "merge_fixture.h"
#include <fcntl.h>
#include <sys/stat.h>

enum { COUNT = 200 }; /* more than three chunks */
static PetscInt64 keys[COUNT];
static char told[8192]; /* what the merges of a test have told */

static void Listen(const char words[])
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

static size_t RecordSize(void)
{
  size_t size;
  hid_t type;

  assert_int_equal(LamRecordTypeCreate(&type), 0);
  size = H5Tget_size(type);
  H5Tclose(type);
  return size;
}

/* Where the record of this key begins. */
static size_t PlaceOf(PetscInt64 key)
{
  size_t size, place = 0;
  unsigned char *bytes = Bytes(&size);

  while (place + 8 < size && memcmp(bytes + place, &key, 8)) place++;
  free(bytes);
  return place;
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

static void a_damaged_record_is_refused_and_by_salvage_left_out_and_named(void **state)
{
  char name[64];

  WriteSound(0);
  Overwrite(PlaceOf(keys[70]) + 500, 8, "damaged.");
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "record 70"));
  AssertNothingLeft();
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 1);
  assert_int_equal(report.left_out, 1);
  snprintf(name, sizeof(name), "key %lld", (long long)keys[70]);
  if (!strstr(told, name)) fail_msg("told: %s", told);
}

static void records_damaged_one_behind_the_other_are_counted(void **state)
{
  WriteSound(0);
  for (int i = 63; i < 67; i++) Overwrite(PlaceOf(keys[i]) + 500, 8, "damaged.");
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 4);
  assert_int_equal(report.left_out, 4);
}

/* The counter tells of one that cannot be made out at all. */
static void a_record_without_a_trace_is_counted(void **state)
{
  const char zeros[300] = {0};

  WriteSound(0);
  Overwrite(PlaceOf(keys[5]), sizeof(zeros), zeros);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT - 1);
  assert_int_equal(report.left_out, 1);
}

static void another_file_has_what_one_has_lost(void **state)
{
  WriteSound(0);
  Overwrite(PlaceOf(keys[5]) + 500, 8, "damaged.");
  WriteSound(1);
  assert_int_equal(SalvageShards(2), 0);
  AssertAllSound(COUNT);
}

/* Whole records before the cut. */
static void of_a_file_that_is_cut_all_before_the_cut_is_found(void **state)
{
  size_t size, place[COUNT];
  const size_t record = RecordSize();
  unsigned char *bytes;

  WriteSound(0);
  bytes = Bytes(&size);
  for (int i = 0; i < COUNT; i++) place[i] = PlaceOf(keys[i]);
  for (int part = 3; part < 16; part += 2) {
    const size_t cut = size * (size_t)part / 16;
    PetscInt wanted = 0;

    assert_int_equal(truncate(shard_path[0], (off_t)cut), 0);
    for (int i = 0; i < COUNT; i++) wanted += place[i] + record <= cut;
    assert_int_equal(SalvageShards(1), 0);
    AssertAllSound(wanted);
    assert_int_equal(report.left_out, COUNT - wanted);
    assert_null(strstr(told, "check them")); /* the header is sound */
    unlink(path);
    Overwrite(0, size, bytes);
  }
  free(bytes);
}

static void a_damaged_unit_is_told(void **state)
{
  size_t size, place;
  unsigned char *bytes, *name;

  WriteSound(0);
  bytes = Bytes(&size);
  name = memmem(bytes, size, "stress_unit_Pa\0\0\x11", 17);
  place = (size_t)(name - bytes) + 16 + 24 + 8;
  bytes[place + 5] ^= 1;
  Overwrite(place + 5, 1, bytes + place + 5);
  free(bytes);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT);
  assert_non_null(strstr(told, "units are read from a damaged header"));
}

/* Zeros over each part of the file in turn: no crash, all records but those that were hit. */
static void wherever_a_file_is_damaged_the_rest_is_found(void **state)
{
  const char zeros[4096] = {0};
  size_t size, place[COUNT];
  const size_t record = RecordSize();
  unsigned char *bytes;

  WriteSound(0);
  WriteSound(1);
  assert_int_equal(truncate(shard_path[1], 20000), 0); /* few records, but a header */
  bytes = Bytes(&size);
  for (int i = 0; i < COUNT; i++) place[i] = PlaceOf(keys[i]);
  for (size_t from = 0; from + sizeof(zeros) < size; from += 5 * sizeof(zeros)) {
    PetscInt hit = 0;

    Overwrite(from, sizeof(zeros), zeros);
    for (int i = 0; i < COUNT; i++) hit += place[i] < from + sizeof(zeros) && from < place[i] + record;
    assert_int_equal(SalvageShards(2), 0);
    AssertAllSound(COUNT - hit);
    unlink(path);
    Overwrite(0, size, bytes);
  }
  free(bytes);
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

/* A commit that was interrupted before the counter was raised. */
static void records_beyond_the_counter_are_taken(void **state)
{
  WriteSound(0);
  SetCounter(150);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(COUNT);
  assert_int_equal(report.left_out, 0);
}

static void a_counter_that_cannot_be_is_not_believed(void **state)
{
  const PetscInt64 counts[] = {INT64_MIN, -1, INT64_MAX};

  for (int k = 0; k < 3; k++) {
    WriteSound(0);
    SetCounter(counts[k]);
    assert_int_equal(SalvageShards(1), 0);
    AssertAllSound(COUNT);
    assert_int_equal(report.left_out, 0);
    assert_non_null(strstr(told, "how many it held cannot be made out any more"));
    unlink(path);
    unlink(shard_path[0]);
  }
}

/* Sound as they are, they answer other questions than their keys say. */
static void nodes_of_another_grid_are_left_out(void **state)
{
  LamResponse r[2] = {NodeResponse(Node(1)), NodeResponse(Node(2))};
  const PetscInt64 two[] = {Node(1), Node(2)};

  r[1].load.F[0] += 1e-9;
  WriteRecords(0, 2, two, r);
  assert_int_equal(SalvageShards(1), 0);
  AssertAllSound(1);
  assert_int_equal(report.left_out, 1);
}

static void a_damaged_file_of_other_tissue_is_refused(void **state)
{
  LamScene scene = ShardScene();
  const PetscInt64 key = Node(1);

  scene.micro.wall_thickness = 0.2;
  WriteOf(&scene, 0, 1, &key, NULL);
  Overwrite(0, 1, "x");
  WriteShard(1, 1, &key);
  assert_int_equal(SalvageShards(2), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "microstructure"));
  AssertNothingLeft();
}

/* Its records are sound, but of what tissue? */
static void a_file_that_does_not_tell_its_tissue_is_left_out(void **state)
{
  const PetscInt64 key = Node(COUNT + 1);
  char *zeros;

  WriteSound(0);
  zeros = calloc(PlaceOf(keys[0]), 1);
  Overwrite(0, PlaceOf(keys[0]), zeros);
  free(zeros);
  WriteShard(1, 1, &key);
  assert_int_equal(SalvageShards(2), 0);
  AssertAllSound(1);
  assert_int_equal(report.left_out, COUNT);
  assert_non_null(strstr(told, "nothing of it is taken"));
}

static void a_changed_description_is_not_believed(void **state)
{
  size_t size, place;
  unsigned char *bytes, *text;

  WriteSound(0);
  bytes = Bytes(&size);
  text = memmem(bytes, size, "{\"wall_thickness\": 0.15", 23);
  place = (size_t)(text - bytes);
  free(bytes);
  Overwrite(place, 23, "{\"wall_thickness\": 0.16");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  AssertNothingLeft();
}

/* Its records are sound, but which node has which load? */
static void a_damaged_grid_is_not_believed(void **state)
{
  size_t size, place;
  unsigned char *bytes;

  WriteSound(0);
  bytes = Bytes(&size);
  place = (size_t)((unsigned char *)memmem(bytes, size, "\"turgor\":0.2", 12) - bytes);
  free(bytes);
  Overwrite(place, 12, "\"turgor\":0.3");
  assert_int_equal(SalvageShards(1), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "its grid cannot be made out"));
  AssertNothingLeft();
  WriteShard(1, 1, keys);
  assert_int_equal(SalvageShards(2), 0);
  AssertAllSound(COUNT);
}

static void a_damaged_record_of_an_earlier_type_is_left_out(void **state)
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
  assert_non_null(strstr(message, "not one sound record"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      MERGE_TEST(a_damaged_record_is_refused_and_by_salvage_left_out_and_named),
      MERGE_TEST(records_damaged_one_behind_the_other_are_counted),
      MERGE_TEST(a_record_without_a_trace_is_counted),
      MERGE_TEST(another_file_has_what_one_has_lost),
      MERGE_TEST(of_a_file_that_is_cut_all_before_the_cut_is_found),
      MERGE_TEST(a_damaged_unit_is_told),
      MERGE_TEST(wherever_a_file_is_damaged_the_rest_is_found),
      MERGE_TEST(records_beyond_the_counter_are_taken),
      MERGE_TEST(a_counter_that_cannot_be_is_not_believed),
      MERGE_TEST(nodes_of_another_grid_are_left_out),
      MERGE_TEST(a_damaged_file_of_other_tissue_is_refused),
      MERGE_TEST(a_file_that_does_not_tell_its_tissue_is_left_out),
      MERGE_TEST(a_changed_description_is_not_believed),
      MERGE_TEST(a_damaged_grid_is_not_believed),
      MERGE_TEST(a_damaged_record_of_an_earlier_type_is_left_out),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
