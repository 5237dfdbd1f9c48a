/*
  System calls that a signal must not break off: begun again where one came. SA_RESTART does not reach all of them, and
  a program that uses the library may do without it.
*/
#ifndef LAM_WHOLE_H
#define LAM_WHOLE_H

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

static inline int LamWholeSync(int fd)
{
  int failed;

  do failed = fsync(fd);
  while (failed && errno == EINTR);
  return failed;
}

static inline int LamWholeLock(int fd, int operation)
{
  int failed;

  do failed = flock(fd, operation);
  while (failed && errno == EINTR);
  return failed;
}

/* As posix_fallocate: returns the error. */
static inline int LamWholeReserve(int fd, off_t at, off_t bytes)
{
  int error;

  do error = posix_fallocate(fd, at, bytes);
  while (error == EINTR);
  return error;
}

#endif
