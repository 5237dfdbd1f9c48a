/*
  Appends records of several files to one file.

  Method
    Two numbers of 64 bits per record stay in memory: a digest of its state, which identifies duplicates, and one of the
    content in which two solves of it must agree. Records are copied as bytes, in blocks of whole chunks. Only if two
    records of a state differ, the first is read back from the file.

  References
    G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014 (the finaliser of
    SplitMix64: a bijection, so that digests of two nodes' keys are never equal).
*/
#define _GNU_SOURCE /* sync_file_range */
#include "record_union.h"
#include "table.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

enum { BLOCK = 8 * LAM_RECORDS_PER_CHUNK, WRITE_BLOCKS = 16, LOAD_BYTES = 11 * sizeof(PetscReal) };

struct LamUnion_s {
  char path[PETSC_MAX_PATH_LEN];
  hid_t file, dataset, type;
  LamRecordLayout layout;
  size_t load, status, P, seconds; /* offsets in a record */
  LamStressScale scale;            /* of the tissue */
  PetscInt n, written;             /* records in total; in the file, the others are in `block` */
  PetscInt64 next_cache_key;
  unsigned char *block, *kept; /* [BLOCK] records; one record that was read back; owned */
  PetscInt room;               /* for checksums and digests */
  uint32_t *checksums;         /* [room] of the records, in their order; owned */
  uint64_t *contents;          /* [room] digests of what two solves must agree in; owned */
  LamPlaceMap states;          /* number of a record by the digest of its state */
};

/* ---- create, destroy ---- */

static PetscErrorCode Open(LamUnion u)
{
  PetscFunctionBeginUser;
  PetscCall(LamRecordTypeCreate(&u->type));
  PetscCall(LamRecordLayoutMake(u->type, &u->layout));
  u->load = LamRecordOffset(&u->layout, offsetof(LamResponse, load.F));
  u->status = LamRecordOffset(&u->layout, offsetof(LamResponse, status));
  u->P = LamRecordOffset(&u->layout, offsetof(LamResponse, P));
  u->seconds = LamRecordOffset(&u->layout, offsetof(LamResponse, seconds));
  PetscCheck(LamRecordOffset(&u->layout, offsetof(LamResponse, load.cohesion)) + sizeof(PetscReal) ==
                 u->load + LOAD_BYTES,
             PETSC_COMM_SELF, PETSC_ERR_PLIB, "F, turgor and cohesion do not follow one another in a record");
  PetscCall(PetscMalloc2((size_t)BLOCK * u->layout.size, &u->block, u->layout.size, &u->kept));
  PetscCall(LamPlaceMapCreate(BLOCK, &u->states));
  PetscCall(LamFileOpen(u->path, PETSC_TRUE, &u->file));
  LamCallHDF5(u->path, PETSC_ERR_FILE_WRITE, u->dataset = H5Dopen2(u->file, "/records", H5P_DEFAULT));
  PetscFunctionReturn(0);
}

PetscErrorCode LamUnionCreate(const char path[], LamStressScale scale, LamUnion *records)
{
  PetscErrorCode ierr;
  LamUnion u;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&u));
  u->file = u->dataset = u->type = H5I_INVALID_HID;
  u->next_cache_key = LAM_CACHE_KEY;
  u->scale = scale;
  PetscCall(PetscStrncpy(u->path, path, sizeof(u->path)));
  ierr = Open(u);
  if (ierr) (void)LamUnionDestroy(&u);
  PetscCall(ierr);
  *records = u;
  PetscFunctionReturn(0);
}

PetscErrorCode LamUnionDestroy(LamUnion *records)
{
  LamUnion u = *records;

  PetscFunctionBeginUser;
  if (!u) PetscFunctionReturn(0);
  PetscCall(LamCloseHDF5(u->path, u->type, u->dataset, u->file));
  PetscCall(PetscFree2(u->block, u->kept));
  PetscCall(PetscFree(u->checksums));
  PetscCall(PetscFree(u->contents));
  PetscCall(LamPlaceMapDestroy(&u->states));
  PetscCall(PetscFree(*records));
  PetscFunctionReturn(0);
}

/* ---- the file ---- */

/* Transfers n records, from number `first` on, between the file and `bytes`. */
static PetscErrorCode Transfer(LamUnion u, PetscBool write, PetscInt first, PetscInt n, unsigned char *bytes)
{
  PetscFunctionBeginUser;
  PetscCall(LamRowsTransfer(u->path, u->dataset, u->type, write, (hsize_t)first, (hsize_t)n, bytes));
  PetscFunctionReturn(0);
}

/* Starts writeback, so that the disk works while more records are read; otherwise all of it waits for the final
   sync. */
static PetscErrorCode BeginWriting(LamUnion u)
{
#ifdef SYNC_FILE_RANGE_WRITE
  int *fd;

  PetscFunctionBeginUser;
  LamCallHDF5(u->path, PETSC_ERR_LIB, H5Fget_vfd_handle(u->file, H5P_DEFAULT, (void **)&fd));
  (void)sync_file_range(*fd, 0, 0, SYNC_FILE_RANGE_WRITE); /* the sync reports errors */
  PetscFunctionReturn(0);
#else
  (void)u;
  return 0;
#endif
}

static PetscErrorCode Flush(LamUnion u)
{
  const PetscInt n = u->n - u->written;
  const hsize_t extent = (hsize_t)u->n;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamFileReserve(u->path, PETSC_FALSE, ((size_t)n + LAM_RECORDS_PER_CHUNK) * u->layout.size));
  LamCallHDF5(u->path, PETSC_ERR_FILE_WRITE, H5Dset_extent(u->dataset, &extent));
  PetscCall(Transfer(u, PETSC_TRUE, u->written, n, u->block));
  u->written = u->n;
  if (u->written % (WRITE_BLOCKS * BLOCK) == 0) PetscCall(BeginWriting(u));
  PetscFunctionReturn(0);
}

/* Truncates the space reserved after the end, which HDF5 does not know. */
PetscErrorCode LamUnionFinish(LamUnion u)
{
  hsize_t bytes;

  PetscFunctionBeginUser;
  PetscCall(Flush(u));
  PetscCall(LamCounterWrite(u->path, u->dataset, u->n, LamBytesSum(0, u->checksums, sizeof(uint32_t) * (size_t)u->n)));
  PetscCall(LamCloseHDF5(u->path, u->dataset));
  u->dataset = H5I_INVALID_HID;
  LamCallHDF5(u->path, PETSC_ERR_FILE_WRITE, H5Fflush(u->file, H5F_SCOPE_GLOBAL));
  LamCallHDF5(u->path, PETSC_ERR_FILE_WRITE, H5Fget_filesize(u->file, &bytes));
  PetscCall(LamCloseHDF5(u->path, u->file));
  u->file = H5I_INVALID_HID;
  PetscCheck(!truncate(u->path, (off_t)bytes), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", u->path,
             strerror(errno));
  PetscFunctionReturn(0);
}

/* ---- digests ---- */

static uint64_t Mix(uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

static uint64_t Digest(uint64_t digest, const unsigned char *bytes, size_t n)
{
  for (size_t i = 0; i < n; i += sizeof(uint64_t)) {
    uint64_t word = 0;

    memcpy(&word, bytes + i, PetscMin(n - i, sizeof(word)));
    digest = Mix(digest ^ word);
  }
  return digest;
}

static uint64_t StateDigest(LamUnion u, const unsigned char *bytes)
{
  const PetscInt64 key = LamRecordInt(bytes + u->layout.key);
  const uint64_t begin = Mix((uint64_t)(key >= LAM_CACHE_KEY ? LAM_CACHE_KEY : key));

  return LamKeyIsNode(key) ? begin : Digest(begin, bytes + u->load, LOAD_BYTES);
}

/* All but key, time and checksum. */
static uint64_t ContentOf(LamUnion u, const unsigned char *bytes)
{
  const size_t behind = u->seconds + sizeof(PetscReal), end = u->layout.size - sizeof(uint32_t);
  const uint64_t digest = Digest(1, bytes + u->load, u->seconds - u->load);

  return Digest(digest, bytes + behind, end - behind);
}

static PetscBool IsSameState(LamUnion u, const unsigned char *a, const unsigned char *b)
{
  const PetscInt64 key_a = LamRecordInt(a + u->layout.key), key_b = LamRecordInt(b + u->layout.key);
  const PetscBool cached = (PetscBool)(key_a >= LAM_CACHE_KEY && key_b >= LAM_CACHE_KEY);

  if (!cached && key_a != key_b) return PETSC_FALSE;
  return (PetscBool)(LamKeyIsNode(key_a) || !memcmp(a + u->load, b + u->load, LOAD_BYTES));
}

/* ---- appending ---- */

static void SetKey(LamUnion u, unsigned char *bytes, PetscInt64 key)
{
  memcpy(bytes + u->layout.key, &key, sizeof(key));
  LamRecordSeal(&u->layout, bytes);
}

/* Stores the checksum of record number `at`. */
static void KeepChecksum(LamUnion u, PetscInt at, const unsigned char *bytes)
{
  memcpy(&u->checksums[at], bytes + u->layout.size - sizeof(uint32_t), sizeof(uint32_t));
}

static PetscErrorCode Append(LamUnion u, const unsigned char *bytes, uint64_t content)
{
  unsigned char *place;

  PetscFunctionBeginUser;
  if (u->n == u->room) {
    u->room = PetscMax(2 * u->room, BLOCK);
    PetscCall(PetscRealloc((size_t)u->room * sizeof(*u->checksums), &u->checksums));
    PetscCall(PetscRealloc((size_t)u->room * sizeof(*u->contents), &u->contents));
  }
  if (u->n - u->written == BLOCK) PetscCall(Flush(u));
  place = u->block + (size_t)(u->n - u->written) * u->layout.size;
  memcpy(place, bytes, u->layout.size);
  if (LamRecordInt(place + u->layout.key) >= LAM_CACHE_KEY) SetKey(u, place, u->next_cache_key++);
  u->contents[u->n] = content;
  KeepChecksum(u, u->n++, place);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadBack(LamUnion u, PetscInt at)
{
  PetscFunctionBeginUser;
  if (at < u->written)
    PetscCall(Transfer(u, PETSC_FALSE, at, 1, u->kept));
  else
    memcpy(u->kept, u->block + (size_t)(at - u->written) * u->layout.size, u->layout.size);
  PetscFunctionReturn(0);
}

/* Replaces the record that was read back, but keeps its key, which is new for a record of a cache. */
static PetscErrorCode Replace(LamUnion u, PetscInt at, const unsigned char *bytes)
{
  const PetscInt64 key = LamRecordInt(u->kept + u->layout.key);

  PetscFunctionBeginUser;
  memcpy(u->kept, bytes, u->layout.size);
  SetKey(u, u->kept, key);
  KeepChecksum(u, at, u->kept);
  if (at < u->written)
    PetscCall(Transfer(u, PETSC_TRUE, at, 1, u->kept));
  else
    memcpy(u->block + (size_t)(at - u->written) * u->layout.size, u->kept, u->layout.size);
  PetscFunctionReturn(0);
}

/* The stored record has other numbers; or, once in 2^64 pairs of loads, it is of another state. */
static PetscErrorCode Decide(LamUnion u, PetscInt at, uint64_t content, const unsigned char *bytes,
                             LamMergeReport *report)
{
  PetscReal P[9], P_kept[9], difference;

  PetscFunctionBeginUser;
  PetscCall(ReadBack(u, at));
  if (!IsSameState(u, u->kept, bytes)) {
    PetscCall(Append(u, bytes, content));
    PetscFunctionReturn(0);
  }
  memcpy(P, bytes + u->P, sizeof(P));
  memcpy(P_kept, u->kept + u->P, sizeof(P_kept));
  difference = LamStressError(u->scale, P, P_kept);
  report->duplicates++;
  report->differing++;
  if (difference > report->difference) report->difference = difference; /* NaN if one has no stress */
  if (bytes[u->status] != LAM_CONVERGED || u->kept[u->status] == LAM_CONVERGED) PetscFunctionReturn(0);
  PetscCall(Replace(u, at, bytes));
  u->contents[at] = content;
  PetscFunctionReturn(0);
}

static PetscErrorCode Take(LamUnion u, const unsigned char *bytes, LamMergeReport *report)
{
  const uint64_t content = ContentOf(u, bytes);
  const PetscInt64 state = (PetscInt64)StateDigest(u, bytes);
  const PetscInt at = LamPlaceMapGet(&u->states, state);

  PetscFunctionBeginUser;
  if (at < 0) {
    PetscCall(LamPlaceMapSet(&u->states, state, u->n));
    PetscCall(Append(u, bytes, content));
  } else if (u->contents[at] == content) {
    report->duplicates++;
  } else {
    PetscCall(Decide(u, at, content, bytes, report));
  }
  report->records = u->n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamUnionTake(LamUnion u, const LamRecordLayout *layout, const unsigned char *bytes,
                            LamMergeReport *report)
{
  const PetscInt64 key = LamRecordInt(bytes + layout->key);
  LamResponse response;
  void *converted;

  PetscFunctionBeginUser;
  if (layout->size == u->layout.size) {
    PetscCall(Take(u, bytes, report));
    PetscFunctionReturn(0);
  }
  PetscCall(LamRecordUnpack(layout, bytes, &response));
  PetscCall(LamRecordsPack(1, &key, &response, u->type, &converted));
  PetscCall(Take(u, converted, report));
  PetscCall(PetscFree(converted));
  PetscFunctionReturn(0);
}
