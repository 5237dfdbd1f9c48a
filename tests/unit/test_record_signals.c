/* A signal that comes while a file is written, and in the middle of a system call, breaks nothing off. */
#define _GNU_SOURCE
#include "record_fixture.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/syscall.h>

static PetscInt interrupted;

/* Every other call is interrupted by a signal; these stand before the C library's own. */
static PetscBool Interrupt(void)
{
  static PetscInt calls;

  if (++calls % 2 == 0) return PETSC_FALSE;
  interrupted++;
  return PETSC_TRUE;
}

int fsync(int fd)
{
  if (!Interrupt()) return (int)syscall(SYS_fsync, fd);
  errno = EINTR;
  return -1;
}

int flock(int fd, int operation)
{
  if (!Interrupt()) return (int)syscall(SYS_flock, fd, operation);
  errno = EINTR;
  return -1;
}

int posix_fallocate(int fd, off_t at, off_t bytes)
{
  if (Interrupt()) return EINTR;
  return syscall(SYS_fallocate, fd, 0, at, bytes) ? errno : 0;
}

TEST_WITH(CommitsAreWhole, Enter, Leave)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  for (int k = 0; k < 5; k++) Commit(writer, 100 * k, 100);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_true(interrupted > 10);
  assert_int_equal(CountRecords(), 500);
}
