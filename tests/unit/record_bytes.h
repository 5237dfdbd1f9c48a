/* Files that are changed behind the library's back: bytes, attributes, and records of another type. The includer
   defines _GNU_SOURCE, for memmem. */
#ifndef LAM_RECORD_BYTES_H
#define LAM_RECORD_BYTES_H

#include <hdf5.h>
#include <fcntl.h>
#include <sys/stat.h>
#include "record_fixture.h"
#include "record_internal.h"

/* The whole file; the caller frees it. */
static inline unsigned char *Bytes(const char file[], size_t *n)
{
  const int fd = open(file, O_RDONLY);
  unsigned char *bytes;
  struct stat info;

  assert_int_equal(fstat(fd, &info), 0);
  *n = (size_t)info.st_size;
  bytes = malloc(*n);
  assert_int_equal(read(fd, bytes, *n), *n);
  close(fd);
  return bytes;
}

static inline void Overwrite(const char file[], size_t place, size_t n, const void *bytes)
{
  const int fd = open(file, O_WRONLY);

  assert_int_equal(pwrite(fd, bytes, n, (off_t)place), n);
  close(fd);
}

/* Where these bytes begin in the file. */
static inline size_t PlaceOf(const char file[], size_t n, const void *wanted)
{
  size_t size;
  unsigned char *bytes = Bytes(file, &size);
  const unsigned char *at = memmem(bytes, size, wanted, n);
  const size_t place = (size_t)(at - bytes);

  assert_non_null(at);
  free(bytes);
  return place;
}

/* H5Fclose closes all that was opened in it. */
static inline hid_t OpenFile(const char name[])
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS), file;

  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  file = H5Fopen(name, H5F_ACC_RDWR, access);
  assert_true(file >= 0);
  H5Pclose(access);
  return file;
}

static inline void SetNumber(const char name[], const char object[], const char attribute[], hid_t type,
                             const void *value)
{
  const hid_t file = OpenFile(name);

  assert_true(H5Awrite(H5Aopen(H5Oopen(file, object, H5P_DEFAULT), attribute, H5P_DEFAULT), type, value) >= 0);
  H5Fclose(file);
}

/* Changes a bit of a record behind its key. */
static inline void DamageRecord(hsize_t number)
{
  const hid_t file = OpenFile(path), dataset = H5Dopen2(file, "/records", H5P_DEFAULT), type = H5Dget_type(dataset);
  const hid_t space = H5Dget_space(dataset), one = H5Screate(H5S_SCALAR);
  unsigned char *bytes = malloc(H5Tget_size(type));

  H5Sselect_elements(space, H5S_SELECT_SET, 1, &number);
  assert_true(H5Dread(dataset, type, one, space, H5P_DEFAULT, bytes) >= 0);
  bytes[200] ^= 4;
  assert_true(H5Dwrite(dataset, type, one, space, H5P_DEFAULT, bytes) >= 0);
  free(bytes);
  H5Fclose(file);
}

/* Our record type without the members that `removed` names, each between blanks, but with a number named `added` before
   the checksum, where not NULL. */
static inline hid_t ChangedType(const char removed[], const char added[])
{
  hid_t ours, type;
  size_t end = 0;

  assert_int_equal(LamRecordTypeCreate(&ours), 0);
  type = H5Tcreate(H5T_COMPOUND, H5Tget_size(ours) + sizeof(double));
  for (int i = 0; i + 1 < H5Tget_nmembers(ours); i++) {
    char *name = H5Tget_member_name(ours, (unsigned)i), word[80];
    const hid_t member = H5Tget_member_type(ours, (unsigned)i);

    snprintf(word, sizeof(word), " %s ", name);
    if (!strstr(removed, word)) {
      H5Tinsert(type, name, end, member);
      end += H5Tget_size(member);
    }
    H5Tclose(member);
    H5free_memory(name);
  }
  if (added) {
    H5Tinsert(type, added, end, H5T_IEEE_F64LE);
    end += sizeof(double);
  }
  H5Tinsert(type, "checksum", end, H5T_STD_U32LE);
  H5Tset_size(type, end + sizeof(uint32_t));
  H5Tclose(ours);
  return type;
}

/* Puts records of this type, which it closes, into the place of a file's. */
static inline void ReplaceRecords(const char name[], hid_t type, PetscInt n, const PetscInt64 keys[],
                                  const LamResponse records[])
{
  const hsize_t count = (hsize_t)n, unlimited = H5S_UNLIMITED, chunk = 64;
  const hid_t space = H5Screate_simple(1, &count, &unlimited), list = H5Pcreate(H5P_DATASET_CREATE);
  const hid_t scalar = H5Screate(H5S_SCALAR), file = OpenFile(name);
  const PetscInt64 committed = n;
  hid_t dataset, attribute;
  void *bytes;

  assert_int_equal(LamRecordsPack(n, keys, records, type, &bytes), 0);
  H5Pset_chunk(list, 1, &chunk);
  H5Ldelete(file, "/records", H5P_DEFAULT);
  dataset = H5Dcreate2(file, "/records", type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
  attribute = H5Acreate2(dataset, "committed", H5T_STD_I64LE, scalar, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_INT64, &committed);
  H5Fclose(file);
  H5Pclose(list);
  H5Sclose(space);
  H5Sclose(scalar);
  H5Tclose(type);
  PetscFree(bytes);
}

#endif
