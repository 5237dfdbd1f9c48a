/*
  File operations of the operating system.
*/
#include "disk.h"
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { COPY_BYTES = 1 << 20 };
#define TABLE_BYTES 131072 /* upper bound for the header, or for the index and attributes of a commit */

/* ---- system calls ---- */

int LamFsync(int fd)
{
  int failed;

  do failed = fsync(fd);
  while (failed && errno == EINTR);
  return failed;
}

int LamFlock(int fd, int operation)
{
  int failed;

  do failed = flock(fd, operation);
  while (failed && errno == EINTR);
  return failed;
}

int LamWriteBytes(int fd, const void *bytes, size_t n)
{
  ssize_t part;

  for (size_t done = 0; done < n; done += (size_t)part) {
    part = write(fd, (const char *)bytes + done, n - done);
    if (part < 0 && errno != EINTR) return errno;
    part = PetscMax(part, 0);
  }
  return 0;
}

void LamTimeNow(char text[LAM_TIME_LENGTH])
{
  const time_t now = time(NULL);
  struct tm utc;

  gmtime_r(&now, &utc);
  strftime(text, LAM_TIME_LENGTH, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

/* ---- paths ---- */

PetscBool LamPathFollow(const char path[], char target[PETSC_MAX_PATH_LEN])
{
  struct stat status;
  char *real;
  int length;

  if (lstat(path, &status) || !S_ISLNK(status.st_mode)) {
    length = snprintf(target, PETSC_MAX_PATH_LEN, "%s", path);
    return (PetscBool)(length < PETSC_MAX_PATH_LEN);
  }
  real = realpath(path, NULL);
  length = real ? snprintf(target, PETSC_MAX_PATH_LEN, "%s", real) : PETSC_MAX_PATH_LEN;
  free(real);
  return (PetscBool)(length < PETSC_MAX_PATH_LEN);
}

/* ---- files ---- */

PetscErrorCode LamFileReserve(const char path[], PetscBool create, size_t bytes)
{
  const int fd = open(path, O_RDWR | O_CLOEXEC | (create ? O_CREAT | O_TRUNC : 0), 0666);
  off_t end;
  int error;

  PetscFunctionBeginUser;
  PetscCheck(fd >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", path, strerror(errno));
  end = lseek(fd, 0, SEEK_END);
  do
    error = posix_fallocate(fd, end,
                            (off_t)(bytes + TABLE_BYTES)); /* HDF5 truncates unused space when it closes the file */
  while (error == EINTR);
  if (error && ftruncate(fd, end)) error = errno;
  close(fd);
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, strerror(error));
  PetscFunctionReturn(0);
}

/* Returns 0 or errno. */
static int CopyBytes(int in, int out, char bytes[COPY_BYTES])
{
  int error = 0;
  ssize_t n;

  while (!error && (n = read(in, bytes, COPY_BYTES)) > 0) error = LamWriteBytes(out, bytes, (size_t)n);
  return error || !n ? error : errno;
}

PetscErrorCode LamFileCopy(const char from[], const char to[])
{
  const int in = open(from, O_RDONLY | O_CLOEXEC);
  int out, error;
  struct stat info;
  char *bytes;

  PetscFunctionBeginUser;
  PetscCheck(in >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", from, strerror(errno));
  PetscCall(PetscMalloc1(COPY_BYTES, &bytes));
  out = open(to, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  error = out < 0 || fstat(in, &info) || fchmod(out, info.st_mode & 07777) ? errno : CopyBytes(in, out, bytes);
  close(in);
  if (out >= 0) close(out);
  PetscCall(PetscFree(bytes));
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", to, strerror(error));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFilePublish(const char temporary[], const char path[])
{
  const int fd = open(temporary, O_RDONLY | O_CLOEXEC);
  const PetscBool synced = (PetscBool)(fd >= 0 && !LamFsync(fd));
  char copy[PETSC_MAX_PATH_LEN];
  int error = errno, directory;

  PetscFunctionBeginUser;
  if (fd >= 0) close(fd);
  PetscCheck(synced, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", temporary, strerror(error));
  PetscCheck(!rename(temporary, path), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, strerror(errno));
  PetscCall(PetscStrncpy(copy, path, sizeof(copy)));
  directory = open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    LamFsync(directory); /* fails on some file systems; the file itself is synced */
    close(directory);
  }
  PetscFunctionReturn(0);
}
