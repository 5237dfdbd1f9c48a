/*
  Library for LD_PRELOAD: the n-th system call on files whose path holds some text goes wrong.
    FAULT_PATH   the text, such as db.h5
    FAULT_CALL   which calls count: some of "write length sync name open close"; all where it is left out. length:
  ftruncate and posix_fallocate; name: rename and unlink; open: only for writing FAULT_AT     n, from 1 on; 0: none
    FAULT_DO     kill: SIGKILL instead of the call; half: SIGKILL within a write, between pages; short: half of a write
  succeeds; or a number: the call fails with that errno FAULT_TIMES  how many calls from then on fail; 0: all
    FAULT_COUNT  a file that gets the number of calls so far
*/
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static long Number(const char name[])
{
  const char *text = getenv(name);

  return text ? atol(text) : 0;
}

static int IsOurs(const char path[], const char call[])
{
  const char *part = getenv("FAULT_PATH"), *calls = getenv("FAULT_CALL");

  return part && strstr(path, part) && (!calls || strstr(calls, call));
}

static void Tell(long n)
{
  const char *name = getenv("FAULT_COUNT");
  char text[32];
  int fd;

  if (!name) return;
  fd = (int)syscall(SYS_openat, AT_FDCWD, name, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (fd < 0) return;
  syscall(SYS_write, fd, text, (size_t)snprintf(text, sizeof(text), "%ld\n", n));
  syscall(SYS_close, fd);
}

/* Whether this call is to go wrong. */
static int IsHit(const char path[], const char call[])
{
  const long at = Number("FAULT_AT"), times = Number("FAULT_TIMES");
  static long n;

  if (!IsOurs(path, call)) return 0;
  Tell(++n);
  return at && n >= at && (!times || n < at + times);
}

/* Returns what to do: 'h'alf and 's'hort are for writes, anything else but a kill is an errno. */
static int Fail(void)
{
  const char *what = getenv("FAULT_DO");

  if (!what || !strcmp(what, "kill")) kill(getpid(), SIGKILL);
  if (!strcmp(what, "half") || !strcmp(what, "short")) return *what;
  errno = atoi(what);
  return 0;
}

static int IsHitFile(int fd, const char call[])
{
  char link[64], path[4096];
  ssize_t n;

  snprintf(link, sizeof(link), "/proc/self/fd/%d", fd);
  n = readlink(link, path, sizeof(path) - 1);
  if (n < 0) return 0;
  path[n] = '\0';
  return IsHit(path, call);
}

/* ---- the calls ---- */

/* About half of a write, as a kill can leave it: the system stops between pages. All of it where it lies in one. */
static size_t UpToPage(size_t size, off_t offset)
{
  const size_t first = offset > 0 ? (size_t)offset : 0, middle = (first + size / 2) / 4096 * 4096;

  return middle > first ? middle - first : size;
}

static ssize_t Write(int fd, const void *bytes, size_t size, off_t offset)
{
  if (IsHitFile(fd, "write")) {
    const int part = Fail();

    if (!part) return -1;
    if (part == 's' && size > 1) size /= 2;
    if (part == 'h') {
      size = UpToPage(size, offset);
      syscall(offset < 0 ? SYS_write : SYS_pwrite64, fd, bytes, size, offset);
      kill(getpid(), SIGKILL);
    }
  }
  return syscall(offset < 0 ? SYS_write : SYS_pwrite64, fd, bytes, size, offset);
}

ssize_t write(int fd, const void *bytes, size_t size)
{
  return Write(fd, bytes, size, -1);
}

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t offset)
{
  return Write(fd, bytes, size, offset);
}

ssize_t pwrite64(int fd, const void *bytes, size_t size, off_t offset)
{
  return Write(fd, bytes, size, offset);
}

int ftruncate(int fd, off_t length)
{
  if (IsHitFile(fd, "length") && !Fail()) return -1;
  return (int)syscall(SYS_ftruncate, fd, length);
}

int ftruncate64(int fd, off_t length)
{
  return ftruncate(fd, length);
}

int posix_fallocate(int fd, off_t offset, off_t length)
{
  if (IsHitFile(fd, "length") && !Fail()) return errno;
  return syscall(SYS_fallocate, fd, 0, offset, length) ? errno : 0;
}

int posix_fallocate64(int fd, off_t offset, off_t length)
{
  return posix_fallocate(fd, offset, length);
}

int fsync(int fd)
{
  if (IsHitFile(fd, "sync") && !Fail()) return -1;
  return (int)syscall(SYS_fsync, fd);
}

int fdatasync(int fd)
{
  if (IsHitFile(fd, "sync") && !Fail()) return -1;
  return (int)syscall(SYS_fdatasync, fd);
}

int close(int fd)
{
  const int hit = IsHitFile(fd, "close") && !Fail();
  const int error = errno;

  if (!hit) return (int)syscall(SYS_close, fd);
  syscall(SYS_close, fd); /* a close that fails has closed */
  errno = error;
  return -1;
}

int rename(const char *from, const char *to)
{
  if (IsHit(to, "name") && !Fail()) return -1;
  return (int)syscall(SYS_rename, from, to);
}

int unlink(const char *path)
{
  if (IsHit(path, "name") && !Fail()) return -1;
  return (int)syscall(SYS_unlink, path);
}

int open(const char *path, int flags, ...)
{
  va_list list;
  int mode;

  va_start(list, flags);
  mode = flags & O_CREAT ? va_arg(list, int) : 0;
  va_end(list);
  if (flags & (O_WRONLY | O_RDWR | O_CREAT) && IsHit(path, "open") && !Fail()) return -1;
  return (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
  va_list list;
  int mode;

  va_start(list, flags);
  mode = flags & O_CREAT ? va_arg(list, int) : 0;
  va_end(list);
  return open(path, flags, mode);
}
