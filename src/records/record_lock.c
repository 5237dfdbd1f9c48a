/*
  One writer per file.

  PATH.lock is created with O_CREAT | O_EXCL and contains host, process, start time of the process (which identifies
  it if its number is reused) and the time. The lock of a process of this host that has died is taken over, and so is
  one that stays empty: its creator died before writing. A creator that was only slow detects afterwards that it has
  lost the lock. HDF5's own locks are off: they would exclude readers during a writer's lifetime. Instead a commit
  locks the lock file exclusively (flock), and a reader shares it while it loads.
*/
#include "disk.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define UNWRITTEN_SECONDS 2 /* a lock is normally written far sooner after its creation */

/* 0 also for a zombie process: its files are closed. */
static unsigned long long ProcessStart(long pid)
{
  char path[64], text[1024], *field;
  unsigned long long start = 0;
  size_t n;
  FILE *file;

  snprintf(path, sizeof(path), "/proc/%ld/stat", pid);
  file = fopen(path, "r");
  if (!file) return 0;
  n = fread(text, 1, sizeof(text) - 1, file);
  fclose(file);
  text[n] = '\0';
  field = strrchr(text, ')'); /* the name before it may contain anything; the start is the 20th field after it */
  if (field && (field[2] == 'Z' || field[2] == 'X')) return 0;
  for (int i = 0; field && i < 20; i++) field = strchr(field + 1, ' ');
  if (field) sscanf(field, "%llu", &start);
  return start;
}

static void HolderSelf(LamLockHolder *self)
{
  memset(self, 0, sizeof(*self));
  if (gethostname(self->host, sizeof(self->host) - 1)) snprintf(self->host, sizeof(self->host), "unknown");
  self->pid = (long)getpid();
  self->start = ProcessStart(self->pid);
  LamTimeNow(self->since);
}

static PetscBool HolderRead(int fd, LamLockHolder *holder)
{
  char text[512] = "";
  const ssize_t n = pread(fd, text, sizeof(text) - 1, 0);

  memset(holder, 0, sizeof(*holder));
  return (PetscBool)(n > 0 && sscanf(text, "%255s %ld %llu %31s", holder->host, &holder->pid, &holder->start,
                                     holder->since) == 4);
}

/* Only the death of a process on this host can be detected. */
static PetscBool HolderIsDead(const LamLockHolder *holder)
{
  LamLockHolder self;

  HolderSelf(&self);
  if (strcmp(holder->host, self.host)) return PETSC_FALSE;
  if (kill((pid_t)holder->pid, 0) && errno == ESRCH) return PETSC_TRUE;
  return (PetscBool)(holder->start && ProcessStart(holder->pid) != holder->start);
}

/* True if the open lock still has its name: a user or another writer may have removed and recreated it. */
static PetscBool IsNamed(int fd, const char path[])
{
  struct stat opened, named;

  return (PetscBool)(!fstat(fd, &opened) && !stat(path, &named) && opened.st_ino == named.st_ino);
}

/* Waits for the line of a lock that is being created; true if it stays empty. */
static PetscBool StaysUnwritten(int fd)
{
  const struct timespec pause = {.tv_nsec = 50000000};
  char text[512];

  for (int k = 0; k < 20 * UNWRITTEN_SECONDS; k++) {
    const ssize_t n = pread(fd, text, sizeof(text), 0);

    if (n > 0 && text[n - 1] == '\n') return PETSC_FALSE;
    nanosleep(&pause, NULL);
  }
  return PETSC_TRUE;
}

/* Removes the lock at `path` if its holder is dead; otherwise an error names the holder. *removed: retry the
   creation. */
static PetscErrorCode RemoveStale(const char path[], const char data_path[], PetscBool *removed)
{
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  PetscBool unwritten, known;
  LamLockHolder holder;

  PetscFunctionBeginUser;
  *removed = PETSC_TRUE;
  if (fd < 0) PetscFunctionReturn(0); /* released in the meantime */
  unwritten = StaysUnwritten(fd);
  LamFlock(fd, LOCK_EX); /* if two processes find it stale, the second detects below that it is gone */
  known = HolderRead(fd, &holder);
  if (!IsNamed(fd, path)) {
    close(fd);
    PetscFunctionReturn(0);
  }
  *removed = (PetscBool)(known ? HolderIsDead(&holder) : unwritten);
  if (*removed) unlink(path);
  close(fd);
  PetscCheck(*removed || known, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "%s: another process is writing to it (%s does not say which); remove the lock if none is", data_path,
             path);
  PetscCheck(*removed, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "%s: process %ld on %s has been writing to it since %s; wait, or remove %s if it is gone", data_path,
             holder.pid, holder.host, holder.since, path);
  PetscFunctionReturn(0);
}

/* Writes the holder. Synced, for processes on other hosts. */
static PetscErrorCode WriteHolder(const char path[], LamLock *lock)
{
  char text[512];
  LamLockHolder self;
  int length, error;

  PetscFunctionBeginUser;
  HolderSelf(&self);
  length = snprintf(text, sizeof(text), "%s %ld %llu %s\n", self.host, self.pid, self.start, self.since);
  error = LamWriteBytes(lock->fd, text, (size_t)length);
  if (!error && LamFsync(lock->fd)) error = errno;
  if (error) PetscCall(LamLockRelease(lock));
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s.lock: %s", path, strerror(error));
  PetscFunctionReturn(0);
}

PetscErrorCode LamLockTake(const char path[], LamLock *lock)
{
  PetscBool removed;
  int length;

  PetscFunctionBeginUser;
  lock->fd = -1;
  length = snprintf(lock->path, sizeof(lock->path), "%s.lock", path);
  PetscCheck(length < (int)sizeof(lock->path), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: the path is too long", path);
  while (lock->fd < 0) {
    lock->fd = open(lock->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (lock->fd < 0) {
      PetscCheck(errno == EEXIST, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: cannot make the lock %s: %s%s", path,
                 lock->path, strerror(errno), errno == ENOENT ? "; make the folder first" : "");
      PetscCall(RemoveStale(lock->path, path, &removed));
      continue;
    }
    PetscCall(WriteHolder(path, lock));
    if (!IsNamed(lock->fd, lock->path)) PetscCall(LamLockRelease(lock));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamLockRelease(LamLock *lock)
{
  PetscFunctionBeginUser;
  if (lock->fd < 0) PetscFunctionReturn(0);
  if (IsNamed(lock->fd, lock->path)) unlink(lock->path);
  close(lock->fd);
  lock->fd = -1;
  PetscFunctionReturn(0);
}

/* On a file system without flock the calls fail, and a reader may, rarely, find an incomplete commit and report it. */
void LamLockBeginCommit(LamLock *lock)
{
  LamFlock(lock->fd, LOCK_EX);
}

void LamLockEndCommit(LamLock *lock)
{
  LamFlock(lock->fd, LOCK_UN);
}

/* The writer's lock is beside the file itself, not beside a link to it. */
static int OpenLock(const char path[])
{
  char target[PETSC_MAX_PATH_LEN], name[PETSC_MAX_PATH_LEN];

  if (!LamPathFollow(path, target)) return -1;
  if (snprintf(name, sizeof(name), "%s.lock", target) >= (int)sizeof(name)) return -1;
  return open(name, O_RDONLY | O_CLOEXEC);
}

int LamLockBeginRead(const char path[])
{
  const int fd = OpenLock(path);

  if (fd >= 0) LamFlock(fd, LOCK_SH);
  return fd;
}

void LamLockEndRead(int fd)
{
  if (fd >= 0) close(fd);
}

PetscBool LamLockGetHolder(const char path[], LamLockHolder *holder)
{
  const int fd = OpenLock(path);
  const PetscBool known = (PetscBool)(fd >= 0 && HolderRead(fd, holder));

  if (fd >= 0) close(fd);
  return (PetscBool)(known && !HolderIsDead(holder));
}
