/* Merging databases: each question once, in the order of the files, and all of it or nothing. */
#define _GNU_SOURCE /* memmem */
#include "merge_fixture.h"
#include "support/tissue.h"
#include <signal.h>
#include <sys/resource.h>

/* ---- what is kept ---- */

MERGE_TEST(records_come_in_the_order_of_the_files)
{
  const PetscInt64 keys[] = {Node(3), Node(4), Node(1), Node(2)}, *found;
  const LamResponse *records;
  PetscInt n;

  WriteShard(0, 2, keys);
  WriteShard(1, 2, keys + 2);
  MergeShards(2, 0);
  records = OpenRecords(&n, &found);
  assert_int_equal(n, 4);
  for (int i = 0; i < 4; i++) {
    const LamResponse wanted = NodeResponse(keys[i]);

    assert_true(found[i] == keys[i]);
    AssertSame(&records[i], &wanted);
  }
}

MERGE_TEST(a_node_comes_once_whatever_its_time)
{
  const PetscInt64 keys[] = {Node(1), Node(2), Node(3)};
  LamResponse r = NodeResponse(keys[0]);

  WriteShard(0, 3, keys);
  r.seconds += 1;
  WriteRecords(1, 1, keys, &r);
  MergeShards(2, 0);
  assert_int_equal(report.records, 3);
  assert_int_equal(report.duplicates, 1);
  assert_int_equal(report.differing, 0);
}

MERGE_TEST(of_two_answers_the_first_is_kept_and_their_difference_told)
{
  const PetscInt64 key = Node(1);
  LamResponse r = NodeResponse(key), first = r, kept;

  WriteShard(0, 1, &key);
  r.P[0] *= 1.01;
  WriteRecords(1, 1, &key, &r);
  MergeShards(2, 0);
  assert_int_equal(report.duplicates, 1);
  assert_int_equal(report.differing, 1);
  assert_true(report.difference == StressError(r.P, first.P));
  kept = OnlyRecord();
  AssertSame(&kept, &first);
}

MERGE_TEST(iterations_that_differ_are_a_difference)
{
  const PetscInt64 key = Node(1);
  LamResponse r = NodeResponse(key);

  WriteShard(0, 1, &key);
  r.newton_iterations++;
  WriteRecords(1, 1, &key, &r);
  MergeShards(2, 0);
  assert_int_equal(report.differing, 1);
  assert_true(report.difference == 0);
}

/* Also where the first one has been written to the file long ago. */
MERGE_TEST(an_answer_goes_before_a_failure)
{
  const PetscInt count = 1100;
  PetscInt64 *keys = calloc((size_t)count, sizeof(*keys));
  LamResponse failed, wanted;

  for (PetscInt i = 0; i < count; i++) keys[i] = Node((int)i);
  wanted = failed = NodeResponse(keys[0]);
  failed.status = LAM_NOT_CONVERGED;
  WriteRecords(0, 1, keys, &failed);
  WriteShard(1, count - 1, keys + 1);
  WriteRecords(2, 1, keys, &wanted);
  MergeShards(3, 0);
  assert_int_equal(report.records, count);
  AssertRecord(0, keys[0], &wanted);
  unlink(path);
  MergeShards(3, 2); /* the answer first */
  AssertRecord(0, keys[0], &wanted);
  free(keys);
}

MERGE_TEST(states_of_a_cache_get_new_keys_and_come_once)
{
  const PetscInt64 keys[] = {LAM_CACHE_KEY, LAM_CACHE_KEY + 1};
  LamResponse r[3];

  for (int i = 0; i < 3; i++) {
    r[i] = Response(6 * (i + 1));
    r[i].load = (LamLoad){.F = {1, 0.1 * i, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.1};
  }
  WriteRecords(0, 2, keys, r);
  WriteRecords(1, 2, keys, r + 1);
  MergeShards(2, 0);
  assert_int_equal(report.records, 3);
  assert_int_equal(report.duplicates, 1);
  for (int i = 0; i < 3; i++) AssertRecord(i, LAM_CACHE_KEY + i, &r[i]);
}

MERGE_TEST(samples_with_one_number_and_two_loads_are_two)
{
  const PetscInt64 keys[] = {0, 1};
  LamResponse r[2] = {Response(0), Response(6)}, other = r[0];

  other.load.F[1] = 0.2;
  WriteRecords(0, 2, keys, r);
  WriteRecords(1, 1, keys, &other);
  MergeShards(2, 0);
  assert_int_equal(report.records, 3);
  AssertRecord(2, 0, &other);
}

static int CompareKeys(const void *a, const void *b)
{
  const PetscInt64 p = *(const PetscInt64 *)a, q = *(const PetscInt64 *)b;

  return (p > q) - (p < q);
}

/* All members but times and checksums, by key. */
MERGE_TEST(the_content_does_not_depend_on_the_order)
{
  PetscInt64 keys[30], found[30], *sorted[2];

  for (int i = 0; i < 30; i++) keys[i] = Node(i);
  for (int s = 0; s < 3; s++) WriteShard(s, 14, keys + 8 * s);
  for (int turn = 0; turn < 2; turn++) {
    const PetscInt64 *borrowed;
    PetscInt n;

    MergeShards(3, turn);
    OpenRecords(&n, &borrowed);
    assert_int_equal(n, 30);
    memcpy(found, borrowed, sizeof(found)); /* until the file is opened again */
    sorted[turn] = malloc(sizeof(keys));
    memcpy(sorted[turn], found, sizeof(keys));
    qsort(sorted[turn], 30, sizeof(*keys), CompareKeys);
    for (PetscInt i = 0; i < n; i++) {
      const LamResponse wanted = NodeResponse(found[i]);

      AssertRecord(i, found[i], &wanted);
    }
    unlink(path);
  }
  assert_memory_equal(sorted[0], sorted[1], sizeof(keys));
  free(sorted[0]);
  free(sorted[1]);
}

MERGE_TEST(the_header_is_of_the_first_file_with_the_smallest_accuracy)
{
  const PetscInt64 keys[] = {Node(1), Node(2)};
  LamMicrostructure micro;
  LamScene scene = ShardScene();
  LamScales scales;
  const char *json;
  OWNED(LamDatabase, LamDatabaseClose) db;

  WriteShard(0, 1, keys);
  scene.accuracy = 0.001;
  scene.scales.length = 1e-4;
  WriteOf(&scene, 1, 1, keys + 1, NULL);
  MergeShards(2, 0);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  LamDatabaseGetMicrostructure(db, &micro, &scales, NULL);
  assert_true(scales.length == ShardScene().scales.length);
  LamDatabaseGetInfo(db, &json);
  assert_non_null(strstr(json, "\"accuracy\":0.001"));
}

MERGE_TEST(records_of_an_earlier_type_get_the_present_one)
{
  const PetscInt64 key = Node(1), later = Node(2);
  LamResponse wanted = NodeResponse(key);
  LamScene scene = ShardScene();
  LamRecordWriter writer;

  WriteShard(0, 1, &key);
  RemoveMember(0, "min_gap", &key, &wanted);
  MergeShards(1, 0);
  wanted.min_gap = NAN;
  AssertRecord(0, key, &wanted);
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_APPEND, &scene, &writer), 0);
  assert_int_equal(LamRecordWriterCommit(writer, 1, &later, &wanted), 0);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
}

/* ---- what is refused ---- */

static void AssertRefused(PetscInt n, const char part[])
{
  assert_int_equal(TryShards(n, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  AssertMessage(part);
  AssertNothingLeft();
}

MERGE_TEST(other_tissue_is_refused_and_both_files_named)
{
  const PetscInt64 key = Node(1);
  LamScene scene = ShardScene();

  WriteShard(0, 1, &key);
  scene.micro.wall_thickness = 0.2;
  WriteOf(&scene, 1, 1, &key, NULL);
  AssertRefused(2, shard_path[0]);
  AssertRefused(2, shard_path[1]);
  AssertRefused(2, "microstructure");
}

MERGE_TEST(another_grid_is_refused_and_both_files_named)
{
  const PetscInt64 key = Node(1);
  LamScene scene = ShardScene();

  WriteShard(0, 1, &key);
  scene.turgor = 0.3;
  WriteOf(&scene, 1, 1, &key, NULL);
  AssertRefused(2, shard_path[0]);
  AssertRefused(2, shard_path[1]);
  AssertRefused(2, LAM_GRID_NAME);
}

MERGE_TEST(a_file_of_another_kind_is_refused)
{
  const PetscInt64 key = 1;
  const LamResponse r = Response(0);
  LamScene scene = ShardScene();
  LamRecordWriter writer;

  assert_int_equal(LamRecordWriterOpen(shard_path[0], "rve", LAM_WRITE_CREATE, &scene, &writer), 0);
  assert_int_equal(LamRecordWriterCommit(writer, 1, &key, &r), 0);
  LamRecordWriterClose(&writer);
  AssertRefused(1, "only databases");
}

MERGE_TEST(a_file_that_is_there_is_not_replaced)
{
  const PetscInt64 keys[] = {Node(1), Node(2)};

  WriteShard(0, 2, keys);
  WriteShard(1, 1, keys);
  MergeShards(1, 1);
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  AssertMessage("exists");
  assert_int_equal(CountRecords(), 1);
}

MERGE_TEST(the_result_may_be_one_of_the_files)
{
  const PetscInt64 keys[] = {Node(1), Node(2)};
  const LamMergeOptions options = {0};
  const char *files[2] = {shard_path[0], path};

  WriteShard(0, 1, keys);
  WriteShard(1, 1, keys + 1);
  MergeShards(1, 1);
  assert_int_equal(LamDatabaseMerge(path, 2, files, &options, &report), 0);
  assert_int_equal(CountRecords(), 2);
}

MERGE_TEST(a_file_that_is_written_is_not_replaced)
{
  const PetscInt64 key = Node(1);
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  WriteShard(0, 1, &key);
  assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_FILE_OPEN);
  AssertMessage("has been writing");
  LamRecordWriterClose(&writer);
}

/* ---- all or nothing ---- */

/* The limit on the file's size stands for a full disk. */
MERGE_TEST(a_full_disk_changes_nothing)
{
  const PetscInt count = 600;
  PetscInt64 *keys = calloc((size_t)count, sizeof(*keys));
  const rlim_t sizes[] = {0, 10000, 140000, 300000, 800000, 1100000};
  struct rlimit old, small;

  for (PetscInt i = 0; i < count; i++) keys[i] = Node((int)i);
  WriteShard(0, count, keys);
  getrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, SIG_IGN);
  for (size_t k = 0; k < sizeof(sizes) / sizeof(sizes[0]); k++) {
    small = old;
    small.rlim_cur = sizes[k];
    setrlimit(RLIMIT_FSIZE, &small);
    assert_int_equal(TryShards(1, 0, PETSC_FALSE), PETSC_ERR_FILE_WRITE);
    setrlimit(RLIMIT_FSIZE, &old);
    AssertMessage("File too large");
    AssertNothingLeft();
  }
  free(keys);
}

static PetscBool Stop(void)
{
  return PETSC_TRUE;
}

MERGE_TEST(a_merge_that_is_stopped_leaves_nothing)
{
  const PetscInt64 key = Node(1);
  const LamMergeOptions options = {.stop = Stop};
  const char *files[1] = {shard_path[0]};

  WriteShard(0, 1, &key);
  assert_int_equal(LamDatabaseMerge(path, 1, files, &options, &report), 0);
  assert_true(report.stopped);
  AssertNothingLeft();
}
