/*
  What is left of a damaged file.

  Method
    Records are looked for in the bytes of the file, at any place, by their checksum: so it does not matter what has
    become of HDF5's tables, nor whether the file has been cut. A place comes into question where the fields with few
    values have one of them; only there the checksum is computed. Most places, zeros above all, are passed over by one
    byte, of F33. Behind a sound record the next one is tried first.
*/
#include "record_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { WINDOW = 8 << 20, MOST_RECORDS = 512, PAGE = 4096, PIECE = 256 };

/* ---- records ---- */

typedef struct {
  const char *path;
  int fd;
  off_t begin;          /* where the window begins in the file */
  size_t n, at, length; /* bytes in the window; where we are in it; of its memory */
  unsigned char *bytes; /* [length] owned */
  off_t claimed;        /* end of the last record, sound or not */
  LamRecordLayout layout;
  size_t status, source, F11, F22, F33;
  LamSalvage *found;
} Scan;

/* A page that the disk cannot read is taken for zeros. */
static PetscErrorCode Fill(Scan *s)
{
  PetscFunctionBeginUser;
  while (s->n < s->length) {
    const off_t place = s->begin + (off_t)s->n;
    ssize_t n = pread(s->fd, s->bytes + s->n, s->length - s->n, place);

    if (n < 0 && errno == EIO) {
      n = (ssize_t)PetscMin(s->length - s->n, (size_t)(PAGE - place % PAGE));
      memset(s->bytes + s->n, 0, (size_t)n);
    }
    PetscCheck(n >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s: %s", s->path, strerror(errno));
    if (n == 0) break;
    s->n += (size_t)n;
  }
  PetscFunctionReturn(0);
}

/* Makes sure that a whole record and more lies before us; *more: there is at least one that could be. */
static PetscErrorCode Advance(Scan *s, PetscBool *more)
{
  PetscFunctionBeginUser;
  if (s->n - s->at < s->layout.size) {
    memmove(s->bytes, s->bytes + s->at, s->n - s->at);
    s->begin += (off_t)s->at;
    s->n -= s->at;
    s->at = 0;
    PetscCall(Fill(s));
  }
  *more = (PetscBool)(s->n - s->at >= s->layout.size);
  PetscFunctionReturn(0);
}

static PetscReal RealAt(const unsigned char *bytes)
{
  PetscReal value;

  memcpy(&value, bytes, sizeof(value));
  return value;
}

/* Of any state that can be asked for, with room to spare. */
static PetscBool MayBeStretch(PetscReal least, PetscReal F)
{
  return (PetscBool)(F >= least && F < 1e3);
}

/*
  Places before the next one where F33 may be a stretch; a piece at a time, so that the search for one byte does not
  run ahead of the other.
*/
static size_t PlacesToPass(const Scan *s)
{
  const size_t places = PetscMin(s->n - s->at - s->layout.size + 1, (size_t)PIECE);
  const unsigned char *high = s->bytes + s->at + s->F33 + sizeof(PetscReal) - 1;
  const unsigned char *below_2 = memchr(high, 0x3f, places); /* sign and exponent of 1e-3 and more */
  const unsigned char *above = memchr(high, 0x40, below_2 ? (size_t)(below_2 - high) : places); /* of 2 to 1e3 */
  const unsigned char *next = above ? above : below_2;

  return next ? (size_t)(next - high) : places;
}

/* Cheap, and false nearly everywhere but at records. There are less than 2^40 keys of a kind. */
static PetscBool MayBeRecord(const Scan *s, const unsigned char *bytes)
{
  const PetscInt64 key = LamRecordInt(bytes + s->layout.key), many = (PetscInt64)1 << 40;

  return (PetscBool)(LamRecordInt(bytes + s->layout.microstructure) == 0 && bytes[s->status] < LAM_STATUS_COUNT &&
                     bytes[s->source] < LAM_SOURCE_COUNT && MayBeStretch(1e-3, RealAt(bytes + s->F33)) &&
                     MayBeStretch(-1e3, RealAt(bytes + s->F11)) && MayBeStretch(-1e3, RealAt(bytes + s->F22)) &&
                     ((key >= 0 && key < many) || LamKeyIsNode(key) ||
                      (key >= LAM_CACHE_KEY && key < LAM_CACHE_KEY + many)));
}

static PetscBool IsSound(const Scan *s, const unsigned char *bytes)
{
  const size_t end = s->layout.size - sizeof(uint32_t);
  uint32_t stored;

  memcpy(&stored, bytes + end, sizeof(stored));
  return (PetscBool)(stored == (uint32_t)crc32(0, bytes, (uInt)end));
}

/* In plane strain F33 is 1, which bytes by chance are not, and keys are not 0, which what lies before a record often
   is: so damaged records are told from what is none. */
static void CountDamaged(Scan *s)
{
  const off_t place = s->begin + (off_t)s->at;
  const unsigned char *bytes = s->bytes + s->at;

  const PetscInt64 key = LamRecordInt(bytes + s->layout.key);

  if (place < s->claimed || RealAt(bytes + s->F33) != 1.0 || !key) return;
  if (s->found->damaged < LAM_SALVAGE_NAMED) {
    s->found->offset[s->found->damaged] = (PetscInt64)place;
    s->found->key[s->found->damaged] = key;
  }
  s->found->damaged++;
  s->claimed = place + (off_t)s->layout.size;
}

/* Shows the sound records that begin here; on where there is none. */
static PetscErrorCode Step(Scan *s, LamRecordVisitor visit, void *ctx)
{
  const size_t size = s->layout.size;
  const unsigned char *bytes = s->bytes + s->at;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  if (!MayBeRecord(s, bytes)) {
    s->at++;
    if (s->n - s->at >= size) s->at += PlacesToPass(s);
    PetscFunctionReturn(0);
  }
  while (n < MOST_RECORDS && s->at + (size_t)(n + 1) * size <= s->n && MayBeRecord(s, bytes + (size_t)n * size) &&
         IsSound(s, bytes + (size_t)n * size))
    n++;
  if (n) {
    PetscCall(visit(ctx, &s->layout, (PetscInt)s->found->sound, n, bytes));
    s->found->sound += n;
    s->at += (size_t)n * size;
    s->claimed = s->begin + (off_t)s->at;
  } else {
    CountDamaged(s);
    s->at++;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ScanAll(Scan *s, LamRecordVisitor visit, void *ctx)
{
  PetscBool more;

  PetscFunctionBeginUser;
  for (;;) {
    PetscCall(Advance(s, &more));
    if (!more) break;
    PetscCall(Step(s, visit, ctx));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ScanAs(const char path[], const LamRecordLayout *layout, LamRecordVisitor visit, void *ctx,
                             LamSalvage *found)
{
  Scan scan = {.path = path, .layout = *layout, .found = found};
  struct stat status;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *found = (LamSalvage){0};
  scan.status = LamRecordOffset(layout, offsetof(LamResponse, status));
  scan.source = LamRecordOffset(layout, offsetof(LamResponse, source));
  scan.F11 = LamRecordOffset(layout, offsetof(LamResponse, load.F));
  scan.F22 = scan.F11 + 4 * sizeof(PetscReal);
  scan.F33 = scan.F11 + 8 * sizeof(PetscReal);
  scan.fd = open(path, O_RDONLY | O_CLOEXEC);
  PetscCheck(scan.fd >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", path, strerror(errno));
  scan.length = layout->size + (fstat(scan.fd, &status) ? WINDOW : (size_t)PetscMin(WINDOW, status.st_size));
  ierr = PetscMalloc1(scan.length, &scan.bytes);
  if (!ierr) ierr = ScanAll(&scan, visit, ctx);
  close(scan.fd);
  PetscCall(PetscFree(scan.bytes));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- the type of the records ---- */

static PetscErrorCode OwnLayout(LamRecordLayout *layout)
{
  hid_t type;

  PetscFunctionBeginUser;
  PetscCall(LamRecordTypeCreate(&type));
  PetscCall(LamRecordLayoutMake(type, layout));
  LamCallHDF5("record type", PETSC_ERR_LIB, H5Tclose(type));
  PetscFunctionReturn(0);
}

static PetscErrorCode TypeOf(const char path[], hid_t file, LamRecordLayout *layout)
{
  hid_t dataset, type;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, type = H5Dget_type(dataset));
  PetscCall(LamRecordTypeCheck(path, type));
  PetscCall(LamRecordLayoutMake(type, layout));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(dataset));
  PetscFunctionReturn(0);
}

/* An error means that the file does not tell. */
static PetscErrorCode FileLayout(const char path[], LamRecordLayout *layout)
{
  hid_t file = H5I_INVALID_HID;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = LamFileOpenRead(path, &file);
  if (!ierr) ierr = TypeOf(path, file, layout);
  if (file >= 0) H5Fclose(file);
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(ierr);
}

/* Records of the present version first: then nothing depends on what the file says of their type. */
PetscErrorCode LamFileSalvage(const char path[], LamRecordVisitor visit, void *ctx, LamSalvage *found)
{
  const int lock = LamLockBeginRead(path);
  LamRecordLayout own, layout;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = OwnLayout(&own);
  if (!ierr) ierr = ScanAs(path, &own, visit, ctx, found);
  if (!ierr && !found->sound && !FileLayout(path, &layout) && layout.size != own.size)
    ierr = ScanAs(path, &layout, visit, ctx, found);
  LamLockEndRead(lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
