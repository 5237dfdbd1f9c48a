/* What a new file may replace: an empty file, or one of the same kind. Links are followed. */
#include "record_fixture.h"
#include <hdf5.h>
#include <sys/stat.h>

static void WriteText(const char text[])
{
  FILE *file = fopen(path, "w");

  fputs(text, file);
  fclose(file);
}

static void AssertRefused(const char kind[], const char part[])
{
  LamScene scene = Scene();
  LamRecordWriter writer;
  struct stat status;

  assert_int_equal(LamRecordWriterOpen(path, kind, LAM_WRITE_CREATE, &scene, &writer), PETSC_ERR_USER_INPUT);
  AssertMessage(part);
  AssertMessage(path);
  assert_null(writer);
  assert_int_not_equal(stat(lock_path, &status), 0);
}

FILE_TEST(a_text_is_not_replaced)
{
  struct stat status;

  WriteText("version: 1\n");
  AssertRefused("database", "exists and is not a file of lamella");
  assert_int_equal(stat(path, &status), 0);
  assert_int_equal(status.st_size, 11);
}

FILE_TEST(a_foreign_hdf5_file_is_not_replaced)
{
  H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  AssertRefused("database", "exists and is not a file of lamella");
}

FILE_TEST(a_damaged_file_is_not_replaced)
{
  WriteFile(3);
  assert_int_equal(truncate(path, 3000), 0);
  AssertRefused("database", "or a damaged one");
}

FILE_TEST(a_file_of_another_kind_is_not_replaced)
{
  WriteFile(3);
  AssertRefused("rve", "exists and is of kind \"database\"");
  assert_int_equal(CountRecords(), 3);
}

FILE_TEST(a_folder_is_not_replaced)
{
  assert_int_equal(mkdir(path, 0777), 0);
  AssertRefused("database", "exists and is a folder");
  assert_int_equal(rmdir(path), 0);
}

FILE_TEST(a_pipe_is_not_replaced)
{
  struct stat status;

  assert_int_equal(mkfifo(path, 0666), 0);
  AssertRefused("database", "exists and is a device, pipe or socket");
  assert_true(!lstat(path, &status) && S_ISFIFO(status.st_mode));
}

FILE_TEST(a_link_to_nothing_is_refused)
{
  assert_int_equal(symlink("nowhere.h5", path), 0);
  AssertRefused("database", "a link that leads to no file");
}

FILE_TEST(an_empty_file_is_replaced)
{
  LamRecordWriter writer;

  WriteText("");
  writer = Open(LAM_WRITE_CREATE);
  Commit(writer, 0, 2);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(CountRecords(), 2);
}

/* The second writer meets the lock of the first under the file's other name. */
FILE_TEST(a_link_stays_and_its_file_is_written)
{
  char real[160];
  LamScene scene = Scene();
  LamRecordWriter writer, second;
  struct stat status;

  WriteFile(5);
  snprintf(real, sizeof(real), "%s/real.h5", directory);
  assert_int_equal(rename(path, real), 0);
  assert_int_equal(symlink("real.h5", path), 0);
  writer = Open(LAM_WRITE_CREATE);
  assert_int_equal(LamRecordWriterOpen(real, "database", LAM_WRITE_APPEND, &scene, &second), PETSC_ERR_FILE_OPEN);
  Commit(writer, 0, 2);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_true(!lstat(path, &status) && S_ISLNK(status.st_mode));
  assert_int_equal(CountRecords(), 2);
  assert_int_equal(unlink(real), 0);
}
