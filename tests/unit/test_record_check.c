/* LamFileCheck: each damaged record and part is named, also behind the first. */
#define _GNU_SOURCE /* memmem */
#include <jansson.h>
#include "record_bytes.h"

static json_t *Check(void)
{
  PetscBool sound;
  json_t *check;
  char *text;

  assert_int_equal(LamFileCheck(path, NULL, &sound, &text), 0);
  check = json_loads(text, 0, NULL);
  assert_non_null(check);
  assert_int_equal(sound, json_is_true(json_object_get(check, "sound")));
  assert_int_equal(sound, !json_array_size(json_object_get(check, "damaged")));
  PetscFree(text);
  return check;
}

static json_int_t Integer(const json_t *object, const char name[])
{
  assert_true(json_is_integer(json_object_get(object, name)));
  return json_integer_value(json_object_get(object, name));
}

static const json_t *Damaged(const json_t *check, size_t i)
{
  return json_array_get(json_object_get(check, "damaged"), i);
}

static void Replace(const char name[], const char by[])
{
  const hid_t file = OpenFile(path), dataset = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(dataset);

  assert_true(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, by) >= 0);
  H5Fclose(file);
}

FILE_TEST(a_sound_file_is_sound_and_wholly_checked)
{
  WriteFile(700);
  json_auto_t *check = Check();
  assert_true(json_is_true(json_object_get(check, "sound")));
  assert_int_equal(Integer(check, "records"), 700);
  assert_int_equal(Integer(check, "sound_records"), 700);
  assert_int_equal(json_array_size(json_object_get(check, "unchecked")), 0);
}

/* Changes where the k-th index of a group or of the records, in the order of the file, says that it goes on: nowhere in
   sound files that are small. PETSC_FALSE: there is none. */
static PetscBool DamageIndex(int k)
{
  FILE *file = fopen(path, "r+");
  unsigned char bytes[32768];
  const size_t n = fread(bytes, 1, sizeof(bytes), file);
  const unsigned char *place = bytes - 1;

  while (k-- >= 0 && place) place = memmem(place + 1, n - (size_t)(place + 1 - bytes), "TREE", 4);
  if (place) {
    fseek(file, place - bytes + 20, SEEK_SET); /* of the address of the one behind it */
    fputc(0x7f, file);
  }
  fclose(file);
  return (PetscBool)(place != NULL);
}

/* Lamella reads such a file, other programs do not. */
FILE_TEST(an_index_that_leads_nowhere_is_damage)
{
  for (int k = 0;; k++) {
    json_t *check;

    WriteFile(3);
    if (!DamageIndex(k)) {
      assert_true(k >= 3); /* of /, /microstructures and what it holds */
      return;
    }
    check = Check();
    if (json_is_true(json_object_get(check, "sound"))) fail_msg("index %d", k);
    json_decref(check);
    unlink(path);
  }
}

FILE_TEST(each_damaged_record_is_named_with_its_key)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);
  const hsize_t numbers[3] = {3, 63, 699};

  Commit(writer, 1000, 700);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  for (int i = 0; i < 3; i++) DamageRecord(numbers[i]);
  json_auto_t *check = Check();
  assert_int_equal(Integer(check, "sound_records"), 697);
  assert_int_equal(json_array_size(json_object_get(check, "damaged")), 3);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(Integer(Damaged(check, (size_t)i), "record"), numbers[i]);
    assert_int_equal(Integer(Damaged(check, (size_t)i), "key"), 1000 + numbers[i]);
  }
}

FILE_TEST(damage_of_a_record_does_not_hide_that_of_a_text)
{
  WriteFile(5);
  DamageRecord(2);
  Replace("/scene", "version: 2\n");
  json_auto_t *check = Check();
  assert_int_equal(json_array_size(json_object_get(check, "damaged")), 2);
  assert_int_equal(Integer(Damaged(check, 0), "record"), 2);
  assert_string_equal(json_string_value(json_object_get(Damaged(check, 1), "part")), "/scene");
}

/* What is sound can be told without it. */
FILE_TEST(records_are_counted_where_the_counter_is_damaged)
{
  const PetscInt64 wrong = 1;
  hid_t file;

  WriteFile(9);
  file = OpenFile(path);
  assert_int_equal(
      LamAttributeUpdate(path, H5Dopen2(file, "/records", H5P_DEFAULT), "committed", H5T_NATIVE_INT64, &wrong), 0);
  H5Fclose(file);
  json_auto_t *check = Check();
  assert_true(json_is_null(json_object_get(check, "records")));
  assert_int_equal(Integer(check, "sound_records"), 9);
  assert_string_equal(json_string_value(json_object_get(Damaged(check, 0), "part")), "commit counter");
}

FILE_TEST(parts_without_a_checksum_are_named)
{
  hid_t file;

  WriteFile(2);
  file = OpenFile(path);
  assert_true(H5Adelete(file, LAM_SUM) >= 0);
  H5Fclose(file);
  json_auto_t *check = Check();
  assert_true(json_is_true(json_object_get(check, "sound")));
  assert_string_equal(json_string_value(json_array_get(json_object_get(check, "unchecked"), 0)), "header");
}

FILE_TEST(a_file_that_is_being_written_is_checked_and_its_writer_named)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);
  json_t *check;

  Commit(writer, 0, 3);
  check = Check();
  assert_true(json_is_true(json_object_get(check, "sound")));
  assert_int_equal(Integer(json_object_get(check, "writer"), "process"), getpid());
  json_decref(check);
  Commit(writer, 3, 3);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  check = Check();
  assert_true(json_is_null(json_object_get(check, "writer")));
  assert_int_equal(Integer(check, "sound_records"), 6);
  json_decref(check);
}

FILE_TEST(what_is_no_file_of_lamella_is_damaged)
{
  FILE *file = fopen(path, "w");

  fputs("version: 1\n", file);
  fclose(file);
  json_auto_t *check = Check();
  assert_string_equal(json_string_value(json_object_get(Damaged(check, 0), "part")), "file");
}

FILE_TEST(a_missing_file_is_an_error)
{
  PetscBool sound;
  char *text;

  assert_int_equal(LamFileCheck(path, NULL, &sound, &text), PETSC_ERR_FILE_OPEN);
  AssertMessage("No such file");
}
