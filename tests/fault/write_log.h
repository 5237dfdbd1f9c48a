/*
  Log of what a program does to one file, made by standing in for the system's calls: writes, changes of its length,
  syncs. Played back up to any point, it gives the file as a kill at that instant, or a loss of power, leaves it.
*/
#ifndef LAM_WRITE_LOG_H
#define LAM_WRITE_LOG_H

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

typedef enum { LOG_WRITE, LOG_LENGTH, LOG_SYNC } LogKind;

typedef struct {
  LogKind kind;
  off_t offset; /* of a write; the new length */
  size_t size;  /* of a write */
  unsigned char *bytes;
} LogEntry;

/* Calls on the file with this number are logged; 0: none. */
static ino_t log_inode;
static LogEntry *log_entries;
static size_t log_n, log_capacity;

static inline void LogStart(const char file[])
{
  struct stat info;

  log_inode = stat(file, &info) ? 0 : info.st_ino;
}

static inline void LogClear(void)
{
  for (size_t k = 0; k < log_n; k++) free(log_entries[k].bytes);
  free(log_entries);
  log_entries = NULL;
  log_n = log_capacity = 0;
  log_inode = 0;
}

static inline void LogAdd(int fd, LogKind kind, off_t offset, size_t size, const void *bytes)
{
  struct stat info;
  LogEntry *e;

  if (!log_inode || fstat(fd, &info) || info.st_ino != log_inode) return;
  if (log_n == log_capacity) {
    log_capacity = 2 * log_capacity + 64;
    log_entries = realloc(log_entries, log_capacity * sizeof(*log_entries));
  }
  e = &log_entries[log_n++];
  *e = (LogEntry){kind, offset, size, NULL};
  if (!size) return;
  e->bytes = malloc(size);
  memcpy(e->bytes, bytes, size);
}

/* ---- the system's calls ---- */

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t offset)
{
  LogAdd(fd, LOG_WRITE, offset, size, bytes);
  return syscall(SYS_pwrite64, fd, bytes, size, offset);
}

int ftruncate(int fd, off_t length)
{
  LogAdd(fd, LOG_LENGTH, length, 0, NULL);
  return (int)syscall(SYS_ftruncate, fd, length);
}

int posix_fallocate(int fd, off_t offset, off_t length)
{
  LogAdd(fd, LOG_LENGTH, offset + length, 0, NULL);
  return syscall(SYS_fallocate, fd, 0, offset, length) ? errno : 0;
}

int fsync(int fd)
{
  LogAdd(fd, LOG_SYNC, 0, 0, NULL);
  return (int)syscall(SYS_fsync, fd);
}

/* ---- playing back ---- */

/* Does to the open file what the entry did; of a write only the first `part` bytes. */
static inline int LogPlay(int fd, const LogEntry *e, size_t part)
{
  const size_t size = part < e->size ? part : e->size;

  if (e->kind == LOG_LENGTH) return (int)syscall(SYS_ftruncate, fd, e->offset);
  if (e->kind == LOG_WRITE) return syscall(SYS_pwrite64, fd, e->bytes, size, e->offset) == (ssize_t)size ? 0 : -1;
  return 0;
}

#endif
