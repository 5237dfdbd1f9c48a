/*
  A file of named arrays that the ranks of a communicator write or read together: the checkpoint of a run.

    LamArchiveCreate(comm, path, &archive), or LamArchiveOpen(comm, path, &archive);
    LamArchiveItems(archive, "u", size, n, numbers, items); ...
    LamArchiveClose(&archive, keep);

  The same calls write and read. All calls are collective. Items have global numbers, so that the number of ranks may
  differ between writing and reading.
*/
#ifndef LAMELLA_ARCHIVE_H
#define LAMELLA_ARCHIVE_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamArchive_s *LamArchive;

/* Creates a file. It is renamed to `path` at LamArchiveClose, when it is complete and synced; if the process is
   killed before, an earlier file remains. */
LAM_EXPORT PetscErrorCode LamArchiveCreate(MPI_Comm comm, const char path[], LamArchive *archive);
/* Opens a file for reading; it may be replaced meanwhile. PETSC_ERR_USER_INPUT: no such file, or a damaged one. */
LAM_EXPORT PetscErrorCode LamArchiveOpen(MPI_Comm comm, const char path[], LamArchive *archive);
LAM_EXPORT PetscBool LamArchiveIsReading(LamArchive archive);
/*
  Writes or reads `n` items of `size` bytes each, items[n][size], with their global numbers 0, 1, ..., which should
  have few gaps. Writing: each number belongs to one rank. Reading: a rank receives the items it names.
  PETSC_ERR_USER_INPUT if count or size in the file differ from those requested.
*/
LAM_EXPORT PetscErrorCode LamArchiveItems(LamArchive archive, const char name[], size_t size, PetscInt n,
                                          const PetscInt numbers[], void *items);
/* A value that is equal on all ranks; that of rank 0 is written. */
LAM_EXPORT PetscErrorCode LamArchiveShared(LamArchive archive, const char name[], size_t size, void *value);
/* A list of *n items on rank 0. Reading: allocated on rank 0, the caller frees it with PetscFree; other ranks get
   n = 0 and items NULL. */
LAM_EXPORT PetscErrorCode LamArchiveList(LamArchive archive, const char name[], size_t size, PetscInt *n, void **items);
/* Closes the archive; `keep` PETSC_FALSE: a file that was written is discarded. */
LAM_EXPORT PetscErrorCode LamArchiveClose(LamArchive *archive, PetscBool keep);

LAM_C_END

#endif
