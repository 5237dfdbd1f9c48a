/* Checksums beside the records: whatever is changed is noticed; files of earlier versions, which lack them, are read.
 */
#define _GNU_SOURCE /* memmem */
#include <sys/wait.h>
#include "record_bytes.h"

/* Where the bytes of a word begin in the file, its zero included. */
static size_t Find(const char word[])
{
  return PlaceOf(path, strlen(word) + 1, word);
}

/* ---- header ---- */

FILE_TEST(a_changed_number_of_the_header_is_found)
{
  const double other = 0.12e6;

  WriteFile(2);
  SetNumber(path, "/", "stress_unit_Pa", H5T_NATIVE_DOUBLE, &other);
  AssertUnreadable("header is damaged");
}

FILE_TEST(a_changed_text_of_the_header_is_found)
{
  WriteFile(2);
  Overwrite(path, Find("row-major, 11 12 13 21 22 23 31 32 33; tangent[i][j][k][l] = dP_ij/dF_kl"), 1, "c");
  AssertUnreadable("header is damaged");
}

/* ---- records ---- */

/* Fewer records than there are would be lost without a word. */
FILE_TEST(a_lowered_counter_is_found)
{
  const long long count = 3;

  WriteFile(7);
  SetNumber(path, "/records", "committed", H5T_NATIVE_LLONG, &count);
  AssertUnreadable("commit counter of /records is damaged (it says 3)");
}

/* A member that files may lack, under a name that nobody looks for. */
FILE_TEST(a_renamed_member_is_found)
{
  WriteFile(2);
  Overwrite(path, Find("mean_gap"), 1, "n");
  AssertUnreadable("names of the members of /records are damaged");
}

/* What a wrong index of HDF5 would do: the second chunk is read in the place of the first. */
FILE_TEST(records_in_the_place_of_others_are_found)
{
  hsize_t chunks, offset, bytes;
  haddr_t address[2];
  unsigned filters;
  unsigned char *all;
  hid_t file, dataset, space;
  size_t n;

  WriteFile(2 * LAM_RECORDS_PER_CHUNK);
  file = OpenFile(path);
  dataset = H5Dopen2(file, "/records", H5P_DEFAULT);
  space = H5Dget_space(dataset);
  H5Dget_num_chunks(dataset, space, &chunks);
  assert_int_equal(chunks, 2);
  for (hsize_t i = 0; i < 2; i++) H5Dget_chunk_info(dataset, space, i, &offset, &filters, &address[i], &bytes);
  H5Fclose(file);
  all = Bytes(path, &n);
  Overwrite(path, address[0], bytes, all + address[1]);
  free(all);
  AssertUnreadable("stands in the place of another");
}

/* One write carries them all, and no kill or lost power comes between the bytes of a sector. */
FILE_TEST(the_counter_and_its_checksums_lie_in_one_sector)
{
  size_t first, last;

  WriteFile(1);
  first = Find("committed");
  last = Find("records_check") + 64;
  assert_int_equal(first / 512, last / 512);
  assert_true(Find("committed_check") > first && Find("committed_check") < last);
}

FILE_TEST(nodes_without_their_grid_are_refused)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, LAM_NODE_KEY, 2);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  AssertUnreadable("/table/grid is missing");
}

/* ---- earlier versions ---- */

static void DeleteSums(void)
{
  const hid_t file = OpenFile(path), records = H5Dopen2(file, "/records", H5P_DEFAULT);

  assert_true(H5Adelete(file, LAM_SUM) >= 0 && H5Adelete(records, LAM_COUNTER_SUM) >= 0);
  assert_true(H5Adelete(records, LAM_RECORDS_SUM) >= 0 && H5Adelete(records, LAM_TYPE_SUM) >= 0);
  assert_true(H5Adelete_by_name(file, "/scene", LAM_SUM, H5P_DEFAULT) >= 0);
  H5Fclose(file);
}

FILE_TEST(a_file_without_checksums_is_read_and_appended_to)
{
  LamRecordWriter writer;

  WriteFile(70);
  DeleteSums();
  writer = Open(LAM_WRITE_APPEND);
  Commit(writer, 70, 3);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(CountRecords(), 73);
}

/* ---- texts and arrays ---- */

FILE_TEST(a_changed_text_is_found)
{
  PetscBool found;
  char *text;

  WriteFile(1);
  Overwrite(path, Find("version: 1\n"), 1, "w");
  assert_int_equal(LamFileReadText(path, "/scene", &found, &text), PETSC_ERR_USER_INPUT);
  AssertMessage("/scene is damaged (its checksum differs)");
}

static void WriteArray(PetscInt times)
{
  const PetscInt dims[1] = {3};
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  for (PetscInt i = 0; i < times; i++) {
    const PetscReal values[3] = {0.125, -7, (double)i};

    assert_int_equal(LamRecordWriterReals(writer, "/fields/gap", 1, dims, values, "apothem"), 0);
  }
  assert_int_equal(LamRecordWriterClose(&writer), 0);
}

static PetscErrorCode ReadArray(void)
{
  PetscInt rank, dims[4];
  PetscReal *values = NULL;
  PetscBool found;
  PetscErrorCode ierr = LamFileReadReals(path, "/fields/gap", &found, &rank, dims, &values);

  PetscFree(values);
  return ierr;
}

FILE_TEST(a_changed_unit_of_an_array_is_found)
{
  WriteArray(1);
  assert_int_equal(ReadArray(), 0);
  Overwrite(path, Find("apothem"), 1, "b");
  assert_int_equal(ReadArray(), PETSC_ERR_USER_INPUT);
  AssertMessage("/fields/gap is damaged");
}

FILE_TEST(an_array_that_was_written_over_has_no_checksum)
{
  WriteArray(3);
  assert_int_equal(ReadArray(), 0);
  Overwrite(path, Find("apothem"), 1, "b");
  assert_int_equal(ReadArray(), 0);
}

/* ---- any bit ---- */

/* FNV-1a of the records, and of what the file says of itself. */
static uint64_t Content(void)
{
  const LamResponse *records;
  const char *json;
  uint64_t hash = 14695981039346656037u;
  LamDatabase db;
  PetscInt n;

  if (LamDatabaseOpen(path, &db)) return 0;
  LamDatabaseGetRecords(db, &n, &records, NULL);
  LamDatabaseGetInfo(db, &json);
  for (size_t i = 0; json[i]; i++) hash = (hash ^ (unsigned char)json[i]) * 1099511628211u;
  for (PetscInt i = 0; i < n; i++) hash = (hash ^ (uint64_t)records[i].newton_iterations) * 1099511628211u;
  LamDatabaseClose(&db);
  return hash;
}

/* In a process of its own: 0 refused, 1 as before, 2 otherwise, 3 the process did not end well. */
static int Outcome(uint64_t wanted)
{
  const pid_t child = fork();
  int status;

  if (child == 0) {
    uint64_t found;

    alarm(10);
    found = Content();
    _exit(found == 0 ? 0 : found == wanted ? 1 : 2);
  }
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 3;
}

/* Every 1009th bit of what is not records, which come last in the file; bench_damage takes all of them. */
FILE_TEST(a_flipped_bit_is_found_or_has_no_effect)
{
  uint64_t wanted;
  unsigned char *bytes;
  size_t n, end;

  WriteFile(3);
  end = Find("reason 0") - 2048;
  bytes = Bytes(path, &n);
  wanted = Content();
  for (size_t bit = 0; bit < 8 * end; bit += 1009) {
    const unsigned char flipped = (unsigned char)(bytes[bit / 8] ^ 1 << bit % 8);
    int outcome;

    Overwrite(path, bit / 8, 1, &flipped);
    outcome = Outcome(wanted);
    Overwrite(path, bit / 8, 1, &bytes[bit / 8]);
    if (outcome > 1) fail_msg("byte %zu bit %zu: %s", bit / 8, bit % 8, outcome > 2 ? "no end" : "read otherwise");
  }
  free(bytes);
}
