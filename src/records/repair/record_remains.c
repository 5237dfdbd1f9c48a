/*
  The header of a damaged file, looked for in its bytes where HDF5 cannot read it any more.

  Method
    Of a file that was cut the front, with its length put right, is a file to HDF5, which reads the header as it was.
    Where it does not, texts lie in the file as they are, with a zero at the end. A description is taken for sound where
  the file holds its hash, too: as attribute and as the name of its group. Numbers of the header are attributes of the
  object headers' first version, as HDF5 writes them for files that 1.8 can read: name, type and space, each filled up
  to 8 bytes, and the value.

  References
    The HDF Group, HDF5 File Format Specification 3.0, Section IV.A.2.m (attribute message, version 1).
*/
#define _GNU_SOURCE /* memmem */
#include "record_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FRONT ((size_t)64 << 20) /* the header and the texts lie in front of nearly all records */

typedef struct {
  unsigned char *bytes; /* followed by a zero */
  size_t n;
} Front;

static PetscErrorCode ReadFront(const char path[], Front *front)
{
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  struct stat info;
  ssize_t n = -1;
  int error;

  PetscFunctionBeginUser;
  PetscCheck(fd >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", path, strerror(errno));
  if (fstat(fd, &info)) info.st_size = 0;
  front->n = PetscMin(FRONT, (size_t)info.st_size);
  PetscCall(PetscCalloc(front->n + 1, (void **)&front->bytes));
  n = pread(fd, front->bytes, front->n, 0);
  error = errno;
  close(fd);
  PetscCheck(n >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s: %s", path, strerror(error));
  front->n = (size_t)n;
  PetscFunctionReturn(0);
}

/* The next place of a text at `from` or behind; NULL: none. */
static const char *Find(const Front *front, const char *from, const char text[])
{
  const char *begin = (const char *)front->bytes;

  if (!from) from = begin;
  return memmem(from, front->n - (size_t)(from - begin), text, strlen(text));
}

/* ---- through HDF5 ---- */

/* Of superblocks of version 0, as HDF5 writes them for files that 1.8 can read: where the length of the file stands. */
enum { SIGNATURE_BYTES = 8, LENGTH_PLACE = 40 };

/* What a cut makes wrong of the superblock, and what there is but one value for. */
static void MendSuperblock(Front *front)
{
  static const unsigned char signature[SIGNATURE_BYTES] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  const uint64_t length = front->n;

  if (front->n < LENGTH_PLACE + sizeof(length)) return;
  memcpy(front->bytes, signature, sizeof(signature));
  memcpy(front->bytes + LENGTH_PLACE, &length, sizeof(length));
}

PetscErrorCode LamRemainsOpen(const char path[], hid_t *file)
{
  char name[PETSC_MAX_PATH_LEN];
  Front front = {0};
  hid_t access;

  PetscFunctionBeginUser;
  snprintf(name, sizeof(name), "%s/front", path); /* HDF5 wants one that no file can have */
  PetscCall(ReadFront(path, &front));
  MendSuperblock(&front);
  LamCallHDF5(path, PETSC_ERR_LIB, access = H5Pcreate(H5P_FILE_ACCESS));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_fapl_core(access, 1 << 20, 0));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  if (front.n) LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_file_image(access, front.bytes, front.n)); /* copies them */
  PetscCall(PetscFree(front.bytes));
  *file = H5Fopen(name, H5F_ACC_RDONLY, access);
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pclose(access));
  PetscCheck(*file >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: HDF5 cannot read it any more", path);
  PetscFunctionReturn(0);
}

/* ---- numbers ---- */

static const unsigned char real_type[] = {0x11, 0x20, 0x3f, 0, 8, 0, 0, 0, 0, 0, 64, 0, 52, 11, 0, 52, 0xff, 3, 0, 0};
static const unsigned char sum_type[] = {0x10, 0, 0, 0, 4, 0, 0, 0, 0, 0, 32, 0};
static const unsigned char int_type[] = {0x10, 8, 0, 0, 8, 0, 0, 0, 0, 0, 64, 0};

/* An attribute of one number of `size` bytes, at `*from` (NULL: the beginning) or behind; *from is then behind it. */
static PetscBool FindNumber(const Front *front, const char **from, const char name[], size_t type_bytes,
                            const unsigned char type[], size_t size, void *value)
{
  const size_t name_room = (strlen(name) + 8) / 8 * 8, type_room = (type_bytes + 7) / 8 * 8, space_room = 8;
  const char *end = (const char *)front->bytes + front->n;

  for (const char *at = *from; (at = Find(front, at, name)) != NULL; at++) {
    const char *number = at + name_room + type_room + space_room;

    if ((size_t)(end - at) < name_room + type_room + space_room + size) break;
    if (at[strlen(name)] || memcmp(at + name_room, type, type_bytes)) continue;
    memcpy(value, number, size);
    *from = number;
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Units are positive, however small: the file's may be of picometres or of micropascals. */
static PetscBool FindReal(const Front *front, const char name[], PetscBool is_unit, PetscReal *value)
{
  const char *from = NULL;

  return (PetscBool)(FindNumber(front, &from, name, sizeof(real_type), real_type, sizeof(*value), value) &&
                     isfinite(*value) && (is_unit ? *value > 0 : *value >= 0));
}

static void FindNumbers(const Front *front, LamRemains *r)
{
  const char *from = NULL;

  r->has_scales = (PetscBool)(FindReal(front, "length_unit_m", PETSC_TRUE, &r->scales.length) &&
                              FindReal(front, "stress_unit_Pa", PETSC_TRUE, &r->scales.stress) &&
                              FindReal(front, "macro_length_unit_m", PETSC_FALSE, &r->scales.macro_length) &&
                              FindReal(front, "accuracy", PETSC_FALSE, &r->accuracy));
  if (!FindNumber(front, &from, "committed", sizeof(int_type), int_type, sizeof(r->committed), &r->committed) ||
      r->committed < 0 || r->committed >= PETSC_MAX_INT)
    r->committed = -1;
}

/* ---- texts ---- */

/* PETSC_FALSE where the text is none, or its hash does not stand in the file. */
static PetscBool TakeDescription(const char path[], const Front *front, const char text[], LamRemains *r)
{
  PetscErrorCode ierr = LamMicrostructureParse(path, text, &r->micro);
  char *json = NULL;

  if (!ierr) ierr = LamMicrostructureDescribe(&r->micro, &json, r->hash);
  if (!ierr && !strcmp(json, text) && Find(front, NULL, r->hash)) {
    r->description = json;
    return PETSC_TRUE;
  }
  (void)PetscFree(json);
  (void)LamMicrostructureDestroy(&r->micro);
  r->hash[0] = '\0';
  return PETSC_FALSE;
}

static void FindDescription(const char path[], const Front *front, LamRemains *r)
{
  for (const char *at = NULL; (at = Find(front, at, "{\"wall_thickness\": ")) != NULL; at++)
    if (TakeDescription(path, front, at, r)) return;
}

/* Whether the file holds the checksum of the text; older files hold none. */
static PetscBool HasChecksum(const Front *front, const char text[])
{
  const uint32_t wanted = LamBytesSum(0, text, strlen(text));
  PetscBool any = PETSC_FALSE;
  const char *from = NULL;
  uint32_t sum;

  while (FindNumber(front, &from, LAM_SUM, sizeof(sum_type), sum_type, sizeof(sum), &sum)) {
    if (sum == wanted) return PETSC_TRUE;
    any = PETSC_TRUE;
  }
  return (PetscBool)!any;
}

/* What is no layout of a grid of this tissue is passed over. */
static void FindGrid(const char path[], const Front *front, LamRemains *r)
{
  for (const char *at = NULL; (at = Find(front, at, "{\"origin\":")) != NULL; at++) {
    LamGrid grid;

    if (!HasChecksum(front, at) || LamGridFromText(path, &r->micro, at, &grid)) continue;
    (void)LamGridDestroy(&grid);
    (void)PetscStrallocpy(at, &r->grid);
    return;
  }
}

/* Errors of what is tried and thrown away are nobody's. */
PetscErrorCode LamRemainsFind(const char path[], const char hash[], LamRemains *remains)
{
  Front front = {0};
  int lock;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *remains = (LamRemains){0};
  lock = LamLockBeginRead(path);
  ierr = ReadFront(path, &front);
  LamLockEndRead(lock);
  if (!ierr) {
    PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
    FindNumbers(&front, remains);
    FindDescription(path, &front, remains);
    if (remains->description) FindGrid(path, &front, remains);
    remains->names_hash = (PetscBool)(hash[0] && Find(&front, NULL, hash));
    PetscCall(PetscPopErrorHandler());
  }
  PetscCall(PetscFree(front.bytes));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRemainsDestroy(LamRemains *remains)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(remains->description));
  PetscCall(PetscFree(remains->grid));
  PetscCall(LamMicrostructureDestroy(&remains->micro));
  PetscFunctionReturn(0);
}
