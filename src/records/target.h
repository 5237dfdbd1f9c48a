/*
  What may stand under the name of a file that a command writes. A file that is there is replaced only if Lamella wrote
  it, of the same kind: an HDF5 file says so by its attribute `kind`, a table by its head line, other texts by how they
  begin. --overwrite (LAM_WRITE_OVERWRITE) replaces any plain file, but no input of the command.
*/
#ifndef LAM_TARGET_H
#define LAM_TARGET_H

#include <lamella/database.h>

/* A kind of text file. */
typedef struct {
  const char *what;           /* for messages: "a table of lamella rve" */
  const char *ending;         /* that replaces .h5 or .hdf5 of the file that it stands beside */
  const char *begins;         /* the first columns of a table, exactly; else a pattern (fnmatch) of the whole text */
  const char *before;         /* the pattern of texts of version 0.1, where that is another one; NULL: it is not */
  const char *const *columns; /* of a table: patterns of all further ones; NULL: no table */
  const char *ends;           /* the last columns, exactly; NULL: any */
} LamTextKind;

/* The file to which a writer of `path` writes: resolves links, and rejects files that the mode must not replace. */
PetscErrorCode LamTargetFind(const char path[], const char kind[], LamWriteMode mode, char target[PETSC_MAX_PATH_LEN]);
/*
  Before the work begins: whether the HDF5 file `path`, or the text beside it, may be written. PETSC_ERR_USER_INPUT: it
  would replace something else, or an input: the scene, a file that the scene names. PETSC_ERR_FILE_OPEN: there is no
  such folder, or nothing can be written to it.
*/
PetscErrorCode LamTargetCheck(const char path[], const char kind[], PetscBool overwrite, const LamScene *scene);
PetscErrorCode LamTargetCheckText(const char hdf5[], const LamTextKind *kind, PetscBool overwrite,
                                  const LamScene *scene);
static inline LamWriteMode LamTargetMode(PetscBool overwrite)
{
  return overwrite ? LAM_WRITE_OVERWRITE : LAM_WRITE_CREATE;
}
/* The path of a text beside an HDF5 file. */
PetscErrorCode LamTargetBeside(const char hdf5[], const char ending[], char path[PETSC_MAX_PATH_LEN]);
/* Whether two paths name the same file. The file need not exist: then its folder is compared. */
PetscBool LamTargetIsSame(const char a[], const char b[]);

#endif
