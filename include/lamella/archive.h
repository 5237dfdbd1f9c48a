/*
  A file of named arrays that the ranks of a communicator write or read together: the state of a run, to go on from.

    LamArchiveCreate(comm, path, &archive), or LamArchiveOpen(comm, path, &archive);
    LamArchiveItems(archive, "u", size, n, numbers, items); ...
    LamArchiveClose(&archive);

  The same calls write and read: what is saved is what is loaded. All are collective. Items have numbers of their own,
  so that any number of ranks may read what another number has written.
*/
#ifndef LAMELLA_ARCHIVE_H
#define LAMELLA_ARCHIVE_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamArchive_s *LamArchive;

/* Starts a file that takes its name at LamArchiveClose, complete and on the disk: a kill leaves the one before. */
LAM_EXPORT PetscErrorCode LamArchiveCreate(MPI_Comm comm, const char path[], LamArchive *archive);
/* Reads a file, also when another one takes its place meanwhile. PETSC_ERR_USER_INPUT: no such file, or a damaged one.
 */
LAM_EXPORT PetscErrorCode LamArchiveOpen(MPI_Comm comm, const char path[], LamArchive *archive);
LAM_EXPORT PetscBool LamArchiveIsReading(LamArchive archive);
/*
  `n` items of `size` bytes each, items[n][size], with their numbers in the whole of all ranks: 0, 1, ... without much
  between that no one has. Written, each number is one rank's; read, a rank gets those it names. PETSC_ERR_USER_INPUT
  where the file has another count, or size, than what is to be read.
*/
LAM_EXPORT PetscErrorCode LamArchiveItems(LamArchive archive, const char name[], size_t size, PetscInt n,
                                          const PetscInt numbers[], void *items);
/* A value that is the same on all ranks; rank 0's is written. */
LAM_EXPORT PetscErrorCode LamArchiveShared(LamArchive archive, const char name[], size_t size, void *value);
/* A list of *n items of rank 0 alone; read, it is made there, and the caller's to PetscFree; others: n 0, items NULL.
 */
LAM_EXPORT PetscErrorCode LamArchiveList(LamArchive archive, const char name[], size_t size, PetscInt *n, void **items);
/* `keep` PETSC_FALSE: what was written vanishes. */
LAM_EXPORT PetscErrorCode LamArchiveClose(LamArchive *archive, PetscBool keep);

LAM_C_END

#endif
