/*
  Edits by HDF5 of a copy of the file, then of its bytes.

  What makes this fast: the folder is in memory; the copy is written over the last one, whose pages are there; it stays
  open, so that HDF5 opens it for the program by counting a reference; and HDF5 keeps what it allocates.
*/
#include "hdf5_edits.h"
#include "record_internal.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { MOST_FILES = 8, MOST_NAMES = 256, MOST_BYTES = 1 << 20, MOST_EDITS = 8, TEXT_ROOM = 256, UNMENDED = 0x80 };
enum { INPUTS_BETWEEN = 1000 };                                  /* looks for leaks */
enum { ROOM_OF_ALL_LISTS = 16 << 20, ROOM_OF_A_LIST = 4 << 20 }; /* bytes of HDF5's free lists */

typedef struct {
  unsigned char *bytes;
  size_t size;
  char names[MOST_NAMES][64]; /* of its datasets */
  int name_count;
} Sound;

static Sound sound[MOST_FILES];
static int sound_count;

/* The input, as far as it has been read, and the file that is made. */
typedef struct {
  const uint8_t *at, *end;
  const Sound *from;
  const char *path;
  hid_t file; /* open while HDF5 edits it */
  PetscBool mends;
} Edits;

#define PATH "file" /* in messages, which no one reads */

/* ---- the sound files ---- */

static herr_t KeepName(hid_t group, const char name[], const H5L_info_t *info, void *ctx)
{
  Sound *s = ctx;
  H5O_info_t object;

  if (H5Oget_info_by_name2(group, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) < 0) return -1;
  if (object.type != H5O_TYPE_DATASET || !strcmp(name, "records")) return 0;
  FuzzCheck(s->name_count < MOST_NAMES && strlen(name) + 1 < sizeof(s->names[0]), "%s: no room for the name", name);
  snprintf(s->names[s->name_count++], sizeof(s->names[0]), "/%s", name);
  return 0;
}

static hid_t OpenFile(const char path[], unsigned flags)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  hid_t file;

  H5Pset_file_locking(access, 0, 1);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  file = H5Fopen(path, flags, access);
  H5Pclose(access);
  return file;
}

/* Over the last one: that takes half as long as a new file. */
static void WriteCopy(const Sound *s, const char path[])
{
  const int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);

  FuzzCheck(fd >= 0 && pwrite(fd, s->bytes, s->size, 0) == (ssize_t)s->size && !ftruncate(fd, (off_t)s->size),
            "%s cannot be written", path);
  close(fd);
}

static void LoadFile(const char name[], Sound *s)
{
  char path[PETSC_MAX_PATH_LEN];
  gzFile packed;
  hid_t file;
  int size;

  snprintf(path, sizeof(path), "%s/tests/fuzz/files/%s.h5.gz", LAMELLA_SOURCE_DIR, name);
  packed = gzopen(path, "rb");
  s->bytes = malloc(MOST_BYTES);
  size = packed ? gzread(packed, s->bytes, MOST_BYTES) : 0;
  FuzzCheck(size > 0 && size < MOST_BYTES && gzclose(packed) == Z_OK, "%s cannot be read", path);
  s->size = (size_t)size;
  FuzzEnterFolder();
  WriteCopy(s, name);
  file = OpenFile(name, H5F_ACC_RDONLY);
  FuzzCheck(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, KeepName, s) >= 0, "%s has no names", path);
  H5Fclose(file);
  unlink(name);
  FuzzLeaveFolder();
}

void EditsLoadFiles(int n, const char *const names[])
{
#ifdef LAMELLA_FUZZ
  EditsFreeHDF5();
#endif
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  /* The tables of an open file are half a megabyte: by default new memory, and pages of it, each time. */
  H5set_free_list_limits(ROOM_OF_ALL_LISTS, ROOM_OF_A_LIST, -1, -1, -1, -1);
  for (int i = 0; i < n; i++) LoadFile(names[i], &sound[sound_count++]);
}

/* ---- the input ---- */

static unsigned Next(Edits *e)
{
  return e->at < e->end ? *e->at++ : 0;
}

static unsigned Short(Edits *e)
{
  const unsigned low = Next(e);

  return low | Next(e) << 8;
}

static const char *Name(Edits *e)
{
  return e->from->names[Next(e) % (unsigned)e->from->name_count];
}

/* A number that tests something, or any. */
static void Value(Edits *e, unsigned char bytes[8])
{
  static const double reals[] = {0, -1, 1e-320, 1e308, -1e308, PETSC_INFINITY, PETSC_NINFINITY};
  static const int64_t integers[] = {0, -1, INT32_MAX, (int64_t)INT32_MAX + 1, INT64_MIN, INT64_MAX};
  const double nan = (double)NAN;
  const unsigned which = Next(e), real_count = PETSC_STATIC_ARRAY_LENGTH(reals);

  if (which < real_count)
    memcpy(bytes, &reals[which], 8);
  else if (which < real_count + PETSC_STATIC_ARRAY_LENGTH(integers))
    memcpy(bytes, &integers[which - real_count], 8);
  else if (which < 32)
    memcpy(bytes, &nan, 8);
  else
    for (int i = 0; i < 8; i++) bytes[i] = (unsigned char)Next(e);
}

/* Cuts bytes out of the text, and puts others there. The caller frees it. */
static char *Splice(Edits *e, const char text[])
{
  const size_t length = strlen(text), from = Short(e) % (length + 1), most = Next(e), in = Next(e) % 32;
  const size_t out = PetscMin(length - from, most);
  char *spliced = malloc(length + in + 1);

  memcpy(spliced, text, from);
  for (size_t i = 0; i < in; i++) {
    const char c = (char)Next(e);

    spliced[from + i] = c ? c : ' ';
  }
  strcpy(spliced + from + in, text + from + out);
  return spliced;
}

/* ---- checksums ---- */

static void MendHeader(Edits *e)
{
  uint32_t sum;

  if (!e->mends || LamHeaderSum(PATH, e->file, &sum)) return;
  (void)LamAttributeUpdate(PATH, e->file, LAM_SUM, H5T_NATIVE_UINT32, &sum);
}

static void MendDataset(Edits *e, hid_t dataset, PetscBool is_text, const void *values, size_t bytes)
{
  uint32_t sum = LamBytesSum(0, values, is_text ? strnlen(values, bytes) : bytes);
  PetscBool has;
  char *unit;

  if (!e->mends) return;
  if (!is_text && !LamAttributeHas(PATH, dataset, "unit", &has) && has &&
      !LamAttributeReadText(PATH, dataset, "unit", &unit)) {
    sum = LamBytesSum(sum, unit, strlen(unit));
    (void)PetscFree(unit);
  }
  if (H5Aexists(dataset, LAM_SUM) > 0) H5Adelete(dataset, LAM_SUM);
  (void)LamSumWrite(PATH, dataset, LAM_SUM, sum);
}

/* ---- edits of values ---- */

/* All values as they are in the file, of what is no text of variable length. The caller frees them; NULL: not read. */
static unsigned char *ReadAll(hid_t dataset, hid_t type, size_t *bytes)
{
  const hid_t space = H5Dget_space(dataset);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  unsigned char *values;

  H5Sclose(space);
  *bytes = (size_t)PetscMax(count, 0) * H5Tget_size(type);
  if (!*bytes || *bytes > MOST_BYTES || H5Tget_class(type) == H5T_VLEN || H5Tis_variable_str(type) > 0) return NULL;
  values = calloc(*bytes + 8, 1);
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) return values;
  free(values);
  return NULL;
}

static void ChangeValue(Edits *e)
{
  const hid_t dataset = H5Dopen2(e->file, Name(e), H5P_DEFAULT), type = H5Dget_type(dataset);
  unsigned char value[8], *values;
  size_t bytes;

  values = dataset >= 0 ? ReadAll(dataset, type, &bytes) : NULL;
  if (values) {
    const size_t at = 8 * (Short(e) % ((bytes + 7) / 8));

    Value(e, value);
    memcpy(values + at, value, 8);
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    MendDataset(e, dataset, (PetscBool)(H5Tget_class(type) == H5T_STRING), values, bytes);
  }
  free(values);
  H5Tclose(type);
  H5Dclose(dataset);
}

static void ChangeText(Edits *e)
{
  const char *name = Name(e);
  char *text, *spliced;

  if (LamFileGetText(PATH, e->file, name, &text) || !text) return;
  spliced = Splice(e, text);
  (void)LamFileWriteText(PATH, e->file, name, spliced);
  free(spliced);
  (void)PetscFree(text);
}

/* A hash that is right for what the description is taken for. */
static void ChangeMicrostructure(Edits *e)
{
  char hash[LAM_HASH_LENGTH], name[64], *text, *spliced, *described;
  LamMicrostructure micro;

  if (LamAttributeReadText(PATH, e->file, "microstructure", &text)) return;
  snprintf(name, sizeof(name), "/microstructures/%s/description", text);
  (void)PetscFree(text);
  if (LamFileGetText(PATH, e->file, name, &text) || !text) return;
  spliced = Splice(e, text);
  (void)PetscFree(text);
  if (!LamMicrostructureParse(PATH, spliced, &micro)) {
    if (!LamMicrostructureDescribe(&micro, &described, hash)) (void)PetscFree(described);
    (void)LamMicrostructureDestroy(&micro);
    H5Ldelete(e->file, "/microstructures", H5P_DEFAULT);
    snprintf(name, sizeof(name), "/microstructures/%s/description", hash);
    (void)LamFileWriteText(PATH, e->file, name, spliced);
    H5Adelete(e->file, "microstructure");
    (void)LamAttributeWriteText(PATH, e->file, "microstructure", hash);
    MendHeader(e);
  }
  free(spliced);
}

/* ---- edits of the records ---- */

static void MendRecords(Edits *e, hid_t dataset, const unsigned char *bytes, size_t record, int64_t count)
{
  uint32_t sum = 0;

  if (!e->mends) return;
  for (int64_t i = 0; i < count; i++) sum = LamBytesSum(sum, bytes + (size_t)(i + 1) * record - 4, 4);
  (void)LamAttributeUpdate(PATH, dataset, LAM_RECORDS_SUM, H5T_NATIVE_UINT32, &sum);
  sum = LamBytesSum(0, &count, sizeof(count));
  (void)LamAttributeUpdate(PATH, dataset, LAM_COUNTER_SUM, H5T_NATIVE_UINT32, &sum);
}

/* Also copies one over another, where `value` says so. */
static void ChangeRecords(Edits *e)
{
  const hid_t dataset = H5Dopen2(e->file, "/records", H5P_DEFAULT), type = H5Dget_type(dataset);
  const size_t size = type >= 0 ? H5Tget_size(type) : 0;
  unsigned char *bytes, *record;
  size_t total, at;
  uint32_t sum;

  bytes = dataset >= 0 ? ReadAll(dataset, type, &total) : NULL;
  if (bytes && size > 16) {
    record = bytes + Next(e) % (total / size) * size;
    at = Short(e) % (size - 4);
    if (at % 8 == 7)
      memcpy(record, bytes + Next(e) % (total / size) * size, size);
    else if (at + 8 <= size)
      Value(e, record + at);
    sum = (uint32_t)crc32(0, record, (uInt)size - 4);
    if (e->mends) memcpy(record + size - 4, &sum, 4);
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
    MendRecords(e, dataset, bytes, size, (int64_t)(total / size));
  }
  free(bytes);
  H5Tclose(type);
  H5Dclose(dataset);
}

static void ChangeCount(Edits *e)
{
  const hid_t dataset = H5Dopen2(e->file, "/records", H5P_DEFAULT), type = H5Dget_type(dataset);
  const hsize_t extent = Short(e);
  int64_t count = 0;
  size_t total = 0;
  unsigned char *bytes;

  if (Next(e) % 2)
    Value(e, (unsigned char *)&count);
  else
    count = Next(e);
  if (dataset >= 0 && extent) H5Dset_extent(dataset, &extent);
  bytes = dataset >= 0 ? ReadAll(dataset, type, &total) : NULL;
  if (dataset >= 0) (void)LamAttributeUpdate(PATH, dataset, "committed", H5T_NATIVE_INT64, &count);
  if (bytes)
    MendRecords(e, dataset, bytes, H5Tget_size(type),
                count < 0 || (size_t)count > total / H5Tget_size(type) ? 0 : count);
  free(bytes);
  H5Tclose(type);
  H5Dclose(dataset);
}

/* ---- edits of what is there ---- */

static hid_t TypeOf(unsigned which, size_t size)
{
  const hid_t known[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_IEEE_F32LE, H5T_STD_I32BE, H5T_C_S1, H5T_C_S1};
  hid_t type;

  if (which % 8 == 6) return H5Tarray_create2(H5T_IEEE_F64LE, 1, &(const hsize_t){2});
  if (which % 8 == 7) return H5Tvlen_create(H5T_STD_I8LE);
  type = H5Tcopy(known[which % 8]);
  if (which % 8 == 4) H5Tset_size(type, PetscMax(size, 1));
  if (which % 8 == 5) H5Tset_size(type, H5T_VARIABLE);
  return type;
}

/* Another type, another shape; the values are the old ones, as many as there are. */
static void ChangeShape(Edits *e)
{
  static unsigned char room[MOST_BYTES];
  const char *name = Name(e);
  const unsigned which = Next(e), rank = Next(e) % 6;
  const hid_t old = H5Dopen2(e->file, name, H5P_DEFAULT), old_type = H5Dget_type(old);
  unsigned char *values;
  size_t bytes = 0, size = 1;
  hsize_t dims[6];
  hid_t type, space, dataset;

  values = old >= 0 ? ReadAll(old, old_type, &bytes) : NULL;
  if (!values) bytes = 0;
  if (values) memcpy(room, values, bytes);
  H5Tclose(old_type);
  H5Dclose(old);
  for (unsigned k = 0; k < rank; k++) size *= dims[k] = Next(e) % 40;
  type = which < 128 ? TypeOf(which, Next(e)) : TypeOf(which, 8);
  space = rank ? H5Screate_simple((int)rank, dims, NULL) : H5Screate(H5S_SCALAR);
  size *= H5Tget_size(type);
  if (size <= MOST_BYTES / 2 && H5Ldelete(e->file, name, H5P_DEFAULT) >= 0) {
    if (bytes < size) memset(room + bytes, 0, size - bytes);
    dataset = H5Dcreate2(e->file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (which % 8 != 5 && which % 8 != 7) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, room);
    MendDataset(e, dataset, (PetscBool)(which % 8 == 4), room, size);
    H5Dclose(dataset);
  }
  H5Sclose(space);
  H5Tclose(type);
  free(values);
}

/* Nothing, something else, or a way to elsewhere under the name. */
static void Replace(Edits *e)
{
  const char *name = Name(e), *other = Name(e);
  const unsigned how = Next(e) % 6;

  if (how == 5) name = "/records";
  if (!strcmp(name, other) && how > 2) return;
  H5Ldelete(e->file, name, H5P_DEFAULT);
  if (how == 1) H5Gclose(H5Gcreate2(e->file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (how == 2) H5Lcreate_soft(name, e->file, name, H5P_DEFAULT, H5P_DEFAULT);
  if (how == 3) H5Lcreate_external("other.h5", other, e->file, name, H5P_DEFAULT, H5P_DEFAULT);
  if (how >= 4) H5Lcreate_hard(e->file, other, e->file, name, H5P_DEFAULT, H5P_DEFAULT);
}

static const char *const attributes[] = {"format",        "format_version", "kind",
                                         "creator",       "created",        "host",
                                         "command",       "petsc_version",  "hdf5_version",
                                         "mpi_version",   "units",          "index_order",
                                         "length_unit_m", "stress_unit_Pa", "macro_length_unit_m",
                                         "accuracy",      "microstructure", LAM_SUM,
                                         "unit"};

static void WriteAttribute(Edits *e, hid_t object, const char name[])
{
  const unsigned how = Next(e) % 5;
  unsigned char value[8];
  char text[TEXT_ROOM + 1] = "";

  if (H5Aexists(object, name) > 0) H5Adelete(object, name);
  if (how == 1) {
    for (unsigned i = 0, n = Next(e); i < n; i++) text[i] = (char)Next(e);
    (void)LamAttributeWriteText(PATH, object, name, text);
  }
  if (how == 2 || how == 3) {
    Value(e, value);
    (void)LamAttributeWriteNumber(PATH, object, name, how == 2 ? H5T_IEEE_F64LE : H5T_STD_I64LE,
                                  how == 2 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, value);
  }
  if (how == 4) {
    const int32_t number = (int32_t)Next(e);

    (void)LamAttributeWriteNumber(PATH, object, name, H5T_STD_I32LE, H5T_NATIVE_INT32, &number);
  }
}

static void ChangeAttribute(Edits *e)
{
  const char *name = attributes[Next(e) % PETSC_STATIC_ARRAY_LENGTH(attributes)];
  const unsigned where = Next(e);
  hid_t dataset;

  if (where < 128) {
    WriteAttribute(e, e->file, name);
    MendHeader(e);
    return;
  }
  dataset = H5Dopen2(e->file, where < 136 ? "/records" : Name(e), H5P_DEFAULT);
  if (dataset >= 0) WriteAttribute(e, dataset, name);
  H5Dclose(dataset);
}

/* ---- edits of bytes ---- */

/* The open file, and a place in it; -1: it is empty. */
static int OpenAt(const Edits *e, size_t place, off_t *at)
{
  const int fd = open(e->path, O_RDWR | O_CLOEXEC);
  const off_t size = lseek(fd, 0, SEEK_END);

  *at = size > 0 ? (off_t)place % size : -1;
  return fd;
}

static size_t Place(Edits *e)
{
  const size_t low = Short(e);

  return low | (size_t)(Next(e) % 8) << 16;
}

static void ChangeByte(Edits *e)
{
  const size_t place = Place(e);
  const unsigned flips = Next(e);
  unsigned char byte;
  off_t at;
  const int fd = OpenAt(e, place, &at);

  if (at >= 0 && pread(fd, &byte, 1, at) == 1) {
    byte ^= (unsigned char)flips;
    FuzzCheck(pwrite(fd, &byte, 1, at) == 1, "%s cannot be written", e->path);
  }
  close(fd);
}

static void Cut(Edits *e)
{
  off_t at;
  const int fd = OpenAt(e, Place(e), &at);

  if (at >= 0) FuzzCheck(!ftruncate(fd, at), "%s cannot be cut", e->path);
  close(fd);
}

/* ---- all of them ---- */

static void (*const edits[])(Edits *) = {ChangeValue, ChangeText, ChangeMicrostructure, ChangeRecords, ChangeCount,
                                         ChangeShape, Replace,    ChangeAttribute,      ChangeByte,    Cut};
enum { FIRST_OF_BYTES = 8 }; /* of those for which HDF5 must be done with the file */

static void CloseEdited(Edits *e)
{
  if (e->file >= 0) H5Fclose(e->file);
  e->file = H5I_INVALID_HID;
}

static void Apply(Edits *e)
{
  for (int n = 0; n < MOST_EDITS && e->at < e->end; n++) {
    const unsigned kind = Next(e) % PETSC_STATIC_ARRAY_LENGTH(edits);

    if (kind >= FIRST_OF_BYTES) CloseEdited(e);
    if (kind >= FIRST_OF_BYTES || e->file >= 0) edits[kind](e);
  }
  CloseEdited(e);
}

static hid_t held = H5I_INVALID_HID;

int EditsMakeFile(const uint8_t *input, size_t size, const char path[], int *file)
{
  Edits e = {.at = input, .end = input + size, .path = path};
  unsigned question;

  *file = (int)(Next(&e) % (unsigned)sound_count);
  question = Next(&e);
  e.from = &sound[*file];
  e.mends = (PetscBool) !(question & UNMENDED);
  WriteCopy(e.from, path);
  e.file = OpenFile(path, H5F_ACC_RDWR);
  FuzzCheck(e.file >= 0, "a sound file cannot be opened");
  Apply(&e);
  held = OpenFile(path, H5F_ACC_RDONLY);
  return (int)(question & ~(unsigned)UNMENDED);
}

void EditsReleaseFile(void)
{
  if (held >= 0) H5Fclose(held);
  held = H5I_INVALID_HID;
}

hsize_t EditsCountOpen(void)
{
  static const H5I_type_t kinds_of_object[] = {H5I_FILE,    H5I_GROUP, H5I_DATATYPE,    H5I_DATASPACE,
                                               H5I_DATASET, H5I_ATTR,  H5I_GENPROP_LST, H5I_GENPROP_CLS};
  hsize_t all = 0;

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(kinds_of_object); i++) {
    hsize_t n = 0;

    H5Inmembers(kinds_of_object[i], &n);
    all += n;
  }
  return all;
}

/* HDF5 keeps what it has found out of every type that it met, some hundred bytes per input. */
void EditsEndInput(void)
{
  static int inputs;

  if (++inputs % INPUTS_BETWEEN) return;
  H5close();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  FuzzLookForLeaks();
}
