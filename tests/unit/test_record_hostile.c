/* Files that hold what lamella never writes: refused by name before memory is taken or another file is opened. */
#define _GNU_SOURCE /* memmem */
#include "record_bytes.h"

/* A sound file of two records, open for changes. */
static hid_t OpenSound(void)
{
  WriteFile(2);
  return OpenFile(path);
}

/* Puts a dataset of nothing in the place of `name`, and closes the file. */
static void Replace(hid_t file, const char name[], hid_t type, hid_t space, hid_t list)
{
  assert_true(H5Ldelete(file, name, H5P_DEFAULT) >= 0);
  assert_true(H5Dcreate2(file, name, type, space, H5P_DEFAULT, list, H5P_DEFAULT) >= 0);
  H5Fclose(file);
}

static hid_t TextType(size_t bytes)
{
  const hid_t type = H5Tcopy(H5T_C_S1);

  assert_true(H5Tset_size(type, bytes) >= 0);
  return type;
}

static void AssertTextUnreadable(const char part[])
{
  PetscBool found;
  char *text;

  assert_int_equal(LamFileReadText(path, "/scene", &found, &text), PETSC_ERR_USER_INPUT);
  AssertMessage(part);
}

/* ---- sizes ---- */

FILE_TEST(a_text_longer_than_the_file_is_refused)
{
  Replace(OpenSound(), "/scene", TextType((size_t)1 << 31), H5Screate(H5S_SCALAR), H5P_DEFAULT);
  AssertTextUnreadable("is said to have");
}

static void AssertArrayUnreadable(int rank, const hsize_t dims[], const char part[])
{
  PetscInt read_rank, read[4];
  PetscReal *values;
  PetscBool found;

  Replace(OpenSound(), "/scene", H5T_IEEE_F64LE, H5Screate_simple(rank, dims, NULL), H5P_DEFAULT);
  assert_int_equal(LamFileReadReals(path, "/scene", &found, &read_rank, read, &values), PETSC_ERR_USER_INPUT);
  AssertMessage(part);
}

FILE_TEST(an_array_longer_than_the_file_is_refused)
{
  AssertArrayUnreadable(4, (hsize_t[]){1 << 20, 1 << 20, 1 << 10, 2}, "is said to have");
}

FILE_TEST(an_array_of_many_dimensions_is_refused)
{
  AssertArrayUnreadable(9, (hsize_t[]){1, 1, 1, 1, 1, 1, 1, 1, 1}, "rank 9");
}

/* The counter's checksum is right: whoever makes such a file can make that too. */
FILE_TEST(more_records_than_the_file_has_room_for_are_refused)
{
  const hsize_t extent = (hsize_t)1 << 60;
  const PetscInt64 count = 1 << 30;
  const uint32_t sum = LamBytesSum(0, &count, sizeof(count));
  const hid_t file = OpenSound(), records = H5Dopen2(file, "/records", H5P_DEFAULT);

  assert_true(H5Dset_extent(records, &extent) >= 0);
  assert_int_equal(LamAttributeUpdate(path, records, "committed", H5T_NATIVE_INT64, &count), 0);
  assert_int_equal(LamAttributeUpdate(path, records, LAM_COUNTER_SUM, H5T_NATIVE_UINT32, &sum), 0);
  H5Fclose(file);
  AssertUnreadable("1073741824 records of");
}

FILE_TEST(a_long_attribute_is_refused)
{
  const hid_t file = OpenSound();
  char *text = calloc(60001, 1);

  memset(text, 'x', 60000); /* taken, but not the header that was summed */
  H5Adelete(file, "host");
  assert_int_equal(LamAttributeWriteText(path, file, "host", text), 0);
  H5Fclose(file);
  free(text);
  AssertUnreadable("header is damaged");
}

/* ---- types ---- */

FILE_TEST(a_number_of_another_type_is_refused)
{
  const hid_t file = OpenSound();
  const float one = 1;

  H5Adelete(file, "accuracy");
  assert_int_equal(LamAttributeWriteNumber(path, file, "accuracy", H5T_IEEE_F32BE, H5T_NATIVE_FLOAT, &one), 0);
  H5Fclose(file);
  AssertUnreadable("\"accuracy\" is of another type");
}

FILE_TEST(a_text_of_variable_length_is_refused)
{
  Replace(OpenSound(), "/scene", TextType(H5T_VARIABLE), H5Screate(H5S_SCALAR), H5P_DEFAULT);
  AssertTextUnreadable("/scene is of another type");
}

FILE_TEST(a_list_of_texts_is_refused)
{
  const hsize_t three = 3;

  Replace(OpenSound(), "/scene", TextType(2), H5Screate_simple(1, &three, NULL), H5P_DEFAULT);
  AssertTextUnreadable("is not one text");
}

FILE_TEST(a_folder_in_the_place_of_records_is_refused)
{
  const hid_t file = OpenSound();

  H5Ldelete(file, "/records", H5P_DEFAULT);
  H5Gcreate2(file, "/records", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  AssertUnreadable("not a dataset");
}

/* ---- data that are elsewhere ---- */

FILE_TEST(a_soft_link_is_refused)
{
  const hid_t file = OpenSound();

  H5Ldelete(file, "/scene", H5P_DEFAULT);
  H5Lcreate_soft("/scene", file, "/scene", H5P_DEFAULT, H5P_DEFAULT); /* to itself */
  H5Fclose(file);
  AssertTextUnreadable("/scene is a link to elsewhere");
}

FILE_TEST(records_behind_a_link_to_another_file_are_refused)
{
  const hid_t file = OpenSound();

  H5Ldelete(file, "/records", H5P_DEFAULT);
  H5Lcreate_external("other.h5", "/records", file, "/records", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  AssertUnreadable("/records is a link to elsewhere");
}

FILE_TEST(a_text_in_another_file_is_refused)
{
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);

  H5Pset_external(list, "/etc/hostname", 0, 4);
  Replace(OpenSound(), "/scene", TextType(4), H5Screate(H5S_SCALAR), list);
  AssertTextUnreadable("in another file");
}

FILE_TEST(virtual_records_are_refused)
{
  const hsize_t count = 4;
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &count, NULL);
  hid_t type;

  assert_int_equal(LamRecordTypeCreate(&type), 0);
  assert_true(H5Pset_virtual(list, space, "other.h5", "/records", space) >= 0);
  Replace(OpenSound(), "/records", type, space, list);
  AssertUnreadable("/records is compressed, in another file");
}

FILE_TEST(compressed_records_are_refused)
{
  const hsize_t count = 4, chunk = 4;
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &count, NULL);
  hid_t type;

  assert_int_equal(LamRecordTypeCreate(&type), 0);
  H5Pset_chunk(list, 1, &chunk);
  H5Pset_shuffle(list);
  Replace(OpenSound(), "/records", type, space, list);
  AssertUnreadable("/records is compressed");
}
