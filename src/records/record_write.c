/*
  The writer of record files.

  Method
    Each commit opens the file, writes its records into the preallocated space after the committed ones, syncs,
  increases the counter, syncs and closes. After a kill at any instant the records below the counter are unchanged; the
  next commit overwrites those beyond it. A new file is created under another name and renamed at the first commit.
*/
#include "record_internal.h"
#include "target.h"
#include "microstructure_compare.h"
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
  char hash[LAM_HASH_LENGTH], *json, difference[LAM_DIFFERENCE_LENGTH] = "";

  PetscFunctionBeginUser;
  PetscCall(LamHeaderRead(path, file, h));
  PetscCheck(!strcmp(h->kind, kind), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\", \"%s\" is wanted; give another file name", path, h->kind, kind);
  PetscCall(LamMicrostructureDescribe(&scene->micro, &json, hash));
  PetscCall(PetscFree(json));
  if (strcmp(h->hash, hash) != 0)
    PetscCall(LamMicrostructureCompare(&h->micro, &scene->micro, "the scene", difference));
  PetscCheck(!strcmp(h->hash, hash), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds another microstructure than the scene %s: %s; give another file name", path, scene->path,
             difference);
  PetscFunctionReturn(0);
}

/* Appending requires exactly our record type: members added by a later version would be left empty. */
static PetscErrorCode CheckType(const char path[], hid_t file, PetscInt *extent)
{
  LamRecordScan scan;
  hid_t ours;
  htri_t same;

  PetscFunctionBeginUser;
  PetscCall(LamRecordScanOpen(path, file, &scan));
  PetscCall(LamRecordTypeCreate(&ours));
  LamCallHDF5(path, PETSC_ERR_LIB, same = H5Tequal(scan.type, ours));
  *extent = LamRecordScanExtent(&scan, file);
  PetscCall(LamRecordScanClose(path, &scan));
  PetscCall(LamCloseHDF5(path, ours));
  PetscCheck(same > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: its records have other members than this lamella writes; go on with the version that wrote it", path);
  PetscFunctionReturn(0);
}

/* Stores the keys of records in the file, and the sum of their checksums. */
static PetscErrorCode KeepKey(void *ctx, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                              const char damage[])
{
  LamRecordWriter w = ctx;

  PetscFunctionBeginUser;
  w->keys[number] = LamRecordInt(bytes + layout->key);
  w->sum = LamRecordsSum(w->sum, layout, 1, bytes);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadExisting(LamRecordWriter w, hid_t file, const char kind[], const LamScene *scene)
{
  LamHeader header = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = CheckSame(w->path, file, kind, scene, &header);
  if (!ierr) ierr = CheckType(w->path, file, &w->extent);
  w->n = w->capacity = header.committed;
  if (!ierr) ierr = PetscMalloc1(w->n + 1, &w->keys);
  if (!ierr) ierr = LamFileScanRecords(w->path, file, w->n, KeepKey, w);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Start(LamRecordWriter w, const char kind[], LamWriteMode mode, const LamScene *scene)
{
  PetscErrorCode ierr;
  hid_t file;

  PetscFunctionBeginUser;
  w->published = (PetscBool)(mode == LAM_WRITE_APPEND && !access(w->path, F_OK));
  if (!w->published) {
    PetscCall(LamFileCreate(w->temporary, kind, scene));
    PetscFunctionReturn(0);
  }
  unlink(w->temporary); /* left by a run that was killed */
  PetscCall(LamFileOpen(w->path, PETSC_FALSE, &file));
  ierr = ReadExisting(w, file, kind, scene);
  PetscCall(LamCloseHDF5(w->path, file));
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
static PetscErrorCode Append(const char path[], hid_t dataset, PetscInt before, PetscInt n, const PetscInt64 keys[],
                             const LamResponse responses[], uint32_t *sum)
{
  LamRecordLayout layout;
  void *bytes;
  hid_t type;

  PetscFunctionBeginUser;
  PetscCall(LamRecordTypeCreate(&type));
  PetscCall(LamRecordLayoutMake(type, &layout));
  PetscCall(LamRecordsPack(n, keys, responses, type, &bytes));
  *sum = LamRecordsSum(*sum, &layout, n, bytes);
  PetscCall(LamRowsTransfer(path, dataset, type, PETSC_TRUE, (hsize_t)before, (hsize_t)n, bytes));
  PetscCall(LamCloseHDF5(path, type));
  PetscCall(PetscFree(bytes));
  PetscFunctionReturn(0);
}

/* The file may have been replaced by another one. */
static PetscErrorCode CheckCounter(LamRecordWriter w, const char path[], hid_t dataset)
{
  PetscInt64 committed;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeReadNumber(path, dataset, "committed", H5T_STD_I64LE, H5T_NATIVE_INT64, &committed));
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
  PetscCall(Append(path, dataset, w->n, b->n, b->keys, b->responses, &b->sum));
  PetscCall(LamFileSync(path, file));
  PetscCall(LamCounterWrite(path, dataset, w->n + b->n, b->sum));
  PetscCall(LamCloseHDF5(path, dataset));
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

/* Writes something of `bytes` bytes beside the records: locks, reserves space, syncs. */
static PetscErrorCode Beside(LamRecordWriter w, size_t bytes, LamFileFunction write, void *ctx)
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

static PetscErrorCode WriteBeside(LamRecordWriter writer, LamArray *array)
{
  PetscFunctionBeginUser;
  PetscCheck(array->rank >= 0 && array->rank <= 4, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "rank %" PetscInt_FMT,
             array->rank);
  PetscCall(Beside(writer, 8 * (LamArrayCount(array) + 1), LamFileWriteArray, array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterReals(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                                    const PetscReal values[], const char unit[])
{
  LamArray array = {name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rank, dims, values, unit};

  PetscFunctionBeginUser;
  PetscCall(WriteBeside(writer, &array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordWriterInts(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                                   const PetscInt values[])
{
  const hid_t memory = sizeof(PetscInt) == sizeof(PetscInt64) ? H5T_NATIVE_INT64 : H5T_NATIVE_INT;
  LamArray array = {name, H5T_STD_I64LE, memory, rank, dims, values, NULL};

  PetscFunctionBeginUser;
  PetscCall(WriteBeside(writer, &array));
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
  PetscCall(Beside(writer, strlen(text), WriteText, &t));
  PetscFunctionReturn(0);
}
