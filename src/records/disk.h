/*
  Private to the record files: file operations without HDF5, and the writer's lock. System calls interrupted by a
  signal are restarted: SA_RESTART does not cover all of them, and a program that uses the library may not set it.
*/
#ifndef LAM_DISK_H
#define LAM_DISK_H

#include <petscsys.h>

#define LAM_TIME_LENGTH 32

/* ---- disk.c ---- */

int LamFsync(int fd);
int LamFlock(int fd, int operation);
/* Writes all bytes; returns 0 or errno. */
int LamWriteBytes(int fd, const void *bytes, size_t n);
/* The current time, ISO 8601, UTC. */
void LamTimeNow(char text[LAM_TIME_LENGTH]);
/* Resolves a link to its target; other paths are copied unchanged, for messages. False: no file, or the path is too
   long. */
PetscBool LamPathFollow(const char path[], char target[PETSC_MAX_PATH_LEN]);
/*
  Reserves `bytes` more on the disk, plus space for HDF5's tables, before HDF5 writes: HDF5 1.10 crashes at exit if it
  could not write data. PETSC_ERR_FILE_WRITE with the system's reason. `create`: creates an empty file.
*/
PetscErrorCode LamFileReserve(const char path[], PetscBool create, size_t bytes);
/* Copies a file with its permissions. */
PetscErrorCode LamFileCopy(const char from[], const char to[]);
/* Syncs a closed file and renames it. */
PetscErrorCode LamFilePublish(const char temporary[], const char path[]);

/* ---- record_lock.c ---- */

/* The writer's lock: the file PATH.lock, which identifies the holder. */
typedef struct {
  char path[PETSC_MAX_PATH_LEN];
  int fd; /* -1: not held */
} LamLock;

PetscErrorCode LamLockTake(const char path[], LamLock *lock);
PetscErrorCode LamLockRelease(LamLock *lock);
/* Readers wait during a commit, and a commit waits for readers: milliseconds each. */
void LamLockBeginCommit(LamLock *lock);
void LamLockEndCommit(LamLock *lock);
int LamLockBeginRead(const char path[]); /* a descriptor for LamLockEndRead, or -1 if there is no writer */
void LamLockEndRead(int fd);
/* The writer of the file. False: none, or a process of this host that has died. */
typedef struct {
  char host[256], since[LAM_TIME_LENGTH];
  long pid;
  unsigned long long start; /* clock ticks after boot; 0: unknown */
} LamLockHolder;
PetscBool LamLockGetHolder(const char path[], LamLockHolder *holder);

#endif
