/* Record files: what is committed stays and comes back; arrays and texts beside the records. */
#include "record_fixture.h"
#include <hdf5.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

FILE_TEST(records_come_back_bit_for_bit)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscInt n;

  WriteFile(12);
  records = OpenRecords(&n, &keys);
  assert_int_equal(n, 12);
  for (PetscInt i = 0; i < n; i++) {
    const LamResponse wanted = Response(i);

    assert_int_equal(keys[i], i);
    AssertSame(&records[i], &wanted);
  }
}

FILE_TEST(appending_goes_on_behind_the_records)
{
  LamRecordWriter writer;
  const PetscInt64 *keys;
  PetscInt n;

  WriteFile(70);
  writer = Open(LAM_WRITE_APPEND);
  LamRecordWriterGetKeys(writer, &n, &keys);
  assert_int_equal(n, 70);
  assert_int_equal(keys[69], 69);
  Commit(writer, 70, 5);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(CountRecords(), 75);
}

FILE_TEST(appending_to_nothing_starts_a_file)
{
  LamRecordWriter writer = Open(LAM_WRITE_APPEND);

  Commit(writer, 0, 1);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(CountRecords(), 1);
}

FILE_TEST(the_microstructure_and_the_scales_come_back)
{
  const LamScene scene = Scene();
  LamMicrostructure micro;
  LamScales scales;
  OWNED(LamDatabase, LamDatabaseClose) db;

  WriteFile(1);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  LamDatabaseGetMicrostructure(db, &micro, &scales, NULL);
  assert_near(micro.wall.C4, scene.micro.wall.C4, 1e-10);
  assert_near(micro.wall_thickness, 0.15, 1e-14);
  assert_int_equal(micro.along, 6);
  assert_true(scales.stress == 0.11e6 && scales.length == 75e-6);
}

/* The extent is raised by hand, as by a commit that was killed before it raised the counter. */
FILE_TEST(what_is_not_committed_is_ignored_and_overwritten)
{
  const hsize_t more = 20;
  LamRecordWriter writer;
  hid_t file, dataset;

  WriteFile(3);
  file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  dataset = H5Dopen2(file, "/records", H5P_DEFAULT);
  assert_true(H5Dset_extent(dataset, &more) >= 0);
  H5Dclose(dataset);
  H5Fclose(file);
  assert_int_equal(CountRecords(), 3);
  writer = Open(LAM_WRITE_APPEND);
  Commit(writer, 3, 1);
  LamRecordWriterClose(&writer);
  assert_int_equal(CountRecords(), 4);
}

FILE_TEST(the_old_file_stays_until_the_first_commit)
{
  LamRecordWriter writer;

  WriteFile(5);
  writer = Open(LAM_WRITE_CREATE);
  assert_int_equal(CountRecords(), 5);
  Commit(writer, 0, 2);
  assert_int_equal(CountRecords(), 2);
  LamRecordWriterClose(&writer);
}

FILE_TEST(a_reader_is_not_shut_out_by_a_writer)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, 0, 2);
  assert_int_equal(CountRecords(), 2);
  Commit(writer, 2, 2);
  assert_int_equal(CountRecords(), 4);
  LamRecordWriterClose(&writer);
}

FILE_TEST(a_killed_writer_loses_nothing_it_has_committed)
{
  int status, pipes[2], acknowledged = 0, count;
  pid_t child;

  assert_int_equal(pipe(pipes), 0);
  child = fork();
  if (child == 0) {
    LamRecordWriter writer = Open(LAM_WRITE_CREATE);

    for (int i = 0;; i++) {
      Commit(writer, i, 1);
      if (write(pipes[1], &i, sizeof(i)) < 0) _exit(1);
    }
  }
  for (int i = 0; i < 8; i++) assert_true(read(pipes[0], &acknowledged, sizeof(acknowledged)) > 0);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  close(pipes[1]);
  while (read(pipes[0], &count, sizeof(count)) > 0) acknowledged = count;
  close(pipes[0]);
  assert_true(CountRecords() >= acknowledged + 1);
}

/* ---- beside the records ---- */

FILE_TEST(arrays_and_texts_come_back)
{
  const PetscInt dims[2] = {2, 3}, numbers[6] = {1, 2, 3, 4, 5, 6};
  const PetscReal values[6] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);
  PetscInt rank, read_dims[4], *ints;
  PetscReal *reals;
  PetscBool found;
  char *text;

  assert_int_equal(LamRecordWriterReals(writer, "/mesh/nodes", 2, dims, values, "apothem"), 0);
  assert_int_equal(LamRecordWriterReals(writer, "/mesh/nodes", 2, dims, values, "apothem"), 0);
  assert_int_equal(LamRecordWriterInts(writer, "/mesh/elements", 2, dims, numbers), 0);
  assert_int_equal(LamRecordWriterText(writer, "/plan", "one cell, µm"), 0);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamFileReadReals(path, "/mesh/nodes", &found, &rank, read_dims, &reals), 0);
  assert_true(found && rank == 2 && read_dims[0] == 2 && read_dims[1] == 3);
  assert_memory_equal(reals, values, sizeof(values));
  assert_int_equal(LamFileReadInts(path, "/mesh/elements", &found, &rank, read_dims, &ints), 0);
  assert_memory_equal(ints, numbers, sizeof(numbers));
  assert_int_equal(LamFileReadText(path, "/plan", &found, &text), 0);
  assert_string_equal(text, "one cell, µm");
  PetscFree(reals);
  PetscFree(ints);
  PetscFree(text);
}

/* A table that is written again and again must not make the file grow. */
FILE_TEST(an_array_of_the_same_shape_is_written_over_in_place)
{
  const PetscInt dims[1] = {1000};
  PetscReal *values, *read;
  PetscInt rank, read_dims[4];
  LamRecordWriter writer;
  struct stat before, after;
  PetscBool found;

  PetscCalloc1(1000, &values);
  WriteFile(1);
  writer = Open(LAM_WRITE_APPEND);
  assert_int_equal(LamRecordWriterReals(writer, "/table", 1, dims, values, "1"), 0);
  assert_int_equal(stat(path, &before), 0);
  for (int i = 1; i <= 20; i++) {
    values[999] = i;
    assert_int_equal(LamRecordWriterReals(writer, "/table", 1, dims, values, "1"), 0);
  }
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(stat(path, &after), 0);
  assert_int_equal(before.st_size, after.st_size);
  assert_int_equal(LamFileReadReals(path, "/table", &found, &rank, read_dims, &read), 0);
  assert_near(read[999], 20, 0);
  PetscFree(read);
  PetscFree(values);
}

FILE_TEST(what_is_not_there_is_not_found)
{
  PetscInt rank, dims[4];
  PetscReal *values;
  PetscBool found;

  WriteFile(1);
  assert_int_equal(LamFileReadReals(path, "/no/such/array", &found, &rank, dims, &values), 0);
  assert_false(found);
}

FILE_TEST(info_counts_records_and_failures)
{
  const char *json;
  OWNED(LamDatabase, LamDatabaseClose) db;

  WriteFile(12);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  assert_int_equal(LamDatabaseGetInfo(db, &json), 0);
  assert_non_null(strstr(json, "\"records\":12,\"failed\":10,\"format_version\":1"));
}
