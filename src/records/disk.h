/*
  Private to the record files: files as the operating system has them, without HDF5; and the lock of a writer. Calls
  that a signal breaks off are begun again: SA_RESTART does not reach all of them, and a program that uses the library
  may do without it.
*/
#ifndef LAM_DISK_H
#define LAM_DISK_H

#include <petscsys.h>

#define LAM_TIME_LENGTH 32

/* ---- disk.c ---- */

int LamFsync(int fd);
int LamFlock(int fd, int operation);
/* Writes all bytes; 0, or errno. */
int LamWriteBytes(int fd, const void *bytes, size_t n);
/* Now, ISO 8601, UTC. */
void LamTimeNow(char text[LAM_TIME_LENGTH]);
/* The file behind a link; otherwise the path as it was given, for messages. False: no file there, or too long a path.
 */
PetscBool LamPathFollow(const char path[], char target[PETSC_MAX_PATH_LEN]);
/*
  Reserves `bytes` more on the disk, and some for HDF5's own tables, before HDF5 begins: HDF5 1.10 crashes at exit over
  data that it could not write. PETSC_ERR_FILE_WRITE with the system's reason. `create`: starts an empty file.
*/
PetscErrorCode LamFileReserve(const char path[], PetscBool create, size_t bytes);
/* With the permissions of the first. */
PetscErrorCode LamFileCopy(const char from[], const char to[]);
/* Syncs a closed file and renames it. */
PetscErrorCode LamFilePublish(const char temporary[], const char path[]);

/* ---- record_lock.c ---- */

/* The writer's lock: the file PATH.lock, which says who holds it. */
typedef struct {
  char path[PETSC_MAX_PATH_LEN];
  int fd; /* -1: not held */
} LamLock;

PetscErrorCode LamLockTake(const char path[], LamLock *lock);
PetscErrorCode LamLockRelease(LamLock *lock);
/* Readers wait while a commit is under way, and a commit waits for readers: milliseconds each. */
void LamLockBeginCommit(LamLock *lock);
void LamLockEndCommit(LamLock *lock);
int LamLockBeginRead(const char path[]); /* a descriptor for LamLockEndRead, or -1 where no writer is about */
void LamLockEndRead(int fd);
/* Who writes to the file. False: no one, or a process of this host that has died. */
typedef struct {
  char host[256], since[LAM_TIME_LENGTH];
  long pid;
  unsigned long long start; /* clock ticks after boot; 0: not known */
} LamLockHolder;
PetscBool LamLockGetHolder(const char path[], LamLockHolder *holder);

#endif
