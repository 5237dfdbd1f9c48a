/*
  The records of a file: the number committed, and their bytes, block by block. All sizes in the file are checked
  before memory is allocated for them.
*/
#include "record_internal.h"

#define BLOCK (8 * LAM_RECORDS_PER_CHUNK) /* 0.9 MB: fits into the processor's cache for check and use */

/* ---- counter ---- */

/* Records are not compressed, so the file is at least as large as they are; nor are chunks larger than it. */
static PetscErrorCode CheckExtent(const char path[], hid_t file, hid_t dataset, PetscInt64 count)
{
  hsize_t size, chunk = 0;
  hid_t type, list;
  size_t bytes;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Fget_filesize(file, &size));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, type = H5Dget_type(dataset));
  bytes = PetscMax(H5Tget_size(type), 1);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, list = H5Dget_create_plist(dataset));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Pget_chunk(list, 1, &chunk));
  PetscCall(LamCloseHDF5(path, list, type));
  PetscCheck(!count || ((hsize_t)count <= size / bytes && chunk <= size / bytes), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %lld records of %zu bytes in chunks of %lld are said to be in %lld bytes; the file is damaged", path,
             (long long)count, bytes, (long long)chunk, (long long)size);
  PetscFunctionReturn(0);
}

/* Opens the list /records without reading it. After an error the caller closes what was opened. */
static PetscErrorCode OpenList(const char path[], hid_t file, hid_t access, hid_t *dataset, hid_t *space)
{
  PetscBool has;

  PetscFunctionBeginUser;
  *dataset = *space = H5I_INVALID_HID;
  PetscCall(LamFileHas(path, file, "/records", &has));
  PetscCheck(has, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the table /records is missing; the file is damaged",
             path);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, *dataset = H5Dopen2(file, "/records", access));
  PetscCall(LamDatasetCheck(path, *dataset, "/records", H5D_CHUNKED));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, *space = H5Dget_space(*dataset));
  PetscCheck(H5Sget_simple_extent_ndims(*space) == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /records is not a list; the file is damaged", path);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadCommitted(const char path[], hid_t file, hid_t dataset, hid_t space, PetscInt *committed)
{
  PetscInt64 count;
  hssize_t extent;
  PetscBool sound;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, extent = H5Sget_simple_extent_npoints(space));
  PetscCall(LamAttributeReadNumber(path, dataset, "committed", H5T_STD_I64LE, H5T_NATIVE_INT64, &count));
  PetscCheck(count >= 0 && count <= (PetscInt64)extent && count < PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %lld records are said to be committed, %lld are there; the file is damaged" LAM_SALVAGE, path,
             (long long)count, (long long)extent);
  PetscCall(LamSumMatches(path, dataset, LAM_COUNTER_SUM, LamBytesSum(0, &count, sizeof(count)), &sound));
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the commit counter of /records is damaged (it says %lld)" LAM_SALVAGE, path, (long long)count);
  PetscCall(CheckExtent(path, file, dataset, count));
  *committed = (PetscInt)count;
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommittedRead(const char path[], hid_t file, PetscInt *committed)
{
  hid_t dataset, space;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = OpenList(path, file, H5P_DEFAULT, &dataset, &space);
  if (!ierr) ierr = ReadCommitted(path, file, dataset, space, committed);
  PetscCall(LamCloseHDF5(path, space, dataset));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- blocks ---- */

static PetscErrorCode CheckType(const char path[], const LamRecordScan *s)
{
  PetscBool sound;
  uint32_t sum;

  PetscFunctionBeginUser;
  PetscCall(LamRecordTypeCheck(path, s->type));
  PetscCall(LamRecordTypeSum(s->type, &sum));
  PetscCall(LamSumMatches(path, s->dataset, LAM_TYPE_SUM, sum, &sound));
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the names of the members of /records are damaged",
             path);
  PetscFunctionReturn(0);
}

/* Without HDF5's chunk cache: each chunk is read once, directly into our block. */
static PetscErrorCode Open(const char path[], hid_t file, LamRecordScan *s)
{
  PetscErrorCode ierr;
  hssize_t extent;
  hid_t access;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_LIB, access = H5Pcreate(H5P_DATASET_ACCESS));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 0, 1));
  ierr = OpenList(path, file, access, &s->dataset, &s->space);
  PetscCall(LamCloseHDF5(path, access));
  PetscCall(ierr);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, s->type = H5Dget_type(s->dataset));
  PetscCall(CheckType(path, s));
  PetscCall(LamRecordLayoutMake(s->type, &s->layout));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, extent = H5Sget_simple_extent_npoints(s->space));
  PetscCall(PetscMalloc((size_t)PetscMin(BLOCK, extent) * s->layout.size, &s->bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordScanOpen(const char path[], hid_t file, LamRecordScan *scan)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *scan = (LamRecordScan){.dataset = H5I_INVALID_HID, .type = H5I_INVALID_HID, .space = H5I_INVALID_HID};
  ierr = Open(path, file, scan);
  if (ierr) PetscCall(LamRecordScanClose(path, scan));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordScanClose(const char path[], LamRecordScan *scan)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(scan->bytes));
  PetscCall(LamCloseHDF5(path, scan->space, scan->type, scan->dataset));
  PetscFunctionReturn(0);
}

PetscInt LamRecordScanExtent(const LamRecordScan *scan, hid_t file)
{
  const hssize_t extent = H5Sget_simple_extent_npoints(scan->space);
  hsize_t size;

  if (extent < 0 || H5Fget_filesize(file, &size) < 0) return 0;
  return (PetscInt)PetscMin(PetscMin((hsize_t)extent, size / scan->layout.size), PETSC_MAX_INT - 1);
}

/* ---- all of them ---- */

/* Sound records may be in the wrong position: the list has its own checksum. */
PetscErrorCode LamRecordScanEnd(const char path[], const LamRecordScan *s, PetscInt count, uint32_t sum)
{
  PetscInt64 committed;
  PetscBool sound;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeReadNumber(path, s->dataset, "committed", H5T_STD_I64LE, H5T_NATIVE_INT64, &committed));
  if (committed != count) PetscFunctionReturn(0); /* the file has grown since it was opened */
  PetscCall(LamSumMatches(path, s->dataset, LAM_RECORDS_SUM, sum, &sound));
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /records is damaged (each record is sound, but one stands in the place of another)" LAM_SALVAGE,
             path);
  PetscFunctionReturn(0);
}

/* Calls `visit` for n records from number `first` on. Those that HDF5 cannot read share a chunk. */
static PetscErrorCode ScanEach(const char path[], LamRecordScan *s, PetscInt first, PetscInt n, LamRecordVisitor visit,
                               void *ctx)
{
  PetscErrorCode unreadable;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  unreadable = LamRowsTransfer(path, s->dataset, s->type, PETSC_FALSE, (hsize_t)first, (hsize_t)n, s->bytes);
  PetscCall(PetscPopErrorHandler());
  if (unreadable && n > LAM_RECORDS_PER_CHUNK) {
    for (PetscInt i = 0; i < n; i += LAM_RECORDS_PER_CHUNK)
      PetscCall(ScanEach(path, s, first + i, PetscMin(LAM_RECORDS_PER_CHUNK, n - i), visit, ctx));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < n; i++) {
    const unsigned char *bytes = unreadable ? NULL : s->bytes + (size_t)i * s->layout.size;
    const char *damage = unreadable ? "HDF5 cannot read it" : LamRecordDamage(&s->layout, bytes);

    PetscCall(visit(ctx, &s->layout, first + i, bytes, damage));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordScanAll(const char path[], LamRecordScan *s, PetscInt count, LamRecordVisitor visit, void *ctx)
{
  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < count; first += BLOCK)
    PetscCall(ScanEach(path, s, first, PetscMin(BLOCK, count - first), visit, ctx));
  PetscFunctionReturn(0);
}

typedef struct {
  const char *path;
  LamRecordVisitor visit;
  void *ctx;
  uint32_t sum;
} Strict;

static PetscErrorCode VisitSound(void *ctx, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                                 const char damage[])
{
  Strict *s = ctx;

  PetscFunctionBeginUser;
  PetscCheck(!damage, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: record %" PetscInt_FMT " is damaged (%s)" LAM_SALVAGE,
             s->path, number, damage);
  s->sum = LamRecordsSum(s->sum, layout, 1, bytes);
  PetscCall(s->visit(s->ctx, layout, number, bytes, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileScanRecords(const char path[], hid_t file, PetscInt count, LamRecordVisitor visit, void *ctx)
{
  Strict strict = {.path = path, .visit = visit, .ctx = ctx};
  LamRecordScan scan;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamRecordScanOpen(path, file, &scan));
  ierr = LamRecordScanAll(path, &scan, count, VisitSound, &strict);
  if (!ierr) ierr = LamRecordScanEnd(path, &scan, count, strict.sum);
  PetscCall(
      LamRecordScanClose(path, &scan)); /* even if records are damaged: a program may continue without this file */
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
