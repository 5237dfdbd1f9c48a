/*
  The writer of record files.

  Method
    Each commit opens the file, writes its records into the preallocated space after the committed ones, syncs,
  increases the counter, syncs and closes. After a kill at any instant the records below the counter are unchanged; the
  next commit overwrites those beyond it. A new file is created under another name and renamed at the first commit.
*/
#include "record_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct LamRecordWriter_s {
  char path[PETSC_MAX_PATH_LEN];
  char temporary[PETSC_MAX_PATH_LEN];
  PetscBool published; /* the file has its own name */
  PetscBool written;   /* something besides the header was written */
  PetscBool begun;     /* LamRecordWriterBegin: readers see nothing before the commit */
  LamLock lock;
  PetscInt extent; /* number of allocated records */
  PetscInt n, capacity;
  PetscInt64 *keys; /* owned */
  uint32_t sum;     /* of the checksums of all records */
};

static const char *CurrentPath(LamRecordWriter w)
{
  return w->published ? w->path : w->temporary;
}

/* ---- open ---- */

static PetscErrorCode CheckSame(const char path[], hid_t file, const char kind[], const LamScene *scene, LamHeader *h)
{
  char hash[LAM_HASH_LENGTH], *json;

  PetscFunctionBeginUser;
  PetscCall(LamHeaderRead(path, file, h));
  PetscCheck(!strcmp(h->kind, kind), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\", \"%s\" is wanted; give another file name", path, h->kind, kind);
  PetscCall(LamMicrostructureDescribe(&scene->micro, &json, hash));
  PetscCall(PetscFree(json));
  PetscCheck(!strcmp(h->hash, hash), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds microstructure %s, the scene %s describes %s; give another file name", path, h->hash,
             scene->path, hash);
  PetscFunctionReturn(0);
}

/* Appending requires exactly our record type: members added by a later version would be left empty. */
static PetscErrorCode CheckType(const char path[], hid_t file)
{
  hid_t dataset, theirs, ours;
  htri_t same;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, theirs = H5Dget_type(dataset));
  PetscCall(LamRecordTypeCreate(&ours));
  LamCallHDF5(path, PETSC_ERR_LIB, same = H5Tequal(theirs, ours));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(ours));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(theirs));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(dataset));
  PetscCheck(same > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: its records have other members than this lamella writes; go on with the version that wrote it", path);
  PetscFunctionReturn(0);
}

/* Stores the keys of records in the file, and the sum of their checksums. */
static PetscErrorCode KeepBlockKeys(void *ctx, const LamRecordLayout *layout, PetscInt first, PetscInt n,
                                    const unsigned char *bytes)
{
  LamRecordWriter w = ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) w->keys[first + i] = LamRecordInt(bytes + (size_t)i * layout->size + layout->key);
  w->sum = LamRecordsSum(w->sum, layout, n, bytes);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadExisting(LamRecordWriter w, hid_t file, const char kind[], const LamScene *scene)
{
  LamHeader header = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = CheckSame(w->path, file, kind, scene, &header);
  if (!ierr) ierr = CheckType(w->path, file);
  if (!ierr) ierr = LamFileReadExtent(w->path, file, &w->extent);
  w->n = w->capacity = header.committed;
  if (!ierr) ierr = PetscMalloc1(w->n + 1, &w->keys);
  if (!ierr) ierr = LamFileScanRecords(w->path, file, w->n, KeepBlockKeys, w);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Size of a new file's texts. */
static PetscErrorCode TextBytes(const LamScene *scene, size_t *bytes)
{
  char hash[LAM_HASH_LENGTH], *json;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureDescribe(&scene->micro, &json, hash));
  *bytes = strlen(json) + (scene->text ? strlen(scene->text) : 0);
  PetscCall(PetscFree(json));
  PetscFunctionReturn(0);
}

static PetscErrorCode Start(LamRecordWriter w, const char kind[], LamWriteMode mode, const LamScene *scene)
{
  PetscErrorCode ierr;
  size_t bytes = 0;
  hid_t file;

  PetscFunctionBeginUser;
  w->published = (PetscBool)(mode == LAM_WRITE_APPEND && !access(w->path, F_OK));
  if (!w->published) {
    PetscCall(TextBytes(scene, &bytes));
    PetscCall(LamFileReserve(w->temporary, PETSC_TRUE, bytes));
    PetscCall(LamFileCreate(w->temporary, kind, scene));
    PetscFunctionReturn(0);
  }
  unlink(w->temporary); /* left by a run that was killed */
  PetscCall(LamFileOpenRead(w->path, &file));
  ierr = ReadExisting(w, file, kind, scene);
  H5Fclose(file);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(LamRecordWriter *writer)
{
  PetscFunctionBeginUser;
  if (!(*writer)->published) unlink((*writer)->temporary);
  PetscCall(LamLockRelease(&(*writer)->lock));
  PetscCall(PetscFree((*writer)->keys));
  PetscCall(PetscFree(*writer));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterOpen(const char path[], const char kind[], LamWriteMode mode, const LamScene *scene,
                                   LamRecordWriter *writer)
{
  PetscErrorCode ierr;
  LamRecordWriter w;

  PetscFunctionBeginUser;
  *writer = NULL;
  PetscCall(PetscNew(&w));
  ierr = LamTargetFind(path, kind, mode, w->path);
  if (!ierr) ierr = LamLockTake(w->path, &w->lock);
  if (ierr) {
    (void)PetscFree(w);
    PetscCall(ierr);
  }
  snprintf(w->temporary, sizeof(w->temporary), "%.*s.tmp", PETSC_MAX_PATH_LEN - 8, w->path);
  ierr = Start(w, kind, mode, scene);
  if (ierr) (void)Destroy(&w);
  PetscCall(ierr);
  *writer = w;
  PetscFunctionReturn(0);
}

/* ---- commit ---- */

/* *sum: of the checksums of all records; updated for the appended ones. */
static PetscErrorCode Append(const char path[], hid_t dataset, hsize_t before, PetscInt n, const PetscInt64 keys[],
                             const LamResponse responses[], uint32_t *sum)
{
  const hsize_t count = (hsize_t)n;
  hid_t type, space, memory;
  LamRecordLayout layout;
  void *bytes;

  PetscFunctionBeginUser;
  PetscCall(LamRecordTypeCreate(&type));
  PetscCall(LamRecordLayoutMake(type, &layout));
  PetscCall(LamRecordsPack(n, keys, responses, type, &bytes));
  *sum = LamRecordsSum(*sum, &layout, n, bytes);
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Dget_space(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, memory = H5Screate_simple(1, &count, NULL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sselect_hyperslab(space, H5S_SELECT_SET, &before, NULL, &count, NULL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, bytes));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(memory));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  PetscCall(PetscFree(bytes));
  PetscFunctionReturn(0);
}

/* The file may have been replaced by another one. */
static PetscErrorCode CheckCounter(LamRecordWriter w, const char path[], hid_t dataset)
{
  PetscInt64 committed;
  hid_t counter;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, counter = H5Aopen(dataset, "committed", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Aread(counter, H5T_NATIVE_INT64, &committed));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Aclose(counter));
  PetscCheck(committed == w->n, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE,
             "%s: holds %" PetscInt64_FMT " records where this run has left %" PetscInt_FMT
             "; another program has changed it",
             path, committed, w->n);
  PetscFunctionReturn(0);
}

typedef struct {
  LamRecordWriter writer;
  PetscInt n;
  const PetscInt64 *keys;
  const LamResponse *responses;
  uint32_t sum; /* of the checksums of all records, including these */
} Batch;

static PetscErrorCode AppendAndCount(const char path[], hid_t file, void *ctx)
{
  Batch *b = ctx;
  LamRecordWriter w = b->writer;
  hid_t dataset;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  PetscCall(CheckCounter(w, path, dataset));
  PetscCall(Append(path, dataset, (hsize_t)w->n, b->n, b->keys, b->responses, &b->sum));
  PetscCall(LamFileSync(path, file));
  PetscCall(LamCounterWrite(path, dataset, w->n + b->n, b->sum));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  PetscFunctionReturn(0);
}

static PetscErrorCode Publish(LamRecordWriter w)
{
  PetscFunctionBeginUser;
  if (w->published) PetscFunctionReturn(0);
  PetscCall(LamFilePublish(w->temporary, w->path));
  w->published = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterBegin(LamRecordWriter writer)
{
  PetscFunctionBeginUser;
  if (writer->published) PetscCall(LamFileCopy(writer->path, writer->temporary));
  writer->published = PETSC_FALSE;
  writer->begun = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepKeys(LamRecordWriter w, PetscInt n, const PetscInt64 keys[])
{
  PetscFunctionBeginUser;
  if (w->n + n > w->capacity) {
    w->capacity = PetscMax(2 * w->capacity, w->n + n);
    PetscCall(PetscRealloc((size_t)w->capacity * sizeof(*w->keys), &w->keys));
  }
  if (n) PetscCall(PetscArraycpy(w->keys + w->n, keys, n));
  w->n += n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterCommit(LamRecordWriter writer, PetscInt n, const PetscInt64 keys[],
                                     const LamResponse responses[])
{
  Batch batch = {writer, n, keys, responses, writer->sum};
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  PetscCall(
      LamFilePreallocate(writer->published ? writer->path : NULL, writer->temporary, writer->n + n, &writer->extent));
  LamLockBeginCommit(&writer->lock);
  if (n) ierr = LamFileWrite(CurrentPath(writer), AppendAndCount, &batch);
  if (!ierr) ierr = Publish(writer);
  LamLockEndCommit(&writer->lock);
  PetscCall(ierr);
  writer->sum = batch.sum;
  writer->written = PETSC_TRUE;
  writer->begun = PETSC_FALSE;
  PetscCall(KeepKeys(writer, n, keys));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterGetKeys(LamRecordWriter writer, PetscInt *n, const PetscInt64 *keys[])
{
  PetscFunctionBeginUser;
  *n = writer->n;
  *keys = writer->keys;
  PetscFunctionReturn(0);
}

/* A file with arrays but no records gets its name here; an empty one is removed. */
PetscErrorCode LamRecordWriterClose(LamRecordWriter *writer)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (!*writer) PetscFunctionReturn(0);
  if ((*writer)->written && !(*writer)->begun) ierr = Publish(*writer);
  PetscCall(Destroy(writer));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- arrays and texts beside the records ---- */

static PetscErrorCode WriteBeside(LamRecordWriter w, size_t bytes, LamFileFunction write, void *ctx)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  LamLockBeginCommit(&w->lock);
  ierr = LamFileReserve(CurrentPath(w), PETSC_FALSE, bytes);
  if (!ierr) ierr = LamFileWrite(CurrentPath(w), write, ctx);
  LamLockEndCommit(&w->lock);
  PetscCall(ierr);
  w->written = PETSC_TRUE;
  PetscFunctionReturn(0);
}

typedef struct {
  const char *name;
  hid_t file_type, memory_type;
  PetscInt rank;
  const PetscInt *dims;
  const void *values;
  const char *unit; /* or NULL */
} Array;

static size_t ArrayCount(const Array *a)
{
  size_t count = 1;

  for (PetscInt i = 0; i < a->rank; i++) count *= (size_t)a->dims[i];
  return count;
}

static size_t ArrayBytes(const Array *a)
{
  return 8 * (ArrayCount(a) + 1); /* reals and integers both have 8 bytes in the file */
}

/* Checksum of the bytes in the file, followed by the unit. */
static uint32_t ArraySum(const Array *a)
{
  uint32_t sum = 0;

  if (a->file_type == H5T_IEEE_F64LE) sum = LamBytesSum(0, a->values, 8 * ArrayCount(a));
  for (size_t i = 0; a->file_type != H5T_IEEE_F64LE && i < ArrayCount(a); i++) {
    const PetscInt64 value = ((const PetscInt *)a->values)[i];

    sum = LamBytesSum(sum, &value, sizeof(value));
  }
  return a->unit ? LamBytesSum(sum, a->unit, strlen(a->unit)) : sum;
}

/* An overwritten array has no valid checksum: a kill may leave old and new numbers. */
static PetscErrorCode DropSum(const char path[], hid_t file, hid_t dataset)
{
  const uint32_t none = LAM_NO_SUM;
  PetscBool summed;

  PetscFunctionBeginUser;
  PetscCall(LamSumHas(path, dataset, LAM_SUM, &summed));
  if (!summed) PetscFunctionReturn(0);
  PetscCall(LamAttributeUpdate(path, dataset, LAM_SUM, H5T_NATIVE_UINT32, &none));
  PetscCall(LamFileSync(path, file));
  PetscFunctionReturn(0);
}

/*
  Overwrites an array of the same shape and type. Only its numbers change in the file, so a table that grows full
  commit by commit takes no more space, and after a kill each number is either old or new.
*/
static PetscErrorCode Overwrite(const char path[], hid_t file, const Array *a, PetscBool *done)
{
  hsize_t dims[H5S_MAX_RANK];
  hid_t dataset, space, type;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, dataset = H5Dopen2(file, a->name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Dget_space(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, type = H5Dget_type(dataset));
  *done = (PetscBool)(H5Tequal(type, a->file_type) > 0 && H5Sget_simple_extent_dims(space, dims, NULL) == a->rank);
  for (PetscInt i = 0; i < a->rank && *done; i++) *done = (PetscBool)(dims[i] == (hsize_t)a->dims[i]);
  if (*done) PetscCall(DropSum(path, file, dataset));
  if (*done)
    LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
                H5Dwrite(dataset, a->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, a->values));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteArray(const char path[], hid_t file, void *ctx)
{
  const Array *a = ctx;
  hsize_t dims[4];
  hid_t groups, space, dataset;
  PetscBool has, done = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, a->name, &has));
  if (has) PetscCall(Overwrite(path, file, a, &done));
  if (done) PetscFunctionReturn(0);
  if (has) LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Ldelete(file, a->name, H5P_DEFAULT));
  for (PetscInt i = 0; i < a->rank; i++) dims[i] = (hsize_t)a->dims[i];
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, groups = H5Pcreate(H5P_LINK_CREATE));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pset_create_intermediate_group(groups, 1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Screate_simple((int)a->rank, dims, NULL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
              dataset = H5Dcreate2(file, a->name, a->file_type, space, groups, H5P_DEFAULT, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dwrite(dataset, a->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, a->values));
  if (a->unit) PetscCall(LamAttributeWriteText(path, dataset, "unit", a->unit));
  PetscCall(LamSumWrite(path, dataset, LAM_SUM, ArraySum(a)));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pclose(groups));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterReals(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                                    const PetscReal values[], const char unit[])
{
  Array array = {name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rank, dims, values, unit};

  PetscFunctionBeginUser;
  PetscCheck(rank >= 0 && rank <= 4, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "rank %" PetscInt_FMT, rank);
  PetscCall(WriteBeside(writer, ArrayBytes(&array), WriteArray, &array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterInts(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                                   const PetscInt values[])
{
  const hid_t memory = sizeof(PetscInt) == sizeof(PetscInt64) ? H5T_NATIVE_INT64 : H5T_NATIVE_INT;
  Array array = {name, H5T_STD_I64LE, memory, rank, dims, values, NULL};

  PetscFunctionBeginUser;
  PetscCheck(rank >= 0 && rank <= 4, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "rank %" PetscInt_FMT, rank);
  PetscCall(WriteBeside(writer, ArrayBytes(&array), WriteArray, &array));
  PetscFunctionReturn(0);
}

typedef struct {
  const char *name, *text;
} Text;

static PetscErrorCode WriteText(const char path[], hid_t file, void *ctx)
{
  const Text *t = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamFileWriteText(path, file, t->name, t->text));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterText(LamRecordWriter writer, const char name[], const char text[])
{
  Text t = {name, text};

  PetscFunctionBeginUser;
  PetscCall(WriteBeside(writer, strlen(text), WriteText, &t));
  PetscFunctionReturn(0);
}
